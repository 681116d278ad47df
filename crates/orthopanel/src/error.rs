//! Everything that can go wrong in a command, and the exit status it leads to.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use orthopanel_data::DataError;
use orthopanel_export::ExportError;
use orthopanel_identify::IdentifyError;
use orthopanel_model::{ModelError, Place, Readable};
use thiserror::Error;

use crate::fmu_refusal::FmuRefusal;

/// The data or the model says no.
pub const SAYS_NO: u8 = 1;
/// Bad usage or input.
pub const BAD_INPUT: u8 = 2;

/// What the command line refuses; the messages of the layers below stand in it as they are.
#[derive(Debug, Error)]
pub enum CommandError {
    #[error("{}: cannot be read: {source}", .path.display())]
    Unreadable { path: PathBuf, source: std::io::Error },
    #[error("{}: cannot be written: {reason}: {}", .path.display(), way_out(*.kind))]
    Unwritable { path: PathBuf, reason: String, kind: ErrorKind },
    #[error("{failed}; not all is as it was: {lost}")]
    NotPutBack { failed: Box<CommandError>, lost: String },
    #[error(
        "{}: not written, for it is {}: name another place for the result", .path.display(),
        if path == input { "read by this command".into() } else { format!("{}, which this command reads", input.display()) }
    )]
    OutputIsInput { path: PathBuf, input: PathBuf },
    #[error("{}: changed while it was read: run again", .path.display())]
    Changed { path: PathBuf },
    #[error("standard output: it goes to {}, which this command reads: send it to another file", .input.display())]
    InputIsAnswer { input: PathBuf },
    #[error("standard output: the answer could not be written whole: {0}")]
    Answer(std::io::Error),
    #[error(transparent)]
    Data(#[from] DataError),
    #[error("{}: {source}", .path.display())]
    Identify { path: PathBuf, source: IdentifyError },
    #[error(
        "{}: no model is written: no effect explains {}, and its base model is refused: {source}",
        .path.display(), .test.display()
    )]
    NoModel { path: PathBuf, test: PathBuf, source: Box<IdentifyError> },
    #[error("{}: {source}", .path.display())]
    Model { path: PathBuf, source: ModelError },
    #[error("{}: no {kind} place: give --{kind} X[,Y], or write ports.{key} into the model file", .path.display())]
    NoPort { path: PathBuf, kind: &'static str, key: &'static str },
    #[error("--{option} {},{}: {source}", Readable(.place.x), Readable(.place.y))]
    Place { option: &'static str, place: Place, source: ModelError },
    #[error(
        "{}: the accelerance of a model needs --force, --response, --from, --to and --lines; a test file (.toml) gives \
         measured ones and needs none of them", .path.display()
    )]
    NoGrid { path: PathBuf },
    #[error(
        "{}: --{option} belongs to a model, and this is a test file: leave it out; places and lines are those of the \
         records", .path.display()
    )]
    GridOfRecords { path: PathBuf, option: &'static str },
    #[error(
        "{}: --{option} belongs to hammer records, and this is a model: leave it out, or name a test file (.toml)",
        .path.display()
    )]
    EstimationOfModel { path: PathBuf, option: &'static str },
    #[error("{}: {problem}", .path.display())]
    Records { path: PathBuf, problem: String },
    #[error("--{option} {value}: {remedy}")]
    Option { option: &'static str, value: String, remedy: String },
    #[error("{}{}: {problem}", .path.display(), line.map_or(String::new(), |line| format!(":{line}")))]
    ForceFile { path: PathBuf, line: Option<u64>, problem: String },
    #[error("{}: {source}", .path.display())]
    Fmu { path: PathBuf, source: FmuRefusal },
    #[error(
        "{}: importers refuse an FMU whose name does not end in .fmu: let it end so, in upper or lower case",
        .path.display()
    )]
    FmuName { path: PathBuf },
    #[error("{}: {given}, where {wanted} is wanted: {taken}", .path.display())]
    OtherKind { path: PathBuf, given: &'static str, wanted: &'static str, taken: String },
    #[error(
        "{}: modes and places are fixed inside an FMU: leave out --modes, --up-to, --force and --response, or give them \
         to `orthopanel export`", .path.display()
    )]
    FixedInFmu { path: PathBuf },
    #[error(transparent)]
    Export(#[from] ExportError),
    #[error("the picture {name} cannot be drawn: {problem}")]
    Picture { name: &'static str, problem: String },
}

/// What to do about a file that cannot be written.
fn way_out(kind: ErrorKind) -> &'static str {
    match kind {
        ErrorKind::NotFound => "name a place in a folder that exists",
        ErrorKind::NotADirectory => "name a folder, or a place that does not lie below a file",
        ErrorKind::PermissionDenied => "name a place that you may write to",
        ErrorKind::ReadOnlyFilesystem => "name a place on a disk that may be written to",
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded => "make room, or name a place on another disk",
        ErrorKind::IsADirectory => "name a file in it",
        ErrorKind::InvalidFilename => "give a shorter name, without characters that the system forbids",
        _ => "name another place",
    }
}

impl CommandError {
    /// A file that the system does not let be written; its words name a temporary file, and its kind of error none.
    pub fn unwritable(path: &Path, error: &std::io::Error) -> Self {
        let kind = error.kind();
        Self::Unwritable { path: path.into(), reason: kind.to_string(), kind }
    }

    /// 1 where the data or the model says no, 2 for bad usage or input.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Model { source: ModelError::Unsupported(_) | ModelError::Eigenproblem, .. }
            | Self::Data(DataError::NoUsableHit { .. })
            | Self::Identify { source: IdentifyError::Data(DataError::NoUsableHit { .. }), .. }
            | Self::Fmu { source: FmuRefusal::Call { .. }, .. }
            | Self::NoModel { .. }
            | Self::Picture { .. }
            | Self::Export(ExportError::Assemble(_)) => SAYS_NO,
            Self::Identify { source, .. } if !source.is_bad_input() => SAYS_NO,
            _ => BAD_INPUT,
        }
    }
}

/// Says which file a refusal of the model is about.
pub trait InFile<T> {
    fn in_file(self, path: &Path) -> Result<T, CommandError>;
}

impl<T> InFile<T> for Result<T, ModelError> {
    fn in_file(self, path: &Path) -> Result<T, CommandError> {
        self.map_err(|source| CommandError::Model { path: path.into(), source })
    }
}
