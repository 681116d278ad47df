//! The accelerance of each record at any complex frequency.

use num_complex::Complex64;

use super::elements::joined;
use super::modulus_path::ModulusPath;
use super::record::RecordPlan;
use super::view::{Layout, View};
use crate::effects::CoreModulus;

/// Accelerances of the records of a test, as [`super::ReceptanceSetup::model`] makes it.
pub struct ReceptanceModel {
    records: Vec<RecordModel>,
    zetas: Vec<f64>,
}

/// One record's model.
pub(super) struct RecordModel {
    base: Base,
    plan: RecordPlan,
}

enum Base {
    Real { layout: Layout, numbers: Vec<Complex64> },
    Complex { path: ModulusPath, core: CoreModulus },
}

impl RecordModel {
    pub(super) fn real(view: View, plan: RecordPlan) -> Self {
        let numbers = view.numbers.into_iter().map(Complex64::from).collect();
        Self { base: Base::Real { layout: view.layout, numbers }, plan }
    }

    pub(super) fn complex(path: ModulusPath, core: CoreModulus, plan: RecordPlan) -> Self {
        Self { base: Base::Complex { path, core }, plan }
    }

    fn accelerance(&self, zetas: &[f64], s: Complex64) -> Complex64 {
        let RecordPlan { elements, factors, windows, hit_time, .. } = &self.plan;
        let s = s + windows.iter().map(|tau| 1.0 / tau).sum::<f64>();
        let bare = match &self.base {
            Base::Real { layout, numbers } => layout.receptances(numbers, zetas, s),
            Base::Complex { path, core } => path.layout().receptances(&path.at(core.factor(s)), zetas, s),
        };
        let pairs: Vec<_> = elements.iter().map(|law| law.pair(s)).collect();
        let channel: Complex64 = factors.iter().map(|factor| factor.at(s)).product();
        let gain: f64 = windows.iter().map(|tau| (-hit_time / tau).exp()).product();
        gain * channel * s * s * joined(&bare, &pairs)
    }
}

impl ReceptanceModel {
    pub(super) fn new(records: Vec<RecordModel>, zetas: Vec<f64>) -> Self {
        Self { records, zetas }
    }

    /// The accelerances \[(m/s²)/N\] of record `index`, counted from zero, as it shows them, $c(s)\,s^2H'(s)$, at each
    /// $s = \sigma + j\omega \ne 0$ \[1/s\] of a list; `None` where there is no such record.
    ///
    /// On $s = \sigma + j\omega$ it is the ratio of the transforms of both channels multiplied by $e^{-\sigma t}$.
    pub fn accelerances(&self, index: usize, s: &[Complex64]) -> Option<Vec<Complex64>> {
        let record = self.records.get(index)?;
        Some(s.iter().map(|s| record.accelerance(&self.zetas, *s)).collect())
    }
}
