//! The names of plate modes: nodal lines across x and across y, told by the products of beam functions they resemble.

use faer::Mat;
use serde::Serialize;

use super::MindlinPlate;
use super::edge_basis::EdgeBasis;
use super::field::Field;
use crate::dense::product;
use crate::structure::RitzMode;
use crate::timoshenko_beam::gauss_points;
use crate::{BeamConstants, Boundary, End, ExactBeam, ModelError, Piece};

/// What a mode of a plate looks like.
///
/// With $f_m$ and $g_n$ the beam functions of the plate's edges with $m$ and $n$ nodes between the edges (free: the rigid
/// translation has none, the rigid turn one), the overlap of a mode with their product is
/// $$o_{mn} = \left|\int wf_mg_n\,dx\,dy\right|\Big/\sqrt{\int w^2\,dx\,dy\int f_m^2g_n^2\,dx\,dy}.$$
/// The squares of all overlaps add up to one. Beam functions are those without shear and rotary inertia.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModeName {
    /// Nodal lines crossed along x and along y, of the product with the largest overlap.
    pub nodes: [usize; 2],
    /// The family.
    pub kind: ModeKind,
    /// The largest overlap, 0 to 1.
    pub overlap: f64,
    /// Nodes of the product with the second largest overlap; two modes that veer share their two products.
    pub second_nodes: [usize; 2],
    /// The second largest overlap.
    pub second_overlap: f64,
}

/// The family of a plate mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum ModeKind {
    /// The width moves as one: the plate bends as a beam along x. Only between free edges along the front and back.
    Bending,
    /// The width turns as one, about its centre line or about a pinned edge: the plate twists. Never where an edge along it is
    /// clamped, nor where both are pinned.
    Torsion,
    /// The width bends, whatever the plate does along x.
    Transverse,
    /// No product holds two thirds of $\int w^2$: modes that veer, and the plus-minus pairs of square plates.
    Mixed,
}

impl ModeKind {
    /// As files and tables say it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bending => "bending",
            Self::Torsion => "torsion",
            Self::Transverse => "transverse",
            Self::Mixed => "mixed",
        }
    }
}

/// Share of $\int w^2$ from which a mode carries the name of one product.
const NAMED_SHARE: f64 = 2.0 / 3.0;

impl MindlinPlate {
    /// The name of one of this plate's modes.
    ///
    /// A mode that shears through the thickness without deflection has overlap zero with all products and is
    /// [`ModeKind::Mixed`].
    pub fn mode_name(&self, mode: &RitzMode) -> ModeName {
        self.name_of(&self.overlaps(mode))
    }

    /// The name of a motion that is the sum of these.
    pub(crate) fn name_of_sum(&self, parts: &[RitzMode]) -> ModeName {
        self.name_of(&self.overlaps_of(parts))
    }

    fn name_of(&self, overlaps: &Mat<f64>) -> ModeName {
        let mut ranked: Vec<([usize; 2], f64)> = (0..overlaps.nrows())
            .flat_map(|m| (0..overlaps.ncols()).map(move |n| [m, n]))
            .map(|[m, n]| ([m, n], overlaps[(m, n)]))
            .collect();
        ranked.sort_by(|a, b| b.1.total_cmp(&a.1));
        let at = |rank: usize| ranked.get(rank).copied().unwrap_or(([0, 0], 0.0));
        let ((nodes, overlap), (second_nodes, second_overlap)) = (at(0), at(1));
        let kind = match ([self.boundary.front, self.boundary.back], nodes[1]) {
            _ if overlap * overlap < NAMED_SHARE => ModeKind::Mixed,
            ([End::Free, End::Free], 0) => ModeKind::Bending,
            ([End::Free, End::Free], 1) | ([End::Free, End::Pinned] | [End::Pinned, End::Free], 0) => ModeKind::Torsion,
            _ => ModeKind::Transverse,
        };
        ModeName { nodes, kind, overlap, second_nodes, second_overlap }
    }

    fn beam_functions(&self) -> &[Mat<f64>; 2] {
        let Boundary { left, right, front, back } = self.boundary;
        self.beam_functions.get_or_init(|| {
            let [x, y] = &self.along;
            [(x, self.piece.length, [left, right]), (y, self.piece.width, [front, back])].map(
                |(basis, length, ends)| {
                    // A plate's piece has been checked: where there were no beam functions, modes would have no name.
                    beam_functions(basis, length, ends)
                        .unwrap_or_else(|_| Mat::zeros(0, basis.count(Field::Deflection)))
                },
            )
        })
    }

    /// Overlaps, 0 to 1, of one of this plate's modes with the products of beam functions (see [`ModeName`]): a row a
    /// number of nodes along x, a column a number along y, as far as the basis resolves them.
    pub fn overlaps(&self, mode: &RitzMode) -> Mat<f64> {
        self.overlaps_of(std::slice::from_ref(mode))
    }

    fn overlaps_of(&self, parts: &[RitzMode]) -> Mat<f64> {
        let [x, y] = &self.along;
        let w = Field::Deflection;
        let mut shape = Mat::zeros(x.count(w), y.count(w));
        for mode in parts {
            let coordinates = self.coordinates.get(mode.block).map_or(&[][..], |list| list);
            for (coordinate, value) in coordinates.iter().zip(&mode.coordinates).filter(|(c, _)| c.field == w) {
                shape[(coordinate.x, coordinate.y)] += *value;
            }
        }
        let [along_x, along_y] = self.beam_functions();
        let [left, right] = [
            product(x.integrals((w, 0), (w, 0)), shape.as_ref()),
            product(shape.as_ref(), y.integrals((w, 0), (w, 0))),
        ];
        let square = product(left.transpose(), right.as_ref());
        let size = (0..square.nrows()).map(|i| square[(i, i)]).sum::<f64>().sqrt();
        // Where all motion is rotation, what is left of w is rounding and has no shape.
        let moving = size * self.piece.mass_per_area.sqrt() > 1e-9;
        let products = product(product(along_x.as_ref(), shape.as_ref()).as_ref(), along_y.transpose());
        Mat::from_fn(
            products.nrows(),
            products.ncols(),
            |m, n| {
                if moving { (products[(m, n)] / size).abs() } else { 0.0 }
            },
        )
    }
}

/// The beam whose modes are the beam functions of these edges.
///
/// # Errors
/// [`ModelError::Size`] where the length has no physical meaning.
pub(super) fn slender_beam(length: f64, [left, right]: [End; 2]) -> Result<ExactBeam, ModelError> {
    // So slender that neither shear nor rotary inertia counts.
    let piece = Piece { length, width: length, thickness: 1e-3 * length, mass_per_area: 1.0 };
    ExactBeam::new(&piece, Boundary { left, right, ..Boundary::FREE }, BeamConstants { e_x: 1e9, g_zx: 1.5e9 })
}

/// $\int f_m\varphi_i\,dx$ of the beam functions of these edges and the plate's deflection functions: a row a number of
/// nodes, from none up to what `terms` polynomials follow.
///
/// # Errors
/// [`ModelError::Size`] where the length has no physical meaning.
fn beam_functions(basis: &EdgeBasis, length: f64, ends: [End; 2]) -> Result<Mat<f64>, ModelError> {
    let beam = slender_beam(length, ends)?;
    // A polynomial of degree n follows 2n/π half-waves.
    let terms = basis.count(Field::Deflection);
    let most = 2 * terms / 3;
    let functions = beam.modes(most);
    let mut products = Mat::<f64>::zeros(functions.len(), terms);
    let mut squares = vec![0.0; products.nrows()];
    let cells = 2 * terms;
    let cell = length / cells as f64;
    for index in 0..cells {
        for (point, weight) in gauss_points() {
            let place = (index as f64 + 0.5 * (1.0 + point)) * cell - 0.5 * length;
            let weight = 0.5 * cell * weight;
            let values = basis.values_at(Field::Deflection, place);
            for (row, (function, square)) in functions.iter().zip(&mut squares).enumerate() {
                let deflection = function.deflection(place);
                *square += weight * deflection * deflection;
                for (column, value) in values.iter().enumerate() {
                    products[(row, column)] += weight * deflection * value;
                }
            }
        }
    }
    Ok(Mat::from_fn(products.nrows(), terms, |row, column| products[(row, column)] / squares[row].sqrt()))
}
