//! The damping ratios of a panel's modes, from the measured poles.

use orthopanel_model::{Damping, ModalModel};

use crate::measured::MeasuredModes;

/// Where no pole tells one.
const UNTOLD: f64 = 0.005;
/// Part of a pole's damping that is left to the panel at least, whatever dashpots and windows bring.
const LEAST: f64 = 1e-2;

/// Damping ratios of the flexible modes, with their standard deviations where a pole tells them.
pub(super) struct TracedDamping {
    pub damping: Damping,
    pub std: Vec<Option<f64>>,
}

impl TracedDamping {
    /// `modes` are those that damping belongs to, without point elements, with force and response of record $r$ as ports $r$; `of_effects` is what
    /// effects bring to each pole. Modes without a pole, and all beyond, get the geometric mean.
    pub(super) fn of(measured: &MeasuredModes, modes: &ModalModel, of_effects: &[f64]) -> Self {
        let mut told: Vec<Option<(f64, f64)>> = Vec::new();
        let damped = |pole: &usize| measured.poles[*pole].damping_ratio.is_some();
        let places = (0..measured.poles.len()).filter(damped).enumerate();
        let partners = measured.matched(modes);
        for (place, pole) in places {
            let (Some(zeta), Some(partner)) = (measured.poles[pole].damping_ratio, partners[pole]) else { continue };
            // The covariance is that of the logarithm, after those of the frequencies.
            let at = measured.poles.len() + place;
            let std = zeta * measured.covariance[(at, at)].sqrt();
            let own = (zeta - of_effects.get(pole).copied().unwrap_or(0.0)).max(LEAST * zeta);
            told.resize(told.len().max(partner.mode), None);
            told[partner.mode - 1] = Some((own, std));
        }
        let logs: Vec<f64> = told.iter().flatten().map(|(zeta, _)| zeta.ln()).collect();
        let usual = if logs.is_empty() { UNTOLD } else { (logs.iter().sum::<f64>() / logs.len() as f64).exp() };
        let ratios = told.iter().map(|known| known.map_or(usual, |(zeta, _)| zeta)).collect();
        let std = told.into_iter().map(|known| known.map(|(_, std)| std)).collect();
        Self { damping: Damping { ratios, beyond: usual }, std }
    }
}
