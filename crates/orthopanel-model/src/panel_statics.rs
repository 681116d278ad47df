//! What all modes of a [`PanelModel`] together leave at low frequency.

use crate::effects::DressedPanel;
use crate::{
    EffectSetting, EffectState, ModelError, PanelModel, Place, StaticFlexibility, StructureKind, static_deflections,
};

/// Modes for which the basis of a plate's static part is chosen: it holds some four times as many.
const STATIC_BASIS: usize = 120;

impl PanelModel {
    /// $\sum_m W_m(r)W_m(f)/\omega_m^2$ \[m/N\] over the flexible modes: a row a response, a column a force. All modes in closed
    /// form for a beam; for a plate all of a basis for `count` modes or 120, whichever is more, since at a point force no
    /// sum over a plate's modes ends. Effects with shapes of their own for what they and the forces do. `None` beside a core that relaxes.
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
    ) -> Result<Option<Vec<Vec<f64>>>, ModelError> {
        let flexibility = if self.effects.is_empty() {
            self.bare_flexibility(count, forces, responses)?
        } else {
            let (values, effects) = self.with_effects()?;
            let setting = EffectSetting::of_panel(&self.piece, self.boundary);
            let even = self.even(&setting, count)?;
            let with = |effects: &[EffectState]| {
                let parts = self.on_even(&setting, &even, &values, effects);
                DressedPanel::static_flexibility(parts, count, forces, responses)
            };
            let Some(mut dressed) = with(&effects)? else { return Ok(None) };
            // On the small basis of a plate's few modes: what effects change there, beside all modes of the large one.
            if let StructureKind::MindlinPlate = self.structure
                && let Some(undressed) = with(&[])?
            {
                let bare = self.bare_flexibility(count, forces, responses)?;
                for ((row, bare), undressed) in dressed.iter_mut().zip(bare).zip(undressed) {
                    row.iter_mut().zip(bare.iter().zip(undressed)).for_each(|(sum, (bare, own))| *sum += bare - own);
                }
            }
            dressed
        };
        match flexibility.iter().flatten().find(|value| !value.is_finite()) {
            Some(&value) => Err(ModelError::NotFinite { what: "static flexibility", value }),
            None => Ok(Some(flexibility)),
        }
    }

    /// Without effects.
    fn bare_flexibility(
        &self,
        count: usize,
        forces: &[Place],
        responses: &[Place],
    ) -> Result<Vec<Vec<f64>>, ModelError> {
        let flexibility = match self.structure {
            StructureKind::TimoshenkoBeam => {
                let all = StaticFlexibility::new(&self.piece, self.boundary)?;
                let (e_x, g_zx) = (self.constant("e_x")?, self.constant("g_zx")?);
                let row = |response: &Place| {
                    forces.iter().map(|force| all.between(force.x, response.x, e_x, g_zx).0).collect::<Vec<f64>>()
                };
                responses.iter().map(row).collect()
            }
            StructureKind::MindlinPlate => {
                let (plate, values) = match self.structure_for(count.max(STATIC_BASIS)) {
                    Err(ModelError::BasisTooSmall { available, .. }) => self.structure_for(available)?,
                    found => found?,
                };
                static_deflections(plate.as_ref(), &values, forces, responses)?
            }
        };
        Ok(flexibility)
    }
}
