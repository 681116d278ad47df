//! One hypothesis fitted to the lists.

use std::cell::RefCell;

use faer::Mat;

use super::hypothesis::Hypothesis;
use super::list_problem::ListProblem;
use crate::IdentifyError;
use crate::least_squares::{Ending, Linearised, Quadratic, descend};
use orthopanel_model::ModelError;

/// A hypothesis at its minimum.
#[derive(Clone)]
pub(super) struct ListFit {
    pub hypothesis: Hypothesis,
    /// Constants that are free, then the effects' coordinates.
    pub parameters: Vec<f64>,
    /// Relative error of each frequency.
    pub residuals: Vec<f64>,
    /// The same, each predicted from all others.
    pub left_out: Vec<f64>,
    /// Standard deviations of the parameters; empty where as many are free as frequencies were measured.
    pub std: Vec<f64>,
    /// Number of free parameters.
    pub size: usize,
    /// Relative standard deviation of each frequency, where the lists tell it.
    pub scatter: Option<Vec<f64>>,
    /// The plate in place of the beam, where that is the hypothesis.
    pub plate: Option<crate::Identification>,
    /// Whether an effect's place may as well be on the other side of the middle.
    pub mirrored: bool,
    /// Where other starts led, the least missed first.
    pub other_minima: Vec<ListFit>,
    /// From where to where the effect may sit, if intervals reach over other places than the one of the fit.
    pub reaches: Option<(f64, f64)>,
}

/// Step of the differences in logarithms, or in parts of a linear parameter's range.
const STEP: f64 = 1e-5;
/// Half the width of an interval of 95 %, in standard deviations.
pub(super) const INTERVAL: f64 = 1.96;
const ENDING: Ending = Ending {
    most_iterations: 40,
    small_step: 1e-7,
    small_gain: 1e-8,
    little: 0.0,
    first_damping: 1e-4,
    failed_damping: 0.0,
    ..Ending::SMOOTH
};
/// Fits constants and effects from parameters of the constants and from where the effects stand.
///
/// # Errors
/// [`IdentifyError::TooFewFrequencies`] where fewer were measured than are free, and what the model refuses.
pub(super) fn fit(problem: &ListProblem, from: &Hypothesis, constants_from: &[f64]) -> Result<ListFit, IdentifyError> {
    let constants = &problem.constants;
    let names = || {
        let constants = (0..constants.count()).map(|i| constants.constant(i).name);
        constants.chain(from.each_free().map(|(on, _)| on.effect.id())).collect::<Vec<_>>().join(", ")
    };
    let needed = constants.count() + from.size();
    if problem.count() < needed {
        return Err(IdentifyError::TooFewFrequencies { found: problem.count(), needed, names: names() });
    }
    let start: Vec<f64> = constants_from.iter().copied().chain(from.coordinates()).collect();
    let bounds: Vec<(f64, f64)> = constants.bounds().into_iter().chain(from.bounds()).collect();
    let descent = Descent { problem, like: from, bounds: &bounds, lowest: RefCell::new(None) };
    let searched = descend(|parameters| descent.quadratic(parameters), &start, &bounds, ENDING);
    let (minimum, _) = searched.map_err(IdentifyError::refused)?;
    let parameters = minimum.parameters;
    let at = descent.at(&parameters)?;
    let size = parameters.len();
    let scatter = problem.scatter();
    let left = at.residuals.iter().map(|r| r * r).sum::<f64>() / problem.count().saturating_sub(size).max(1) as f64;
    // Residuals are in units of what the lists tell; where they miss by more, so do the parameters.
    let variance = if scatter.is_some() { left.max(1.0) } else { left };
    let covariance = if size > 0 && problem.count() > size { at.quadratic().covariance() } else { None };
    let std = covariance
        .as_ref()
        .map_or(vec![f64::INFINITY; size], |matrix| (0..size).map(|i| (variance * matrix[(i, i)]).sqrt()).collect());
    let left_out = at.residuals.iter().enumerate().map(|(row, residual)| {
        let leverage: f64 = covariance.as_ref().map_or(0.0, |matrix| {
            let entry = |i: usize, j: usize| at.jacobian[(row, i)] * matrix[(i, j)] * at.jacobian[(row, j)];
            (0..size).map(|i| (0..size).map(|j| entry(i, j)).sum::<f64>()).sum()
        });
        residual / (1.0 - leverage).max(1e-6)
    });
    let left_out = in_parts(left_out.collect(), scatter.as_deref());
    let (_, coordinates) = parameters.split_at(constants.count());
    let hypothesis = from.at(coordinates);
    let residuals = in_parts(at.residuals, scatter.as_deref());
    Ok(ListFit {
        hypothesis,
        residuals,
        left_out,
        std,
        size,
        parameters,
        scatter,
        plate: None,
        mirrored: false,
        other_minima: vec![],
        reaches: None,
    })
}

/// From units of the scatter to parts of each frequency.
fn in_parts(residuals: Vec<f64>, scatter: Option<&[f64]>) -> Vec<f64> {
    match scatter {
        Some(scatter) => residuals.iter().zip(scatter).map(|(residual, scatter)| residual * scatter).collect(),
        None => residuals,
    }
}

/// One search, which does without derivatives that nobody asks for: each is two models of all frequencies.
struct Descent<'a> {
    problem: &'a ListProblem,
    like: &'a Hypothesis,
    bounds: &'a [(f64, f64)],
    /// The lowest that was found so far, and where.
    lowest: RefCell<Option<(Vec<f64>, f64, Linearised)>>,
}

impl Descent<'_> {
    fn quadratic(&self, parameters: &[f64]) -> Result<Quadratic, ModelError> {
        let residuals = self.problem.weighed(parameters, self.like)?;
        let cost: f64 = residuals.iter().map(|r| r * r).sum();
        if self.lowest.borrow().as_ref().is_some_and(|(_, lowest, _)| cost > *lowest) {
            // A step that went up is taken back whatever its derivatives.
            return Ok(Quadratic { cost, ..Quadratic::zero(parameters.len()) });
        }
        let at = self.linearise(parameters, residuals)?;
        let mut quadratic = at.quadratic();
        // What moves nothing here must not stop the rest.
        for index in 0..parameters.len() {
            if quadratic.normal[(index, index)] == 0.0 {
                quadratic.normal[(index, index)] = 1.0;
            }
        }
        if quadratic.is_finite() {
            *self.lowest.borrow_mut() = Some((parameters.to_vec(), cost, at));
        }
        Ok(quadratic)
    }

    /// Where the search ended.
    fn at(self, parameters: &[f64]) -> Result<Linearised, ModelError> {
        match self.lowest.take() {
            Some((lowest, _, at)) if lowest == parameters => Ok(at),
            _ => self.linearise(parameters, self.problem.weighed(parameters, self.like)?),
        }
    }

    fn linearise(&self, parameters: &[f64], residuals: Vec<f64>) -> Result<Linearised, ModelError> {
        let mut jacobian = Mat::zeros(residuals.len(), parameters.len());
        for (column, &(low, high)) in self.bounds.iter().enumerate() {
            let step = STEP * (high - low).min(1.0);
            let moved = |by: f64| {
                let mut at = parameters.to_vec();
                at[column] = (at[column] + by).clamp(low, high);
                (self.problem.weighed(&at, self.like), at[column])
            };
            let ((above, right), (below, left)) = (moved(step), moved(-step));
            for (row, (above, below)) in above?.iter().zip(&below?).enumerate() {
                jacobian[(row, column)] = (above - below) / (right - left);
            }
        }
        Ok(Linearised { residuals, jacobian })
    }
}

impl ListFit {
    fn square(&self) -> f64 {
        self.residuals.iter().map(|r| r * r).sum()
    }

    /// $\sum(r_i/\sigma_i)^2$, where the lists tell $\sigma$.
    fn chi_square(&self) -> Option<f64> {
        let scatter = self.scatter.as_ref()?;
        Some(self.residuals.iter().zip(scatter).map(|(residual, scatter)| (residual / scatter).powi(2)).sum())
    }

    /// $\sum(r_i/\sigma_i)^2$ where the lists tell $\sigma$, else $n\ln(R/n)$.
    pub(super) fn missed(&self) -> f64 {
        let count = self.residuals.len().max(1) as f64;
        self.chi_square().unwrap_or_else(|| count * (self.square() / count).max(f64::MIN_POSITIVE).ln())
    }

    /// [`Self::missed`] $ + k\ln n$.
    pub(super) fn bic(&self) -> f64 {
        self.missed() + self.size as f64 * (self.residuals.len().max(1) as f64).ln()
    }

    /// By how much a step of one deviation raises [`Self::missed`]: more than one where more is missed than the lists tell.
    pub(super) fn excess(&self) -> f64 {
        let beyond = self.residuals.len().saturating_sub(self.size).max(1);
        self.chi_square().map_or(1.0, |sum| (sum / beyond as f64).max(1.0))
    }

    /// Up to where [`Self::missed`] is no worse within intervals of 95 %.
    pub(super) fn most(&self) -> f64 {
        self.missed() + INTERVAL * INTERVAL * self.excess()
    }

    /// The constants' parameters.
    pub(super) fn constants(&self, problem: &ListProblem) -> &[f64] {
        self.parameters.split_at(problem.constants.count().min(self.parameters.len())).0
    }

    /// Rms error \[%\].
    pub(super) fn percent(&self) -> f64 {
        100.0 * (self.square() / self.residuals.len().max(1) as f64).sqrt()
    }

    /// Indices of the frequencies that the others are to foretell: all, but of as many as resonators have modes of their own those that
    /// are missed the most, for where a resonator is tuned its own frequency alone tells.
    pub(super) fn foretold(&self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.left_out.len()).collect();
        order.sort_by(|&a, &b| self.left_out[a].abs().total_cmp(&self.left_out[b].abs()));
        order.truncate(order.len().saturating_sub(self.hypothesis.own_modes()));
        order
    }

    /// Rms error \[%\] of each frequency predicted from all others, as [`Self::foretold`] takes them.
    pub(super) fn left_out_percent(&self) -> f64 {
        let foretold = self.foretold();
        let square: f64 = foretold.iter().map(|&at| self.left_out[at].powi(2)).sum();
        100.0 * (square / foretold.len().max(1) as f64).sqrt()
    }

    /// Scatter of the residuals, with the free parameters counted.
    pub(super) fn scatter(&self) -> f64 {
        (self.square() / self.residuals.len().saturating_sub(self.size).max(1) as f64).sqrt()
    }
}
