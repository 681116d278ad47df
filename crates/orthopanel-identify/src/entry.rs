//! The entry: what the test holds decides which of the paper's two problems is solved.

use orthopanel_data::{ImpactTest, MeasurementData};
use orthopanel_model::{ModelError, StructureKind};

use crate::answer::{PlateByModes, identify_lists_with_effects, identify_with_effects, without_repeats};
use crate::measured::is_record;
use crate::place_readings::untold;
use crate::shapes_of_list::shapes_by_frequency;
use crate::{
    DampingLaw, Identification, IdentifyError, Search, Settings, accelerance_fit, frequency_fit, known_beforehand,
};

/// Finds the constants of a test, and its damping where there are records: eq. 22 for natural frequencies, the whole
/// complex accelerance for records. Starting values are found here. Effects that the test file declares are part of the
/// model; what it leaves out of their parameters is identified too. Priors of constants, and standard deviations of sizes and mass,
/// are carried into constants and covariance.
///
/// `settings` may be a [`crate::Search`] alone.
///
/// # Errors
/// [`IdentifyError`]: too few data, an unknown constant, no convergence, a constant on its bound or known no better than
/// its own size, records that contradict the test file, records that cannot be
/// read, or a test that this version cannot evaluate.
pub fn identify(test: &ImpactTest, settings: impl Into<Settings>) -> Result<Identification, IdentifyError> {
    let settings = settings.into();
    settings.paper_weights.check()?;
    Ok(identify_without_contradicting(test, settings)?.0)
}

/// As [`identify`]: a record that contradicts all others, which agree, is left out, and said; with the test without it where one is.
///
/// # Errors
/// As [`identify`].
pub(crate) fn identify_without_contradicting(
    test: &ImpactTest,
    settings: Settings,
) -> Result<(Identification, Option<ImpactTest>), IdentifyError> {
    let refused = match identify_all(test, settings) {
        Ok(found) => return Ok((found, None)),
        Err(refused) => refused,
    };
    let Some(rest) = accelerance_fit::without_contradicting(test, &refused) else { return Err(refused) };
    let Ok(mut found) = identify_all(&rest, settings) else { return Err(refused) };
    found.notes.insert(0, format!("{refused}; it is left out: what is found is of the other records, which agree"));
    Ok((found, Some(rest)))
}

fn identify_all(test: &ImpactTest, settings: Settings) -> Result<Identification, IdentifyError> {
    let mut found = known_beforehand::carried(test, of_data(test, settings)?, |test| of_data(test, settings))?;
    let modes = found.pieces.iter().map(|piece| piece.modes.len()).sum();
    found.common_gain = accelerance_fit::common_gain(&found.accelerances, modes);
    if let Some(gain) = found.common_gain {
        found.notes.insert(0, accelerance_fit::said_of_gain(gain, test));
    }
    found.notes.extend(untold(test));
    Ok(found)
}

/// What the data alone say.
fn of_data(test: &ImpactTest, settings: Settings) -> Result<Identification, IdentifyError> {
    let is_frequencies = |data: &MeasurementData| matches!(data, MeasurementData::NaturalFrequencies(_));
    let lists = test.measurements.iter().filter(|measurement| is_frequencies(&measurement.data)).count();
    if lists > 0 {
        let (once, notes) = without_repeats(test);
        let mut found = of_once(&once, lists - notes.len(), settings)?;
        found.notes.extend(notes);
        return Ok(found);
    }
    of_once(test, lists, settings)
}

/// The same where each list stands once; `lists` is their number.
fn of_once(test: &ImpactTest, lists: usize, settings: Settings) -> Result<Identification, IdentifyError> {
    if !test.effects.is_empty() || (lists > 0 && lists < test.measurements.len()) {
        return by_modes_alone(test, lists, settings);
    }
    if lists == test.measurements.len() {
        let read = frequency_fit::likeliest_reading(test);
        let test = read.as_ref().map_or(test, |read| &read.test);
        let of_held = |error| of_held_constants(test, error);
        let by_frequencies = |test: &ImpactTest| frequency_fit::identify_frequencies(test, settings.search);
        let found = by_frequencies(test).or_else(|refused| {
            // Modes of any kind, where bending modes alone do not meet a list without shapes.
            let is_far = matches!(refused, IdentifyError::FarFromList { .. });
            let Some(read) = is_far.then(|| shapes_by_frequency(test)).transpose()?.flatten() else {
                return Err(refused);
            };
            let Ok(mut found) = by_frequencies(&read.test) else { return Err(refused) };
            found.notes.splice(..0, read.notes);
            found.question = found.question.or(read.question);
            Ok(found)
        });
        let mut found = found.map_err(of_held)?.determined()?;
        if let Some(read) = read {
            found.notes.splice(..0, read.notes.into_iter().chain(read.question.clone()));
            found.question = found.question.or(read.question);
        }
        Ok(found)
    } else {
        let of_held = |error| of_held_constants(test, error);
        let plate = plate_by_modes(test);
        if let Some(plate) = &plate {
            plate.refuse_other_places(test)?;
        }
        // A plate whose modes are right and whose lines a factor explains is refused for that factor.
        let by_modes = || {
            let found = plate.as_ref()?.identification(test, settings).ok()?.determined().ok()?;
            // Modes that lie a half width beside those of the plate leave half of the motion of a sound one.
            match accelerance_fit::refuse_missed(test, &found.accelerances) {
                Err(factor @ IdentifyError::OtherUnits { .. }) => Some(Err(factor)),
                _ => Some(Ok(found)),
            }
        };
        if plate.as_ref().is_some_and(|plate| !plate.is_ideal() || plate.is_seen_all_over())
            && let Some(found) = by_modes()
        {
            return found;
        }
        let by_lines = accelerance_fit::identify_records(test, settings).map_err(of_held);
        by_lines.and_then(Identification::determined).or_else(|refused| by_modes().unwrap_or(Err(refused)))
    }
}

/// A test that declares effects, or has lists of natural frequencies beside records.
fn by_modes_alone(test: &ImpactTest, lists: usize, settings: Settings) -> Result<Identification, IdentifyError> {
    let what =
        if test.effects.is_empty() { "natural frequencies beside records" } else { "declared effects ([[effect]])" };
    let refused = |message: &str| Err(IdentifyError::Unsupported(format!("{what}{message}")));
    if settings.search == Search::Simplex || settings.damping_law == DampingLaw::Hysteretic {
        return refused(" want least squares and viscous damping: leave out --search and --damping");
    }
    if lists == test.measurements.len() {
        return identify_lists_with_effects(test)?.determined();
    }
    let records = records_alone(test);
    accelerance_fit::refuse_other_units(&records, &records.accelerances(settings.estimation)?)?;
    let mut found = identify_with_effects(test, settings.estimation)?.determined()?;
    accelerance_fit::refuse_missed(test, &found.accelerances)?;
    found.question = accelerance_fit::question_of_window(&records);
    found.notes.extend(found.question.clone());
    Ok(found)
}

/// A declared plate of one piece by the modes that its records show; `None` where these cannot be had.
fn plate_by_modes(test: &ImpactTest) -> Option<PlateByModes> {
    let is_one_plate = test.structure == Some(StructureKind::MindlinPlate) && test.pieces.len() == 1;
    if is_one_plate { PlateByModes::of(test).ok().flatten() } else { None }
}

/// The records of a test without the lists that stand beside them, and the pieces that were hit alone.
pub(crate) fn records_alone(test: &ImpactTest) -> ImpactTest {
    let mut records = test.clone();
    records.measurements.retain(is_record);
    let is_hit = |piece: &usize| records.measurements.iter().any(|record| record.piece == *piece);
    let hit: Vec<usize> = (0..test.pieces.len()).filter(is_hit).collect();
    for record in &mut records.measurements {
        record.piece = hit.partition_point(|piece| *piece < record.piece);
    }
    records.pieces = hit.into_iter().map(|piece| test.pieces[piece].clone()).collect();
    records
}

/// A law that is indefinite where the search began says nothing of the values it began with, where these are not the user's.
fn of_held_constants(test: &ImpactTest, error: IdentifyError) -> IdentifyError {
    let IdentifyError::Model(ModelError::IndefiniteLaw { .. }) = error else { return error };
    let (held, free): (Vec<&str>, Vec<&str>) =
        ["e_x", "e_y", "nu_xy"].into_iter().partition(|name| test.constants.contains_key(*name));
    if free.is_empty() || held.is_empty() {
        return error;
    }
    let value = |name: &&str| format!("{name} = {:e}", test.constants[*name]);
    IdentifyError::HeldLaw { held: held.iter().map(value).collect::<Vec<_>>().join(", "), free: free.join(" and ") }
}
