//! One mode of a panel, whatever its structure.

use std::sync::Arc;

use crate::effects::DressedMode;
use crate::structure_modes::NaturalMode;
use crate::{BeamMode, MindlinPlate, ModeName, Place, RitzMode};

/// A mode of a panel, whatever its structure.
#[derive(Debug, Clone)]
pub struct PanelMode {
    nodes: [usize; 2],
    shape: Shape,
}

#[derive(Debug, Clone)]
enum Shape {
    Beam(BeamMode),
    Dressed(DressedMode),
    Plate { plate: Arc<MindlinPlate>, mode: RitzMode, name: ModeName },
}

impl PanelMode {
    /// Natural angular frequency $\omega$ \[rad/s\]; zero for a rigid mode.
    pub fn angular_frequency(&self) -> f64 {
        match &self.shape {
            Shape::Beam(mode) => mode.angular_frequency(),
            Shape::Dressed(mode) => mode.angular_frequency,
            Shape::Plate { mode, .. } => mode.angular_frequency,
        }
    }

    /// Natural frequency \[Hz\]; zero for a rigid mode.
    pub fn frequency(&self) -> f64 {
        self.angular_frequency() / std::f64::consts::TAU
    }

    /// $\zeta$ where effects give it; `None` where it is the model's own for that number.
    pub fn own_damping_ratio(&self) -> Option<f64> {
        match &self.shape {
            Shape::Dressed(mode) => Some(mode.damping_ratio),
            Shape::Beam(_) | Shape::Plate { .. } => None,
        }
    }

    /// Whether the panel moves without strain.
    pub fn is_rigid(&self) -> bool {
        self.angular_frequency() == 0.0
    }

    /// Nodal lines crossed along x and along y between the edges; a beam has none along y.
    pub fn nodes(&self) -> [usize; 2] {
        match &self.shape {
            Shape::Dressed(mode) => mode.nodes(),
            Shape::Beam(_) | Shape::Plate { .. } => self.nodes,
        }
    }

    /// The name of a plate's mode; a beam's modes need none beside their nodes.
    pub fn name(&self) -> Option<ModeName> {
        match &self.shape {
            Shape::Beam(_) => None,
            Shape::Dressed(mode) => mode.name(),
            Shape::Plate { name, .. } => Some(*name),
        }
    }

    /// Mass-normalised deflection $W$ \[kg^-1/2\] at a place on the piece.
    pub fn deflection(&self, place: Place) -> f64 {
        match &self.shape {
            Shape::Beam(mode) => mode.deflection(place.x),
            Shape::Dressed(mode) => mode.deflection(place),
            Shape::Plate { plate, mode, .. } => mode.deflection(plate.as_ref(), place),
        }
    }

    /// `number` counts flexible modes from 1, and is 0 for rigid ones.
    pub(crate) fn of_beam(mode: BeamMode, length: f64, number: usize) -> Self {
        // Mode m has at most m + 1 nodes; eight points between two of them part every pair.
        let points = 8 * (number + 2);
        let place = |index: usize| length * ((index as f64 + 0.5) / points as f64 - 0.5);
        let deflections: Vec<f64> = (0..points).map(|index| mode.deflection(place(index))).collect();
        Self { nodes: [crossings(&deflections), 0], shape: Shape::Beam(mode) }
    }

    /// A mode of a panel with effects; its nodes are counted when they are asked for.
    pub(crate) fn of_dressed(mode: DressedMode) -> Self {
        Self { nodes: [0, 0], shape: Shape::Dressed(mode) }
    }

    pub(crate) fn of_plate(plate: &Arc<MindlinPlate>, mode: RitzMode) -> Self {
        let name = plate.mode_name(&mode);
        Self { nodes: name.nodes, shape: Shape::Plate { plate: Arc::clone(plate), mode, name } }
    }
}

/// How often a row of deflections changes its sign.
pub(crate) fn crossings(deflections: &[f64]) -> usize {
    let crosses = |pair: &&[f64]| matches!(pair, [left, right] if (*left < 0.0) != (*right < 0.0));
    deflections.windows(2).filter(crosses).count()
}

impl NaturalMode for PanelMode {
    fn angular_frequency(&self) -> f64 {
        PanelMode::angular_frequency(self)
    }

    fn deflection_at(&self, place: Place) -> f64 {
        self.deflection(place)
    }

    fn own_damping(&self) -> Option<f64> {
        self.own_damping_ratio()
    }

    fn damping_coupling(&self) -> &[f64] {
        match &self.shape {
            Shape::Dressed(mode) => &mode.damping_coupling,
            Shape::Beam(_) | Shape::Plate { .. } => &[],
        }
    }
}
