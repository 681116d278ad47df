//! How far the motion is known that forces which go with its cube answer.
//!
//! The motion is worked out from the measured blow, so what is wrong with that is wrong with the motion: noise $N$ of the hammer's
//! channel beside a blow $F$ by the part $|N/F|$ of it. Over the swings on such springs that part decides when each comes, so lines
//! miss by more than the noise of either channel.

use orthopanel_model::{ModelError, Piece};
use rayon::prelude::*;

use crate::IdentifyError;
use crate::outcome::Progress;
use crate::tracing::fit::{Fit, LAST, PATIENCE, polish, polished_through, settle};
use crate::tracing::hypothesis::CUBIC;
use crate::tracing::model_error::TRUSTED;
use crate::tracing::ranking::{LITTLE, Ranking, Search, least_cost};
use crate::tracing::record_problem::State;
use crate::tracing::records_of_test::TestRecords;
use crate::tracing::rough::rest::RoughRest;
use crate::tracing::widened_lines::{HitLines, median};

/// The widest lines but one: on wider ones the swings are over before they are out of step, and a line's tolerance is beyond any roughness.
/// [`TestRecords::as_hit`] from here on takes a doubt from here on back.
pub(in crate::tracing) const WIDE: usize = 1;
/// The lowest lines of a hit, which tell the part: a blow has its impulse there, and the springs their swings.
const LOWEST: usize = 8;
/// $E|h - h'|^2/|h|^2$ of swings that are altogether out of step: two springs may make of the least part a motion of its own, with a
/// derivative that grows without bounds.
const OUT_OF_STEP: f64 = 2.0;

impl TestRecords {
    /// Adds to the variances of the hits, on all lines from this widening on, what an error of their motion does: that of the
    /// hammer's channel, that of any model ([`TRUSTED`]), and where the test is rough what `rest` says and what gains of records
    /// are, for no record tells which of its channels a gain belongs to.
    ///
    /// # Errors
    /// What the model refuses.
    pub(in crate::tracing) fn doubt_motion(
        &mut self,
        state: &State,
        (from, rest): (usize, Option<RoughRest>),
    ) -> Result<(), ModelError> {
        let gain = self.rough.map_or(0.0, |scales| scales.gain);
        let shared = rest.map_or(0.0, |rest| rest.part.powi(2)) + gain.powi(2) + TRUSTED.powi(2);
        for stage in from..self.widened.len() {
            let problem = self.problem(stage);
            let numbers: Vec<usize> = (0..problem.records.len()).collect();
            let by_motion = numbers.into_par_iter().map(|index| problem.by_motion(state, index));
            let by_motion = by_motion.collect::<Result<Vec<_>, ModelError>>()?;
            for (record, by) in self.widened[stage].iter_mut().zip(by_motion) {
                let doubt = |(by, hit): (Vec<MotionPower>, &HitLines)| {
                    let part = shared + part_of_blow(hit);
                    by.into_iter().map(|power| (part * power.by_part).min(OUT_OF_STEP * power.whole)).collect()
                };
                let by: Vec<Vec<f64>> = by.into_iter().zip(&record.hits).map(doubt).collect();
                if !by.is_empty() {
                    record.widen_hits(&by);
                }
            }
        }
        self.forget_sums();
        Ok(())
    }
}

/// On a line of a hit: $|h|^2$ of what such forces take off it, and $|2k_3\,\partial h/\partial k_3|^2$, which a motion that is wrong by a
/// part changes there through its cube, over that part squared. The force of $\lambda$ times a motion is that of the motion itself on
/// springs $\lambda^2k_3$.
pub(in crate::tracing) struct MotionPower {
    pub whole: f64,
    pub by_part: f64,
}

/// $|N/F|^2$ of a hit.
fn part_of_blow(hit: &HitLines) -> f64 {
    let lowest = hit.by_force.iter().zip(&hit.value).take(LOWEST);
    let parts: Vec<f64> = lowest.map(|(by, value)| by / value.norm_sqr()).filter(|part| part.is_finite()).collect();
    if parts.is_empty() { 0.0 } else { median(&parts) }
}

impl Search<'_> {
    /// Whether a fit has such forces and misses more than noise: its motion is to be doubted.
    pub(in crate::tracing) fn is_undoubted(&self, fit: &Fit) -> bool {
        is_cubic(fit) && !self.meets_noise(fit)
    }
}

/// Where the best fit has such forces and misses more than noise: the fits once more, beside what is wrong with their motion; those that
/// were given up where they now come near. Only an answer that then meets the noise is kept: what such forces do not explain must
/// not hide behind what is doubted of them.
///
/// # Errors
/// What the model refuses.
pub(in crate::tracing) fn beside_motion_doubt(
    records: &mut TestRecords,
    ranking: &mut Ranking,
    (piece, progress): (Piece, &(dyn Fn(Progress) + Sync)),
) -> Result<(), IdentifyError> {
    // What swings out of step foretells no other record: such a fit is not yet the chosen one.
    let best = least_cost(&ranking.fits).filter(|best| Search { records, piece, progress }.is_undoubted(best));
    let Some(state) = best.map(|best| best.state.clone()) else { return Ok(()) };
    let before = ranking.fits.clone();
    records.doubt_motion(&state, (WIDE, None))?;
    ranking.fits.par_iter_mut().try_for_each(|fit| {
        let state = match fit.given_up {
            None => polish(records, &fit.state, LAST, PATIENCE[LAST])?.0,
            Some(_) => fit.state.clone(),
        };
        *fit = settle(records, state, fit.given_up)?;
        Ok::<_, IdentifyError>(())
    })?;
    let near = least_cost(&ranking.fits).map_or(0.0, |best| best.cost) + LITTLE;
    ranking.fits.par_iter_mut().filter(|fit| fit.cost <= near).try_for_each(|fit| {
        if let Some(from) = fit.given_up {
            let (state, _) = polished_through(records, (fit.state.clone(), fit.cost), from..=LAST)?;
            *fit = settle(records, state, None)?;
        }
        Ok::<_, IdentifyError>(())
    })?;
    let search = Search { records, piece, progress };
    search.lead(&mut ranking.fits[1..]);
    search.choose(ranking)?;
    let chosen = &ranking.fits[ranking.chosen];
    if is_cubic(chosen) && search.explains(chosen) {
        return Ok(());
    }
    records.as_hit(WIDE, None);
    ranking.fits = before;
    ranking.chosen = 0;
    let search = Search { records, piece, progress };
    search.lead(&mut ranking.fits[1..]);
    search.choose(ranking)
}

fn is_cubic(fit: &Fit) -> bool {
    fit.state.hypothesis.effects.iter().any(|on| on.effect.id() == CUBIC)
}
