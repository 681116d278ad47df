//! The paper's integration of eq. 27: classic Runge-Kutta with the measured force interpolated.
//!
//! [`ModalModel::acceleration_under`] is exact and quicker; this is the witness beside it.

use super::ForceRecord;
use crate::{ModalModel, Mode, ModelError};

/// Greatest $\omega h$ taken. The half disc of this radius in the left half plane, where every damped pole lies, is
/// inside the method's region of stability; on the imaginary axis alone $2\sqrt2$ would do.
const STABLE_UP_TO: f64 = 2.6;

impl ModalModel {
    /// Acceleration \[m/s²\] at each response port at the instants of the record, by the classic Runge-Kutta method of
    /// fourth order on the modal equations (eq. 27),
    /// $$\ddot y + \Lambda\dot y + \Omega y = T^Tf,$$
    /// with `steps` equal steps between two samples and the force interpolated linearly (section 3.5). The model is at
    /// rest before the first sample.
    ///
    /// A mode's phase runs off by $(\omega h)^4/120$ of itself, $h$ the step: for $10^{-8}$ of the peak after
    /// $n$ periods, $\omega h < (2\cdot10^{-7}/n)^{1/4}$, 0.02 at one period and 0.007 at a hundred.
    ///
    /// # Errors
    /// As [`ModalModel::acceleration_under`]; [`ModelError::Unsupported`] where damping couples the modes;
    /// [`ModelError::UnstableStep`] where the step is too long for a mode, and
    /// [`ModelError::Size`] for no steps at all.
    pub fn acceleration_by_runge_kutta(&self, record: &ForceRecord, steps: usize) -> Result<Vec<Vec<f64>>, ModelError> {
        record.check_ports(self)?;
        if steps == 0 {
            return Err(ModelError::Size { name: "steps between samples", value: 0.0, unit: "1" });
        }
        if !self.damping_coupling().is_empty() {
            return Err(ModelError::Unsupported("Runge-Kutta of modes that damping couples".into()));
        }
        self.check_stability(record.interval(), steps)?;
        let mut accelerations = vec![vec![0.0; record.count()]; self.response_count()];
        for mode in self.modes() {
            // Modes do not couple, so each runs through the whole record by itself.
            let modal = modal_acceleration(mode, &modal_force(mode, record), record.interval(), steps);
            for (acceleration, shape) in accelerations.iter_mut().zip(&mode.at_responses) {
                acceleration.iter_mut().zip(&modal).for_each(|(sum, value)| *sum += shape * value);
            }
        }
        match accelerations.iter().flatten().find(|value| !value.is_finite()) {
            Some(&value) => Err(ModelError::NotFinite { what: "acceleration", value }),
            None => Ok(accelerations),
        }
    }

    fn check_stability(&self, interval: f64, steps: usize) -> Result<(), ModelError> {
        let modes = self.modes().iter().map(|mode| mode.angular_frequency).enumerate();
        let Some((index, omega)) = modes.max_by(|(_, a), (_, b)| a.total_cmp(b)) else { return Ok(()) };
        // A number beyond usize saturates: it cannot be taken either.
        let needed = (omega * interval / STABLE_UP_TO).ceil() as usize;
        if steps < needed {
            let frequency = omega / std::f64::consts::TAU;
            return Err(ModelError::UnstableStep { mode: index + 1, frequency, steps, needed });
        }
        Ok(())
    }
}

/// $p = \sum_k W(x_k) f_k$ at each sample.
fn modal_force(mode: &Mode, record: &ForceRecord) -> Vec<f64> {
    let mut modal = vec![0.0; record.count()];
    for (shape, samples) in mode.at_forces.iter().zip(record.forces()) {
        modal.iter_mut().zip(samples).for_each(|(sum, force)| *sum += shape * force);
    }
    modal
}

/// $\ddot y$ at each sample.
fn modal_acceleration(mode: &Mode, force: &[f64], interval: f64, steps: usize) -> Vec<f64> {
    let equation = ModalEquation {
        stiffness: mode.angular_frequency * mode.angular_frequency,
        damping: 2.0 * mode.damping_ratio * mode.angular_frequency,
    };
    let step = interval / steps as f64;
    let mut state = [0.0; 2];
    let mut before = force.first().copied().unwrap_or_default();
    let mut accelerations = Vec::with_capacity(force.len());
    for (sample, &after) in force.iter().enumerate() {
        if sample > 0 {
            let at = |part: f64| before + part / steps as f64 * (after - before);
            for n in 0..steps {
                let n = n as f64;
                state = equation.advanced(state, [at(n), at(n + 0.5), at(n + 1.0)], step);
            }
            before = after;
        }
        accelerations.push(equation.rate(state, after)[1]);
    }
    accelerations
}

/// $\ddot y + 2\zeta\omega\dot y + \omega^2y = p$.
struct ModalEquation {
    /// $\omega^2$.
    stiffness: f64,
    /// $2\zeta\omega$.
    damping: f64,
}

impl ModalEquation {
    /// $(\dot y, \ddot y)$ of the state $(y, \dot y)$.
    fn rate(&self, [position, velocity]: [f64; 2], force: f64) -> [f64; 2] {
        [velocity, force - self.damping * velocity - self.stiffness * position]
    }

    /// One step, with the force at its start, middle and end.
    fn advanced(&self, state: [f64; 2], [start, middle, end]: [f64; 3], step: f64) -> [f64; 2] {
        let moved = |by: f64, [y, v]: [f64; 2]| [state[0] + by * y, state[1] + by * v];
        let first = self.rate(state, start);
        let second = self.rate(moved(0.5 * step, first), middle);
        let third = self.rate(moved(0.5 * step, second), middle);
        let fourth = self.rate(moved(step, third), end);
        let mean = |i: usize| (first[i] + 2.0 * (second[i] + third[i]) + fourth[i]) / 6.0;
        moved(step, [mean(0), mean(1)])
    }
}
