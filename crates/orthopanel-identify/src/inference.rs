//! From a test to what it says: measured modes, hypotheses, and one judge.

use orthopanel_data::{ImpactTest, MeasurementData};
use orthopanel_model::{BEAM_CONSTANTS, EffectSetting, RecordSetting, StructureKind, effect};

use crate::IdentifyError;
use crate::comparison::Comparison;
use crate::hit_strength::HitStrength;
use crate::hypothesis::Part;
use crate::judge::{Finding, judged};
use crate::measured::{MeasuredModes, measured_modes};
use crate::model_error::Kind;
use crate::outcome::Progress;
use crate::posterior::Judged;
use crate::search::Inquiry;
use crate::search_progress::SearchProgress;

/// What a test says of a beam: its constants, the effects that the model lacked, and by how much the model still misses.
///
/// # Method
/// The records are brought to [`MeasuredModes`] first, which know no physics. Every hypothesis, nothing missing, each effect of the
/// catalogue, and more of them while the evidence grows, predicts the same modes. What is measured less what is predicted has the covariance
/// $$C = C_\text{noise} + \sum_k\tau_k^2F_kF_k^T$$
/// of noise and of the model errors that every real panel has: of each frequency and residue, of places and gains, of core, faces and mass
/// along the panel. The sizes $\tau_k$ are estimated with the parameters $\theta$. Hypotheses are compared by the marginal likelihood
/// $$p(d) = \int p(d\mid\theta,\tau)\,p(\theta)\,p(\tau)\,d\theta\,d\tau$$
/// in Laplace's approximation (MacKay, Neural Computation 4, 1992), each effect lacking by itself with the prior odds of one to the size of the
/// catalogue.
///
/// # Limits
/// Hits or accelerances of one piece, as a beam that may turn out a plate, hit and seen on its centre line. What shows between hits alone,
/// `cubic-stiffness`, is held against the best of the other hypotheses. Standard deviations hold the sizes of model error as they are estimated, not
/// their own uncertainty, which makes them small where modes are few. [`trace_by_modes`](crate::trace_by_modes) answers by it.
#[derive(Debug, Clone)]
pub struct Inference {
    /// What is said.
    pub finding: Finding,
    /// The constants with the hypothesis that was chosen.
    pub constants: Vec<InferredValue>,
    /// Its effects, declared ones first.
    pub effects: Vec<InferredEffect>,
    /// Effects that fit alike, where it is ambiguous.
    pub rivals: Vec<&'static str>,
    /// $\tau$ of the logarithm of each frequency.
    pub frequency_error: f64,
    /// $\tau$ of each residue along its phase, over the rms of the mode's residues.
    pub residue_error: f64,
    /// Undeclared effects of each hypothesis, and the logarithm of its odds against the likeliest, which stands first.
    pub hypotheses: Vec<(Vec<&'static str>, f64)>,
}

/// An effect with its parameters.
#[derive(Debug, Clone)]
pub struct InferredEffect {
    /// Its id.
    pub id: &'static str,
    /// Whether the test file declares it.
    pub declared: bool,
    /// Its parameters, one a record where each record has its own.
    pub parameters: Vec<InferredValue>,
}

/// A value with its standard deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InferredValue {
    /// Its name in files.
    pub name: &'static str,
    /// The most probable value.
    pub value: f64,
    /// Its standard deviation; `None` where it is held.
    pub std: Option<f64>,
    /// SI unit.
    pub unit: &'static str,
}

/// What the hits or accelerances of a beam say.
///
/// ```
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// use orthopanel_identify::{Finding, infer};
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/made-hits");
/// let said = infer(&orthopanel_data::ImpactTest::read(folder)?)?;
/// assert_eq!(said.finding, Finding::NothingMissing);
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// As [`measured_modes`]; [`IdentifyError::Unsupported`] for what it does not take, and [`IdentifyError::Model`] for a piece or an effect that has
/// no meaning.
pub fn infer(test: &ImpactTest) -> Result<Inference, IdentifyError> {
    with_hypotheses(test, &|_| {}, |_, all| Ok(Inference::of(all)))?.ok_or_else(|| too_few(0))
}

fn too_few(found: usize) -> IdentifyError {
    IdentifyError::TooFewResonances { found, needed: 2, noise_percent: None }
}

/// What is said of the hypotheses that were held against a test, the likeliest first, while all that they were held against is at hand.
///
/// # Errors
/// As [`infer`], and what is said.
pub(crate) fn with_hypotheses<T>(
    test: &ImpactTest,
    progress: &(dyn Fn(Progress) + Sync),
    say: impl FnOnce(&Inquiry, &[Judged]) -> Result<T, IdentifyError>,
) -> Result<T, IdentifyError> {
    let refused = |what: &str| Err(IdentifyError::Unsupported(what.into()));
    let listed = |data: &MeasurementData| matches!(data, MeasurementData::NaturalFrequencies(_));
    if test.pieces.len() != 1 || test.measurements.iter().any(|measurement| listed(&measurement.data)) {
        return refused("an inference from several pieces or from lists of frequencies: use `trace`");
    }
    if test.structure == Some(StructureKind::MindlinPlate) {
        return refused("an inference for a plate: use `identify`");
    }
    let all: Vec<MeasuredModes> = measured_modes(test)?.into_iter().map(MeasuredModes::without_faint).collect();
    let [measured] = &all[..] else { return refused("an inference from hits and accelerances together: use `trace`") };
    let piece = test.pieces[0].piece;
    let setting = EffectSetting {
        piece,
        boundary: test.boundary,
        suspension: test.suspension.clone(),
        record: RecordSetting::default(),
    };
    let records = measured.records.len();
    let mut declared = Vec::new();
    for entry in &test.effects {
        let effect = effect(&entry.id)?;
        let value = |name: &str| entry.parameters.get(name).copied();
        let values: Vec<Option<f64>> =
            effect.parameters().iter().map(|parameter| value(parameter.name).or(parameter.held_at)).collect();
        declared.extend(Part::declared(effect, &values, &piece, records));
    }
    let held: Vec<Option<f64>> =
        BEAM_CONSTANTS.iter().map(|constant| test.constants.get(constant.name).copied()).collect();
    let comparison = Comparison::new(measured, piece.mass());
    let begun = Inquiry::begin(&comparison, &setting, &held, &declared)?;
    let (mut inquiry, base) = begun.ok_or_else(|| too_few(measured.poles.len()))?;
    inquiry.hits = HitStrength::new(test, measured.band)?;
    inquiry.progress = SearchProgress::telling(progress);
    let all = inquiry.search(base);
    say(&inquiry, &all)
}

impl Inference {
    fn of(all: &[Judged]) -> Option<Self> {
        let (chosen, finding, rivals) = judged(all)?;
        let hypothesis = &chosen.hypothesis;
        let values = hypothesis.values_with_deviations(&chosen.posterior.point.z, &chosen.posterior.covariance);
        let mut values = values.into_iter();
        let constants = BEAM_CONSTANTS.iter().zip(values.by_ref());
        let constants = constants
            .map(|(constant, (value, std))| InferredValue { name: constant.name, value, std, unit: constant.unit })
            .collect();
        let effects = hypothesis.parts.iter().map(|part| {
            let parameters = part.parameters().map(|parameter| (parameter.name, parameter.unit)).zip(values.by_ref());
            let parameters =
                parameters.map(|((name, unit), (value, std))| InferredValue { name, value, std, unit }).collect();
            InferredEffect { id: part.effect.id(), declared: part.declared, parameters }
        });
        let size = |kind: Kind| chosen.posterior.log_sizes[kind as usize].exp();
        Some(Self {
            finding,
            constants,
            effects: effects.collect(),
            rivals,
            frequency_error: size(Kind::Frequency),
            residue_error: size(Kind::Residue),
            hypotheses: all.iter().map(|judged| (judged.names(), judged.log_odds - all[0].log_odds)).collect(),
        })
    }
}
