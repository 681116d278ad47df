//! The same work on several things at once. Inside an FMU (feature `compact`) it is done one by one: a host may unload
//! the library, and no thread of ours may then be left in it.

#[cfg(not(feature = "compact"))]
use rayon::prelude::*;

/// `work` on each of `items`, results in their order.
pub(crate) fn map<'a, T: Sync, R: Send>(items: &'a [T], work: impl Fn(&'a T) -> R + Sync + Send) -> Vec<R> {
    #[cfg(not(feature = "compact"))]
    return items.par_iter().map(work).collect();
    #[cfg(feature = "compact")]
    items.iter().map(work).collect()
}

/// `work` on each of `items` until one fails.
pub(crate) fn try_each<T: Send, E: Send>(
    items: &mut [T],
    work: impl Fn(&mut T) -> Result<(), E> + Sync + Send,
) -> Result<(), E> {
    #[cfg(not(feature = "compact"))]
    return items.par_iter_mut().try_for_each(work);
    #[cfg(feature = "compact")]
    items.iter_mut().try_for_each(work)
}
