//! Long work: on a thread of its own, without the interpreter's lock, with progress and Ctrl-C.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use orthopanel::{Error, Observer, Steps, Work};
use orthopanel_identify::until;
use pyo3::prelude::*;

use crate::error::{answered, fault, raised};
use crate::fork::after_fork;

/// How often signals and progress are looked after.
const PERIOD: Duration = Duration::from_millis(50);

/// What the work has told and was told.
#[derive(Default)]
struct Watch {
    at: Mutex<At>,
    interrupted: Arc<AtomicBool>,
}

#[derive(Clone, Default, PartialEq)]
struct At {
    work: &'static str,
    done: usize,
    of: Option<usize>,
    step: &'static str,
}

impl Watch {
    fn put(&self, change: impl FnOnce(&mut At)) {
        change(&mut self.at.lock().unwrap_or_else(PoisonError::into_inner));
    }

    fn now(&self) -> At {
        self.at.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

impl Observer for Watch {
    fn begin(&self, work: &'static str, steps: Steps) -> Box<dyn Work + '_> {
        let of = if let Steps::Of(count) = steps { Some(count) } else { None };
        self.put(|at| *at = At { work, done: 0, of, step: "" });
        Box::new(Stage(self))
    }

    fn is_interrupted(&self) -> bool {
        self.interrupted.load(Ordering::Relaxed)
    }
}

struct Stage<'a>(&'a Watch);

impl Work for Stage<'_> {
    fn at(&self, done: usize, of: usize, step: &'static str) {
        self.0.put(|at| (at.done, at.of, at.step) = (done, Some(of), step));
    }
}

/// Does `work`; `tell(work, done, of, step)` is called as it goes on.
///
/// # Errors
/// What `work` refuses; what a signal or `tell` raises: then the work ends at its next step, and until then goes on where nobody waits
/// for it.
pub fn done<T: Send + 'static>(
    py: Python<'_>,
    tell: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&dyn Observer) -> Result<T, Error> + Send + 'static,
) -> PyResult<T> {
    let watch = Arc::new(Watch::default());
    let (send, mut receive) = channel();
    let seen = Arc::clone(&watch);
    let body = move || {
        let ended = Arc::clone(&seen.interrupted);
        let heeding = || until(ended, || work(&*seen)).unwrap_or(Err(Error::Interrupted));
        // Nobody may wait for it any more.
        let _ = send.send(catch_unwind(AssertUnwindSafe(|| after_fork(heeding))));
    };
    thread::Builder::new().name("orthopanel".into()).spawn(body)?;
    let mut told = At::default();
    loop {
        let (answer, receiver) = py.detach(move || (receive.recv_timeout(PERIOD), receive));
        receive = receiver;
        match answer {
            Ok(Ok(result)) => return result.map_err(|refused| raised(py, &refused)),
            Ok(Err(_)) | Err(RecvTimeoutError::Disconnected) => return Err(fault()),
            Err(RecvTimeoutError::Timeout) => {}
        }
        let now = watch.now();
        let heard = py.check_signals().and_then(|()| match tell {
            Some(tell) if now != told => tell.call1((now.work, now.done, now.of, now.step)).map(drop),
            _ => Ok(()),
        });
        told = now;
        if let Err(raised) = heard {
            watch.interrupted.store(true, Ordering::Relaxed);
            return Err(raised);
        }
    }
}

/// Does `work` that takes no longer than anybody waits, without the interpreter's lock.
///
/// # Errors
/// What `work` refuses.
pub fn at_once<T: Send>(py: Python<'_>, work: impl FnOnce() -> Result<T, Error> + Send) -> PyResult<T> {
    answered(py, || py.detach(|| after_fork(work)))
}
