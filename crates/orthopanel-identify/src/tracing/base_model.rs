//! The base model with the effects that the test file declares, as an identification.

use orthopanel_data::{Accelerance, Estimation, ImpactTest, MeasurementData};
use orthopanel_model::{
    BEAM_CONSTANTS, EffectSetting, Estimate, ModelError, NaturalFrequencies, ReceptanceSetup, RecordSetting,
    StructureKind,
};

use super::accelerances::base_of_accelerances;
use super::frequencies::identify_lists;
use super::hypothesis::Hypothesis;
use super::record_problem::State;
use super::records_of_test::base_of_histories;
use super::report::effects_of;
use crate::accelerance_fit::{ResonanceStart, is_told};
use crate::declared_effects::pairs_of_places;
use crate::free_constants::FreeConstants;
use crate::frequency_fit::identified_constants;
use crate::structures::bending_nodes;
use crate::{DampingLaw, HiddenMode, Identification, IdentifyError, ModeFit, PieceFit, Search, Settings};

/// The base model fitted to records.
pub(super) struct RecordsBase {
    pub accelerances: Vec<Accelerance>,
    /// The resonances that the search began from.
    pub start: ResonanceStart,
    pub setup: ReceptanceSetup,
    pub state: State,
    /// Standard deviations of the free constants' logarithms, the damping ratios' and the effects' coordinates.
    pub std: Vec<Option<f64>>,
    /// Damping ratios among them.
    pub free_zetas: usize,
    /// Highest line \[Hz\], and modes below it.
    pub band: f64,
    pub in_band: usize,
    /// Misfit per datum over the records' noise, where these tell it.
    pub chi_square: Option<f64>,
}

/// Identifies the constants of a beam whose test declares effects; a parameter that the file leaves out is identified too.
///
/// # Errors
/// As [`crate::identify`].
pub(crate) fn identify_with_effects(test: &ImpactTest, settings: Settings) -> Result<Identification, IdentifyError> {
    let refused = |message: &str| Err(IdentifyError::Unsupported(message.to_owned()));
    if test.structure == Some(StructureKind::MindlinPlate) {
        return refused("declared effects ([[effect]]) act on beams: leave them out, or structure = \"mindlin-plate\"");
    }
    if settings.search == Search::Simplex || settings.damping_law == DampingLaw::Hysteretic {
        return refused(
            "declared effects ([[effect]]) want least squares and viscous damping: leave out --search and --damping",
        );
    }
    let kinds = |wanted: fn(&MeasurementData) -> bool| test.measurements.iter().all(|of| wanted(&of.data));
    let largest = test.pieces.iter().map(|named| named.piece).max_by(|a, b| a.mass().total_cmp(&b.mass()));
    let Some(piece) = largest else { return refused("a test without a piece") };
    if kinds(|data| matches!(data, MeasurementData::NaturalFrequencies(_))) {
        return identify_lists(test, &Hypothesis::declared(test, &piece, 1)?);
    }
    if test.pieces.len() > 1 {
        return refused("declared effects with records of several pieces: give each piece a test file of its own");
    }
    // Said here, for starts that fail are passed over.
    Hypothesis::declared(test, &piece, pairs_of_places(test))?.check_that_each_acts(test, &piece)?;
    if kinds(|data| matches!(data, MeasurementData::Accelerance(_))) {
        return base_of_accelerances(test)?.identification(test, settings.estimation);
    }
    if kinds(|data| matches!(data, MeasurementData::TimeHistory(_))) {
        return base_of_histories(test)?.identification(test, settings.estimation);
    }
    refused("declared effects want measurements of one kind: put others into a test file of their own")
}

impl RecordsBase {
    fn identification(self, test: &ImpactTest, estimation: Estimation) -> Result<Identification, IdentifyError> {
        let constants = FreeConstants::of(test, &BEAM_CONSTANTS)?;
        let free: Vec<f64> = constants.free.iter().map(|free| self.state.constants[free.constant]).collect();
        constants.refuse_bounds(&free)?;
        let (of_constants, rest) = self.std.split_at(free.len().min(self.std.len()));
        let (of_zetas, of_effects) = rest.split_at(self.free_zetas.min(rest.len()));
        let damping: Vec<Estimate> = self
            .state
            .zetas
            .iter()
            .take(self.in_band)
            .enumerate()
            .map(|(mode, log)| {
                let value = log.exp();
                Estimate { value, std: of_zetas.get(mode).copied().flatten().map(|std| std * value) }
            })
            .collect();
        let named = &test.pieces[0];
        let (modes, hidden) = self.modes(test, &damping)?;
        let errors: f64 = modes.iter().map(|mode| mode.error_percent().powi(2)).sum();
        let shown: Vec<Accelerance> =
            test.accelerances(estimation)?.into_iter().map(|(_, accelerance)| accelerance).collect();
        let accelerances = self.state.curves(&shown, &self.setup, self.band)?;
        let lines = || accelerances.iter().flat_map(|pair| pair.model.iter().zip(&pair.measured));
        let missed: f64 = lines().map(|(model, measured)| (model - measured).norm_sqr()).sum();
        let total: f64 = lines().map(|(_, measured)| measured.norm_sqr()).sum();
        Ok(Identification {
            question: None,
            common_gain: None,
            structure: StructureKind::TimoshenkoBeam,
            constants: identified_constants(test, &constants, &free, of_constants),
            not_identified: vec![],
            correlations: vec![],
            frequency_rms_percent: (errors / modes.len().max(1) as f64).sqrt(),
            left_one_out_percent: None,
            accelerance_rms_percent: Some(100.0 * (missed / total).sqrt()),
            chi_square: self.chi_square,
            effects: effects_of(&self.state.hypothesis, of_effects),
            notes: self.accelerances.iter().flat_map(|record| record.notes.iter().cloned()).collect(),
            pieces: vec![PieceFit { modes, hidden, damping, ..PieceFit::of(named) }],
            accelerances,
        })
    }

    /// The resonances that the records show, beside those of the model, and the modes in the band without one; none where
    /// the model's are no plain modes.
    fn modes(&self, test: &ImpactTest, damping: &[Estimate]) -> Result<(Vec<ModeFit>, Vec<HiddenMode>), IdentifyError> {
        let setting = EffectSetting {
            piece: test.pieces[0].piece,
            boundary: test.boundary,
            suspension: test.suspension.clone(),
            record: RecordSetting {
                number: 1,
                response_at: self.accelerances.first().map(|record| record.response_at),
                ..RecordSetting::default()
            },
        };
        let states = self.state.hypothesis.states(self.accelerances.len())?;
        let count = self.start.modes.len();
        let found = match NaturalFrequencies::new(&setting, count)?.at(&self.state.constants.map(f64::exp), &states) {
            Ok(found) => found,
            Err(ModelError::Unsupported(_)) => return Ok((vec![], vec![])),
            Err(error) => return Err(error.into()),
        };
        let nodes = bending_nodes(test.boundary, count);
        let (mut modes, mut hidden) = (vec![], vec![]);
        for (index, ((seen, model), nodes)) in self.start.modes.iter().zip(found).zip(nodes).enumerate() {
            let (mode, told) = (index + 1, damping.get(index).copied());
            match seen {
                Some((measured, _)) => {
                    let measured_std = self.start.frequency_stds.get(index).copied().flatten();
                    modes.push(ModeFit { mode, nodes, measured: *measured, measured_std, model, damping: told });
                }
                None if index < damping.len() => {
                    hidden.push(HiddenMode { mode, nodes, model, damping: told.filter(is_told) });
                }
                None => {}
            }
        }
        Ok((modes, hidden))
    }
}
