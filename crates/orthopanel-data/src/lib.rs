#![doc = include_str!("../README.md")]

mod draft;
mod error;
mod input;
pub mod limits;
mod listing;
mod records;
mod spectra;
mod test_file;
mod units;

pub use draft::draft;
pub use error::{DataError, Location, Position};
pub use input::{InputKind, regular_file};
pub use listing::ListedRecord;
pub use records::{Axis, ColumnName, ColumnRole, DeclaredColumns, Port, Record, RecordFile, RecordKind, Samples};
pub use spectra::{
    Accelerance, Channel, ChannelNoise, Cut, Estimation, Estimator, ForceNoise, Hit, HitFault, HitVerdict, ReadAs,
    TimeHistory, Transforms, Window,
};
pub use test_file::{
    ChannelName, DeclaredEffect, Direction, ImpactTest, KnownConstant, Measurement, MeasurementData, NamedPiece,
    NaturalFrequencies, RecordedResponse, SizeDoubt, Trigger,
};
pub use units::{Motion, Unit};
