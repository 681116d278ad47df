//! What joins a panel to its surroundings beside forces and motions at ports: one file for each kind, one line where it is registered.

mod gravity;
mod layout;
mod mount;
mod mounts;
mod moving_frame;
mod pressure;
mod rotations;
mod setting;

use orthopanel_model::{ModelError, PanelModel, is_identifier};

use crate::{FmuError, PortNames};

use layout::Load;
pub(crate) use layout::{Input, Layout, MovedBy, Output, Signal, Terms, value};
pub use mount::Mount;
pub use setting::Connections;
use setting::Setting;

type Join = fn(&Setting, &mut Layout) -> Result<(), ModelError>;

/// In the order of their variables; the frame, which bears all loads, comes last.
const KINDS: [Join; 5] = [rotations::join, mounts::join, gravity::join, pressure::join, moving_frame::join];

impl Connections {
    /// Where all of these are joined to a panel.
    pub(crate) fn layout(&self, model: &PanelModel, flexible: usize, names: &PortNames) -> Result<Layout, ModelError> {
        let mut layout = Layout::of_ports(&model.ports);
        let setting = Setting { model, flexible, connections: self, names };
        KINDS.iter().try_for_each(|join| join(&setting, &mut layout))?;
        Ok(layout)
    }

    /// Refuses mounts that are none, and a frame where no edge is held.
    ///
    /// # Errors
    /// [`FmuError::PortName`], [`FmuError::Mount`], [`FmuError::NoFrame`], and [`ModelError::OffPiece`] for a mount off the panel.
    #[cold]
    pub(crate) fn check(&self, model: &PanelModel) -> Result<(), FmuError> {
        for mount in &self.mounts {
            if !is_identifier(&mount.name) {
                return Err(FmuError::PortName { name: mount.name.clone() });
            }
            model.piece.contains(mount.at)?;
            for (what, value) in [("stiffness", mount.stiffness), ("damping", mount.damping)] {
                mounts::check(&mount.name, what, value)?;
            }
        }
        if self.base_acceleration && model.boundary == orthopanel_model::Boundary::FREE {
            return Err(FmuError::NoFrame);
        }
        Ok(())
    }
}

pub(crate) use mounts::check as check_mount;
