//! Each measured hit beside the base model and the model with the effects, both in the band of the trace.
//!
//! Effects of rig and measuring chain act on the accelerance, so a hit's force goes through that: with both channels faded as the
//! window has them, $A(s) = H(s)F(s)$ on every line of the record. What else the record holds is left out of all alike.

use num_complex::Complex64;
use orthopanel_data::{Hit, TimeHistory, Transforms};
use orthopanel_identify::AcceleranceFit;
use orthopanel_model::Place;

/// A line stands at a whole multiple of the record's resolution, to this part of it.
const ON_LINE: f64 = 1e-3;

/// The hits of one pair of places.
pub struct HitsWithEffects {
    pub force: Place,
    pub response: Place,
    /// Lowest and highest line \[Hz\].
    pub band: [f64; 2],
    /// Rms over the kept hits of measured less calculated, over each hit's peak \[%\]: by the base model and with the effects.
    pub before: f64,
    pub after: f64,
    /// Of each kept hit the greatest force \[N\] and what the model with the effects leaves \[% of peak\].
    pub levels: Vec<(f64, f64)>,
}

impl HitsWithEffects {
    /// `None` where the accelerances of both models do not stand on the record's own lines.
    pub fn of(history: &TimeHistory, kept: &[bool], base: &AcceleranceFit, with: &AcceleranceFit) -> Option<Self> {
        let samples = history.hits.first()?.force.len();
        if base.decay_rate != with.decay_rate || samples == 0 {
            return None;
        }
        let resolution = history.rate / samples as f64;
        let on_line = |frequency: f64| {
            let line = frequency / resolution;
            ((line - line.round()).abs() < ON_LINE).then_some(line.round() as usize)
        };
        let first = on_line(base.frequency.first()?.max(*with.frequency.first()?))?;
        let last = on_line(base.frequency.last()?.min(*with.frequency.last()?))?;
        let lines = |pair: &AcceleranceFit| {
            let all = pair.frequency.iter().zip(&pair.model);
            let told = all.map(|(&frequency, &value)| Some((on_line(frequency)?, value)));
            let told: Option<Vec<_>> = told.collect();
            let told: Vec<_> = told?.into_iter().filter(|(line, _)| (first..=last).contains(line)).collect();
            (told.len() == last + 1 - first).then_some(told)
        };
        let (base_lines, with_lines) = (lines(base)?, lines(with)?);
        let hits = history.hits.iter().zip(kept).filter(|(_, kept)| **kept);
        let misfits: Vec<[f64; 2]> = hits
            .map(|(hit, _)| {
                let [force, motion] = spectra(hit, with.decay_rate / history.rate);
                [&base_lines, &with_lines].map(|model| misfit(&force, &motion, model, samples))
            })
            .collect();
        let rms = |of: usize| {
            (misfits.iter().map(|misfit| misfit[of] * misfit[of]).sum::<f64>() / misfits.len().max(1) as f64).sqrt()
        };
        let (force, response) = (history.force_at, history.response_at);
        let peak = |hit: &Hit| hit.force.iter().fold(0.0_f64, |peak, value| peak.max(value.abs()));
        let hits = history.hits.iter().zip(kept).filter(|(_, kept)| **kept);
        let levels = hits
            .zip(&misfits)
            .map(|((hit, _), misfit)| (peak(hit), misfit[1]))
            .filter(|(_, misfit)| misfit.is_finite())
            .collect();
        let band = [first, last].map(|line| line as f64 * resolution);
        (!misfits.is_empty()).then(|| Self { force, response, band, before: rms(0), after: rms(1), levels })
    }
}

/// Transforms of force and acceleration, both faded by this much a sample.
fn spectra(hit: &Hit, fading: f64) -> [Vec<Complex64>; 2] {
    let mut transforms = Transforms::default();
    [&hit.force, &hit.acceleration].map(|samples| {
        let faded = samples.iter().enumerate().map(|(n, value)| value * (-fading * n as f64).exp());
        transforms.lines(faded.collect())
    })
}

/// Rms of what the model leaves of the acceleration on its lines, over the peak of that \[%\].
fn misfit(force: &[Complex64], motion: &[Complex64], model: &[(usize, Complex64)], samples: usize) -> f64 {
    let mut measured = vec![Complex64::ZERO; motion.len()];
    let mut left = 0.0;
    for &(line, value) in model {
        let (Some(force), Some(&motion), Some(measured)) = (force.get(line), motion.get(line), measured.get_mut(line))
        else {
            continue;
        };
        *measured = motion;
        left += 2.0 * (motion - value * force).norm_sqr();
    }
    let signal = Transforms::default().samples(measured, samples);
    let peak = signal.iter().fold(0.0_f64, |peak, value| peak.max(value.abs()));
    // Parseval: the mean square of a signal is that of its lines over the samples, and both stand unscaled.
    100.0 * left.sqrt() / peak
}
