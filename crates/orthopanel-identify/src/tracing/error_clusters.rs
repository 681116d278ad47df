//! What residuals that err together leave of the parameters of a rough test.
//!
//! A hit beside its mark moves all lines of its record, an uneven core one resonance in all records: thousands of lines are then
//! as few witnesses as there are records and resonances.

use faer::Mat;
use orthopanel_model::ModelError;

use super::fit::{Fit, LAST};
use super::record_problem::Grouping;
use super::records_of_test::TestRecords;

/// Gradients of a sum of squares, $g = J^TWr$ over some lines, by record and by stretch of the band.
struct Clusters {
    by_record: Vec<Vec<f64>>,
    by_stretch: Vec<Vec<f64>>,
    /// $\sum gg^T$ of each stretch of each record by itself.
    of_both: Mat<f64>,
}

impl Clusters {
    fn new(records: usize, stretches: usize, size: usize) -> Self {
        let none = |many| vec![vec![0.0; size]; many];
        Self { by_record: none(records), by_stretch: none(stretches), of_both: Mat::zeros(size, size) }
    }

    fn add(&mut self, (record, stretch): (usize, usize), gradient: &[f64]) {
        for sum in [&mut self.by_record[record], &mut self.by_stretch[stretch]] {
            sum.iter_mut().zip(gradient).for_each(|(sum, own)| *sum += own);
        }
        add_square(&mut self.of_both, 1.0, gradient);
    }

    /// The variance of the whole gradient, see [`clustered_spread`].
    fn spread(self) -> Mat<f64> {
        let mut spread = faer::Scale(-1.0) * self.of_both;
        let several = self.by_record.len() as f64;
        let of_few = if several > 1.0 { several / (several - 1.0) } else { 1.0 };
        self.by_record.iter().for_each(|gradient| add_square(&mut spread, of_few, gradient));
        self.by_stretch.iter().for_each(|gradient| add_square(&mut spread, 1.0, gradient));
        spread
    }
}

/// The variance of the gradient by clusters of lines that err together,
/// $$V = \frac{R}{R-1}\sum_kg_kg_k^T + \sum_mg_mg_m^T - \sum_{km}g_{km}g_{km}^T ,$$
/// with $g$ summed over the lines of record $k$ of $R$, over those of stretch $m$ of the band in all records, and over those of
/// both; there are as many stretches as modes in the band. With the covariance $C$ that independent lines leave, $CVC$ is what
/// these leave, whatever went wrong; where residuals are white it is $C$, but for what a few numbers scatter.
///
/// Source: A. C. Cameron, J. B. Gelbach, D. L. Miller, Robust inference with multiway clustering, Journal of Business and
/// Economic Statistics 29 (2011), eq. 2.11.
///
/// # Errors
/// What the model refuses.
pub(super) fn clustered_spread(records: &TestRecords, fit: &Fit) -> Result<Mat<f64>, ModelError> {
    let problem = records.problem(LAST);
    let size = fit.parameters.len();
    let stretches = records.in_band.max(1);
    let mut clusters = Clusters::new(problem.records.len(), stretches, size);
    problem.rows(&fit.state, Grouping::Places, |index, _, rows| {
        let lines = problem.records[index].s.len();
        let stretch = lines.div_ceil(stretches).max(1);
        let missed = rows.col_as_slice(size);
        for (number, from) in (0..lines).step_by(stretch).enumerate() {
            let own = 2 * from..2 * (from + stretch).min(lines);
            let dot = |column: usize| {
                let pairs = rows.col_as_slice(column)[own.clone()].iter().zip(&missed[own.clone()]);
                pairs.map(|(row, missed)| row * missed).sum()
            };
            let gradient: Vec<f64> = (0..size).map(dot).collect();
            clusters.add((index, number), &gradient);
        }
    })?;
    Ok(clusters.spread())
}

/// Adds $f\,gg^T$.
pub(super) fn add_square(sum: &mut Mat<f64>, factor: f64, gradient: &[f64]) {
    for (column, of_column) in gradient.iter().enumerate() {
        let column = sum.col_as_slice_mut(column).iter_mut();
        column.zip(gradient).for_each(|(sum, value)| *sum += factor * of_column * value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RECORDS: usize = 5;
    const STRETCHES: usize = 10;

    fn spread(gradient: impl Fn(usize, usize) -> f64) -> f64 {
        let mut clusters = Clusters::new(RECORDS, STRETCHES, 1);
        for record in 0..RECORDS {
            for stretch in 0..STRETCHES {
                clusters.add((record, stretch), &[gradient(record, stretch)]);
            }
        }
        clusters.spread()[(0, 0)]
    }

    /// Errors of one record in all its stretches add up; so do those of one stretch in all records.
    #[test]
    fn val_what_errs_together_is_counted_as_one() {
        let sign = |number: usize| if number.is_multiple_of(2) { 1.0 } else { -1.0 };
        let (r, m) = (RECORDS as f64, STRETCHES as f64);
        // The sum over a stretch is that of five alternating signs, one.
        let by_record = spread(|record, _| sign(record));
        let expected = r / (r - 1.0) * r * m * m + m - r * m;
        assert!((by_record / expected - 1.0).abs() < 1e-12, "{by_record} {expected}");
        // The sum over a record is that of ten alternating signs, none.
        let by_stretch = spread(|_, stretch| sign(stretch));
        let expected = m * r * r - r * m;
        assert!((by_stretch / expected - 1.0).abs() < 1e-12, "{by_stretch} {expected}");
    }

    /// Of errors that share nothing the expectation is that of independent lines: $R$ records of $M$ stretches with variance one
    /// each, and a quarter more for the few records.
    #[test]
    fn val_what_shares_nothing_counts_each_by_itself() {
        let mut state = 7_u64;
        let mut draw = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            3.0_f64.sqrt() * ((state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0)
        };
        let many = 2000;
        let mut mean = 0.0;
        for _ in 0..many {
            let drawn: Vec<f64> = (0..RECORDS * STRETCHES).map(|_| draw()).collect();
            mean += spread(|record, stretch| drawn[record * STRETCHES + stretch]) / f64::from(many);
        }
        let white = (RECORDS * STRETCHES) as f64;
        let of_few = RECORDS as f64 / (RECORDS as f64 - 1.0);
        // One draw scatters by some 0.8 of it: 2000 by 2 %.
        assert!((mean / (of_few * white) - 1.0).abs() < 0.06, "{mean} {white}");
    }
}
