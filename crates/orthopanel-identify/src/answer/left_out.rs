//! What is foretold of each part of the data by all others, in closed form.

use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::prelude::Solve;
use faer::{Mat, Par, Side};

/// Part of the diagonal that is added to a part's matrix: a number that no other part tells leaves a direction without any.
const RIDGE: f64 = 1e-12;

/// A linear problem: data $y = Jz + e$ with the covariance $C = LL^T$ of $e$, and the precision $\Lambda$ of $z$ about zero beforehand.
pub(super) struct Linear<'a> {
    /// $L^{-1}$.
    pub inverse_factor: &'a Mat<f64>,
    /// $L^{-1}y$.
    pub values: Vec<f64>,
    /// $L^{-1}J$.
    pub derivatives: Mat<f64>,
    /// The diagonal of $\Lambda$.
    pub precision: Vec<f64>,
}

/// A group of data beside its prediction from all others.
pub(super) struct LeftOut {
    /// $e_r^TS_r^{-1}e_r$.
    pub square: f64,
    /// $e_r$.
    pub missed: Mat<f64>,
    /// $S_r$.
    pub covariance: Mat<f64>,
}

impl Linear<'_> {
    /// Of each group $r$ of data, which lists their places: what it misses of its prediction from all others.
    ///
    /// Before any datum $y$ has the covariance $P^{-1} = C + J\Lambda^{-1}J^T$, and so
    /// $$P = C^{-1} - C^{-1}J(J^TC^{-1}J + \Lambda)^{-1}J^TC^{-1},\qquad S_r = P_{rr}^{-1},\qquad e_r = P_{rr}^{-1}(Py)_r$$
    /// (Dubrule, Math. Geol. 15, 1983): nothing is fitted anew. `None` where the data do not determine the parameters.
    pub(super) fn left_out(&self, groups: &[Vec<usize>]) -> Option<Vec<LeftOut>> {
        let (rows, columns) = (self.derivatives.nrows(), self.derivatives.ncols());
        let transposed = self.derivatives.transpose();
        let mut curvature = transposed * &self.derivatives;
        (0..columns).for_each(|i| curvature[(i, i)] += self.precision[i]);
        let factor = curvature.llt(Side::Lower).ok()?;
        let values = Mat::from_fn(rows, 1, |i, _| self.values[i]);
        let step = factor.solve(transposed * &values);
        // $P = L^{-T}L^{-1} - U^TU$.
        let whole = self.inverse_factor.transpose() * (values - &self.derivatives * step);
        let mut taken = transposed * self.inverse_factor;
        solve_lower_triangular_in_place(factor.L(), taken.as_mut(), Par::Seq);
        let of_group = |group: &Vec<usize>| {
            let columns = |of: &Mat<f64>| Mat::from_fn(of.nrows(), group.len(), |i, j| of[(i, group[j])]);
            let (noise, taken) = (columns(self.inverse_factor), columns(&taken));
            let mut own = noise.transpose() * &noise - taken.transpose() * &taken;
            (0..group.len()).for_each(|i| own[(i, i)] += RIDGE * noise.col(i).squared_norm_l2());
            let told = Mat::from_fn(group.len(), 1, |i, _| whole[(group[i], 0)]);
            let factor = own.llt(Side::Lower).ok()?;
            let missed = factor.solve(&told);
            let covariance = factor.solve(Mat::<f64>::identity(group.len(), group.len()));
            Some(LeftOut { square: (told.transpose() * &missed)[(0, 0)], missed, covariance })
        };
        groups.iter().map(of_group).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::whitening::Whitening;

    const DATA: usize = 9;
    const PARAMETERS: usize = 3;

    /// Numbers without a pattern.
    fn number(i: usize, j: usize) -> f64 {
        (12.9898 * (i as f64 + 1.0) + 78.233 * (j as f64 + 1.0)).sin()
    }

    /// Each group is left out, and the rest fitted: the error of the prediction from that, over what it is sure to.
    #[test]
    fn val_a_group_is_foretold_as_by_a_fit_to_the_others() {
        let spread = Mat::from_fn(DATA, DATA, |i, j| 0.3 * number(i, j));
        let covariance = &spread * spread.transpose() + Mat::<f64>::identity(DATA, DATA) * 0.2;
        let derivatives = Mat::from_fn(DATA, PARAMETERS, |i, j| number(i + 20, j));
        // The last is held by nothing but the data.
        let precision = vec![1.0, 1.0, 0.0];
        let values: Vec<f64> = (0..DATA).map(|i| number(i, 7)).collect();
        let by = Whitening::new(&covariance).expect("a covariance");
        let (mut inverse_factor, mut whitened) = (Mat::identity(DATA, DATA), derivatives.clone());
        by.whiten(&mut inverse_factor);
        by.whiten(&mut whitened);
        let linear = Linear {
            inverse_factor: &inverse_factor,
            values: by.whitened(&values),
            derivatives: whitened,
            precision: precision.clone(),
        };
        let groups = [vec![0, 1, 2], vec![3, 5], vec![8]];
        let found = linear.left_out(&groups).expect("determined");
        for (group, found) in groups.iter().zip(found) {
            let others: Vec<usize> = (0..DATA).filter(|i| !group.contains(i)).collect();
            let of = |rows: &[usize], columns: &[usize]| {
                Mat::from_fn(rows.len(), columns.len(), |i, j| covariance[(rows[i], columns[j])])
            };
            let slopes = |rows: &[usize]| Mat::from_fn(rows.len(), PARAMETERS, |i, j| derivatives[(rows[i], j)]);
            let data = |rows: &[usize]| Mat::from_fn(rows.len(), 1, |i, _| values[rows[i]]);
            let noise = of(&others, &others).llt(Side::Lower).expect("a covariance");
            let curvature = slopes(&others).transpose() * noise.solve(slopes(&others))
                + Mat::from_fn(PARAMETERS, PARAMETERS, |i, j| if i == j { precision[i] } else { 0.0 });
            let curvature = curvature.llt(Side::Lower).expect("determined");
            let fitted = curvature.solve(slopes(&others).transpose() * noise.solve(data(&others)));
            let along = of(group, &others) * noise.solve(data(&others) - slopes(&others) * &fitted);
            let missed = data(group) - slopes(group) * &fitted - along;
            let free = slopes(group) - of(group, &others) * noise.solve(slopes(&others));
            let sure = of(group, group) - of(group, &others) * noise.solve(of(&others, group))
                + &free * curvature.solve(free.transpose());
            let wanted = (missed.transpose() * sure.llt(Side::Lower).expect("a covariance").solve(&missed))[(0, 0)];
            assert!((found.square / wanted - 1.0).abs() < 1e-9, "{} {wanted}", found.square);
        }
    }
}
