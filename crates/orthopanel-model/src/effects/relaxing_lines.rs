//! The accelerance of a panel whose core relaxes, with the core's own law at every line.

use faer::Mat;
use faer::prelude::Solve;
use num_complex::Complex64;

use super::relaxing_panel::Relaxing;
use super::{CoreModulus, PanelWithEffects};
use crate::structure::Motion;
use crate::{ModelError, Place};

/// From a force at one place to the acceleration at another.
///
/// With the law $g(s)$ of a [`CoreModulus`], and no fit of it,
/// $$H(s) = s^2\,r^T\big[s^2M + sC + K + (g(s)-1)S\big]^{-1}f$$
/// in the coordinates in which [`PanelModel::time_model`](crate::PanelModel::time_model) relaxes, with shapes of their own for what
/// forces at the elements do, and at the two places if so asked.
#[derive(Debug, Clone)]
pub struct RelaxingLines {
    /// Scaled to a stiffness of one a coordinate.
    mass: Mat<f64>,
    damping: Mat<f64>,
    stiffness: Mat<f64>,
    shear: Mat<f64>,
    force: Vec<f64>,
    response: Vec<f64>,
    core: CoreModulus,
}

impl RelaxingLines {
    /// On `count` flexible modes at the low modulus; `None` where no effect is a core.
    pub(crate) fn new(
        parts: PanelWithEffects,
        count: usize,
        [force, response]: [Place; 2],
        with_ports: bool,
    ) -> Result<Option<Self>, ModelError> {
        let ports = [force, response];
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
        let seen = |place: Place| -> Result<Vec<f64>, ModelError> {
            let row = panel.values_in((Motion::Deflection, place))?;
            Ok(kept.iter().map(|&i| row.get(i).map_or(0.0, |value| scale(i) * value)).collect())
        };
        Ok(Some(Self {
            mass: part(&system.mass),
            damping: part(&system.damping),
            stiffness: part(&system.stiffness),
            shear: part(&whole_shear),
            force: seen(force)?,
            response: seen(response)?,
            core,
        }))
    }

    /// The accelerance \[(m/s²)/N\] at $s \ne 0$ \[1/s\].
    pub fn at(&self, s: Complex64) -> Complex64 {
        let excess = self.core.line(s).value - 1.0;
        let size = self.force.len();
        let dynamic = Mat::from_fn(size, size, |i, j| {
            let at = (i, j);
            self.mass[at] * s * s + self.damping[at] * s + self.stiffness[at] + self.shear[at] * excess
        });
        let pushed = Mat::from_fn(size, 1, |i, _| Complex64::from(self.force[i]));
        let moved = dynamic.partial_piv_lu().solve(&pushed);
        let sum: Complex64 = self.response.iter().enumerate().map(|(i, r)| moved[(i, 0)] * *r).sum();
        s * s * sum
    }
}
