//! Where to start without a single pole: constants scanned over records made wide.

use std::f64::consts::TAU;

use num_complex::Complex64;
use orthopanel_model::{ModelError, Place};
use rayon::prelude::*;

use super::recorded::Recorded;
use super::records::PlaceRecord;
use super::sharpening::{Rough, fit_wide};
use super::smeared::{smeared_value, told};
use super::synthesis::DampingLaw;
use crate::IdentifyError;
use crate::free_constants::FreeConstants;
use crate::starting_constants::guess;
use crate::structures::RecordedStructure;

/// Width of the smeared resonances, $\sigma/\omega$: a scan that steps by no more meets them all.
pub(super) const WIDTH: f64 = 0.02;
/// Damping ratios tried: next to none beside the width, and as much as it.
const ZETAS: [f64; 2] = [0.002, 0.025];
/// $E_x/(k'G_{zx})$ tried: decades above one, and steps a decade.
const SOFTNESS: (f64, usize) = (3.5, 24);
/// Most modes that may lie in the band, and up to where the sum goes, in bands.
const MODES: usize = 60;
const SUMMED: f64 = 2.0;
/// Records of a piece that take part: more tell little that these do not.
const RECORDS: usize = 6;
/// Starts that are handed on, and how far apart in frequency, in steps.
const STARTS: usize = 6;
const APART: f64 = 2.5;

/// The smeared lines of one piece.
struct WidePiece<'a> {
    structure: &'a dyn RecordedStructure,
    pairs: Vec<(Place, Place)>,
    s: Vec<Complex64>,
    /// A list a record.
    values: Vec<Vec<Complex64>>,
    rigid: Vec<f64>,
    band: f64,
}

/// Constants to start from.
#[derive(Debug, Clone)]
struct WideStart {
    values: Vec<f64>,
    zeta: f64,
    /// Mean of the lines' misfit, from 0 to 2.
    misfit: f64,
    log_frequency: f64,
}

impl<'a> WidePiece<'a> {
    fn new(structure: &'a dyn RecordedStructure, records: &[PlaceRecord], values: &[f64]) -> Result<Self, ModelError> {
        let stride = records.len().div_ceil(RECORDS).max(1);
        let records: Vec<&PlaceRecord> = records.iter().step_by(stride).collect();
        let (mut from, mut end, mut step, mut decay) = (0.0_f64, f64::INFINITY, 0.0_f64, 0.0_f64);
        for record in &records {
            let own = told(record, WIDTH);
            (from, end) = (from.max(own.0), end.min(own.1));
            (step, decay) = (step.max(record.line_step()), decay.max(record.decay_rate));
        }
        let width = |frequency: f64| (WIDTH * frequency).max(2.0 * step);
        let mut lines = Vec::new();
        let mut at = from.max(step);
        while at < end && step > 0.0 {
            lines.push(at);
            at += width(at);
        }
        let total = |frequency: f64| decay + TAU * width(frequency);
        let of_record = |record: &&PlaceRecord| -> Vec<Complex64> {
            let value = |&line: &f64| smeared_value(record, line, (total(line) - record.decay_rate) / TAU);
            lines.par_iter().map(value).collect()
        };
        let pairs: Vec<(Place, Place)> = records.iter().map(|record| (record.force_at, record.response_at)).collect();
        let places: Vec<Place> = pairs.iter().flat_map(|pair| [pair.0, pair.1]).collect();
        let shapes = structure.synthesis(values, 1)?.modes(values, 1, &places)?.rigid;
        let rigid = |pair: usize| shapes.iter().map(|shape| shape[2 * pair] * shape[2 * pair + 1]).sum();
        Ok(Self {
            structure,
            s: lines.iter().map(|&line| Complex64::new(total(line), TAU * line)).collect(),
            values: records.iter().map(of_record).collect(),
            rigid: (0..pairs.len()).map(rigid).collect(),
            band: end,
            pairs,
        })
    }

    /// The lowest modes, as many as a scan may want.
    fn modes(&self, values: &[f64]) -> Result<Vec<(f64, Vec<f64>)>, ModelError> {
        let wanted = (SUMMED * MODES as f64) as usize;
        let mut limit = self.band;
        loop {
            let modes = self.structure.modes_below(values, limit, &[])?;
            // Records of a few lines are narrower than the width, and have no band that could be doubled.
            if modes.len() >= wanted || !(limit > 0.0 && limit < 1e9) {
                break;
            }
            limit *= 2.0;
        }
        let modes = self.structure.modes_below(values, limit, &self.pairs)?;
        Ok(modes.into_iter().take(wanted).map(|mode| (TAU * mode.frequency, mode.products)).collect())
    }

    /// The sum of the lines' misfits and their number, with all frequencies times `factor`.
    ///
    /// $|H_{cal}-H_{exp}|^2/(|H_{cal}|^2+|H_{exp}|^2)$ lies between 0 and 2 and makes lines count alike, peak or valley.
    fn misfit(&self, modes: &[(f64, Vec<f64>)], factor: f64, zeta: f64) -> (f64, usize) {
        let within = modes.partition_point(|(omega, _)| factor * omega < SUMMED * TAU * self.band);
        let mut sums = vec![Complex64::ZERO; self.rigid.len()];
        let mut misfit = 0.0;
        for (line, &s) in self.s.iter().enumerate() {
            sums.iter_mut().zip(&self.rigid).for_each(|(sum, rigid)| *sum = Complex64::from(*rigid));
            let s2 = s * s;
            for (omega, products) in &modes[..within] {
                let omega = factor * omega;
                let gain = s2 / (s2 + 2.0 * zeta * omega * s + omega * omega);
                sums.iter_mut().zip(products).for_each(|(sum, product)| *sum += *product * gain);
            }
            for (sum, values) in sums.iter().zip(&self.values) {
                let sizes = sum.norm_sqr() + values[line].norm_sqr();
                misfit += if sizes > 0.0 { (sum - values[line]).norm_sqr() / sizes } else { 0.0 };
            }
        }
        (misfit, self.s.len() * self.values.len())
    }
}

/// Starts that are followed beyond the widest records, and how far apart their constants lie at least.
const FOLLOWED: usize = 2;
const APART_WHEN_FITTED: f64 = 0.02;

/// Constants and damping at which the model meets the records made wide, the nearest first.
pub(super) fn rough_starts(recorded: &Recorded, law: DampingLaw) -> Result<Vec<Rough>, IdentifyError> {
    let constants = &recorded.constants;
    let any = guess(constants, 10.0);
    let wide = recorded.pieces.iter().zip(&recorded.poles);
    let wide = wide.map(|(piece, poles)| WidePiece::new(&*poles.structure, &piece.records, &any));
    let wide = wide.collect::<Result<Vec<_>, _>>()?;
    let fit = |start: &WideStart| {
        let parameters = constants.free.iter().enumerate();
        let rough = Rough {
            constants: parameters.map(|(i, free)| constants.parameter(i, start.values[free.constant])).collect(),
            log_zetas: vec![Vec::new(); recorded.pieces.len()],
            usual_log_zeta: start.zeta.ln(),
            misfit: f64::INFINITY,
        };
        fit_wide(recorded, constants, &rough, law, WIDTH).ok()
    };
    let mut fitted: Vec<Rough> = wide_scan(&wide, constants)?.par_iter().filter_map(fit).collect();
    fitted.sort_by(|a, b| a.misfit.total_cmp(&b.misfit));
    let mut found: Vec<Rough> = Vec::new();
    for rough in fitted {
        let alike = |other: &Rough| {
            rough.constants.iter().zip(&other.constants).all(|(a, b)| (a - b).abs() < APART_WHEN_FITTED)
        };
        if found.len() < FOLLOWED && !found.iter().any(alike) {
            found.push(rough);
        }
    }
    Ok(found)
}

/// Constants at which the wide model comes near the wide records, the nearest first and no two alike.
fn wide_scan(pieces: &[WidePiece], constants: &FreeConstants) -> Result<Vec<WideStart>, ModelError> {
    let Some((leading, guide)) = pieces.iter().enumerate().max_by_key(|(_, piece)| piece.s.len()) else {
        return Ok(Vec::new());
    };
    let (decades, steps) = SOFTNESS;
    let at_softness = |step: usize| -> Result<Vec<WideStart>, ModelError> {
        let guess = guess(constants, 10.0_f64.powf(step as f64 / steps as f64));
        let modes = pieces.iter().map(|piece| piece.modes(&guess)).collect::<Result<Vec<_>, _>>()?;
        let of_guide = &modes[leading];
        let factors: Vec<f64> = match (of_guide.first(), of_guide.get(MODES)) {
            // From all but the first mode beyond the band to as many within as may be.
            (Some((first, _)), Some((last, _))) if constants.moduli_are_free() => {
                let count = ((last / first).ln() / WIDTH).ceil() as usize;
                (0..=count).map(|at| TAU * guide.band / last * (WIDTH * at as f64).exp()).collect()
            }
            // Without a size to choose, the guess is what it is.
            _ => vec![1.0],
        };
        let starts = factors.into_iter().flat_map(|factor| ZETAS.map(|zeta| (factor, zeta)));
        let starts = starts.filter_map(|(factor, zeta)| {
            let values = constants.scaled(&guess, factor * factor);
            let holds = constants.constants.iter().zip(&values).all(|(constant, &value)| constant.check(value).is_ok());
            holds.then(|| {
                let each = pieces.iter().zip(&modes).map(|(piece, modes)| piece.misfit(modes, factor, zeta));
                let (misfit, lines) = each.fold((0.0, 0), |sum, own| (sum.0 + own.0, sum.1 + own.1));
                let log_frequency = of_guide.first().map_or(0.0, |(first, _)| (factor * first).ln());
                WideStart { values, zeta, misfit: misfit / lines.max(1) as f64, log_frequency }
            })
        });
        Ok(starts.collect())
    };
    let all: Vec<_> = (0..=(decades * steps as f64) as usize).into_par_iter().map(at_softness).collect();
    let mut all: Vec<WideStart> = all.into_iter().collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect();
    all.sort_by(|a, b| a.misfit.total_cmp(&b.misfit));
    let mut found: Vec<WideStart> = Vec::new();
    for start in all {
        // Alike where the first mode lies there and the moduli stand alike too.
        let alike = |other: &WideStart| {
            (start.log_frequency - other.log_frequency).abs() < APART * WIDTH
                && start.values.iter().zip(&other.values).all(|(a, b)| (a / b).ln().abs() < 0.2)
        };
        if found.len() < STARTS && !found.iter().any(alike) {
            found.push(start);
        }
    }
    Ok(found)
}
