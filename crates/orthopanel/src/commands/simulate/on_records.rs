//! A model driven by measured hits, and its acceleration held against the measured one.

use std::path::Path;

use orthopanel_data::{ImpactTest, RecordedResponse, TimeHistory};
use orthopanel_identify::ForceBetweenSamples;
use orthopanel_model::PanelModel;
use serde::Serialize;

use super::{Arguments, Method};
use crate::error::CommandError;
use crate::measured_pairs::{ComparedPair, HitMisfit, csv, is_test_file, misfit_table};
use crate::section_3_5::{self, Integration};
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
    method: &'static str,
    /// Of each pair of places, where the method is Runge-Kutta's.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    integrations: Vec<Integration>,
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
    if arguments.method == Method::Exact && arguments.steps.is_some() {
        let problem = "--steps belongs to --method runge-kutta: the exact method needs none".into();
        return Err(CommandError::Records { path: arguments.force_file.clone(), problem });
    }
    let between_samples = match (arguments.hold, arguments.method) {
        (None, Method::Exact) | (Some(Hold::BandLimited), _) => ForceBetweenSamples::BandLimited,
        (None, Method::RungeKutta) | (Some(Hold::Linear), _) => ForceBetweenSamples::Linear,
        (Some(Hold::Held), _) => {
            let remedy = "measured hits are not held: leave it out for band-limited, or give linear".into();
            return Err(CommandError::Option { option: "hold", value: "held".into(), remedy });
        }
    };
    let model = model_file::read(path)?;
    if arguments.method == Method::RungeKutta && !section_3_5::takes(&model) {
        let problem =
            "section 3.5 is of a beam without effects: leave out --method runge-kutta, the exact one takes them".into();
        return Err(CommandError::Records { path: path.clone(), problem });
    }
    let histories = histories(arguments, &model)?;
    let shown = progress::bar("driving the model", histories.len());
    let (mut pairs, mut hits, mut integrations) = (Vec::with_capacity(histories.len()), Vec::new(), Vec::new());
    let refused = |source| CommandError::Identify { path: arguments.force_file.clone(), source };
    for history in histories {
        let exact = ComparedPair::of(&model, history, between_samples, None).map_err(refused)?;
        match arguments.method {
            Method::Exact => {
                hits.extend(exact.misfits());
                pairs.push(exact);
            }
            Method::RungeKutta => {
                let found = section_3_5::by_runge_kutta(&model, &exact, between_samples, arguments.steps);
                let (pair, integration) = found.map_err(refused)?;
                let beside = pair.misfits().into_iter().zip(exact.misfits()).zip(section_3_5::apart(&pair, &exact));
                hits.extend(beside.map(|((own, exact), apart)| own.beside_exact(exact, apart)));
                integrations.push(integration);
                pairs.push(pair);
            }
        }
        shown.step();
    }
    drop(shown);
    for Integration { elements, steps } in &integrations {
        eprintln!("{elements} beam elements, {steps} steps of Runge-Kutta from one sample to the next");
    }
    for ComparedPair { history, .. } in &pairs {
        notes::say(&format!("{}: ", history.file.display()), &history.notes);
    }
    if let Some(path) = &arguments.output {
        output::write(path, csv(&pairs))?;
        eprintln!("wrote {}", path.display());
    }
    if arguments.json {
        let method = match arguments.method {
            Method::Exact => "exact",
            Method::RungeKutta => "runge-kutta",
        };
        output::print_json(&Answer { schema: "orthopanel.simulated-hits/1", method, integrations, hits });
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
