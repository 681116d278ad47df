//! How far any model of a test is trusted, and what that leaves of the parameters that are read off it.

use faer::Mat;
use num_complex::Complex64;
use orthopanel_model::{LineBlock, ModelError};

use super::error_clusters::add_square;
use super::fit::{Fit, LAST};
use super::hypothesis::{CUBIC, FreeParameter, Hypothesis, Switched};
use super::record_problem::Grouping;
use super::records_of_test::TestRecords;
use super::widened_lines::WidenedLines;

/// Part of the motion by which a model is wrong where nothing tells it: hits may agree to 1e-5 of a peak, but no beam, sensor
/// or place is known that well. What is left of such a peak must not call for an effect, nor make a parameter more certain.
pub(super) const TRUSTED: f64 = 3e-4;
/// Part of a resonance's frequency by which a model is wrong: a tenth of a kelvin does that to aluminium.
pub(super) const TUNED: f64 = 3e-5;

/// Variance that the same error of the motion leaves of each of a hypothesis' coordinates where forces go with its cube: with
/// $k_3w^3$, a motion that is wrong by a part is a $k_3$ that is wrong by twice that. Its derivative does not show this: over many
/// swings that grows so steep that it would tell $k_3$ to any digit.
///
/// In a rough test that part is what its roughness leaves, and with it the gains of its records in the mean: no record tells which of
/// its channels a gain belongs to, and one of the force's is one of the motion under it.
pub(super) fn of_amplitude(records: &TestRecords, hypothesis: &Hypothesis) -> Vec<f64> {
    let many = records.problem(LAST).records.len().max(1) as f64;
    let trusted = records.rest.map_or(TRUSTED, |rest| rest.part.max(TRUSTED));
    let of_gains = records.rough.map_or(0.0, |scales| scales.gain.powi(2) / many);
    let motion = trusted.powi(2) + of_gains;
    let part = |(on, free): (&Switched, &FreeParameter)| {
        let value = on.values[free.at];
        if on.effect.id() == CUBIC { 4.0 * motion * (value / free.slope(value)).powi(2) } else { 0.0 }
    };
    hypothesis.each_free().map(part).collect()
}

/// $\sum_gv_gv_g^T$ with $v_g = J^TWe_g$ of errors $e_g$ that a model may have beside the noise: what these do to the gradient.
/// With $N = J^TWJ$, $N^{-1}\sum_gv_gv_g^TN^{-1}$ is what that adds to the covariance.
///
/// The lines of a record fall into as many stretches as there are modes in the band. Over each, the accelerance $h$ of each
/// record may be wrong by the part [`TRUSTED`] in size and in phase, and that of all records together by a shift of frequency,
/// $s\,dh/ds$ times [`TUNED`]. In a rough test both are what its roughness leaves, where that is more: see
/// `rough::rest`.
///
/// # Errors
/// What the model refuses.
pub(super) fn spread_of_gradient(records: &TestRecords, fit: &Fit) -> Result<Mat<f64>, ModelError> {
    let problem = records.problem(LAST);
    let size = fit.parameters.len();
    let (trusted, tuned) =
        records.rest.map_or((TRUSTED, TUNED), |rest| (rest.part.max(TRUSTED), rest.tuning.max(TUNED)));
    let mut sum = Mat::zeros(size, size);
    let mut shifts: Vec<Vec<f64>> = Vec::new();
    problem.rows(&fit.state, Grouping::Places, |index, _, rows| {
        let record = &problem.records[index];
        let lines = record.s.len();
        let stretch = lines.div_ceil(records.in_band.max(1)).max(1);
        let noise = record.noise();
        let gradient = |own: std::ops::Range<usize>, error: &dyn Fn(usize) -> Complex64| {
            // What lines share reaches as far as their blocks.
            let first = own.start / LineBlock::MOST * LineBlock::MOST;
            let count = own.end.next_multiple_of(LineBlock::MOST).min(lines) - first;
            let (mut re, mut im) = (vec![0.0; count], vec![0.0; count]);
            for line in own {
                let error = error(line) * noise.weights[line];
                (re[line - first], im[line - first]) = (error.re, error.im);
            }
            noise.whiten(first, [&mut re, &mut im]);
            let dot = |column: usize| {
                let rows = rows.col_as_slice(column)[2 * first..].chunks_exact(2);
                rows.zip(re.iter().zip(&im)).map(|(row, (re, im))| row[0] * re + row[1] * im).sum()
            };
            (0..size).map(dot).collect::<Vec<f64>>()
        };
        for (number, from) in (0..lines).step_by(stretch).enumerate() {
            let own = from..(from + stretch).min(lines);
            add_square(&mut sum, 1.0, &gradient(own.clone(), &|line| trusted * record.value[line]));
            add_square(&mut sum, 1.0, &gradient(own.clone(), &|line| trusted * Complex64::I * record.value[line]));
            if shifts.len() <= number {
                shifts.push(vec![0.0; size]);
            }
            let shift = gradient(own, &|line| tuned * record.s[line] * slope(record, line));
            shifts[number].iter_mut().zip(shift).for_each(|(sum, own)| *sum += own);
        }
    })?;
    shifts.iter().for_each(|shift| add_square(&mut sum, 1.0, shift));
    Ok(sum)
}

/// $dh/ds$ at a line, from its neighbours.
pub(super) fn slope(record: &WidenedLines, line: usize) -> Complex64 {
    let (before, after) = (line.saturating_sub(1), (line + 1).min(record.s.len() - 1));
    let apart = record.s[after] - record.s[before];
    if apart.norm() > 0.0 { (record.value[after] - record.value[before]) / apart } else { Complex64::ZERO }
}
