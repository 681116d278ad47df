//! A structure on a few shapes of its own, beside the whole one.

use std::sync::Arc;

use orthopanel_model::{
    Boundary, End, MindlinPlate, Piece, ReducedStructure, RitzMode, Structure, modes_below, ritz_modes, ritz_modes_near,
};

const HONEYCOMB: [f64; 6] = [1.07e10, 8.2e9, 0.3, 2.9e9, 3.1e8, 5.363e8];
const COUNT: usize = 10;

fn frequencies(structure: &dyn Structure, values: &[f64]) -> Vec<f64> {
    let modes = ritz_modes(structure, values, COUNT).unwrap();
    modes.iter().map(|mode| mode.angular_frequency).filter(|omega| *omega > 0.0).collect()
}

/// Where it is made its modes are those of the whole. Away from there they lie above, as those of a part of the whole
/// space must, by the square of the change or less.
#[test]
fn val_frequencies_err_by_the_square_of_the_change() {
    let piece = Piece { length: 0.8, width: 0.3, thickness: 0.03, mass_per_area: 6.88 };
    for boundary in [Boundary::FREE, Boundary { left: End::Clamped, ..Boundary::FREE }] {
        let plate = Arc::new(MindlinPlate::with_basis_for(&piece, boundary, &HONEYCOMB, COUNT).unwrap());
        let reduced = ReducedStructure::near(Arc::clone(&plate), &HONEYCOMB, COUNT).unwrap();
        let size = |structure: &dyn Structure| structure.blocks().iter().map(|block| block.size()).sum::<usize>();
        assert!(size(&reduced) * 5 < size(plate.as_ref()), "{} of {}", size(&reduced), size(plate.as_ref()));
        let error = |change: f64| {
            let signs = [1.0, -1.0, 1.0, -1.0, 1.0, -1.0];
            let values: Vec<f64> =
                HONEYCOMB.iter().zip(signs).map(|(value, sign)| value * (1.0 + sign * change)).collect();
            let pairs = frequencies(&reduced, &values).into_iter().zip(frequencies(plate.as_ref(), &values));
            let errors: Vec<f64> = pairs.map(|(reduced, whole)| reduced / whole - 1.0).collect();
            assert!(errors.iter().all(|error| *error > -1e-9), "{boundary:?} {change}: {errors:?}");
            errors.into_iter().fold(0.0, f64::max)
        };
        let [here, near, far] = [0.0, 0.01, 0.1].map(error);
        // The square of 10 % is 1e-2; the shapes' first changes, which the space holds, leave the tenth of it and less.
        assert!(here < 1e-9 && far < 1e-3 && near < 0.02 * far + 1e-9, "{boundary:?}: {here:e} {near:e} {far:e}");
    }
}

fn flexible(modes: &[RitzMode]) -> Vec<f64> {
    modes.iter().map(|mode| mode.angular_frequency).filter(|omega| *omega > 0.0).collect()
}

fn assert_alike(found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert!((found / expected - 1.0).abs() < tolerance, "{found} {expected}");
    }
}

/// From the modes of a reduced structure 20 % off, and from a list that misses one of them: the same as from nothing.
#[test]
fn val_modes_from_near_ones_are_those_from_nothing() {
    let piece = Piece { length: 0.8, width: 0.3, thickness: 0.03, mass_per_area: 6.88 };
    for boundary in [Boundary::FREE, Boundary { left: End::Clamped, ..Boundary::FREE }] {
        let plate = Arc::new(MindlinPlate::with_basis_for(&piece, boundary, &HONEYCOMB, COUNT + 8).unwrap());
        let reduced = ReducedStructure::near(Arc::clone(&plate), &HONEYCOMB, COUNT + 8).unwrap();
        let values = HONEYCOMB.map(|value| 1.2 * value);
        let values = [values[0], HONEYCOMB[1], values[2], HONEYCOMB[3], values[4], HONEYCOMB[5]];
        let own = reduced.modes(&values).unwrap();
        let by_pencil = ritz_modes(&reduced, &values, COUNT).unwrap();
        assert_alike(&flexible(&own)[..COUNT], &flexible(&by_pencil), 1e-9);
        let alone: Vec<f64> = reduced
            .natural_frequencies(&values)
            .unwrap()
            .iter()
            .map(|frequency| frequency * std::f64::consts::TAU)
            .collect();
        assert_alike(&alone, &flexible(&own), 1e-10);

        let expected = ritz_modes(plate.as_ref(), &values, COUNT).unwrap();
        let near: Vec<RitzMode> = own.iter().map(|mode| reduced.in_whole(mode)).take(COUNT + 9).collect();
        let found = ritz_modes_near(plate.as_ref(), &values, COUNT, &near).unwrap();
        assert_alike(&flexible(&found), &flexible(&expected), 1e-10);
        assert_eq!(found.len(), expected.len(), "rigid modes too");
        for (found, expected) in found.iter().zip(&expected).filter(|(found, _)| found.angular_frequency > 0.0) {
            assert_eq!(found.block, expected.block);
            let [by_found, by_expected] =
                [found, expected].map(|mode| mode.coefficient_sensitivity(plate.as_ref())[0] / mode.angular_frequency);
            assert!((by_found - by_expected).abs() < 1e-5 * expected.angular_frequency, "{by_found} {by_expected}");
        }
        for missing in 0..near.len() {
            let some: Vec<RitzMode> =
                near.iter().enumerate().filter(|(index, _)| *index != missing).map(|(_, mode)| mode.clone()).collect();
            let found = ritz_modes_near(plate.as_ref(), &values, COUNT, &some).unwrap();
            assert_alike(&flexible(&found), &flexible(&expected), 1e-10);
        }
    }
}

/// Counts below limits between the modes are the modes' numbers.
#[test]
fn val_pivots_count_the_modes_below() {
    let piece = Piece { length: 0.8, width: 0.3, thickness: 0.03, mass_per_area: 6.88 };
    let plate = MindlinPlate::with_basis_for(&piece, Boundary::FREE, &HONEYCOMB, COUNT).unwrap();
    let omegas = flexible(&ritz_modes(&plate, &HONEYCOMB, COUNT).unwrap());
    let limits: Vec<f64> = omegas.iter().map(|omega| omega * (1.0 - 1e-6)).collect();
    assert_eq!(modes_below(&plate, &HONEYCOMB, &limits).unwrap(), (0..COUNT).collect::<Vec<_>>());
}

/// Fewer polynomials: a part of the space, so frequencies above, by some per cent.
#[test]
fn val_fewer_terms_raise_frequencies_a_little() {
    let piece = Piece { length: 0.8, width: 0.3, thickness: 0.03, mass_per_area: 6.88 };
    for boundary in [Boundary::FREE, Boundary { left: End::Clamped, ..Boundary::FREE }] {
        let plate = MindlinPlate::new(&piece, boundary, [16, 10]).unwrap();
        let rough = plate.with_fewer_terms([8, 6]);
        assert_eq!(rough.terms(), [8, 6]);
        let (fine, rough) = (frequencies(&plate, &HONEYCOMB), frequencies(&rough, &HONEYCOMB));
        for (rough, fine) in rough.iter().zip(&fine) {
            assert!((-1e-9..0.05).contains(&(rough / fine - 1.0)), "{boundary:?}: {rough} {fine}");
        }
        assert!(rough.iter().zip(&fine).any(|(rough, fine)| rough / fine > 1.0 + 1e-6));
    }
}
