//! Variance of an averaged line from the scatter of hits of unequal strength and unequal noise.

use std::ops::Range;

use super::{extremes::median, spectrum::Sums};

/// Part of the lines, with the weakest or the strongest motion, from which either kind of noise is read.
const TAIL: f64 = 0.3;

/// Standard deviations by which the strong lines must scatter more than the weak ones.
const SURE: f64 = 3.0;

/// Sums of a noise $s_i$ over the hits, each with its share $h_i$.
#[derive(Clone, Copy, Default)]
struct Shared {
    /// $\sum h_is_i$
    once: f64,
    /// $\sum h_i^2s_i$
    twice: f64,
}

impl Shared {
    fn add(&mut self, share: f64, noise: f64) {
        self.once += share * noise;
        self.twice += share * share * noise;
    }

    fn plus(self, part: f64, other: Self) -> Self {
        Self { once: self.once + part * other.once, twice: self.twice + part * other.twice }
    }

    /// $\sum h_is_i$ as the scatter shows it, `squares` being $\sum h_i^2$.
    fn scattered(self, squares: f64) -> f64 {
        self.once * (1.0 + squares) - 2.0 * self.twice
    }
}

/// One line of all hits.
struct Line {
    /// $\sum h_i|A_i-H_1F_i|^2$.
    scatter: f64,
    /// $\sum|F_i|^2$.
    force: f64,
    squares: f64,
    /// The channels' noise, $N_a + |H|^2N_f$.
    channels: Shared,
    /// The hit's own motion, $|HF|^2$.
    motion: Shared,
}

impl Line {
    /// Variance of the line where a part `astray` of each hit's motion comes to its channels' noise.
    fn variance(&self, astray: f64) -> f64 {
        let noise = self.channels.plus(astray, self.motion);
        let seen = noise.scattered(self.squares) / noise.once;
        // Without any noise told, as of computed records, all hits are alike.
        let seen = if seen > 0.0 { seen } else { 1.0 - self.squares };
        (self.scatter / seen / self.force).max(0.0)
    }
}

impl Sums {
    /// Variance of $H_1$ at each of `lines` from the scatter of the hits. With shares $h_i = |F_i|^2/\sum|F|^2$ and a
    /// hit's noise $s_i = E|A_i - HF_i|^2$ it is $\sum h_is_i/\sum|F|^2$. A residual is
    /// $e_i - F_i\sum_j\bar F_je_j/\sum|F|^2$, hence
    /// $$E\sum h_i|A_i-H_1F_i|^2 = \sum h_is_i\,\Big(1-\frac{2\sum h_i^2s_i-\sum h_i^2\sum h_is_i}{\sum h_is_i}\Big).$$
    /// The scatter is divided by the bracket, for which only the noises' ratios count: it is $1-\sum h_i^2$ where all
    /// hits are equally noisy, and a fifth of that for two of 1 : 3 whose noise goes with their strength.
    ///
    /// The ratios are read from the channels before each blow, and from what strong lines scatter beyond them, which is
    /// taken to go with the hit's own motion: the part of it that does is the second number. Where a record begins with its blow,
    /// all hits are taken as equally noisy.
    pub(super) fn variance(&self, lines: Range<usize>) -> (Vec<f64>, f64) {
        let lines: Vec<Line> = lines.map(|line| self.line(line)).collect();
        let astray = if self.noise.is_some() { self.astray(&lines) } else { 0.0 };
        (lines.iter().map(|line| line.variance(astray)).collect(), astray)
    }

    fn line(&self, line: usize) -> Line {
        let (force, quotient) = (self.force[line], self.cross[line] / self.force[line]);
        let power = quotient.norm_sqr();
        let (force4, motion, cross) = self.weighted(line);
        let misfit = motion - 2.0 * (quotient.conj() * cross).re + power * force4;
        let mut sums = Line {
            scatter: misfit / force,
            force,
            squares: force4 / (force * force),
            channels: Shared::default(),
            motion: Shared::default(),
        };
        let per_force = 1.0 / force;
        for (hit, noise) in self.powers.iter().zip(self.noise.iter().flatten()) {
            let share = hit[line] * per_force;
            sums.channels.add(share, noise.of_line(power));
            sums.motion.add(share, power * hit[line]);
        }
        sums
    }

    /// Part of a hit's own motion that strong lines scatter by beyond the channels' noise, over what weak lines show
    /// of that; zero where chance alone may be it.
    fn astray(&self, lines: &[Line]) -> f64 {
        let differences = self.powers.len() as f64 - 1.0;
        // A chi-square's median over its mean (Wilson and Hilferty).
        let of_mean = (1.0 - 1.0 / (9.0 * differences)).powi(3);
        let mut lines: Vec<[f64; 3]> = lines
            .iter()
            .map(|line| {
                let expected = |noise: Shared| noise.scattered(line.squares);
                [line.scatter / of_mean, expected(line.channels), expected(line.motion)]
            })
            .filter(|line| line.iter().all(|part| part.is_finite()))
            .collect();
        let tail = (TAIL * lines.len() as f64) as usize;
        if tail == 0 {
            return 0.0;
        }
        let by_motion = |a: &[f64; 3], b: &[f64; 3]| (a[2] * b[1]).total_cmp(&(b[2] * a[1]));
        let (from, last) = (lines.len() - tail, lines.len() - 1);
        lines.select_nth_unstable_by(tail - 1, by_motion);
        if let Some(rest) = lines.get_mut(tail..).filter(|rest| !rest.is_empty()) {
            rest.select_nth_unstable_by(from.min(last) - tail, by_motion);
        }
        let (weak, strong) = (lines.get(..tail).unwrap_or_default(), lines.get(from..).unwrap_or_default());
        let over_channels = |[seen, channels, _]: &[f64; 3]| seen / channels;
        let level = median(weak.iter().map(over_channels).collect());
        // Two medians of so many exponential numbers, each known to 1.44 of itself over the root of their count.
        let chance = 1.44 * (2.0 / (tail as f64 * differences)).sqrt();
        if median(strong.iter().map(over_channels).collect()) / level > 1.0 + SURE * chance {
            let beyond = strong.iter().map(|[seen, channels, motion]| (seen - level * channels) / motion);
            (median(beyond.collect()) / level).max(0.0)
        } else {
            0.0
        }
    }
}
