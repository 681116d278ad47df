//! One beam, three ways, one answer: exact, Ritz and finite element against each other.

use orthopanel_model::{
    BeamConstants, BeamElements, Boundary, End, ExactBeam, Piece, Place, TimoshenkoBeam, ritz_modes,
};
use proptest::prelude::*;

const ENDS: [End; 3] = [End::Free, End::Pinned, End::Clamped];

fn boundaries() -> impl Iterator<Item = Boundary> {
    ENDS.into_iter().flat_map(|left| ENDS.map(|right| Boundary { left, right, ..Boundary::FREE }))
}

/// A piece of slenderness a/t and a pair of constants of ratio E/(k'G).
fn beam(slenderness: f64, softness: f64) -> (Piece, BeamConstants) {
    let piece = Piece { length: 0.8, width: 0.1, thickness: 0.8 / slenderness, mass_per_area: 6.88 };
    (piece, BeamConstants { e_x: 1e10, g_zx: 1e10 / softness * 1.5 })
}

/// Largest relative difference of the first 20 frequencies, exact against Ritz with `terms`.
fn exact_against_ritz(slenderness: f64, softness: f64, boundary: Boundary, terms: usize) -> f64 {
    let (piece, constants) = beam(slenderness, softness);
    let exact = ExactBeam::new(&piece, boundary, constants).unwrap().modes(20);
    let ritz_beam = TimoshenkoBeam::new(&piece, boundary, terms).unwrap();
    let ritz = ritz_modes(&ritz_beam, &[constants.e_x, constants.g_zx], 20).unwrap();
    assert_eq!(exact.len(), ritz.len());
    let pairs = exact.iter().zip(&ritz).skip(boundary.rigid_modes());
    pairs.map(|(e, r)| (e.angular_frequency() / r.angular_frequency - 1.0).abs()).fold(0.0, f64::max)
}

#[test]
fn val_exact_and_ritz_agree_over_all_ends_slenderness_and_softness() {
    for boundary in boundaries() {
        for slenderness in [3.0, 10.0, 26.7, 100.0, 1000.0] {
            for softness in [1.0, 3.0, 30.0, 300.0, 1000.0] {
                let difference = exact_against_ritz(slenderness, softness, boundary, 60);
                assert!(
                    difference < 1e-9,
                    "{boundary:?} a/t {slenderness} E/k'G {softness}: first 20 modes differ by {difference:e}"
                );
            }
        }
    }
}

/// Far above the cut-off, where both waves travel and modes crowd.
#[test]
fn val_a_hundred_modes_agree_with_ritz() {
    for boundary in boundaries() {
        let (piece, constants) = beam(10.0, 30.0);
        let exact = ExactBeam::new(&piece, boundary, constants).unwrap();
        let structure = TimoshenkoBeam::new(&piece, boundary, 220).unwrap();
        let ritz = ritz_modes(&structure, &[constants.e_x, constants.g_zx], 100).unwrap();
        let frequencies = exact.natural_frequencies(100);
        assert!(frequencies[99] > exact.cut_off());
        for (f, r) in frequencies.iter().zip(&ritz[boundary.rigid_modes()..]) {
            let difference = f * std::f64::consts::TAU / r.angular_frequency - 1.0;
            assert!(difference.abs() < 1e-9, "{boundary:?} {f} Hz: {difference:e}");
        }
    }
}

#[test]
fn val_shapes_and_sensitivities_agree_with_ritz() {
    for boundary in boundaries() {
        let (piece, constants) = beam(26.7, 30.0);
        let exact = ExactBeam::new(&piece, boundary, constants).unwrap().modes(12);
        let structure = TimoshenkoBeam::new(&piece, boundary, 60).unwrap();
        let ritz = ritz_modes(&structure, &[constants.e_x, constants.g_zx], 12).unwrap();
        for (e, r) in exact.iter().zip(&ritz).skip(boundary.rigid_modes()) {
            let places: Vec<f64> = (-8..=8).map(|i| 0.05 * f64::from(i)).collect();
            let here: Vec<f64> = places.iter().map(|&x| e.deflection(x)).collect();
            let there: Vec<f64> = places.iter().map(|&x| r.deflection(&structure, Place { x, y: 0.0 })).collect();
            let size = here.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            let sign = here.iter().zip(&there).map(|(a, b)| a * b).sum::<f64>().signum();
            for (a, b) in here.iter().zip(&there) {
                assert!((a - sign * b).abs() < 1e-7 * size, "{boundary:?} {} Hz: {a} {b}", e.frequency());
            }
            let by_energy = r.coefficient_sensitivity(&structure);
            for (a, b) in e.sensitivity().iter().zip(&by_energy) {
                assert!((a - b).abs() < 1e-8 * (a.abs() + b.abs()), "{boundary:?} {} Hz: {a} {b}", e.frequency());
            }
        }
    }
}

#[test]
fn val_rigid_modes_agree_with_ritz() {
    let (piece, constants) = beam(10.0, 30.0);
    for boundary in boundaries() {
        let exact = ExactBeam::new(&piece, boundary, constants).unwrap().rigid_modes();
        let structure = TimoshenkoBeam::new(&piece, boundary, 12).unwrap();
        let ritz = ritz_modes(&structure, &[constants.e_x, constants.g_zx], 1).unwrap();
        assert_eq!(exact.len(), boundary.rigid_modes());
        for (e, r) in exact.iter().zip(&ritz) {
            assert_eq!(r.angular_frequency, 0.0);
            for x in [-0.4, -0.1, 0.0, 0.3, 0.4] {
                let difference = e.deflection(x).abs() - r.deflection(&structure, Place { x, y: 0.0 }).abs();
                assert!(difference.abs() < 1e-12, "{boundary:?} x {x}");
            }
        }
    }
}

#[test]
fn val_elements_converge_with_the_fourth_power() {
    let (piece, constants) = beam(26.7, 30.0);
    for boundary in boundaries() {
        let exact = ExactBeam::new(&piece, boundary, constants).unwrap().natural_frequencies(4);
        let error = |elements: usize| -> f64 {
            let structure = BeamElements::new(&piece, boundary, elements).unwrap();
            let modes = ritz_modes(&structure, &[constants.e_x, constants.g_zx], 4).unwrap();
            let last = modes.last().unwrap().angular_frequency / std::f64::consts::TAU;
            assert!(last > exact[3], "{boundary:?}: from above");
            last / exact[3] - 1.0
        };
        let errors = [16, 32, 64].map(error);
        for pair in errors.windows(2) {
            let order = (pair[0] / pair[1]).log2();
            assert!((3.9..4.1).contains(&order), "{boundary:?}: order {order}, errors {errors:?}");
        }
    }
}

#[test]
fn val_elements_carry_the_shapes_of_the_exact_beam() {
    let (piece, constants) = beam(26.7, 30.0);
    let exact = ExactBeam::new(&piece, Boundary::FREE, constants).unwrap().modes(3);
    let structure = BeamElements::new(&piece, Boundary::FREE, 64).unwrap();
    let elements = ritz_modes(&structure, &[constants.e_x, constants.g_zx], 3).unwrap();
    for (e, f) in exact.iter().zip(&elements) {
        for x in [-0.4, -0.3, 0.013, 0.3, 0.4] {
            let (a, b) = (e.deflection(x).abs(), f.deflection(&structure, Place { x, y: 0.0 }).abs());
            // The element's shapes converge with the same fourth power as its frequencies.
            assert!((a - b).abs() < 1e-5 * e.deflection(0.4).abs(), "x {x}: {a} {b}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// The count is right at every frequency between two modes, and each mode is one step of it.
    #[test]
    fn val_a_hundred_modes_none_missed(
        slenderness in 3.0_f64..1000.0,
        softness in 1.0_f64..1000.0,
        left in 0_usize..3,
        right in 0_usize..3,
    ) {
        let boundary = Boundary { left: ENDS[left], right: ENDS[right], ..Boundary::FREE };
        let (piece, constants) = beam(slenderness, softness);
        let exact = ExactBeam::new(&piece, boundary, constants).unwrap();
        let frequencies = exact.natural_frequencies(100);
        for (index, pair) in frequencies.windows(2).enumerate() {
            prop_assert!(pair[0] <= pair[1]);
            if pair[1] > pair[0] * (1.0 + 1e-9) {
                let between = 0.5 * (pair[0] + pair[1]);
                prop_assert_eq!(exact.count_below(between), boundary.rigid_modes() + index + 1);
            }
        }
    }

    /// Mass-normalised, orthogonal in the mass (eq. 15 with its misprint mended), and finite everywhere.
    #[test]
    fn modes_are_orthonormal(
        slenderness in 3.0_f64..300.0,
        softness in 1.0_f64..1000.0,
        left in 0_usize..3,
        right in 0_usize..3,
    ) {
        let boundary = Boundary { left: ENDS[left], right: ENDS[right], ..Boundary::FREE };
        let (piece, constants) = beam(slenderness, softness);
        let modes = ExactBeam::new(&piece, boundary, constants).unwrap().modes(10);
        let mass = piece.mass_per_area * piece.width;
        let rotary = mass * piece.thickness.powi(2) / 12.0;
        let cells = 4000;
        let step = piece.length / f64::from(cells);
        for (i, m) in modes.iter().enumerate() {
            for n in &modes[..=i] {
                // Simpson's rule, of our own here: the closed integrals are under test.
                let product: f64 = (0..=cells).map(|k| {
                    let x = f64::from(k) * step - 0.5 * piece.length;
                    let weight = if k == 0 || k == cells { 1.0 } else if k % 2 == 1 { 4.0 } else { 2.0 };
                    weight * step / 3.0
                        * (mass * m.deflection(x) * n.deflection(x) + rotary * m.rotation(x) * n.rotation(x))
                }).sum();
                let expected = if std::ptr::eq(m, n) { 1.0 } else { 0.0 };
                // Two modes that nearly coincide may mix: then only their sum is certain.
                let gap = (m.frequency() / n.frequency() - 1.0).abs();
                prop_assert!((product - expected).abs() < 1e-7 || gap < 1e-6, "{boundary:?} {product}");
            }
        }
    }
}

#[test]
fn shapes_of_a_hundred_modes_stay_finite_and_bounded() {
    for boundary in boundaries() {
        for (slenderness, softness) in [(3.0, 1000.0), (26.7, 30.0), (1000.0, 1.0)] {
            let (piece, constants) = beam(slenderness, softness);
            let modes = ExactBeam::new(&piece, boundary, constants).unwrap().modes(100);
            let bound = 4.0 / piece.mass().sqrt();
            for mode in &modes {
                for x in [-0.4, -0.39, -0.2, 0.0, 0.11, 0.4] {
                    let w = mode.deflection(x);
                    assert!(w.is_finite() && w.abs() < bound, "{boundary:?} {} Hz at {x}: {w}", mode.frequency());
                    assert!(mode.rotation(x).is_finite());
                }
            }
        }
    }
}

#[test]
fn val_sensitivities_are_the_derivatives() {
    let (piece, constants) = beam(26.7, 30.0);
    for boundary in boundaries() {
        let modes = |constants| ExactBeam::new(&piece, boundary, constants).unwrap().modes(6);
        for (index, mode) in modes(constants).iter().enumerate().skip(boundary.rigid_modes()) {
            let step = 1e-4;
            let shifted = |e: f64, g: f64| {
                modes(BeamConstants { e_x: constants.e_x * e, g_zx: constants.g_zx * g })[index]
                    .angular_frequency()
                    .powi(2)
            };
            let by_e = (shifted(1.0 + step, 1.0) - shifted(1.0 - step, 1.0)) / (2.0 * step * constants.e_x);
            let by_g = (shifted(1.0, 1.0 + step) - shifted(1.0, 1.0 - step)) / (2.0 * step * constants.g_zx);
            let [e, g] = mode.sensitivity();
            // Central differences of step 1e-4 carry an error of 1e-8 in ω².
            let size = mode.angular_frequency().powi(2);
            assert!((by_e - e).abs() * constants.e_x < 1e-7 * size, "{boundary:?} mode {index}: {by_e} {e}");
            assert!((by_g - g).abs() * constants.g_zx < 1e-7 * size, "{boundary:?} mode {index}: {by_g} {g}");
        }
    }
}
