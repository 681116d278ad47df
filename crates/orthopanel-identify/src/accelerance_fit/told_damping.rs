//! Which damping ratios the records tell.

use orthopanel_model::Estimate;

/// A damping ratio known no better than to this factor's logarithm is the prior's, and is not reported.
pub(super) const DAMPING_UNSEEN: f64 = 0.5;

/// Whether the records tell a damping ratio for which no resonance speaks: what has no deviation was put in.
pub(super) fn is_told(ratio: &Estimate) -> bool {
    ratio.std.is_some_and(|std| std < DAMPING_UNSEEN * ratio.value)
}
