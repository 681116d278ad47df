//! Poles that hardly stand out.

use num_complex::Complex64;

use super::{MeasuredModes, MeasuredRecord};

/// A peak below this part of what all other poles do there is faint: modes that effects bring rise above it, twins do not.
const FAINT: f64 = 0.02;

impl MeasuredModes {
    /// Without poles whose peak is below two hundredths of what all others do there, rms over the records: hits that fall beside each other make
    /// twins of strong poles, which are no modes.
    pub(crate) fn without_faint(self) -> Self {
        let (poles, records) = (self.poles.len(), self.records.len());
        let kept: Vec<bool> = (0..poles).map(|pole| records == 0 || self.prominence(pole) >= FAINT).collect();
        self.with_poles(&kept)
    }

    /// The lowest poles alone.
    pub(crate) fn lowest(&self, count: usize) -> Self {
        let kept: Vec<bool> = (0..self.poles.len()).map(|pole| pole < count).collect();
        self.clone().with_poles(&kept)
    }

    /// Those poles alone that are `kept`.
    fn with_poles(mut self, kept: &[bool]) -> Self {
        let records = self.records.len();
        if kept.iter().all(|kept| *kept) {
            return self;
        }
        let damped = self.poles.iter().map(|pole| pole.damping_ratio.is_some());
        let of_damping = damped.zip(kept).filter(|(damped, _)| *damped).map(|(_, kept)| *kept);
        let remainder = vec![true; 2 * self.remainder_frequencies.len()];
        let of_record = || kept.iter().flat_map(|kept| [*kept; 2]).chain(remainder.iter().copied());
        let all = kept.iter().copied().chain(of_damping).chain((0..records).flat_map(|_| of_record()));
        let places: Vec<usize> = all.enumerate().filter(|(_, kept)| *kept).map(|(place, _)| place).collect();
        self.covariance =
            faer::Mat::from_fn(places.len(), places.len(), |i, j| self.covariance[(places[i], places[j])]);
        let mut number = kept.iter();
        self.poles.retain(|_| number.next().copied().unwrap_or(true));
        for record in &mut self.records {
            let mut number = kept.iter();
            record.residues.retain(|_| number.next().copied().unwrap_or(true));
        }
        self
    }

    /// The peak of a pole over what all others do there, rms over the records.
    pub(crate) fn prominence(&self, pole: usize) -> f64 {
        let at = Complex64::new(0.0, self.poles[pole].lambda().im);
        let line = |record: &MeasuredRecord, other: usize| {
            let (residue, lambda) = (record.residues[other], self.poles[other].lambda());
            residue / (at - lambda) + residue.conj() / (at - lambda.conj())
        };
        let own: f64 = self.records.iter().map(|record| line(record, pole).norm_sqr()).sum();
        let others = |record: &MeasuredRecord| {
            (0..self.poles.len()).filter(|other| *other != pole).map(|other| line(record, other)).sum::<Complex64>()
        };
        let beside: f64 = self.records.iter().map(|record| others(record).norm_sqr()).sum();
        (own / beside).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use orthopanel_model::Place;

    use super::super::Pole;
    use super::*;

    #[test]
    fn a_twin_is_left_out_with_its_covariance() {
        let pole = |angular_frequency: f64| Pole { angular_frequency, damping_ratio: Some(0.005) };
        let place = Place { x: 0.1, y: 0.0 };
        let residues = [Complex64::new(0.0, 50.0), Complex64::new(0.0, 0.05), Complex64::new(0.0, 40.0)];
        let record = MeasuredRecord {
            force_at: place,
            response_at: place,
            residues: residues.to_vec(),
            remainder: vec![Complex64::ONE],
        };
        let measured = MeasuredModes {
            piece: 0,
            poles: vec![pole(2000.0), pole(2010.0), pole(5000.0)],
            beside: vec![],
            records: vec![record],
            sensor_at: None,
            remainder_frequencies: vec![20.0],
            band: [10.0, 1000.0],
            covariance: faer::Mat::from_fn(14, 14, |i, j| if i == j { i as f64 } else { 0.0 }),
            chi_square: Some(1.0),
            missed_most: None,
            undone_decay: 0.0,
            named: orthopanel_model::NamedShapes::default(),
            order: vec![],
        };
        let left = measured.without_faint();
        assert_eq!(left.poles, [pole(2000.0), pole(5000.0)]);
        assert_eq!(left.records[0].residues, [residues[0], residues[2]]);
        let diagonal: Vec<f64> = (0..left.covariance.nrows()).map(|i| left.covariance[(i, i)]).collect();
        assert_eq!(diagonal, [0.0, 2.0, 3.0, 5.0, 6.0, 7.0, 10.0, 11.0, 12.0, 13.0]);
        assert_eq!(left.values().len(), diagonal.len());
    }
}
