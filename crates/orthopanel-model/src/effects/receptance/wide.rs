//! Several lines side by side: one instruction then works on as many of them as the processor holds.

use num_complex::Complex64;

/// Lines of one [`Wide`].
pub(super) const LINES: usize = 32;

/// A complex number of each line.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wide {
    re: [f64; LINES],
    im: [f64; LINES],
}

impl Wide {
    pub(super) const ZERO: Self = Self { re: [0.0; LINES], im: [0.0; LINES] };
    pub(super) const ONE: Self = Self { re: [1.0; LINES], im: [0.0; LINES] };

    pub(super) fn from_fn(number: impl Fn(usize) -> Complex64) -> Self {
        let mut wide = Self::ZERO;
        (0..LINES).for_each(|line| wide.set(line, number(line)));
        wide
    }

    pub(super) fn at(&self, line: usize) -> Complex64 {
        Complex64::new(self.re[line], self.im[line])
    }

    /// Real parts and imaginary parts.
    pub(super) fn parts(&self) -> [&[f64; LINES]; 2] {
        [&self.re, &self.im]
    }

    pub(super) fn set(&mut self, line: usize, number: Complex64) {
        (self.re[line], self.im[line]) = (number.re, number.im);
    }

    #[inline(always)]
    pub(super) fn times(&self, other: &Self) -> Self {
        let mut product = Self::ZERO;
        product.add_product(self, other);
        product
    }

    #[inline(always)]
    pub(super) fn scaled(&self, factor: f64) -> Self {
        let mut product = Self::ZERO;
        product.add_scaled(factor, self);
        product
    }

    #[inline(always)]
    pub(super) fn add(&mut self, other: &Self) {
        for line in 0..LINES {
            self.re[line] += other.re[line];
            self.im[line] += other.im[line];
        }
    }

    /// Adds a multiple.
    #[inline(always)]
    pub(super) fn add_scaled(&mut self, factor: f64, other: &Self) {
        for line in 0..LINES {
            self.re[line] += factor * other.re[line];
            self.im[line] += factor * other.im[line];
        }
    }

    /// Adds $ab$.
    #[inline(always)]
    pub(super) fn add_product(&mut self, a: &Self, b: &Self) {
        for line in 0..LINES {
            self.re[line] += a.re[line] * b.re[line] - a.im[line] * b.im[line];
            self.im[line] += a.re[line] * b.im[line] + a.im[line] * b.re[line];
        }
    }

    /// $1/z$.
    #[inline(always)]
    pub(super) fn inverse(&self) -> Self {
        let mut inverse = Self::ZERO;
        for line in 0..LINES {
            let size = 1.0 / (self.re[line] * self.re[line] + self.im[line] * self.im[line]);
            inverse.re[line] = self.re[line] * size;
            inverse.im[line] = -self.im[line] * size;
        }
        inverse
    }

    /// $\sqrt z$, principal branch.
    pub(super) fn root(&self) -> Self {
        Self::from_fn(|line| self.at(line).sqrt())
    }
}

/// The numbers of a view on each line.
pub(super) trait Numbers {
    /// Number `index` itself.
    fn wide(&self, index: usize) -> Wide;

    /// Its root.
    fn root(&self, index: usize) -> Wide;

    /// One over its root, which is known.
    fn inverse_root(&self, index: usize, root: &Wide) -> Wide;

    /// Adds it times `to` to `sum`.
    fn add(&self, index: usize, to: &Wide, sum: &mut Wide);

    /// Adds the product of two of them times `to` to `sum`.
    fn add_pair(&self, pair: [usize; 2], to: &Wide, sum: &mut Wide);
}

/// The same real numbers on all lines.
pub(super) struct Even<'a>(pub &'a [f64]);

impl Numbers for Even<'_> {
    #[inline(always)]
    fn wide(&self, index: usize) -> Wide {
        Wide { re: [self.0[index]; LINES], im: [0.0; LINES] }
    }

    #[inline(always)]
    fn root(&self, index: usize) -> Wide {
        Wide { re: [self.0[index].sqrt(); LINES], im: [0.0; LINES] }
    }

    #[inline(always)]
    fn inverse_root(&self, index: usize, _: &Wide) -> Wide {
        Wide { re: [self.0[index].sqrt().recip(); LINES], im: [0.0; LINES] }
    }

    #[inline(always)]
    fn add(&self, index: usize, to: &Wide, sum: &mut Wide) {
        sum.add_scaled(self.0[index], to);
    }

    #[inline(always)]
    fn add_pair(&self, [first, second]: [usize; 2], to: &Wide, sum: &mut Wide) {
        sum.add_scaled(self.0[first] * self.0[second], to);
    }
}

/// Complex numbers that differ from line to line.
pub(super) struct OfLine<'a>(pub &'a [Wide]);

impl Numbers for OfLine<'_> {
    #[inline(always)]
    fn wide(&self, index: usize) -> Wide {
        self.0[index]
    }

    #[inline(always)]
    fn root(&self, index: usize) -> Wide {
        self.0[index].root()
    }

    #[inline(always)]
    fn inverse_root(&self, _: usize, root: &Wide) -> Wide {
        root.inverse()
    }

    #[inline(always)]
    fn add(&self, index: usize, to: &Wide, sum: &mut Wide) {
        sum.add_product(&self.0[index], to);
    }

    #[inline(always)]
    fn add_pair(&self, [first, second]: [usize; 2], to: &Wide, sum: &mut Wide) {
        sum.add_product(&self.0[first].times(&self.0[second]), to);
    }
}
