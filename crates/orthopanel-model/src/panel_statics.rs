//! What all modes of a [`PanelModel`] together leave at low frequency.

use std::sync::Arc;

use crate::effects::{CoupledPanel, FarModes, Flexibilities, MOST_SUMMED, SPARE_MODES, Seat, point_elements};
use crate::mindlin_plate::FixedPlate;
use crate::static_deflection::static_deflections;
use crate::{
    EffectSetting, MindlinPlate, ModelError, Motion, PanelModel, Place, StaticFlexibility, Structure, StructureKind,
    VISCOELASTIC_CORE,
};

/// Modes for which the basis of a plate's static part is chosen: it holds some four times as many.
const STATIC_BASIS: usize = 120;

impl PanelModel {
    /// $\sum_m W_m(r)W_m(f)/\omega_m^2$ \[m/N\] over the flexible modes: a row a response, a column a force. All modes in closed
    /// form for a beam; for a plate all of a basis for `count` modes or 120, whichever is more, since at a point force no
    /// sum over a plate's modes ends. Effects with shapes of their own for what they and the forces do; a core that relaxes at its low
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
        let flexibility = if self.effects.is_empty() {
            self.bare_flexibility(count, forces, responses)?
        } else {
            let (values, effects) = self.with_effects()?;
            let setting = EffectSetting::of_panel(&self.piece, self.boundary);
            let even = self.even(&setting, count)?;
            let parts = self.on_even(&setting, &even, &values, &effects);
            let modified = CoupledPanel::static_flexibility(parts, count, forces, responses)?;
            self.on_large_basis(modified, None, (&values, count.min(MOST_SUMMED)), forces, responses)?
        };
        finite(flexibility)
    }

    /// The flexible modes but the first `count`, as seen from `places` and then from `ports`, with what they lack of the static
    /// flexibility from the places to all of these, a row each. A core that relaxes is at its low modulus.
    pub(crate) fn far_modes(
        &self,
        count: usize,
        places: &[Place],
        ports: &[Place],
    ) -> Result<(FarModes, Flexibilities), ModelError> {
        if self.relaxes() {
            return self.relaxed().far_modes(count, places, ports);
        }
        let (values, effects) = self.with_effects()?;
        let setting = EffectSetting::of_panel(&self.piece, self.boundary);
        let even = self.even(&setting, count)?;
        let parts = self.on_even(&setting, &even, &values, &effects);
        let (modes, plate) = CoupledPanel::far_modes(parts, count, [places, ports])?;
        let all: Vec<Place> = places.iter().chain(ports).copied().collect();
        let none = vec![vec![0.0; places.len()]; all.len()];
        let lacking = self.on_large_basis(none, plate, (&values, count), places, &all)?;
        Ok((modes, finite(lacking)?))
    }

    /// Without the core, which at rest has its low modulus.
    fn relaxed(&self) -> Self {
        let mut relaxed = self.clone();
        relaxed.effects.retain(|entry| entry.id != VISCOELASTIC_CORE);
        relaxed
    }

    /// Of a plate, whose effects are seen on the small basis of its few modes: what they change there, beside all modes of
    /// the large one. `small` is the plate without effects on that basis, where there is one already.
    fn on_large_basis(
        &self,
        mut modified: Flexibilities,
        small: Option<Arc<MindlinPlate>>,
        (values, count): (&[f64], usize),
        forces: &[Place],
        responses: &[Place],
    ) -> Result<Flexibilities, ModelError> {
        if self.structure != StructureKind::MindlinPlate {
            return Ok(modified);
        }
        let bare = self.bare_flexibility(count, forces, responses)?;
        let made =
            || MindlinPlate::with_basis_for(&self.piece, self.boundary, values, count + SPARE_MODES).map(Arc::new);
        let small = small.map_or_else(made, Ok)?;
        let own = static_deflections(small.as_ref(), values, forces, responses)?;
        let (_, effects) = self.with_effects()?;
        let elements = point_elements(&effects, &EffectSetting::of_panel(&self.piece, self.boundary))?;
        // Under a foot the few functions have the whole answer.
        let is_foot = |place: Place| elements.iter().any(|element| element.seat == Seat::At(place));
        for (r, (row, (bare, own))) in modified.iter_mut().zip(bare.into_iter().zip(own)).enumerate() {
            for (f, (sum, (bare, own))) in row.iter_mut().zip(bare.into_iter().zip(own)).enumerate() {
                if responses[r] == forces[f] && is_foot(forces[f]) {
                    continue;
                }
                let motions = [responses[r], forces[f]].map(|place| (Motion::Deflection, place));
                let kink = small.static_remainder(values, motions).unwrap_or_default();
                *sum += bare - own - kink;
            }
        }
        Ok(modified)
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
                self.check()?;
                let values = self.plate_constants()?;
                let on = |count| FixedPlate::with_basis_for(&self.piece, self.boundary, &values, count);
                let plate = match on(count.max(STATIC_BASIS)) {
                    Err(ModelError::BasisTooSmall { available, .. }) => on(available)?,
                    found => found?,
                };
                static_deflections(&plate, &values, forces, responses)?
            }
        };
        Ok(flexibility)
    }
}

fn finite(flexibility: Flexibilities) -> Result<Flexibilities, ModelError> {
    match flexibility.iter().flatten().find(|value| !value.is_finite()) {
        Some(&value) => Err(ModelError::NotFinite { what: "static flexibility", value }),
        None => Ok(flexibility),
    }
}
