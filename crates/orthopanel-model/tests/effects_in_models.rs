//! Model files with effects: modes and accelerance against the line-by-line receptances, and what is refused.

use std::f64::consts::TAU;

use num_complex::Complex64;
use orthopanel_model::{
    Boundary, CoreModulus, Damping, EffectState, ModalStepper, Mode, ModeRange, ModelError, PanelMode, PanelModel,
    Piece, Place, ReceptanceSetup, RecordSetting, effect,
};

const PIECE: Piece = Piece { length: 0.8, width: 0.1, thickness: 0.03, mass_per_area: 6.88 };
const CONSTANTS: [f64; 2] = [1.07e10, 5.363e8];

fn text(effects: &str) -> String {
    format!(
        r#"{{"schema":"orthopanel.model/1","structure":"timoshenko-beam",
        "piece":{{"length":0.8,"width":0.1,"thickness":0.03,"mass_per_area":6.88}},
        "constants":{{"e_x":1.07e10,"g_zx":5.363e8}},"damping":{{"ratios":[],"beyond":0.004}},"effects":[{effects}]}}"#
    )
}

fn at(x: f64) -> Place {
    Place { x, y: 0.0 }
}

/// The receptances that know no modal coordinates of the dressed panel.
fn lines(effects: &[(&str, &[f64])], zeta: f64, s: &[Complex64]) -> Vec<Complex64> {
    let record = RecordSetting { force_at: Some(at(-0.31)), response_at: Some(at(0.27)), ..RecordSetting::default() };
    let setup = ReceptanceSetup::new(&PIECE, Boundary::FREE, &[], &[record], 16).unwrap();
    let state = |(id, values): &(&str, &[f64])| EffectState::new(effect(id).unwrap(), values.to_vec(), 1).unwrap();
    let states: Vec<EffectState> = effects.iter().map(state).collect();
    let model = setup.model(&CONSTANTS, &Damping { ratios: vec![], beyond: zeta }, &states).unwrap();
    let mut found = vec![];
    model.evaluator(0).unwrap().lines(s, |_, value, _| found.push(value));
    found
}

fn line(effects: &[(&str, &[f64])], zeta: f64, s: Complex64) -> Complex64 {
    lines(effects, zeta, &[s])[0]
}

const DRESSED: &str = r#"{"id":"local-mass","owner":"panel","mass":0.03,"x":0.11},
    {"id":"local-mass","owner":"panel","mass":-0.01,"x":-0.2},
    {"id":"resonator","owner":"panel","mass":0.02,"frequency":1200,"zeta":0.004,"x":-0.33},
    {"id":"stiffness-loss","owner":"panel","loss":0.4,"span":0.1,"x":0.2},
    {"id":"rotary-inertia","owner":"panel","factor":2.2}"#;

const SAME: &[(&str, &[f64])] = &[
    ("local-mass", &[0.03, 0.11]),
    ("local-mass", &[-0.01, -0.2]),
    ("resonator", &[0.02, 1200.0, 0.004, -0.33]),
    ("stiffness-loss", &[0.4, 0.1, 0.2]),
    ("rotary-inertia", &[2.2]),
];

/// Every natural frequency is a pole of the undamped receptance.
#[test]
fn val_modes_are_the_poles_of_the_receptance() {
    let model = PanelModel::from_json(&text(DRESSED)).unwrap();
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
    let model = PanelModel::from_json(&text(DRESSED)).unwrap();
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

/// With one damping ratio everywhere the modes of the dressed panel hold nearly all of its accelerance.
#[test]
fn val_accelerance_of_the_modes_is_the_receptance() {
    let model = PanelModel::from_json(&text(DRESSED)).unwrap();
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
    let dressed = PanelModel::from_json(&text(none)).unwrap().modes(ModeRange::Count(10)).unwrap();
    assert_eq!(bare.len(), dressed.len());
    for (bare, dressed) in bare.iter().zip(&dressed) {
        assert!((bare.frequency() - dressed.frequency()).abs() <= 1e-8 * bare.frequency());
        assert_eq!(bare.nodes(), dressed.nodes());
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
            r#"{"id":"local-mass","owner":"panel","mass":0.01,"x":0,"y":0}"#,
            "effect local-mass: y is no parameter of it",
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

fn core(strength: f64, tau: f64, alpha: f64) -> String {
    format!(r#"{{"id":"viscoelastic-core","owner":"panel","strength":{strength},"tau":{tau},"alpha":{alpha}}}"#)
}

fn undamped(effects: &str) -> PanelModel {
    PanelModel::from_json(&text(effects).replace(r#""beyond":0.004"#, r#""beyond":0.0"#)).unwrap()
}

/// With internal variables in place of the law itself: the receptance at complex moduli, which knows of none, is met within
/// what the fit says of the modulus, as far as a change of the modulus moves the receptance.
fn assert_core_is_met(numbers: [f64; 3], others: &str, same: &[(&str, &[f64])], more_modes: usize, count: usize) {
    let [strength, tau, alpha] = numbers;
    let model = undamped(&(core(strength, tau, alpha) + others));
    let found = model.time_model(ModeRange::Count(20), &[at(-0.31)], &[at(0.27)]).unwrap();
    let fit = found.core.unwrap();
    assert_eq!((found.flexible, found.modes.modes().len()), (20, 2 + 20 * 8 + more_modes));
    assert!(fit.error < 1e-2, "{}", fit.error);
    let all_at = |strength: f64, s: &[Complex64]| {
        let values = [strength, tau, alpha];
        let all: Vec<(&str, &[f64])> =
            [("viscoelastic-core", &values[..])].into_iter().chain(same.iter().copied()).collect();
        lines(&all, 0.0, s)
    };
    let frequencies: Vec<f64> = (0..count).map(|n| 40.0 * (115.0_f64.ln() * n as f64 / count as f64).exp()).collect();
    let s: Vec<Complex64> = frequencies.iter().map(|frequency| Complex64::new(0.0, TAU * frequency)).collect();
    let (exact, stronger) = (all_at(strength, &s), all_at(strength * (1.0 + 1e-3), &s));
    let without = lines(same, 1e-3, &s);
    let (mut missed, mut moved, mut bare) = (0.0_f64, 0.0_f64, 0.0_f64);
    let mut whole = 0.0_f64;
    for (n, &frequency) in frequencies.iter().enumerate() {
        missed = missed.max((found.modes.accelerance(0, 0, frequency) - exact[n]).norm());
        let modulus = |strength| CoreModulus { strength, tau, alpha }.line(s[n]).value;
        let change = (modulus(strength * (1.0 + 1e-3)) - modulus(strength)).norm() / modulus(strength).norm();
        moved = moved.max((stronger[n] - exact[n]).norm() / change);
        bare = bare.max((without[n] - exact[n]).norm());
        whole = whole.max(exact[n].norm());
    }
    // To first order; the modes left out add less than 1e-3 of the largest value.
    assert!(missed < 1.2 * fit.error * moved + 1e-3 * whole, "{missed} {moved} {}", fit.error);
    assert!(bare > 20.0 * missed, "the core must be seen: {bare} {missed}");
}

#[test]
fn val_a_core_in_internal_variables_is_its_receptance() {
    for numbers in [[0.1, 1e-4, 0.6], [0.5, 1e-4, 0.5], [1.0, 1e-3, 0.8]] {
        assert_core_is_met(numbers, "", &[], 0, 200);
    }
}

/// Elements sit on shapes that relax, too: mass, missing mass and resonator beside the core, on a panel with a span that has
/// lost shear stiffness.
#[test]
fn val_a_core_beside_elements_is_its_receptance() {
    for numbers in [[0.1, 1e-4, 0.6], [0.5, 1e-4, 0.5]] {
        // Three elements: two shapes and a kink each (that under the resonator has no mass, that under the missing mass has less
        // than none), two directions of shear and one for the kink, each in six terms; and the resonator's own mass.
        assert_core_is_met(numbers, &format!(",{DRESSED}"), SAME, 3 * 3 - 2 + 6 * 9 + 1, 40);
    }
}

/// A driving point's displacement well below the last mode: the static part of what modes and internal variables lack is in
/// it. The core is stiffer there than at rest, and by so much this part errs.
#[test]
fn val_the_static_part_makes_up_beside_a_core_too() {
    let [strength, tau, alpha] = [0.2, 1e-4, 0.5];
    for others in [String::new(), format!(",{DRESSED}")] {
        let model = undamped(&(core(strength, tau, alpha) + &others));
        let ports = [at(-0.31)];
        let found = model.time_model(ModeRange::Count(4), &ports, &ports).unwrap();
        let whole = model.relaxing_lines(ModeRange::Count(40), ports[0], ports[0]).unwrap().unwrap();
        for frequency in [60.0, 150.0, 400.0] {
            let omega = TAU * frequency;
            let lacking = |beyond: f64| {
                let accelerance = found.modes.accelerance(0, 0, frequency) - omega * omega * beyond;
                (accelerance - whole.at(Complex64::new(0.0, omega))).norm() / (omega * omega)
            };
            let (with, without) = (lacking(found.static_remainder[0][0]), lacking(0.0));
            assert!(with < 0.06 * without, "{frequency} Hz: {with:e} of {without:e} m/N");
        }
    }
}

/// Line by line with the law itself: the receptance at complex moduli, which sums modes along the modulus' path.
#[test]
fn val_lines_of_a_core_are_its_receptance() {
    for (others, same) in [(String::new(), &[][..]), (format!(",{DRESSED}"), SAME)] {
        let [strength, tau, alpha] = [0.5, 1e-4, 0.5];
        let model = undamped(&(core(strength, tau, alpha) + &others));
        let found = model.relaxing_lines(ModeRange::Count(16), at(-0.31), at(0.27)).unwrap().unwrap();
        let values = [strength, tau, alpha];
        let all: Vec<(&str, &[f64])> =
            [("viscoelastic-core", &values[..])].into_iter().chain(same.iter().copied()).collect();
        let s: Vec<Complex64> = (0..200).map(|index| Complex64::new(0.0, TAU * 40.0 * 1.02_f64.powi(index))).collect();
        let (mut missed, mut whole) = (0.0_f64, 0.0_f64);
        for (exact, s) in lines(&all, 0.0, &s).into_iter().zip(&s) {
            missed = missed.max((found.at(*s) - exact).norm());
            whole = whole.max(exact.norm());
        }
        assert!(missed < 1e-4 * whole, "{missed} of {whole}");
    }
    assert!(undamped(DRESSED).relaxing_lines(ModeRange::Count(16), at(0.0), at(0.0)).unwrap().is_none());
}

/// A mode at its own storage modulus, with the core's loss, is where the undamped receptance at complex moduli has its pole:
/// by Newton's steps on one over the receptance, to the product of the mode's and the core's loss.
#[test]
fn val_modes_with_a_core_are_the_poles_of_the_receptance() {
    let values = [0.1, 1e-4, 0.6];
    let model = undamped(&core(values[0], values[1], values[2]));
    let modes = model.modes(ModeRange::Count(6)).unwrap();
    assert_eq!(modes.iter().filter(|mode| mode.is_rigid()).count(), 2);
    let dynamic = |s: Complex64| line(&[("viscoelastic-core", &values)], 0.0, s).inv();
    for mode in modes.iter().filter(|mode| !mode.is_rigid()) {
        let (omega, zeta) = (mode.angular_frequency(), mode.own_damping_ratio().unwrap());
        let mut s = Complex64::new(-zeta * omega, omega);
        let start = s;
        for _ in 0..8 {
            let h = 1e-5 * omega;
            let step = dynamic(s) * 2.0 * h / (dynamic(s + h) - dynamic(s - h));
            // At the pole itself the receptance is no number.
            if !step.is_finite() || step.norm() < 1e-10 * omega {
                break;
            }
            s -= step;
        }
        let law = CoreModulus { strength: values[0], tau: values[1], alpha: values[2] };
        let loss = law.line(Complex64::new(0.0, omega)).value.im;
        let missed = (s - start).norm() / omega;
        assert!(missed > 0.0, "no step was taken");
        assert!(missed < 2.0 * zeta * loss && missed < 0.05 * zeta, "{s} {start}");
    }
}

/// Whatever force has acted: once it ends, the energy of panel and internal variables falls at every step of any size.
#[test]
fn val_energy_never_grows_without_a_force() {
    let model = undamped(&core(0.6, 2e-4, 0.4));
    let found = model.time_model(ModeRange::Count(10), &[at(-0.31)], &[at(0.27)]).unwrap().modes;
    assert_eq!(found.modes().len(), 2 + 10 * 8);
    let mut stepper = ModalStepper::new(&found);
    let energy = |stepper: &ModalStepper| -> f64 {
        let both = stepper.state().into_iter().zip(found.modes());
        both.map(|([a, v], mode)| 0.5 * (v * v + (mode.angular_frequency * a).powi(2))).sum()
    };
    for (round, step) in [1e-6, 1e-5, 1e-4, 1e-3, 3e-6].into_iter().enumerate() {
        for n in 0..40 {
            stepper.set_forces(&[f64::from(n * 7 % 11) - 5.0 + round as f64]).unwrap();
            stepper.advance_held(1e-5).unwrap();
        }
        stepper.set_forces(&[0.0]).unwrap();
        let first = energy(&stepper);
        let mut before = first;
        for _ in 0..200 {
            stepper.advance_held(step).unwrap();
            let now = energy(&stepper);
            assert!(now <= before * (1.0 + 1e-11), "step {step}: {before:e} to {now:e}");
            before = now;
        }
        assert!(before < first, "step {step}: nothing was lost");
    }
}

#[test]
fn a_core_is_refused_where_no_internal_variables_can_be_told() {
    let model = undamped(&core(0.5, 1e-4, 0.5));
    let refused = |model: &PanelModel, count| {
        model.time_model(ModeRange::Count(count), &[at(0.0)], &[at(0.0)]).expect_err("refused").to_string()
    };
    assert!(model.modes(ModeRange::Count(5)).is_ok(), "each at its own modulus");
    assert!(refused(&model, 1).contains("from 2 to 60"), "{}", refused(&model, 1));
}

/// `--up-to` keeps the modes that the panel has there at the low modulus of its core, rigid ones not counted, and two at least.
#[test]
fn val_a_range_up_to_a_frequency_counts_the_modes_beside_a_core() {
    let core = r#"{"id":"viscoelastic-core","owner":"panel","strength":0.2,"tau":1e-4,"alpha":0.6}"#;
    let plate = r#"{"schema":"orthopanel.model/1","structure":"mindlin-plate",
        "piece":{"length":0.8,"width":0.4,"thickness":0.03,"mass_per_area":6.88},"damping":{"ratios":[],"beyond":0.004},
        "constants":{"e_x":1.07e10,"e_y":9e9,"nu_xy":0.3,"g_xy":3e9,"g_yz":3e8,"g_zx":5.363e8},"effects":[CORE]}"#;
    for model in [text(core), plate.replace("CORE", core)] {
        let model = PanelModel::from_json(&model).unwrap();
        let mut bare = model.clone();
        bare.effects.clear();
        for frequency in [100.0, 900.0, 1700.0, 2900.0] {
            let modes = bare.modes(ModeRange::UpTo(frequency)).unwrap();
            let expected = modes.iter().filter(|mode| !mode.is_rigid()).count().max(2);
            let found = model.time_model(ModeRange::UpTo(frequency), &[at(-0.31)], &[at(0.27)]).unwrap();
            assert_eq!(found.flexible, expected, "up to {frequency} Hz");
        }
    }
}
