//! Where the residual of records that no effect explains stands out: in frequency and by place.

use orthopanel_identify::Verdict;
use orthopanel_model::Readable;

use super::Traced;
use crate::evidence::{PairResidual, ResidualUnit, banded};
use crate::measured_pairs::place_text;

/// Bands of frequency that are told apart.
const BANDS: usize = 8;
/// Less than this over the noise stands out nowhere.
const NOISE: f64 = 1.1;

impl Traced {
    /// A sentence on what is left where no effect explains the records; `None` with any other verdict.
    pub(crate) fn left(&self) -> Option<String> {
        if self.tracing.verdict != Verdict::Unexplained {
            return None;
        }
        standing_out(&self.tracing.accelerances.iter().map(PairResidual::of).collect::<Vec<_>>())
    }
}

/// The band of frequency and the pair of places at which most is left; `None` where only noise is.
fn standing_out(pairs: &[PairResidual]) -> Option<String> {
    if pairs.iter().any(|pair| pair.unit != ResidualUnit::Noise) {
        return None;
    }
    let lines = || pairs.iter().flat_map(|pair| &pair.lines);
    let lowest = lines().map(|(frequency, _)| *frequency).fold(f64::INFINITY, f64::min);
    let highest = lines().map(|(frequency, _)| *frequency).fold(0.0, f64::max);
    let (_, over_all) = *banded(lines(), highest, 1).first()?;
    let (middle, most) = banded(lines(), highest, BANDS).into_iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let half = 0.5 * highest / BANDS as f64;
    if over_all < NOISE {
        return None;
    }
    let (low, high) = ((middle - half).max(lowest), middle + half);
    let mut told = format!(
        "What is left is {:.1} times the noise of the mean of the hits over all lines: most from {low:.0} to {high:.0} Hz, {:.1}",
        Readable(over_all),
        Readable(most)
    );
    if pairs.len() > 1 {
        let worst = pairs.iter().max_by(|a, b| a.rms().total_cmp(&b.rms()))?;
        let [force, response] = [worst.force, worst.response].map(place_text);
        told += &format!(
            ", and with the force at {force} m and the response at {response} m, {:.1}",
            Readable(worst.rms())
        );
    }
    Some(told)
}

#[cfg(test)]
mod tests {
    use orthopanel_model::Place;

    use super::*;

    fn pair(x: f64, size: impl Fn(f64) -> f64) -> PairResidual {
        let lines = (1..=800).map(|line| (f64::from(line), size(f64::from(line)))).collect();
        let at = |x| Place { x, y: 0.0 };
        PairResidual { force: at(x), response: at(0.3), unit: ResidualUnit::Noise, lines }
    }

    #[test]
    fn the_band_and_the_place_of_most_residual_are_told() {
        let lump = |frequency: f64| if (300.0..400.0).contains(&frequency) { 5.0 } else { 1.0 };
        let told = standing_out(&[pair(-0.1, |_| 1.0), pair(0.2, lump)]).expect("a sentence");
        assert!(told.contains("most from 300 to 400 Hz, 3.6"), "{told}");
        assert!(told.contains("the force at 0.2 m and the response at 0.3 m, 2.0"), "{told}");
        assert_eq!(standing_out(&[pair(-0.1, |_| 1.0), pair(0.2, |_| 1.0)]), None);
        let single = standing_out(&[pair(0.2, lump)]).expect("a sentence");
        assert!(!single.contains("the force at"), "{single}");
    }
}
