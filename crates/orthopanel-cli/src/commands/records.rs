//! `records`: what files of records hold.

use std::path::PathBuf;

use orthopanel::harmless::harmless_line;
use orthopanel::tables;
use orthopanel_data::{ListedRecord, RecordFile};
use serde::Serialize;

use orthopanel_model::Readable;

use crate::error::CommandError;
use crate::{console, terminal};

/// List what files of records hold: quantity, unit, node and direction, length, rate, peak, coherence
///
/// Universal files 58 and 58b, and columns of numbers in a text (CSV, LVM and others). What was assumed is said on standard error.
/// Numbers, and nodes with their directions, are those that `record`, `force_channel` and `response_channel` of a test file take.
/// A file that cannot be read is named, and the others are listed all the same; the command then ends with exit status 2.
/// A file of another kind (MAT, TDMS, HDF5, WAV, XLSX, NPY) is named, with the two lines of Python that convert it.
///
/// Examples: orthopanel records point-0.uff
///           orthopanel records *.csv --json
#[derive(clap::Args)]
#[command(verbatim_doc_comment)]
pub struct Arguments {
    /// Files of records
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Print one JSON object (orthopanel.records/1) on standard output
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Answer {
    schema: &'static str,
    files: Vec<FileEntry>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    not_read: Vec<NotRead>,
}

#[derive(Serialize)]
struct FileEntry {
    file: PathBuf,
    records: Vec<ListedRecord>,
    notes: Vec<String>,
}

#[derive(Serialize)]
struct NotRead {
    file: PathBuf,
    why: String,
}

pub fn execute(arguments: &Arguments) -> Result<(), CommandError> {
    let (mut files, mut not_read, mut first) = (Vec::new(), Vec::new(), None);
    for path in &arguments.files {
        match RecordFile::read(path) {
            Ok(file) => {
                let notes = file.notes.iter().cloned().chain(file.questions()).collect();
                files.push(FileEntry { file: path.clone(), records: file.listed(), notes });
            }
            Err(error) => {
                not_read.push(NotRead { file: path.clone(), why: error.to_string() });
                // The first is what the command ends with.
                if first.is_some() {
                    console::say(format_args!("{error}"));
                }
                first = first.or(Some(error));
            }
        }
    }
    for FileEntry { file, notes, .. } in &files {
        terminal::note(&format!("{}: ", file.display()), notes);
    }
    if arguments.json {
        console::print_json(&Answer { schema: "orthopanel.records/1", files, not_read })?;
    } else if !files.is_empty() {
        let text: Vec<String> = files.iter().map(table).collect();
        console::print(&text.join("\n"))?;
    }
    first.map_or(Ok(()), |error| Err(error.into()))
}

/// Characters of a title that are shown.
const TITLE: usize = 40;

fn table(file: &FileEntry) -> String {
    let row = |of: &ListedRecord| {
        let told = |text: &str| if text.is_empty() { "-".to_owned() } else { text.to_owned() };
        vec![
            of.record.to_string(),
            of.quantity.clone(),
            told(&of.unit),
            told(&of.response),
            told(&of.reference),
            of.points.to_string(),
            of.extent(),
            format!("{:.4}", Readable(of.peak)),
            of.mean_coherence.map_or("-".to_owned(), |mean| format!("{mean:.3}")),
            of.title.chars().take(TITLE).collect(),
        ]
    };
    let heading =
        ["record", "quantity", "unit", "response", "reference", "points", "extent", "peak", "mean coherence", "title"];
    let rows: Vec<Vec<String>> = file.records.iter().map(row).collect();
    format!("{}\n{}", harmless_line(&file.file.display().to_string()), tables::ending_in_words(&heading, &rows))
}
