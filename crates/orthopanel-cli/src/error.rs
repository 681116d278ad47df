//! Everything that can go wrong in a command, and the exit status it leads to.

use std::path::PathBuf;

use orthopanel::Error;
use orthopanel_data::DataError;
use orthopanel_export::ExportError;
use orthopanel_model::{ModelError, Place, Readable};

/// All is done.
pub const DONE: u8 = 0;
/// The data or the model says no.
pub const SAYS_NO: u8 = 1;
/// Bad usage or input.
pub const BAD_INPUT: u8 = 2;

/// What the command line refuses; the messages of the layers below stand in it as they are.
#[derive(Debug, thiserror::Error)]
pub enum CommandError {
    #[error(transparent)]
    Facade(#[from] Error),
    #[error("standard output: it goes to {}, which this command reads: send it to another file", .input.display())]
    InputIsAnswer { input: PathBuf },
    #[error("standard output: the answer could not be written whole: {0}")]
    Answer(std::io::Error),
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
    #[error("--{option} {value}: {remedy}")]
    Option { option: &'static str, value: String, remedy: String },
    #[error(
        "{}: modes and places are fixed inside an FMU: leave out --modes, --up-to, --force and --response, or give them \
         to `orthopanel export`", .path.display()
    )]
    FixedInFmu { path: PathBuf },
}

impl From<DataError> for CommandError {
    fn from(refused: DataError) -> Self {
        Self::Facade(refused.into())
    }
}

impl From<ExportError> for CommandError {
    fn from(refused: ExportError) -> Self {
        Self::Facade(refused.into())
    }
}

impl CommandError {
    /// 1 where the data or the model says no, 2 for bad usage or input.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Facade(refused) if refused.says_no() => SAYS_NO,
            _ => BAD_INPUT,
        }
    }
}
