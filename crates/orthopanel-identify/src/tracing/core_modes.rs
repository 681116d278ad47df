//! What records see of a core that creeps: how far it moves each mode's frequency, and what it adds to each mode's damping.
//!
//! To first order in the law $g(s)$ of a [`CoreModulus`] mode $k$ has
//! $$\ln\omega_k = \mathrm{const} + \sum_ia_{ki}\ln c_i + b_k\ln|g(\mathrm i\omega_k)|,\qquad \zeta_k + b_k\arg g(\mathrm i\omega_k),$$
//! with the constants $c_i$ and $b_k = \partial\ln\omega_k/\partial\ln G_{zx}$. Strength, $\tau$, $\alpha$ and $G_{zx}$ move all of these
//! alike within a band: where the sum of squares hardly changes is a valley that bends in these four, and is straight in the
//! frequencies and the damping.

use std::f64::consts::TAU;

use faer::prelude::Solve;
use faer::{Mat, Side};
use num_complex::Complex64;
use orthopanel_model::{CoreModulus, ModelError};

use super::hypothesis::{Hypothesis, Switched};
use super::record_problem::{RecordProblem, State};

/// The effect.
pub(super) const CORE: &str = "viscoelastic-core";
/// Step of a constant's logarithm for a difference.
const STEP: f64 = 1e-3;
/// What a core's loss leaves at least of a mode's damping ratio: it has some other damping too.
const LEFT: f64 = 0.2;
/// Strengths between which a start's is sought, and how often that stretch is halved.
const STRENGTHS: (f64, f64) = (1e-3, 3.0);
const HALVINGS: usize = 12;
/// Starts of strengths below this one take this part of the loss that a panel's damping has room for, the others all of it.
const HALFWAY: f64 = 0.2;
const PART: f64 = 0.4;
/// Steps of Gauss and Newton back onto the frequencies, and the part of the curvature that holds them back.
const BACK: usize = 6;
const HELD_BACK: f64 = 1e-4;
/// No step back moves a coordinate further.
const LONGEST_BACK: f64 = 0.5;

/// Whether a hypothesis has such a core.
pub(super) fn creeps(hypothesis: &Hypothesis) -> bool {
    hypothesis.effects.iter().any(is_core)
}

fn is_core(on: &Switched) -> bool {
    on.effect.id() == CORE
}

/// How the modes of a panel follow its constants and its core.
pub(super) struct CoreModes {
    /// Angular frequencies of the modes whose damping is free \[rad/s\].
    omega: Vec<f64>,
    /// $a_{ki}$, a row a mode, a column a constant that is free.
    by_constants: Mat<f64>,
    /// $b_k$.
    by_shear: Vec<f64>,
}

/// A core among what a search moves.
struct Moved<'a> {
    on: &'a Switched,
    /// Of its first coordinate.
    column: usize,
}

impl Moved<'_> {
    fn law(&self, parameters: &[f64]) -> CoreModulus {
        let mut values = self.on.values.clone();
        for (free, &coordinate) in self.on.free.iter().zip(&parameters[self.column..]) {
            values[free.at] = free.value(coordinate);
        }
        CoreModulus { strength: values[0], tau: values[1], alpha: values[2] }
    }

    /// Derivatives of $b\ln g$ of one mode by the core's coordinates.
    fn slopes(&self, core: CoreModulus, (omega, by_shear): (f64, f64)) -> Vec<Complex64> {
        let values = [core.strength, core.tau, core.alpha];
        let line = core.line(Complex64::new(0.0, omega));
        let of = |at: usize| by_shear * line.by_numbers[at] / line.value;
        self.on.free.iter().map(|free| of(free.at) * free.slope(values[free.at])).collect()
    }

    fn columns(&self) -> std::ops::Range<usize> {
        self.column..self.column + self.on.free.len()
    }
}

impl CoreModes {
    /// Of a panel as it is without its core's law; `None` where a derivative fails, and of a plate.
    pub(super) fn of(problem: &RecordProblem, state: &State) -> Option<Self> {
        if state.hypothesis.holds_plate() {
            return None;
        }
        let effects = state.hypothesis.states(problem.records.len()).ok()?;
        let frequencies = |constants: [f64; 2]| -> Result<Vec<f64>, ModelError> {
            let mut modes = problem.setup.summed_frequencies(&constants.map(f64::exp), &effects)?;
            modes.truncate(state.zetas.len());
            Ok(modes)
        };
        let here = frequencies(state.constants).ok()?;
        let by = |index: usize| -> Option<Vec<f64>> {
            let mut moved = state.constants;
            moved[index] += STEP;
            let there = frequencies(moved).ok()?;
            Some(there.iter().zip(&here).map(|(there, here)| (there / here).ln() / STEP).collect())
        };
        let columns = [by(0)?, by(1)?];
        let free: Vec<usize> = (0..columns.len()).filter(|&index| problem.held[index].is_none()).collect();
        let by_constants = Mat::from_fn(here.len(), free.len(), |mode, column| columns[free[column]][mode]);
        let omega: Vec<f64> = here.into_iter().map(|frequency| TAU * frequency).collect();
        let [_, by_shear] = columns;
        (omega.len() == state.zetas.len()).then_some(Self { omega, by_constants, by_shear })
    }

    fn modes(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.omega.iter().copied().zip(self.by_shear.iter().copied())
    }

    /// What the core adds to each mode: real parts to the logarithm of its frequency, imaginary ones to its damping ratio.
    fn added(&self, core: CoreModulus) -> Vec<Complex64> {
        self.modes().map(|(omega, by)| by * core.line(Complex64::new(0.0, omega)).value.ln()).collect()
    }

    /// A start whose constants and damping are those of a base without its core: as strong as a part of what the damping of the
    /// modes below `band` \[Hz\] allows, for all loss of a core is in that, and with the core's part given back.
    pub(super) fn begun(&self, problem: &RecordProblem, mut state: State, band: f64) -> State {
        let zetas = state.zetas.clone();
        let Some(on) = state.hypothesis.effects.iter_mut().find(|on| is_core(on)) else { return state };
        let [strength, tau, alpha] = on.values[..] else { return state };
        let most = self.most_within(&zetas, CoreModulus { strength, tau, alpha }, band);
        let strength = if strength < HALFWAY { (PART * most).max(STRENGTHS.0) } else { most };
        on.values[0] = strength;
        let given = self.given_back(problem.parameters(&state), CoreModulus { strength, tau, alpha });
        problem.state(&given, &state)
    }

    /// The strength at which a law takes all the damping of one of the modes below `band` \[Hz\].
    fn most_within(&self, log_zetas: &[f64], core: CoreModulus, band: f64) -> f64 {
        let has_room = |strength: f64| {
            let added = self.added(CoreModulus { strength, ..core });
            let mut modes = added.iter().zip(log_zetas).zip(&self.omega);
            modes.all(|((added, log), omega)| *omega >= TAU * band || added.im <= log.exp())
        };
        let (mut low, mut high) = STRENGTHS;
        for _ in 0..HALVINGS {
            let middle = (low * high).sqrt();
            if has_room(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }

    /// Parameters of a base with what the core adds taken off its constants and damping.
    fn given_back(&self, mut given: Vec<f64>, core: CoreModulus) -> Vec<f64> {
        let added = self.added(core);
        let constants = self.by_constants.ncols();
        let wanted = Mat::from_fn(added.len(), 1, |mode, _| -added[mode].re);
        let normal = self.by_constants.transpose() * &self.by_constants;
        if let Ok(factor) = normal.llt(Side::Lower) {
            let change = factor.solve(self.by_constants.transpose() * wanted);
            given.iter_mut().zip(0..constants).for_each(|(value, row)| *value += change[(row, 0)]);
        }
        for (log, added) in given.iter_mut().skip(constants).zip(&added) {
            *log += (1.0 - added.im / log.exp()).max(LEFT).ln();
        }
        given
    }

    /// Where a step from `from` to `trial` ends that goes straight in frequencies and damping rather than in the core's own
    /// numbers: the same to first order. `None` where no core is on or it finds no such end.
    pub(super) fn straightened(&self, hypothesis: &Hypothesis, from: &[f64], trial: &[f64]) -> Option<Vec<f64>> {
        let (constants, modes) = (self.by_constants.ncols(), self.omega.len());
        let before = hypothesis.effects.iter().take_while(|on| !is_core(on)).map(|on| on.free.len()).sum::<usize>();
        let on = hypothesis.effects.iter().find(|on| is_core(on))?;
        let core = Moved { on, column: constants + modes + before };
        let targets = self.targets(&core, from, trial);
        let mut new = trial.to_vec();
        let unknown: Vec<usize> = (0..constants).chain(core.columns()).collect();
        for _ in 0..BACK {
            let law = core.law(&new);
            let here = self.added(law);
            let by: Vec<Vec<Complex64>> = self.modes().map(|mode| core.slopes(law, mode)).collect();
            let jacobian = Mat::from_fn(modes, unknown.len(), |mode, index| match unknown[index] {
                constant if constant < constants => self.by_constants[(mode, constant)],
                own => by[mode][own - core.column].re,
            });
            let missed = Mat::from_fn(modes, 1, |mode, _| {
                let linear: f64 = (0..constants).map(|c| self.by_constants[(mode, c)] * (new[c] - trial[c])).sum();
                targets[mode].re - here[mode].re - linear
            });
            let mut normal = jacobian.transpose() * &jacobian;
            for i in 0..unknown.len() {
                normal[(i, i)] = normal[(i, i)] * (1.0 + HELD_BACK) + f64::MIN_POSITIVE;
            }
            let change = normal.llt(Side::Lower).ok()?.solve(jacobian.transpose() * missed);
            for (row, &index) in unknown.iter().enumerate() {
                new[index] += change[(row, 0)].clamp(-LONGEST_BACK, LONGEST_BACK);
            }
        }
        let after = self.added(core.law(&new));
        for (mode, (target, after)) in targets.iter().zip(after).enumerate() {
            let at = constants + mode;
            let zeta = from[at].exp() * (1.0 + trial[at] - from[at]) + target.im - after.im;
            if zeta > LEFT * trial[at].exp() {
                new[at] = zeta.ln();
            }
        }
        new.iter().all(|value| value.is_finite()).then_some(new)
    }

    /// What the core adds to each mode at the end of a step, to first order.
    fn targets(&self, core: &Moved, from: &[f64], trial: &[f64]) -> Vec<Complex64> {
        let law = core.law(from);
        let of_mode = |(added, mode): (Complex64, (f64, f64))| {
            let steps = core.columns().map(|column| trial[column] - from[column]);
            added + core.slopes(law, mode).iter().zip(steps).map(|(by, step)| by * step).sum::<Complex64>()
        };
        self.added(law).into_iter().zip(self.modes()).map(of_mode).collect()
    }
}

#[cfg(test)]
mod tests {
    use orthopanel_model::{Piece, effect};

    use super::*;

    const VALUES: [f64; 3] = [0.3, 2e-4, 0.6];

    fn some_modes() -> CoreModes {
        let hertz = [300.0, 780.0, 1450.0, 2200.0, 3000.0, 3900.0, 4800.0];
        let by_shear: Vec<f64> = hertz.iter().map(|f| 0.5 * f / (f + 1500.0)).collect();
        let by_constants = Mat::from_fn(hertz.len(), 2, |mode, constant| match constant {
            0 => 0.5 - by_shear[mode],
            _ => by_shear[mode],
        });
        CoreModes { omega: hertz.iter().map(|f| TAU * f).collect(), by_constants, by_shear }
    }

    fn core() -> Hypothesis {
        let piece = Piece { length: 0.8, width: 0.1, thickness: 0.03, mass_per_area: 6.88 };
        let values = |name: &str| ["strength", "tau", "alpha"].iter().position(|own| *own == name).map(|at| VALUES[at]);
        let switched = Switched::new(effect(CORE).unwrap(), &piece, 1, values, |_| false);
        Hypothesis { effects: vec![switched] }
    }

    /// Logarithms of the frequencies and the damping ratios that these parameters stand for.
    fn seen(modes: &CoreModes, parameters: &[f64]) -> Vec<Complex64> {
        let hypothesis = core();
        let core = Moved { on: &hypothesis.effects[0], column: 2 + modes.omega.len() };
        let constants = |mode: usize| (0..2).map(|c| modes.by_constants[(mode, c)] * parameters[c]).sum::<f64>();
        let added = modes.added(core.law(parameters)).into_iter().enumerate();
        added.map(|(mode, added)| added + Complex64::new(constants(mode), parameters[2 + mode].exp())).collect()
    }

    fn apart(a: &[Complex64], b: &[Complex64]) -> f64 {
        a.iter().zip(b).map(|(a, b)| (a - b).norm_sqr()).sum::<f64>().sqrt()
    }

    /// A straight step in the parameters leaves its tangent with the square of its length, the bent one does by less than a
    /// twentieth of that; and both begin alike.
    #[test]
    fn val_a_step_is_straight_in_frequencies_and_damping() {
        let (modes, hypothesis) = (some_modes(), core());
        let from: Vec<f64> =
            [23.0, 20.0].into_iter().chain([0.01_f64.ln(); 7]).chain(hypothesis.coordinates()).collect();
        let way: Vec<f64> = [0.01, -0.08].into_iter().chain([0.1; 7]).chain([0.5, 0.4, -0.1]).collect();
        let to = |length: f64| -> Vec<f64> { from.iter().zip(&way).map(|(from, way)| from + length * way).collect() };
        let small = 1e-5;
        let (here, near) = (seen(&modes, &from), seen(&modes, &to(small)));
        for length in [0.25, 0.5, 1.0] {
            let tangent: Vec<Complex64> =
                here.iter().zip(&near).map(|(here, near)| here + (near - here) * (length / small)).collect();
            let bent = modes.straightened(&hypothesis, &from, &to(length)).unwrap();
            let (straight, bent) = (apart(&seen(&modes, &to(length)), &tangent), apart(&seen(&modes, &bent), &tangent));
            assert!(bent < 0.05 * straight, "{length}: {bent:e} {straight:e}");
        }
        let bent = modes.straightened(&hypothesis, &from, &to(1e-3)).unwrap();
        let off = bent.iter().zip(to(1e-3)).map(|(bent, straight)| (bent - straight).abs()).fold(0.0, f64::max);
        assert!(off < 1e-4, "{off:e}");
    }

    /// A start takes no more damping of any mode in the band than there is.
    #[test]
    fn val_a_start_is_as_strong_as_damping_allows() {
        let modes = some_modes();
        let logs: Vec<f64> = [0.01_f64, 0.006, 0.008, 0.003, 0.01, 0.01, 0.002].map(f64::ln).to_vec();
        let [strength, tau, alpha] = VALUES;
        let core = CoreModulus { strength, tau, alpha };
        let added = modes.added(CoreModulus { strength: modes.most_within(&logs, core, 4500.0), ..core });
        let room: Vec<f64> = added.iter().zip(&logs).take(6).map(|(added, log)| added.im / log.exp()).collect();
        let most = room.iter().fold(0.0_f64, |most, part| most.max(*part));
        assert!((0.99..=1.0).contains(&most), "{room:?}");
    }

    /// Constants and damping that a core's part is given back to leave frequencies and damping as they were without it.
    #[test]
    fn val_what_a_core_adds_is_given_back() {
        let modes = some_modes();
        let [_, tau, alpha] = VALUES;
        let core = CoreModulus { strength: 0.05, tau, alpha };
        let without: Vec<f64> = [23.0, 20.0].into_iter().chain([0.01_f64.ln(); 7]).collect();
        let given = modes.given_back(without.clone(), core);
        let added = modes.added(core);
        let moved = |mode: usize| (0..2).map(|c| modes.by_constants[(mode, c)] * (given[c] - without[c])).sum::<f64>();
        let left: f64 = added.iter().enumerate().map(|(mode, added)| (moved(mode) + added.re).powi(2)).sum();
        // Two constants make up for the most of what three numbers do to seven modes.
        assert!(left < 0.01 * added.iter().map(|added| added.re.powi(2)).sum::<f64>(), "{left:e} {added:?}");
        for (mode, added) in added.iter().enumerate() {
            assert!((given[2 + mode].exp() + added.im - 0.01).abs() < 1e-9, "{mode}");
        }
    }
}
