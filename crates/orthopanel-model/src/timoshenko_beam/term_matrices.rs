//! Matrices of an uneven beam, in the coordinates of its strain functions, by quadrature between the edges of its spans.

use faer::Mat;

use super::beam_terms::ShearLoss;
use super::strain_basis::StrainFunction;
use crate::dense::product;
use crate::legendre::{gauss_legendre, legendre};

/// Values of all functions at Gauss points that no edge lies between.
#[derive(Debug, Clone)]
pub(super) struct Quadrature {
    half_length: f64,
    /// $t$ and weight in $x$ of each point.
    points: Vec<(f64, f64)>,
    /// $w'+\psi$, $\psi$, $w$: a row a point, a column a function.
    values: [Mat<f64>; 3],
}

/// A field of [`Quadrature`]; none asks for the curvature, whose matrix is diagonal.
#[derive(Debug, Clone, Copy)]
pub(super) enum Field {
    Shear,
    Rotation,
    Deflection,
}

impl Quadrature {
    pub(super) fn new(functions: &[StrainFunction], half_length: f64, losses: &[ShearLoss]) -> Self {
        let terms = functions.iter().map(|f| f.deflection.len()).max().unwrap_or(0);
        let mut edges: Vec<f64> =
            losses.iter().flat_map(|loss| loss.edges(half_length)).map(|x| x / half_length).collect();
        edges.extend([-1.0, 1.0]);
        edges.sort_by(f64::total_cmp);
        let rule = gauss_legendre(terms + 2);
        let stretches = edges.windows(2).filter_map(|pair| match pair {
            [low, high] if high > low => Some((0.5 * (low + high), 0.5 * (high - low))),
            _ => None,
        });
        let points: Vec<(f64, f64)> = stretches
            .flat_map(|(middle, half)| {
                rule.iter().map(move |(t, weight)| (middle + half * t, half_length * half * weight))
            })
            .collect();
        let at_points: Vec<Vec<f64>> = points.iter().map(|&(t, _)| legendre(terms, t)).collect();
        let polynomials = Mat::from_fn(points.len(), terms, |row, n| at_points[row][n]);
        let of_series = |series: &dyn Fn(&StrainFunction) -> &[f64]| {
            let coefficients = Mat::from_fn(terms, functions.len(), |n, column| {
                series(&functions[column]).get(n).copied().unwrap_or_default()
            });
            product(polynomials.as_ref(), coefficients.as_ref())
        };
        let mut values = [of_series(&|f| &f.shear), of_series(&|f| &f.rotation), of_series(&|f| &f.deflection)];
        for (column, step) in functions.iter().enumerate().filter_map(|(column, f)| Some((column, f.step?))) {
            for (row, &(t, _)) in points.iter().enumerate() {
                let [shear, deflection] = step.at(t, half_length);
                values[Field::Shear as usize][(row, column)] += shear;
                values[Field::Deflection as usize][(row, column)] += deflection;
            }
        }
        Self { half_length, points, values }
    }

    /// $\int f_if_jg\,dx$ of a field with a weight $g(x)$.
    pub(super) fn product(&self, field: Field, weight: impl Fn(f64) -> f64) -> Mat<f64> {
        let values = &self.values[field as usize];
        let scale: Vec<f64> = self.points.iter().map(|(t, w)| w * weight(self.half_length * t)).collect();
        let weighted = Mat::from_fn(values.nrows(), values.ncols(), |i, j| scale[i] * values[(i, j)]);
        product(values.transpose(), weighted.as_ref())
    }

    /// $\int(w'+\psi)_i(w'+\psi)_j\,dx$ over the span of a loss.
    pub(super) fn span(&self, loss: &ShearLoss) -> Mat<f64> {
        let [low, high] = loss.edges(self.half_length);
        self.product(Field::Shear, |x| if x > low && x < high { 1.0 } else { 0.0 })
    }
}

/// Springs against the end motions, which have a coordinate each.
pub(super) fn support_stiffness(functions: &[StrainFunction], [translation, rotation]: [f64; 2]) -> Mat<f64> {
    let mut matrix = Mat::zeros(functions.len(), functions.len());
    for (i, function) in functions.iter().enumerate() {
        let [deflects, rotates] = function.moves_end;
        matrix[(i, i)] = translation * deflects + rotation * rotates;
    }
    matrix
}
