//! Named elastic constants.

use crate::ModelError;

/// Name, unit and bounds of an elastic constant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constant {
    /// Name in files and tables, such as `e_x`.
    pub name: &'static str,
    /// Unit, `Pa` or `1`.
    pub unit: &'static str,
    /// Least value that any search may try.
    pub low: f64,
    /// Greatest value that any search may try.
    pub high: f64,
}

impl Constant {
    /// Checks a value against the bounds.
    ///
    /// # Errors
    /// [`ModelError::Constant`] with the value and the bounds.
    pub fn check(&self, value: f64) -> Result<(), ModelError> {
        if (self.low..=self.high).contains(&value) {
            return Ok(());
        }
        let Self { name, unit, low, high } = *self;
        Err(ModelError::Constant { name, value, unit, low, high })
    }
}
