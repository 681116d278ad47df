//! The panel of a hypothesis, and what is removed from it.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use orthopanel_data::{ImpactTest, NamedPiece};
use orthopanel_model::{
    Boundary, CorrelationMatrix, Damping, Estimate, MODEL_SCHEMA, ModeRange, ModelError, Owner, PanelModel, Piece,
    Place, Ports, StructureKind,
};

use super::damping::TracedDamping;
use super::estimates::Estimates;
use crate::hypothesis::Role;
use crate::measured::MeasuredModes;
use crate::outcome::Removed;
use crate::plate_of_ratios::widen;
use crate::posterior::Judged;
use crate::predicted::distinct;
use crate::search::Inquiry;
use crate::structures;
use crate::traced_effect::TracedEffect;

/// Key of a model's provenance under which the standard deviations of its damping ratios stand.
const DAMPING_STD: &str = "damping_std";
/// Modes of a plate up to so many times the highest pole get a damping ratio.
const ABOVE: f64 = 1.1;

/// The panel of a piece that was hit, with the effects that are its own; `plate` is the number of the effect that stands a
/// plate in the place of the beam, and `of_effects` as in [`TracedDamping::of`].
///
/// # Errors
/// What the plate refuses.
pub(super) fn panel(
    test: &ImpactTest,
    (measured, of_effects): (&MeasuredModes, &[f64]),
    (judged, estimates): (&Judged, &Estimates),
    damping: TracedDamping,
    plate: Option<usize>,
) -> Result<PanelModel, ModelError> {
    let places = |at: fn(&crate::MeasuredRecord) -> Place| distinct(measured.records.iter().map(at));
    let (own, _) = own_and_others(estimates, plate);
    let structure = structures::of_test(test).kind();
    let ports = Ports { forces: places(|record| record.force_at), responses: places(|record| record.response_at) };
    let piece = (test.pieces[measured.piece].piece, test.boundary);
    let mut panel = bare(structure, piece, constants(structure, (judged, estimates), measured.piece), ports);
    let damping = match plate.and_then(|number| estimates.effects.get(number)) {
        Some((ratios, _)) => {
            widen(&mut panel, ratios);
            damping_of_plate(&panel, (measured, of_effects))?
        }
        None if structure == StructureKind::MindlinPlate => damping_of_plate(&panel, (measured, of_effects))?,
        None => damping,
    };
    panel.damping = damping.damping;
    panel.provenance.insert(DAMPING_STD.to_owned(), damping.std.into());
    panel.effects = own.into_iter().map(|(effect, _)| effect.entry()).collect();
    Ok(panel)
}

/// A panel for each piece as its constants say alone, with the effects that are its own, and which of the others are removed and why. Frequencies tell
/// no damping. An effect at a place is on the piece that was hit, if any was.
pub(super) fn panels_of_lists(
    test: &ImpactTest,
    inquiry: &Inquiry,
    judged: &Judged,
    estimates: &Estimates,
) -> (Vec<PanelModel>, Vec<Removed>) {
    let structure = structures::of_test(test).kind();
    let plate = judged.hypothesis.parts.iter().position(|part| part.replaces_structure(inquiry.predictor()));
    let hit: Vec<usize> = inquiry.stacked.hit().map(|(_, hit)| hit.piece).collect();
    let (own, others) = own_and_others(estimates, plate);
    let of_piece = |(piece, named): (usize, &NamedPiece)| {
        let ports = Ports { forces: vec![], responses: vec![] };
        let mut panel =
            bare(structure, (named.piece, test.boundary), constants(structure, (judged, estimates), piece), ports);
        if let Some((ratios, _)) = plate.and_then(|number| estimates.effects.get(number)) {
            widen(&mut panel, ratios);
        }
        let acts = |effect: &&TracedEffect| hit.is_empty() || hit.contains(&piece) || !effect.has_place();
        panel.effects = own.iter().map(|(effect, _)| effect).filter(acts).map(TracedEffect::entry).collect();
        panel
    };
    (test.pieces.iter().enumerate().map(of_piece).collect(), removed(&others))
}

/// The constants of a piece, and how their errors go together.
type Constants = (BTreeMap<String, Estimate>, Option<CorrelationMatrix>);

fn constants(structure: StructureKind, (judged, estimates): (&Judged, &Estimates), piece: usize) -> Constants {
    let coordinates = judged.hypothesis.coordinates_of_constants();
    let of = |(constant, of): (usize, &orthopanel_model::Constant)| {
        let found = |own: Option<usize>| {
            let place = judged.hypothesis.constant_numbers().position(|number| number == (constant, own))?;
            Some((*estimates.constants.get(place)?, coordinates.get(place).copied().flatten()))
        };
        let (estimate, coordinate) = found(Some(piece)).or_else(|| found(None))?;
        Some((of.name.to_owned(), estimate, coordinate))
    };
    let found: Vec<_> = structure.constants().iter().enumerate().filter_map(of).collect();
    let free = found.iter().filter_map(|(name, _, coordinate)| Some((name.clone(), (*coordinate)?)));
    let (names, places): (Vec<String>, Vec<usize>) = free.unzip();
    // Coordinates go with the constants, or their logarithms.
    let covariance = |i: usize, j: usize| judged.posterior.covariance[(places[i], places[j])];
    let correlation =
        CorrelationMatrix::between(names, |i, j| covariance(i, j) / (covariance(i, i) * covariance(j, j)).sqrt());
    (found.into_iter().map(|(name, estimate, _)| (name, estimate)).collect(), correlation)
}

type Parts<'a> = Vec<&'a (TracedEffect, Role)>;

/// Effects of the panel, and those of rig and measuring chain.
fn own_and_others(estimates: &Estimates, plate: Option<usize>) -> (Parts<'_>, Parts<'_>) {
    let parts = estimates.effects.iter().enumerate().filter(|(number, _)| Some(*number) != plate);
    parts.map(|(_, part)| part).partition(|(effect, _)| effect.owner == Owner::Panel)
}

fn removed(others: &Parts) -> Vec<Removed> {
    let others = others.iter().filter(|(_, role)| matches!(role, Role::Declared | Role::Found));
    others.map(|(effect, role)| Removed::of(effect, *role == Role::Declared)).collect()
}

/// A structure without damping and effects.
fn bare(
    structure: StructureKind,
    (piece, boundary): (Piece, Boundary),
    (constants, correlation): Constants,
    ports: Ports,
) -> PanelModel {
    PanelModel {
        name: None,
        schema: MODEL_SCHEMA.to_owned(),
        piece,
        boundary,
        structure,
        constants,
        damping: Damping::default(),
        correlation,
        effects: vec![],
        ports,
        provenance: BTreeMap::new(),
    }
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
