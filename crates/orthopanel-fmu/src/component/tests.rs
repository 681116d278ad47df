//! The life cycle without any C.

use orthopanel_model::{ModalModel, ModalStepper, Mode, Place, Ports};
use proptest::prelude::*;

use super::*;

const FORCE_LINEAR: u32 = 2;
const FORCE: u32 = 3;
const ACCELERATION: u32 = 4;
const VELOCITY: u32 = 5;
const DISPLACEMENT: u32 = 6;

fn resource() -> Resource {
    let mode = |angular_frequency, damping_ratio| Mode {
        angular_frequency,
        damping_ratio,
        at_forces: vec![0.7],
        at_responses: vec![-1.1],
    };
    let model = ModalModel::new(1, 1, vec![mode(0.0, 0.0), mode(2000.0, 0.01)]).expect("a sound model");
    let ports = Ports { forces: vec![Place { x: -0.3, y: 0.0 }], responses: vec![Place { x: 0.3, y: 0.0 }] };
    Resource::new(model, ports).expect("as many places as ports")
}

fn initialized(force_linear: bool) -> Component {
    let mut component = Component::new(&resource(), Interface::CoSimulation, "");
    component.set_booleans(&[FORCE_LINEAR], &[force_linear]).expect("a parameter");
    component.enter_initialization().expect("enter");
    component.exit_initialization().expect("exit");
    component
}

fn outputs(component: &mut Component) -> [f64; 3] {
    let mut values = [0.0; 3];
    component.get_reals(&[DISPLACEMENT, VELOCITY, ACCELERATION], &mut values).expect("outputs");
    values
}

fn stepper_outputs(stepper: &ModalStepper) -> [f64; 3] {
    [stepper.displacement(0), stepper.velocity(0), stepper.acceleration(0)].map(|value| value.expect("port"))
}

#[test]
fn val_each_hold_is_the_steppers() {
    let forces = [0.0, 1.0, 4.0, -2.0];
    let step = 3e-4;
    let mut held = initialized(false);
    let mut linear = initialized(true);
    let mut rates = initialized(false);
    let mut stepper_held = ModalStepper::new(resource().model());
    let mut stepper_linear = stepper_held.clone();
    for (n, pair) in forces.windows(2).enumerate() {
        let (time, from, to) = (n as f64 * step, pair[0], pair[1]);
        held.set_reals(&[FORCE], &[from]).expect("set");
        held.do_step(time, step).expect("step");
        linear.set_reals(&[FORCE], &[to]).expect("set");
        linear.do_step(time, step).expect("step");
        rates.set_reals(&[FORCE], &[from]).expect("set");
        rates.set_force_rates(&[FORCE], &[1], &[(to - from) / step]).expect("rates");
        rates.do_step(time, step).expect("step");
        stepper_held.set_forces(&[from]).expect("set");
        stepper_held.advance_held(step).expect("step");
        stepper_linear.advance_linear(step, &[to]).expect("step");
        assert_eq!(outputs(&mut held), stepper_outputs(&stepper_held));
        assert_eq!(outputs(&mut linear), stepper_outputs(&stepper_linear));
        // The rate times the step gives the end value back but for rounding.
        for (value, expected) in outputs(&mut rates).into_iter().zip(stepper_outputs(&stepper_linear)) {
            assert!((value - expected).abs() <= 1e-13 * expected.abs(), "{value} {expected}");
        }
    }
}

#[test]
fn val_an_acceleration_answers_at_once_to_a_force() {
    let mut component = initialized(false);
    component.set_reals(&[FORCE], &[3.0]).expect("set");
    // At rest: sum of W_r W_f over two modes times the force.
    let expected = 2.0 * -1.1 * 0.7 * 3.0;
    let [displacement, velocity, acceleration] = outputs(&mut component);
    assert_eq!((displacement, velocity), (0.0, 0.0));
    assert!((acceleration - expected).abs() < 1e-14, "{acceleration}");
}

/// The value set is that of the end of the step to come: until then the old one acts.
#[test]
fn val_a_linear_force_acts_when_its_step_is_done() {
    let mut component = initialized(true);
    component.set_reals(&[FORCE], &[3.0]).expect("set");
    component.do_step(0.0, 1e-3).expect("step");
    let there = outputs(&mut component);
    component.set_reals(&[FORCE], &[-8.0]).expect("set");
    assert_eq!(outputs(&mut component), there);
    let mut force = [0.0];
    component.get_reals(&[FORCE], &mut force).expect("input");
    assert_eq!(force, [-8.0]);
    component.do_step(1e-3, 1e-3).expect("step");
    let mut stepper = ModalStepper::new(resource().model());
    stepper.advance_linear(1e-3, &[3.0]).and_then(|()| stepper.advance_linear(1e-3, &[-8.0])).expect("steps");
    assert_eq!(outputs(&mut component), stepper_outputs(&stepper));
}

#[test]
fn refused_calls_change_nothing() {
    let mut component = initialized(false);
    component.set_reals(&[FORCE], &[3.0]).expect("set");
    component.do_step(0.0, 1e-3).expect("step");
    let before = outputs(&mut component);
    assert!(matches!(component.set_reals(&[FORCE, 99], &[8.0, 8.0]), Err(FmuError::UnknownReference { last: 14, .. })));
    assert!(matches!(component.set_reals(&[FORCE], &[f64::NAN]), Err(FmuError::NotFinite { .. })));
    assert!(matches!(component.set_reals(&[ACCELERATION], &[1.0]), Err(FmuError::NotSettable { .. })));
    assert!(matches!(component.set_reals(&[FORCE_LINEAR], &[1.0]), Err(FmuError::VariableType { .. })));
    assert!(matches!(component.set_reals(&[FORCE], &[]), Err(FmuError::Count { .. })));
    assert!(matches!(component.set_booleans(&[FORCE_LINEAR], &[true]), Err(FmuError::NotSettable { .. })));
    assert!(matches!(component.set_force_rates(&[FORCE], &[2], &[1.0]), Err(FmuError::DerivativeOrder { order: 2 })));
    assert!(matches!(component.enter_initialization(), Err(FmuError::Order { .. })));
    for (start, step) in [(1e-3, 0.0), (1e-3, -1e-3), (1e-3, f64::NAN), (f64::NAN, 1e-3), (0.5, 1e-3), (0.0, 1e-3)] {
        assert!(component.do_step(start, step).is_err(), "{start} {step}");
    }
    assert_eq!(outputs(&mut component), before);
    assert_eq!(component.time(), 1e-3);
}

#[test]
fn a_linear_step_that_fails_keeps_the_force_set() {
    let mut component = initialized(true);
    component.set_reals(&[FORCE], &[3.0]).expect("set");
    let before = outputs(&mut component);
    assert!(component.do_step(0.0, f64::INFINITY).is_err());
    assert!(component.do_step(0.0, 1e200).is_err());
    assert_eq!(outputs(&mut component), before);
}

#[test]
fn reset_gives_the_same_run_again() {
    let mut component = initialized(false);
    let run = |component: &mut Component| {
        (0..20)
            .map(|n| {
                component.set_reals(&[FORCE], &[f64::from(n % 7)]).expect("set");
                component.do_step(f64::from(n) * 1e-4, 1e-4).expect("step");
                outputs(component)
            })
            .collect::<Vec<_>>()
    };
    let first = run(&mut component);
    component.terminate().expect("terminate");
    assert!(component.do_step(2e-3, 1e-4).is_err());
    component.reset().expect("reset");
    component.enter_initialization().expect("enter");
    component.exit_initialization().expect("exit");
    assert_eq!(run(&mut component), first);
}

#[test]
fn communication_points_added_up_with_rounding_are_accepted() {
    let mut component = initialized(false);
    let mut time = 0.0;
    for n in 0..100_000 {
        // Every third importer multiplies, the others add: they differ in the last places.
        let start = if n % 3 == 0 { f64::from(n) * 1e-5 } else { time };
        component.do_step(start, 1e-5).expect("within rounding");
        time += 1e-5;
    }
}

#[test]
fn the_stop_time_bounds_the_steps() {
    let mut component = Component::new(&resource(), Interface::CoSimulation, "");
    assert!(matches!(component.set_experiment(None, 1.0, Some(0.5)), Err(FmuError::StopBeforeStart { .. })));
    component.set_experiment(None, 0.0, Some(0.3)).expect("experiment");
    component.enter_initialization().expect("enter");
    component.exit_initialization().expect("exit");
    for n in 0..3 {
        component.do_step(f64::from(n) * 0.1, 0.1).expect("0.1 + 0.2 is past 0.3 by rounding alone");
    }
    assert!(matches!(component.do_step(0.3, 0.1), Err(FmuError::PastStop { .. })));
}

#[test]
fn regress_numbers_too_large_to_step_with_are_refused_when_set() {
    for value in [1.0001e100, -1e300, 1e308] {
        let mut component = initialized(false);
        component.set_reals(&[FORCE], &[2.0]).and_then(|()| component.do_step(0.0, 1e-3)).expect("a step");
        let before = component.snapshot();
        let refused = component.set_reals(&[FORCE], &[value]).expect_err("too large").to_string();
        assert_eq!(refused, format!("force_1 = {value:e}: must lie between -1e100 and 1e100"));
        assert!(matches!(component.set_force_rates(&[FORCE], &[1], &[value]), Err(FmuError::TooLarge { .. })));
        let mut sensitivity = [0.0];
        let seeded = component.directional_derivative(&[ACCELERATION], &[FORCE], &[value], &mut sensitivity);
        assert!(matches!(seeded, Err(FmuError::TooLarge { .. })));
        let seeded = component.adjoint_derivative(&[ACCELERATION], &[FORCE], &[value], &mut sensitivity);
        assert!(matches!(seeded, Err(FmuError::TooLarge { .. })));
        assert_eq!(component.snapshot(), before);
        let mut component = Component::new(&resource(), Interface::ModelExchange, "");
        component.enter_initialization().and_then(|()| component.exit_initialization()).expect("initialized");
        component.enter_continuous_time_mode().expect("continuous time");
        assert!(matches!(component.set_continuous_states(&[value; 4]), Err(FmuError::TooLarge { .. })));
    }
}

#[test]
fn regress_a_motion_too_large_to_read_is_not_stepped_into() {
    let mut component = Component::new(&resource(), Interface::CoSimulation, "");
    component.enter_initialization().expect("enter");
    let position = component.variables.variables().iter().find(|v| v.quantity == Quantity::ModalPosition(1));
    let position = position.expect("a second mode").reference;
    assert!(matches!(component.set_reals(&[position], &[1e308]), Err(FmuError::TooLarge { .. })));
    component.set_reals(&[position, FORCE], &[1e100, 1e100]).expect("just small enough");
    component.exit_initialization().expect("exit");
    let mut step = 1e-3;
    for _ in 0..80 {
        let before = component.snapshot();
        if component.do_step(component.time(), step).is_err() {
            assert_eq!(component.snapshot(), before);
        }
        assert!(outputs(&mut component).iter().all(|value| value.is_finite()));
        step *= 3.0;
    }
}

#[test]
fn regress_steps_and_times_of_no_simulation_are_refused() {
    let mut component = initialized(false);
    component.set_reals(&[FORCE], &[2.0]).expect("a force");
    let before = component.snapshot();
    for (start, step, said) in [
        (0.0, 1e80, "step = 1e80 s: steps and times must stay below 1e30 s"),
        (0.0, 1e30, "step = 1e30 s"),
        (0.0, 1.7e308, "step = 1.7e308 s"),
        (1e308, 1e308, "communication point = 1e308 s"),
        (-1e30, 1.0, "communication point = -1e30 s"),
        (f64::NEG_INFINITY, 1.0, "communication point = -inf"),
    ] {
        let refused = component.do_step(start, step).expect_err("too long").to_string();
        assert!(refused.starts_with(said), "{refused}");
        assert_eq!(component.snapshot(), before);
    }
    component.do_step(0.0, 9e29).expect("a long step");
    let refused = component.do_step(9e29, 9e29).expect_err("too late").to_string();
    assert!(refused.starts_with("end of the step = 1.8e30 s"), "{refused}");
    let mut late = component.snapshot();
    late.situation.time = 1e30;
    assert!(matches!(component.restore(&late), Err(FmuError::TooLong { .. })));

    let mut component = Component::new(&resource(), Interface::ModelExchange, "");
    assert!(matches!(component.set_experiment(None, 1e30, None), Err(FmuError::TooLong { .. })));
    component.set_experiment(None, 0.0, Some(f64::MAX)).expect("a stop that never comes");
    component.enter_initialization().and_then(|()| component.exit_initialization()).expect("initialized");
    assert!(matches!(component.set_time(1e30), Err(FmuError::TooLong { .. })));
    component.set_time(9e29).expect("a late time");
}

/// A damaged panel, whose shapes are numbers but what is seen through them is none.
#[test]
fn regress_results_that_are_no_number_are_refused() {
    let mode = Mode { angular_frequency: 10.0, damping_ratio: 0.0, at_forces: vec![1.0], at_responses: vec![1e300] };
    let place = || vec![Place { x: 0.0, y: 0.0 }];
    let model = ModalModel::new(1, 1, vec![mode]).expect("numbers");
    let resource = Resource::new(model, Ports { forces: place(), responses: place() }).expect("a port each");
    let mut component = Component::new(&resource, Interface::CoSimulation, "");
    component.enter_initialization().and_then(|()| component.exit_initialization()).expect("initialized");
    component.set_reals(&[FORCE], &[1e50]).expect("small enough");
    let before = component.snapshot();
    let mut values = [0.0; 2];
    for references in [&[ACCELERATION][..], &[DISPLACEMENT, ACCELERATION]] {
        // Once before the force is told to the modes, once after.
        for _ in 0..2 {
            let refused = component.get_reals(references, &mut values[..references.len()]).expect_err("overflows");
            assert!(refused.to_string().starts_with("acceleration_1 = inf under"), "{refused}");
        }
    }
    let mut sensitivity = [0.0];
    let refused = component.directional_derivative(&[ACCELERATION], &[FORCE], &[1e50], &mut sensitivity);
    assert!(matches!(refused, Err(FmuError::Overflow { .. })));
    let refused = component.adjoint_derivative(&[ACCELERATION], &[FORCE], &[1e50], &mut sensitivity);
    assert!(matches!(refused, Err(FmuError::Overflow { .. })));
    assert_eq!(component.snapshot(), before);
    component.set_reals(&[FORCE], &[1.0]).expect("small");
    assert!(outputs(&mut component).iter().all(|value| value.is_finite()));
}

#[test]
fn regress_a_tolerance_that_is_none_is_refused() {
    let mut component = Component::new(&resource(), Interface::CoSimulation, "");
    for tolerance in [f64::NAN, f64::INFINITY, -1e-6] {
        let refused = component.set_experiment(Some(tolerance), 0.0, None).expect_err("none").to_string();
        assert!(refused.starts_with("tolerance = "), "{refused}");
    }
    component
        .set_experiment(Some(1e-6), 0.0, None)
        .and_then(|()| component.set_experiment(Some(0.0), 0.0, None))
        .expect("one");
}

/// One call of an importer that knows nothing of the order.
#[derive(Debug, Clone)]
enum Call {
    Experiment(Option<f64>, f64, Option<f64>),
    Enter,
    Exit,
    Terminate,
    Reset,
    Set(u32, f64),
    Rate(u32, i32, f64),
    Linear(u32, bool),
    Step(f64, f64),
}

fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![4 => -2.0..2.0_f64, 1 => Just(0.0), 1 => proptest::num::f64::ANY]
}

fn any_option() -> impl Strategy<Value = Option<f64>> {
    proptest::option::of(any_number())
}

fn any_call() -> impl Strategy<Value = Call> {
    prop_oneof![
        1 => (any_option(), any_number(), any_option())
            .prop_map(|(tolerance, start, stop)| Call::Experiment(tolerance, start, stop)),
        2 => Just(Call::Enter),
        2 => Just(Call::Exit),
        1 => Just(Call::Terminate),
        1 => Just(Call::Reset),
        4 => (0..9_u32, any_number()).prop_map(|(reference, value)| Call::Set(reference, value)),
        2 => (0..9_u32, 0..3_i32, any_number()).prop_map(|(reference, order, rate)| Call::Rate(reference, order, rate)),
        1 => (0..9_u32, any::<bool>()).prop_map(|(reference, on)| Call::Linear(reference, on)),
        6 => (any_number(), any_number()).prop_map(|(offset, step)| Call::Step(offset, step)),
    ]
}

proptest! {
    /// Whatever is called in whatever order: no panic, outputs stay numbers, a refused call changes nothing.
    #[test]
    fn random_calls_leave_a_sound_instance(calls in prop::collection::vec(any_call(), 1..40)) {
        let mut component = Component::new(&resource(), Interface::CoSimulation, "");
        for call in calls {
            let readable = |component: &mut Component| {
                let mut values = [0.0; 5];
                component.get_reals(&[0, FORCE, ACCELERATION, VELOCITY, DISPLACEMENT], &mut values).map(|()| values)
            };
            let before = readable(&mut component);
            let done = match call {
                Call::Experiment(tolerance, start, stop) => component.set_experiment(tolerance, start, stop),
                Call::Enter => component.enter_initialization(),
                Call::Exit => component.exit_initialization(),
                Call::Terminate => component.terminate(),
                Call::Reset => component.reset(),
                Call::Set(reference, value) => component.set_reals(&[reference], &[value]),
                Call::Rate(reference, order, rate) => component.set_force_rates(&[reference], &[order], &[rate]),
                Call::Linear(reference, on) => component.set_booleans(&[reference], &[on]),
                // Mostly from where the instance stands, now and then from elsewhere.
                Call::Step(offset, step) => {
                    let start = component.time() + if offset.abs() < 1.0 { 0.0 } else { offset };
                    component.do_step(start, step)
                }
            };
            let after = readable(&mut component);
            if let (Err(_), Ok(before), Ok(after)) = (&done, &before, &after) {
                prop_assert_eq!(before, after);
            }
            if let Ok(after) = after {
                prop_assert!(after.iter().all(|value| value.is_finite()), "{:?}", after);
            }
        }
    }
}
