//! How many poles the records show, and where: from the data alone.

use std::f64::consts::TAU;

use num_complex::Complex64;

use super::lines::RecordLines;
use super::modal_fit::{Fitted, ModalFit, PoleParameters, lambda};

/// Poles found, with the fit at them.
pub(super) struct Found {
    pub poles: PoleParameters,
    pub fitted: Fitted,
    pub freedom: f64,
}

/// A peak stands out of the lines around it by this factor in power, ...
const STANDS_OUT: f64 = 4.0;
/// ... and the power falls by this factor on both sides of it before it rises higher.
const PROMINENCE: f64 = 16.0;
/// Lines on either side that are around it.
const AROUND: usize = 150;
/// Damping ratios at which a pole begins.
const FIRST_ZETAS: [f64; 3] = [1e-3, 4e-3, 2e-2];
/// Evaluations of a fit on the way, and of the last.
const ON_THE_WAY: usize = 8;
const LAST: usize = 40;
/// Widths in lines over which the misfit is gathered for the next pole: a sharp one and a damped one.
const WIDTHS: [usize; 3] = [5, 21, 81];
/// Places without success after which the search ends.
const PATIENCE: usize = 2;
/// A pole closer than this to one that was tried is the same.
const SAME: f64 = 5e-3;

/// Poles at the peaks of the records, to begin with.
pub(super) fn peaks(records: &[RecordLines]) -> Option<PoleParameters> {
    Some(Spectrum::of(records)?.peaks())
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
    while failed < PATIENCE {
        let fit_now = ModalFit::new(records, &found.poles);
        let left = fit_now.residuals(&found.poles, &found.fitted);
        let Some(frequency) = spectrum.worst(&spectrum.sum(&left), records.len(), &tried) else { break };
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
    let found = pruned(records, found)?;
    fit(records, found.poles, LAST)
}

/// Refined poles, with lines that count by themselves near where they began; sorted.
fn fit(records: &[RecordLines], poles: PoleParameters, evaluations: usize) -> Option<Found> {
    let fit = ModalFit::new(records, &poles);
    let (mut poles, _) = fit.minimise(poles, evaluations)?;
    poles.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let fitted = fit.at(&poles)?;
    let freedom = fit.freedom(poles.len());
    Some(Found { poles, fitted, freedom })
}

/// With one more pole, begun at a frequency \[Hz\] with the damping that suits best; `None` where what is left there does not pay for it.
fn with_another(records: &[RecordLines], found: &Found, (left, frequency): (&[Vec<Complex64>], f64)) -> Option<Found> {
    let begun = FIRST_ZETAS.iter().flat_map(|zeta| {
        // Within a half-width or so on either side.
        [-1.0, -0.5, 0.0, 0.5, 1.0].map(|aside| [(TAU * frequency).ln() + aside * zeta, zeta.ln()])
    });
    let gained = begun.map(|pole| (taken_up(records, left, pole), pole));
    let (gain, pole) = gained.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let data = records.iter().map(|record| 2 * record.s.len()).sum::<usize>() as f64;
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
    let near = NEAR * pole[1].exp() * pole[0].exp();
    let of_record = |(record, left): (&RecordLines, &Vec<Complex64>)| {
        let lines = |frequency: f64| record.s.partition_point(|s| s.im < frequency);
        let [from, to] = [lines(lambda.im - near), lines(lambda.im + near)];
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

/// The misfit per datum, never below that of the noise alone.
fn per_datum(found: &Found) -> f64 {
    (found.fitted.misfit / found.freedom).max(1.0)
}

/// By how much one pole has to lower the misfit: more than noise would let it, and by a part that counts of what is left.
fn price(records: &[RecordLines], data: f64, left: &Found) -> f64 {
    let by_chance = (2 + 2 * records.len()) as f64 * data.ln() * per_datum(left);
    if per_datum(left) > SYSTEMATIC { by_chance.max(LEAST_PART * left.fitted.misfit) } else { by_chance }
}

/// Misfit per datum from which no noise leaves it: the records hold what no pole is, a force that is not linear or a panel that changed,
/// which many poles would mimic.
const SYSTEMATIC: f64 = 2.0;
/// Then a pole has to take up this part of the misfit.
const LEAST_PART: f64 = 0.1;

fn is_worth(records: &[RecordLines], without: &Found, with: &Found) -> bool {
    // Both on the same lines, those of the one with more poles.
    let fit = ModalFit::new(records, &with.poles);
    let misfit = fit.at(&without.poles).map_or(f64::INFINITY, |fitted| fitted.misfit);
    misfit - with.fitted.misfit > price(records, fit.data() as f64, with)
}

/// Leaves out poles that pay no more, the least first.
fn pruned(records: &[RecordLines], mut found: Found) -> Option<Found> {
    loop {
        let fit_now = ModalFit::new(records, &found.poles);
        let without = |pole: usize| {
            let mut poles = found.poles.clone();
            poles.remove(pole);
            poles
        };
        let loss = |pole: usize| {
            let poles = without(pole);
            fit_now.at(&poles).map_or(f64::INFINITY, |fitted| fitted.misfit - found.fitted.misfit)
        };
        let losses = (0..found.poles.len()).map(|pole| (loss(pole), pole));
        let Some((loss, pole)) = losses.min_by(|a, b| a.0.total_cmp(&b.0)) else { return Some(found) };
        if found.poles.len() == 1 || loss > price(records, fit_now.data() as f64, &found) {
            return Some(found);
        }
        found = fit(records, without(pole), ON_THE_WAY)?;
    }
}

/// The lines of all records on one grid of frequencies.
struct Spectrum {
    /// \[Hz\], evenly spaced.
    frequency: Vec<f64>,
    power: Vec<f64>,
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
        let mut spectrum = Self { frequency, power: vec![], places };
        // A resonance that wanders has more noise than its skirts: weighed line by line it would be no peak.
        let weighted = |record: &RecordLines| {
            let mut weights = record.weight.clone();
            let middle = weights.len() / 2;
            let usual =
                if weights.is_empty() { 0.0 } else { *weights.select_nth_unstable_by(middle, f64::total_cmp).1 };
            record.value.iter().map(|value| value * usual).collect()
        };
        spectrum.power = smooth(&spectrum.sum(&records.iter().map(weighted).collect::<Vec<_>>()), 3);
        Some(spectrum)
    }

    /// Sum of squares of all records on the grid.
    fn sum(&self, of: &[Vec<Complex64>]) -> Vec<f64> {
        let mut sum = vec![0.0; self.frequency.len()];
        for (values, places) in of.iter().zip(&self.places) {
            values.iter().zip(places).for_each(|(value, place)| sum[*place] += value.norm_sqr());
        }
        sum
    }

    /// A pole at each peak that stands out, at its frequency and half-width.
    fn peaks(&self) -> PoleParameters {
        let power = &self.power;
        let mut poles = vec![];
        for k in 1..power.len() - 1 {
            if !(power[k] > power[k - 1] && power[k] >= power[k + 1]) {
                continue;
            }
            let mut around: Vec<f64> = power[k.saturating_sub(AROUND)..(k + AROUND).min(power.len())].to_vec();
            let middle = around.len() / 2;
            let floor = *around.select_nth_unstable_by(middle, f64::total_cmp).1;
            // How far the power falls on either side before it rises above the peak.
            let falls = |lines: &mut dyn Iterator<Item = usize>| {
                lines.take_while(|line| power[*line] <= power[k]).fold(power[k], |least, line| least.min(power[line]))
            };
            let least = falls(&mut (0..k).rev()).max(falls(&mut (k + 1..power.len())));
            if power[k] > STANDS_OUT * floor && power[k] > PROMINENCE * least {
                let half = (k..power.len()).take_while(|line| power[*line] > 0.5 * power[k]).count();
                let step = self.frequency[1] - self.frequency[0];
                let zeta = (half as f64 * step / self.frequency[k]).clamp(1e-4, 0.1);
                poles.push([(TAU * self.frequency[k]).ln(), zeta.ln()]);
            }
        }
        if poles.is_empty() {
            let strongest = (0..power.len()).max_by(|a, b| power[*a].total_cmp(&power[*b])).unwrap_or(0);
            poles.push([(TAU * self.frequency[strongest]).ln(), FIRST_ZETAS[1].ln()]);
        }
        poles
    }

    /// The frequency \[Hz\] where the misfit rises furthest out of the noise of as many records, and was not tried.
    fn worst(&self, left: &[f64], records: usize, tried: &[f64]) -> Option<f64> {
        let is_new = |k: usize| tried.iter().all(|tried| (self.frequency[k] / tried).ln().abs() > SAME);
        let expected = 2.0 * records as f64;
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
