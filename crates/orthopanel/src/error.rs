//! Everything that the facade refuses; the messages of the layers below stand in it as they are.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use orthopanel_data::{DataError, Location, Position};
use orthopanel_export::ExportError;
use orthopanel_identify::IdentifyError;
use orthopanel_model::ModelError;
use thiserror::Error;

use crate::fmu_refusal::FmuRefusal;

/// Why something was not done; each message names the file, what is wrong in it, and the way out.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// A file that is not there, or that may not be read.
    #[error("{}: cannot be read: {source}", .path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A result that cannot be put where it was asked for.
    #[error("{}: cannot be written: {reason}: {}", .path.display(), way_out(*.kind))]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: String,
        /// The system's kind of it.
        kind: ErrorKind,
    },
    /// Results could be neither written whole nor left as they were.
    #[error("{failed}; not all is as it was: {lost}")]
    NotPutBack {
        /// What kept them from being written.
        failed: Box<Error>,
        /// What is lost.
        lost: String,
    },
    /// A result would take the place of what it is made from.
    #[error(
        "{}: not written, for it is {}: name another place for the result", .path.display(),
        if path == input { "read by this command".into() } else { format!("{}, which this command reads", input.display()) }
    )]
    OutputIsInput {
        /// The result.
        path: PathBuf,
        /// What is read.
        input: PathBuf,
    },
    /// A file was changed by somebody else meanwhile.
    #[error("{}: changed while it was read: run again", .path.display())]
    Changed {
        /// The file.
        path: PathBuf,
    },
    /// A test file or its records.
    #[error(transparent)]
    Data(#[from] DataError),
    /// A table of a lot.
    #[error("{}: {source}", .path.display())]
    Lot {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: crate::lot::TableError,
    },
    /// A test that cannot be identified or traced.
    #[error("{}: {source}", .path.display())]
    Identify {
        /// The test file.
        path: PathBuf,
        /// Why.
        source: IdentifyError,
    },
    /// A trace that explains nothing, of a test whose base model is refused.
    #[error("{}: no model is written: no effect explains {}, and its base model is refused: {source}", .path.display(), .test.display())]
    NoModel {
        /// The model file.
        path: PathBuf,
        /// The test file.
        test: PathBuf,
        /// What refuses the base model.
        source: Box<IdentifyError>,
    },
    /// A model that is none, or that cannot answer.
    #[error("{}: {source}", .path.display())]
    Model {
        /// The model file.
        path: PathBuf,
        /// Why.
        source: ModelError,
    },
    /// Records that do not fit what is asked of them.
    #[error("{}: {problem}", .path.display())]
    Records {
        /// The file.
        path: PathBuf,
        /// What does not fit, and what to do.
        problem: String,
    },
    /// A force file.
    #[error("{}{}: {problem}", .path.display(), line.map_or(String::new(), |line| format!(":{line}")))]
    ForceFile {
        /// The file.
        path: PathBuf,
        /// From 1, where the fault is in one.
        line: Option<u64>,
        /// What is wrong, and what to do.
        problem: String,
    },
    /// An FMU that is not run.
    #[error("{}: {source}", .path.display())]
    Fmu {
        /// The FMU.
        path: PathBuf,
        /// Why.
        source: FmuRefusal,
    },
    /// A file of another kind than is wanted.
    #[error("{}: {given}, where {wanted} is wanted: {taken}", .path.display())]
    OtherKind {
        /// The file.
        path: PathBuf,
        /// What it is.
        given: &'static str,
        /// What is wanted.
        wanted: &'static str,
        /// What takes it.
        taken: String,
    },
    /// A name under which no importer knows an FMU.
    #[error("{}: importers refuse an FMU whose name does not end in .fmu: let it end so, in upper or lower case", .path.display())]
    FmuName {
        /// The name.
        path: PathBuf,
    },
    /// An FMU that cannot be made.
    #[error(transparent)]
    Export(#[from] ExportError),
    /// A picture that cannot be drawn.
    #[error("the picture {name} cannot be drawn: {problem}")]
    Picture {
        /// Which.
        name: &'static str,
        /// Why.
        problem: String,
    },
    /// An [`Observer`](crate::Observer) asked for it.
    #[error("interrupted")]
    Interrupted,
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

impl Error {
    /// A file that the system does not let be written; its words name a temporary file, and its kind of error none.
    pub(crate) fn unwritable(path: &Path, error: &std::io::Error) -> Self {
        let kind = error.kind();
        Self::Unwritable { path: path.into(), reason: kind.to_string(), kind }
    }

    /// Whether the data or the model says no, of input that is as it should be.
    pub fn says_no(&self) -> bool {
        match self {
            Self::Model { source: ModelError::Unsupported(_) | ModelError::Eigenproblem, .. }
            | Self::Data(DataError::NoUsableHit { .. })
            | Self::Identify { source: IdentifyError::Data(DataError::NoUsableHit { .. }), .. }
            | Self::Fmu { source: FmuRefusal::Call { .. }, .. }
            | Self::NoModel { .. }
            | Self::Picture { .. }
            | Self::Export(ExportError::Assemble(_)) => true,
            Self::Identify { source, .. } => !source.is_bad_input(),
            _ => false,
        }
    }
}

/// Where it is wrong.
impl Error {
    fn location(&self) -> Option<&Location> {
        match self {
            Self::Data(source) | Self::Identify { source: IdentifyError::Data(source), .. } => source.location(),
            Self::NotPutBack { failed, .. } => failed.location(),
            _ => None,
        }
    }

    /// The file that it is about, where it is about one.
    pub fn path(&self) -> Option<&Path> {
        match self {
            Self::Unreadable { path, .. }
            | Self::Unwritable { path, .. }
            | Self::OutputIsInput { path, .. }
            | Self::Changed { path }
            | Self::Lot { path, .. }
            | Self::NoModel { path, .. }
            | Self::Model { path, .. }
            | Self::Records { path, .. }
            | Self::ForceFile { path, .. }
            | Self::Fmu { path, .. }
            | Self::FmuName { path }
            | Self::OtherKind { path, .. } => Some(path),
            Self::Identify { path, .. } => Some(self.location().map_or(path, |at| &at.file)),
            Self::Data(_) => self.location().map(|at| at.file.as_path()),
            Self::NotPutBack { failed, .. } => failed.path(),
            Self::Export(_) | Self::Picture { .. } | Self::Interrupted => None,
        }
    }

    /// The line of the file, from 1, where one is known.
    pub fn line(&self) -> Option<u64> {
        match (self, self.location().map(|at| at.position)) {
            (Self::ForceFile { line, .. }, _) => *line,
            (_, Some(Position::Line(line))) => Some(line as u64),
            _ => None,
        }
    }

    /// The key of a test file, or the name of a record, where one is known.
    pub fn key(&self) -> Option<&str> {
        self.location().map(|at| at.key.as_str()).filter(|key| !key.is_empty())
    }

    /// What to do about it: the end of the message.
    pub fn way_out(&self) -> Option<String> {
        let said = self.to_string();
        said.rsplit_once(": ").map(|(_, way_out)| way_out.to_owned())
    }
}

/// Says which file a refusal of the model is about.
pub(crate) trait InFile<T> {
    fn in_file(self, path: &Path) -> Result<T, Error>;
}

impl<T> InFile<T> for Result<T, ModelError> {
    fn in_file(self, path: &Path) -> Result<T, Error> {
        self.map_err(|source| Error::Model { path: path.into(), source })
    }
}
