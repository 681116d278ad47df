//! A prior that the data contradict.

use std::fmt;

use orthopanel_model::Readable;

use super::wording::spaced;

/// A prior that lies far from what the data say.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PriorContradiction {
    /// The constant.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Of the prior.
    pub value: f64,
    /// Of the prior.
    pub std: f64,
    /// What the data say.
    pub found: f64,
    /// How well they say it.
    pub found_std: f64,
    /// Their difference over the standard deviation of both.
    pub deviations: f64,
}

impl fmt::Display for PriorContradiction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, unit, value, std, found, found_std, deviations } = self;
        write!(
            f,
            "{name} = {{value = {value:e}, std = {std:e}}} under [constants] lies {:.1} standard deviations from what the data say, \
             {found:.4e} +- {found_std:.1e}{}: one of the two is wrong; correct the value, widen its std, or leave the line out",
            Readable(*deviations),
            spaced(unit)
        )
    }
}
