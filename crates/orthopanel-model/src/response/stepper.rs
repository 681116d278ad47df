//! [`ModalStepper`]: the state of all modes, advanced together.

use super::propagator::{Coefficients, LANES, Lane};
use crate::{ModalModel, ModelError};

/// What a group of modes keeps for good: $\omega^2$ and $2\zeta\omega$.
#[derive(Debug, Clone, Copy, Default)]
struct Group {
    stiffness: Lane,
    damping: Lane,
}

/// Modal coordinates and their rates of one group.
#[derive(Debug, Clone, Copy, Default)]
struct State {
    position: Lane,
    velocity: Lane,
}

/// [`Coefficients`] of one group.
#[derive(Debug, Clone, Copy, Default)]
struct Propagator {
    impulse: Lane,
    held: Lane,
    ramp: Lane,
    ramp_rate: Lane,
}

/// Advances the modes of a [`ModalModel`] exactly in time.
///
/// Each mode obeys eq. 20,
/// $$\ddot a + 2\zeta\omega\,\dot a + \omega^2 a = \sum_k W(x_k)\,f_k(t),$$
/// and is stepped by its own closed solution for a force held or linear over the step, so the step may have any
/// size: the result carries rounding only. The coefficients of the last step size are kept; steps of one size cost
/// no sine. No step allocates. What runs at each step is inlined, so that a caller compiled for wider vectors than
/// this crate gets them here too.
///
/// Units: force \[N\] along +z, time \[s\]; outputs \[m\], \[m/s\], \[m/s²\] at the response ports of the model,
/// each the sum over the modes that the model holds. A new stepper is at rest with no force.
#[derive(Debug, Clone)]
pub struct ModalStepper {
    mode_count: usize,
    parameters: Vec<[f64; 2]>,
    groups: Vec<Group>,
    /// Shape values, port after port, each in groups; modes that fill up the last group have none.
    at_forces: Vec<Vec<Lane>>,
    at_responses: Vec<Vec<Lane>>,
    /// Modal force now.
    force: Vec<Lane>,
    /// Modal force at the end of a linear step, while it is computed.
    force_after: Vec<Lane>,
    state: Vec<State>,
    state_after: Vec<State>,
    step: f64,
    propagators: Vec<Propagator>,
}

impl ModalStepper {
    /// A stepper at rest for the modes and ports of `model`.
    pub fn new(model: &ModalModel) -> Self {
        let modes = model.modes();
        let count = modes.len().div_ceil(LANES);
        let mut groups = vec![Group::default(); count];
        for (group, modes) in groups.iter_mut().zip(modes.chunks(LANES)) {
            for ((stiffness, damping), mode) in group.stiffness.iter_mut().zip(&mut group.damping).zip(modes) {
                *stiffness = mode.angular_frequency * mode.angular_frequency;
                *damping = 2.0 * mode.damping_ratio * mode.angular_frequency;
            }
        }
        let port = |values: Vec<f64>| values.chunks(LANES).map(lane).collect::<Vec<_>>();
        let at_forces = (0..model.force_count())
            .map(|k| port(modes.iter().filter_map(|mode| mode.at_forces.get(k).copied()).collect()))
            .collect();
        let at_responses = (0..model.response_count())
            .map(|k| port(modes.iter().filter_map(|mode| mode.at_responses.get(k).copied()).collect()))
            .collect();
        Self {
            mode_count: modes.len(),
            parameters: modes.iter().map(|mode| [mode.angular_frequency, mode.damping_ratio]).collect(),
            groups,
            at_forces,
            at_responses,
            force: vec![Lane::default(); count],
            force_after: vec![Lane::default(); count],
            state: vec![State::default(); count],
            state_after: vec![State::default(); count],
            step: 0.0,
            propagators: vec![Propagator::default(); count],
        }
    }

    /// Sets the force now \[N\], one value a force port; accelerations answer at once (direct feedthrough).
    ///
    /// # Errors
    /// [`ModelError::ForceCount`], [`ModelError::NotFinite`]; the force stays as it was.
    #[inline(always)]
    pub fn set_forces(&mut self, forces: &[f64]) -> Result<(), ModelError> {
        self.check_forces(forces)?;
        project(&self.at_forces, forces, &mut self.force_after);
        if let Some(&value) = self.force_after.iter().flatten().find(|value| !value.is_finite()) {
            return Err(ModelError::NotFinite { what: "modal force", value });
        }
        std::mem::swap(&mut self.force, &mut self.force_after);
        Ok(())
    }

    /// Advances by `step` \[s\] under the force now, held.
    ///
    /// # Errors
    /// [`ModelError::Size`] for a step that is not above zero, [`ModelError::NotFinite`] where a state would
    /// overflow; the state stays as it was.
    #[inline(always)]
    pub fn advance_held(&mut self, step: f64) -> Result<(), ModelError> {
        self.prepare(step)?;
        self.advance_prepared::<false>()
    }

    /// Advances by `step` \[s\] under a force that runs linearly from the force now to `forces` \[N\], which is then
    /// the force now.
    ///
    /// # Errors
    /// As [`ModalStepper::set_forces`] and [`ModalStepper::advance_held`]; state and force stay as they were.
    #[inline(always)]
    pub fn advance_linear(&mut self, step: f64, forces: &[f64]) -> Result<(), ModelError> {
        self.check_forces(forces)?;
        self.prepare(step)?;
        project(&self.at_forces, forces, &mut self.force_after);
        self.advance_prepared::<true>()?;
        std::mem::swap(&mut self.force, &mut self.force_after);
        Ok(())
    }

    /// Displacement $w = \sum W a$ \[m\] at a response port, counted from 0; `None` where there is no such port.
    #[inline(always)]
    pub fn displacement(&self, response: usize) -> Option<f64> {
        let shape = self.at_responses.get(response)?;
        Some(sum(shape, &self.state, |state, i| state.position[i]))
    }

    /// Velocity \[m/s\] at a response port, counted from 0.
    #[inline(always)]
    pub fn velocity(&self, response: usize) -> Option<f64> {
        let shape = self.at_responses.get(response)?;
        Some(sum(shape, &self.state, |state, i| state.velocity[i]))
    }

    /// Acceleration $\sum W(p - 2\zeta\omega\dot a - \omega^2 a)$ \[m/s²\] at a response port under the force now.
    #[inline(always)]
    pub fn acceleration(&self, response: usize) -> Option<f64> {
        let shape = self.at_responses.get(response)?;
        let modes = self.state.iter().zip(&self.groups).zip(&self.force);
        Some(sum(shape, modes, |((state, group), force), i| {
            force[i] - group.damping[i] * state.velocity[i] - group.stiffness[i] * state.position[i]
        }))
    }

    /// Modal coordinate $a$ \[m kg^1/2\] and its rate $\dot a$ of each mode, in the order of the model.
    pub fn state(&self) -> Vec<[f64; 2]> {
        (0..self.mode_count).filter_map(|mode| self.mode_state(mode)).collect()
    }

    /// $a$ and $\dot a$ of one mode, counted from 0; `None` where there is no such mode.
    pub fn mode_state(&self, mode: usize) -> Option<[f64; 2]> {
        let (group, i) = (self.state.get(mode / LANES)?, mode % LANES);
        (mode < self.mode_count).then(|| [group.position[i], group.velocity[i]])
    }

    /// $\dot a$ and $\ddot a = p - 2\zeta\omega\dot a - \omega^2 a$ of one mode under the force now, counted from 0;
    /// `None` where there is no such mode.
    pub fn mode_rate(&self, mode: usize) -> Option<[f64; 2]> {
        let [position, velocity] = self.mode_state(mode)?;
        let (index, i) = (mode / LANES, mode % LANES);
        let (group, force) = (self.groups.get(index)?, self.force.get(index)?);
        Some([velocity, force[i] - group.damping[i] * velocity - group.stiffness[i] * position])
    }

    /// Puts back what [`ModalStepper::state`] gave.
    ///
    /// # Errors
    /// [`ModelError::StateCount`] for another number of modes, [`ModelError::NotFinite`]; the state stays as it was.
    pub fn set_state(&mut self, state: &[[f64; 2]]) -> Result<(), ModelError> {
        if state.len() != self.mode_count {
            return Err(ModelError::StateCount { found: state.len(), expected: self.mode_count });
        }
        if let Some(&value) = state.iter().flatten().find(|value| !value.is_finite()) {
            return Err(ModelError::NotFinite { what: "modal state", value });
        }
        for (group, modes) in self.state.iter_mut().zip(state.chunks(LANES)) {
            for ((position, velocity), mode) in group.position.iter_mut().zip(&mut group.velocity).zip(modes) {
                [*position, *velocity] = *mode;
            }
        }
        Ok(())
    }

    /// Sets $a$ and $\dot a$ of one mode, counted from 0.
    ///
    /// # Errors
    /// [`ModelError::StateCount`] where there is no such mode, [`ModelError::NotFinite`]; the state stays as it was.
    pub fn set_mode_state(&mut self, mode: usize, state: [f64; 2]) -> Result<(), ModelError> {
        if let Some(&value) = state.iter().find(|value| !value.is_finite()) {
            return Err(ModelError::NotFinite { what: "modal state", value });
        }
        let group = self.state.get_mut(mode / LANES).filter(|_| mode < self.mode_count);
        let group = group.ok_or(ModelError::StateCount { found: mode.saturating_add(1), expected: self.mode_count })?;
        (group.position[mode % LANES], group.velocity[mode % LANES]) = (state[0], state[1]);
        Ok(())
    }

    #[inline(always)]
    fn check_forces(&self, forces: &[f64]) -> Result<(), ModelError> {
        if forces.len() != self.at_forces.len() {
            return Err(ModelError::ForceCount { found: forces.len(), expected: self.at_forces.len() });
        }
        match forces.iter().find(|force| !force.is_finite()) {
            Some(&value) => Err(ModelError::NotFinite { what: "force", value }),
            None => Ok(()),
        }
    }

    /// Makes the coefficients for `step`, unless the last step had the same size.
    #[inline(always)]
    fn prepare(&mut self, step: f64) -> Result<(), ModelError> {
        if step == self.step { Ok(()) } else { self.make_propagators(step) }
    }

    #[cold]
    fn make_propagators(&mut self, step: f64) -> Result<(), ModelError> {
        if !(step.is_finite() && step > 0.0) {
            return Err(ModelError::Size { name: "step", value: step, unit: "s" });
        }
        // Should a mode refuse the step, the coefficients are half old, half new: forget which step they are for.
        self.step = 0.0;
        for (group, modes) in self.propagators.iter_mut().zip(self.parameters.chunks(LANES)) {
            for (i, &[omega, zeta]) in modes.iter().enumerate() {
                let new = Coefficients::new(omega, zeta, step);
                if !new.is_finite() {
                    return Err(ModelError::NotFinite { what: "angular frequency times step", value: omega * step });
                }
                (group.impulse[i], group.held[i]) = (new.impulse, new.held);
                (group.ramp[i], group.ramp_rate[i]) = (new.ramp, new.ramp_rate);
            }
        }
        self.step = step;
        Ok(())
    }

    /// The step itself, from `state` to `state_after`, which then change places. Where the force is not `LINEAR` it
    /// stays, `force_after` is not read, and the compiler leaves its loads out.
    #[inline(always)]
    fn advance_prepared<const LINEAR: bool>(&mut self) -> Result<(), ModelError> {
        let forces = self.force.iter().zip(&self.force_after);
        let modes = self.groups.iter().zip(&self.propagators).zip(forces);
        // A sum of zeros that only an infinity or a NaN can spoil: cheaper than asking each number.
        let mut zero = Lane::default();
        for ((before, after), ((group, by), (force, force_after))) in
            self.state.iter().zip(&mut self.state_after).zip(modes)
        {
            for i in 0..LANES {
                let (a, v, p) = (before.position[i], before.velocity[i], force[i]);
                let change = if LINEAR { force_after[i] - p } else { 0.0 };
                let elastic = p - group.stiffness[i] * a;
                let acceleration = elastic - group.damping[i] * v;
                after.position[i] = a + by.impulse[i] * v + by.held[i] * elastic;
                after.velocity[i] = v + by.impulse[i] * acceleration - group.stiffness[i] * by.held[i] * v;
                if LINEAR {
                    after.position[i] += by.ramp[i] * change;
                    after.velocity[i] += by.ramp_rate[i] * change;
                }
                zero[i] += 0.0 * after.position[i] + 0.0 * after.velocity[i];
            }
        }
        let zero: f64 = zero.iter().sum();
        if zero != 0.0 || zero.is_nan() {
            return Err(ModelError::NotFinite { what: "modal state after the step", value: zero });
        }
        std::mem::swap(&mut self.state, &mut self.state_after);
        Ok(())
    }
}

/// Up to [`LANES`] numbers, filled up with zeros.
fn lane(values: &[f64]) -> Lane {
    let mut lane = Lane::default();
    for (to, from) in lane.iter_mut().zip(values) {
        *to = *from;
    }
    lane
}

/// Modal forces $p = \sum_k W(x_k) f_k$.
#[inline(always)]
fn project(at_forces: &[Vec<Lane>], forces: &[f64], modal: &mut [Lane]) {
    modal.fill(Lane::default());
    for (shape, &force) in at_forces.iter().zip(forces) {
        for (p, w) in modal.iter_mut().zip(shape) {
            for i in 0..LANES {
                p[i] += w[i] * force;
            }
        }
    }
}

/// $\sum_m W_m q_m$ with `quantity` giving $q$ of a lane.
#[inline(always)]
fn sum<T: Copy>(shape: &[Lane], modes: impl IntoIterator<Item = T>, quantity: impl Fn(T, usize) -> f64) -> f64 {
    let mut total = Lane::default();
    for (w, mode) in shape.iter().zip(modes) {
        for i in 0..LANES {
            total[i] += w[i] * quantity(mode, i);
        }
    }
    total.iter().sum()
}
