//! A plate that was traced in records, as a panel of its own.

use orthopanel_model::{MindlinPlate, ModelError, PanelModel, RitzMode, Structure, ritz_modes};

use crate::outcome::TracedEffect;
use crate::plate_of_ratios;

/// Modes of the plate among which those that the records show are looked for, for each of these.
const EACH: usize = 4;

/// Turns the panel's beam into the plate that `width-coupling` stands for, as [`plate_of_ratios::widen`] does. Damping ratios are
/// of the modes that the records' places show, in rising order; the plate's other modes, which no record shows, get the usual
/// one.
///
/// # Errors
/// What the plate refuses.
pub(super) fn widen(panel: &mut PanelModel, plate: &TracedEffect) -> Result<(), ModelError> {
    let values = plate_of_ratios::widen(panel, plate);
    let mut places = panel.ports.forces.iter().chain(&panel.ports.responses);
    if places.any(|place| place.y != 0.0) {
        return Ok(());
    }
    let seen = std::mem::take(&mut panel.damping.ratios);
    let wanted = EACH * seen.len().max(1);
    let (whole, count) = match MindlinPlate::with_basis_for(&panel.piece, panel.boundary, &values, wanted) {
        Err(ModelError::BasisTooSmall { available, .. }) => {
            (MindlinPlate::with_basis_for(&panel.piece, panel.boundary, &values, available)?, available)
        }
        plate => (plate?, wanted),
    };
    let middle = whole.only_with_nodes(&[[0, 0], [1, 0]]);
    let frequencies = |plate: &MindlinPlate, count: usize| -> Result<Vec<f64>, ModelError> {
        let modes: Vec<RitzMode> = ritz_modes(plate, &values, count)?;
        Ok(modes.iter().map(|mode| mode.angular_frequency).filter(|omega| *omega > 0.0).collect())
    };
    let shown = frequencies(&middle, seen.len().min(middle.resolved_modes()))?;
    for omega in frequencies(&whole, count)? {
        // The same mode on the same functions, solved in another company of blocks: equal but for rounding.
        let mode = shown.iter().position(|own| (own / omega - 1.0).abs() < 1e-9);
        let ratio = mode.and_then(|mode| seen.get(mode)).copied().unwrap_or(panel.damping.beyond);
        panel.damping.ratios.push(ratio);
        if mode == Some(seen.len().saturating_sub(1)) {
            break;
        }
    }
    Ok(())
}
