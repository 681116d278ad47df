//! Damping and places set while the simulation runs: FMU states, resets, and when they are refused.

use super::panel_tests::{BEAM, PLATE, reference, set};
use super::tunable_tests::{TUNED, force, initialized, instance, panels, step};
use super::*;

/// The state from before brings the old damping and places back, in the same instance and, as bytes, in another.
#[test]
fn regress_states_from_before_and_after_a_change_bring_each_panel_back() {
    for text in panels() {
        let mut component = initialized(&text, Interface::CoSimulation);
        (0..10).for_each(|n| _ = step(&mut component, force(n)));
        let before = component.get_fmu_state(0).expect("a state");
        let untouched: Vec<_> = (10..20).map(|n| step(&mut component, force(n))).collect();
        component.set_fmu_state(before).expect("the state");
        for (name, value) in TUNED {
            set(&mut component, name, value).expect("a tunable parameter");
        }
        let pending = component.get_fmu_state(0).expect("a state");
        (10..13).for_each(|n| _ = step(&mut component, force(n)));
        let after = component.get_fmu_state(0).expect("a state");
        let tuned: Vec<_> = (13..20).map(|n| step(&mut component, force(n))).collect();
        assert!(tuned != untouched[3..]);
        component.set_fmu_state(before).expect("the state");
        assert_eq!((10..20).map(|n| step(&mut component, force(n))).collect::<Vec<_>>(), untouched, "{text}");
        for (state, from) in [(after, 13), (pending, 10)] {
            let bytes = component.serialize_fmu_state(state).expect("bytes");
            let mut other = instance(&text, Interface::CoSimulation);
            let carried = other.deserialize_fmu_state(&bytes, 0).expect("a state");
            other.set_fmu_state(carried).expect("the state");
            let run: Vec<_> = (from..20).map(|n| step(&mut other, force(n))).collect();
            assert_eq!(run[run.len() - 7..], tuned, "{text}");
            let mut value = [0.0];
            other.get_reals(&[reference(&other, "damping_ratio_1")], &mut value).expect("a parameter");
            assert_eq!(value, [0.05]);
        }
    }
}

#[test]
fn regress_a_reset_brings_the_exported_panel_back_to_the_bit() {
    for text in panels() {
        let mut component = initialized(&text, Interface::CoSimulation);
        let first: Vec<_> = (0..20).map(|n| step(&mut component, force(n))).collect();
        for (name, value) in TUNED {
            set(&mut component, name, value).expect("a tunable parameter");
        }
        step(&mut component, 1.0);
        component.reset().expect("reset");
        component.enter_initialization().and_then(|()| component.exit_initialization()).expect("initialized");
        assert_eq!((0..20).map(|n| step(&mut component, force(n))).collect::<Vec<_>>(), first, "{text}");
    }
}

#[test]
fn tunable_parameters_are_set_at_an_event_and_refused_between() {
    let mut component = initialized(BEAM, Interface::ModelExchange);
    set(&mut component, "damping_ratio_1", 0.01).expect("at the first event");
    component.enter_continuous_time_mode().expect("continuous time");
    let before = component.snapshot();
    for (name, value) in [("damping_ratio_1", 0.02), ("force_1_x", 0.1)] {
        let refused = set(&mut component, name, value).expect_err("between events").to_string();
        assert!(refused.contains("a tunable parameter is set in event mode (model exchange)"), "{refused}");
    }
    assert_eq!(component.snapshot(), before);
    component.enter_event_mode().expect("an event");
    set(&mut component, "damping_ratio_1", 0.02).expect("at an event");
    let refused = set(&mut component, "length", 0.7).expect_err("fixed").to_string();
    assert!(refused.contains("a fixed parameter is set before or in initialization mode"), "{refused}");
    component.terminate().expect("terminated");
    assert!(matches!(set(&mut component, "damping_ratio_1", 0.01), Err(FmuError::Order { .. })));
}

/// Sizes of the states follow a force's place, and the event says so, once.
#[test]
fn nominals_that_change_at_an_event_are_told_once() {
    let mut component = initialized(BEAM, Interface::ModelExchange);
    let nominals = |component: &mut Component| {
        let mut values = vec![0.0; component.state_count()];
        component.get_nominals(&mut values, false).map(|()| values).expect("nominals")
    };
    assert!(!component.update_discrete_states().expect("an event"), "as they were when initialization ended");
    let before = nominals(&mut component);
    set(&mut component, "damping_ratio_1", 0.3).expect("a ratio");
    assert!(!component.update_discrete_states().expect("an event"), "damping does not change them");
    // All but the end, where every mode of a free beam moves most, is less.
    set(&mut component, "force_1_x", -0.4).expect("a place");
    assert!(component.update_discrete_states().expect("an event"));
    assert!(!component.update_discrete_states().expect("an event"));
    assert_ne!(nominals(&mut component), before);
}

#[test]
fn values_that_no_panel_has_are_refused_and_the_run_goes_on() {
    let mut component = initialized(PLATE, Interface::CoSimulation);
    let mut beside = initialized(PLATE, Interface::CoSimulation);
    let bad = [
        ("damping_ratio_1", f64::NAN, "must be a finite number"),
        ("damping_ratio_1", 0.8, "0 <= zeta"),
        ("damping_ratio_4", -1e-9, "0 <= zeta"),
        ("force_1_x", 0.401, "lies off the piece"),
        ("response_1_y", -0.26, "lies off the piece"),
        ("force_2_y", f64::INFINITY, "must be a finite number"),
    ];
    for n in 0..20 {
        if let Some((name, value, message)) = bad.get(n as usize) {
            let before = component.snapshot();
            let pair = [reference(&component, "damping_ratio_2"), reference(&component, name)];
            // One bad value of a call leaves the good ones unset too.
            let refused = component.set_reals(&pair, &[0.02, *value]).expect_err("no panel has it").to_string();
            assert!(refused.contains(message), "{refused}");
            assert_eq!(component.snapshot(), before);
        }
        assert_eq!(step(&mut component, force(n)), step(&mut beside, force(n)));
    }
}
