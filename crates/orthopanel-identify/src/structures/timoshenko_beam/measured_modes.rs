//! Measured modes of the exact beam.

use orthopanel_model::{BeamConstants, Boundary, ExactBeam, ModelError, Piece};

use crate::IdentifyError;
use crate::structures::{MeasuredModes, Prediction, SpectrumLine};

/// Bending modes of a beam.
#[derive(Debug)]
pub(super) struct BeamModes {
    piece: Piece,
    boundary: Boundary,
    nodes: Vec<[usize; 2]>,
    /// Position of each among the flexible modes, from 0.
    positions: Vec<usize>,
    /// One more than the highest position.
    reach: usize,
}

impl BeamModes {
    pub(super) fn new(piece: &Piece, boundary: Boundary, nodes: Vec<[usize; 2]>) -> Result<Self, IdentifyError> {
        let rigid = boundary.rigid_modes();
        let position = |&[x, y]: &[usize; 2]| {
            if y > 0 {
                let message = format!(
                    "shape [{x}, {y}]: a beam has no nodal lines along its length; write structure = \"mindlin-plate\" \
                     at the top of the test file"
                );
                return Err(IdentifyError::Unsupported(message));
            }
            x.checked_sub(rigid).ok_or_else(|| {
                let message = format!("shape [{x}, 0] is a rigid motion: flexible modes have {rigid} nodes or more");
                IdentifyError::Unsupported(message)
            })
        };
        let positions = nodes.iter().map(position).collect::<Result<Vec<_>, _>>()?;
        let reach = positions.iter().max().map_or(0, |highest| highest + 1);
        Ok(Self { piece: *piece, boundary, nodes, positions, reach })
    }

    fn beam(&self, values: &[f64]) -> Result<ExactBeam, ModelError> {
        let &[e_x, g_zx] = values else {
            return Err(ModelError::ConstantCount { found: values.len(), expected: 2 });
        };
        ExactBeam::new(&self.piece, self.boundary, BeamConstants { e_x, g_zx })
    }
}

impl MeasuredModes for BeamModes {
    fn frequencies(&self, values: &[f64]) -> Result<Vec<f64>, ModelError> {
        let frequencies = self.beam(values)?.natural_frequencies(self.reach);
        Ok(self.positions.iter().map(|&position| frequencies[position]).collect())
    }

    fn predict(&self, values: &[f64]) -> Result<Vec<Prediction>, ModelError> {
        let modes: Vec<_> = self.beam(values)?.flexible_modes().take(self.reach).collect();
        let prediction = |&position: &usize| {
            let mode = &modes[position];
            let twice_omega2 = 2.0 * mode.angular_frequency().powi(2);
            Prediction {
                frequency: mode.frequency(),
                by_constant: mode.sensitivity().iter().map(|by| by / twice_omega2).collect(),
                share: 1.0,
            }
        };
        Ok(self.positions.iter().map(prediction).collect())
    }

    fn nodes(&self) -> &[[usize; 2]] {
        &self.nodes
    }

    fn spectrum(&self, values: &[f64]) -> Result<Vec<SpectrumLine>, ModelError> {
        let frequencies = self.beam(values)?.natural_frequencies(self.reach);
        let rigid = self.boundary.rigid_modes();
        let line = |(index, frequency)| SpectrumLine { frequency, nodes: [index + rigid, 0] };
        Ok(frequencies.into_iter().enumerate().map(line).collect())
    }
}
