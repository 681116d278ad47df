//! From the modal fit of records to [`MeasuredModes`]: modes inside the band, remainders, and the covariance of all.

use std::f64::consts::TAU;

use faer::{Mat, Side};
use num_complex::Complex64;
use orthopanel_data::{Accelerance, TimeHistory};
use rayon::prelude::*;

use super::accelerances::UNTOLD_NOISE;
use super::drift::Drift;
use super::hits::FLAT;
use super::joint_fit::{Found, LAST, fit};
use super::lines::RecordLines;
use super::modal_fit::{MOST_DAMPING, ModalFit, lambda};
use super::noise_decay::{decay_of_noise, undone};
use super::pole_search::{in_parts, joined, pruned};
use super::scatter::Scatter;
use super::{MeasuredModes, MeasuredRecord, Pole};

/// Lowest frequency of the band \[Hz\]: below the hanging modes of a panel on cords, which are poles like others.
const LOWEST: f64 = 5.0;
/// and never less than so many periods in a record.
const LEAST_PERIODS: f64 = 6.0;
/// Half-widths of a resonance that have to lie inside the band.
pub(crate) const SKIRT: f64 = 4.0;
/// Most that the logarithm of a frequency may be unsure by for its mode to stand by itself.
const MOST_UNSURE: f64 = 5e-3;
/// The same of the logarithm of its damping: beyond, noise could have made it of nothing.
const MOST_UNSURE_DAMPING: f64 = 0.5;
/// Damping ratio from which a pole is no mode but a slope.
const MOST_ZETA: f64 = 0.25;
/// Deviation of the logarithms of a pole's frequency and damping before any data: a factor of twenty.
const UNTOLD_PARAMETER: f64 = 3.0;
/// Values of the remainder that are told, and the highest of their frequencies \[Hz\].
const REMAINDER_VALUES: usize = 8;
const HIGHEST_REMAINDER: f64 = 400.0;
/// Times that the scatter beyond noise is found anew.
const SCATTERS: usize = 4;

impl MeasuredModes {
    /// From the hits of all pairs of places of one piece, up to a frequency \[Hz\]; `None` where they show no resonance.
    ///
    /// Where the noise of the hits dies away, so may they have under an exponential window, and that is undone: noise under it is no noise by
    /// itself on each line, and looks like poles. It stays undone where the modes then meet the hits better.
    pub(super) fn of_hits(piece: usize, histories: &[TimeHistory], highest: f64) -> Option<Self> {
        let as_recorded = || Self::of_steady_hits(piece, histories, highest);
        let undone_decay = decay_of_noise(histories);
        if undone_decay == 0.0 {
            return as_recorded();
        }
        let undone = Self::of_steady_hits(piece, &undone(histories, undone_decay), highest);
        let undone = undone.map(|measured| Self { undone_decay, ..measured });
        undone.into_iter().chain(as_recorded()).min_by(|a, b| a.per_datum().total_cmp(&b.per_datum()))
    }

    fn per_datum(&self) -> f64 {
        self.chi_square.unwrap_or(f64::INFINITY)
    }

    /// The same of hits whose noise stays as it is.
    fn of_steady_hits(piece: usize, histories: &[TimeHistory], highest: f64) -> Option<Self> {
        let rate = histories.iter().map(|history| history.rate).fold(f64::INFINITY, f64::min);
        let duration =
            |history: &TimeHistory| history.hits.first().map_or(0.0, |hit| hit.force.len() as f64) / history.rate;
        let shortest = histories.iter().map(duration).fold(f64::INFINITY, f64::min);
        let declared = || histories.iter().filter_map(|history| history.band);
        let band = [
            declared().map(|[from, _]| from).fold(LOWEST.max(LEAST_PERIODS / shortest), f64::max),
            declared().map(|[_, to]| to).fold(highest.min(FLAT * rate), f64::min),
        ];
        let records: Vec<RecordLines> =
            histories.par_iter().map(|history| RecordLines::of_hits(history, band)).collect();
        Self::of_lines(piece, records, (band, true))
    }

    /// From accelerances of all pairs of places of one piece on the lines that all have; `None` where they show no resonance.
    pub(super) fn of_accelerances(piece: usize, accelerances: &[Accelerance]) -> Option<Self> {
        let ends = |of: &Accelerance| of.frequency.first().copied().zip(of.frequency.last().copied());
        let told = || accelerances.iter().filter_map(ends);
        let band = [
            told().map(|(first, _)| first).fold(LOWEST, f64::max),
            told().map(|(_, last)| last).fold(f64::INFINITY, f64::min),
        ];
        let records: Vec<RecordLines> =
            accelerances.iter().map(|accelerance| RecordLines::of_accelerance(accelerance, band)).collect();
        let is_told = accelerances.iter().all(|accelerance| accelerance.variance.is_some());
        Self::of_lines(piece, records, (band, is_told))
    }

    /// From lines, in a band \[Hz\], and whether their noise is told.
    pub(super) fn of_lines(
        piece: usize,
        mut records: Vec<RecordLines>,
        (band, is_told): ([f64; 2], bool),
    ) -> Option<Self> {
        let mut scatter = Scatter::most(&mut records);
        let (start, highest) = in_parts(&records, (band, is_told));
        let band = [band[0], highest.min(band[1])];
        records.iter_mut().for_each(|record| *record = record.between(band));
        scatter.cut(&records);
        let mut found = joined(&records, start, is_told)?;
        for _ in 0..SCATTERS {
            if !scatter.follows(&mut records, &found) {
                break;
            }
            found = joined(&records, found.poles, is_told)?;
        }
        let mut drift = Drift::none();
        if !is_told {
            Scatter::settles(&mut records, &found);
            let standing = pruned(&records, fit(&records, found.poles, LAST)?);
            found = fit(&records, standing.poles, LAST)?;
            drift = Drift::removed(&mut records, &mut found);
        }
        Some(told(piece, &records, (&found, &drift), (band, is_told)))
    }
}

/// Which poles stand by themselves, and $R$ with $R^TR$ the covariance of the poles' parameters.
fn inside(found: &Found, scale: f64, band: [f64; 2]) -> (Vec<usize>, Mat<f64>) {
    let size = 2 * found.poles.len();
    // A pole far beyond the band tells nothing: rounding may leave a curvature below zero, and the prior alone holds it.
    let own = |i: usize| (found.fitted.curvature[(i, i)] / scale).max(0.0);
    let curvature = |i: usize, j: usize| {
        let most = (own(i) * own(j)).sqrt();
        (found.fitted.curvature[(i, j)] / scale).clamp(-most, most)
    };
    let prior = UNTOLD_PARAMETER.powi(-2);
    let unit = |i: usize| (own(i) + prior).sqrt();
    let scaled = Mat::from_fn(size, size, |i, j| curvature(i, j) / (unit(i) * unit(j)));
    let root = match scaled.self_adjoint_eigen(Side::Lower) {
        Ok(eigen) => Mat::from_fn(size, size, |k, i| {
            let of_prior: f64 = (0..size).map(|j| prior * (eigen.U()[(j, k)] / unit(j)).powi(2)).sum();
            eigen.U()[(i, k)] / unit(i) / (eigen.S()[k].max(0.0) + of_prior).sqrt()
        }),
        Err(_) => Mat::from_fn(size, size, |i, j| if i == j { UNTOLD_PARAMETER } else { 0.0 }),
    };
    let has_skirt_inside = |pole: usize| {
        let [frequency, zeta] = [found.poles[pole][0].exp() / TAU, found.poles[pole][1].exp()];
        let skirt = SKIRT * zeta * frequency;
        frequency - skirt > band[0] && frequency + skirt < band[1]
    };
    let resonates = |pole: usize| found.poles[pole][1].exp() < MOST_ZETA;
    let stands = |&pole: &usize| {
        let is_sure = |parameter: usize, most: f64| root.col(parameter).norm_l2() < most;
        let sure = is_sure(2 * pole, MOST_UNSURE) && is_sure(2 * pole + 1, MOST_UNSURE_DAMPING);
        has_skirt_inside(pole) && resonates(pole) && sure
    };
    let mut kept: Vec<usize> = (0..found.poles.len()).filter(stands).collect();
    // Of two resonances that run together at an end of the band none stands: what one has of them is what the other leaves.
    let reaches_over = |&pole: &usize| resonates(pole) && !has_skirt_inside(pole);
    let others: Vec<usize> = (0..found.poles.len()).filter(reaches_over).collect();
    let half_width = |pole: usize| found.poles[pole].iter().sum::<f64>().exp();
    let together =
        |a: usize, b: usize| (found.poles[a][0].exp() - found.poles[b][0].exp()).abs() < half_width(a) + half_width(b);
    kept.retain(|pole| !others.iter().any(|other| together(*pole, *other)));
    (kept, root)
}

/// The fit in the terms of [`MeasuredModes`]; the poles that do not stand by themselves go to the remainders.
fn told(
    piece: usize,
    records: &[RecordLines],
    (found, drift): (&Found, &Drift),
    (band, is_told): ([f64; 2], bool),
) -> MeasuredModes {
    let fit = ModalFit::new(records, &found.poles);
    let chi_square = found.fitted.misfit / found.freedom;
    let scale = chi_square.max(f64::MIN_POSITIVE);
    let (kept, root) = inside(found, scale, band);
    let remainder_frequencies = remainder_frequencies(band);
    let [modes, all] = [kept.len(), found.poles.len()];
    let block = 2 * (modes + remainder_frequencies.len());
    let size = 2 * modes + records.len() * block;
    // Values as linear functions of the poles' parameters, and of each record's coefficients.
    let mut by_poles = Mat::<f64>::zeros(size, 2 * all);
    for (row, pole) in kept.iter().enumerate() {
        by_poles[(row, 2 * pole)] = 1.0;
        by_poles[(modes + row, 2 * pole + 1)] = 1.0;
    }
    let mut covariance = Mat::<f64>::zeros(size, size);
    let mut measured = Vec::with_capacity(records.len());
    for (index, (record, fitted)) in records.iter().zip(&found.fitted.records).enumerate() {
        let from = 2 * modes + index * block;
        let linear = fitted.coefficients.len();
        let mut rows = Mat::<f64>::zeros(block, linear);
        for (row, pole) in kept.iter().enumerate() {
            rows[(2 * row, 2 * pole)] = 1.0;
            rows[(2 * row + 1, 2 * pole + 1)] = 1.0;
        }
        let mut remainder = Vec::with_capacity(remainder_frequencies.len());
        for (place, frequency) in remainder_frequencies.iter().enumerate() {
            let s = Complex64::new(0.0, TAU * frequency);
            let row = 2 * (modes + place);
            let mut value = Complex64::ZERO;
            let mut add = |column: usize, of: Complex64| {
                rows[(row, column)] += of.re;
                rows[(row + 1, column)] += of.im;
                value += of * fitted.coefficients[column];
            };
            for pole in (0..all).filter(|pole| !kept.contains(pole)) {
                let [lambda, by_frequency, by_damping] = lambda(found.poles[pole]);
                let [one, other] = [(s - lambda).inv(), (s - lambda.conj()).inv()];
                add(2 * pole, one + other);
                add(2 * pole + 1, Complex64::I * (one - other));
                // What is known of its pole no better comes in by its residue's terms.
                let residue = fitted.residue(pole);
                for (parameter, by) in [by_frequency, by_damping].into_iter().enumerate() {
                    let moved = residue * by * one * one + (residue * by).conj() * other * other;
                    by_poles[(from + row, 2 * pole + parameter)] += moved.re;
                    by_poles[(from + row + 1, 2 * pole + parameter)] += moved.im;
                }
            }
            for term in 0..linear - 2 * all {
                add(2 * all + term, fit.remainder_term(term, s));
            }
            remainder.push(value);
        }
        let followed = &rows * &fitted.by_poles;
        let own = &fitted.root * rows.transpose();
        let own = own.transpose() * &own;
        for i in 0..block {
            (0..2 * all).for_each(|j| by_poles[(from + i, j)] += followed[(i, j)]);
            (0..block).for_each(|j| covariance[(from + i, from + j)] = scale * own[(i, j)]);
        }
        let residues: Vec<Complex64> = kept.iter().map(|pole| fitted.residue(*pole)).collect();
        let values: Vec<Complex64> = residues.iter().chain(&remainder).copied().collect();
        let frequencies =
            kept.iter().map(|pole| found.poles[*pole][0].exp() / TAU).chain(remainder_frequencies.iter().copied());
        // The noise of a windowed force runs smoothly over a resonance: it moves a whole residue. Of a noise that is not told it is not known how
        // much of it runs smoothly.
        for (place, (frequency, value)) in frequencies.zip(values).enumerate() {
            let smooth = if is_told { record.force_noise_at(frequency) } else { scale * UNTOLD_NOISE.powi(2) };
            let variance = 0.5 * smooth * value.norm_sqr();
            (0..2).for_each(|part| covariance[(from + 2 * place + part, from + 2 * place + part)] += variance);
        }
        let (force_at, response_at) = (record.force_at, record.response_at);
        measured.push(MeasuredRecord { force_at, response_at, residues, remainder });
    }
    let known = root * by_poles.transpose();
    covariance += known.transpose() * &known;
    let of_mean: Vec<f64> = found.poles.iter().flat_map(|pole| drift.of_mean(*pole)).collect();
    let drifting = Mat::from_fn(size, 2 * all, |i, j| by_poles[(i, j)] * of_mean[j].sqrt());
    covariance += &drifting * drifting.transpose();
    let pole = |&pole: &usize| Pole {
        angular_frequency: found.poles[pole][0].exp(),
        damping_ratio: Some(found.poles[pole][1].exp().min(MOST_DAMPING)),
    };
    MeasuredModes {
        piece,
        poles: kept.iter().map(pole).collect(),
        beside: (0..all).filter(|pole| !kept.contains(pole)).map(|number| pole(&number)).collect(),
        records: measured,
        sensor_at: None,
        remainder_frequencies,
        band,
        covariance,
        chi_square: Some(chi_square),
        missed_most: missed_most(records, &fit.residuals(&found.poles, &found.fitted)),
        undone_decay: 0.0,
        named: orthopanel_model::NamedShapes::default(),
        order: vec![],
    }
}

/// The line that is missed by most, of all records \[Hz\].
fn missed_most(records: &[RecordLines], left: &[Vec<Complex64>]) -> Option<f64> {
    let lines = records.iter().zip(left).flat_map(|(record, left)| {
        record.s.iter().zip(left).map(|(s, left)| (record.per_datum * left.norm_sqr(), s.im / TAU))
    });
    lines.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, frequency)| frequency)
}

/// Evenly in the logarithm, from the band's end to where modes alone carry the accelerance.
fn remainder_frequencies([lowest, highest]: [f64; 2]) -> Vec<f64> {
    let to = HIGHEST_REMAINDER.min(0.5 * highest).max(1.5 * lowest);
    let step = (to / lowest).ln() / (REMAINDER_VALUES - 1) as f64;
    (0..REMAINDER_VALUES).map(|k| lowest * (step * k as f64).exp()).collect()
}

impl RecordLines {
    /// Relative variance of the accelerance at a frequency \[Hz\] by the noise of the force.
    fn force_noise_at(&self, frequency: f64) -> f64 {
        let line = self.s.partition_point(|s| s.im < TAU * frequency).min(self.s.len().saturating_sub(1));
        self.force_noise.get(line).copied().unwrap_or(0.0)
    }
}
