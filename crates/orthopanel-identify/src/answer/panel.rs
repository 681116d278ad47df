//! The panel of a hypothesis, and what is taken out of it.

use std::collections::BTreeMap;

use orthopanel_data::ImpactTest;
use orthopanel_model::{BEAM_CONSTANTS, MODEL_SCHEMA, Owner, PanelModel, Place, Ports, StructureKind};

use super::damping::TracedDamping;
use super::estimates::Estimates;
use crate::measured::MeasuredModes;
use crate::outcome::Removed;
use crate::predicted::distinct;

/// Key of a model's provenance under which the standard deviations of its damping ratios stand.
const DAMPING_STD: &str = "damping_std";

/// The panel with the effects that are its own, and which of the others are taken out and why.
pub(super) fn panel(
    test: &ImpactTest,
    measured: &MeasuredModes,
    estimates: &Estimates,
    damping: TracedDamping,
) -> (PanelModel, Vec<Removed>) {
    let places = |at: fn(&crate::MeasuredRecord) -> Place| distinct(measured.records.iter().map(at));
    let constants = BEAM_CONSTANTS.iter().zip(&estimates.constants);
    let (own, others): (Vec<_>, Vec<_>) =
        estimates.effects.iter().partition(|(effect, _)| effect.owner == Owner::Panel);
    let panel = PanelModel {
        schema: MODEL_SCHEMA.to_owned(),
        piece: test.pieces[measured.piece].piece,
        boundary: test.boundary,
        structure: StructureKind::TimoshenkoBeam,
        constants: constants.map(|(constant, estimate)| (constant.name.to_owned(), *estimate)).collect(),
        damping: damping.damping,
        effects: own.into_iter().map(|(effect, _)| effect.entry()).collect(),
        ports: Ports { forces: places(|record| record.force_at), responses: places(|record| record.response_at) },
        provenance: BTreeMap::from([(DAMPING_STD.to_owned(), damping.std.into())]),
    };
    (panel, others.into_iter().map(|(effect, declared)| Removed::of(effect, *declared)).collect())
}
