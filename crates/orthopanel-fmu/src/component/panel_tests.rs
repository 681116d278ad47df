//! Instances whose panel can be set.

use orthopanel_model::{ModeRange, PanelModel, Place, Ports};

use super::*;
use crate::{Connections, Residual};

pub(super) const PLATE: &str = r#"{"schema": "orthopanel.model/1", "structure": "mindlin-plate",
    "piece": {"length": 0.8, "width": 0.5, "thickness": 0.03, "mass_per_area": 6.88},
    "constants": {"e_x": 1.067e10, "e_y": 0.9e10, "nu_xy": 0.3, "g_xy": 3e9, "g_yz": 4e8, "g_zx": 5.304e8},
    "damping": {"beyond": 0.003}}"#;

pub(super) const BEAM: &str = r#"{"schema": "orthopanel.model/1", "structure": "timoshenko-beam",
    "piece": {"length": 0.8, "width": 0.1, "thickness": 0.03, "mass_per_area": 6.88},
    "constants": {"e_x": 1.067e10, "g_zx": 5.304e8}, "damping": {"beyond": 0.003}}"#;

fn resource(text: &str) -> Resource {
    let place = |x| Place { x, y: 0.02 };
    let ports = Ports { forces: vec![place(-0.3)], responses: vec![place(0.1)] };
    let panel = PanelModel::from_json(text).expect("a sound model");
    Resource::of_panel(&panel, ModeRange::Count(4), ports, Residual::Attachment, Connections::default())
        .expect("a sound panel")
        .0
}

fn instance(text: &str, interface: Interface) -> Component {
    Component::new(&resource(text), interface, "")
}

pub(super) fn reference(component: &Component, name: &str) -> u32 {
    let all = component.variables.variables();
    all.iter().find(|variable| variable.name == name).expect("a variable").reference
}

pub(super) fn set(component: &mut Component, name: &str, value: f64) -> Result<(), FmuError> {
    component.set_reals(&[reference(component, name)], &[value])
}

#[test]
fn regress_constants_without_meaning_are_refused_when_set() {
    let beam = [("e_x", -1.0), ("e_x", 0.0), ("g_zx", -5.0), ("e_x", 1e300)];
    let plate = [("nu_xy", 5.0), ("nu_xy", -0.1), ("g_xy", 0.0), ("e_y", 1e300), ("g_yz", 1.0)];
    for (text, values) in [(BEAM, &beam[..]), (PLATE, &plate[..])] {
        let mut component = instance(text, Interface::CoSimulation);
        for &(name, value) in values {
            let before = component.snapshot();
            let refused = set(&mut component, name, value).expect_err("no panel has it").to_string();
            assert!(refused.starts_with(&format!("{name} = {value:e}")), "{refused}");
            assert!(refused.contains("must lie between") && refused.len() < 100, "{refused}");
            assert_eq!(component.snapshot(), before);
        }
        set(&mut component, "e_x", 1.2e10).expect("a panel has it");
        component.enter_initialization().and_then(|()| component.exit_initialization()).expect("solved");
    }
}

#[test]
fn regress_huge_numbers_are_told_in_exponent_form() {
    let mut component = instance(BEAM, Interface::CoSimulation);
    set(&mut component, "length", 1e300).expect("finite and above zero by itself");
    component.enter_initialization().expect("enter");
    let refused = component.exit_initialization().expect_err("no panel").to_string();
    assert!(refused.len() < 150 && refused.contains('e'), "{refused}");
    for (name, value) in [("length", -1e300), ("damping_ratio_1", 1e300)] {
        let refused = set(&mut component, name, value).expect_err("refused").to_string();
        assert!(refused.contains(&format!("{value:e}")), "{refused}");
    }
}

#[test]
fn regress_a_step_too_long_is_told_with_its_size() {
    let mut component = instance(BEAM, Interface::CoSimulation);
    component.enter_initialization().and_then(|()| component.exit_initialization()).expect("initialized");
    let refused = component.do_step(0.0, 1e300).expect_err("too long").to_string();
    assert_eq!(refused, "step = 1e300 s: steps and times must stay below 1e30 s");
    assert_eq!(component.time(), 0.0);
}

#[test]
fn regress_nominals_follow_the_parameters_in_initialization_mode() {
    let mut component = instance(BEAM, Interface::ModelExchange);
    component.enter_initialization().expect("enter");
    let nominals = |component: &mut Component| {
        let mut values = vec![0.0; component.state_count()];
        component.get_nominals(&mut values, false).map(|()| values).expect("nominals")
    };
    let before = nominals(&mut component);
    set(&mut component, "length", 0.65).expect("a length");
    let set_now = nominals(&mut component);
    component.exit_initialization().expect("exit");
    assert_ne!(before, set_now);
    assert_eq!(set_now, nominals(&mut component));
}

/// Derivatives of the acceleration in initialization mode by these knowns together.
fn derivative(component: &mut Component, knowns: &[(&str, f64)]) -> Result<f64, FmuError> {
    let references: Vec<u32> = knowns.iter().map(|(name, _)| reference(component, name)).collect();
    let seed: Vec<f64> = knowns.iter().map(|&(_, seed)| seed).collect();
    let (unknown, mut value) = (reference(component, "acceleration_1"), [0.0]);
    component.directional_derivative(&[unknown], &references, &seed, &mut value)?;
    Ok(value[0])
}

fn acceleration(component: &mut Component) -> f64 {
    let mut value = [0.0];
    component.get_reals(&[reference(component, "acceleration_1")], &mut value).expect("a number");
    value[0]
}

/// Laws of scale tell these without a solver: $W\propto m^{-1/2}$ and $\omega^2\propto C/m$ in the mass per area $m$ and a factor
/// $C$ of all constants; a damping ratio stands in the acceleration as $-2\zeta\omega W\dot a$, a place in $W$ alone.
#[test]
fn val_derivatives_by_parameters_follow_the_laws_of_scale() {
    let constants = [("e_x", 1.067e10), ("e_y", 0.9e10), ("g_xy", 3e9), ("g_yz", 4e8), ("g_zx", 5.304e8)];
    let beam: Vec<_> = [constants[0], constants[4]].to_vec();
    // The beam is solved in closed form; a plate's modes carry the rounding of an iterated solver, divided by the step.
    for (text, factors, tolerance) in [(BEAM, beam, 1e-7), (PLATE, constants.to_vec(), 1e-5)] {
        let mut component = instance(text, Interface::CoSimulation);
        component.enter_initialization().expect("enter");
        set(&mut component, "force_1", 3.0).expect("a force");
        let before = component.snapshot();
        let pushed = acceleration(&mut component);
        let found = derivative(&mut component, &[("mass_per_area", 1.0)]).expect("a derivative");
        let expected = -pushed / 6.88;
        assert!((found - expected).abs() < tolerance * expected.abs(), "mass: {found} {expected}");
        assert_eq!(derivative(&mut component, &[("time", 1.0)]).expect("none"), 0.0);
        assert_eq!(component.snapshot(), before);
        // Mode 5 is flexible: the state's force is elastic, and in proportion to the constants.
        set(&mut component, "force_1", 0.0).expect("a force");
        set(&mut component, "modal_position_5", 1e-3).expect("a state");
        let held = acceleration(&mut component);
        let found = derivative(&mut component, &factors).expect("a derivative");
        assert!((found - held).abs() < tolerance * held.abs(), "constants: {found} {held}");
        let adjoint = {
            let (unknown, known) = (reference(&component, "acceleration_1"), reference(&component, "e_x"));
            let mut value = [0.0];
            component.adjoint_derivative(&[unknown], &[known], &[2.0], &mut value).expect("an adjoint");
            value[0]
        };
        let found = derivative(&mut component, &[("e_x", 2.0)]).expect("a derivative");
        assert!((found - adjoint).abs() <= 1e-9 * found.abs(), "{found} {adjoint}");
        component.exit_initialization().expect("exit");
        assert!(matches!(derivative(&mut component, &[("e_x", 1.0)]), Err(FmuError::NotDifferentiable { .. })));
    }
}

/// At a bound one side alone is a panel: a damping ratio of zero, in which the acceleration is linear, and the edge of the piece.
#[test]
fn val_derivatives_at_a_bound_are_one_sided() {
    let mut component = instance(BEAM, Interface::CoSimulation);
    component.enter_initialization().expect("enter");
    // The third mode is the first that bends: two rigid ones come before it.
    set(&mut component, "modal_velocity_3", 2.0).expect("a state");
    set(&mut component, "damping_ratio_1", 0.0).expect("a ratio");
    let without = acceleration(&mut component);
    let found = derivative(&mut component, &[("damping_ratio_1", 1.0)]).expect("a derivative");
    set(&mut component, "damping_ratio_1", 0.5).expect("a ratio");
    let expected = (acceleration(&mut component) - without) / 0.5;
    assert!((found - expected).abs() < 1e-9 * expected.abs(), "{found} {expected}");
    let mut component = instance(BEAM, Interface::CoSimulation);
    component.enter_initialization().expect("enter");
    set(&mut component, "force_1", 1.0).expect("a force");
    let mut at = |x: f64| {
        set(&mut component, "force_1_x", x).expect("a place");
        derivative(&mut component, &[("force_1_x", 1.0)]).expect("a derivative")
    };
    let (edge, beside) = (at(-0.4), [at(-0.3995), at(-0.399)]);
    // A straight line from beside to the edge: half a millimetre is a hundredth of the shortest wave, that of a residual mode.
    let expected = 2.0 * beside[0] - beside[1];
    assert!((edge - expected).abs() < 1e-2 * expected.abs(), "{edge} {expected}");
}

#[test]
fn regress_a_derivative_by_a_force_is_what_setting_it_does() {
    for force_linear in [false, true] {
        let mut component = instance(BEAM, Interface::CoSimulation);
        component.set_booleans(&[reference(&component, "force_linear")], &[force_linear]).expect("a parameter");
        component.enter_initialization().and_then(|()| component.exit_initialization()).expect("initialized");
        component.do_step(0.0, 1e-4).expect("a step");
        let derived = derivative(&mut component, &[("force_1", 2.0)]).expect("a derivative");
        let before = acceleration(&mut component);
        set(&mut component, "force_1", 2.0).expect("a force");
        let moved = acceleration(&mut component) - before;
        assert!((derived - moved).abs() <= 1e-12 * moved.abs(), "{derived} {moved}");
        assert_eq!(moved == 0.0, force_linear);
    }
}

/// Whatever `InitialUnknowns` lists is taken as a known, and tells how the output moves when it is set.
#[test]
fn regress_every_initial_dependency_has_its_derivative() {
    for text in [BEAM, PLATE] {
        let mut component = instance(text, Interface::ModelExchange);
        component.enter_initialization().expect("enter");
        set(&mut component, "force_1", 2.0).expect("a force");
        for mode in 1..=component.mode_count() {
            set(&mut component, &format!("modal_position_{mode}"), 1e-4 / mode as f64).expect("a state");
            set(&mut component, &format!("modal_velocity_{mode}"), 0.1 / mode as f64).expect("a state");
        }
        let unknown = reference(&component, "acceleration_1");
        let variable = resource(text).variables().get(unknown).expect("there").clone();
        assert!(variable.initial_dependencies.len() > variable.dependencies.len());
        for known in variable.initial_dependencies {
            let (name, mut start) = (component.variables.get(known).expect("there").name.clone(), [0.0]);
            component.get_reals(&[known], &mut start).expect("a value");
            // Another step than the component's own; frequencies of residual modes bend sharply where a force is moved.
            let share = if name.starts_with("force_1_") { 3e-5 } else { 2e-4 };
            let step = share * if start[0] == 0.0 { 1.0 } else { start[0].abs() };
            let mut at = |value: f64| {
                component.set_reals(&[known], &[value]).map(|()| acceleration(&mut component)).expect("an acceleration")
            };
            let expected = (at(start[0] + step) - at(start[0] - step)) / (2.0 * step);
            at(start[0]);
            let found = derivative(&mut component, &[(&name, 1.0)]).expect("a derivative");
            // The simple difference errs by the square of its step times that of the waves on the panel.
            let scale = expected.abs().max(1e-6 * acceleration(&mut component).abs() / step * 2e-4);
            assert!((found - expected).abs() < 1e-3 * scale, "{name}: {found} {expected}");
        }
    }
}
