#![doc = include_str!("../README.md")]

mod error;
mod input;
pub mod limits;
mod records;
mod spectra;
mod test_file;
mod units;

pub use error::{DataError, Location, Position};
pub use input::{InputKind, regular_file};
pub use records::{Axis, Port, Record, RecordFile, RecordKind, Samples};
pub use spectra::{
    Accelerance, Channel, ChannelNoise, Estimation, Estimator, ForceNoise, Hit, HitFault, HitVerdict, TimeHistory,
    Window,
};
pub use test_file::{
    ChannelName, DeclaredEffect, Direction, ImpactTest, Measurement, MeasurementData, NamedPiece, NaturalFrequencies,
    RecordedResponse, Trigger,
};
pub use units::{Motion, Unit};
