//! A list of natural frequencies as measured modes: poles without damping and without records.

use std::f64::consts::TAU;

use faer::Mat;
use orthopanel_data::{ImpactTest, Measurement, MeasurementData, NaturalFrequencies};

use super::{MeasuredModes, Names, Pole};

impl MeasuredModes {
    /// Each frequency with the variance that its bin and its scatter give, $d^2/12 + s^2$, zero where the list states neither: what the model
    /// misses is then its own error, which no list tells apart from noise.
    pub(crate) fn of_frequencies(piece: usize, list: &NaturalFrequencies) -> Self {
        let of = |values: &[f64], mode: usize| values.get(mode).copied().unwrap_or(0.0);
        let variance = |mode: usize| {
            let square = of(&list.resolution, mode).powi(2) / 12.0 + of(&list.scatter, mode).powi(2);
            square / list.values[mode].powi(2)
        };
        let modes = list.values.len();
        let pole = |frequency: &f64| Pole { angular_frequency: TAU * frequency, damping_ratio: None };
        let ends = [list.values.first(), list.values.last()].map(|end| end.copied().unwrap_or(0.0));
        Self {
            piece,
            poles: list.values.iter().map(pole).collect(),
            beside: vec![],
            records: vec![],
            sensor_at: list.response_at,
            remainder_frequencies: vec![],
            band: ends,
            covariance: Mat::from_fn(modes, modes, |i, j| if i == j { variance(i) } else { 0.0 }),
            chi_square: None,
            missed_most: None,
            undone_decay: 0.0,
            named: orthopanel_model::NamedShapes::default(),
            order: vec![],
        }
    }
}

/// The shapes that a test file tells.
pub(crate) fn names_told(test: &ImpactTest) -> Vec<Names> {
    let told = |measurement: &Measurement| match &measurement.data {
        MeasurementData::NaturalFrequencies(list) => {
            list.shape.iter().map(|shape| Some(shape.map(|count| count as usize))).collect()
        }
        _ => vec![],
    };
    test.measurements.iter().map(told).collect()
}
