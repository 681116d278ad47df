//! The records' lines beside what a hypothesis predicts of them.

use num_complex::Complex64;
use orthopanel_data::{Accelerance, Estimation, ImpactTest, TimeHistory};
use orthopanel_model::{
    BeamConstants, BeamMode, Damping, EffectState, ExactBeam, Place, ReceptanceSetup, RecordSetting, SuspensionMotion,
};
use rayon::prelude::*;

use super::damping::TracedDamping;
use crate::accelerance_fit::told_variance;
use crate::curves::curves;
use crate::measured::MeasuredModes;
use crate::stacked::Block;
use crate::{AcceleranceFit, IdentifyError, MeasuredRecord};

/// Lines sum the modes up to so many times the highest.
const SUMMED: f64 = 2.5;
/// Pairs of places from which one hit at each will do.
const FEW: usize = 3;
/// Modes of the beam that are looked through for those.
const MOST_MODES: usize = 200;

/// The accelerances of the records: of hits as an analyser shows them, of files as they stand there.
pub(super) struct Lines {
    /// Each with its piece.
    accelerances: Vec<(usize, Accelerance)>,
    /// Whether neither hits nor places could tell by how much hits differ.
    pub hits_are_few: bool,
    /// Hits that were left out, and why; and all that is said of files of accelerances.
    pub notes: Vec<String>,
}

/// A hypothesis with the damping ratios that the poles then say.
pub(super) struct Drawn {
    pub curves: Vec<AcceleranceFit>,
    pub damping: TracedDamping,
}

impl Lines {
    /// # Errors
    /// Records that cannot be read.
    pub(super) fn of(test: &ImpactTest, estimation: Estimation) -> Result<Self, IdentifyError> {
        let (pieces, histories): (Vec<usize>, Vec<TimeHistory>) = test.time_histories()?.into_iter().unzip();
        let of_hits = histories.par_iter().map(|history| Ok(history.accelerance(estimation)?));
        let accelerances = of_hits.collect::<Result<Vec<_>, IdentifyError>>()?;
        let mut notes = Vec::new();
        for (history, accelerance) in histories.iter().zip(&accelerances) {
            let [force, response] = [history.force_at, history.response_at].map(|place| place.x);
            let left_out = history.left_out_of(&accelerance.verdicts).into_iter();
            notes.extend(left_out.map(|note| format!("force at x = {force} m, response at x = {response} m: {note}")));
        }
        let single = |(history, accelerance): (&TimeHistory, &Accelerance)| history.kept_in(accelerance).hits.len() < 2;
        let hits_are_few = (1..FEW).contains(&histories.len()) && histories.iter().zip(&accelerances).all(single);
        let mut accelerances: Vec<(usize, Accelerance)> = pieces.into_iter().zip(accelerances).collect();
        for of_file in test.recorded_accelerances()? {
            notes.extend(of_file.1.notes.iter().cloned());
            accelerances.push(of_file);
        }
        Ok(Self { accelerances, hits_are_few, notes })
    }

    /// All that is said of the records, a sentence each.
    pub(super) fn notes_of_records(&self) -> Vec<String> {
        self.accelerances.iter().flat_map(|(_, record)| record.notes.iter().cloned()).collect()
    }

    /// Of a plate, by its modes as each record sees them. Damping is left out.
    ///
    /// # Errors
    /// What the model refuses.
    pub(super) fn drawn_by_modes(
        &self,
        block: &Block,
        state: (&[f64], &[EffectState]),
    ) -> Result<Drawn, IdentifyError> {
        let measured = block.comparison().measured;
        let own = self.accelerances.iter().filter(|(piece, _)| *piece == measured.piece);
        let placed = own.filter_map(|(_, of)| {
            let is_it =
                |record: &MeasuredRecord| (record.force_at, record.response_at) == (of.force_at, of.response_at);
            Some((measured.records.iter().position(is_it)?, of))
        });
        let placed: Vec<(usize, &Accelerance)> = placed.collect();
        let curve = |(number, record): (usize, &Accelerance)| {
            let lines = record.frequency.partition_point(|&frequency| frequency <= measured.band[1]);
            let frequency = record.frequency[..lines].to_vec();
            let at = |f: &f64| Complex64::new(record.decay_rate, std::f64::consts::TAU * f);
            let s: Vec<Complex64> = frequency.iter().map(at).collect();
            Ok(AcceleranceFit {
                piece: measured.piece,
                force_at: record.force_at,
                response_at: record.response_at,
                model: block.predictor.accelerance(number, state, &s)?,
                measured: record.value[..lines].to_vec(),
                decay_rate: record.decay_rate,
                variance: told_variance(record).map(|variance| variance[..lines].to_vec()),
                frequency,
            })
        };
        let curves = placed.into_par_iter().map(curve).collect::<Result<Vec<_>, IdentifyError>>()?;
        Ok(Drawn { curves, damping: TracedDamping { damping: Damping::default(), std: vec![] } })
    }

    /// Of the piece of these modes, at these constants with these effects; `of_effects` as in [`TracedDamping::of`].
    ///
    /// # Errors
    /// What the model refuses.
    pub(super) fn drawn(
        &self,
        test: &ImpactTest,
        measured: &MeasuredModes,
        (constants, effects, of_effects): (&[f64], &[EffectState], &[f64]),
    ) -> Result<Drawn, IdentifyError> {
        let piece = test.pieces[measured.piece].piece;
        let band = measured.band[1];
        let value = |at: usize| constants.get(at).copied().unwrap_or_default();
        let beam = ExactBeam::new(&piece, test.boundary, BeamConstants { e_x: value(0), g_zx: value(1) })?;
        let low = |mode: &BeamMode| mode.frequency() < SUMMED * band;
        let summed = beam.flexible_modes().take(MOST_MODES).take_while(low).count();
        let setting = |accelerance: &Accelerance| RecordSetting {
            force_at: Some(accelerance.force_at),
            response_at: Some(accelerance.response_at),
            // What is not linear has no lines of its own.
            suspension_motion: SuspensionMotion::InTime,
            ..RecordSetting::default()
        };
        let own = self.accelerances.iter().filter(|(piece, _)| *piece == measured.piece);
        let accelerances: Vec<Accelerance> = own.map(|(_, accelerance)| accelerance.clone()).collect();
        let settings: Vec<RecordSetting> = accelerances.iter().map(setting).collect();
        let setup = ReceptanceSetup::new(&piece, test.boundary, &test.suspension, &settings, summed + 1)?;
        let (forces, responses): (Vec<Place>, Vec<Place>) =
            measured.records.iter().map(|record| (record.force_at, record.response_at)).unzip();
        let bare = Damping::default();
        let modes = setup.summed_modes(constants, (&bare, effects), [&forces, &responses], SUMMED * band)?;
        let damping = TracedDamping::of(measured, &modes, of_effects);
        let curves = curves(&accelerances, (measured.piece, &setup), (constants, &damping.damping, effects), band)?;
        Ok(Drawn { curves, damping })
    }
}
