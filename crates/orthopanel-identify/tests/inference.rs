//! Inference from measured modes, against panels as real ones are: made by `tests/blind_tracing`, which shares no code with the crates.

use orthopanel_data::ImpactTest;
use orthopanel_identify::{IdentifyError, Inference, infer};
use serde_json::Value;

use crate::support::made_of;

fn made(kind: &str) -> Option<(Inference, Value)> {
    let folder = tempfile::tempdir().unwrap();
    let (test, truth) = made_of(folder.path(), "real", (kind, 20), 911)?;
    Some((infer(&test).unwrap(), truth))
}

/// Of the mean panel, whose core wanders by percents.
fn assert_constants(said: &Inference, truth: &Value) {
    for constant in &said.constants {
        let value = truth["constants"][constant.name].as_f64().unwrap();
        assert!((constant.value / value - 1.0).abs() < 0.03, "{} {} beside {value}", constant.name, constant.value);
    }
}

/// A core and faces that wander, hits beside their marks, gains and modes that are off leave the constants what they are.
#[test]
fn val_constants_of_a_real_panel_are_found() {
    let Some((said, truth)) = made("none") else { return };
    assert_constants(&said, &truth);
    // Its modes are some 1e-4 beside any model's.
    assert!((1e-5..1e-3).contains(&said.frequency_error), "{}", said.frequency_error);
}

#[test]
fn val_a_resonator_on_a_real_panel_is_found() {
    let Some((said, truth)) = made("resonator") else { return };
    assert_constants(&said, &truth);
    let resonator = said.effects.iter().find(|effect| effect.id == "resonator").unwrap();
    for (name, within) in [("mass", 2e-3), ("frequency", 5.0), ("x", 5e-3)] {
        let value = truth["effects"][0]["parameters"][name].as_f64().unwrap();
        let found = resonator.parameters.iter().find(|parameter| parameter.name == name).unwrap().value;
        assert!((found - value).abs() < within, "{name}: {found} beside {value}");
    }
}

/// The core's three numbers are those that it was made with, by modes that share no code with the crates'.
#[test]
fn val_a_core_that_relaxes_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let Some((test, truth)) = made_of(folder.path(), "clean", ("viscoelastic-core", 5), 71) else { return };
    let said = infer(&test).unwrap();
    assert_constants(&said, &truth);
    let core = said.effects.iter().find(|effect| effect.id == "viscoelastic-core").unwrap();
    for (parameter, within) in core.parameters.iter().zip([0.2, 0.4, 0.1]) {
        let value = truth["effects"][0]["parameters"][parameter.name].as_f64().unwrap();
        assert!(
            (parameter.value / value - 1.0).abs() < within,
            "{} {} beside {value}",
            parameter.name,
            parameter.value
        );
    }
}

/// Springs whose force goes with the cube of the motion differ from hit to hit, and leave the modes as they are.
#[test]
fn val_a_cubic_suspension_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let Some((test, truth)) = made_of(folder.path(), "clean", ("cubic-stiffness", 5), 71) else { return };
    let said = infer(&test).unwrap();
    assert_constants(&said, &truth);
    let springs = said.effects.iter().find(|effect| effect.id == "cubic-stiffness").unwrap();
    let value = truth["effects"][0]["parameters"]["k3"].as_f64().unwrap();
    assert!((springs.parameters[0].value / value - 1.0).abs() < 0.02, "{:?} beside {value}", springs.parameters);
}

/// A strip so wide that it bends across and twists: all constants of the plate, by records along its centre line.
#[test]
#[ignore = "a minute and a half; all such run by `cargo test --release -- --ignored`"]
fn val_a_plate_in_the_place_of_the_beam_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let Some((test, truth)) = made_of(folder.path(), "clean", ("width-coupling", 5), 71) else { return };
    let said = infer(&test).unwrap();
    assert_constants(&said, &truth);
    let plate = said.effects.iter().find(|effect| effect.id == "width-coupling").unwrap();
    let constant = |name: &str| truth["constants"][name].as_f64().unwrap();
    let across = |name: &str| truth["across"][name].as_f64().unwrap();
    let ratios = [
        across("e_y") / constant("e_x"),
        across("nu_xy"),
        across("g_xy") / constant("e_x"),
        across("g_yz") / constant("g_zx"),
    ];
    for (parameter, value) in plate.parameters.iter().zip(ratios) {
        assert!((parameter.value / value - 1.0).abs() < 0.01, "{} {} beside {value}", parameter.name, parameter.value);
    }
}

#[test]
fn lists_are_refused_with_the_way_out() {
    let text = "[piece]\nlength = 0.8\nwidth = 0.1\nthickness = 0.03\nmass_per_area = 6.88\n\
                [[measurement]]\nkind = \"natural-frequencies\"\nvalues = [321.3, 837.5, 1520.0]\n";
    let refused = infer(&ImpactTest::from_toml(text, "test.toml").unwrap()).unwrap_err();
    assert!(matches!(refused, IdentifyError::Unsupported(_)), "{refused}");
    assert!(refused.to_string().contains("`trace`"), "{refused}");
}
