//! Numbers that a seed brings back.

/// Marsaglia's xorshift.
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        // The lowest bits of the generator are its worst.
        self.0.rotate_right(11)
    }

    pub fn below(&mut self, limit: u64) -> u64 {
        (self.bits() >> 11) % limit
    }

    /// One in so many.
    pub fn one_in(&mut self, count: u64) -> bool {
        self.below(count) == 0
    }

    /// Mostly a small number, now and then one of any size, and one that no call should take.
    pub fn number(&mut self) -> f64 {
        match self.below(16) {
            0 => f64::NAN,
            1 => f64::INFINITY,
            2 => f64::from_bits(self.bits()),
            3 => 0.0,
            4 => 10.0_f64.powi(self.below(616) as i32 - 308) * if self.one_in(2) { 1.0 } else { -1.0 },
            _ => self.below(2_000_001) as f64 * 1e-6 - 1.0,
        }
    }
}
