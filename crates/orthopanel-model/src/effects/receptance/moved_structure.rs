//! A parameter with which the coordinates of a structure move, as the edges of a span do.

use std::sync::Arc;

use faer::Mat;

use super::modal_base::{Row, coordinate_rows};
use crate::structure::{Motion, Structure};
use crate::{ModelError, Place, TimoshenkoBeam};

/// The structure with one parameter $p$ moved back and forth.
///
/// With coordinates $c$ held, $\partial K/\partial p$, $\partial M/\partial p$ and the values of the coordinates in a row follow
/// from both sides by central differences. A mode's derivative then follows from these as from any other parameter's matrices,
/// without an eigenproblem on either side: within the basis that is exact, since $\Phi$ spans all of it.
#[derive(Debug, Clone)]
pub(in crate::effects) struct Moved {
    /// Position of the parameter in [`Structure::term_derivatives`].
    pub term: usize,
    sides: [Arc<TimoshenkoBeam>; 2],
    /// From the first side to the second.
    apart: f64,
}

impl Moved {
    /// `beam` with the parameter a step back and a step forth. A side on which an edge has left the beam has other
    /// coordinates: there the beam itself stands in.
    pub(in crate::effects) fn new(
        term: usize,
        step: f64,
        beam: &Arc<TimoshenkoBeam>,
        sides: [TimoshenkoBeam; 2],
    ) -> Self {
        let like = |side: &TimoshenkoBeam| {
            let sizes = |beam: &TimoshenkoBeam| beam.blocks().iter().map(|block| block.size()).collect::<Vec<_>>();
            sizes(side) == sizes(beam)
        };
        let apart = sides.iter().filter(|side| like(side)).count() as f64 * step;
        let sides = sides.map(|side| if like(&side) { Arc::new(side) } else { Arc::clone(beam) });
        // Both sides strange would leave nothing to divide by, and no difference either.
        Self { term, sides, apart: apart.max(step) }
    }

    /// $\partial K/\partial p$ and $\partial M/\partial p$ of a block, at these coefficients.
    pub(in crate::effects) fn matrices(&self, block: usize, coefficients: &[f64]) -> [Mat<f64>; 2] {
        let [back, forth] = [0, 1].map(|side: usize| &self.sides[side].blocks()[block]);
        let over = faer::Scale(self.apart.recip());
        let [[stiffness, mass], [stiffness_forth, mass_forth]] =
            [back, forth].map(|side| [side.stiffness_at(coefficients).to_dense(), side.mass.to_dense()]);
        [over * (stiffness_forth - stiffness), over * (mass_forth - mass)]
    }

    /// How the coordinates' values in some rows change with the parameter.
    ///
    /// # Errors
    /// [`ModelError::Unsupported`] for a row that the structure does not have.
    pub(in crate::effects) fn rows(&self, block: usize, rows: &[Row]) -> Result<Mat<f64>, ModelError> {
        let size = self.sides[0].blocks()[block].size();
        let [back, forth] = &self.sides;
        let of = |side: &TimoshenkoBeam| coordinate_rows(side, (block, size), rows);
        Ok(faer::Scale(self.apart.recip()) * (of(forth)? - of(back)?))
    }

    /// How the static flexibility between two motions changes with the parameter.
    pub(in crate::effects) fn static_flexibility(&self, values: &[f64], motions: [(Motion, Place); 2]) -> Option<f64> {
        let [back, forth] = &self.sides;
        let of = |side: &TimoshenkoBeam| Some(side.static_flexibility(values, motions)?.value);
        Some((of(forth)? - of(back)?) / self.apart)
    }

    /// How [`Structure::inertial_remainders`] change with the parameter.
    pub(in crate::effects) fn inertial_remainders(&self, values: &[f64], rows: &[Row], columns: usize) -> Vec<f64> {
        let [back, forth] = [0, 1].map(|side: usize| self.sides[side].inertial_remainders(values, rows, columns));
        forth.iter().zip(&back).map(|(forth, back)| (forth.value - back.value) / self.apart).collect()
    }
}
