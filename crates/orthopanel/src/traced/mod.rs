//! What a trace found, as text for people and as the panel's model; its JSON (`orthopanel.trace/2`) is the layer's own.

mod left;
mod lists;
mod places;
mod sentences;
mod tables;

use orthopanel_data::KnownConstant;
use orthopanel_identify::{AcceleranceFit, Progress, Removed, Settings, Tracing, Verdict, trace_against, trace_with};
use orthopanel_model::{CUBIC_STIFFNESS, Damping, PanelModel, Place};
use serde_json::Value;

use crate::identified::{ASSUMED_DAMPING, base_models, to_digits};
use crate::notes::note;
use crate::observer::{Observer, Steps};
use crate::provenance::{Provenance, WithProvenance};
use crate::{Error, Model, Silent, Test, interruption, json};
pub use places::found_places;
pub use tables::{RANKING_HEADINGS, comparison, effect_rows, not_tested, ranking_rows};

/// What a mode's entry in a model's provenance tells of the test alone.
const AS_MEASURED: [&str; 4] = ["mode", "nodes", "measured_hz", "measured_std_hz"];

/// Standard deviations of a traced panel's damping ratios, in its provenance.
const DAMPING_STD: &str = "damping_std";

const DAMPING: &str = "with the effects, the ratios of the measured modes less what dashpots and windows among the effects bring; beyond \
                                their geometric mean";
/// What the model of a test lacks.
pub struct Traced {
    pub(crate) tracing: Tracing,
}

impl Test {
    /// The effect that the model lacks.
    ///
    /// # Errors
    /// [`Error::Identify`].
    ///
    /// # Examples
    /// ```
    /// let test = orthopanel::Test::load("../../examples/piece-1/test.toml")?;
    /// let why = test.trace()?;
    /// println!("{}", why.text());
    /// let error = &why.tracing().error;
    /// assert!(error.after.fitted <= error.before.fitted);
    /// # Ok::<(), orthopanel::Error>(())
    /// ```
    pub fn trace(&self) -> Result<Traced, Error> {
        self.trace_with(None, &Silent)
    }

    /// As [`Test::trace`], against a sound panel of the same make where there is one, and told to an observer.
    ///
    /// # Errors
    /// [`Error::Identify`], and [`Error::Interrupted`] where the observer asks for it.
    pub fn trace_with(&self, reference: Option<&Test>, observer: &dyn Observer) -> Result<Traced, Error> {
        Traced::of(self, reference, observer)
    }
}

impl Traced {
    /// Traces, against a sound panel of the same make where there is one; says what was noted.
    pub(crate) fn of(test: &Test, reference: Option<&Test>, observer: &dyn Observer) -> Result<Self, Error> {
        let path = test.path();
        let test = test.content();
        let mut tracing = {
            let shown = observer.begin("tracing what the model lacks", Steps::Named);
            let tell = |at: Progress| {
                shown.at(at.done, at.of, at.effect);
                interruption::heed(observer);
            };
            let traced = interruption::caught(|| match reference {
                Some(reference) => trace_against(test, reference.content(), &tell),
                None => trace_with(test, &tell),
            })?;
            traced.map_err(|source| Error::Identify { path: path.into(), source })?
        };
        for panel in tracing.panels.iter_mut().filter(|panel| panel.damping == Damping::default()) {
            // Lists tell no damping, and a panel without any would ring for ever.
            panel.damping.beyond = ASSUMED_DAMPING;
            panel.provenance.insert("damping".into(), "assumed, not measured".into());
        }
        note(observer, "", &tracing.notes);
        let is_prior = |known: &KnownConstant| matches!(known, KnownConstant::Prior { .. });
        if test.known_constants.values().any(is_prior) || test.pieces.iter().any(|piece| !piece.doubt.is_none()) {
            let what = "priors of constants and standard deviations of sizes and mass count in `identify`; a trace goes by the data alone";
            note(observer, "", &[what.to_owned()]);
        }
        Ok(Self { tracing })
    }

    /// As [`Traced::of`] where tracing is not all that was asked for: of a test that it refuses the sentence that says so.
    ///
    /// # Errors
    /// [`Error::Interrupted`].
    pub(crate) fn where_possible(
        test: &Test,
        reference: Option<&Test>,
        observer: &dyn Observer,
    ) -> Result<Result<Self, String>, Error> {
        match Self::of(test, reference, observer) {
            Err(Error::Identify { path, source }) => {
                observer.say(&format!("not traced: {}: {source}", path.display()));
                Ok(Err(format!("Not traced: {source}.")))
            }
            traced => traced.map(Ok),
        }
    }

    /// Verdict, effects, errors, candidates and the next experiment.
    pub fn tracing(&self) -> &Tracing {
        &self.tracing
    }

    /// One JSON object (`orthopanel.trace/2`) on one line.
    pub fn to_json(&self) -> String {
        json::line(&self.tracing)
    }

    /// As [`Traced::to_json`], with what it is of.
    #[doc(hidden)]
    pub fn to_json_with(&self, provenance: &Provenance) -> String {
        json::line(&WithProvenance { answer: &self.tracing, provenance })
    }

    /// The panels with the effects that were found and are theirs; `None` where no effect was found, or none that explains
    /// the data.
    fn panels(&self) -> Option<&[PanelModel]> {
        let found = matches!(self.tracing.verdict, Verdict::Explained | Verdict::Ambiguous);
        (found && !self.tracing.effects.is_empty()).then_some(&self.tracing.panels)
    }

    /// The accelerance of the model with the effects from one place to another; `None` where no effect was found, and
    /// where one makes of each hit something else.
    pub(crate) fn accelerance_of(&self, places: (Place, Place)) -> Option<&AcceleranceFit> {
        let effects = &self.tracing.effects;
        if effects.is_empty() || effects.iter().any(|effect| effect.id == CUBIC_STIFFNESS) {
            return None;
        }
        self.tracing.accelerances.iter().find(|pair| (pair.force_at, pair.response_at) == places)
    }

    /// Whether effects were found that explain the data.
    pub fn explains(&self) -> bool {
        self.panels().is_some()
    }

    /// The identified models with what the trace found, where it explains the data: its constants, its damping and the
    /// panel's own effects. Effects of rig and measuring chain are in none of them. Each tells the verdict and what was taken
    /// out.
    pub(crate) fn applied_to(&self, models: &[PanelModel]) -> Vec<PanelModel> {
        let mut models = models.to_vec();
        let hit = self.tracing.accelerances.first().map(|record| record.piece);
        for (piece, (model, panel)) in models.iter_mut().zip(self.panels().unwrap_or_default()).enumerate() {
            model.structure = panel.structure;
            model.constants.clone_from(&panel.constants);
            model.damping.clone_from(&panel.damping);
            model.correlation.clone_from(&panel.correlation);
            model
                .provenance
                .extend(panel.provenance.get_key_value(DAMPING_STD).map(|(key, std)| (key.clone(), std.clone())));
            model.effects.clone_from(&panel.effects);
            if let Some(modes) = model.provenance.get_mut("modes").and_then(Value::as_array_mut) {
                // The rest is that of the model without the effects.
                modes.iter_mut().filter_map(Value::as_object_mut).for_each(|mode| {
                    mode.retain(|key, _| AS_MEASURED.contains(&key.as_str()));
                });
            }
            self.put_own_errors(model, hit.is_none_or(|hit| hit == piece));
        }
        let removed: Vec<&str> = self.taken_out().map(|removed| removed.id).collect();
        for model in &mut models {
            model.provenance.insert("trace".into(), self.tracing.verdict.name().into());
            if !removed.is_empty() {
                model.provenance.insert("removed".into(), removed.clone().into());
            }
        }
        models
    }

    /// The models of the test after tracing, one a piece: effects of the panel stay in them, those of rig and measuring chain are
    /// taken out. Where no effect explains the data, they are those of the base model.
    ///
    /// # Errors
    /// [`Error::Identify`] where no effect explains the data and the base model is refused.
    pub fn models(&self, test: &Test) -> Result<Vec<Model>, Error> {
        self.models_with(test, &Silent)
    }

    /// As [`Traced::models`], told to an observer.
    ///
    /// # Errors
    /// As [`Traced::models`].
    pub fn models_with(&self, test: &Test, observer: &dyn Observer) -> Result<Vec<Model>, Error> {
        let of = |panels: Vec<PanelModel>| panels.into_iter().map(|panel| Model::of(panel, test.path())).collect();
        // The panels of the trace hold constants beside effects that explain nothing.
        if self.tracing.verdict == Verdict::Unexplained {
            let _shown = observer.begin("identifying the base model", Steps::Unknown);
            let base = base_models(test.content(), Settings::default());
            let base = base.map_err(|source| Error::Identify { path: test.path().into(), source })?;
            return Ok(of(self.applied_to(&base)));
        }
        Ok(of(self.applied_to(&self.tracing.panels)))
    }

    /// As [`Traced::models_with`], each behind `-NAME` of its piece, safe in file names, where there are several.
    ///
    /// # Errors
    /// As [`Traced::models`].
    pub fn named_models(&self, test: &Test, observer: &dyn Observer) -> Result<Vec<(String, Model)>, Error> {
        Ok(test.suffixes().zip(self.models_with(test, observer)?).collect())
    }

    /// Effects of rig and measuring chain that the models that are written do not have: found ones only where they explain
    /// the data.
    fn taken_out(&self) -> impl Iterator<Item = &Removed> {
        let is_found = |id: &str| self.tracing.effects.iter().any(|effect| effect.id == id);
        self.tracing.removed.iter().filter(move |removed| self.explains() || !is_found(removed.id))
    }

    /// The errors and the damping that a provenance tells are those of the model without the effects: in their place come
    /// this model's own, as far as the trace tells them; of a piece beside the one that was hit it tells none.
    fn put_own_errors(&self, model: &mut PanelModel, is_told: bool) {
        let provenance = &mut model.provenance;
        for key in ["frequency_rms_percent", "accelerance_rms_percent"] {
            provenance.remove(key);
        }
        if !is_told {
            return;
        }
        let Some(accelerances) = self.accelerance_rms_percent() else {
            let error = to_digits(self.tracing.error.after.fitted, 2);
            provenance.insert("frequency_rms_percent".into(), error.into());
            return;
        };
        provenance.insert("accelerance_rms_percent".into(), to_digits(accelerances, 2).into());
        provenance.remove("damping_law");
        provenance.insert("damping".into(), DAMPING.into());
    }

    /// Rms of what the model with the effects leaves of the records over the rms measured \[%\]; `None` where lists
    /// were traced.
    fn accelerance_rms_percent(&self) -> Option<f64> {
        let lines = || self.tracing.accelerances.iter().flat_map(|pair| pair.measured.iter().zip(&pair.model));
        let measured: f64 = lines().map(|(measured, _)| measured.norm_sqr()).sum();
        let left: f64 = lines().map(|(measured, model)| (measured - model).norm_sqr()).sum();
        (measured > 0.0).then(|| 100.0 * (left / measured).sqrt())
    }
}
