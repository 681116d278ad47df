//! Damping and places set while the simulation runs.

use orthopanel_model::{Attachments, ModalModel, ModalStepper, ModeRange, PanelModel, Place, Ports};

use super::panel_tests::{BEAM, PLATE, reference, set};
use super::*;
use crate::{Connections, Residual};

/// Panels whose modes are found in all ways that there are.
pub(super) fn panels() -> Vec<String> {
    let with = |effect: &str| BEAM.replace(r#""damping""#, &format!(r#""effects": [{effect}], "damping""#));
    let plate_with = |effect: &str| PLATE.replace(r#""damping""#, &format!(r#""effects": [{effect}], "damping""#));
    let resonator = r#"{"id": "resonator", "owner": "panel", "mass": 0.02, "frequency": 400, "zeta": 0.05, "x": 0.1}"#;
    let loss = r#"{"id": "stiffness-loss", "owner": "panel", "loss": 0.4, "span": 0.1, "x": -0.1}"#;
    let core = r#"{"id": "viscoelastic-core", "owner": "panel", "strength": 0.2, "tau": 1e-4, "alpha": 0.6}"#;
    vec![BEAM.into(), PLATE.into(), with(resonator), with(loss), with(core), plate_with(resonator)]
}

const FORCES: [Place; 2] = [Place { x: -0.3, y: 0.02 }, Place { x: 0.1, y: -0.03 }];
const RESPONSES: [Place; 1] = [Place { x: 0.13, y: 0.04 }];
const MODES: usize = 4;

fn resource(text: &str) -> Resource {
    let ports = Ports { forces: FORCES.into(), responses: RESPONSES.into() };
    let panel = PanelModel::from_json(text).expect("a sound model");
    Resource::of_panel(&panel, ModeRange::Count(MODES), ports, Residual::Attachment, Connections::default())
        .expect("a sound panel")
        .0
}

pub(super) fn instance(text: &str, interface: Interface) -> Component {
    Component::new(&resource(text), interface, "a token of thirty-eight characters, so")
}

pub(super) fn initialized(text: &str, interface: Interface) -> Component {
    let mut component = instance(text, interface);
    component.enter_initialization().and_then(|()| component.exit_initialization()).expect("initialized");
    component
}

/// The modes of a panel with these ratios and places, solved from the model file's side; residual modes are those of the places before.
fn modes_of(text: &str, ratios: [f64; MODES], forces: &[Place], responses: &[Place]) -> ModalModel {
    let mut panel = PanelModel::from_json(text).expect("a sound model");
    panel.damping.ratios = ratios.into();
    let attachments = Attachments { places: FORCES.into(), count: None, damping_ratio: 0.003 };
    let found = panel.time_model(ModeRange::Count(MODES), forces, responses).expect("modes");
    found.with_residual_modes(&panel, &attachments, forces, responses).expect("residual modes").modes
}

fn outputs(component: &mut Component) -> [f64; 3] {
    let references = ["displacement_1", "velocity_1", "acceleration_1"].map(|name| reference(component, name));
    let mut values = [0.0; 3];
    component.get_reals(&references, &mut values).expect("outputs");
    values
}

pub(super) fn step(component: &mut Component, force: f64) -> [f64; 3] {
    set(component, "force_1", force).expect("a force");
    component.do_step(component.time(), 2e-4).expect("a step");
    outputs(component)
}

pub(super) fn force(n: i32) -> f64 {
    f64::from(n * 7 % 5) - 1.5
}

/// Ratios and places that are set half way.
pub(super) const TUNED: [(&str, f64); 5] = [
    ("damping_ratio_1", 0.05),
    ("damping_ratio_3", 0.0),
    ("force_1_x", -0.22),
    ("response_1_x", 0.31),
    ("response_1_y", -0.01),
];
const RATIOS: [[f64; MODES]; 2] = [[0.003; MODES], [0.05, 0.003, 0.0, 0.003]];
const TUNED_FORCES: [Place; 2] = [Place { x: -0.22, y: 0.02 }, FORCES[1]];
const TUNED_RESPONSES: [Place; 1] = [Place { x: 0.31, y: -0.01 }];

/// Each panel's own stepper goes on from the state of the one before, on modes that were never told of the change.
#[test]
fn val_what_is_tuned_between_steps_is_what_the_next_step_has() {
    for text in panels() {
        let mut component = initialized(&text, Interface::CoSimulation);
        let before = modes_of(&text, RATIOS[0], &FORCES, &RESPONSES);
        let after = modes_of(&text, RATIOS[1], &TUNED_FORCES, &TUNED_RESPONSES);
        let mut stepper = ModalStepper::new(&before);
        for n in 0..20 {
            step(&mut component, force(n));
            stepper.set_forces(&[force(n), 0.0]).and_then(|()| stepper.advance_held(2e-4)).expect("a step");
        }
        let state = component.stepper.state();
        for (name, value) in TUNED {
            set(&mut component, name, value).expect("a tunable parameter");
        }
        let mut tuned = ModalStepper::new(&after);
        tuned.set_state(&stepper.state()).and_then(|()| tuned.set_forces(&[force(19), 0.0])).expect("as many modes");
        let expected = |stepper: &ModalStepper| {
            [stepper.displacement(0), stepper.velocity(0), stepper.acceleration(0)].map(Option::unwrap)
        };
        let mut runs = vec![(outputs(&mut component), expected(&tuned))];
        assert_eq!(component.stepper.state(), state, "the state goes on");
        for n in 20..60 {
            tuned.set_forces(&[force(n), 0.0]).and_then(|()| tuned.advance_held(2e-4)).expect("a step");
            runs.push((step(&mut component, force(n)), expected(&tuned)));
        }
        for row in 0..3 {
            let peak = runs.iter().fold(0.0, |most: f64, (_, expected)| most.max(expected[row].abs()));
            for (n, (found, expected)) in runs.iter().enumerate() {
                let error = (found[row] - expected[row]).abs();
                assert!(peak > 0.0 && error < 1e-11 * peak, "{text}, output {row}, step {n}: {error:e} of {peak:e}");
            }
        }
    }
}

/// Where the force stays, displacement and velocity do not know of damping; acceleration does.
#[test]
fn val_motion_is_continuous_where_damping_is_tuned() {
    for text in panels() {
        let mut component = initialized(&text, Interface::CoSimulation);
        let [displacement, velocity, acceleration] =
            (0..20).map(|n| step(&mut component, force(n))).last().expect("20");
        set(&mut component, "damping_ratio_2", 0.1).expect("a ratio");
        let after = outputs(&mut component);
        assert!((after[0] - displacement).abs() <= 1e-12 * displacement.abs(), "{text}");
        assert!((after[1] - velocity).abs() <= 1e-12 * velocity.abs(), "{text}");
        assert!((after[2] - acceleration).abs() > 1e-3 * acceleration.abs(), "{text}");
    }
}

/// A force that runs to its next value sees the new panel from the step on; until then it is the old force.
#[test]
fn val_a_linear_force_goes_on_where_damping_is_tuned() {
    let mut component = instance(BEAM, Interface::CoSimulation);
    component.set_booleans(&[reference(&component, "force_linear")], &[true]).expect("a parameter");
    component.enter_initialization().and_then(|()| component.exit_initialization()).expect("initialized");
    let before = modes_of(BEAM, RATIOS[0], &FORCES, &RESPONSES);
    let mut ratios = RATIOS[0];
    ratios[0] = 0.2;
    let after = modes_of(BEAM, ratios, &FORCES, &RESPONSES);
    let (mut stepper, mut tuned) = (ModalStepper::new(&before), ModalStepper::new(&after));
    step(&mut component, 3.0);
    stepper.advance_linear(2e-4, &[3.0, 0.0]).expect("a step");
    set(&mut component, "damping_ratio_1", 0.2).expect("a ratio");
    let found = step(&mut component, -2.0);
    tuned.set_state(&stepper.state()).and_then(|()| tuned.set_forces(&[3.0, 0.0])).expect("as many modes");
    tuned.advance_linear(2e-4, &[-2.0, 0.0]).expect("a step");
    for (found, expected) in found[1..].iter().zip([tuned.velocity(0), tuned.acceleration(0)]) {
        let expected = expected.expect("a port");
        assert!((found - expected).abs() <= 1e-12 * expected.abs(), "{found} {expected}");
    }
}

/// The modes know nothing of the ports: a mode's sense and number stay the same wherever these are moved.
#[test]
fn val_modes_are_the_same_to_the_bit_wherever_the_ports_are() {
    for text in panels() {
        let here = modes_of(&text, RATIOS[0], &FORCES, &RESPONSES);
        let there = modes_of(&text, RATIOS[1], &[TUNED_FORCES[0], Place { x: 0.0, y: 0.0 }], &RESPONSES);
        for (one, other) in here.modes().iter().zip(there.modes()) {
            assert_eq!(one.angular_frequency, other.angular_frequency, "{text}");
            assert_eq!(one.at_responses, other.at_responses, "{text}");
        }
    }
}

/// What FMI 3.0 lists as a dependency has its derivative, also while the simulation runs.
#[test]
fn val_derivatives_by_tunable_parameters_are_those_of_differences() {
    for text in panels() {
        let mut component = initialized(&text, Interface::CoSimulation);
        (0..20).for_each(|n| _ = step(&mut component, force(n)));
        for output in ["displacement_1", "velocity_1", "acceleration_1"] {
            let unknown = reference(&component, output);
            let table = resource(&text).variables();
            let listed = table.get(unknown).expect("there").dependencies.clone();
            for (index, variable) in table.variables().iter().enumerate() {
                if !variable.tunable {
                    continue;
                }
                let (known, mut start) = ([variable.reference], [0.0]);
                component.get_reals(&known, &mut start).expect("a value");
                // Away from where only one side is a panel; a millimetre, or a tenth of a per cent of damping.
                let size = 1e-3;
                let mut at = |value: f64| {
                    component.set_reals(&known, &[value]).expect("a value");
                    let mut found = [0.0];
                    component.get_reals(&[unknown], &mut found).map(|()| found[0]).expect("an output")
                };
                let expected = (at(start[0] + size) - at(start[0] - size)) / (2.0 * size);
                let whole = at(start[0]).abs();
                let mut found = [0.0];
                component.directional_derivative(&[unknown], &known, &[1.0], &mut found).expect("a derivative");
                // The square of a millimetre beside the shortest wave's length, and what rounding is divided by.
                let scale = expected.abs().max(1e-3 * whole / 0.1);
                let name = &variable.name;
                assert!((found[0] - expected).abs() < 5e-3 * scale, "{text} {output} {name}: {found:?} {expected}");
                let is_listed = listed.iter().any(|on| on.reference as usize == index + 1);
                assert!(is_listed || expected.abs() <= 1e-9 * whole / 0.1, "{output} by {name}: {expected} of {whole}");
            }
        }
    }
}
