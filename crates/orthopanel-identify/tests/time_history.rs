//! Models driven with measured forces against measured accelerations: closed forms and laws.

use orthopanel_data::{Hit, TimeHistory};
use orthopanel_identify::{ForceBetweenSamples, HistorySettings, HitComparison, IdentifyError, compare_time_history};
use orthopanel_model::{ForceRecord, ModalModel, Mode, ModelError, Place};
use proptest::prelude::*;

const RATE: f64 = 8192.0;

/// Modes of frequency \[Hz\], damping ratio and $W(l_1)W(l_x)$.
fn model(modes: &[(f64, f64, f64)]) -> ModalModel {
    let mode = |&(frequency, damping_ratio, product): &(f64, f64, f64)| Mode {
        angular_frequency: std::f64::consts::TAU * frequency,
        damping_ratio,
        at_forces: vec![1.0],
        at_responses: vec![product],
    };
    ModalModel::new(1, 1, modes.iter().map(mode).collect()).unwrap()
}

/// A Gaussian blow of 1 N, 0.15 ms of standard deviation, after 20 ms: nothing of it is above half the rate.
fn blow(time: f64) -> f64 {
    (-0.5 * ((time - 0.02) / 1.5e-4).powi(2)).exp()
}

/// What a model does under the blow itself, by straight lines 64 times finer than the samples.
fn answer(model: &ModalModel, samples: usize) -> Hit {
    const FINER: usize = 64;
    let interval = 1.0 / (RATE * FINER as f64);
    let force = (0..(samples - 1) * FINER + 1).map(|n| blow(n as f64 * interval)).collect();
    let fine = model.acceleration_under(&ForceRecord::new(interval, vec![force]).unwrap()).unwrap();
    Hit {
        force: (0..samples).map(|n| blow(n as f64 / RATE)).collect(),
        acceleration: fine[0].iter().step_by(FINER).copied().collect(),
    }
}

fn history(hits: Vec<Hit>) -> TimeHistory {
    let place = Place { x: 0.0, y: 0.0 };
    TimeHistory::new("hits.csv", [place, place], RATE, hits)
}

fn compared(model: &ModalModel, hit: Hit, settings: &HistorySettings) -> HitComparison {
    compare_time_history(model, &history(vec![hit]), settings).unwrap().remove(0)
}

#[test]
fn val_the_model_itself_is_explained() {
    let model = model(&[(0.0, 0.0, 1.2), (320.0, 3e-3, -0.9), (1500.0, 1e-3, 0.7)]);
    let misfit = compared(&model, answer(&model, 4096), &HistorySettings::default()).whole.misfit;
    // What the straight lines of the interpolation add above half the rate is a thousandth of the force at most.
    assert!(misfit.greatest_percent_of_peak < 0.1, "{misfit:?}");
    assert!(1.0 - misfit.variance_explained < 1e-6, "{misfit:?}");
}

/// One mode alone rings at its own frequency, and straight lines make it $\mathrm{sinc}^2(f/f_s)$ as loud.
#[test]
fn val_straight_lines_lose_what_their_doc_says() {
    for parts in [8.0, 4.0] {
        let model = model(&[(RATE / parts, 1e-4, 1.0)]);
        let phase = std::f64::consts::PI / parts;
        let loss = 1.0 - (phase.sin() / phase).powi(2);
        let settings = HistorySettings { between_samples: ForceBetweenSamples::Linear, ..HistorySettings::default() };
        let misfit = compared(&model, answer(&model, 4096), &settings).whole.misfit;
        let found = (1.0 - misfit.variance_explained).sqrt();
        // The samples during the blow itself are some 10 of 4000, and not all ringing.
        assert!((found / loss - 1.0).abs() < 0.01, "an {parts}th of the rate: {found}, {loss} expected");
    }
}

#[test]
fn val_a_band_leaves_out_the_mode_that_the_model_lacks() {
    let modes = [(320.0, 3e-3, -0.9), (800.0, 3e-3, 0.5), (2500.0, 2e-3, 5.0)];
    let hit = answer(&model(&modes), 16384);
    let flexible = |&(frequency, _, product): &(f64, f64, f64)| product / (std::f64::consts::TAU * frequency).powi(2);
    let static_flexibility = Some(modes.iter().map(flexible).sum());
    let settings = HistorySettings { band: Some(0.0..=1000.0), static_flexibility, ..HistorySettings::default() };
    let found = compared(&model(&modes[..2]), hit, &settings);
    let in_band = found.in_band.unwrap();
    assert!(found.whole.misfit.variance_explained < 0.5, "{:?}", found.whole.misfit);
    // Static for dynamic leaves (1000/2500)^2 of an answer that is small between the peaks already.
    assert!(in_band.misfit.variance_explained > 0.999, "{:?}", in_band.misfit);
    assert_eq!(in_band.measured.len(), 16384);
}

/// Measured is 1.25 times calculated: a fifth of the peak, and 1 - 0.04 of the variance.
#[test]
fn val_a_wrong_gain_gives_the_numbers_of_its_closed_form() {
    let model = model(&[(320.0, 3e-3, 1.0)]);
    let mut hit = answer(&model, 2048);
    let calculated = compared(&model, hit.clone(), &HistorySettings::default()).whole.calculated;
    hit.acceleration = calculated.iter().map(|value| 1.25 * value).collect();
    let misfit = compared(&model, hit, &HistorySettings::default()).whole.misfit;
    // The mean difference, which is no part of a gain, is taken out: some 1e-3 of the peak.
    assert!((misfit.greatest_percent_of_peak - 20.0).abs() < 0.1, "{misfit:?}");
    assert!((misfit.variance_explained - 0.96).abs() < 1e-9, "{misfit:?}");
}

proptest! {
    /// Offsets of either channel change nothing, nor does a gain common to both.
    #[test]
    fn misfits_do_not_know_offsets_and_scale(force in -3.0..3.0_f64, motion in -9.0..9.0_f64, gain in 1e-3..1e3_f64) {
        let truth = model(&[(0.0, 0.0, 1.2), (320.0, 3e-3, -0.9), (1500.0, 1e-3, 0.7)]);
        let wrong = model(&[(0.0, 0.0, 1.2), (321.0, 2e-3, -0.9), (1500.0, 1e-3, 0.6)]);
        let hit = answer(&truth, 512);
        let moved = Hit {
            force: hit.force.iter().map(|value| gain * (value + force)).collect(),
            acceleration: hit.acceleration.iter().map(|value| gain * (value + motion)).collect(),
        };
        let settings = HistorySettings { band: Some(50.0..=2000.0), ..HistorySettings::default() };
        let (plain, moved) = (compared(&wrong, hit, &settings), compared(&wrong, moved, &settings));
        prop_assert!((moved.offset - gain * (plain.offset + motion)).abs() < 1e-9 * gain);
        let pairs = [(plain.whole, moved.whole), (plain.in_band.unwrap(), moved.in_band.unwrap())];
        for (plain, moved) in pairs.map(|(plain, moved)| (plain.misfit, moved.misfit)) {
            prop_assert!((plain.variance_explained - moved.variance_explained).abs() < 1e-9);
            prop_assert!((plain.rms_percent_of_peak - moved.rms_percent_of_peak).abs() < 1e-7);
            prop_assert!((plain.greatest_percent_of_peak - moved.greatest_percent_of_peak).abs() < 1e-7);
            prop_assert!((moved.peak / (gain * plain.peak) - 1.0).abs() < 1e-9);
        }
    }
}

#[test]
fn what_cannot_be_compared_is_refused_by_name() {
    let one = model(&[(320.0, 3e-3, 1.0)]);
    let good = answer(&one, 64);
    let plain = HistorySettings::default();
    let refusal = |model: &ModalModel, hit: &Hit, settings: &HistorySettings| {
        compare_time_history(model, &history(vec![hit.clone()]), settings).unwrap_err()
    };
    for band in [-1.0..=10.0, 10.0..=10.0, 20.0..=10.0, 0.0..=4096.5, f64::NAN..=10.0, 0.0..=f64::NAN] {
        let settings = HistorySettings { band: Some(band), ..plain.clone() };
        assert!(matches!(refusal(&one, &good, &settings), IdentifyError::HistoryBand { half_rate: 4096.0, .. }));
    }
    for (forces, responses) in [(2, 1), (1, 0)] {
        let refused = refusal(&ModalModel::new(forces, responses, Vec::new()).unwrap(), &good, &plain);
        let IdentifyError::HistoryPorts { forces: f, responses: r } = refused else { panic!("{refused}") };
        assert_eq!((f, r), (forces, responses));
    }
    for (force, acceleration) in [(3, 4), (0, 0), (1, 1)] {
        let short = Hit { force: vec![1.0; force], acceleration: vec![1.0; acceleration] };
        let refused = refusal(&one, &short, &plain);
        let IdentifyError::HitSamples { hit: 1, force: f, acceleration: a } = refused else { panic!("{refused}") };
        assert_eq!((f, a), (force, acceleration));
    }
    let silent = Hit { force: good.force.clone(), acceleration: vec![0.1; 64] };
    assert!(matches!(refusal(&one, &silent, &plain), IdentifyError::SilentHit { hit: 1 }));
    let above = (0..64).map(|n| if n % 2 == 0 { 3.1 } else { -2.9 }).collect();
    let below = HistorySettings { band: Some(100.0..=2000.0), ..plain.clone() };
    let out_of_band = Hit { force: vec![0.0; 64], acceleration: above };
    assert!(matches!(refusal(&one, &out_of_band, &below), IdentifyError::SilentHit { hit: 1 }));
    for channel in 0..2 {
        let mut broken = good.clone();
        [&mut broken.force, &mut broken.acceleration][channel][7] = f64::NAN;
        let refused = refusal(&one, &broken, &plain);
        assert!(matches!(refused, IdentifyError::Model(ModelError::NotFinite { .. })), "{refused}");
    }
}
