//! The accelerance of each record at any complex frequency.

use num_complex::Complex64;

use super::coupling::{Columns, Coupling};
use super::modulus_path::ModulusPath;
use super::record::RecordPlan;
use super::view::View;
use crate::effects::{ChannelFactor, CoreModulus, ElementLine, PointElement};

/// Accelerances of the records of a test, as [`super::ReceptanceSetup::model`] makes it.
///
/// Each line has its derivatives in one list of [`ReceptanceModel::columns`] numbers: by the constants, by $\ln\zeta_m$ of
/// the free damping ratios, then by the values of each effect in order (by the values themselves, whatever scale a search
/// takes).
pub struct ReceptanceModel {
    records: Vec<RecordModel>,
    zetas: Vec<f64>,
    columns: usize,
}

/// One record's model.
pub(super) struct RecordModel {
    base: Base,
    elements: Vec<PointElement>,
    factors: Vec<(ChannelFactor, Vec<usize>)>,
    windows: Vec<(f64, usize)>,
    hit_time: f64,
    columns: Columns,
}

enum Base {
    Real(View),
    Complex { path: ModulusPath, core: Option<(CoreModulus, usize)>, modulus: f64 },
}

impl RecordModel {
    pub(super) fn real(view: View, plan: RecordPlan) -> Self {
        Self::new(Base::Real(view), plan)
    }

    /// With the column of the core's first parameter.
    pub(super) fn complex(
        path: ModulusPath,
        core: Option<(CoreModulus, usize)>,
        modulus: f64,
        plan: RecordPlan,
    ) -> Self {
        Self::new(Base::Complex { path, core, modulus }, plan)
    }

    fn new(base: Base, plan: RecordPlan) -> Self {
        let RecordPlan { elements, factors, windows, hit_time, columns, .. } = plan;
        Self { base, elements, factors, windows, hit_time, columns }
    }
}

impl ReceptanceModel {
    pub(super) fn new(records: Vec<RecordModel>, zetas: Vec<f64>, columns: usize) -> Self {
        Self { records, zetas, columns }
    }

    /// Number of derivatives of a line.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Number of records.
    pub fn records(&self) -> usize {
        self.records.len()
    }

    /// What evaluates the lines of record `index`, counted from zero; one for each thread.
    pub fn evaluator(&self, index: usize) -> Option<LineEvaluator<'_>> {
        let record = self.records.get(index)?;
        Some(LineEvaluator { model: self, record, coupling: Coupling::default(), lines: vec![], numbers: vec![] })
    }
}

/// Evaluates one record line by line.
pub struct LineEvaluator<'a> {
    model: &'a ReceptanceModel,
    record: &'a RecordModel,
    coupling: Coupling,
    lines: Vec<ElementLine>,
    numbers: Vec<Complex64>,
}

impl LineEvaluator<'_> {
    /// The accelerance \[(m/s²)/N\] at $s = \sigma + j\omega \ne 0$ \[1/s\] as the record shows it, $c(s)\,s^2H'(s)$, and
    /// into `derivatives` (at least [`ReceptanceModel::columns`] long) its derivatives.
    ///
    /// On $s = \sigma + j\omega$ it is the ratio of the transforms of both channels multiplied by $e^{-\sigma t}$.
    pub fn line(&mut self, s: Complex64, derivatives: &mut [Complex64]) -> Complex64 {
        derivatives.fill(Complex64::ZERO);
        if derivatives.len() < self.model.columns {
            return Complex64::new(f64::NAN, f64::NAN);
        }
        let record = self.record;
        let s = s + record.windows.iter().map(|(tau, _)| 1.0 / tau).sum::<f64>();
        self.lines.clear();
        self.lines.extend(record.elements.iter().map(|element| element.law.line(s)));
        let zetas = &self.model.zetas;
        let receptance = match &record.base {
            Base::Real(view) => {
                let numbers = (&view.layout, view.numbers.as_slice());
                self.coupling.line(numbers, zetas, &self.lines, &record.columns, s, derivatives)
            }
            Base::Complex { path, core, modulus } => {
                let core = core.map(|(core, column)| (core.line(s), column));
                let g = core.map_or(Complex64::ONE, |(line, _)| line.value);
                path.at(g, &mut self.numbers);
                let numbers = (&path.layout(), self.numbers.as_slice());
                let mut receptance = self.coupling.line(numbers, zetas, &self.lines, &record.columns, s, derivatives);
                if let (Some((line, column)), Some(&shear)) = (core, record.columns.structure.get(1)) {
                    // The view's derivative is by the modulus gG itself.
                    let by_modulus = derivatives[shear];
                    derivatives[shear] = by_modulus * g;
                    let by_g = by_modulus * *modulus;
                    for (i, by) in line.by_numbers.into_iter().enumerate() {
                        derivatives[column + i] += by_g * by;
                    }
                    receptance.by_s += by_g * line.by_s;
                }
                receptance
            }
        };
        let (value, by_s) = (s * s * receptance.value, s * s * receptance.by_s + 2.0 * s * receptance.value);
        derivatives.iter_mut().for_each(|by| *by *= s * s);
        record.through_channel(s, value, by_s, derivatives)
    }
}

impl RecordModel {
    /// Applies factors and windows to an accelerance and its derivatives.
    fn through_channel(&self, s: Complex64, value: Complex64, by_s: Complex64, out: &mut [Complex64]) -> Complex64 {
        if self.factors.is_empty() && self.windows.is_empty() {
            return value;
        }
        let lines: Vec<_> = self.factors.iter().map(|(factor, columns)| (factor.line(s), columns)).collect();
        let gain: f64 = self.windows.iter().map(|(tau, _)| (-self.hit_time / tau).exp()).product();
        let product = lines.iter().map(|(line, _)| line.value).product::<Complex64>() * gain;
        let mut factor_by_s = Complex64::ZERO;
        out.iter_mut().for_each(|by| *by *= product);
        for (i, (line, columns)) in lines.iter().enumerate() {
            let others: Complex64 =
                lines.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, (other, _))| other.value).product();
            factor_by_s += gain * others * line.by_s;
            for (&column, by) in columns.iter().zip(line.by_numbers) {
                out[column] += gain * others * by * value;
            }
        }
        let whole_by_s = product * by_s + factor_by_s * value;
        for &(tau, column) in &self.windows {
            out[column] += (product * value * self.hit_time - whole_by_s) / (tau * tau);
        }
        product * value
    }
}
