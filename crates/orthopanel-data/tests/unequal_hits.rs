//! Hits of unequal strength, the hard ones noisier or not: the variance that they state against the error they make.

use crate::support::hammer::{Noise, Resonator, history};
use orthopanel_data::{Estimation, Estimator, Hit, Window};

const DAMPED: Resonator = Resonator { radius: 0.9, angle: 0.5 };
const ALL_LINES: Estimation = Estimation { window: Window::None, estimator: Estimator::H1, force_drop: f64::INFINITY };
const TESTS: u64 = 300;

/// How the noise of a hit goes with its strength.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Noisy {
    /// The same in all hits.
    Alike,
    /// In proportion to the hit, as noise in per cent of a record's peak or rms.
    WithStrength,
    /// The same in all hits, and each answers by some per cent more or less than the piece does, as where it lands
    /// beside its place. One that answers by more than five is left out.
    Astray,
}

/// Mean of the variance stated over the mean squared error, over many repetitions; noise in per cent of a hit of 100 N.
fn stated_over_seen(heights: &[f64], force: f64, acceleration: f64, noisy: Noisy) -> f64 {
    let clean: Vec<Hit> = heights.iter().map(|&height| DAMPED.hit(2000, height)).collect();
    let (mut seen, mut stated) = (0.0, 0.0);
    for seed in 0..TESTS {
        let mut noise = Noise(7000 + seed);
        let hits = heights.iter().zip(&clean).map(|(height, hit)| {
            let part = if noisy == Noisy::WithStrength { height / 100.0 } else { 1.0 };
            let mut hit = hit.clone();
            if noisy == Noisy::Astray {
                let astray = 1.0 + 0.02 * noise.next();
                hit.acceleration.iter_mut().for_each(|a| *a *= astray);
            }
            noise.over(&hit, part * force, part * acceleration)
        });
        let found = history(hits.collect()).accelerance(ALL_LINES).unwrap();
        for ((frequency, value), variance) in found.frequency.iter().zip(&found.value).zip(found.variance.unwrap()) {
            // Where the force is strong, so that its own noise makes no bias.
            if *frequency < 120.0 {
                let exact = DAMPED.transfer(0.0, *frequency);
                seen += (value - exact).norm_sqr() / exact.norm_sqr();
                stated += variance / exact.norm_sqr();
            }
        }
    }
    stated / seen
}

const HEIGHTS: [&[f64]; 3] = [&[60.0, 180.0], &[60.0, 100.0, 180.0], &[60.0, 80.0, 110.0, 140.0, 180.0]];

#[test]
fn val_variance_of_unequal_hits_is_the_mean_squared_error() {
    let mut missed = Vec::new();
    for heights in HEIGHTS {
        for noisy in [Noisy::Alike, Noisy::WithStrength] {
            // Force noise that stays below the softest hit at every line: H1 knows it to first order only.
            for (force, acceleration) in [(0.0, 0.3), (0.05, 0.0), (0.05, 0.3)] {
                let ratio = stated_over_seen(heights, force, acceleration, noisy);
                println!("{} hits, {noisy:?}, {force} N, {acceleration} m/s2: {ratio:.3}", heights.len());
                // 300 tests of 239 lines: the ratio scatters by 1 %. The 360 samples before a blow tell the ratio of two
                // hits' noise to 15 %, and one over the bracket is convex in it: 2 % too much for two hits alike.
                if (ratio - 1.0).abs() > 0.05 {
                    missed.push((heights.len(), noisy, force, acceleration, ratio));
                }
            }
        }
    }
    assert!(missed.is_empty(), "{missed:?}");
}

#[test]
fn val_variance_of_hits_astray_is_the_mean_squared_error() {
    for heights in HEIGHTS {
        let ratio = stated_over_seen(heights, 0.0, 0.3, Noisy::Astray);
        println!("{} hits astray: {ratio:.3}", heights.len());
        // One number a hit strays, not one a line: 300 tests leave 8 % on a single difference of two.
        assert!((ratio - 1.0).abs() < 0.2, "{} hits: {ratio}", heights.len());
    }
}
