//! What was found last is kept: a search goes back and forth between a few.

use std::sync::{Arc, Mutex, PoisonError};

use crate::ModelError;

/// What was found last, the last used first.
pub(super) type Known<K, V> = Mutex<Vec<(K, Arc<V>)>>;

/// So many are kept: each of some threads goes back and forth between a few.
pub(super) const KEPT: usize = 16;

/// What is known by a key, else found and kept, among so many.
pub(super) fn known_or<K: PartialEq, V>(
    known: &Known<K, V>,
    key: K,
    most: usize,
    find: impl FnOnce() -> Result<V, ModelError>,
) -> Result<Arc<V>, ModelError> {
    let lock = || known.lock().unwrap_or_else(PoisonError::into_inner);
    let mut kept = lock();
    if let Some(place) = kept.iter().position(|known| known.0 == key) {
        kept[..=place].rotate_right(1);
        return Ok(Arc::clone(&kept[0].1));
    }
    // Others need not wait.
    drop(kept);
    let found = Arc::new(find()?);
    let mut kept = lock();
    kept.truncate(most.saturating_sub(1));
    kept.insert(0, (key, Arc::clone(&found)));
    Ok(found)
}

/// As [`known_or`], of what only a search asks for again: in an FMU's library, which has no room to spare, it is found anew.
pub(super) fn known_in_search<K: PartialEq, V>(
    known: &Known<K, V>,
    key: impl FnOnce() -> K,
    most: usize,
    find: impl FnOnce() -> Result<V, ModelError>,
) -> Result<Arc<V>, ModelError> {
    if cfg!(feature = "compact") { find().map(Arc::new) } else { known_or(known, key(), most, find) }
}
