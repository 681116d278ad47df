//! Stiffness and mass matrices of the plate, block by block: sums of products of integrals along x and along y.

use faer::{Mat, MatRef};

use super::Field;
use super::edge_basis::EdgeBasis;
use crate::structure::{Block, quadratic_form};
use crate::{Piece, side_by_side};

/// One product of a function along x and a function along y, of one field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Coordinate {
    pub field: Field,
    /// Number of its function along x.
    pub x: usize,
    /// Number of its function along y.
    pub y: usize,
}

/// Which products of the functions along x and along y are coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Products {
    /// All of them.
    All,
    /// Those within the quarter of an ellipse, $(i/n_x)^2+(j/n_y)^2\le1$ with $n$ the last of each direction. Whoever is in has the
    /// slopes that it needs in too. What is left out, a fifth of all and more, has many nodes both ways, which no low mode has.
    WithinEllipse,
}

impl Products {
    /// Whether a product of these two functions is a coordinate.
    pub(super) fn hold(self, [x, y]: [usize; 2], [count_x, count_y]: [usize; 2]) -> bool {
        let part = |number: usize, count: usize| (number as f64 / count.saturating_sub(1).max(1) as f64).powi(2);
        // The last function along a side must not be lost to rounding.
        self == Self::All || part(x, count_x) + part(y, count_y) < 1.0 + 1e-9
    }
}

/// A field with its orders of differentiation along x and y.
type Term = (Field, usize, usize);

const CURVATURE_X: &[Term] = &[(Field::RotationX, 1, 0)];
const CURVATURE_Y: &[Term] = &[(Field::RotationY, 0, 1)];
const TWIST: &[Term] = &[(Field::RotationX, 0, 1), (Field::RotationY, 1, 0)];
const SHEAR_X: &[Term] = &[(Field::Deflection, 1, 0), (Field::RotationX, 0, 0)];
const SHEAR_Y: &[Term] = &[(Field::Deflection, 0, 1), (Field::RotationY, 0, 0)];

/// The coordinates of each block, and the blocks. Stiffnesses stand in the order $D_{11}, D_{22}, D_{12}, D_{66},
/// A_{55}, A_{44}$.
pub(super) fn assemble(
    piece: &Piece,
    along: &[EdgeBasis; 2],
    rotary_factor: f64,
    edge_mass: f64,
    products: Products,
) -> (Vec<Vec<Coordinate>>, Vec<Block>) {
    let [x, y] = along;
    let mut coordinates = Vec::new();
    for &odd_y in y.parities() {
        for &odd_x in x.parities() {
            coordinates.push(block_coordinates(along, [odd_x, odd_y], products));
        }
    }
    let blocks = side_by_side::map(&coordinates, |list| {
        let mut block = block(piece, along, rotary_factor, list);
        if edge_mass != 0.0 {
            add_edge_mass(piece, along, edge_mass, list, &mut block);
        }
        block
    });
    (coordinates, blocks)
}

/// Each rotation has the parity of the slope of $w$ along its own direction.
fn block_coordinates([x, y]: &[EdgeBasis; 2], [odd_x, odd_y]: [bool; 2], products: Products) -> Vec<Coordinate> {
    let mut list = Vec::new();
    for field in Field::ALL {
        let flips_x = field == Field::RotationX;
        let flips_y = field == Field::RotationY;
        for i in x.of_parity(field, odd_x != flips_x) {
            let counts = [x.count(field), y.count(field)];
            let own = y.of_parity(field, odd_y != flips_y).filter(|&j| products.hold([i, j], counts));
            list.extend(own.map(|j| Coordinate { field, x: i, y: j }));
        }
    }
    list
}

fn block(piece: &Piece, along: &[EdgeBasis; 2], rotary_factor: f64, list: &[Coordinate]) -> Block {
    let form = |f: &[Term], g: &[Term]| product(along, list, EdgeBasis::integrals, [f, g]);
    let shear = |f: &[Term]| product(along, list, EdgeBasis::sheared_integrals, [f, f]);
    let crossed = form(CURVATURE_X, CURVATURE_Y);
    let stiffness = vec![
        form(CURVATURE_X, CURVATURE_X),
        form(CURVATURE_Y, CURVATURE_Y),
        &crossed + crossed.transpose(),
        form(TWIST, TWIST),
        shear(SHEAR_X),
        shear(SHEAR_Y),
    ];
    let rotary_inertia = rotary_factor * piece.mass_per_area * piece.thickness * piece.thickness / 12.0;
    let mut mass = Mat::zeros(list.len(), list.len());
    for (field, inertia) in Field::ALL.into_iter().zip([piece.mass_per_area, rotary_inertia, rotary_inertia]) {
        let own: &[Term] = &[(field, 0, 0)];
        mass += faer::Scale(inertia) * form(own, own);
    }
    let rigid = rigid_modes(along, list, &mass);
    Block { stiffness, mass, rigid }
}

/// Adds $\frac mb\int ww\,dy$ at both ends of x, and scales the rigid modes to it: even mass at both ends keeps these
/// orthogonal.
fn add_edge_mass(piece: &Piece, [x, y]: &[EdgeBasis; 2], mass: f64, list: &[Coordinate], block: &mut Block) {
    let w = Field::Deflection;
    let across = y.integrals((w, 0), (w, 0));
    let own: Vec<usize> = (0..list.len()).filter(|&i| list[i].field == w).collect();
    for end in [-0.5, 0.5] {
        let along = x.values_at(w, end * piece.length);
        for (&i, &j) in own.iter().flat_map(|i| own.iter().map(move |j| (i, j))) {
            let (a, b) = (list[i], list[j]);
            block.mass[(i, j)] += mass / piece.width * along[a.x] * along[b.x] * across[(a.y, b.y)];
        }
    }
    for mode in &mut block.rigid {
        let scale = quadratic_form(&block.mass, mode).sqrt().recip();
        mode.iter_mut().for_each(|value| *value *= scale);
    }
}

/// Integrals along x of two fields, each with its order of differentiation.
type AlongX = fn(&EdgeBasis, (Field, usize), (Field, usize)) -> MatRef<'_, f64>;

/// $\int fg\,dx\,dy$ of two strains in the coordinates of a block: a row a coordinate of `f`, a column one of `g`.
fn product([x, y]: &[EdgeBasis; 2], list: &[Coordinate], integrals: AlongX, [f, g]: [&[Term]; 2]) -> Mat<f64> {
    let mut matrix = Mat::zeros(list.len(), list.len());
    // The coordinates of a block stand field by field.
    let own = |field: Field| {
        let first = list.partition_point(|c| (c.field as usize) < field as usize);
        (first, list.iter().filter(move |c| c.field == field))
    };
    for &(left, left_x, left_y) in f {
        for &(right, right_x, right_y) in g {
            let along_x = integrals(x, (left, left_x), (right, right_x));
            let along_y = y.integrals((left, left_y), (right, right_y));
            let ((first_row, rows), (first_column, columns)) = (own(left), own(right));
            let rows: Vec<&Coordinate> = rows.collect();
            for (column, b) in columns.enumerate() {
                let entries = &mut matrix.col_as_slice_mut(first_column + column)[first_row..];
                for (entry, a) in entries.iter_mut().zip(&rows) {
                    *entry += along_x[(a.x, b.x)] * along_y[(a.y, b.y)];
                }
            }
        }
    }
    matrix
}

/// The motions of a block without strain: $w$ a product of functions that is at most linear, with the rotations that
/// cancel its slopes.
fn rigid_modes([x, y]: &[EdgeBasis; 2], list: &[Coordinate], mass: &Mat<f64>) -> Vec<Vec<f64>> {
    let mut modes = Vec::new();
    for (position, candidate) in list.iter().enumerate().filter(|(_, c)| c.field == Field::Deflection) {
        let slopes = (x.linear_slope(candidate.x), y.linear_slope(candidate.y));
        let (Some(slope_x), Some(slope_y)) = slopes else { continue };
        // The other factor of a linear function is a constant, one over the unit of that direction.
        let rotation = match (slope_x != 0.0, slope_y != 0.0) {
            (false, false) => None,
            (true, false) => Some((Field::RotationX, slope_x, y.unit(Field::Deflection))),
            (false, true) => Some((Field::RotationY, slope_y, x.unit(Field::Deflection))),
            (true, true) => continue,
        };
        let mut mode = vec![0.0; list.len()];
        mode[position] = 1.0;
        if let Some((field, slope, other)) = rotation {
            let own = Coordinate { field, x: 0, y: 0 };
            let place = list.iter().position(|c| *c == own);
            let (Some(place), Some(other), Some(unit_x), Some(unit_y)) = (place, other, x.unit(field), y.unit(field))
            else {
                continue;
            };
            mode[place] = -slope / other * unit_x * unit_y;
        }
        let scale = quadratic_form(mass, &mode).sqrt().recip();
        mode.iter_mut().for_each(|value| *value *= scale);
        modes.push(mode);
    }
    modes
}
