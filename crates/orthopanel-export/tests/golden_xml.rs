//! `modelDescription/`: the XML of each flavour for one small model, as it was last agreed on; of arrays, a plate
//! and each effect that can stand in an FMU, too.
//!
//! After a change on purpose, write them anew with `UPDATE_GOLDEN=1 cargo test -p orthopanel-export --test golden_xml`
//! and read the difference.

use std::io::Read as _;
use std::path::Path;

use orthopanel_export::{Connections, FmiVersion, Fmu, FmuOptions, Mount};
use orthopanel_model::{ModalModel, Mode, ModeRange, PanelModel, Place, Ports};

/// A rigid and two flexible modes; force 2 sits on a node of all modes that response 2 sees.
fn fmu(version: FmiVersion) -> Fmu {
    let mode = |angular_frequency, damping_ratio, at_forces: [f64; 2], at_responses: [f64; 2]| Mode {
        angular_frequency,
        damping_ratio,
        at_forces: at_forces.into(),
        at_responses: at_responses.into(),
    };
    let modes = vec![
        mode(0.0, 0.0, [1.25, 0.0], [1.25, 1.25]),
        mode(2000.0, 0.0025, [1.5, 0.75], [1.5, 0.0]),
        mode(5250.0, 0.00125, [-1.0, 0.0], [1.0, 0.5]),
    ];
    let model = ModalModel::new(2, 2, modes).expect("a sound model");
    let place = |x| Place { x, y: 0.0 };
    let ports = Ports { forces: vec![place(-0.3), place(0.1)], responses: vec![place(0.3), place(0.2)] };
    let options = FmuOptions { name: "small_panel".into(), version, ..FmuOptions::default() };
    Fmu::new(model, ports, &options).expect("a sound FMU")
}

fn compare(file: &str, written: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../modelDescription").join(file);
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(&path, written).expect("golden file written");
    }
    let golden = std::fs::read_to_string(&path).expect("golden file");
    assert_eq!(written, golden, "{file}: see the head of this test");
}

/// The XML without the token of its content: solved modes differ in their last digits from machine to machine.
fn tokenless(fmu: &Fmu, attribute: &str) -> String {
    let text = fmu.model_description();
    let start = text.find(attribute).expect("a token") + attribute.len() + 2;
    let end = start + text[start..].find('"').expect("an end");
    format!("{}{{token of the content}}{}", &text[..start], &text[end..])
}

#[test]
fn regress_fmi2() {
    compare("fmi2.xml", fmu(FmiVersion::Fmi2).model_description());
    compare("fmi2-parameters.xml", &tokenless(&settable(FmiVersion::Fmi2), "guid"));
}

#[test]
fn regress_fmi3() {
    compare("fmi3.xml", fmu(FmiVersion::Fmi3).model_description());
    compare("fmi3-parameters.xml", &tokenless(&settable(FmiVersion::Fmi3), "instantiationToken"));
}

#[test]
fn regress_terminals() {
    let bytes = settable(FmiVersion::Fmi3).to_bytes().expect("an archive");
    let mut archive = zip::ZipArchive::new(std::io::Cursor::new(bytes)).expect("a zip");
    let mut text = String::new();
    let name = "terminalsAndIcons/terminalsAndIcons.xml";
    archive.by_name(name).expect("terminals").read_to_string(&mut text).expect("text");
    compare("terminalsAndIcons.xml", &text);
}

#[test]
fn regress_arrays() {
    compare("fmi3-arrays.xml", &tokenless(&of_arrays(), "instantiationToken"));
}

/// All forces as one array, and each kind of output as another.
fn of_arrays() -> Fmu {
    let options = FmuOptions { version: FmiVersion::Fmi3, arrays: true, ..FmuOptions::default() };
    exported(&beam(""), 3, [&[-0.3, 0.1], &[0.1, 0.3]], &options)
}

#[test]
fn regress_plate() {
    for (version, attribute, file) in FLAVOURS {
        let options = FmuOptions { version, ..FmuOptions::default() };
        let fmu = exported(PLATE, 3, [&[-0.3], &[0.1]], &options);
        compare(&format!("{file}-plate.xml"), &tokenless(&fmu, attribute));
    }
}

/// The effects that can stand in an FMU, each in a beam of two modes: what states and parameters it brings.
const EFFECTS: [&str; 6] = [
    r#"{"id": "local-mass", "owner": "panel", "mass": 0.05, "x": 0.1}"#,
    r#"{"id": "edge-mass", "owner": "panel", "mass": 0.05}"#,
    r#"{"id": "stiffness-loss", "owner": "panel", "loss": 0.5, "span": 0.1, "x": 0.1}"#,
    r#"{"id": "resonator", "owner": "panel", "mass": 0.02, "frequency": 900, "zeta": 0.02, "x": 0.21}"#,
    r#"{"id": "rotary-inertia", "owner": "panel", "factor": 2.4}"#,
    r#"{"id": "viscoelastic-core", "owner": "panel", "strength": 0.3, "tau": 1e-4, "alpha": 0.6}"#,
];

#[test]
fn regress_each_effect() {
    for (version, attribute, file) in FLAVOURS {
        for effect in EFFECTS {
            let id = effect.split('"').nth(3).expect("an id");
            let options = FmuOptions { version, ..FmuOptions::default() };
            let fmu = exported(&beam(effect), 2, [&[-0.3], &[0.1]], &options);
            compare(&format!("{file}-{id}.xml"), &tokenless(&fmu, attribute));
        }
    }
}

#[test]
fn regress_connections() {
    for (version, attribute, file) in FLAVOURS {
        compare(&format!("{file}-connections.xml"), &tokenless(&connected(version), attribute));
    }
}

/// A cantilever on a mount, with every other connection.
fn connected(version: FmiVersion) -> Fmu {
    let mount = Mount { name: "tip".into(), at: Place { x: 0.35, y: 0.0 }, stiffness: 1e5, damping: 10.0 };
    let connections =
        Connections { mounts: vec![mount], rotations: true, gravity: true, pressure: true, base_acceleration: true };
    let options = FmuOptions { version, connections, ..FmuOptions::default() };
    let held = beam("").replace("\"damping\"", "\"boundary\": {\"left\": \"clamped\"}, \"damping\"");
    exported(&held, 2, [&[-0.3], &[0.1]], &options)
}

const FLAVOURS: [(FmiVersion, &str, &str); 2] =
    [(FmiVersion::Fmi2, "guid", "fmi2"), (FmiVersion::Fmi3, "instantiationToken", "fmi3")];

const PLATE: &str = r#"{"schema": "orthopanel.model/1", "structure": "mindlin-plate",
    "piece": {"length": 0.8, "width": 0.5, "thickness": 0.03, "mass_per_area": 6.88},
    "constants": {"e_x": 1.067e10, "e_y": 0.9e10, "nu_xy": 0.3, "g_xy": 3e9, "g_yz": 4e8, "g_zx": 5.304e8},
    "damping": {"beyond": 0.003}}"#;

/// The paper's piece 1, with these effects.
fn beam(effects: &str) -> String {
    format!(
        r#"{{"schema": "orthopanel.model/1", "structure": "timoshenko-beam",
        "piece": {{"length": 0.8, "width": 0.1, "thickness": 0.03, "mass_per_area": 6.88}},
        "constants": {{"e_x": 1.067e10, "g_zx": 5.304e8}}, "damping": {{"beyond": 0.003}}, "effects": [{effects}]}}"#
    )
}

/// With so many modes, forces and responses at these x.
fn exported(text: &str, modes: usize, [forces, responses]: [&[f64]; 2], options: &FmuOptions) -> Fmu {
    let panel = PanelModel::from_json(text).expect("a sound model");
    let places = |all: &[f64]| all.iter().map(|&x| Place { x, y: 0.0 }).collect();
    let ports = Ports { forces: places(forces), responses: places(responses) };
    Fmu::of_panel(&panel, ModeRange::Count(modes), ports, options).expect("a sound FMU")
}

/// The paper's piece 1, with parameters.
fn settable(version: FmiVersion) -> Fmu {
    exported(&beam(""), 3, [&[-0.3, 0.1], &[0.1, 0.3]], &FmuOptions { version, ..FmuOptions::default() })
}

/// The importer `fmi-rs` has a validator of its own.
#[test]
fn val_fmi_rs_finds_no_problem() {
    let also = |version| {
        let options = FmuOptions { version, ..FmuOptions::default() };
        let panels = EFFECTS.into_iter().map(beam).chain([PLATE.into()]);
        panels.map(move |text| exported(&text, 2, [&[-0.3], &[0.1]], &options)).collect::<Vec<_>>()
    };
    let two = [fmu(FmiVersion::Fmi2), settable(FmiVersion::Fmi2), connected(FmiVersion::Fmi2)];
    for two in two.into_iter().chain(also(FmiVersion::Fmi2)) {
        let two = two.model_description();
        let two = fmi_rs::model_description::fmi2::ModelDescription::from_string(two).expect("FMI 2.0");
        let problems = two.validate();
        assert!(problems.is_empty(), "{problems:?}");
    }
    let three = [fmu(FmiVersion::Fmi3), settable(FmiVersion::Fmi3), connected(FmiVersion::Fmi3), of_arrays()];
    for three in three.into_iter().chain(also(FmiVersion::Fmi3)) {
        let three = three.model_description();
        let three = fmi_rs::model_description::fmi3::ModelDescription::from_string(three).expect("FMI 3.0");
        let problems = three.validate();
        assert!(problems.is_empty(), "{problems:?}");
    }
}
