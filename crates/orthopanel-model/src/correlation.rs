//! How what is known of constants and damping hangs together.

use serde::{Deserialize, Serialize};

use crate::{ModelError, PanelModel};

/// What of a variance of one may lie beside what the others leave of it: files are written with some digits.
const ROUNDING: f64 = 1e-6;

/// Correlation of constants (by their names) and damping ratios (`damping_ratio_1`, ..): $R_{ij} = \operatorname{cov}(p_i, p_j)/(\sigma_i\sigma_j)$.
/// What is not named depends on nothing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Correlation {
    /// Names, in the order of rows and columns.
    pub names: Vec<String>,
    /// Rows of $R$ \[1\].
    pub matrix: Vec<Vec<f64>>,
}

impl Correlation {
    /// $R_{ij}$ by names: one for each with itself, zero for what is not named.
    pub fn between(&self, first: &str, second: &str) -> f64 {
        let index = |name: &str| self.names.iter().position(|known| known == name);
        let value = || self.matrix.get(index(first)?)?.get(index(second)?).copied();
        if first == second { 1.0 } else { value().unwrap_or(0.0) }
    }

    /// Rows of the lower triangle $L$ with $L L^T = R$: independent normal numbers times it hang together by $R$. Where some follow wholly from
    /// others, their columns are zero.
    ///
    /// # Errors
    /// [`ModelError::Correlation`] where $R$ is no correlation: another shape, ones not on its diagonal, not symmetric, or no distribution has it.
    pub fn factor(&self) -> Result<Vec<Vec<f64>>, ModelError> {
        let refused = |problem: String| Err(ModelError::Correlation { problem });
        let (count, matrix) = (self.names.len(), &self.matrix);
        if matrix.len() != count || matrix.iter().any(|row| row.len() != count) {
            return refused(format!("matrix must have {count} rows of {count} numbers, as there are names"));
        }
        if let Some(value) = matrix.iter().flatten().find(|value| !value.is_finite()) {
            return refused(format!("matrix holds {value}: must be finite numbers"));
        }
        let mut factor: Vec<Vec<f64>> = Vec::with_capacity(count);
        for (i, row) in matrix.iter().enumerate() {
            if (row[i] - 1.0).abs() > ROUNDING {
                return refused(format!("matrix[{i}][{i}] = {}: the diagonal must be of ones", row[i]));
            }
            let mut own = vec![0.0; count];
            for j in 0..=i {
                if (row[j] - matrix[j][i]).abs() > ROUNDING {
                    return refused(format!(
                        "matrix[{i}][{j}] = {} and matrix[{j}][{i}] = {} must be the same",
                        row[j], matrix[j][i]
                    ));
                }
                let before: f64 = own[..j].iter().zip(factor.get(j).unwrap_or(&own)).map(|(a, b)| a * b).sum();
                let rest = row[j] - before;
                let pivot = factor.get(j).map(|other| other[j]);
                let sound = match pivot {
                    None => rest >= -ROUNDING,
                    Some(0.0) => rest.abs() <= ROUNDING.sqrt(),
                    Some(_) => true,
                };
                if !sound {
                    return refused(format!(
                        "no numbers are correlated so: {} contradicts those before it (write more digits, or leave it out)",
                        self.names[i]
                    ));
                }
                own[j] = match pivot {
                    None if rest <= ROUNDING => 0.0,
                    None => rest.sqrt(),
                    Some(0.0) => 0.0,
                    Some(pivot) => rest / pivot,
                };
            }
            factor.push(own);
        }
        Ok(factor)
    }
}

impl PanelModel {
    /// $R_{ij}$ of two constants or damping ratios.
    pub fn correlation_between(&self, first: &str, second: &str) -> f64 {
        let independent = if first == second { 1.0 } else { 0.0 };
        self.correlation.as_ref().map_or(independent, |correlation| correlation.between(first, second))
    }

    pub(crate) fn check_correlation(&self) -> Result<(), ModelError> {
        let Some(correlation) = &self.correlation else { return Ok(()) };
        let ratios = (1..=self.damping.ratios.len()).map(|mode| format!("damping_ratio_{mode}"));
        let known: Vec<String> = self.constants.keys().cloned().chain(ratios).collect();
        for (index, name) in correlation.names.iter().enumerate() {
            let problem = if !known.contains(name) {
                format!("{name:?} is no constant or damping ratio of this model: known are {}", known.join(", "))
            } else if correlation.names[..index].contains(name) {
                format!("{name} stands there twice: leave one out, with its row and column")
            } else {
                continue;
            };
            return Err(ModelError::Correlation { problem });
        }
        correlation.factor().map(|_| ())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(matrix: &[&[f64]]) -> Correlation {
        let names = ["e_x", "g_zx", "damping_ratio_1"].iter().take(matrix.len()).map(|name| (*name).to_owned());
        Correlation { names: names.collect(), matrix: matrix.iter().map(|row| row.to_vec()).collect() }
    }

    #[test]
    fn val_the_factor_times_its_transpose_is_the_matrix() {
        let whole: &[&[f64]] = &[&[1.0, -0.8, 0.3], &[-0.8, 1.0, 0.1], &[0.3, 0.1, 1.0]];
        // The third is the mean of the first two, by its deviation.
        let share = 0.1_f64.sqrt();
        let singular: &[&[f64]] = &[&[1.0, -0.8, share], &[-0.8, 1.0, share], &[share, share, 1.0]];
        for matrix in [whole, singular] {
            let factor = of(matrix).factor().unwrap();
            for (i, row) in matrix.iter().enumerate() {
                for (j, value) in row.iter().enumerate() {
                    let product: f64 = factor[i].iter().zip(&factor[j]).map(|(a, b)| a * b).sum();
                    assert!((product - value).abs() < 1e-6, "{i} {j}: {product} {value}");
                }
            }
        }
    }

    #[test]
    fn what_is_no_correlation_is_refused() {
        let cases: [(&[&[f64]], &str); 5] = [
            (&[&[1.0, 0.5]], "must have 1 rows of 1 numbers"),
            (&[&[1.0, 0.5], &[0.4, 1.0]], "must be the same"),
            (&[&[2.0]], "the diagonal must be of ones"),
            (&[&[1.0, f64::NAN], &[f64::NAN, 1.0]], "must be finite numbers"),
            (&[&[1.0, 0.9, 0.9], &[0.9, 1.0, -0.9], &[0.9, -0.9, 1.0]], "damping_ratio_1 contradicts those before it"),
        ];
        for (matrix, said) in cases {
            let error = of(matrix).factor().unwrap_err().to_string();
            assert!(error.contains(said), "{error}");
        }
    }
}
