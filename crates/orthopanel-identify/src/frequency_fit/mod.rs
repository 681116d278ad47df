//! Identification by natural frequencies (eqs 22 and 24).

mod prediction;
mod problem;
mod starting_values;
mod uncertainty;

#[cfg(test)]
mod tests;

use orthopanel_data::ImpactTest;
use orthopanel_model::StructureKind;

use crate::Search;
use crate::downhill_simplex::{Penalised, downhill_simplex};
use crate::elastic_constants::refuse_bounds;
use crate::least_squares::{Stuck, levenberg_marquardt};
use crate::{Identification, IdentifiedConstant, IdentifyError, ModeFit, PieceFit};
use problem::FrequencyProblem;

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
pub(crate) fn identify_frequencies(test: &ImpactTest, search: Search) -> Result<Identification, IdentifyError> {
    let problem = FrequencyProblem::of(test)?;
    let start = starting_values::starting_values(&problem)?;
    let found = minimise(&problem, &start, search)?;
    refuse_bounds(&problem.constants, &problem.free, &found)?;
    let at = problem.linearise(&found)?;
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
        frequency_rms_percent: 100.0 * (at.quadratic().cost / problem.count() as f64).sqrt(),
        left_one_out_percent: uncertainty.left_one_out_percent,
        accelerance_rms_percent: None,
        chi_square: None,
        accelerances: Vec::new(),
        notes: Vec::new(),
    })
}

/// Logarithms of the free constants at the minimum, from `start`.
fn minimise(problem: &FrequencyProblem, start: &[f64], search: Search) -> Result<Vec<f64>, IdentifyError> {
    if start.is_empty() {
        return Ok(Vec::new());
    }
    let bounds = problem.log_bounds();
    match search {
        Search::Simplex => {
            let error = |logs: &[f64]| problem.error(logs);
            downhill_simplex(&Penalised { error, bounds }, start)
        }
        Search::LeastSquares => {
            let quadratic = |logs: &[f64]| problem.linearise(logs).map(|at| at.quadratic());
            let minimum = levenberg_marquardt(quadratic, start, &bounds).map_err(|stuck| match stuck {
                Stuck::Refused(error) => error,
                Stuck::Iterations { count, cost } => IdentifyError::NotConverged {
                    iterations: count,
                    error_percent: 100.0 * (cost / problem.count() as f64).sqrt(),
                },
            })?;
            Ok(minimum.parameters)
        }
    }
}

/// The modes of each piece; the residuals stand in the order of the measurements.
fn piece_fits(test: &ImpactTest, problem: &FrequencyProblem, residuals: &[f64]) -> Vec<PieceFit> {
    let named = test.pieces.iter();
    let mut fits: Vec<PieceFit> = named
        .map(|named| PieceFit { name: named.name.clone(), piece: named.piece, modes: vec![], damping: vec![] })
        .collect();
    let mut residuals = residuals.iter();
    for set in &problem.sets {
        for (index, (&measured, residual)) in set.measured.iter().zip(residuals.by_ref()).enumerate() {
            let model = measured * (1.0 + residual);
            fits[set.piece].modes.push(ModeFit { mode: index + 1, measured, model, damping: None });
        }
    }
    fits
}
