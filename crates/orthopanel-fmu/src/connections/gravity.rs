//! A uniform field of acceleration, as gravity or a steady turn: it pushes mode $m$ by $g\,\Gamma_z(W_m)$
//! ([`PanelModel::inertia_row`](orthopanel_model::PanelModel::inertia_row)).

use orthopanel_model::{ModelError, RigidMotion};

use super::{Layout, Load, Setting};

#[cold]
pub(super) fn join(setting: &Setting, layout: &mut Layout) -> Result<(), ModelError> {
    if setting.connections.gravity {
        let row = setting.model.inertia_row(RigidMotion::AlongZ, setting.flexible)?;
        let text = "Uniform field of acceleration on all masses, positive along +z: -9.81 where +z points up. Held over each step, or \
                    linear, as forces are";
        layout.input("gravity".into(), "m/s2", described!("{text}"), Load::Works(row));
    }
    Ok(())
}
