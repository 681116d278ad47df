//! Why an FMU is not run.

use std::path::PathBuf;

use thiserror::Error;

/// What is wrong with an FMU, or what it said itself. Texts from inside it are shortened and free of control characters.
#[derive(Debug, Error)]
#[allow(missing_docs, reason = "the messages tell")]
#[non_exhaustive]
pub enum FmuRefusal {
    #[error("not an FMU: it is no zip archive")]
    NoArchive,
    #[error("its zip archive is broken: {0}: copy or export it anew")]
    Archive(String),
    #[error("its zip archive has an entry {name} that {problem}")]
    Entry { name: String, problem: &'static str },
    #[error("its zip archive has two entries of one name: pack it anew")]
    TwoEntries,
    #[error("not an FMU: its zip archive has no modelDescription.xml")]
    NoDescription,
    #[error("it has {what} of more than {most} {unit}: export it anew, with fewer places, or with --arrays for FMI 3")]
    TooMuch { what: String, most: u64, unit: &'static str },
    #[error(
        "its modelDescription.xml has a document type declaration (<!DOCTYPE ...>), which no FMU needs: leave it out"
    )]
    DocumentType,
    #[error("its modelDescription.xml is broken: {0}: export it anew")]
    Description(String),
    #[error("its fmiVersion is {0}: only FMI 2.0 and 3.0 are run")]
    Version(String),
    #[error("its modelIdentifier {0} is no C identifier, so it names no library: export it anew")]
    Identifier(String),
    #[error("not an FMU that orthopanel wrote: {0}")]
    Foreign(String),
    #[error("it has no library for this platform ({path}), {}", elsewhere(.others))]
    NoLibrary { path: String, others: Vec<String> },
    #[error(
        "its library {path} ({size} bytes) is not the one that this orthopanel carries, so it was made by another version, by \
         another build or by a stranger: export it anew from its model, or run it by --trust, which lets the code of whoever \
         made it do all that you may"
    )]
    Untrusted { path: String, size: usize },
    #[error("its library {path} is cut short or damaged: {reason}: export it anew, or have it sent again")]
    DamagedLibrary { path: String, reason: String },
    #[error("its library {path} cannot be loaded: {reason}")]
    Load { path: String, reason: String },
    #[error("it cannot be read: {0}")]
    Read(std::io::Error),
    #[error(
        "it cannot be unpacked: {} cannot be {what}: {source}: temporary files need room, TMPDIR can name another folder",
        .path.display()
    )]
    Unpack { what: &'static str, path: PathBuf, source: std::io::Error },
    #[error("it refuses to start{}", said(.0))]
    NoInstance(Vec<String>),
    #[error("the FMU fails at {call}{}", said(.messages))]
    Call { call: &'static str, messages: Vec<String> },
}

/// Libraries for other platforms, as the archive's paths say.
fn elsewhere(paths: &[String]) -> String {
    match paths {
        [] => "and none for another: export it anew".into(),
        _ => format!("only {}: export it here anew, or with --library", paths.join(", ")),
    }
}

fn said(messages: &[String]) -> String {
    messages.iter().map(|message| format!(": {message}")).collect()
}

/// Refuses a `count` of more than `most`.
pub fn limited(what: &str, count: usize, most: usize, unit: &'static str) -> Result<(), FmuRefusal> {
    if count > most { Err(FmuRefusal::TooMuch { what: what.into(), most: most as u64, unit }) } else { Ok(()) }
}

/// The most characters that are shown of a text from inside an FMU.
const SHOWN: usize = 600;

/// A stranger's text on one line, shortened, without control characters.
pub fn shown(text: &str) -> String {
    let mut shown: String = text.trim_end().chars().take(SHOWN).flat_map(escaped).collect();
    if text.chars().nth(SHOWN).is_some() {
        shown += "...";
    }
    shown
}

fn escaped(character: char) -> Vec<char> {
    if character.is_control() { character.escape_default().collect() } else { vec![character] }
}
