//! The records of a test, widened, with the model that they are to meet.

use orthopanel_data::{Accelerance, Estimation, ImpactTest, TimeHistory};
use orthopanel_model::{
    BEAM_CONSTANTS, BeamConstants, ExactBeam, ModelError, ReceptanceSetup, RecordSetting, SuspensionMotion,
};
use rayon::prelude::*;

use super::base_model::RecordsBase;
use super::fit::{Fit, LAST, by_group};
use super::held_out::LEAST_PLACES;
use super::hypothesis::Hypothesis;
use super::known_sums::KnownSums;
use super::reactions::Reactions;
use super::record_problem::{DampingPrior, Grouping, RecordProblem, State, total};
use super::rough::RoughScales;
use super::rough::rest::RoughRest;
use super::search_work::SearchWork;
use super::starts::declared::{base_fit, begun_where_declared};
use super::starts::plate_states::PlateEvidence;
use super::whiteness::{independent_part, whitened};
use super::widened_lines::{HitModel, WIDENINGS, WidenedLines, aligned_lines, widened_lines};
use crate::accelerance_fit::{ResonanceStart, resonance_starts};
use crate::free_constants::FreeConstants;
use crate::least_squares::{Ending, descend};
use crate::{AcceleranceFit, IdentifyError};

/// Everything that a trace of one piece's records needs.
pub(super) struct TestRecords {
    pub setup: ReceptanceSetup,
    /// The records at each of [`WIDENINGS`].
    pub widened: Vec<Vec<WidenedLines>>,
    pub held: [Option<f64>; 2],
    pub usual_log_zeta: f64,
    /// Highest line \[Hz\].
    pub band: f64,
    /// Flexible modes below it, and those that every line sums.
    pub in_band: usize,
    pub summed: usize,
    /// Where a search without effects begins.
    pub start: State,
    /// $\ln\zeta$ of the free modes as the resonances alone tell it.
    log_zetas: Vec<f64>,
    /// See [`RecordProblem::work`].
    pub work: SearchWork,
    known: KnownSums,
    /// Frequencies \[Hz\] of the resonances that the records show.
    pub poles: Vec<f64>,
    pub plates: PlateEvidence,
    /// As the analyser shows the records.
    accelerances: Vec<Accelerance>,
    reactions: Option<Reactions>,
    histories: Vec<TimeHistory>,
    /// Scales of the test's roughness, where hypotheses have any.
    pub rough: Option<RoughScales>,
    /// What is in the lines' variances beside noise, where the test is rough.
    pub rest: Option<RoughRest>,
    /// Hits that were left out, and why.
    pub notes: Vec<String>,
}

/// The band ends where the force has fallen by this much \[dB\].
const FORCE_DROP: f64 = 20.0;
/// and below this part of the rate: analysers' filters are flat up to there.
const FLAT: f64 = 1.0 / 2.56;
/// and above so many modes: more of them tell little that these do not, and every line pays for each.
const MOST_MODES: usize = 10;
/// Damping is free of every mode up to this part of the band, and lines sum modes up to [`SUMMED`] times it.
pub(super) const FREE_DAMPING: f64 = 1.6;
const SUMMED: f64 = 2.5;
/// Standard deviation of a mode's $\ln\zeta$ before the records speak, at each widening; panels' modes differ by a factor of two or three.
const LOG_ZETA_STD: [f64; WIDENINGS.len()] = [0.5, 1.0, 2.0, 1.0];
/// The same of all modes beyond: while peaks are wide it would take up whatever is smooth in a misfit, as a mass at an edge.
const LOG_ZETA_STD_BEYOND: [f64; WIDENINGS.len()] = [0.1, 0.1, 0.1, 1.0];
/// Scatter of the hits over their noise that may still be the noise's own: beyond, they differ by something that a hypothesis
/// has to explain, as a force that is not linear, and a misfit may not hide behind it.
const SCATTERED: f64 = 2.0;
/// Scatter of the hits over their noise from which a test may be rough: over thousands of lines noise alone gives 0.9 to 1.02.
const ROUGH: f64 = 1.3;
/// Starts that are followed a little way, and the evaluations spent on each before the best is taken.
const TRIED: usize = 4;
const TRIAL: Ending = Ending::far(12, 1.0);

impl TestRecords {
    /// Widens the hits of a test and reads where to start off its resonances.
    ///
    /// # Errors
    /// [`IdentifyError`] where records do not show enough resonances, and what the model refuses.
    pub(super) fn new(test: &ImpactTest, histories: &[TimeHistory]) -> Result<Self, IdentifyError> {
        let estimation = Estimation { force_drop: FORCE_DROP, ..Estimation::default() };
        let accelerances = histories.par_iter().map(|history| Ok(history.accelerance(estimation)?));
        let accelerances = accelerances.collect::<Result<Vec<_>, IdentifyError>>()?;
        let mut notes = Vec::new();
        for (history, accelerance) in histories.iter().zip(&accelerances) {
            let left_out = history.left_out_of(&accelerance.verdicts);
            let [force, response] = [history.force_at, history.response_at].map(|place| place.x);
            notes.extend(
                left_out.into_iter().map(|note| format!("force at x = {force} m, response at {response} m: {note}")),
            );
        }
        let kept: Vec<TimeHistory> =
            histories.iter().zip(&accelerances).map(|(history, accelerance)| history.kept_in(accelerance)).collect();
        let histories = &kept[..];
        let tops = accelerances.iter().filter_map(|accelerance| accelerance.frequency.last().copied());
        let hit = tops.fold(f64::INFINITY, f64::min);
        let flat = histories.iter().map(|history| FLAT * history.rate).fold(f64::INFINITY, f64::min);
        let constants = FreeConstants::of(test, &BEAM_CONSTANTS)?.held;
        let held = [0, 1].map(|index| constants.get(index).copied().flatten());
        let starts = resonance_starts(&test.pieces[0].piece, test.boundary, held, &accelerances)?;
        let tried: Vec<(f64, Self)> = starts
            .par_iter()
            .take(TRIED)
            .filter_map(|start| Self::from_start(test, histories, start, held, hit.min(flat)).ok())
            .collect();
        let best = tried.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, mut records)) = best else {
            return Err(IdentifyError::TooFewResonances { found: 0, needed: 1, noise_percent: None });
        };
        let finer = WIDENINGS.iter().skip(1).map(|&widening| widened_lines(histories, widening, records.band));
        records.widened.extend(finer);
        records.accelerances = accelerances;
        records.notes = notes;
        records.reactions = Reactions::new(test, histories, (records.summed, records.band))?;
        records.known.forget();
        records.histories = kept;
        records.start = begun_where_declared(&records, &test.pieces[0].piece);
        Ok(records)
    }

    /// With the widest lines only, and the misfit per datum that a short search from there leaves.
    fn from_start(
        test: &ImpactTest,
        histories: &[TimeHistory],
        start: &ResonanceStart,
        held: [Option<f64>; 2],
        highest: f64,
    ) -> Result<(f64, Self), IdentifyError> {
        let piece = test.pieces[0].piece;
        let [e_x, g_zx] = start.constants;
        let beam = ExactBeam::new(&piece, test.boundary, BeamConstants { e_x, g_zx })?;
        let frequencies: Vec<f64> = beam.flexible_modes().take(4 * MOST_MODES).map(|mode| mode.frequency()).collect();
        let wanted = frequencies.get(MOST_MODES).zip(frequencies.get(MOST_MODES - 1)).map(|(a, b)| 0.5 * (a + b));
        let band = highest.min(wanted.unwrap_or(f64::INFINITY));
        let below = |limit: f64| frequencies.iter().filter(|frequency| **frequency < limit).count();
        let modes = below(FREE_DAMPING * band).max(1);
        let settings: Vec<RecordSetting> = histories
            .iter()
            .map(|history| RecordSetting {
                force_at: Some(history.force_at),
                response_at: Some(history.response_at),
                suspension_motion: SuspensionMotion::InTime,
                ..RecordSetting::default()
            })
            .collect();
        let (in_band, summed) = (below(band), below(SUMMED * band).max(modes + 1));
        let setup = ReceptanceSetup::new(&piece, test.boundary, &test.suspension, &settings, summed)?;
        let usual_log_zeta = start.usual_zeta.ln();
        let poles = start.poles.clone();
        let plates = PlateEvidence::of(test, histories, start);
        let zeta = |mode: usize| start.modes.get(mode).copied().flatten().map_or(usual_log_zeta, |(_, zeta)| zeta.ln());
        let log_zetas: Vec<f64> = (0..modes).map(zeta).chain([usual_log_zeta]).collect();
        let start = State {
            constants: start.constants.map(f64::ln),
            zetas: log_zetas.clone(),
            hypothesis: Hypothesis::declared(test, &piece, histories.len())?,
        };
        let widened = vec![widened_lines(histories, WIDENINGS[0], band)];
        let mut records = Self {
            setup,
            widened,
            held,
            usual_log_zeta,
            band,
            in_band,
            summed,
            start,
            log_zetas,
            work: SearchWork::default(),
            known: KnownSums::default(),
            poles,
            plates,
            accelerances: vec![],
            reactions: None,
            histories: vec![],
            rough: None,
            rest: None,
            notes: vec![],
        };
        let problem = records.problem(0);
        let from = problem.parameters(&records.start);
        let bounds = problem.bounds(&records.start);
        let searched = descend(|p| problem.linearise(p, &records.start), &from, &bounds, TRIAL);
        let (minimum, _) = searched.map_err(IdentifyError::refused)?;
        let misfit = minimum.at.cost / problem.data() as f64;
        records.start = problem.state(&minimum.parameters, &records.start);
        Ok((misfit, records))
    }

    /// Every record beside the model of a fit.
    ///
    /// # Errors
    /// What the model refuses.
    pub(super) fn curves(&self, fit: &Fit) -> Result<Vec<AcceleranceFit>, IdentifyError> {
        fit.state.curves(&self.accelerances, &self.setup, self.band)
    }

    /// Scatter of the hits about their mean per datum, over the noise as it is modelled; 1 where a single hit tells none.
    ///
    /// Where forces that are not linear are on, hits scatter about what these make of each.
    ///
    /// # Errors
    /// What the model refuses.
    pub(super) fn noise_floor(&self, fit: &Fit) -> Result<f64, IdentifyError> {
        if let Some(scatter) = self.problem(LAST).scatter_beside_reactions(&fit.state)? {
            return Ok(scatter);
        }
        Ok(self.hit_scatter())
    }

    /// The same where all forces are linear.
    pub(super) fn hit_scatter(&self) -> f64 {
        let last = self.widened.last().map_or(&[][..], Vec::as_slice);
        let told: Vec<f64> = last.iter().filter_map(|record| record.scatter).collect();
        if told.is_empty() { 1.0 } else { told.iter().sum::<f64>() / told.len() as f64 }
    }

    /// Misfit per datum of a fit over what the hits' scatter asks of any: at least 1, and no more than [`SCATTERED`].
    ///
    /// # Errors
    /// What the model refuses.
    pub(super) fn misfit_over_floor(&self, fit: &Fit) -> Result<f64, IdentifyError> {
        Ok(fit.chi_square(self) / self.noise_floor(fit)?.clamp(1.0, SCATTERED))
    }

    /// Whether nothing can be left out to judge by: neither a place nor a hit.
    pub(super) fn are_too_few(&self) -> bool {
        let records = &self.problem(0).records;
        records.len() < LEAST_PLACES && records.iter().all(|record| record.hits.len() < 2)
    }

    /// Whether the hits of a record differ by more than noise.
    pub(super) fn hits_differ(&self) -> bool {
        self.hit_scatter() > ROUGH
    }

    /// Brings the hits of each record to the place that they hit in the mean, by the model at a state with roughness, on all
    /// lines from this widening on, and adds to the lines' variances what roughness leaves. Tells by how much the mean of a record's
    /// hits scatters \[m\].
    ///
    /// # Errors
    /// What the model refuses.
    pub(super) fn align_hits(&mut self, state: &State, (from, rest): (usize, RoughRest)) -> Result<f64, ModelError> {
        let mut scatter = 0.0;
        let mut beside = vec![];
        for (stage, &widening) in WIDENINGS.iter().enumerate().skip(from) {
            let problem = self.problem(stage);
            let told = |index: usize, lines: &WidenedLines| {
                let by_place = problem.by_place(state, index, &lines.s)?;
                Ok::<_, ModelError>(HitModel { by_place, taken: problem.taken_off_hits(state, index, lines)? })
            };
            let aligned = aligned_lines(&self.histories, widening, self.band, told)?;
            let (lines, places): (Vec<_>, Vec<_>) = aligned.into_iter().unzip();
            self.widened[stage] = lines;
            scatter = of_means(&places);
            beside = places;
            self.widened[stage].iter_mut().for_each(|record| rest.widen(record));
        }
        if let Some(reactions) = &mut self.reactions {
            reactions.put_hits(&beside);
        }
        self.doubt_motion(state, (from, Some(rest)))?;
        self.rest = Some(rest);
        Ok(scatter)
    }

    /// Sums of squares are of lines that have changed since.
    pub(super) fn forget_sums(&mut self) {
        self.known.forget();
    }

    /// The hits as they fell, with `rest` in their lines' variances: undoes [`TestRecords::align_hits`].
    pub(super) fn as_hit(&mut self, from: usize, rest: Option<RoughRest>) {
        for (widened, &widening) in self.widened.iter_mut().zip(&WIDENINGS).skip(from) {
            *widened = widened_lines(&self.histories, widening, self.band);
            if let Some(rest) = rest {
                widened.iter_mut().for_each(|record| rest.widen(record));
            }
        }
        if let Some(reactions) = &mut self.reactions {
            reactions.put_hits_together();
        }
        self.rest = rest;
        self.known.forget();
    }

    /// The problem at one widening, counted from the widest.
    pub(super) fn problem(&self, stage: usize) -> RecordProblem<'_> {
        let records = self.widened.get(stage).or(self.widened.last()).map_or(&[][..], Vec::as_slice);
        let Self { setup, held, usual_log_zeta, work, known, .. } = self;
        let known = Some((known, stage));
        // While peaks are wide a misfit that is no damping would else drag the damping off, and the search with it.
        let about = if stage < LAST { &self.log_zetas[..] } else { &[] };
        let stage = stage.min(LAST);
        let prior = DampingPrior { about, std: LOG_ZETA_STD[stage], beyond: LOG_ZETA_STD_BEYOND[stage] };
        let (held, usual_log_zeta) = (*held, *usual_log_zeta);
        let (reactions, rough) = (self.reactions.as_ref(), self.rough);
        RecordProblem { setup, records, held, free_damping: true, usual_log_zeta, prior, rough, work, reactions, known }
    }
}

/// Standard deviation of the mean of a record's hits, from how each lies beside it.
fn of_means(beside: &[Vec<f64>]) -> f64 {
    let square: f64 = beside.iter().flatten().map(|beside| beside * beside).sum();
    let freedom: f64 = beside.iter().map(|hits| hits.len() as f64 - 1.0).sum();
    let hits = beside.iter().map(|hits| hits.len() as f64).sum::<f64>() / beside.len().max(1) as f64;
    (square / freedom.max(1.0) / hits.max(1.0)).sqrt()
}

/// The base model fitted to the hits of a test of one piece.
///
/// # Errors
/// As [`TestRecords::new`], and what the model refuses.
pub(super) fn base_of_histories(test: &ImpactTest) -> Result<RecordsBase, IdentifyError> {
    let histories: Vec<TimeHistory> = test.time_histories()?.into_iter().map(|(_, history)| history).collect();
    let records = TestRecords::new(test, &histories)?;
    let base = base_fit(&records)?;
    let chi_square = base.chi_square(&records);
    let covariance = total(&by_group(&records, &base, Grouping::Places)?).covariance();
    let unit = chi_square.max(1.0) / independent_part(&whitened(&records, &base)?);
    let std = |i: usize| covariance.as_ref().map(|matrix| (unit * matrix[(i, i)]).sqrt()).filter(|std| std.is_finite());
    let starts = resonance_starts(&test.pieces[0].piece, test.boundary, records.held, &records.accelerances)?;
    let too_few = IdentifyError::TooFewResonances { found: 0, needed: 1, noise_percent: None };
    Ok(RecordsBase {
        start: starts.into_iter().next().ok_or(too_few)?,
        std: (0..base.size).map(std).collect(),
        free_zetas: base.state.zetas.len(),
        band: records.band,
        in_band: records.in_band,
        chi_square: Some(chi_square),
        accelerances: records.accelerances,
        setup: records.setup,
        state: base.state,
    })
}
