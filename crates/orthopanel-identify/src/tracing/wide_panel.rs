//! A plate that was traced in records, as a panel of its own.

use orthopanel_model::{
    Estimate, MindlinPlate, ModelError, PLATE_CONSTANTS, PanelModel, RitzMode, Structure, StructureKind, ritz_modes,
};

use crate::outcome::TracedEffect;

/// Modes of the plate among which those that the records show are looked for, for each of these.
const EACH: usize = 4;

/// Turns the panel's beam into the plate that `width-coupling` stands for, $E_y = (E_y/E_x)E_x$ and so on.
///
/// The ratios' standard deviations and those of $E_x$, $G_{zx}$ are added as those of independent numbers. Damping ratios are
/// of the modes that the records' places show, in rising order; the plate's other modes, which no record shows, get the usual
/// one.
///
/// # Errors
/// What the plate refuses.
pub(super) fn widen(panel: &mut PanelModel, plate: &TracedEffect) -> Result<(), ModelError> {
    let untold = Estimate { value: 0.0, std: None };
    let beam = |name: &str| panel.constants.get(name).copied().unwrap_or(untold);
    let (e_x, g_zx) = (beam("e_x"), beam("g_zx"));
    let ratio =
        |at: usize| plate.parameters.get(at).and_then(|parameter| parameter.values.first()).copied().unwrap_or(untold);
    let times = |ratio: Estimate, of: Estimate| {
        let part = |one: Estimate| one.std.map(|std| (std / one.value).powi(2));
        let value = ratio.value * of.value;
        Estimate { value, std: part(ratio).zip(part(of)).map(|(a, b)| value * (a + b).sqrt()) }
    };
    let told = [e_x, times(ratio(0), e_x), ratio(1), times(ratio(2), e_x), times(ratio(3), g_zx), g_zx];
    panel.structure = StructureKind::MindlinPlate;
    panel.constants =
        PLATE_CONSTANTS.iter().zip(told).map(|(constant, told)| (constant.name.to_owned(), told)).collect();
    let values = told.map(|estimate| estimate.value);
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
