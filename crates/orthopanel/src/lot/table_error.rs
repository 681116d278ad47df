//! A table that is none of a lot's.

use thiserror::Error;

/// A table that is none of a lot's.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum TableError {
    /// An ending that names no format.
    #[error("the lot is written as .csv or .parquet: give its name one of these endings")]
    Ending,
    /// A file that is broken, or of another kind.
    #[error("no lot's table: {problem}: `orthopanel batch TEST.. -o LOT` writes one")]
    Broken {
        /// What is wrong.
        problem: String,
    },
}
