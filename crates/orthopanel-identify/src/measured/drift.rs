//! Poles that differ from record to record: a panel that warms up, a sensor's mass that moves along.

use rayon::prelude::*;

use super::joint_fit::{Found, fit};
use super::lines::RecordLines;
use super::modal_fit::{ModalFit, PoleParameters, lambda};

/// Rounds of common poles and own ones.
const ROUNDS: usize = 3;
/// Part of the misfit by less than which it falls where a record's own fit ends.
const OWN: f64 = 1e-6;
/// Steps to the size of a drift.
const SIZES: usize = 20;

/// Drift of the parameters of each pole, in the order of [`PoleParameters`].
pub(super) struct Drift {
    poles: PoleParameters,
    /// Variance of the mean over the records that it leaves of $\ln\omega$ and $\ln\zeta$.
    of_mean: Vec<[f64; 2]>,
}

impl Drift {
    pub(super) fn none() -> Self {
        Self { poles: vec![], of_mean: vec![] }
    }

    /// Removes from each record what its own poles do otherwise than the common ones. With $\delta_r$ the parameters of record $r$ less the common ones,
    /// known with variances $\sigma_r^2$, the drift has the variance $\sigma_d^2$ at which $\delta_r^2$ is $\sigma_d^2+\sigma_r^2$ in the mean, and
    /// $\delta_r\sigma_d^2/(\sigma_d^2+\sigma_r^2)$ is removed: a record that hardly shows a mode keeps the common pole.
    pub(super) fn removed(records: &mut [RecordLines], found: &mut Found) -> Self {
        let mut drift = Self::none();
        if records.len() == 1 {
            return drift;
        }
        let measured = records.to_vec();
        for _ in 0..ROUNDS {
            let common = found.poles.clone();
            let own: Vec<Option<Own>> = measured.par_iter().map(|record| Own::of(record, &common)).collect();
            let sizes: Vec<f64> = (0..2 * common.len()).map(|place| size(&own, place)).collect();
            let corrected = measured.par_iter().zip(&own).map(|(record, own)| match own {
                Some(own) => own.corrected(record, &common, &sizes),
                None => record.clone(),
            });
            let corrected: Vec<RecordLines> = corrected.collect();
            let Some(again) = fit(&corrected, common.clone(), OWN) else { break };
            records.clone_from_slice(&corrected);
            *found = again;
            let count = measured.len() as f64;
            drift.of_mean = sizes.chunks_exact(2).map(|sizes| [sizes[0] / count, sizes[1] / count]).collect();
            drift.poles = common;
        }
        drift
    }

    /// Variance that drift leaves of the common parameters of a pole.
    pub(super) fn of_mean(&self, pole: [f64; 2]) -> [f64; 2] {
        let near = |other: &[f64; 2]| (other[0] - pole[0]).abs() < pole[1].exp();
        self.poles.iter().position(near).map_or([0.0; 2], |number| self.of_mean[number])
    }
}

/// The poles that one record has of its own.
struct Own {
    /// Less the common ones, and the variance of each.
    apart: Vec<f64>,
    variance: Vec<f64>,
}

impl Own {
    fn of(record: &RecordLines, common: &PoleParameters) -> Option<Self> {
        let alone = std::slice::from_ref(record);
        let fit = ModalFit::new(alone, common);
        let (poles, fitted) = fit.minimise(common.clone(), OWN)?;
        let scale = (fitted.misfit / fit.freedom(poles.len())).max(1.0);
        let own = poles.iter().zip(common).flat_map(|(own, common)| [own[0] - common[0], own[1] - common[1]]);
        let variance =
            (0..2 * poles.len()).map(|place| scale / fitted.curvature[(place, place)].max(f64::MIN_POSITIVE));
        Some(Self { apart: own.collect(), variance: variance.collect() })
    }

    /// The record as it were at the common poles, with drifts of these variances.
    fn corrected(&self, record: &RecordLines, common: &PoleParameters, sizes: &[f64]) -> RecordLines {
        let moved = |place: usize| {
            let part = sizes[place] / (sizes[place] + self.variance[place]);
            if part.is_finite() { part * self.apart[place] } else { 0.0 }
        };
        let poles: PoleParameters = common
            .iter()
            .enumerate()
            .map(|(number, pole)| [pole[0] + moved(2 * number), pole[1] + moved(2 * number + 1)])
            .collect();
        let mut corrected = record.clone();
        let Some(fitted) = ModalFit::new(std::slice::from_ref(record), common).at(&poles) else { return corrected };
        for (number, (own, common)) in poles.iter().zip(common).enumerate() {
            let residue = fitted.records[0].residue(number);
            record.add_pole(&mut corrected.value, lambda(*own)[0], -residue);
            record.add_pole(&mut corrected.value, lambda(*common)[0], residue);
        }
        corrected
    }
}

/// The variance of the drift of one parameter over the records.
fn size(own: &[Option<Own>], place: usize) -> f64 {
    let told: Vec<[f64; 2]> = own.iter().flatten().map(|own| [own.apart[place].powi(2), own.variance[place]]).collect();
    let mut size = 0.0;
    for _ in 0..SIZES {
        let weighed = told.iter().map(|[square, variance]| {
            let weight = (size + variance).powi(-2);
            [weight * (square - variance), weight]
        });
        let [sum, weights] = weighed.fold([0.0; 2], |sum, of| [sum[0] + of[0], sum[1] + of[1]]);
        size = (sum / weights).max(0.0);
    }
    if size.is_finite() { size } else { 0.0 }
}
