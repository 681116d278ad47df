//! The plate against closed forms: Navier's solution for simply supported edges, and the exact beam at its limit.

use std::f64::consts::TAU;

use faer::{Mat, Side};
use orthopanel_model::{
    BeamConstants, Boundary, End, ExactBeam, MindlinPlate, Piece, RitzMode, SHEAR_COEFFICIENT, Structure, ritz_modes,
};

const PINNED: Boundary = Boundary { left: End::Pinned, right: End::Pinned, front: End::Pinned, back: End::Pinned };
/// Sizes of the paper's piece 2, and constants of its order.
const PANEL: Piece = Piece { length: 0.8, width: 0.3, thickness: 0.03, mass_per_area: 6.88 };
const HONEYCOMB: [f64; 6] = [1.07e10, 8.2e9, 0.3, 2.9e9, 3.1e8, 5.363e8];

/// Roots $\omega^2$ of Navier's 3 x 3 problem for $w = \sin\alpha x\sin\beta y$, $\psi_x = \cos\alpha x\sin\beta y$,
/// $\psi_y = \sin\alpha x\cos\beta y$, from a corner; rising. Reference: Reddy, Mechanics of Laminated Composite Plates,
/// 2nd ed. (2004), section 6.2.
fn navier(piece: &Piece, values: &[f64; 6], m: usize, n: usize) -> [f64; 3] {
    let [e_x, e_y, nu_xy, g_xy, g_yz, g_zx] = *values;
    let t = piece.thickness;
    let rest = 1.0 - nu_xy * nu_xy * e_y / e_x;
    let bending = t.powi(3) / 12.0;
    let (d_11, d_22, d_66) = (bending * e_x / rest, bending * e_y / rest, bending * g_xy);
    let d_12 = nu_xy * d_22;
    let (a_55, a_44) = (SHEAR_COEFFICIENT * t * g_zx, SHEAR_COEFFICIENT * t * g_yz);
    let alpha = m as f64 * std::f64::consts::PI / piece.length;
    let beta = n as f64 * std::f64::consts::PI / piece.width;
    let stiffness = [
        [a_55 * alpha * alpha + a_44 * beta * beta, a_55 * alpha, a_44 * beta],
        [a_55 * alpha, d_11 * alpha * alpha + d_66 * beta * beta + a_55, (d_12 + d_66) * alpha * beta],
        [a_44 * beta, (d_12 + d_66) * alpha * beta, d_66 * alpha * alpha + d_22 * beta * beta + a_44],
    ];
    let rotary = piece.mass_per_area * t * t / 12.0;
    let inertia = [piece.mass_per_area, rotary, rotary];
    let matrix = Mat::from_fn(3, 3, |i, j| stiffness[i][j] / (inertia[i] * inertia[j]).sqrt());
    matrix.self_adjoint_eigenvalues(Side::Lower).unwrap().try_into().unwrap()
}

fn navier_frequencies(piece: &Piece, values: &[f64; 6], count: usize) -> Vec<f64> {
    let mut all: Vec<f64> =
        (1..40).flat_map(|m| (1..40).flat_map(move |n| navier(piece, values, m, n))).map(f64::sqrt).collect();
    // Hard edges also let the plate shear through its thickness without deflecting: one rotation alone, the same all
    // along its own direction.
    let [_, _, _, g_xy, g_yz, g_zx] = *values;
    let squared = |n: usize, length: f64| (n as f64 * std::f64::consts::PI / length).powi(2);
    for n in 1..40 {
        for (shear, length) in [(g_zx, piece.width), (g_yz, piece.length)] {
            let density = piece.mass_per_area / piece.thickness;
            let t2 = piece.thickness * piece.thickness;
            let omega2 = (g_xy * squared(n, length) + 12.0 * SHEAR_COEFFICIENT * shear / t2) / density;
            all.push(omega2.sqrt());
        }
    }
    all.sort_by(f64::total_cmp);
    all.truncate(count);
    all
}

#[test]
fn val_simply_supported_plates_follow_navier() {
    let isotropic = |e: f64, nu: f64| {
        let g = 0.5 * e / (1.0 + nu);
        [e, e, nu, g, g, g]
    };
    let square = Piece { length: 0.5, width: 0.5, thickness: 0.05, mass_per_area: 135.0 };
    for (piece, values) in [(PANEL, HONEYCOMB), (square, isotropic(7e10, 0.3)), (square, HONEYCOMB)] {
        let expected = navier_frequencies(&piece, &values, 30);
        let plate = MindlinPlate::new(&piece, PINNED, [32, 22]).unwrap();
        let found = ritz_modes(&plate, &values, 30).unwrap();
        for (mode, expected) in found.iter().zip(&expected) {
            let difference = mode.angular_frequency / expected - 1.0;
            assert!(difference.abs() < 1e-9, "{piece:?} {expected} rad/s: {difference:e}");
        }
    }
}

const ENDS: [Boundary; 4] = [
    Boundary::FREE,
    Boundary { left: End::Clamped, ..Boundary::FREE },
    Boundary { left: End::Clamped, right: End::Pinned, ..Boundary::FREE },
    Boundary { left: End::Pinned, right: End::Clamped, ..Boundary::FREE },
];

/// The least relative distance of each beam frequency from one of the plate's.
fn beam_frequencies_missed(piece: &Piece, ends: Boundary, values: &[f64; 6], terms: [usize; 2], count: usize) -> f64 {
    let beam = ExactBeam::new(piece, ends, BeamConstants { e_x: values[0], g_zx: values[5] }).unwrap();
    let plate = MindlinPlate::new(piece, ends, terms).unwrap();
    let modes = ritz_modes(&plate, values, plate.resolved_modes()).unwrap();
    let missed = |expected: f64| {
        let away = |mode: &RitzMode| (mode.angular_frequency / (TAU * expected) - 1.0).abs();
        modes.iter().map(away).fold(f64::INFINITY, f64::min)
    };
    beam.natural_frequencies(count).into_iter().map(missed).fold(0.0, f64::max)
}

/// Without Poisson's coupling the plate bends as the beam does, however wide it is.
#[test]
fn val_without_poissons_ratio_the_plate_has_the_beams_modes() {
    let values = [1.07e10, 8.2e9, 0.0, 2.9e9, 3.1e8, 5.363e8];
    for ends in ENDS {
        for width in [0.05, 0.1, 0.3] {
            let missed = beam_frequencies_missed(&Piece { width, ..PANEL }, ends, &values, [30, 8], 5);
            assert!(missed < 1e-9, "{ends:?} width {width}: {missed:e}");
        }
    }
}

/// With it, a strip so narrow that nothing holds its anticlastic curvature does. A clamped edge holds it over a length
/// of about the width, so there the limit is met with the first power of the width only, and less than that once 60 terms
/// no longer follow so short a layer.
#[test]
fn val_a_narrow_strip_is_the_exact_beam() {
    let pinned = Boundary { left: End::Pinned, right: End::Pinned, ..Boundary::FREE };
    for ends in [Boundary::FREE, pinned, Boundary { left: End::Free, ..pinned }] {
        let strip = Piece { width: 8e-4, ..PANEL };
        let missed = beam_frequencies_missed(&strip, ends, &HONEYCOMB, [60, 4], 3);
        assert!(missed < 1e-6, "{ends:?}: {missed:e}");
    }
    let clamped = Boundary { left: End::Clamped, right: End::Clamped, ..Boundary::FREE };
    let missed = |width: f64| beam_frequencies_missed(&Piece { width, ..PANEL }, clamped, &HONEYCOMB, [60, 4], 3);
    assert!(missed(8e-4) < 0.3 * missed(8e-3), "{:e} {:e}", missed(8e-4), missed(8e-3));
}
