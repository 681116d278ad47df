//! The plate that a beam's constants and the ratios of `width-coupling` make.

use orthopanel_model::{CorrelationMatrix, Estimate, PLATE_CONSTANTS, PanelModel, StructureKind};

use crate::traced_effect::TracedEffect;

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
    panel.correlation = correlation(panel, &told);
    panel.structure = StructureKind::MindlinPlate;
    panel.constants =
        PLATE_CONSTANTS.iter().zip(told).map(|(constant, told)| (constant.name.to_owned(), told)).collect();
    told.map(|estimate| estimate.value)
}

/// How the six constants of a beam's plate go together: a multiple of $E_x$ or $G_{zx}$ moves with it, and these two as they did.
fn correlation(beam: &PanelModel, told: &[Estimate; 6]) -> Option<CorrelationMatrix> {
    // The constant of the beam that each is a multiple of.
    const OF: [Option<&str>; 6] = [Some("e_x"), Some("e_x"), None, Some("e_x"), Some("g_zx"), Some("g_zx")];
    let relative = |estimate: &Estimate| estimate.std.map(|std| std / estimate.value);
    let known: Vec<usize> = (0..told.len()).filter(|&place| told[place].std.is_some_and(|std| std > 0.0)).collect();
    let names = known.iter().map(|&place| PLATE_CONSTANTS[place].name.to_owned()).collect();
    let of_beam = |name: &str| beam.constants.get(name).and_then(relative).unwrap_or(0.0);
    CorrelationMatrix::between(names, |i, j| {
        let (i, j) = (known[i], known[j]);
        let (Some(one), Some(other)) = (OF[i], OF[j]) else { return 0.0 };
        let together = match &beam.correlation {
            _ if one == other => 1.0,
            Some(matrix) => matrix.of(one, other),
            None => 0.0,
        };
        let size = |place: usize| relative(&told[place]).unwrap_or(f64::INFINITY);
        together * of_beam(one) * of_beam(other) / (size(i) * size(j))
    })
}
