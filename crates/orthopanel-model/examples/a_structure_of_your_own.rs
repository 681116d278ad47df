//! A structure of one's own: a thin orthotropic plate on simple supports, on a basis of sines.
//!
//! It is all that a structure has to say; modes, accelerance, time response and the FMU then come from the layers below.
//! Run it: `cargo run --example a_structure_of_your_own`.
#![allow(clippy::print_stdout)]

use std::f64::consts::{PI, TAU};

use faer::Mat;
use orthopanel_model::{Block, Constant, Damping, ModalModel, ModelError, Piece, Place, Ports, Structure};

const CONSTANTS: [Constant; 2] = [
    Constant { name: "d_x", unit: "N m", low: 1e-3, high: 1e9 },
    Constant { name: "d_y", unit: "N m", low: 1e-3, high: 1e9 },
];

/// $w_{ij} = \sin(i\pi\xi/a)\sin(j\pi\eta/b)$ from the corner; $U = \frac12\int D_xw_{xx}^2 + D_yw_{yy}^2$.
struct ThinPlate {
    piece: Piece,
    terms: Vec<[usize; 2]>,
    blocks: Vec<Block>,
}

impl ThinPlate {
    fn new(piece: Piece, most: usize) -> Self {
        let terms: Vec<[usize; 2]> = (1..=most).flat_map(|i| (1..=most).map(move |j| [i, j])).collect();
        let quarter = 0.25 * piece.length * piece.width;
        let diagonal = |entry: &dyn Fn([usize; 2]) -> f64| {
            Mat::from_fn(
                terms.len(),
                terms.len(),
                |row, column| if row == column { quarter * entry(terms[row]) } else { 0.0 },
            )
        };
        let along_x = diagonal(&|[i, _]| (i as f64 * PI / piece.length).powi(4));
        let along_y = diagonal(&|[_, j]| (j as f64 * PI / piece.width).powi(4));
        let mass = diagonal(&|_| piece.mass_per_area);
        Self {
            piece,
            terms,
            blocks: vec![Block { stiffness: vec![along_x.into(), along_y.into()], mass: mass.into(), rigid: vec![] }],
        }
    }
}

impl Structure for ThinPlate {
    fn constants(&self) -> &'static [Constant] {
        &CONSTANTS
    }

    fn coefficients(&self, values: &[f64]) -> Result<Vec<f64>, ModelError> {
        Ok(values.to_vec())
    }

    fn coefficient_derivatives(&self, values: &[f64]) -> Result<Mat<f64>, ModelError> {
        Ok(Mat::identity(values.len(), values.len()))
    }

    fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    fn shape_row(&self, _block: usize, place: Place) -> Vec<f64> {
        let (xi, eta) = (place.x / self.piece.length + 0.5, place.y / self.piece.width + 0.5);
        self.terms.iter().map(|&[i, j]| (i as f64 * PI * xi).sin() * (j as f64 * PI * eta).sin()).collect()
    }
}

fn main() -> Result<(), ModelError> {
    let piece = Piece { length: 0.8, width: 0.5, thickness: 0.01, mass_per_area: 6.88 };
    let places = vec![Place { x: 0.1, y: 0.05 }];
    let ports = Ports { forces: places.clone(), responses: places };
    let damping = Damping { beyond: 0.01, ..Damping::default() };
    let model = ModalModel::of_structure(&ThinPlate::new(piece, 6), &[900.0, 700.0], 8, &damping, &ports)?;
    let lowest = model.modes()[0].angular_frequency;
    // Closed form: ω² ρt = D_x (π/a)⁴ + D_y (π/b)⁴.
    let stiffness = 900.0 * (PI / piece.length).powi(4) + 700.0 * (PI / piece.width).powi(4);
    let exact = (stiffness / piece.mass_per_area).sqrt();
    assert!((lowest / exact - 1.0).abs() < 1e-12, "{lowest}, closed form {exact}");
    println!("mode 1: {:.3} Hz", lowest / TAU);
    println!("accelerance at 100 Hz: {:.4} (m/s2)/N", model.accelerance(0, 0, 100.0));
    Ok(())
}

#[test]
fn the_closed_form_is_met() {
    main().unwrap();
}
