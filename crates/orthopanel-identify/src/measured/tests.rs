//! Hits made from poles and residues, in time, and what is measured of them.

use std::f64::consts::TAU;

use num_complex::Complex64;
use orthopanel_data::{Estimation, Hit, TimeHistory, Window};
use orthopanel_model::Place;

use super::MeasuredModes;
use super::drift::Drift;
use super::joint_fit::{Found, LAST, fit};
use super::lines::RecordLines;
use super::modal_fit::ModalFit;

/// A system by its poles and residues, and its accelerance at infinite frequency.
struct Made {
    poles: Vec<Complex64>,
    /// One list a record.
    residues: Vec<Vec<Complex64>>,
    direct: f64,
}

const RATE: f64 = 16384.0;
const SAMPLES: usize = 16384;
/// Gauss-Legendre points and weights on 0 to 1.
const GAUSS: [(f64, f64); 5] = [
    (0.046_910_077_030_668, 0.118_463_442_528_094_5),
    (0.230_765_344_947_158_5, 0.239_314_335_249_683_2),
    (0.5, 0.284_444_444_444_444_4),
    (0.769_234_655_052_841_5, 0.239_314_335_249_683_2),
    (0.953_089_922_969_332, 0.118_463_442_528_094_5),
];

/// Normal deviates by a linear congruential generator (Knuth's MMIX) and Box-Muller.
struct Noise(u64);

impl Noise {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        (-2.0 * self.uniform().ln()).sqrt() * (TAU * self.uniform()).cos()
    }
}

fn pole(frequency: f64, zeta: f64) -> Complex64 {
    TAU * frequency * Complex64::new(-zeta, (1.0 - zeta * zeta).sqrt())
}

/// Residue of a mode with these shape values, for acceleration over force: $W_fW_r\lambda^2/(2j\omega_d)$.
fn residue(lambda: Complex64, shapes: f64) -> Complex64 {
    shapes * lambda * lambda / (2.0 * Complex64::I * lambda.im)
}

impl Made {
    /// Modes at these frequencies \[Hz\] with these ratios, whose shape products are a row a record.
    fn new(modes: &[(f64, f64)], shapes: &[&[f64]]) -> Self {
        let poles: Vec<Complex64> = modes.iter().map(|(frequency, zeta)| pole(*frequency, *zeta)).collect();
        let of_record = |row: &&[f64]| poles.iter().zip(*row).map(|(lambda, w)| residue(*lambda, *w)).collect();
        Self { residues: shapes.iter().map(of_record).collect(), poles, direct: 0.2 }
    }

    /// A blow of Gaussian shape, whose spectrum is nothing at half the rate, and the acceleration under it, integrated pole by pole
    /// between samples by Gauss's rule.
    fn hit(&self, record: usize, peak: f64, at: f64) -> Hit {
        let width = 1.5e-4;
        let force = |t: f64| peak * (-0.5 * ((t - at) / width).powi(2)).exp();
        let step = RATE.recip();
        let mut state = vec![Complex64::ZERO; self.poles.len()];
        let mut hit = Hit { force: vec![], acceleration: vec![] };
        for n in 0..SAMPLES {
            let t = n as f64 * step;
            hit.force.push(force(t));
            let modal: f64 = state.iter().zip(&self.residues[record]).map(|(y, q)| 2.0 * (q * y).re).sum();
            hit.acceleration.push(modal + self.direct * force(t));
            for (lambda, y) in self.poles.iter().zip(&mut state) {
                let driven =
                    |(u, weight): &(f64, f64)| weight * step * force(t + u * step) * (lambda * (1.0 - u) * step).exp();
                *y = *y * (lambda * step).exp() + GAUSS.iter().map(driven).sum::<Complex64>();
            }
        }
        hit
    }

    /// Records of some hits each with white noise of this part of the motion's rms, and a tenth of it of the force's: the force's noise
    /// moves whole residues, so that no misfit shows it.
    fn histories(&self, hits: usize, noise: f64, seed: u64) -> Vec<TimeHistory> {
        let mut deviates = Noise(seed);
        (0..self.residues.len())
            .map(|record| {
                let hits = (0..hits)
                    .map(|index| {
                        let mut hit = self.hit(record, 60.0 + 20.0 * index as f64, 0.02 + 1e-3 * index as f64);
                        for (channel, noise) in [(&mut hit.force, 0.1 * noise), (&mut hit.acceleration, noise)] {
                            let rms = (channel.iter().map(|v| v * v).sum::<f64>() / channel.len() as f64).sqrt();
                            channel.iter_mut().for_each(|v| *v += noise * rms * deviates.normal());
                        }
                        hit
                    })
                    .collect();
                let place = |x: f64| Place { x, y: 0.0 };
                let places = [place(-0.3 + 0.1 * record as f64), place(0.3)];
                TimeHistory::new(format!("made-{record}"), places, RATE, hits)
            })
            .collect()
    }
}

/// Three modes of which the first rings on when the record ends, seen in two records.
fn ringing() -> Made {
    Made::new(&[(180.0, 4e-4), (430.0, 2e-3), (1210.0, 5e-3)], &[&[0.8, -0.5, 0.3], &[-0.4, 0.7, 0.6]])
}

/// Without noise the poles and residues come back to many digits although the records are cut off while the first mode
/// rings at 64 % of its amplitude.
#[test]
fn val_records_that_ring_on_at_their_end_give_their_poles_and_residues() {
    let made = ringing();
    let measured = MeasuredModes::of_hits(0, &made.histories(2, 1e-7, 1), 4000.0).expect("resonances");
    assert_eq!(measured.poles.len(), 3, "{:?}", measured.poles);
    for (m, (found, expected)) in measured.poles.iter().zip(&made.poles).enumerate() {
        let apart = (found.lambda() - expected).norm() / expected.norm();
        assert!(apart < 1e-7, "pole {m}: {} instead of {expected}, {apart:e}", found.lambda());
        for (record, residues) in measured.records.iter().zip(&made.residues) {
            let apart = (record.residues[m] - residues[m]).norm() / residues[m].norm();
            assert!(apart < 1e-4, "residue {m}: {} instead of {}", record.residues[m], residues[m]);
        }
    }
}

/// Two modes 0.6 half-widths apart are told apart by two places.
#[test]
fn val_two_close_modes_are_told_apart_by_the_places() {
    let made = Made::new(&[(500.0, 4e-3), (501.2, 4e-3), (900.0, 3e-3)], &[&[0.8, 0.5, 0.4], &[0.7, -0.6, 0.5]]);
    let measured = MeasuredModes::of_hits(0, &made.histories(3, 1e-3, 5), 3000.0).expect("resonances");
    assert_eq!(measured.poles.len(), 3, "{:?}", measured.poles);
    for (found, expected) in measured.poles.iter().zip(&made.poles) {
        assert!((found.angular_frequency / expected.norm() - 1.0).abs() < 1e-4, "{found:?} {expected}");
    }
}

/// Over many draws of the noise every measured value errs by what its covariance says, and the misfit is that of noise alone.
#[test]
fn val_errors_are_those_that_the_covariance_states() {
    let made = ringing();
    let draws = 8;
    let (mut squares, mut count, mut misfits) = (0.0, 0, 0.0);
    for seed in 0..draws {
        let measured = MeasuredModes::of_hits(0, &made.histories(3, 3e-3, 100 + seed), 4000.0).expect("resonances");
        assert_eq!(measured.poles.len(), 3);
        misfits += measured.chi_square.expect("a fit") / draws as f64;
        let values = measured.values();
        let expected: Vec<f64> = made.poles.iter().map(|pole| pole.norm().ln()).collect();
        let damping = made.poles.iter().map(|pole| (-pole.re / pole.norm()).ln());
        let residues = |record: usize| made.residues[record].iter().flat_map(|q| [q.re, q.im]);
        let expected: Vec<f64> = expected.into_iter().chain(damping).collect();
        let mut add = |place: usize, expected: f64| {
            let variance = measured.covariance[(place, place)];
            squares += (values[place] - expected).powi(2) / variance;
            count += 1;
        };
        expected.iter().enumerate().for_each(|(place, value)| add(place, *value));
        let block = 2 * (3 + measured.remainder_frequencies.len());
        for record in 0..2 {
            residues(record).enumerate().for_each(|(place, value)| add(6 + record * block + place, value));
        }
    }
    let rms = (squares / f64::from(count)).sqrt();
    // 144 errors, of which each mode's are dependent: the standard deviation of their rms is about 0.08.
    assert!((0.76..1.24).contains(&rms), "errors {rms} times what is stated");
    assert!((0.9..1.1).contains(&misfits), "misfit per datum {misfits}");
}

/// Hits under an exponential window that nobody tells, which takes half of the noise before a fifth of the record is over: its decay rate
/// shows in the noise, and poles and residues come back as they are without it. Noise that stays undoes nothing.
#[test]
fn val_a_window_over_hits_shows_in_their_noise_and_is_undone() {
    const DECAY: f64 = 4.0;
    let made = Made::new(&[(180.0, 8e-3), (430.0, 4e-3), (1210.0, 5e-3)], &[&[0.8, -0.5, 0.3], &[-0.4, 0.7, 0.6]]);
    let mut histories = made.histories(3, 3e-3, 17);
    let steady = MeasuredModes::of_hits(0, &histories, 4000.0).expect("resonances");
    assert_eq!(steady.undone_decay, 0.0);
    for hit in histories.iter_mut().flat_map(|history| &mut history.hits) {
        for channel in [&mut hit.force, &mut hit.acceleration] {
            channel.iter_mut().enumerate().for_each(|(n, value)| *value *= (-DECAY * n as f64 / RATE).exp());
        }
    }
    let measured = MeasuredModes::of_hits(0, &histories, 4000.0).expect("resonances");
    let missed = measured.undone_decay - DECAY;
    assert!(missed.abs() < 0.1, "{} 1/s", measured.undone_decay);
    assert_eq!(measured.poles.len(), 3, "{:?}", measured.poles);
    assert!(measured.chi_square.is_some_and(|misfit| (0.8..1.2).contains(&misfit)), "{:?}", measured.chi_square);
    for (found, expected) in measured.poles.iter().zip(&made.poles) {
        let apart = (found.lambda() - expected - missed).norm() / expected.norm();
        assert!(apart < 2e-6, "{} instead of {expected} and {missed}, {apart:e}", found.lambda());
    }
}

/// Lines that scatter by 2 % of themselves, far more than the noise that their file tells: no further pole is made of it, and the covariance
/// holds it.
#[test]
fn val_scatter_beyond_the_noise_is_no_pole() {
    let made = ringing();
    let mut noise = Noise(11);
    let s: Vec<Complex64> = (40..3000).map(|line| Complex64::new(0.0, TAU * 0.5 * f64::from(line))).collect();
    let mut record = |number: usize| {
        let line = |s: &Complex64| {
            let mode = |(q, lambda): (&Complex64, &Complex64)| q / (s - lambda) + q.conj() / (s - lambda.conj());
            let exact = made.direct + made.residues[number].iter().zip(&made.poles).map(mode).sum::<Complex64>();
            exact * (1.0 + 0.02 * 0.5_f64.sqrt() * Complex64::new(noise.normal(), noise.normal()))
        };
        RecordLines {
            force_at: Place { x: 0.1 * number as f64, y: 0.0 },
            response_at: Place { x: 0.3, y: 0.0 },
            value: s.iter().map(line).collect(),
            weight: vec![1e3; s.len()],
            s: s.clone(),
            truncations: None,
            per_datum: 1.0,
            force_noise: vec![],
        }
    };
    let measured = MeasuredModes::of_lines(0, vec![record(0), record(1)], ([20.0, 1500.0], true)).expect("resonances");
    assert_eq!(measured.poles.len(), 3, "{:?}", measured.poles);
    assert!(measured.chi_square.is_some_and(|misfit| (0.8..1.2).contains(&misfit)), "{:?}", measured.chi_square);
    for (mode, (found, expected)) in measured.poles.iter().zip(&made.poles).enumerate() {
        let [apart, deviation] =
            [(found.angular_frequency / expected.norm()).ln().abs(), measured.covariance[(mode, mode)].sqrt()];
        assert!(apart < 4.0 * deviation && deviation < 1e-4, "{found:?}: {apart:e} off, {deviation:e} stated");
    }
}

/// A panel that warms up: each record has its poles 5e-5 above those of the one before, an eighth of a half-width. Once
/// drift is removed residues are less than half as far off, and the mean poles are known to what five records tell of their mean.
#[test]
fn val_drift_from_record_to_record_is_removed() {
    const RECORDS: usize = 5;
    let modes = [(180.0, 4e-4), (430.0, 6e-4)];
    let shapes = [[0.8, -0.5], [-0.4, 0.7], [0.6, 0.3], [0.9, 0.6], [-0.7, 0.8]];
    let mut noise = Noise(17);
    let s: Vec<Complex64> = (400..12000).map(|line| Complex64::new(0.0, TAU * 0.05 * f64::from(line))).collect();
    let mut record = |number: usize| {
        let drift = 1.0 + 5e-5 * (number as f64 - (RECORDS / 2) as f64);
        let made = Made::new(&modes.map(|(frequency, zeta)| (drift * frequency, zeta)), &[&shapes[number]]);
        let line = |s: &Complex64| {
            let mode = |(q, lambda): (&Complex64, &Complex64)| q / (s - lambda) + q.conj() / (s - lambda.conj());
            let exact = made.direct + made.residues[0].iter().zip(&made.poles).map(mode).sum::<Complex64>();
            exact + 0.01 * exact.norm() * 0.5_f64.sqrt() * Complex64::new(noise.normal(), noise.normal())
        };
        let value: Vec<Complex64> = s.iter().map(line).collect();
        RecordLines {
            force_at: Place { x: 0.1 * number as f64, y: 0.0 },
            response_at: Place { x: 0.3, y: 0.0 },
            weight: value.iter().map(|value| 2f64.sqrt() * 1e2 / value.norm()).collect(),
            value,
            s: s.clone(),
            truncations: None,
            per_datum: 1.0,
            force_noise: vec![],
        }
    };
    let mut records: Vec<RecordLines> = (0..RECORDS).map(&mut record).collect();
    let mean = Made::new(&modes, &shapes.each_ref().map(|shapes| &shapes[..]));
    let begun = modes.iter().map(|(frequency, zeta): &(f64, f64)| [(TAU * frequency).ln(), zeta.ln()]).collect();
    let mut found = fit(&records, begun, LAST).unwrap();
    let most_off = |found: &Found| {
        let records = found.fitted.records.iter().zip(&mean.residues);
        let off = records.flat_map(|(record, residues)| {
            residues.iter().enumerate().map(|(mode, residue)| (record.residue(mode) / residue - 1.0).norm())
        });
        off.fold(0.0, f64::max)
    };
    let before = most_off(&found);
    let drift = Drift::removed(&mut records, &mut found);
    let after = most_off(&found);
    assert!(after < 5e-4 && after < 0.5 * before, "residues {before} off, {after} without drift");
    for (pole, (frequency, _)) in found.poles.iter().zip(modes) {
        // Of five records that drift by 7e-5 rms.
        let [deviation, off] = [drift.of_mean(*pole)[0].sqrt(), pole[0] - (TAU * frequency).ln()];
        assert!(off.abs() < 5e-6 && (2.5e-5..4e-5).contains(&deviation), "{off:e} off, {deviation:e} stated");
    }
}

/// A band that the test file declares ends that of the modes.
#[test]
fn a_declared_band_is_the_band_of_the_modes() {
    let made = Made::new(&[(180.0, 8e-3), (430.0, 6e-3), (1210.0, 5e-3)], &[&[0.8, -0.5, 0.3], &[-0.4, 0.7, 0.6]]);
    let mut histories = made.histories(2, 1e-3, 3);
    histories.iter_mut().for_each(|history| history.band = Some([100.0, 800.0]));
    let measured = MeasuredModes::of_hits(0, &histories, 4000.0).expect("resonances");
    assert_eq!((measured.band, measured.poles.len()), ([100.0, 800.0], 2), "{:?}", measured.poles);
}

/// Eighteen modes of a plate over two octaves, two of them a thousandth apart, that six places tell: each is found, and none else.
#[test]
fn val_close_modes_of_a_plate_are_told_apart_by_the_places() {
    let frequencies: Vec<f64> = (0..18).map(|k| 180.0 * 1.085f64.powi(k)).collect();
    let mut modes: Vec<(f64, f64)> = frequencies.iter().map(|frequency| (*frequency, 0.004)).collect();
    modes[9].0 = 1.001 * modes[8].0;
    let mut noise = Noise(7);
    let shapes: Vec<Vec<f64>> = (0..6).map(|_| modes.iter().map(|_| noise.normal()).collect()).collect();
    let rows: Vec<&[f64]> = shapes.iter().map(Vec::as_slice).collect();
    let made = Made::new(&modes, &rows);
    let accelerance = |record: usize| {
        let frequency: Vec<f64> = (0..3800).map(|line| 50.0 + 0.25 * f64::from(line)).collect();
        let line = |frequency: &f64| {
            let s = Complex64::new(0.0, TAU * frequency);
            let sum: Complex64 = made
                .poles
                .iter()
                .zip(&made.residues[record])
                .map(|(pole, residue)| residue / (s - pole) + residue.conj() / (s - pole.conj()))
                .sum();
            made.direct + sum
        };
        let value: Vec<Complex64> = frequency.iter().map(line).collect();
        let place = Place { x: 0.0, y: 0.0 };
        RecordLines {
            force_at: place,
            response_at: place,
            s: frequency.iter().map(|frequency| Complex64::new(0.0, TAU * frequency)).collect(),
            weight: value.iter().map(|value| 1.0 / (1e-3 * value.norm() + 1e-3)).collect(),
            per_datum: 1.0,
            force_noise: vec![0.0; value.len()],
            truncations: None,
            value,
        }
    };
    let mut records: Vec<RecordLines> = (0..6).map(accelerance).collect();
    for record in &mut records {
        for (value, weight) in record.value.iter_mut().zip(&record.weight) {
            *value += Complex64::new(noise.normal(), noise.normal()) / weight;
        }
    }
    let found = MeasuredModes::of_lines(0, records, ([50.0, 1000.0], true)).expect("modes");
    let mut wanted: Vec<f64> = modes.iter().map(|(frequency, _)| *frequency).collect();
    wanted.sort_by(f64::total_cmp);
    // A mode whose skirt leaves the band stands beside.
    wanted.retain(|frequency| *frequency < 980.0 / 1.016);
    let own: Vec<f64> = found.poles.iter().map(|pole| pole.angular_frequency / TAU).collect();
    for frequency in &wanted {
        assert!(own.iter().any(|own| (own / frequency - 1.0).abs() < 1e-4), "{frequency} Hz is not among {own:?}");
    }
    assert!(own.len() <= wanted.len() + 1, "{own:?}");
    assert!(found.chi_square.is_some_and(|chi_square| (0.8..1.2).contains(&chi_square)), "{:?}", found.chi_square);
}

/// What a pole takes up of the misfit, from its residues and their covariance, is what a fit without it leaves more.
#[test]
fn val_the_loss_without_a_pole_is_that_of_a_fit_without_it() {
    let made = ringing();
    let records: Vec<RecordLines> =
        made.histories(2, 1e-2, 9).iter().map(|history| RecordLines::of_hits(history, [20.0, 3000.0])).collect();
    let poles: Vec<[f64; 2]> =
        made.poles.iter().map(|pole| [pole.norm().ln(), (-pole.re / pole.norm()).ln()]).collect();
    let fit = ModalFit::new(&records, &poles);
    let all = fit.at(&poles).expect("a fit");
    for pole in 0..poles.len() {
        let mut others = poles.clone();
        others.remove(pole);
        let more = fit.at(&others).expect("a fit").misfit - all.misfit;
        let loss: f64 = all.records.iter().map(|record| record.loss_without(pole)).sum();
        assert!((loss / more - 1.0).abs() < 1e-6, "pole {pole}: {loss} instead of {more}");
    }
}

/// The mean of three hits under an exponential window, with the variance that three hits tell of each line: noise that runs alike over ten lines
/// is no pole, and what is stated of the poles' frequencies holds.
#[test]
fn val_noise_under_an_exponential_window_is_no_pole() {
    let made = ringing();
    let window = Window::ForceExponential { half_width: 0.01, tau: 0.1 };
    let estimated = made.histories(3, 3e-3, 23).into_iter().map(|history| {
        let mean = history.accelerance(Estimation { window, ..Estimation::default() });
        mean.expect("an accelerance")
    });
    let measured = MeasuredModes::of_accelerances(0, &estimated.collect::<Vec<_>>()).expect("resonances");
    assert_eq!(measured.poles.len(), made.poles.len(), "{:?}", measured.poles);
    assert!(measured.chi_square.is_some_and(|misfit| (0.6..1.4).contains(&misfit)), "{:?}", measured.chi_square);
    for (mode, (found, expected)) in measured.poles.iter().zip(&made.poles).enumerate() {
        let off = (found.angular_frequency / expected.norm()).ln();
        let deviation = measured.covariance[(mode, mode)].sqrt();
        assert!(off.abs() < 3.5 * deviation && deviation < 1e-4, "{found:?}: {off:e} off, {deviation:e} stated");
    }
}

/// Of a plate whose modes lie close the band's end falls among them: of those just beyond it lines show skirts alone.
#[test]
fn val_resonances_beyond_the_band_spoil_none_within() {
    let modes =
        [(310.0, 4e-3), (560.0, 3e-3), (741.0, 5e-3), (762.0, 4e-3), (812.0, 5e-3), (817.0, 9e-3), (925.0, 6e-3)];
    let shapes: Vec<Vec<f64>> = (0..6)
        .map(|record| (0..modes.len()).map(|n| (1.7 * (record + 1) as f64 * (n + 1) as f64).sin()).collect())
        .collect();
    let rows: Vec<&[f64]> = shapes.iter().map(Vec::as_slice).collect();
    let made = Made::new(&modes, &rows);
    let measured = MeasuredModes::of_hits(0, &made.histories(2, 1e-4, 5), 800.0).expect("resonances");
    let chi_square = measured.chi_square.expect("of hits");
    assert!((0.7..1.2).contains(&chi_square), "{chi_square}");
    assert_eq!(measured.poles.len(), 4, "{:?}", measured.poles);
    for (m, (found, expected)) in measured.poles.iter().zip(&made.poles).enumerate() {
        let apart = (found.angular_frequency / expected.norm()).ln();
        let std = measured.covariance[(m, m)].sqrt();
        assert!(apart.abs() < 4.0 * std && std < 1e-5, "pole {m}: {apart:e} of {std:e}");
    }
}

/// A filter before the converter rings for longer than the hammer touches, the longer the lower the rate: what a window cuts of it moves every line.
#[test]
fn val_a_filter_that_rings_at_a_low_rate_is_no_misfit() {
    const EVERY: usize = 8;
    let rate = RATE / EVERY as f64;
    // Off at 0.435 of the rate within 0.016 of it, as an error function: a Gaussian over what rings.
    let (end, within) = (0.435 * rate, 0.0156 * rate);
    let reach = (4.5 / (std::f64::consts::PI * within) * RATE) as isize;
    let kernel: Vec<f64> = (-reach..=reach)
        .map(|n| {
            let t = n as f64 / RATE;
            let turn = TAU * end * t;
            let sinc = if n == 0 { 1.0 } else { turn.sin() / turn };
            2.0 * end / RATE * sinc * (-(std::f64::consts::PI * within * t).powi(2)).exp()
        })
        .collect();
    let filtered = |channel: &[f64]| -> Vec<f64> {
        let at = |n: usize| {
            let sample = |(k, h): (usize, &f64)| {
                let from = n as isize + k as isize - reach;
                usize::try_from(from).ok().and_then(|from| channel.get(from)).map_or(0.0, |value| h * value)
            };
            kernel.iter().enumerate().map(sample).sum()
        };
        (0..channel.len()).step_by(EVERY).map(at).collect()
    };
    let made = Made::new(&[(210.0, 6e-3), (415.0, 5e-3), (640.0, 8e-3)], &[&[0.8, -0.5, 0.3], &[-0.4, 0.7, 0.6]]);
    let mut deviates = Noise(11);
    let history = |record: usize| {
        let hit = |index: usize| {
            let Hit { force, acceleration } = made.hit(record, 60.0 + 20.0 * index as f64, 0.1);
            let [force, acceleration] = [force, acceleration].map(|channel| filtered(&channel));
            Hit { force, acceleration }
        };
        let mut hits: Vec<Hit> = (0..2).map(hit).collect();
        for hit in &mut hits {
            for (channel, noise) in [(&mut hit.force, 1e-5), (&mut hit.acceleration, 1e-4)] {
                let rms = (channel.iter().map(|v| v * v).sum::<f64>() / channel.len() as f64).sqrt();
                channel.iter_mut().for_each(|v| *v += noise * rms * deviates.normal());
            }
        }
        let places = [Place { x: -0.3 + 0.1 * record as f64, y: 0.0 }, Place { x: 0.3, y: 0.0 }];
        TimeHistory::new(format!("made-{record}"), places, rate, hits)
    };
    let histories: Vec<TimeHistory> = (0..2).map(history).collect();
    let measured = MeasuredModes::of_hits(0, &histories, 4000.0).expect("resonances");
    let chi_square = measured.chi_square.expect("of hits");
    assert!((0.7..1.3).contains(&chi_square), "{chi_square}");
    assert_eq!(measured.poles.len(), 3, "{:?}", measured.poles);
}
