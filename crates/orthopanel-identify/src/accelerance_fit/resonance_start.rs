//! Constants and damping of a beam read off the resonances alone: where a search with more physics begins.

use faer::Mat;
use orthopanel_data::Accelerance;
use orthopanel_model::{BEAM_CONSTANTS, BeamConstants, Boundary, ExactBeam, ModelError, Piece};

use super::pole_charge::pole_charge;
use super::poles::{Pole, flat_poles, poles};
use super::records::PlaceRecord;
use super::start::usual_log_zeta;
use crate::IdentifyError;
use crate::least_squares::{Ending, Linearised, descend};

/// Constants and damping ratios of one piece.
pub(crate) struct ResonanceStart {
    /// $E_x$, $G_{zx}$ \[Pa\].
    pub constants: [f64; 2],
    /// Natural frequency \[Hz\] and damping ratio of each flexible mode; `None` for one without a resonance.
    pub modes: Vec<Option<(f64, f64)>>,
    /// Standard deviation of each of these frequencies \[Hz\].
    pub frequency_stds: Vec<Option<f64>>,
    /// Geometric mean of the damping ratios.
    pub usual_zeta: f64,
    /// Frequencies \[Hz\] of all resonances, whether a mode was found for them or not.
    pub poles: Vec<f64>,
    /// The damping ratio of each of these.
    pub pole_zetas: Vec<f64>,
}

impl ResonanceStart {
    /// Frequency \[Hz\] and damping ratio of the resonance nearest to each of these modes \[Hz\], within `reach` of its frequency.
    pub(crate) fn nearest_to(&self, modes: &[f64], reach: f64) -> Vec<Option<(f64, f64)>> {
        let mut found = vec![None; modes.len()];
        for (&pole, &zeta) in self.poles.iter().zip(&self.pole_zetas) {
            let distance = |mode: &usize| (modes[*mode] / pole - 1.0).abs();
            let near = (0..modes.len()).filter(|mode| distance(mode) < reach && found[*mode].is_none());
            if let Some(mode) = near.min_by(|a, b| distance(a).total_cmp(&distance(b))) {
                found[mode] = Some((pole, zeta));
            }
        }
        let last = found.iter().rposition(Option::is_some).map_or(0, |last| last + 1);
        found.truncate(last);
        found
    }
}

/// A damping ratio where no resonance tells one.
const UNTOLD_ZETA: f64 = 0.005;
/// Ratios $E_x/G_{zx}$ tried: lowest, highest and steps between.
const RATIOS: (f64, f64, usize) = (1.5, 1500.0, 40);
/// One of so many lowest poles is one of so many lowest modes.
const ANCHORS: (usize, usize) = (4, 6);
/// A pole further than this from every mode belongs to none.
const REACH: f64 = 0.04;
/// Starts that are handed on.
const STARTS: usize = 4;
/// Where nothing else is known \[Pa\].
const USUAL: [f64; 2] = [1e10, 5e8];
const PATIENCE: Ending = Ending::short(40, 1e-9);

/// Starts for a search over records, the likeliest first. Any pole may be missing, as where a mode does not stand out from
/// the noise: constants are scanned, and those kept whose modes meet the poles best.
///
/// # Errors
/// [`IdentifyError::TooFewResonances`] where fewer resonances stand out than constants are free.
pub(crate) fn resonance_starts(
    piece: &Piece,
    boundary: Boundary,
    held: [Option<f64>; 2],
    accelerances: &[Accelerance],
) -> Result<Vec<ResonanceStart>, IdentifyError> {
    let records: Vec<PlaceRecord> = accelerances.iter().map(PlaceRecord::of).collect();
    let needed = held.iter().filter(|held| held.is_none()).count().max(1);
    let mut poles = poles(&records);
    if poles.len() < needed {
        poles = flat_poles(&records);
    }
    if poles.len() < needed {
        return Err(IdentifyError::TooFewResonances { found: poles.len(), needed, noise_percent: None });
    }
    let fit = BeamFit { piece, boundary, held, poles: &poles };
    let mut starts: Vec<(f64, ResonanceStart)> = Vec::new();
    for constants in fit.scan()? {
        let Ok(nearest) = fit.nearest(constants) else { continue };
        let Ok(constants) = fit.constants(constants, &nearest) else { continue };
        let Ok(nearest) = fit.nearest(constants) else { continue };
        starts.push((fit.charge(constants)?, fit.start(constants, &nearest)));
    }
    starts.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(starts.into_iter().map(|(_, start)| start).collect())
}

struct BeamFit<'a> {
    piece: &'a Piece,
    boundary: Boundary,
    held: [Option<f64>; 2],
    poles: &'a [Pole],
}

impl BeamFit<'_> {
    fn beam(&self, [e_x, g_zx]: [f64; 2]) -> Result<ExactBeam, ModelError> {
        ExactBeam::new(self.piece, self.boundary, BeamConstants { e_x, g_zx })
    }

    /// Constants whose modes lie near the poles, the nearest first and none alike.
    fn scan(&self) -> Result<Vec<[f64; 2]>, ModelError> {
        let (lowest, highest, steps) = RATIOS;
        let mut found: Vec<(f64, [f64; 2])> = Vec::new();
        for step in 0..=steps {
            let ratio = lowest * (highest / lowest).powf(step as f64 / steps as f64);
            let unit = match self.held {
                [Some(e_x), g_zx] => [e_x, g_zx.unwrap_or(e_x / ratio)],
                [None, Some(g_zx)] => [ratio * g_zx, g_zx],
                [None, None] => [USUAL[0], USUAL[0] / ratio],
            };
            // Frequencies go with the root of a factor on both constants.
            let modes = self.beam(unit)?.natural_frequencies(ANCHORS.1);
            let poles = self.poles.iter().take(ANCHORS.0);
            let factors: Vec<f64> = if self.held == [None, None] {
                poles.flat_map(|pole| modes.iter().map(move |mode| (pole.frequency / mode).powi(2))).collect()
            } else {
                vec![1.0]
            };
            for factor in factors {
                let constants = unit.map(|value| value * factor);
                if BEAM_CONSTANTS.iter().zip(constants).all(|(constant, value)| constant.check(value).is_ok()) {
                    found.push((self.charge(constants)?, constants));
                }
            }
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut starts: Vec<[f64; 2]> = Vec::new();
        for (_, constants) in found {
            // Shear alone moves the high modes: its modulus tells two starts apart better than E does.
            let alike = |other: &[f64; 2]| (0..2).all(|i| (constants[i] / other[i]).ln().abs() < [0.5, 0.05][i]);
            if starts.len() < STARTS && !starts.iter().any(alike) {
                starts.push(constants);
            }
        }
        Ok(starts)
    }

    /// How far the poles lie from their nearest modes, with a charge for a pole without a mode and a mode without a pole.
    fn charge(&self, constants: [f64; 2]) -> Result<f64, ModelError> {
        let poles: Vec<f64> = self.poles.iter().map(|pole| pole.frequency).collect();
        let top = poles.last().copied().unwrap_or(0.0) * (1.0 + REACH);
        let beam = self.beam(constants)?;
        Ok(pole_charge(&poles, beam.flexible_modes().take(60).map(|mode| mode.frequency()), top, REACH))
    }

    fn values(&self, logs: &[f64]) -> [f64; 2] {
        let mut logs = logs.iter();
        let mut values = USUAL;
        for ((value, held), constant) in values.iter_mut().zip(self.held).zip(&BEAM_CONSTANTS) {
            let free = |log: &f64| log.exp().clamp(constant.low, constant.high);
            *value = held.unwrap_or_else(|| logs.next().map_or(*value, free));
        }
        values
    }

    /// The constants that bring the poles' modes nearest to them.
    fn constants(&self, from: [f64; 2], modes: &[Option<usize>]) -> Result<[f64; 2], IdentifyError> {
        let free: Vec<usize> = (0..2).filter(|&index| self.held[index].is_none()).collect();
        let start: Vec<f64> = free.iter().map(|&index| from[index].ln()).collect();
        let bounds: Vec<(f64, f64)> =
            free.iter().map(|&index| (BEAM_CONSTANTS[index].low.ln(), BEAM_CONSTANTS[index].high.ln())).collect();
        let linearise = |logs: &[f64]| -> Result<_, ModelError> {
            let values = self.values(logs);
            let (mut residuals, mut rows) = (Vec::new(), Vec::new());
            let highest = modes.iter().flatten().max().map_or(0, |mode| mode + 1);
            let all: Vec<_> = self.beam(values)?.flexible_modes().take(highest).collect();
            for (pole, mode) in self.poles.iter().zip(modes) {
                let Some(mode) = mode.and_then(|mode| all.get(mode)) else { continue };
                let ratio = mode.frequency() / pole.frequency;
                let twice_omega2 = 2.0 * mode.angular_frequency().powi(2);
                let by = mode.sensitivity();
                residuals.push(ratio - 1.0);
                rows.push([0, 1].map(|index| ratio * by[index] * values[index] / twice_omega2));
            }
            let jacobian = Mat::from_fn(rows.len(), free.len(), |i, j| rows[i][free[j]]);
            Ok(Linearised { residuals, jacobian }.quadratic())
        };
        let (minimum, _) = descend(linearise, &start, &bounds, PATIENCE).map_err(IdentifyError::refused)?;
        Ok(self.values(&minimum.parameters))
    }

    /// The mode nearest to each pole, within [`REACH`].
    fn nearest(&self, constants: [f64; 2]) -> Result<Vec<Option<usize>>, ModelError> {
        let highest = self.poles.last().map_or(0.0, |pole| pole.frequency * (1.0 + REACH));
        let beam = self.beam(constants)?;
        let modes: Vec<f64> =
            beam.flexible_modes().take(200).map(|mode| mode.frequency()).take_while(|f| *f < highest).collect();
        let nearest = |pole: &Pole| {
            let distance = |mode: &usize| (modes[*mode] / pole.frequency - 1.0).abs();
            (0..modes.len()).filter(|mode| distance(mode) < REACH).min_by(|a, b| distance(a).total_cmp(&distance(b)))
        };
        Ok(self.poles.iter().map(nearest).collect())
    }

    fn start(&self, constants: [f64; 2], modes: &[Option<usize>]) -> ResonanceStart {
        let poles = self.poles.iter().map(|pole| pole.frequency).collect();
        let count = modes.iter().flatten().max().map_or(0, |mode| mode + 1);
        let (modes_found, frequency_stds) = (vec![None; count], vec![None; count]);
        let pole_zetas = self.poles.iter().map(|pole| pole.zeta).collect();
        let usual_zeta = UNTOLD_ZETA;
        let mut found = ResonanceStart { constants, modes: modes_found, frequency_stds, usual_zeta, poles, pole_zetas };
        for (pole, mode) in self.poles.iter().zip(modes) {
            if let Some(mode) = mode.filter(|&mode| mode < count) {
                found.modes[mode] = Some((pole.frequency, pole.zeta));
                found.frequency_stds[mode] = Some(pole.frequency_std());
            }
        }
        if !self.poles.is_empty() {
            found.usual_zeta = usual_log_zeta(self.poles).exp();
        }
        found
    }
}
