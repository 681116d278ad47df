//! What the identification refuses, with the numbers in it and the way out.

use orthopanel_model::ModelError;
use thiserror::Error;

/// Errors of this crate.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum IdentifyError {
    /// Fewer measured frequencies than constants to find.
    #[error(
        "{found} natural frequencies for {needed} constants ({names}): measure at least {needed}, or hold a constant \
         at a known value under [constants]"
    )]
    TooFewFrequencies {
        /// Frequencies in the test.
        found: usize,
        /// Constants to find.
        needed: usize,
        /// Their names.
        names: String,
    },
    /// The test holds a constant that the structure does not have.
    #[error("constants.{name}: the structure has no such constant, it has {known}")]
    UnknownConstant {
        /// The constant.
        name: String,
        /// The constants of the structure.
        known: String,
    },
    /// The search came to no end.
    #[error(
        "no minimum after {iterations} iterations; the last error was {error_percent:.3} % rms: check the order of the frequencies and the sizes of the piece"
    )]
    NotConverged {
        /// Iterations done.
        iterations: usize,
        /// Error of the last one \[% rms\].
        error_percent: f64,
    },
    /// The best value lies on a bound, so it is none.
    #[error(
        "{name} = {value:e} {unit} lies on its bound: these frequencies do not determine it; hold it under [constants] or measure more modes"
    )]
    OnBound {
        /// The constant.
        name: &'static str,
        /// The bound.
        value: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// A test that this version cannot evaluate.
    #[error("{0}")]
    Unsupported(String),
    /// What the physics refuses.
    #[error(transparent)]
    Model(#[from] ModelError),
}

impl IdentifyError {
    /// Whether the test itself must be mended, rather than that its data or the model say no.
    pub fn is_bad_input(&self) -> bool {
        !matches!(self, Self::NotConverged { .. } | Self::OnBound { .. })
    }
}
