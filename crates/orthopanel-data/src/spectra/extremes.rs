//! Least and greatest sample, and the level a channel rests at: what every judgement of a hit begins with.

/// Running results kept side by side, so that one sample does not wait for the one before.
pub(super) const LANES: usize = 8;

/// What every judgement of a channel asks for, found once.
#[derive(Clone, Copy)]
pub(super) struct Levels {
    /// Least and greatest sample.
    pub(super) extremes: [f64; 2],
    /// The level it rests at, or swings about.
    pub(super) middle: f64,
}

impl Levels {
    pub(super) fn of(values: &[f64]) -> Self {
        Self { extremes: extremes(values), middle: sampled_median(values) }
    }

    /// The farther extreme's distance from the middle.
    pub(super) fn reach(self) -> f64 {
        let [least, greatest] = self.extremes;
        (greatest - self.middle).max(self.middle - least)
    }

    /// The extremes far from the middle: a quiet side rests on its last bit.
    pub(super) fn far(self) -> impl Iterator<Item = f64> {
        let [least, greatest] = self.extremes;
        [greatest, least].into_iter().filter(move |extreme| (extreme - self.middle).abs() > 0.5 * self.reach())
    }
}

/// The least and the greatest value; infinite, the wrong way round, of an empty list.
pub(super) fn extremes(values: &[f64]) -> [f64; 2] {
    let (mut least, mut greatest) = ([f64::INFINITY; LANES], [f64::NEG_INFINITY; LANES]);
    for chunk in values.chunks(LANES) {
        for ((low, high), &value) in least.iter_mut().zip(&mut greatest).zip(chunk) {
            *low = if value < *low { value } else { *low };
            *high = if value > *high { value } else { *high };
        }
    }
    let low = least.into_iter().fold(f64::INFINITY, f64::min);
    [low, greatest.into_iter().fold(f64::NEG_INFINITY, f64::max)]
}

/// The sample farthest from the offset, the first where several are, and its height over it.
pub(super) fn peak(values: &[f64], offset: f64) -> (usize, f64) {
    peak_among(values, offset, extremes(values))
}

/// As [`peak`], where the extremes are known.
pub(super) fn peak_among(values: &[f64], offset: f64, [least, greatest]: [f64; 2]) -> (usize, f64) {
    let first = |extreme: f64| values.iter().position(|&value| value == extreme);
    let (down, up) = ((least - offset).abs(), (greatest - offset).abs());
    let found = match (first(least), first(greatest)) {
        (Some(low), Some(high)) if down > up || (down == up && low < high) => (low, least - offset),
        (_, Some(high)) => (high, greatest - offset),
        _ => (0, 0.0),
    };
    if found.1 == 0.0 { (0, 0.0) } else { found }
}

/// The median of at most some thousand values spread over all, which is good to 4 % of a standard deviation: sorting a
/// long record would take longer than its transform.
pub(super) fn sampled_median(values: &[f64]) -> f64 {
    let stride = (values.len() / 1000).max(1);
    median(values.iter().step_by(stride).copied().collect())
}

/// The middle value; 0 of an empty list.
pub(super) fn median(mut values: Vec<f64>) -> f64 {
    let middle = values.len() / 2;
    if values.is_empty() { 0.0 } else { *values.select_nth_unstable_by(middle, f64::total_cmp).1 }
}
