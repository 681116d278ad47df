//! Every derivative of every effect against central differences.

use num_complex::Complex64;
use orthopanel_model::{
    Boundary, CORE_WAVES, Damping, Effect, EffectState, End, Piece, Place, ReceptanceSetup, RecordSetting,
    SuspensionMotion, catalogue, effect, roughness,
};

const PIECE: Piece = Piece { length: 0.8, width: 0.1, thickness: 0.03, mass_per_area: 6.88 };
const CONSTANTS: [f64; 2] = [1.07e10, 5.363e8];
/// Of nine modes, and last that of all beyond.
const RATIOS: [f64; 10] = [0.004, 0.005, 0.006, 0.004, 0.007, 0.005, 0.006, 0.004, 0.005, 0.003];
const RECORDS: usize = 2;

fn at(x: f64) -> Place {
    Place { x, y: 0.0 }
}

fn setup(boundary: Boundary) -> ReceptanceSetup {
    let record = |force: f64| RecordSetting {
        force_at: Some(at(force)),
        response_at: Some(at(0.27)),
        hit_time: 2e-3,
        suspension_motion: SuspensionMotion::Amplitudes(vec![3e-5, 2e-5]),
        ..RecordSetting::default()
    };
    ReceptanceSetup::new(&PIECE, boundary, &[at(-0.22), at(0.22)], &[record(-0.31), record(0.12)], 12).unwrap()
}

/// Values somewhere inside, at which every parameter shows.
fn values(effect: &dyn Effect) -> Vec<f64> {
    match effect.id() {
        "sensor-mass" => vec![0.02, 2e-5],
        "suspension" => vec![4e4, 15.0],
        "local-mass" => vec![-0.03, 0.11],
        "edge-mass" => vec![0.02],
        "stiffness-loss" => vec![0.4, 0.13, -0.17],
        "resonator" => vec![0.03, 900.0, 0.03, 0.21],
        "rotary-inertia" => vec![2.3],
        "viscoelastic-core" => vec![0.4, 2e-4, 0.6],
        "cubic-stiffness" => vec![8e13],
        "channel-delay" => vec![2e-5],
        "sensor-resonance" => vec![6000.0, 0.03],
        "high-pass" => vec![20.0],
        "exponential-window" => vec![0.05],
        "gain" => vec![0.93],
        "record-gain" => vec![0.9, 2.0],
        "hammer-offset" => vec![0.004, -0.003],
        "width-coupling" => vec![0.8, 0.3, 0.35, 0.6],
        "support-compliance" => vec![2e4, 3e6],
        "position-error" => vec![0.006],
        // Offset and gain of both records, then the waves.
        "roughness" => (0..4 + CORE_WAVES).map(|i| [0.004, -0.003, 1.02, 0.98].get(i).map_or(0.01, |v| *v)).collect(),
        id => unreachable!("{id} has no values in this test"),
    }
}

/// All lines of both records, and every derivative.
fn lines(setup: &ReceptanceSetup, constants: [f64; 2], ratios: &[f64], effects: &[EffectState]) -> Vec<Vec<Complex64>> {
    let (&beyond, ratios) = ratios.split_last().unwrap();
    let damping = Damping { ratios: ratios.to_vec(), beyond };
    let model = setup.model(&constants, &damping, effects).unwrap();
    let mut found = vec![vec![]; 1 + model.columns()];
    for record in 0..model.records() {
        let mut evaluator = model.evaluator(record).unwrap();
        let mut by = vec![Complex64::ZERO; model.columns()];
        for frequency in [40.0, 180.0, 320.0, 833.0, 1490.0, 2400.0, 3300.0, 4100.0] {
            let s = Complex64::new(15.0, std::f64::consts::TAU * frequency);
            found[0].push(evaluator.line(s, &mut by));
            found[1..].iter_mut().zip(&by).for_each(|(list, value)| list.push(*value));
        }
    }
    found
}

fn norm(list: &[Complex64]) -> f64 {
    list.iter().map(|value| value.norm_sqr()).sum::<f64>().sqrt()
}

/// Compares column `column` with differences of `moved`, which steps the value of size `scale`.
fn check(name: &str, by: &[Complex64], scale: f64, moved: &dyn Fn(f64) -> Vec<Complex64>) {
    // A single wave of a core moves every line by a hundredth of what other numbers do: that much nearer is rounding.
    let tolerance = if name.contains(", roughness") { 1e-5 } else { 1e-6 };
    // Two steps extrapolated: rounding near 1e-10, the fourth power of the step near 1e-9.
    let difference = |h: f64| -> Vec<Complex64> {
        moved(h).iter().zip(moved(-h)).map(|(high, low)| (high - low) / (2.0 * h)).collect()
    };
    let h = 1e-4 * scale;
    let best: Vec<Complex64> =
        difference(h).iter().zip(difference(2.0 * h)).map(|(fine, coarse)| (4.0 * fine - coarse) / 3.0).collect();
    let error: Vec<Complex64> = by.iter().zip(&best).map(|(by, best)| by - best).collect();
    assert!(norm(&best) > 0.0, "{name}: nothing moves");
    assert!(norm(&error) < tolerance * norm(&best), "{name}: {:e}", norm(&error) / norm(&best));
}

fn check_all(name: &str, boundary: Boundary, chosen: &[EffectState]) {
    let setup = setup(boundary);
    let found = lines(&setup, CONSTANTS, &RATIOS, chosen);
    for j in 0..2 {
        let moved = |h: f64| {
            let mut constants = CONSTANTS;
            constants[j] += h;
            lines(&setup, constants, &RATIOS, chosen).swap_remove(0)
        };
        check(&format!("{name}, constant {j}"), &found[1 + j], CONSTANTS[j], &moved);
    }
    // Lines sum no more than nine modes of a plate: there all far ones take a ratio of the list.
    let is_plate = chosen.iter().any(|state| state.effect.id() == "width-coupling");
    for mode in [0, 4, if is_plate { 5 } else { 9 }] {
        let moved = |h: f64| {
            let mut ratios = RATIOS;
            ratios[mode] *= h.exp();
            lines(&setup, CONSTANTS, &ratios, chosen).swap_remove(0)
        };
        check(&format!("{name}, ln zeta {}", mode + 1), &found[3 + mode], 1.0, &moved);
    }
    let mut column = 3 + RATIOS.len();
    for (i, state) in chosen.iter().enumerate() {
        for (k, &value) in state.values.iter().enumerate() {
            let index = state.effect.id() == "record-gain" && k == 1;
            if !index {
                let moved = |h: f64| {
                    let mut states = chosen.to_vec();
                    states[i].values[k] += h;
                    lines(&setup, CONSTANTS, &RATIOS, &states).swap_remove(0)
                };
                // What starts from nothing has no size of its own: a hundredth of that would drown in rounding.
                let from_nothing = ["hammer-offset", "roughness"].contains(&state.effect.id());
                let scale = if from_nothing { 0.1 } else { value.abs() };
                check(&format!("{name}, {} {k}", state.effect.id()), &found[column], scale, &moved);
            }
            column += 1;
        }
    }
    assert_eq!(column, found.len());
}

fn state(id: &str) -> EffectState {
    let effect = effect(id).unwrap();
    EffectState::new(effect, values(effect), RECORDS).unwrap()
}

#[test]
fn val_every_effect_alone() {
    let clamped = Boundary { left: End::Clamped, ..Boundary::FREE };
    for effect in catalogue().iter() {
        let boundary = if effect.id() == "support-compliance" { clamped } else { Boundary::FREE };
        check_all(effect.id(), boundary, &[state(effect.id())]);
    }
}

/// No effect of the catalogue, but beside any of them.
#[test]
fn val_a_rough_test() {
    let rough = || EffectState::new(roughness(), values(roughness()), RECORDS).unwrap();
    check_all("rough", Boundary::FREE, &[rough(), state("sensor-mass")]);
    let clamped = Boundary { left: End::Clamped, ..Boundary::FREE };
    let ids = ["stiffness-loss", "viscoelastic-core", "support-compliance"];
    check_all("rough and spread", clamped, &[vec![rough()], ids.map(state).to_vec()].concat());
}

/// What moves a place, what sits there, and what bends the line in between.
#[test]
fn val_effects_together() {
    let ids = ["sensor-mass", "position-error", "hammer-offset", "resonator", "exponential-window", "sensor-resonance"];
    check_all("together", Boundary::FREE, &ids.map(state));
    let clamped = Boundary { left: End::Clamped, right: End::Clamped, ..Boundary::FREE };
    let ids = ["viscoelastic-core", "stiffness-loss", "rotary-inertia", "support-compliance", "local-mass"];
    check_all("spread", clamped, &ids.map(state));
    let ids = ["width-coupling", "hammer-offset", "sensor-mass", "gain"];
    check_all("on a plate", Boundary::FREE, &ids.map(state));
}
