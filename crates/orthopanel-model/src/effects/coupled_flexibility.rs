//! What all modes of a panel with effects together leave at low frequency.

use super::coupled_panel::{CoupledPanel, ModifiedStructure, PanelWithEffects};
use super::low_modes::FarAnswers;
use crate::modal_model::add_flexibility;
use crate::{Damping, ModelError, Place};

/// Bare modes in whose coordinates it is worked out, at most: forces at ports and elements have shapes of their own, so that no
/// number of modes makes it better but where the panel itself is uneven.
const MOST_SUMMED: usize = 60;

/// A row a response, a column a force \[m/N\].
pub(crate) type Flexibilities = Vec<Vec<f64>>;

impl CoupledPanel {
    /// $\sum_m W_m(r)W_m(f)/\omega_m^2$ \[m/N\] over all flexible modes of the panel with its effects.
    ///
    /// # Errors
    /// As [`CoupledPanel::modes`].
    pub(crate) fn static_flexibility(
        parts: PanelWithEffects,
        count: usize,
        forces: &[Place],
        responses: &[Place],
    ) -> Result<Flexibilities, ModelError> {
        let modified = ModifiedStructure::for_modes(parts, count.min(MOST_SUMMED))?;
        let ports: Vec<Place> = forces.iter().chain(responses).copied().collect();
        modified.static_flexibility(&modified.far_answers(&ports)?, parts.damping, [forces, responses])
    }
}

/// Modes beyond those that a model keeps, in the coordinates of a [`CoupledPanel`] with a residual shape for each of some places: so a
/// force there has its whole static answer in them.
pub(crate) struct FarModes {
    /// $\omega_N$ \[rad/s\] of the last mode kept; zero where none is.
    pub last_kept: f64,
    pub modes: Vec<FarMode>,
}

/// $\omega_m$ and the deflections \[kg^-1/2\] at the places and then at others.
pub(crate) type FarMode = (f64, Vec<f64>);

impl CoupledPanel {
    /// All modes of the panel with its effects but the first `count` flexible ones, as seen from `places` and `others`.
    ///
    /// # Errors
    /// As [`CoupledPanel::modes`].
    pub(crate) fn far_modes(
        parts: PanelWithEffects,
        count: usize,
        [places, others]: [&[Place]; 2],
    ) -> Result<FarModes, ModelError> {
        let modified = match ModifiedStructure::for_modes(parts, count) {
            // At the end of its basis a panel has no modes to spare.
            Err(ModelError::BasisTooSmall { .. }) => ModifiedStructure::new(parts, count)?,
            found => found?,
        };
        let (panel, system) = modified.with_residuals(&modified.far_answers(places)?, places, parts.damping);
        let rows: Vec<Vec<f64>> = places.iter().chain(others).map(|&place| panel.deflections(place)).collect();
        let mut modes = system.solve()?;
        let far = modes.split_off(modes.len().min(panel.rigid() + count));
        let seen = |shares: &[f64]| -> Vec<f64> {
            rows.iter().map(|row| row.iter().zip(shares).map(|(value, share)| value * share).sum()).collect()
        };
        let last_kept = modes.last().map_or(0.0, |(omega, ..)| *omega);
        let modes = far.iter().filter(|(omega, ..)| *omega > 0.0).map(|(omega, _, shares)| (*omega, seen(shares)));
        Ok(FarModes { last_kept, modes: modes.collect() })
    }
}

impl ModifiedStructure {
    /// In the coordinates of [`CoupledPanel`], with a residual shape for each port as for each element, a force at a port has its
    /// static answer: the sum over the few modes of these coordinates is that over all. For a free panel it is the answer beside the
    /// rigid motion that the force brings about.
    fn static_flexibility(
        &self,
        answers: &FarAnswers,
        damping: &Damping,
        [forces, responses]: [&[Place]; 2],
    ) -> Result<Flexibilities, ModelError> {
        let ports: Vec<Place> = forces.iter().chain(responses).copied().collect();
        let (panel, system) = self.with_residuals(answers, &ports, damping);
        let modes = system.solve()?;
        let at = |places: &[Place]| -> Vec<Vec<f64>> { places.iter().map(|&place| panel.deflections(place)).collect() };
        let (forces, responses) = (at(forces), at(responses));
        let mut sum = vec![vec![0.0; forces.len()]; responses.len()];
        for (omega, _, shares) in modes.iter().filter(|(omega, ..)| *omega > 0.0) {
            let seen = |rows: &[Vec<f64>]| -> Vec<f64> {
                rows.iter().map(|row| row.iter().zip(shares).map(|(value, share)| value * share).sum()).collect()
            };
            add_flexibility(&mut sum, 1.0, *omega, (&seen(&responses), &seen(&forces)));
        }
        Ok(sum)
    }
}
