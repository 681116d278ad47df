//! Tracing on rough hammer tests made by `tests/blind_tracing`: hits 0.7 mm off, gains 0.3 % off, a core 0.5 % uneven.
//!
//! These need Python with numpy, scipy and pyuff, named by `ORTHOPANEL_PYTHON`; without it they say so and pass.

use crate::support::{made, made_with};
use orthopanel_identify::{Verdict, trace};

/// No name that the scatter of hits, gains and a core would wear.
#[test]
fn val_a_rough_test_lacks_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let Some((test, _)) = made(&folder.path().join("set"), "rough-none", "none") else { return };
    let found = trace(&test).unwrap();
    assert_eq!((found.verdict, found.effects.len()), (Verdict::NothingMissing, 0), "{:?}", found.effects);
    // What the hits share is no part of the panel.
    assert!(found.panels[0].effects.is_empty() && found.removed.is_empty(), "{:?}", found.removed);
}

#[test]
fn val_an_effect_is_found_beside_roughness() {
    for (kind, parameter) in [("suspension", "stiffness"), ("local-mass", "x")] {
        let folder = tempfile::tempdir().unwrap();
        let Some((test, case)) = made(&folder.path().join("set"), "rough", kind) else { return };
        let found = trace(&test).unwrap();
        assert!(matches!(found.verdict, Verdict::Explained | Verdict::Ambiguous), "{kind}: {}", found.verdict.name());
        assert_eq!(found.effects[0].id, kind);
        let truth = case["effects"][0]["parameters"][parameter].as_f64().unwrap();
        let known = found.effects[0].parameters.iter().find(|known| known.name == parameter).unwrap().values[0];
        let (value, std) = (known.value, known.std.unwrap());
        assert!((value - truth).abs() < 3.0 * std, "{kind}: {value} +- {std}, truth {truth}");
    }
}

/// A gain of 3.4 % of one record is as likely as gains of all that differ by 1.5 %, five times what is usual: nothing else is named for it, and its
/// number stands among the candidates.
#[test]
fn val_a_small_gain_of_one_record_is_no_roughness() {
    let folder = tempfile::tempdir().unwrap();
    let Some((test, case)) = made_with(&folder.path().join("set"), "rough", "record-gain", 1682) else { return };
    let found = trace(&test).unwrap();
    let named = found.effects.iter().all(|effect| effect.id == "record-gain");
    assert!(named && found.verdict != Verdict::Unexplained, "{:?}", found.effects);
    let candidate = found.candidates.iter().find(|candidate| candidate.id == "record-gain").unwrap();
    let truth = case["effects"][0]["parameters"]["gain"].as_f64().unwrap();
    let gain = candidate.effects[0].parameters[0].values[0];
    // The record has its own roughness of 0.3 % on top.
    assert!((gain.value / truth - 1.0).abs() < 0.01, "{gain:?}, truth {truth}");
}

/// Hits of unequal strength differ by the cube of the motion: that was taken for places beside the mark, and no rough test with such
/// springs was explained.
#[test]
fn val_a_cubic_suspension_is_found_beside_roughness() {
    let folder = tempfile::tempdir().unwrap();
    let Some((test, case)) = made_with(&folder.path().join("set"), "rough", "cubic-stiffness", 1802) else { return };
    let found = trace(&test).unwrap();
    assert_eq!((found.verdict.name(), found.effects[0].id), ("explained", "cubic-stiffness"));
    let truth = case["effects"][0]["parameters"]["k3"].as_f64().unwrap();
    let k3 = found.effects[0].parameters[0].values[0];
    assert!((k3.value - truth).abs() < 3.0 * k3.std.unwrap(), "{k3:?}, truth {truth}");
}

/// Hard springs let hard hits swing out of step with any model of them. That was taken for roughness, which this test has none of; and with
/// the modes above the band as stiff as stone, $k_3$ came out a thousandth low. The mean over such hits leaves residues further off than a sound model
/// does, so that the verdict is `unexplained`; and the deviation that is stated of $k_3$, 3e-5, is too small: it is 2e-4 off.
#[test]
fn val_swings_out_of_step_are_no_roughness() {
    let folder = tempfile::tempdir().unwrap();
    let Some((test, case)) = made_with(&folder.path().join("set"), "clean", "cubic-stiffness", 2401) else { return };
    let found = trace(&test).unwrap();
    assert_eq!(found.effects[0].id, "cubic-stiffness", "{}", found.verdict.name());
    let truth = case["effects"][0]["parameters"]["k3"].as_f64().unwrap();
    let k3 = found.effects[0].parameters[0].values[0];
    assert!((k3.value / truth - 1.0).abs() < 5e-4, "{k3:?}, truth {truth}");
}

/// Hits of unequal strength were weighed otherwise in the records than in what cubic forces take off them, and over the swings on such
/// springs a part of a per cent of the motion decides when each comes: the lines below 80 Hz were missed by ten times the noise and more.
/// Seed 2302 then left 1.9 times the noise in what was held out, and five times the interval.
#[test]
fn val_hard_springs_leave_no_more_than_noise_beside_roughness() {
    let folder = tempfile::tempdir().unwrap();
    let Some((test, case)) = made_with(&folder.path().join("set"), "rough", "cubic-stiffness", 2302) else { return };
    let found = trace(&test).unwrap();
    assert_eq!((found.verdict.name(), found.effects[0].id), ("explained", "cubic-stiffness"));
    // Modes of hits on such springs scatter by more than the noise: 1.4 of it and of the model error.
    assert!(found.error.after.held_out < 1.5 * found.error.noise_floor, "{:?}", found.error);
    let truth = case["effects"][0]["parameters"]["k3"].as_f64().unwrap();
    let k3 = found.effects[0].parameters[0].values[0];
    assert!(
        (k3.value - truth).abs() < 3.0 * k3.std.unwrap() && k3.std.unwrap() < 0.01 * truth,
        "{k3:?}, truth {truth}"
    );
}
