//! Closing the loop: the effect that the base model lacks, by name.
//!
//! 1. The base model is fitted to the records; the residual is the misfit over the noise of the hits.
//! 2. Every effect of the catalogue is fitted with it, alone, then one more as long as it pays.
//! 3. The hypotheses are judged by what was held out, by a criterion scaled to the whiteness of the residual, and by what
//!    is left of it beside the scatter of the hits.
//!
//! Both channels are multiplied by $e^{-\sigma t}$, and the model is evaluated on $s = \sigma + j\omega$: exact for every linear
//! effect, free of leakage, and with peaks as wide as a search needs ([`widened_lines`]). Lists of natural frequencies and
//! files of accelerances, which hold no hits, are traced in [`frequencies`] and [`accelerances`].

mod accelerances;
mod bare_panel;
mod base_model;
mod bounds;
mod closer_look;
mod core_modes;
mod declared_doubt;
mod each_effect;
mod elsewhere;
mod error_clusters;
mod fit;
mod frequencies;
mod further_list;
mod held_out;
mod hit_noise;
mod hit_places;
mod hypothesis;
mod information;
mod known_sums;
mod line_noise;
mod made_rows;
mod model_error;
mod next_experiment;
mod ranking;
mod reactions;
mod record_problem;
mod records_of_test;
mod report;
mod rough;
mod row_products;
mod search_work;
mod starts;
mod valley;
mod verdict;
mod whiteness;
mod wide_panel;
mod widened_lines;

use orthopanel_data::{ImpactTest, MeasurementData, TimeHistory};

pub(crate) use base_model::identify_with_effects;
pub(crate) use frequencies::without_repeats;

use crate::IdentifyError;
use crate::outcome::{Progress, Tracing};
use hypothesis::Hypothesis;
use ranking::Search;
use records_of_test::TestRecords;

/// Fits the lines of records, or the numbers of lists, with each effect, one after the other.
///
/// # Errors
/// Records that cannot be read or show too few resonances, and tests that this version cannot trace.
pub(crate) fn trace_by_fits(test: &ImpactTest, progress: &(dyn Fn(Progress) + Sync)) -> Result<Tracing, IdentifyError> {
    let lists = |data: &MeasurementData| matches!(data, MeasurementData::NaturalFrequencies(_));
    if test.measurements.iter().all(|measurement| lists(&measurement.data)) {
        let piece = test.pieces.iter().map(|named| named.piece).max_by(|a, b| a.mass().total_cmp(&b.mass()));
        let Some(piece) = piece else {
            return Err(IdentifyError::Unsupported("a test without a piece".to_owned()));
        };
        return frequencies::trace_frequencies(test, &Hypothesis::declared(test, &piece, 1)?, progress);
    }
    let [named] = &test.pieces[..] else {
        let message =
            format!("a trace of {} pieces in one test: give each piece a test file of its own", test.pieces.len());
        return Err(IdentifyError::Unsupported(message));
    };
    let kinds =
        |wanted: fn(&MeasurementData) -> bool| test.measurements.iter().all(|measurement| wanted(&measurement.data));
    if kinds(|data| matches!(data, MeasurementData::Accelerance(_))) {
        return accelerances::trace_accelerances(test, progress);
    }
    if !kinds(|data| matches!(data, MeasurementData::TimeHistory(_))) {
        let message = "a trace needs measurements of one kind: natural-frequencies, accelerance or time-history; put others \
                       into a test file of their own";
        return Err(IdentifyError::Unsupported(message.to_owned()));
    }
    let histories: Vec<TimeHistory> = test.time_histories()?.into_iter().map(|(_, history)| history).collect();
    let piece = named.piece;
    // Starts that fail are passed over: what the file declares wrongly would be said as too few resonances.
    Hypothesis::declared(test, &piece, histories.len())?.check_that_each_acts(test, &piece)?;
    let mut records = TestRecords::new(test, &histories)?;
    let mut alone = Search { records: &records, piece, progress }.each_alone()?;
    reactions::motion_doubt::beside_motion_doubt(&mut records, &mut alone, (piece, progress))?;
    Search { records: &records, piece, progress }.free_what_is_kept(&mut alone, 1)?;
    // What parts the hits of a place is told by roughness, which a search allows for first.
    if !records.hits_differ() {
        Search { records: &records, piece, progress }.look_closer(&mut alone)?;
    }

    let mut ranking = match rough::search::rough_search(&mut records, piece, progress, &alone) {
        Some(ranking) => ranking,
        None => Search { records: &records, piece, progress }.together(alone)?,
    };

    let search = Search { records: &records, piece, progress };
    // Beside roughness each effect alone was fitted anew.
    search.free_what_is_kept(&mut ranking, if records.rough.is_some() { 1 } else { 2 })?;

    report::report(test, &search, &ranking)
}
