//! Isotropic plates against published tables: $\lambda = \omega a^2\sqrt{\rho t/D}$, Poisson's ratio 0.3.
//!
//! The digits were typed from memory and not held against the print. `fmpy-checks/test_plate_tables.py` reads them from
//! here and solves every case again without this crate, Leissa's with his own 36 beam functions: all digits agree, but
//! that 35.992, 35.024 and 86.135 would round to one less in their last place (35.9915, 35.0235, 86.1345).

use orthopanel_model::{Boundary, End, MindlinPlate, Piece, SHEAR_COEFFICIENT, ritz_modes};

/// Parameters $\lambda$ of the first six flexible modes of a square plate with this thickness over side and the table's
/// own shear coefficient; edges in the order left, right, front, back, as S, C or F.
fn parameters(edges: &str, thickness: f64, shear_coefficient: f64) -> [f64; 6] {
    let mut ends = edges.chars().map(|edge| match edge {
        'S' => End::Pinned,
        'C' => End::Clamped,
        _ => End::Free,
    });
    let mut next = || ends.next().unwrap();
    let boundary = Boundary { left: next(), right: next(), front: next(), back: next() };
    let (e, nu, density) = (7e10, 0.3, 2700.0);
    let g = e / (2.0 * (1.0 + nu));
    let g_shear = g * shear_coefficient / SHEAR_COEFFICIENT;
    let piece = Piece { length: 1.0, width: 1.0, thickness, mass_per_area: density * thickness };
    let plate = MindlinPlate::new(&piece, boundary, [16, 16]).unwrap();
    let modes = ritz_modes(&plate, &[e, e, nu, g, g_shear, g_shear], 6).unwrap();
    let d = e * thickness.powi(3) / (12.0 * (1.0 - nu * nu));
    let scale = (piece.mass_per_area / d).sqrt();
    let flexible = modes.iter().filter(|mode| mode.angular_frequency > 0.0);
    flexible.map(|mode| mode.angular_frequency * scale).collect::<Vec<_>>().try_into().unwrap()
}

/// So thin that shear and rotary inertia change nothing in five digits.
const THIN: f64 = 1e-4;

/// Two opposite edges simply supported: Levy's exact solutions of the thin plate. Source: A. W. Leissa, J. Sound Vib. 31
/// (1973) 257, a/b = 1 of the tables for SS-C-SS-C, SS-C-SS-SS, SS-C-SS-F, SS-SS-SS-F and SS-F-SS-F.
#[test]
fn val_thin_plates_follow_levys_exact_solutions() {
    for (edges, table) in [
        ("SSCC", [28.951, 54.743, 69.327, 94.585, 102.216, 129.096]),
        ("SSCS", [23.646, 51.674, 58.646, 86.135, 100.270, 113.228]),
        ("SSCF", [12.687, 33.065, 41.702, 63.015, 72.398, 90.611]),
        ("SSSF", [11.685, 27.756, 41.197, 59.066, 61.861, 90.294]),
        ("SSFF", [9.6314, 16.135, 36.726, 38.945, 46.738, 70.740]),
    ] {
        let found = parameters(edges, THIN, 5.0 / 6.0);
        for (found, table) in found.iter().zip(table) {
            // One unit of the last digit printed for most.
            assert!((found - table).abs() < 1e-3, "{edges}: {found} {table}");
        }
    }
}

/// Source: the same, tables for C-C-C-C, C-F-F-F and F-F-F-F: Ritz with 36 beam functions: upper bounds, and the
/// higher the more edges are free, for beam functions meet no free edge of a plate.
#[test]
fn val_thin_plates_lie_just_below_leissas_bounds() {
    for (edges, table, slack) in [
        ("CCCC", [35.992, 73.413, 73.413, 108.27, 131.64, 132.24], 5e-4),
        ("CFFF", [3.4917, 8.5246, 21.429, 27.331, 31.111, 54.443], 1e-2),
        ("FFFF", [13.489, 19.789, 24.432, 35.024, 35.024, 61.526], 1e-2),
    ] {
        let found = parameters(edges, THIN, 5.0 / 6.0);
        for (found, table) in found.iter().zip(table) {
            assert!(*found < table && *found > (1.0 - slack) * table, "{edges}: {found} {table}");
        }
    }
}

/// Thick plates. Source: K. M. Liew, Y. Xiang, S. Kitipornchai, Comput. Struct. 49 (1993) 1, t/b = 0.1 and 0.2, shear
/// coefficient 5/6; their parameter is ours over $\pi^2$.
#[test]
fn val_thick_plates_follow_the_mindlin_tables() {
    for (edges, thickness, table) in [
        ("SSSS", 0.1, [1.9317, 4.6084, 4.6084, 7.0716, 8.6162, 8.6162]),
        ("CCCC", 0.1, [3.2954, 6.2858, 6.2858, 8.8098, 10.3788, 10.4778]),
        ("CCCC", 0.2, [2.6875, 4.6907, 4.6907, 6.2985, 7.1767, 7.2759]),
    ] {
        let found = parameters(edges, thickness, 5.0 / 6.0);
        for (found, table) in found.iter().zip(table) {
            let found = found / std::f64::consts::PI.powi(2);
            // Half a unit of the last digit printed.
            assert!((found - table).abs() < 0.5001e-4, "{edges} {thickness}: {found} {table}");
        }
    }
}
