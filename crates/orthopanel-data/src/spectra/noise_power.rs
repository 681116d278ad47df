//! Power of the noise of a hit's channels.

use super::channel_noise::ChannelNoise;

/// What white noise of a hit's channels adds to $|F|^2$ and $|A|^2$ of any line.
#[derive(Clone, Copy)]
pub(super) struct NoisePower {
    force: f64,
    acceleration: f64,
}

impl NoisePower {
    /// Of every hit, `None` where not all tell theirs; `windowed` are the sums of the squared windows over force and
    /// acceleration.
    pub(super) fn of(hits: &[Option<ChannelNoise>], windowed: [f64; 2]) -> Option<Vec<Self>> {
        let told: Vec<ChannelNoise> = hits.iter().copied().collect::<Option<_>>()?;
        let channel = |deviation: fn(&ChannelNoise) -> f64, windowed: f64| {
            let powers: Vec<f64> = told.iter().map(|noise| deviation(noise).powi(2) * windowed).collect();
            // No noise read is noise below the converter's step: alike in all hits.
            let mean = powers.iter().sum::<f64>() / powers.len().max(1) as f64;
            if powers.contains(&0.0) { vec![mean; powers.len()] } else { powers }
        };
        let (force, acceleration) =
            (channel(|noise| noise.force, windowed[0]), channel(|noise| noise.acceleration, windowed[1]));
        let both = force.into_iter().zip(acceleration);
        Some(both.map(|(force, acceleration)| Self { force, acceleration }).collect())
    }

    /// $N_a + |H|^2N_f$ of a line with this $|H|^2$.
    pub(super) fn of_line(self, power: f64) -> f64 {
        self.acceleration + power * self.force
    }

    /// $N_a$.
    pub(super) fn of_acceleration(self) -> f64 {
        self.acceleration
    }

    /// $N_f$.
    pub(super) fn of_force(self) -> f64 {
        self.force
    }
}
