//! A whole roving test in one measurement, channels in files of their own, the band, and the test file drafted of records.

use std::{fs, path::Path};

use orthopanel_data::{
    ChannelName, Estimation, ImpactTest, KnownConstant, MeasurementData, RecordFile, SizeDoubt, draft,
};
use orthopanel_model::Place;

use crate::support::{
    Dataset,
    recorded::{good, pair},
};

const PIECE: &str = "[piece]\nlength = 0.8\nwidth = 0.1\nthickness = 0.03\nmass_per_area = 6.88\n";

/// A record at a node, along z.
fn at(node: i64, dataset: &Dataset) -> Dataset {
    Dataset { response_node: node, reference_node: 0, ..dataset.clone() }
}

/// Blows at nodes 1 and 2, each with the responses of nodes 11 and 12.
fn roving() -> Vec<u8> {
    let [force, motion] = pair();
    let blow = |node: i64| [at(node, &force), at(11, &motion), at(12, &motion)];
    [blow(1), blow(2)].concat().iter().flat_map(|dataset| dataset.binary(false)).collect()
}

fn test(folder: &Path, measurement: &str) -> Result<ImpactTest, String> {
    let text = format!("{PIECE}[[measurement]]\nkind = \"time-history\"\n{measurement}");
    ImpactTest::from_toml(&text, folder.join("test.toml")).map_err(|error| error.to_string())
}

#[test]
fn val_places_make_a_measurement_of_each_pair_of_nodes() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    fs::write(folder.join("all.uff"), roving()).unwrap();
    fs::write(folder.join("places.csv"), "node,x (mm),y (mm)\n1,-300,0\n2,0,20\n11,300,0\n12,-380,0\n").unwrap();
    let found = test(folder, "file = \"all.uff\"\nplaces = \"places.csv\"\n").unwrap();
    assert_eq!(found.measurements.len(), 4);
    assert!(found.files().any(|file| file.ends_with("places.csv")));
    let lines = found.accelerances(Estimation::default()).unwrap();
    let places: Vec<[Place; 2]> = lines.iter().map(|(_, line)| [line.force_at, line.response_at]).collect();
    let place = |x: f64, y: f64| Place { x, y };
    let (a, b, c, d) = (place(-0.3, 0.0), place(0.0, 0.02), place(0.3, 0.0), place(-0.38, 0.0));
    assert_eq!(places, [[a, c], [a, d], [b, c], [b, d]]);
    // A channel chosen leaves the others out, and a declared place stands over a node's.
    let one = test(
        folder,
        "file = \"all.uff\"\nplaces = \"places.csv\"\nresponse_channel = \"12:+z\"\nresponse_at = [0.1, 0]\n",
    )
    .unwrap();
    let recorded = |of: &ImpactTest, index: usize| of.measurements[index].data.recorded().unwrap().clone();
    assert_eq!(one.measurements.len(), 2);
    assert_eq!(recorded(&one, 1).response_at, place(0.1, 0.0));
    assert_eq!(recorded(&one, 1).force_channel, Some(ChannelName::Port { node: 2, direction: 3 }));
}

#[test]
fn val_what_places_lack_is_asked_for() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    fs::write(folder.join("all.uff"), roving()).unwrap();
    for (places, more, said) in [
        ("node,x,y\n1,-0.3,0\n2,0,0\n11,0.3,0\n", "", "places.csv has no node 12, where"),
        ("node,x,y\n1,-0.3,0\n2,0,0\n11,0.3,0\n", "", "add the row 12,x,y, or give response_at = [x, y]"),
        (
            "node,x,y\n1,0.1,0\n2,0.4,0\n11,0.7,0\n12,0.75,0\n",
            "",
            "give origin = [x, y], the centre as the file has it",
        ),
        ("node,x\n1,0\n", "", "column y is missing among \"node\", \"x\": the columns are node,x,y"),
        ("node,x,y\n", "", "no row under the column names node,x,y"),
        ("node,x,y\n1,0,0\n2,0,0\n11,0,0\n12,a,0\n", "", "places.csv:5: x: \"a\" is no number"),
        ("", "origin = [0.4, 0]\n", "no row under the column names node,x,y"),
    ] {
        fs::write(folder.join("places.csv"), places).unwrap();
        let refused = test(folder, &format!("file = \"all.uff\"\nplaces = \"places.csv\"\n{more}")).unwrap_err();
        assert!(refused.contains(said), "{said}\n{refused}");
    }
    fs::write(folder.join("places.csv"), "node,x,y\n1,0.1,0\n2,0.4,0\n11,0.7,0\n12,0.75,0\n").unwrap();
    let moved = test(folder, "file = \"all.uff\"\nplaces = \"places.csv\"\norigin = [0.4, 0]\n").unwrap();
    assert!((moved.measurements[0].data.recorded().unwrap().force_at.x + 0.3).abs() < 1e-12);
    let alone =
        test(folder, "file = \"all.uff\"\nforce_at = [0, 0]\nresponse_at = [0, 0]\norigin = [0.4, 0]\n").unwrap_err();
    assert!(alone.contains("origin: belongs to places"), "{alone}");
}

#[test]
fn val_channels_may_have_files_of_their_own() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    let [force, motion] = pair();
    let write =
        |name: &str, of: &Dataset| fs::write(folder.join(name), [of.binary(false), of.binary(false)].concat()).unwrap();
    write("force.uff", &force);
    write("motion.uff", &motion);
    let places = "force_at = [-0.3, 0]\nresponse_at = [0.3, 0]\n";
    let found =
        test(folder, &format!("file = {{force = \"force.uff\", response = \"motion.uff\"}}\n{places}")).unwrap();
    let histories = found.time_histories().unwrap();
    assert_eq!((histories.len(), histories[0].1.hits.len()), (1, 2));
    assert_eq!(histories[0].1.hits[0].force, good().force);
    assert_eq!(found.files().count(), 2);
    let said = test(folder, &format!("file = {{force = \"force.uff\"}}\n{places}")).unwrap_err();
    assert!(said.contains("a list of names, or {force = .., response = ..}"), "{said}");
    let alone = test(folder, &format!("file = \"force.uff\"\n{places}")).unwrap().time_histories().unwrap_err();
    assert!(alone.to_string().contains("name both by file = {force = \"..\", response = \"..\"}"), "{alone}");
}

#[test]
fn val_a_band_leaves_the_lines_that_count() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    let rows: String = (1..200).map(|n| format!("{n},1,0.5\n")).collect();
    fs::write(folder.join("a.csv"), format!("frequency_hz,real,imag\n{rows}")).unwrap();
    let lines = |top: &str, own: &str| {
        let text = format!(
            "{top}{PIECE}[[measurement]]\nkind = \"accelerance\"\nfile = \"a.csv\"\nforce_at = [0, 0]\nresponse_at = [0, 0]\n{own}"
        );
        let test = ImpactTest::from_toml(&text, folder.join("test.toml")).map_err(|error| error.to_string())?;
        let found = test.accelerances(Estimation::default()).map_err(|error| error.to_string())?;
        let frequency = &found[0].1.frequency;
        Ok::<_, String>([frequency[0], frequency[frequency.len() - 1]])
    };
    assert_eq!(lines("", "").unwrap(), [1.0, 199.0]);
    assert_eq!(lines("band = [20, 150]\n", "").unwrap(), [20.0, 150.0]);
    assert_eq!(lines("band = [20, 150]\n", "band = [30, 40.5]\n").unwrap(), [30.0, 40.0]);
    let said = lines("", "band = [300, 400]\n").unwrap_err();
    assert!(said.contains("band = [300, 400] leaves 0 of its lines, which go from 1 to 199 Hz: widen it"), "{said}");
    for wrong in ["band = [150, 20]\n", "band = [-1, 20]\n"] {
        let said = lines("", wrong).unwrap_err();
        assert!(said.contains("a band is [from, to] in Hz, rising"), "{said}");
    }
}

#[test]
fn val_constants_and_sizes_may_be_known_in_part() {
    let list = "[[measurement]]\nkind = \"natural-frequencies\"\nvalues = [321.3, 837.5]\n";
    let read = |piece: &str, constants: &str| {
        ImpactTest::from_toml(&format!("{PIECE}{piece}[constants]\n{constants}\n{list}"), "test.toml")
            .map_err(|error| error.to_string())
    };
    let found =
        read("thickness_std = 1e-4\n", "e_x = {value = 1e10, std = 1e9}\ng_zx = {start = 5e8}\nnu_xy = 0.3").unwrap();
    assert_eq!(found.known_constants["e_x"], KnownConstant::Prior { value: 1e10, std: 1e9 });
    assert_eq!(found.known_constants["g_zx"], KnownConstant::Start(5e8));
    assert_eq!((found.constants.len(), found.constants["nu_xy"]), (1, 0.3));
    assert_eq!(found.pieces[0].doubt, SizeDoubt { thickness: 1e-4, ..SizeDoubt::default() });
    for (piece, constants, said) in [
        ("", "e_x = {value = 1e10}", "wanted is a number (held), {start = ..}, or {value = .., std = ..}"),
        ("", "e_x = {start = 1e10, value = 1e10, std = 1.0}", "wanted is a number (held)"),
        ("", "e_x = {value = 1e10, std = 0.0}", "std must be finite and greater than zero"),
        ("", "e_x = {start = 1e20}", "must lie between 1e2 and 1e13 Pa"),
        ("", "e_q = {start = 1e9}", "the constants are e_x"),
        ("", "e_x = \"soft\"", "wanted is a number (Pa; a Poisson's ratio has no unit), {start = ..}"),
        ("thickness_std = 0.1\n", "", "thickness_std = 0.1: must be less than thickness itself, 0.03 m"),
        ("length_std = -1.0\n", "", "length_std = -1: must be a finite number of m, greater than zero"),
    ] {
        let refused = read(piece, constants).unwrap_err();
        assert!(refused.contains(said), "{said}\n{refused}");
    }
}

/// The draft of a file, its comments filled in, is a test of that file.
#[test]
fn val_a_draft_is_a_test_once_it_is_filled_in() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    let filled = |bytes: &[u8], places: &str| {
        fs::write(folder.join("all.uff"), bytes).unwrap();
        let file = RecordFile::read(folder.join("all.uff")).unwrap();
        let text = draft(&[(Path::new("all.uff"), &file)]);
        let unfinished = ImpactTest::from_toml(&text, folder.join("test.toml")).unwrap_err().to_string();
        assert!(unfinished.contains("piece.length is missing: give it in m"), "{unfinished}");
        let mut filled = text.clone();
        for key in ["length", "width", "thickness", "mass_per_area", "force_at", "response_at"] {
            filled = filled.replace(&format!("\n# {key} = "), &format!("\n{key} = "));
        }
        fs::write(folder.join("places.csv"), places).unwrap();
        let test = ImpactTest::from_toml(&filled, folder.join("test.toml"));
        (text, test.unwrap_or_else(|error| panic!("{error}\n{filled}")))
    };
    let [force, motion] = pair();
    let plain = [at(0, &force).binary(false), at(0, &motion).binary(false)].concat();
    let (text, one) = filled(&plain, "");
    assert!(text.contains("# 1 x force (N)") && text.contains("kind = \"time-history\""), "{text}");
    assert_eq!(one.time_histories().unwrap()[0].1.hits[0].force, good().force);
    let (text, four) = filled(&roving(), "node,x,y\n1,-0.3,0\n2,0,0\n11,0.3,0\n12,-0.38,0\n");
    assert!(text.contains("a row a node, in m from the piece's centre: 1, 2, 11, 12"), "{text}");
    assert_eq!(four.measurements.len(), 4);
    assert!(four.measurements.iter().all(|of| matches!(of.data, MeasurementData::TimeHistory(_))));
}

/// What nodes do not tell apart, records without nodes and runs of one pair, has a measurement each by its number; of runs that with the
/// best coherence. As drafted, but for what only a person knows, it is read.
#[test]
fn val_a_draft_of_responses_without_nodes_and_of_runs_names_their_numbers() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    let response = |nodes: [i64; 2], size: f64| Dataset {
        function: 4,
        complex: true,
        numerator: (12, "m/s2".into()),
        denominator: (13, "N".into()),
        points: (0..5).map(|line| vec![size, f64::from(line)]).collect(),
        response_node: nodes[0],
        reference_node: nodes[1],
        ..Dataset::time(&[], (12, ""))
    };
    let coherence = |nodes: [i64; 2], of: f64| Dataset {
        function: 6,
        response_node: nodes[0],
        reference_node: nodes[1],
        ..Dataset::time(&[of; 5], (0, "NONE"))
    };
    let read = |datasets: &[Dataset]| {
        let bytes: Vec<u8> = datasets.iter().flat_map(|dataset| dataset.binary(false)).collect();
        fs::write(folder.join("all.uff"), bytes).unwrap();
        let file = RecordFile::read(folder.join("all.uff")).unwrap();
        let text = draft(&[(Path::new("all.uff"), &file)]);
        let mut filled = text.clone();
        for key in ["length", "width", "thickness", "mass_per_area", "force_at", "response_at"] {
            filled = filled.replace(&format!("\n# {key} = "), &format!("\n{key} = "));
        }
        // Each pair of places has its own.
        let parts: Vec<&str> = filled.split("response_at = [0.0, 0.0]").collect();
        let last = parts.len() - 1;
        let placed = parts.iter().enumerate().map(|(index, part)| match index {
            of if of == last => (*part).to_owned(),
            of => format!("{part}response_at = [0.{}, 0.0]", of + 1),
        });
        let test = ImpactTest::from_toml(&placed.collect::<String>(), folder.join("test.toml"));
        let lines = test.unwrap().accelerances(Estimation::default()).unwrap_or_else(|error| panic!("{error}\n{text}"));
        (text, lines.into_iter().map(|(_, line)| line.value[0].re).collect::<Vec<f64>>())
    };
    let none = [0, 0];
    let (text, sizes) = read(&[
        response(none, 1.0),
        coherence(none, 0.9),
        response(none, 2.0),
        coherence(none, 0.9),
        response(none, 3.0),
        coherence(none, 0.9),
    ]);
    assert_eq!(sizes, [1.0, 2.0, 3.0], "{text}");
    assert!(text.contains("record = 3   # a record\n# force_at"), "{text}");
    let run = |nodes, size| {
        [response(nodes, size), coherence(nodes, 0.3), response(nodes, 10.0 * size), coherence(nodes, 0.99)]
    };
    let (text, sizes) = read(&[run([2, 1], 1.0), run([3, 1], 2.0)].concat());
    assert_eq!(sizes, [10.0, 20.0], "{text}");
    assert!(text.contains("record = 7   # of the runs 5, 7, that with the best coherence, 0.990"), "{text}");
}
