//! The stepper against closed forms that it does not use, and against the laws it must keep.

use proptest::prelude::*;

use super::ModalStepper;
use crate::{ModalModel, Mode, ModelError};

/// One mode with unit shapes: its modal coordinate is the displacement.
fn oscillator(omega: f64, zeta: f64) -> ModalStepper {
    let mode = Mode { angular_frequency: omega, damping_ratio: zeta, at_forces: vec![1.0], at_responses: vec![1.0] };
    ModalStepper::new(&ModalModel::new(1, 1, vec![mode]).expect("a sound model"))
}

fn outputs(stepper: &ModalStepper) -> [f64; 3] {
    [stepper.displacement(0), stepper.velocity(0), stepper.acceleration(0)].map(|value| value.expect("port 0"))
}

/// Response of displacement, velocity and acceleration to a unit ramp of force that starts at rest, a time `t` after.
fn ramp_response(omega: f64, zeta: f64, t: f64) -> [f64; 3] {
    let damped = omega * (1.0 - zeta * zeta).sqrt();
    let decay = (-zeta * omega * t).exp();
    let (sine, cosine) = (damped * t).sin_cos();
    let impulse = decay * sine / damped;
    let unit_step = (1.0 - decay * (cosine + zeta * omega / damped * sine)) / (omega * omega);
    let ramp = (t - impulse - 2.0 * zeta * omega * unit_step) / (omega * omega);
    [ramp, unit_step, impulse]
}

/// Displacement, velocity and acceleration at `time` steps: the sum of the ramps that start where the force bends.
fn sum_of_ramps(omega: f64, zeta: f64, step: f64, forces: &[f64], time: f64) -> [f64; 3] {
    let slope = |n: usize| if n == 0 { 0.0 } else { (forces[n] - forces[n - 1]) / step };
    let mut sums = [0.0; 3];
    for start in (0..forces.len() - 1).take_while(|&start| (start as f64) < time) {
        let bend = slope(start + 1) - slope(start);
        for (sum, value) in sums.iter_mut().zip(ramp_response(omega, zeta, (time - start as f64) * step)) {
            *sum += bend * value;
        }
    }
    sums
}

/// Worst error over the run, each output against its own peak. The peak is looked for between the steps too: a step
/// of one period would see the same small part of each oscillation again and again, and a step of a hundred damped
/// periods would miss what follows each bend.
fn worst_error(omega: f64, zeta: f64, step: f64, forces: &[f64]) -> f64 {
    let mut stepper = oscillator(omega, zeta);
    let mut peaks = [0.0_f64; 3];
    let mut errors = [0.0_f64; 3];
    for n in 1..forces.len() {
        for part in [(1.5 / (omega * step)).min(0.2), 0.45, 0.7] {
            let between = sum_of_ramps(omega, zeta, step, forces, (n - 1) as f64 + part);
            peaks.iter_mut().zip(between).for_each(|(peak, value)| *peak = peak.max(value.abs()));
        }
        stepper.advance_linear(step, &forces[n..=n]).expect("a sound step");
        let expected = sum_of_ramps(omega, zeta, step, forces, n as f64);
        for (i, value) in outputs(&stepper).into_iter().enumerate() {
            errors[i] = errors[i].max((value - expected[i]).abs());
        }
    }
    errors.iter().zip(peaks).map(|(error, peak)| error / peak).fold(0.0, f64::max)
}

/// A force that bends at every step and starts at zero.
fn jagged(count: usize) -> Vec<f64> {
    (0..count).map(|n| if n == 0 { 0.0 } else { (2.3 * n as f64).sin() + 0.1 * (n % 3) as f64 }).collect()
}

#[test]
fn val_linear_force_meets_the_sum_of_ramps_at_any_step() {
    for zeta in [0.0, 1e-4, 3e-3, 0.1, 0.7, 0.99] {
        for phase in [0.3, 0.99, 1.01, 3.0, std::f64::consts::TAU, 40.0, 1e3] {
            let omega = 2000.0;
            let error = worst_error(omega, zeta, phase / omega, &jagged(60));
            assert!(error < 1e-12, "zeta {zeta}, omega h {phase}: {error:e} of the peak");
        }
    }
}

#[test]
fn val_short_steps_meet_the_sum_of_ramps() {
    // The sum itself loses (omega t)^-3 units in the last place, so it judges only once some periods have passed:
    // the run is long and the peaks are those of the whole run.
    let forces: Vec<f64> = (0..1500).map(|n| (0.011 * n as f64).sin()).collect();
    let error = worst_error(2000.0, 1e-3, 0.02 / 2000.0, &forces);
    assert!(error < 1e-12, "{error:e} of the peak");
}

#[test]
fn val_rigid_mode_moves_by_polynomials() {
    let mut stepper = oscillator(0.0, 0.0);
    stepper.set_forces(&[2.0]).expect("one force");
    stepper.advance_held(0.5).expect("step");
    assert_eq!(outputs(&stepper), [0.25, 1.0, 2.0]);
    // From 2 N to 5 N in 0.5 s: a = 0.25 + 0.5 + 2 h^2/2 + 3 h^2/6, v = 1 + 2 h + 3 h/2.
    stepper.advance_linear(0.5, &[5.0]).expect("step");
    let expected = [0.25 + 0.5 + 0.25 + 0.125, 1.0 + 1.0 + 0.75, 5.0];
    for (value, expected) in outputs(&stepper).into_iter().zip(expected) {
        assert!((value - expected).abs() <= 4.0 * f64::EPSILON * expected, "{value} {expected}");
    }
}

#[test]
fn val_tiny_phase_keeps_every_digit() {
    // Held force, undamped: x = 2 p sin^2(omega h/2)/omega^2, v = p sin(omega h)/omega, free of cancellation.
    for phase in [1e-12, 1e-6, 1e-3, 0.1, 0.9] {
        let (omega, step) = (phase * 1e3, 1e-3);
        let mut stepper = oscillator(omega, 0.0);
        stepper.set_forces(&[1.0]).expect("one force");
        stepper.advance_held(step).expect("step");
        let half = (omega * step / 2.0).sin();
        let expected = [2.0 * half * half / (omega * omega), (omega * step).sin() / omega];
        for (value, expected) in outputs(&stepper).into_iter().zip(expected) {
            assert!((value / expected - 1.0).abs() < 1e-15, "omega h {phase}: {value:e} {expected:e}");
        }
    }
}

#[test]
fn val_one_step_of_a_million_periods_keeps_its_phase() {
    // 2^20 periods of 2^-10 s: omega h is not a multiple of 2 pi by the rounding of 2 pi alone, which the exact
    // answer knows: its phase is -2^20 times the error of TAU, 2.449e-16 (2 pi = TAU + 2.449293598294706e-16).
    let omega = std::f64::consts::TAU * 1024.0;
    let periods = f64::from(1 << 20);
    let mut stepper = oscillator(omega, 0.0);
    stepper.set_state(&[[1.0, 0.0]]).expect("one mode");
    stepper.advance_held(periods / 1024.0).expect("step");
    let phase = -periods * 2.449293598294706e-16;
    let [position, velocity, _] = outputs(&stepper);
    assert!((position - 1.0).abs() < 1e-15, "{position}");
    assert!((velocity / omega + phase.sin()).abs() < 1e-15, "{velocity}");
}

#[test]
fn refusals_name_the_number_and_leave_all_as_it_was() {
    let mut stepper = oscillator(300.0, 0.01);
    stepper.set_forces(&[1.0]).expect("one force");
    stepper.advance_held(1e-3).expect("step");
    let (before, state) = (outputs(&stepper), stepper.state());
    for step in [0.0, -1e-3, f64::NAN, f64::INFINITY] {
        let error = stepper.advance_held(step).expect_err("not a step");
        assert!(matches!(error, ModelError::Size { name: "step", .. }), "{error}");
    }
    assert!(matches!(stepper.set_forces(&[f64::NAN]), Err(ModelError::NotFinite { what: "force", .. })));
    assert!(matches!(stepper.set_forces(&[1.0, 2.0]), Err(ModelError::ForceCount { found: 2, expected: 1 })));
    assert!(matches!(stepper.advance_linear(1e-3, &[]), Err(ModelError::ForceCount { found: 0, expected: 1 })));
    assert!(matches!(stepper.set_state(&[]), Err(ModelError::StateCount { found: 0, expected: 1 })));
    assert!(stepper.set_state(&[[f64::NAN, 0.0]]).is_err());
    assert!(stepper.displacement(1).is_none());
    assert_eq!((outputs(&stepper), stepper.state()), (before, state));
}

#[test]
fn a_force_too_large_is_refused() {
    let mode = Mode { angular_frequency: 1.0, damping_ratio: 0.0, at_forces: vec![4.0], at_responses: vec![1.0] };
    let mut stepper = ModalStepper::new(&ModalModel::new(1, 1, vec![mode]).expect("sound"));
    for force in [1e150, 1e308] {
        let error = stepper.set_forces(&[force]).expect_err("too large");
        assert!(
            matches!(error, ModelError::TooLarge { what: "modal force", .. } | ModelError::NotFinite { .. }),
            "{error}"
        );
        assert!(stepper.advance_linear(1.0, &[force]).is_err());
        assert!(stepper.advance_under_one(force, 1.0).is_err());
    }
    assert_eq!(outputs(&stepper), [0.0; 3]);
}

#[test]
fn a_state_too_large_is_refused() {
    let mut stepper = oscillator(0.0, 0.0);
    assert!(matches!(stepper.set_state(&[[1.0, 1e151]]), Err(ModelError::TooLarge { value: 1e151, .. })));
    stepper.set_state(&[[1.0, 1e149]]).expect("one mode");
    for step in [1e3, 1e10, 1e100] {
        assert!(matches!(stepper.advance_held(step), Err(ModelError::TooLarge { .. } | ModelError::NotFinite { .. })));
        assert_eq!(stepper.state(), [[1.0, 1e149]]);
    }
}

proptest! {
    // What a step leaves can be read, however large state and force: else the call after it would have to refuse.
    #[test]
    fn law_a_step_that_is_taken_leaves_outputs_that_are_numbers(
        modes in prop::collection::vec(
            (prop_oneof![Just(0.0), 1.0..1e6_f64], 0.0..0.99_f64, -100.0..100.0_f64, [-1.0..1.0_f64, -1.0..1.0_f64]), 1..9,
        ),
        coupled in any::<bool>(), force in -1.0..1.0_f64, size in 100.0..160.0_f64, step in -9.0..9.0_f64,
    ) {
        let mode = |&(angular_frequency, damping_ratio, shape, _): &(f64, f64, f64, _)| Mode {
            angular_frequency, damping_ratio, at_forces: vec![shape], at_responses: vec![-shape],
        };
        let mut model = ModalModel::new(1, 1, modes.iter().map(mode).collect()).expect("sound");
        if coupled {
            let row = |m: usize| (0..modes.len()).map(|n| if m == n { 2.0 } else { 0.1 }).collect();
            model = model.with_damping_coupling((0..modes.len()).map(row).collect()).expect("sound");
        }
        let (mut stepper, scale, step) = (ModalStepper::new(&model), 10.0_f64.powf(size), 10.0_f64.powf(step));
        let state: Vec<[f64; 2]> = modes.iter().map(|mode| mode.3.map(|value| value * scale)).collect();
        let set = stepper.set_state(&state).is_ok();
        let told = stepper.set_forces(&[force * scale]).is_ok();
        let stepped = stepper.advance_held(step).is_ok();
        prop_assert!(outputs(&stepper).iter().all(|output| output.is_finite()), "{set} {told} {stepped}");
        // Not all are refused: the law would hold of nothing.
        prop_assert!(size > 120.0 || step > 1e3 || (set && told && stepped));
    }
}

prop_compose! {
    /// Any omega h from rigid to 10^5, any damping below critical.
    fn any_mode()(phase in prop_oneof![Just(0.0), (-8.0..5.0_f64).prop_map(|p| 10.0_f64.powf(p))],
                  zeta in prop_oneof![Just(0.0), 0.0..0.999_f64]) -> (f64, f64) {
        (phase, if phase == 0.0 { 0.0 } else { zeta })
    }
}

proptest! {
    /// One step equals two halves; scales are those of the motion itself.
    #[test]
    fn a_step_is_two_half_steps((omega, zeta) in any_mode(), a in -1.0..1.0_f64, v in -1.0..1.0_f64,
                                p0 in -1.0..1.0_f64, p1 in -1.0..1.0_f64) {
        let scale = omega.max(1.0);
        let mut whole = oscillator(omega, zeta);
        whole.set_state(&[[a / scale, v]]).expect("one mode");
        whole.set_forces(&[p0 * scale]).expect("one force");
        let mut halves = whole.clone();
        whole.advance_linear(1.0, &[p1 * scale]).expect("step");
        halves.advance_linear(0.5, &[(p0 + p1) / 2.0 * scale]).expect("step");
        halves.advance_linear(0.5, &[p1 * scale]).expect("step");
        let [position, velocity, _] = outputs(&whole);
        let [position_2, velocity_2, _] = outputs(&halves);
        prop_assert!((position - position_2).abs() * scale < 2e-14, "{position:e} {position_2:e}");
        prop_assert!((velocity - velocity_2).abs() < 2e-14, "{velocity:e} {velocity_2:e}");
    }

    /// Without damping and force, a'^2 + omega^2 a^2 stays.
    #[test]
    fn energy_stays_without_damping_and_force((omega, _) in any_mode(), a in -1.0..1.0_f64, v in 0.1..1.0_f64) {
        let scale = omega.max(1.0);
        let mut stepper = oscillator(omega, 0.0);
        stepper.set_state(&[[a / scale, v]]).expect("one mode");
        let energy = |stepper: &ModalStepper| {
            let [position, velocity, _] = outputs(stepper);
            velocity * velocity + (omega * position) * (omega * position)
        };
        let before = energy(&stepper);
        for _ in 0..100 {
            stepper.advance_held(1.0).expect("step");
        }
        // 100 steps, each with a few roundings; a rigid mode drifts 100 long, its energy does not.
        prop_assert!((energy(&stepper) / before - 1.0).abs() < 1e-13);
    }

    /// The response to a sum of forces at several ports is the sum of the responses.
    #[test]
    fn responses_add_up(shapes in prop::collection::vec((0.0..3000.0_f64, 0.0..0.5_f64, -1.0..1.0_f64, -1.0..1.0_f64,
                                                         -1.0..1.0_f64), 1..9),
                        forces in prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64), 1..20)) {
        let modes = shapes.iter().map(|&(omega, zeta, w1, w2, w)| Mode {
            angular_frequency: omega, damping_ratio: zeta, at_forces: vec![w1, w2], at_responses: vec![w] });
        let rest = ModalStepper::new(&ModalModel::new(2, 1, modes.collect()).expect("sound"));
        let (mut both, mut first, mut second) = (rest.clone(), rest.clone(), rest);
        for &(f1, f2) in &forces {
            both.advance_linear(1e-3, &[f1, f2]).expect("step");
            first.advance_linear(1e-3, &[f1, 0.0]).expect("step");
            second.advance_linear(1e-3, &[0.0, f2]).expect("step");
        }
        let sums = outputs(&first).into_iter().zip(outputs(&second)).map(|(x, y)| x + y);
        for ((value, sum), scale) in outputs(&both).into_iter().zip(sums).zip([1e-2, 1.0, 1e2]) {
            prop_assert!((value - sum).abs() < 1e-12 * scale, "{value} {sum}");
        }
    }

    /// State read and put back goes on with the same numbers, bit for bit.
    #[test]
    fn a_state_put_back_goes_on_alike(omegas in prop::collection::vec(0.0..5000.0_f64, 1..10), f in -9.0..9.0_f64) {
        let modes = omegas.iter().map(|&omega| Mode {
            angular_frequency: omega, damping_ratio: 0.01, at_forces: vec![1.0], at_responses: vec![1.0] });
        let mut stepper = ModalStepper::new(&ModalModel::new(1, 1, modes.collect()).expect("sound"));
        let mut other = stepper.clone();
        stepper.advance_linear(1e-3, &[f]).expect("step");
        other.set_state(&stepper.state()).expect("same modes");
        other.set_forces(&[f]).expect("one force");
        stepper.advance_held(2e-3).expect("step");
        other.advance_held(2e-3).expect("step");
        prop_assert_eq!(stepper.state(), other.state());
        prop_assert_eq!(outputs(&stepper), outputs(&other));
    }

    /// A force told with the step is the force told before it, bit for bit; damping may couple the modes.
    #[test]
    fn a_force_told_with_the_step_is_one_told_before(
        omegas in prop::collection::vec(0.0..5000.0_f64, 1..10),
        steps in prop::collection::vec((1e-4..2e-3_f64, -9.0..9.0_f64), 1..6),
        coupled: bool,
    ) {
        let modes = omegas.iter().map(|&omega| Mode {
            angular_frequency: omega, damping_ratio: 0.01, at_forces: vec![1.0], at_responses: vec![1.0] });
        let mut model = ModalModel::new(1, 1, modes.collect()).expect("sound");
        if coupled {
            let row = |i| (0..omegas.len()).map(|j| if i == j { 2.0 } else { 0.1 }).collect();
            model = model.with_damping_coupling((0..omegas.len()).map(row).collect()).expect("sound");
        }
        let mut together = ModalStepper::new(&model);
        let mut apart = together.clone();
        for (step, force) in steps {
            for _ in 0..2 {
                together.advance_under_one(force, step).expect("a step");
                apart.set_forces(&[force]).and_then(|()| apart.advance_held(step)).expect("a step");
                prop_assert_eq!(together.state(), apart.state());
                prop_assert_eq!(outputs(&together), outputs(&apart));
            }
        }
    }
}

#[test]
fn a_force_told_with_the_step_is_refused_where_it_is_not_one_or_not_finite() {
    let mut stepper = oscillator(10.0, 0.1);
    stepper.advance_under_one(3.0, 0.1).expect("a step");
    let before = stepper.state();
    assert!(matches!(stepper.advance_under_one(f64::NAN, 0.1), Err(ModelError::NotFinite { what: "force", .. })));
    assert!(matches!(stepper.advance_under_one(1.0, 0.0), Err(ModelError::Size { .. })));
    assert_eq!(stepper.state(), before);
    let mode = Mode { angular_frequency: 1.0, damping_ratio: 0.0, at_forces: vec![1.0; 2], at_responses: vec![1.0] };
    let mut two = ModalStepper::new(&ModalModel::new(2, 1, vec![mode]).expect("a sound model"));
    let refused = two.advance_under_one(1.0, 0.1);
    assert!(matches!(refused, Err(ModelError::ForceCount { found: 1, expected: 2 })), "{refused:?}");
}
