//! Ending long work early, where its observer wants no more.
//!
//! The layer below tells how far it is and asks nobody else, so the teller unwinds.

use orthopanel_identify::interruption;

use crate::{Error, Observer};

/// Unwinds where the observer wants no more.
pub fn heed(observer: &dyn Observer) {
    if observer.is_interrupted() {
        interruption::end();
    }
}

/// What `work` gives.
///
/// # Errors
/// [`Error::Interrupted`] where [`heed`] unwound.
pub fn caught<T>(work: impl FnOnce() -> T) -> Result<T, Error> {
    interruption::caught(work).ok_or(Error::Interrupted)
}
