//! The even step, which is printed with few digits and so is often rounded.

/// Digits of a number that passes for round: 25600 Hz and 51.2 s have three, 48000 Hz two.
const ROUND_DIGITS: i32 = 4;

/// The step that was printed as `step`, to `digits` digits, for `points` points; `None` where it stays as it is.
///
/// A step is the inverse of a sampling rate or of a record's length, and one of them was chosen by a person: a number
/// of few digits, or a power of two. 0.0195312 Hz is 1/51.2 s, for between 1/0.01953125 and 1/0.01953115 nothing else
/// is as round; at line 50944 the difference is 2.5 mHz. Looked for are round values of $1/\Delta$, $(N-1)\Delta$ and
/// $N\Delta$ within half a unit of the last printed digit; the roundest wins, and none is made up where none fits.
pub(in crate::records) fn restored(step: f64, digits: u32, points: usize) -> Option<f64> {
    // Nine digits are as good as a single-precision number ever was: nothing is lost.
    if digits == 0 || digits >= 9 {
        return None;
    }
    let decade = step.log10().floor();
    let half_unit = 0.5 * 10f64.powf(decade - f64::from(digits) + 1.0);
    let (low, high) = (step - half_unit, step + half_unit);
    if low <= 0.0 {
        return None;
    }
    let count = points as f64;
    let length = |factor: f64| roundest(low * factor, high * factor).map(|(digits, round)| (digits, round / factor));
    let rate = roundest(1.0 / high, 1.0 / low).map(|(digits, round)| (digits, 1.0 / round));
    let candidates = [rate, length(count - 1.0), length(count)];
    let (_, best) = candidates.into_iter().flatten().min_by_key(|&(digits, _)| digits)?;
    let changed = (best - step).abs() > 1e-12 * step;
    changed.then_some(best)
}

/// The roundest sampling rate between two; `None` where none is round.
pub(crate) fn round_rate(low: f64, high: f64) -> Option<f64> {
    roundest(low, high).map(|(_, rate)| rate)
}

/// The number of fewest digits in an interval, with its digits; a power of two counts as one digit.
fn roundest(low: f64, high: f64) -> Option<(i32, f64)> {
    if !(low > 0.0 && low < high && high.is_finite()) {
        return None;
    }
    let binary = 2f64.powf(high.log2().floor());
    if binary >= low {
        return Some((1, binary));
    }
    let decade = high.log10().floor() as i32;
    (1..=ROUND_DIGITS).find_map(|digits| {
        // A power of ten that a double holds exactly, so 51.2 comes out as 51.2.
        let places = digits - 1 - decade;
        let scale = 10f64.powi(places.abs());
        let round = if places >= 0 { (high * scale).floor() / scale } else { (high / scale).floor() * scale };
        (round >= low).then_some((digits, round))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_steps_rounded_to_six_digits_are_restored() {
        for (step, points, exact) in [
            (0.0195312, 50945, 0.01953125),
            (1.95312e-5, 51200, 1.0 / 51200.0),
            (1.52588e-5, 65536, 1.0 / 65536.0),
            (2.26757e-5, 44100, 1.0 / 44100.0),
            (0.333333, 100, 1.0 / 3.0),
            (6.10352e-5, 16384, 1.0 / 16384.0),
        ] {
            let found = restored(step, 6, points).unwrap_or(step);
            assert!((found - exact).abs() < 1e-15 * exact.max(1e-1), "{step}: {found}, expected {exact}");
        }
    }

    #[test]
    fn val_exact_or_unround_steps_stay() {
        for (step, digits, points) in
            [(3.90625e-5, 6, 25600), (0.3125, 6, 6400), (1.25, 6, 400), (0.0195312, 9, 50945), (0.271828, 6, 9973)]
        {
            assert_eq!(restored(step, digits, points), None, "{step}");
        }
    }
}
