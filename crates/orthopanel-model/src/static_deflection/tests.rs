//! The plate under a force that stands still.

use faer::Mat;

use super::StaticSolution;
use crate::dense::product;
use crate::{Boundary, End, MindlinPlate, Piece, Place, SHEAR_COEFFICIENT, Structure, sensitive_modes};

const HONEYCOMB: [f64; 6] = [1.07e10, 8.2e9, 0.3, 2.9e9, 3.1e8, 5.363e8];

/// A row a response, a column a force \[m/N\].
fn static_deflections(plate: &MindlinPlate, values: &[f64], forces: &[Place], responses: &[Place]) -> Mat<f64> {
    let coefficients = plate.coefficients(values).unwrap();
    let mut sum = Mat::zeros(responses.len(), forces.len());
    for (index, block) in plate.blocks().iter().enumerate() {
        let rows = |places: &[Place]| {
            let rows: Vec<Vec<f64>> = places.iter().map(|&place| plate.shape_row(index, place)).collect();
            Mat::from_fn(block.size(), places.len(), |i, place| rows[place][i])
        };
        let deflected = StaticSolution::new(block, &coefficients).unwrap().of(rows(forces));
        sum += product(rows(responses).transpose(), deflected.as_ref());
    }
    sum
}

/// The sum over all modes of the basis, rigid motions or not.
#[test]
fn val_static_deflection_is_the_sum_over_all_modes() {
    let piece = Piece { length: 0.8, width: 0.3, thickness: 0.03, mass_per_area: 6.88 };
    let places = [Place { x: -0.31, y: 0.12 }, Place { x: 0.2, y: -0.05 }];
    for boundary in [
        Boundary::FREE,
        Boundary { left: End::Pinned, ..Boundary::FREE },
        Boundary { left: End::Clamped, ..Boundary::FREE },
    ] {
        let plate = MindlinPlate::new(&piece, boundary, [12, 8]).unwrap();
        let modes = sensitive_modes(&plate, &HONEYCOMB, 0, &places).unwrap();
        let all = static_deflections(&plate, &HONEYCOMB, &places, &places);
        for (first, second) in [(0, 1), (1, 0), (1, 1)] {
            let sum: f64 = modes.higher.iter().map(|(omega2, shape)| shape[first] * shape[second] / omega2).sum();
            let found = all[(first, second)];
            assert!((found / sum - 1.0).abs() < 1e-8, "{boundary:?} {first} {second}: {found} {sum}");
        }
    }
}

/// Navier's double series of the simply supported isotropic plate, each half-wave bending and shearing,
/// $w_{mn} = q_{mn}/(Dk^4) + q_{mn}/(k'Gtk^2)$ with $k^2 = (m\pi/a)^2+(n\pi/b)^2$.
#[test]
fn val_static_deflection_of_a_simply_supported_plate_is_naviers() {
    let (e, nu, thickness, [a, b]) = (7e10, 0.3, 0.05, [0.8, 0.5]);
    let g = e / (2.0 * (1.0 + nu));
    let piece = Piece { length: a, width: b, thickness, mass_per_area: 2700.0 * thickness };
    let edges = Boundary { left: End::Pinned, right: End::Pinned, front: End::Pinned, back: End::Pinned };
    let plate = MindlinPlate::new(&piece, edges, [36, 36]).unwrap();
    let places = [Place { x: -0.1, y: 0.08 }, Place { x: 0.2, y: -0.1 }];
    let found = static_deflections(&plate, &[e, e, nu, g, g, g], &places[..1], &places[1..])[(0, 0)];
    let bending = e * thickness.powi(3) / (12.0 * (1.0 - nu * nu));
    let shear = SHEAR_COEFFICIENT * g * thickness;
    let wave = |count: usize, side: f64, place: f64| (count as f64 * std::f64::consts::PI * (place / side + 0.5)).sin();
    let term = |m: usize, n: usize| {
        let k2 = std::f64::consts::PI.powi(2) * ((m as f64 / a).powi(2) + (n as f64 / b).powi(2));
        let shape = |place: Place| wave(m, a, place.x) * wave(n, b, place.y);
        4.0 / (a * b) * shape(places[0]) * shape(places[1]) * (1.0 / (bending * k2 * k2) + 1.0 / (shear * k2))
    };
    let series: f64 = (1..=600).flat_map(|m| (1..=600).map(move |n| (m, n))).map(|(m, n)| term(m, n)).sum();
    // Both end at a finite wave: the shear's part of what is left out is some 1e-5 of the whole.
    assert!((found / series - 1.0).abs() < 1e-4, "{found} {series}");
}
