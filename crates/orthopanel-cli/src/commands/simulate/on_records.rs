//! A model driven by measured hits, and its acceleration held against the measured one.

use std::path::Path;

use orthopanel::measured_pairs::{ComparedPair, HitMisfit, csv, misfit_table, place_text};
use orthopanel::outputs::Outputs;
use orthopanel::section_3_5::{self, Integration};
use orthopanel::{Error, Model, Test, Work as _, importer};
use orthopanel_data::{ImpactTest, RecordedResponse, TimeHistory, limits};
use orthopanel_identify::{ForceBetweenSamples, IdentifyError};
use orthopanel_model::PanelModel;
use serde::Serialize;

use super::arguments::{Arguments, HoldWord, Method};
use crate::error::CommandError;
use crate::terminal::{self, Terminal};
use crate::{console, progress};

/// Whether a force file that is no test holds measured accelerations beside the force: a UFF, or a CSV of a record's three
/// columns. A CSV with more is a force with other columns, such as `simulate` itself writes.
pub fn is_measured(path: &Path) -> Result<bool, CommandError> {
    let bytes = limits::RECORD_FILE.read(path);
    let bytes = bytes.map_err(|source| Error::Unreadable { path: path.into(), source })?;
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes);
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

pub fn execute(arguments: &Arguments, test: Option<&Test>, mut outputs: Outputs) -> Result<(), CommandError> {
    let path = &arguments.model;
    if importer::is_fmu(path)? {
        let problem = "measured hits are held against a model file, not an FMU: give MODEL.json, or a force file of \
                       time_s,force_n"
            .into();
        return Err(Error::Records { path: path.clone(), problem }.into());
    }
    if arguments.modes.is_given() {
        let problem = "measured hits take every mode up to the sampling rate: leave out --modes and --up-to".into();
        return Err(Error::Records { path: arguments.force_file.clone(), problem }.into());
    }
    if arguments.method == Method::Exact && arguments.steps.is_some() {
        let problem = "--steps belongs to --method runge-kutta: the exact method needs none".into();
        return Err(Error::Records { path: arguments.force_file.clone(), problem }.into());
    }
    let between_samples = match arguments.hold {
        None | Some(HoldWord::BandLimited) => ForceBetweenSamples::BandLimited,
        Some(HoldWord::Linear) => ForceBetweenSamples::Linear,
        Some(HoldWord::Held) => {
            let remedy = "measured hits are not held: leave it out for band-limited, or give linear".into();
            return Err(CommandError::Option { option: "hold", value: "held".into(), remedy });
        }
    };
    let model = Model::load(path)?;
    let model = model.panel();
    if arguments.method == Method::RungeKutta && !section_3_5::takes(model) {
        let problem =
            "section 3.5 is of a beam without effects: leave out --method runge-kutta, the exact one takes them".into();
        return Err(Error::Records { path: path.clone(), problem }.into());
    }
    let histories = histories(arguments, test, model)?;
    let (shown, count) = (progress::bar("driving the model", histories.len()), histories.len());
    let (mut pairs, mut hits, mut integrations) = (Vec::with_capacity(histories.len()), Vec::new(), Vec::new());
    let mut lost = Vec::new();
    let refused = |source| Error::Identify { path: arguments.force_file.clone(), source };
    for (done, history) in (1..).zip(histories) {
        let exact = ComparedPair::of(model, history, between_samples, None).map_err(refused)?;
        if between_samples == ForceBetweenSamples::Linear {
            lost.extend(lost_by_straight_lines(model, &exact).map_err(refused)?);
        }
        match arguments.method {
            Method::Exact => {
                hits.extend(exact.misfits());
                pairs.push(exact);
            }
            Method::RungeKutta => {
                let found = section_3_5::by_runge_kutta(model, &exact, between_samples, arguments.steps);
                let (pair, integration) = found.map_err(refused)?;
                let beside = pair.misfits().into_iter().zip(exact.misfits()).zip(section_3_5::apart(&pair, &exact));
                hits.extend(beside.map(|((own, exact), apart)| own.beside_exact(exact, apart)));
                integrations.push(integration);
                pairs.push(pair);
            }
        }
        shown.at(done, count, "");
    }
    drop(shown);
    for integration in &integrations {
        console::say(format_args!("{}", integration.said()));
    }
    terminal::note("", &lost);
    terminal::note("", &pairs.iter().filter_map(turned_round).collect::<Vec<_>>());
    for ComparedPair { history, .. } in &pairs {
        terminal::note(&format!("{}: ", history.file.display()), &history.notes);
    }
    if let Some(path) = &arguments.output {
        outputs.add(path, csv(&pairs));
        outputs.write(&Terminal)?;
        console::say(format_args!("wrote {}", path.display()));
    }
    if arguments.json {
        let method = match arguments.method {
            Method::Exact => "exact",
            Method::RungeKutta => "runge-kutta",
        };
        console::print_json(&Answer { schema: "orthopanel.simulated-hits/1", method, integrations, hits })?;
    } else {
        console::print(&misfit_table(&hits.iter().collect::<Vec<_>>()))?;
    }
    Ok(())
}

/// Part of the variance, explained under a band-limited force and not under straight lines, that is worth a word.
const WORTH_A_WORD: f64 = 1e-3;

/// What straight lines between the samples lose of a force that was measured through an anti-alias filter: a sentence
/// where the band-limited one explains clearly more.
fn lost_by_straight_lines(model: &PanelModel, linear: &ComparedPair) -> Result<Option<String>, IdentifyError> {
    let smooth = ComparedPair::of(model, linear.history.clone(), ForceBetweenSamples::BandLimited, None)?;
    let least = |pair: &ComparedPair| {
        pair.hits.iter().map(|hit| hit.whole.misfit.variance_explained).fold(f64::INFINITY, f64::min)
    };
    let (by_lines, by_band) = (least(linear), least(&smooth));
    let (force, response) = (place_text(linear.history.force_at), place_text(linear.history.response_at));
    Ok((by_band - by_lines > WORTH_A_WORD).then(|| {
        format!(
            "{force} to {response}: straight lines lose of the force what lies near half the sampling rate: of the variance \
             {by_lines:.5} is explained, {by_band:.5} with --hold band-limited (the least of the hits, by the exact stepper)"
        )
    }))
}

/// Correlation of measured and calculated acceleration below which one of them is turned round.
const AGAINST: f64 = -0.5;

/// What is said where the measured acceleration runs against the calculated one.
fn turned_round(pair: &ComparedPair) -> Option<String> {
    let signals = || pair.hits.iter().flat_map(|hit| hit.whole.measured.iter().zip(&hit.whole.calculated));
    let (mut both, mut measured, mut calculated) = (0.0, 0.0, 0.0);
    for (one, other) in signals() {
        both += one * other;
        measured += one * one;
        calculated += other * other;
    }
    let correlation = both / (measured * calculated).sqrt();
    (correlation < AGAINST).then(|| {
        format!(
            "{} to {}: measured and calculated acceleration run against each other (correlation {correlation:.3}): sensor or \
             hammer is turned round; direction = -1 in the [[measurement]] of a test file puts it right",
            place_text(pair.history.force_at),
            place_text(pair.history.response_at)
        )
    })
}

/// The hits of the force file, each pair of places by itself.
fn histories(arguments: &Arguments, test: Option<&Test>, model: &PanelModel) -> Result<Vec<TimeHistory>, CommandError> {
    let path = &arguments.force_file;
    let refused = |problem: String| CommandError::from(Error::Records { path: path.clone(), problem });
    if let Some(test) = test.map(Test::content) {
        if arguments.ports.is_given() {
            return Err(refused("the places are those of the test file: leave out --force and --response".into()));
        }
        let piece = piece_of(test, model).ok_or_else(|| {
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
    let record = RecordedResponse::new(path, [*force_at, *response_at]);
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
