//! A lot on one page: what its panels have in common, by how much they differ, and which of them stand out.

use std::collections::BTreeSet;

use askama::Template;
use orthopanel_model::{BEAM_CONSTANTS, PLATE_CONSTANTS, printable};

use super::{ControlChart, LotRow, Measured, RandomEffects};
use crate::report::{Figure, Table};
use crate::{Error, pictures};

#[derive(Template)]
#[template(path = "lot.html")]
struct Page {
    title: String,
    made_by: &'static str,
    lead: String,
    constants: Table,
    outliers: Table,
    charts: Vec<Figure>,
    effects: Table,
    failed: Table,
}

/// One constant over the lot.
struct OfConstant<'a> {
    name: &'a str,
    unit: &'static str,
    /// Rows that have it, and what they have.
    panels: Vec<(&'a LotRow, Measured)>,
}

impl OfConstant<'_> {
    fn measured(&self) -> Vec<Measured> {
        self.panels.iter().map(|(_, measured)| *measured).collect()
    }

    fn values(&self) -> Vec<f64> {
        self.panels.iter().map(|(_, measured)| measured.value).collect()
    }
}

/// The page of a lot.
///
/// # Errors
/// [`Error::Picture`].
pub fn page(title: &str, rows: &[LotRow]) -> Result<String, Error> {
    let constants = constants(rows);
    let (failed, sound): (Vec<&LotRow>, Vec<&LotRow>) = rows.iter().partition(|row| row.failed.is_some());
    let named: Vec<&&LotRow> = sound.iter().filter(|row| row.effects.is_some()).collect();
    let lead = format!(
        "{} panels: {} with constants, {} with a named effect, {} failed.",
        rows.len(),
        sound.len(),
        named.len(),
        failed.len()
    );
    let effect = |row: &&&LotRow| {
        let text = |of: &Option<String>| of.clone().unwrap_or_default();
        vec![row.panel.clone(), text(&row.verdict), text(&row.effects)]
    };
    let refused = |row: &&LotRow| vec![row.panel.clone(), row.failed.clone().unwrap_or_default()];
    let page = Page {
        title: format!("Lot {title}"),
        made_by: concat!("Written by orthopanel ", env!("CARGO_PKG_VERSION")),
        lead,
        constants: Table::new(&CONSTANTS, constants.iter().map(summary).collect()),
        outliers: Table::new(
            &["panel", "constant", "value", "deviations off", "\"why"],
            constants.iter().flat_map(standing_out).collect(),
        ),
        charts: constants.iter().filter_map(|of| chart(of).transpose()).collect::<Result<_, _>>()?,
        effects: Table::new(&["panel", "\"verdict", "\"effects"], named.iter().map(effect).collect()),
        failed: Table::new(&["panel", "\"why"], failed.iter().map(refused).collect()),
    };
    let page = page.render().map(|page| printable(&page).into_owned());
    page.map_err(|error| Error::Picture { name: "lot", problem: error.to_string() })
}

const CONSTANTS: [&str; 8] = [
    "constant",
    "panels",
    "mean",
    "95 % of the mean",
    "spread between panels",
    "95 % of the spread",
    "own deviation (median)",
    "unit",
];

fn constants(rows: &[LotRow]) -> Vec<OfConstant<'_>> {
    let names: BTreeSet<&String> = rows.iter().flat_map(|row| row.constants.keys()).collect();
    names.into_iter().map(|name| of_name(name, rows)).filter(|of| !of.panels.is_empty()).collect()
}

fn of_name<'a>(name: &'a str, rows: &'a [LotRow]) -> OfConstant<'a> {
    let known = BEAM_CONSTANTS.iter().chain(PLATE_CONSTANTS.iter()).find(|constant| constant.name == name);
    // Without a deviation a constant was held, or the data tell nothing of it.
    let measured = |row: &LotRow| {
        let estimate = row.constants.get(name)?;
        Some(Measured { value: estimate.value, std: estimate.std? })
    };
    let panels = rows.iter().filter_map(|row| Some((row, measured(row)?))).collect();
    OfConstant { name, unit: known.map_or("", |constant| constant.unit), panels }
}

fn summary(of: &OfConstant) -> Vec<String> {
    let number = |value: f64| format!("{value:.4e}");
    let interval = |[low, high]: [f64; 2]| format!("{} to {}", number(low), number(high));
    let start = vec![of.name.to_owned(), of.panels.len().to_string()];
    let numbers = match RandomEffects::of(&of.measured()) {
        Some(found) => {
            let percent = 100.0 * found.spread / found.mean.abs();
            vec![
                number(found.mean),
                interval(found.mean_interval),
                format!("{} ({percent:.2} %)", number(found.spread)),
                interval(found.spread_interval),
                number(found.own),
            ]
        }
        None => vec!["-".to_owned(); 5],
    };
    [start, numbers, vec![of.unit.to_owned()]].concat()
}

/// Panels that stand out by a constant, with why.
fn standing_out(of: &OfConstant) -> Vec<Vec<String>> {
    let (Some(found), Some(chart)) = (RandomEffects::of(&of.measured()), ControlChart::of(&of.values())) else {
        return vec![];
    };
    let outliers: BTreeSet<usize> = found.outliers().collect();
    let why = |panel: usize| {
        let reasons = [
            (outliers.contains(&panel), format!("beyond {:.2} of both spreads", found.limit)),
            (chart.beyond.contains(&panel), "beyond the limits of individuals".to_owned()),
            (chart.jumps.contains(&panel), "further from the panel before than the limit of moving ranges".to_owned()),
            (chart.in_a_run.contains(&panel), "in a run of nine or more on one side of the mean".to_owned()),
        ];
        reasons.into_iter().filter(|(holds, _)| *holds).map(|(_, reason)| reason).collect::<Vec<_>>().join("; ")
    };
    let row = |(panel, (row, measured)): (usize, &(&LotRow, Measured))| {
        let reasons = why(panel);
        let off = format!("{:+.1}", found.residuals[panel]);
        (!reasons.is_empty())
            .then(|| vec![row.panel.clone(), of.name.to_owned(), format!("{:.4e}", measured.value), off, reasons])
    };
    of.panels.iter().enumerate().filter_map(row).collect()
}

fn chart(of: &OfConstant) -> Result<Option<Figure>, Error> {
    let Some(chart) = ControlChart::of(&of.values()) else { return Ok(None) };
    let stds: Vec<f64> = of.panels.iter().map(|(_, measured)| measured.std).collect();
    let svg = pictures::control_chart(&format!("{} [{}]", of.name, of.unit), &of.values(), &stds, &chart)?;
    let caption = format!(
        "{} of each panel in the order of the table, with its own standard deviation; below, how far each is from the one before. Lines: mean and limits of three \
         deviations of the process.",
        of.name
    );
    Ok(Some(Figure::new(&svg, caption)))
}
