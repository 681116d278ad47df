//! A structure on a few shapes of its own, beside the whole one.

use std::sync::Arc;

use orthopanel_model::{Boundary, End, MindlinPlate, Piece, ReducedStructure, Structure, ritz_modes};

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
