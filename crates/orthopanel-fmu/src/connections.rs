//! What joins a panel to its surroundings beside forces and motions at ports: one file for each kind, one line where it is registered.

mod gravity;
mod layout;
mod mounts;
mod moving_frame;
mod pressure;
mod rotations;

use orthopanel_model::{ModelError, PanelModel, is_identifier};
use serde::{Deserialize, Serialize};

use crate::{FmuError, PortNames};

use layout::Load;
pub(crate) use layout::{Input, Layout, MovedBy, Output, Signal, Terms, value};
pub use mounts::Mount;

/// The inputs and outputs of an FMU beside those of its ports.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Connections {
    /// Springs and dashpots between the panel and bases that move, inside the FMU.
    pub mounts: Vec<Mount>,
    /// Couples at the force ports, and rotations at the response ports.
    pub rotations: bool,
    /// A uniform field of acceleration.
    pub gravity: bool,
    /// A uniform pressure on the face.
    pub pressure: bool,
    /// The motion of the frame that holds the edges, and its reactions.
    pub base_acceleration: bool,
}

/// What a kind of connection is joined to.
pub(crate) struct Setting<'a> {
    pub model: &'a PanelModel,
    /// Modes that are kept: integrals over shapes have points enough for these.
    pub flexible: usize,
    pub connections: &'a Connections,
    pub names: &'a PortNames,
}

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
