//! Modes at a complex shear modulus, continued from real ones.

use num_complex::Complex64;

use super::modal_base::ModalBase;
use super::view::{Layout, View};
use crate::effects::CoreModulus;
use crate::effects::row::{Row, SharedStructure};
use crate::{ModelError, side_by_side};

/// Nodes of the interpolation. On the arc of a core with $\Delta = 1$ nine leave 1e-7 of a receptance.
const NODES: usize = 9;
/// Nodes where $\Delta$ is below [`SOFT`]: the error falls with the power of $\Delta$ that they are.
const FEW_NODES: usize = 6;
const SOFT: f64 = 0.3;

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
pub(super) struct NodeBases {
    nodes: Vec<f64>,
    bases: Vec<ModalBase>,
}

impl NodeBases {
    pub(super) fn new(
        structure: &SharedStructure,
        values: &[f64],
        core: &CoreModulus,
        near: usize,
    ) -> Result<Self, ModelError> {
        // A stretch of some width, so that the modes at its nodes differ by more than their rounding.
        let half = 0.5 * core.strength.max(0.05);
        let count = if core.strength < SOFT { FEW_NODES } else { NODES };
        let angle = |k: usize| std::f64::consts::PI * (k as f64 + 0.5) / count as f64;
        let nodes: Vec<f64> = (0..count).map(|k| 1.0 + half - half * angle(k).cos()).collect();
        let at_node = |node: &f64| {
            let mut at = values.to_vec();
            if let Some(modulus) = at.get_mut(SHEAR_MODULUS) {
                *modulus *= node;
            }
            ModalBase::new(structure, &at, near)
        };
        let mut bases: Vec<ModalBase> = Vec::new();
        for base in side_by_side::map(&nodes, at_node) {
            let base = base?;
            bases.push(match bases.first() {
                Some(first) => base.aligned_with(first),
                None => base,
            });
        }
        Ok(Self { nodes, bases })
    }

    pub(super) fn path(&self, rows: &[Row]) -> Result<ModulusPath, ModelError> {
        let views = self.bases.iter().map(|base| View::new(base, rows)).collect::<Result<_, _>>()?;
        let weight = |k: usize| {
            let others = self.nodes.iter().enumerate().filter(|(other, _)| *other != k);
            others.map(|(_, node)| 1.0 / (self.nodes[k] - node)).product()
        };
        Ok(ModulusPath { views, nodes: self.nodes.clone(), weights: (0..self.nodes.len()).map(weight).collect() })
    }
}

impl ModulusPath {
    pub(super) fn layout(&self) -> Layout {
        self.views[0].layout
    }

    /// The numbers of the view at a modulus factor: Lagrange's polynomial.
    pub(super) fn at(&self, g: Complex64) -> Vec<Complex64> {
        let share = |k: usize| {
            let others = self.nodes.iter().enumerate().filter(|(other, _)| *other != k);
            others.fold(Complex64::from(self.weights[k]), |product, (_, node)| product * (g - node))
        };
        let mut numbers = vec![Complex64::ZERO; self.views[0].numbers.len()];
        for (k, view) in self.views.iter().enumerate() {
            let share = share(k);
            numbers.iter_mut().zip(&view.numbers).for_each(|(sum, number)| *sum += share * number);
        }
        numbers
    }
}
