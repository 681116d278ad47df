//! Which predicted mode is which measured one: by frequency and by shape.

use std::f64::consts::TAU;

use num_complex::Complex64;
use orthopanel_model::{ModalModel, ModeRange, ModelError, PanelModel, Place};
use pathfinding::matrix::Matrix;
use pathfinding::prelude::kuhn_munkres_min;

use crate::measured::MeasuredModes;

/// A predicted mode that a measured pole is matched with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModeMatch {
    /// Number of the flexible mode, from 1.
    pub mode: usize,
    /// Its undamped natural frequency \[Hz\].
    pub frequency: f64,
    /// Modal assurance criterion between residues and predicted shape over the records, 0 to 1; `None` of fewer than two records.
    pub assurance: Option<f64>,
}

/// Modal assurance criteria between measured poles and the flexible modes of a model.
#[derive(Debug, Clone, PartialEq)]
pub struct ModalAssurance {
    /// Undamped natural frequencies \[Hz\] of the model's flexible modes, rising, from mode 1.
    pub frequencies: Vec<f64>,
    /// Of each pole the criterion with each of these modes, 0 to 1.
    pub of_poles: Vec<Vec<f64>>,
}

/// Deviation of the logarithm of a frequency between partners: a model that is not yet identified misses by a few per cent.
const APART: f64 = 0.06;
/// Worth of a shape: one that is another mode's costs as much as two deviations of frequency.
const SHAPE: f64 = 4.0;
/// Standard deviation of the logarithm of a residue's size between partners of one record, the most that it costs, and what a wrong sign does.
const SIZE: f64 = 0.7;
const MOST_BY_SIZE: f64 = 9.0;
const SIGN: f64 = 4.0;
/// No partner costs so much: seven deviations.
const ALONE: f64 = 50.0;
/// The assignment works in whole numbers.
const UNIT: f64 = 1e4;

/// The number of a pole's partner among predicted modes, if it has one, and their modal assurance criterion.
pub(crate) type Partner = Option<(usize, Option<f64>)>;

impl MeasuredModes {
    /// Of each pole the flexible mode of a model that it is, if any.
    ///
    /// The pairs are those of least total cost (Kuhn and Munkres) with
    /// $$\left(\frac{\ln(\omega_m/\omega_n)}{0.06}\right)^2 + 4\,(1-\mathrm{MAC}_{mn}),\qquad
    /// \mathrm{MAC}_{mn} = \frac{\left|\sum_rq_{rm}\,W_{rn}\right|^2}{\sum_r|q_{rm}|^2\,\sum_rW_{rn}^2},$$
    /// where $W_{rn}$ is the product of mode $n$'s deflections at the two places of record $r$ (Allemang and Brown, Proc. IMAC 1, 1982).
    /// A pole further than $\sqrt{50}$ deviations from every mode stays alone.
    ///
    /// # Errors
    /// [`ModelError`] of a model whose modes cannot be had up to the end of the measured band.
    pub fn matched_with(&self, model: &PanelModel) -> Result<Vec<Option<ModeMatch>>, ModelError> {
        Ok(self.matched(&self.modes_of(model, ABOVE)?))
    }

    /// The modal assurance criterion $\mathrm{MAC}_{mn}$ of each pole with each flexible mode of a model up to the last pole and a little beyond, as
    /// [`matched_with`](Self::matched_with) has it of partners; `None` of fewer than two records, which have no shape.
    ///
    /// # Errors
    /// As [`matched_with`](Self::matched_with).
    pub fn assurance_with(&self, model: &PanelModel) -> Result<Option<ModalAssurance>, ModelError> {
        if self.records.len() < 2 {
            return Ok(None);
        }
        let candidates = candidates(&self.modes_of(model, JUST_ABOVE)?);
        let of_pole = |pole: usize| {
            candidates.iter().map(|(_, shape)| self.assurance(pole, shape).unwrap_or(0.0)).collect::<Vec<f64>>()
        };
        Ok(Some(ModalAssurance {
            frequencies: candidates.iter().map(|(omega, _)| omega / TAU).collect(),
            of_poles: (0..self.poles.len()).map(of_pole).collect(),
        }))
    }

    /// The modes of a model up to so many times the last pole, with the force and the response of record $r$ as ports number $r$.
    fn modes_of(&self, model: &PanelModel, above: f64) -> Result<ModalModel, ModelError> {
        let to = self.poles.last().map_or(self.band[1], |pole| pole.angular_frequency / TAU);
        let (forces, responses): (Vec<Place>, Vec<Place>) =
            self.records.iter().map(|record| (record.force_at, record.response_at)).unzip();
        model.modal_model(ModeRange::UpTo(above * to), &forces, &responses)
    }

    /// `modes` has the force and the response of record $r$ as its ports number $r$.
    pub(crate) fn matched(&self, modes: &ModalModel) -> Vec<Option<ModeMatch>> {
        let candidates = candidates(modes);
        let partner = |(index, assurance): (usize, Option<f64>)| ModeMatch {
            mode: index + 1,
            frequency: candidates[index].0 / TAU,
            assurance,
        };
        self.partners(&candidates, |_| APART).into_iter().map(|found| found.map(partner)).collect()
    }

    /// Of each pole the number of its partner among predicted modes, given by $\omega$ and $W_r$ of each record, and their modal
    /// assurance criterion; `apart` is the standard deviation of the logarithm of the frequency of such a mode.
    pub(crate) fn partners(&self, candidates: &[(f64, Vec<f64>)], apart: impl Fn(usize) -> f64) -> Vec<Partner> {
        self.assigned(candidates, apart, |_| ALONE).0
    }

    /// The same with what each pole costs that stays alone, and the cost of all. Of a list whose poles have names a candidate's shape is its
    /// deflection at the places of [`NamedShapes`](orthopanel_model::NamedShapes).
    pub(crate) fn assigned(
        &self,
        candidates: &[(f64, Vec<f64>)],
        apart: impl Fn(usize) -> f64,
        alone: impl Fn(usize) -> f64,
    ) -> (Vec<Partner>, f64) {
        let pairs = |pole: usize| {
            let of = |(index, (omega, shape)): (usize, &(f64, Vec<f64>))| {
                let assurance = self.assurance(pole, shape);
                let apart = (self.poles[pole].angular_frequency / omega).ln() / apart(index);
                // What a list names another shape is another mode.
                let worth = if self.records.is_empty() { alone(pole) } else { SHAPE };
                let of_shape = assurance.map_or_else(|| self.unlikeness(pole, shape), |mac| worth * (1.0 - mac));
                (apart * apart + of_shape, assurance)
            };
            candidates.iter().enumerate().map(of).collect::<Vec<_>>()
        };
        let pairs: Vec<Vec<(f64, Option<f64>)>> = (0..self.poles.len()).map(pairs).collect();
        if pairs.is_empty() {
            return (vec![], 0.0);
        }
        // One column more a pole, in which it stays alone.
        let cost_of =
            |pole: usize, column: usize| pairs[pole].get(column).map_or(alone(pole), |(cost, _)| cost.min(alone(pole)));
        let cost = |(pole, column): (usize, usize)| (UNIT * cost_of(pole, column)).round() as i64;
        let (_, columns) = kuhn_munkres_min(&Matrix::from_fn(pairs.len(), candidates.len() + pairs.len(), cost));
        let total = columns.iter().enumerate().map(|(pole, column)| cost_of(pole, *column)).sum();
        let partner = |(pole, column): (usize, usize)| {
            let (cost, assurance) = *pairs[pole].get(column)?;
            (cost < alone(pole)).then_some((column, assurance))
        };
        (columns.into_iter().enumerate().map(partner).collect(), total)
    }

    /// $W_r$ of a pole, about: a lightly damped mode has the residue $j\omega W/2$.
    pub(crate) fn product(&self, record: usize, pole: usize) -> f64 {
        2.0 * self.records[record].residues[pole].im / self.poles[pole].angular_frequency
    }

    /// How far a pole of one record is from a mode by size and sign, squared in standard deviations.
    fn unlikeness(&self, pole: usize, shape: &[f64]) -> f64 {
        let (Some(&predicted), 1) = (shape.first(), self.records.len()) else { return 0.0 };
        let measured = self.product(0, pole);
        let size = ((predicted / measured).abs().max(f64::MIN_POSITIVE).ln() / SIZE).powi(2).min(MOST_BY_SIZE);
        size + if predicted * measured < 0.0 { SIGN } else { 0.0 }
    }

    fn assurance(&self, pole: usize, shape: &[f64]) -> Option<f64> {
        if self.records.is_empty() {
            return self.named.share(pole, shape);
        }
        if self.records.len() < 2 {
            return None;
        }
        let (mut dot, mut left, mut right) = (Complex64::ZERO, 0.0, 0.0);
        for (record, product) in self.records.iter().zip(shape) {
            let residue = record.residues[pole];
            dot += residue * product;
            left += residue.norm_sqr();
            right += product * product;
        }
        Some(if left * right > 0.0 { dot.norm_sqr() / (left * right) } else { 0.0 })
    }
}

/// Up to so many times the highest pole modes of the model are looked at,
const ABOVE: f64 = 1.5;
/// and shown beside the poles.
const JUST_ABOVE: f64 = 1.05;

/// $\omega$ and $W_r$ of each record for every flexible mode.
fn candidates(modes: &ModalModel) -> Vec<(f64, Vec<f64>)> {
    let candidate = |mode: &orthopanel_model::Mode| {
        let shape = mode.at_forces.iter().zip(&mode.at_responses).map(|(force, response)| force * response);
        (mode.angular_frequency, shape.collect::<Vec<f64>>())
    };
    modes.flexible().map(candidate).collect()
}

#[cfg(test)]
mod tests {
    use faer::Mat;

    use super::*;
    use crate::measured::{MeasuredRecord, Pole};

    /// Two modes whose order is not that of the model's: shapes decide.
    #[test]
    fn val_shapes_part_modes_that_changed_places() {
        let mode = |frequency: f64, at_forces: [f64; 3]| orthopanel_model::Mode {
            angular_frequency: TAU * frequency,
            damping_ratio: 0.0,
            at_forces: at_forces.to_vec(),
            at_responses: vec![1.0; 3],
        };
        let shapes = [[0.5, -0.4, 0.6], [0.3, 0.7, 0.1]];
        let modes =
            vec![mode(0.0, [1.0; 3]), mode(500.0, shapes[0]), mode(505.0, shapes[1]), mode(900.0, [0.2, 0.1, -0.5])];
        let modes = ModalModel::new(3, 3, modes).expect("a model");
        let place = Place { x: 0.0, y: 0.0 };
        let record = |r: usize| MeasuredRecord {
            force_at: place,
            response_at: place,
            residues: vec![Complex64::I * shapes[1][r], Complex64::I * shapes[0][r], Complex64::I * 0.1],
            remainder: vec![],
        };
        let pole = |frequency: f64| Pole { angular_frequency: TAU * frequency, damping_ratio: None };
        let measured = MeasuredModes {
            piece: 0,
            poles: vec![pole(501.0), pole(504.0), pole(5000.0)],
            beside: vec![],
            records: (0..3).map(record).collect(),
            sensor_at: None,
            remainder_frequencies: vec![],
            band: [5.0, 6000.0],
            covariance: Mat::zeros(0, 0),
            chi_square: None,
            missed_most: None,
            undone_decay: 0.0,
            named: orthopanel_model::NamedShapes::default(),
            order: vec![],
        };
        let matched = measured.matched(&modes);
        let numbers: Vec<Option<usize>> = matched.iter().map(|found| found.map(|found| found.mode)).collect();
        assert_eq!(numbers, [Some(2), Some(1), None]);
        assert!(
            matched.iter().flatten().all(|found| (found.assurance.unwrap_or(0.0) - 1.0).abs() < 1e-12),
            "{matched:?}"
        );
    }
}
