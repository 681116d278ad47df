//! `[[effect]]` in a test file: part of the base model of `identify`, `trace` and `run`.

use crate::support::{Bench, number, refused};

/// Natural frequencies of a free beam 1.2 x 0.05 x 0.01 m, 27 kg/m2, E 70 GPa, k'G 26 GPa x 2/3, with 20 g at x = 0.5 m:
/// by finite elements in Python (200 Timoshenko elements), apart from this program.
fn test_file(effect: &str) -> String {
    format!(
        "[piece]\nlength = 1.2\nwidth = 0.05\nthickness = 0.01\nmass_per_area = 27.0\n[constants]\ng_zx = 2.6e10\n{effect}\n\
         [[measurement]]\nkind = \"natural-frequencies\"\nvalues = {FREQUENCIES:?}\nresponse_at = [0.5, 0.0]\n"
    )
}

const FREQUENCIES: [f64; 6] = [36.014785, 99.817963, 196.028983, 323.665693, 481.862595, 669.908578];

#[test]
fn val_a_declared_sensor_is_part_of_the_base_model() {
    let bench = Bench::new();
    bench.write("told.toml", &test_file("[[effect]]\nid = \"sensor-mass\"\nmass = 0.02"));
    let told = bench.json("identify told.toml -o model.json");
    let e_x = number(&told, "/constants/e_x/value");
    assert!((e_x / 7.0e10 - 1.0).abs() < 2e-5, "e_x {e_x}");
    assert_eq!(told["effects"][0]["id"], "sensor-mass");
    assert_eq!(told["effects"][0]["parameters"]["mass"][0]["value"], 0.02);
    // The sensor is the rig's: the panel's model does not carry it.
    assert!(bench.read_json("model.json").get("effects").is_none());
    // Without it the constant is wrong by twice the shift of the frequencies: 1.2 % of the mass sits where modes move.
    bench.write("untold.toml", &test_file(""));
    let untold = bench.json("identify untold.toml");
    let e_x = number(&untold, "/constants/e_x/value");
    assert!(e_x / 7.0e10 - 1.0 < -0.005, "e_x {e_x}");
}

#[test]
fn val_a_parameter_left_out_is_identified() {
    let bench = Bench::new();
    bench.write("test.toml", &test_file("[[effect]]\nid = \"sensor-mass\""));
    let found = bench.json("identify test.toml");
    let mass = &found["effects"][0]["parameters"]["mass"][0];
    let (value, std) = (number(mass, "/value"), number(mass, "/std"));
    // Six frequencies do not tell the mass from a panel that is uneven by as little as panels are.
    assert!((value - 0.02).abs() < std && std < 2e-3, "{value} +- {std} kg");
    assert!((number(&found, "/constants/e_x/value") / 7.0e10 - 1.0).abs() < 2e-3);
    // A mass of the panel stays in its model.
    bench.write("panel.toml", &test_file("[[effect]]\nid = \"local-mass\"\nx = 0.5"));
    bench.json("identify panel.toml -o model.json");
    let kept = &bench.read_json("model.json")["effects"][0];
    assert_eq!(kept["id"], "local-mass");
    assert!((number(kept, "/mass/value") - 0.02).abs() < 1e-3, "{kept}");
}

#[test]
fn a_wrong_effect_is_refused_with_its_numbers() {
    for (effect, said) in [
        ("id = \"sensor-wheel\"", &["sensor-wheel", "sensor-mass"][..]),
        ("id = \"sensor-mass\"\nweight = 0.02", &["weight", "mass"]),
        ("id = \"sensor-mass\"\nmass = -1.0", &["mass", "-1", "kg"]),
        ("id = \"sensor-mass\"\nmass = 900.0", &["mass", "9e2", "kg"]),
        ("id = \"suspension\"", &["suspension"]),
        ("id = \"width-coupling\"", &["width-coupling"]),
    ] {
        let bench = Bench::new();
        bench.write("test.toml", &test_file(&format!("[[effect]]\n{effect}")));
        for command in ["identify", "trace"] {
            refused(&bench, &format!("{command} test.toml"), 2, said);
        }
    }
    let bench = Bench::new();
    let twice = "[[effect]]\nid = \"sensor-mass\"\nmass = 0.01\n[[effect]]\nid = \"sensor-mass\"";
    bench.write("test.toml", &test_file(twice));
    refused(&bench, "identify test.toml", 2, &["sensor-mass", "twice"]);
    let plate = format!("structure = \"mindlin-plate\"\n{}", test_file("[[effect]]\nid = \"sensor-mass\""));
    bench.write("test.toml", &plate);
    // A strip's six frequencies are too few for six constants of a plate and a mass.
    refused(&bench, "identify test.toml", 1, &["nu_xy", "hold it under [constants]"]);
}

/// As copied from a model file; the catalogue knows whose an effect is.
#[test]
fn an_owner_may_be_told_and_must_be_right() {
    let bench = Bench::new();
    let effect =
        |owner: &str| test_file(&format!("[[effect]]\nid = \"sensor-mass\"\nowner = \"{owner}\"\nmass = 0.005"));
    bench.write("test.toml", &effect("rig"));
    bench.done("identify test.toml");
    bench.write("test.toml", &effect("panel"));
    refused(&bench, "identify test.toml", 2, &["owner", "\"panel\" given", "sensor-mass belongs to the rig"]);
}

/// Bounds that follow from the sizes are told with few digits.
#[test]
fn bounds_in_messages_are_short() {
    let bench = Bench::new();
    bench.write("test.toml", &test_file("[[effect]]\nid = \"sensor-mass\"\nmass = 1e6"));
    let message = String::from_utf8_lossy(&bench.run("identify test.toml").stderr).into_owned();
    let (_, bounds) = message.split_once("must lie between ").unwrap_or_else(|| panic!("no bounds: {message}"));
    let bounds = bounds.trim().split(" and ").map(|bound| bound.split([' ', ':', ',']).next().unwrap_or_default());
    let bounds: Vec<&str> = bounds.collect();
    assert!(
        bounds.len() == 2 && bounds.iter().all(|bound| bound.len() <= 9 && bound.parse::<f64>().is_ok()),
        "{message}"
    );
}

/// A suspension of a free beam whose springs nobody gave, and which no record shows.
#[test]
fn a_declared_effect_that_is_not_there_is_told_as_such() {
    let bench = Bench::new();
    let hung = bench.made_hits("[suspension]\nat = [-0.22, 0.22]\n[[effect]]\nid = \"suspension\"\n");
    for command in ["identify", "trace"] {
        let notes = bench.json(&format!("{command} {hung}"))["notes"].to_string();
        assert!(notes.contains("the data do not show the declared suspension"), "{command}: {notes}");
    }
    assert_eq!(bench.json(&format!("trace {hung}"))["verdict"], "nothing-missing");
}
