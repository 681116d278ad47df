//! Measured modes of the Mindlin plate, told by their nodal lines.

use orthopanel_model::{Boundary, MindlinPlate, ModelError, Piece, Structure, ritz_modes};

use super::{MeasuredModes, Prediction};
use crate::IdentifyError;

/// Modes of a plate by their nodal lines.
#[derive(Debug)]
pub(super) struct PlateModes {
    plate: MindlinPlate,
    nodes: Vec<[usize; 2]>,
    /// Modes solved for: those measured lie among them.
    reach: usize,
}

/// Modes solved for beyond those that lie below the last measured one if all pairs of nodes exist.
const SPARE_MODES: usize = 6;

impl PlateModes {
    pub(super) fn new(piece: &Piece, boundary: Boundary, nodes: Vec<[usize; 2]>) -> Result<Self, IdentifyError> {
        let [most_x, most_y] = [0, 1].map(|axis| nodes.iter().map(|pair| pair[axis]).max().unwrap_or(0));
        let plate = MindlinPlate::new(piece, boundary, [most_x + 11, (most_y + 6).max(7)])?;
        let reach = ((most_x + 2) * (most_y + 3) + SPARE_MODES).min(plate.resolved_modes());
        Ok(Self { plate, nodes, reach })
    }
}

impl MeasuredModes for PlateModes {
    fn predict(&self, values: &[f64]) -> Result<Vec<Prediction>, ModelError> {
        let modes = ritz_modes(&self.plate, values, self.reach)?;
        let by_constants = self.plate.coefficient_derivatives(values)?;
        let flexible: Vec<_> = modes.iter().filter(|mode| mode.angular_frequency > 0.0).collect();
        let prediction = |&nodes: &[usize; 2]| {
            let overlaps = flexible.iter().enumerate().map(|(index, mode)| (index, self.plate.overlap(mode, nodes)));
            let (index, _) = overlaps.max_by(|a, b| a.1.total_cmp(&b.1))?;
            let mode = flexible[index];
            let by_coefficient = mode.coefficient_sensitivity(&self.plate);
            let twice_omega2 = 2.0 * mode.angular_frequency.powi(2);
            let by = |constant: usize| {
                let sum: f64 = by_coefficient.iter().enumerate().map(|(i, by)| by * by_constants[(i, constant)]).sum();
                sum / twice_omega2
            };
            Some(Prediction {
                mode: index + 1,
                frequency: mode.angular_frequency / std::f64::consts::TAU,
                by_constant: (0..values.len()).map(by).collect(),
            })
        };
        let predictions: Option<Vec<Prediction>> = self.nodes.iter().map(prediction).collect();
        predictions.ok_or(ModelError::BasisTooSmall { asked: self.nodes.len(), available: flexible.len() })
    }

    fn nodes(&self) -> &[[usize; 2]] {
        &self.nodes
    }
}
