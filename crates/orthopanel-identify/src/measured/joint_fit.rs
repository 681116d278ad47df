//! A fit of all records at a number of poles, and whether noise explains what it leaves.

use super::lines::RecordLines;
use super::modal_fit::{Fitted, ModalFit, PoleParameters};

/// Misfit per datum from which no noise leaves it: poles are missing, or the records hold what no pole is, a force that is not linear or a panel
/// that changed, which many poles would mimic.
pub(super) const SYSTEMATIC: f64 = 2.0;

/// Part of the misfit by less than which it falls where the last fit ends: of tens of thousands of data the logarithm of the likelihood is then told to
/// 1e-4.
pub(super) const LAST: f64 = 1e-8;

/// Poles found, with the fit at them.
pub(super) struct Found {
    pub poles: PoleParameters,
    pub fitted: Fitted,
    pub freedom: f64,
}

impl Found {
    /// Whether noise explains what the poles leave.
    pub(super) fn by_noise(&self) -> bool {
        self.per_datum() < SYSTEMATIC
    }

    pub(super) fn per_datum(&self) -> f64 {
        self.fitted.misfit / self.freedom
    }
}

/// Refined poles, with lines that count by themselves near where they began; sorted.
pub(super) fn fit(records: &[RecordLines], poles: PoleParameters, tolerance: f64) -> Option<Found> {
    let fit = ModalFit::new(records, &poles);
    let (mut poles, _) = fit.minimise(poles, tolerance)?;
    poles.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let fitted = fit.at(&poles)?;
    let freedom = fit.freedom(poles.len());
    Some(Found { poles, fitted, freedom })
}
