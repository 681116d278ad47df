//! One blow and what answers it.

/// One hit: sample $n$ stands at $t = n / \mathrm{rate}$ from the record's start.
#[derive(Debug, Clone, PartialEq)]
pub struct Hit {
    /// Force of the hammer \[N\].
    pub force: Vec<f64>,
    /// Acceleration along the force \[m/s²\], as long as `force`.
    pub acceleration: Vec<f64>,
}
