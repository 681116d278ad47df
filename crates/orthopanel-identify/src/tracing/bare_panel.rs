//! The panel at a fit to records, without any effect.

use std::collections::BTreeMap;

use orthopanel_data::ImpactTest;
use orthopanel_model::{
    BEAM_CONSTANTS, Damping, Estimate, MODEL_SCHEMA, ModelError, PanelModel, Piece, Place, Ports, StructureKind,
};

use super::hypothesis::PLATE;
use super::record_problem::State;
use super::report::effects_of;
use super::wide_panel::widen;

/// The model at `state`, with all constants that are not `held` given their standard deviation from the beginning of
/// `std`; `damping` is the number of modes whose ratios are told, and the logarithm of the ratio beyond. Each of `places`
/// (force and response of a record) is a port, once. Where a plate stands in place of the beam, the panel is that plate.
///
/// # Errors
/// What the plate refuses.
pub(super) fn bare_panel(
    (test, piece): (&ImpactTest, Piece),
    (state, std): (&State, &[Option<f64>]),
    held: &[Option<f64>; 2],
    damping: (usize, f64),
    places: impl IntoIterator<Item = [Option<Place>; 2]>,
) -> Result<PanelModel, ModelError> {
    let mut of_constants = std.iter().copied();
    let mut constants = BTreeMap::new();
    for ((constant, held), log) in BEAM_CONSTANTS.iter().zip(held).zip(state.constants) {
        let value = log.exp();
        let std = if held.is_some() { None } else { of_constants.next().flatten().map(|std| std * value) };
        constants.insert(constant.name.to_owned(), Estimate { value, std });
    }
    let mut ports = Ports { forces: vec![], responses: vec![] };
    for [force, response] in places {
        for (known, place) in [(&mut ports.forces, force), (&mut ports.responses, response)] {
            known.extend(place.filter(|place| !known.contains(place)));
        }
    }
    let (in_band, beyond) = damping;
    let mut ratios = state.damping().ratios;
    if !state.hypothesis.holds_plate() {
        ratios.truncate(in_band);
    }
    let mut panel = PanelModel {
        name: None,
        schema: MODEL_SCHEMA.to_owned(),
        piece,
        boundary: test.boundary,
        structure: StructureKind::TimoshenkoBeam,
        constants,
        damping: Damping { ratios, beyond: beyond.exp() },
        effects: vec![],
        ports,
        provenance: BTreeMap::new(),
    };
    let of_effects = std.get(std.len().saturating_sub(state.hypothesis.size())..).unwrap_or_default();
    if let Some(plate) = effects_of(&state.hypothesis, of_effects).iter().find(|effect| effect.id == PLATE) {
        widen(&mut panel, plate)?;
    }
    Ok(panel)
}
