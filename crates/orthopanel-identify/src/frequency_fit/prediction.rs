//! Natural frequencies of a structure and how they follow its constants.

use orthopanel_model::{BeamConstants, Boundary, ExactBeam, ModelError, Piece};

/// One mode at given constants.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Prediction {
    /// Natural frequency \[Hz\].
    pub frequency: f64,
    /// $\partial\ln f/\partial\ln c_j$ for each constant.
    pub log_sensitivity: [f64; 2],
}

/// The first `count` natural frequencies \[Hz\] alone.
pub(super) fn beam_frequencies(
    piece: &Piece,
    boundary: Boundary,
    [e_x, g_zx]: [f64; 2],
    count: usize,
) -> Result<Vec<f64>, ModelError> {
    Ok(ExactBeam::new(piece, boundary, BeamConstants { e_x, g_zx })?.natural_frequencies(count))
}

/// The first `count` flexible modes of the beam at constants ($E_x$, $G_{zx}$).
pub(super) fn beam_predictions(
    piece: &Piece,
    boundary: Boundary,
    [e_x, g_zx]: [f64; 2],
    count: usize,
) -> Result<Vec<Prediction>, ModelError> {
    let beam = ExactBeam::new(piece, boundary, BeamConstants { e_x, g_zx })?;
    let predictions = beam.flexible_modes().take(count).map(|mode| {
        let [by_e, by_g] = mode.sensitivity();
        let twice_omega2 = 2.0 * mode.angular_frequency().powi(2);
        Prediction {
            frequency: mode.frequency(),
            log_sensitivity: [by_e * e_x / twice_omega2, by_g * g_zx / twice_omega2],
        }
    });
    Ok(predictions.collect())
}
