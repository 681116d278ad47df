//! From a test to the hypotheses that are held against its measured modes.

use orthopanel_data::{ImpactTest, MeasurementData};
use orthopanel_model::{BEAM_CONSTANTS, EffectSetting, Place, RecordSetting};

use crate::IdentifyError;
use crate::comparison::Comparison;
use crate::declared_effects::declared_parts;
use crate::hit_strength::HitStrength;
use crate::measured::{MeasuredModes, measured_modes};
use crate::outcome::Progress;
use crate::posterior::Judged;
use crate::search::Inquiry;
use crate::search_progress::SearchProgress;

/// Records of a test: files of the same places are hits of one.
fn pairs_of_places(test: &ImpactTest) -> usize {
    let mut pairs: Vec<[Place; 2]> = Vec::new();
    for measurement in &test.measurements {
        if let MeasurementData::TimeHistory(record) | MeasurementData::Accelerance(record) = &measurement.data {
            let pair = [record.force_at, record.response_at];
            if !pairs.contains(&pair) {
                pairs.push(pair);
            }
        }
    }
    pairs.len()
}

fn too_few(found: usize) -> IdentifyError {
    IdentifyError::TooFewResonances { found, needed: 2, noise_percent: None }
}

/// What is said of the hypotheses that were held against a test, the likeliest first, while all that they were held against is at hand.
///
/// # Errors
/// As [`measured_modes`], and what is said; [`IdentifyError::Unsupported`] for what it does not take, and [`IdentifyError::Model`] for a piece or an effect that has
/// no meaning.
pub(crate) fn with_hypotheses<T>(
    test: &ImpactTest,
    progress: &(dyn Fn(Progress) + Sync),
    say: impl FnOnce(&Inquiry, &[Judged]) -> Result<T, IdentifyError>,
) -> Result<T, IdentifyError> {
    with_base(test, progress, |mut inquiry, base| {
        let band = inquiry.problem(&base.hypothesis).predictor.comparison.measured.band;
        inquiry.hits = HitStrength::new(test, band)?;
        let all = inquiry.search(base);
        say(&inquiry, &all)
    })
}

/// What is said of the hypothesis that nothing is missing beside what the file declares.
///
/// # Errors
/// As [`with_hypotheses`].
pub(crate) fn with_base<T>(
    test: &ImpactTest,
    progress: &(dyn Fn(Progress) + Sync),
    say: impl FnOnce(Inquiry, Judged) -> Result<T, IdentifyError>,
) -> Result<T, IdentifyError> {
    let refused = |what: &str| Err(IdentifyError::Unsupported(what.into()));
    let listed = |data: &MeasurementData| matches!(data, MeasurementData::NaturalFrequencies(_));
    let [named] = &test.pieces[..] else {
        return refused(&format!(
            "records of {} pieces in one test: give each piece a test file of its own",
            test.pieces.len()
        ));
    };
    if test.measurements.iter().any(|measurement| listed(&measurement.data)) {
        return refused(
            "natural frequencies beside records: a trace needs measurements of one kind, put the list into a test file of its own",
        );
    }
    let piece = named.piece;
    // What is declared wrongly is said before the records are read.
    declared_parts(test, &piece, pairs_of_places(test))?;
    let all: Vec<MeasuredModes> = measured_modes(test)?.into_iter().map(MeasuredModes::without_faint).collect();
    let [measured] = &all[..] else {
        return refused(
            "hits beside accelerances: a trace needs measurements of one kind, put the others into a test file of their own",
        );
    };
    let setting = EffectSetting {
        piece,
        boundary: test.boundary,
        suspension: test.suspension.clone(),
        record: RecordSetting::default(),
    };
    let declared = declared_parts(test, &piece, measured.records.len())?;
    let held: Vec<Option<f64>> =
        BEAM_CONSTANTS.iter().map(|constant| test.constants.get(constant.name).copied()).collect();
    let comparison = Comparison::new(measured, piece.mass());
    let begun = Inquiry::begin(&comparison, &setting, &held, &declared)?;
    let (mut inquiry, base) = begun.ok_or_else(|| too_few(measured.poles.len()))?;
    inquiry.progress = SearchProgress::telling(progress);
    say(inquiry, base)
}
