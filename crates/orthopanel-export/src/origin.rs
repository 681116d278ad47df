//! The part of the documentation that tells of the panel behind the modes: its sizes, constants and effects, and how it was
//! identified.

use std::fmt::Write as _;

use orthopanel_model::{Boundary, CoreFit, EffectEntry, Estimate, PanelModel, VISCOELASTIC_CORE, effect};

use crate::acceleration_band::AccelerationBands;
use crate::html::escaped;

/// What the page tells of the panel behind the modes.
pub(crate) struct Origin<'a> {
    pub panel: &'a PanelModel,
    /// How the core's modulus is fitted, where one relaxes.
    pub core: Option<CoreFit>,
    pub bands: AccelerationBands,
    /// Of the flexible modes kept; see `frequency_doubt`.
    pub doubt: Vec<f64>,
}

impl Origin<'_> {
    /// Piece, constants, effects, what is told of the identification, and its modes measured and by the model.
    pub(crate) fn section(&self) -> String {
        let mut text = String::from("<h2>Where the panel comes from</h2>\n");
        let rows = self.rows();
        text += "<table>\n<tr><th>what</th><th>value</th><th>standard deviation</th></tr>\n";
        for [name, value, std] in rows {
            let [name, value, std] = [name, value, std].map(|cell| escaped(&cell));
            // Writing to a String has nothing to fail on, here and below.
            let _ = writeln!(text, "<tr><td>{name}</td><td>{value}</td><td>{std}</td></tr>");
        }
        text += "</table>\n";
        let told = self.panel.provenance.iter().filter(|(name, _)| *name != MODES);
        let mut told = told.peekable();
        if told.peek().is_some() {
            text += "<table>\n<tr><th>of the identification</th><th></th></tr>\n";
            for (name, value) in told {
                let value = value.as_str().map_or_else(|| value.to_string(), String::from);
                let (name, value) = (escaped(&name.replace('_', " ")), escaped(&value));
                let _ = writeln!(text, "<tr><td>{name}</td><td>{value}</td></tr>");
            }
            text += "</table>\n";
        }
        text + &self.measured_modes()
    }

    /// Name, value and standard deviation of everything that the panel is made of.
    fn rows(&self) -> Vec<[String; 3]> {
        let piece = &self.panel.piece;
        let exact = |name: &str, value: String| [name.to_owned(), value, String::new()];
        let mut rows = vec![
            exact("structure", self.panel.structure.title().into()),
            exact("length, along x [m]", piece.length.to_string()),
            exact("width, along y [m]", piece.width.to_string()),
            exact("thickness [m]", piece.thickness.to_string()),
            exact("mass per area [kg/m2]", piece.mass_per_area.to_string()),
            exact("mass, without effects [kg]", format!("{:.4}", piece.length * piece.width * piece.mass_per_area)),
            exact("edges", edges(self.panel.boundary)),
        ];
        for (name, estimate) in &self.panel.constants {
            let unit = if name.starts_with("nu") { "" } else { " [Pa]" };
            rows.push(told(format!("{name}{unit}"), estimate));
        }
        for entry in &self.panel.effects {
            rows.push(exact(&format!("effect {}", entry.id), self.fate(entry)));
            let known = effect(&entry.id).map(|effect| effect.parameters()).unwrap_or_default();
            for (name, estimate) in &entry.parameters {
                let unit = known.iter().find(|parameter| parameter.name == name).map_or("", |parameter| parameter.unit);
                rows.push(told(format!("{} {name} [{unit}]", entry.id), estimate));
            }
        }
        rows
    }

    fn fate(&self, entry: &EffectEntry) -> String {
        match &self.core {
            _ if entry.owner != "panel" => "left out: no part of the panel".into(),
            Some(fit) if entry.id == VISCOELASTIC_CORE => relaxing(fit),
            _ => "in the modes".into(),
        }
    }

    /// Each mode that was measured, beside the model's.
    fn measured_modes(&self) -> String {
        let Some(modes) = self.panel.provenance.get(MODES).and_then(|modes| modes.as_array()) else {
            return String::new();
        };
        // A traced panel's test has rig and measuring chain in it, which no model of the panel has.
        let has_model = modes.iter().any(|mode| mode.get("model_hz").is_some());
        let mut text = String::from(if has_model { MEASURED_AND_BY_MODEL } else { MEASURED });
        for mode in modes {
            let number = |key: &str| mode.get(key).and_then(|value| value.as_f64());
            let cell =
                |key: &str, digits: usize| number(key).map_or(String::new(), |value| format!("{value:.digits$}"));
            let small = |key: &str| number(key).map_or(String::new(), |value| format!("{value:.1e}"));
            let error = number("error_percent").map_or(String::new(), |error| format!("{error:+.3}"));
            let zeta = number("zeta").map_or(String::new(), |zeta| format!("{zeta:.3e}"));
            let cells = [
                cell("mode", 0),
                cell("measured_hz", 2),
                small("measured_std_hz"),
                cell("model_hz", 2),
                error,
                zeta,
                small("zeta_std"),
            ];
            let shown = if has_model { &cells[..] } else { &cells[..3] };
            let cells: String = shown.iter().map(|cell| format!("<td>{cell}</td>")).collect();
            let _ = writeln!(text, "<tr>{cells}</tr>");
        }
        text + "</table>\n"
    }
}

/// The entry of a model's provenance that lists its measured modes.
const MODES: &str = "modes";

const MEASURED: &str = "<p>Each mode as measured, with whatever was taken out of the panel still on it:</p>\n<table>\n\
     <tr><th>mode</th><th>measured [Hz]</th><th>standard deviation [Hz]</th></tr>\n";

const MEASURED_AND_BY_MODEL: &str = "<p>Each mode as measured, and by the model as identified:</p>\n<table>\n<tr><th>mode</th>\
     <th>measured [Hz]</th><th>standard deviation [Hz]</th><th>model [Hz]</th><th>error [%]</th><th>damping ratio</th>\
     <th>standard deviation</th></tr>\n";

fn told(name: String, estimate: &Estimate) -> [String; 3] {
    let std = estimate.std.map_or_else(|| "not told".into(), |std| format!("{std:.1e}"));
    [name, format!("{:.4e}", estimate.value), std]
}

fn edges(Boundary { left, right, front, back }: Boundary) -> String {
    format!("left {left}, right {right}, front {front}, back {back}")
}

fn relaxing(fit: &CoreFit) -> String {
    let CoreFit { terms, ratio, band: [from, to], error } = fit;
    format!(
        "in internal variables, {} oscillators of damping ratio {ratio} for each mode, so the frequencies above are those of \
         the modes and these variables together, undamped: this rational fit of the shear modulus errs by {:.2} % of it at \
         most, from {from:.0} to {to:.0} Hz, and gives no energy at any frequency",
        terms.len(),
        100.0 * error
    )
}
