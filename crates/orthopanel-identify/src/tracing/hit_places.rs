//! By how much each hit of a record missed the place of the others.

use num_complex::Complex64;

use super::hit_noise::HitNoise;
use super::widened_lines::HitSpectra;

/// The weights of the lines follow from the noise that is left: once more with those.
const PASSES: usize = 2;

/// Brings all hits of a record to the place that they hit in the mean, and tells by how much each was beside that \[m\].
///
/// Of hits $h$ at places $\bar x + \delta_h$ the accelerances are $\bar H + \delta_h\,\partial H/\partial x$ to first order, so
/// $\delta_h$ is a least-squares fit of one number over all lines. `by_place` is $\partial H/\partial x$ on the lines from 0 up,
/// by a model: an error of a few per cent of it leaves as much of what the hits scattered by. `taken` is what forces that are not
/// linear take off the accelerance of each hit, on the same lines, or nothing: hits of unequal strength differ by that too.
pub(super) fn align(hits: &mut [HitSpectra], (by_place, taken): (&[Complex64], &[Vec<Complex64>])) -> Vec<f64> {
    let mut beside = vec![0.0; hits.len()];
    give_back(hits, taken, 1.0);
    for _ in 0..PASSES {
        let noise = HitNoise::of(hits, by_place.len());
        let mut sums = vec![[0.0, f64::MIN_POSITIVE]; hits.len()];
        for (line, slope) in by_place.iter().enumerate().skip(1) {
            let weights: Vec<f64> = hits
                .iter()
                .enumerate()
                .map(|(index, hit)| {
                    let (force, motion) = (hit.force[line], hit.motion[line]);
                    force.norm_sqr() / noise.at(index, force, motion)[0].max(f64::MIN_POSITIVE)
                })
                .collect();
            let values: Vec<Complex64> = hits.iter().map(|hit| hit.motion[line] / hit.force[line]).collect();
            let total: f64 = weights.iter().sum();
            let mean = values.iter().zip(&weights).map(|(value, weight)| value * weight).sum::<Complex64>() / total;
            if !mean.is_finite() {
                continue;
            }
            for ((sum, value), weight) in sums.iter_mut().zip(&values).zip(&weights) {
                sum[0] += weight * (slope.conj() * (value - mean)).re;
                sum[1] += weight * slope.norm_sqr();
            }
        }
        let found: Vec<f64> = sums.iter().map(|[product, square]| product / square).collect();
        let middle = found.iter().sum::<f64>() / found.len().max(1) as f64;
        for ((hit, found), beside) in hits.iter_mut().zip(&found).zip(&mut beside) {
            let own = found - middle;
            *beside += own;
            for (line, slope) in by_place.iter().enumerate() {
                hit.motion[line] -= own * slope * hit.force[line];
            }
        }
    }
    give_back(hits, taken, -1.0);
    beside
}

/// Adds `sign` times what was taken off.
fn give_back(hits: &mut [HitSpectra], taken: &[Vec<Complex64>], sign: f64) {
    for (hit, taken) in hits.iter_mut().zip(taken) {
        for ((motion, force), taken) in hit.motion.iter_mut().zip(&hit.force).zip(taken) {
            *motion += sign * taken * force;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LINES: usize = 400;
    const AWAY: [f64; 3] = [1e-3, -0.4e-3, -0.6e-3];

    fn at(line: usize) -> Complex64 {
        Complex64::new((0.05 * line as f64).sin() + 1.5, (0.03 * line as f64).cos())
    }

    fn slopes() -> Vec<Complex64> {
        (0..LINES).map(|line| Complex64::new(0.0, 7.0) * at(line) + 3.0).collect()
    }

    /// Three hits of different strength on one made-up accelerance, each its own way beside the place, less what is `taken` off.
    fn hits(slope: &[Complex64], taken: &[Vec<Complex64>]) -> Vec<HitSpectra> {
        let of_hit = |(index, away): (usize, &f64)| {
            let force = vec![Complex64::new(1.0 + index as f64, 0.2); 2 * LINES];
            // Above the band stands what little noise there is.
            let value = |line: usize| {
                let off = taken.get(index).map_or(Complex64::ZERO, |taken| taken[line]);
                at(line) + away * slope[line] - off
            };
            let seen = |line: usize| if line < LINES { value(line) } else { Complex64::ZERO };
            let noise = |line: usize| 1e-7 * Complex64::new((line * (index + 2)) as f64, 1.0).sin();
            let motion = (0..2 * LINES).map(|line| seen(line) * force[line] + noise(line)).collect();
            HitSpectra { force, motion, force_noise: 0.0, motion_noise: None }
        };
        AWAY.iter().enumerate().map(of_hit).collect()
    }

    #[test]
    fn val_hits_beside_their_place_are_brought_together() {
        let slope = slopes();
        let mut hits = hits(&slope, &[]);
        let found = align(&mut hits, (&slope, &[]));
        for (found, away) in found.iter().zip(AWAY) {
            assert!((found - away).abs() < 1e-6, "{found} {away}");
        }
        for line in 1..LINES {
            let values: Vec<Complex64> = hits.iter().map(|hit| hit.motion[line] / hit.force[line]).collect();
            assert!((values[0] - values[2]).norm() < 1e-4 * at(line).norm(), "{line}: {values:?}");
        }
    }

    /// What a strong hit lacks is no place, and it still lacks it afterwards.
    #[test]
    fn val_forces_that_go_with_the_cube_are_not_taken_for_places() {
        let slope = slopes();
        let taken: Vec<Vec<Complex64>> = (1..=3)
            .map(|size| (0..LINES).map(|line| 0.01 * f64::from(size * size) * at(line + 40)).collect())
            .collect();
        let mut together = hits(&slope, &taken);
        let found = align(&mut together, (&slope, &taken));
        for (found, away) in found.iter().zip(AWAY) {
            assert!((found - away).abs() < 1e-6, "{found} {away}");
        }
        for line in 1..LINES {
            for (hit, taken) in together.iter().zip(&taken) {
                let linear = hit.motion[line] / hit.force[line] + taken[line];
                assert!((linear - at(line)).norm() < 1e-4 * at(line).norm(), "{line}: {linear}");
            }
        }
        let misled = align(&mut hits(&slope, &taken), (&slope, &[]));
        assert!((misled[2] - AWAY[2]).abs() > 1e-3, "{misled:?}");
    }
}
