//! Matrices of a beam in the coordinates of its strain functions: by their series where these say all, by quadrature between
//! the edges of spans where strains begin at an edge.

use faer::Mat;

use super::beam_terms::ShearLoss;
use super::strain_basis::StrainFunction;
use crate::dense::product;
use crate::legendre::{gauss_legendre, legendre_at, norm};
use crate::order::sort;

/// $h\int_{-1}^1f_if_j\,dt$ of one Legendre series of each function.
#[inline(never)] // Four times in one place, it would make every FMU larger.
pub(super) fn series_products(
    functions: &[StrainFunction],
    half_length: f64,
    series: fn(&StrainFunction) -> &[f64],
) -> Mat<f64> {
    // A series has few terms that are not zero, and few functions share one.
    let terms = functions.iter().map(|f| series(f).len()).max().unwrap_or(0);
    let mut sharing: Vec<Vec<(usize, f64)>> = vec![Vec::new(); terms];
    for (i, function) in functions.iter().enumerate() {
        let coefficients = series(function).iter().zip(&mut sharing);
        coefficients.filter(|(value, _)| **value != 0.0).for_each(|(value, own)| own.push((i, *value)));
    }
    let mut products = Mat::zeros(functions.len(), functions.len());
    for (n, sharing) in sharing.iter().enumerate() {
        for &(j, b) in sharing {
            let column = products.col_as_slice_mut(j);
            sharing.iter().for_each(|&(i, a)| column[i] += half_length * norm(n) * (a * b));
        }
    }
    products
}

/// Values at Gauss points that no edge lies between.
pub(super) struct Quadrature<'a> {
    functions: &'a [StrainFunction],
    half_length: f64,
    /// $t$ and weight in $x$ of each point.
    points: Vec<(f64, f64)>,
    /// Legendre polynomials: a row a point.
    polynomials: Mat<f64>,
    /// The functions that begin at an edge.
    steps: Vec<usize>,
    /// Shear strain and deflection of these, a column each: what begins at the edge, and the series.
    shear: Mat<f64>,
    deflection: Mat<f64>,
}

impl<'a> Quadrature<'a> {
    pub(super) fn new(functions: &'a [StrainFunction], half_length: f64, losses: &[ShearLoss]) -> Self {
        let terms = functions.iter().map(|f| f.deflection.len()).max().unwrap_or(0);
        let mut edges: Vec<f64> =
            losses.iter().flat_map(|loss| loss.edges(half_length)).map(|x| x / half_length).collect();
        edges.extend([-1.0, 1.0]);
        sort(&mut edges);
        // Products of two functions.
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
        let polynomials = legendre_at(terms, &points.iter().map(|(t, _)| *t).collect::<Vec<_>>());
        let steps: Vec<usize> = (0..functions.len()).filter(|&column| functions[column].step.is_some()).collect();
        let values = |series: &dyn Fn(&StrainFunction) -> &[f64], own: usize| {
            let coefficients = Mat::from_fn(terms, steps.len(), |n, k| {
                series(&functions[steps[k]]).get(n).copied().unwrap_or_default()
            });
            let mut values = product(polynomials.as_ref(), coefficients.as_ref());
            for (k, step) in steps.iter().enumerate().filter_map(|(k, &column)| Some((k, functions[column].step?))) {
                for (row, &(t, _)) in points.iter().enumerate() {
                    values[(row, k)] += step.at(t, half_length)[own];
                }
            }
            values
        };
        let (shear, deflection) = (values(&|f| &f.shear, 0), values(&|f| &f.deflection, 1));
        Self { functions, half_length, points, polynomials, steps, shear, deflection }
    }

    /// $\int(w'+\psi)_i(w'+\psi)_j\,dx$. What begins at an edge is orthogonal to every polynomial of the basis.
    pub(super) fn shear(&self) -> Mat<f64> {
        let mut matrix = series_products(self.functions, self.half_length, |f| &f.shear);
        for &column in &self.steps {
            for other in 0..matrix.nrows() {
                (matrix[(column, other)], matrix[(other, column)]) = (0.0, 0.0);
            }
        }
        self.set_among_steps(&mut matrix, &self.shear);
        matrix
    }

    /// $\int w_iw_j\,dx$.
    pub(super) fn deflection(&self) -> Mat<f64> {
        let mut matrix = series_products(self.functions, self.half_length, |f| &f.deflection);
        let moments = product(self.polynomials.transpose(), self.weighted(&self.deflection).as_ref());
        for (k, &column) in self.steps.iter().enumerate() {
            for (other, function) in self.functions.iter().enumerate() {
                let value = function.deflection.iter().enumerate().map(|(n, c)| c * moments[(n, k)]).sum();
                (matrix[(column, other)], matrix[(other, column)]) = (value, value);
            }
        }
        self.set_among_steps(&mut matrix, &self.deflection);
        matrix
    }

    /// $\int(w'+\psi)_i(w'+\psi)_j\,dx$ over the span of a loss.
    pub(super) fn span(&self, loss: &ShearLoss) -> Mat<f64> {
        let [low, high] = loss.edges(self.half_length).map(|x| x / self.half_length);
        let inside: Vec<usize> =
            (0..self.points.len()).filter(|&row| self.points[row].0 > low && self.points[row].0 < high).collect();
        let (strained, mut values) = self.strains(&inside);
        let root: Vec<f64> = inside.iter().map(|&row| self.points[row].1.sqrt()).collect();
        for column in 0..strained.len() {
            values.col_as_slice_mut(column).iter_mut().zip(&root).for_each(|(value, root)| *value *= root);
        }
        self.spread(&strained, &product(values.transpose(), values.as_ref()))
    }

    /// The functions that have shear strain, and theirs at some of the points, a column each.
    fn strains(&self, inside: &[usize]) -> (Vec<usize>, Mat<f64>) {
        let strained: Vec<usize> = (0..self.functions.len())
            .filter(|&i| self.functions[i].step.is_some() || self.functions[i].shear.iter().any(|&c| c != 0.0))
            .collect();
        let mut values = Mat::zeros(inside.len(), strained.len());
        for (column, &function) in strained.iter().enumerate() {
            let values = values.col_as_slice_mut(column);
            let mut add = |share: f64, of: &[f64]| {
                values.iter_mut().zip(inside).for_each(|(value, &row)| *value += share * of[row]);
            };
            match self.steps.iter().position(|step| *step == function) {
                Some(k) => add(1.0, self.shear.col_as_slice(k)),
                None => {
                    let series = self.functions[function].shear.iter().enumerate().filter(|(_, c)| **c != 0.0);
                    series.for_each(|(n, &share)| add(share, self.polynomials.col_as_slice(n)));
                }
            }
        }
        (strained, values)
    }

    /// A matrix of some functions as one of all.
    fn spread(&self, strained: &[usize], within: &Mat<f64>) -> Mat<f64> {
        let mut matrix = Mat::zeros(self.functions.len(), self.functions.len());
        for (j, &column) in strained.iter().enumerate() {
            for (i, &row) in strained.iter().enumerate() {
                matrix[(row, column)] = within[(i, j)];
            }
        }
        matrix
    }

    fn weighted(&self, values: &Mat<f64>) -> Mat<f64> {
        Mat::from_fn(values.nrows(), values.ncols(), |row, k| self.points[row].1 * values[(row, k)])
    }

    fn set_among_steps(&self, matrix: &mut Mat<f64>, values: &Mat<f64>) {
        let among = product(values.transpose(), self.weighted(values).as_ref());
        for (a, &row) in self.steps.iter().enumerate() {
            for (b, &column) in self.steps.iter().enumerate() {
                matrix[(row, column)] = among[(a, b)];
            }
        }
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
