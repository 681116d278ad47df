//! Threads in processes that were forked, as `multiprocessing` does: such a process has the pool of the one it came from, and none of its
//! threads.

use std::process;
use std::sync::OnceLock;

/// The process that imported the module.
static FIRST: OnceLock<u32> = OnceLock::new();

/// Says which process has the pool's threads.
pub fn born() {
    FIRST.get_or_init(process::id);
}

/// Does `work` with threads that are there.
pub fn after_fork<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    if FIRST.get().is_none_or(|first| *first == process::id()) {
        return work();
    }
    match rayon::ThreadPoolBuilder::new().build() {
        Ok(pool) => pool.install(work),
        Err(_) => work(),
    }
}
