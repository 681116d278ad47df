//! The lowest modes of a block without solving for all of them: block Lanczos on the inverted problem.
//!
//! Reference: G. H. Golub and R. Underwood, The block Lanczos method for computing eigenvalues, in Mathematical Software
//! III (1977) 361. All vectors are kept and orthogonalised twice, so no eigenvalue returns as a ghost.

use faer::Mat;

use crate::block_pencil::{BlockPencil, Eigenpair};
use crate::dense::{dot, symmetric_eigen};
use crate::skyline::add;
use crate::wide::wide;

/// Residual, over its eigenvalue, at which a vector has converged: its frequency is then exact to rounding.
const CONVERGED: f64 = 1e-8;
/// Residual at which a vector that began near its mode has converged: an eigenvalue errs by its square.
const NEARLY_CONVERGED: f64 = 1e-6;
/// What a step takes off a residual, on the quick side: of one vector, of more.
const GAIN: [f64; 2] = [6.0, 15.0];

/// Vectors that hold all of an image but rounding's share, where the space grows by one vector a step.
const LARGE_SHARES: usize = 2;
/// A pass over all vectors that leaves less of a vector than this was not the last.
const KEPT: f64 = 0.7;

/// The Krylov space of a block, which grows until the modes asked for have converged.
pub(crate) struct BlockKrylov {
    /// Orthonormal: the rigid modes, the space, and what it grows by next.
    vectors: Vec<Vec<f64>>,
    rigid: usize,
    /// Shares of $A$ times each vector of the space in the vectors behind the rigid ones.
    images: Vec<Vec<f64>>,
    /// Residual at which a vector has converged.
    least: f64,
    /// Largest first: the eigenvalues of the projection, and their vectors as columns.
    thetas: Vec<f64>,
    directions: Mat<f64>,
    converged: usize,
}

impl BlockKrylov {
    /// From as many vectors without preference as `width`: of modes that coincide no more are found.
    pub(crate) fn new(pencil: &BlockPencil<'_>, width: usize) -> Self {
        Self::from_vectors(pencil, start(pencil.size(), width), CONVERGED)
    }

    fn from_vectors(pencil: &BlockPencil<'_>, start: Vec<Vec<f64>>, least: f64) -> Self {
        let vectors = pencil.rigid_vectors();
        let (rigid, images) = (vectors.len(), Vec::new());
        let (thetas, directions, converged) = (Vec::new(), Mat::new(), 0);
        let mut space = Self { vectors, rigid, images, least, thetas, directions, converged };
        for vector in start {
            space.join(vector);
        }
        space
    }

    /// How many of the lowest flexible modes have converged.
    pub(crate) fn converged(&self) -> usize {
        self.converged
    }

    /// $\omega^2$ of the lowest flexible modes, rising: those that have converged, then others from above.
    pub(crate) fn omega2s(&self, pencil: &BlockPencil<'_>) -> impl Iterator<Item = f64> {
        self.thetas.iter().take_while(|theta| **theta > 0.0).map(|&theta| pencil.omega2(theta))
    }

    /// How many modes with $\omega^2$ below `limit` have converged.
    pub(crate) fn known_below(&self, pencil: &BlockPencil<'_>, limit: f64) -> usize {
        self.omega2s(pencil).take(self.converged).filter(|omega2| *omega2 < limit).count()
    }

    /// The lowest `count` flexible modes, rising, as far as they have converged.
    pub(crate) fn modes(&self, pencil: &BlockPencil<'_>, count: usize) -> Vec<Eigenpair> {
        let mode = |m: usize| {
            let mut shape = vec![0.0; pencil.size()];
            let shares = self.directions.col_as_slice(self.thetas.len() - 1 - m);
            shares.iter().zip(&self.vectors[self.rigid..]).for_each(|(&share, vector)| add(&mut shape, share, vector));
            pencil.mode(self.thetas[m], shape)
        };
        (0..self.converged.min(count)).map(mode).collect()
    }

    /// Grows until the lowest `wanted` flexible modes have converged; whether they have before a dense solution is cheaper.
    pub(crate) fn grow(&mut self, pencil: &BlockPencil<'_>, wanted: usize) -> bool {
        let capacity = pencil.size() - self.rigid;
        let mut look_at = likely(wanted).max(self.images.len() + 1);
        while self.converged < wanted {
            let last = self.vectors.len() - self.rigid;
            if 2 * self.images.len() >= capacity || 2 * wanted > capacity || last == self.images.len() {
                return false;
            }
            let width = last - self.images.len();
            for own in self.images.len()..last {
                let image = pencil.apply(&self.vectors[self.rigid + own]);
                let shares = self.join(image);
                self.images.push(shares);
            }
            // The projection costs more than a step: look only where convergence is likely.
            let is_whole = self.vectors.len() - self.rigid == self.images.len();
            if self.images.len() >= look_at || is_whole {
                let Some(worst) = self.look(wanted) else { return false };
                let gain = GAIN[usize::from(width > 1)];
                let steps = ((worst / self.least).ln() / gain.ln()).ceil().max(1.0);
                look_at = self.images.len() + width * steps.min(wanted as f64) as usize;
            }
        }
        true
    }

    /// Takes in what of a vector lies outside the space, if anything does; its shares in the vectors behind the rigid ones.
    fn join(&mut self, mut vector: Vec<f64>) -> Vec<f64> {
        let before = dot(&vector, &vector).sqrt();
        let mut shares = vec![0.0; self.vectors.len()];
        // Nearly all of an image lies in the last vectors: with that gone, one more time over all takes rounding's share out.
        let last = self.vectors.len().saturating_sub(LARGE_SHARES);
        let mut left = self.take_out(&mut vector, &mut shares, last);
        let mut after = self.take_out(&mut vector, &mut shares, 0);
        while after < KEPT * left && after > 1e-12 * before {
            left = after;
            after = self.take_out(&mut vector, &mut shares, 0);
        }
        let mut shares = shares.split_off(self.rigid);
        if after > 1e-12 * before {
            vector.iter_mut().for_each(|value| *value /= after);
            self.vectors.push(vector);
            shares.push(after);
        }
        shares
    }

    /// Takes the shares of the vectors from one on out of a vector, and adds them to `shares`; the norm of what is left.
    fn take_out(&self, vector: &mut [f64], shares: &mut [f64], from: usize) -> f64 {
        let vectors = &self.vectors[from..];
        let shares = &mut shares[from..];
        wide!(|vectors: &'a [Vec<f64>], vector: &'a mut [f64], shares: &'a mut [f64]| -> f64 {
            for (sum, other) in shares.iter_mut().zip(vectors) {
                let share = dot(other, vector);
                *sum += share;
                add(vector, -share, other);
            }
            dot(vector, vector).sqrt()
        })
    }

    /// Counts the modes that have converged; the largest residual of the lowest `wanted`.
    fn look(&mut self, wanted: usize) -> Option<f64> {
        let found = self.images.len();
        // Beyond what A times an earlier vector reaches stands rounding alone: left out, the eigenproblem is banded.
        let entry = |low: usize, high: usize| if high < self.images[low].len() { self.images[high][low] } else { 0.0 };
        let projection = Mat::from_fn(found, found, |i, j| entry(i.min(j), i.max(j)));
        let (thetas, directions) = symmetric_eigen(&projection)?;
        self.thetas = thetas.into_iter().rev().collect();
        self.directions = directions;
        // What A times the space adds lies in the vectors that it grows by next.
        let residual = |m: usize| {
            let mut outside = vec![0.0; self.vectors.len() - self.rigid - found];
            for (image, share) in self.images.iter().zip(self.directions.col_as_slice(found - 1 - m)) {
                add(&mut outside, *share, image.get(found..).unwrap_or_default());
            }
            dot(&outside, &outside).sqrt() / self.thetas[m]
        };
        let residuals: Vec<f64> = (0..found).map(residual).collect();
        self.converged = residuals.iter().take_while(|residual| **residual <= self.least).count();
        Some(residuals.into_iter().take(wanted).fold(0.0, f64::max))
    }
}

/// Vectors from which on so many modes are likely to have converged, where nothing is known.
fn likely(wanted: usize) -> usize {
    2 * wanted + 10
}

/// The lowest `wanted` flexible modes, rising, from shapes that nearly are some more of them; their frequencies are exact
/// to rounding, their shapes to some 1e-6.
pub(crate) fn lowest_modes_near(pencil: &BlockPencil<'_>, wanted: usize, shapes: &[&[f64]]) -> Option<Vec<Eigenpair>> {
    if wanted > shapes.len() {
        return None;
    }
    if wanted == 0 {
        return Some(Vec::new());
    }
    let mut krylov = BlockKrylov::from_vectors(pencil, pencil.unit_vectors(shapes), NEARLY_CONVERGED);
    krylov.grow(pencil, wanted).then(|| krylov.modes(pencil, wanted))
}

/// Vectors without preference for any coordinate, the same in every run.
fn start(size: usize, width: usize) -> Vec<Vec<f64>> {
    // Multiples of the golden ratio, modulo one, fall evenly.
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let value = |i: usize, j: usize| (golden * (1 + i * width + j) as f64).fract() - 0.5;
    (0..width).map(|j| (0..size).map(|i| value(i, j)).collect()).collect()
}
