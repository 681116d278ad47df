#![doc = include_str!("../README.md")]

mod error;
mod test_file;

pub use error::{DataError, Location, Position};
pub use test_file::{
    AccelerationUnit, DeclaredEffect, ImpactTest, Measurement, MeasurementData, NamedPiece, NaturalFrequencies,
    RecordedResponse,
};
