//! The test file `test.toml`: what was tested, how it was held, and where the measurements are.

mod declared;
mod in_memory;
mod measurements;
mod pieces;
mod source;
mod syntax;
mod wrong_type;

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

use orthopanel_model::{Boundary, Place, StructureKind};

use crate::{DataError, Location, Position, limits};
pub use declared::{DeclaredEffect, KnownConstant};
pub use measurements::{
    ChannelName, Direction, Measurement, MeasurementData, NaturalFrequencies, RecordedResponse, Trigger,
};
pub use pieces::{NamedPiece, SizeDoubt};
use source::Source;

/// One impact test, read and checked: every number in it is finite and in range, every place lies on its piece, and
/// every file it names was there.
///
/// Without a file it is filled field by field, and then [checked](ImpactTest::checked).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ImpactTest {
    /// `structure`, a key before the tables: what is identified; `None` where the file says nothing, which means the
    /// Timoshenko beam.
    pub structure: Option<StructureKind>,
    /// The pieces, of one material but for their [`NamedPiece::own_constants`]; at least one.
    pub pieces: Vec<NamedPiece>,
    /// What holds the ends; free unless said.
    pub boundary: Boundary,
    /// Places of the suspension \[m\], on the centre line; empty where the file says nothing.
    pub suspension: Vec<Place>,
    /// Constants held at these values, by name \[Pa; Poisson's ratio 1\].
    pub constants: BTreeMap<String, f64>,
    /// What is known beforehand of constants that are not held, by name.
    pub known_constants: BTreeMap<String, KnownConstant>,
    /// Effects known beforehand, in the order of the file.
    pub effects: Vec<DeclaredEffect>,
    /// The measurements, in the order of the file; at least one.
    pub measurements: Vec<Measurement>,
}

impl ImpactTest {
    /// Reads the test file at `path`; a folder stands for the `test.toml` in it. Files that it names are looked for beside it.
    ///
    /// # Errors
    /// [`DataError::Unreadable`] where the file cannot be read, else as [`ImpactTest::from_toml`].
    pub fn read(path: impl AsRef<Path>) -> Result<Self, DataError> {
        let path = &Self::file_at(path.as_ref());
        let read = limits::TEST_FILE.read(path);
        let bytes = read.map_err(|source| DataError::Unreadable { at: Location::whole(path), source })?;
        let text = String::from_utf8(bytes).map_err(|error| DataError::Syntax {
            at: Box::new(Location {
                position: Position::Byte(error.utf8_error().valid_up_to()),
                ..*Location::whole(path)
            }),
            message: "not UTF-8 text: save the test file as UTF-8".into(),
        })?;
        Self::from_toml(&text, path)
    }

    /// The test file that `path` stands for: of a folder the `test.toml` in it.
    pub fn file_at(path: &Path) -> PathBuf {
        if path.is_dir() { path.join("test.toml") } else { path.into() }
    }

    /// Every file that the test names, as it is to be opened.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        self.measurements.iter().filter_map(|measurement| measurement.data.recorded()).flat_map(RecordedResponse::files)
    }

    /// Reads the text of a test file; `path` names it in messages, and files that it names are looked for beside it.
    ///
    /// # Errors
    /// The first fault found, with line and key: [`DataError::Syntax`] for text that is no TOML, unknown keys and
    /// wrong types; [`DataError::Missing`], [`DataError::Contradiction`], [`DataError::OutOfRange`],
    /// [`DataError::UnknownName`], [`DataError::Duplicate`], [`DataError::Order`], [`DataError::Count`] and
    /// [`DataError::Model`] for what the keys hold; [`DataError::Unreadable`] for a named file that is not there.
    pub fn from_toml(text: &str, path: impl AsRef<Path>) -> Result<Self, DataError> {
        let source = Source::new(path.as_ref(), text);
        let file: syntax::TestFile = toml::from_str(text).map_err(|error| source.syntax(&error))?;
        let test = Self::of_keys(&source, file)?;
        if test.measurements.is_empty() {
            let remedy = "write at least one [[measurement]] with kind, and values or file";
            return Err(DataError::Missing { at: source.whole("measurement"), remedy });
        }
        Ok(test)
    }

    /// Checks what the keys hold.
    fn of_keys(source: &Source, file: syntax::TestFile) -> Result<Self, DataError> {
        let pieces = pieces::pieces(source, file.piece)?;
        let declared::Constants { held, known } = declared::constants(source, file.constants)?;
        Ok(Self {
            structure: file.structure.map(|name| declared::structure(source, &name)).transpose()?,
            suspension: declared::suspension(source, file.suspension, &pieces)?,
            constants: held,
            known_constants: known,
            effects: declared::effects(source, file.effect)?,
            measurements: measurements::measurements(source, (file.measurement, file.band), &pieces)?,
            boundary: file.boundary,
            pieces,
        })
    }
}
