//! A uniform pressure on the face: it pushes mode $m$ by $p\int W_mdA$.

use orthopanel_model::ModelError;

use super::{Layout, Load, Setting};

#[cold]
pub(super) fn join(setting: &Setting, layout: &mut Layout) -> Result<(), ModelError> {
    if setting.connections.pressure {
        let row = setting.model.area_row(setting.flexible)?;
        let text = "Uniform pressure on the face, positive where it pushes along +z. Held over each step, or linear, as forces are";
        layout.input("pressure".into(), "Pa", described!("{text}"), Load::Works(row));
    }
    Ok(())
}
