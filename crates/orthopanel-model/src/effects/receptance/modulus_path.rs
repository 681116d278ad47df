//! Modes at a complex shear modulus, continued from real ones.

use num_complex::Complex64;

use super::modal_base::{ModalBase, Moved, Row};
use super::view::{Layout, View};
use crate::effects::CoreModulus;
use crate::{ModelError, Structure};

/// Nodes of the interpolation. On the arc of a core with $\Delta = 1$ nine leave 1e-7 of a receptance.
const NODES: usize = 9;

/// The views of a record at real moduli $g_kG_{zx}$ on $1 \le g \le 1+\Delta$.
///
/// $\omega_m^2$ and shapes are analytic in the modulus, and the arc that $g(s)$ draws stays near that stretch: a
/// polynomial through Chebyshev's points continues them to it. A line then costs one weighted sum of the views, where the
/// modes of a complex stiffness would cost an eigenproblem.
pub(super) struct ModulusPath {
    views: Vec<View>,
    nodes: Vec<f64>,
    weights: Vec<f64>,
}

/// Position of the shear modulus among the constants of the beam.
const SHEAR_MODULUS: usize = 1;

/// The bases at the nodes.
pub(super) struct NodeBases<'a> {
    nodes: Vec<f64>,
    bases: Vec<ModalBase<'a>>,
}

impl<'a> NodeBases<'a> {
    pub(super) fn new(
        structure: &'a dyn Structure,
        values: &[f64],
        core: &CoreModulus,
        near: usize,
        terms: &[usize],
        moved: &'a [Moved],
    ) -> Result<Self, ModelError> {
        // A stretch of some width, so that the modes at its nodes differ by more than their rounding.
        let half = 0.5 * core.strength.max(0.05);
        let angle = |k: usize| std::f64::consts::PI * (k as f64 + 0.5) / NODES as f64;
        let nodes: Vec<f64> = (0..NODES).map(|k| 1.0 + half - half * angle(k).cos()).collect();
        let mut bases: Vec<ModalBase> = Vec::new();
        for node in &nodes {
            let mut at = values.to_vec();
            if let Some(modulus) = at.get_mut(SHEAR_MODULUS) {
                *modulus *= node;
            }
            let base = ModalBase::new(structure, &at, near, terms, moved)?;
            bases.push(match bases.first() {
                Some(first) => base.aligned_with(first),
                None => base,
            });
        }
        Ok(Self { nodes, bases })
    }

    pub(super) fn path(&self, active: &[Row], slopes: &[Row]) -> Result<ModulusPath, ModelError> {
        let views = self.bases.iter().map(|base| View::new(base, active, slopes)).collect::<Result<_, _>>()?;
        let weight = |k: usize| {
            let others = self.nodes.iter().enumerate().filter(|(other, _)| *other != k);
            others.map(|(_, node)| 1.0 / (self.nodes[k] - node)).product()
        };
        Ok(ModulusPath { views, nodes: self.nodes.clone(), weights: (0..NODES).map(weight).collect() })
    }
}

impl ModulusPath {
    pub(super) fn layout(&self) -> Layout {
        self.views[0].layout
    }

    /// Writes the view at the modulus factor `g`: Lagrange's polynomial.
    pub(super) fn at(&self, g: Complex64, numbers: &mut Vec<Complex64>) {
        numbers.clear();
        numbers.resize(self.views.first().map_or(0, |view| view.numbers.len()), Complex64::ZERO);
        for (k, (view, weight)) in self.views.iter().zip(&self.weights).enumerate() {
            let others = self.nodes.iter().enumerate().filter(|(other, _)| *other != k);
            let share: Complex64 = others.map(|(_, node)| g - node).product::<Complex64>() * *weight;
            for (total, value) in numbers.iter_mut().zip(&view.numbers) {
                *total += share * value;
            }
        }
    }
}
