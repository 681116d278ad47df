//! Modes that overlap where there are too few places to tell them apart.

use std::fmt;

use orthopanel_model::Estimate;

use crate::structures::SeenMode;

/// More modes that overlap than there are pairs of places: records of $R$ pairs are sums of at most $R$ shapes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct TooFewPlaces {
    /// Modes of the largest group, in which each lies within a half-power bandwidth $2\zeta f$ of the next.
    modes: usize,
    /// Its lowest and its highest frequency \[Hz\].
    between: [f64; 2],
    /// Pairs of places.
    places: usize,
}

impl TooFewPlaces {
    /// `None` where the places are enough; `damping` is of the first of the modes, which rise.
    pub(super) fn of(modes: &[SeenMode], damping: &[Estimate], places: usize) -> Option<Self> {
        let half = |(mode, ratio): (&SeenMode, &Estimate)| (mode.frequency, ratio.value * mode.frequency);
        Self::of_resonances(modes.iter().zip(damping).map(half), places)
    }

    /// Of frequencies with half their bandwidths, rising \[Hz\].
    fn of_resonances(resonances: impl Iterator<Item = (f64, f64)>, places: usize) -> Option<Self> {
        let mut largest: Option<Self> = None;
        let mut group: Vec<(f64, f64)> = vec![];
        for (frequency, width) in resonances {
            if group.last().is_some_and(|(last, other)| frequency - last > other + width) {
                group.clear();
            }
            group.push((frequency, width));
            let (modes, between) = (group.len(), [group[0].0, frequency]);
            if largest.is_none_or(|largest| modes > largest.modes) {
                largest = Some(Self { modes, between, places });
            }
        }
        largest.filter(|largest| largest.modes > places)
    }
}

impl fmt::Display for TooFewPlaces {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { modes, between: [first, last], places } = self;
        let pairs = if *places == 1 { "pair" } else { "pairs" };
        write!(
            f,
            "{modes} modes of the plate overlap from {first:.1} to {last:.1} Hz, and records of {places} {pairs} of places tell no more than {places} \
             apart: hit {modes} places at least, off the lines of symmetry"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_modes_that_overlap_want_three_places() {
        let resonances = [(100.0, 1.0), (200.0, 1.0), (201.5, 1.0), (203.0, 1.0), (300.0, 1.0)];
        let of = |places: usize| TooFewPlaces::of_resonances(resonances.into_iter(), places);
        let said = of(2).expect("too few").to_string();
        let told = "3 modes of the plate overlap from 200.0 to 203.0 Hz, and records of 2 pairs of places tell no more than 2 apart: hit 3 places";
        assert!(said.starts_with(told), "{said}");
        assert!(of(1).is_some_and(|few| few.to_string().contains("records of 1 pair of places")));
        assert_eq!(of(3), None);
    }
}
