//! What all modes of a [`PanelModel`] together leave at low frequency.

use crate::effects::{CoupledPanel, FarModes, Flexibilities};
use crate::{EffectSetting, ModelError, PanelModel, Place, StaticFlexibility, StructureKind, VISCOELASTIC_CORE};

impl PanelModel {
    /// $\sum_m W_m(r)W_m(f)/\omega_m^2$ \[m/N\] over the flexible modes: a row a response, a column a force. All modes in closed
    /// form for a beam; for a plate those of a basis for `count` modes, and what it lacks of the membrane's answer, with each force on a square of 10 mm: at a
    /// point no sum over a plate's modes ends. Effects with shapes of their own for what they and the forces do; a core that relaxes at its low
    /// modulus, which it has at rest.
    ///
    /// Less the sum over the modes that a model keeps, it is what the others add at rest.
    ///
    /// # Errors
    /// As [`PanelModel::modes`], and [`ModelError::NotFinite`].
    pub fn static_flexibility(
        &self,
        count: usize,
        forces: &[Place],
        responses: &[Place],
    ) -> Result<Vec<Vec<f64>>, ModelError> {
        if self.relaxes() {
            return self.relaxed().static_flexibility(count, forces, responses);
        }
        if self.effects.is_empty() && self.structure == StructureKind::TimoshenkoBeam {
            return finite(self.of_beam(forces, responses)?);
        }
        let (values, effects) = self.with_effects()?;
        let setting = EffectSetting::of_panel(&self.piece, self.boundary);
        let even = self.even(&setting, count)?;
        finite(CoupledPanel::static_flexibility(
            self.on_even(&setting, &even, &values, &effects),
            count,
            forces,
            responses,
        )?)
    }

    /// The flexible modes but the first `count`, as seen from `places` and then from `ports`: a force at one of the places has its whole static answer
    /// in them and those. A core that relaxes is at its low modulus.
    pub(crate) fn far_modes(&self, count: usize, places: &[Place], ports: &[Place]) -> Result<FarModes, ModelError> {
        if self.relaxes() {
            return self.relaxed().far_modes(count, places, ports);
        }
        let (values, effects) = self.with_effects()?;
        let setting = EffectSetting::of_panel(&self.piece, self.boundary);
        let even = self.even(&setting, count)?;
        CoupledPanel::far_modes(self.on_even(&setting, &even, &values, &effects), count, [places, ports])
    }

    /// Without the core, which at rest has its low modulus.
    fn relaxed(&self) -> Self {
        let mut relaxed = self.clone();
        relaxed.effects.retain(|entry| entry.id != VISCOELASTIC_CORE);
        relaxed
    }

    /// Of a beam without effects.
    fn of_beam(&self, forces: &[Place], responses: &[Place]) -> Result<Flexibilities, ModelError> {
        let all = StaticFlexibility::new(&self.piece, self.boundary)?;
        let (e_x, g_zx) = (self.constant("e_x")?, self.constant("g_zx")?);
        let row = |response: &Place| {
            forces.iter().map(|force| all.between(force.x, response.x, e_x, g_zx).0).collect::<Vec<f64>>()
        };
        Ok(responses.iter().map(row).collect())
    }
}

fn finite(flexibility: Flexibilities) -> Result<Flexibilities, ModelError> {
    match flexibility.iter().flatten().find(|value| !value.is_finite()) {
        Some(&value) => Err(ModelError::NotFinite { what: "static flexibility", value }),
        None => Ok(flexibility),
    }
}
