//! What a parameter of an FMU is of its panel.

use orthopanel_model::EffectParameter;

/// What a parameter of the FMU is of the panel; ports and modes are counted from 0.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Part {
    Length,
    Width,
    Thickness,
    MassPerArea,
    Constant(String),
    /// Number of the effect among those of the panel, and its parameter.
    Effect(usize, &'static EffectParameter),
    Damping(usize),
    /// Of all residual modes.
    ResidualDamping,
    ForceX(usize),
    ForceY(usize),
    ResponseX(usize),
    ResponseY(usize),
    MountStiffness(usize),
    MountDamping(usize),
    MountX(usize),
    MountY(usize),
    /// Place of a force or a mount that residual modes answer: no parameter, but what follows the port or mount until initialization has ended.
    AttachmentX(usize),
    AttachmentY(usize),
}

impl Part {
    /// Whether it may be set while the simulation runs: modal coordinates go on meaning the same motion. Modes are those of the
    /// undamped panel, so that neither damping nor a port moves them; with sizes, mass or constants they would be other shapes.
    pub(crate) fn is_tunable(&self) -> bool {
        self.is_damping() || self.is_of_force() || self.is_of_response() || self.mount().is_some()
    }

    pub(crate) fn is_damping(&self) -> bool {
        matches!(self, Self::Damping(_) | Self::ResidualDamping)
    }

    pub(crate) fn is_of_attachment(&self) -> bool {
        matches!(self, Self::AttachmentX(_) | Self::AttachmentY(_))
    }

    pub(crate) fn is_place(&self) -> bool {
        let of_mount = matches!(self, Self::MountX(_) | Self::MountY(_));
        of_mount || self.is_of_force() || self.is_of_response() || self.is_of_attachment()
    }

    /// Of which mount it is.
    pub(crate) fn mount(&self) -> Option<usize> {
        match *self {
            Self::MountStiffness(mount) | Self::MountDamping(mount) | Self::MountX(mount) | Self::MountY(mount) => {
                Some(mount)
            }
            _ => None,
        }
    }

    /// Whether it is a mount's stiffness or damping.
    pub(crate) fn is_of_mount_law(&self) -> bool {
        matches!(self, Self::MountStiffness(_) | Self::MountDamping(_))
    }

    /// Whether it is the place of a force.
    pub(crate) fn is_of_force(&self) -> bool {
        matches!(self, Self::ForceX(_) | Self::ForceY(_))
    }

    /// Whether it is the place of a response.
    pub(crate) fn is_of_response(&self) -> bool {
        matches!(self, Self::ResponseX(_) | Self::ResponseY(_))
    }

    /// Whether it is the place of a port across the panel.
    pub(crate) fn is_along_y(&self) -> bool {
        matches!(self, Self::ForceY(_) | Self::ResponseY(_) | Self::MountY(_))
    }
}

/// A parameter of the FMU, as its table of variables shows it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PanelParameter {
    pub name: String,
    pub unit: &'static str,
    pub description: String,
    pub start: f64,
    pub tunable: bool,
}
