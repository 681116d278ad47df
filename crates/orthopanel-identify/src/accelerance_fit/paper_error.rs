//! The paper's second problem: eq. 23 under eq. 25, by downhill simplex with a penalty.

use orthopanel_model::{BeamConstants, ExactBeam, ModalModel, Mode, ModelError};

use super::Start;
use super::problem::AcceleranceProblem;
use crate::IdentifyError;
use crate::downhill_simplex::{Penalised, downhill_simplex};

/// Weights of eq. 23 as in section 3.4 of the paper.
const FREQUENCY_WEIGHT: f64 = 0.1;
const MAGNITUDE_WEIGHT: f64 = 1e4;

/// One measured resonance point of one record.
struct ResonancePoint {
    mode: usize,
    frequency: f64,
    magnitude: f64,
}

/// Modes beyond the band that take part in the calculated accelerance.
const MODES_BEYOND: usize = 20;

/// Eq. 23, summed over the records,
/// $$W_f\sum_m\frac{(f_{exp}-f_{cal})^2}{f_{exp}^2} + W_G\sum_m\frac{(G(f_{exp})-G(f_{cal}))^2}{G(f_{exp})^2}$$
/// where $G$ is the magnitude at the measured and at the calculated resonance.
struct PaperError<'a> {
    problem: &'a AcceleranceProblem,
    start: &'a Start,
    /// For each piece, for each record, its resonance points.
    points: Vec<Vec<Vec<ResonancePoint>>>,
}

/// The minimum of eq. 23 from `parameters`, which are those of the likelihood.
pub(super) fn minimise(
    problem: &AcceleranceProblem,
    start: &Start,
    parameters: &[f64],
) -> Result<Vec<f64>, IdentifyError> {
    let points = problem.pieces.iter().enumerate().map(|(index, _)| resonance_points(problem, start, index)).collect();
    let error = PaperError { problem, start, points };
    downhill_simplex(&Penalised { error: |p: &[f64]| Ok(error.at(p)?), bounds: problem.bounds() }, parameters)
}

/// The greatest magnitude within three half-power widths of each matched pole.
fn resonance_points(problem: &AcceleranceProblem, start: &Start, piece: usize) -> Vec<Vec<ResonancePoint>> {
    let poles = start.pieces[piece].poles.iter().zip(&start.matching.modes[piece]);
    let matched: Vec<_> = poles.filter_map(|(pole, mode)| Some((pole, (*mode)?))).collect();
    let of_record = |record: &super::records::PlaceRecord| {
        let point = |&(pole, mode): &(&super::Pole, usize)| {
            let reach = 6.0 * pole.zeta * pole.frequency;
            let near = |f: f64| (f - pole.frequency).abs() <= reach.max(1e-3 * pole.frequency);
            let lines = (0..record.value.len()).filter(|&line| near(record.frequency[line]));
            let line = lines.max_by(|&a, &b| record.value[a].norm().total_cmp(&record.value[b].norm()))?;
            let magnitude = record.value[line].norm();
            (magnitude > 0.0).then_some(ResonancePoint { mode, frequency: record.frequency[line], magnitude })
        };
        matched.iter().filter_map(point).collect()
    };
    problem.pieces[piece].records.iter().map(of_record).collect()
}

impl PaperError<'_> {
    fn at(&self, parameters: &[f64]) -> Result<f64, ModelError> {
        let [e_x, g_zx] = self.problem.values(parameters);
        let mut sum = 0.0;
        for (index, piece) in self.problem.pieces.iter().enumerate() {
            let boundary = self.start.poles[index].boundary;
            let beam = ExactBeam::new(&piece.sizes, boundary, BeamConstants { e_x, g_zx })?;
            let modes = beam.modes(piece.free_zetas + MODES_BEYOND);
            let rigid = boundary.rigid_modes();
            let offset = self.problem.zeta_offset(index);
            let zetas = &parameters[offset..offset + piece.free_zetas];
            for (record, points) in piece.records.iter().zip(&self.points[index]) {
                let seen = modes.iter().enumerate().map(|(number, mode)| Mode {
                    angular_frequency: mode.angular_frequency(),
                    damping_ratio: match number.checked_sub(rigid) {
                        None => 0.0,
                        Some(number) => zetas.get(number).or(zetas.last()).map_or(0.0, |zeta| zeta.exp()),
                    },
                    at_forces: vec![mode.deflection(record.force_at.x)],
                    at_responses: vec![mode.deflection(record.response_at.x)],
                });
                let model = ModalModel::new(1, 1, seen.collect())?;
                for point in points {
                    let Some(mode) = model.modes().get(rigid + point.mode) else { continue };
                    let (frequency, magnitude) = resonance(&model, mode);
                    sum += FREQUENCY_WEIGHT * (frequency / point.frequency - 1.0).powi(2)
                        + MAGNITUDE_WEIGHT * (magnitude / point.magnitude - 1.0).powi(2);
                }
            }
        }
        Ok(sum)
    }
}

/// Frequency and magnitude of the calculated resonance of a mode: golden section within two half-power widths.
fn resonance(model: &ModalModel, mode: &Mode) -> (f64, f64) {
    let natural = mode.angular_frequency / std::f64::consts::TAU;
    let width = 2.0 * mode.damping_ratio.max(1e-7) * natural;
    let magnitude = |f: f64| model.accelerance(0, 0, f).norm();
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut low, mut high) = (natural - 2.0 * width, natural + 2.0 * width);
    let (mut left, mut right) = (high - golden * (high - low), low + golden * (high - low));
    let (mut at_left, mut at_right) = (magnitude(left), magnitude(right));
    for _ in 0..30 {
        if at_left > at_right {
            (high, right, at_right) = (right, left, at_left);
            left = high - golden * (high - low);
            at_left = magnitude(left);
        } else {
            (low, left, at_left) = (left, right, at_right);
            right = low + golden * (high - low);
            at_right = magnitude(right);
        }
    }
    (0.5 * (low + high), at_left.max(at_right))
}
