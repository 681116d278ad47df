//! From a test to the hypotheses that are held against its measured modes.

use orthopanel_data::ImpactTest;
use orthopanel_model::{BEAM_CONSTANTS, EffectSetting, RecordSetting};

use crate::IdentifyError;
use crate::comparison::Comparison;
use crate::declared_effects::{declared_parts, pairs_of_places};
use crate::free_constants::FreeConstants;
use crate::measured::{MeasuredModes, measured_modes};
use crate::outcome::Progress;
use crate::posterior::Judged;
use crate::search::Inquiry;
use crate::search_progress::SearchProgress;

fn too_few(found: usize) -> IdentifyError {
    IdentifyError::TooFewResonances { found, needed: 2, noise_percent: None }
}

/// What is said from the base of a test, the beam with the effects that the file declares, held against the modes that the records of one piece
/// show, while all that it is held against is at hand.
///
/// # Errors
/// As [`measured_modes`], and what is said; [`IdentifyError::Model`] for a piece or an effect that has no meaning.
pub(crate) fn from_base<T>(
    test: &ImpactTest,
    progress: &(dyn Fn(Progress) + Sync),
    say: impl FnOnce(Inquiry, Judged) -> Result<T, IdentifyError>,
) -> Result<T, IdentifyError> {
    let piece = test.pieces.first().ok_or_else(|| too_few(0))?.piece;
    // What is declared wrongly is said before the records are read.
    let held = FreeConstants::of(test, &BEAM_CONSTANTS)?.held;
    let declared = declared_parts(test, &piece, pairs_of_places(test))?;
    let all: Vec<MeasuredModes> = measured_modes(test)?.into_iter().map(MeasuredModes::without_faint).collect();
    let measured = all.first().ok_or_else(|| too_few(0))?;
    let setting = EffectSetting {
        piece,
        boundary: test.boundary,
        suspension: test.suspension.clone(),
        record: RecordSetting::default(),
    };
    let comparison = Comparison::new(measured, piece.mass());
    let begun = Inquiry::begin(&comparison, &setting, &held, &declared)?;
    let (mut inquiry, base) = begun.ok_or_else(|| match measured.poles.len() {
        found @ 0..2 => too_few(found),
        _ => IdentifyError::NotFinite { what: "likelihood of the measured modes on any beam".to_owned() },
    })?;
    inquiry.progress = SearchProgress::telling(progress);
    say(inquiry, base)
}
