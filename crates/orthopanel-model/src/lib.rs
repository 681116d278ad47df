#![doc = include_str!("../README.md")]

mod boundary;
mod error;
mod modal_model;
mod panel_model;
mod piece;
mod response;

pub use boundary::{Boundary, End};
pub use error::ModelError;
pub use modal_model::{ModalModel, Mode};
pub use panel_model::{Damping, EffectEntry, Estimate, MODEL_SCHEMA, PanelModel, Ports, StructureKind};
pub use piece::{Piece, Place};
pub use response::ModalStepper;
