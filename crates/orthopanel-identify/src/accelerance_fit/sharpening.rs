//! From constants that are roughly right to where a fit line by line may begin, without matching a pole.

use super::problem::{AcceleranceProblem, PieceProblem, is_far_from_noise};
use super::recorded::Recorded;
use super::records::PlaceRecord;
use super::smeared::smeared;
use super::synthesis::DampingLaw;
use crate::IdentifyError;
use crate::free_constants::FreeConstants;
use crate::least_squares::{Ending, Minimum, descend};

/// Constants and damping on the way.
#[derive(Debug, Clone)]
pub(super) struct Rough {
    /// Parameters of the free constants.
    pub constants: Vec<f64>,
    /// $\ln\zeta$ of the lowest modes of each piece.
    pub log_zetas: Vec<Vec<f64>>,
    /// $\ln\zeta$ of the others.
    pub usual_log_zeta: f64,
    /// Misfit per datum of the last records, beside the size of their lines.
    pub misfit: f64,
}

impl Rough {
    /// Parameters of a problem.
    pub(super) fn of(problem: &AcceleranceProblem, parameters: &[f64]) -> Self {
        let (constants, log_zetas) = parameters.split_at(problem.constants.count());
        let mut log_zetas = log_zetas.iter().copied();
        let of_piece = |piece: &PieceProblem| log_zetas.by_ref().take(piece.free_zetas).collect();
        Self {
            constants: constants.to_vec(),
            log_zetas: problem.pieces.iter().map(of_piece).collect(),
            usual_log_zeta: problem.usual_log_zeta,
            misfit: f64::INFINITY,
        }
    }

    /// Geometric mean of the damping ratios.
    fn mean_zeta(&self) -> f64 {
        let logs: Vec<f64> = self.log_zetas.iter().flatten().copied().collect();
        (logs.iter().sum::<f64>() / logs.len().max(1) as f64).exp()
    }
}

/// Modes are summed up to here, in bands, while records are wide.
const WIDE_REACH: f64 = 1.5;
/// Each search ends where a step promises no more of its sum of squares than this.
const LITTLE: f64 = 0.05;
const STEPS: usize = 10;

/// The fit of every line at constants and damping.
pub(super) fn problem_at(
    recorded: &Recorded,
    constants: &FreeConstants,
    rough: &Rough,
    law: DampingLaw,
    (reach, records): (f64, impl Fn(&[PlaceRecord]) -> Vec<PlaceRecord>),
) -> Result<(AcceleranceProblem, Vec<f64>), IdentifyError> {
    let mut pieces = Vec::new();
    let mut parameters = rough.constants.clone();
    for ((own, poles), log_zetas) in recorded.pieces.iter().zip(&recorded.poles).zip(&rough.log_zetas) {
        let values = constants.values(&rough.constants, own.index);
        let modes = poles.structure.modes_below(&values, reach.min(poles.structure.reach()) * poles.band, &[])?;
        let frequencies: Vec<f64> = modes.iter().map(|mode| mode.frequency).collect();
        let synthesis = poles.structure.synthesis(&values, frequencies.len().max(1))?;
        let piece = PieceProblem::new(own.index, own.sizes, synthesis, records(&own.records), &frequencies);
        let zeta = |mode: usize| log_zetas.get(mode).copied().unwrap_or(rough.usual_log_zeta);
        parameters.extend((0..piece.free_zetas).map(zeta));
        pieces.push(piece);
    }
    Ok((AcceleranceProblem::new(constants.clone(), law, pieces, rough.usual_log_zeta), parameters))
}

/// A misfit per datum above this, half of the lines' own size, is no start at all.
const LOST: f64 = 25.0;
/// and above this once records are narrower, a seventh of it, the model lacks something that no constants make up for.
const LACKING: f64 = 2.0;
/// Records narrower than this part of the damping ratios look as they are.
const NARROW: f64 = 0.25;

/// Fits the records made wide, then narrower by half each time until they look as they are; `None` where the widest already
/// are missed.
///
/// Wide resonances overlap, so that the misfit has a slope towards them; each fit leaves them near enough for the next.
fn sharpen(
    recorded: &Recorded,
    constants: &FreeConstants,
    mut rough: Rough,
    law: DampingLaw,
    widest: f64,
) -> Result<Option<Rough>, IdentifyError> {
    let mut part = widest;
    while part == widest || (narrows(recorded, part) && part > NARROW * rough.mean_zeta()) {
        rough = fit_wide(recorded, constants, &rough, law, part)?;
        if rough.misfit.is_nan() || rough.misfit > if part == widest { LOST } else { LACKING } {
            return Ok(None);
        }
        part *= 0.5;
    }
    Ok(Some(rough))
}

/// Fits the records made as wide as this part of the frequency.
pub(super) fn fit_wide(
    recorded: &Recorded,
    constants: &FreeConstants,
    rough: &Rough,
    law: DampingLaw,
    part: f64,
) -> Result<Rough, IdentifyError> {
    let wide = |records: &[PlaceRecord]| records.iter().flat_map(|record| smeared(record, part)).collect();
    let (problem, parameters) = problem_at(recorded, constants, rough, law, (WIDE_REACH, wide))?;
    let ending = Ending::short(STEPS, LITTLE);
    let (minimum, _) =
        descend(|p| problem.linearise(p), &parameters, &problem.bounds(), ending).map_err(IdentifyError::refused)?;
    Ok(Rough { misfit: problem.chi_square(minimum.at.cost), ..Rough::of(&problem, &minimum.parameters) })
}

/// Quick searches one after the other, each near where the last one ended.
const QUICK_SEARCHES: usize = 8;

/// The minimum over all lines; `None` where the search finds no end.
///
/// Where lines are summed quickly near some constants, the search goes on near its own end until nothing is promised there: that
/// is a minimum of the whole. Valleys of modes beyond the band, whose damping ratios stand in for one another, are long and bent: a
/// search that is still in one, with no more to gain than one standard deviation costs, has come near enough.
pub(super) fn line_by_line(problem: &mut AcceleranceProblem, from: &[f64]) -> Option<Minimum> {
    // Of records better than any noise, the sum of squares is no measure of what a step must gain: one is, a deviation's cost.
    let deviation = if problem.noise_is_known() { 1.0 } else { 0.0 };
    let bounds = problem.bounds();
    let ending = Ending { little: SURELY_LITTLE * deviation, ..Ending::likelihood(problem.data()) };
    let near = Ending { small_gain: 1.0 / problem.data(), little: deviation, ..ending };
    let mut from = from.to_vec();
    let mut is_quick = problem.move_near(&from).ok()?;
    for search in 1..=QUICK_SEARCHES {
        let (mut minimum, settled) = descend(|p| problem.linearise(p), &from, &bounds, ending).ok()?;
        let mut settled = settled || near.is_reached(&minimum.at, &minimum.parameters, &bounds);
        if is_quick {
            is_quick = problem.move_near(&minimum.parameters).ok()?;
            minimum.at = problem.linearise(&minimum.parameters).ok()?;
            let enough = if search < QUICK_SEARCHES { ending } else { near };
            settled = settled && enough.is_reached(&minimum.at, &minimum.parameters, &bounds);
        }
        if settled || !is_quick {
            return settled.then_some(minimum);
        }
        from = minimum.parameters;
    }
    None
}

/// Part of what a parameter's standard deviation costs that moves it by a thirtieth of that.
const SURELY_LITTLE: f64 = 1e-3;

/// Passes in which noise and fit follow from each other.
const NOISE_PASSES: usize = 2;

/// The same where the noise of some records, or the weight of their lines, follows from the fit itself: it then stands in the problem.
pub(super) fn line_by_line_with_noise(problem: &mut AcceleranceProblem, from: &[f64]) -> Option<Minimum> {
    let mut minimum = line_by_line(problem, from)?;
    if problem.noise_is_to_learn() {
        for _ in 0..NOISE_PASSES {
            problem.learn_noise(&minimum.parameters).ok()?;
            minimum = line_by_line(problem, &minimum.parameters)?;
        }
    }
    if !is_far_from_noise(problem, &minimum) && problem.weigh_by_model(&minimum.parameters).ok()? {
        minimum = line_by_line(problem, &minimum.parameters)?;
    }
    Some(minimum)
}

/// A fit line by line from constants that are roughly right, by way of records made wide; `None` where it stays far from
/// the noise.
pub(super) fn sharpened_lines(
    recorded: &Recorded,
    law: DampingLaw,
    rough: Rough,
    widest: f64,
) -> Result<Option<(AcceleranceProblem, Minimum)>, IdentifyError> {
    let constants = &recorded.constants;
    let Some(rough) = sharpen(recorded, constants, rough, law, widest)? else { return Ok(None) };
    let as_they_are = (f64::INFINITY, <[PlaceRecord]>::to_vec);
    let (mut problem, parameters) = problem_at(recorded, constants, &rough, law, as_they_are)?;
    let fitted =
        line_by_line_with_noise(&mut problem, &parameters).filter(|minimum| !is_far_from_noise(&problem, minimum));
    Ok(fitted.map(|minimum| (problem, minimum)))
}

/// Whether a width of this part of the frequency is more than the distance between lines anywhere.
fn narrows(recorded: &Recorded, part: f64) -> bool {
    recorded.records().any(|record| part * record.band_end() > record.line_step())
}
