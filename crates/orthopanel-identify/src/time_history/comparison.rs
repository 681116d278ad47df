//! Measured against calculated acceleration, hit by hit.

use std::ops::RangeInclusive;

use orthopanel_data::{Hit, TimeHistory, Transforms};
use orthopanel_model::{ModalModel, ModelError};

use super::{
    force_between_samples::{ForceBetweenSamples, Stepping},
    spectrum,
};
use crate::IdentifyError;

/// How a model is held against records.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct HistorySettings {
    /// How the measured force runs between its samples.
    pub between_samples: ForceBetweenSamples,
    /// How the modes are carried from sample to sample.
    pub stepping: Stepping,
    /// Static flexibility $G = \sum_m W_m(l_1)W_m(l_x)/\omega_m^2$ over **all** flexible modes \[m/N\], for a beam by
    /// [`StaticFlexibility`](orthopanel_model::StaticFlexibility). What the modes of the model leave of it, $R$, answers
    /// as $R\ddot f$.
    pub static_flexibility: Option<f64>,
    /// A second comparison with every line outside this band \[Hz\] taken out of both signals: its upper end leaves out
    /// modes that the model does not claim to know, its lower end the suspension and the sensor's drift.
    pub band: Option<RangeInclusive<f64>>,
}

/// One hit, measured and calculated.
#[derive(Debug, Clone, PartialEq)]
pub struct HitComparison {
    /// Mean of measured less calculated acceleration \[m/s²\], taken out of the measured one: the sensor's offset.
    pub offset: f64,
    /// The whole record.
    pub whole: ComparedSignals,
    /// The band alone, where one was asked for.
    pub in_band: Option<ComparedSignals>,
}

/// Two accelerations at the instants of the record, and how far they are apart.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparedSignals {
    /// Measured \[m/s²\], without its offset.
    pub measured: Vec<f64>,
    /// Calculated \[m/s²\].
    pub calculated: Vec<f64>,
    /// Their difference in numbers.
    pub misfit: Misfit,
}

/// The difference $e = a_\mathrm{measured} - a_\mathrm{calculated}$ in numbers.
///
/// The percentages are of one instant's peak, so `rms_percent_of_peak` falls as a record grows longer than the ringing;
/// `variance_explained` does not, but for noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Misfit {
    /// Greatest measured $|a|$ \[m/s²\].
    pub peak: f64,
    /// $100\,\mathrm{rms}(e)/\mathrm{peak}$ over all samples \[%\].
    pub rms_percent_of_peak: f64,
    /// $100\max|e|/\mathrm{peak}$ \[%\].
    pub greatest_percent_of_peak: f64,
    /// $1 - \mathrm{var}(e)/\mathrm{var}(a_\mathrm{measured})$ \[1\]: 1 where the model explains all, 0 for a model
    /// that stands still, negative for one that is worse than that.
    pub variance_explained: f64,
}

/// Drives the model with each measured force and compares its acceleration with the measured one.
///
/// Force enters at the model's only force port, motion leaves at its first response port: make the model with the
/// places of `history`. Each hit starts at rest, so its record must begin before the blow. `settings` says how the force
/// runs between samples, and how the modes are stepped: exactly, unless said.
///
/// **Modes beyond the records.** A mode that the model leaves out still answers below its frequency, as a static
/// flexibility. Without it a model errs between its peaks and beside them: with modes up to four times half the
/// sampling rate by less than $10^{-6}$ of the variance at places apart, but by $10^{-4}$ to $10^{-3}$ where force and
/// response share a place, since the sum converges slowly there. With `static_flexibility` modes up to twice half the
/// sampling rate leave less than $10^{-5}$ anywhere.
///
/// **Offsets.** The hammer is off the piece nearly all the time: the median of the force is its channel's offset and is
/// taken out. The rigid modes accelerate a free piece during the blow alone, so the calculated acceleration does not
/// drift; an accelerometer is coupled by alternating current and shows no constant, or has an offset of its own. Either
/// way a constant says nothing about the panel: the mean difference is taken out of the measured acceleration and
/// reported. Slower drift is not a constant: leave it out with the band's lower end.
///
/// **Band.** Lines outside are set to zero in both signals alike, so the difference is filtered like them and
/// `variance_explained` is that of the lines inside. A response that still rings at the record's end leaks over the
/// band's ends, in both signals alike.
///
/// A hit is compared whatever its faults: [`Hit::faults`] tells an overload; a double hit does no harm here.
///
/// # Errors
/// [`IdentifyError::HistoryBand`], [`IdentifyError::HistoryPorts`], [`IdentifyError::HitSamples`] and
/// [`IdentifyError::SilentHit`] for what cannot be compared; [`IdentifyError::Model`] for samples or a sampling rate
/// that are no numbers.
pub fn compare_time_history(
    model: &ModalModel,
    history: &TimeHistory,
    settings: &HistorySettings,
) -> Result<Vec<HitComparison>, IdentifyError> {
    let (forces, responses) = (model.force_count(), model.response_count());
    if forces != 1 || responses == 0 {
        return Err(IdentifyError::HistoryPorts { forces, responses });
    }
    if let Some(band) = &settings.band {
        let (from, to, half_rate) = (*band.start(), *band.end(), 0.5 * history.rate);
        if !(0.0 <= from && from < to && to <= half_rate) {
            return Err(IdentifyError::HistoryBand { from, to, half_rate });
        }
    }
    let mut transforms = Transforms::default();
    let hits = history.hits.iter().enumerate();
    hits.map(|(index, hit)| compare_hit(model, index + 1, hit, history.rate, settings, &mut transforms)).collect()
}

fn compare_hit(
    model: &ModalModel,
    number: usize,
    hit: &Hit,
    rate: f64,
    settings: &HistorySettings,
    transforms: &mut Transforms,
) -> Result<HitComparison, IdentifyError> {
    let (force, acceleration) = (hit.force.len(), hit.acceleration.len());
    if force != acceleration || force < 2 {
        return Err(IdentifyError::HitSamples { hit: number, force, acceleration });
    }
    if let Some(&value) = hit.acceleration.iter().find(|value| !value.is_finite()) {
        return Err(ModelError::NotFinite { what: "measured acceleration", value }.into());
    }
    let at_rest = median(&hit.force);
    let force: Vec<f64> = hit.force.iter().map(|value| value - at_rest).collect();
    let beyond = settings.static_flexibility.map(|all| left_out(model, all)).transpose()?;
    let beyond = beyond.map(|flexibility| (flexibility, spectrum::second_derivative(transforms, &force, rate)));
    let mut calculated = settings.between_samples.acceleration(model, force, rate, settings.stepping, transforms)?;
    if let Some((flexibility, derivative)) = beyond {
        calculated.iter_mut().zip(derivative).for_each(|(sum, value)| *sum += flexibility * value);
    }
    let offset = mean(hit.acceleration.iter().zip(&calculated).map(|(measured, calculated)| measured - calculated));
    let measured: Vec<f64> = hit.acceleration.iter().map(|value| value - offset).collect();
    let rounding = ROUNDING * greatest(&hit.acceleration);
    let signals = |measured, calculated| {
        ComparedSignals::new(measured, calculated, rounding).ok_or(IdentifyError::SilentHit { hit: number })
    };
    let in_band = match &settings.band {
        None => None,
        Some(band) => {
            let [measured, calculated] =
                [&measured, &calculated].map(|values| spectrum::within(transforms, values, rate, band));
            Some(signals(measured, calculated)?)
        }
    };
    let whole = signals(measured, calculated)?;
    Ok(HitComparison { offset, whole, in_band })
}

/// Of the greatest sample: what an offset or a filter leaves of a signal that is not there.
const ROUNDING: f64 = 1e-12;

/// $R = G - \sum_m W_m(l_1)W_m(l_x)/\omega_m^2$ \[m/N\] over the flexible modes of the model.
fn left_out(model: &ModalModel, all: f64) -> Result<f64, ModelError> {
    let left = model.left_of_flexibility(vec![vec![all]])[0][0];
    if left.is_finite() { Ok(left) } else { Err(ModelError::NotFinite { what: "static flexibility", value: all }) }
}

impl ComparedSignals {
    /// `None` where the measured signal varies by no more than `rounding`.
    fn new(measured: Vec<f64>, calculated: Vec<f64>, rounding: f64) -> Option<Self> {
        let errors: Vec<f64> =
            measured.iter().zip(&calculated).map(|(measured, calculated)| measured - calculated).collect();
        let (peak, all) = (greatest(&measured), variance(&measured));
        if all.sqrt() <= rounding {
            return None;
        }
        let rms = mean(errors.iter().map(|error| error * error)).sqrt();
        let misfit = Misfit {
            peak,
            rms_percent_of_peak: 100.0 * rms / peak,
            greatest_percent_of_peak: 100.0 * greatest(&errors) / peak,
            variance_explained: 1.0 - variance(&errors) / all,
        };
        Some(Self { measured, calculated, misfit })
    }
}

fn greatest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |greatest, value| greatest.max(value.abs()))
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    values.sum::<f64>() / count
}

fn variance(values: &[f64]) -> f64 {
    let middle = mean(values.iter().copied());
    mean(values.iter().map(|value| (value - middle).powi(2)))
}

/// The middle value; 0 of an empty list.
fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    let middle = sorted.len() / 2;
    if sorted.is_empty() { 0.0 } else { *sorted.select_nth_unstable_by(middle, f64::total_cmp).1 }
}
