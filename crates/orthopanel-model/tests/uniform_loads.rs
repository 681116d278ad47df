//! What weight, pressure and a moving frame do to modes: balances that hold whatever the shapes are, and the sines of pinned panels.

use std::f64::consts::PI;

use orthopanel_model::{DeflectionRow, ModeRange, PanelModel, Place, RigidMotion};

const EFFECTS: &str = r#"
    {"id":"local-mass","owner":"panel","mass":0.05,"x":0.1},
    {"id":"edge-mass","owner":"panel","mass":0.02},
    {"id":"resonator","owner":"panel","mass":0.02,"frequency":400,"zeta":0.05,"x":-0.2},
    {"id":"rotary-inertia","owner":"panel","factor":2.4}"#;

fn panel(structure: &str, boundary: &str, effects: &str, width: f64) -> PanelModel {
    let constants = if structure == "timoshenko-beam" {
        r#"{"e_x":1.067e10,"g_zx":5.304e8}"#
    } else {
        r#"{"e_x":1.07e10,"e_y":9.6e9,"nu_xy":0.31,"g_xy":3.7e9,"g_yz":2.9e8,"g_zx":5.363e8}"#
    };
    let text = format!(
        r#"{{"schema":"orthopanel.model/1","structure":"{structure}","constants":{constants},"boundary":{{{boundary}}},
        "damping":{{"beyond":0.01}},"effects":[{effects}],
        "piece":{{"length":0.8,"width":{width},"thickness":0.03,"mass_per_area":6.88}}}}"#
    );
    PanelModel::from_json(&text).unwrap()
}

/// Frequency of each mode, and a row of each.
fn of_modes(panel: &PanelModel, row: &DeflectionRow, count: usize) -> Vec<(f64, f64)> {
    let modes = panel.modes(ModeRange::Count(count)).unwrap();
    let value =
        |mode: &orthopanel_model::PanelMode| row.of_mode(mode.angular_frequency(), |place| mode.deflection(place));
    modes.iter().map(|mode| (mode.angular_frequency(), value(mode))).collect()
}

/// The rigid modes of a free panel hold all of its momentum, masses and resonators with it, and the others none.
#[test]
fn val_a_free_panel_has_its_momentum_in_rigid_modes() {
    // Under masses shapes have kinks, over which the points of the integral run: the more the higher the mode.
    let around = r#"{"id":"edge-mass","owner":"panel","mass":0.08,"mass_y":0.2}"#;
    for (structure, width, effects, tolerance) in [
        ("timoshenko-beam", 0.1, "", 1e-9),
        ("timoshenko-beam", 0.1, EFFECTS, 1e-3),
        ("mindlin-plate", 0.5, "", 1e-9),
        ("mindlin-plate", 0.5, around, 1e-9),
    ] {
        let panel = panel(structure, "", effects, width);
        for &motion in panel.rigid_motions() {
            let row = panel.inertia_row(motion, 8).unwrap();
            let whole = row.of_rigid(motion);
            let modes = of_modes(&panel, &row, 8);
            let rigid: f64 = modes.iter().filter(|(omega, _)| *omega == 0.0).map(|(_, value)| value * value).sum();
            // A rotation's inertia is that of slopes: exact without shear, as rigid motions are.
            assert!((rigid / whole - 1.0).abs() < tolerance, "{structure} {motion:?}: {rigid} of {whole}");
            // Shear makes rotations of flexible modes other than slopes.
            let kinks = if effects.is_empty() { tolerance } else { 2e-2 };
            let shear = if motion == RigidMotion::AlongZ { kinks } else { kinks.max(2e-3) };
            for (omega, value) in modes.iter().filter(|(omega, _)| *omega > 0.0) {
                assert!(
                    value.abs() < shear * whole.sqrt(),
                    "{structure} {motion:?} {omega}: {value} of {}",
                    whole.sqrt()
                );
            }
        }
        let on_it = match effects {
            "" => 0.0,
            _ if effects == around => 2.0 * (0.08 + 0.2),
            _ => 0.05 + 0.04 + 0.02,
        };
        let mass = 6.88 * 0.8 * width + on_it;
        let found = panel.inertia_row(RigidMotion::AlongZ, 8).unwrap().of_rigid(RigidMotion::AlongZ);
        assert!((found / mass - 1.0).abs() < 1e-12, "{found} {mass}");
    }
}

/// Each mode of a pinned plate is a product of sines: its mean is known, and its size from the mass that its rotations carry.
#[test]
fn val_a_pinned_plate_has_the_mean_of_its_sines() {
    let edges = r#""left":"pinned","right":"pinned","front":"pinned","back":"pinned""#;
    let panel = panel("mindlin-plate", edges, "", 0.5);
    let area = panel.area_row(12).unwrap();
    assert!((area.of_rigid(RigidMotion::AlongZ) - 0.8 * 0.5).abs() < 1e-12);
    let momentum = of_modes(&panel, &panel.inertia_row(RigidMotion::AlongZ, 12).unwrap(), 12);
    let middle = DeflectionRow::at(Place { x: 0.8 / 6.0, y: 0.5 / 6.0 });
    let modes = panel.modes(ModeRange::Count(12)).unwrap();
    for (mode, (_, momentum)) in modes.iter().zip(momentum) {
        let [m, n] = mode.nodes().map(|nodes| nodes + 1);
        let wave = |count: usize, at: f64| (count as f64 * PI * at).sin();
        let mean = |count: usize| (1.0 - (count as f64 * PI).cos()) / (count as f64 * PI);
        let size = middle.of_mode(0.0, |place| mode.deflection(place)) / (wave(m, 2.0 / 3.0) * wave(n, 2.0 / 3.0));
        let expected = size * 0.8 * 0.5 * mean(m) * mean(n);
        let found = area.of_mode(mode.angular_frequency(), |place| mode.deflection(place));
        if m % 3 != 0 && n % 3 != 0 {
            assert!((found - expected).abs() < 1e-4 * size.abs() * 0.4, "{m} {n}: {found} {expected}");
            assert!((momentum - 6.88 * found).abs() < 1e-9 * (6.88 * size * 0.4).abs(), "{momentum} {found}");
        }
    }
}

#[test]
fn a_resonator_on_a_core_that_relaxes_has_no_such_row() {
    let core = r#"{"id":"viscoelastic-core","owner":"panel","strength":0.2,"tau":1e-4,"alpha":0.6},
        {"id":"resonator","owner":"panel","mass":0.02,"frequency":400,"zeta":0.05,"x":-0.2}"#;
    let refused = panel("timoshenko-beam", "", core, 0.1).inertia_row(RigidMotion::AlongZ, 4).unwrap_err().to_string();
    assert!(refused.contains("beside a sprung mass and a core that relaxes"), "{refused}");
}
