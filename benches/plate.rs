//! Twenty modes of the paper's two widths as orthotropic Mindlin plates, to 1e-4 of their frequencies.
//!
//! `cargo bench -p orthopanel-model --bench plate` prints criterion's figures: with the basis built (a step of an
//! identification), with the derivatives by all six stiffnesses, and cold (basis, matrices and modes).

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion};
use orthopanel_model::{Boundary, MindlinPlate, Piece, RitzMode, ritz_modes};

/// Constants of the order of the paper's panels: $E_x, E_y$ \[Pa\], $\nu_{xy}$, $G_{xy}, G_{yz}, G_{zx}$ \[Pa\].
const CONSTANTS: [f64; 6] = [1.07e10, 8.2e9, 0.3, 2.9e9, 3.1e8, 5.363e8];
const MODES: usize = 20;

fn plate(width: f64) -> MindlinPlate {
    let piece = Piece { length: 0.8, width, thickness: 0.03, mass_per_area: 6.880 };
    MindlinPlate::with_basis_for(&piece, Boundary::FREE, &CONSTANTS, MODES).expect("a valid piece")
}

fn modes(plate: &MindlinPlate) -> Vec<RitzMode> {
    ritz_modes(plate, black_box(&CONSTANTS), MODES).expect("valid constants")
}

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    let mut group = criterion.benchmark_group("20 plate modes");
    for width in [0.1, 0.3] {
        let built = plate(width);
        group.bench_function(BenchmarkId::new("built", width), |bencher| bencher.iter(|| modes(&built)));
        let sensitive =
            || -> Vec<Vec<f64>> { modes(&built).iter().map(|mode| mode.coefficient_sensitivity(&built)).collect() };
        group.bench_function(BenchmarkId::new("built, with derivatives", width), |bencher| bencher.iter(sensitive));
        group.bench_function(BenchmarkId::new("cold", width), |bencher| bencher.iter(|| modes(&plate(width))));
    }
    group.finish();
    criterion.final_summary();
}
