//! Instances whose panel can be set.

use orthopanel_model::{ModeRange, PanelModel, Place, Ports};

use super::*;

const PLATE: &str = r#"{"schema": "orthopanel.model/1", "structure": "mindlin-plate",
    "piece": {"length": 0.8, "width": 0.5, "thickness": 0.03, "mass_per_area": 6.88},
    "constants": {"e_x": 1.067e10, "e_y": 0.9e10, "nu_xy": 0.3, "g_xy": 3e9, "g_yz": 4e8, "g_zx": 5.304e8},
    "damping": {"beyond": 0.003}}"#;

const BEAM: &str = r#"{"schema": "orthopanel.model/1", "structure": "timoshenko-beam",
    "piece": {"length": 0.8, "width": 0.1, "thickness": 0.03, "mass_per_area": 6.88},
    "constants": {"e_x": 1.067e10, "g_zx": 5.304e8}, "damping": {"beyond": 0.003}}"#;

fn instance(text: &str, interface: Interface) -> Component {
    let place = |x| Place { x, y: 0.02 };
    let ports = Ports { forces: vec![place(-0.3)], responses: vec![place(0.1)] };
    let panel = PanelModel::from_json(text).expect("a sound model");
    let (resource, _) = Resource::of_panel(&panel, ModeRange::Count(4), ports).expect("a sound panel");
    Component::new(&resource, interface, "")
}

fn reference(component: &Component, name: &str) -> u32 {
    let all = component.variables.variables();
    all.iter().find(|variable| variable.name == name).expect("a variable").reference
}

fn set(component: &mut Component, name: &str, value: f64) -> Result<(), FmuError> {
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
    assert!(refused.starts_with("step = 1e300 s: too long"), "{refused}");
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
