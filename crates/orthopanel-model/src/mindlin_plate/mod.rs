//! The orthotropic Mindlin plate: the panel as a panel.
//!
//! With the deflection $w$ and the rotations $\psi_x$, $\psi_y$ counted as the beam's (without shear,
//! $\psi_x = -w_{,x}$), the strain energy is
//! $$\begin{aligned}
//! U = \tfrac12\int\big[&D_{11}\psi_{x,x}^2 + D_{22}\psi_{y,y}^2 + 2D_{12}\psi_{x,x}\psi_{y,y} +
//! D_{66}(\psi_{x,y}+\psi_{y,x})^2\\\\
//! &+ A_{55}(w_{,x}+\psi_x)^2 + A_{44}(w_{,y}+\psi_y)^2\big]\,dx\,dy
//! \end{aligned}$$
//! with $D_{11} = E_xt^3/12(1-\nu_{xy}\nu_{yx})$, $D_{22} = E_yt^3/12(1-\nu_{xy}\nu_{yx})$, $D_{12} = \nu_{xy}D_{22}$,
//! $D_{66} = G_{xy}t^3/12$, $A_{55} = k'G_{zx}t$, $A_{44} = k'G_{yz}t$, $\nu_{yx} = \nu_{xy}E_y/E_x$, and the beam's
//! $k' = 2/3$ on both shears. The kinetic energy is
//! $$T = \tfrac12\int\big[\rho t\,\dot w^2 + \tfrac{\rho t^3}{12}(\dot\psi_x^2+\dot\psi_y^2)\big]\,dx\,dy.$$
//!
//! Reference: R. D. Mindlin, J. Appl. Mech. 18 (1951) 31; the paper's eq. 2 with its shear moduli outside the fraction.

mod assembly;
mod basis_choice;
mod edge_basis;
mod field;
mod foot;
mod kink;
mod law;
mod membrane;
mod mode_names;
mod moments_of_shear;
mod named_shapes;
mod span_edges;
mod wave;

use std::sync::OnceLock;

use faer::Mat;

pub use law::PLATE_CONSTANTS;
pub use mode_names::{ModeKind, ModeName};
pub use named_shapes::NamedShapes;

use crate::structure::{Block, Motion, ShearMoment, Structure};
use crate::{BeamTerms, Boundary, Constant, ModelError, Piece, Place};
use assembly::{Coordinate, Edges, Products, assemble};
use edge_basis::EdgeBasis;
use field::Field;
pub(crate) use foot::FOOT;
use law::{plate_stiffness_derivatives, plate_stiffnesses};
pub(crate) use membrane::Membrane;
use span_edges::Spans;

/// An orthotropic Mindlin plate as a [`Structure`], on products of Legendre series in x and y.
///
/// Coefficients are the six plate stiffnesses $D_{11}, D_{22}, D_{12}, D_{66}$ \[N m\], $A_{55}, A_{44}$ \[N/m\], in
/// this order, and where clamped edges yield one more, of fixed value 1; constants those of [`PLATE_CONSTANTS`]. Any edge is free, pinned (hard: $w = 0$ and the rotation along
/// the edge is zero) or clamped. Where opposite edges are held alike the coordinates part by parity: four blocks where
/// both pairs are, two where one is.
///
/// Converges as fast as any power of the number of terms.
#[derive(Debug, Clone)]
pub struct MindlinPlate {
    piece: Piece,
    boundary: Boundary,
    terms: [usize; 2],
    products: Products,
    resolved_modes: usize,
    along: [EdgeBasis; 2],
    coordinates: Vec<Vec<Coordinate>>,
    blocks: Vec<Block>,
    /// Integrals of the deflection functions with beam functions, by their nodes, once a mode is to be named.
    beam_functions: OnceLock<[Mat<f64>; 2]>,
    /// What tells the kinks under forces, once it is asked for.
    membrane: OnceLock<Option<Membrane>>,
    is_even: bool,
    /// Whether clamped edges yield: the springs under them are the last matrix of stiffness, with the coefficient one.
    yields: bool,
}

/// What may differ from the even plate.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct PlateTerms {
    /// Spans across the whole width that have lost part of both shear stiffnesses, the factor on the rotary inertia, and the springs under
    /// clamped edges: each metre of these has what [`Support`](crate::Support) says over the plate's width.
    pub spread: BeamTerms,
    /// Mass \[kg\] spread evenly along each of the edges at $x = \pm a/2$, and at $y = \pm b/2$.
    pub edge_mass: [f64; 2],
}

/// Fewest and most terms along one direction.
const TERMS: [usize; 2] = [4, 80];

impl MindlinPlate {
    /// A plate with `terms_x` polynomials along x and `terms_y` along y for each field, from 4 to 80 each.
    ///
    /// # Errors
    /// [`ModelError::Size`] where the piece has no physical meaning, [`ModelError::TermCount`] for other numbers of
    /// terms.
    pub fn new(piece: &Piece, boundary: Boundary, terms: [usize; 2]) -> Result<Self, ModelError> {
        Self::uneven(piece, boundary, terms, Products::All, &PlateTerms::default())
    }

    /// The same without those products of two polynomials that have many nodes both ways: three quarters of the coordinates, with
    /// which the low modes err little more.
    ///
    /// # Errors
    /// As [`MindlinPlate::new`].
    pub fn within_ellipse(piece: &Piece, boundary: Boundary, terms: [usize; 2]) -> Result<Self, ModelError> {
        Self::uneven(piece, boundary, terms, Products::WithinEllipse, &PlateTerms::default())
    }

    /// With terms of its own.
    fn uneven(
        piece: &Piece,
        boundary: Boundary,
        terms: [usize; 2],
        products: Products,
        own: &PlateTerms,
    ) -> Result<Self, ModelError> {
        let piece = piece.checked()?;
        let PlateTerms { spread: own, edge_mass } = own;
        own.check()?;
        let [least, most] = TERMS;
        if let Some(&found) = terms.iter().find(|count| !(least..=most).contains(*count)) {
            return Err(ModelError::TermCount { found, least, most });
        }
        let Boundary { left, right, front, back } = boundary;
        let yields = own.support.is_some();
        let mut x = EdgeBasis::new(0.5 * piece.length, [left, right], yields, Field::RotationX, terms[0]);
        if !own.losses.is_empty() {
            x = x.with_spans([left, right], &Spans::new(0.5 * piece.length, &own.losses));
        }
        let y = EdgeBasis::new(0.5 * piece.width, [front, back], yields, Field::RotationY, terms[1]);
        let (along, is_even) = ([x, y], own.losses.is_empty());
        let edges = Edges { boundary, mass: *edge_mass, support: own.support };
        let (coordinates, blocks) = assemble(&piece, &along, own.rotary_factor, &edges, products);
        // In each direction n polynomials follow 2n/π half-waves; some nx ny/3 products lie within the ellipse that both
        // span, and the lower half of these hold 1e-4.
        let resolved_modes = terms[0] * terms[1] / 6;
        Ok(Self {
            piece,
            boundary,
            terms,
            products,
            resolved_modes,
            along,
            coordinates,
            blocks,
            beam_functions: OnceLock::new(),
            membrane: OnceLock::new(),
            is_even,
            yields,
        })
    }

    /// The same plate without those parity blocks where no mode with these nodes along x and y lies.
    pub fn only_with_nodes(&self, nodes: &[[usize; 2]]) -> Self {
        let [x, y] = &self.along;
        let holds = |coordinates: &[Coordinate]| {
            let deflection = coordinates.iter().find(|coordinate| coordinate.field == Field::Deflection);
            let alike = |basis: &EdgeBasis, own: usize, count: usize| !basis.parts() || own % 2 == count % 2;
            deflection.is_some_and(|own| nodes.iter().any(|&[m, n]| alike(x, own.x, m) && alike(y, own.y, n)))
        };
        let own = self.coordinates.iter().zip(&self.blocks).filter(|(coordinates, _)| holds(coordinates));
        let (coordinates, blocks): (Vec<_>, Vec<_>) = own.map(|(list, block)| (list.clone(), block.clone())).unzip();
        let resolved_modes = self.resolved_modes * blocks.len() / self.blocks.len().max(1);
        let (along, beam_functions) = (self.along.clone(), self.beam_functions.clone());
        Self { resolved_modes, along, coordinates, blocks, beam_functions, membrane: OnceLock::new(), ..*self }
    }

    /// The same plate with fewer polynomials along x and y: rougher, and quicker.
    pub fn with_fewer_terms(&self, terms: [usize; 2]) -> Self {
        let keeps = |coordinate: &Coordinate| coordinate.x < terms[0] && coordinate.y < terms[1];
        let of_block = |(list, block): (&Vec<Coordinate>, &Block)| {
            let kept: Vec<usize> = (0..list.len()).filter(|&index| keeps(&list[index])).collect();
            let block = Block {
                stiffness: block.stiffness.iter().map(|matrix| matrix.part(&kept)).collect(),
                mass: block.mass.part(&kept),
                rigid: block.rigid.iter().map(|shape| kept.iter().map(|&index| shape[index]).collect()).collect(),
            };
            (kept.iter().map(|&index| list[index]).collect::<Vec<_>>(), block)
        };
        let (coordinates, blocks): (_, Vec<Block>) = self.coordinates.iter().zip(&self.blocks).map(of_block).unzip();
        let terms = [0, 1].map(|axis| terms[axis].min(self.terms[axis]));
        let resolved_modes =
            blocks.iter().map(|block| block.size() - block.rigid.len()).sum::<usize>().min(self.resolved_modes);
        let (along, beam_functions) = (self.along.clone(), self.beam_functions.clone());
        Self { terms, resolved_modes, along, coordinates, blocks, beam_functions, membrane: OnceLock::new(), ..*self }
    }

    /// Number of polynomials of each field along x and y.
    pub fn terms(&self) -> [usize; 2] {
        self.terms
    }
}

/// Most that the shear stiffness may be of the bending stiffness, $k'Gta^2/D$. Shear strain of thin plates is a small
/// difference of slope and rotation, and the lowest modes lie close together beside the stiffness that a search for them begins
/// with: up to this limit frequencies are held to 1e-4, beside what their basis leaves; at ten times as much some come out 17 %
/// too high.
const SHEAR_OVER_BENDING: f64 = 4e8;

impl MindlinPlate {
    fn check_thickness(&self, [d_11, d_22, _, _, a_55, a_44]: [f64; 6]) -> Result<(), ModelError> {
        let Piece { length, width, thickness, .. } = self.piece;
        let ratio = (a_55 * length * length / d_11).max(a_44 * width * width / d_22);
        if ratio <= SHEAR_OVER_BENDING {
            return Ok(());
        }
        // The ratio falls with the square of the thickness.
        let least = thickness * (ratio / SHEAR_OVER_BENDING).sqrt();
        Err(ModelError::TooThin { thickness, ratio, limit: SHEAR_OVER_BENDING, least })
    }
}

impl MindlinPlate {
    /// A moment of a shear strain of each coordinate of a block.
    fn shear_moment(&self, block: usize, moment: ShearMoment, at: Place) -> Vec<f64> {
        let Some(coordinates) = self.coordinates.get(block) else { return vec![] };
        let [x, y] = &self.along;
        let ends = |middle: f64, half: f64| [-0.5, 0.5].map(|side| (middle + side * moment.span).clamp(-half, half));
        let [along, across] = [ends(at.x, 0.5 * self.piece.length), ends(at.y, 0.5 * self.piece.width)];
        let orders = if moment.across { [0, 1] } else { [1, 0] };
        let rotation = if moment.across { Field::RotationY } else { Field::RotationX };
        let integral = |field: Field, orders: [usize; 2]| {
            [
                x.moments(field, orders[0], (along, moment.degrees[0])),
                y.moments(field, orders[1], (across, moment.degrees[1])),
            ]
        };
        let (slope, rotated) = (integral(Field::Deflection, orders), integral(rotation, [0, 0]));
        let value = |own: &Coordinate| match own.field {
            Field::Deflection => slope[0][own.x] * slope[1][own.y],
            field if field == rotation => rotated[0][own.x] * rotated[1][own.y],
            _ => 0.0,
        };
        coordinates.iter().map(value).collect()
    }

    /// The mean deflection of each coordinate of a block over a foot.
    fn mean_over_foot(&self, block: usize, place: Place) -> Vec<f64> {
        let [along, across] = [(place.x, self.piece.length), (place.y, self.piece.width)]
            .map(|(place, side)| foot::gauss_points(place, 0.5 * side));
        let rows = along.into_iter().flat_map(|x| across.map(|y| Place { x, y }));
        let rows: Vec<Vec<f64>> = rows.map(|place| self.row(block, Field::Deflection, [0, 0], place)).collect();
        (0..rows[0].len()).map(|i| 0.25 * rows.iter().map(|row| row[i]).sum::<f64>()).collect()
    }

    /// A field of each coordinate of a block at a place, or its slope along x or y.
    fn row(&self, block: usize, field: Field, orders: [usize; 2], place: Place) -> Vec<f64> {
        let Some(coordinates) = self.coordinates.get(block) else { return vec![] };
        let [x, y] = &self.along;
        let at = |basis: &EdgeBasis, order: usize, place: f64| {
            if order == 0 { basis.values_at(field, place) } else { basis.slopes_at(field, place) }
        };
        let (at_x, at_y) = (at(x, orders[0], place.x), at(y, orders[1], place.y));
        let value = |own: &Coordinate| if own.field == field { at_x[own.x] * at_y[own.y] } else { 0.0 };
        coordinates.iter().map(value).collect()
    }
}

impl MindlinPlate {
    /// What tells the kinks that this basis lacks; `None` where its functions cannot be told apart.
    pub(crate) fn membrane(&self) -> Option<Membrane> {
        let Boundary { left, right, front, back } = if self.yields { self.boundary.released() } else { self.boundary };
        let counts = [0, 1].map(|axis| self.along[axis].count(Field::Deflection));
        let length = |j: usize| (0..counts[0]).filter(|&i| self.products.hold([i, j], counts)).count();
        let lengths: Vec<usize> = (0..counts[1]).map(length).collect();
        let Piece { length, width, .. } = self.piece;
        Membrane::new(&self.along, [0.5 * length, 0.5 * width], [[left, right], [front, back]], &lengths)
    }

    /// What the basis lacks of the static flexibility between two motions; `None` for a rotation, which has no kink.
    pub(crate) fn kink(&self, membrane: &Membrane, values: &[f64], motions: [(Motion, Place); 2]) -> Option<f64> {
        membrane.kink(&self.along, plate_stiffnesses(self.piece.thickness, values).ok()?, motions)
    }

    /// The membrane of a plate without terms of its own, made once.
    fn even_membrane(&self) -> Option<&Membrane> {
        self.membrane.get_or_init(|| if self.is_even { self.membrane() } else { None }).as_ref()
    }

    /// What the basis lacks of the static flexibility between the motions of two lists.
    pub(crate) fn kinks(
        &self,
        membrane: &Membrane,
        values: &[f64],
        motions: [&[(Motion, Place)]; 2],
    ) -> Option<Mat<f64>> {
        Some(membrane.kinks(&self.along, plate_stiffnesses(self.piece.thickness, values).ok()?, motions))
    }

    /// [`Structure::inertial_remainders`], as many as there are.
    pub(crate) fn inertia(
        &self,
        membrane: &Membrane,
        values: &[f64],
        motions: [&[(Motion, Place)]; 2],
    ) -> Vec<Mat<f64>> {
        let Ok(stiffnesses) = plate_stiffnesses(self.piece.thickness, values) else { return vec![] };
        membrane.inertia(&self.along, stiffnesses, self.piece.mass_per_area, motions).into()
    }
}

impl Structure for MindlinPlate {
    fn constants(&self) -> &'static [Constant] {
        &PLATE_CONSTANTS
    }

    fn coefficients(&self, values: &[f64]) -> Result<Vec<f64>, ModelError> {
        let stiffnesses = plate_stiffnesses(self.piece.thickness, values)?;
        self.check_thickness(stiffnesses)?;
        let springs = self.yields.then_some(1.0);
        Ok(stiffnesses.into_iter().chain(springs).collect())
    }

    fn coefficient_derivatives(&self, values: &[f64]) -> Result<Mat<f64>, ModelError> {
        let mut by_constants = plate_stiffness_derivatives(self.piece.thickness, values)?;
        by_constants.resize_with(by_constants.nrows() + usize::from(self.yields), by_constants.ncols(), |_, _| 0.0);
        Ok(by_constants)
    }

    fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    fn shape_row(&self, block: usize, place: Place) -> Vec<f64> {
        self.row(block, Field::Deflection, [0, 0], place)
    }

    fn motion_row(&self, block: usize, motion: Motion, place: Place) -> Option<Vec<f64>> {
        Some(match motion {
            Motion::Deflection => self.row(block, Field::Deflection, [0, 0], place),
            Motion::Foot => self.mean_over_foot(block, place),
            Motion::Slope => self.row(block, Field::Deflection, [1, 0], place),
            Motion::SlopeAcross => self.row(block, Field::Deflection, [0, 1], place),
            Motion::Rotation => self.row(block, Field::RotationX, [0, 0], place),
            Motion::Curvature => self.row(block, Field::RotationX, [1, 0], place),
            Motion::Shear(moment) => self.shear_moment(block, moment, place),
        })
    }

    /// The kinks, of an even plate.
    fn static_remainder(&self, values: &[f64], motions: [(Motion, Place); 2]) -> Option<f64> {
        self.kink(self.even_membrane()?, values, motions)
    }

    fn static_remainders(&self, values: &[f64], motions: [&[(Motion, Place)]; 2]) -> Option<Mat<f64>> {
        self.kinks(self.even_membrane()?, values, motions)
    }

    fn inertial_remainders(&self, values: &[f64], motions: [&[(Motion, Place)]; 2]) -> Vec<Mat<f64>> {
        self.even_membrane().map_or_else(Vec::new, |membrane| self.inertia(membrane, values, motions))
    }

    fn resolved_modes(&self) -> usize {
        self.resolved_modes
    }
}
