//! Matrices of the terms that make a beam uneven, in the coordinates of its strain functions.

use faer::Mat;

use super::beam_terms::ShearLoss;
use super::ritz::product;
use super::strain_basis::StrainFunction;
use crate::legendre::legendre;

/// $\int(w'+\psi)_i(w'+\psi)_j\,dx$ over the span of a loss.
pub(super) fn span_stiffness(functions: &[StrainFunction], half_length: f64, loss: &ShearLoss) -> Mat<f64> {
    let [low, high] = loss.edges(half_length);
    let terms = functions.iter().map(|f| f.shear.len()).max().unwrap_or(0);
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    let points = gauss_legendre(terms + 1);
    let mut strain = Mat::<f64>::zeros(points.len(), functions.len());
    for (row, (t, weight)) in points.iter().enumerate() {
        let values = legendre(terms, (middle + half * t) / half_length);
        for (column, function) in functions.iter().enumerate() {
            strain[(row, column)] = (half * weight).sqrt() * sum(&function.shear, &values);
        }
    }
    strain.transpose() * &strain
}

/// $(w'+\psi)_i(w'+\psi)_j$ at one end of the span; nothing where that is the beam's own end, which does not move.
pub(super) fn span_edge(functions: &[StrainFunction], edge: f64, half_length: f64) -> Mat<f64> {
    let terms = functions.iter().map(|f| f.shear.len()).max().unwrap_or(0);
    let values = legendre(terms, edge / half_length);
    let on_beam = if edge.abs() < half_length { 1.0 } else { 0.0 };
    let strain: Vec<f64> = functions.iter().map(|f| on_beam * sum(&f.shear, &values)).collect();
    Mat::from_fn(strain.len(), strain.len(), |i, j| strain[i] * strain[j])
}

/// $\int\psi_i\psi_j\,dt$ over $[-1, 1]$.
pub(super) fn mass_by_rotary_factor(functions: &[StrainFunction]) -> Mat<f64> {
    let size = functions.len();
    Mat::from_fn(size, size, |i, j| product(&functions[i].rotation, &functions[j].rotation))
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

fn sum(series: &[f64], values: &[f64]) -> f64 {
    series.iter().zip(values).map(|(c, p)| c * p).sum()
}

/// Points and weights of Gauss and Legendre on $[-1, 1]$: exact for polynomials of degree $2\,\text{count}-1$.
fn gauss_legendre(count: usize) -> Vec<(f64, f64)> {
    let n = count as f64;
    let point = |i: usize| {
        let mut t = (std::f64::consts::PI * (i as f64 + 0.75) / (n + 0.5)).cos();
        let mut slope = 1.0;
        // Newton's steps double the digits: five pass any count.
        for _ in 0..8 {
            let values = legendre(count + 1, t);
            let [Some(before), Some(value)] = [values.get(count - 1), values.get(count)] else { break };
            slope = n * (before - t * value) / (1.0 - t * t);
            t -= value / slope;
        }
        (t, 2.0 / ((1.0 - t * t) * slope * slope))
    };
    (0..count).map(point).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_gauss_legendre_integrates_powers() {
        for count in [1, 2, 5, 61] {
            for power in (0..2 * count).step_by(2) {
                let sum: f64 = gauss_legendre(count).iter().map(|(t, weight)| weight * t.powi(power as i32)).sum();
                assert!((sum - 2.0 / (power as f64 + 1.0)).abs() < 1e-13, "{count} points, power {power}: {sum}");
            }
        }
    }
}
