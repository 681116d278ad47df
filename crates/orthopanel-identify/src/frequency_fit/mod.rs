//! Identification by natural frequencies (eqs 22 and 24).

mod prediction;
mod problem;
mod simplex;
mod starting_values;
mod uncertainty;

#[cfg(test)]
mod tests;

use orthopanel_data::ImpactTest;
use orthopanel_model::StructureKind;

use crate::least_squares::{Minimum, Stuck, levenberg_marquardt};
use crate::{Identification, IdentifiedConstant, IdentifyError, ModeFit, PieceFit};
use problem::FrequencyProblem;

/// How to search for the minimum of eq. 22.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Search {
    /// Levenberg-Marquardt on exact sensitivities.
    #[default]
    LeastSquares,
    /// The paper's downhill simplex with a penalty (eq. 24).
    Simplex,
}

/// Finds the elastic constants that minimise eq. 22,
/// $$Error(E_x, G_{zx}) = \frac1M\sum_{m=1}^M\frac{(f_{exp}^{(m)}-f_{cal}^{(m)})^2}{(f_{exp}^{(m)})^2},$$
/// over all natural-frequency measurements of the test; pieces share the constants, as they are of one material.
///
/// Starting values are found here. Both searches work on the logarithms of the constants, so eq. 24's bounds hold.
/// Standard deviations come from $s^2(J^TJ)^{-1}$, where $s^2$ is the scatter of the residuals or the rounding to the
/// analyser's bins, whichever is larger.
///
/// # Errors
/// [`IdentifyError`]: too few frequencies, an unknown constant, no convergence, a constant on its bound, or a test that
/// this version cannot evaluate.
pub fn identify(test: &ImpactTest, search: Search) -> Result<Identification, IdentifyError> {
    let problem = FrequencyProblem::of(test)?;
    let start = starting_values::starting_values(&problem)?;
    let Minimum { parameters: found, at } = minimise(&problem, &start, search)?;
    problem.refuse_bounds(&found)?;
    let uncertainty = uncertainty::uncertainty(&problem, &at);
    let values = problem.values(&found);
    let constants = problem.constants.iter().zip(&values).enumerate().map(|(index, (constant, &value))| {
        let free = problem.free.iter().position(|&at| at == index);
        IdentifiedConstant {
            name: constant.name,
            unit: constant.unit,
            value,
            std: free.and_then(|at| uncertainty.log_std.get(at)).map(|std| std * value),
            held: free.is_none(),
        }
    });
    Ok(Identification {
        structure: StructureKind::TimoshenkoBeam,
        constants: constants.collect(),
        correlations: uncertainty.correlations,
        pieces: piece_fits(test, &problem, &at.residuals),
        frequency_rms_percent: 100.0 * (at.cost() / problem.count() as f64).sqrt(),
        left_one_out_percent: uncertainty.left_one_out_percent,
    })
}

/// The minimum over the logarithms of the free constants, from `start`.
fn minimise(problem: &FrequencyProblem, start: &[f64], search: Search) -> Result<Minimum, IdentifyError> {
    if search == Search::LeastSquares && !start.is_empty() {
        return levenberg_marquardt(|p| problem.linearise(p), start, &problem.log_bounds()).map_err(
            |stuck| match stuck {
                Stuck::Refused(error) => error,
                Stuck::Iterations { count, cost } => IdentifyError::NotConverged {
                    iterations: count,
                    error_percent: 100.0 * (cost / problem.count() as f64).sqrt(),
                },
            },
        );
    }
    let parameters = if start.is_empty() { Vec::new() } else { simplex::downhill_simplex(problem, start)? };
    Ok(Minimum { at: problem.linearise(&parameters)?, parameters })
}

/// The modes of each piece; the residuals stand in the order of the measurements.
fn piece_fits(test: &ImpactTest, problem: &FrequencyProblem, residuals: &[f64]) -> Vec<PieceFit> {
    let named = test.pieces.iter();
    let mut fits: Vec<PieceFit> =
        named.map(|named| PieceFit { name: named.name.clone(), piece: named.piece, modes: Vec::new() }).collect();
    let mut residuals = residuals.iter();
    for set in &problem.sets {
        for (index, (&measured, residual)) in set.measured.iter().zip(residuals.by_ref()).enumerate() {
            let model = measured * (1.0 + residual);
            fits[set.piece].modes.push(ModeFit { mode: index + 1, measured, model, damping: None });
        }
    }
    fits
}
