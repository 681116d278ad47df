//! What files may hold at most: bounds of time and memory, each far beyond what tests of panels need.
//!
//! Each refusal tells the limit and the number found.

pub use orthopanel_model::limits::*;

use crate::InputKind;

/// A test file: ten thousand measurements take 3 MB. Reading TOML may take a hundred times its size in memory.
pub const TEST_FILE: InputKind = InputKind { name: "a test file", most_bytes: 1 << 22 };

/// A file of records (UFF or CSV): ten minutes of four channels at 51.2 kHz take 1 GB.
pub const RECORD_FILE: InputKind = InputKind { name: "a file of records", most_bytes: 1 << 31 };

/// All files of records of one test together, for they are evaluated together.
pub const RECORD_FILES: u64 = 1 << 32;

/// A model file: one with as many modes, places and effects as it may hold takes less than 1 MB.
pub const MODEL_FILE: InputKind = InputKind { name: "a model file", most_bytes: 1 << 24 };

/// A force file: an hour at 10 kHz takes 1 GB.
pub const FORCE_FILE: InputKind = InputKind { name: "a force file", most_bytes: 1 << 30 };

/// A library of an FMU for another platform.
pub const LIBRARY_FILE: InputKind = InputKind { name: "a library", most_bytes: 1 << 28 };

/// Pieces of a test.
pub const PIECES: usize = 200;

/// Measurements of a test: twenty hits in files of their own at five hundred places.
pub const MEASUREMENTS: usize = 10_000;

/// Natural frequencies of one list. Few analysts read more than 30; beyond 100 modes stand so close that no list names them.
pub const FREQUENCIES: usize = 200;

/// Natural frequencies of one list that is traced: each effect is fitted to them, in time that grows with the cube of their number
/// and more: on one core a quarter of a minute for twelve, and minutes for so many.
pub const FREQUENCIES_TRACED: usize = 40;

/// Natural frequencies of all lists of one piece that is traced: twenty lists of six take two minutes.
pub const FREQUENCIES_TRACED_OF_PIECE: usize = 120;

/// Samples of a force that is band-limited between them, over all places: each takes the memory of a hundred numbers.
pub const BAND_LIMITED_SAMPLES: usize = 2_000_000;

/// Natural frequencies of all lists of a test: forty of each of fifty pieces.
pub const FREQUENCIES_OF_TEST: usize = 2000;

/// Records of one file: all frequency responses of a roving test at a few thousand places.
pub const RECORDS: usize = 100_000;

/// Sampling rates and frequencies of lines \[Hz\]: from swings of days to a thousand times what a hammer excites. Others are a unit's
/// mistake, and nothing that is computed from them makes sense.
pub const HERTZ: [f64; 2] = [1e-6, 1e8];

/// Sampling rates of hammer tests \[Hz\]: below, a blow falls between two samples, and times were in ms or µs; no recorder of motion
/// goes above.
pub const SAMPLING_RATE: [f64; 2] = [100.0, 2e7];

/// Hits of one pair of places. Three to twenty are usual.
pub const HITS: usize = 2000;

/// Suspension points.
pub const SUSPENSION_POINTS: usize = 100;

/// Coupons weighed of one piece.
pub const WEIGHINGS: usize = 10_000;

/// Names in a piece's `own_constants`: as many as a plate has constants.
pub const OWN_CONSTANTS: usize = 6;
