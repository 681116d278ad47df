//! How an identification is to be done.

use orthopanel_data::Estimation;

use crate::DampingLaw;

/// How to search for the minimum.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Search {
    /// Least squares on exact derivatives: eq. 22 for frequencies, maximum likelihood for records.
    #[default]
    LeastSquares,
    /// The paper's downhill simplex with a penalty: eq. 24 for frequencies, eq. 25 for records.
    Simplex,
}

/// All choices of an identification; the default is what we recommend.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Settings {
    /// The search.
    pub search: Search,
    /// How records become accelerances.
    pub estimation: Estimation,
    /// How modes lose energy.
    pub damping_law: DampingLaw,
}

impl From<Search> for Settings {
    fn from(search: Search) -> Self {
        Self { search, ..Self::default() }
    }
}
