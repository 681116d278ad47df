//! Tracing in files of accelerances: what analysers keep, without the hits.
//!
//! At a damping ratio of 1e-4 the lines at a peak measure how far the frequencies drifted between two records, so
//! resonances ([`resonances`]) and the lines between them ([`between_peaks`]) are weighed apart ([`problem`]).

mod between_peaks;
mod parting;
mod problem;
mod report;
mod resonances;
mod search;

use orthopanel_data::{Accelerance, Estimation, ImpactTest};
use orthopanel_model::{BEAM_CONSTANTS, BeamConstants, ExactBeam, Piece, ReceptanceSetup, RecordSetting, effect};

use super::base_model::RecordsBase;
use super::hypothesis::{Hypothesis, Switched};
use super::record_problem::State;
use super::starts::supports::{REACH, SUPPORT, SupportStarts, support_starts};
use crate::IdentifyError;
use crate::accelerance_fit::{ResonanceStart, resonance_starts};
use crate::free_constants::FreeConstants;
use crate::outcome::{NotTested, Progress, Tracing};
use between_peaks::BetweenPeaks;
use problem::AccelerancesProblem;
use search::Search;

/// Lines sum the modes below so many times their band.
const SUMMED: f64 = 2.5;
/// Modes that are looked through for these.
const MOST_MODES: usize = 60;
/// The factor on all records.
const SCALE: &str = "gain";

/// Names the effect that the base model lacks in the accelerances of one piece.
///
/// # Errors
/// As [`crate::trace()`].
pub(super) fn trace_accelerances(
    test: &ImpactTest,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Tracing, IdentifyError> {
    let Begun { problem, state, declared, free_scale, band, accelerances, start } = begin(test)?;
    let (piece, poles) = (test.pieces[0].piece, start.poles);
    let mut search = Search { problem, piece, declared, band, accelerances, poles, progress };
    let mut found = search.run(state)?;
    if free_scale {
        let reason = "a file of accelerances does not tell how it was calibrated: a factor on all records is free in every \
                      hypothesis, unless the test file declares it";
        found.not_tested.push(NotTested { id: SCALE, reason: reason.to_owned() });
    }
    report::report(test, &search, &found, free_scale)
}

/// The base model fitted to the accelerances of a test of one piece.
///
/// # Errors
/// As [`crate::trace()`].
pub(super) fn base_of_accelerances(test: &ImpactTest) -> Result<RecordsBase, IdentifyError> {
    let Begun { problem, state, declared, band, accelerances, start, .. } = begin(test)?;
    let (piece, poles) = (test.pieces[0].piece, start.poles.clone());
    let mut search = Search { problem, piece, declared, band, accelerances, poles, progress: &|_| {} };
    let base = search.base(&state)?;
    Ok(RecordsBase {
        std: report::deviations(&search, &base)?,
        free_zetas: 0,
        band,
        in_band: start.modes.len(),
        chi_square: None,
        start,
        accelerances: search.accelerances,
        setup: search.problem.setup,
        state: base.state,
    })
}

/// What stands before the first fit.
struct Begun {
    accelerances: Vec<Accelerance>,
    start: ResonanceStart,
    problem: AccelerancesProblem,
    state: State,
    /// Effects of the base, the last of which is the factor on all records where that is free.
    declared: usize,
    free_scale: bool,
    band: f64,
}

fn begin(test: &ImpactTest) -> Result<Begun, IdentifyError> {
    let piece = test.pieces[0].piece;
    let accelerances: Vec<Accelerance> =
        test.accelerances(Estimation::default())?.into_iter().map(|(_, accelerance)| accelerance).collect();
    let declared = Hypothesis::declared(test, &piece, accelerances.len())?;
    let tops = accelerances.iter().filter_map(|accelerance| accelerance.frequency.last().copied());
    let band = tops.fold(f64::INFINITY, f64::min);
    let constants = FreeConstants::of(test, &BEAM_CONSTANTS)?.held;
    let held = [0, 1].map(|index| constants.get(index).copied().flatten());
    let starts = resonance_starts(&piece, test.boundary, held, &accelerances)?;
    let too_few = IdentifyError::TooFewResonances { found: 0, needed: 1, noise_percent: None };
    let mut start = starts.into_iter().next().ok_or(too_few)?;
    let settings: Vec<RecordSetting> = accelerances
        .iter()
        .map(|record| RecordSetting {
            force_at: Some(record.force_at),
            response_at: Some(record.response_at),
            ..RecordSetting::default()
        })
        .collect();
    let [e_x, g_zx] = start.constants;
    let beam = ExactBeam::new(&piece, test.boundary, BeamConstants { e_x, g_zx })?;
    let modes = beam.flexible_modes().take(MOST_MODES).map(|mode| mode.frequency());
    let summed: Vec<f64> = modes.take_while(|frequency| *frequency < SUMMED * band).collect();
    let setup = ReceptanceSetup::new(&piece, test.boundary, &test.suspension, &settings, summed.len())?;
    let free_scale = declared.effects.iter().all(|on| on.effect.id() != SCALE);
    let hypothesis = if free_scale {
        declared.and(Switched::new(effect(SCALE)?, &piece, accelerances.len(), |_| None, |_| false))
    } else {
        declared
    };
    let declared = hypothesis.effects.len();
    let mut state = State { constants: start.constants.map(f64::ln), zetas: vec![start.usual_zeta.ln()], hypothesis };
    if let Some(modes) = with_yielding_supports(&start, &state, (&held, &setup, &piece), accelerances.len()) {
        start.modes = modes;
    }
    let usual_log_zeta = start.usual_zeta.ln();
    let log_zeta = |mode: usize| start.modes.get(mode).copied().flatten().map_or(usual_log_zeta, |(_, zeta)| zeta.ln());
    state.zetas = (0..start.modes.len()).map(log_zeta).chain([usual_log_zeta]).collect();
    let seen = resonances::resonances(&accelerances, &start);
    let is_seen = |mode: usize| seen.iter().any(|resonance| resonance.mode == mode);
    let unseen: Vec<f64> =
        summed.iter().enumerate().filter(|(mode, _)| !is_seen(*mode)).map(|(_, frequency)| *frequency).collect();
    let damping = |mode: usize| log_zeta(mode).exp();
    let most_damped = start.modes.iter().flatten().fold(start.usual_zeta, |most, (_, zeta)| most.max(*zeta));
    let between = BetweenPeaks::of(&accelerances, &seen, damping, (&unseen, most_damped));
    let problem = AccelerancesProblem::new(test, setup, seen, between, (held, usual_log_zeta))?;
    Ok(Begun { accelerances, start, problem, state, declared, free_scale, band })
}

/// The resonances of each mode where clamps that yield number them, if these give a mode to more of them: with ideal clamps the lowest may
/// be taken for none.
fn with_yielding_supports(
    start: &ResonanceStart,
    base: &State,
    (held, setup, piece): (&[Option<f64>; 2], &ReceptanceSetup, &Piece),
    records: usize,
) -> Option<Vec<Option<(f64, f64)>>> {
    let known = SupportStarts { poles: &start.poles, held, setup, piece };
    let states = support_starts(known, base, effect(SUPPORT).ok()?, records).ok()?;
    let state = states.first()?;
    let modes =
        setup.summed_frequencies(&state.constants.map(f64::exp), &state.hypothesis.states(records).ok()?).ok()?;
    let found = start.nearest_to(&modes, REACH);
    let matched = |modes: &[Option<(f64, f64)>]| modes.iter().flatten().count();
    (matched(&found) > matched(&start.modes)).then_some(found)
}
