//! How many poles the records show, and where: from the data alone.

use std::f64::consts::TAU;

use num_complex::Complex64;
use rayon::prelude::*;

use super::drift::Drift;
use super::joint_fit::{Found, LAST, SYSTEMATIC, fit};
use super::lines::RecordLines;
use super::modal_fit::{FittedRecord, ModalFit, PoleParameters, lambda};
use super::stabilisation::stable_poles;
use crate::interruption::heed;

/// Damping ratios at which a pole begins.
const FIRST_ZETAS: [f64; 3] = [1e-3, 4e-3, 2e-2];
/// Part of the misfit by less than which it falls where a fit ends on the way: of tens of thousands of data the logarithm of the likelihood is then
/// told to 0.2.
const ON_THE_WAY: f64 = 1e-5;
/// Widths in lines over which the misfit is gathered for the next pole: a sharp one and a damped one.
const WIDTHS: [usize; 3] = [5, 21, 81];
/// Places without success after which the search ends.
const PATIENCE: usize = 2;
/// Where a pole beyond the band begins, over its end: as near as its skirt is seen from there.
const BEYOND: f64 = 1.01;
/// Of so many lines of the band one counts to its end.
const LAST_LINES: usize = 16;
/// A pole closer than this to one that was tried is the same.
const SAME: f64 = 5e-3;

/// A part of the band ends so many times higher than it begins, and holds so many lines at least.
const PART: f64 = 1.5;
const LEAST_LINES: usize = 64;
/// Poles of two parts that lie nearer to each other than this part of their half-width are one.
const ONE: f64 = 0.3;
/// Lines beside a part that its fit sees, as a factor of frequency.
const OVERLAP: f64 = 1.2;

/// Poles from the data alone, part after part of a band \[Hz\], and up to where they explain the records: beyond, modes overlap so far that no pole
/// stands by itself. The whole band where they do nowhere, or where no pole stands below.
///
/// What the poles of the other parts show in a part, a free vibration that the record's end cuts off or a skirt, is removed from it, and its own
/// poles are found anew; those that explain more are kept.
pub(super) fn in_parts(records: &[RecordLines], (band, is_told): ([f64; 2], bool)) -> (PoleParameters, f64) {
    let step = records
        .iter()
        .filter_map(|record| Some((record.s.last()?.im - record.s.first()?.im) / TAU / record.s.len() as f64));
    let step = step.fold(0.0, f64::max);
    let mut ends = vec![band[0]];
    while let Some(&from) = ends.last().filter(|from| **from < band[1]) {
        let to = (PART * from).max(from + LEAST_LINES as f64 * step);
        ends.push(if PART * to > band[1] { band[1] } else { to });
    }
    let seen = |ends: &[f64]| -> Vec<RecordLines> {
        records.iter().map(|record| record.between([ends[0] / OVERLAP, ends[1] * OVERLAP])).collect()
    };
    let alone: Vec<Option<Part>> =
        ends.par_windows(2).map(|ends| Part::of([ends[0], ends[1]], &seen(ends), is_told)).collect();
    heed();
    let beside = |(number, ends): (usize, &[f64])| {
        let mut seen = seen(ends);
        let others = alone.iter().enumerate().filter(|(other, _)| *other != number);
        others.filter_map(|(_, other)| other.as_ref()).for_each(|other| other.remove_from(&mut seen));
        Part::of([ends[0], ends[1]], &seen, is_told)
    };
    let again: Vec<Option<Part>> = ends.par_windows(2).enumerate().map(beside).collect();
    heed();
    let misfit = |part: &Option<Part>| part.as_ref().map_or(f64::INFINITY, |part| part.per_datum);
    let parts: Vec<Option<Part>> = alone
        .into_iter()
        .zip(again)
        .map(|(alone, again)| if misfit(&again) < misfit(&alone) { again } else { alone })
        .collect();
    let explained = parts.iter().position(|part| part.as_ref().is_some_and(|part| !part.explained));
    let hold_poles = |count: &usize| parts.iter().take(*count).flatten().any(|part| !part.poles.is_empty());
    let count = explained.filter(hold_poles).unwrap_or(parts.len());
    let mut poles: PoleParameters = parts.into_iter().take(count).flatten().flat_map(|part| part.poles).collect();
    // A pole at the end of a part may be found from either side.
    poles.sort_by(|a, b| a[0].total_cmp(&b[0]));
    poles.dedup_by(|b, a| b[0] - a[0] < ONE * b[1].exp());
    (poles, ends[count])
}

/// What a part of the band shows.
struct Part {
    /// The poles inside it.
    poles: PoleParameters,
    /// Of each record, one a pole.
    residues: Vec<Vec<Complex64>>,
    per_datum: f64,
    /// Whether noise and drift between records explain what its poles leave.
    explained: bool,
}

impl Part {
    /// Of the lines that the part and what lies beside it have, with its ends \[Hz\].
    fn of([from, to]: [f64; 2], seen: &[RecordLines], is_told: bool) -> Option<Self> {
        let mut found = poles(seen, stable_poles(seen))?;
        if !(is_told || found.by_noise()) {
            Drift::removed(&mut seen.to_vec(), &mut found);
        }
        let own = |pole: &usize| (from..to).contains(&(found.poles[*pole][0].exp() / TAU));
        let own: Vec<usize> = (0..found.poles.len()).filter(own).collect();
        let of_record = |record: &FittedRecord| own.iter().map(|pole| record.residue(*pole)).collect();
        Some(Self {
            poles: own.iter().map(|pole| found.poles[*pole]).collect(),
            residues: found.fitted.records.iter().map(of_record).collect(),
            explained: found.by_noise(),
            per_datum: found.per_datum(),
        })
    }

    /// Removes what its poles show on the lines of another part.
    fn remove_from(&self, records: &mut [RecordLines]) {
        records.par_iter_mut().zip(&self.residues).for_each(|(record, residues)| {
            let mut value = std::mem::take(&mut record.value);
            for (pole, residue) in self.poles.iter().zip(residues) {
                record.add_pole(&mut value, lambda(*pole)[0], -residue);
            }
            record.value = value;
        });
    }
}

/// The poles of all parts of a band together, found one by one where these do not explain the records; where their noise is told, with poles beyond.
pub(super) fn joined(records: &[RecordLines], start: PoleParameters, is_told: bool) -> Option<Found> {
    let found = pruned(records, fit(records, start, LAST)?);
    let found = if found.by_noise() { found } else { poles(records, found.poles)? };
    let found = if is_told { with_poles_beyond(records, found) } else { found };
    fit(records, found.poles.clone(), LAST).or(Some(found))
}

/// With poles beyond the end of the band, as many as pay: resonances there of which no line shows more than a skirt, which powers of $s$ follow slowly.
fn with_poles_beyond(records: &[RecordLines], mut found: Found) -> Found {
    let end = |record: &RecordLines| record.s.last().map_or(0.0, |s| s.im / TAU);
    let end = records.iter().map(end).fold(0.0, f64::max);
    let within = |found: &Found| found.poles.iter().filter(|pole| pole[0].exp() < TAU * end).count();
    loop {
        let left = ModalFit::new(records, &found.poles).residuals(&found.poles, &found.fitted);
        if at_end(records, &left) < SYSTEMATIC {
            return found;
        }
        match with_another(records, &found, (&left, BEYOND * end)) {
            // What ends within the band was looked for there.
            Some(more) if within(&more) == within(&found) && is_worth(records, &found, &more) => found = more,
            _ => return found,
        }
    }
}

/// Misfit per datum over the last lines of the band.
fn at_end(records: &[RecordLines], left: &[Vec<Complex64>]) -> f64 {
    let of_record = |(record, left): (&RecordLines, &Vec<Complex64>)| {
        let last = &left[left.len() - left.len() / LAST_LINES..];
        (0.5 * record.per_datum * last.iter().map(Complex64::norm_sqr).sum::<f64>(), last.len())
    };
    let sums = records.iter().zip(left).map(of_record);
    let (sum, count) = sums.fold((0.0, 0), |(sum, count), (own, lines)| (sum + own, count + lines));
    sum / count.max(1) as f64
}

/// The poles of all records in common, from a start.
///
/// A pole stays where it lowers the misfit by more than the logarithm of the number of data for each of its parameters, in
/// units of the misfit per datum that is left (Schwarz, Ann. Stat. 6, 1978).
pub(super) fn poles(records: &[RecordLines], start: PoleParameters) -> Option<Found> {
    let spectrum = Spectrum::of(records)?;
    let mut found = fit(records, start, ON_THE_WAY)?;
    let mut tried: Vec<f64> = vec![];
    let mut failed = 0;
    let expected = records.iter().map(|record| 2.0 / record.per_datum).sum();
    while failed < PATIENCE {
        let fit_now = ModalFit::new(records, &found.poles);
        let left = fit_now.residuals(&found.poles, &found.fitted);
        let Some(frequency) = spectrum.worst(&spectrum.sum(&left), expected, &tried) else { break };
        match with_another(records, &found, (&left, frequency)) {
            Some(more) if is_worth(records, &found, &more) => {
                found = more;
                failed = 0;
            }
            _ => {
                tried.push(frequency);
                failed += 1;
            }
        }
    }
    let found = pruned(records, found);
    fit(records, found.poles, LAST)
}

/// With one more pole, begun at a frequency \[Hz\] with the damping that suits best; `None` where what is left there does not pay for it.
fn with_another(records: &[RecordLines], found: &Found, (left, frequency): (&[Vec<Complex64>], f64)) -> Option<Found> {
    let begun = FIRST_ZETAS.iter().flat_map(|zeta| {
        // Within a half-width or so on either side.
        [-1.0, -0.5, 0.0, 0.5, 1.0].map(|aside| [(TAU * frequency).ln() + aside * zeta, zeta.ln()])
    });
    let gained = begun.map(|pole| (taken_up(records, left, pole), pole));
    let (gain, pole) = gained.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let data = records.iter().map(|record| 2.0 * record.s.len() as f64 / record.per_datum).sum::<f64>();
    // The columns of the other poles are left out here, which makes a gain too small where poles are close.
    if gain < PROMISING * price(records, data, found) {
        return None;
    }
    let poles = found.poles.iter().copied().chain([pole]).collect();
    fit(records, poles, ON_THE_WAY)
}

/// Part of a pole's price that a first guess of its gain has to reach.
const PROMISING: f64 = 0.25;

/// What one more pole takes up of the misfit that is left, as if it stood alone.
fn taken_up(records: &[RecordLines], left: &[Vec<Complex64>], pole: [f64; 2]) -> f64 {
    let [lambda, ..] = lambda(pole);
    let of_record = |(record, left): (&RecordLines, &Vec<Complex64>)| {
        let [from, to] = around(record, pole);
        // Of $\mathrm{Re}$ and $\mathrm{Im}$ of the residue together: a complex least squares with the pole alone.
        let (mut cross, mut square) = (Complex64::ZERO, f64::MIN_POSITIVE);
        for ((s, weight), left) in record.s.iter().zip(&record.weight).zip(left).take(to).skip(from) {
            let column = *weight * (s - lambda).inv();
            cross += column.conj() * left;
            square += column.norm_sqr();
        }
        cross.norm_sqr() / square
    };
    records.iter().zip(left).map(of_record).sum()
}

/// Half-widths on either side that count.
const NEAR: f64 = 10.0;

/// The lines around a pole, from and to.
fn around(record: &RecordLines, pole: [f64; 2]) -> [usize; 2] {
    let near = NEAR * pole[1].exp() * pole[0].exp();
    [-near, near].map(|aside| record.s.partition_point(|s| s.im < lambda(pole)[0].im + aside))
}

/// By how much one pole has to lower the misfit: more than noise would let it, or what is left where that is more.
fn price(records: &[RecordLines], data: f64, left: &Found) -> f64 {
    (2 + 2 * records.len()) as f64 * data.ln() * left.per_datum().max(1.0)
}

/// Where noise does not explain what poles leave, one more has to take up this part of the misfit around it, as a resonance that was missing does.
const LEAST_PART: f64 = 0.5;

fn is_worth(records: &[RecordLines], without: &Found, with: &Found) -> bool {
    // Both on the same lines, those of the one with more poles.
    let fit = ModalFit::new(records, &with.poles);
    let Some(fitted) = fit.at(&without.poles) else { return true };
    if fitted.misfit - with.fitted.misfit <= price(records, fit.data(), with) {
        return false;
    }
    if with.by_noise() {
        return true;
    }
    let is_new = |pole: &&[f64; 2]| without.poles.iter().all(|other| (other[0] - pole[0]).abs() > pole[1].exp());
    let Some(new) = with.poles.iter().find(is_new) else { return true };
    // Beyond the band it is no mode that is told, and as good as any power of s.
    let is_outside = |record: &RecordLines| {
        let [from, to] = around(record, *new);
        from == to
    };
    if records.iter().all(is_outside) {
        return true;
    }
    let around = |left: &[Vec<Complex64>]| -> f64 {
        let of_record = |(record, left): (&RecordLines, &Vec<Complex64>)| {
            let [from, to] = around(record, *new);
            left[from..to].iter().map(Complex64::norm_sqr).sum::<f64>()
        };
        records.iter().zip(left).map(of_record).sum()
    };
    let left = around(&fit.residuals(&with.poles, &with.fitted));
    left < (1.0 - LEAST_PART) * around(&fit.residuals(&without.poles, &fitted))
}

/// Leaves out poles that pay no more, the least first, as long as the others can be fitted without them.
pub(super) fn pruned(records: &[RecordLines], mut found: Found) -> Found {
    loop {
        let loss = |pole: usize| found.fitted.records.iter().map(|record| record.loss_without(pole)).sum::<f64>();
        let losses = (0..found.poles.len()).map(|pole| (loss(pole), pole));
        let Some((loss, pole)) = losses.min_by(|a, b| a.0.total_cmp(&b.0)) else { return found };
        let data = ModalFit::new(records, &found.poles).data();
        if found.poles.len() == 1 || loss > price(records, data, &found) {
            return found;
        }
        let mut poles = found.poles.clone();
        poles.remove(pole);
        let Some(without) = fit(records, poles, ON_THE_WAY) else { return found };
        found = without;
    }
}

/// The lines of all records on one grid of frequencies.
struct Spectrum {
    /// \[Hz\], evenly spaced.
    frequency: Vec<f64>,
    /// Number of each record's line on the grid.
    places: Vec<Vec<usize>>,
}

impl Spectrum {
    /// On the grid of the record with the most lines.
    fn of(records: &[RecordLines]) -> Option<Self> {
        let finest = records.iter().max_by_key(|record| record.s.len())?;
        let frequency: Vec<f64> = finest.s.iter().map(|s| s.im / TAU).collect();
        if frequency.len() < 3 {
            return None;
        }
        let on_grid = |s: &Complex64| frequency.partition_point(|f| *f < s.im / TAU).min(frequency.len() - 1);
        let places = records.iter().map(|record| record.s.iter().map(on_grid).collect()).collect();
        Some(Self { frequency, places })
    }

    /// Sum of squares of all records on the grid.
    fn sum(&self, of: &[Vec<Complex64>]) -> Vec<f64> {
        let mut sum = vec![0.0; self.frequency.len()];
        for (values, places) in of.iter().zip(&self.places) {
            values.iter().zip(places).for_each(|(value, place)| sum[*place] += value.norm_sqr());
        }
        sum
    }

    /// The frequency \[Hz\] where the misfit rises furthest out of what noise leaves on a line, and was not tried.
    fn worst(&self, left: &[f64], expected: f64, tried: &[f64]) -> Option<f64> {
        let is_new = |k: usize| tried.iter().all(|tried| (self.frequency[k] / tried).ln().abs() > SAME);
        let mut worst: Option<(f64, usize)> = None;
        for width in WIDTHS {
            let gathered = smooth(left, width);
            for (k, value) in gathered.iter().enumerate().filter(|(k, _)| is_new(*k)) {
                // In standard deviations of the mean of as many squares.
                let excess = (value - expected) * (width as f64).sqrt();
                if worst.is_none_or(|(most, _)| excess > most) {
                    worst = Some((excess, k));
                }
            }
        }
        worst.map(|(_, k)| self.frequency[k])
    }
}

/// Running mean over so many lines.
fn smooth(values: &[f64], width: usize) -> Vec<f64> {
    let mut sums = Vec::with_capacity(values.len() + 1);
    sums.push(0.0);
    for value in values {
        sums.push(sums[sums.len() - 1] + value);
    }
    let half = width / 2;
    let mean = |k: usize| {
        let (from, to) = (k.saturating_sub(half), (k + half + 1).min(values.len()));
        (sums[to] - sums[from]) / (to - from) as f64
    };
    (0..values.len()).map(mean).collect()
}
