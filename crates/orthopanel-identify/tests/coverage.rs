//! Whether stated intervals hold the truth as often as they say: 400 noisy accelerances of one panel, whose coherence tells
//! the true variance. `coverage_of_hits.rs` does the same from hits, where noise is read from the records.
//!
//! The clean accelerance comes from `tests/record_generator`, whose physics is its own; the noise is added here. Needs
//! Python with numpy and scipy, named by `ORTHOPANEL_PYTHON`; without it the test says so and passes.

use std::fmt::Write;
use std::path::Path;
use std::process::Command;

use crate::support::Normal;
use orthopanel_data::ImpactTest;
use orthopanel_identify::{Settings, identify};

const E_X: f64 = 1.067e10;
const G_ZX: f64 = 5.304e8;
const ZETAS: [f64; 6] = [2.364e-3, 1.306e-3, 1.108e-3, 2.251e-3, 5.485e-3, 4.488e-3];
const TESTS: usize = 150;

/// Prints frequency, real and imaginary part of the accelerance from -0.3 to 0.3 m, 10 to 4400 Hz.
const CLEAN: &str = "
import numpy as np
from record_generator import beam
panel = beam.Panel()
modes = beam.solve(panel, (-0.3, 0.3), 40000.0)
zeta = beam.damping(modes, (2.364e-3, 1.306e-3, 1.108e-3, 2.251e-3, 5.485e-3, 4.488e-3), 0.004)
frequency = np.arange(10.0, 4401.0, 1.0)
for f, g in zip(frequency, beam.accelerance(modes, zeta, -0.3, 0.3, frequency)):
    print(repr(float(f)), repr(float(g.real)), repr(float(g.imag)))
";

fn clean() -> Option<Vec<[f64; 3]>> {
    let Some(python) = std::env::var_os("ORTHOPANEL_PYTHON") else {
        println!("skipped: ORTHOPANEL_PYTHON names no Python with numpy and scipy");
        return None;
    };
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests");
    let output = Command::new(python).current_dir(folder).args(["-c", CLEAN]).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let numbers = |line: &str| {
        let mut parts = line.split(' ').map(|part| part.parse::<f64>().unwrap());
        std::array::from_fn(|_| parts.next().unwrap())
    };
    Some(String::from_utf8(output.stdout).unwrap().lines().map(numbers).collect())
}

#[test]
fn val_intervals_hold_the_truth_as_often_as_they_say() {
    let Some(clean) = clean() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("test.toml");
    let text = "[piece]\nlength = 0.8\nwidth = 0.1\nthickness = 0.03\nmass_per_area = 6.880\n[[measurement]]\n\
                kind = \"accelerance\"\nfile = \"noisy.csv\"\nforce_at = [-0.3, 0.0]\nresponse_at = [0.3, 0.0]\n";
    let mut normal = Normal(2026);
    // An even noise floor, and noise in proportion as from the hammer's channel; together 1 % of a usual line.
    let usual = 2.0_f64;
    let (mut constants_held, mut damping_held) = ([0_usize; 2], 0_usize);
    for _ in 0..TESTS {
        let mut csv = String::from("frequency_hz,real,imag,coherence\n");
        for [frequency, real, imag] in &clean {
            let power = real * real + imag * imag;
            let variance = 1e-4 * usual * usual + 1e-5 * power;
            let sigma = (0.5 * variance).sqrt();
            let (real, imag) = (real + sigma * normal.next(), imag + sigma * normal.next());
            // The coherence that one hit with this noise would show, read back by |H|² (1 − γ²)/γ².
            let noisy = real * real + imag * imag;
            writeln!(csv, "{frequency},{real:e},{imag:e},{:.15}", noisy / (noisy + variance)).unwrap();
        }
        std::fs::write(folder.path().join("noisy.csv"), csv).unwrap();
        let found = identify(&ImpactTest::from_toml(text, &path).unwrap(), Settings::default()).unwrap();
        let inside = |value: f64, std: Option<f64>, truth: f64| (value - truth).abs() < 1.96 * std.unwrap();
        for (index, truth) in [E_X, G_ZX].into_iter().enumerate() {
            let constant = found.constants[index].clone();
            constants_held[index] += usize::from(inside(constant.value, constant.std, truth));
        }
        let zetas = found.pieces[0].damping.iter().zip(ZETAS);
        damping_held += zetas.filter(|(zeta, truth)| inside(zeta.value, zeta.std, *truth)).count();
    }
    let share = |count: usize, of: usize| count as f64 / of as f64;
    println!("E_x {} G_zx {} zeta {}", constants_held[0], constants_held[1], damping_held);
    // Three binomial deviations.
    for held in constants_held {
        assert!((0.90..=1.0).contains(&share(held, TESTS)), "{constants_held:?} of {TESTS}");
    }
    assert!((0.925..=0.975).contains(&share(damping_held, 6 * TESTS)), "{damping_held} of {}", 6 * TESTS);
}
