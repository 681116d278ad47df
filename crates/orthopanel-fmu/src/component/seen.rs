//! A panel as some values of its parameters make it.

use std::sync::Arc;

use orthopanel_model::ModalModel;

use crate::connections::Terms;
use crate::panel::Panel;
use crate::{Resource, nominals};

/// The panel as some values of its parameters make it.
#[derive(Debug)]
pub(super) struct Seen {
    /// Of the parameters; none where nothing of the panel can be set.
    pub(super) values: Vec<f64>,
    /// Without the mounts.
    pub(super) free: ModalModel,
    /// On the mounts.
    pub(super) modes: ModalModel,
    /// What outputs of connections are made of.
    pub(super) outputs: Vec<Terms>,
    /// Sizes of the states to be expected.
    pub(super) nominals: Vec<[f64; 2]>,
}

impl Seen {
    /// As it was exported.
    pub(super) fn exported(resource: &Resource) -> Self {
        Self {
            values: resource.panel().map(Panel::values).unwrap_or_default(),
            free: resource.free().clone(),
            modes: resource.model().clone(),
            outputs: resource.outputs().iter().map(|output| output.terms.clone()).collect(),
            nominals: nominals::of(resource.model(), resource.ports().forces.len()),
        }
    }
}

/// Where the modes can be found anew.
#[derive(Debug)]
pub(super) struct Settable {
    pub(super) panel: Panel,
    pub(super) exported: Arc<Seen>,
}
