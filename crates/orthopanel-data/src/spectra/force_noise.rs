//! What the noise of the force's own channel does to an averaged line.

use super::{estimation::Estimator, spectrum::Sums, window::Window};

/// The part of an accelerance's errors that comes from the noise of the force under a force window.
///
/// Of the noise $\nu$ no more is left than what lies within $h$ of the blow, so that its spectrum runs smoothly from line to
/// line: the error is $-H(f)\,\epsilon(f)$ with $E\,\epsilon(f)\overline{\epsilon(g)} \propto
/// \mathrm{sinc}(2h(f-g))$. It shifts all lines of a resonance alike.
#[derive(Debug, Clone, PartialEq)]
pub struct ForceNoise {
    /// Half the width $h$ of the force window \[s\].
    pub half_width: f64,
    /// Variance of each line that comes from it, $|H|^2 N_f/\sum|F|^2$ \[((m/s²)/N)²\]; part of the whole variance.
    pub variance: Vec<f64>,
    /// Variance of the rest of each line's errors, independent from line to line, as the noise before the blows and what strong
    /// lines scatter beyond it tell \[((m/s²)/N)²\]; the scatter of the hits may show more.
    pub independent: Vec<f64>,
}

impl ForceNoise {
    /// Without lines yet; `None` where no window shortens the force, or a hit does not tell its noise.
    pub(super) fn beneath(window: Window, sums: &Sums, length: f64) -> Option<Self> {
        let half_width = window.force_half_width().filter(|half_width| 2.0 * half_width < length)?;
        sums.noise.as_ref()?;
        Some(Self { half_width, variance: Vec::new(), independent: Vec::new() })
    }

    /// Keeps these lines and no others.
    pub(super) fn keep(&mut self, lines: &[usize]) {
        for values in [&mut self.variance, &mut self.independent] {
            *values = lines.iter().filter_map(|&line| values.get(line).copied()).collect();
        }
    }

    /// Adds the line of the spectra with this number, at which $|H|^2$ is `power`; a part `astray` of each hit's motion comes to
    /// its channels' noise.
    pub(super) fn push(&mut self, sums: &Sums, (line, power): (usize, f64), astray: f64) {
        let (shared, _) = sums.force_noise(line);
        self.variance.push(power * shared);
        self.independent.push(sums.independent_noise(line, power, astray));
    }
}

impl Sums {
    /// The part of its size by which a line is too low for the forces' noise; zero where a hit does not tell its own.
    pub(super) fn bias(&self, line: usize, estimator: Estimator) -> f64 {
        let (_, biased) = self.force_noise(line);
        // H_1 divides by S_ff, H_v by its root, H_2 not at all.
        match estimator {
            Estimator::H1 => biased,
            Estimator::Hv => 0.5 * biased,
            Estimator::H2 => 0.0,
        }
    }

    /// The noise $N_i$ of the hits' forces at a line over $\sum|F|^2$: weighed with the hits' shares $h_i$ as in $H_1$,
    /// $\sum h_iN_i$, and as $|H_1|$ is too low by it, $\sum(1-h_i)N_i$. Of a single hit $A/(F+\nu)$ has the mean $A/F$.
    fn force_noise(&self, line: usize) -> (f64, f64) {
        let all = self.force[line];
        let hits = self.powers.iter().zip(self.noise.iter().flatten());
        hits.fold((0.0, 0.0), |(shared, biased), (powers, noise)| {
            let (share, part) = (powers[line] / all, noise.of_force() / all);
            (shared + share * part, biased + (1.0 - share) * part)
        })
    }

    /// $\sum h_iN_i/\sum|F|^2$ of the accelerations' noise and of what goes astray with each hit's motion.
    fn independent_noise(&self, line: usize, power: f64, astray: f64) -> f64 {
        let all = self.force[line];
        let hits = self.powers.iter().zip(self.noise.iter().flatten());
        hits.map(|(powers, noise)| {
            let own = powers[line];
            own / all * (noise.of_acceleration() + astray * power * own) / all
        })
        .sum()
    }

    /// The noise of all forces together in any line of $\sum|F|^2$; zero where a hit does not tell its own.
    pub(super) fn noise_of_forces(&self) -> f64 {
        self.noise.iter().flatten().map(|noise| noise.of_force()).sum()
    }
}
