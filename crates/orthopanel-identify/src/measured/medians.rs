//! Medians, of all values and of those about one.

use std::ops::Range;

/// Lines of which the median is taken: a resonance is a few lines wide in a record that lasts.
pub(super) const NEIGHBOURS: usize = 65;

/// Zero where there are no values.
pub(super) fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    let middle = values.len() / 2;
    if values.is_empty() { 0.0 } else { *values.select_nth_unstable_by(middle, f64::total_cmp).1 }
}

/// Places of `count` of `all` values about one: at the ends the first or last.
pub(super) fn about(place: usize, count: usize, all: usize) -> Range<usize> {
    let from = place.saturating_sub(count / 2).min(all.saturating_sub(count));
    from..(from + count).min(all)
}
