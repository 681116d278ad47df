//! The commands on a plate model.

use crate::support::{Bench, PLATE, number};

/// Mass, and moments of inertia about the axes across and along, of [`PLATE`]'s piece (rotary inertia is in the law).
fn inertia() -> (f64, f64, f64) {
    let (length, width, thickness): (f64, f64, f64) = (0.8, 0.2, 0.03);
    let mass = 6.88 * length * width;
    let about = |side: f64| mass * (side.powi(2) + thickness.powi(2)) / 12.0;
    (mass, about(length), about(width))
}

#[test]
fn val_modes_tell_bending_from_torsion() {
    let bench = Bench::new();
    let answer = bench.json("modes plate.json --count 6");
    let told: Vec<_> = answer["modes"].as_array().expect("modes").iter().map(|mode| mode["kind"].clone()).collect();
    assert_eq!(told, ["bending", "torsion", "bending", "torsion", "bending", "torsion"]);
    assert_eq!(answer["modes"][3]["nodes"], serde_json::json!([2, 1]));
    // A narrow piece whose material does not contract sideways bends as the beam: its modes 1 and 2 to a ten-thousandth.
    let narrow = PLATE.replace("0.2,", "0.02,").replace("\"nu_xy\": 0.3", "\"nu_xy\": 0.0").replace("0.05]", "0.005]");
    std::fs::write(bench.path("narrow.json"), narrow).expect("a file is written");
    let plate = bench.json("modes narrow.json --count 4");
    let beam = bench.json("modes model.json --count 2");
    let bending: Vec<_> =
        plate["modes"].as_array().expect("modes").iter().filter(|mode| mode["kind"] == "bending").collect();
    for (index, mode) in bending.iter().take(2).enumerate() {
        let (found, expected) = (number(mode, "/frequency_hz"), number(&beam, &format!("/modes/{index}/frequency_hz")));
        assert!((found / expected - 1.0).abs() < 1e-4, "mode {}: {found}, beam {expected}", index + 1);
    }
}

#[test]
fn val_a_picture_names_every_mode() {
    let bench = Bench::new();
    bench.done("modes plate.json --count 4 --picture modes.svg");
    let text = std::fs::read_to_string(bench.path("modes.svg")).expect("a picture");
    for name in ["bending (2, 0)", "torsion (1, 1)", "bending (3, 0)", "torsion (2, 1)"] {
        assert!(text.contains(name), "{name}");
    }
    // Nodal lines: 2 + 2 + 3 + 3 at least, each drawn as one line or several.
    assert!(text.matches("<polyline").count() >= 10);
    bench.done("modes plate.json --count 0 --picture none.svg");
    assert!(!bench.path("none.svg").exists(), "a picture of no mode");
}

#[test]
fn val_accelerance_off_the_centre_line_turns_the_rigid_plate_two_ways() {
    let bench = Bench::new();
    let line = "accelerance plate.json --force=-0.3,0.06 --response=0.2,0.08 --from 0 --to 4000 --lines 801";
    let answer = bench.json(line);
    let (mass, across, along) = inertia();
    let rigid = 1.0 / mass - 0.3 * 0.2 / across + 0.06 * 0.08 / along;
    assert!((number(&answer, "/real/0") / rigid - 1.0).abs() < 1e-6, "{}, rigid {rigid}", number(&answer, "/real/0"));
    // On the centre line no torsion answers: mode 2 stands out off it only.
    let torsion = number(&bench.json("modes plate.json --count 2"), "/modes/1/frequency_hz");
    let at = |places: &str| {
        let line = format!("accelerance plate.json {places} --from {torsion} --to {torsion} --lines 1");
        number(&bench.json(&line), "/imag/0").abs()
    };
    let (off, on) = (at("--force=-0.3,0.06 --response=0.2,0.08"), at("--force=-0.3 --response=0.2"));
    assert!(off > 100.0 * on, "off the centre line {off}, on it {on}");
}

/// Twelve modes and the rest at rest answer as 120 that a basis resolves, up to a quarter of the highest of the twelve, in
/// the valleys too: at the driving point, where the others add a third there, and between places.
#[test]
fn val_few_modes_and_the_static_part_of_the_others_answer_as_many() {
    let bench = Bench::new();
    let highest = number(&bench.json("modes plate.json --count 12"), "/modes/11/frequency_hz");
    for places in ["--force=-0.3,0.06 --response=-0.3,0.06", "--force=-0.3,0.06 --response=0.2,0.08"] {
        let answer = |modes: &str| {
            let line = format!("accelerance plate.json {places} --from 10 --to {} --lines 400 {modes}", 0.25 * highest);
            let found = bench.json(&line);
            let part = |name: &str| -> Vec<f64> {
                found[name].as_array().expect("lines").iter().map(|value| value.as_f64().expect("a number")).collect()
            };
            part("real").into_iter().zip(part("imag")).collect::<Vec<(f64, f64)>>()
        };
        let (few, many) = (answer("--modes 12"), answer("--modes 120"));
        let mut sizes: Vec<f64> = many.iter().map(|(re, im)| re.hypot(*im)).collect();
        sizes.sort_by(f64::total_cmp);
        let misses = few.iter().zip(&many).map(|(few, many)| (few.0 - many.0).hypot(few.1 - many.1));
        let worst = misses.fold(0.0, f64::max) / sizes[200];
        // What is left goes with the fourth power of a line over the modes left out: a sixteenth of that third, and less.
        assert!(worst < 0.02, "{places}: {worst}");
    }
}

#[test]
fn an_fmu_moves_as_its_plate() {
    let bench = Bench::new();
    for fmi in ["2", "3"] {
        let answer = bench.json(&format!("export plate.json --fmi {fmi} --modes 12 -o plate.fmu"));
        assert_eq!((number(&answer, "/rigid_modes"), number(&answer, "/flexible_modes")), (3.0, 12.0));
        bench.done("simulate plate.json --modes 12 --force-file force.csv -o model.csv");
        bench.done("simulate plate.fmu --force-file force.csv -o fmu.csv");
        let (model, fmu) = (bench.rows("model.csv"), bench.rows("fmu.csv"));
        let peak = model.iter().map(|row| row[2].abs()).fold(0.0, f64::max);
        assert!(peak > 1.0 && model.len() == fmu.len());
        assert!(model.iter().zip(&fmu).all(|(model, fmu)| (model[2] - fmu[2]).abs() <= 1e-9 * peak), "FMI {fmi}");
    }
}

/// The limit told is the true one: so many modes are given.
#[test]
fn too_many_modes_are_refused_with_the_number_that_can_be_had() {
    let bench = Bench::new();
    let output = bench.run("modes plate.json --count 1001");
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{message}");
    let told = message.split("ask for ").nth(1).and_then(|rest| rest.split(' ').next()).expect("a number");
    let most: usize = told.parse().expect("a number");
    assert!((100..1000).contains(&most), "{message}");
    assert!(!bench.run(&format!("modes plate.json --count {}", most + 1)).status.success());
    bench.done(&format!("modes plate.json --count {most}"));
}

/// What is not identified stands in the table with its interval and its own direction; pure numbers have no unit.
#[test]
fn the_table_tells_what_the_data_leave_open() {
    let bench = Bench::new();
    let list = "structure = \"mindlin-plate\"\n[piece]\nlength = 0.8\nwidth = 0.2\nthickness = 0.03\nmass_per_area = 6.88\n\
                [[measurement]]\nkind = \"natural-frequencies\"\nvalues = [322.5, 842.5]\n";
    std::fs::write(bench.path("short.toml"), list).expect("a file is written");
    let output = bench.run("identify short.toml");
    let table = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{table}");
    assert!(
        table.contains("g_xy is not identified, held at ") && table.contains(" Pa: the data leave it open from "),
        "{table}"
    );
    assert!(table.contains(", along ln g_xy "), "{table}");
    let poisson = table.lines().find(|line| line.starts_with("nu_xy ")).expect("a row");
    assert!(poisson.trim_end().ends_with("held"), "{table}");
}

/// Held along its front, a plate that does not contract sideways is a cantilever as long as the plate is wide.
#[test]
fn val_a_plate_clamped_along_its_front_swings_as_a_cantilever_across() {
    let bench = Bench::new();
    let example = std::fs::read_to_string(bench.path("examples/clamped-plate.json")).expect("the example");
    bench.write("held.json", &example.replace("\"nu_xy\": 0.3", "\"nu_xy\": 0.0"));
    bench.write(
        "across.json",
        r#"{"schema": "orthopanel.model/1", "structure": "timoshenko-beam",
            "piece": {"length": 0.4, "width": 0.1, "thickness": 0.03, "mass_per_area": 6.88},
            "boundary": {"left": "clamped", "right": "free"}, "constants": {"e_x": 1.07e10, "g_zx": 3.0e8},
            "damping": {"beyond": 0.003}}"#,
    );
    let [plate, beam] = ["held", "across"].map(|name| bench.json(&format!("modes {name}.json --count 1")));
    let [plate, beam] = [&plate, &beam].map(|modes| number(modes, "/modes/0/frequency_hz"));
    assert!((plate / beam - 1.0).abs() < 1e-4, "plate {plate}, cantilever {beam}");
}

/// The same sizes are refused in a model as in a test.
#[test]
fn sizes_in_millimetres_are_refused_in_models_too() {
    let bench = Bench::new();
    let sizes = PLATE.replace("0.8,", "800,").replace("0.2,", "200,").replace("0.03,", "30,");
    bench.write("mm.json", &sizes.replace("[[-0.3, -0.05]]", "[]").replace("[[0.3, 0.05]]", "[]"));
    for command in ["modes mm.json", "export mm.json -o out.fmu --force 1 --response 2"] {
        let output = bench.run(command);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{command}: {message}");
        assert!(message.contains("make 0.229 kg/m3") && message.contains("metres"), "{message}");
    }
}
