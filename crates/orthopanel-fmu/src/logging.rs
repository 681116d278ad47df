//! Messages to the importer's logger, by category.

use crate::{FmuError, LOG_CATEGORIES};

/// Kind of a message; errors are always logged, events while they are switched on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Category {
    Events = 0,
    Error = 1,
}

impl Category {
    pub(crate) fn name(self) -> &'static str {
        LOG_CATEGORIES[self as usize].0
    }

    /// FMI status that goes with the message, the same number in both versions.
    pub(crate) fn status(self) -> i32 {
        match self {
            Self::Events => 0,
            Self::Error => 3,
        }
    }
}

/// Where messages go; it knows the C callback and the instance's name.
pub(crate) type Sink = Box<dyn Fn(Category, &str)>;

/// The importer's logger with its switch.
pub(crate) struct Logger {
    sink: Sink,
    events: bool,
}

impl Logger {
    pub(crate) fn new(sink: Sink, on: bool) -> Self {
        Self { sink, events: on }
    }

    pub(crate) fn log(&self, category: Category, message: &str) {
        if category == Category::Error || self.events {
            (self.sink)(category, message);
        }
    }

    /// Switches logging of `categories` on or off; none named means all.
    pub(crate) fn set(&mut self, on: bool, categories: &[&str]) -> Result<(), FmuError> {
        let known = |category: &&&str| LOG_CATEGORIES.iter().any(|(name, _)| name == *category);
        if let Some(&unknown) = categories.iter().find(|category| !known(category)) {
            return Err(FmuError::LogCategory(unknown.into()));
        }
        if categories.is_empty() || categories.iter().any(|&category| matches!(category, "logEvents" | "logAll")) {
            self.events = on;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;
    use std::rc::Rc;

    use super::*;

    #[test]
    fn events_are_switched_and_errors_always_pass() {
        let seen = Rc::new(RefCell::new(Vec::new()));
        let log = Rc::clone(&seen);
        let mut logger = Logger::new(Box::new(move |category, _| log.borrow_mut().push(category)), false);
        let logged = |logger: &Logger| {
            logger.log(Category::Events, "message");
            logger.log(Category::Error, "message");
            std::mem::take(&mut *seen.borrow_mut())
        };
        assert_eq!(logged(&logger), [Category::Error]);
        for (on, categories, events) in [
            (true, &["logEvents"][..], true),
            (false, &["logStatusError"], true),
            (false, &["logAll"], false),
            (true, &[], true),
        ] {
            logger.set(on, categories).expect("known");
            assert_eq!(logged(&logger).contains(&Category::Events), events, "{on} {categories:?}");
        }
        assert!(matches!(logger.set(false, &["logEvents", "nothing"]), Err(FmuError::LogCategory(_))));
        assert_eq!(logged(&logger), [Category::Events, Category::Error]);
    }
}
