//! A beam with effects, hit and listened to at one place each: what the tests of the effects' physics stand on.

use std::f64::consts::TAU;

use num_complex::Complex64;
use orthopanel_model::{Boundary, Damping, EffectState, End, Piece, Place, ReceptanceSetup, RecordSetting, effect};

pub const PIECE: Piece = Piece { length: 0.8, width: 0.1, thickness: 0.03, mass_per_area: 6.88 };
pub const CONSTANTS: [f64; 2] = [1.07e10, 5.363e8];

/// So slender and stiff in shear that Euler and Bernoulli's closed forms hold: 0.27 kg/m.
pub const SLENDER: Piece = Piece { length: 1.0, width: 0.1, thickness: 1e-3, mass_per_area: 2.7 };
pub const SLENDER_CONSTANTS: [f64; 2] = [7e10, 7e12];
/// Rotary inertia shifts the fourth mode by $\beta^2t^2/24 = 5\cdot10^{-6}$.
pub const SLENDER_TOLERANCE: f64 = 6e-6;

pub fn at(x: f64) -> Place {
    Place { x, y: 0.0 }
}

pub struct Bench {
    pub piece: Piece,
    pub constants: [f64; 2],
    pub boundary: Boundary,
    pub zeta: f64,
    pub force: f64,
    pub response: f64,
    pub suspension: Vec<Place>,
}

impl Bench {
    pub fn panel() -> Self {
        let (piece, constants, boundary) = (PIECE, CONSTANTS, Boundary::FREE);
        Self { piece, constants, boundary, zeta: 0.0, force: -0.31, response: 0.27, suspension: vec![] }
    }

    pub fn cantilever() -> Self {
        let boundary = Boundary { left: End::Clamped, ..Boundary::FREE };
        Self { piece: SLENDER, constants: SLENDER_CONSTANTS, boundary, ..Self::panel() }
    }

    pub fn accelerance(&self, effects: &[(&str, &[f64])], s: Complex64) -> Complex64 {
        let state = |(id, values): &(&str, &[f64])| EffectState::new(effect(id).unwrap(), values.to_vec(), 1).unwrap();
        let states: Vec<EffectState> = effects.iter().map(state).collect();
        let record = RecordSetting {
            force_at: Some(at(self.force)),
            response_at: Some(at(self.response)),
            hit_time: 1e-3,
            ..RecordSetting::default()
        };
        let setup = ReceptanceSetup::new(&self.piece, self.boundary, &self.suspension, &[record], 14).unwrap();
        let model =
            setup.model(&self.constants, &Damping { beyond: self.zeta, ..Damping::default() }, &states).unwrap();
        model.accelerances(0, &[s]).unwrap()[0]
    }

    /// The receptance has its pole between both sides of `frequency` \[Hz\].
    pub fn resonates(&self, effects: &[(&str, &[f64])], frequency: f64, tolerance: f64) {
        let dynamic = |f: f64| self.accelerance(effects, Complex64::new(0.0, TAU * f)).inv().re;
        let (low, high) = (dynamic(frequency * (1.0 - tolerance)), dynamic(frequency * (1.0 + tolerance)));
        let scale = dynamic(frequency * 0.97).abs();
        assert!(low * high < 0.0 && low.abs() < scale, "{effects:?}: no resonance at {frequency} Hz: {low:e} {high:e}");
    }
}
