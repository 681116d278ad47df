//! Constants from matched poles: eq. 22 over the modes that the records show.

use faer::Mat;
use orthopanel_model::{BEAM_CONSTANTS, BeamConstants, ExactBeam, ModelError};

use super::matching::{Matching, PiecePoles};
use crate::least_squares::{Linearised, Minimum, Stuck, levenberg_marquardt};

/// Minimises the relative misfit of the matched poles over the free constants; the parameters are their logarithms.
pub(super) fn fit_constants(
    pieces: &[PiecePoles],
    matching: &Matching,
    held: [Option<f64>; 2],
) -> Result<Minimum, Stuck<ModelError>> {
    let free: Vec<usize> = (0..2).filter(|&index| held[index].is_none()).collect();
    let start: Vec<f64> = free.iter().map(|&index| matching.constants[index].ln()).collect();
    let bounds: Vec<(f64, f64)> =
        free.iter().map(|&index| (BEAM_CONSTANTS[index].low.ln(), BEAM_CONSTANTS[index].high.ln())).collect();
    let linearise = |logs: &[f64]| {
        let mut values = held.map(|value| value.unwrap_or(f64::NAN));
        for (&index, log) in free.iter().zip(logs) {
            values[index] = log.exp().clamp(BEAM_CONSTANTS[index].low, BEAM_CONSTANTS[index].high);
        }
        let (mut residuals, mut rows) = (Vec::new(), Vec::new());
        for (piece, matched) in pieces.iter().zip(&matching.modes) {
            let highest = matched.iter().flatten().max().map_or(0, |mode| mode + 1);
            let constants = BeamConstants { e_x: values[0], g_zx: values[1] };
            let beam = ExactBeam::new(&piece.sizes, piece.boundary, constants)?;
            let modes: Vec<_> = beam.flexible_modes().take(highest).collect();
            for (frequency, mode) in piece.frequencies.iter().zip(matched) {
                let Some(mode) = mode.and_then(|mode| modes.get(mode)) else { continue };
                let ratio = mode.frequency() / frequency;
                let by = mode.sensitivity();
                let twice_omega2 = 2.0 * mode.angular_frequency().powi(2);
                residuals.push(ratio - 1.0);
                rows.push([0, 1].map(|index| ratio * by[index] * values[index] / twice_omega2));
            }
        }
        let jacobian = Mat::from_fn(rows.len(), free.len(), |i, j| rows[i][free[j]]);
        Ok(Linearised { residuals, jacobian }.quadratic())
    };
    levenberg_marquardt(linearise, &start, &bounds)
}
