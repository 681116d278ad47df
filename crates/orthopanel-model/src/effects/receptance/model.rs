//! The accelerance of each record at any complex frequency.

use num_complex::Complex64;

use super::coupling::{Columns, Coupling};
use super::modulus_path::ModulusPath;
use super::record::RecordPlan;
use super::view::View;
use super::wide::{Even, LINES, OfLine, Wide};
use crate::effects::{ChannelFactor, CoreModulus, ElementLine, PointElement};

/// Accelerances of the records of a test, as [`super::ReceptanceSetup::model`] makes it.
///
/// Each line has its derivatives in one list of [`ReceptanceModel::columns`] numbers: by the constants, by $\ln\zeta_m$ of
/// the listed damping ratios and of that of all modes beyond, then by the values of each effect in order (by the values
/// themselves, whatever scale a search takes).
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
        let coupling = Coupling::default();
        Some(LineEvaluator { model: self, record, coupling, elements: vec![], numbers: vec![], by: vec![] })
    }
}

/// Evaluates the lines of one record.
pub struct LineEvaluator<'a> {
    model: &'a ReceptanceModel,
    record: &'a RecordModel,
    coupling: Coupling,
    elements: Vec<Vec<ElementLine>>,
    numbers: Vec<Wide>,
    by: Vec<Wide>,
}

impl LineEvaluator<'_> {
    /// The accelerance \[(m/s²)/N\] at $s = \sigma + j\omega \ne 0$ \[1/s\] as the record shows it, $c(s)\,s^2H'(s)$, and
    /// into `derivatives` (at least [`ReceptanceModel::columns`] long) its derivatives.
    ///
    /// On $s = \sigma + j\omega$ it is the ratio of the transforms of both channels multiplied by $e^{-\sigma t}$.
    /// Many lines cost far less by [`LineEvaluator::lines`].
    pub fn line(&mut self, s: Complex64, derivatives: &mut [Complex64]) -> Complex64 {
        derivatives.fill(Complex64::ZERO);
        let mut value = Complex64::new(f64::NAN, f64::NAN);
        if derivatives.len() >= self.model.columns {
            self.lines(&[s], |_, found, by| {
                value = found;
                derivatives.iter_mut().enumerate().take(by.len()).for_each(|(column, to)| *to = by.of(column));
            });
        }
        value
    }

    /// The same at every $s$ of a list: tells `take` the line's number, its accelerance and its derivatives.
    pub fn lines(&mut self, s: &[Complex64], mut take: impl FnMut(usize, Complex64, LineDerivatives)) {
        self.blocks(s, |first, block| {
            for line in 0..block.len() {
                take(first + line, block.value(line), LineDerivatives { by: block.by, line });
            }
        });
    }

    /// The same, [`LineBlock::MOST`] lines at once: tells `take` the number of the first, and all of them.
    pub fn blocks(&mut self, s: &[Complex64], mut take: impl FnMut(usize, LineBlock)) {
        for (chunk, some) in s.chunks(LINES).enumerate() {
            let last = some.len() - 1;
            let lines = Wide::from_fn(|line| some[line.min(last)]);
            let value = pulp::Arch::new().dispatch(SomeLines { evaluator: &mut *self, s: &lines });
            take(chunk * LINES, LineBlock { value: &value, by: &self.by, lines: some.len() });
        }
    }

    #[inline(always)]
    fn some_lines(&mut self, s: &Wide) -> Wide {
        self.by.clear();
        self.by.resize(self.model.columns, Wide::ZERO);
        let record = self.record;
        let fading = record.windows.iter().map(|(tau, _)| 1.0 / tau).sum::<f64>();
        let mut shifted = *s;
        shifted.add_scaled(fading, &Wide::ONE);
        let s = &shifted;
        self.elements.resize(record.elements.len(), vec![]);
        for (lines, element) in self.elements.iter_mut().zip(&record.elements) {
            lines.clear();
            lines.extend((0..LINES).map(|line| element.law.line(s.at(line))));
        }
        let (zetas, elements, by) = (&self.model.zetas, &self.elements, &mut self.by[..]);
        let receptance = match &record.base {
            Base::Real(view) => {
                let numbers = (&view.layout, &Even(&view.numbers));
                self.coupling.lines(numbers, zetas, elements, &record.columns, s, by)
            }
            Base::Complex { path, core, modulus } => {
                let of_lines = |core: &CoreModulus| (0..LINES).map(|line| core.line(s.at(line))).collect::<Vec<_>>();
                let laws = core.as_ref().map(|(core, column)| (of_lines(core), *column));
                let g = laws.as_ref().map_or(Wide::ONE, |(laws, _)| Wide::from_fn(|line| laws[line].value));
                path.at(&g, &mut self.numbers);
                let numbers = (&path.layout(), &OfLine(&self.numbers));
                let mut receptance = self.coupling.lines(numbers, zetas, elements, &record.columns, s, by);
                if let (Some((laws, column)), Some(&shear)) = (&laws, record.columns.structure.get(1)) {
                    // The view's derivative is by the modulus gG itself.
                    let by_g = by[shear].scaled(*modulus);
                    by[shear] = by[shear].times(&g);
                    for i in 0..laws[0].by_numbers.len() {
                        by[column + i].add_product(&by_g, &Wide::from_fn(|line| laws[line].by_numbers[i]));
                    }
                    receptance.by_s.add_product(&by_g, &Wide::from_fn(|line| laws[line].by_s));
                }
                receptance
            }
        };
        let s2 = s.times(s);
        let value = s2.times(&receptance.value);
        let mut by_s = s2.times(&receptance.by_s);
        by_s.add_product(&s.scaled(2.0), &receptance.value);
        by.iter_mut().for_each(|by| *by = by.times(&s2));
        record.through_channel(s, value, &by_s, by)
    }
}

/// The work on one [`Wide`], to be compiled for each kind of processor: a closure would not be inlined there.
struct SomeLines<'a, 'b> {
    evaluator: &'a mut LineEvaluator<'b>,
    s: &'a Wide,
}

impl pulp::NullaryFnOnce for SomeLines<'_, '_> {
    type Output = Wide;

    #[inline(always)]
    fn call(self) -> Wide {
        self.evaluator.some_lines(self.s)
    }
}

/// Some lines side by side, with their derivatives.
#[derive(Debug, Clone, Copy)]
pub struct LineBlock<'a> {
    value: &'a Wide,
    by: &'a [Wide],
    lines: usize,
}

impl<'a> LineBlock<'a> {
    /// Most lines of a block; all but the last one of a list have as many.
    pub const MOST: usize = LINES;

    /// Number of lines.
    #[expect(clippy::len_without_is_empty, reason = "never empty: made of a chunk of lines")]
    pub fn len(&self) -> usize {
        self.lines
    }

    /// The accelerance of a line.
    pub fn value(&self, line: usize) -> Complex64 {
        self.value.at(line)
    }

    /// Real and imaginary parts of the derivatives of all lines by this column.
    pub fn by(&self, column: usize) -> [&'a [f64]; 2] {
        self.by[column].parts().map(|part| &part[..self.lines])
    }
}

/// The derivatives of one line.
#[derive(Debug, Clone, Copy)]
pub struct LineDerivatives<'a> {
    by: &'a [Wide],
    line: usize,
}

impl LineDerivatives<'_> {
    /// Number of derivatives.
    #[expect(clippy::len_without_is_empty, reason = "never empty: the constants come first")]
    pub fn len(&self) -> usize {
        self.by.len()
    }

    /// The derivative of this column.
    pub fn of(&self, column: usize) -> Complex64 {
        self.by[column].at(self.line)
    }
}

impl RecordModel {
    /// Applies factors and windows to an accelerance and its derivatives.
    fn through_channel(&self, s: &Wide, value: Wide, by_s: &Wide, out: &mut [Wide]) -> Wide {
        if self.factors.is_empty() && self.windows.is_empty() {
            return value;
        }
        let laws = self.factors.iter().map(|(factor, columns)| {
            let laws: Vec<_> = (0..LINES).map(|line| factor.line(s.at(line))).collect();
            (laws, columns)
        });
        let laws: Vec<_> = laws.collect();
        let values: Vec<Wide> = laws.iter().map(|(laws, _)| Wide::from_fn(|line| laws[line].value)).collect();
        let gain: f64 = self.windows.iter().map(|(tau, _)| (-self.hit_time / tau).exp()).product();
        let product = values.iter().fold(Wide::ONE.scaled(gain), |product, value| product.times(value));
        let mut factor_by_s = Wide::ZERO;
        out.iter_mut().for_each(|by| *by = by.times(&product));
        for (i, (laws, columns)) in laws.iter().enumerate() {
            let others = values.iter().enumerate().filter(|(j, _)| *j != i);
            let others = others.fold(Wide::ONE.scaled(gain), |product, (_, other)| product.times(other));
            factor_by_s.add_product(&others, &Wide::from_fn(|line| laws[line].by_s));
            let through = others.times(&value);
            for (number, &column) in columns.iter().enumerate().take(laws[0].by_numbers.len()) {
                out[column].add_product(&through, &Wide::from_fn(|line| laws[line].by_numbers[number]));
            }
        }
        let mut whole_by_s = product.times(by_s);
        whole_by_s.add_product(&factor_by_s, &value);
        let seen = product.times(&value);
        for &(tau, column) in &self.windows {
            out[column].add_scaled(self.hit_time / (tau * tau), &seen);
            out[column].add_scaled(-1.0 / (tau * tau), &whole_by_s);
        }
        seen
    }
}
