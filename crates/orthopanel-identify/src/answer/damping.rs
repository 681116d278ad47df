//! The damping ratios of a panel's modes, from the measured poles.

use std::f64::consts::TAU;

use orthopanel_model::{Damping, ModalModel};

use crate::accelerance_fit::ResonanceStart;
use crate::measured::MeasuredModes;

/// Where no pole tells one.
const WITHOUT_POLES: f64 = 0.005;
/// Part of a pole's damping that is left to the panel at least, whatever dashpots and windows bring.
const LEAST: f64 = 1e-2;
/// A resonance further than this from every mode belongs to none.
const REACH: f64 = 0.04;

/// Damping ratios of the flexible modes, with their standard deviations where a pole tells them.
pub(super) struct TracedDamping {
    pub damping: Damping,
    pub std: Vec<Option<f64>>,
}

impl TracedDamping {
    /// `modes` are those that damping belongs to, without point elements, with force and response of record $r$ as ports $r$; `of_effects` is what
    /// effects bring to each pole. Modes without a pole, as near the end of the band, get what their resonance in the lines shows, and all others
    /// what is usual for these.
    pub(super) fn of(
        measured: &MeasuredModes,
        modes: &ModalModel,
        (of_effects, resonances): (&[f64], Option<&ResonanceStart>),
    ) -> Self {
        let mut known: Vec<Option<(f64, Option<f64>)>> = Vec::new();
        let frequencies: Vec<f64> = modes.flexible().map(|mode| mode.angular_frequency / TAU).collect();
        if let Some(resonances) = resonances {
            let nearest = resonances.nearest_to(&frequencies, REACH).into_iter();
            known.extend(nearest.map(|found| found.map(|(_, zeta)| (zeta, None))));
        }
        let damped = |pole: &usize| measured.poles[*pole].damping_ratio.is_some();
        let partners = measured.matched(modes);
        for (place, pole) in (0..measured.poles.len()).filter(damped).enumerate() {
            let (Some(zeta), Some(partner)) = (measured.poles[pole].damping_ratio, partners[pole]) else { continue };
            // The covariance is that of the logarithm, after those of the frequencies.
            let at = measured.poles.len() + place;
            let std = zeta * measured.covariance[(at, at)].sqrt();
            let own = (zeta - of_effects.get(pole).copied().unwrap_or(0.0)).max(LEAST * zeta);
            known.resize(known.len().max(partner.mode), None);
            known[partner.mode - 1] = Some((own, Some(std)));
        }
        let logs: Vec<f64> = known.iter().flatten().map(|(zeta, _)| zeta.ln()).collect();
        let usual = if logs.is_empty() { WITHOUT_POLES } else { (logs.iter().sum::<f64>() / logs.len() as f64).exp() };
        let ratios = known.iter().map(|one| one.map_or(usual, |(zeta, _)| zeta)).collect();
        let std = known.into_iter().map(|one| one.and_then(|(_, std)| std)).collect();
        Self { damping: Damping { ratios, beyond: usual }, std }
    }
}
