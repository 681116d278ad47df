//! Mode shapes of a model.

use orthopanel_model::{ModeRange, ModelError, PanelMode, Place};

use super::Model;
use crate::Error;
use crate::error::InFile as _;

impl Model {
    /// Its rigid and flexible modes.
    ///
    /// # Errors
    /// [`Error::Model`].
    pub fn modes(&self, range: ModeRange) -> Result<Vec<PanelMode>, Error> {
        self.panel.modes(range).in_file(&self.name)
    }

    /// Deflection of flexible mode `number`, from 1, at each of the places \[kg^(-1/2)\]: its modal mass is one.
    ///
    /// # Errors
    /// [`Error::Model`] for a place that is not on the piece, and for a mode beyond those that can be resolved.
    ///
    /// # Examples
    /// ```
    /// use orthopanel::{Model, Place};
    ///
    /// let model = Model::load("../../examples/plate.json")?;
    /// let shape = model.mode_shape(1, &[Place { x: 0.0, y: 0.0 }, Place { x: 0.1, y: 0.0 }])?;
    /// assert_eq!(shape.len(), 2);
    /// # Ok::<(), orthopanel::Error>(())
    /// ```
    pub fn mode_shape(&self, number: usize, places: &[Place]) -> Result<Vec<f64>, Error> {
        places.iter().try_for_each(|place| self.panel.piece.contains(*place)).in_file(&self.name)?;
        let modes = self.modes(ModeRange::Count(number))?;
        let mut flexible = modes.iter().filter(|mode| !mode.is_rigid());
        let none = ModelError::BasisTooSmall { asked: number, available: flexible.clone().count() };
        let mode = number.checked_sub(1).and_then(|index| flexible.nth(index)).ok_or(none).in_file(&self.name)?;
        Ok(places.iter().map(|&place| mode.deflection(place)).collect())
    }
}
