//! Rising order, by one sort for all.
//!
//! For each type and key the standard library brings 2 to 10 KB of sort into every FMU, most for bare numbers. So all keys are
//! sorted as one type.

/// Places of these keys, from the smallest key on; equal ones stay as they come.
pub(crate) fn rising(keys: &[f64]) -> Vec<usize> {
    pairs(keys).into_iter().map(|(_, place)| place).collect()
}

/// The numbers, from the smallest on.
pub(crate) fn sort(numbers: &mut [f64]) {
    let sorted = pairs(numbers);
    numbers.iter_mut().zip(sorted).for_each(|(number, (key, _))| *number = key);
}

/// The items, from that with the smallest key on; equal ones stay as they come.
pub(crate) fn sorted<T>(items: Vec<T>, key: impl FnMut(&T) -> f64) -> Vec<T> {
    let order = rising(&items.iter().map(key).collect::<Vec<_>>());
    let mut items: Vec<Option<T>> = items.into_iter().map(Some).collect();
    order.into_iter().filter_map(|place| items.get_mut(place)?.take()).collect()
}

/// The same of modes by their frequencies, but that those which agree to [`COINCIDENT`] stay as they come: which of them is the
/// lower would be rounding's choice, another one with each solver.
pub(crate) fn sorted_modes<T>(modes: Vec<T>, frequency: impl FnMut(&T) -> f64) -> Vec<T> {
    let frequencies: Vec<f64> = modes.iter().map(frequency).collect();
    let mut ranks = vec![0.0; frequencies.len()];
    let (mut rank, mut last) = (0.0, None);
    for place in rising(&frequencies) {
        // No infinite frequency to begin from: infinity less infinity kills a host that traps what is no number.
        if last.is_some_and(|last: f64| frequencies[place] > last + COINCIDENT * last.abs()) {
            rank += 1.0;
        }
        (ranks[place], last) = (rank, Some(frequencies[place]));
    }
    let mut ranks = ranks.into_iter();
    sorted(modes, |_| ranks.next().unwrap_or(rank))
}

/// Share of itself within which a frequency is another one's: solvers differ by some 1e-10.
const COINCIDENT: f64 = 1e-8;

#[inline(never)]
fn pairs(keys: &[f64]) -> Vec<(f64, usize)> {
    let mut pairs: Vec<_> = keys.iter().copied().zip(0..).collect();
    pairs.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    pairs
}

#[cfg(test)]
mod tests {
    use super::{rising, sort, sorted, sorted_modes};

    #[test]
    fn equal_keys_stay_as_they_come() {
        let keys = [3.0, -1.0, 3.0, f64::INFINITY, 0.0, -1.0];
        assert_eq!(rising(&keys), [1, 5, 4, 0, 2, 3]);
        let words = vec!["three", "a", "cab", "two", "b"];
        assert_eq!(sorted(words, |word| word.len() as f64), ["a", "b", "cab", "two", "three"]);
    }

    #[test]
    fn modes_that_coincide_stay_as_they_come() {
        let frequencies = vec![7.0, 3.0 + 1e-10, 0.0, 3.0, 3.001, 7.0 - 1e-9, 0.0, 5.0];
        let expected = [0.0, 0.0, 3.0 + 1e-10, 3.0, 3.001, 5.0, 7.0, 7.0 - 1e-9];
        assert_eq!(sorted_modes(frequencies, |frequency| *frequency), expected);
    }

    #[test]
    fn many_numbers_are_sorted() {
        let mut numbers: Vec<f64> = (0..1000_u32).map(|n| f64::from(n.wrapping_mul(2_654_435_761) >> 8)).collect();
        let mut expected = numbers.clone();
        expected.sort_unstable_by(f64::total_cmp);
        sort(&mut numbers);
        assert_eq!(numbers, expected);
        assert!(numbers.windows(2).any(|pair| pair[0] < pair[1]));
    }
}
