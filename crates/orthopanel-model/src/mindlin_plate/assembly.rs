//! Stiffness and mass matrices of the plate, block by block: sums of products of integrals along x and along y.
//!
//! Coordinates stand by their degree along the side with more functions, then by that along the other. Since functions
//! meet whose degrees are at most two apart, rows of the matrices then are short. Where spans have lost shear stiffness, all
//! functions along x meet, and the degree along y comes first.

use std::sync::Arc;

use faer::{Mat, MatRef};

use super::edge_basis::EdgeBasis;
use super::field::Field;
use crate::order::sorted;
use crate::skyline::Profile;
use crate::structure::Block;
use crate::{Boundary, End, Piece, Support, SymmetricMatrix, side_by_side};

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

const DEFLECTION: &[Term] = &[(Field::Deflection, 0, 0)];
const ROTATION_X: &[Term] = &[(Field::RotationX, 0, 0)];
const ROTATION_Y: &[Term] = &[(Field::RotationY, 0, 0)];
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
    edges: &Edges,
    products: Products,
) -> (Vec<Vec<Coordinate>>, Vec<Block>) {
    let [x, y] = along;
    let mut coordinates = Vec::new();
    for &odd_y in y.parities() {
        for &odd_x in x.parities() {
            coordinates.push(block_coordinates(along, [odd_x, odd_y], products));
        }
    }
    let meetings = along.each_ref().map(EdgeBasis::meetings);
    let blocks = side_by_side::map(&coordinates, |list| {
        let mut block = block(piece, along, rotary_factor, (list, &meetings));
        if edges.mass != [0.0; 2] {
            add_edge_mass(piece, along, edges.mass, list, &mut block);
        }
        if let Some(support) = edges.support {
            block.stiffness.push(edge_springs(piece, along, (edges.boundary, support), list).into());
            block.rigid.clear();
        }
        block
    });
    (coordinates, blocks)
}

/// Each rotation has the parity of the slope of $w$ along its own direction.
fn block_coordinates(along: &[EdgeBasis; 2], [odd_x, odd_y]: [bool; 2], products: Products) -> Vec<Coordinate> {
    let [x, y] = along;
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
    sorted(list, |coordinate| {
        let [first, second] = degrees(along, coordinate);
        (((first << 16 | second) << 2) + coordinate.field as usize) as f64
    })
}

/// The side along which rows of the matrices are ordered first: that with more functions, but never one all of whose functions meet
/// in a span without all of the shear stiffness.
fn major([x, y]: &[EdgeBasis; 2]) -> usize {
    usize::from(x.is_sheared() || x.count(Field::Deflection) < y.count(Field::Deflection))
}

/// Degrees along the major side and along the other.
fn degrees(along: &[EdgeBasis; 2], &Coordinate { field, x: i, y: j }: &Coordinate) -> [usize; 2] {
    let [along_x, along_y] = [along[0].degree(field, i), along[1].degree(field, j)];
    if major(along) == 0 { [along_x, along_y] } else { [along_y, along_x] }
}

fn block(
    piece: &Piece,
    along: &[EdgeBasis; 2],
    rotary_factor: f64,
    (list, meetings): (&[Coordinate], &[Vec<Vec<bool>>; 2]),
) -> Block {
    let profile = Arc::new(profile(along, list, meetings));
    let sum = |forms: &[Form]| product(along, (list, &profile), forms);
    let plain = |f: &'static [Term], g: &'static [Term]| (1.0, EdgeBasis::integrals as AlongX, f, g);
    let sheared = |f: &'static [Term]| (1.0, EdgeBasis::sheared_integrals as AlongX, f, f);
    // In the order of the coefficients.
    let forms = [
        vec![plain(CURVATURE_X, CURVATURE_X)],
        vec![plain(CURVATURE_Y, CURVATURE_Y)],
        vec![plain(CURVATURE_X, CURVATURE_Y), plain(CURVATURE_Y, CURVATURE_X)],
        vec![plain(TWIST, TWIST)],
        vec![sheared(SHEAR_X)],
        vec![sheared(SHEAR_Y)],
    ];
    let stiffness = forms.iter().map(|own| sum(own)).collect();
    let rotary_inertia = rotary_factor * piece.mass_per_area * piece.thickness * piece.thickness / 12.0;
    let inertias = [(piece.mass_per_area, DEFLECTION), (rotary_inertia, ROTATION_X), (rotary_inertia, ROTATION_Y)];
    let mass = sum(&inertias.map(|(inertia, own)| (inertia, EdgeBasis::integrals as AlongX, own, own)));
    let rigid = rigid_modes(along, list, &mass);
    Block { stiffness, mass, rigid }
}

/// Where the first coordinate stands that each one meets.
fn profile(along: &[EdgeBasis; 2], list: &[Coordinate], meetings: &[Vec<Vec<bool>>; 2]) -> Profile {
    let [x, y] = along;
    let slots: Vec<[usize; 2]> = list.iter().map(|c| [x.slot(c.field, c.x), y.slot(c.field, c.y)]).collect();
    let meet = |a: usize, b: usize| meetings[0][slots[a][0]][slots[b][0]] && meetings[1][slots[a][1]][slots[b][1]];
    // A row begins no sooner than the least degree along the longer series that it meets.
    let degree: Vec<usize> = list.iter().map(|coordinate| degrees(along, coordinate)[0]).collect();
    let major = major(along);
    let numbers = |field: Field| (0..along[major].count(field)).map(move |number| (field, number));
    let met: Vec<(usize, usize)> = Field::ALL
        .into_iter()
        .flat_map(numbers)
        .map(|(field, number)| (along[major].slot(field, number), along[major].degree(field, number)))
        .collect();
    let least_degree = |slot: usize| {
        let met = met.iter().filter(|(other, _)| meetings[major][slot][*other]);
        met.map(|(_, degree)| *degree).min().unwrap_or(0)
    };
    let least: Vec<usize> = (0..meetings[major].len()).map(least_degree).collect();
    let first = |row: usize| {
        let least = least[slots[row][major]];
        let from = degree.partition_point(|degree| *degree < least);
        (from..row).find(|&column| meet(row, column)).unwrap_or(row)
    };
    Profile::new((0..list.len()).map(first).collect())
}

/// What stands along edges.
pub(super) struct Edges {
    pub boundary: Boundary,
    /// Mass \[kg\] along each of the edges at $x = \pm a/2$, and at $y = \pm b/2$.
    pub mass: [f64; 2],
    /// What every clamped edge rests on.
    pub support: Option<Support>,
}

/// Adds $c\int ff\,ds$ of a field along the edge at one side, -1 or 1, of an axis.
fn add_along_edge(
    [x, y]: &[EdgeBasis; 2],
    (axis, side): (usize, f64),
    (coefficient, field): (f64, Field),
    list: &[Coordinate],
    sum: &mut Mat<f64>,
) {
    let (across, along) = if axis == 0 { (x, y) } else { (y, x) };
    let mut at_edge = across.values_at(field, side * across.half_length());
    // Most functions vanish at the edges, to rounding.
    let greatest = at_edge.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    at_edge.iter_mut().filter(|value| value.abs() < 1e-12 * greatest).for_each(|value| *value = 0.0);
    let along = along.integrals((field, 0), (field, 0));
    let number = |coordinate: &Coordinate| if axis == 0 { coordinate.x } else { coordinate.y };
    let other = |coordinate: &Coordinate| if axis == 0 { coordinate.y } else { coordinate.x };
    let moves = |i: &usize| list[*i].field == field && at_edge[number(&list[*i])] != 0.0;
    let own: Vec<usize> = (0..list.len()).filter(moves).collect();
    for (&i, &j) in own.iter().flat_map(|i| own.iter().map(move |j| (i, j))) {
        let (a, b) = (&list[i], &list[j]);
        sum[(i, j)] += coefficient * at_edge[number(a)] * at_edge[number(b)] * along[(other(a), other(b))];
    }
}

/// Adds $\frac mb\int ww\,dy$ at both ends of x and $\frac ma\int ww\,dx$ at both of y, and scales the rigid modes to it: even mass at both ends keeps
/// these orthogonal.
fn add_edge_mass(piece: &Piece, along: &[EdgeBasis; 2], masses: [f64; 2], list: &[Coordinate], block: &mut Block) {
    let mut added = Mat::<f64>::zeros(list.len(), list.len());
    for (axis, (mass, edge)) in masses.into_iter().zip([piece.width, piece.length]).enumerate() {
        for side in [-1.0, 1.0] {
            add_along_edge(along, (axis, side), (mass / edge, Field::Deflection), list, &mut added);
        }
    }
    block.mass = SymmetricMatrix::sum([(1.0, &block.mass), (1.0, &added.into())].into_iter(), list.len());
    for mode in &mut block.rigid {
        let scale = block.mass.quadratic_form(mode).sqrt().recip();
        mode.iter_mut().for_each(|value| *value *= scale);
    }
}

/// $\frac1b\int(k_www + k_\psi\psi_x\psi_x + k_\psi\psi_y\psi_y)\,ds$ along all clamped edges: infinite springs leave what a clamp does,
/// which holds both rotations.
fn edge_springs(
    piece: &Piece,
    along: &[EdgeBasis; 2],
    (boundary, support): (Boundary, Support),
    list: &[Coordinate],
) -> Mat<f64> {
    let mut springs = Mat::<f64>::zeros(list.len(), list.len());
    let Boundary { left, right, front, back } = boundary;
    for (edge, end) in [((0, -1.0), left), ((0, 1.0), right), ((1, -1.0), front), ((1, 1.0), back)] {
        for field in Field::ALL.into_iter().filter(|_| end == End::Clamped) {
            let stiffness = if field == Field::Deflection { support.translation } else { support.rotation };
            add_along_edge(along, edge, (stiffness / piece.width, field), list, &mut springs);
        }
    }
    springs
}

/// Integrals along x of two fields, each with its order of differentiation.
type AlongX = fn(&EdgeBasis, (Field, usize), (Field, usize)) -> MatRef<'_, f64>;

/// $c\int fg\,dx\,dy$ of two strains.
type Form<'a> = (f64, AlongX, &'a [Term], &'a [Term]);

/// A sum of forms in the coordinates of a block: a row a coordinate of `f`, a column one of `g`, its lower triangle.
#[inline(never)] // Several times in one place, it would make every FMU larger.
fn product(
    [x, y]: &[EdgeBasis; 2],
    (list, profile): (&[Coordinate], &Arc<Profile>),
    forms: &[Form],
) -> SymmetricMatrix {
    let mut tables: [Vec<(Field, [Rows; 2])>; 3] = Default::default();
    for &(factor, integrals, f, g) in forms {
        for &(left, left_x, left_y) in f {
            for &(right, right_x, right_y) in g {
                let along_x = integrals(x, (left, left_x), (right, right_x));
                let along_y = y.integrals((left, left_y), (right, right_y));
                tables[left as usize].push((right, [Rows::of(along_x, factor), Rows::of(along_y, 1.0)]));
            }
        }
    }
    let places = Places::of(list, [x, y]);
    SymmetricMatrix::from_rows(profile, |row, first, values| {
        let own = list[row];
        for (field, [along_x, along_y]) in &tables[own.field as usize] {
            let along_y = along_y.row(own.y);
            for &(other_x, by_x) in along_x.row(own.x) {
                for &(other_y, by_y) in along_y {
                    // Those of other blocks, and of the upper triangle, have no place here.
                    let place = places.at(*field, other_x, other_y).wrapping_sub(first);
                    if let Some(value) = values.get_mut(place) {
                        *value += by_x * by_y;
                    }
                }
            }
        }
    })
}

/// What is not zero of a matrix, by rows: most functions do not meet.
struct Rows {
    starts: Vec<usize>,
    entries: Vec<(usize, f64)>,
}

impl Rows {
    /// Times a factor.
    fn of(matrix: MatRef<'_, f64>, factor: f64) -> Self {
        let (mut starts, mut entries) = (vec![0], Vec::with_capacity(4 * matrix.nrows()));
        for i in 0..matrix.nrows() {
            for j in 0..matrix.ncols() {
                let value = matrix[(i, j)];
                if value != 0.0 {
                    entries.push((j, factor * value));
                }
            }
            starts.push(entries.len());
        }
        Self { starts, entries }
    }

    fn row(&self, row: usize) -> &[(usize, f64)] {
        &self.entries[self.starts[row]..self.starts[row + 1]]
    }
}

/// Where in a block each product of two functions stands.
struct Places {
    counts: [usize; 2],
    places: Vec<usize>,
}

impl Places {
    fn of(list: &[Coordinate], along: [&EdgeBasis; 2]) -> Self {
        let counts = along.map(|basis| Field::ALL.map(|field| basis.count(field)).into_iter().max().unwrap_or(0));
        let mut own = Self { counts, places: vec![usize::MAX; 3 * counts[0] * counts[1]] };
        for (place, coordinate) in list.iter().enumerate() {
            let number = own.number(coordinate.field, coordinate.x, coordinate.y);
            own.places[number] = place;
        }
        own
    }

    fn number(&self, field: Field, x: usize, y: usize) -> usize {
        (field as usize * self.counts[0] + x) * self.counts[1] + y
    }

    /// [`usize::MAX`] of another block's.
    fn at(&self, field: Field, x: usize, y: usize) -> usize {
        self.places[self.number(field, x, y)]
    }
}

/// The motions of a block without strain: $w$ a product of functions that is at most linear, with the rotations that
/// cancel its slopes.
fn rigid_modes([x, y]: &[EdgeBasis; 2], list: &[Coordinate], mass: &SymmetricMatrix) -> Vec<Vec<f64>> {
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
        let scale = mass.quadratic_form(&mode).sqrt().recip();
        mode.iter_mut().for_each(|value| *value *= scale);
        modes.push(mode);
    }
    modes
}
