//! Model files with effects: modes and accelerance against the line-by-line receptances, and what is refused.

use std::f64::consts::TAU;

use num_complex::Complex64;
use orthopanel_model::{Mode, ModeRange, ModelError, PanelMode, PanelModel};

use crate::beam_with_effects::{SAME, WITH_EFFECTS, at, line, text};

/// Every natural frequency is a pole of the undamped receptance.
#[test]
fn val_modes_are_the_poles_of_the_receptance() {
    let model = PanelModel::from_json(&text(WITH_EFFECTS)).unwrap();
    let modes = model.modes(ModeRange::Count(8)).unwrap();
    assert_eq!(modes.iter().filter(|mode| mode.is_rigid()).count(), 2);
    // The resonator's damping at its least leaves its own pole a hundredth of a percent beside.
    let undamped: Vec<(&str, Vec<f64>)> = SAME
        .iter()
        .map(|(id, values)| (*id, if *id == "resonator" { vec![0.02, 1200.0, 1e-4, -0.33] } else { values.to_vec() }))
        .collect();
    let undamped: Vec<(&str, &[f64])> = undamped.iter().map(|(id, values)| (*id, values.as_slice())).collect();
    for mode in modes.iter().filter(|mode| !mode.is_rigid()) {
        let dynamic = |f: f64| line(&undamped, 0.0, Complex64::new(0.0, TAU * f)).inv().re;
        let f = mode.frequency();
        // The residual shapes hold the first two of the six terms that the receptance keeps.
        let (low, high) = (dynamic(f * (1.0 - 1e-5)), dynamic(f * (1.0 + 1e-5)));
        assert!(low * high < 0.0, "no pole at {f} Hz: {low:e} {high:e}");
    }
}

/// A free beam with a mass $m$ at $p$, from what is known of it without: a force at $f$ moves it rigidly by $a(x)$, the mass pulls back
/// with $m\,a(p)$, and the motion that is left does none of the rigid motions of beam and mass together.
#[test]
fn val_static_part_beside_a_mass_in_closed_form() {
    let (mass, p, f, r) = (0.09, 0.11, -0.31, 0.27);
    let model = PanelModel::from_json(&text(r#"{"id":"local-mass","owner":"panel","mass":0.09,"x":0.11}"#)).unwrap();
    let bare = PanelModel::from_json(&text("")).unwrap();
    let flexibility = |from: f64, to: f64| bare.static_flexibility(1, &[at(from)], &[at(to)]).unwrap()[0][0];
    let rigid: Vec<PanelMode> =
        bare.modes(ModeRange::Count(1)).unwrap().into_iter().filter(PanelMode::is_rigid).collect();
    let shapes = |x: f64| -> Vec<f64> { rigid.iter().map(|mode| mode.deflection(at(x))).collect() };
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let (at_p, at_f) = (shapes(p), shapes(f));
    let heavier = 1.0 + mass * product(&at_p, &at_p);
    for x in [r, f, p] {
        let pulled = mass * product(&at_f, &at_p) / heavier;
        let elastic = |x: f64| flexibility(f, x) - pulled * flexibility(p, x);
        let expected = elastic(x) - mass * elastic(p) / heavier * product(&at_p, &shapes(x));
        let found = model.static_flexibility(6, &[at(f)], &[at(x)]).unwrap()[0][0];
        assert!((found / expected - 1.0).abs() < 1e-9, "at {x}: {found:e}, expected {expected:e}");
    }
}

/// Held panels stand still under a force whatever they carry.
#[test]
fn val_masses_change_nothing_of_a_held_panel_at_rest() {
    let carried = r#""effects":[{"id":"local-mass","owner":"panel","mass":0.2,"x":0.11},
        {"id":"resonator","owner":"panel","mass":0.1,"frequency":200,"zeta":0.004,"x":-0.2}]"#;
    let beam = r#""structure":"timoshenko-beam","constants":{"e_x":1.07e10,"g_zx":5.363e8},
        "boundary":{"left":"pinned","right":"clamped"}"#;
    let plate = r#""structure":"mindlin-plate","boundary":{"left":"pinned","right":"clamped","front":"pinned","back":"pinned"},
        "constants":{"e_x":1.07e10,"e_y":9e9,"nu_xy":0.3,"g_xy":3e9,"g_yz":3e8,"g_zx":5.363e8}"#;
    for (panel, within) in [(beam, 1e-9), (plate, 1e-6)] {
        let flexibility = |effects: &str| {
            let text = format!(
                r#"{{"schema":"orthopanel.model/1",{panel},"piece":{{"length":0.8,"width":0.3,"thickness":0.03,
                "mass_per_area":6.88}},"damping":{{"ratios":[],"beyond":0.004}},{effects}}}"#
            );
            let model = PanelModel::from_json(&text).unwrap();
            model.static_flexibility(6, &[at(-0.31), at(0.2)], &[at(0.27)]).unwrap()
        };
        let (with, without) = (flexibility(carried), flexibility(r#""effects":[]"#));
        // Two ports far apart on the plate are all but independent: what is left there is small beside the other.
        let greatest = without[0].iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        for (with, without) in with[0].iter().zip(&without[0]) {
            assert!((with - without).abs() < within * greatest, "{with:e} {without:e}");
        }
    }
}

/// What few modes miss of the accelerance well below the last is the static part of the others, and beyond it
/// $\omega^2\sum\phi_m\phi_m/\omega_m^4$ of these: 4 % of the static part at 200 Hz. A static part that is off by 2 %, as the missing mass
/// makes it where the series' second term is that of a cut basis, may hide in that, so the term is taken off.
#[test]
fn val_the_static_part_makes_up_for_the_modes_left_out() {
    let model = PanelModel::from_json(&text(WITH_EFFECTS)).unwrap();
    let ports = [[at(-0.31)], [at(0.27)]];
    let modes = model.modal_model(ModeRange::Count(2), &ports[0], &ports[1]).unwrap();
    let beyond = model.static_remainder(&modes, &ports[0], &ports[1]).unwrap()[0][0];
    let many = model.modal_model(ModeRange::Count(30), &ports[0], &ports[1]).unwrap();
    let second = |mode: &Mode| mode.at_forces[0] * mode.at_responses[0] / mode.angular_frequency.powi(4);
    let second: f64 = many.flexible().skip(2).map(second).sum();
    // Below the first resonance, where the damping of no mode counts.
    for frequency in [20.0, 60.0, 120.0, 200.0] {
        let omega = TAU * frequency;
        let truth = line(SAME, 0.004, Complex64::new(0.0, omega));
        let sum = modes.accelerance(0, 0, frequency);
        let at_rest = omega * omega * beyond;
        let [without, with] = [0.0, at_rest + omega.powi(4) * second].map(|rest| (sum - rest - truth) / at_rest);
        assert!((without.re - 1.0).abs() < 0.04, "{frequency} Hz: {without}");
        // The third term is 2 % of the second.
        assert!(with.re.abs() < 1e-3, "{frequency} Hz: {with}");
        assert!(with.im.abs() < 0.01, "{frequency} Hz: {with}");
    }
}

/// With one damping ratio everywhere the modes of the modified panel hold nearly all of its accelerance.
#[test]
fn val_accelerance_of_the_modes_is_the_receptance() {
    let model = PanelModel::from_json(&text(WITH_EFFECTS)).unwrap();
    let modal = model.modal_model(ModeRange::Count(60), &[at(-0.31)], &[at(0.27)]).unwrap();
    for frequency in [30.0, 321.0, 700.0, 1190.0, 2000.0] {
        let found = modal.accelerance(0, 0, frequency);
        let expected = line(SAME, 0.004, Complex64::new(0.0, TAU * frequency));
        // What couples the modes through the resonator's dashpot, of the size of zeta, and the modes left out.
        assert!((found - expected).norm() < 5e-3 * expected.norm().max(0.3), "{frequency} Hz: {found} {expected}");
    }
}

#[test]
fn val_an_effect_of_no_size_changes_nothing() {
    let bare = PanelModel::from_json(&text("")).unwrap().modes(ModeRange::Count(10)).unwrap();
    let none = r#"{"id":"edge-mass","owner":"panel","mass":0},{"id":"rotary-inertia","owner":"panel","factor":1}"#;
    let modified = PanelModel::from_json(&text(none)).unwrap().modes(ModeRange::Count(10)).unwrap();
    assert_eq!(bare.len(), modified.len());
    for (bare, modified) in bare.iter().zip(&modified) {
        assert!((bare.frequency() - modified.frequency()).abs() <= 1e-8 * bare.frequency());
        assert_eq!(bare.nodes(), modified.nodes());
    }
    let in_band = PanelModel::from_json(&text(none)).unwrap().modes(ModeRange::UpTo(3500.0)).unwrap();
    assert_eq!(in_band.len(), 2 + 5);
}

/// Modes that were left out in silence would look like a panel that has none there.
#[test]
fn regress_more_modes_than_a_beam_may_have_are_refused_with_the_frequency_reached() {
    for effects in ["", r#"{"id":"edge-mass","owner":"panel","mass":0.05}"#] {
        let model = PanelModel::from_json(&text(effects)).unwrap();
        let refused = model.modes(ModeRange::UpTo(1e8)).expect_err("refused");
        let ModelError::BeyondBasis { frequency: 1e8, available, reached } = refused else { panic!("{refused}") };
        assert_eq!(available, ModeRange::MOST);
        assert!(
            refused.to_string().contains(&format!("1000 modes at most, up to {} Hz", reached.floor())),
            "{refused}"
        );
        let highest = model.modes(ModeRange::Count(available)).unwrap().last().unwrap().frequency();
        assert!((highest - reached).abs() <= 1e-9 * reached, "{highest} Hz, told {reached} Hz");
        assert!(model.modes(ModeRange::UpTo(reached.floor())).is_ok(), "the way out that is told");
    }
}

/// More modes than a plate's largest basis resolves are refused with a number that can be had, effects or none.
#[test]
fn a_plate_with_effects_tells_how_many_modes_it_can_have() {
    let text = r#"{"schema":"orthopanel.model/1","structure":"mindlin-plate",
        "piece":{"length":0.8,"width":0.08,"thickness":0.03,"mass_per_area":6.88},"damping":{"ratios":[],"beyond":0.004},
        "constants":{"e_x":1.07e10,"e_y":9e9,"nu_xy":0.3,"g_xy":3e9,"g_yz":3e8,"g_zx":5.363e8},
        "effects":[{"id":"local-mass","owner":"panel","mass":0.02,"x":0.11}]}"#;
    let model = PanelModel::from_json(text).unwrap();
    let refused = model.modes(ModeRange::Count(900)).expect_err("refused");
    let ModelError::BasisTooSmall { asked: 900, available } = refused else { panic!("{refused}") };
    assert!(model.modes(ModeRange::Count(available)).is_ok(), "the way out that is told: {available}");
}

#[test]
fn what_is_no_effect_of_the_panel_is_refused_with_its_reason() {
    let said = |effects: &str| {
        PanelModel::from_json(&text(effects)).unwrap().modes(ModeRange::Count(3)).expect_err("refused").to_string()
    };
    let cases = [
        (
            r#"{"id":"sensor-mass","owner":"rig","mass":0.01}"#,
            "effect sensor-mass belongs to the rig, not to the panel",
        ),
        (r#"{"id":"gain","owner":"channel","gain":0.9}"#, "effect gain belongs to the channel, not to the panel"),
        (r#"{"id":"local-mass","owner":"rig","mass":0.01,"x":0}"#, "effect local-mass: owner = \"rig\""),
        (r#"{"id":"local-mass","owner":"panel","mass":0.01}"#, "effect local-mass: x is missing"),
        (
            r#"{"id":"local-mass","owner":"panel","mass":0.01,"x":0,"y":0.01}"#,
            "effect local-mass: y = 0.01: a beam has its effects on its centre line",
        ),
        (
            r#"{"id":"local-mass","owner":"panel","mass":-0.2,"x":0}"#,
            "effect local-mass: mass = -2e-1 kg: must lie between",
        ),
        (r#"{"id":"glue","owner":"panel"}"#, "effect \"glue\" is not in the catalogue"),
    ];
    for (effects, start) in cases {
        assert!(said(effects).starts_with(start), "{}", said(effects));
    }
}

/// A mass on its foot is the same mass on any basis, at an edge too, and the same where the plate is turned by a right angle.
#[test]
fn val_a_mass_on_a_plate_is_the_same_on_any_basis() {
    let frequencies = |turned: bool, place: [f64; 2], count: usize| -> Vec<f64> {
        let (mut sides, mut moduli, mut shear, mut at) = ([0.9, 0.6], [1.1e10, 8e9], [4e8, 2.5e8], place);
        let mut nu = 0.3;
        if turned {
            nu *= moduli[1] / moduli[0];
            [&mut sides, &mut moduli, &mut shear, &mut at].into_iter().for_each(|pair| pair.reverse());
        }
        let model = format!(
            r#"{{"schema":"orthopanel.model/1","structure":"mindlin-plate",
            "piece":{{"length":{},"width":{},"thickness":0.02,"mass_per_area":5.0}},
            "constants":{{"e_x":{{"value":{}}},"e_y":{{"value":{}}},"nu_xy":{{"value":{nu}}},"g_xy":{{"value":3e9}},
            "g_zx":{{"value":{}}},"g_yz":{{"value":{}}}}},"damping":{{"beyond":0.0}},
            "effects":[{{"id":"local-mass","owner":"panel","mass":0.08,"x":{},"y":{}}}]}}"#,
            sides[0], sides[1], moduli[0], moduli[1], shear[0], shear[1], at[0], at[1]
        );
        let modes = PanelModel::from_json(&model).unwrap().modes(ModeRange::Count(count)).unwrap();
        modes.iter().filter(|mode| !mode.is_rigid()).take(12).map(PanelMode::frequency).collect()
    };
    let worst = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max);
    for place in [[0.21, -0.13], [0.445, 0.1]] {
        let few = frequencies(false, place, 12);
        let by_basis = worst(&few, &frequencies(false, place, 90));
        let by_turn = worst(&few, &frequencies(true, place, 12));
        assert!(by_basis < 1.5e-3 && by_turn < 1.5e-3, "{place:?}: {by_basis:e}, turned {by_turn:e}");
    }
}
