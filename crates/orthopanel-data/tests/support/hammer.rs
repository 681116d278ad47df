//! Hits on a system whose transfer function is known in closed form.

use num_complex::Complex64;
use orthopanel_data::{Accelerance, Hit, TimeHistory};
use orthopanel_model::Place;

pub const RATE: f64 = 1000.0;

/// $a_n = 2 r \cos\theta\, a_{n-1} - r^2 a_{n-2} + f_n$, with $H(z) = 1/(1 - 2 r \cos\theta\, z^{-1} + r^2 z^{-2})$.
#[derive(Clone, Copy)]
pub struct Resonator {
    pub radius: f64,
    pub angle: f64,
}

impl Resonator {
    /// $H$ at $z = e^{s/\mathrm{rate}}$, $s = \sigma + j 2\pi f$.
    pub fn transfer(self, sigma: f64, frequency: f64) -> Complex64 {
        let back = (-Complex64::new(sigma, std::f64::consts::TAU * frequency) / RATE).exp();
        1.0 / (1.0 - 2.0 * self.radius * self.angle.cos() * back + self.radius.powi(2) * back * back)
    }

    /// A hit of `samples` samples at a fifth of the record: a pulse $k\,0.6^k$, whose spectrum has no zero and falls
    /// by 24 dB up to half the rate. `height` scales it; its peak is 0.72 of that.
    pub fn hit(self, samples: usize, height: f64) -> Hit {
        let pulse = |n: usize| n.checked_sub(samples / 5).map_or(0.0, |k| height * k as f64 * 0.6f64.powi(k as i32));
        self.respond((0..samples).map(pulse).collect())
    }

    /// A softer hit: a Gaussian pulse of standard deviation 2 ms, 20 dB down at 171 Hz and nothing above 300 Hz.
    pub fn soft_hit(self, samples: usize, height: f64) -> Hit {
        let pulse = |n: usize| height * (-0.5 * ((n as f64 - samples as f64 / 5.0) / 2.0).powi(2)).exp();
        self.respond((0..samples).map(pulse).collect())
    }

    pub fn respond(self, force: Vec<f64>) -> Hit {
        let (mut before, mut last) = (0.0, 0.0);
        let acceleration = force
            .iter()
            .map(|force| {
                let now = 2.0 * self.radius * self.angle.cos() * last - self.radius.powi(2) * before + force;
                (before, last) = (last, now);
                now
            })
            .collect();
        Hit { force, acceleration }
    }
}

pub fn history(hits: Vec<Hit>) -> TimeHistory {
    let place = Place { x: 0.0, y: 0.0 };
    TimeHistory::new("hits.uff", [place, place], RATE, hits)
}

/// Greatest relative deviation from the resonator's transfer function.
pub fn deviation(found: &Accelerance, resonator: Resonator) -> f64 {
    let lines = found.frequency.iter().zip(&found.value);
    lines.fold(0.0, |worst, (&frequency, value)| {
        let exact = resonator.transfer(found.decay_rate, frequency);
        worst.max((value - exact).norm() / exact.norm())
    })
}

/// Normal deviates from a fixed seed: twelve uniform ones summed, good to three standard deviations.
pub struct Noise(pub u64);

impl Noise {
    pub fn next(&mut self) -> f64 {
        (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0
    }

    fn uniform(&mut self) -> f64 {
        // Knuth's MMIX generator; its high bits are good.
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// `hit` with noise of these standard deviations on its channels.
    pub fn over(&mut self, hit: &Hit, force: f64, acceleration: f64) -> Hit {
        let mut noisy = |values: &[f64], level: f64| values.iter().map(|value| value + level * self.next()).collect();
        Hit { force: noisy(&hit.force, force), acceleration: noisy(&hit.acceleration, acceleration) }
    }
}
