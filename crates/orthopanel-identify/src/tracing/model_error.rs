//! How far any model of a test is trusted, and what that leaves of the parameters that are read off it.

use faer::Mat;
use orthopanel_model::ModelError;

use super::fit::{Fit, LAST};
use super::record_problem::Grouping;
use super::records_of_test::TestRecords;

/// Part of the motion by which a model is wrong where nothing tells it: hits may agree to 1e-5 of a peak, but no beam, sensor
/// or place is known that well. What is left of such a peak must not call for an effect, nor make a parameter more certain.
pub(super) const TRUSTED: f64 = 3e-4;

/// $\sum_gv_gv_g^T$ with $v_g = \epsilon J^TWh$ over the lines of one stretch: what a model that is wrong there by the part
/// $\epsilon$ of the accelerance $h$, all its lines alike, does to the gradient. Stretches are as many to a record as it has
/// modes, and err by size and by phase. With $N = J^TWJ$, $N^{-1}\sum_gv_gv_g^TN^{-1}$ is what that adds to the covariance.
///
/// # Errors
/// What the model refuses.
pub(super) fn spread_of_gradient(records: &TestRecords, fit: &Fit) -> Result<Mat<f64>, ModelError> {
    let problem = records.problem(LAST);
    let size = fit.parameters.len();
    let mut sum = Mat::zeros(size, size);
    problem.rows(&fit.state, Grouping::Places, |index, _, rows| {
        let record = &problem.records[index];
        let lines = record.s.len();
        let stretch = lines.div_ceil(records.in_band.max(1)).max(1);
        for from in (0..lines).step_by(stretch) {
            let mut by_size = vec![0.0; size];
            let mut by_phase = vec![0.0; size];
            for line in from..(from + stretch).min(lines) {
                let error = record.value[line] * (TRUSTED * (2.0 / record.variance[line]).sqrt());
                for column in 0..size {
                    let (re, im) = (rows[(2 * line, column)], rows[(2 * line + 1, column)]);
                    by_size[column] += re * error.re + im * error.im;
                    by_phase[column] += im * error.re - re * error.im;
                }
            }
            for error in [by_size, by_phase] {
                for column in 0..size {
                    for row in 0..size {
                        sum[(row, column)] += error[row] * error[column];
                    }
                }
            }
        }
    })?;
    Ok(sum)
}
