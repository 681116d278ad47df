//! An exponential window that the test file does not declare: it damps all modes by the same decay rate, and turns the lines between them.
//!
//! Averaged under $e^{-t/\tau}$, a frequency response stands at $s = 1/\tau + j\omega$. Taken for one at $j\omega$, every damping
//! ratio is too high by $1/(\omega\tau)$, most at low frequency, and frequencies are right. What gives it away is $s^2$ above the
//! resonances, a phase of $2/(\omega\tau)$ that no damping makes: the records are met better at the true $s$. Where the window is all the
//! damping there is, that goes as $1/\omega$ by itself, as no panel's does.

use std::f64::consts::TAU;

use orthopanel_model::{ModelError, Readable};

use super::other_law::is_clearly_less;
use super::problem::AcceleranceProblem;
use super::records::PlaceRecord;
use super::start::Start;
use super::told_damping::is_told;
use crate::{IdentifyError, PieceFit};

/// Misfit per datum above which the window may be what the model lacks.
const SUSPECT: f64 = 1.2;
/// Decay rates tried, as parts of that of the mode that dies away slowest: a window leaves each mode some damping of its own.
const MOST: f64 = 0.98;
/// A window whose decay rate is a smaller part of that is not worth a question.
const LEAST: f64 = 0.05;
/// Steps of the golden section: to a hundredth of the range.
const STEPS: usize = 9;
/// Decay rates of all modes that agree within this part, rms, over as many modes and such a range of frequencies, are a window's.
const ALIKE: f64 = 0.1;
const ALIKE_MODES: usize = 3;
const ALIKE_RANGE: f64 = 3.0;

/// A mode whose damping the records tell.
#[derive(Debug, Clone, Copy)]
struct DampedMode {
    /// Natural frequency \[Hz\].
    frequency: f64,
    /// Damping ratio.
    zeta: f64,
}

impl DampedMode {
    /// $\zeta\omega$ \[1/s\].
    fn decay(&self) -> f64 {
        self.zeta * TAU * self.frequency
    }
}

/// The question whether the records were averaged under an exponential window; `None` where nothing looks like one.
pub(super) fn asked(
    start: &Start,
    problem: &mut AcceleranceProblem,
    parameters: &[f64],
    fits: &[PieceFit],
) -> Result<Option<String>, IdentifyError> {
    let modes = fits.iter().flat_map(|fit| &fit.modes);
    let damped: Vec<DampedMode> = modes
        .filter_map(|mode| Some(DampedMode { frequency: mode.model, zeta: mode.damping.filter(is_told)?.value }))
        .collect();
    let slowest = damped.iter().map(DampedMode::decay).fold(f64::INFINITY, f64::min);
    if damped.is_empty() || problem.records().any(|record| record.decay_rate > 0.0) {
        return Ok(None);
    }
    if let Some(rate) = common_rate(&damped) {
        return Ok(Some(question(rate, &damped, "all modes die away at the same rate, as under it and no panel does")));
    }
    if !problem.noise_is_known() {
        return Ok(None);
    }
    let mut frequencies = Vec::new();
    for (index, own) in start.recorded.poles.iter().enumerate() {
        let modes = own.structure.modes_below(&problem.values(parameters, index), 1.4 * own.band, &[])?;
        frequencies.push(modes.iter().map(|mode| mode.frequency).collect::<Vec<f64>>());
    }
    let (cost, _) = promised(problem, parameters, &frequencies, 0.0)?;
    let mut before = problem.chi_square(cost);
    if before < SUSPECT {
        return Ok(None);
    }
    let most = MOST * slowest;
    let rate = least_cost(most, |rate| Ok(promised(problem, parameters, &frequencies, rate)?.0))?;
    let (cost, stepped) = promised(problem, parameters, &frequencies, rate)?;
    let mut after = problem.chi_square(cost);
    // Noise that was read off the misfit of a wrong model is too great.
    if problem.noise_is_to_learn() {
        let kept: Vec<Vec<PlaceRecord>> = problem.pieces.iter().map(|piece| piece.records.clone()).collect();
        let both = beside_learned_noise(problem, (parameters, stepped), &frequencies, rate);
        problem.pieces.iter_mut().zip(kept).for_each(|(piece, records)| piece.records = records);
        [before, after] = both?.map(|cost| problem.chi_square(cost));
    }
    let is_half = after < SUSPECT && after - 1.0 < 0.5 * (before - 1.0);
    if rate < LEAST * most || before < SUSPECT || !(is_half || is_clearly_less(after, before)) {
        return Ok(None);
    }
    let why = format!("misfit per datum {:.1} with it, {:.1} without", Readable(after), Readable(before));
    Ok(Some(question(rate, &damped, &why)))
}

/// The sums of squares without the window and with it, over the noise that is read off the misfit with it.
fn beside_learned_noise(
    problem: &mut AcceleranceProblem,
    (parameters, mut stepped): (&[f64], Vec<f64>),
    frequencies: &[Vec<f64>],
    rate: f64,
) -> Result<[f64; 2], ModelError> {
    let mut with = 0.0;
    // The first step ends near the minimum, not at it.
    for _ in 0..2 {
        set_rate(problem, rate);
        let learned = problem.learn_noise(&stepped);
        set_rate(problem, 0.0);
        learned?;
        (with, stepped) = promised(problem, parameters, frequencies, rate)?;
    }
    Ok([promised(problem, parameters, frequencies, 0.0)?.0, with])
}

fn question(rate: f64, told: &[DampedMode], why: &str) -> String {
    let tau = 1.0 / rate;
    // Two digits: what is asked is whether there was one, and its time constant stands in the analyser's setup.
    let shown: f64 = format!("{tau:.1e}").parse().unwrap_or(tau);
    let lowest = told.iter().min_by(|a, b| a.frequency.total_cmp(&b.frequency));
    let instead = lowest.map_or(String::new(), |mode| {
        let own = mode.zeta - rate / (TAU * mode.frequency);
        format!(
            "; at {:.1} Hz zeta is about {:.2e} then, not {:.2e}",
            Readable(mode.frequency),
            own.max(0.0),
            mode.zeta
        )
    });
    format!(
        "damping is too high towards low frequency, by 1/(omega tau), as records are that were averaged under an exponential window ({why}): \
         was there one of about {shown} s? write window_decay = {shown}, its time constant in s, in each [[measurement]]{instead}"
    )
}

/// The decay rate that all modes share; `None` where they do not, or are too few to tell.
fn common_rate(told: &[DampedMode]) -> Option<f64> {
    let count = told.len() as f64;
    let mean = told.iter().map(DampedMode::decay).sum::<f64>() / count;
    let spread = (told.iter().map(|mode| (mode.decay() / mean - 1.0).powi(2)).sum::<f64>() / count).sqrt();
    let ends = told.iter().map(|mode| mode.frequency);
    let (low, high) = (ends.clone().fold(f64::INFINITY, f64::min), ends.fold(0.0, f64::max));
    (told.len() >= ALIKE_MODES && high > ALIKE_RANGE * low && spread < ALIKE).then_some(mean)
}

/// The sum of squares that one step from these parameters promises, with all records at a decay rate \[1/s\] and each mode's own less
/// by it; and where the step ends.
fn promised(
    problem: &mut AcceleranceProblem,
    parameters: &[f64],
    frequencies: &[Vec<f64>],
    rate: f64,
) -> Result<(f64, Vec<f64>), ModelError> {
    let mut moved = parameters.to_vec();
    for (piece, frequencies) in frequencies.iter().enumerate() {
        let (offset, count) = (problem.zeta_offset(piece), problem.pieces[piece].free_zetas);
        for (log_zeta, frequency) in moved.iter_mut().skip(offset).take(count).zip(frequencies) {
            let zeta = log_zeta.exp();
            *log_zeta = (zeta - rate / (TAU * frequency)).max((1.0 - MOST) * zeta).ln();
        }
    }
    set_rate(problem, rate);
    let at = problem.linearise(&moved);
    set_rate(problem, 0.0);
    let at = at?;
    let Some(covariance) = at.covariance() else { return Ok((at.cost, moved)) };
    let size = moved.len();
    let step: Vec<f64> = (0..size).map(|i| (0..size).map(|j| covariance[(i, j)] * at.gradient[j]).sum()).collect();
    let promise: f64 = step.iter().zip(&at.gradient).map(|(step, gradient)| step * gradient).sum();
    let ends = moved.iter().zip(&step).zip(problem.bounds());
    let stepped = ends.map(|((at, step), (low, high))| (at - step).clamp(low, high)).collect();
    Ok(((at.cost - promise).max(0.0), stepped))
}

fn set_rate(problem: &mut AcceleranceProblem, rate: f64) {
    let records = problem.pieces.iter_mut().flat_map(|piece| &mut piece.records);
    records.for_each(|record| record.decay_rate = rate);
}

/// Where a function is least between zero and `most`, by golden section.
fn least_cost(most: f64, mut of: impl FnMut(f64) -> Result<f64, ModelError>) -> Result<f64, ModelError> {
    const PART: f64 = 0.618_033_988_749_894_9;
    let (mut low, mut high) = (0.0, most);
    let mut inner = [high - PART * (high - low), low + PART * (high - low)];
    let mut costs = [of(inner[0])?, of(inner[1])?];
    for _ in 0..STEPS {
        if costs[0] < costs[1] {
            high = inner[1];
            inner = [high - PART * (high - low), inner[0]];
            costs = [of(inner[0])?, costs[0]];
        } else {
            low = inner[0];
            inner = [inner[1], low + PART * (high - low)];
            costs = [costs[1], of(inner[1])?];
        }
    }
    Ok(inner[usize::from(costs[1] < costs[0])])
}
