//! What a lot's table says of one panel.

use std::collections::BTreeMap;

use orthopanel_model::{Estimate, PanelModel};

use crate::{Analysis, Error};

/// One panel: a piece of a test, or a test that failed.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LotRow {
    /// The piece's name; of a test with a single piece that of the test's folder or file.
    pub panel: String,
    /// The test file, as it was named.
    pub test: String,
    /// SHA-256 of the SHA-256s of the test file and of every file that it names.
    pub sha256: String,
    /// The version of orthopanel that made the row.
    pub version: String,
    /// Why the panel has no numbers.
    pub failed: Option<String>,
    /// `timoshenko-beam` or `mindlin-plate`.
    pub structure: Option<String>,
    /// Of the model after tracing, in the units of the structure's constants; shear moduli with k' = 2/3.
    pub constants: BTreeMap<String, Estimate>,
    /// Of each two constants that were identified together.
    pub correlations: BTreeMap<(String, String), f64>,
    /// Rms of the frequencies' errors of the base model \[%\].
    pub error_percent: Option<f64>,
    /// The same of each frequency foretold from all others \[%\].
    pub left_out_error_percent: Option<f64>,
    /// The verdict of the trace; `not-traced` where there is none.
    pub verdict: Option<String>,
    /// Ids of the effects that were found, joined by ` + `.
    pub effects: Option<String>,
    /// What was assumed or left out, joined by ` | `.
    pub notes: Option<String>,
}

impl LotRow {
    /// The rows of a test's pieces.
    pub(super) fn of(common: &Self, analysis: &Analysis) -> Vec<Self> {
        let identified = analysis.identified();
        let found = identified.map(|identified| &identified.found);
        let tracing = analysis.traced().ok().map(|traced| &traced.tracing);
        let panels = analysis.panels();
        let names: Vec<&str> = analysis.test.content().pieces.iter().map(|piece| piece.name.as_str()).collect();
        let notes = found.map(|found| &found.notes).into_iter().chain(tracing.map(|tracing| &tracing.notes)).flatten();
        let mut told: Vec<&str> = Vec::new();
        notes.for_each(|note| {
            if !told.contains(&note.as_str()) {
                told.push(note)
            }
        });
        let joined = |texts: Vec<&str>, between: &str| (!texts.is_empty()).then(|| texts.join(between));
        let row = |(index, panel): (usize, &PanelModel)| Self {
            panel: if names.len() > 1 { names[index].to_owned() } else { common.panel.clone() },
            structure: Some(panel.structure.name().to_owned()),
            constants: panel.constants.clone(),
            correlations: correlations(panel),
            error_percent: found.map(|found| found.frequency_rms_percent),
            left_out_error_percent: found.and_then(|found| found.left_one_out_percent),
            verdict: Some(tracing.map_or("not-traced", |tracing| tracing.verdict.name()).to_owned()),
            effects: tracing
                .and_then(|tracing| joined(tracing.effects.iter().map(|effect| effect.id).collect(), " + ")),
            notes: joined(told.clone(), " | "),
            ..common.clone()
        };
        panels.iter().enumerate().map(row).collect()
    }

    /// The row of a test that was refused.
    pub(super) fn refused(common: &Self, error: &Error) -> Self {
        Self { failed: Some(error.to_string()), ..common.clone() }
    }
}

fn correlations(panel: &PanelModel) -> BTreeMap<(String, String), f64> {
    let Some(correlation) = &panel.correlation else { return BTreeMap::new() };
    let is_constant = |name: &String| panel.constants.contains_key(name);
    let mut pairs = BTreeMap::new();
    for (i, first) in correlation.names.iter().enumerate().filter(|(_, name)| is_constant(name)) {
        for (j, second) in correlation.names.iter().enumerate().take(i).filter(|(_, name)| is_constant(name)) {
            let pair = if first < second { (first, second) } else { (second, first) };
            pairs.insert((pair.0.clone(), pair.1.clone()), correlation.matrix[i][j]);
        }
    }
    pairs
}
