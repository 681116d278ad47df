//! [`ModalStepper`]: the state of all modes, advanced together.

use super::coupled::Coupled;
use super::lane::{LANES, Lane};
use super::mode_group::{Group, Turn, project, sum};
use super::propagator::Coefficients;
use crate::{ModalModel, Mode, ModelError};

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
    /// Largest $|W|$ at each force port: bounds every modal force.
    largest_at_forces: Vec<f64>,
    now: Turn,
    pub(super) step: f64,
    /// Where dampers or springs couple the modes: their step together, in place of each mode's own.
    pub(super) coupled: Option<Box<Coupled>>,
}

impl ModalStepper {
    /// Largest modal coordinate \[m kg^1/2\], rate and modal force, as a number. Its square is a number still, and so is
    /// each output: a step that is taken never leaves an acceleration that cannot be read.
    pub const LARGEST: f64 = 1e150;

    /// A stepper at rest for the modes and ports of `model`.
    pub fn new(model: &ModalModel) -> Self {
        let modes = model.modes();
        let count = modes.len().div_ceil(LANES);
        let mut groups = vec![Group::default(); count];
        for (group, modes) in groups.iter_mut().zip(modes.chunks(LANES)) {
            for (i, mode) in modes.iter().enumerate() {
                group.stiffness.0[i] = mode.angular_frequency * mode.angular_frequency;
                group.damping.0[i] = 2.0 * mode.damping_ratio * mode.angular_frequency;
            }
        }
        let port = |of: &dyn Fn(&Mode) -> Option<f64>| -> Vec<Lane> {
            let values: Vec<f64> = modes.iter().filter_map(of).collect();
            values.chunks(LANES).map(Lane::of).collect()
        };
        let at_forces: Vec<_> =
            (0..model.force_count()).map(|k| port(&|mode| mode.at_forces.get(k).copied())).collect();
        let at_responses =
            (0..model.response_count()).map(|k| port(&|mode| mode.at_responses.get(k).copied())).collect();
        let largest =
            |shape: &Vec<Lane>| shape.iter().flat_map(|lane| lane.0).fold(0.0, |most: f64, w| most.max(w.abs()));
        Self {
            mode_count: modes.len(),
            parameters: modes.iter().map(|mode| [mode.angular_frequency, mode.damping_ratio]).collect(),
            groups,
            largest_at_forces: at_forces.iter().map(largest).collect(),
            at_forces,
            at_responses,
            now: Turn::default(),
            step: 0.0,
            coupled: Coupled::new(model).map(Box::new),
        }
    }

    /// Sets the force now \[N\], one value a force port; accelerations answer at once (direct feedthrough).
    ///
    /// # Errors
    /// [`ModelError::ForceCount`], [`ModelError::NotFinite`], [`ModelError::TooLarge`]; the force stays as it was.
    #[inline(always)]
    pub fn set_forces(&mut self, forces: &[f64]) -> Result<(), ModelError> {
        self.check_forces(forces)?;
        project(&self.at_forces, forces, &mut self.groups, |group| &mut group.force);
        Ok(())
    }

    /// Advances by `step` \[s\] under the force now, held.
    ///
    /// # Errors
    /// [`ModelError::Size`] for a step that is not above zero, [`ModelError::TooLarge`] where a state would pass
    /// [`ModalStepper::LARGEST`]; the state stays as it was.
    #[inline(always)]
    pub fn advance_held(&mut self, step: f64) -> Result<(), ModelError> {
        self.prepare(step)?;
        self.advance_prepared::<false>()
    }

    /// [`ModalStepper::set_forces`] and [`ModalStepper::advance_held`] of a model with one force port, in one pass over the
    /// modes.
    ///
    /// # Errors
    /// As these two. The state stays as it was; the force may be told or not.
    #[inline(always)]
    pub fn advance_under_one(&mut self, force: f64, step: f64) -> Result<(), ModelError> {
        let ([shape], [largest]) = (&self.at_forces[..], &self.largest_at_forces[..]) else {
            return Err(self.not_one_force());
        };
        let bound = force.abs() * largest;
        if !fits(bound) {
            return Err(no_force(&[force], bound));
        }
        // Two branches, since of one condition the compiler works out both sides before it branches.
        if self.coupled.is_some() {
            return self.advance_in_two(force, step);
        }
        if step != self.step {
            return self.advance_in_two(force, step);
        }
        let mut all = Lane::default();
        for (group, &w) in self.groups.iter_mut().zip(shape) {
            group.force = w * Lane::all(force);
            let after = group.state(self.now).stepped::<false>(group);
            *group.state_mut(self.now.next()) = after;
            all = all + after.squares();
        }
        self.arrive(all)
    }

    #[cold]
    fn advance_in_two(&mut self, force: f64, step: f64) -> Result<(), ModelError> {
        self.set_forces(&[force])?;
        self.advance_held(step)
    }

    #[cold]
    fn not_one_force(&self) -> ModelError {
        ModelError::ForceCount { found: 1, expected: self.at_forces.len() }
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
        project(&self.at_forces, forces, &mut self.groups, |group| &mut group.force_after);
        self.advance_prepared::<true>()?;
        for group in &mut self.groups {
            group.force = group.force_after;
        }
        Ok(())
    }

    /// Displacement $w = \sum W a$ \[m\] at a response port, counted from 0; `None` where there is no such port.
    #[inline(always)]
    pub fn displacement(&self, response: usize) -> Option<f64> {
        let shape = self.at_responses.get(response)?;
        Some(sum(shape, &self.groups, |group| group.state(self.now).position))
    }

    /// Velocity \[m/s\] at a response port, counted from 0.
    #[inline(always)]
    pub fn velocity(&self, response: usize) -> Option<f64> {
        let shape = self.at_responses.get(response)?;
        Some(sum(shape, &self.groups, |group| group.state(self.now).velocity))
    }

    /// Acceleration $\sum W(p - 2\zeta\omega\dot a - \omega^2 a)$ \[m/s²\] at a response port under the force now.
    #[inline(always)]
    pub fn acceleration(&self, response: usize) -> Option<f64> {
        let shape = self.at_responses.get(response)?;
        let by_itself = sum(shape, &self.groups, |group| {
            let state = group.state(self.now);
            group.force - group.damping * state.velocity - group.stiffness * state.position
        });
        Some(match &self.coupled {
            None => by_itself,
            Some(coupled) => by_itself - self.coupling_acceleration(coupled, shape),
        })
    }

    /// Modal coordinate $a$ \[m kg^1/2\] and its rate $\dot a$ of each mode, in the order of the model.
    pub fn state(&self) -> Vec<[f64; 2]> {
        (0..self.mode_count).filter_map(|mode| self.mode_state(mode)).collect()
    }

    /// $a$ and $\dot a$ of one mode, counted from 0; `None` where there is no such mode.
    pub fn mode_state(&self, mode: usize) -> Option<[f64; 2]> {
        let (state, i) = (self.groups.get(mode / LANES)?.state(self.now), mode % LANES);
        (mode < self.mode_count).then(|| [state.position.0[i], state.velocity.0[i]])
    }

    /// $\dot a$ and $\ddot a = p - 2\zeta\omega\dot a - \omega^2 a$ of one mode under the force now, counted from 0;
    /// `None` where there is no such mode.
    pub fn mode_rate(&self, mode: usize) -> Option<[f64; 2]> {
        let [position, velocity] = self.mode_state(mode)?;
        let (group, i) = (self.groups.get(mode / LANES)?, mode % LANES);
        let by_itself = group.force.0[i] - group.damping.0[i] * velocity - group.stiffness.0[i] * position;
        let coupling = self.coupled.as_ref().map_or(0.0, |coupled| coupled.force(mode, |n| self.state_of(n)));
        Some([velocity, by_itself - coupling])
    }

    fn state_of(&self, mode: usize) -> [f64; 2] {
        self.mode_state(mode).unwrap_or_default()
    }

    #[cold]
    fn coupling_acceleration(&self, coupled: &Coupled, shape: &[Lane]) -> f64 {
        let of_mode = |mode: usize| {
            let at = shape.get(mode / LANES).map_or(0.0, |lane| lane.0[mode % LANES]);
            at * coupled.force(mode, |n| self.state_of(n))
        };
        (0..self.mode_count).map(of_mode).sum()
    }

    /// Puts back what [`ModalStepper::state`] gave.
    ///
    /// # Errors
    /// [`ModelError::StateCount`] for another number of modes, [`ModelError::NotFinite`], [`ModelError::TooLarge`] beyond
    /// [`ModalStepper::LARGEST`]; the state stays as it was.
    pub fn set_state(&mut self, state: &[[f64; 2]]) -> Result<(), ModelError> {
        if state.len() != self.mode_count {
            return Err(ModelError::StateCount { found: state.len(), expected: self.mode_count });
        }
        if let Some(&value) = state.iter().flatten().find(|value| !fits(**value)) {
            return Err(refused("modal state", value));
        }
        for (group, modes) in self.groups.iter_mut().zip(state.chunks(LANES)) {
            let state = group.state_mut(self.now);
            for (i, mode) in modes.iter().enumerate() {
                [state.position.0[i], state.velocity.0[i]] = *mode;
            }
        }
        Ok(())
    }

    /// Sets $a$ and $\dot a$ of one mode, counted from 0.
    ///
    /// # Errors
    /// [`ModelError::StateCount`] where there is no such mode, else as [`ModalStepper::set_state`]; the state stays as it was.
    pub fn set_mode_state(&mut self, mode: usize, state: [f64; 2]) -> Result<(), ModelError> {
        if let Some(&value) = state.iter().find(|value| !fits(**value)) {
            return Err(refused("modal state", value));
        }
        let group = self.groups.get_mut(mode / LANES).filter(|_| mode < self.mode_count);
        let group = group.ok_or(ModelError::StateCount { found: mode.saturating_add(1), expected: self.mode_count })?;
        let of_group = group.state_mut(self.now);
        [of_group.position.0[mode % LANES], of_group.velocity.0[mode % LANES]] = state;
        Ok(())
    }

    #[inline(always)]
    fn check_forces(&self, forces: &[f64]) -> Result<(), ModelError> {
        if forces.len() != self.at_forces.len() {
            return Err(ModelError::ForceCount { found: forces.len(), expected: self.at_forces.len() });
        }
        // Where this bound fits, so does every modal force, and every force is a number.
        let mut bound = 0.0;
        for (force, largest) in forces.iter().zip(&self.largest_at_forces) {
            bound += force.abs() * largest;
        }
        if fits(bound) { Ok(()) } else { Err(no_force(forces, bound)) }
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
        for (group, modes) in self.groups.iter_mut().zip(self.parameters.chunks(LANES)) {
            for (i, &[omega, zeta]) in modes.iter().enumerate() {
                let new = Coefficients::new(omega, zeta, step);
                if !new.is_finite() {
                    return Err(ModelError::LongStep { step, angular_frequency: omega });
                }
                (group.impulse.0[i], group.held.0[i]) = (new.impulse, new.held);
                group.held_stiffness.0[i] = group.stiffness.0[i] * new.held;
                (group.ramp.0[i], group.ramp_rate.0[i]) = (new.ramp, new.ramp_rate);
            }
        }
        if let Some(coupled) = &mut self.coupled {
            coupled.prepare(step)?;
        }
        self.step = step;
        Ok(())
    }

    /// The step of modes that are coupled.
    #[cold]
    fn advance_coupled(&mut self, linear: bool) -> Result<(), ModelError> {
        let Some(coupled) = &mut self.coupled else { return Ok(()) };
        let now = self.now;
        let numbers = self.groups.iter().flat_map(|group| {
            let state = group.state(now);
            (0..LANES).map(move |i| {
                let (from, to) = (group.force.0[i], group.force_after.0[i]);
                [state.position.0[i], state.velocity.0[i], from, if linear { to - from } else { 0.0 }]
            })
        });
        let after = coupled.advance(numbers);
        if let Some(&value) = after.iter().flatten().find(|value| !fits(**value)) {
            return Err(refused(AFTER, value));
        }
        for (group, modes) in self.groups.iter_mut().zip(after.chunks(LANES)) {
            let state = group.state_mut(now);
            for (i, mode) in modes.iter().enumerate() {
                [state.position.0[i], state.velocity.0[i]] = *mode;
            }
        }
        Ok(())
    }

    /// The step itself, into the state after it, which then becomes the one now. Where the force is not `LINEAR` it
    /// stays, `force_after` is not read, and the compiler leaves its loads out.
    #[inline(always)]
    fn advance_prepared<const LINEAR: bool>(&mut self) -> Result<(), ModelError> {
        if self.coupled.is_some() {
            return self.advance_coupled(LINEAR);
        }
        let mut all = Lane::default();
        for group in &mut self.groups {
            let after = group.state(self.now).stepped::<LINEAR>(group);
            *group.state_mut(self.now.next()) = after;
            all = all + after.squares();
        }
        self.arrive(all)
    }

    /// Takes the state after the step, unless the sum of the squares of `all` its numbers tells that one is too large or none:
    /// cheaper than asking each.
    #[inline(always)]
    fn arrive(&mut self, all: Lane) -> Result<(), ModelError> {
        if !all.is_below(Self::LARGEST * Self::LARGEST) {
            return Err(refused(AFTER, all.sum().sqrt()));
        }
        self.now = self.now.next();
        Ok(())
    }
}

const AFTER: &str = "modal state after the step";

/// Not so for what is no number.
#[inline(always)]
fn fits(value: f64) -> bool {
    value.abs() <= ModalStepper::LARGEST
}

#[cold]
fn refused(what: &'static str, value: f64) -> ModelError {
    if value.is_finite() {
        ModelError::TooLarge { what, value, largest: ModalStepper::LARGEST }
    } else {
        ModelError::NotFinite { what, value }
    }
}

/// Which force is no number, or that with these forces a modal force is too large.
#[cold]
fn no_force(forces: &[f64], bound: f64) -> ModelError {
    match forces.iter().find(|force| !force.is_finite()) {
        Some(&value) => refused("force", value),
        None => refused("modal force", bound),
    }
}
