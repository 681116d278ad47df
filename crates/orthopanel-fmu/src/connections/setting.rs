//! What joins a panel to its surroundings, and the panel that it is joined to.

use orthopanel_model::PanelModel;
use serde::{Deserialize, Serialize};

use super::mount::Mount;
use crate::PortNames;

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
