//! What the model lacks: the verdict, the errors before and after, and the ranking.

use orthopanel_identify::{AcceleranceFit, FittedError, TracedEffect, Tracing};
use orthopanel_model::{Estimate, Readable, StructureKind};

use super::constants::interval;
use super::figure::Figure;
use super::pieces::Gallery;
use super::table::Table;
use crate::error::Error;
use crate::evidence::{HitsWithEffects, PairResidual};
use crate::measured_pairs::place_text;
use crate::traced::{RANKING_HEADINGS, Traced, comparison, effect_rows, found_places, not_tested, ranking_rows};
use crate::{notes, pictures};

pub struct TraceSection {
    pub verdict: String,
    pub effects: Option<Table>,
    /// Where they sit, in words, and on a plate in a picture.
    pub places: Vec<String>,
    pub map: Option<Figure>,
    /// Those of the panel beside the effects.
    pub constants: Option<Table>,
    pub measure: String,
    pub comparison: Table,
    /// By how much the model misses beside noise.
    pub model_error: Option<String>,
    /// What a reference took off that.
    pub shared_model_error: Option<String>,
    /// From which size on a disbond would have been named.
    pub detectable: Option<String>,
    /// Where most is left of records that no effect explains.
    pub left: Option<String>,
    /// Why what was held out may be met better than what was fitted, where it is.
    pub about_held_out: Option<&'static str>,
    /// What the ranking is by.
    pub about_ranking: &'static str,
    pub ranking: Table,
    /// What stays in the model, what was taken out and why.
    pub ownership: Vec<String>,
    pub next_experiment: String,
    /// What was assumed or left out.
    pub notes: Vec<String>,
    /// Effects that these data cannot show, with the reason.
    pub not_tested: Vec<String>,
    /// The records beside the model with the effects, and what it leaves of them; none where no effect was found.
    pub fit: Option<Gallery>,
    pub residual: Vec<Figure>,
    /// How far both models are from the hits themselves.
    pub hits: Option<Table>,
}

impl TraceSection {
    /// `modes` are the measured natural frequencies \[Hz\], as far as they are known.
    pub fn of(name: &str, traced: &Traced, compared: &[&HitsWithEffects], modes: &[f64]) -> Result<Self, Error> {
        let tracing = &traced.tracing;
        let [hypothesis, evidence, held_out] = RANKING_HEADINGS;
        let ranking = [hypothesis, evidence, held_out, "\"parameters"];
        let (headings, rows) = comparison(tracing);
        let fitted = if tracing.effects.is_empty() { &[][..] } else { &tracing.accelerances[..] };
        Ok(Self {
            verdict: traced.verdict(),
            effects: effects(&tracing.effects),
            places: traced.places().collect(),
            map: map(traced)?,
            constants: constants_with_it(traced),
            measure: tracing.error.measure.clone(),
            comparison: Table::new(&headings, rows),
            model_error: traced.model_error(),
            shared_model_error: traced.shared_model_error(),
            detectable: traced.detectable(),
            left: traced.left(),
            about_held_out: about_held_out(tracing),
            about_ranking: BY_EVIDENCE,
            ranking: Table::new(&ranking, ranking_rows(tracing, usize::MAX)),
            ownership: traced.ownership(),
            next_experiment: tracing.next_experiment.clone(),
            notes: notes::counted(&tracing.notes).collect(),
            not_tested: not_tested(tracing),
            fit: gallery(name, fitted)?,
            residual: residual(fitted, compared, modes)?,
            hits: hits(compared),
        })
    }
}

fn effects(found: &[TracedEffect]) -> Option<Table> {
    let estimates = found.iter().flat_map(|effect| effect.parameters.iter().flat_map(|of| &of.values));
    let rows = with_intervals(effect_rows(found), estimates);
    let headings = ["effect", "owner", "parameter", "value", "std", "95 % interval", "unit"];
    (!rows.is_empty()).then(|| Table::new(&headings, rows))
}

fn constants_with_it(traced: &Traced) -> Option<Table> {
    let rows = with_intervals(traced.constant_rows(), traced.constants().map(|(_, estimate)| estimate));
    (!rows.is_empty()).then(|| Table::new(&["constant with it", "value", "std", "95 % interval", "unit"], rows))
}

/// The interval of each row's estimate before its unit, which stands last.
fn with_intervals<'a>(mut rows: Vec<Vec<String>>, estimates: impl Iterator<Item = &'a Estimate>) -> Vec<Vec<String>> {
    for (row, of) in rows.iter_mut().zip(estimates) {
        let interval = of.std.map_or(String::new(), |std| interval(of.value, std));
        row.insert(row.len().saturating_sub(1), interval);
    }
    rows
}

const BY_EVIDENCE: &str = "The natural logarithm of the evidence of each hypothesis beside that of the likeliest, which takes the parameters that it \
                           brings and the model error into account, and the error on what was held out.";

const HELD_OUT: &str = "Held out is one record after the other, of a single record one mode after the other, each foretold by all others: what those \
                               leave open counts, so the figure held out may stand below the fitted one.";
fn about_held_out(tracing: &Tracing) -> Option<&'static str> {
    let is_below = |error: FittedError| error.held_out < error.fitted;
    let is_odd = !tracing.accelerances.is_empty() && (is_below(tracing.error.before) || is_below(tracing.error.after));
    is_odd.then_some(HELD_OUT)
}

/// A row a pair of places.
fn hits(compared: &[&HitsWithEffects]) -> Option<Table> {
    let row = |pair: &&HitsWithEffects| {
        let [low, high] = pair.band;
        vec![
            format!("{} to {}", place_text(pair.force), place_text(pair.response)),
            format!("{low:.1} to {high:.1} Hz"),
            format!("{:.3}", Readable(pair.before)),
            format!("{:.3}", Readable(pair.after)),
        ]
    };
    let headings = ["force to response [m]", "band", "before [% of peak]", "with the effects [% of peak]"];
    (!compared.is_empty()).then(|| Table::new(&headings, compared.iter().map(row).collect()))
}

fn gallery(name: &str, fitted: &[AcceleranceFit]) -> Result<Option<Gallery>, Error> {
    let pictures = fitted.iter().map(|pair| pictures::measured_accelerance(name, pair));
    let pictures = pictures.collect::<Result<Vec<_>, _>>()?;
    Ok(Gallery::new(
        "Accelerances with the effects",
        "Measured in orange, calculated with the effects in blue.",
        &pictures,
    ))
}

/// Where a plate was hit and seen, with what is left there and where the effects sit.
fn map(traced: &Traced) -> Result<Option<Figure>, Error> {
    let tracing = &traced.tracing;
    let (Some(panel), Some(first)) = (tracing.panels.first(), tracing.accelerances.first()) else { return Ok(None) };
    if panel.structure != StructureKind::MindlinPlate {
        return Ok(None);
    }
    let of_piece = tracing.accelerances.iter().filter(|pair| pair.piece == first.piece);
    let residuals: Vec<PairResidual> = of_piece.map(PairResidual::of).collect();
    let picture = pictures::plate_map(&panel.piece, &residuals, &found_places(&tracing.effects))?;
    Ok(Some(Figure::new(
        &picture,
        "The plate from above: the more a circle covers, the less the model meets the hits there.",
    )))
}

/// Against frequency, place and level, where these are told.
fn residual(fitted: &[AcceleranceFit], compared: &[&HitsWithEffects], modes: &[f64]) -> Result<Vec<Figure>, Error> {
    let residuals: Vec<PairResidual> = fitted.iter().map(PairResidual::of).collect();
    let mut figures = Vec::new();
    if !residuals.is_empty() {
        let caption = "What the model with the effects leaves: compare the same picture without them, further down.";
        figures.push(Figure::new(&pictures::residual_by_frequency(&residuals)?, caption));
    }
    if residuals.len() > 1 {
        let caption = "The same by place: where an effect at one place, or of one record, is all that was missing, none stands out.";
        figures.push(Figure::new(&pictures::residual_by_place(&residuals)?, caption));
    }
    if residuals.len() > 1 && modes.len() > 1 {
        let caption = "The same by place and mode: where nothing stands out, all that was missing is found.";
        figures.push(Figure::new(&pictures::residual_by_place_and_mode(&residuals, modes)?, caption));
    }
    let levels: Vec<(f64, f64)> = compared.iter().flat_map(|pair| &pair.levels).copied().collect();
    if levels.len() > 1 {
        let caption =
            "The same by level, in the band of the trace: a misfit that still grows with the force is not linear.";
        figures.push(Figure::new(&pictures::residual_by_level(&levels)?, caption));
    }
    Ok(figures)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Test;

    /// The lines are drawn at the numbers that the modes say: where nothing is missing, these leave little more than noise.
    #[test]
    fn val_the_picture_shows_noise_where_nothing_is_missing() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/made-hits/test.toml");
        let traced = Test::load(path).and_then(|test| test.trace()).expect("a trace");
        assert!(!traced.tracing.accelerances.is_empty());
        for pair in &traced.tracing.accelerances {
            let shown = PairResidual::of(pair).rms();
            assert!((0.9..1.5).contains(&shown), "{shown} times the noise");
        }
    }
}
