//! What an FMU says through its importer's logger.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use fmi_rs::fmi2::types::fmi2Status;
use fmi_rs::fmi3::types::fmi3Status;

use crate::fmu_refusal::shown;

/// Messages that are kept; an FMU may log at each of a million steps.
const KEPT: usize = 10;

/// The first messages of an FMU, in order.
#[derive(Default)]
pub(super) struct Log(Mutex<Vec<String>>);

impl Log {
    pub(super) fn new() -> Arc<Self> {
        Arc::default()
    }

    /// The messages so far, which the log forgets.
    pub(super) fn taken(&self) -> Vec<String> {
        std::mem::take(&mut *self.messages())
    }

    fn messages(&self) -> MutexGuard<'_, Vec<String>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn keep(&self, message: &str) {
        let mut messages = self.messages();
        if messages.len() < KEPT {
            messages.push(shown(message));
        }
    }
}

impl fmi_rs::fmi2::log::Logger for Log {
    fn log_call(&self, _: fmi2Status, _: &str) {}

    fn log_message(&self, _: fmi2Status, _: &str, message: &str) {
        self.keep(message);
    }
}

impl fmi_rs::fmi3::log::Logger for Log {
    fn log_call(&self, _: fmi3Status, _: &str) {}

    fn log_message(&self, _: fmi3Status, _: &str, message: &str) {
        self.keep(message);
    }
}
