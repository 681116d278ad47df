//! The basis of the Ritz beam: curvature and shear strain, each a Legendre series.
//!
//! With $h = a/2$, $t = x/h$:
//! $$\psi' = \sum k_iP_i(t),\qquad w'+\psi = \sum g_iP_i(t).$$
//! Both stiffness matrices are then diagonal, whatever the ends, so a slender beam does not lock and nothing cancels.
//! Rotation and deflection follow by integration, with two rigid coordinates $\psi_0$, $w_0$. At the ends
//! $$\psi = \psi_0 \pm hk_0,\qquad w = w_0 \pm h\,(g_0 - \psi_0 + hk_1/3),$$
//! so the conditions of held ends touch the five coordinates $(w_0, \psi_0, k_0, k_1, g_0)$ alone. [`low_functions`]
//! lists what remains of these for each pair of ends, chosen so that both stiffnesses stay diagonal.

use crate::dense::{dot, dot_of_common};
use crate::legendre::{antiderivative, gauss_legendre, legendre_at, norm};
use crate::structure::Motion;
use crate::{Boundary, End};

/// One basis function by its Legendre coefficients in $t$.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct StrainFunction {
    /// Of $\psi'$.
    pub curvature: Vec<f64>,
    /// Of $w'+\psi$.
    pub shear: Vec<f64>,
    /// Of $\psi$.
    pub rotation: Vec<f64>,
    /// Of $w$.
    pub deflection: Vec<f64>,
    /// Whether $w$ is even in $x$, odd, or neither.
    pub parity: Parity,
    /// 1 where this function alone deflects a yielding end, and 1 where it alone rotates one.
    pub moves_end: [f64; 2],
    /// Shear strain that begins at an edge of a span; the series above hold the rest.
    pub step: Option<Step>,
}

/// Shear strain $((t-e)/(1-e))^n$ beyond an edge $e$, nothing before.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Step {
    pub edge: f64,
    pub degree: i32,
}

impl StrainFunction {
    /// A motion at $t$, given the Legendre polynomials there.
    pub(super) fn at(&self, motion: Motion, t: f64, polynomials: &[f64], half_length: f64) -> f64 {
        let sum = |series: &[f64]| dot_of_common(series, polynomials);
        let [shear, deflection] = self.step.map_or([0.0; 2], |step| step.at(t, half_length));
        match motion {
            Motion::Deflection | Motion::Foot => sum(&self.deflection) + deflection,
            Motion::Slope => sum(&self.shear) + shear - sum(&self.rotation),
            Motion::Rotation => sum(&self.rotation),
            Motion::Curvature => sum(&self.curvature),
            Motion::SlopeAcross | Motion::Shear(_) => 0.0,
        }
    }
}

impl Step {
    /// Strain and its integral at $t$.
    pub(super) fn at(&self, t: f64, half_length: f64) -> [f64; 2] {
        if t <= self.edge {
            return [0.0; 2];
        }
        let along = (t - self.edge) / (1.0 - self.edge);
        let strain = along.powi(self.degree);
        [strain, half_length * (1.0 - self.edge) * strain * along / f64::from(self.degree + 1)]
    }
}

/// Symmetry of a deflection.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Parity {
    Even,
    Odd,
    Neither,
}

/// The basis with `terms` Legendre terms of each strain that meets the deflection and rotation conditions.
pub(super) fn strain_functions(half_length: f64, boundary: Boundary, terms: usize) -> Vec<StrainFunction> {
    let symmetric = boundary.left == boundary.right;
    let with_parity = |even: bool| match (symmetric, even) {
        (false, _) => Parity::Neither,
        (true, true) => Parity::Even,
        (true, false) => Parity::Odd,
    };
    let low = low_functions(half_length, boundary).into_iter().map(|[w0, psi0, k0, k1, g0]| {
        let even = psi0 == 0.0 && k1 == 0.0 && g0 == 0.0;
        integrated(half_length, [w0, psi0], vec![k0, k1], vec![g0], with_parity(even))
    });
    let unit = |n: usize| (0..=n).map(|i| if i == n { 1.0 } else { 0.0 }).collect::<Vec<f64>>();
    let curvatures = (2..terms).map(|n| integrated(half_length, [0.0; 2], unit(n), vec![], with_parity(n % 2 == 0)));
    let shears = (1..terms).map(|n| integrated(half_length, [0.0; 2], vec![], unit(n), with_parity(n % 2 == 1)));
    low.chain(curvatures).chain(shears).collect()
}

fn integrated(h: f64, [w0, psi0]: [f64; 2], curvature: Vec<f64>, shear: Vec<f64>, parity: Parity) -> StrainFunction {
    let mut rotation: Vec<f64> = antiderivative(&curvature).iter().map(|value| h * value).collect();
    rotation[0] += psi0;
    let length = rotation.len().max(shear.len());
    let at = |series: &[f64], n: usize| series.get(n).copied().unwrap_or(0.0);
    let slope: Vec<f64> = (0..length).map(|n| at(&shear, n) - at(&rotation, n)).collect();
    let mut deflection: Vec<f64> = antiderivative(&slope).iter().map(|value| h * value).collect();
    deflection[0] += w0;
    // ∫P_1 leaves P_2/3 − P_0/3, which vanishes at the ends as the module's formulas want.
    StrainFunction { curvature, shear, rotation, deflection, parity, moves_end: [0.0; 2], step: None }
}

/// Derivatives of the shear strain that may jump at an edge, the strain itself among them.
pub(super) const JUMPS: i32 = 3;

/// Whether a place $t$ lies on the beam and not at its end, where an edge is none.
pub(super) fn is_inside(t: f64) -> bool {
    t.abs() < 1.0 - 1e-4
}

/// Strains that begin at the edges of a span, where shear stiffness changes: the shear force goes on smoothly there, so
/// the strain must jump, which no few polynomials can. An edge at the beam's end is none.
///
/// Each is taken less its share of the `terms` polynomials of the basis, lest it nearly repeat them. What is left has no
/// mean, so $w$ vanishes at both ends whatever holds them.
pub(super) fn steps(half_length: f64, edges: [f64; 2], terms: usize) -> impl Iterator<Item = StrainFunction> {
    let inside = edges.into_iter().map(move |x| x / half_length).filter(|t| is_inside(*t));
    inside.flat_map(move |edge| steps_at(half_length, edge, terms))
}

fn steps_at(half_length: f64, edge: f64, terms: usize) -> impl Iterator<Item = StrainFunction> {
    let (middle, half) = (0.5 * (edge + 1.0), 0.5 * (1.0 - edge));
    let rule = gauss_legendre(terms + 2);
    let polynomials = legendre_at(terms, &rule.iter().map(|(t, _)| middle + half * t).collect::<Vec<_>>());
    (0..JUMPS).map(move |degree| {
        let strain: Vec<f64> = rule.iter().map(|(t, weight)| half * weight * (0.5 * (t + 1.0)).powi(degree)).collect();
        let shear: Vec<f64> = (0..terms).map(|n| -dot(polynomials.col_as_slice(n), &strain) / norm(n)).collect();
        let mean = shear.first().copied().unwrap_or_default();
        let balance = integrated(half_length, [half_length * mean, 0.0], vec![], shear, Parity::Neither);
        StrainFunction { step: Some(Step { edge, degree }), ..balance }
    })
}

/// Motions of clamped ends that yield: one function deflects an end by one, one rotates it by one, and every other
/// function of the basis leaves that end at rest. Springs of any stiffness then stand alone on the diagonal, and an
/// infinite one is the clamp. Where the other end is free, these are the two rigid motions.
pub(super) fn end_motions(half_length: f64, boundary: Boundary) -> Vec<StrainFunction> {
    let h = half_length;
    let sides = [(boundary.left, boundary.right, -1.0), (boundary.right, boundary.left, 1.0)];
    let yielding = sides.into_iter().filter(|(own, ..)| *own == End::Clamped);
    let motions = yielding.flat_map(|(_, other, side)| {
        [[1.0, 0.0], [0.0, 1.0]].map(|[w, psi]| {
            let [w0, psi0, k0, g0] = match other {
                End::Free => [w + side * h * psi, psi, 0.0, 0.0],
                // w and ψ vanish at the other end: w0 = w/2, ψ0 = ψ/2, hk0 = side·ψ/2, h(g0 − ψ0) = side·w/2.
                _ => [0.5 * w, 0.5 * psi, 0.5 * side * psi / h, 0.5 * side * w / h + 0.5 * psi],
            };
            let function = integrated(h, [w0, psi0], vec![k0, 0.0], vec![g0], Parity::Neither);
            StrainFunction { moves_end: [w, psi], ..function }
        })
    });
    motions.collect()
}

/// What the end conditions leave of $(w_0, \psi_0, k_0, k_1, g_0)$; rigid motions first.
fn low_functions(h: f64, boundary: Boundary) -> Vec<[f64; 5]> {
    use End::{Clamped, Free, Pinned};
    // Deflection zero at the end where x = side·h: w0 = −side·h (g0 − ψ0 + h k1/3).
    let held_at =
        |side: f64, psi0: f64, [k0, k1, g0]: [f64; 3]| [-side * h * (g0 - psi0 + h * k1 / 3.0), psi0, k0, k1, g0];
    let units = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let one_pin = |side: f64| {
        let turning = [held_at(side, 1.0, [0.0; 3])];
        turning.into_iter().chain(units.map(|strains| held_at(side, 0.0, strains))).collect()
    };
    // Rotation zero there too: ψ0 = −side·h k0.
    let one_clamp = |side: f64| units.map(|strains| held_at(side, -side * h * strains[0], strains)).to_vec();
    match (boundary.left, boundary.right) {
        (Free, Free) => (0..5).map(|n| std::array::from_fn(|i| if i == n { 1.0 } else { 0.0 })).collect(),
        (Pinned, Free) => one_pin(-1.0),
        (Free, Pinned) => one_pin(1.0),
        (Clamped, Free) => one_clamp(-1.0),
        (Free, Clamped) => one_clamp(1.0),
        // w0 = 0 and ψ0 = g0 + h k1/3.
        (Pinned, Pinned) => units.map(|[k0, k1, g0]| [0.0, g0 + h * k1 / 3.0, k0, k1, g0]).to_vec(),
        (Clamped, Pinned) => clamp_and_pin(h, -1.0),
        (Pinned, Clamped) => clamp_and_pin(h, 1.0),
        (Clamped, Clamped) => vec![[0.0, 0.0, 0.0, 1.0, -h / 3.0]],
    }
}

/// Clamped at `side`, pinned opposite: $\psi_0 = -\text{side}\,hk_0$ and $g_0 = \psi_0 - hk_1/3$. Of the two
/// combinations of $k_0$ and $k_1$ the first has no $g_0$ and the second bends orthogonally to it.
fn clamp_and_pin(h: f64, side: f64) -> Vec<[f64; 5]> {
    [[1.0, -3.0 * side], [1.0, side]]
        .map(|[k0, k1]| {
            let psi0 = -side * h * k0;
            [0.0, psi0, k0, k1, psi0 - h * k1 / 3.0]
        })
        .to_vec()
}
