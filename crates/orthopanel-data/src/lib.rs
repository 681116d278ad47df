#![doc = include_str!("../README.md")]

mod error;
mod records;
mod test_file;

pub use error::{DataError, Location, Position};
pub use records::{Axis, Port, Record, RecordFile, RecordKind, Samples};
pub use test_file::{
    AccelerationUnit, DeclaredEffect, ImpactTest, Measurement, MeasurementData, NamedPiece, NaturalFrequencies,
    RecordedResponse,
};
