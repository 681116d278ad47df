//! What stands for the modes that an FMU leaves out.

/// What stands for the modes that an FMU leaves out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Residual {
    /// The residual attachment modes of the force ports: what forces there bend beyond the modes kept, with its own inertia.
    #[default]
    Attachment,
    /// Nothing: displacements lack the static part of the modes left out, and no frequency is higher than that of the last mode.
    None,
}
