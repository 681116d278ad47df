//! What the model lacks: the verdict, the errors before and after, and the ranking.

use orthopanel_identify::AcceleranceFit;

use super::Figure;
use super::pieces::Gallery;
use super::table::Table;
use crate::error::CommandError;
use crate::evidence::PairResidual;
use crate::traced::{Traced, comparison_rows, effect_rows, ranking_rows};
use crate::{notes, pictures};

pub struct TraceSection {
    pub verdict: String,
    pub effects: Option<Table>,
    /// Those of the panel beside the effects.
    pub constants: Option<Table>,
    pub measure: String,
    pub comparison: Table,
    pub ranking: Table,
    /// What stays in the model, what was taken out and why.
    pub ownership: Vec<String>,
    pub next_experiment: String,
    /// What was assumed or left out, and how rough the test is.
    pub notes: Vec<String>,
    /// Effects that these data cannot show, with the reason.
    pub not_tested: Vec<String>,
    /// The records beside the model with the effects, and what it leaves of them; none where no effect was found.
    pub fit: Option<Gallery>,
    pub residual: Option<Figure>,
}

impl TraceSection {
    pub fn of(name: &str, traced: &Traced) -> Result<Self, CommandError> {
        let tracing = &traced.tracing;
        let constants = traced.constant_rows();
        let effects = ["effect", "owner", "parameter", "value", "std", "unit"];
        let ranking = ["hypothesis", "BIC above best", "error held out", "\"parameters"];
        let fitted = if tracing.effects.is_empty() { &[][..] } else { &tracing.accelerances[..] };
        Ok(Self {
            verdict: traced.verdict(),
            effects: (!tracing.effects.is_empty()).then(|| Table::new(&effects, effect_rows(&tracing.effects))),
            constants: (!constants.is_empty())
                .then(|| Table::new(&["constant with it", "value", "std", "unit"], constants)),
            measure: tracing.error.measure.clone(),
            comparison: Table::new(&["", "fitted", "held out"], comparison_rows(tracing)),
            ranking: Table::new(&ranking, ranking_rows(tracing, usize::MAX)),
            ownership: traced.ownership(),
            next_experiment: tracing.next_experiment.clone(),
            notes: notes::counted(&tracing.notes).collect(),
            not_tested: tracing.not_tested.iter().map(|of| format!("{}: {}", of.id, of.reason)).collect(),
            fit: gallery(name, fitted)?,
            residual: residual(fitted)?,
        })
    }
}

fn gallery(name: &str, fitted: &[AcceleranceFit]) -> Result<Option<Gallery>, CommandError> {
    let pictures = fitted.iter().map(|pair| pictures::measured_accelerance(name, pair));
    let pictures = pictures.collect::<Result<Vec<_>, _>>()?;
    Ok(Gallery::new(
        "Accelerances with the effects",
        "Measured in orange, calculated with the effects in blue.",
        &pictures,
    ))
}

fn residual(fitted: &[AcceleranceFit]) -> Result<Option<Figure>, CommandError> {
    let residuals: Vec<PairResidual> = fitted.iter().map(PairResidual::of).collect();
    if residuals.is_empty() {
        return Ok(None);
    }
    let caption = "What the model with the effects leaves: compare the same picture without them, further down.";
    Ok(Some(Figure::new(&pictures::residual_by_frequency(&residuals)?, caption)))
}
