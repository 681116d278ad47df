//! Numbers of several modes, one operation on all of them.

use std::ops::{Add, Mul, Sub};

/// Modes are handled in groups of this many: a vector of AVX2, two of what every processor has.
pub(super) const LANES: usize = 4;

/// One number of each mode in a group. The compiler turns each operation into vector instructions, of the width that
/// the function into which it is inlined was compiled for. Number by number, so that no loop is
/// left to unroll first.
#[derive(Debug, Clone, Copy, Default)]
#[repr(align(32))]
pub(super) struct Lane(pub [f64; LANES]);

impl Lane {
    /// Up to [`LANES`] numbers, filled up with zeros.
    pub(super) fn of(values: &[f64]) -> Self {
        let mut lane = Self::default();
        for (to, from) in lane.0.iter_mut().zip(values) {
            *to = *from;
        }
        lane
    }

    /// The same number for all modes.
    #[inline(always)]
    pub(super) fn all(value: f64) -> Self {
        Self([value; LANES])
    }

    /// Is each number at most `largest`? None of those that are none is. Asked of all at once: an early answer would be a
    /// branch a number.
    #[inline(always)]
    pub(super) fn is_below(self, largest: f64) -> bool {
        let [a, b, c, d] = self.0;
        (a <= largest) & (b <= largest) & (c <= largest) & (d <= largest)
    }

    /// Sum, one after the other: a sum by halves would let the compiler cut the vectors of the loop before it in half.
    #[inline(always)]
    pub(super) fn sum(self) -> f64 {
        let [a, b, c, d] = self.0;
        a + b + c + d
    }
}

macro_rules! by_element {
    ($($trait:ident $method:ident $operator:tt;)*) => {$(
        impl $trait for Lane {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
                Self([a $operator e, b $operator f, c $operator g, d $operator h])
            }
        }
    )*};
}

by_element! {
    Add add +;
    Sub sub -;
    Mul mul *;
}
