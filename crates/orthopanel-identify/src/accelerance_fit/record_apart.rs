//! One record that stands far from the fit of the others, and the place at which it would not.

use num_complex::Complex64;
use orthopanel_data::ReadAs;
use orthopanel_model::{ModelError, Place, Readable};

use super::misfit::{median, record_misfit_percent, scaled_misfit_percent};
use super::problem::{AcceleranceProblem, PieceProblem, model_lines};
use super::records::PlaceRecord;
use crate::AcceleranceFit;
use crate::error::one_times;

/// So many records at least: of two that contradict each other neither is the odd one.
const LEAST_RECORDS: usize = 3;
/// Median misfit \[%\] from which a record stands apart, ...
const APART: f64 = 10.0;
/// ... where no other has more than this part of it.
const AGREEING: f64 = 0.25;
/// A place further than this from the one written down \[m\] is a wrong one. A hammer meets its mark within millimetres: what
/// lies nearer is a fault of the test, for which `hammer-offset` and `position-error` of a trace are there.
const MISPLACED: f64 = 0.015;
/// Lines and steps along the piece at which places are tried, ...
const LINES: usize = 600;
const STEPS: usize = 100;
/// ... and steps within one of these, where they are tried again.
const FINE: usize = 10;
/// A factor on the record that leaves less than this many times what the other place leaves explains it as well.
const FACTOR_AS_GOOD: f64 = 2.0;

/// A record that stands apart.
pub(super) struct Apart {
    /// Its median misfit \[%\].
    percent: f64,
    /// The greatest of the others \[%\].
    others: f64,
    fits: Option<OtherPlace>,
    /// The factor with which it fits as the others do.
    factor: Option<f64>,
}

/// The place at which a record fits as the others do.
#[derive(Debug, Clone, Copy)]
struct OtherPlace {
    /// `force_at` or `response_at`.
    key: &'static str,
    /// Along the piece \[m\], and what is written down.
    x: f64,
    written: f64,
    /// Its median misfit there \[%\].
    percent: f64,
    /// Whether a wrong gain would explain the record as well.
    factor_as_good: bool,
}

impl Apart {
    /// Whether the test file says what cannot be: the place is a wrong one beyond doubt.
    pub fn is_misplaced(&self) -> bool {
        self.fits.is_some_and(|place| (place.x - place.written).abs() > MISPLACED && !place.factor_as_good)
    }

    /// The place at which the record fits: `force_at` or `response_at`, and x \[m\].
    pub fn fits_at(&self) -> Option<(&'static str, f64)> {
        self.fits.filter(|place| !place.factor_as_good).map(|place| (place.key, place.x))
    }

    /// The factor with which it fits, where that is no matter of its place.
    pub fn factor(&self) -> Option<f64> {
        self.factor.filter(|_| !self.is_misplaced())
    }

    /// A sentence for a record that is kept.
    pub fn note(&self, record: &str) -> String {
        let Self { percent, others, .. } = self;
        let place = self.fits_at().map_or(String::new(), |(key, x)| format!(" (it fits with {key} x = {x:.3} m)"));
        format!(
            "{record}: half of its lines miss the model by more than {:.0} %, those of the other records by no more \
             than {:.1} %: check its places{place}, the sensor's direction, unit and gain{}; orthopanel trace parts them",
            Readable(*percent),
            Readable(*others),
            one_times(self.factor())
        )
    }
}

/// Of misfits \[%\] from the worst down, the worst and the next, where the worst stands apart.
fn apart(misfits: &[f64]) -> Option<(f64, f64)> {
    let &[worst, next, ..] = misfits else { return None };
    (misfits.len() >= LEAST_RECORDS && worst >= APART && next <= AGREEING * worst).then_some((worst, next))
}

/// Whether one record stands far from the model while the others meet it.
pub(crate) fn has_record_apart(fits: &[AcceleranceFit]) -> bool {
    let misfit = |fit: &AcceleranceFit| record_misfit_percent(&PlaceRecord::of_fit(fit, ReadAs::SI), &fit.model);
    let mut misfits: Vec<f64> = fits.iter().map(misfit).collect();
    misfits.sort_by(|a, b| b.total_cmp(a));
    apart(&misfits).is_some()
}

/// The record that stands far from the fit of the others while these agree; `None` where none does.
pub(super) fn record_apart(
    problem: &AcceleranceProblem,
    parameters: &[f64],
    lines: &[Vec<Complex64>],
) -> Result<Option<Apart>, ModelError> {
    let mut misfits = misfits(problem, lines);
    misfits.sort_by(|a, b| b.0.total_cmp(&a.0));
    let percents: Vec<f64> = misfits.iter().map(|(percent, ..)| *percent).collect();
    let Some((percent, others)) = apart(&percents) else { return Ok(None) };
    let (_, piece, own) = misfits[0];
    let (values, log_zetas) = problem.of_piece(piece, parameters);
    let trial = Trial { piece: &problem.pieces[piece], record: own.thinned(LINES), at: (&values, log_zetas), problem };
    let (factor, factor_leaves) = trial.factor()?;
    let fits = trial.best_place(factor_leaves)?.filter(|place| place.percent < AGREEING * percent);
    let factor = (factor_leaves < AGREEING * percent && factor != 0.0).then_some(1.0 / factor);
    Ok(Some(Apart { percent, others, fits, factor }))
}

/// The record, by its number, in whose place the one that misses the model most fits, and which fits in that one's; `None` where there is none.
pub(super) fn exchanged(
    problem: &AcceleranceProblem,
    parameters: &[f64],
    lines: &[Vec<Complex64>],
) -> Result<Option<usize>, ModelError> {
    let records = misfits(problem, lines);
    let worst = (0..records.len()).max_by(|a, b| records[*a].0.total_cmp(&records[*b].0));
    let Some(worst) = worst.filter(|_| records.len() > LEAST_RECORDS) else { return Ok(None) };
    let piece = records[worst].1;
    let (values, log_zetas) = problem.of_piece(piece, parameters);
    let fits = |index: usize, at: usize| -> Result<bool, ModelError> {
        let (percent, _, own) = records[index];
        let (_, _, other) = records[at];
        let record = own.thinned(LINES);
        let trial = Trial { piece: &problem.pieces[piece], record, at: (&values, log_zetas), problem };
        let models = trial.models(&[(other.force_at, other.response_at)])?;
        let left = models.first().map_or(f64::INFINITY, |model| record_misfit_percent(&trial.record, model));
        Ok(left < AGREEING * percent)
    };
    for (other, &(percent, of_piece, _)) in records.iter().enumerate() {
        let may_be = other != worst && of_piece == piece && percent > APART;
        if may_be && fits(worst, other)? && fits(other, worst)? {
            return Ok(Some(other));
        }
    }
    Ok(None)
}

/// Of each record its misfit \[%\] and its piece among those of the problem.
fn misfits<'a>(problem: &'a AcceleranceProblem, lines: &[Vec<Complex64>]) -> Vec<(f64, usize, &'a PlaceRecord)> {
    let pieces = problem.pieces.iter().enumerate();
    let records = pieces.flat_map(|(index, piece)| piece.records.iter().map(move |record| (index, record)));
    records.zip(lines).map(|((piece, record), model)| (record_misfit_percent(record, model), piece, record)).collect()
}

/// A record tried at other places, the constants as the others have them.
struct Trial<'a> {
    problem: &'a AcceleranceProblem,
    piece: &'a PieceProblem,
    record: PlaceRecord,
    at: (&'a [f64], &'a [f64]),
}

impl Trial<'_> {
    fn models(&self, pairs: &[(Place, Place)]) -> Result<Vec<Vec<Complex64>>, ModelError> {
        let models = self.piece.models_between(&self.record, pairs, self.at, self.problem.law)?;
        Ok(models.iter().map(|model| model_lines(&self.record, model)).collect())
    }

    /// The record over its model, and the median misfit that is left with that factor \[%\].
    fn factor(&self) -> Result<(f64, f64), ModelError> {
        let (force, response) = (self.record.force_at, self.record.response_at);
        Ok(match self.models(&[(force, response)])?.first() {
            Some(model) => {
                let factor = median(self.record.value.iter().zip(model).map(|(measured, model)| (measured / model).re));
                (factor, scaled_misfit_percent(&self.record, model, factor))
            }
            None => (0.0, f64::INFINITY),
        })
    }

    /// The best of places for the force or for the response; where both fit alike, the one nearer to what is written. `factor_leaves`
    /// is what a factor leaves in place of it \[%\].
    fn best_place(&self, factor_leaves: f64) -> Result<Option<OtherPlace>, ModelError> {
        let half = 0.5 * self.piece.sizes.length;
        let (force, response) = (self.record.force_at, self.record.response_at);
        let mut best: Option<OtherPlace> = None;
        for (key, written) in [("force_at", force), ("response_at", response)] {
            let pair = |x: f64| {
                let moved = Place { x, ..written };
                if key == "force_at" { (moved, response) } else { (force, moved) }
            };
            let least = |places: Vec<f64>| -> Result<Option<(f64, f64)>, ModelError> {
                let pairs: Vec<(Place, Place)> = places.iter().map(|&x| pair(x)).collect();
                let misfits = self.models(&pairs)?;
                let misfits = misfits.iter().map(|model| record_misfit_percent(&self.record, model));
                Ok(misfits.zip(places).min_by(|a, b| a.0.total_cmp(&b.0)))
            };
            let step = 2.0 * half / STEPS as f64;
            let Some((_, near)) = least((0..=STEPS).map(|i| i as f64 * step - half).collect())? else { continue };
            let fine = (0..=2 * FINE).map(|i| near + (i as f64 / FINE as f64 - 1.0) * step);
            let Some((percent, x)) = least(fine.filter(|x| x.abs() <= half).collect())? else { continue };
            let factor_as_good = factor_leaves < FACTOR_AS_GOOD * percent;
            let found = OtherPlace { key, x, written: written.x, percent, factor_as_good };
            let distance = |place: &OtherPlace| (place.x - place.written).abs();
            let is_better = best.as_ref().is_none_or(|known| {
                let alike = percent < FACTOR_AS_GOOD * known.percent && known.percent < FACTOR_AS_GOOD * percent;
                if alike { distance(&found) < distance(known) } else { percent < known.percent }
            });
            if is_better {
                best = Some(found);
            }
        }
        Ok(best)
    }
}
