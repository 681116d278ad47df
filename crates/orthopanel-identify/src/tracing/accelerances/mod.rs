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
use orthopanel_model::{BEAM_CONSTANTS, BeamConstants, ExactBeam, ReceptanceSetup, RecordSetting, effect};

use super::base_model::RecordsBase;
use super::hypothesis::{Hypothesis, Switched};
use super::outcome::{NotTested, Progress, Tracing};
use super::record_problem::State;
use crate::IdentifyError;
use crate::accelerance_fit::{ResonanceStart, resonance_starts};
use crate::free_constants::FreeConstants;
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
/// As [`super::trace`].
pub(super) fn trace_accelerances(
    test: &ImpactTest,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Tracing, IdentifyError> {
    let Begun { problem, state, declared, free_scale, band, accelerances, .. } = begin(test)?;
    let piece = test.pieces[0].piece;
    let mut search = Search { problem, piece, declared, band, accelerances, progress };
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
/// As [`super::trace`].
pub(super) fn base_of_accelerances(test: &ImpactTest) -> Result<RecordsBase, IdentifyError> {
    let Begun { problem, state, declared, band, accelerances, start, .. } = begin(test)?;
    let mut search = Search { problem, piece: test.pieces[0].piece, declared, band, accelerances, progress: &|_| {} };
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
    let start = starts.into_iter().next().ok_or(too_few)?;
    let seen = resonances::resonances(&accelerances, &start);
    let usual_log_zeta = start.usual_zeta.ln();
    let log_zeta = |mode: usize| start.modes.get(mode).copied().flatten().map_or(usual_log_zeta, |(_, zeta)| zeta.ln());
    let between = BetweenPeaks::of(&accelerances, &seen, |mode| log_zeta(mode).exp());
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
    let summed = modes.take_while(|frequency| *frequency < SUMMED * band).count();
    let setup = ReceptanceSetup::new(&piece, test.boundary, &test.suspension, &settings, summed)?;
    let free_scale = declared.effects.iter().all(|on| on.effect.id() != SCALE);
    let hypothesis = if free_scale {
        declared.and(Switched::new(effect(SCALE)?, &piece, accelerances.len(), |_| None, |_| false))
    } else {
        declared
    };
    let declared = hypothesis.effects.len();
    let state = State {
        constants: start.constants.map(f64::ln),
        zetas: (0..start.modes.len()).map(log_zeta).chain([usual_log_zeta]).collect(),
        hypothesis,
    };
    let problem = AccelerancesProblem::new(test, setup, seen, between, (held, usual_log_zeta))?;
    Ok(Begun { accelerances, start, problem, state, declared, free_scale, band })
}
