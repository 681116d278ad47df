//! Nodes along a line.

/// How often a row of deflections changes its sign.
pub(crate) fn crossings(deflections: &[f64]) -> usize {
    let crosses = |pair: &&[f64]| matches!(pair, [left, right] if (*left < 0.0) != (*right < 0.0));
    deflections.windows(2).filter(crosses).count()
}
