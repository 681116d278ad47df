//! On what a variable depends, and how.

/// One variable on which another depends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Dependency {
    /// Its reference.
    pub reference: u32,
    /// How it enters.
    pub factor: Factor,
}

/// FMI `dependenciesKind`: what becomes of the factor before a known once initialization has ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Factor {
    /// It stays as it is.
    Fixed,
    /// It changes where a tunable parameter is set.
    Tunable,
    /// There is none: the unknown is not linear in this known.
    Dependent,
}

impl Factor {
    /// As the XML says it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fixed => "fixed",
            Self::Tunable => "tunable",
            Self::Dependent => "dependent",
        }
    }
}
