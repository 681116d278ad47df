//! Whether stated intervals hold the truth as often as they say where noise is read from hits: hits, spectra, variance, fit.
//!
//! The clean hits come from `tests/record_generator`, whose physics is its own; white noise is added here to both channels
//! of each hit. Needs Python with numpy and scipy, named by `ORTHOPANEL_PYTHON`; without it the tests say so and pass.
//! The shares that `docs/decisions/identification-by-records.md` quotes are of three times as many tests.

use std::fmt::Write;

use crate::support::{Normal, hammer_test};
use orthopanel_data::{Estimation, Hit, ImpactTest, Window};
use orthopanel_identify::{Settings, identify};

const E_X: f64 = 1.067e10;
const G_ZX: f64 = 5.304e8;
/// So that 3e-6 of the first mode is left after 1.6 s.
const MUCH: [&str; 6] = ["4.0e-3", "3.3e-3", "3.1e-3", "3.4e-3", "3.6e-3", "3.9e-3"];

/// Table 9: a thousandth of the first mode is left then.
const TABLE_9: [&str; 6] = ["2.363e-3", "1.306e-3", "1.108e-3", "2.250e-3", "5.486e-3", "4.488e-3"];

/// Three hits with force up to 5 kHz, 1.6 s each.
const THREE_HITS: [&str; 10] = [
    "--hits",
    "3",
    "--pulse",
    "half-sine",
    "--pulse-duration",
    "2.5e-4",
    "--sampling-rate",
    "10240",
    "--samples",
    "16384",
];

/// The generator's damping of all modes after the sixth.
const BEYOND: f64 = 4e-3;

/// Parts of the intervals that held the truth: of E_x, of G_zx, of the first six damping ratios, of those beyond.
#[derive(Debug)]
struct Held {
    shares: [f64; 4],
    /// Of how many intervals each share is.
    of: [usize; 4],
}

impl Held {
    /// Each of the first `kinds` shares within three binomial deviations of 95 %, and two in a hundred: likelihoods are no exact coverage.
    fn assert_as_stated(&self, kinds: usize) {
        for (share, of) in self.shares.iter().zip(self.of).take(kinds) {
            let apart = 3.0 * (0.95 * 0.05 / of as f64).sqrt() + 0.02;
            assert!((share - 0.95).abs() < apart, "{self:?}, {apart:.3} allowed");
        }
    }
}

/// Noise as a part of what of each channel.
#[derive(Debug, Clone, Copy)]
enum Noise {
    OfRms(f64),
    OfPeak(f64),
}

/// So many tests with fresh noise; `None` without Python.
fn held(
    options: &[&str],
    zetas: &[&str; 6],
    noise: Noise,
    (tests, seed): (usize, u64),
    settings: Settings,
) -> Option<Held> {
    let folder = tempfile::tempdir().unwrap();
    let clean = hammer_test(
        &folder.path().join("clean"),
        &[options, &["--noise", "0", "--seed", "5", "--zeta"], zetas].concat(),
    )?;
    let [(_, history)] = clean.time_histories().unwrap().try_into().unwrap();
    let path = folder.path().join("test.toml");
    let mut text = String::from("[piece]\nlength = 0.8\nwidth = 0.1\nthickness = 0.03\nmass_per_area = 6.880\n");
    for hit in 0..history.hits.len() {
        let places = "force_at = [-0.3, 0.0]\nresponse_at = [0.3, 0.0]";
        write!(text, "[[measurement]]\nkind = \"time-history\"\nfile = \"hit-{hit}.csv\"\n{places}\n").unwrap();
    }
    let zetas = zetas.map(|zeta| zeta.parse::<f64>().unwrap());
    let mut normal = Normal(seed);
    let (mut counts, mut beyond) = ([0_usize; 4], 0);
    for _ in 0..tests {
        for (index, hit) in history.hits.iter().enumerate() {
            let csv = noisy(hit, history.rate, noise, &mut normal);
            std::fs::write(folder.path().join(format!("hit-{index}.csv")), csv).unwrap();
        }
        let found = identify(&ImpactTest::from_toml(&text, &path).unwrap(), settings).unwrap();
        let inside = |value: f64, std: Option<f64>, truth: f64| (value - truth).abs() < 1.96 * std.unwrap();
        for (index, truth) in [E_X, G_ZX].into_iter().enumerate() {
            counts[index] += usize::from(inside(found.constants[index].value, found.constants[index].std, truth));
        }
        let zetas = found.pieces[0].damping.iter().zip(zetas);
        counts[2] += zetas.filter(|(zeta, truth)| inside(zeta.value, zeta.std, *truth)).count();
        let others = found.pieces[0].damping.get(6..).unwrap_or_default();
        beyond += others.len();
        counts[3] += others.iter().filter(|zeta| inside(zeta.value, zeta.std, BEYOND)).count();
    }
    let share = |count: usize, of: usize| count as f64 / of as f64;
    let of = [tests, tests, 6 * tests, beyond.max(1)];
    let held = Held { shares: std::array::from_fn(|index| share(counts[index], of[index])), of };
    println!("{options:?}, {noise:?}: {held:?}");
    Some(held)
}

/// A hit as CSV with noise on both channels.
fn noisy(hit: &Hit, rate: f64, noise: Noise, normal: &mut Normal) -> String {
    let deviation = |channel: &[f64]| match noise {
        Noise::OfRms(part) => {
            part * (channel.iter().map(|value| value * value).sum::<f64>() / channel.len() as f64).sqrt()
        }
        Noise::OfPeak(part) => part * channel.iter().fold(0.0_f64, |peak, value| peak.max(value.abs())),
    };
    let (of_force, of_motion) = (deviation(&hit.force), deviation(&hit.acceleration));
    let mut csv = String::from("time_s,force_n,acceleration_m_s2\n");
    for (sample, (force, acceleration)) in hit.force.iter().zip(&hit.acceleration).enumerate() {
        let (force, acceleration) = (force + of_force * normal.next(), acceleration + of_motion * normal.next());
        writeln!(csv, "{},{force:.6},{acceleration:.6}", sample as f64 / rate).unwrap();
    }
    csv
}

/// One hit has no scatter. At 10.24 kHz no line stands above the band to read noise from; at 20.48 kHz the hammer's second
/// lobe and further modes stand there, which is no noise. Of 120 tests at 20.48 kHz E_x and G_zx were held in 92 %.
#[test]
fn val_intervals_from_one_hit_hold_the_truth() {
    for (rate, samples, noise) in [("10240", "16384", 0.002), ("20480", "32768", 0.003)] {
        let options = ["--hits", "1", "--pulse", "half-sine", "--pulse-duration", "2.5e-4"];
        let options = [&options[..], &["--sampling-rate", rate, "--samples", samples]].concat();
        let Some(held) = held(&options, &MUCH, Noise::OfRms(noise), (30, 77), Settings::default()) else { return };
        held.assert_as_stated(3);
    }
}

/// The response rings on, so an exponential window is taken, over the whole force: with a window of 4 ms over the force E_x was
/// held in 82, G_zx in 74 and damping in 83 % of 100 tests.
#[test]
fn val_intervals_from_three_hits_of_a_piece_that_rings_on_hold_the_truth() {
    let Some(held) = held(&THREE_HITS, &TABLE_9, Noise::OfRms(0.005), (100, 7), Settings::default()) else { return };
    held.assert_as_stated(3);
}

/// The noise of the force counts: over the whole record it would make as much of S_ff as the blow. A window over the blow leaves
/// a 200th, tied together over 200 lines and more; what it makes too low is taken out. Of 200 tests 92 to 94 % held the truth.
#[test]
fn val_intervals_under_much_noise_of_the_force_hold_the_truth() {
    for (zetas, part) in [(&MUCH, 0.01), (&TABLE_9, 0.003)] {
        let noise = Noise::OfPeak(part);
        let Some(held) = held(&THREE_HITS, zetas, noise, (40, 11), Settings::default()) else { return };
        held.assert_as_stated(3);
    }
}

/// The window asked for by hand, 4 ms about the blow, on a piece that rings on. While its lines were taken as independent, E_x
/// was held in 82, G_zx in 74 and damping in 83 % of 100 tests; of 200 now in 99, 97 and 96 %.
#[test]
fn val_intervals_under_a_force_window_asked_for_hold_the_truth() {
    let window = Window::ForceExponential { half_width: Window::USUAL_HALF_WIDTH, tau: 0.2 };
    let settings = Settings { estimation: Estimation { window, ..Estimation::default() }, ..Settings::default() };
    let Some(held) = held(&THREE_HITS, &TABLE_9, Noise::OfRms(0.005), (40, 7), settings) else { return };
    held.assert_as_stated(3);
}

/// Up to beyond 7 kHz the force falls a thousandfold in power, and its noise in the whole record, which counts for nothing where the
/// force is strong, is a few per cent of S_ff there. Without that taken out of H1 the highest ratio of five places was held in 33 % of
/// tests. Of sixty tests 91 % held the four ratios beyond the sixth; the tenth lies at the band's end.
#[test]
fn val_intervals_of_the_highest_modes_hold_the_truth() {
    let options = ["--hits", "5", "--sampling-rate", "16384", "--samples", "16384"];
    let Some(held) = held(&options, &MUCH, Noise::OfRms(0.01), (30, 3), Settings::default()) else { return };
    held.assert_as_stated(4);
}
