//! Ports: where force goes in and motion comes out.

use serde::{Deserialize, Serialize};

use crate::Place;

/// Where force goes in and motion comes out.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ports {
    /// Places of the forces, along +z.
    #[serde(default)]
    pub forces: Vec<Place>,
    /// Places of the responses, along +z.
    #[serde(default)]
    pub responses: Vec<Place>,
}
