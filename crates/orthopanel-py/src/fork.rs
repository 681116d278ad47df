//! Threads: how many, and in processes that were forked, as `multiprocessing` does: such a process has the pool of the one it came from, and
//! none of its threads.

use std::process;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The process that imported the module.
static FIRST: OnceLock<u32> = OnceLock::new();

/// Threads of a pool; as many as there are cores where it is zero.
static THREADS: AtomicUsize = AtomicUsize::new(0);

/// Says which process has the pool's threads.
pub fn born() {
    FIRST.get_or_init(process::id);
}

/// Does `work` with threads that are there.
pub fn after_fork<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    if FIRST.get().is_none_or(|first| *first == process::id()) {
        return work();
    }
    match pool().build() {
        Ok(pool) => pool.install(work),
        Err(_) => work(),
    }
}

/// No more threads than these, unless the process computes already, on those that it has; how many there are.
pub fn limit(threads: usize) -> usize {
    THREADS.store(threads, Ordering::Relaxed);
    // Refused where there is a pool.
    let _ = pool().build_global();
    rayon::current_num_threads()
}

fn pool() -> rayon::ThreadPoolBuilder {
    rayon::ThreadPoolBuilder::new().num_threads(THREADS.load(Ordering::Relaxed))
}
