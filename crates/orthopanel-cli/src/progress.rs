//! Signs of life on long work, on standard error, and only where that is a terminal.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use orthopanel::Work;

/// A spinner that turns until it is dropped; in pipes and log files nothing is drawn.
pub fn spinner(message: &'static str) -> Shown {
    let bar = ProgressBar::new_spinner().with_message(message);
    shown(bar)
}

/// A bar over `steps` steps of work.
pub fn bar(message: &'static str, steps: usize) -> Shown {
    let style = ProgressStyle::with_template("{msg} [{bar:30}] {pos}/{len}").unwrap_or(ProgressStyle::default_bar());
    shown(ProgressBar::new(steps as u64).with_message(message).with_style(style))
}

/// A bar over work whose steps are counted elsewhere, and named.
pub fn counted(message: &'static str) -> Shown {
    let style = ProgressStyle::with_template("{prefix} [{bar:30}] {pos}/{len} {msg}");
    shown(ProgressBar::new(1).with_prefix(message).with_style(style.unwrap_or(ProgressStyle::default_bar())))
}

/// Drawn at once and ever again: a first step may take minutes.
fn shown(bar: ProgressBar) -> Shown {
    bar.enable_steady_tick(Duration::from_millis(100));
    Shown(bar)
}

/// Work that is being shown; dropping it clears the line.
pub struct Shown(ProgressBar);

impl Work for Shown {
    fn at(&self, done: usize, of: usize, step: &'static str) {
        self.0.set_length(of as u64);
        self.0.set_position(done as u64);
        // Steps without names are what the message says already.
        if !step.is_empty() {
            self.0.set_message(step);
        }
    }
}

impl Drop for Shown {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
