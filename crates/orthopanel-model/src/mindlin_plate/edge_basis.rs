//! Functions along one direction of the plate: Legendre series that keep what the two edges of that direction hold.
//!
//! With $t \in [-1, 1]$ from edge to edge, functions of degree below `terms` that vanish where the edge holds the field:
//! nowhere $P_n$; at one edge $P_n \pm P_{n-1}$; at both $P_{n+2}-P_n$, which are the integrated Legendre polynomials.
//! All are scaled to $\int f^2dt = 1$. The products' integrals are sums of two or three terms or, for derivatives, finite
//! sums: nothing is left to quadrature.

use faer::{Mat, MatRef};

use super::Field;
use crate::End;
use crate::legendre::{legendre, norm};

/// A function of $t$ by its Legendre coefficients, and its derivative by $t$ likewise.
#[derive(Debug, Clone)]
struct EdgeFunction {
    series: Vec<f64>,
    slope: Vec<f64>,
}

/// The functions of all three fields along one direction, with the integrals of their products.
#[derive(Debug, Clone)]
pub(super) struct EdgeBasis {
    half_length: f64,
    terms: usize,
    /// Whether both edges are held alike, so that functions part by parity.
    symmetric: bool,
    fields: [Vec<EdgeFunction>; 3],
    /// Integrals over the direction \[m^(1 - orders)\], rows and columns by [`EdgeBasis::index`].
    integrals: Mat<f64>,
}

impl EdgeBasis {
    /// `across` is the rotation across the two edges `ends`, counted from $-h$ to $+h$.
    pub(super) fn new(half_length: f64, ends: [End; 2], across: Field, terms: usize) -> Self {
        let fields = Field::ALL.map(|field| {
            let holds = |end: End| if field == across { end == End::Clamped } else { end != End::Free };
            edge_functions(ends.map(holds), terms)
        });
        let mut basis = Self { half_length, terms, symmetric: ends[0] == ends[1], fields, integrals: Mat::zeros(0, 0) };
        basis.integrals = basis.all_integrals();
        basis
    }

    /// Numbers of a field's functions of one parity; of all functions where the edges differ.
    pub(super) fn of_parity(&self, field: Field, odd: bool) -> impl Iterator<Item = usize> + use<> {
        let (symmetric, count) = (self.symmetric, self.fields[field as usize].len());
        (0..count).filter(move |n| !symmetric || (n % 2 == 1) == odd)
    }

    /// Whether functions part by parity.
    pub(super) fn parts(&self) -> bool {
        self.symmetric
    }

    /// The parities that deflections may have: even and odd, or one stand-in where the edges differ.
    pub(super) fn parities(&self) -> &'static [bool] {
        if self.symmetric { &[false, true] } else { &[false] }
    }

    /// Number of a field's functions.
    pub(super) fn count(&self, field: Field) -> usize {
        self.fields[field as usize].len()
    }

    /// $\int f^{(p)}g^{(q)}dx$: a row a function of field `f`, a column one of field `g`.
    pub(super) fn integrals(&self, (f, p): (Field, usize), (g, q): (Field, usize)) -> MatRef<'_, f64> {
        let (row, column) = (self.index(f, p, 0), self.index(g, q, 0));
        self.integrals.submatrix(row, column, self.count(f), self.count(g))
    }

    fn index(&self, field: Field, order: usize, number: usize) -> usize {
        (2 * field as usize + order) * self.terms + number
    }

    fn all_integrals(&self) -> Mat<f64> {
        let size = 6 * self.terms;
        let mut integrals = Mat::zeros(size, size);
        let listed: Vec<(usize, i32, &[f64])> = Field::ALL
            .into_iter()
            .flat_map(|field| self.fields[field as usize].iter().enumerate().map(move |(n, f)| (field, n, f)))
            .flat_map(|(field, n, f)| {
                [(self.index(field, 0, n), 0, &f.series[..]), (self.index(field, 1, n), 1, &f.slope[..])]
            })
            .collect();
        for &(row, p, f) in &listed {
            for &(column, q, g) in &listed {
                let sum: f64 = f.iter().zip(g).enumerate().map(|(n, (a, b))| a * b * norm(n)).sum();
                integrals[(row, column)] = sum * self.half_length.powi(1 - p - q);
            }
        }
        integrals
    }

    /// Values of all functions of a field at a place \[m\] of this direction, from its centre.
    pub(super) fn values_at(&self, field: Field, place: f64) -> Vec<f64> {
        self.sums_at(field, place, |function| &function.series, 1.0)
    }

    /// Their slopes \[1/m\] there.
    pub(super) fn slopes_at(&self, field: Field, place: f64) -> Vec<f64> {
        self.sums_at(field, place, |function| &function.slope, self.half_length.recip())
    }

    fn sums_at(&self, field: Field, place: f64, series: fn(&EdgeFunction) -> &[f64], scale: f64) -> Vec<f64> {
        let values = legendre(self.terms, place / self.half_length);
        let at = |f: &EdgeFunction| scale * series(f).iter().zip(&values).map(|(c, p)| c * p).sum::<f64>();
        self.fields[field as usize].iter().map(at).collect()
    }

    /// Where function `number` of the deflection is linear, its slope \[1/m\]; zero where it is constant.
    pub(super) fn linear_slope(&self, number: usize) -> Option<f64> {
        let function = self.fields[Field::Deflection as usize].get(number)?;
        match function.series.len() {
            1 => Some(0.0),
            2 => function.slope.first().map(|slope| slope / self.half_length),
            _ => None,
        }
    }

    /// The coefficient of a field's first function that makes it one everywhere, where the edges allow that.
    pub(super) fn unit(&self, field: Field) -> Option<f64> {
        match self.fields[field as usize].first()?.series[..] {
            [constant] => Some(constant.recip()),
            _ => None,
        }
    }
}

fn edge_functions([held_low, held_high]: [bool; 2], terms: usize) -> Vec<EdgeFunction> {
    let series = |n: usize| {
        let mut series = vec![0.0; n];
        series.push(1.0);
        match (held_low, held_high) {
            (false, false) => {}
            (true, false) => series[n - 1] = 1.0,
            (false, true) => series[n - 1] = -1.0,
            (true, true) => series[n - 2] = -1.0,
        }
        series
    };
    let lowest = usize::from(held_low) + usize::from(held_high);
    (lowest..terms).map(|n| EdgeFunction::of_unit_norm(series(n))).collect()
}

impl EdgeFunction {
    fn of_unit_norm(mut series: Vec<f64>) -> Self {
        let square: f64 = series.iter().enumerate().map(|(n, c)| c * c * norm(n)).sum();
        series.iter_mut().for_each(|c| *c /= square.sqrt());
        // P_n' = (2n-1) P_{n-1} + (2n-5) P_{n-3} + ...
        let mut slope = vec![0.0; series.len().saturating_sub(1)];
        for (n, coefficient) in series.iter().enumerate() {
            for k in (0..n).rev().step_by(2) {
                slope[k] += coefficient * (2 * k + 1) as f64;
            }
        }
        Self { series, slope }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Held fields vanish at their edge, and the rotation across a pinned edge does not.
    #[test]
    fn fields_vanish_where_they_are_held() {
        for (ends, holds) in [
            ([End::Free, End::Pinned], [[false, true], [false, false], [false, true]]),
            ([End::Clamped, End::Pinned], [[true, true], [true, false], [true, true]]),
            ([End::Clamped, End::Clamped], [[true, true]; 3]),
        ] {
            let basis = EdgeBasis::new(0.4, ends, Field::RotationX, 9);
            for (functions, holds) in basis.fields.iter().zip(holds) {
                for (t, held) in [-1.0, 1.0].into_iter().zip(holds) {
                    let values = legendre(9, t);
                    let at = |f: &EdgeFunction| f.series.iter().zip(&values).map(|(c, p)| c * p).sum::<f64>().abs();
                    let greatest = functions.iter().map(at).fold(0.0, f64::max);
                    assert_eq!(greatest < 1e-14, held, "{ends:?} at {t}: {greatest}");
                }
            }
        }
    }

    /// $\int f'g\,dx + \int fg'\,dx = [fg]$.
    #[test]
    fn val_integrals_by_parts() {
        let basis = EdgeBasis::new(0.15, [End::Free, End::Clamped], Field::RotationX, 8);
        let w = Field::Deflection;
        let slopes = basis.integrals((w, 1), (w, 0));
        let (low, high) = (basis.values_at(w, -0.15), basis.values_at(w, 0.15));
        for i in 0..7 {
            for j in 0..7 {
                let parts = slopes[(i, j)] + slopes[(j, i)];
                let edges = high[i] * high[j] - low[i] * low[j];
                assert!((parts - edges).abs() < 1e-12, "{i} {j}: {parts} {edges}");
            }
        }
    }
}
