//! The accelerances that the records of a test show.

use std::path::{Path, PathBuf};

use orthopanel::measured_pairs::{ToldHit, place_text, told};
use orthopanel::outputs::{Inputs, ends_as_folder, with_suffix};
use orthopanel::{Error, csv_text, tables};
use orthopanel_data::{Accelerance, Estimation, ImpactTest, MeasurementData, Window};
use orthopanel_model::Place;
use serde::Serialize;

use crate::error::CommandError;
use crate::record_options::EstimationOptions;
use crate::terminal::{self, Terminal};
use crate::{console, progress};

/// Not that of `run`, whose results may lie in the same folder.
const MANIFEST: &str = "accelerance-manifest.json";

#[derive(Serialize)]
struct Answer {
    schema: &'static str,
    accelerances: Vec<Entry>,
}

#[derive(Serialize)]
struct Entry {
    piece: String,
    force: Place,
    response: Place,
    /// Hits averaged; 0 where an accelerance file does not tell.
    hits_kept: usize,
    hits: Vec<ToldHit>,
    from_hz: f64,
    to_hz: f64,
    lines: usize,
    /// The accelerance stands at s = decay_rate + j omega [1/s].
    decay_rate: f64,
    file: Option<PathBuf>,
    notes: Vec<String>,
}

pub fn execute(
    path: &Path,
    options: &EstimationOptions,
    output: Option<&Path>,
    json: bool,
    words: &[String],
) -> Result<(), CommandError> {
    let estimation = options.estimation(Window::None)?;
    let (inputs, read) = Inputs::reading_test(path)?;
    let test = read.content();
    let mut outputs = terminal::outputs(inputs, words)?.all_planned(output.iter().flat_map(|&output| {
        // Into a folder that is not there goes nothing that is.
        let files = if is_folder(output, true) && !output.is_dir() { 0 } else { test.files().count() };
        let is_new_folder = ends_as_folder(output) && !output.is_dir();
        let single = if is_new_folder { output.components().collect() } else { named(output, false, 0) };
        (0..files).map(move |index| named(output, true, index)).chain([single])
    }))?;
    if let Some(output) = output.filter(|path| !is_folder(path, true)) {
        outputs = outputs.beside(output, test.files().count() > 1)?;
    }
    if output.is_some_and(|path| is_folder(path, test.files().count() > 1)) {
        outputs = outputs.hashing();
    }
    options.say_if_idle(&read);
    let mut measured = {
        let _shown = progress::spinner("reading the records");
        estimated(test, estimation)?
    };
    if measured.is_empty() {
        let problem = "no records in this test: add a [[measurement]] of kind time-history or accelerance".into();
        return Err(Error::Records { path: path.into(), problem }.into());
    }
    let several = measured.len() > 1;
    outputs = match output {
        Some(folder) if is_folder(folder, several) => outputs.filling(folder, MANIFEST),
        Some(output) => outputs.beside(output, several)?,
        None => outputs,
    };
    for (index, (entry, accelerance)) in measured.iter_mut().enumerate() {
        let Some(output) = output else { break };
        let named = named(output, several, index);
        entry.file = Some(named.clone());
        outputs.add(named, csv(accelerance));
    }
    let written = outputs.write(&Terminal)?;
    let accelerances: Vec<Entry> = measured.into_iter().map(|(entry, _)| entry).collect();
    for entry in &accelerances {
        let pair = format!("{} to {}", place_text(entry.force), place_text(entry.response));
        terminal::note(&format!("{pair}: "), &entry.notes);
    }
    written.iter().for_each(|path| console::say(format_args!("wrote {}", path.display())));
    if let Some(widest) = accelerances.iter().map(|entry| entry.decay_rate).max_by(f64::total_cmp)
        && widest > 0.0
        && !written.is_empty()
    {
        console::say(format_args!(
            "note: these lines hold the exponential window's damping, {widest:.3} 1/s: the column decay_rate_1_s carries it, and \
             identify and trace take it out; a damping ratio read off the lines by other means comes out too great by \
             {widest:.3} / omega"
        ));
    }
    if json {
        console::print_json(&Answer { schema: "orthopanel.accelerances/1", accelerances })
    } else {
        console::print(&table(&accelerances))
    }
}

/// Whether `output` is the name of a folder: it is there as one, ends in a separator, or there are several files and it is not that of a CSV.
fn is_folder(output: &Path, several: bool) -> bool {
    let is_csv = output.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("csv"));
    output.is_dir() || ends_as_folder(output) || (several && !is_csv)
}

fn named(output: &Path, several: bool, index: usize) -> PathBuf {
    let number = format!("-{}", index + 1);
    if is_folder(output, several) {
        return output.join(format!("accelerance{number}.csv"));
    }
    with_suffix(output, if several { &number } else { "" })
}

/// Every accelerance of the test: those estimated from hits first, then those given as files.
fn estimated(test: &ImpactTest, estimation: Estimation) -> Result<Vec<(Entry, Accelerance)>, CommandError> {
    let mut all = Vec::new();
    for (piece, history) in test.time_histories()? {
        let accelerance = history.accelerance(estimation)?;
        all.push((entry(test, piece, &accelerance), accelerance));
    }
    for measurement in &test.measurements {
        if let MeasurementData::Accelerance(recorded) = &measurement.data {
            let accelerance = Accelerance::read(recorded)?;
            all.push((entry(test, measurement.piece, &accelerance), accelerance));
        }
    }
    Ok(all)
}

fn entry(test: &ImpactTest, piece: usize, of: &Accelerance) -> Entry {
    Entry {
        piece: test.pieces.get(piece).map_or(String::new(), |piece| piece.name.clone()),
        force: of.force_at,
        response: of.response_at,
        hits_kept: of.hits,
        hits: told(&of.verdicts),
        from_hz: of.frequency.first().copied().unwrap_or(0.0),
        to_hz: of.frequency.last().copied().unwrap_or(0.0),
        lines: of.frequency.len(),
        decay_rate: of.decay_rate,
        file: None,
        notes: of.notes.clone(),
    }
}

/// `frequency_hz,real,imag`, and `coherence`, `variance` where they are known, `decay_rate_1_s` where it is not zero.
fn csv(of: &Accelerance) -> String {
    let (real, imag): (Vec<f64>, Vec<f64>) = of.value.iter().map(|value| (value.re, value.im)).unzip();
    let mut names: Vec<String> = ["frequency_hz", "real", "imag"].map(String::from).into();
    let mut columns: Vec<&[f64]> = vec![&of.frequency, &real, &imag];
    for (name, column) in [("coherence", &of.coherence), ("variance", &of.variance)] {
        if let Some(column) = column {
            names.push(name.into());
            columns.push(column);
        }
    }
    let decay_rate = vec![of.decay_rate; of.frequency.len()];
    if of.decay_rate > 0.0 {
        names.push("decay_rate_1_s".into());
        columns.push(&decay_rate);
    }
    csv_text::csv(&names, &columns)
}

fn table(entries: &[Entry]) -> String {
    let row = |entry: &Entry| {
        vec![
            entry.piece.clone(),
            place_text(entry.force),
            place_text(entry.response),
            if entry.hits_kept == 0 { "not told".into() } else { entry.hits_kept.to_string() },
            entry.hits.iter().filter(|hit| !hit.kept).count().to_string(),
            format!("{:.1}", entry.from_hz),
            format!("{:.1}", entry.to_hz),
            entry.lines.to_string(),
        ]
    };
    let heading = ["piece", "force [m]", "response [m]", "hits kept", "left out", "from [Hz]", "to [Hz]", "lines"];
    tables::aligned(&heading, &entries.iter().map(row).collect::<Vec<_>>())
}
