//! What a trace found, as tables: the effects, the errors, the ranking.

use orthopanel_identify::{Candidate, FittedError, TracedEffect, TracedParameter, Tracing};
use orthopanel_model::{Estimate, Readable};

use super::Traced;
use crate::tables::{aligned, ending_in_words, shown_unit, with_unit};

/// Effect, owner, parameter, value, standard deviation and unit; a row a number.
pub fn effect_rows(effects: &[TracedEffect]) -> Vec<Vec<String>> {
    effects.iter().flat_map(|effect| effect.parameters.iter().flat_map(|of| parameter_rows(effect, of))).collect()
}

fn parameter_rows(effect: &TracedEffect, parameter: &TracedParameter) -> Vec<Vec<String>> {
    let several = parameter.values.len() > 1;
    let row = |(record, estimate): (usize, &Estimate)| {
        let name = if several { format!("{} of record {record}", parameter.name) } else { parameter.name.to_owned() };
        let std = estimate.std.map_or("held".into(), |std| format!("{std:.1e}"));
        let unit = shown_unit(parameter.unit);
        let value = format!("{:.4e}", estimate.value);
        vec![effect.id.to_owned(), effect.owner.name().to_owned(), name, value, std, unit.to_owned()]
    };
    (1..).zip(&parameter.values).map(row).collect()
}

/// The base, the model with the effects, and the noise: error on what was fitted and on what was held out. Headings first.
pub fn comparison(tracing: &Tracing) -> ([&'static str; 3], Vec<Vec<String>>) {
    let error = &tracing.error;
    let row = |name: &str, error: FittedError| vec![name.into(), number(error.fitted), number(error.held_out)];
    let floor = FittedError { fitted: error.noise_floor, held_out: error.noise_floor };
    let rows = vec![row("before", error.before), row("after", error.after), row("noise and model error", floor)];
    (["", "fitted", "held out"], rows)
}

/// Headings of [`ranking_rows`].
pub const RANKING_HEADINGS: [&str; 3] = ["hypothesis", "log evidence", "held out"];

/// Candidate, its evidence beside the best one's, error held out and parameters.
pub fn ranking_rows(tracing: &Tracing, most: usize) -> Vec<Vec<String>> {
    let best = tracing.candidates.iter().map(|candidate| candidate.log_evidence).fold(f64::NEG_INFINITY, f64::max);
    let row = |candidate: &Candidate| {
        let margin = candidate.log_evidence - best;
        let error = number(candidate.held_out);
        vec![candidate.id.clone(), format!("{:.1}", Readable(margin)), error, parameters_text(candidate)]
    };
    tracing.candidates.iter().take(most).map(row).collect()
}

/// Such as `mass 5.02e-3 +- 1.1e-5 kg`.
fn parameters_text(candidate: &Candidate) -> String {
    let several = candidate.effects.len() > 1;
    let text = |(id, parameter): (&str, &TracedParameter)| {
        let name = if several { format!("{id}.{}", parameter.name) } else { parameter.name.to_owned() };
        match &parameter.values[..] {
            [one] => {
                let std = one.std.map_or(String::new(), |std| format!(" +- {std:.1e}"));
                with_unit(&format!("{name} {:.3e}{std}", one.value), parameter.unit)
            }
            many => format!("{name} of {} records", many.len()),
        }
    };
    let all = candidate.effects.iter();
    let all = all.flat_map(|effect| effect.parameters.iter().map(move |parameter| (effect.id, parameter)));
    all.map(text).collect::<Vec<_>>().join(", ")
}

fn number(value: f64) -> String {
    if (0.01..1e4).contains(&value) { format!("{value:.3}") } else { format!("{value:.2e}") }
}

/// Hypotheses listed for people; JSON holds all.
const LISTED: usize = 10;

/// The effects that were not tested, those of one reason together, in the order of the catalogue.
pub fn not_tested(tracing: &Tracing) -> Vec<String> {
    let mut by_reason: Vec<(&str, Vec<&str>)> = vec![];
    for of in &tracing.not_tested {
        match by_reason.iter_mut().find(|(reason, _)| *reason == of.reason) {
            Some((_, ids)) => ids.push(of.id),
            None => by_reason.push((&of.reason, vec![of.id])),
        }
    }
    by_reason.into_iter().map(|(reason, ids)| format!("{}: {reason}", ids.join(", "))).collect()
}

impl Traced {
    /// Constants of the panel beside the effects that were found: those of the model that is written; none where no
    /// effect was found.
    pub(crate) fn constant_rows(&self) -> Vec<Vec<String>> {
        let row = |(name, of): (&String, &Estimate)| {
            let std = of.std.map_or("held".into(), |std| format!("{std:.1e}"));
            let unit = if name == "nu_xy" { "" } else { "Pa" };
            vec![name.clone(), format!("{:.4e}", of.value), std, unit.to_owned()]
        };
        self.constants().map(row).collect()
    }

    /// The same as numbers.
    pub(crate) fn constants(&self) -> impl Iterator<Item = (&String, &Estimate)> {
        self.panels().and_then(|panels| panels.first()).into_iter().flat_map(|panel| &panel.constants)
    }

    /// For people: verdict, effects, errors, ranking, ownership and the next experiment.
    pub fn text(&self) -> String {
        let tracing = &self.tracing;
        let mut text = self.verdict() + "\n";
        if !tracing.effects.is_empty() {
            let headings = ["effect", "owner", "parameter", "value", "std", "unit"];
            text += &format!("\n{}", aligned(&headings, &effect_rows(&tracing.effects)));
        }
        text.extend(self.places().map(|place| place + "\n"));
        let constants = self.constant_rows();
        if !constants.is_empty() {
            text += &format!("\n{}", aligned(&["constant with it", "value", "std", "unit"], &constants));
        }
        text += &format!("\n{}\n", tracing.error.measure);
        let (headings, rows) = comparison(tracing);
        text += &aligned(&headings, &rows);
        text.extend(self.model_error().map(|told| told + "\n"));
        text.extend(self.shared_model_error().map(|told| told + "\n"));
        text.extend(self.left().map(|left| left + ".\n"));
        let [hypothesis, evidence, held_out] = RANKING_HEADINGS;
        let headings = [hypothesis, evidence, held_out, "parameters"];
        text += &format!("\n{}", ending_in_words(&headings, &ranking_rows(tracing, LISTED)));
        match tracing.candidates.len().saturating_sub(LISTED) {
            0 => {}
            further => text += &format!("and {further} further behind: --json and the report list them all\n"),
        }
        for line in not_tested(tracing) {
            text += &format!("not tested: {line}\n");
        }
        text.extend(self.detectable().map(|told| told + "\n"));
        text += "\n";
        for sentence in self.ownership() {
            text += &(sentence + "\n");
        }
        if !tracing.next_experiment.is_empty() {
            text += &format!("next experiment: {}\n", tracing.next_experiment);
        }
        text
    }
}
