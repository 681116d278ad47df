//! A model driven by measured hits, and its acceleration held against the measured one.

use std::path::Path;

use orthopanel_data::{ImpactTest, RecordedResponse, TimeHistory};
use orthopanel_identify::ForceBetweenSamples;
use orthopanel_model::PanelModel;
use serde::Serialize;

use super::Arguments;
use crate::error::CommandError;
use crate::measured_pairs::{ComparedPair, HitMisfit, csv, is_test_file, misfit_table};
use crate::time_response::Hold;
use crate::{importer, model_file, notes, output, progress};

/// Whether the force file holds measured accelerations beside the force: a test, a UFF, or a CSV of a record's three
/// columns. A CSV with more is a force with other columns, such as `simulate` itself writes.
pub fn is_measured(path: &Path) -> Result<bool, CommandError> {
    if is_test_file(path) {
        return Ok(true);
    }
    let bytes = std::fs::read(path).map_err(|source| CommandError::Unreadable { path: path.into(), source })?;
    let mut lines = bytes.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii);
    let first = lines.find(|line| !line.is_empty() && !line.starts_with(b"#")).unwrap_or_default();
    let mut columns: Vec<&[u8]> = first.split(|&byte| byte == b',').map(<[u8]>::trim_ascii).collect();
    columns.sort_unstable();
    Ok(first == b"-1" || columns == [&b"acceleration_m_s2"[..], b"force_n", b"time_s"])
}

#[derive(Serialize)]
struct Answer {
    schema: &'static str,
    hits: Vec<HitMisfit>,
}

pub fn execute(arguments: &Arguments) -> Result<(), CommandError> {
    let path = &arguments.model;
    if importer::is_fmu(path)? {
        let problem = "measured hits are held against a model file, not an FMU: give MODEL.json, or a force file of \
                       time_s,force_n"
            .into();
        return Err(CommandError::Records { path: path.clone(), problem });
    }
    if arguments.modes.is_given() {
        let problem = "measured hits take every mode up to the sampling rate: leave out --modes and --up-to".into();
        return Err(CommandError::Records { path: arguments.force_file.clone(), problem });
    }
    let between_samples = match arguments.hold {
        None | Some(Hold::BandLimited) => ForceBetweenSamples::BandLimited,
        Some(Hold::Linear) => ForceBetweenSamples::Linear,
        Some(Hold::Held) => {
            let remedy = "measured hits are not held: leave it out for band-limited, or give linear".into();
            return Err(CommandError::Option { option: "hold", value: "held".into(), remedy });
        }
    };
    let model = model_file::read(path)?;
    let histories = histories(arguments, &model)?;
    let shown = progress::bar("driving the model", histories.len());
    let mut pairs = Vec::with_capacity(histories.len());
    for history in histories {
        let compared = ComparedPair::of(&model, history, between_samples, None);
        pairs.push(compared.map_err(|source| CommandError::Identify { path: arguments.force_file.clone(), source })?);
        shown.step();
    }
    drop(shown);
    for ComparedPair { history, .. } in &pairs {
        notes::say(&format!("{}: ", history.file.display()), &history.notes);
    }
    if let Some(path) = &arguments.output {
        output::write(path, csv(&pairs))?;
        eprintln!("wrote {}", path.display());
    }
    let hits: Vec<HitMisfit> = pairs.iter().flat_map(ComparedPair::misfits).collect();
    if arguments.json {
        output::print_json(&Answer { schema: "orthopanel.simulated-hits/1", hits });
    } else {
        output::print(&misfit_table(&hits.iter().collect::<Vec<_>>()));
    }
    Ok(())
}

/// The hits of the force file, each pair of places by itself.
fn histories(arguments: &Arguments, model: &PanelModel) -> Result<Vec<TimeHistory>, CommandError> {
    let path = &arguments.force_file;
    let refused = |problem: String| CommandError::Records { path: path.clone(), problem };
    if is_test_file(path) {
        if arguments.ports.is_given() {
            return Err(refused("the places are those of the test file: leave out --force and --response".into()));
        }
        let test = ImpactTest::read(path)?;
        let piece = piece_of(&test, model).ok_or_else(|| {
            let names: Vec<_> = test.pieces.iter().map(|piece| piece.name.as_str()).collect();
            refused(format!("the model's piece is none of {}: sizes or names differ", names.join(", ")))
        })?;
        let histories = test.time_histories()?.into_iter().filter(|(index, _)| *index == piece);
        let histories: Vec<_> = histories.map(|(_, history)| history).collect();
        if histories.is_empty() {
            return Err(refused("no time-history of the model's piece in this test".into()));
        }
        return Ok(histories);
    }
    let ports = arguments.ports.needed(model, &arguments.model)?;
    let ([force_at], [response_at]) = (&ports.forces[..], &ports.responses[..]) else {
        let (forces, responses) = (ports.forces.len(), ports.responses.len());
        let problem = format!(
            "a record has one force and one response place, the model has {forces} and {responses}: say which by \
             --force and --response"
        );
        return Err(refused(problem));
    };
    let record = RecordedResponse {
        file: path.clone(),
        force_at: *force_at,
        response_at: *response_at,
        unit: None,
        direction: None,
        record: None,
    };
    Ok(vec![TimeHistory::read(&record)?])
}

/// The piece of the test that the model is of: the only one, else the one of the same sizes and of the name that
/// `identify` left in the model file.
fn piece_of(test: &ImpactTest, model: &PanelModel) -> Option<usize> {
    let named = model.provenance.get("piece").and_then(|name| name.as_str());
    let mut same = test.pieces.iter().enumerate().filter(|(_, piece)| piece.piece == model.piece);
    match (named, test.pieces.len()) {
        (_, 0 | 1) => Some(0),
        (Some(name), _) => same.find(|(_, piece)| piece.name == name).map(|(index, _)| index),
        (None, _) => same.next().map(|(index, _)| index),
    }
}
