//! How many polynomials a plate needs: from the nodes that its lowest modes have in each direction, and from the layers at its
//! free edges.

use super::assembly::Products;
use super::law::plate_stiffnesses;
use super::{MindlinPlate, PlateTerms, TERMS};
use crate::{Boundary, End, ModelError, Piece, Support};

/// Most entries of one matrix of all blocks together: 3.6 million keep a plate below 200 MB.
const MOST_ENTRIES: usize = 3_600_000;

/// Isotropic, with bending stiffness one and as good as no shear strain.
const EQUAL_STIFFNESSES: [f64; 6] = [1.0, 1.0, 0.3, 0.35, 1e30, 1e30];

impl MindlinPlate {
    /// A plate whose basis holds its first `count` flexible modes to about 1e-4 of their frequencies, chosen for equal
    /// stiffness along x and y.
    ///
    /// # Errors
    /// As [`MindlinPlate::with_basis_for`].
    pub fn with_default_basis(piece: &Piece, boundary: Boundary, count: usize) -> Result<Self, ModelError> {
        let layers = Self::layer_terms(piece, boundary)?;
        let terms = Reach { layers, ..Reach::new(piece, boundary, EQUAL_STIFFNESSES)? }.terms(count)?;
        let plate = Self::new(piece, boundary, terms)?;
        Ok(Self { resolved_modes: plate.resolved_modes.max(count), ..plate })
    }

    /// A plate whose basis holds its first `count` flexible modes to about 1e-4 of their frequencies at these values of
    /// the constants (order of [`PLATE_CONSTANTS`](crate::PLATE_CONSTANTS)).
    ///
    /// Limits: where the layer at free edges is thinner than some 1/300 of the plate (solid plates more than a hundred times as
    /// wide as thick), the largest basis has too few terms for it, which costs up to 6e-4 of a twisting mode's frequency.
    ///
    /// # Errors
    /// [`ModelError::BasisTooSmall`] for more modes than the largest basis resolves, and as [`MindlinPlate::new`].
    pub fn with_basis_for(piece: &Piece, boundary: Boundary, values: &[f64], count: usize) -> Result<Self, ModelError> {
        Self::uneven_with_basis_for((piece, boundary), values, count, &PlateTerms::default())
    }

    /// The same with terms beyond the even plate.
    ///
    /// # Errors
    /// As [`MindlinPlate::with_basis_for`].
    pub(crate) fn uneven_with_basis_for(
        (piece, boundary): (&Piece, Boundary),
        values: &[f64],
        count: usize,
        own: &PlateTerms,
    ) -> Result<Self, ModelError> {
        let mut own = own.clone();
        let mut terms = Self::terms_for_basis(piece, boundary, values, count)?;
        if let Some(support) = &mut own.spread.support {
            *support = at_most_stiffest(*support, piece, &plate_stiffnesses(piece.thickness, values)?);
            // Between none and the ideal clamp a plate has as many nodes as either.
            let free = Self::terms_for_basis(piece, boundary.released(), values, count)?;
            terms = [0, 1].map(|axis| terms[axis].max(free[axis]));
        }
        // Frequencies can do without products of many nodes both ways, the motion under a point force cannot.
        let plate = Self::uneven(piece, boundary, terms, Products::All, &own)?;
        Ok(Self { resolved_modes: plate.resolved_modes.max(count), ..plate })
    }

    /// Terms along x and y that [`MindlinPlate::with_basis_for`] has.
    ///
    /// # Errors
    /// As there.
    pub(crate) fn terms_for_basis(
        piece: &Piece,
        boundary: Boundary,
        values: &[f64],
        count: usize,
    ) -> Result<[usize; 2], ModelError> {
        let stiffnesses = plate_stiffnesses(piece.checked()?.thickness, values)?;
        Reach::new(piece, boundary, stiffnesses)?.terms(count)
    }

    /// Polynomials along x and y that follow the layers at the free edges of a plate that shears as little as solid metal,
    /// whose layers are the thinnest: for a basis that must hold before the constants are known.
    ///
    /// # Errors
    /// [`ModelError::Size`] where the piece has no physical meaning.
    pub fn layer_terms(piece: &Piece, boundary: Boundary) -> Result<[usize; 2], ModelError> {
        let thickness = piece.checked()?.thickness;
        let solid = plate_stiffnesses(thickness, &SOLID)?;
        Ok(layers(piece, ends(boundary), solid))
    }

    /// Polynomials along x and y that hold modes with so many nodes, between edges held like this, to about 1e-4 of their
    /// frequencies; layers at free edges may want more ([`MindlinPlate::layer_terms`]).
    pub fn terms_for_nodes(boundary: Boundary, nodes: [usize; 2]) -> [usize; 2] {
        let ends = ends(boundary);
        [0, 1].map(|axis| terms_for(half_waves(nodes[axis], ends[axis])))
    }

    /// Natural frequency \[Hz\] of the mode with these nodes along x and y, within a quarter or so, by one product of beam functions:
    /// with the mean squares of their slopes and curvatures, bending and shear yield one after the other. Zero for a rigid motion.
    ///
    /// # Errors
    /// [`ModelError::Size`] and what [`Structure::coefficients`](crate::Structure::coefficients) refuses of the constants.
    pub fn estimated_frequency(
        piece: &Piece,
        boundary: Boundary,
        values: &[f64],
        nodes: [usize; 2],
    ) -> Result<f64, ModelError> {
        let piece = piece.checked()?;
        let estimate = one_term(&piece, ends(boundary), plate_stiffnesses(piece.thickness, values)?, nodes);
        Ok((estimate.unwrap_or(0.0) / piece.mass_per_area).sqrt() / std::f64::consts::TAU)
    }

    /// Whether a plate with so many polynomials along x and y is small enough to be built: 80 each way at most, and no more
    /// coordinates than some 200 MB of matrices hold.
    pub fn can_have(boundary: Boundary, terms: [usize; 2]) -> bool {
        terms.iter().all(|count| *count >= TERMS[0]) && fits(ends(boundary), terms)
    }

    /// Roughly how many flexible modes lie below `frequency` \[Hz\], within a quarter or so; at most one more than a
    /// basis can resolve.
    ///
    /// # Errors
    /// As [`MindlinPlate::with_basis_for`].
    pub fn estimated_count(
        piece: &Piece,
        boundary: Boundary,
        values: &[f64],
        frequency: f64,
    ) -> Result<usize, ModelError> {
        Ok(Self::estimated_nodes(piece, boundary, values, frequency)?.len())
    }

    /// The nodes of these modes along x and y.
    ///
    /// # Errors
    /// As [`MindlinPlate::with_basis_for`].
    pub(crate) fn estimated_nodes(
        piece: &Piece,
        boundary: Boundary,
        values: &[f64],
        frequency: f64,
    ) -> Result<Vec<[usize; 2]>, ModelError> {
        let stiffnesses = plate_stiffnesses(piece.checked()?.thickness, values)?;
        let reach = Reach::new(piece, boundary, stiffnesses)?;
        let omega2 = (frequency * std::f64::consts::TAU).powi(2) * piece.mass_per_area;
        let mut below = reach.modes;
        below.retain(|(estimate, _)| *estimate <= omega2);
        below.sort_unstable_by(rising);
        Ok(below.into_iter().map(|(_, nodes)| nodes).collect())
    }
}

/// Springs under edges that are so many times as stiff as the plate over its shorter half are as good as rigid, and would leave rounding of
/// what else bends.
const STIFFEST: f64 = 1e7;

/// Springs no stiffer than that.
fn at_most_stiffest(support: Support, piece: &Piece, [d_11, d_22, ..]: &[f64; 6]) -> Support {
    let half = 0.5 * piece.length.min(piece.width);
    let most = STIFFEST * d_11.max(*d_22) * piece.width / half;
    Support { translation: support.translation.min(most / (half * half)), rotation: support.rotation.min(most) }
}

/// Isotropic constants; their size is all one.
const SOLID: [f64; 6] = [2.6e9, 2.6e9, 0.3, 1e9, 1e9, 1e9];

/// What holds the edges at the low and high end of x, then of y.
fn ends(Boundary { left, right, front, back }: Boundary) -> [[End; 2]; 2] {
    [[left, right], [front, back]]
}

/// Terms along x and y that follow the layers at free edges.
///
/// There the twisting moment of the plate without shear turns into shear force: the rotation along the edge $y = \pm b/2$ obeys
/// $D_{66}\psi_{x,yy} = A_{55}\psi_x$ and falls off with the length $\lambda = \sqrt{D_{66}/A_{55}}$, which is $t/\sqrt8$ of a
/// solid plate; at $x = \pm a/2$ it is $\sqrt{D_{66}/A_{44}}$.
fn layers(piece: &Piece, ends: [[End; 2]; 2], [_, _, _, d_66, a_55, a_44]: [f64; 6]) -> [usize; 2] {
    let halves = [0.5 * piece.length, 0.5 * piece.width];
    let lengths = [(d_66 / a_44).sqrt(), (d_66 / a_55).sqrt()];
    [0, 1].map(|axis| if ends[axis].contains(&End::Free) { terms_for_layer(lengths[axis] / halves[axis]) } else { 0 })
}

/// Polynomials that follow $e^{-(1-t)/\epsilon}$ so far that frequencies are held.
///
/// Its Legendre coefficients fall as $e^{-n^2\epsilon/2}$, and the layer holds a part of some $\epsilon$ of the energy of twisting:
/// what $n$ polynomials leave of a twisting mode's frequency is $0.9\,\epsilon\,e^{-(n-1)^2\epsilon}$, by tests of plates 10 to 1000
/// times as wide as thick. A layer that holds less needs none.
fn terms_for_layer(epsilon: f64) -> usize {
    let left_without = 0.9 * epsilon / LAYER_ERROR;
    if left_without > 1.0 { 1 + (left_without.ln() / epsilon).sqrt().ceil() as usize } else { 0 }
}

/// Part of a frequency that the layers along one direction may cost.
const LAYER_ERROR: f64 = 2.5e-5;

/// A one-term estimate of $\omega^2\rho t$ with the nodes that it is of.
type Estimate = (f64, [usize; 2]);

fn rising(a: &Estimate, b: &Estimate) -> std::cmp::Ordering {
    a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))
}

/// Nodes of the flexible modes.
struct Reach {
    modes: Vec<Estimate>,
    /// What holds the edges at the low and high end of x, then of y.
    ends: [[End; 2]; 2],
    /// Terms along x and y that the layers at free edges want.
    layers: [usize; 2],
}

/// Most nodes along one direction for which a basis is chosen.
const MOST_NODES: usize = 50;

impl Reach {
    fn new(piece: &Piece, boundary: Boundary, stiffnesses: [f64; 6]) -> Result<Self, ModelError> {
        let piece = piece.checked()?;
        let ends = ends(boundary);
        let mut modes = Vec::with_capacity((MOST_NODES + 1).pow(2));
        for nodes in (0..=MOST_NODES).flat_map(|m| (0..=MOST_NODES).map(move |n| [m, n])) {
            modes.extend(one_term(&piece, ends, stiffnesses, nodes).map(|estimate| (estimate, nodes)));
        }
        Ok(Self { modes, layers: layers(&piece, ends, stiffnesses), ends })
    }

    /// Terms along x and y for `count` modes.
    fn terms(mut self, count: usize) -> Result<[usize; 2], ModelError> {
        // The order of the estimates is rough, so look a little further.
        let margin = |count: usize| count.saturating_add(count / 10).saturating_add(1);
        // Few are wanted of two thousand and more: these alone are put in order.
        let mut lowest = std::mem::take(&mut self.modes);
        if margin(count) < lowest.len() {
            let mut limit = lowest.iter().fold(0.0, |most: f64, (estimate, _)| most.max(*estimate));
            let below = |limit: f64| lowest.iter().filter(|(estimate, _)| *estimate <= limit).count();
            while limit.is_normal() && below(0.5 * limit) >= margin(count) {
                limit *= 0.5;
            }
            lowest.retain(|(estimate, _)| *estimate <= limit);
        }
        lowest.sort_unstable_by(rising);
        lowest.truncate(margin(count));
        let mut most_nodes = [0; 2];
        let mut terms = [0; 2];
        for (index, (_, nodes)) in lowest.iter().enumerate() {
            most_nodes = [most_nodes[0].max(nodes[0]), most_nodes[1].max(nodes[1])];
            let wider = [0, 1].map(|direction| terms_for(half_waves(most_nodes[direction], self.ends[direction])));
            if !self.fits(wider) || most_nodes.contains(&MOST_NODES) {
                // No more than estimates are there: a count may be as large as numbers go.
                let available = (0..count.min(index + 1)).rev().find(|&fewer| margin(fewer) <= index).unwrap_or(0);
                return Err(ModelError::BasisTooSmall { asked: count, available });
            }
            terms = wider;
        }
        Ok(self.with_layers(terms))
    }

    /// These terms, and as many more as the layers want and the largest basis has.
    fn with_layers(&self, terms: [usize; 2]) -> [usize; 2] {
        let up_to = |most: usize| [0, 1].map(|axis| terms[axis].max(self.layers[axis].min(most)));
        let most = self.layers[0].max(self.layers[1]).min(TERMS[1]);
        (0..=most).rev().map(up_to).find(|&wider| self.fits(wider)).unwrap_or(terms)
    }

    fn fits(&self, terms: [usize; 2]) -> bool {
        fits(self.ends, terms)
    }
}

fn fits(ends: [[End; 2]; 2], [x, y]: [usize; 2]) -> bool {
    let coordinates = 3 * x * y;
    let are_followed = x.max(y) <= TERMS[1];
    let blocks: usize = ends.iter().map(|[low, high]| if low == high { 2 } else { 1 }).product();
    are_followed && coordinates * coordinates / blocks <= MOST_ENTRIES
}

/// $\omega^2\rho t$ of the product of beam functions with these nodes; `None` where it is a rigid motion.
fn one_term(piece: &Piece, ends: [[End; 2]; 2], stiffnesses: [f64; 6], [m, n]: [usize; 2]) -> Option<f64> {
    let [slope_x, curvature_x] = mean_squares(m, ends[0], piece.length);
    let [slope_y, curvature_y] = mean_squares(n, ends[1], piece.width);
    let [d_11, d_22, d_12, d_66, a_55, a_44] = stiffnesses;
    let bending = d_11 * curvature_x + d_22 * curvature_y + (2.0 * d_12 + 4.0 * d_66) * slope_x * slope_y;
    let shear = a_55 * slope_x + a_44 * slope_y;
    // Bending and shear yield one after the other.
    (bending > 0.0).then(|| 1.0 / (1.0 / bending + 1.0 / shear))
}

/// Half-waves of the beam function with `nodes` between these ends, far from them.
fn half_waves(nodes: usize, ends: [End; 2]) -> f64 {
    let added = |end: End| match end {
        End::Free => -0.75,
        End::Pinned => 0.0,
        End::Clamped => 0.25,
    };
    nodes as f64 + 1.0 + added(ends[0]) + added(ends[1])
}

/// Polynomials that hold so many half-waves to 1e-4 of their frequency, as tests/mindlin_plate_modes.rs finds.
fn terms_for(half_waves: f64) -> usize {
    (1.7 * half_waves.max(0.0) + 6.0).ceil() as usize
}

/// Mean squares of slope and curvature over the mean square of the beam function with `nodes` between these ends.
fn mean_squares(nodes: usize, ends: [End; 2], length: f64) -> [f64; 2] {
    let rigid = match ends {
        [End::Free, End::Free] => 2,
        [End::Free, End::Pinned] | [End::Pinned, End::Free] => 1,
        _ => 0,
    };
    if nodes < rigid {
        // A turn about the centre, or about the pin.
        let slope = if rigid == 1 { 3.0 } else { 12.0 };
        return [if nodes + 1 == rigid { slope / (length * length) } else { 0.0 }, 0.0];
    }
    let wave_number = half_waves(nodes, ends) * std::f64::consts::PI / length;
    [wave_number.powi(2), wave_number.powi(4)]
}
