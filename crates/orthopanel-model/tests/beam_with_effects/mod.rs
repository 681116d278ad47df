//! A beam with elements on it, as a model file and as line-by-line receptances, which know no modal coordinates.

use num_complex::Complex64;
use orthopanel_model::{Boundary, Damping, EffectState, Piece, Place, ReceptanceSetup, RecordSetting, effect};

pub const PIECE: Piece = Piece { length: 0.8, width: 0.1, thickness: 0.03, mass_per_area: 6.88 };
pub const CONSTANTS: [f64; 2] = [1.07e10, 5.363e8];

pub fn text(effects: &str) -> String {
    format!(
        r#"{{"schema":"orthopanel.model/1","structure":"timoshenko-beam",
        "piece":{{"length":0.8,"width":0.1,"thickness":0.03,"mass_per_area":6.88}},
        "constants":{{"e_x":1.07e10,"g_zx":5.363e8}},"damping":{{"ratios":[],"beyond":0.004}},"effects":[{effects}]}}"#
    )
}

pub fn at(x: f64) -> Place {
    Place { x, y: 0.0 }
}

/// The receptances that know no modal coordinates of the modified panel.
pub fn lines(effects: &[(&str, &[f64])], zeta: f64, s: &[Complex64]) -> Vec<Complex64> {
    let record = RecordSetting { force_at: Some(at(-0.31)), response_at: Some(at(0.27)), ..RecordSetting::default() };
    let setup = ReceptanceSetup::new(&PIECE, Boundary::FREE, &[], &[record], 16).unwrap();
    let state = |(id, values): &(&str, &[f64])| EffectState::new(effect(id).unwrap(), values.to_vec(), 1).unwrap();
    let states: Vec<EffectState> = effects.iter().map(state).collect();
    let model = setup.model(&CONSTANTS, &Damping { beyond: zeta, ..Damping::default() }, &states).unwrap();
    model.accelerances(0, s).unwrap()
}

pub fn line(effects: &[(&str, &[f64])], zeta: f64, s: Complex64) -> Complex64 {
    lines(effects, zeta, &[s])[0]
}

pub const WITH_EFFECTS: &str = r#"{"id":"local-mass","owner":"panel","mass":0.03,"x":0.11},
    {"id":"local-mass","owner":"panel","mass":-0.01,"x":-0.2},
    {"id":"resonator","owner":"panel","mass":0.02,"frequency":1200,"zeta":0.004,"x":-0.33},
    {"id":"stiffness-loss","owner":"panel","loss":0.4,"span":0.1,"x":0.2},
    {"id":"rotary-inertia","owner":"panel","factor":2.2}"#;

pub const SAME: &[(&str, &[f64])] = &[
    ("local-mass", &[0.03, 0.11]),
    ("local-mass", &[-0.01, -0.2]),
    ("resonator", &[0.02, 1200.0, 0.004, -0.33]),
    ("stiffness-loss", &[0.4, 0.1, 0.2]),
    ("rotary-inertia", &[2.2]),
];
