//! What the parameters of a test's roughness mean: no effect of the catalogue, but beside any of them.

use std::f64::consts::{PI, TAU};

use crate::effects_bench::{Bench, CONSTANTS, PIECE};
use num_complex::Complex64;
use orthopanel_model::{
    BeamTerms, Boundary, CORE_WAVES, EffectState, ModelError, ShearLoss, TimoshenkoBeam, catalogue, ritz_modes,
    roughness,
};

const LINES: [f64; 3] = [50.0, 600.0, 2222.0];

/// One record's offset and gain, and the first waves of its core; the others are none.
fn rough(offset: f64, gain: f64, waves: &[f64]) -> Result<EffectState, ModelError> {
    let mut values = vec![0.0; 2 + CORE_WAVES];
    (values[0], values[1]) = (offset, gain);
    values[2..2 + waves.len()].copy_from_slice(waves);
    EffectState::new(roughness(), values, 1)
}

fn at_lines(test: impl Fn(Complex64)) {
    LINES.iter().for_each(|line| test(Complex64::new(10.0, TAU * line)));
}

#[test]
fn val_none_is_the_even_panel() {
    at_lines(|s| {
        let (found, expected) =
            (Bench::panel().accelerance_with(&[rough(0.0, 1.0, &[]).unwrap()], s), Bench::panel().accelerance(&[], s));
        assert!((found / expected - 1.0).norm() < 1e-5, "{s}: {found} {expected}");
    });
}

/// The blow fell there, and not at the place that is written down.
#[test]
fn val_an_offset_is_another_place_of_the_force() {
    let moved = Bench { force: Bench::panel().force + 4e-3, ..Bench::panel() };
    at_lines(|s| {
        let found = Bench::panel().accelerance_with(&[rough(4e-3, 1.0, &[]).unwrap()], s);
        let expected = moved.accelerance_with(&[rough(0.0, 1.0, &[]).unwrap()], s);
        assert!((found / expected - 1.0).norm() < 1e-9, "{s}: {found} {expected}");
        let even = Bench::panel().accelerance(&[], s);
        assert!((found / even - 1.0).norm() > 1e-3, "{s}: 4 mm must show");
    });
}

#[test]
fn val_a_gain_multiplies_what_is_read() {
    at_lines(|s| {
        let found = Bench::panel().accelerance_with(&[rough(0.0, 1.01, &[]).unwrap()], s);
        let even = Bench::panel().accelerance_with(&[rough(0.0, 1.0, &[]).unwrap()], s);
        assert!((found / even - 1.01).norm() < 1e-12, "{s}: {found} {even}");
    });
}

/// The Fourier series of a span that has lost stiffness: its mean is a softer core, the rest are waves. Of six modes none feels the
/// waves beyond the fortieth, but for their square.
#[test]
fn val_a_span_that_is_softer_is_a_row_of_waves() {
    let loss = ShearLoss { loss: 0.01, span: 0.25, at: 0.07 };
    let frequencies = |constants: [f64; 2], terms: BeamTerms| -> Vec<f64> {
        let beam = TimoshenkoBeam::with_terms(&PIECE, Boundary::FREE, 60, terms).unwrap();
        let modes = ritz_modes(&beam, &constants, 8).unwrap();
        modes.iter().map(|mode| mode.angular_frequency).filter(|omega| *omega > 1.0).take(6).collect()
    };
    let mean = 1.0 - loss.loss * loss.span / PIECE.length;
    let edges = [-0.5, 0.5].map(|side| (loss.at + side * loss.span) / PIECE.length + 0.5);
    let wave = |number: usize| {
        let turns = number as f64 * PI;
        let [low, high] = edges.map(|edge| (turns * edge).sin());
        -loss.loss * 2.0 / turns * (high - low) / mean
    };
    let softer = [CONSTANTS[0], mean * CONSTANTS[1]];
    let even = frequencies(softer, BeamTerms::default());
    let wavy = frequencies(softer, BeamTerms { core_waves: (1..=40).map(wave).collect(), ..BeamTerms::default() });
    let span = frequencies(CONSTANTS, BeamTerms { losses: vec![loss], ..BeamTerms::default() });
    let most = span.iter().zip(&even).map(|(span, even)| (span / even - 1.0).abs()).fold(0.0, f64::max);
    assert!(most > 2e-5, "a span must show beyond its mean: {most:e}");
    for ((wavy, span), even) in wavy.iter().zip(&span).zip(&even) {
        let [of_waves, of_span] = [wavy / even - 1.0, span / even - 1.0];
        assert!((of_waves - of_span).abs() < 0.02 * most, "{of_waves:e} {of_span:e}");
    }
}

/// It has no name to be found by: every hypothesis has it, or none.
#[test]
fn roughness_is_in_no_catalogue() {
    assert!(catalogue().iter().all(|effect| effect.id() != roughness().id()));
}

#[test]
fn more_than_any_core_has_is_refused() {
    let check = |wave: f64| roughness().check(&rough(0.0, 1.0, &[wave]).unwrap().values, &PIECE);
    assert!(check(0.01).is_ok());
    let error = check(0.5).unwrap_err();
    assert!(matches!(error, ModelError::EffectParameter { name: "wave", value: 0.5, .. }), "{error:?}");
}
