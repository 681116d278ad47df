//! Ending a trace early.
//!
//! The layer below tells how far it is and asks nothing. So the teller unwinds, without a word from the panic hook; rayon hands that on
//! from thread to thread, and here it becomes an error again. What a trace holds is dropped on the way.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

use crate::{Error, Observer};

/// What unwinds.
struct Interrupted;

/// Unwinds where the observer wants no more.
pub fn heed(observer: &dyn Observer) {
    if observer.is_interrupted() {
        resume_unwind(Box::new(Interrupted));
    }
}

/// What `work` gives.
///
/// # Errors
/// [`Error::Interrupted`] where [`heed`] unwound.
pub fn caught<T>(work: impl FnOnce() -> T) -> Result<T, Error> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|unwound| match unwound.downcast::<Interrupted>() {
        Ok(_) => Error::Interrupted,
        // A fault of ours is none of the observer's.
        Err(other) => resume_unwind(other),
    })
}
