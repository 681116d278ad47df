//! What stands on a plate stands on a foot, whose size is not known.

use std::f64::consts::TAU;

use super::row::Row;
use super::{Action, Effect, EffectParameter, EffectSetting, Owner, PointElement, Seat};
use crate::mindlin_plate::FOOT;
use crate::structure::Motion;
use crate::{ModelError, Place};

/// Elements as they stand on a plate.
pub(super) fn on_feet(mut elements: Vec<PointElement>) -> Vec<PointElement> {
    for element in &mut elements {
        if let (Seat::At(_), Motion::Deflection) = (element.seat, element.motion) {
            element.motion = Motion::Foot;
        }
    }
    elements
}

/// What moves at a place: the foot of what stands there.
pub(super) fn port(place: Place, standing: &[Row]) -> Row {
    let foot = (Motion::Foot, place);
    if standing.contains(&foot) { foot } else { (Motion::Deflection, place) }
}

/// The side $d$ \[m\] of the square feet on which all stands that stands on a plate: of two of three it is 6.5 to 15 mm. It is in no catalogue, since a foot of
/// another size is no fault of a panel: inference has it for a nuisance parameter.
///
/// Under a foot a plate with the shear stiffnesses $A_{55}$, $A_{44}$ yields by $R(0)$, away from its edges, with
/// $$R(0; d) = R(0; d_0) - \frac{\ln(d/d_0)}{2\pi\sqrt{A_{44}A_{55}}} .$$
/// Limits: a foot is small beside the waves of the modes that are told. Source: the static membrane's logarithm under a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct FootSide;

/// The foot on which all stands that stands on a plate, for inference.
pub static FOOT_SIDE: &dyn Effect = &FootSide;

const PARAMETERS: [EffectParameter; 1] = [EffectParameter::log("side", "m", [1e-3, 4e-2], &[FOOT]).sized(FOOT, 1.5)];

impl Effect for FootSide {
    fn id(&self) -> &'static str {
        "foot"
    }

    fn owner(&self) -> Owner {
        Owner::Rig
    }

    fn parameters(&self) -> &'static [EffectParameter] {
        &PARAMETERS
    }

    fn act(&self, values: &[f64], setting: &EffectSetting) -> Result<Vec<Action>, ModelError> {
        self.check(values, &setting.piece)?;
        Ok(values.iter().map(|side| Action::Foot(*side)).collect())
    }
}

/// By how much more a foot of a side \[m\] yields than the usual one \[m/N\], on these shear stiffnesses.
pub(super) fn more_yield(side: f64, [a_55, a_44]: [f64; 2]) -> f64 {
    -(side / FOOT).ln() / (TAU * (a_44 * a_55).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        Boundary, EffectSetting, EffectState, ModifiedPanel, Piece, RecordSetting, SeenModes, StructureKind, effect,
    };

    /// A mass on a stiff spring is one on a foot that yields so much more.
    #[test]
    fn val_a_smaller_foot_is_a_spring_under_the_mass() {
        let piece = Piece { length: 0.8, width: 0.5, thickness: 0.02, mass_per_area: 3.9 };
        let setting = EffectSetting {
            piece,
            boundary: Boundary::default(),
            suspension: vec![],
            record: RecordSetting { number: 1, ..RecordSetting::default() },
        };
        let places = [Place { x: 0.31, y: -0.19 }, Place { x: -0.22, y: 0.13 }, Place { x: 0.05, y: 0.2 }];
        let panel = ModifiedPanel::new(StructureKind::MindlinPlate, &setting, 20).expect("a plate");
        let panel = panel.perhaps_wide(&setting, &places, 1500.0);
        let constants = [9.0e9, 7.0e9, 0.3, 3.0e9, 1.5e8, 3.0e8];
        let state =
            |id: &str, values: &[f64]| EffectState::new(effect(id).expect("known"), values.to_vec(), 1).expect("valid");
        let seen =
            |states: &[EffectState]| panel.seen_from(&setting, &places, false, &constants, states).expect("modes");
        let (mass, at) = (0.03, [0.23, 0.11]);
        let stands = state("local-mass", &[mass, at[0], at[1]]);
        let usual = seen(std::slice::from_ref(&stands));
        let yields = 1.0 / (TAU * (constants[4] * constants[5]).sqrt() * piece.thickness / 1.5);
        let smaller: f64 = 0.7;
        let foot = EffectState::new(FOOT_SIDE, vec![FOOT * (-smaller).exp()], 1).expect("valid");
        let on_foot = seen(&[stands, foot]);
        let frequency = (mass * yields * smaller).sqrt().recip() / TAU;
        let on_spring = seen(&[state("resonator", &[mass, frequency, 1e-4, at[0], at[1]])]);
        let mut moved = 0;
        for n in 3..16 {
            let [changed, spring] =
                [&on_foot, &on_spring].map(|of| of.angular_frequency[n] / usual.angular_frequency[n] - 1.0);
            // What the mass swings with beside the modes is a series in the one and is not in the other.
            assert!((changed - spring).abs() < 0.01 * spring.abs() + 1e-8, "mode {n}: {changed} {spring}");
            moved += usize::from(changed < -1e-5);
            for (a, b) in [(0, 1), (1, 2), (2, 2)] {
                let product = |of: &SeenModes| of.deflection[n][a] * of.deflection[n][b];
                let [changed, spring] = [&on_foot, &on_spring].map(|of| product(of) - product(&usual));
                let least = 0.02 * spring.abs() + 1e-5 * product(&usual).abs() + 1e-6;
                assert!((changed - spring).abs() < least, "mode {n} at {a}, {b}: {changed} {spring}");
            }
        }
        assert!(moved > 5, "{moved}");
    }

    /// On the few shapes of a search, as on a fine basis: as much as the latter lacks of a foot's give is left, a twentieth of what a foot of e times the
    /// side changes. Low modes were 8e-6 off while their changes were weighed by mass, high ones a fifth of that change before a mass had second
    /// shapes.
    #[test]
    fn val_a_search_meets_a_fine_basis() {
        let piece = Piece { length: 1.287, width: 0.773, thickness: 0.02, mass_per_area: 3.767 };
        let setting = EffectSetting {
            piece,
            boundary: Boundary::default(),
            suspension: vec![],
            record: RecordSetting { number: 1, ..RecordSetting::default() },
        };
        let places = [Place { x: -0.628, y: -0.017 }, Place { x: -0.347, y: -0.077 }, Place { x: -0.545, y: -0.32 }];
        let constants = [5.207e9, 4.666e9, 0.291, 2.198e9, 5.579e7, 1.1796e8];
        let state =
            |id: &str, values: &[f64]| EffectState::new(effect(id).expect("known"), values.to_vec(), 1).expect("valid");
        for mass in [None, Some(0.024)] {
            let seen = |count: usize, factor: Option<f64>, side: f64| {
                let panel = ModifiedPanel::new(StructureKind::MindlinPlate, &setting, count).expect("a plate");
                let panel = panel.perhaps_wide(&setting, &places, 1000.0);
                let standing = mass.map(|mass| state("local-mass", &[mass, 0.446, -0.195]));
                let turning = factor.map(|factor| state("rotary-inertia", &[factor]));
                let foot = EffectState::new(FOOT_SIDE, vec![side], 1).expect("valid");
                let effects: Vec<EffectState> = standing.into_iter().chain(turning).chain([foot]).collect();
                panel.seen_from(&setting, &places, false, &constants, &effects).expect("modes")
            };
            // What is spread over a plate has a basis of its own, for so many modes.
            let (few, fine) = (seen(28, None, FOOT), seen(80, Some(1.0), FOOT));
            let larger = seen(28, None, 1.1 * FOOT);
            let mut greatest = 0.0_f64;
            for n in 3..28 {
                let omega = few.angular_frequency[n];
                let by_foot = (larger.angular_frequency[n] / omega).ln() / 1.1_f64.ln();
                let apart = omega / fine.angular_frequency[n] - 1.0;
                assert!(apart.abs() < 0.06 * by_foot + 5e-7, "mode {n} with {mass:?}: {apart:e}, {by_foot:e}");
                greatest = greatest.max(by_foot);
            }
            assert_eq!(greatest > 5e-4, mass.is_some(), "{greatest}");
        }
    }
}
