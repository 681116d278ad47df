//! The panel of a hypothesis, and what is removed from it.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use orthopanel_data::ImpactTest;
use orthopanel_model::{
    BEAM_CONSTANTS, Damping, MODEL_SCHEMA, ModeRange, ModelError, Owner, PanelModel, Place, Ports, StructureKind,
};

use super::damping::TracedDamping;
use super::estimates::Estimates;
use crate::hypothesis::Role;
use crate::measured::MeasuredModes;
use crate::outcome::Removed;
use crate::plate_of_ratios::widen;
use crate::predicted::distinct;

/// Key of a model's provenance under which the standard deviations of its damping ratios stand.
const DAMPING_STD: &str = "damping_std";
/// Modes of a plate up to so many times the highest pole get a damping ratio.
const ABOVE: f64 = 1.1;

/// The panel with the effects that are its own, and which of the others are removed and why; `plate` is the number of the effect that stands a
/// plate in the place of the beam, and `of_effects` as in [`TracedDamping::of`].
///
/// # Errors
/// What the plate refuses.
pub(super) fn panel(
    test: &ImpactTest,
    (measured, of_effects): (&MeasuredModes, &[f64]),
    estimates: &Estimates,
    damping: TracedDamping,
    plate: Option<usize>,
) -> Result<(PanelModel, Vec<Removed>), ModelError> {
    let places = |at: fn(&crate::MeasuredRecord) -> Place| distinct(measured.records.iter().map(at));
    let constants = BEAM_CONSTANTS.iter().zip(&estimates.constants);
    let parts = estimates.effects.iter().enumerate().filter(|(number, _)| Some(*number) != plate);
    let (own, others): (Vec<_>, Vec<_>) =
        parts.map(|(_, part)| part).partition(|(effect, _)| effect.owner == Owner::Panel);
    let mut panel = PanelModel {
        name: None,
        schema: MODEL_SCHEMA.to_owned(),
        piece: test.pieces[measured.piece].piece,
        boundary: test.boundary,
        structure: StructureKind::TimoshenkoBeam,
        constants: constants.map(|(constant, estimate)| (constant.name.to_owned(), *estimate)).collect(),
        damping: Damping::default(),
        effects: vec![],
        ports: Ports { forces: places(|record| record.force_at), responses: places(|record| record.response_at) },
        provenance: BTreeMap::new(),
    };
    let damping = match plate.and_then(|number| estimates.effects.get(number)) {
        Some((ratios, _)) => {
            widen(&mut panel, ratios);
            damping_of_plate(&panel, (measured, of_effects))?
        }
        None => damping,
    };
    panel.damping = damping.damping;
    panel.provenance.insert(DAMPING_STD.to_owned(), damping.std.into());
    panel.effects = own.into_iter().map(|(effect, _)| effect.entry()).collect();
    let others = others.into_iter().filter(|(_, role)| *role != Role::Linearised);
    Ok((panel, others.map(|(effect, role)| Removed::of(effect, *role == Role::Declared)).collect()))
}

/// Of all modes of the plate, those too that no record shows.
fn damping_of_plate(
    panel: &PanelModel,
    (measured, of_effects): (&MeasuredModes, &[f64]),
) -> Result<TracedDamping, ModelError> {
    let (forces, responses): (Vec<Place>, Vec<Place>) =
        measured.records.iter().map(|record| (record.force_at, record.response_at)).unzip();
    let top = measured.poles.last().map_or(measured.band[1], |pole| pole.angular_frequency / TAU);
    let modes = panel.modal_model(ModeRange::UpTo(ABOVE * top), &forces, &responses)?;
    Ok(TracedDamping::of(measured, &modes, of_effects))
}
