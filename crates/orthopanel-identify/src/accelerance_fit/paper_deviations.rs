//! What the noise of the records does to the minimum of eq. 23.

use faer::Mat;
use faer::prelude::SolveLstsq;
use orthopanel_model::ModelError;

use super::paper_error::PaperError;

/// Step of the derivatives, in logarithms: points are found to 1e-6, and what bends over a step is of its square.
const STEP: f64 = 1e-3;

impl PaperError<'_> {
    /// Covariance of the parameters at the minimum; `None` where eq. 23 does not hold them there.
    ///
    /// With $r$ the relative misfits of eq. 23, $J = \partial r/\partial p$, its weights $W$ and the variances $C$ of the measured
    /// points by the records' noise, the minimum moves with these by $P = (J^TWJ)^{-1}J^TW$, and scatters by
    /// $$PCP^T = (J^TWJ)^{-1}\,J^TWCWJ\,(J^TWJ)^{-1}.$$
    /// $P$ is found by a QR factorisation of $\sqrt WJ$: at one place every magnitude is met by its own ratio, and what is left of
    /// the frequencies beside weights 1e5 times theirs would drown in $J^TWJ$. Ratios follow from magnitudes alone, as in the
    /// search; one that no magnitude tells is as well known as its pole tells it.
    pub(super) fn covariance(&self, parameters: &[f64]) -> Result<Option<Mat<f64>>, ModelError> {
        let shifted = |column: usize, step: f64| {
            let mut at = parameters.to_vec();
            at[column] += step;
            self.misfits(&at)
        };
        let moved: Vec<usize> = (0..parameters.len()).filter(|&column| self.moves(column)).collect();
        let mut columns = Vec::with_capacity(moved.len());
        for &column in &moved {
            let (low, high) = (shifted(column, -STEP)?, shifted(column, STEP)?);
            let slopes = high.iter().zip(&low).map(|(high, low)| (high - low) / (2.0 * STEP));
            let of_magnitudes_alone = self.is_damping(column);
            let own =
                slopes.enumerate().map(|(row, slope)| if of_magnitudes_alone && row % 2 == 0 { 0.0 } else { slope });
            columns.push(own.collect::<Vec<f64>>());
        }
        let (weights, variances) = self.weights_and_variances();
        let rows: Vec<usize> = (0..weights.len()).filter(|&row| weights[row] > 0.0).collect();
        if rows.len() < moved.len() || moved.is_empty() {
            return Ok(None);
        }
        let weighted = Mat::from_fn(rows.len(), moved.len(), |i, j| weights[rows[i]].sqrt() * columns[j][rows[i]]);
        let responses = weighted.qr().solve_lstsq(&Mat::<f64>::identity(rows.len(), rows.len()));
        let own = Mat::from_fn(moved.len(), moved.len(), |i, j| {
            let scatter = |k: usize| weights[rows[k]] * variances[rows[k]] * responses[(i, k)] * responses[(j, k)];
            (0..rows.len()).map(scatter).sum::<f64>()
        });
        let mut covariance = Mat::zeros(parameters.len(), parameters.len());
        self.known.iter().enumerate().for_each(|(i, std)| covariance[(i, i)] = std * std);
        for (i, &row) in moved.iter().enumerate() {
            for (j, &column) in moved.iter().enumerate() {
                covariance[(row, column)] = own[(i, j)];
            }
        }
        Ok((0..moved.len()).all(|i| own[(i, i)].is_finite()).then_some(covariance))
    }
}
