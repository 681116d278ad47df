//! Tracing on hammer tests made by `tests/blind_tracing`, which shares no code with the crates.
//!
//! These need Python with numpy, scipy and pyuff, named by `ORTHOPANEL_PYTHON`; without it they say so and pass.

use crate::support::{hammer_test, made, made_with};
use orthopanel_data::MeasurementData;
use orthopanel_identify::{Tracing, Verdict, trace};

fn value(found: &Tracing, parameter: &str) -> (f64, f64) {
    let estimate = found.effects[0].parameters.iter().find(|known| known.name == parameter).unwrap().values[0];
    (estimate.value, estimate.std.unwrap())
}

/// Parameters of the effect that came first lie within three of their deviations.
fn are_told(found: &Tracing, case: &serde_json::Value, parameters: &[&str]) {
    for parameter in parameters {
        let truth = case["effects"][0]["parameters"][parameter].as_f64().unwrap();
        let (value, std) = value(found, parameter);
        assert!((value - truth).abs() < 3.0 * std, "{case}, {parameter}: {value} +- {std}, truth {truth}");
    }
}

#[test]
#[ignore = "minutes: `tests/blind_tracing/test_trace.py` traces a case of each kind; `cargo test --release -- --ignored` runs these too"]
fn val_an_effect_put_in_is_named_and_measured() {
    for (kind, parameter) in
        [("sensor-mass", "mass"), ("record-gain", "gain"), ("channel-delay", "delay"), ("cubic-stiffness", "k3")]
    {
        let folder = tempfile::tempdir().unwrap();
        let Some((test, case)) = made(&folder.path().join("set"), "clean", kind) else { return };
        let found = trace(&test).unwrap();
        assert!(matches!(found.verdict, Verdict::Explained | Verdict::Ambiguous), "{kind}: {}", found.verdict.name());
        assert_eq!(found.effects[0].id, kind);
        let truth = case["effects"][0]["parameters"][parameter].as_f64().unwrap();
        let (value, std) = value(&found, parameter);
        assert!((value - truth).abs() < 3.0 * std, "{kind}: {value} +- {std}, truth {truth}");
        // Thousands of lines above their noise know a gain to 1e-6. No model is trusted to more than 3e-4 at any of ten modes.
        assert!(kind != "record-gain" || std > 5e-5, "{kind}: {std}");
        // A motion that is trusted to no more tells k3 to twice that.
        assert!(kind != "cubic-stiffness" || std > 5e-4 * value, "{kind}: {std}");
        assert!(found.error.after.held_out < 1.2 * found.error.noise_floor, "{kind}: {:?}", found.error);
        // What depends on the strength of a hit shows in harder hits, and nothing else does.
        let harder = "hit 2 times as hard, at the same places";
        assert_eq!(found.next_experiment.contains(harder), kind == "cubic-stiffness", "{}", found.next_experiment);
    }
}

/// The constants fitted with ideal clamps are no start for clamps that yield: seed 1101 was `unexplained` before the search began from
/// the resonances, and 1104 before more of these starts were followed than promised the most.
#[test]
fn val_clamps_that_yield_are_found_from_one_pair_of_places() {
    for seed in [1101, 1104] {
        let folder = tempfile::tempdir().unwrap();
        let Some((test, case)) = made_with(&folder.path().join("set"), "single-place", "support-compliance", seed)
        else {
            return;
        };
        let found = trace(&test).unwrap();
        assert_eq!((found.verdict.name(), found.effects[0].id), ("explained", "support-compliance"), "{seed}");
        are_told(&found, &case, &["rotation", "translation"]);
    }
}

/// One step ranks starts badly where an effect lies between two usual places: seed 1101 was `unexplained` before the search looked closer.
/// In 1102 the span is short and at the panel's end: that was found once short spans were among the starts.
#[test]
#[ignore = "minutes: `tests/blind_tracing/test_trace.py` traces a case of each kind; `cargo test --release -- --ignored` runs these too"]
fn val_losses_of_stiffness_between_usual_places_are_found() {
    for seed in [1101, 1102] {
        let folder = tempfile::tempdir().unwrap();
        let Some((test, case)) = made_with(&folder.path().join("set"), "clean", "stiffness-loss", seed) else { return };
        let found = trace(&test).unwrap();
        assert_eq!((found.verdict.name(), found.effects[0].id), ("explained", "stiffness-loss"), "{seed}");
        are_told(&found, &case, &["loss", "span", "x"]);
    }
}

/// A plate's modes change places with its constants: seed 1303 was `unexplained` before plates were begun from the poles, and while ten of
/// those that were followed were alike.
#[test]
#[ignore = "minutes: `tests/blind_tracing/test_trace.py` traces a case of each kind; `cargo test --release -- --ignored` runs these too"]
fn val_a_wide_plate_is_found_from_one_pair_of_places() {
    let folder = tempfile::tempdir().unwrap();
    let Some((test, _)) = made_with(&folder.path().join("set"), "single-place", "width-coupling", 1303) else {
        return;
    };
    let found = trace(&test).unwrap();
    // `explained` by lines one by one; the modes of one record leave it open whether more lacks.
    assert_eq!(found.effects[0].id, "width-coupling", "{}", found.verdict.name());
}

/// A mass at the sensor's place may be the sensor's or the panel's: that a mass of the panel lies just there is a thousand times less likely
/// beforehand.
#[test]
fn val_a_mass_at_the_sensor_is_the_sensors() {
    let folder = tempfile::tempdir().unwrap();
    let Some((test, case)) = made_with(&folder.path().join("set"), "clean", "sensor-mass", 1000) else {
        return;
    };
    let found = trace(&test).unwrap();
    assert_eq!((found.verdict, found.effects[0].id), (Verdict::Explained, "sensor-mass"));
    are_told(&found, &case, &["mass"]);
    let MeasurementData::TimeHistory(record) = &test.measurements[0].data else { panic!("hits") };
    let rival = found.candidates.iter().find(|candidate| candidate.id == "local-mass").unwrap();
    let x = rival.effects[0].parameters.iter().find(|parameter| parameter.name == "x").unwrap().values[0].value;
    assert!((x - record.response_at.x).abs() < 5e-3, "{x}");
}

/// A core that softens as it is strained more is in no catalogue.
#[test]
fn val_what_no_effect_makes_stays_unexplained() {
    let folder = tempfile::tempdir().unwrap();
    let Some((test, _)) = made_with(&folder.path().join("set"), "outside", "softening-core", 1000) else { return };
    let found = trace(&test).unwrap();
    assert_eq!(found.verdict, Verdict::Unexplained, "{:?}", found.effects);
    assert!(found.effects.is_empty() && found.alternatives.is_empty(), "{:?}", found.effects);
    // The plate of a wide panel meets all resonances but one, which is none of its modes.
    assert!(found.next_experiment.contains(" Hz is no mode of this model"), "{}", found.next_experiment);
    // No place or mass parts what does not fit: what may be wrong is to be looked at.
    assert!(found.next_experiment.contains("check the sizes and their units"), "{}", found.next_experiment);
}

/// The search for a plate spent what its partners may cost, creeping along a floor that only the gain lowers: this was `unexplained`.
#[test]
#[ignore = "minutes: `tests/blind_tracing/test_trace.py` traces a case of each kind; `cargo test --release -- --ignored` runs these too"]
fn val_a_gain_beside_a_plate_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let kind = "width-coupling + gain";
    let Some((test, case)) = made_with(&folder.path().join("set"), "pairs", kind, 1200) else { return };
    let found = trace(&test).unwrap();
    let named: Vec<&str> = found.effects.iter().map(|effect| effect.id).collect();
    assert_eq!((found.verdict.name(), &named[..]), ("explained", &["width-coupling", "gain"][..]));
    let truth = case["effects"][1]["parameters"]["gain"].as_f64().unwrap();
    let gain = found.effects[1].parameters[0].values[0];
    assert!((gain.value - truth).abs() < 3.0 * gain.std.unwrap(), "{gain:?}, {truth}");
}

/// Starts of a core whose stiffening and loss were in the base already promised nothing: this was `unexplained` before they gave it back.
#[test]
#[ignore = "minutes: `tests/blind_tracing/test_trace.py` traces a case of each kind; `cargo test --release -- --ignored` runs these too"]
fn val_a_core_beside_a_delay_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let kind = "viscoelastic-core + channel-delay";
    let Some((test, case)) = made_with(&folder.path().join("set"), "pairs", kind, 1701) else { return };
    let found = trace(&test).unwrap();
    let named: Vec<&str> = found.effects.iter().map(|effect| effect.id).collect();
    assert_eq!((found.verdict.name(), &named[..]), ("explained", &["channel-delay", "viscoelastic-core"][..]));
    for (effect, parameter) in [(0, "strength"), (0, "tau"), (0, "alpha"), (1, "delay")] {
        let truth = case["effects"][effect]["parameters"][parameter].as_f64().unwrap();
        let parameters = found.effects.iter().flat_map(|effect| &effect.parameters);
        let told = parameters.into_iter().find(|told| told.name == parameter).unwrap();
        let (value, std) = (told.values[0].value, told.values[0].std.unwrap());
        assert!((value - truth).abs() < 3.0 * std, "{parameter}: {value} +- {std}, truth {truth}");
        // A delay moves the phase of every line: it is told to a thousandth beside a core whose numbers hardly part.
        assert!(parameter != "delay" || std < 1e-3 * truth, "{std}");
    }
}

#[test]
fn val_nothing_is_missing_where_nothing_was_put_in() {
    let folder = tempfile::tempdir().unwrap();
    let Some((test, _)) = made(&folder.path().join("set"), "none", "none") else { return };
    let found = trace(&test).unwrap();
    assert_eq!((found.verdict, found.effects.len()), (Verdict::NothingMissing, 0));
    assert_eq!(found.error.before, found.error.after);
    let json = serde_json::to_value(&found).unwrap();
    assert_eq!((&json["schema"], &json["verdict"]), (&"orthopanel.trace/2".into(), &"nothing-missing".into()));
    // A free piece has no clamp that could yield.
    let reason = found.not_tested.iter().find(|known| known.id == "support-compliance").unwrap();
    assert!(reason.reason.contains("clamped"), "{}", reason.reason);
}

/// Noise of 0.1 %, and a hammer behind the sensor: a record that was left out was missed by 1.23 of the noise before modes above the
/// sum were damped and the force's noise counted once for the lines that it moves alike.
#[test]
fn val_a_record_that_was_left_out_is_foretold_within_little_noise() {
    let folder = tempfile::tempdir().unwrap();
    let Some((test, case)) = made_with(&folder.path().join("set"), "none", "none", 1105) else { return };
    assert!(case["noise"]["part"].as_f64().unwrap() < 1.1e-3, "{}", case["noise"]);
    let found = trace(&test).unwrap();
    assert_eq!(found.verdict, Verdict::NothingMissing);
    assert!(found.error.after.held_out < 1.05 * found.error.noise_floor, "{:?}", found.error);
}

/// A second touch and an overload would look like a gain, and like damping.
#[test]
fn val_hits_that_are_left_out_are_left_out_of_the_trace() {
    let folder = tempfile::tempdir().unwrap();
    let Some(test) = hammer_test(&folder.path().join("set"), &["--double-hit", "2", "--overload", "4"]) else { return };
    let found = trace(&test).unwrap();
    assert_eq!(found.verdict, Verdict::NothingMissing, "{:?}", found.error);
    assert!(found.error.after.fitted < 1.1 * found.error.noise_floor.max(1.0), "{:?}", found.error);
    for hit in ["hit 2 ", "hit 4 "] {
        let told = |note: &String| note.contains(hit) && note.contains("left out");
        assert!(found.notes.iter().any(told), "{hit}: {:?}", found.notes);
    }
}

/// One hit at one place: nothing is missing, and how hits differ is not seen.
#[test]
fn a_single_hit_at_a_single_place_says_what_it_does_not_show() {
    let folder = tempfile::tempdir().unwrap();
    let Some(test) = hammer_test(&folder.path().join("set"), &["--hits", "1"]) else { return };
    let found = trace(&test).unwrap();
    assert_eq!(test.measurements.len(), 1);
    assert_eq!(found.verdict, Verdict::NothingMissing, "{:?}", found.effects);
    let said =
        |note: &String| note.contains("how hits differ is not seen") && note.contains("Hit each place three times");
    assert!(found.notes.iter().any(said), "{:?}", found.notes);
}

/// The gain of the only record is the gain.
#[test]
fn val_the_gain_of_a_single_record_has_one_name() {
    let folder = tempfile::tempdir().unwrap();
    let Some((test, case)) = made(&folder.path().join("set"), "single-place", "gain") else { return };
    let found = trace(&test).unwrap();
    assert_eq!(found.effects[0].id, "gain", "{:?}", found.alternatives);
    are_told(&found, &case, &["gain"]);
    let reason = found.not_tested.iter().find(|known| known.id == "record-gain").unwrap();
    assert!(reason.reason.contains("no other to differ from"), "{}", reason.reason);
}
