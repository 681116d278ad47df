//! The accelerance of a panel whose core relaxes, with the core's own law at every line.

use faer::Mat;
use faer::prelude::Solve;
use num_complex::Complex64;

use super::relaxing_panel::Relaxing;
use super::{CoreModulus, PanelWithEffects};
use crate::{ModelError, Place};

/// From forces at some places to the accelerations at others.
///
/// With the law $g(s)$ of a [`CoreModulus`], and no fit of it,
/// $$H(s) = s^2\,R^T\big[s^2M + sC + K + (g(s)-1)S\big]^{-1}F$$
/// in the coordinates in which [`PanelModel::time_model`](crate::PanelModel::time_model) relaxes, with shapes of their own for what
/// forces at the elements do, and at the places if so asked.
#[derive(Debug, Clone)]
pub struct RelaxingLines {
    /// Scaled to a stiffness of one a coordinate.
    mass: Mat<f64>,
    damping: Mat<f64>,
    stiffness: Mat<f64>,
    shear: Mat<f64>,
    /// A column a force.
    forces: Mat<Complex64>,
    /// A list a response.
    responses: Vec<Vec<f64>>,
    core: CoreModulus,
}

impl RelaxingLines {
    /// On `count` flexible modes at the low modulus; `None` where no effect is a core.
    pub(crate) fn new(
        parts: PanelWithEffects,
        count: usize,
        (forces, responses): (&[Place], &[Place]),
        with_ports: bool,
    ) -> Result<Option<Self>, ModelError> {
        let ports = [forces, responses].concat();
        let found = Relaxing::new(parts, count, if with_ports { &ports } else { &[] })?;
        let Some(Relaxing { panel, system, shear, core, .. }) = found else { return Ok(None) };
        let rigid = panel.rigid();
        // Of coordinates that others hold already, none has a stiffness of its own.
        let kept = system.independent();
        let shift = system.shift;
        let scale = |i: usize| (system.stiffness[(i, i)] + shift * system.mass[(i, i)]).sqrt().recip();
        let part = |matrix: &Mat<f64>| {
            Mat::from_fn(kept.len(), kept.len(), |i, j| scale(kept[i]) * matrix[(kept[i], kept[j])] * scale(kept[j]))
        };
        let whole_shear = Mat::from_fn(system.stiffness.nrows(), system.stiffness.nrows(), |i, j| {
            let inside = |i: usize| (rigid..rigid + shear.nrows()).contains(&i);
            if inside(i) && inside(j) { shear[(i - rigid, j - rigid)] } else { 0.0 }
        });
        let seen = |place: &Place| -> Result<Vec<f64>, ModelError> {
            let row = panel.values_in(panel.port(*place))?;
            Ok(kept.iter().map(|&i| row.get(i).map_or(0.0, |value| scale(i) * value)).collect())
        };
        let pushed = forces.iter().map(seen).collect::<Result<Vec<Vec<f64>>, ModelError>>()?;
        Ok(Some(Self {
            mass: part(&system.mass),
            damping: part(&system.damping),
            stiffness: part(&system.stiffness),
            shear: part(&whole_shear),
            forces: Mat::from_fn(kept.len(), forces.len(), |i, force| pushed[force][i].into()),
            responses: responses.iter().map(seen).collect::<Result<_, _>>()?,
            core,
        }))
    }

    /// The accelerances \[(m/s²)/N\] at $s \ne 0$ \[1/s\]: a row a response, a column a force.
    pub fn at(&self, s: Complex64) -> Vec<Vec<Complex64>> {
        let excess = self.core.factor(s) - 1.0;
        let size = self.mass.nrows();
        let dynamic = Mat::from_fn(size, size, |i, j| {
            let at = (i, j);
            self.mass[at] * s * s + self.damping[at] * s + self.stiffness[at] + self.shear[at] * excess
        });
        let moved = dynamic.partial_piv_lu().solve(&self.forces);
        let one = |response: &[f64], force: usize| {
            let sum: Complex64 = response.iter().enumerate().map(|(i, r)| moved[(i, force)] * *r).sum();
            s * s * sum
        };
        self.responses.iter().map(|response| (0..moved.ncols()).map(|force| one(response, force)).collect()).collect()
    }
}
