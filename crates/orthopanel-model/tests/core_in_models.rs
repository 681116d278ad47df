//! Model files with a viscoelastic core: internal variables, modes and lines against the line-by-line receptances.

use std::f64::consts::TAU;

use num_complex::Complex64;
use orthopanel_model::{CoreModulus, ModalStepper, ModeRange, PanelModel};

use crate::beam_with_effects::{SAME, WITH_EFFECTS, at, line, lines, text};

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
        let modulus = |strength| CoreModulus { strength, tau, alpha }.factor(s[n]);
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
        assert_core_is_met(numbers, &format!(",{WITH_EFFECTS}"), SAME, 3 * 3 - 2 + 6 * 9 + 1, 40);
    }
}

/// A driving point's displacement well below the last mode: the static part of what modes and internal variables lack is in
/// it. The core is stiffer there than at rest, and by so much this part errs.
#[test]
fn val_the_static_part_makes_up_beside_a_core_too() {
    let [strength, tau, alpha] = [0.2, 1e-4, 0.5];
    for others in [String::new(), format!(",{WITH_EFFECTS}")] {
        let model = undamped(&(core(strength, tau, alpha) + &others));
        let ports = [at(-0.31)];
        let found = model.time_model(ModeRange::Count(4), &ports, &ports).unwrap();
        let all = model.static_flexibility(4, &ports, &ports).unwrap();
        let static_remainder = found.modes.left_of_flexibility(all)[0][0];
        let whole = model.relaxing_lines(ModeRange::Count(40), &ports, &ports).unwrap().unwrap();
        for frequency in [60.0, 150.0, 400.0] {
            let omega = TAU * frequency;
            let lacking = |beyond: f64| {
                let accelerance = found.modes.accelerance(0, 0, frequency) - omega * omega * beyond;
                (accelerance - whole.at(Complex64::new(0.0, omega))[0][0]).norm() / (omega * omega)
            };
            let (with, without) = (lacking(static_remainder), lacking(0.0));
            assert!(with < 0.06 * without, "{frequency} Hz: {with:e} of {without:e} m/N");
        }
    }
}

/// Line by line with the law itself: the receptance at complex moduli, which sums modes along the modulus' path.
#[test]
fn val_lines_of_a_core_are_its_receptance() {
    for (others, same) in [(String::new(), &[][..]), (format!(",{WITH_EFFECTS}"), SAME)] {
        let [strength, tau, alpha] = [0.5, 1e-4, 0.5];
        let model = undamped(&(core(strength, tau, alpha) + &others));
        let found = model.relaxing_lines(ModeRange::Count(16), &[at(-0.31)], &[at(0.27)]).unwrap().unwrap();
        let values = [strength, tau, alpha];
        let all: Vec<(&str, &[f64])> =
            [("viscoelastic-core", &values[..])].into_iter().chain(same.iter().copied()).collect();
        let s: Vec<Complex64> = (0..200).map(|index| Complex64::new(0.0, TAU * 40.0 * 1.02_f64.powi(index))).collect();
        let (mut missed, mut whole) = (0.0_f64, 0.0_f64);
        for (exact, s) in lines(&all, 0.0, &s).into_iter().zip(&s) {
            missed = missed.max((found.at(*s)[0][0] - exact).norm());
            whole = whole.max(exact.norm());
        }
        assert!(missed < 1e-4 * whole, "{missed} of {whole}");
    }
    assert!(undamped(WITH_EFFECTS).relaxing_lines(ModeRange::Count(16), &[at(0.0)], &[at(0.0)]).unwrap().is_none());
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
        let loss = law.factor(Complex64::new(0.0, omega)).im;
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

/// A row a response, a column a force: the same lines one by one, on the coordinates that no place adds to.
#[test]
fn val_lines_of_many_places_are_those_of_each_two() {
    let model = undamped(&(core(0.3, 1e-4, 0.5) + "," + WITH_EFFECTS));
    let (forces, responses) = ([at(-0.31), at(0.05)], [at(0.27), at(-0.12), at(0.4)]);
    let of = |forces: &[_], responses: &[_]| {
        let lines = model.relaxing_lines_of_modes(ModeRange::Count(6), forces, responses).unwrap().unwrap();
        lines.at(Complex64::new(0.0, TAU * 330.0))
    };
    let all = of(&forces, &responses);
    assert_eq!((all.len(), all[0].len()), (3, 2));
    for (row, &response) in all.iter().zip(&responses) {
        for (value, &force) in row.iter().zip(&forces) {
            let single = of(&[force], &[response])[0][0];
            assert!((value - single).norm() < 1e-12 * single.norm(), "{value} {single}");
        }
    }
}
