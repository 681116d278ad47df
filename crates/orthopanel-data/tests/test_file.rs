//! The test file: what it means, and one clear message for each way to get it wrong.

use orthopanel_data::{DataError, Direction, ImpactTest, MeasurementData, Position, Unit};
use orthopanel_model::{Boundary, End, Place, StructureKind};
use proptest::prelude::*;

const PIECE: &str = "[piece]\nlength = 0.8\nwidth = 0.1\nthickness = 0.03\nmass_per_area = 6.88\n";
const FREQUENCIES: &str = "[[measurement]]\nkind = \"natural-frequencies\"\nvalues = [321.3, 837.5, 1520]\n";

fn read(text: &str) -> Result<ImpactTest, DataError> {
    ImpactTest::from_toml(text, "test.toml")
}

/// The message for `text`, which must be refused.
#[track_caller]
fn message(text: &str) -> String {
    match read(text) {
        Ok(test) => panic!("accepted: {test:?}"),
        Err(error) => error.to_string(),
    }
}

#[track_caller]
fn frequencies(test: &ImpactTest, index: usize) -> &orthopanel_data::NaturalFrequencies {
    match &test.measurements[index].data {
        MeasurementData::NaturalFrequencies(data) => data,
        other => panic!("{other:?}"),
    }
}

#[test]
fn val_the_whole_file_of_the_design_is_read() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("point-0.uff"), "").unwrap();
    let text = format!(
        "{PIECE}[boundary]\nright = \"clamped\"\n[suspension]\nat = [-0.22, 0.22]\n[constants]\ne_x = 7.0e10\n\
         [[effect]]\nid = \"sensor-mass\"\nmass = 0.005\n{FREQUENCIES}resolution = 1.25\nresponse_at = [0.3, 0]\n\
         [[measurement]]\nkind = \"accelerance\"\nfile = \"point-0.uff\"\nforce_at = [-0.3, 0.0]\n\
         response_at = [0.3, 0.0]\nunit = \"g\"\ndirection = -1\n"
    );
    let path = folder.path().join("test.toml");
    std::fs::write(&path, text).unwrap();
    let test = ImpactTest::read(&path).unwrap();
    assert_eq!(
        format!("{:?}", ImpactTest::read(folder.path()).unwrap()),
        format!("{test:?}"),
        "a folder stands for its test.toml"
    );
    assert_eq!(test.pieces[0].piece.thickness, 0.03);
    assert_eq!(test.boundary, Boundary { left: End::Free, right: End::Clamped, ..Boundary::FREE });
    assert_eq!(test.suspension, [Place { x: -0.22, y: 0.0 }, Place { x: 0.22, y: 0.0 }]);
    assert_eq!(test.constants["e_x"], 7.0e10);
    assert_eq!((test.effects[0].id.as_str(), test.effects[0].parameters["mass"]), ("sensor-mass", 0.005));
    assert_eq!(frequencies(&test, 0).values, [321.3, 837.5, 1520.0]);
    assert_eq!(frequencies(&test, 0).resolution, [1.25; 3]);
    assert_eq!(frequencies(&test, 0).response_at, Some(Place { x: 0.3, y: 0.0 }));
    let MeasurementData::Accelerance(recorded) = &test.measurements[1].data else { panic!("not an accelerance") };
    assert_eq!(recorded.file, folder.path().join("point-0.uff"));
    assert_eq!(recorded.force_at, Place { x: -0.3, y: 0.0 });
    assert_eq!((recorded.response_unit.clone(), recorded.direction), (Unit::parse("g"), Some(Direction::AgainstForce)));
}

#[test]
fn val_several_pieces_are_told_apart_by_name() {
    let piece = |name: &str| format!("[{PIECE}name = \"{name}\"\n").replace("[piece]", "[piece]]");
    let of = |name: &str| format!("{FREQUENCIES}piece = \"{name}\"\n");
    let test = read(&[piece("1"), piece("2"), of("2"), of("1")].concat()).unwrap();
    assert_eq!([test.measurements[0].piece, test.measurements[1].piece], [1, 0]);
    let twice = message(&[piece("1"), piece("1"), of("1")].concat());
    assert!(twice.contains("test.toml:12: piece[2].name = \"1\": the name stands before"), "{twice}");
    let unknown = message(&[piece("1"), piece("2"), of("3")].concat());
    assert!(unknown.contains("measurement[1].piece = \"3\": the pieces are named \"1\", \"2\""), "{unknown}");
    let unsaid = message(&[piece("1"), piece("2"), FREQUENCIES.into()].concat());
    assert!(unsaid.contains("measurement[1].piece is missing: there are several pieces"), "{unsaid}");
}

/// The paper's table 2 divides mass by area for each coupon and takes the mean.
#[test]
fn val_weighings_give_the_mean_mass_per_area() {
    let text = PIECE.replace("mass_per_area = 6.88", "weighings = [[0.1, 0.1, 6.862e-2], [0.2, 0.1, 0.138]]");
    let test = read(&format!("{text}{FREQUENCIES}")).unwrap();
    let by_hand = (6.862 + 6.9) / 2.0;
    assert!((test.pieces[0].piece.mass_per_area - by_hand).abs() < 1e-12);
}

#[test]
fn val_structure_and_own_constants_are_read() {
    let text = format!("structure = \"mindlin-plate\"\n{PIECE}own_constants = [\"g_zx\"]\n{FREQUENCIES}");
    let test = read(&text).unwrap();
    assert_eq!(
        (test.structure, &test.pieces[0].own_constants[..]),
        (Some(StructureKind::MindlinPlate), &["g_zx".to_owned()][..])
    );
    let silent = read(&format!("{PIECE}{FREQUENCIES}")).unwrap();
    assert_eq!((silent.structure, silent.pieces[0].own_constants.len()), (None, 0));
    let cases = [
        (
            "mindlin-plate",
            "shell",
            "test.toml:1: structure = \"shell\": must be \"timoshenko-beam\" or \"mindlin-plate\"",
        ),
        (
            "[\"g_zx\"]",
            "[\"g_zx\", \"g_zx\"]",
            "test.toml:7: piece.own_constants[2] = \"g_zx\": the name stands before",
        ),
        ("[\"g_zx\"]", "[\" \"]", "test.toml:7: piece.own_constants[1] is missing"),
        ("[\"g_zx\"]", "\"g_zx\"", "test.toml:7: piece.own_constants: text \"g_zx\" given, wanted is a list of names"),
    ];
    for (from, to, said) in cases {
        let found = message(&text.replacen(from, to, 1));
        assert!(found.contains(said), "\n  said   {found}\n  wanted {said}");
    }
}

#[test]
fn val_plate_shapes_may_share_a_bin_and_stand_one_a_mode() {
    let text = format!("{PIECE}{}shape = [[2, 0], [1, 1], [3, 0]]\n", FREQUENCIES.replace("837.5", "321.3"));
    assert_eq!(frequencies(&read(&text).unwrap(), 0).shape, [[2, 0], [1, 1], [3, 0]]);
    let short = message(&format!("{PIECE}{FREQUENCIES}shape = [[2, 0]]\n"));
    assert!(short.contains("measurement[1].shape has 1 entries: give one [nodes_x, nodes_y] a mode, 3"), "{short}");
    let twice = message(&format!("{PIECE}{FREQUENCIES}shape = [[2, 0], [1, 1], [2, 0]]\n"));
    assert!(twice.contains("measurement[1].shape[3]"), "{twice}");
}

/// A name by shape makes order needless; each line keeps its bin.
#[test]
fn val_a_list_with_shapes_may_stand_in_any_order() {
    let lines = "values = [321.3, 1520.0, 837.5]\nshape = [[2, 0], [4, 0], [3, 0]]\nresolution = [1.0, 3.0, 2.0]\n";
    let read = read(&format!("{PIECE}[[measurement]]\nkind = \"natural-frequencies\"\n{lines}")).unwrap();
    let list = frequencies(&read, 0);
    assert_eq!(list.values, [321.3, 837.5, 1520.0]);
    assert_eq!(list.shape, [[2, 0], [3, 0], [4, 0]]);
    assert_eq!(list.resolution, [1.0, 2.0, 3.0]);
}

#[test]
fn val_frequencies_out_of_order_name_piece_modes_and_values() {
    let text = "[[piece]]\nname = \"2\"\nlength = 0.8\nwidth = 0.1\nthickness = 0.03\nmass_per_area = 6.88\n\
                [[measurement]]\nkind = \"natural-frequencies\"\nvalues = [\n  321, 837, 3150,\n  2362\n]\n";
    assert_eq!(
        message(text),
        "test.toml:11: measurement[1].values[4]: piece 2: mode 4 (2362 Hz) lies below mode 3 (3150 Hz): list natural \
         frequencies in rising order"
    );
    assert!(message(&text.replace("2362", "3150")).contains("mode 4 (3150 Hz) repeats mode 3 (3150 Hz)"));
}

/// Each row: a good file's text, what stands in its place, and what the message must say.
#[test]
fn val_each_fault_gets_line_key_and_remedy() {
    let good = format!("{PIECE}{FREQUENCIES}");
    let faults = [
        ("length = 0.8", "lenght = 0.8", "test.toml:2: unknown field `lenght`, expected one of `name`, `length`"),
        ("length = 0.8\n", "", "piece.length is missing: give it in m"),
        ("length = 0.8", "length = 0", "test.toml:2: piece.length = 0: must be a finite number of m, greater than"),
        ("width = 0.1", "width = -0.1", "test.toml:3: piece.width = -0.1"),
        ("width = 0.1", "width = nan", "test.toml:3: piece.width = NaN"),
        ("thickness = 0.03", "thickness = inf", "test.toml:4: piece.thickness = inf"),
        (
            "thickness = 0.03",
            "thickness = \"0.03\"",
            "test.toml:4: piece.thickness: text \"0.03\" given, wanted is a number in m",
        ),
        ("mass_per_area = 6.88\n", "", "piece.mass_per_area is missing: give it in kg/m2, or weighings"),
        ("mass_per_area = 6.88", "weighings = []", "piece.weighings has 0 entries"),
        ("mass_per_area = 6.88", "weighings = [[0.1, 0.1, -1]]", "piece.weighings[1][3] = -1"),
        ("mass_per_area = 6.88", "mass_per_area = 6.88\nweighings = [[1, 1, 1]]", "test.toml:6: piece.weighings: mass"),
        ("[piece]", "[plate]", "test.toml:1: unknown field `plate`"),
        (
            "natural-frequencies",
            "frequencies",
            "measurement[1].kind = \"frequencies\": must be \"natural-frequencies\"",
        ),
        ("kind = \"natural-frequencies\"\n", "", "test.toml:6: measurement[1].kind is missing"),
        ("values = [321.3, 837.5, 1520]\n", "", "measurement[1].values is missing"),
        ("[321.3, 837.5, 1520]", "[]", "measurement[1].values has 0 entries"),
        ("837.5", "nan", "test.toml:8: measurement[1].values[2] = NaN: must be a finite number of Hz"),
        (
            "1520]",
            "1520]\nresolution = [1, 2]",
            "test.toml:9: measurement[1].resolution has 2 entries: give one number",
        ),
        ("1520]", "1520]\nresolution = [1, 0, 2]", "measurement[1].resolution[2] = 0"),
        ("1520]", "1520]\nresolution = -1", "measurement[1].resolution = -1"),
        (
            "1520]",
            "1520]\nresolution = 1e6",
            "measurement[1].resolution = 1000000: must lie below the natural frequency",
        ),
        ("1520]", "1520]\nscatter = [1, 840, 2]", "measurement[1].scatter[2] = 840: must lie below"),
        (
            "1520]",
            "1520]\nresolution = \"1\"",
            "test.toml:9: measurement[1].resolution: text \"1\" given, wanted is one number [Hz], or a list with one",
        ),
        (
            "1520]",
            "1520]\nresponse_at = [0.5, 0]",
            "test.toml:9: measurement[1].response_at: place (0.5, 0) m lies off",
        ),
        (
            "1520]",
            "1520]\nshape = [[2, 0], [-1, 1], [3, 0]]",
            "measurement[1].shape: -1 given, wanted is a list with one [nodes",
        ),
        (
            "1520]",
            "1520]\nshape = [[2, 0], [1.5, 1], [3, 0]]",
            "measurement[1].shape: 1.5 given, wanted is a list with one [nodes",
        ),
        (
            "1520]",
            "1520]\n[constants]\ne_x = \"70\"",
            "test.toml:10: constants.e_x: text \"70\" given, wanted is a number (Pa",
        ),
        ("837.5", "\n  true", "test.toml:9: measurement[1].values: true given, wanted is a list of frequencies in Hz"),
        ("1520]", "1520]\nresponse_at = [nan, 0]", "measurement[1].response_at: place (NaN, 0) m lies off the piece"),
        ("1520]", "1520]\nunit = \"g\"", "measurement[1].unit: does not belong to kind = \"natural-frequencies\""),
        ("1520]", "1520]\npiece = \"wide\"", "measurement[1].piece = \"wide\": the pieces are named \"1\""),
        ("1520]", "1520]\n[constants]\ne_x = 70", "test.toml:10: constants.e_x = 70: must lie between 1e2 and 1e13 Pa"),
        ("1520]", "1520]\n[constants]\ne_z = 7e10", "constants.e_z = \"e_z\": the constants are e_x"),
        (
            "1520]",
            "1520]\n[constants]\nnu_xy = 0.8\ne_x = 1e9\ne_y = 2e9",
            "constants.nu_xy = 0.8: must lie below 0.7071",
        ),
        ("1520]", "1520]\n[constants]\nnu_xy = -0.1", "constants.nu_xy = -0.1: must lie between 0e0 and 9.5e-1"),
        ("1520]", "1520]\n[boundary]\nleft = \"fixed\"", "unknown variant `fixed`, expected one of `free`, `pinned`"),
        ("1520]", "1520]\n[suspension]\nat = [0.5]", "suspension.at[1]: place (0.5, 0) m lies off the piece"),
        ("1520]", "1520]\n[[effect]]\nmass = 1", "test.toml:9: effect[1].id is missing"),
        ("1520]", "1520]\n[[effect]]\nid = \"gain\"\ngain = inf", "test.toml:11: effect[1].gain = inf"),
        ("1520]", "1520]\n[[effect]]\nid = \"gain\"\ngain = \"1\"", "effect[1].gain: string given, a number"),
    ];
    for (from, to, said) in faults {
        assert!(good.contains(from), "{from} does not stand in the good file");
        let found = message(&good.replacen(from, to, 1));
        assert!(found.contains(said), "for {to:?}\n  said   {found}\n  wanted {said}");
        assert!(!found.contains('\n'), "more than one line: {found}");
    }
    assert!(message(PIECE).contains("measurement is missing"));
    assert!(message(FREQUENCIES).contains("piece is missing: write [piece] with length"));
}

#[test]
fn val_a_recorded_response_needs_file_places_and_known_units() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("hits.uff"), "").unwrap();
    let path = folder.path().join("test.toml");
    let good = format!(
        "{PIECE}[[measurement]]\nkind = \"time-history\"\nfile = \"hits.uff\"\nforce_at = [0.4, 0]\n\
         response_at = [-0.4, 0.05]\ndirection = 1\nunit = \"m/s2\"\n"
    );
    ImpactTest::from_toml(&good, &path).unwrap();
    let faults = [
        ("file = \"hits.uff\"\n", "", "measurement[1].file is missing"),
        ("hits.uff", "hit.uff", "test.toml:8: measurement[1].file: cannot be read: "),
        ("hits.uff", ".", "it is a folder, not a file"),
        ("force_at = [0.4, 0]\n", "", "measurement[1].force_at is missing"),
        ("[0.4, 0]", "[0.41, 0]", "measurement[1].force_at: place (0.41, 0) m lies off the piece"),
        (
            "[0.4, 0]",
            "[0.4]",
            "test.toml:9: measurement[1].force_at: a list of 1 given, wanted is a place [x, y] in m from the piece's centre",
        ),
        ("m/s2", "N", "measurement[1].unit = \"N\": must be a unit of motion, such as \"m/s2\", \"g\""),
        ("direction = 1", "direction = 0", "measurement[1].direction = 0: must be 1 (sensor along the force) or -1"),
        ("direction = 1", "record = 2", "measurement[1].record: does not belong to kind = \"time-history\""),
        ("direction = 1", "values = [1]", "measurement[1].values: does not belong to kind = \"time-history\""),
    ];
    for (from, to, said) in faults {
        let found = match ImpactTest::from_toml(&good.replacen(from, to, 1), &path) {
            Ok(test) => panic!("accepted: {test:?}"),
            Err(error) => error.to_string(),
        };
        assert!(found.contains(said), "for {to:?}\n  said   {found}\n  wanted {said}");
    }
}

#[test]
fn val_files_that_cannot_be_read_are_named() {
    let absent = ImpactTest::read("no/such/test.toml").unwrap_err().to_string();
    assert!(absent.starts_with("no/such/test.toml: cannot be read: "), "{absent}");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("latin1.toml");
    std::fs::write(&path, b"# \xe9\n").unwrap();
    match ImpactTest::read(&path).unwrap_err() {
        DataError::Syntax { at, .. } => assert_eq!((at.position, at.file), (Position::Byte(2), path)),
        other => panic!("{other}"),
    }
}

#[test]
fn val_real_test_files_are_read() {
    let Some(path) = crate::support::measured("free_beam/test.toml") else { return };
    assert_eq!(ImpactTest::read(path).unwrap().measurements.len(), 9);
}

/// A line of a test file, right or wrong, so that random files get past the first line.
fn line() -> impl Strategy<Value = String> {
    let key = prop::sample::select(vec![
        "length",
        "width",
        "thickness",
        "mass_per_area",
        "weighings",
        "name",
        "at",
        "e_x",
        "nu_xy",
        "id",
        "kind",
        "values",
        "resolution",
        "shape",
        "file",
        "force_at",
        "response_at",
        "unit",
        "direction",
        "left",
    ]);
    let value = prop_oneof![
        any::<f64>().prop_map(|x| format!("{x:?}")),
        any::<i64>().prop_map(|x| x.to_string()),
        prop::collection::vec(-1e4..1e4f64, 0..4).prop_map(|x| format!("{x:?}")),
        prop::sample::select(vec!["nan", "-inf", "[[1, 1, 1]]", "\"g\"", "\"accelerance\"", "\"natural-frequencies\""])
            .prop_map(str::to_owned),
        "\\PC{0,8}",
    ];
    let header = prop::sample::select(vec![
        "[piece]",
        "[[piece]]",
        "[boundary]",
        "[suspension]",
        "[constants]",
        "[[effect]]",
        "[[measurement]]",
    ]);
    prop_oneof![
        (key, value).prop_map(|(key, value)| format!("{key} = {value}\n")),
        header.prop_map(|h| format!("{h}\n"))
    ]
}

proptest! {
    #[test]
    fn val_no_text_makes_the_reader_panic(text in "(?s).{0,300}") {
        let _ = read(&text);
    }

    #[test]
    fn val_no_mixture_of_keys_makes_the_reader_panic(lines in prop::collection::vec(line(), 0..25)) {
        let _ = read(&lines.concat());
        let _ = read(&format!("{PIECE}{FREQUENCIES}{}", lines.concat()));
    }

    /// Whatever is accepted keeps the promises of [`ImpactTest`].
    #[test]
    fn val_accepted_frequencies_rise(values in prop::collection::vec(-10.0..1e4f64, 1..4)) {
        if let Ok(test) = read(&format!("{PIECE}[[measurement]]\nkind = \"natural-frequencies\"\nvalues = {values:?}\n")) {
            let accepted = &frequencies(&test, 0).values;
            prop_assert!(accepted[0] > 0.0 && accepted.windows(2).all(|pair| pair[0] < pair[1]));
            prop_assert_eq!(accepted, &values);
        } else {
            prop_assert!(values[0] <= 0.0 || values.windows(2).any(|pair| pair[0] >= pair[1]));
        }
    }
}

/// Sizes in millimetres or centimetres make a solid lighter than any foam.
#[test]
fn val_sizes_in_another_unit_are_told() {
    let read = |sizes: &str| {
        let text = format!(
            "[piece]\n{sizes}\n[[measurement]]\nkind = \"natural-frequencies\"\nvalues = [320.0, 830.0, 1500.0]\n"
        );
        ImpactTest::from_toml(&text, "test.toml").map_err(|error| error.to_string())
    };
    let piece = |[length, width, thickness]: [f64; 3], mass: f64| {
        read(&format!("length = {length:?}\nwidth = {width:?}\nthickness = {thickness:?}\nmass_per_area = {mass:?}"))
    };
    assert!(piece([0.8, 0.1, 0.03], 6.88).is_ok() && piece([0.8, 0.1, 0.03], 0.9).is_ok());
    for (sizes, density) in
        [([800.0, 100.0, 30.0], "0.229"), ([80.0, 10.0, 3.0], "2.293"), ([0.8, 0.1, 3e-5], "229333.333")]
    {
        let refused = piece(sizes, 6.88).unwrap_err();
        assert!(refused.contains("piece.thickness") && refused.contains(&format!("make {density} kg/m3")), "{refused}");
        assert!(refused.contains("sizes are in metres"), "{refused}");
    }
}
