//! Functions along one direction of the plate: Legendre series that keep what the two edges of that direction hold.
//!
//! With $t \in [-1, 1]$ from edge to edge, functions of degree below `terms`: $1$ and $t$, or the one of $1\pm t$ that vanishes
//! where an edge holds the field, or neither; and the integrated Legendre polynomials $P_n-P_{n-2}$, which vanish at both edges.
//! All are scaled to $\int f^2dt = 1$. Since $(P_n-P_{n-2})' = (2n-1)P_{n-1}$, integrals of products are sums of two or three terms
//! and all others exactly zero: functions meet, with derivatives or without, whose degrees are at most two apart.
//!
//! Where spans have lost shear stiffness, deflections with a kink at each edge of a span join in, and integrals are by Gauss'
//! rule from edge to edge, which is exact for them.

use faer::{Mat, MatRef};

use super::field::Field;
use super::span_edges::{Kink, Spans};
use crate::End;
use crate::dense::Cholesky;
use crate::legendre::{gauss_legendre, legendre, norm};

/// A function of $t$ by its Legendre coefficients, and its derivative by $t$ likewise.
#[derive(Debug, Clone)]
struct EdgeFunction {
    /// As many as the degree and one.
    series: Vec<f64>,
    slope: Vec<f64>,
    /// What no series follows, with its factor.
    kink: Option<(Kink, f64)>,
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
    /// The same of what is left of the shear stiffness; none where all is.
    sheared: Option<Mat<f64>>,
}

impl EdgeBasis {
    /// `across` is the rotation across the two edges `ends`, counted from $-h$ to $+h$; a clamp that `yields` holds no field.
    pub(super) fn new(half_length: f64, ends: [End; 2], yields: bool, across: Field, terms: usize) -> Self {
        let fields = Field::ALL.map(|field| {
            let holds = |end: End| match end {
                End::Free => false,
                End::Pinned => field != across,
                End::Clamped => !yields,
            };
            edge_functions(ends.map(holds), terms)
        });
        let (symmetric, integrals) = (ends[0] == ends[1], Mat::zeros(0, 0));
        let mut basis = Self { half_length, terms, symmetric, fields, integrals, sheared: None };
        basis.integrals = basis.all_integrals();
        basis
    }

    /// The same with spans that have lost shear stiffness.
    pub(super) fn with_spans(mut self, ends: [End; 2], spans: &Spans) -> Self {
        let held = ends.map(|end| end != End::Free);
        let polynomials = self.terms;
        let rule = spans.rule(polynomials + 3);
        let own = &mut self.fields[Field::Deflection as usize];
        let with = |kink| EdgeFunction::with_kink(kink, own, polynomials, &rule);
        let more: Vec<EdgeFunction> = spans.kinks(held).into_iter().filter_map(with).collect();
        own.extend(more);
        self.terms = self.fields.iter().map(Vec::len).max().unwrap_or(polynomials).max(polynomials);
        self.symmetric = false;
        // Of polynomials alone by their series, which leave exact zeros.
        let exact = self.all_integrals();
        let mut integrals = self.by_rule(&rule, |_| 1.0, &[&EVERY]);
        let kinked = |index: usize| {
            let function = self.fields[index / (2 * self.terms)].get(index % self.terms);
            function.is_some_and(|function| function.kink.is_some())
        };
        for column in (0..integrals.ncols()).filter(|column| !kinked(*column)) {
            let values = integrals.col_as_slice_mut(column).iter_mut().enumerate();
            values.filter(|(row, _)| !kinked(*row)).for_each(|(row, value)| *value = exact[(row, column)]);
        }
        self.integrals = integrals;
        self.sheared = Some(self.by_rule(&rule, |t| spans.remaining(t), &[&SHEAR_ALONG, &SHEAR_ACROSS]));
        self
    }

    /// Integrals of every two of what each list has.
    fn by_rule(&self, rule: &[(f64, f64)], share: impl Fn(f64) -> f64, lists: &[&[(Field, usize)]]) -> Mat<f64> {
        let size = 6 * self.terms;
        let values = Mat::<f64>::zeros(rule.len(), size);
        let (mut left, mut right) = (values.clone(), values);
        let h = self.half_length;
        for (row, &(t, weight)) in rule.iter().enumerate() {
            let polynomials = legendre(self.terms, t);
            for field in Field::ALL {
                for (n, function) in self.fields[field as usize].iter().enumerate() {
                    let [value, slope] = function.at(t, &polynomials);
                    for (order, value) in [(0, value), (1, slope / h)] {
                        let column = self.index(field, order, n);
                        left[(row, column)] = weight * share(t) * h * value;
                        right[(row, column)] = value;
                    }
                }
            }
        }
        let mut integrals = Mat::zeros(size, size);
        for list in lists {
            for (&(f, p), &(g, q)) in list.iter().flat_map(|f| list.iter().map(move |g| (f, g))) {
                let (row, column) = (self.index(f, p, 0), self.index(g, q, 0));
                let of =
                    |values: &'_ Mat<f64>, from: usize, count: usize| values.get(.., from..from + count).to_owned();
                let (left, right) = (of(&left, row, self.count(f)), of(&right, column, self.count(g)));
                let part = crate::dense::product(left.transpose(), right.as_ref());
                for j in 0..part.ncols() {
                    integrals.col_as_slice_mut(column + j)[row..row + part.nrows()]
                        .copy_from_slice(part.col_as_slice(j));
                }
            }
        }
        integrals
    }

    /// Half of what lies between the edges \[m\].
    pub(super) fn half_length(&self) -> f64 {
        self.half_length
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

    /// Whether spans have lost shear stiffness.
    pub(super) fn is_sheared(&self) -> bool {
        self.sheared.is_some()
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

    /// The same over what is left of the shear stiffness.
    pub(super) fn sheared_integrals(&self, (f, p): (Field, usize), (g, q): (Field, usize)) -> MatRef<'_, f64> {
        let (row, column) = (self.index(f, p, 0), self.index(g, q, 0));
        let integrals = self.sheared.as_ref().unwrap_or(&self.integrals);
        integrals.submatrix(row, column, self.count(f), self.count(g))
    }

    fn index(&self, field: Field, order: usize, number: usize) -> usize {
        (2 * field as usize + order) * self.terms + number
    }

    fn all_integrals(&self) -> Mat<f64> {
        let size = 6 * self.terms;
        let mut integrals = Mat::zeros(size, size);
        // By the number of terms: functions meet whose numbers are near.
        let mut listed: Vec<Vec<(usize, i32, &[f64])>> = vec![Vec::new(); self.terms + 1];
        for field in Field::ALL {
            for (n, function) in self.fields[field as usize].iter().enumerate() {
                for (order, series) in [(0, &function.series), (1, &function.slope)] {
                    listed[series.len()].push((self.index(field, order as usize, n), order, &series[..]));
                }
            }
        }
        for (length, own) in listed.iter().enumerate() {
            let near = &listed[length.saturating_sub(SPAN)..(length + SPAN + 1).min(listed.len())];
            for (&(row, p, f), &(column, q, g)) in own.iter().flat_map(|f| near.iter().flatten().map(move |g| (f, g))) {
                // The lowest degrees of both are zero.
                let lowest = f.len().max(g.len()).saturating_sub(SPAN);
                if f.len().min(g.len()) <= lowest {
                    continue;
                }
                let both = f.iter().zip(g).enumerate().skip(lowest);
                let sum: f64 = both.map(|(n, (a, b))| a * b * norm(n)).sum();
                integrals[(row, column)] = sum * self.half_length.powi(1 - p - q);
            }
        }
        integrals
    }

    /// Degree of a field's function; what has a kink comes after all polynomials.
    pub(super) fn degree(&self, field: Field, number: usize) -> usize {
        match self.fields[field as usize].get(number) {
            Some(function) if function.kink.is_none() => function.series.len() - 1,
            _ => self.terms + number,
        }
    }

    /// Whether two functions or their derivatives have any integral, by numbers of [`EdgeBasis::slot`].
    pub(super) fn meetings(&self) -> Vec<Vec<bool>> {
        let count = 3 * self.terms;
        let any = |row: usize, column: usize| {
            let at = |slot: usize, order: usize| (2 * (slot / self.terms) + order) * self.terms + slot % self.terms;
            let all = [(0, 0), (0, 1), (1, 0), (1, 1)];
            all.iter().any(|&(p, q)| {
                let (row, column) = (at(row, p), at(column, q));
                self.integrals[(row, column)] != 0.0
                    || self.sheared.as_ref().is_some_and(|sheared| sheared[(row, column)] != 0.0)
            })
        };
        (0..count).map(|row| (0..count).map(|column| any(row, column)).collect()).collect()
    }

    /// Number of a field's function among those of all fields.
    pub(super) fn slot(&self, field: Field, number: usize) -> usize {
        field as usize * self.terms + number
    }

    /// Values of all functions of a field at a place \[m\] of this direction, from its centre.
    pub(super) fn values_at(&self, field: Field, place: f64) -> Vec<f64> {
        self.sums_at(field, place, 0)
    }

    /// Their slopes \[1/m\] there.
    pub(super) fn slopes_at(&self, field: Field, place: f64) -> Vec<f64> {
        self.sums_at(field, place, 1).into_iter().map(|slope| slope / self.half_length).collect()
    }

    /// The integral of each function of a field, or of its slope, times an orthonormal polynomial of Legendre over a stretch.
    pub(super) fn moments(&self, field: Field, order: usize, ([low, high], degree): ([f64; 2], usize)) -> Vec<f64> {
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let mut sum = vec![0.0; self.count(field)];
        if half <= 0.0 {
            return sum;
        }
        let scale = (half * (degree as f64 + 0.5)).sqrt();
        for (t, weight) in gauss_legendre(MOMENT_POINTS).iter() {
            let place = middle + half * t;
            let values = if order == 0 { self.values_at(field, place) } else { self.slopes_at(field, place) };
            let by = scale * weight * legendre(degree + 1, *t)[degree];
            sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += by * value);
        }
        sum
    }

    fn sums_at(&self, field: Field, place: f64, order: usize) -> Vec<f64> {
        let t = place / self.half_length;
        let polynomials = legendre(self.terms, t);
        self.fields[field as usize].iter().map(|function| function.at(t, &polynomials)[order]).collect()
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
        match (n, held_low, held_high) {
            (0, ..) | (1, false, false) => {}
            (1, true, _) => series[0] = 1.0,
            (1, false, true) => series[0] = -1.0,
            _ => series[n - 2] = -1.0,
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
        Self { slope: slope_of(&series), series, kink: None }
    }

    /// A kink without what the functions there already follow of it; `None` where that is all.
    fn with_kink(kink: Kink, own: &[Self], terms: usize, rule: &[(f64, f64)]) -> Option<Self> {
        let samples: Vec<(f64, f64, Vec<f64>)> = rule
            .iter()
            .map(|&(t, weight)| {
                let polynomials = legendre(terms, t);
                (kink.at(t)[0], weight, own.iter().map(|f| f.at(t, &polynomials)[0]).collect())
            })
            .collect();
        let gram = Mat::from_fn(own.len(), own.len(), |i, j| {
            samples.iter().map(|(_, weight, f)| weight * f[i] * f[j]).sum::<f64>()
        });
        let mut shares =
            Mat::from_fn(own.len(), 1, |i, _| samples.iter().map(|(kink, weight, f)| weight * kink * f[i]).sum());
        let factor = Cholesky::new(&gram)?;
        factor.solve_lower(&mut shares);
        factor.solve_upper(&mut shares);
        let left =
            |(kink, _, f): &(f64, f64, Vec<f64>)| kink - (0..f.len()).map(|i| shares[(i, 0)] * f[i]).sum::<f64>();
        let size = samples.iter().map(|sample| sample.1 * left(sample).powi(2)).sum::<f64>().sqrt();
        let whole = samples.iter().map(|sample| sample.1 * sample.0.powi(2)).sum::<f64>().sqrt();
        if size <= FOLLOWED * whole {
            return None;
        }
        let mut series = vec![0.0; terms];
        for (i, function) in own.iter().enumerate() {
            let share = -shares[(i, 0)] / size;
            series.iter_mut().zip(&function.series).for_each(|(sum, c)| *sum += share * c);
        }
        Some(Self { slope: slope_of(&series), series, kink: Some((kink, size.recip())) })
    }

    /// Value and derivative at $t$, given the Legendre polynomials there.
    fn at(&self, t: f64, polynomials: &[f64]) -> [f64; 2] {
        let mut values =
            [&self.series, &self.slope].map(|series| series.iter().zip(polynomials).map(|(c, p)| c * p).sum::<f64>());
        if let Some((kink, factor)) = &self.kink {
            values.iter_mut().zip(kink.at(t)).for_each(|(value, own)| *value += factor * own);
        }
        values
    }
}

/// Every field and its slope.
const EVERY: [(Field, usize); 6] = {
    use Field::{Deflection, RotationX, RotationY};
    [(Deflection, 0), (Deflection, 1), (RotationX, 0), (RotationX, 1), (RotationY, 0), (RotationY, 1)]
};

/// What of the shear strain along x goes with x, and of that along y.
const SHEAR_ALONG: [(Field, usize); 2] = [(Field::Deflection, 1), (Field::RotationX, 0)];
const SHEAR_ACROSS: [(Field, usize); 2] = [(Field::Deflection, 0), (Field::RotationY, 0)];

/// Degrees that a function without kinks has: its highest, and two below.
const SPAN: usize = 3;
/// Points of a moment's integral.
const MOMENT_POINTS: usize = 10;

/// Part of a kink's size that is no function of its own.
const FOLLOWED: f64 = 1e-7;

/// $P_n' = (2n-1)P_{n-1} + (2n-5)P_{n-3} + \dots$
fn slope_of(series: &[f64]) -> Vec<f64> {
    let mut slope = vec![0.0; series.len().saturating_sub(1)];
    for (n, coefficient) in series.iter().enumerate() {
        for k in (0..n).rev().step_by(2) {
            slope[k] += coefficient * (2 * k + 1) as f64;
        }
    }
    slope
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
            let basis = EdgeBasis::new(0.4, ends, false, Field::RotationX, 9);
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
        let basis = EdgeBasis::new(0.15, [End::Free, End::Clamped], false, Field::RotationX, 8);
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
