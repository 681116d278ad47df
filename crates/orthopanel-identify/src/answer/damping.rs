//! The damping ratios of a panel's modes, from the measured poles.

use std::f64::consts::TAU;

use orthopanel_model::{Damping, ModalModel};

use crate::identification::told;
use crate::measured::{MeasuredModes, Pole};

/// Where no pole tells one.
const WITHOUT_POLES: f64 = 0.005;
/// Part of a pole's damping that is left to the panel at least, whatever dashpots and windows bring.
const LEAST: f64 = 1e-2;
/// A pole further than this part of its frequency from a mode is another's.
const REACH: f64 = 0.04;

/// Damping ratios of the flexible modes, with their standard deviations where a pole tells them.
pub(super) struct TracedDamping {
    pub damping: Damping,
    pub std: Vec<Option<f64>>,
}

impl TracedDamping {
    /// `modes` are those that damping belongs to, without point elements, with force and response of record $r$ as ports $r$; `of_effects` is what
    /// effects bring to each pole. Modes without one, as near the end of the band, get the damping of the pole beside them that does not stand by
    /// itself, and all others what is usual for these.
    pub(super) fn of(measured: &MeasuredModes, modes: &ModalModel, of_effects: &[f64]) -> Self {
        let frequencies: Vec<f64> = modes.flexible().map(|mode| mode.angular_frequency / TAU).collect();
        let away = |pole: &Pole, frequency: f64| (pole.angular_frequency / (TAU * frequency) - 1.0).abs();
        let beside = |&frequency: &f64| {
            let near = measured.beside.iter().filter(|pole| away(pole, frequency) < REACH);
            let nearest = near.min_by(|a, b| away(a, frequency).total_cmp(&away(b, frequency)))?;
            nearest.damping_ratio.map(|zeta| (zeta, None))
        };
        let mut known: Vec<Option<(f64, Option<f64>)>> = frequencies.iter().map(beside).collect();
        let partners = measured.matched(modes);
        let partners: Vec<Option<usize>> = partners.iter().map(|partner| Some(partner.as_ref()?.mode - 1)).collect();
        Self::tell(&mut known, measured, (&partners, of_effects));
        known.truncate(known.iter().rposition(Option::is_some).map_or(0, |last| last + 1));
        Self::of_known(known)
    }

    /// Of as many flexible modes as there are, of which these are the partners of the poles.
    pub(super) fn of_partners(
        measured: &MeasuredModes,
        (partners, of_effects): (&[Option<usize>], &[f64]),
        modes: usize,
    ) -> Self {
        let mut known = vec![None; modes];
        Self::tell(&mut known, measured, (partners, of_effects));
        Self::of_known(known)
    }

    /// Puts what poles say of their partners, less what effects bring, with its deviation.
    fn tell(
        known: &mut [Option<(f64, Option<f64>)>],
        measured: &MeasuredModes,
        (partners, of_effects): (&[Option<usize>], &[f64]),
    ) {
        let damped = |pole: &usize| measured.poles[*pole].damping_ratio.is_some();
        for (place, pole) in (0..measured.poles.len()).filter(damped).enumerate() {
            let (Some(zeta), Some(partner)) = (measured.poles[pole].damping_ratio, partners[pole]) else { continue };
            // The covariance is that of the logarithm, after those of the frequencies.
            let at = measured.poles.len() + place;
            let std = zeta * measured.covariance[(at, at)].sqrt();
            let own = (zeta - of_effects.get(pole).copied().unwrap_or(0.0)).max(LEAST * zeta);
            if let Some(known) = known.get_mut(partner) {
                *known = Some((own, Some(std)));
            }
        }
    }

    fn of_known(known: Vec<Option<(f64, Option<f64>)>>) -> Self {
        let logs: Vec<f64> = known.iter().flatten().map(|(zeta, _)| zeta.ln()).collect();
        let usual = if logs.is_empty() { WITHOUT_POLES } else { (logs.iter().sum::<f64>() / logs.len() as f64).exp() };
        let ratios = known.iter().map(|one| one.map_or(usual, |(zeta, _)| zeta)).collect();
        let std = known.into_iter().map(|one| one.and_then(|(_, std)| std)).collect::<Vec<_>>();
        Self { damping: Damping { ratios, std: told(&std), beyond: usual }, std }
    }
}
