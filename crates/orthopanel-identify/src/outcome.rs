//! What a trace found, whichever search found it.

use orthopanel_model::{Owner, PanelModel};

use crate::traced_effect::TracedEffect;
use crate::{AcceleranceFit, IdentifyError};

/// What can be said of the physics that the base model lacks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// The base model meets the data: no effect pays for its parameters.
    NothingMissing,
    /// One effect, or several, clearly ahead of all others.
    Explained,
    /// Several effects fit alike, or some are ahead of nothing missing, but not clearly, and none is named: see [`Tracing::alternatives`] and
    /// [`Tracing::next_experiment`].
    Ambiguous,
    /// Structure remains in the residual, and no effect of the catalogue takes it away.
    Unexplained,
}

impl Verdict {
    /// The word in files: `nothing-missing`, `explained`, `ambiguous` or `unexplained`.
    pub fn name(self) -> &'static str {
        match self {
            Self::NothingMissing => "nothing-missing",
            Self::Explained => "explained",
            Self::Ambiguous => "ambiguous",
            Self::Unexplained => "unexplained",
        }
    }
}

/// What a trace found: the verdict, the effects with their parameters, and the model with them.
#[derive(Debug, Clone, PartialEq)]
pub struct Tracing {
    /// The verdict.
    pub verdict: Verdict,
    /// The effects that explain the data best; what the file declares is not among them.
    pub effects: Vec<TracedEffect>,
    /// Effects that explain the data about as well: ids, each once.
    pub alternatives: Vec<String>,
    /// Error of the base and of the model with the effects.
    pub error: TracedError,
    /// By how much the model misses beside noise, as it was estimated with the rest.
    pub model_error: Option<EstimatedModelError>,
    /// Every hypothesis that was fitted, the likeliest first.
    pub candidates: Vec<Candidate>,
    /// Effects that these data cannot show, with the reason.
    pub not_tested: Vec<NotTested>,
    /// The measurement that would part the alternatives best, with what it is expected to show.
    pub next_experiment: String,
    /// The smallest disbond that the test would show; `None` where none is looked for, and where one was found.
    pub detectable: Option<Detectable>,
    /// What a reference of the same make shows of the model's error; `None` where none was given.
    pub shared_model_error: Option<SharedModelError>,
    /// Misfit per datum of the model with the effects, in units of the noise: near 1 where nothing is left.
    pub chi_square: f64,
    /// Each piece with the effects that belong to it, without those of rig and measuring chain.
    pub panels: Vec<PanelModel>,
    /// Effects that are in the data and not in [`Tracing::panels`].
    pub removed: Vec<Removed>,
    /// Every record with the accelerance that the model with the effects foretells; empty where none was measured.
    pub accelerances: Vec<AcceleranceFit>,
    /// The same records with the accelerance that the base model foretells.
    pub base_accelerances: Vec<AcceleranceFit>,
    /// What was assumed or left out, a sentence each.
    pub notes: Vec<String>,
}

impl Tracing {
    /// Refuses a trace whose errors are no finite numbers, and leaves candidates without a finite criterion out of the ranking.
    ///
    /// # Errors
    /// [`IdentifyError::NotFinite`].
    pub(crate) fn finite(mut self) -> Result<Self, IdentifyError> {
        let TracedError { before, after, noise_floor, .. } = &self.error;
        for (what, value) in [
            ("error of the base model", before.fitted),
            ("error of the base model on what was held out", before.held_out),
            ("error of the model with the effects", after.fitted),
            ("error of the model with the effects on what was held out", after.held_out),
            ("noise floor", *noise_floor),
            ("misfit per datum", self.chi_square),
        ] {
            if !value.is_finite() {
                return Err(IdentifyError::NotFinite { what: what.into() });
            }
        }
        let is_finite = |of: &Candidate| of.log_evidence.is_finite() && of.held_out.is_finite();
        let (ranked, lost): (Vec<_>, Vec<_>) = std::mem::take(&mut self.candidates).into_iter().partition(is_finite);
        self.candidates = ranked;
        let left_out =
            |of: Candidate| format!("{} is left out of the ranking: its criterion is no finite number", of.id);
        self.notes.extend(lost.into_iter().map(left_out));
        Ok(self)
    }
}

/// By how much a sound model of this panel misses what was measured, beside noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EstimatedModelError {
    /// Standard deviation of the logarithm of each natural frequency \[1\].
    pub frequency: f64,
    /// The same of each residue along its phase, over the rms of its mode's residues \[1\]; `None` where frequencies alone were measured.
    pub residue: Option<f64>,
}

/// Error before and after, on what was fitted and on what was held out.
#[derive(Debug, Clone, PartialEq)]
pub struct TracedError {
    /// What the numbers are, in words.
    pub measure: String,
    /// The base model's.
    pub before: FittedError,
    /// The error with the effects.
    pub after: FittedError,
    /// The error that noise alone makes.
    pub noise_floor: f64,
}

/// An error on what was fitted and on what was held out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FittedError {
    /// On the data of the fit.
    pub fitted: f64,
    /// On each part of the data, predicted from the others.
    pub held_out: f64,
}

/// One hypothesis of the ranking.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// Its effects' ids joined by ` + `; `base` for none.
    pub id: String,
    /// Natural logarithm of the evidence times the prior of the hypothesis: differences are logarithms of odds.
    pub log_evidence: f64,
    /// Error on what was held out, as in [`TracedError`].
    pub held_out: f64,
    /// What was found of the effects.
    pub effects: Vec<TracedEffect>,
}

/// What the model misses of the modes that a reference and the suspect share, rms of the logarithms of their frequencies \[1\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SharedModelError {
    /// How many modes both show.
    pub modes: usize,
    /// Of the reference beside its own constants.
    pub reference: f64,
    /// Of the suspect beside what was found.
    pub suspect: f64,
    /// The same less what is missed of the reference: smaller, where the two share their error.
    pub suspect_less_reference: f64,
}

/// From which size on a disbond would be named, to first order about the model with the effects.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Detectable {
    /// Its id in the catalogue.
    pub effect: &'static str,
    /// Part of the shear stiffness that it loses \[1\].
    pub loss: f64,
    /// Side \[m\] from which on it shows at half of the places that were looked at, on a beam its length; `None` where it does at fewer.
    pub at_half_of_the_places: Option<f64>,
    /// The same at all of them.
    pub anywhere: Option<f64>,
    /// How many places were looked at.
    pub places: usize,
    /// Largest side that was looked at \[m\].
    pub most: f64,
}

/// An effect that was not tested.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NotTested {
    /// Its id.
    pub id: &'static str,
    /// Why these data cannot show it.
    pub reason: String,
}

/// An effect that is in the data and not of the panel.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Removed {
    /// Its id.
    pub id: &'static str,
    /// Whose it is.
    pub owner: Owner,
    /// Why it is not in the panel's model, a sentence.
    pub why: String,
}

impl Removed {
    /// Why an effect is not in the panel's model.
    pub(crate) fn of(effect: &TracedEffect, is_declared: bool) -> Self {
        let told = if is_declared { "declared in the test file" } else { "found in the data" };
        let why = match effect.owner {
            Owner::Rig => "it belongs to the rig: the panel in service carries neither sensor nor suspension",
            _ => "it belongs to the measuring chain: the panel itself does not have it",
        };
        Self { id: effect.id, owner: effect.owner, why: format!("{told}; {why}") }
    }
}

/// How far a trace is: one effect of the catalogue after the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Progress {
    /// The effect that was fitted last, or what is done now.
    pub effect: &'static str,
    /// How many are done.
    pub done: usize,
    /// of how many.
    pub of: usize,
}
