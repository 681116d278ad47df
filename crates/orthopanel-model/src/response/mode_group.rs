//! Modes side by side: what a group of them is stepped with, and the sums over all groups.

use super::lane::Lane;

/// What is known of a group of modes, all that a step reads in one place.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Group {
    /// The state now and the one after the step, in turns: [`Turn`] tells which is which.
    pub states: [State; 2],
    /// $\omega^2$ and $2\zeta\omega$.
    pub stiffness: Lane,
    pub damping: Lane,
    /// [`Coefficients`](super::propagator::Coefficients) of the last step size.
    pub impulse: Lane,
    pub held: Lane,
    /// $\omega^2$ times that.
    pub held_stiffness: Lane,
    pub ramp: Lane,
    pub ramp_rate: Lane,
    /// Modal force now, and at the end of a linear step while that is computed.
    pub force: Lane,
    pub force_after: Lane,
}

/// Which of the two states of all groups is the one now. To pass a step on is to turn, and to refuse it is not to.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Turn(bool);

impl Turn {
    #[inline(always)]
    pub fn next(self) -> Self {
        Self(!self.0)
    }
}

impl Group {
    #[inline(always)]
    pub fn state(&self, turn: Turn) -> &State {
        &self.states[usize::from(turn.0)]
    }

    #[inline(always)]
    pub fn state_mut(&mut self, turn: Turn) -> &mut State {
        &mut self.states[usize::from(turn.0)]
    }
}

/// Modal coordinates and their rates of one group.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct State {
    pub position: Lane,
    pub velocity: Lane,
}

impl State {
    /// $a^2 + \dot a^2$ of each mode.
    #[inline(always)]
    pub fn squares(&self) -> Lane {
        self.position * self.position + self.velocity * self.velocity
    }

    /// The state after the step for which the group's coefficients are made.
    #[inline(always)]
    pub fn stepped<const LINEAR: bool>(self, group: &Group) -> Self {
        let Self { position: a, velocity: v } = self;
        let elastic = group.force - group.stiffness * a;
        let acceleration = elastic - group.damping * v;
        let mut position = a + group.impulse * v + group.held * elastic;
        let mut velocity = v + group.impulse * acceleration - group.held_stiffness * v;
        if LINEAR {
            let change = group.force_after - group.force;
            position = position + group.ramp * change;
            velocity = velocity + group.ramp_rate * change;
        }
        Self { position, velocity }
    }
}

/// Modal forces $p = \sum_k W(x_k) f_k$, written where `place` says.
#[inline(always)]
pub(super) fn project(
    at_forces: &[Vec<Lane>],
    forces: &[f64],
    groups: &mut [Group],
    place: impl Fn(&mut Group) -> &mut Lane,
) {
    for (port, (shape, &force)) in at_forces.iter().zip(forces).enumerate() {
        for (group, &w) in groups.iter_mut().zip(shape) {
            let modal = place(group);
            let term = w * Lane::all(force);
            *modal = if port == 0 { term } else { *modal + term };
        }
    }
}

/// $\sum_m W_m q_m$ with `quantity` giving $q$ of a group.
#[inline(always)]
pub(super) fn sum(shape: &[Lane], groups: &[Group], quantity: impl Fn(&Group) -> Lane) -> f64 {
    let mut sums = Lane::default();
    for (&w, group) in shape.iter().zip(groups) {
        sums = sums + w * quantity(group);
    }
    sums.sum()
}
