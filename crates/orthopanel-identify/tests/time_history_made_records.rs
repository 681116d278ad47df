//! Section 3.5's comparison on hammer records whose truth is known, made by tests/record_generator.

use std::path::Path;

use orthopanel_data::{ImpactTest, MeasurementData, TimeHistory};
use orthopanel_identify::{HistorySettings, compare_time_history};
use orthopanel_model::{Boundary, ModalModel, ModeRange, PanelModel, StaticFlexibility};

/// A folder of made records and its truth; prints why and returns `None` where there is no Python for it.
fn made_records(folder: &Path, arguments: &[&str]) -> Option<serde_json::Value> {
    crate::support::hammer_test(folder, arguments)?;
    Some(serde_json::from_str(&std::fs::read_to_string(folder.join("truth.json")).unwrap()).unwrap())
}

/// The records of a test and the true model at their places, with flexible modes up to `up_to` Hz.
fn records_and_model(folder: &Path, truth: &serde_json::Value, up_to: f64) -> Vec<(TimeHistory, ModalModel)> {
    let test = ImpactTest::read(folder.join("test.toml")).unwrap();
    let piece = serde_json::to_value(test.pieces[0].piece).unwrap();
    let constants = serde_json::json!({"e_x": truth["constants"]["e_x"], "g_zx": truth["constants"]["g_zx"]});
    let ratios: Vec<&serde_json::Value> = truth["modes"].as_array().unwrap().iter().map(|mode| &mode["zeta"]).collect();
    // The truth lists the modes below half the sampling rate; those above are damped like the last of them.
    let text = serde_json::json!({
        "schema": "orthopanel.model/1", "piece": piece, "structure": "timoshenko-beam", "constants": constants,
        "damping": {"ratios": ratios, "beyond": ratios.last()},
    });
    let panel = PanelModel::from_json(&text.to_string()).unwrap();
    let pair = |data: &MeasurementData| {
        let MeasurementData::TimeHistory(measurement) = data else { panic!("another kind") };
        let places = [measurement.force_at, measurement.response_at];
        let model = panel.modal_model(ModeRange::UpTo(up_to), &places[..1], &places[1..]).unwrap();
        (TimeHistory::read(measurement).unwrap(), model)
    };
    test.measurements.iter().map(|measurement| pair(&measurement.data)).collect()
}

/// Variance of the error that noise alone makes: that of the acceleration's channel, and what the force's white noise
/// moves through the model.
fn noise_floor(model: &ModalModel, rate: f64, facts: &serde_json::Value) -> f64 {
    let [force, acceleration] = ["force_noise", "acceleration_noise"].map(|name| facts[name].as_f64().unwrap());
    // Fine enough for the narrowest peak, 1.5 Hz wide.
    let lines = 40_000;
    let power = |k: i32| model.accelerance(0, 0, (f64::from(k) + 0.5) / f64::from(lines) * 0.5 * rate).norm_sqr();
    acceleration.powi(2) + force.powi(2) * (0..lines).map(power).sum::<f64>() / f64::from(lines)
}

/// Static flexibility of all flexible modes between the places of a record.
fn static_flexibility(folder: &Path, truth: &serde_json::Value, history: &TimeHistory) -> f64 {
    let piece = ImpactTest::read(folder.join("test.toml")).unwrap().pieces[0].piece;
    let [e_x, g_zx] = ["e_x", "g_zx"].map(|name| truth["constants"][name].as_f64().unwrap());
    let all = StaticFlexibility::new(&piece, Boundary::FREE).unwrap();
    all.between(history.force_at.x, history.response_at.x, e_x, g_zx).0
}

/// At the paper's places the error is the noise, no more.
#[test]
fn val_made_records_are_explained_to_their_noise() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path().join("records");
    let arguments = ["--hits", "3", "--samples", "16384", "--noise", "0.003", "--seed", "11"];
    let Some(truth) = made_records(&folder, &arguments) else { return };
    let records = records_and_model(&folder, &truth, 4.0 * 8192.0);
    let facts = truth["points"][0]["hits"].as_array().unwrap();
    for ((history, model), facts) in records.iter().zip(facts) {
        let whole = compare_time_history(model, history, &HistorySettings::default()).unwrap().remove(0).whole;
        let variance = whole.measured.iter().map(|value| value * value).sum::<f64>() / whole.measured.len() as f64;
        let error = (1.0 - whole.misfit.variance_explained) * variance;
        let ratio = error / noise_floor(model, history.rate, facts);
        // Half of the noise comes through the force and rings in peaks a few Hz wide: one second of it is some hundred
        // independent numbers.
        assert!((0.85..1.15).contains(&ratio), "variance of the error over that of the noise: {ratio}");
        assert!(whole.misfit.variance_explained > 0.9999, "{:?}", whole.misfit);
    }
}

/// Records without noise, where the modes left out are all that is left: at places apart, and at the force's own.
#[test]
fn val_truncation_leaves_what_the_doc_says() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path().join("records");
    let places = ["--pair", "-0.3", "0.3", "--pair", "0.13", "0.3", "--pair", "0.3", "0.3"];
    let arguments = ["--hits", "1", "--samples", "16384", "--noise", "0"];
    let Some(truth) = made_records(&folder, &[&places[..], &arguments].concat()) else { return };
    let unexplained = |up_to: f64, with_static: bool| -> Vec<f64> {
        let records = records_and_model(&folder, &truth, up_to);
        let left = |(history, model): &(TimeHistory, ModalModel)| {
            let all = with_static.then(|| static_flexibility(&folder, &truth, history));
            let settings = HistorySettings { static_flexibility: all, ..HistorySettings::default() };
            let hit = compare_time_history(model, history, &settings).unwrap().remove(0);
            1.0 - hit.whole.misfit.variance_explained
        };
        records.iter().map(left).collect()
    };
    let half_rate = 8192.0;
    let modes_alone = unexplained(4.0 * half_rate, false);
    assert!(modes_alone[..2].iter().all(|&left| left < 1e-6), "places apart: {modes_alone:?}");
    assert!((1e-4..1e-3).contains(&modes_alone[2]), "one place: {modes_alone:?}");
    let with_static = unexplained(2.0 * half_rate, true);
    assert!(with_static.iter().all(|&left| left < 1e-5), "{with_static:?}");
}
