//! What all modes of a panel with effects together leave at low frequency.

use super::dressed_panel::{Dressed, DressedPanel, PanelWithEffects, SPARE_MODES};
use crate::modal_model::add_flexibility;
use crate::{ModelError, Place};

/// Bare modes in whose coordinates it is worked out, at most: forces at ports and elements have shapes of their own, so that no
/// number of modes makes it better but where the panel itself is uneven.
const MOST_SUMMED: usize = 60;

impl DressedPanel {
    /// $\sum_m W_m(r)W_m(f)/\omega_m^2$ \[m/N\] over all flexible modes of the panel with its effects: a row a response, a column a
    /// force. `None` beside a core that relaxes.
    ///
    /// In the coordinates of [`DressedPanel`], with a residual shape for each port as for each element, a force at a port has its
    /// static answer: the sum over the few modes of these coordinates is that over all. For a free panel it is the answer beside the
    /// rigid motion that the force brings about.
    ///
    /// # Errors
    /// As [`DressedPanel::modes`].
    pub(crate) fn static_flexibility(
        parts: PanelWithEffects,
        count: usize,
        forces: &[Place],
        responses: &[Place],
    ) -> Result<Option<Vec<Vec<f64>>>, ModelError> {
        let ports: Vec<Place> = forces.iter().chain(responses).copied().collect();
        let dressed = Dressed::new(parts, count.min(MOST_SUMMED) + SPARE_MODES, &ports)?;
        if dressed.core.is_some() {
            return Ok(None);
        }
        let (panel, system) = dressed.with_residuals(parts.damping)?;
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
        Ok(Some(sum))
    }
}
