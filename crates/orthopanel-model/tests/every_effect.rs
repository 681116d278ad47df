//! Laws that every effect of the catalogue obeys, whichever it is: a new one is tested here without a line of its own.

use std::f64::consts::TAU;

use num_complex::Complex64;
use orthopanel_model::{
    Boundary, Damping, Effect, EffectParameter, EffectSetting, EffectState, End, ModelError, Owner, PanelModel, Prior,
    ReceptanceSetup, RecordSetting, SuspensionMotion, catalogue,
};

use crate::effects_bench::{CONSTANTS, PIECE, at};

/// A test that has all that an effect may need: a clamped edge, suspension points, a sensor, hits.
fn setting() -> EffectSetting {
    let record = RecordSetting {
        number: 1,
        force_at: Some(at(0.27)),
        response_at: Some(at(0.27)),
        hit_time: 1e-3,
        suspension_motion: SuspensionMotion::InTime,
        ..RecordSetting::default()
    };
    let boundary = Boundary { left: End::Clamped, ..Boundary::FREE };
    EffectSetting { piece: PIECE, boundary, suspension: vec![at(-0.2), at(0.2)], record }
}

/// Where a search for it starts, or near there where that is none of the effect.
fn started(effect: &'static dyn Effect) -> EffectState {
    let of = |parameter: &EffectParameter| {
        let start = parameter.starts(&PIECE)[0];
        let away = match start {
            1.0 if parameter.is_factor => 1.1,
            0.0 => 0.1 * parameter.range_looked_for(&PIECE).1,
            _ => start,
        };
        parameter.held_at.unwrap_or(away)
    };
    EffectState::new(effect, effect.parameters().iter().map(of).collect(), 1).expect("as many values as parameters")
}

/// The accelerance \[(m/s²)/N\] at its driving point with these effects.
fn accelerances(states: &[EffectState], lines: &[Complex64]) -> Vec<Complex64> {
    let EffectSetting { piece, boundary, suspension, record } = setting();
    let setup = ReceptanceSetup::new(&piece, boundary, &suspension, &[record], 14).expect("a cantilever");
    let damping = Damping { beyond: 4e-3, ..Damping::default() };
    setup.model(&CONSTANTS, &damping, states).expect("a model").accelerances(0, lines).expect("accelerances")
}

/// Between and on the resonances of the cantilever, 54 Hz the first.
fn lines() -> Vec<Complex64> {
    (0..60).map(|line| Complex64::new(0.0, TAU * 20.0 * 1.09_f64.powi(line))).collect()
}

#[test]
fn starts_priors_and_values_that_are_held_lie_within_the_bounds() {
    for effect in catalogue() {
        for parameter in effect.parameters() {
            let told = format!("{} {}", effect.id(), parameter.name);
            let ((low, high), (from, to)) = (parameter.range(&PIECE), parameter.range_looked_for(&PIECE));
            assert!(low < high && low <= from && from < to && to <= high, "{told}: {low} {from} {to} {high}");
            let starts = parameter.starts(&PIECE);
            assert!(starts.iter().all(|start| (from..=to).contains(start)), "{told}: {starts:?} in {from} to {to}");
            assert!(parameter.held_at.is_none_or(|at| at.is_nan() || (low..=high).contains(&at)), "{told}");
            match parameter.prior {
                Prior::Even => assert!(low.is_finite() && high.is_finite(), "{told}"),
                Prior::Size { median, factor, .. } => {
                    assert!((low..=high).contains(&median) && factor > 1.0, "{told}: {median} {factor}");
                }
                Prior::Gaussian { mean, std } => assert!((low..=high).contains(&mean) && std > 0.0, "{told}"),
            }
        }
    }
}

#[test]
fn a_value_out_of_bounds_is_refused_by_name() {
    for effect in catalogue() {
        let state = started(*effect);
        for (number, parameter) in effect.parameters().iter().enumerate() {
            let mut values = state.values.clone();
            values[number] = parameter.range(&PIECE).1.mul_add(2.0, 1.0);
            let refused = effect.act(&values, &setting());
            let is_named = |error: &ModelError| {
                let text = error.to_string();
                text.contains(effect.id()) && text.contains(parameter.name)
            };
            assert!(refused.as_ref().is_err_and(is_named), "{} {}: {refused:?}", effect.id(), parameter.name);
        }
    }
}

/// What is real in time has $H(\bar s) = \overline{H(s)}$; and a driving point takes power in, $\mathrm{Re}\,H/s \ge 0$, whatever passive sits on
/// the panel.
#[test]
fn val_every_effect_is_real_in_time_and_none_of_panel_or_rig_gives_power() {
    let lines = lines();
    let conjugate: Vec<Complex64> = lines.iter().map(Complex64::conj).collect();
    let base = accelerances(&[], &lines);
    for effect in catalogue() {
        let state = started(*effect);
        let acts = !state.acting_in(&setting()).expect("its actions").is_empty();
        let found = accelerances(std::slice::from_ref(&state), &lines);
        let mirrored = accelerances(&[state], &conjugate);
        let mut moved: f64 = 0.0;
        for (line, s) in lines.iter().enumerate() {
            let (value, other) = (found[line], mirrored[line].conj());
            assert!((value - other).norm() <= 1e-9 * value.norm(), "{} at {s}: {value} {other}", effect.id());
            if effect.owner() != Owner::Channel {
                let mobility = (value / s).re;
                assert!(mobility >= -1e-9 * (value / s).norm(), "{} at {s}: {mobility:e}", effect.id());
            }
            moved = moved.max((value / base[line] - 1.0).norm());
        }
        assert_eq!(acts, moved > 1e-6, "{}: acts {acts}, moves a line by {moved:e}", effect.id());
    }
}

#[test]
fn every_effect_is_read_from_a_model_file() {
    for effect in catalogue() {
        let state = started(*effect);
        let written = |(parameter, value): (&EffectParameter, &f64)| {
            (!value.is_nan()).then(|| format!(", \"{}\": {value:e}", parameter.name))
        };
        let values: String = effect.parameters().iter().zip(&state.values).filter_map(written).collect();
        let text = format!(
            r#"{{"schema": "orthopanel.model/1", "piece": {{"length": 0.8, "width": 0.1, "thickness": 0.03,
            "mass_per_area": 6.88}}, "structure": "timoshenko-beam", "constants": {{"e_x": 1.07e10, "g_zx": 5.363e8}},
            "damping": {{"beyond": 0.003}}, "effects": [{{"id": "{}", "owner": "{}"{values}}}]}}"#,
            effect.id(),
            effect.owner().name()
        );
        let model = PanelModel::from_json(&text).unwrap_or_else(|error| panic!("{text}: {error}"));
        let back = EffectState::from_entry(&model.effects[0]).expect("an effect");
        let is_same = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-15 * b.abs() || a.is_nan() && b.is_nan();
        assert!(back.values.iter().zip(&state.values).all(is_same), "{}: {:?}", effect.id(), back.values);
    }
}
