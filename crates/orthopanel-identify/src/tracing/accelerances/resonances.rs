//! Natural frequencies as the records agree on them, and by how much they do not.

use orthopanel_data::Accelerance;
use orthopanel_model::Place;

use crate::accelerance_fit::{RecordPole, ResonanceStart, record_poles};

/// A natural frequency of the piece with its sensor at one place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Resonance {
    /// Flexible mode, from 0.
    pub mode: usize,
    pub response_at: Place,
    /// Mean of the records \[Hz\].
    pub frequency: f64,
    /// Relative standard deviation: that of the records about their mean, or their own noise where that is more.
    ///
    /// Not divided by the root of their number: records drift with temperature and time, all modes alike, and a drift does
    /// not average out.
    pub std: f64,
}

/// Natural frequencies of every place of the sensor.
pub(super) fn resonances(accelerances: &[Accelerance], start: &ResonanceStart) -> Vec<Resonance> {
    let seen: Vec<(usize, (f64, f64))> =
        start.modes.iter().enumerate().filter_map(|(mode, seen)| Some((mode, (*seen)?))).collect();
    let near: Vec<(f64, f64)> = seen.iter().map(|(_, near)| *near).collect();
    let mut places: Vec<Place> = Vec::new();
    for accelerance in accelerances {
        if !places.contains(&accelerance.response_at) {
            places.push(accelerance.response_at);
        }
    }
    let mut resonances = Vec::new();
    for ((mode, _), found) in seen.iter().zip(record_poles(accelerances, &near)) {
        for &response_at in &places {
            let of_place = accelerances.iter().zip(&found).filter(|(record, _)| record.response_at == response_at);
            let own: Vec<RecordPole> = of_place.filter_map(|(_, pole)| *pole).collect();
            if let Some((frequency, std)) = agreed(&own) {
                resonances.push(Resonance { mode: *mode, response_at, frequency, std });
            }
        }
    }
    resonances
}

/// Mean and relative standard deviation.
fn agreed(poles: &[RecordPole]) -> Option<(f64, f64)> {
    let count = poles.len() as f64;
    let mean = poles.iter().map(|pole| pole.frequency).sum::<f64>() / count;
    let own = poles.iter().map(|pole| pole.std.powi(2)).sum::<f64>() / count;
    let square: f64 = poles.iter().map(|pole| (pole.frequency / mean - 1.0).powi(2)).sum();
    let scatter = if poles.len() > 1 { square / (count - 1.0) } else { 0.0 };
    (!poles.is_empty()).then_some((mean, scatter.max(own).sqrt().max(f64::EPSILON)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_that_drift_say_how_sure_their_mean_is() {
        let pole = |frequency| RecordPole { frequency, std: 1e-6 };
        let (mean, std) = agreed(&[pole(99.99), pole(100.0), pole(100.01)]).unwrap();
        assert!((mean - 100.0).abs() < 1e-12 && (std - 1e-4).abs() < 1e-12, "{mean} {std}");
        assert_eq!(agreed(&[pole(50.0)]), Some((50.0, 1e-6)));
        assert_eq!(agreed(&[]), None);
    }
}
