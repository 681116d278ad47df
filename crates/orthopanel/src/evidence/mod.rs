//! What a test shows for the models identified from it, gathered once: `run` writes it into its folder, `report` onto a
//! page.

mod hits_with_effects;
mod records;
mod residual;

use std::path::Path;

use orthopanel_data::{Accelerance, Estimation, HitVerdict, ImpactTest, TimeHistory};
use orthopanel_identify::{AcceleranceFit, ForceBetweenSamples, PieceFit};
use orthopanel_model::{PanelModel, Place};

use crate::error::{Error, InFile as _};
use crate::identified::Identified;
use crate::measured_pairs::{ComparedPair, HitMisfit};
use crate::observer::{Observer, Steps};
use crate::traced::Traced;
use crate::whole_accelerance::WholeAccelerance;
use crate::{Test, pictures};
pub use hits_with_effects::HitsWithEffects;
pub use records::RecordRow;
pub use residual::{PairResidual, ResidualUnit, banded};

/// Pictures are SVG.
pub struct Evidence {
    /// In the order of the identified pieces.
    pub pieces: Vec<PieceEvidence>,
}

#[derive(Default)]
pub struct PieceEvidence {
    pub records: Vec<RecordRow>,
    /// Coherence of all records that tell it.
    pub coherence: Option<String>,
    /// Natural frequencies \[Hz\] of the model with the effects, one a mode of the fit: of lists where effects were found.
    pub with_effects: Option<Vec<f64>>,
    /// Natural frequencies, measured and calculated.
    pub frequencies: Option<String>,
    /// Measured and calculated, one a pair of places; without records that of the model alone.
    pub accelerances: Vec<String>,
    /// How each continuous record was cut into hits.
    pub cuts: Vec<String>,
    /// A hit of each pair with the accelerations measured and calculated under it.
    pub time_histories: Vec<String>,
    /// One a measured accelerance.
    pub residuals: Vec<PairResidual>,
    /// How far the base model and that with the effects are from the hits of each pair, where effects were found that act on
    /// every hit alike.
    pub hits_with_effects: Vec<HitsWithEffects>,
    /// How far the model is from each measured hit.
    pub hits: Vec<HitMisfit>,
    /// Of each hit the greatest force \[N\] and what the model leaves \[% of peak\].
    pub levels: Vec<(f64, f64)>,
}

impl Evidence {
    /// With what a trace found.
    pub fn of(identified: &Identified, traced: Option<&Traced>, observer: &dyn Observer) -> Result<Self, Error> {
        let Identified { test, settings, found, models, .. } = identified;
        let (path, test, estimation) = (test.path(), test.content(), settings.estimation);
        let with_effects = traced.and_then(|traced| traced.frequencies(test, &found.pieces));
        let with_effects = |index: usize| with_effects.as_ref()?.get(index).filter(|modes| !modes.is_empty()).cloned();
        let mut pieces = Vec::with_capacity(found.pieces.len());
        for (index, (fit, model)) in found.pieces.iter().zip(models).enumerate() {
            let own: Vec<_> = found.accelerances.iter().filter(|pair| pair.piece == index).collect();
            pieces.push(PieceEvidence::of_fit((fit, model), &own, with_effects(index), path)?);
        }
        let mut accelerances: Vec<(usize, Accelerance)> = Vec::new();
        let histories = read(test, observer)?;
        let (shown, count) = (observer.begin("driving the model", Steps::Of(histories.len())), histories.len());
        for (done, (piece, history)) in (1..).zip(histories) {
            let (Some(fit), Some(model), Some(evidence)) =
                (found.pieces.get(piece), models.get(piece), pieces.get_mut(piece))
            else {
                continue;
            };
            let accelerance = history.accelerance(estimation)?;
            evidence.records.push(RecordRow::of_hits(&history, &accelerance));
            evidence.add_cuts(&test.pieces[piece].name, &history)?;
            let places = (history.force_at, history.response_at);
            let mut own = found.accelerances.iter().filter(|pair| pair.piece == piece);
            let pair = own.find(|pair| (pair.force_at, pair.response_at) == places);
            let with = traced.and_then(|traced| traced.accelerance_of(places));
            if let (Some(base), Some(with)) = (pair, with) {
                let kept: Vec<bool> = accelerance.verdicts.iter().map(HitVerdict::is_kept).collect();
                evidence.hits_with_effects.extend(HitsWithEffects::of(&history, &kept, base, with));
            }
            let band = pair.and_then(|pair| Some(*pair.frequency.first()?..=*pair.frequency.last()?));
            let compared = ComparedPair::of(model, history, ForceBetweenSamples::BandLimited, band)
                .map_err(|source| Error::Identify { path: path.into(), source })?;
            evidence.time_histories.push(pictures::time_history(&fit.name, &compared)?);
            let misfits = compared.misfits();
            evidence.levels.extend(misfits.iter().map(|hit| (hit.peak_force_n, hit.rms_percent())));
            evidence.hits.extend(misfits);
            accelerances.push((piece, accelerance));
            shown.at(done, count, "");
        }
        Self::with_coherence(test, pieces, accelerances)
    }

    /// What a trace alone shows, of a test of which no base model was identified.
    pub fn of_trace(
        test: &Test,
        traced: &Traced,
        estimation: Estimation,
        observer: &dyn Observer,
    ) -> Result<Self, Error> {
        let test = test.content();
        let base = &traced.tracing.base_accelerances;
        let mut pieces = Vec::with_capacity(test.pieces.len());
        for (index, named) in test.pieces.iter().enumerate() {
            let mut evidence = PieceEvidence::default();
            evidence.add_pairs(&named.name, base.iter().filter(|pair| pair.piece == index))?;
            pieces.push(evidence);
        }
        let mut accelerances: Vec<(usize, Accelerance)> = Vec::new();
        let histories = read(test, observer)?;
        let (shown, count) = (observer.begin("comparing the hits", Steps::Of(histories.len())), histories.len());
        for (done, (piece, history)) in (1..).zip(histories) {
            shown.at(done, count, "");
            let Some(evidence) = pieces.get_mut(piece) else { continue };
            let accelerance = history.accelerance(estimation)?;
            evidence.records.push(RecordRow::of_hits(&history, &accelerance));
            evidence.add_cuts(&test.pieces[piece].name, &history)?;
            let places = (history.force_at, history.response_at);
            let mut own = base.iter().filter(|pair| pair.piece == piece);
            if let Some(base) = own.find(|pair| (pair.force_at, pair.response_at) == places) {
                let kept: Vec<bool> = accelerance.verdicts.iter().map(HitVerdict::is_kept).collect();
                let alone = HitsWithEffects::of(&history, &kept, base, base);
                evidence.levels.extend(alone.into_iter().flat_map(|hits| hits.levels));
                let with = traced.accelerance_of(places);
                evidence
                    .hits_with_effects
                    .extend(with.and_then(|with| HitsWithEffects::of(&history, &kept, base, with)));
            }
            accelerances.push((piece, accelerance));
        }
        Self::with_coherence(test, pieces, accelerances)
    }

    /// Adds the accelerances that are files of their own to those of the hits, and draws the coherence of both.
    fn with_coherence(
        test: &ImpactTest,
        mut pieces: Vec<PieceEvidence>,
        mut accelerances: Vec<(usize, Accelerance)>,
    ) -> Result<Self, Error> {
        for (piece, accelerance) in test.recorded_accelerances()? {
            if let Some(evidence) = pieces.get_mut(piece) {
                evidence.records.push(RecordRow::of_accelerance(&accelerance));
                accelerances.push((piece, accelerance));
            }
        }
        for (index, (evidence, named)) in pieces.iter_mut().zip(&test.pieces).enumerate() {
            let own: Vec<&Accelerance> =
                accelerances.iter().filter(|(piece, _)| *piece == index).map(|(_, accelerance)| accelerance).collect();
            evidence.coherence = pictures::coherence(&named.name, &own)?;
        }
        Ok(Self { pieces })
    }

    /// How far the model is from the measured hits of all pieces.
    pub fn into_hits(self) -> Vec<HitMisfit> {
        self.pieces.into_iter().flat_map(|piece| piece.hits).collect()
    }
}

fn read(test: &ImpactTest, observer: &dyn Observer) -> Result<Vec<(usize, TimeHistory)>, Error> {
    let _shown = observer.begin("reading the records", Steps::Unknown);
    Ok(test.time_histories()?)
}

impl PieceEvidence {
    fn of_fit(
        (fit, model): (&PieceFit, &PanelModel),
        pairs: &[&AcceleranceFit],
        with_effects: Option<Vec<f64>>,
        path: &Path,
    ) -> Result<Self, Error> {
        let mut evidence = Self { with_effects, ..Self::default() };
        if !fit.modes.is_empty() {
            evidence.frequencies = Some(pictures::frequencies(fit, evidence.with_effects.as_deref())?);
        }
        evidence.add_pairs(&fit.name, pairs.iter().copied())?;
        if let (true, Some(&force), Some(&response)) =
            (pairs.is_empty(), model.ports.forces.first(), model.ports.responses.first())
        {
            evidence.accelerances.push(calculated(fit, model, [force, response], path)?);
        }
        Ok(evidence)
    }

    fn add_cuts(&mut self, name: &str, history: &TimeHistory) -> Result<(), Error> {
        for cut in &history.cuts {
            self.cuts.push(pictures::cut(name, cut)?);
        }
        Ok(())
    }

    /// The picture and the residual of each pair of places.
    fn add_pairs<'a>(&mut self, name: &str, pairs: impl Iterator<Item = &'a AcceleranceFit>) -> Result<(), Error> {
        for pair in pairs {
            self.accelerances.push(pictures::measured_accelerance(name, pair)?);
            self.residuals.push(PairResidual::of(pair));
        }
        Ok(())
    }
}

/// Accelerance of the model alone, over the measured natural frequencies.
fn calculated(fit: &PieceFit, model: &PanelModel, [force, response]: [Place; 2], path: &Path) -> Result<String, Error> {
    let highest = fit.modes.iter().map(|mode| mode.measured).fold(0.0, f64::max);
    let seen = WholeAccelerance::up_to(model, highest, force, response).in_file(path)?;
    pictures::accelerance(fit, [force, response], &seen)
}
