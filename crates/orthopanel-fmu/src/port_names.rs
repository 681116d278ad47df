//! Names of the ports, which stand in those of the variables.

use orthopanel_model::is_identifier;
use serde::{Deserialize, Serialize};

use crate::FmuError;

/// Names of force and response ports; a port without one has its number, from 1.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PortNames {
    /// Of the forces, in their order; those behind the last have none.
    pub forces: Vec<Option<String>>,
    /// Of the responses, alike.
    pub responses: Vec<Option<String>>,
}

impl PortNames {
    /// Name of a force port, counted from 0; its number from 1 where it has none.
    pub fn force(&self, port: usize) -> String {
        label(&self.forces, port)
    }

    /// Name of a response port, alike.
    pub fn response(&self, port: usize) -> String {
        label(&self.responses, port)
    }

    /// # Errors
    /// [`FmuError::PortName`] for what is no identifier.
    pub(crate) fn check(&self) -> Result<(), FmuError> {
        match self.forces.iter().chain(&self.responses).flatten().find(|name| !is_identifier(name)) {
            Some(name) => Err(FmuError::PortName { name: name.clone() }),
            None => Ok(()),
        }
    }
}

fn label(names: &[Option<String>], port: usize) -> String {
    names.get(port).cloned().flatten().unwrap_or_else(|| (port + 1).to_string())
}
