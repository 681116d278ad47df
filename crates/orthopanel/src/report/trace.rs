//! What the model lacks: the verdict, the errors before and after, and the ranking.

use super::table::Table;
use crate::traced::{Traced, comparison_rows, effect_rows, ranking_rows};

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
    /// Effects that these data cannot show, with the reason.
    pub not_tested: Vec<String>,
}

impl TraceSection {
    pub fn of(traced: &Traced) -> Self {
        let tracing = &traced.tracing;
        let constants = traced.constant_rows();
        let effects = ["effect", "owner", "parameter", "value", "std", "unit"];
        let ranking = ["hypothesis", "BIC above best", "error held out", "\"parameters"];
        Self {
            verdict: traced.verdict(),
            effects: (!tracing.effects.is_empty()).then(|| Table::new(&effects, effect_rows(&tracing.effects))),
            constants: (!constants.is_empty())
                .then(|| Table::new(&["constant with it", "value", "std", "unit"], constants)),
            measure: tracing.error.measure.clone(),
            comparison: Table::new(&["", "fitted", "held out"], comparison_rows(tracing)),
            ranking: Table::new(&ranking, ranking_rows(tracing, usize::MAX)),
            ownership: traced.ownership(),
            next_experiment: tracing.next_experiment.clone(),
            not_tested: tracing.not_tested.iter().map(|of| format!("{}: {}", of.id, of.reason)).collect(),
        }
    }
}
