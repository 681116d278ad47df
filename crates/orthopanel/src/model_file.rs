//! Reading and writing model files (`orthopanel.model/1`).

use std::path::Path;

use orthopanel_data::{ImpactTest, limits};
use orthopanel_model::PanelModel;

use crate::error::{CommandError, InFile as _};
use crate::given_file::{self, Wanted};
use crate::identified::suffixes;
use crate::measured_pairs::is_test_file;
use crate::outputs::{Outputs, with_suffix};
use crate::{console, importer};

pub fn read(path: &Path) -> Result<PanelModel, CommandError> {
    let of_other_kind =
        |given, taken| Err(CommandError::OtherKind { path: path.into(), given, wanted: "a model file (JSON)", taken });
    if importer::is_fmu(path)? {
        return of_other_kind("an FMU", "name the one that the FMU was made from".into());
    }
    if is_test_file(path) {
        let taken = format!("`orthopanel identify {} -o model.json` makes one of it", path.display());
        return of_other_kind("a test file", taken);
    }
    let text = limits::MODEL_FILE.read_text(path);
    let text = text.map_err(|source| CommandError::Unreadable { path: path.into(), source });
    let model = text.and_then(|text| PanelModel::from_json(&text).in_file(path));
    model.map_err(|refused| given_file::or_kind_of(path, Wanted::Model, refused))
}

/// Plans one model a piece of the test, as [`write_each`] names them.
pub fn planned_each(outputs: Outputs, path: Option<&Path>, test: &ImpactTest) -> Result<Outputs, CommandError> {
    let Some(path) = path else { return Ok(outputs) };
    let named = suffixes(test).map(|suffix| with_suffix(path, &suffix));
    outputs.beside(path, test.pieces.len() > 1)?.all_planned(named)
}

/// Writes one model a piece, as `with_suffix` names them, and says so on standard error.
pub fn write_each<'a>(
    mut outputs: Outputs,
    path: &Path,
    models: impl Iterator<Item = (String, &'a PanelModel)>,
) -> Result<(), CommandError> {
    for (suffix, model) in models {
        outputs.add(with_suffix(path, &suffix), model.to_json());
    }
    for path in outputs.write()? {
        console::say(format_args!("wrote {}", path.display()));
    }
    Ok(())
}
