//! What the model leaves of each measured accelerance.

use orthopanel_identify::AcceleranceFit;
use orthopanel_model::Place;

/// What a residual is counted in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ResidualUnit {
    /// The records' own noise: 1 where nothing else is left.
    Noise,
    /// Percent of the rms of the measured accelerance.
    Percent,
}

/// The residual of one pair of places.
pub struct PairResidual {
    pub force: Place,
    pub response: Place,
    pub unit: ResidualUnit,
    /// Frequency \[Hz\] and size of each line.
    pub lines: Vec<(f64, f64)>,
}

impl PairResidual {
    pub fn of(pair: &AcceleranceFit) -> Self {
        let count = pair.measured.len().max(1) as f64;
        let scale = (pair.measured.iter().map(|value| value.norm_sqr()).sum::<f64>() / count).sqrt();
        let unit = if pair.variance.is_some() { ResidualUnit::Noise } else { ResidualUnit::Percent };
        let unit_of = |line: usize| match &pair.variance {
            Some(variance) => variance.get(line).map_or(f64::NAN, |variance| variance.sqrt()),
            None => 0.01 * scale,
        };
        let missed = pair.measured.iter().zip(&pair.model).map(|(measured, model)| (measured - model).norm());
        let lines = pair.frequency.iter().zip(missed).enumerate();
        let lines = lines.map(|(line, (&frequency, missed))| (frequency, missed / unit_of(line)));
        Self {
            force: pair.force_at,
            response: pair.response_at,
            unit,
            lines: lines.filter(|(_, r)| r.is_finite()).collect(),
        }
    }

    /// Root of the mean square over all lines.
    pub fn rms(&self) -> f64 {
        rms(self.lines.iter().map(|(_, size)| *size))
    }

    /// The same over the lines to which no other of the `modes` \[Hz\] is nearer; `None` where a mode has no line.
    pub fn by_mode(&self, modes: &[f64]) -> Vec<Option<f64>> {
        let mut near = vec![Vec::new(); modes.len()];
        for &(frequency, size) in &self.lines {
            let apart = |mode: &usize| (modes[*mode] - frequency).abs();
            let nearest = (0..modes.len()).min_by(|one, other| apart(one).total_cmp(&apart(other)));
            nearest.into_iter().for_each(|mode| near[mode].push(size));
        }
        near.into_iter().map(|sizes| (!sizes.is_empty()).then(|| rms(sizes.into_iter()))).collect()
    }
}

/// Root mean square of lines in `bands` bands of even width up to `highest` \[Hz\], at the bands' middles; bands without
/// lines are left out.
pub fn banded<'a>(lines: impl Iterator<Item = &'a (f64, f64)>, highest: f64, bands: usize) -> Vec<(f64, f64)> {
    let mut sums = vec![(0.0, 0_usize); bands];
    for &(frequency, size) in lines {
        let band = (frequency / highest * bands as f64) as usize;
        if let Some((sum, count)) = sums.get_mut(band.min(bands.saturating_sub(1))) {
            *sum += size * size;
            *count += 1;
        }
    }
    let middle = |band: usize| (band as f64 + 0.5) * highest / bands as f64;
    let filled = sums.into_iter().enumerate().filter(|(_, (_, count))| *count > 0);
    filled.map(|(band, (sum, count))| (middle(band), (sum / count as f64).sqrt())).collect()
}

fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0_usize), |(sum, count), value| (sum + value * value, count + 1));
    (sum / count.max(1) as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use num_complex::Complex64;

    use super::*;

    #[test]
    fn a_residual_as_large_as_its_noise_is_one() {
        let line = |re, im| Complex64::new(re, im);
        let pair = |variance| AcceleranceFit {
            piece: 0,
            force_at: Place { x: 0.0, y: 0.0 },
            response_at: Place { x: 0.1, y: 0.0 },
            decay_rate: 0.0,
            frequency: vec![10.0, 20.0],
            measured: vec![line(3.0, 0.0), line(0.0, 4.0)],
            model: vec![line(3.0, 0.3), line(0.4, 4.0)],
            variance,
        };
        let whitened = PairResidual::of(&pair(Some(vec![0.09, 0.16])));
        assert!((whitened.rms() - 1.0).abs() < 1e-12 && whitened.unit == ResidualUnit::Noise);
        // Without noise: over the rms of 3 and 4, a tenth of either.
        let relative = PairResidual::of(&pair(None));
        assert!((relative.rms() - 10.0).abs() < 1e-12 && relative.unit == ResidualUnit::Percent);
    }

    #[test]
    fn every_line_counts_for_the_nearest_mode() {
        let at = Place { x: 0.0, y: 0.0 };
        let lines = vec![(9.0, 3.0), (12.0, 4.0), (19.0, 7.0)];
        let pair = PairResidual { force: at, response: at, unit: ResidualUnit::Noise, lines };
        assert_eq!(pair.by_mode(&[10.0, 20.0, 40.0]), [Some(12.5_f64.sqrt()), Some(7.0), None]);
    }

    #[test]
    fn bands_hold_the_root_of_the_mean_square() {
        let lines = [(1.0, 3.0), (2.0, 4.0), (9.0, 7.0), (10.0, 7.0)];
        assert_eq!(banded(lines.iter(), 10.0, 5), [(1.0, 3.0), (3.0, 4.0), (9.0, 7.0)]);
        let one = banded(lines[..2].iter(), 10.0, 1);
        assert!((one[0].1 - 12.5_f64.sqrt()).abs() < 1e-12);
    }
}
