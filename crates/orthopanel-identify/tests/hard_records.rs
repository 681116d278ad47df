//! Records from which few poles can be told, or wrong ones: much damping, resonances at the band's end, crowds of them,
//! low ones not measured. The accelerances come from `tests/record_generator`, whose physics is its own.
//!
//! These need Python with numpy and scipy, named by `ORTHOPANEL_PYTHON`; without it they say so and pass.

use std::path::Path;
use std::process::Command;

use orthopanel_data::ImpactTest;
use orthopanel_identify::{Identification, Settings, identify};

const E_X: f64 = 1.067e10;

/// Writes one accelerance with noise, even and in proportion, as a coherence tells it. Arguments: file, length, `g_zx`,
/// every mode's damping ratio, places of force and response, band, noise, seed, and how
/// far the modes lie beside those of the model at random.
const MAKE: &str = "
import dataclasses
import sys
import numpy as np
from record_generator import beam
length, g_zx, zeta, force, response, low, high, noise, seed, astray = map(float, sys.argv[2:])
modes = beam.solve(beam.Panel(length=length, g_zx=g_zx), sorted((force, response)), 4.0 * high)
random = np.random.default_rng(int(seed))
shifted = modes.frequency * (1.0 + astray * random.uniform(-1.0, 1.0, len(modes.frequency)))
modes = dataclasses.replace(modes, frequency=shifted)
frequency = np.arange(low, high + 0.5, 1.0)
clean = beam.accelerance(modes, beam.damping(modes, (), zeta), force, response, frequency)
variance = noise**2 * (np.median(abs(clean)) ** 2 + 0.1 * abs(clean) ** 2)
spread = np.sqrt(variance / 2.0)
noisy = clean + spread * (random.standard_normal(len(clean)) + 1j * random.standard_normal(len(clean)))
coherence = abs(noisy) ** 2 / (abs(noisy) ** 2 + variance)
table = np.c_[frequency, noisy.real, noisy.imag, coherence]
np.savetxt(sys.argv[1], table, '%.15g', ',', header='frequency_hz,real,imag,coherence', comments='')
";

struct Case {
    name: &'static str,
    length: f64,
    g_zx: f64,
    zeta: f64,
    places: [f64; 2],
    band: [f64; 2],
    /// Part of the frequency by which modes lie beside those of the model, at most.
    astray: f64,
}

/// What an identification finds; `None` where there is no Python.
fn found(case: &Case, noise: f64, seed: u32) -> Option<Identification> {
    let Some(python) = std::env::var_os("ORTHOPANEL_PYTHON") else {
        println!("skipped: ORTHOPANEL_PYTHON names no Python with numpy and scipy");
        return None;
    };
    let folder = tempfile::tempdir().unwrap();
    let Case { length, places: [force, response], .. } = *case;
    let [low, high] = case.band;
    let numbers = [length, case.g_zx, case.zeta, force, response, low, high, noise, f64::from(seed), case.astray];
    let output = Command::new(python)
        .current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests"))
        .args(["-c", MAKE])
        .arg(folder.path().join("noisy.csv"))
        .args(numbers.map(|number| number.to_string()))
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = format!(
        "[piece]\nlength = {length}\nwidth = 0.1\nthickness = 0.03\nmass_per_area = 6.880\n[[measurement]]\n\
         kind = \"accelerance\"\nfile = \"noisy.csv\"\nforce_at = [{force}, 0.0]\nresponse_at = [{response}, 0.0]\n"
    );
    let test = ImpactTest::from_toml(&text, folder.path().join("test.toml")).unwrap();
    let found = identify(&test, Settings::default());
    Some(found.unwrap_or_else(|refused| panic!("{}, noise {noise}, seed {seed}: {refused}", case.name)))
}

/// The figures: E within 0.1 %, G within 0.3 %, damping of one place within 3 %; and what is left is the noise.
fn assert_truth(case: &Case) {
    for (noise, seed) in [(0.001, 1), (0.01, 2)] {
        let Some(found) = found(case, noise, seed) else { return };
        let named = format!("{}, noise {noise}", case.name);
        for ((constant, truth), within) in found.constants.iter().zip([E_X, case.g_zx]).zip([1e-3, 3e-3]) {
            assert!((constant.value / truth - 1.0).abs() < within, "{named}: {} = {:e}", constant.name, constant.value);
        }
        let chi_square = found.chi_square.unwrap();
        assert!(chi_square < 2.0, "{named}: chi-square {chi_square}");
        for mode in found.pieces[0].modes.iter().filter(|mode| mode.measured > case.band[0]) {
            let Some(zeta) = mode.damping else { continue };
            assert!((zeta.value / case.zeta - 1.0).abs() < 0.03, "{named}: mode {}: {}", mode.mode, zeta.value);
        }
        let fit = &found.pieces[0];
        for mode in (1..=fit.damping.len()).filter(|mode| fit.modes.iter().all(|listed| listed.mode != *mode)) {
            let hidden = fit.hidden.iter().find(|hidden| hidden.mode == mode);
            let hidden = hidden.unwrap_or_else(|| panic!("{named}: mode {mode} is nowhere"));
            let Some(zeta) = hidden.damping.filter(|_| hidden.model > case.band[0]) else { continue };
            let within = f64::max(0.03, 3.0 * zeta.std.unwrap() / case.zeta);
            assert!((zeta.value / case.zeta - 1.0).abs() < within, "{named}: mode {mode}: {zeta:?}");
        }
    }
}

const USUAL: Case =
    Case { name: "", length: 0.8, g_zx: 5.304e8, zeta: 0.003, places: [-0.3, 0.3], band: [10.0, 5000.0], astray: 0.0 };

#[test]
fn val_much_damping_away_from_the_ends() {
    assert_truth(&Case { name: "damping 3 %", zeta: 0.03, places: [-0.1, 0.25], ..USUAL });
    assert_truth(&Case { name: "damping 3 %, elsewhere", zeta: 0.03, places: [-0.21, 0.13], ..USUAL });
}

/// Mode 4 of 0.3 m lies at 8989 Hz.
#[test]
fn val_a_resonance_at_the_end_of_the_band() {
    let short = Case { length: 0.3, band: [10.0, 9000.0], ..USUAL };
    assert_truth(&Case { name: "short piece", places: [-0.11, 0.05], ..short });
    assert_truth(&Case { name: "short piece, ends", places: [-0.15, 0.15], ..short });
}

#[test]
fn val_low_modes_that_were_not_measured() {
    assert_truth(&Case { name: "from 1800 Hz", band: [1800.0, 5000.0], ..USUAL });
    assert_truth(&Case { name: "from 2200 Hz", band: [2200.0, 5000.0], ..USUAL });
}

/// So soft in shear that the modes stand a spacing apart, and overlap.
#[test]
fn val_a_crowd_of_modes() {
    assert_truth(&Case { name: "E/G = 500", g_zx: E_X / 500.0, band: [1000.0, 5000.0], zeta: 0.006, ..USUAL });
}

/// No panel's modes lie where the model says: damping then comes from the resonances, crowded ones fitted together. Each
/// by itself misses by up to its own size.
#[test]
fn val_damping_of_a_crowd_that_the_model_does_not_meet() {
    let case = Case { name: "astray", g_zx: E_X / 300.0, zeta: 0.004, astray: 0.005, ..USUAL };
    for (noise, seed) in [(0.001, 1), (0.01, 2)] {
        let Some(found) = found(&case, noise, seed) else { return };
        let told: Vec<(f64, f64)> = found.pieces[0]
            .modes
            .iter()
            .filter_map(|mode| mode.damping)
            .filter_map(|zeta| Some((zeta.value / case.zeta - 1.0, zeta.std? / case.zeta)))
            .collect();
        assert!(told.len() > 15, "noise {noise}: {}", told.len());
        // A mode that its neighbours all but hide may miss by more, where its deviation says so.
        let holds = |&(error, std): &(f64, f64)| error.abs() < f64::max(0.03, 3.0 * std);
        assert!(told.iter().all(holds), "noise {noise}: {told:?}");
        let well_known = told.iter().filter(|(_, std)| *std < 0.01).count();
        assert!(well_known > 15, "noise {noise}: {well_known} of {}", told.len());
    }
}

/// How far such a damping is said to be known: 90 % of the 95 % intervals hold the truth (66 % where each mode was fitted
/// once beside the model's neighbours). What is missing are modes that their neighbours press from both sides, with
/// deviations of a tenth of a per cent.
#[test]
fn val_intervals_of_a_crowd_that_the_model_does_not_meet() {
    let case = Case { name: "astray", g_zx: E_X / 300.0, zeta: 0.004, astray: 0.005, ..USUAL };
    let (mut inside, mut all) = (0, 0);
    for seed in 11..17 {
        let Some(found) = found(&case, 0.003, seed) else { return };
        let told = found.pieces[0].modes.iter().filter_map(|mode| mode.damping);
        for (zeta, std) in told.filter_map(|zeta| Some((zeta.value, zeta.std?))) {
            all += 1;
            inside += usize::from((zeta - case.zeta).abs() < 1.96 * std);
        }
    }
    assert!(all > 130 && inside * 100 >= 87 * all, "{inside} of {all}");
}

/// The deviation of a measured frequency is that of the noise: against the model, whose frequencies all records tell
/// together ten times better, misses stand to it as normal numbers do.
#[test]
fn val_measured_frequencies_scatter_as_they_say() {
    let (mut squares, mut count) = (0.0, 0.0);
    for seed in 21..27 {
        let Some(found) = found(&USUAL, 0.01, seed) else { return };
        for mode in found.pieces[0].modes.iter().take(6) {
            squares += ((mode.measured - mode.model) / mode.measured_std.unwrap()).powi(2);
            count += 1.0;
        }
    }
    let rms = (squares / count).sqrt();
    assert!((0.7..1.4).contains(&rms), "rms of {count} misses in deviations: {rms}");
}

/// Ten times the paper's damping leaves few resonances; the ratios of the other modes are as well told.
#[test]
fn val_modes_without_a_resonance_are_listed() {
    let case = Case { name: "damping 4 %", zeta: 0.04, ..USUAL };
    let Some(found) = found(&case, 0.001, 3) else { return };
    let fit = &found.pieces[0];
    assert!(fit.hidden.len() >= 3, "{:?}", fit.hidden);
    let told = fit.hidden.iter().filter_map(|hidden| hidden.damping).count();
    assert_eq!(fit.measured_damping().count(), fit.modes.iter().filter(|mode| mode.damping.is_some()).count() + told);
    assert!(told >= 2 && fit.hidden.len() + fit.modes.len() >= fit.damping.len(), "{fit:?}");
}
