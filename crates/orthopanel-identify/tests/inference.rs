//! Inference from measured modes, against panels as real ones are: made by `tests/blind_tracing`, which shares no code with the crates.

use orthopanel_identify::{TracedEffect, Tracing, trace};
use serde_json::Value;

use crate::support::made_of;

fn made(kind: &str) -> Option<(Tracing, Value)> {
    let folder = tempfile::tempdir().unwrap();
    let (test, truth) = made_of(folder.path(), "real", (kind, 20), 911)?;
    Some((trace(&test).unwrap(), truth))
}

/// Of the mean panel, whose core wanders by percents.
fn assert_constants(said: &Tracing, truth: &Value) {
    for name in ["e_x", "g_zx"] {
        let (value, found) = (truth["constants"][name].as_f64().unwrap(), said.panels[0].constants[name].value);
        assert!((found / value - 1.0).abs() < 0.03, "{name} {found} beside {value}");
    }
}

fn effect<'a>(said: &'a Tracing, id: &str) -> &'a TracedEffect {
    said.effects.iter().find(|effect| effect.id == id).unwrap_or_else(|| panic!("{:?}", said.effects))
}

fn value(effect: &TracedEffect, name: &str) -> f64 {
    effect.parameters.iter().find(|parameter| parameter.name == name).unwrap().values[0].value
}

/// A core and faces that wander, hits beside their marks, gains and modes that are off leave the constants what they are.
#[test]
fn val_constants_of_a_real_panel_are_found() {
    let Some((said, truth)) = made("none") else { return };
    assert_constants(&said, &truth);
    // Its modes are some 1e-4 beside any model's.
    let missed = said.model_error.unwrap().frequency;
    assert!((1e-5..1e-3).contains(&missed), "{missed}");
}

#[test]
fn val_a_resonator_on_a_real_panel_is_found() {
    let Some((said, truth)) = made("resonator") else { return };
    assert_constants(&said, &truth);
    let resonator = effect(&said, "resonator");
    for (name, within) in [("mass", 2e-3), ("frequency", 5.0), ("x", 5e-3)] {
        let put_in = truth["effects"][0]["parameters"][name].as_f64().unwrap();
        let found = value(resonator, name);
        assert!((found - put_in).abs() < within, "{name}: {found} beside {put_in}");
    }
}

/// The core's three numbers are those that it was made with, by modes that share no code with the crates'.
#[test]
fn val_a_core_that_relaxes_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let Some((test, truth)) = made_of(folder.path(), "clean", ("viscoelastic-core", 5), 71) else { return };
    let said = trace(&test).unwrap();
    assert_constants(&said, &truth);
    let core = effect(&said, "viscoelastic-core");
    for (parameter, within) in core.parameters.iter().zip([0.2, 0.4, 0.1]) {
        let put_in = truth["effects"][0]["parameters"][parameter.name].as_f64().unwrap();
        let found = parameter.values[0].value;
        assert!((found / put_in - 1.0).abs() < within, "{} {found} beside {put_in}", parameter.name);
    }
}

/// Springs whose force goes with the cube of the motion differ from hit to hit, and leave the modes as they are.
#[test]
fn val_a_cubic_suspension_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let Some((test, truth)) = made_of(folder.path(), "clean", ("cubic-stiffness", 5), 71) else { return };
    let said = trace(&test).unwrap();
    // A core that relaxes by 4 % is named beside the springs: G_zx, its modulus at rest then, is as much too low.
    for (name, within) in [("e_x", 0.03), ("g_zx", 0.05)] {
        let (wanted, found) = (truth["constants"][name].as_f64().unwrap(), said.panels[0].constants[name].value);
        assert!((found / wanted - 1.0).abs() < within, "{name} {found} beside {wanted}");
    }
    let springs = effect(&said, "cubic-stiffness");
    let put_in = truth["effects"][0]["parameters"]["k3"].as_f64().unwrap();
    // The linear springs that the mean over hits shows are no effect of their own.
    assert!(said.effects.iter().all(|effect| effect.id != "suspension"), "{:?}", said.effects);
    // Their dashpot is called a high-pass here, and the hits are held against a panel behind it.
    assert!((value(springs, "k3") / put_in - 1.0).abs() < 0.05, "{springs:?} beside {put_in}");
}

/// A strip so wide that it bends across and twists: all constants of the plate, by records along its centre line.
#[test]
#[ignore = "a minute and a half; all such run by `cargo test --release -- --ignored`"]
fn val_a_plate_in_the_place_of_the_beam_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let Some((test, truth)) = made_of(folder.path(), "clean", ("width-coupling", 5), 71) else { return };
    let said = trace(&test).unwrap();
    assert_constants(&said, &truth);
    let plate = effect(&said, "width-coupling");
    let constant = |name: &str| truth["constants"][name].as_f64().unwrap();
    let across = |name: &str| truth["across"][name].as_f64().unwrap();
    let ratios = [
        across("e_y") / constant("e_x"),
        across("nu_xy"),
        across("g_xy") / constant("e_x"),
        across("g_yz") / constant("g_zx"),
    ];
    for (parameter, put_in) in plate.parameters.iter().zip(ratios) {
        let found = parameter.values[0].value;
        assert!((found / put_in - 1.0).abs() < 0.01, "{} {found} beside {put_in}", parameter.name);
    }
}
