//! The shapes that modes of a plate are named by, at places.

use super::mode_names::slender_beam;
use crate::legendre::gauss_legendre;
use crate::{Boundary, ModelError, Piece, Place};

/// Points along a side beyond the most nodes of a name: a mode that has more of them is no other's likeness.
const SPARE: usize = 6;

/// Products $f_mg_n$ of beam functions, as [`ModeName`](super::ModeName) has them, at Gauss points over the plate. What deflects there as
/// $\phi$ has of a product the share
/// $$\frac{\left(\int\phi f_mg_n\,dx\,dy\right)^2}{\int\phi^2\,dx\,dy\int f_m^2g_n^2\,dx\,dy},$$
/// the square of the overlap.
#[derive(Debug, Clone, Default)]
pub struct NamedShapes {
    places: Vec<Place>,
    weights: Vec<f64>,
    shapes: Vec<Option<Vec<f64>>>,
}

impl NamedShapes {
    /// Of these nodal lines across x and across y, `None` where none are told.
    ///
    /// # Errors
    /// [`ModelError::Size`] where length or width has no physical meaning.
    pub fn new(piece: &Piece, boundary: Boundary, nodes: &[Option<[usize; 2]>]) -> Result<Self, ModelError> {
        let Some(most) = nodes.iter().flatten().copied().reduce(|a, b| [a[0].max(b[0]), a[1].max(b[1])]) else {
            return Ok(Self { shapes: vec![None; nodes.len()], ..Self::default() });
        };
        let side = |length: f64, ends, most: usize| {
            let rule = gauss_legendre(most + SPARE);
            let beam = slender_beam(length, ends)?;
            let functions = beam.modes(most + 1);
            let value = |function: &crate::BeamMode, t: f64| function.deflection(0.5 * length * t);
            let of_node = |n: usize| rule.iter().map(|(t, _)| value(&functions[n], *t)).collect::<Vec<f64>>();
            Ok::<_, ModelError>(((0..=most).map(of_node).collect::<Vec<_>>(), rule))
        };
        let (along, of_x) = side(piece.length, [boundary.left, boundary.right], most[0])?;
        let (across, of_y) = side(piece.width, [boundary.front, boundary.back], most[1])?;
        let pairs = || (0..of_x.len()).flat_map(|i| (0..of_y.len()).map(move |j| (i, j)));
        let place =
            |(i, j): (usize, usize)| Place { x: 0.5 * piece.length * of_x[i].0, y: 0.5 * piece.width * of_y[j].0 };
        let product = |[x, y]: [usize; 2]| pairs().map(|(i, j)| along[x][i] * across[y][j]).collect();
        Ok(Self {
            places: pairs().map(place).collect(),
            weights: pairs().map(|(i, j)| of_x[i].1 * of_y[j].1).collect(),
            shapes: nodes.iter().map(|nodes| nodes.map(product)).collect(),
        })
    }

    /// The Gauss points; none where no shape is named.
    pub fn places(&self) -> &[Place] {
        &self.places
    }

    /// What deflections at the places have of a named shape, 0 to 1; `None` where it has no name.
    pub fn share(&self, number: usize, deflection: &[f64]) -> Option<f64> {
        let shape = self.shapes.get(number)?.as_ref().filter(|shape| shape.len() == deflection.len())?;
        let (mut dot, mut own, mut other) = (0.0, 0.0, 0.0);
        for ((weight, a), b) in self.weights.iter().zip(shape).zip(deflection) {
            dot += weight * a * b;
            own += weight * a * a;
            other += weight * b * b;
        }
        Some(if own * other > 0.0 { dot * dot / (own * other) } else { 0.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{MindlinPlate, Structure, ritz_modes};

    /// By the integrals over the plate's own basis, free and with an edge clamped.
    #[test]
    fn val_shares_are_the_squares_of_overlaps() {
        let piece = Piece { length: 0.58, width: 0.22, thickness: 0.005, mass_per_area: 2.1 };
        let values = [1.1e10, 0.95e9, 0.35, 7.5e8, 8e8, 1e9];
        let clamped = Boundary { left: crate::End::Clamped, ..Boundary::FREE };
        for boundary in [Boundary::FREE, clamped] {
            let plate = MindlinPlate::with_basis_for(&piece, boundary, &values, 14).unwrap();
            let modes = ritz_modes(&plate, &values, 14).unwrap();
            let flexible: Vec<_> = modes.iter().filter(|mode| mode.angular_frequency > 0.0).take(12).collect();
            let names: Vec<_> = flexible.iter().map(|mode| Some(plate.mode_name(mode).nodes)).collect();
            let named = NamedShapes::new(&piece, boundary, &names).unwrap();
            for (number, mode) in flexible.iter().enumerate() {
                let at = |place: &Place| {
                    let row = plate.shape_row(mode.block, *place);
                    row.iter().zip(&mode.coordinates).map(|(a, b)| a * b).sum::<f64>()
                };
                let deflection: Vec<f64> = named.places().iter().map(at).collect();
                let (share, overlap) = (named.share(number, &deflection).unwrap(), plate.mode_name(mode).overlap);
                assert!((share - overlap * overlap).abs() < 1e-3, "{boundary:?} {number}: {share} {overlap}");
            }
        }
    }
}
