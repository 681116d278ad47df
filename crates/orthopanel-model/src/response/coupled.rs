//! The exact step of modes that dampers or springs couple: all of them together.

use faer::Mat;

use crate::dense::{dot, product};
use crate::{ModalModel, ModelError};

/// A scaled step below which [`TERMS`] of the power series leave nothing out: $0.5^{16}/16! < 10^{-18}$.
const SERIES_UP_TO: f64 = 0.5;
const TERMS: u32 = 15;

/// Modes with
/// $$\ddot a_m + 2\zeta_m\omega_m\dot a_m + \sum_n c_{mn}\dot a_n + \omega_m^2a_m + \sum_nk_{mn}a_n = p_m.$$
///
/// In $x = (s_ma_m, \dot a_m)$ this is $\dot x = Ax + Bp$, and for a $p$ that runs from $p_0$ by $\Delta p$ over $h$
/// $$x_1 - x = Ah\varphi_1x + h\varphi_1Bp_0 + h\varphi_2B\Delta p,\quad \varphi_k = \sum_{n\ge0}\frac{(Ah)^n}{(n+k)!}.$$
/// The series is summed for a fraction of the step, which is then doubled; increments are doubled, not states, so that a
/// short step loses nothing. Reference: N. J. Higham, Functions of Matrices (SIAM 2008), 10.7.4.
#[derive(Debug, Clone)]
pub(super) struct Coupled {
    /// $\omega$ and $2\zeta\omega$.
    modes: Vec<[f64; 2]>,
    damping: Vec<Vec<f64>>,
    stiffness: Vec<Vec<f64>>,
    /// Matrices of the last step sizes, the present one first.
    steps: Vec<StepMatrix>,
    /// How many matrices were made.
    #[cfg(test)]
    made: usize,
    /// State and forces of all modes.
    before: Vec<f64>,
    after: Vec<[f64; 2]>,
}

/// Step sizes whose matrices are kept. An importer that subtracts times passes steps that differ in the last bits: a handful
/// of values while the time stays within a factor of two. Each has its own matrix, so that no error is made.
const KEPT: usize = 8;

/// Numbers that all kept matrices together may have, unless two of them have more: 64 MiB.
const KEPT_NUMBERS: usize = 1 << 23;

/// What leads over one size of step.
#[derive(Debug, Clone)]
struct StepMatrix {
    /// \[s\]
    size: f64,
    /// A row an increment of $a$, then of $\dot a$; columns $a$, $\dot a$, $p_0$, $\Delta p$.
    rows: Vec<Vec<f64>>,
}

impl Coupled {
    /// `None` where nothing couples the modes.
    pub(super) fn new(model: &ModalModel) -> Option<Self> {
        let (damping, stiffness) = (model.damping_coupling().to_vec(), model.stiffness_coupling().to_vec());
        let of_mode = |mode: &crate::Mode| [mode.angular_frequency, 2.0 * mode.damping_ratio * mode.angular_frequency];
        let modes: Vec<_> = model.modes().iter().map(of_mode).collect();
        let (before, after) = (vec![0.0; 4 * modes.len()], vec![[0.0; 2]; modes.len()]);
        (!(damping.is_empty() && stiffness.is_empty())).then(|| Self {
            modes,
            damping,
            stiffness,
            steps: vec![],
            #[cfg(test)]
            made: 0,
            before,
            after,
        })
    }

    /// $\sum_nc_{mn}\dot a_n + k_{mn}a_n$ of mode `mode`; `state` gives $a_n$ and $\dot a_n$.
    pub(super) fn force(&self, mode: usize, state: impl Fn(usize) -> [f64; 2]) -> f64 {
        let sum = |coupling: &[Vec<f64>], of: usize| -> f64 {
            let row = coupling.get(mode).into_iter().flatten().enumerate();
            row.map(|(other, value)| value * state(other)[of]).sum()
        };
        sum(&self.damping, 1) + sum(&self.stiffness, 0)
    }

    /// $s_m$: of what the whole stiffness holds of a mode, so that strong springs between slow modes make no large numbers.
    fn scale(&self) -> Vec<f64> {
        let mut scale: Vec<f64> = self.modes.iter().map(|&[omega, _]| omega).collect();
        for row in &self.stiffness {
            scale.iter_mut().zip(row).for_each(|(own, coupling)| *own = own.max(coupling.abs().sqrt()));
        }
        // A rigid mode that nothing holds is not scaled: it has no frequency.
        scale.into_iter().map(|own| if own > 0.0 { own } else { 1.0 }).collect()
    }

    /// Makes the step's matrix, unless it is among those kept.
    ///
    /// # Errors
    /// [`ModelError::LongStep`] for a step too long to be computed.
    pub(super) fn prepare(&mut self, step: f64) -> Result<(), ModelError> {
        if let Some(place) = self.steps.iter().position(|kept| kept.size == step) {
            self.steps[..=place].rotate_right(1);
            return Ok(());
        }
        let made = StepMatrix { size: step, rows: self.matrix(step)? };
        let numbers = 8 * self.modes.len() * self.modes.len();
        self.steps.truncate((KEPT_NUMBERS / numbers.max(1)).clamp(2, KEPT) - 1);
        self.steps.insert(0, made);
        #[cfg(test)]
        (self.made += 1);
        Ok(())
    }

    fn matrix(&self, step: f64) -> Result<Vec<Vec<f64>>, ModelError> {
        let count = self.modes.len();
        let scale = self.scale();
        let mut generator = Mat::<f64>::zeros(2 * count, 2 * count);
        for (m, &[omega, loss]) in self.modes.iter().enumerate() {
            generator[(m, count + m)] = scale[m];
            generator[(count + m, m)] = -omega * omega / scale[m];
            for (n, coupling) in self.damping.get(m).into_iter().flatten().enumerate() {
                generator[(count + m, count + n)] = -coupling;
            }
            for (n, coupling) in self.stiffness.get(m).into_iter().flatten().enumerate() {
                generator[(count + m, n)] -= coupling / scale[n];
            }
            generator[(count + m, count + m)] -= loss;
        }
        let columns = generator.col_iter().map(|column| column.iter().map(|value| value.abs()).sum::<f64>());
        let size = step * columns.fold(0.0, f64::max);
        if !size.is_finite() {
            return Err(self.too_long(step));
        }
        let doublings = (size / SERIES_UP_TO).log2().ceil().max(0.0) as i32;
        let mut part = step * (-f64::from(doublings)).exp2();
        let generator = faer::Scale(part) * generator;
        let mut second = faer::Scale(1.0 / factorial(TERMS + 1)) * Mat::<f64>::identity(2 * count, 2 * count);
        for n in (0..TERMS - 1).rev() {
            second = product(generator.as_ref(), second.as_ref());
            let next = 1.0 / factorial(n + 2);
            (0..2 * count).for_each(|i| second[(i, i)] += next);
        }
        let mut first = product(generator.as_ref(), second.as_ref());
        (0..2 * count).for_each(|i| first[(i, i)] += 1.0);
        let mut free = product(generator.as_ref(), first.as_ref());
        let of_force = |matrix: &Mat<f64>| faer::Scale(part) * matrix.subcols(count, count);
        let (mut held, mut ramp) = (of_force(&first), of_force(&second));
        // The force of the whole step is reached in parts.
        let mut share = part / step;
        ramp = faer::Scale(share) * ramp;
        for _ in 0..doublings {
            ramp = faer::Scale(2.0) * &ramp + product(free.as_ref(), ramp.as_ref()) + faer::Scale(share) * &held;
            held = faer::Scale(2.0) * &held + product(free.as_ref(), held.as_ref());
            free = faer::Scale(2.0) * &free + product(free.as_ref(), free.as_ref());
            (part, share) = (2.0 * part, 2.0 * share);
        }
        let unscaled = |i: usize| if i < count { 1.0 / scale[i] } else { 1.0 };
        let row = |i: usize| {
            let own = (0..2 * count).map(|j| unscaled(i) * free[(i, j)] / unscaled(j));
            let forces = (0..count).map(|j| unscaled(i) * held[(i, j)]);
            let changes = (0..count).map(|j| unscaled(i) * ramp[(i, j)]);
            own.chain(forces).chain(changes).collect()
        };
        let rows: Vec<Vec<f64>> = (0..2 * count).map(row).collect();
        if rows.iter().flatten().all(|value| value.is_finite()) { Ok(rows) } else { Err(self.too_long(step)) }
    }

    fn too_long(&self, step: f64) -> ModelError {
        let angular_frequency = self.modes.iter().fold(0.0, |most: f64, &[omega, _]| most.max(omega));
        ModelError::LongStep { step, angular_frequency }
    }

    /// State of all modes after the step, from $a$, $\dot a$, $p_0$ and $\Delta p$ of each.
    pub(super) fn advance(&mut self, modes: impl Iterator<Item = [f64; 4]>) -> &[[f64; 2]] {
        let count = self.modes.len();
        for (m, values) in modes.take(count).enumerate() {
            values.into_iter().enumerate().for_each(|(kind, value)| self.before[kind * count + m] = value);
        }
        let rows = self.steps.first().map(|kept| kept.rows.as_slice()).unwrap_or_default();
        let change = |row: &Vec<f64>| dot(row, &self.before);
        for (m, after) in self.after.iter_mut().enumerate() {
            let changes = [m, count + m].map(|i| rows.get(i).map_or(f64::NAN, change));
            *after = [self.before[m] + changes[0], self.before[count + m] + changes[1]];
        }
        &self.after
    }
}

fn factorial(n: u32) -> f64 {
    (1..=n).map(f64::from).product()
}

#[cfg(test)]
mod tests {
    use crate::{ModalModel, ModalStepper, Mode};

    fn mode(omega: f64, zeta: f64, shape: f64) -> Mode {
        Mode { angular_frequency: omega, damping_ratio: zeta, at_forces: vec![shape], at_responses: vec![shape] }
    }

    /// Displacement, velocity and acceleration after each of some steps, held and linear by turns.
    fn motion(model: &ModalModel, step: f64) -> Vec<[f64; 3]> {
        let mut stepper = ModalStepper::new(model);
        let mut motion = Vec::new();
        for n in 0..12 {
            let force = f64::from(n * 5 % 7) - 2.0;
            if n % 2 == 0 {
                stepper.set_forces(&[force]).and_then(|()| stepper.advance_held(step)).unwrap();
            } else {
                stepper.advance_linear(step, &[force]).unwrap();
            }
            motion.push([stepper.displacement(0), stepper.velocity(0), stepper.acceleration(0)].map(Option::unwrap));
        }
        motion
    }

    fn assert_alike(found: &[[f64; 3]], expected: &[[f64; 3]], tolerance: f64) {
        for kind in 0..3 {
            let peak = expected.iter().fold(0.0, |most: f64, row| most.max(row[kind].abs()));
            for (found, expected) in found.iter().zip(expected) {
                let error = (found[kind] - expected[kind]).abs() / peak;
                assert!(error < tolerance, "{kind}: {error:e} of the peak");
            }
        }
    }

    /// A coupling on the diagonal alone is a greater damping ratio: the modes' own exact step is the authority.
    #[test]
    fn val_a_diagonal_coupling_is_a_damping_ratio() {
        let omegas = [0.0, 900.0, 2500.0, 7000.0, 40_000.0];
        let more = |m: usize| if m == 0 { 0.0 } else { 0.01 * m as f64 };
        let with = |extra: &dyn Fn(usize) -> f64| {
            let of = |(m, &omega): (usize, &f64)| mode(omega, extra(m), 1.0 / (1.0 + m as f64));
            ModalModel::new(1, 1, omegas.iter().enumerate().map(of).collect()).unwrap()
        };
        let row = |m: usize| (0..5).map(|n| if m == n { 2.0 * more(m) * omegas[m] } else { 0.0 }).collect();
        let coupled = with(&|_| 0.0).with_damping_coupling((0..5).map(row).collect()).unwrap();
        // Phases from 1e-6 to 40; each doubling of the step may double the rounding.
        for (step, tolerance) in [(1e-9, 1e-13), (1e-6, 1e-13), (1e-4, 1e-12), (1e-3, 1e-11)] {
            assert_alike(&motion(&coupled, step), &motion(&with(&more), step), tolerance);
        }
    }

    /// A spring on the diagonal alone is a higher frequency, and moves a rigid mode to one: the modes' own exact step is the authority.
    #[test]
    fn val_a_diagonal_spring_is_a_frequency() {
        let omegas = [0.0, 900.0, 2500.0, 7000.0];
        for stiffness in [1e3, 1e6, 1e9] {
            let spring = |m: usize| stiffness / (1.0 + m as f64);
            let list = |held: bool| {
                let of = |(m, &omega): (usize, &f64)| {
                    let whole = if held { (omega * omega + spring(m)).sqrt() } else { omega };
                    mode(whole, if omega > 0.0 { 0.01 * omega / whole } else { 0.0 }, 1.0 / (1.0 + m as f64))
                };
                ModalModel::new(1, 1, omegas.iter().enumerate().map(of).collect()).unwrap()
            };
            let rows = (0..4).map(|m| (0..4).map(|n| if m == n { spring(m) } else { 0.0 }).collect()).collect();
            let (held, coupled) = (list(true), list(false).with_stiffness_coupling(rows).unwrap());
            for (step, tolerance) in [(1e-7, 1e-12), (1e-5, 1e-11), (1e-4, 1e-10)] {
                assert_alike(&motion(&coupled, step), &motion(&held, step), tolerance);
            }
            for frequency in [40.0, 470.0, 2000.0] {
                let (found, expected) = (coupled.accelerance(0, 0, frequency), held.accelerance(0, 0, frequency));
                assert!((found - expected).norm() < 1e-10 * expected.norm(), "{frequency}: {found} {expected}");
            }
        }
    }

    /// Two modes of one frequency may be turned into each other: damped apart, they are coupled when turned.
    #[test]
    fn val_turned_modes_are_coupled() {
        let (omega, zetas, angle) = (3000.0, [0.005, 0.08], 0.6_f64);
        let (sine, cosine) = angle.sin_cos();
        let shapes = [1.3, -0.4];
        let apart = ModalModel::new(1, 1, vec![mode(omega, zetas[0], shapes[0]), mode(omega, zetas[1], shapes[1])]);
        let turned = [cosine * shapes[0] + sine * shapes[1], -sine * shapes[0] + cosine * shapes[1]];
        let [first, second] = zetas.map(|zeta| 2.0 * zeta * omega);
        let between = sine * cosine * (second - first);
        let coupling = vec![
            vec![cosine * cosine * first + sine * sine * second, between],
            vec![between, sine * sine * first + cosine * cosine * second],
        ];
        let coupled = ModalModel::new(1, 1, vec![mode(omega, 0.0, turned[0]), mode(omega, 0.0, turned[1])]);
        let (apart, coupled) = (apart.unwrap(), coupled.unwrap().with_damping_coupling(coupling).unwrap());
        assert_alike(&motion(&coupled, 2e-4), &motion(&apart, 2e-4), 1e-12);
        for frequency in [40.0, 470.0, 480.0, 2000.0] {
            let (found, expected) = (coupled.accelerance(0, 0, frequency), apart.accelerance(0, 0, frequency));
            assert!((found - expected).norm() < 1e-12 * expected.norm(), "{frequency}: {found} {expected}");
        }
    }

    fn coupled_pair() -> ModalModel {
        let modes = vec![mode(900.0, 0.002, 1.0), mode(2500.0, 0.002, -0.6)];
        let coupling = vec![vec![9.0, 4.0], vec![4.0, 25.0]];
        ModalModel::new(1, 1, modes).unwrap().with_damping_coupling(coupling).unwrap()
    }

    /// Steps as an importer passes that subtracts one communication point from the next: each size costs one matrix, and the
    /// motion is that of a stepper which makes every matrix anew.
    #[test]
    fn regress_steps_of_few_sizes_cost_few_matrices() {
        let mut stepper = ModalStepper::new(&coupled_pair());
        let mut fresh = stepper.clone();
        let mut sizes = std::collections::BTreeSet::new();
        let mut changes = 0;
        let mut last = 0.0;
        for n in 0..20_000 {
            let step = f64::from(n + 1) * 1e-4 - f64::from(n) * 1e-4;
            sizes.insert(step.to_bits());
            changes += usize::from(step != last);
            last = step;
            let force = f64::from(n % 7) - 3.0;
            for stepper in [&mut stepper, &mut fresh] {
                stepper.set_forces(&[force]).and_then(|()| stepper.advance_held(step)).unwrap();
            }
            if let Some(coupled) = &mut fresh.coupled {
                coupled.steps.clear();
                fresh.step = 0.0;
            }
        }
        let made = stepper.coupled.as_ref().map_or(0, |coupled| coupled.made);
        let made_fresh = fresh.coupled.as_ref().map_or(0, |coupled| coupled.made);
        assert_eq!(stepper.state(), fresh.state());
        assert_eq!(made_fresh, 20_000);
        assert!(changes > 4_000, "{changes} changes among {} sizes", sizes.len());
        assert!(made < 200, "{made} matrices for {changes} changes among {} sizes", sizes.len());
    }

    #[test]
    fn steps_too_long_are_refused_with_their_size() {
        let mut stepper = ModalStepper::new(&coupled_pair());
        let refused = stepper.advance_held(1e307).unwrap_err().to_string();
        assert!(refused.starts_with("step = 1e307 s: too long"), "{refused}");
        stepper.advance_held(1e-4).unwrap();
    }

    #[test]
    fn couplings_of_another_size_are_refused() {
        let model = ModalModel::new(1, 1, vec![mode(1.0, 0.0, 1.0)]).unwrap();
        for coupling in [vec![vec![]], vec![vec![0.0], vec![0.0]], vec![vec![f64::NAN]]] {
            assert!(model.clone().with_damping_coupling(coupling).is_err());
        }
    }
}
