//! Resonances that overlap, fitted together: each with its own frequency and damping, whatever the model says of them.

use std::f64::consts::TAU;
use std::ops::Range;

use num_complex::Complex64;
use rayon::prelude::*;

use super::pole::Pole;
use super::poles::{MOST_DAMPING, mean_pole};
use super::records::PlaceRecord;
use super::resonance_fit::{ResonanceFit, resonance};
use crate::least_squares::{Ending, descend};

/// A mode of the model as the records of a piece see it, at the frequency and damping where a search may begin.
#[derive(Debug, Clone)]
pub(super) struct NearMode {
    /// \[Hz\].
    pub frequency: f64,
    pub zeta: f64,
    /// $W(l_1)W(l_x)$ of each record.
    pub products: Vec<f64>,
}

/// Modes overlap that lie nearer than so many of their half widths together. Beyond six a neighbour still bends what a
/// straight background takes up, and shifts damping by 0.3 %.
const OVERLAP: f64 = 15.0;
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

/// The resonances of a group, less the model's other modes.
struct GroupFit<'a> {
    fit: ResonanceFit<'a>,
    /// $\ln f$ and $\ln\zeta$ of each mode.
    start: Vec<f64>,
    bounds: Vec<(f64, f64)>,
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
        Some(Self { fit: ResonanceFit { record, lines, value }, start, bounds })
    }

    fn pole(&self, mode: usize) -> Option<Pole> {
        let linearise = |p: &[f64]| Ok::<_, std::convert::Infallible>(self.fit.linearise(p));
        let (minimum, settled) = descend(linearise, &self.start, &self.bounds, PATIENCE).ok()?;
        let pole = self.fit.pole(&minimum, mode, self.fit.record.line_step())?;
        let (low, high) = self.bounds[2 * mode];
        let at = minimum.parameters[2 * mode];
        let free = at > low + 1e-9 && at < high - 1e-9;
        (settled && free && pole.log_zeta_std < 0.5 && pole.zeta < MOST_DAMPING).then_some(pole)
    }
}
