//! The plate that a beam's constants and the ratios of `width-coupling` make.

use orthopanel_model::{Estimate, PLATE_CONSTANTS, PanelModel, StructureKind};

use crate::outcome::TracedEffect;

/// Turns the panel's beam into the plate whose ratios an effect holds, $E_y = (E_y/E_x)E_x$ and so on.
///
/// Gives the six constants in the order of [`PLATE_CONSTANTS`]. The ratios' standard deviations and those of $E_x$, $G_{zx}$ are added as those of independent numbers.
pub(crate) fn widen(panel: &mut PanelModel, plate: &TracedEffect) -> [f64; 6] {
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
    told.map(|estimate| estimate.value)
}
