//! Resonances that overlap, fitted together: each with its own frequency and damping, whatever the model says of them.

use std::f64::consts::TAU;
use std::ops::Range;

use faer::Mat;
use num_complex::Complex64;
use rayon::prelude::*;

use super::poles::{MOST_DAMPING, Pole, mean_pole, project_out};
use super::records::{PlaceRecord, variance_beneath_window};
use crate::least_squares::{Ending, Linearised, Quadratic, descend};

/// A mode of the model as the records of a piece see it, at the frequency and damping where a search may begin.
#[derive(Debug, Clone)]
pub(super) struct NearMode {
    /// \[Hz\].
    pub frequency: f64,
    pub zeta: f64,
    /// $W(l_1)W(l_x)$ of each record.
    pub products: Vec<f64>,
}

/// Modes overlap that lie nearer than so many of their half widths together.
const OVERLAP: f64 = 6.0;
/// Most neighbours on either side that are fitted with a mode; the model stands for the others.
const NEIGHBOURS: usize = 2;
/// Half widths beyond the outer modes that take part, and the fewest lines.
const MARGIN: f64 = 4.0;
const LEAST_LINES: usize = 15;
const PATIENCE: Ending = Ending { most_iterations: 40, small_gain: 1e-6, longest_step: 0.5, ..Ending::SMOOTH };

/// What a mode's neighbours do to its resonance.
pub(super) enum Overlap {
    /// None overlaps it.
    Alone,
    /// Fitted together with those that do.
    Told(Pole),
    /// They hide it from every record.
    Hidden,
}

/// The pole of mode number `mode` among `modes` (rising), fitted with those that overlap it.
pub(super) fn group_pole(records: &[PlaceRecord], modes: &[NearMode], mode: usize) -> Overlap {
    let width = |mode: &NearMode| mode.zeta * mode.frequency;
    let Some(own) = modes.get(mode) else { return Overlap::Alone };
    let overlaps =
        |other: usize| (modes[other].frequency - own.frequency).abs() < OVERLAP * (width(&modes[other]) + width(own));
    let lowest = (mode.saturating_sub(NEIGHBOURS)..mode).find(|&other| overlaps(other)).unwrap_or(mode);
    let highest =
        (mode + 1..modes.len().min(mode + NEIGHBOURS + 1)).rev().find(|&other| overlaps(other)).unwrap_or(mode);
    if lowest == highest {
        return Overlap::Alone;
    }
    let group = lowest..highest + 1;
    let of_record = |(index, record): (usize, &PlaceRecord)| {
        let fit = GroupFit::new(record, modes, group.clone(), index)?;
        fit.pole(mode - lowest)
    };
    let own: Vec<Pole> = records.par_iter().enumerate().filter_map(of_record).collect();
    mean_pole(&own).map_or(Overlap::Hidden, Overlap::Told)
}

/// $H \approx \sum_k A_ks^2/d_k(s) + B + C(f-f_0)$ over the model's other modes, amplitudes eliminated.
struct GroupFit<'a> {
    record: &'a PlaceRecord,
    lines: Range<usize>,
    /// The record less the other modes.
    value: Vec<Complex64>,
    /// $\ln f$ and $\ln\zeta$ of each mode.
    start: Vec<f64>,
    bounds: Vec<(f64, f64)>,
}

fn resonance(s: Complex64, frequency: f64, zeta: f64) -> Complex64 {
    let omega = TAU * frequency;
    s * s / (s * s + 2.0 * zeta * omega * s + omega * omega)
}

impl<'a> GroupFit<'a> {
    fn new(record: &'a PlaceRecord, modes: &[NearMode], group: Range<usize>, index: usize) -> Option<Self> {
        let own = &modes[group.clone()];
        let margin = |mode: &NearMode| MARGIN * (mode.zeta * mode.frequency + record.decay_rate / TAU);
        let (first, last) = (own.first()?, own.last()?);
        let start_line = record.frequency.partition_point(|&line| line < first.frequency - margin(first));
        let end_line = record.frequency.partition_point(|&line| line <= last.frequency + margin(last));
        let lines = start_line.saturating_sub(LEAST_LINES)..(end_line + LEAST_LINES).min(record.frequency.len());
        if lines.len() < 4 * LEAST_LINES.min(8) + 4 * own.len() {
            return None;
        }
        let others = || modes.iter().enumerate().filter(|(mode, _)| !group.contains(mode)).map(|(_, mode)| mode);
        let value = lines.clone().map(|line| {
            let s = record.s(line);
            let of_others: Complex64 =
                others().map(|mode| mode.products[index] * resonance(s, mode.frequency, mode.zeta)).sum();
            record.value[line] - of_others
        });
        // No mode passes the middle between its neighbours.
        let reach = |mode: &NearMode| (2.0 * mode.zeta).max(0.01);
        let start: Vec<f64> = own.iter().flat_map(|mode| [mode.frequency.ln(), mode.zeta.ln()]).collect();
        let bounds = own.iter().flat_map(|mode| {
            let at = mode.frequency.ln();
            [(at - reach(mode), at + reach(mode)), (1e-7_f64.ln(), 0.5_f64.ln())]
        });
        let (value, bounds) = (value.collect(), bounds.collect());
        Some(Self { record, lines, value, start, bounds })
    }

    fn pole(&self, mode: usize) -> Option<Pole> {
        let linearise = |p: &[f64]| Ok::<_, std::convert::Infallible>(self.linearise(p));
        let (minimum, settled) = descend(linearise, &self.start, &self.bounds, PATIENCE).ok()?;
        let covariance = minimum.at.covariance()?;
        let data = 2.0 * self.lines.len() as f64 - (2 * self.start.len() + 4) as f64;
        let scale = if data > 0.0 { (minimum.at.cost / data).max(1.0) } else { 1.0 };
        let (frequency, zeta) = (minimum.parameters[2 * mode].exp(), minimum.parameters[2 * mode + 1].exp());
        let mut pole = Pole { frequency, zeta, log_zeta_std: f64::INFINITY };
        let step = self.record.frequency.get(1)? - self.record.frequency.first()?;
        let beneath = variance_beneath_window(pole.decay_rate(), self.record.decay_rate, 1.0 / step);
        pole.log_zeta_std = (scale * beneath * covariance[(2 * mode + 1, 2 * mode + 1)]).sqrt();
        let (low, high) = self.bounds[2 * mode];
        let at = minimum.parameters[2 * mode];
        let free = at > low + 1e-9 && at < high - 1e-9;
        (settled && free && pole.log_zeta_std < 0.5 && zeta < MOST_DAMPING).then_some(pole)
    }

    fn linearise(&self, parameters: &[f64]) -> Quadratic {
        let residuals = self.residuals(parameters);
        let columns: Vec<Vec<f64>> = (0..parameters.len())
            .map(|i| {
                // Well inside a half-power width.
                let step = if i % 2 == 0 { 1e-3 * parameters[i + 1].exp().max(1e-6) } else { 1e-3 };
                let shifted = |sign: f64| {
                    let mut at = parameters.to_vec();
                    at[i] += sign * step;
                    self.residuals(&at)
                };
                let (low, high) = (shifted(-1.0), shifted(1.0));
                high.iter().zip(&low).map(|(high, low)| (high - low) / (2.0 * step)).collect()
            })
            .collect();
        let jacobian = Mat::from_fn(residuals.len(), parameters.len(), |i, j| columns[j][i]);
        Linearised { jacobian, residuals }.quadratic()
    }

    fn residuals(&self, parameters: &[f64]) -> Vec<f64> {
        let Self { record, lines, .. } = self;
        let (from, to) = (record.frequency[lines.start], record.frequency[lines.end - 1]);
        let even = record.variance[lines.clone()].iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        let mut columns = vec![Vec::with_capacity(lines.len()); parameters.len() / 2 + 2];
        let mut right = Vec::with_capacity(lines.len());
        for (line, value) in lines.clone().zip(&self.value) {
            let variance = if record.variance_known { record.variance[line] } else { even };
            let weight = (2.0 / variance).sqrt();
            let s = record.s(line);
            let (modes, straight) = columns.split_at_mut(parameters.len() / 2);
            for (column, mode) in modes.iter_mut().zip(parameters.chunks_exact(2)) {
                let (frequency, zeta) = (mode[0].exp(), mode[1].exp());
                column.push(weight * 2.0 * zeta * resonance(s, frequency, zeta));
            }
            straight[0].push(Complex64::new(weight, 0.0));
            straight[1].push(Complex64::new(weight * (record.frequency[line] - 0.5 * (from + to)) / (to - from), 0.0));
            right.push(weight * value);
        }
        project_out(columns, right).into_iter().flat_map(|value| [value.re, value.im]).collect()
    }
}
