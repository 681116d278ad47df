//! A recorded beam: exact modes to match, a Ritz basis with derivatives to sum.

use faer::Mat;
use orthopanel_model::{
    BeamConstants, BeamMode, Boundary, ExactBeam, ModelError, Piece, Place, SensitiveModes, StaticFlexibility,
    Structure, TimoshenkoBeam, sensitive_modes,
};

use crate::structures::{ModeSynthesis, RecordedStructure, SeenMode};

pub(super) struct RecordedBeam {
    pub piece: Piece,
    pub boundary: Boundary,
}

/// Most modes that are looked at.
const MOST_MODES: usize = 400;

impl RecordedStructure for RecordedBeam {
    fn modes_below(&self, values: &[f64], limit: f64, pairs: &[(Place, Place)]) -> Result<Vec<SeenMode>, ModelError> {
        let &[e_x, g_zx] = values else {
            return Err(ModelError::ConstantCount { found: values.len(), expected: 2 });
        };
        let beam = ExactBeam::new(&self.piece, self.boundary, BeamConstants { e_x, g_zx })?;
        let rigid = self.boundary.rigid_modes();
        let modes = beam.flexible_modes().take(MOST_MODES).take_while(|mode| mode.frequency() < limit);
        let seen = |(index, mode): (usize, BeamMode)| SeenMode {
            frequency: mode.frequency(),
            by_constant: mode.sensitivity().iter().map(|by| by / (2.0 * mode.angular_frequency().powi(2))).collect(),
            nodes: [index + rigid, 0],
            products: pairs
                .iter()
                .map(|(force, response)| mode.deflection(force.x) * mode.deflection(response.x))
                .collect(),
        };
        Ok(modes.enumerate().map(seen).collect())
    }

    fn reach(&self) -> f64 {
        2.5
    }

    fn synthesis(&self, _: &[f64], count: usize) -> Result<Box<dyn ModeSynthesis>, ModelError> {
        Ok(Box::new(BeamSynthesis {
            // Twice as many terms as modes, and some: the sum's modes then stand to rounding.
            beam: TimoshenkoBeam::new(&self.piece, self.boundary, 2 * count + 24)?,
            flexibility: StaticFlexibility::new(&self.piece, self.boundary)?,
        }))
    }
}

struct BeamSynthesis {
    beam: TimoshenkoBeam,
    flexibility: StaticFlexibility,
}

impl ModeSynthesis for BeamSynthesis {
    fn modes(&self, values: &[f64], count: usize, places: &[Place]) -> Result<SensitiveModes, ModelError> {
        sensitive_modes(&self.beam, values, count, places)
    }

    fn flexibility(
        &self,
        _: &SensitiveModes,
        places: &[Place],
        (first, second): (usize, usize),
        values: &[f64],
    ) -> (f64, Vec<f64>) {
        let (value, by) = self.flexibility.between(places[first].x, places[second].x, values[0], values[1]);
        (value, by.to_vec())
    }

    fn coefficient_derivatives(&self, values: &[f64]) -> Result<Mat<f64>, ModelError> {
        self.beam.coefficient_derivatives(values)
    }
}
