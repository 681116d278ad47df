//! Accelerance from hits: estimators, coherence, variance, and the band in which the hammer had force.

use num_complex::Complex64;

use super::{
    accelerance::Accelerance,
    blow_window::{CutBlow, WHOLE},
    estimation::{Estimation, Estimator},
    extremes::median,
    force_noise::ForceNoise,
    hit::Hit,
    hit_faults::HitFault,
    hit_verdict::HitVerdict,
    spectrum::{self, Sums},
    time_history::TimeHistory,
    window::{Window, milliseconds},
};
use crate::{DataError, Location, Position, error::some_of};

/// Lines over which the force spectrum is smoothed before its fall is judged: single lines scatter.
const SMOOTHED_LINES: usize = 9;

/// The force over its channel's noise below which lines are left out, in power, where windows are taken as needed.
const OUT_OF_NOISE: f64 = 9.0;

/// Part of a blow, rms, from which a force window is refused: it is no accelerance that is left.
const MOST_LOST: f64 = 0.2;

/// Lines above the band from which the noise of a single hit can be told, to a sixth.
const LEAST_NOISE_LINES: usize = 32;

impl TimeHistory {
    /// Estimates the accelerance; the line at 0 Hz, which holds nothing but offsets, is left out.
    ///
    /// The variance of a line is, for two hits and more, that of their scatter; for hits alike it is
    /// $|H_1|^2 (1 - \gamma^2) / ((n - 1)\gamma^2)$ (Bendat and Piersol, Random Data, chapter 9, with the degrees of
    /// freedom of $n$ hits). Hits may be of unequal strength, and a hard hit noisier than a soft one by what the records
    /// show before each blow. For a single hit it is $(N_a + |H|^2 N_f)/|F|^2$ with the noise $N$ of either channel read above the band, and unknown where
    /// no line stands there.
    ///
    /// # Errors
    /// [`DataError::NoUsableHit`] where every hit is left out, with the reasons; [`DataError::OutOfRange`] for settings
    /// that make no sense.
    pub fn accelerance(&self, estimation: Estimation) -> Result<Accelerance, DataError> {
        self.check(estimation)?;
        let mut notes = self.notes.clone();
        let mut verdicts = self.first_verdicts();
        let mut reasons: Vec<String> =
            verdicts.iter().enumerate().flat_map(|(index, verdict)| verdict.notes(&self.hit_name(index))).collect();
        let mut kept = self.kept(&verdicts);
        if kept.is_empty() {
            return Err(DataError::NoUsableHit { file: self.file.clone(), reasons: some_of(&reasons, "; ") });
        }
        let ringing = kept.iter().flat_map(|(index, _)| &verdicts[*index].faults).filter_map(|fault| match fault {
            HitFault::NotDecayed { ratio } => Some(*ratio),
            _ => None,
        });
        let left = ringing.reduce(f64::max);
        notes.append(&mut reasons);
        let hits: Vec<&Hit> = kept.iter().map(|(_, hit)| *hit).collect();
        let window = estimation.window.resolved(left, &hits, self.rate);
        notes.extend(window.notes(left.is_some()));
        notes.extend(window.cut_off(&hits, self.rate));
        notes.extend(self.cut_blow(estimation.window, &hits)?);
        notes.extend(self.cut_push(window, &kept));
        let floor = |sums: &Sums| match estimation.window {
            Window::AsNeeded => OUT_OF_NOISE * sums.noise_of_forces(),
            // Who asks for a window gets all lines that it leaves.
            _ => 0.0,
        };

        let samples = hits.first().map_or(0, |hit| hit.force.len());
        let mut sums = spectrum::sums(&hits, samples, window, self.rate);
        let step = self.rate / samples as f64;
        let mut band = self.band_end(&sums, estimation.force_drop, floor(&sums), step)?;
        if self.heed_agreement(&sums, 1..band.0, &mut verdicts, &mut notes)? {
            kept = self.kept(&verdicts);
            let hits: Vec<&Hit> = kept.iter().map(|(_, hit)| *hit).collect();
            sums = spectrum::sums(&hits, samples, window, self.rate);
            band = self.band_end(&sums, estimation.force_drop, floor(&sums), step)?;
        }
        let (end, cut) = band;
        notes.extend(cut);
        let noise = (kept.len() == 1).then(|| noise_above(&sums, end)).flatten();
        let mut result = Accelerance::empty(self.force_at, self.response_at);
        result.read_as = self.read_as;
        let (mut variance, mut coherence) = (Vec::new(), Vec::new());
        let mut force_noise = ForceNoise::beneath(window, &sums, samples as f64 / self.rate);
        let mut bias = sums.noise.is_some().then(Vec::new);
        let (scatter, astray) = if kept.len() > 1 { sums.variance(1..end) } else { (Vec::new(), 0.0) };
        let lines = sums.force.iter().zip(&sums.motion).zip(&sums.cross).enumerate().take(end).skip(1);
        for (line, ((&force, &motion), &cross)) in lines {
            // A line without force has no quotient; it is left out like the band above.
            if !(force > 0.0 && force.is_finite() && motion.is_finite()) {
                continue;
            }
            let gamma = if motion > 0.0 { (cross.norm_sqr() / (force * motion)).min(1.0) } else { 0.0 };
            let value = estimate(estimation.estimator, force, motion, cross);
            // The sums stand for the means: their number cancels in every quotient.
            let first = cross.norm_sqr() / (force * force);
            result.frequency.push(line as f64 * step);
            result.value.push(value);
            coherence.push(gamma);
            if let Some(noise) = &mut force_noise {
                noise.push(&sums, (line, first), astray);
            }
            if let Some(bias) = &mut bias {
                bias.push(sums.bias(line, estimation.estimator));
            }
            variance.push(match noise {
                Some((force_noise, motion_noise)) => (motion_noise + first * force_noise) / force,
                None => scatter.get(line - 1).copied().unwrap_or_default(),
            });
        }
        if result.frequency.is_empty() {
            let reasons = "no line of the spectrum has a force that can be divided by".into();
            return Err(DataError::NoUsableHit { file: self.file.clone(), reasons });
        }
        result.hits = kept.len();
        result.verdicts = verdicts;
        result.decay_rate = window.decay_rate();
        let doubts = kept.iter().map(|(_, hit)| window.decay_rate_in_doubt(hit, self.rate));
        result.decay_rate_in_doubt = doubts.fold(0.0, f64::max);
        if force_noise.is_none()
            && window.force_half_width().is_some_and(|half| 2.0 * half * self.rate < samples as f64)
        {
            notes.push(
                "the force window ties the force's noise together from line to line, and no quiet stretch before the blow \
                 tells how much: deviations stated by a fit may be too small"
                    .into(),
            );
        }
        result.force_noise = force_noise;
        result.bias = bias;
        if kept.len() > 1 {
            result.coherence = Some(coherence);
            result.variance = Some(variance);
        } else if noise.is_some() {
            notes.push("one hit: the variance comes from the noise above the band, not from scatter".into());
            result.variance = Some(variance);
        } else {
            notes.push("one hit, and no line above the band to read noise from: variance unknown".into());
        }
        result.notes = notes;
        Ok(result)
    }

    /// What is wrong with each hit, in their order, as [`TimeHistory::accelerance`] with its usual settings judges them: by
    /// themselves, by extremes that they share, and beside one another. Where no accelerance can be made of them, not
    /// beside one another.
    pub fn verdicts(&self) -> Vec<HitVerdict> {
        let judged = self.accelerance(Estimation::default()).ok();
        judged.map_or_else(|| self.first_verdicts(), |accelerance| accelerance.verdicts)
    }

    fn check(&self, estimation: Estimation) -> Result<(), DataError> {
        let refused = |key: &str, value: f64, range: &str| {
            let location = Location { file: "settings".into(), position: Position::Whole, key: key.into() };
            Err(DataError::OutOfRange { at: Box::new(location), value, range: range.into() })
        };
        let size = match estimation.window {
            Window::ForceExponential { tau, .. } => tau,
            window => window.force_half_width().unwrap_or_default(),
        };
        if !estimation.window.is_valid() {
            return refused("window", size, "half width and time constant must be finite seconds, greater than zero");
        }
        let drop = estimation.force_drop;
        if drop.is_nan() || drop <= 0.0 {
            return refused("force_drop", drop, "must be greater than zero dB");
        }
        Ok(())
    }

    /// Refuses a force window that cuts off much of a blow; a sentence where it cuts off some of it.
    fn cut_blow(&self, window: Window, hits: &[&Hit]) -> Result<Option<String>, DataError> {
        let Some(half_width) = window.force_half_width() else { return Ok(None) };
        let CutBlow { lost, needed } = CutBlow::of(hits, half_width * self.rate);
        let needed = 1e-6 * (1e6 * (needed + 1) as f64 / self.rate).ceil();
        let cut = format!(
            "the force window cuts off {:.1} % of the blow (rms): half its width is {}, and {} would hold it",
            100.0 * lost,
            milliseconds(half_width),
            milliseconds(needed)
        );
        if lost > MOST_LOST {
            let location = Location { file: self.file.clone(), position: Position::Whole, key: "window".into() };
            let problem = format!("{cut}: give a half width of {needed:.6} s or more, or none");
            return Err(DataError::Contradiction { at: Box::new(location), problem });
        }
        Ok((lost > WHOLE).then(|| format!("{cut}: the lines are wrong by as much, and what is read off them")))
    }

    /// A sentence where a force window cuts off a push beside the blow.
    fn cut_push(&self, window: Window, hits: &[(usize, &Hit)]) -> Option<String> {
        let reach = window.force_half_width()? * self.rate;
        let pushes = hits.iter().filter_map(|(index, hit)| Some((index, hit.push_beyond(reach)?)));
        let (index, (samples, ratio)) = pushes.max_by(|a, b| a.1.1.total_cmp(&b.1.1))?;
        let after = samples / self.rate;
        let when = if after < 0.0 { "before" } else { "after" };
        Some(format!(
            "{}: the force window cuts off a push of {:.1} % of the blow, {} {when} it: where that is a second touch, the piece \
             has felt it, and what is read off the lines is wrong; take the window none",
            self.hit_name(*index),
            100.0 * ratio,
            milliseconds(after.abs())
        ))
    }

    /// The first line that is left out above the band, where the force falls below `floor` too, and what to say of it.
    fn band_end(
        &self,
        sums: &Sums,
        force_drop: f64,
        floor: f64,
        step: f64,
    ) -> Result<(usize, Option<String>), DataError> {
        let half = SMOOTHED_LINES / 2;
        let smooth = |line: usize| {
            let lines = sums.force.get(line.saturating_sub(half).max(1)..(line + half + 1).min(sums.force.len()));
            let lines = lines.unwrap_or_default();
            lines.iter().sum::<f64>() / lines.len().max(1) as f64
        };
        let smoothed: Vec<f64> = (0..sums.force.len()).map(smooth).collect();
        let greatest = smoothed.iter().copied().fold(0.0, f64::max);
        if greatest < floor {
            let reasons = format!(
                "the noise of the force's channel, read before the blow, is {:.0} % of its spectrum where that is \
                 greatest: too much noise; hit harder, or record the force with less noise",
                100.0 * (sums.noise_of_forces() / greatest).sqrt()
            );
            return Err(DataError::NoUsableHit { file: self.file.clone(), reasons });
        }
        let fallen = greatest * 10f64.powf(-force_drop / 10.0);
        let top = smoothed.iter().position(|&value| value == greatest).unwrap_or(0);
        let end = smoothed.iter().skip(top).position(|&value| value < fallen.max(floor)).map(|after| top + after);
        let cut = end.map(|end| {
            let at = end as f64 * step;
            if floor > fallen {
                let over = OUT_OF_NOISE.sqrt();
                format!("band cut at {at:.1} Hz: above, the force is less than {over} times its channel's noise")
            } else {
                format!("band cut at {at:.1} Hz: above, the force is more than {force_drop} dB below its greatest line")
            }
        });
        Ok((end.unwrap_or(sums.force.len()), cut))
    }
}

fn estimate(estimator: Estimator, force: f64, motion: f64, cross: Complex64) -> Complex64 {
    match estimator {
        Estimator::H1 => cross / force,
        // Without any coherence the phase is unknown: the line is zero, and its variance tells.
        _ if cross.norm_sqr() == 0.0 => Complex64::default(),
        Estimator::H2 => motion / cross.conj(),
        Estimator::Hv => cross / cross.norm() * (motion / force).sqrt(),
    }
}

/// Mean $|F|^2$ and $|A|^2$ of the noise, from the upper half of the lines between the band and where anti-alias
/// filters begin (0.78 of half the rate in analysers, whose rate is 2.56 times the span).
///
/// The upper half, since a hammer's force does not end with the band: it goes on falling above.
fn noise_above(sums: &Sums, end: usize) -> Option<(f64, f64)> {
    let top = (0.78 * sums.force.len() as f64) as usize;
    let above = |spectrum: &[f64]| {
        let lines = spectrum.get(end.midpoint(top)..top).filter(|lines| lines.len() >= LEAST_NOISE_LINES)?;
        // |noise|^2 is exponentially distributed: its median is ln 2 of its mean, and what leaks hardly moves it.
        Some(median(lines.to_vec()) / std::f64::consts::LN_2)
    };
    above(&sums.force).zip(above(&sums.motion))
}
