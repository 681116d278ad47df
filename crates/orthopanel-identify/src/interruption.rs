//! Ending long work early.
//!
//! Work unwinds, without a word from the panic hook; rayon hands that on from thread to thread, and [`caught`] makes a value of it again. What the
//! work holds is dropped on the way. Loops ask on the thread alone that the work began on: a thread of rayon's pool may be doing a part of other
//! work meanwhile.

use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// What unwinds.
struct Interrupted;

thread_local! {
    static ENDED: RefCell<Option<Arc<AtomicBool>>> = const { RefCell::new(None) };
}

/// Unwinds to the next [`caught`] or [`until`].
pub fn end() -> ! {
    resume_unwind(Box::new(Interrupted))
}

/// What `work` gives; `None` where it came to an [`end`].
pub fn caught<T>(work: impl FnOnce() -> T) -> Option<T> {
    match catch_unwind(AssertUnwindSafe(work)) {
        Ok(done) => Some(done),
        Err(unwound) if unwound.is::<Interrupted>() => None,
        // A fault of ours is nobody's wish.
        Err(fault) => resume_unwind(fault),
    }
}

/// What `work` gives, which ends within seconds once `ended` is set; `None` where it did. [`crate::identify`] asks between its steps, unless the
/// work runs on a thread of rayon's pool.
///
/// ```
/// use std::sync::{Arc, atomic::AtomicBool};
/// use orthopanel_identify::{identify, Search, until};
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/piece-1");
/// let test = orthopanel_data::ImpactTest::read(folder)?;
/// let ended = Arc::new(AtomicBool::new(true));
/// assert!(until(ended, || identify(&test, Search::LeastSquares)).is_none());
/// # Ok::<(), orthopanel_data::DataError>(())
/// ```
pub fn until<T>(ended: Arc<AtomicBool>, work: impl FnOnce() -> T) -> Option<T> {
    struct Restored(Option<Arc<AtomicBool>>);
    impl Drop for Restored {
        fn drop(&mut self) {
            ENDED.set(self.0.take());
        }
    }
    let _restored = Restored(ENDED.replace(Some(ended)));
    caught(work)
}

/// Ends the work where that is asked for.
pub(crate) fn heed() {
    let is_ended = ENDED.with_borrow(|ended| ended.as_ref().is_some_and(|ended| ended.load(Ordering::Relaxed)));
    if is_ended && rayon::current_thread_index().is_none() {
        end();
    }
}
