//! How the errors of a model's constants and damping ratios go together.

use serde::{Deserialize, Serialize};

use crate::ModelError;

/// Correlation matrices are written with fewer digits than they are computed with.
const TOLERANCE: f64 = 1e-6;

/// Correlation of what has a standard deviation in a model file; what is not named is independent of all else.
///
/// $\mathrm{cov}(p_i, p_j) = \rho_{ij}\sigma_i\sigma_j$, of damping ratios of their logarithms.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CorrelationMatrix {
    /// Constants by name, and damping ratios as `damping_ratio_1`, ... of the flexible modes; each once.
    pub names: Vec<String>,
    /// $\rho$, a row a name: symmetric, positive semi-definite, with a diagonal of ones.
    pub matrix: Vec<Vec<f64>>,
}

/// False of what is no number.
fn is_within(value: f64, limit: f64) -> bool {
    (-limit..=limit).contains(&value)
}

/// The name of the damping ratio of flexible mode `mode`, from 1: as FMUs call the parameter.
pub(crate) fn damping_ratio_name(mode: usize) -> String {
    format!("damping_ratio_{mode}")
}

impl CorrelationMatrix {
    /// Of these names, with the coefficient of each two that `of` gives by their places; `None` of fewer than two names, and where a
    /// coefficient is not known.
    pub fn between(names: Vec<String>, of: impl Fn(usize, usize) -> f64) -> Option<Self> {
        let one = |i: usize, j: usize| if i == j { 1.0 } else { of(i.min(j), i.max(j)).clamp(-1.0, 1.0) };
        let row = |i| (0..names.len()).map(|j| one(i, j)).collect();
        let matrix: Vec<Vec<f64>> = (0..names.len()).map(row).collect();
        let is_known = names.len() > 1 && matrix.iter().flatten().all(|value| value.is_finite());
        is_known.then_some(Self { names, matrix })
    }

    /// The coefficient of two names; zero where one of them is not in the matrix.
    pub fn of(&self, first: &str, second: &str) -> f64 {
        let place = |name: &str| self.names.iter().position(|known| known == name);
        let row = place(first).and_then(|row| self.matrix.get(row));
        row.zip(place(second)).and_then(|(row, column)| row.get(column)).copied().unwrap_or(0.0)
    }

    /// Checks names and matrix, of a model with as many damping ratios, and with such constants.
    ///
    /// # Errors
    /// [`ModelError::Correlation`] for a name that the model does not have or that stands twice, and for a matrix that is none of
    /// correlations.
    pub(crate) fn check(&self, ratios: usize, is_constant: impl Fn(&str) -> bool) -> Result<(), ModelError> {
        let refused = |problem: String| Err(ModelError::Correlation { problem });
        let count = self.names.len();
        for (place, name) in self.names.iter().enumerate() {
            let is_ratio = (1..=ratios).any(|mode| damping_ratio_name(mode) == *name);
            if !is_ratio && !is_constant(name) {
                return refused(format!(
                    "names[{place}] = {name:?} is neither one of its constants nor damping_ratio_1 to damping_ratio_{ratios}"
                ));
            }
            if self.names.iter().take(place).any(|earlier| earlier == name) {
                return refused(format!("names[{place}] = {name:?} stands twice"));
            }
        }
        if let Some(found) = self.matrix.iter().map(Vec::len).chain([self.matrix.len()]).find(|found| *found != count) {
            return refused(format!("matrix must have {count} rows of {count} numbers, as many as names, not {found}"));
        }
        for (i, row) in self.matrix.iter().enumerate() {
            for (j, &value) in row.iter().enumerate() {
                let mirrored = self.matrix[j][i];
                if i == j && !is_within(value - 1.0, TOLERANCE) {
                    return refused(format!("matrix[{i}][{i}] = {value}: each correlates with itself by 1"));
                }
                if !is_within(value - mirrored, TOLERANCE) {
                    return refused(format!(
                        "matrix[{i}][{j}] = {value} and matrix[{j}][{i}] = {mirrored}: it must be symmetric"
                    ));
                }
                if !is_within(value, 1.0 + TOLERANCE) {
                    return refused(format!("matrix[{i}][{j}] = {value}: must lie between -1 and 1"));
                }
            }
        }
        match factor(&self.matrix) {
            Some(_) => Ok(()),
            None => refused(
                "matrix is not positive semi-definite: no errors correlate so; write coefficients with six digits or more".into(),
            ),
        }
    }
}

/// Lower triangle $L$ with $\rho = LL^T$ of a positive semi-definite matrix (Cholesky); `None` where it is not.
///
/// What hangs wholly together with those before it has a pivot of zero, and then nothing left with those behind it.
pub(crate) fn factor(matrix: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let count = matrix.len();
    let mut lower = vec![vec![0.0; count]; count];
    for j in 0..count {
        let left = |i: usize, lower: &[Vec<f64>]| {
            matrix[i][j] - lower[i].iter().zip(&lower[j]).take(j).map(|(a, b)| a * b).sum::<f64>()
        };
        let pivot = left(j, &lower);
        if pivot < -TOLERANCE {
            return None;
        }
        for i in j..count {
            let value = left(i, &lower);
            if pivot > TOLERANCE {
                lower[i][j] = value / pivot.sqrt();
            } else if i > j && value.abs() > TOLERANCE.sqrt() {
                return None;
            }
        }
    }
    Some(lower)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PanelModel;

    fn model(correlation: &str) -> Result<PanelModel, ModelError> {
        PanelModel::from_json(&format!(
            r#"{{"schema": "orthopanel.model/1", "structure": "mindlin-plate",
            "piece": {{"length": 0.8, "width": 0.5, "thickness": 0.03, "mass_per_area": 6.88}},
            "constants": {{"e_x": {{"value": 1e10, "std": 1e8}}, "e_y": {{"value": 8e9, "std": 1e8}}, "nu_xy": 0.3, "g_xy": 4e9,
            "g_yz": {{"value": 3e8, "std": 1e7}}, "g_zx": 5e8}}, "damping": {{"ratios": [0.002, 0.003]}}{correlation}}}"#
        ))
    }

    #[test]
    fn val_a_matrix_of_correlations_is_kept_and_any_other_refused() {
        let with =
            |names: &str, matrix: &str| model(&format!(r#", "correlation": {{"names": {names}, "matrix": {matrix}}}"#));
        let kept =
            with(r#"["g_yz", "e_x", "damping_ratio_2"]"#, "[[1, -0.7, 0.1], [-0.7, 1, 0], [0.1, 0, 1]]").unwrap();
        assert_eq!(PanelModel::from_json(&kept.to_json()), Ok(kept.clone()));
        let correlation = kept.correlation.unwrap();
        assert_eq!((correlation.of("e_x", "g_yz"), correlation.of("e_x", "g_xy")), (-0.7, 0.0));
        // Semi-definite: two that are one.
        assert!(with(r#"["e_x", "e_y", "g_yz"]"#, "[[1, 1, 0.5], [1, 1, 0.5], [0.5, 0.5, 1]]").is_ok());
        assert_eq!(model("").unwrap().correlation, None);
        for (names, matrix, said) in [
            (
                r#"["e_x", "e_z"]"#,
                "[[1, 0], [0, 1]]",
                "names[1] = \"e_z\" is neither one of its constants nor damping_ratio_1 to",
            ),
            (r#"["damping_ratio_3"]"#, "[[1]]", "names[0] = \"damping_ratio_3\" is neither"),
            (r#"["e_x", "e_x"]"#, "[[1, 0], [0, 1]]", "names[1] = \"e_x\" stands twice"),
            (r#"["e_x", "e_y"]"#, "[[1, 0]]", "matrix must have 2 rows of 2 numbers, as many as names, not 1"),
            (
                r#"["e_x", "e_y"]"#,
                "[[1, 0], [0, 1, 0]]",
                "matrix must have 2 rows of 2 numbers, as many as names, not 3",
            ),
            (r#"["e_x", "e_y"]"#, "[[1, 0], [0, 1.5]]", "matrix[1][1] = 1.5: each correlates with itself by 1"),
            (
                r#"["e_x", "e_y"]"#,
                "[[1, 0.5], [0.4, 1]]",
                "matrix[0][1] = 0.5 and matrix[1][0] = 0.4: it must be symmetric",
            ),
            (r#"["e_x", "e_y"]"#, "[[1, 1.5], [1.5, 1]]", "matrix[0][1] = 1.5: must lie between -1 and 1"),
            (
                r#"["e_x", "e_y", "g_yz"]"#,
                "[[1, 0.9, -0.9], [0.9, 1, 0.9], [-0.9, 0.9, 1]]",
                "matrix is not positive semi-definite: no errors correlate so",
            ),
            (
                r#"["e_x", "e_y", "g_yz"]"#,
                "[[1, 1, 0.5], [1, 1, -0.5], [0.5, -0.5, 1]]",
                "matrix is not positive semi-definite: no errors correlate so",
            ),
        ] {
            let said_of = with(names, matrix).expect_err(said).to_string();
            assert!(said_of.starts_with(&format!("correlation: {said}")), "{said_of}");
        }
    }
}
