#![doc = include_str!("../README.md")]

mod error;
mod frequency_fit;
mod identification;
mod least_squares;

pub use error::IdentifyError;
pub use frequency_fit::{Search, identify};
pub use identification::{Correlation, Identification, IdentifiedConstant, ModeFit, PieceFit};
