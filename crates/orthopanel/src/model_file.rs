//! Reading a model file (`orthopanel.model/1`).

use std::path::Path;

use orthopanel_model::PanelModel;

use crate::error::{CommandError, InFile as _};
use crate::importer;

pub fn read(path: &Path) -> Result<PanelModel, CommandError> {
    if importer::is_fmu(path)? {
        return Err(CommandError::FmuForModel { path: path.into() });
    }
    let text =
        std::fs::read_to_string(path).map_err(|source| CommandError::Unreadable { path: path.into(), source })?;
    PanelModel::from_json(&text).in_file(path)
}
