//! The poles of each record by itself: a test drifts, and its records tell by how much.

use orthopanel_data::Accelerance;
use rayon::prelude::*;

use super::poles::fit_pole;
use super::records::PlaceRecord;

/// One resonance as one record shows it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RecordPole {
    /// Natural frequency \[Hz\].
    pub frequency: f64,
    /// Relative standard deviation of the same by the record's own noise.
    pub std: f64,
}

/// A record whose peak does not tell its width to this logarithm lies near a node: it says nothing of the frequency.
const SURE: f64 = 0.1;
/// Half-power widths, and part of the frequency, within which a record's peak is looked for.
const REACH: (f64, f64) = (6.0, 1e-3);

/// The poles of every record near natural frequencies \[Hz\] with their damping ratios: a list for each of `near` with an
/// entry a record.
pub(crate) fn record_poles(accelerances: &[Accelerance], near: &[(f64, f64)]) -> Vec<Vec<Option<RecordPole>>> {
    let records: Vec<PlaceRecord> = accelerances.par_iter().map(PlaceRecord::of).collect();
    let of_mode = |&(frequency, zeta): &(f64, f64)| {
        let reach = (REACH.0 * zeta * frequency).max(REACH.1 * frequency);
        records.par_iter().map(|record| of_record(record, frequency, reach)).collect()
    };
    near.iter().map(of_mode).collect()
}

fn of_record(record: &PlaceRecord, frequency: f64, reach: f64) -> Option<RecordPole> {
    let power: Vec<f64> = record.value.iter().map(|value| value.norm_sqr()).collect();
    let first = record.frequency.partition_point(|&f| f < frequency - reach);
    let end = record.frequency.partition_point(|&f| f <= frequency + reach);
    let peak = (first..end).max_by(|&a, &b| power[a].total_cmp(&power[b]))?;
    let (pole, _) = fit_pole(record, &power, peak)?;
    // Of one resonance the frequency is known to its half width as well as the damping is to its own size.
    let std = pole.zeta * pole.log_zeta_std;
    (pole.log_zeta_std < SURE).then_some(RecordPole { frequency: pole.frequency, std })
}
