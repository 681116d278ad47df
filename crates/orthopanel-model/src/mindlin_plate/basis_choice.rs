//! How many polynomials a plate needs: from the nodes that its lowest modes have in each direction.

use super::law::plate_stiffnesses;
use super::{MindlinPlate, PlateTerms};
use crate::{Boundary, End, ModelError, Piece};

/// Most entries of one matrix of all blocks together: 1.8 million keep a plate below 100 MB.
const MOST_ENTRIES: usize = 1_800_000;

/// Isotropic, with bending stiffness one and as good as no shear strain.
const EQUAL_STIFFNESSES: [f64; 6] = [1.0, 1.0, 0.3, 0.35, 1e30, 1e30];

impl MindlinPlate {
    /// A plate whose basis holds its first `count` flexible modes to about 1e-4 of their frequencies, chosen for equal
    /// stiffness along x and y.
    ///
    /// # Errors
    /// As [`MindlinPlate::with_basis_for`].
    pub fn with_default_basis(piece: &Piece, boundary: Boundary, count: usize) -> Result<Self, ModelError> {
        let terms = Reach::new(piece, boundary, EQUAL_STIFFNESSES)?.terms(count)?;
        let plate = Self::new(piece, boundary, terms)?;
        Ok(Self { resolved_modes: plate.resolved_modes.max(count), ..plate })
    }

    /// A plate whose basis holds its first `count` flexible modes to about 1e-4 of their frequencies at these values of
    /// the constants (order of [`PLATE_CONSTANTS`](crate::PLATE_CONSTANTS)).
    ///
    /// Limits: free edges of plates about a hundred times as wide as thick carry a twisting layer as thin as the
    /// thickness, which costs up to 1e-3 in the basis chosen here.
    ///
    /// # Errors
    /// [`ModelError::BasisTooSmall`] for more modes than the largest basis resolves, and as [`MindlinPlate::new`].
    pub fn with_basis_for(piece: &Piece, boundary: Boundary, values: &[f64], count: usize) -> Result<Self, ModelError> {
        Self::uneven_with_basis_for((piece, boundary), values, count, &PlateTerms::default())
    }

    /// The same with terms beyond the even plate.
    ///
    /// # Errors
    /// As [`MindlinPlate::with_basis_for`], and [`ModelError::Unsupported`] for supports that yield.
    pub(crate) fn uneven_with_basis_for(
        (piece, boundary): (&Piece, Boundary),
        values: &[f64],
        count: usize,
        own: &PlateTerms,
    ) -> Result<Self, ModelError> {
        let stiffnesses = plate_stiffnesses(piece.checked()?.thickness, values)?;
        let plate = Self::uneven(piece, boundary, Reach::new(piece, boundary, stiffnesses)?.terms(count)?, own)?;
        Ok(Self { resolved_modes: plate.resolved_modes.max(count), ..plate })
    }

    /// Roughly how many flexible modes lie below `frequency` \[Hz\], within a quarter or so; at most one more than a
    /// basis can resolve.
    ///
    /// # Errors
    /// As [`MindlinPlate::with_basis_for`].
    pub(crate) fn estimated_count(
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
        Ok(reach.modes.into_iter().take_while(|(estimate, _)| *estimate <= omega2).map(|(_, nodes)| nodes).collect())
    }
}

/// Nodes of the flexible modes, in rising order of a one-term estimate of $\omega^2\rho t$.
struct Reach {
    modes: Vec<(f64, [usize; 2])>,
    /// What holds the edges at the low and high end of x, then of y.
    ends: [[End; 2]; 2],
}

/// Most nodes along one direction for which a basis is chosen.
const MOST_NODES: usize = 50;

impl Reach {
    fn new(piece: &Piece, boundary: Boundary, stiffnesses: [f64; 6]) -> Result<Self, ModelError> {
        let piece = piece.checked()?;
        let Boundary { left, right, front, back } = boundary;
        let along_x: Vec<_> = (0..=MOST_NODES).map(|m| mean_squares(m, [left, right], piece.length)).collect();
        let along_y: Vec<_> = (0..=MOST_NODES).map(|n| mean_squares(n, [front, back], piece.width)).collect();
        let [d_11, d_22, d_12, d_66, a_55, a_44] = stiffnesses;
        let mut modes = Vec::with_capacity(along_x.len() * along_y.len());
        for (m, [slope_x, curvature_x]) in along_x.iter().enumerate() {
            for (n, [slope_y, curvature_y]) in along_y.iter().enumerate() {
                let bending = d_11 * curvature_x + d_22 * curvature_y + (2.0 * d_12 + 4.0 * d_66) * slope_x * slope_y;
                let shear = a_55 * slope_x + a_44 * slope_y;
                // Bending and shear yield one after the other.
                if bending > 0.0 {
                    modes.push((1.0 / (1.0 / bending + 1.0 / shear), [m, n]));
                }
            }
        }
        modes.sort_by(|a, b| a.0.total_cmp(&b.0));
        Ok(Self { modes, ends: [[left, right], [front, back]] })
    }

    /// Terms along x and y for `count` modes.
    fn terms(&self, count: usize) -> Result<[usize; 2], ModelError> {
        // The order of the estimates is rough, so look a little further.
        let margin = |count: usize| count + count / 10 + 1;
        let mut most_nodes = [0; 2];
        let mut terms = [0; 2];
        for (index, (_, nodes)) in self.modes.iter().take(margin(count)).enumerate() {
            most_nodes = [most_nodes[0].max(nodes[0]), most_nodes[1].max(nodes[1])];
            let wider = [0, 1].map(|direction| terms_for(half_waves(most_nodes[direction], self.ends[direction])));
            if !self.fits(wider) || most_nodes.contains(&MOST_NODES) {
                let available = (0..count).rev().find(|&fewer| margin(fewer) <= index).unwrap_or(0);
                return Err(ModelError::BasisTooSmall { asked: count, available });
            }
            terms = wider;
        }
        Ok(terms)
    }

    fn fits(&self, [x, y]: [usize; 2]) -> bool {
        let coordinates = 3 * x * y;
        let blocks: usize = self.ends.iter().map(|[low, high]| if low == high { 2 } else { 1 }).product();
        coordinates * coordinates / blocks <= MOST_ENTRIES
    }
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
