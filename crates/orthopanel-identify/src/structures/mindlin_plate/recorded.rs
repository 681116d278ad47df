//! A recorded plate: modes told by their shape, and summed on the plate's own basis.

use std::sync::Arc;

use faer::Mat;
use orthopanel_model::{
    Boundary, MindlinPlate, ModeSensitivity, ModelError, Piece, Place, ReducedStructure, RitzMode, SensitiveModes,
    Structure, ritz_modes, sensitive_modes,
};

use crate::structures::{ModeSynthesis, RecordedStructure, SeenMode};

pub(super) struct RecordedPlate {
    pub piece: Piece,
    pub boundary: Boundary,
}

/// Fewest modes asked for, and most: more of a plate's modes than these overlap, and no record parts them.
const MODES: (usize, usize) = (24, 150);

impl RecordedPlate {
    /// The smallest basis that reaches `limit` \[Hz\], and its modes; the largest one where none reaches so far.
    fn modes(&self, values: &[f64], limit: f64) -> Result<(MindlinPlate, Vec<RitzMode>), ModelError> {
        let estimate = MindlinPlate::estimated_count(&self.piece, self.boundary, values, limit)?;
        let mut count = (estimate + estimate / 8 + 4).clamp(MODES.0, MODES.1);
        let mut last = None;
        loop {
            let plate = match MindlinPlate::with_basis_for(&self.piece, self.boundary, values, count) {
                Ok(plate) => plate,
                Err(ModelError::BasisTooSmall { available, .. }) if last.is_none() && available > 0 => {
                    count = available;
                    MindlinPlate::with_basis_for(&self.piece, self.boundary, values, available)?
                }
                Err(error) => return last.ok_or(error),
            };
            let modes = ritz_modes(&plate, values, count)?;
            let highest = modes.last().map_or(f64::INFINITY, |mode| mode.angular_frequency);
            if highest > limit * std::f64::consts::TAU || count >= MODES.1 {
                return Ok((plate, modes));
            }
            last = Some((plate, modes));
            count = (count + count / 2).min(MODES.1);
        }
    }
}

impl RecordedStructure for RecordedPlate {
    fn modes_below(&self, values: &[f64], limit: f64, pairs: &[(Place, Place)]) -> Result<Vec<SeenMode>, ModelError> {
        let (plate, modes) = self.modes(values, limit)?;
        let by_constants = plate.coefficient_derivatives(values)?;
        let below = limit * std::f64::consts::TAU;
        let flexible = modes.iter().filter(|mode| mode.angular_frequency > 0.0 && mode.angular_frequency < below);
        let seen = flexible.map(|mode| SeenMode {
            frequency: mode.angular_frequency / std::f64::consts::TAU,
            by_constant: {
                let by_coefficient = mode.coefficient_sensitivity(&plate);
                let by = |constant: usize| -> f64 {
                    by_coefficient.iter().enumerate().map(|(i, by)| by * by_constants[(i, constant)]).sum()
                };
                (0..values.len()).map(|constant| by(constant) / (2.0 * mode.angular_frequency.powi(2))).collect()
            },
            nodes: plate.mode_name(mode).nodes,
            products: pairs
                .iter()
                .map(|&(force, response)| mode.deflection(&plate, force) * mode.deflection(&plate, response))
                .collect(),
        });
        Ok(seen.collect())
    }

    // The density of a plate's modes does not fall with frequency, so a sum as far as a beam's would hold hundreds.
    fn reach(&self) -> f64 {
        1.6
    }

    fn synthesis(&self, values: &[f64], count: usize) -> Result<Box<dyn ModeSynthesis>, ModelError> {
        // A basis for three times the modes that are summed: those beyond stand for the static part of the rest, and what
        // that lacks moves a constant that hardly shows, as E_y, by five of its deviations where the basis just holds them.
        let plate = MindlinPlate::with_basis_for(&self.piece, self.boundary, values, (3 * count).max(3 * MODES.0))?;
        Ok(Box::new(PlateSynthesis { plate: Arc::new(plate) }))
    }
}

struct PlateSynthesis {
    plate: Arc<MindlinPlate>,
}

impl ModeSynthesis for PlateSynthesis {
    fn modes(&self, values: &[f64], count: usize, places: &[Place]) -> Result<SensitiveModes, ModelError> {
        sensitive_modes(self.plate.as_ref(), values, count, places)
    }

    fn flexibility(&self, modes: &SensitiveModes, _: &[Place], pair: (usize, usize), _: &[f64]) -> (f64, Vec<f64>) {
        sum_over_modes(modes, pair)
    }

    fn coefficient_derivatives(&self, values: &[f64]) -> Result<Mat<f64>, ModelError> {
        self.plate.coefficient_derivatives(values)
    }

    fn near(
        &self,
        values: &[f64],
        count: usize,
        places: &[Place],
    ) -> Result<Option<Box<dyn ModeSynthesis>>, ModelError> {
        let plate = ReducedStructure::answering(Arc::clone(&self.plate), values, count, places)?;
        Ok(Some(Box::new(NearbyPlate { plate })))
    }
}

/// The same near some values of the constants: on the modes there, what the constants change of them, and what forces at the
/// records' places do.
struct NearbyPlate {
    plate: ReducedStructure<MindlinPlate>,
}

impl ModeSynthesis for NearbyPlate {
    fn modes(&self, values: &[f64], count: usize, places: &[Place]) -> Result<SensitiveModes, ModelError> {
        sensitive_modes(&self.plate, values, count, places)
    }

    fn flexibility(&self, modes: &SensitiveModes, _: &[Place], pair: (usize, usize), _: &[f64]) -> (f64, Vec<f64>) {
        sum_over_modes(modes, pair)
    }

    fn coefficient_derivatives(&self, values: &[f64]) -> Result<Mat<f64>, ModelError> {
        self.plate.coefficient_derivatives(values)
    }
}

/// Static flexibility over all modes of the basis. A plate that shears is infinitely soft under a point force, so no basis holds
/// the driving point's; derivatives are those of the modes in the sum, which hold nearly all of it.
fn sum_over_modes(modes: &SensitiveModes, (first, second): (usize, usize)) -> (f64, Vec<f64>) {
    let summed = modes.flexible.iter().map(|mode| mode.shape[first] * mode.shape[second] / mode.omega2);
    let higher = modes.higher.iter().map(|(omega2, shape)| shape[first] * shape[second] / omega2);
    let coefficients = modes.flexible.first().map_or(0, |mode| mode.omega2_by.len());
    let by = (0..coefficients).map(|i| {
        let of_mode = |mode: &ModeSensitivity| {
            let by_product =
                mode.shape_by[i][first] * mode.shape[second] + mode.shape[first] * mode.shape_by[i][second];
            let product = mode.shape[first] * mode.shape[second];
            (by_product - product * mode.omega2_by[i] / mode.omega2) / mode.omega2
        };
        modes.flexible.iter().map(of_mode).sum()
    });
    (summed.chain(higher).sum(), by.collect())
}
