//! Pairs of lines that may have changed their names.

use super::problem::{FrequencyProblem, FrequencySet, Renamed};
use crate::IdentifyError;
use crate::starting_constants::{SOFTNESS, guess};

/// Pairs of lines that are tried with each other's names.
const MOST_PAIRS: usize = 8;
/// Relative scatter of a usual panel's frequencies about those of any other.
pub(super) const USUAL_MISS: f64 = 0.05;
/// Two lines this near to each other, as a part of their frequency, miss by little with each other's names.
const NEAR: f64 = 0.04;

/// Neighbours of one list with each other's names, the nearest first.
pub(super) fn near_pairs(whole: &FrequencyProblem) -> Vec<Vec<Renamed>> {
    let mut pairs: Vec<(f64, Vec<Renamed>)> = Vec::new();
    for (set, own) in whole.sets.iter().enumerate() {
        for one in 0..own.measured.len() {
            for other in one + 1..own.measured.len() {
                let apart = (own.measured[other] / own.measured[one] - 1.0).abs();
                if apart < NEAR {
                    pairs.push((apart, changed(own, set, [one, other])));
                }
            }
        }
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    pairs.into_iter().map(|(_, pair)| pair).take(MOST_PAIRS).collect()
}

/// Two lines of a list with each other's names.
fn changed(own: &FrequencySet, set: usize, [one, other]: [usize; 2]) -> Vec<Renamed> {
    let renamed = |line: usize, name: usize| Renamed { set, line, nodes: own.modes.nodes()[name] };
    vec![renamed(one, other), renamed(other, one)]
}

/// Pairs of lines of one list with each other's names: those that come nearest to a usual panel of the right size.
pub(super) fn changed_pairs(whole: &FrequencyProblem) -> Result<Vec<Vec<Renamed>>, IdentifyError> {
    let mut pairs: Vec<(f64, Vec<Renamed>)> = Vec::new();
    for softness in SOFTNESS {
        let usual = guess(&whole.constants, softness);
        let of_set = |set: &FrequencySet| set.modes.rough_frequencies(&usual);
        let frequencies = whole.sets.iter().map(of_set).collect::<Result<Vec<_>, _>>()?;
        let named = whole.sets.iter().zip(&frequencies);
        let mut sizes: Vec<f64> =
            named.flat_map(|(set, own)| own.iter().zip(&set.measured).map(|(f, m)| f / m)).collect();
        sizes.sort_by(f64::total_cmp);
        // That of most lines: wrong names stand out on either side.
        let size = sizes[sizes.len() / 2];
        let miss = |frequency: f64, measured: f64| ((frequency / size / measured).ln() / USUAL_MISS).powi(2).ln_1p();
        let as_named =
            |set: usize, line: usize, name: usize| miss(frequencies[set][name], whole.sets[set].measured[line]);
        let lines = |set: usize| 0..whole.sets[set].measured.len();
        let all: f64 = (0..whole.sets.len())
            .flat_map(|set| lines(set).map(move |line| (set, line)))
            .map(|(set, line)| as_named(set, line, line))
            .sum();
        for (set, own) in whole.sets.iter().enumerate() {
            for one in lines(set) {
                for other in one + 1..lines(set).end {
                    let before = as_named(set, one, one) + as_named(set, other, other);
                    let after = as_named(set, one, other) + as_named(set, other, one);
                    pairs.push((all + after - before, changed(own, set, [one, other])));
                }
            }
        }
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut likeliest: Vec<Vec<Renamed>> = Vec::new();
    for (_, pair) in pairs {
        if likeliest.len() < MOST_PAIRS && !likeliest.contains(&pair) {
            likeliest.push(pair);
        }
    }
    Ok(likeliest)
}
