//! A force history and how it runs between its samples: the instants that a model or an FMU is stepped through.

use std::path::Path;

use orthopanel_data::limits;
use orthopanel_identify::ForceBetweenSamples;
use orthopanel_model::Readable;

use crate::error::Error;
use crate::force_file::ForceHistory;
use crate::motion::Motion;
use crate::notes::note;
use crate::observer::Observer;

/// Greatest departure of a sample's time from an even grid, over the step: what printed times lose by rounding.
const UNEVEN: f64 = 1e-3;
/// Greatest difference of the last force from the first, over the peak, that is passed over in silence.
const JUMP: f64 = 0.01;

/// How a force runs between two samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Hold {
    /// In a straight line from sample to sample.
    #[default]
    Linear,
    /// As the smooth function without content above half the rate.
    BandLimited,
    /// At the value of the earlier sample.
    Held,
}

/// Forces that are held, or that run in straight lines, from one instant of `stepped` to the next.
pub struct DrivingForce {
    /// The samples as they were read.
    pub samples: ForceHistory,
    finer: Option<ForceHistory>,
    /// Steps from one sample to the next.
    steps: usize,
    held: bool,
}

impl DrivingForce {
    /// `path` names the force file in messages.
    pub fn new(samples: ForceHistory, hold: Hold, path: &Path, observer: &dyn Observer) -> Result<Self, Error> {
        let held = hold == Hold::Held;
        if hold != Hold::BandLimited {
            return Ok(Self { samples, finer: None, steps: 1, held });
        }
        let (found, most) = (samples.time.len() * samples.forces.len(), limits::BAND_LIMITED_SAMPLES);
        if found > most {
            return Err(Error::ForceFile {
                path: path.into(),
                line: None,
                problem: format!(
                    "{found} samples: --hold band-limited keeps many finer ones for each in memory and takes {most} at most; linear does not, or \
                     cut the force into pieces"
                ),
            });
        }
        let interval = even_interval(&samples.time).map_err(|line| Error::ForceFile {
            path: path.into(),
            line: None,
            problem: format!(
                "sample {line} is off the even grid: --hold band-limited needs even times, linear does not"
            ),
        })?;
        if let Some((first, last)) = samples.forces.iter().find_map(|force| jump(force)) {
            let name = path.display();
            note(
                observer,
                "",
                &[format!(
                    "{name}: the force begins at {} N and ends at {} N: band-limited, it rings at both ends; add silence",
                    Readable(first),
                    Readable(last)
                )],
            );
        }
        let lines = |force: &Vec<f64>| ForceBetweenSamples::BandLimited.straight_lines(force);
        let steps = samples.forces.first().map_or(1, |force| lines(force).1);
        let forces: Vec<Vec<f64>> = samples.forces.iter().map(|force| lines(force).0).collect();
        let start = samples.time.first().copied().unwrap_or_default();
        let count = forces.first().map_or(0, Vec::len);
        let time = (0..count).map(|index| start + index as f64 * interval / steps as f64).collect();
        Ok(Self { samples, finer: Some(ForceHistory { time, forces }), steps, held })
    }

    /// The instants to step through, with their forces.
    pub fn stepped(&self) -> &ForceHistory {
        self.finer.as_ref().unwrap_or(&self.samples)
    }

    /// Whether a force stays at its value until the next instant; it runs there in a straight line otherwise.
    pub fn is_held(&self) -> bool {
        self.held
    }

    /// Motions at the samples, of those at all instants.
    pub fn at_samples(&self, motions: Vec<Motion>) -> Vec<Motion> {
        let thinned = |values: Vec<f64>| values.into_iter().step_by(self.steps).collect();
        let motion = |motion: Motion| Motion {
            acceleration: thinned(motion.acceleration),
            velocity: thinned(motion.velocity),
            displacement: thinned(motion.displacement),
        };
        motions.into_iter().map(motion).collect()
    }
}

/// The interval of even times; `Err` is the first sample, from 1, that is off the grid.
fn even_interval(time: &[f64]) -> Result<f64, usize> {
    let (Some(&first), Some(&last)) = (time.first(), time.last()) else { return Err(1) };
    let interval = (last - first) / time.len().saturating_sub(1).max(1) as f64;
    let off = |(index, &time): (usize, &f64)| (time - first - index as f64 * interval).abs() > UNEVEN * interval;
    match time.iter().enumerate().position(off) {
        Some(index) => Err(index + 1),
        None => Ok(interval),
    }
}

/// First and last force where they differ.
fn jump(force: &[f64]) -> Option<(f64, f64)> {
    let (&first, &last) = (force.first()?, force.last()?);
    let peak = force.iter().fold(0.0_f64, |peak, value| peak.max(value.abs()));
    ((last - first).abs() > JUMP * peak).then_some((first, last))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_off_the_grid_are_found() {
        assert_eq!(even_interval(&[1.0, 1.5, 2.0]), Ok(0.5));
        assert_eq!(even_interval(&[0.0, 0.5, 0.9, 1.5]), Err(3));
    }

    #[test]
    fn regress_a_force_that_would_fill_the_memory_is_refused() {
        let count = limits::BAND_LIMITED_SAMPLES + 1;
        let samples =
            ForceHistory { time: (0..count).map(|i| i as f64 * 1e-4).collect(), forces: vec![vec![0.0; count]] };
        let refused = DrivingForce::new(samples, Hold::BandLimited, Path::new("force.csv"), &crate::Silent)
            .err()
            .expect("refused");
        let said = refused.to_string();
        assert!(said.contains("2000001 samples") && said.contains("linear does not"), "{said}");
    }

    #[test]
    fn only_a_force_that_ends_elsewhere_jumps() {
        assert_eq!(jump(&[0.0, 100.0, 0.5]), None);
        assert_eq!(jump(&[0.0, 100.0, 2.0]), Some((0.0, 2.0)));
    }
}
