//! The further list of natural frequencies that would part the chosen hypothesis from its rivals best.

use orthopanel_data::ImpactTest;
use orthopanel_model::{EffectSetting, ModeRange, ModelError, PanelModel, Place, StructureKind, natural_frequencies};

use crate::model_error::Kind;
use crate::posterior::Judged;
use crate::search::Inquiry;
use crate::stacked::Block;

use super::estimates::{Estimates, id};
use super::misfit::noise;
use super::next_measurement::{PARTS, sensor_with};
use super::panel::panels_of_lists;

/// Masses that a tester adds, in parts of the piece's \[1\].
const ADDED: [f64; 3] = [0.05, 0.1, 0.2];
/// Places along the piece to which the sensor may move, and of a plate along each side.
const PLACES: usize = 11;
const EACH_WAY: usize = 5;
/// Modes that a further list is taken to hold beyond those of the first.
const MORE: usize = 1;
/// Modes of a plate are looked for up to this part of the highest frequency measured.
const FURTHER: f64 = 1.3;
/// Twisting modes that are named, at most.
const NAMED: usize = 3;

/// What to measure next, in words, with the difference that the hypotheses then show over noise and model error.
pub(super) fn next_list(test: &ImpactTest, inquiry: &Inquiry, chosen: &Judged, others: &[&Judged]) -> String {
    if others.is_empty() {
        return "none: no other effect of the catalogue could be tried".to_owned();
    }
    let second = others.iter().map(|other| id(other)).collect::<Vec<_>>().join(", ");
    let first = id(chosen);
    // What is a beam in one and a plate in the other shows off the centre line.
    let panels = |judged: &Judged| panels_of_lists(test, inquiry, judged, &Estimates::of(judged)).0;
    let is_declared = inquiry.stacked.is_of_plates();
    let is_plate = |panel: &PanelModel| !is_declared && panel.structure == StructureKind::MindlinPlate;
    let of_chosen = panels(chosen);
    if of_chosen.iter().any(is_plate) {
        return across(inquiry, &of_chosen, &second);
    }
    if let Some(plates) = others.iter().map(|other| panels(other)).find(|panels| panels.iter().any(is_plate)) {
        return across(inquiry, &plates, &first);
    }
    let block = inquiry.stacked.longest();
    let setting = block.predictor.setting(0);
    let error = noise(inquiry).hypot(chosen.posterior.log_sizes[Kind::Frequency as usize].exp());
    let count = block.comparison().measured.modes_in_order() + MORE;
    let mut best: Option<(f64, String)> = None;
    let mut try_out = |words: String, sensor: Option<Place>, added: f64| {
        let frequencies = |judged: &Judged| further(block, &setting, judged, (sensor, added), count).ok();
        let Some(of_chosen) = frequencies(chosen) else { return };
        let apart = |other: &&Judged| {
            let other = frequencies(other)?;
            let square: f64 = of_chosen.iter().zip(&other).map(|(a, b)| (a / b).ln().powi(2)).sum();
            Some((square / count as f64).sqrt() / error)
        };
        // What is nearest to the chosen one counts.
        let apart = others.iter().map(|other| apart(other).unwrap_or(0.0)).fold(f64::INFINITY, f64::min);
        if best.as_ref().is_none_or(|(most, _)| apart > *most) {
            best = Some((apart, words));
        }
    };
    let (piece, sensor) = (setting.piece, setting.record.response_at);
    let along = |side: f64, places: usize| {
        (0..places).map(move |step| (1e3 * side * (step as f64 / (places - 1) as f64 - 0.5)).round() / 1e3)
    };
    let places: Vec<Place> = if is_declared {
        along(piece.length, EACH_WAY).flat_map(|x| along(piece.width, EACH_WAY).map(move |y| Place { x, y })).collect()
    } else {
        along(piece.length, PLACES).map(|x| Place { x, y: 0.0 }).collect()
    };
    let places = places.into_iter().filter(|place| piece.contains(*place).is_ok());
    let at = |Place { x, y }: Place| if is_declared { format!("({x:.3}, {y:.3}) m") } else { format!("x = {x:.3} m") };
    let masses = ADDED.map(|part| part * piece.mass());
    if sensor.is_some() {
        for added in masses {
            try_out(format!("add {:.1} g at the sensor", 1e3 * added), sensor, added);
        }
        places.for_each(|place| try_out(format!("move the sensor to {}", at(place)), Some(place), 0.0));
        try_out("listen without a sensor (microphone, laser)".to_owned(), None, 0.0);
    } else {
        for place in places {
            for added in masses {
                try_out(format!("fix {:.1} g at {}", 1e3 * added, at(place)), Some(place), added);
            }
        }
    }
    match best {
        Some((apart, words)) if apart > PARTS => format!(
            "{words} and read the first {count} frequencies again: there {first} differs from {second} by {apart:.1} times noise and model error"
        ),
        _ => format!(
            "hit the piece at several places and record it (kind = \"time-history\"): its shapes tell what frequencies do not; no added \
             mass parts the frequencies of {first} and {second} clearly"
        ),
    }
}

/// The first `count` natural frequencies \[Hz\] with a sensor elsewhere, or a mass \[kg\] beside it.
fn further(
    block: &Block,
    setting: &EffectSetting,
    judged: &Judged,
    (sensor, added): (Option<Place>, f64),
    count: usize,
) -> Result<Vec<f64>, ModelError> {
    let mut setting = setting.clone();
    setting.record.response_at = sensor;
    let (constants, mut effects) = block.values(&judged.hypothesis, &judged.posterior.point.z)?;
    if added > 0.0 {
        let sensor = sensor_with(added, &mut effects)?;
        effects.push(sensor);
    }
    if block.predictor.structure == StructureKind::MindlinPlate {
        return block.predictor.flexible_frequencies(&setting, &constants, &effects, count);
    }
    natural_frequencies(&setting, &constants, &effects, count)
}

/// Where a plate's modes that bend across or twist lie, on the widest piece: a beam has none.
fn across(inquiry: &Inquiry, panels: &[PanelModel], beams: &str) -> String {
    let usual = format!("hit and measure on a line across the width: a plate bends or twists there, {beams} does not");
    let width = |block: &&Block| block.predictor.piece().width;
    let Some(block) = inquiry.stacked.blocks.iter().max_by(|a, b| width(a).total_cmp(&width(b))) else { return usual };
    let Some(panel) = panels.get(block.piece) else { return usual };
    let highest = block.comparison().measured.band[1];
    let Ok(modes) = panel.modes(ModeRange::UpTo(FURTHER * highest)) else { return usual };
    let of_nodes = |count: usize| {
        let own = modes.iter().filter(move |mode| !mode.is_rigid() && mode.nodes()[1] == count);
        own.map(|mode| (mode.frequency(), mode.nodes())).collect::<Vec<_>>()
    };
    let (twisting, bending) = (of_nodes(1), of_nodes(2));
    let edge = 0.5 * panel.piece.width;
    let of_twist = twisting.iter().take(NAMED).map(|(frequency, _)| format!("{frequency:.0}")).collect::<Vec<_>>();
    let twist = if of_twist.is_empty() {
        "no twisting mode".to_owned()
    } else {
        format!("twisting modes near {} Hz, which the edge shows", of_twist.join(", "))
    };
    let bend = match bending.first() {
        Some((frequency, [along, across])) => {
            format!(
                "a mode that bends across (nodes {along} along, {across} across) near {frequency:.0} Hz, which the centre line shows too"
            )
        }
        None => format!("no mode that bends across below {:.0} Hz", FURTHER * highest),
    };
    let number = block.piece + 1;
    format!(
        "on piece {number}, hit and measure along an edge, y = {edge:.3} m, and on the centre line: the plate has {bend}, and {twist}; {beams} has \
         no peaks there"
    )
}
