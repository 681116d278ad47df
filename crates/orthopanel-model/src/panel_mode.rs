//! One mode of a panel, whatever its structure.

use std::sync::{Arc, OnceLock};

use crate::dense::dot;
use crate::effects::CoupledMode;
use crate::nodes::crossings;
use crate::structure_modes::NaturalMode;
use crate::{BeamMode, MindlinPlate, ModeName, Place, RitzMode, Structure};

/// A mode of a panel, whatever its structure.
#[derive(Debug, Clone)]
pub struct PanelMode {
    shape: Shape,
}

/// Nodes and names cost more than modes: they are told once they are asked for.
#[derive(Debug, Clone)]
enum Shape {
    /// `number` counts flexible modes from 1, and is 0 for rigid ones.
    Beam {
        mode: BeamMode,
        length: f64,
        number: usize,
    },
    Coupled(CoupledMode),
    Plate {
        plate: Arc<MindlinPlate>,
        mode: RitzMode,
        name: OnceLock<ModeName>,
    },
}

impl PanelMode {
    /// Natural angular frequency $\omega$ \[rad/s\]; zero for a rigid mode.
    pub fn angular_frequency(&self) -> f64 {
        match &self.shape {
            Shape::Beam { mode, .. } => mode.angular_frequency(),
            Shape::Coupled(mode) => mode.angular_frequency,
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
            Shape::Coupled(mode) => Some(mode.damping_ratio),
            Shape::Beam { .. } | Shape::Plate { .. } => None,
        }
    }

    /// Whether the panel moves without strain.
    pub fn is_rigid(&self) -> bool {
        self.angular_frequency() == 0.0
    }

    /// Nodal lines crossed along x and along y between the edges; a beam has none along y.
    pub fn nodes(&self) -> [usize; 2] {
        match &self.shape {
            Shape::Coupled(mode) => mode.nodes(),
            Shape::Beam { mode, length, number } => [beam_nodes(mode, *length, *number), 0],
            Shape::Plate { plate, mode, name } => name.get_or_init(|| plate.mode_name(mode)).nodes,
        }
    }

    /// The name of a plate's mode; a beam's modes need none beside their nodes.
    pub fn name(&self) -> Option<ModeName> {
        match &self.shape {
            Shape::Beam { .. } => None,
            Shape::Coupled(mode) => mode.name(),
            Shape::Plate { plate, mode, name } => Some(*name.get_or_init(|| plate.mode_name(mode))),
        }
    }

    /// Mass-normalised deflection $W$ \[kg^-1/2\] at a place on the piece.
    pub fn deflection(&self, place: Place) -> f64 {
        match &self.shape {
            Shape::Beam { mode, .. } => mode.deflection(place.x),
            Shape::Coupled(mode) => mode.deflection(place),
            Shape::Plate { plate, mode, .. } => mode.deflection(plate.as_ref(), place),
        }
    }

    /// `number` counts flexible modes from 1, and is 0 for rigid ones.
    pub(crate) fn of_beam(mode: BeamMode, length: f64, number: usize) -> Self {
        Self { shape: Shape::Beam { mode, length, number } }
    }

    pub(crate) fn of_coupled(mode: CoupledMode) -> Self {
        Self { shape: Shape::Coupled(mode) }
    }

    pub(crate) fn of_plate(plate: &Arc<MindlinPlate>, mode: RitzMode) -> Self {
        Self { shape: Shape::Plate { plate: Arc::clone(plate), mode, name: OnceLock::new() } }
    }
}

fn beam_nodes(mode: &BeamMode, length: f64, number: usize) -> usize {
    // Mode m has at most m + 1 nodes; eight points between two of them part every pair.
    let points = 8 * (number + 2);
    let place = |index: usize| length * ((index as f64 + 0.5) / points as f64 - 0.5);
    let deflections: Vec<f64> = (0..points).map(|index| mode.deflection(place(index))).collect();
    crossings(&deflections)
}

impl NaturalMode for PanelMode {
    fn angular_frequency(&self) -> f64 {
        PanelMode::angular_frequency(self)
    }

    fn deflection_at(&self, place: Place) -> f64 {
        self.deflection(place)
    }

    fn deflections_at(modes: &[Self], place: Place) -> Vec<f64> {
        // What a basis does there is worked out once for all modes on it.
        let mut modified: Option<(&CoupledMode, Vec<f64>)> = None;
        let mut plates: Option<(&Arc<MindlinPlate>, Vec<Vec<f64>>)> = None;
        let mut deflections = Vec::with_capacity(modes.len());
        for PanelMode { shape } in modes {
            deflections.push(match shape {
                Shape::Beam { mode, .. } => mode.deflection(place.x),
                Shape::Coupled(mode) => {
                    if !modified.as_ref().is_some_and(|(other, _)| other.is_beside(mode)) {
                        modified = Some((mode, mode.basis_at(place)));
                    }
                    modified.as_ref().map_or(f64::NAN, |(_, basis)| mode.in_basis(basis))
                }
                Shape::Plate { plate, mode, .. } => {
                    if !plates.as_ref().is_some_and(|(other, _)| Arc::ptr_eq(other, plate)) {
                        let rows = (0..plate.blocks().len()).map(|block| plate.shape_row(block, place));
                        plates = Some((plate, rows.collect()));
                    }
                    let row = plates.as_ref().and_then(|(_, rows)| rows.get(mode.block));
                    row.map_or(f64::NAN, |row| dot(row, &mode.coordinates))
                }
            });
        }
        deflections
    }

    fn own_damping(&self) -> Option<f64> {
        self.own_damping_ratio()
    }

    fn damping_coupling(&self) -> &[f64] {
        match &self.shape {
            Shape::Coupled(mode) => &mode.damping_coupling,
            Shape::Beam { .. } | Shape::Plate { .. } => &[],
        }
    }
}
