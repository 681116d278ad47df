//! What a cut series of shear strain lacks of how the beam's own inertia answers a force.
//!
//! At a unit force the shear force falls by one, and with it the strain: its Legendre series
//! $$\gamma = \sum_n g_nP_n(t),\qquad g_n = \frac{P_{n+1}(t_a)-P_{n-1}(t_a)}{2S}$$
//! falls no faster than $n^{-1/2}$, where the basis ends at $n = N$. The deflection that this strain makes has the coefficients
//! $w_j = h\,(g_{j-1}/(2j-1) - g_{j+1}/(2j+3))$, and the sum over all modes
//! $$\sum_m\frac{\phi_m(a)\phi_m(b)}{\omega_m^4} = \int\rho A\,w_aw_b\,dx + \int\rho I\,\psi_a\psi_b\,dx$$
//! of the static deflections $w_a$, $w_b$ lacks $\rho Ah\sum_j\frac2{2j+1}(w_jw_j'-\hat w_j\hat w_j')$, the hat being what the basis
//! has. That falls as $N^{-3}$ at the driving point. What the series of the curvature lacks falls by $N^{-2}$ more and is left out
//! (5 % at 40 terms, for a piece 27 times as long as thick), as are the rotation's part and the next power of frequency.

use std::sync::{Arc, Mutex};

use super::Section;
use super::beam_terms::ShearLoss;
use super::strain_basis::{JUMPS, is_inside};
use crate::dense::dot_of_common;
use crate::legendre::{legendre, norm};
use crate::structure::Motion;

/// The series is followed to so many times the basis: what is left of a sum that falls as $n^{-3}$ is 0.2 %.
const FOLLOWED: usize = 8;

/// Strains that make every deflection of the terms that the basis has.
const HELD: usize = 4;

/// What a unit load strains: the deflection by $G_{zx}$ times its strain from term $N-1$ on, and what the basis has of it.
#[derive(Debug)]
pub(super) struct Unheld {
    whole: Vec<f64>,
    held: Vec<f64>,
    /// Both times $\int P_n^2\,dt$.
    weighted: [Vec<f64>; 2],
}

/// A motion at a place, with what a unit load on it strains.
type KnownLoad = (Motion, f64, Arc<Unheld>);
/// Loads that are kept: a test's records share their places, and a search comes back to them.
const KEPT: usize = 64;

#[derive(Debug, Clone)]
pub(super) struct InertialRemainder {
    half_length: f64,
    section: Section,
    /// Terms of the shear strain in the basis.
    order: usize,
    losses: Vec<ShearLoss>,
    /// The strains that begin at an edge, as far as they are not in the terms: orthonormal, from [`Self::order`] on.
    steps: Vec<Vec<f64>>,
    /// The latest loads.
    known: Arc<Mutex<Vec<KnownLoad>>>,
}

impl InertialRemainder {
    pub(super) fn new(half_length: f64, section: Section, order: usize, losses: &[ShearLoss]) -> Self {
        let (losses, known) = (losses.to_vec(), Arc::default());
        let mut remainder = Self { half_length, section, order, losses, steps: vec![], known };
        let edges = remainder.losses.iter().flat_map(|loss| loss.edges(half_length)).map(|x| x / half_length);
        for edge in edges.filter(|t| is_inside(*t)).collect::<Vec<_>>() {
            remainder.add_steps_at(edge);
        }
        remainder
    }

    /// Number of the last term that is followed.
    fn last(&self) -> usize {
        FOLLOWED * self.order
    }

    /// What a unit load on a motion strains that the basis does not follow; nothing for other motions than deflection and slope.
    pub(super) fn unheld(&self, motion: Motion, x: f64) -> Arc<Unheld> {
        let known = |loads: &Vec<KnownLoad>| {
            loads.iter().find(|load| (load.0, load.1) == (motion, x)).map(|load| Arc::clone(&load.2))
        };
        // A lock that a panic has poisoned only costs the repetition.
        if let Some(load) = self.known.lock().ok().and_then(|loads| known(&loads)) {
            return load;
        }
        let load = Arc::new(self.unheld_anew(motion, x));
        if let Ok(mut loads) = self.known.lock() {
            loads.truncate(KEPT - 1);
            loads.insert(0, (motion, x, Arc::clone(&load)));
        }
        load
    }

    fn unheld_anew(&self, motion: Motion, x: f64) -> Unheld {
        let strains = self.strains(motion, x);
        let [whole, held] = strains
            .map_or([vec![], vec![]], |strains| [self.deflections(&strains), self.deflections(&self.held(&strains))]);
        let weigh = |(i, value): (usize, &f64)| norm(self.order - 1 + i) * value;
        let weighted = [&whole, &held].map(|values| values.iter().enumerate().map(weigh).collect());
        Unheld { whole, held, weighted }
    }

    /// Between two unit loads, times $G_{zx}^2$. Not asked between two slopes, where the sum has no end.
    pub(super) fn between(&self, a: &Unheld, b: &Unheld) -> f64 {
        let [whole, held] = &a.weighted;
        self.section.mass * self.half_length * (dot_of_common(whole, &b.whole) - dot_of_common(held, &b.held))
    }

    /// $g_n$ from $n = N-2$ on, times $G_{zx}$; of a slope their derivatives by the place.
    fn strains(&self, motion: Motion, x: f64) -> Option<Vec<f64>> {
        let t = x / self.half_length;
        let values = legendre(self.last() + 2, t);
        let g = |n: usize| match motion {
            Motion::Deflection | Motion::Foot => Some(0.5 * (values[n + 1] - values[n - 1])),
            Motion::Slope => Some((n as f64 + 0.5) * values[n] / self.half_length),
            Motion::Rotation | Motion::Curvature | Motion::SlopeAcross | Motion::Shear(_) => None,
        };
        let lost: f64 = self.losses.iter().filter(|loss| loss.holds(x, self.half_length)).map(|loss| loss.loss).sum();
        let stiffness = self.section.shear_area * (1.0 - lost);
        (self.order - 2..=self.last()).map(|n| Some(g(n)? / stiffness)).collect()
    }

    /// What the basis holds of them: its terms, and of the others the share of the strains that begin at an edge.
    fn held(&self, strains: &[f64]) -> Vec<f64> {
        let mut held: Vec<f64> = strains.iter().enumerate().map(|(i, g)| if i < 2 { *g } else { 0.0 }).collect();
        if self.steps.is_empty() {
            // Two terms' deflections reach no further.
            held.truncate(HELD);
        }
        for step in &self.steps {
            let share = self.product(step, &strains[2..]);
            held[2..].iter_mut().zip(step).for_each(|(sum, value)| *sum += share * value);
        }
        held
    }

    /// $w_j$ from $j = N-1$ on.
    fn deflections(&self, strains: &[f64]) -> Vec<f64> {
        let pairs = strains.iter().zip(&strains[2..]).enumerate();
        let w = |(i, (before, after)): (usize, (&f64, &f64))| {
            let j = (self.order - 1 + i) as f64;
            self.half_length * (before / (2.0 * j - 1.0) - after / (2.0 * j + 3.0))
        };
        pairs.map(w).collect()
    }

    /// $\int\gamma\gamma'\,dt$ of two series from $n = N$ on.
    fn product(&self, a: &[f64], b: &[f64]) -> f64 {
        a.iter().zip(b).enumerate().map(|(i, (a, b))| norm(self.order + i) * a * b).sum()
    }

    fn add_steps_at(&mut self, edge: f64) {
        let count = self.last() + 1 + JUMPS as usize;
        let values = legendre(count + 1, edge);
        let mut strain: Vec<f64> =
            (0..count).map(|n| if n == 0 { 0.0 } else { 0.5 * (values[n - 1] - values[n + 1]) }).collect();
        for _ in 0..JUMPS {
            let mut step = strain[self.order..=self.last()].to_vec();
            let whole = self.product(&step, &step).sqrt();
            // Twice, for rounding.
            for other in self.steps.iter().chain(&self.steps) {
                let share = self.product(other, &step);
                step.iter_mut().zip(other).for_each(|(value, other)| *value -= share * other);
            }
            let size = self.product(&step, &step).sqrt();
            if size > 1e-7 * whole {
                step.iter_mut().for_each(|value| *value /= size);
                self.steps.push(step);
            }
            // The next strain is the integral of this one.
            let at = |n: usize| strain.get(n).map_or(0.0, |g| g / (2 * n + 1) as f64);
            strain = (0..count).map(|n| if n == 0 { 0.0 } else { at(n - 1) - at(n + 1) }).collect();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ritz_modes::all_ritz_modes;
    use crate::structure::Structure;
    use crate::{BeamTerms, Boundary, Piece, Place, TimoshenkoBeam};

    const VALUES: [f64; 2] = [1.07e10, 5.36e8];

    /// $\sum\phi_a\phi_b/\omega^4$ as a basis has it.
    fn in_basis(beam: &TimoshenkoBeam, [a, b]: [f64; 2]) -> f64 {
        let at = |block: usize, x: f64, shape: &[f64]| -> f64 {
            beam.shape_row(block, Place { x, y: 0.0 }).iter().zip(shape).map(|(row, share)| row * share).sum()
        };
        let modes = all_ritz_modes(beam, &VALUES).unwrap();
        let flexible = modes.iter().filter(|mode| mode.angular_frequency > 0.0);
        flexible
            .map(|mode| {
                at(mode.block, a, &mode.coordinates) * at(mode.block, b, &mode.coordinates)
                    / mode.angular_frequency.powi(4)
            })
            .sum()
    }

    /// The basis of 40 terms against one of 240: at the driving point, at two places, beside an edge and inside a disbond. What
    /// the curvature lacks is some 5 % of what an even beam's basis does, and no strain that begins at an edge mends that.
    #[test]
    fn val_a_larger_basis_has_what_the_smaller_lacks() {
        let piece = Piece { length: 0.8, width: 0.1, thickness: 0.03, mass_per_area: 6.88 };
        let loss = |loss: f64, at: f64| vec![ShearLoss { loss, span: 0.1, at }];
        let cases = [
            (vec![], [0.3, 0.3]),
            (vec![], [0.11, 0.11]),
            (vec![], [0.3, 0.31]),
            (loss(0.0, 0.355), [0.3, 0.3]),
            (loss(0.0, 0.2), [0.3, 0.3]),
            (loss(0.6, 0.3), [0.3, 0.3]),
            (loss(0.6, 0.1), [0.3, 0.3]),
        ];
        for (losses, at) in cases {
            let terms = BeamTerms { losses: losses.clone(), ..BeamTerms::default() };
            let beam = |order| TimoshenkoBeam::with_terms(&piece, Boundary::default(), order, terms.clone()).unwrap();
            let small = beam(40);
            let expected = in_basis(&beam(240), at) - in_basis(&small, at);
            let rows = at.map(|x| (Motion::Deflection, Place { x, y: 0.0 }));
            let lacking = |beam: &TimoshenkoBeam| beam.inertial_remainders(&VALUES, [&rows; 2])[0][(0, 1)];
            let (found, even) =
                (lacking(&small), lacking(&TimoshenkoBeam::new(&piece, Boundary::default(), 40).unwrap()));
            // Under a loss the basis projects in the energy of what is left, which the closed form does not follow.
            let by_loss = if losses.iter().any(|loss| loss.loss > 0.0) { 0.1 * expected.abs() } else { 0.0 };
            assert!(
                (found - expected).abs() < 0.06 * even.abs() + by_loss,
                "{losses:?} {at:?}: {found:e}, {expected:e} of {even:e}"
            );
        }
    }

    #[test]
    fn val_a_slope_is_the_derivative_by_the_place() {
        let piece = Piece { length: 0.8, width: 0.1, thickness: 0.03, mass_per_area: 6.88 };
        let beam = TimoshenkoBeam::new(&piece, Boundary::default(), 40).unwrap();
        let at = |motion: Motion, x: f64| {
            let rows = [(Motion::Deflection, 0.3), (motion, x)].map(|(motion, x)| (motion, Place { x, y: 0.0 }));
            beam.inertial_remainders(&VALUES, [&rows; 2])[0][(1, 0)]
        };
        let step = 1e-5;
        let difference = (at(Motion::Deflection, 0.29 + step) - at(Motion::Deflection, 0.29 - step)) / (2.0 * step);
        assert!((at(Motion::Slope, 0.29) / difference - 1.0).abs() < 1e-3);
    }
}
