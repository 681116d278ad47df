//! Records and test file that speak of different things.

use num_complex::Complex64;
use orthopanel_data::{ImpactTest, Measurement};

use super::misfit::{misfit_percent, record_misfit_percent};
use super::other_units::other_units;
use super::problem::AcceleranceProblem;
use super::record_apart::{exchanged, record_apart};
use super::record_name::record_name;
use super::records::PlaceRecord;
use crate::IdentifyError;
use crate::declared_effects::pairs_of_places;
use crate::structures::{self, Shown};

/// Median misfit of a line \[%\] above which records and test file speak of different things. The median leaves out the
/// peaks, where a right model with a wrong digit misses wholly, and the valleys, where noise does.
const CONTRADICTION: f64 = 40.0;
/// The same of one record: an effect that the model lacks may bend one by half, a wrong place, file or sign by all.
const RECORD_CONTRADICTION: f64 = 80.0;

/// Refuses records that contradict the test file; a sentence on the one that stands apart where it may be kept.
/// `resonances` \[Hz\] are those that no mode took.
pub(super) fn contradiction(
    test: &ImpactTest,
    problem: &AcceleranceProblem,
    parameters: &[f64],
    lines: &[Vec<Complex64>],
    resonances: &[f64],
) -> Result<Option<String>, IdentifyError> {
    let records: Vec<(usize, &PlaceRecord)> =
        problem.pieces.iter().flat_map(|piece| piece.records.iter().map(|record| (piece.piece, record))).collect();
    let misfits = records.iter().zip(lines).map(|((_, record), model)| record_misfit_percent(record, model));
    let worst = misfits.zip(&records).max_by(|a, b| a.0.total_cmp(&b.0));
    let Some((worst_percent, &(piece, record))) = worst else { return Ok(None) };
    let name = record_name(test, piece, (record.force_at, record.response_at));
    let apart = record_apart(problem, parameters, lines)?;
    let fits_at = apart.as_ref().and_then(|apart| apart.fits_at());
    let factor = apart.as_ref().and_then(|apart| apart.factor());
    let refused = |exchanged_with: Option<String>| IdentifyError::RecordContradiction {
        record: name.clone(),
        percent: worst_percent,
        fits_at: fits_at.filter(|_| exchanged_with.is_none()),
        factor: factor.filter(|_| exchanged_with.is_none()),
        exchanged_with,
    };
    if worst_percent > CONTRADICTION
        && let Some(other) = exchanged(problem, parameters, lines)?
    {
        let (piece, other) = &records[other];
        return Err(refused(Some(record_name(test, *piece, (other.force_at, other.response_at)))));
    }
    if apart.as_ref().is_some_and(|apart| apart.is_misplaced()) {
        return Err(refused(None));
    }
    if let Some(refused) = contradicted(test, &records, lines, resonances) {
        return Err(refused);
    }
    if worst_percent > RECORD_CONTRADICTION {
        return Err(other_units(test, &records, lines).unwrap_or_else(|| refused(None)));
    }
    Ok(apart.map(|apart| apart.note(&name)))
}

/// What is refused where half of all lines miss the model by more than [`CONTRADICTION`]: by the factor that explains it, where one does.
pub(super) fn contradicted(
    test: &ImpactTest,
    records: &[(usize, &PlaceRecord)],
    lines: &[Vec<Complex64>],
    resonances: &[f64],
) -> Option<IdentifyError> {
    let percent = misfit_percent(records.iter().map(|(_, record)| *record).zip(lines));
    if percent <= CONTRADICTION {
        return None;
    }
    let misfits = records.iter().zip(lines).map(|((_, record), model)| record_misfit_percent(record, model));
    let (_, (piece, worst)) = misfits.zip(records).max_by(|a, b| a.0.total_cmp(&b.0))?;
    let record = record_name(test, *piece, (worst.force_at, worst.response_at));
    let refused = match structures::of_test(test).shown() {
        Shown::InPart => IdentifyError::PlateContradiction { record, percent, resonances: resonances.to_vec() },
        Shown::Wholly => IdentifyError::Contradiction { record, percent },
    };
    Some(other_units(test, records, lines).unwrap_or(refused))
}

/// Records from which on one that contradicts the others is left out.
const LEAST_RECORDS: usize = 5;

/// The test without the record that is refused for contradicting the others; `None` where that is not told of one record, where two are exchanged, or where
/// few records are left.
pub(crate) fn without_contradicting(test: &ImpactTest, refused: &IdentifyError) -> Option<ImpactTest> {
    let IdentifyError::RecordContradiction { record, exchanged_with: None, .. } = refused else { return None };
    let is_it = |measurement: &Measurement| {
        let of = measurement.data.recorded()?;
        Some(record_name(test, measurement.piece, (of.force_at, of.response_at)) == *record)
    };
    let mut rest = test.clone();
    rest.measurements.retain(|measurement| is_it(measurement) != Some(true));
    let pairs = pairs_of_places(test);
    (pairs >= LEAST_RECORDS && pairs_of_places(&rest) + 1 == pairs).then_some(rest)
}
