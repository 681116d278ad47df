//! From a test to the hypotheses that are held against its measured modes.

use orthopanel_data::ImpactTest;
use orthopanel_model::{EffectSetting, RecordSetting, StructureKind, effect};

use crate::IdentifyError;
use crate::comparison::Comparison;
use crate::declared_effects::{declared_parts, pairs_of_places};
use crate::effect_places::{OF_PIECE, OF_RECORD, has_place, is_of_record};
use crate::free_constants::FreeConstants;
use crate::measured::{MeasuredModes, is_record, measured_as_named};
use crate::outcome::Progress;
use crate::place_readings::refuse_other_places;
use crate::posterior::Judged;
use crate::predicted::Predictor;
use crate::search::Inquiry;
use crate::search_progress::SearchProgress;
use crate::shapes_of_list::names_of_lists;
use crate::shared_error::SharedError;
use crate::stacked::{Block, Stacked};
use crate::structures;

fn too_few(found: usize) -> IdentifyError {
    IdentifyError::TooFewResonances { found, needed: 2, noise_percent: None }
}

/// # Errors
/// [`IdentifyError::Unsupported`] for a declared effect of which nothing says on which piece, or in which record, it is.
pub(crate) fn refuse_several(test: &ImpactTest) -> Result<(), IdentifyError> {
    let records = test.measurements.iter().filter(|measurement| is_record(measurement));
    let mut of: Vec<_> = records.map(|of| (of.piece, std::mem::discriminant(&of.data))).collect();
    of.dedup();
    if of.len() < 2 {
        return Ok(());
    }
    let is_of_several_pieces = of.iter().any(|(piece, _)| *piece != of[0].0);
    for declared in &test.effects {
        let effect = effect(&declared.id)?;
        let why = if is_of_record(effect) {
            OF_RECORD
        } else if is_of_several_pieces && has_place(effect) {
            OF_PIECE
        } else {
            continue;
        };
        return Err(IdentifyError::Unsupported(format!("effect {:?}: {why}", declared.id)));
    }
    Ok(())
}

/// Removes from what was measured of a test's only block what its model is known to miss.
pub(crate) type Correct<'a> = &'a dyn Fn(&mut Comparison) -> Result<SharedError, IdentifyError>;

/// What is said from the base of a test, the structure with the effects that the file declares, held against the measured modes, while all that it is held
/// against is at hand.
///
/// # Errors
/// As [`refuse_several`] and [`crate::measured_modes`], lists that no plate meets, and what is said; [`IdentifyError::Model`] for a piece or an effect that has no meaning.
pub(crate) fn from_base<T>(
    test: &ImpactTest,
    correct: Option<Correct>,
    progress: &(dyn Fn(Progress) + Sync),
    say: impl FnOnce(Inquiry, Judged) -> Result<T, IdentifyError>,
) -> Result<T, IdentifyError> {
    let hit = test.measurements.iter().filter(|measurement| is_record(measurement)).map(|record| record.piece);
    let hit: Vec<usize> = hit.collect();
    let largest = || test.pieces.iter().map(|named| named.piece).max_by(|a, b| a.mass().total_cmp(&b.mass()));
    let piece = hit.first().map(|hit| test.pieces[*hit].piece).or_else(largest).ok_or_else(|| too_few(0))?;
    refuse_several(test)?;
    // What is declared wrongly is said before the records are read.
    let structure = structures::of_test(test).kind();
    let constants = FreeConstants::of(test, structure.constants())?;
    let declared = declared_parts(test, &piece, pairs_of_places(test))?;
    let named = names_of_lists(test)?;
    let mut all: Vec<MeasuredModes> =
        measured_as_named(test, &named.names)?.into_iter().map(MeasuredModes::without_faint).collect();
    all.sort_by_key(|of| of.records.is_empty());
    let measured = all.first().ok_or_else(|| too_few(0))?;
    let mut comparisons: Vec<Comparison> =
        all.iter().map(|of| Comparison::new(of, test.pieces[of.piece].piece.mass())).collect();
    let of_piece = |of: &MeasuredModes| EffectSetting {
        piece: test.pieces[of.piece].piece,
        boundary: test.boundary,
        suspension: test.suspension.clone(),
        record: RecordSetting { response_at: of.sensor_at, ..RecordSetting::default() },
    };
    let shared_error = match (correct, &mut comparisons[..]) {
        (None, _) => None,
        (Some(correct), [first]) => Some(correct(first)?),
        (Some(_), _) => return Err(IdentifyError::OtherPanel("the suspect has records and lists".to_owned())),
    };
    let mut blocks = Vec::new();
    for comparison in &comparisons {
        let of = comparison.measured;
        let predictor = Predictor::new(comparison, structure, &of_piece(of))?;
        let is_of_other = !hit.is_empty() && !hit.contains(&of.piece);
        blocks.push(Block { piece: of.piece, is_of_other, predictor, waves: vec![] });
    }
    let begun = Inquiry::begin(Stacked::new(blocks), &constants, &declared, named)?;
    let (mut inquiry, base) = begun.ok_or_else(|| match measured.poles.len() {
        found @ 0..2 => too_few(found),
        _ => IdentifyError::NotFinite { what: "likelihood of the measured modes on any such piece".to_owned() },
    })?;
    if structure == StructureKind::MindlinPlate && !measured.records.is_empty() {
        let (constants, _) = inquiry.stacked.first().values(&base.hypothesis, &base.posterior.point.z)?;
        refuse_other_places(measured, (inquiry.predictor().piece(), test.boundary), &constants)?;
    }
    inquiry.progress = SearchProgress::telling(progress);
    inquiry.shared_error = shared_error;
    say(inquiry, base)
}
