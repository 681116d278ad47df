//! What stands on a plate stands on a foot, whose size is not known.

use std::f64::consts::TAU;

use super::modified_panel::SeenModes;
use super::row::Row;
use super::{ElementLaw, PointElement, Seat};
use crate::Place;
use crate::structure::Motion;

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

/// A mass on a foot, with its deflection in each mode \[kg^-1/2\].
pub(super) struct StandingMass {
    pub mass: f64,
    pub row: Row,
    pub deflection: Vec<f64>,
}

impl StandingMass {
    /// Of an element; `deflection` of its row in each mode.
    pub(super) fn of(element: &PointElement, deflection: impl FnOnce() -> Vec<f64>) -> Option<Self> {
        match (element.law, element.seat, element.motion) {
            (ElementLaw::Mass { mass }, Seat::At(place), Motion::Foot) => {
                Some(Self { mass, row: (Motion::Foot, place), deflection: deflection() })
            }
            _ => None,
        }
    }
}

/// Derivatives of modes by $\ln d$, with $d$ the side of the feet under these masses.
///
/// Under a foot a plate with the shear stiffnesses $A_{55}$, $A_{44}$ yields by $R(0)$, away from its edges, with
/// $$R' = \frac{\partial R(0)}{\partial\ln d} = -\frac1{2\pi\sqrt{A_{44}A_{55}}} .$$
/// A mass $m$ on a spring that yields by $R'$ more weighs $m(1+\omega^2mR')$, so that with $P_n = \omega_n^2m\phi_n$ of its foot
/// $$\frac{\partial\omega_n^2}{\partial\ln d} = -P_n^2R'\ ,\qquad \frac{\partial\phi_n}{\partial\ln d} =
/// R'\Big(\sum_{k\ne n}\frac{\omega_n^2m\phi_kP_n}{\omega_k^2-\omega_n^2}\phi_k - \frac{P_n^2}{\omega_n^2}\phi_n\Big)\ ,$$
/// and the foot itself moves by $P_nR'$ more. What stands on a spring of its own has nothing else by it than that spring has.
pub(super) fn by_foot(seen: &SeenModes, masses: &[StandingMass], ports: &[Row], [a_55, a_44]: [f64; 2]) -> SeenModes {
    let yields = -1.0 / (TAU * (a_44 * a_55).sqrt());
    let modes = seen.angular_frequency.len();
    let square: Vec<f64> = seen.angular_frequency.iter().map(|omega| omega * omega).collect();
    let along = |of: &[Vec<f64>], shares: &[f64]| -> Vec<f64> {
        let places = of.first().map_or(0, Vec::len);
        (0..places).map(|p| of.iter().zip(shares).map(|(mode, share)| share * mode[p]).sum()).collect()
    };
    let mut by = SeenModes { damping_ratio: vec![0.0; modes], ..SeenModes::default() };
    for n in 0..modes {
        let (mut shares, mut direct) = (vec![0.0; modes], vec![0.0; ports.len()]);
        let mut of_square = 0.0;
        for StandingMass { mass, row, deflection } in masses {
            let pushes = |k: usize| square[n] * mass * deflection[k];
            of_square -= pushes(n).powi(2) * yields;
            for (k, share) in shares.iter_mut().enumerate() {
                let coupled = yields * pushes(n) * pushes(k);
                *share += if k == n {
                    if square[n] > 0.0 { -coupled / square[n] } else { 0.0 }
                } else {
                    // Modes that lie nearer to each other than this moves them mix wholly.
                    let apart = square[k] - square[n];
                    let apart = apart.abs().max(coupled.abs()).copysign(apart);
                    if apart == 0.0 { 0.0 } else { coupled / apart }
                };
            }
            for (port, moved) in ports.iter().zip(&mut direct) {
                if port == row {
                    *moved += pushes(n) * yields;
                }
            }
        }
        let omega = seen.angular_frequency[n];
        by.angular_frequency.push(if omega > 0.0 { of_square / (2.0 * omega) } else { 0.0 });
        let moved = along(&seen.deflection, &shares).into_iter().zip(direct);
        by.deflection.push(moved.map(|(by_modes, direct)| by_modes + direct).collect());
        by.slope.push(along(&seen.slope, &shares));
        by.slope_across.push(along(&seen.slope_across, &shares));
    }
    by
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Boundary, EffectSetting, EffectState, ModifiedPanel, Piece, RecordSetting, StructureKind, effect};

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
        let seen = |state: EffectState| panel.seen_from(&setting, &places, false, &constants, &[state]).expect("modes");
        let (mass, at) = (0.1, [0.23, 0.11]);
        let stands = seen(state("local-mass", &[mass, at[0], at[1]]));
        let by = stands.by_foot.as_ref().expect("a mass on a foot");
        let yields = 1.0 / (TAU * (constants[4] * constants[5]).sqrt() * piece.thickness / 1.5);
        let smaller = 0.05;
        let frequency = (mass * yields * smaller).sqrt().recip() / TAU;
        let on_spring = seen(state("resonator", &[mass, frequency, 1e-4, at[0], at[1]]));
        let mut moved = 0;
        for n in 3..20 {
            let change = on_spring.angular_frequency[n] / stands.angular_frequency[n] - 1.0;
            let told = -smaller * by.angular_frequency[n] / stands.angular_frequency[n];
            // To first order: the second is a fortieth.
            assert!((change - told).abs() < 0.04 * change.abs() + 1e-9, "mode {n}: {change} {told}");
            moved += usize::from(change < -1e-6);
            for (a, b) in [(0, 1), (1, 2), (2, 2)] {
                let product = |of: &SeenModes| of.deflection[n][a] * of.deflection[n][b];
                let change = product(&on_spring) - product(&stands);
                let of = |a: usize, b: usize| by.deflection[n][a] * stands.deflection[n][b];
                let told = -smaller * (of(a, b) + of(b, a));
                let least = 0.1 * change.abs() + 1e-5 * product(&stands).abs() + 1e-7;
                // Modes 16 and 17 mix, and follow to first order no farther.
                assert!(n > 15 || (change - told).abs() < least, "mode {n} at {a}, {b}: {change} {told}");
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
            let seen = |count: usize, factor: Option<f64>| {
                let panel = ModifiedPanel::new(StructureKind::MindlinPlate, &setting, count).expect("a plate");
                let panel = panel.perhaps_wide(&setting, &places, 1000.0);
                let standing = mass.map(|mass| state("local-mass", &[mass, 0.446, -0.195]));
                let turning = factor.map(|factor| state("rotary-inertia", &[factor]));
                let effects: Vec<EffectState> = standing.into_iter().chain(turning).collect();
                panel.seen_from(&setting, &places, false, &constants, &effects).expect("modes")
            };
            // What is spread over a plate has a basis of its own, for so many modes.
            let (few, fine) = (seen(28, None), seen(80, Some(1.0)));
            let mut greatest = 0.0_f64;
            for n in 3..28 {
                let omega = few.angular_frequency[n];
                let by_foot = few.by_foot.as_ref().map_or(0.0, |by| by.angular_frequency[n] / omega);
                let apart = omega / fine.angular_frequency[n] - 1.0;
                assert!(apart.abs() < 0.06 * by_foot + 5e-7, "mode {n} with {mass:?}: {apart:e}, {by_foot:e}");
                greatest = greatest.max(by_foot);
            }
            assert_eq!(greatest > 5e-4, mass.is_some(), "{greatest}");
        }
    }
}
