//! The FMU of a model.

use std::path::Path;

use orthopanel_export::{ExportError, Fmu, FmuError, FmuOptions};
use orthopanel_model::{ModeRange, Ports};

use super::Model;
use crate::error::InFile as _;
use crate::outputs::{Inputs, Outputs};
use crate::{Error, Silent, USUAL_MODES};

impl Model {
    /// An FMU of the panel, with its flexible modes of `range` and these ports; effects of rig and measuring chain are no part of it.
    ///
    /// # Errors
    /// [`Error::Model`], and [`Error::Export`] for what no FMU can have.
    pub fn fmu(&self, range: ModeRange, ports: &Ports, options: &FmuOptions) -> Result<Fmu, Error> {
        match Fmu::of_panel(&self.panel, range, ports.clone(), options) {
            Err(ExportError::Resource(FmuError::Model(error))) => Err(error).in_file(&self.name),
            made => Ok(made?),
        }
    }

    /// Writes an FMU of the panel, with twenty flexible modes and the model's own ports.
    ///
    /// # Errors
    /// As [`Model::fmu`]; [`Error::FmuName`], [`Error::Unwritable`].
    ///
    /// # Examples
    /// ```
    /// use orthopanel::{FmiVersion, FmuOptions, Model};
    ///
    /// let folder = tempfile::tempdir().unwrap();
    /// let options = FmuOptions { version: FmiVersion::Fmi3, ..FmuOptions::default() };
    /// Model::load("../../examples/plate.json")?.export(folder.path().join("panel.fmu"), &options)?;
    /// # Ok::<(), orthopanel::Error>(())
    /// ```
    pub fn export(&self, path: impl AsRef<Path>, options: &FmuOptions) -> Result<(), Error> {
        self.export_with(path, USUAL_MODES, &self.panel.ports, options)
    }

    /// As [`Model::export`], with other modes and ports.
    ///
    /// # Errors
    /// As [`Model::export`].
    pub fn export_with(
        &self,
        path: impl AsRef<Path>,
        range: ModeRange,
        ports: &Ports,
        options: &FmuOptions,
    ) -> Result<(), Error> {
        is_fmu_name(path.as_ref())?;
        self.write(path.as_ref(), self.fmu(range, ports, options)?.to_bytes()?)
    }

    /// Writes the model file.
    ///
    /// # Errors
    /// [`Error::Unwritable`].
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        self.write(path.as_ref(), self.to_json())
    }

    fn write(&self, path: &Path, content: impl Into<Vec<u8>>) -> Result<(), Error> {
        let mut outputs = Outputs::of(Inputs::default()).planned(path)?;
        outputs.add(path, content);
        outputs.write(&Silent).map(drop)
    }
}

/// Importers know an FMU by the end of its name.
///
/// # Errors
/// [`Error::FmuName`].
pub fn is_fmu_name(path: &Path) -> Result<(), Error> {
    match path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("fmu")) {
        true => Ok(()),
        false => Err(Error::FmuName { path: path.into() }),
    }
}
