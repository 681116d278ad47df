//! The one resource of an FMU: `resources/panel.json`, modes and ports, so that exporting needs no compiler.

use std::fmt::Write as _;
use std::path::Path;

use orthopanel_model::{ModalModel, Ports};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::{FmuError, VariableTable};

/// The file's name in `resources/`.
pub const RESOURCE_FILE: &str = "panel.json";

const RESOURCE_SCHEMA: &str = "orthopanel.fmu/1";

/// Program and version, as FMUs name the tool that made them.
pub const GENERATOR: &str = concat!("orthopanel ", env!("CARGO_PKG_VERSION"));

/// What an FMU holds: the modes, and the places of its ports.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Resource {
    schema: String,
    /// Program and version that wrote it: part of the token, since another version may order variables otherwise.
    generator: String,
    ports: Ports,
    model: ModalModel,
}

impl Resource {
    /// Joins a model with the places of its ports.
    ///
    /// # Errors
    /// [`FmuError::ResourceText`] where the numbers of places and ports differ.
    pub fn new(model: ModalModel, ports: Ports) -> Result<Self, FmuError> {
        Self { schema: RESOURCE_SCHEMA.into(), generator: GENERATOR.into(), ports, model }.checked()
    }

    /// The modes.
    pub fn model(&self) -> &ModalModel {
        &self.model
    }

    /// Places of forces and responses.
    pub fn ports(&self) -> &Ports {
        &self.ports
    }

    /// The variables of this FMU.
    pub fn variables(&self) -> VariableTable {
        VariableTable::new(&self.model, &self.ports)
    }

    /// Text of the file; the same content gives the same text.
    pub fn to_json(&self) -> String {
        // Every field is a plain number, text or list: serialisation has nothing to fail on.
        serde_json::to_string(self).unwrap_or_default() + "\n"
    }

    /// Reads the resource from the folder `resources`, if it is the one that `token` belongs to.
    ///
    /// # Errors
    /// [`FmuError::ResourceMissing`], [`FmuError::Token`], [`FmuError::ResourceText`].
    pub fn read(resources: &Path, token: &str) -> Result<Self, FmuError> {
        let path = resources.join(RESOURCE_FILE);
        let bytes = match std::fs::read(&path) {
            Ok(bytes) => bytes,
            Err(source) => return Err(FmuError::ResourceMissing { path, source }),
        };
        let found = content_token(&bytes);
        if token != found {
            return Err(FmuError::Token { path, given: token.into(), found });
        }
        let resource: Self =
            serde_json::from_slice(&bytes).map_err(|error| FmuError::ResourceText(error.to_string()))?;
        resource.checked()
    }

    fn checked(self) -> Result<Self, FmuError> {
        if self.schema != RESOURCE_SCHEMA {
            let message = format!("schema = {:?}: this library reads {RESOURCE_SCHEMA:?}", self.schema);
            return Err(FmuError::ResourceText(message));
        }
        let model = self.model.checked()?;
        let places = (self.ports.forces.len(), self.ports.responses.len());
        let counts = (model.force_count(), model.response_count());
        if places != counts {
            return Err(FmuError::ResourceText(format!(
                "places of {} forces and {} responses for a model of {} and {}",
                places.0, places.1, counts.0, counts.1
            )));
        }
        Ok(Self { model, ..self })
    }
}

/// The FMI 2 `guid` and FMI 3 `instantiationToken` of a resource's text: the start of its SHA-256, written as a GUID.
///
/// The content is its own token: a damaged or exchanged file is noticed before anything is read from it.
pub fn content_token(resource: &[u8]) -> String {
    let mut token = String::from("{");
    for (index, byte) in Sha256::digest(resource).iter().take(16).enumerate() {
        if matches!(index, 4 | 6 | 8 | 10) {
            token.push('-');
        }
        // Writing to a String has nothing to fail on.
        let _ = write!(token, "{byte:02x}");
    }
    token + "}"
}
