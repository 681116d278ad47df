//! How a test is identified, as JSON.

use orthopanel::Settings;
use orthopanel::data::{Estimation, Estimator, Window};
use orthopanel_identify::{DampingLaw, Search};
use serde::Deserialize;

/// The words of the command's options.
#[derive(Deserialize, Default)]
#[serde(default)]
pub struct Words {
    search: Option<String>,
    damping: Option<String>,
    window: Option<String>,
    tau: Option<f64>,
    force_half_width: Option<f64>,
    estimator: Option<String>,
}

fn none_of<T>(key: &'static str, word: &str, words: &[&str]) -> Result<T, (String, &'static str)> {
    let words = words.iter().map(|word| format!("{word:?}")).collect::<Vec<_>>().join(", ");
    Err((format!("{key} = {word:?}: must be one of {words}"), key))
}

impl Words {
    /// # Errors
    /// The word that is none, and its key.
    pub fn settings(&self) -> Result<Settings, (String, &'static str)> {
        let usual = Settings::default();
        let search = match self.search.as_deref() {
            None | Some("least-squares") => Search::LeastSquares,
            Some("simplex") => Search::Simplex,
            Some(word) => return none_of("search", word, &["least-squares", "simplex"]),
        };
        let damping_law = match self.damping.as_deref() {
            None | Some("viscous") => DampingLaw::Viscous,
            Some("hysteretic") => DampingLaw::Hysteretic,
            Some(word) => return none_of("damping", word, &["viscous", "hysteretic"]),
        };
        let estimator = match self.estimator.as_deref() {
            None | Some("h1") => Estimator::H1,
            Some("h2") => Estimator::H2,
            Some("hv") => Estimator::Hv,
            Some(word) => return none_of("estimator", word, &["h1", "h2", "hv"]),
        };
        if let Some((key, value)) = [("tau", self.tau), ("force_half_width", self.force_half_width)]
            .into_iter()
            .find_map(|(key, value)| Some((key, value.filter(|value| !(value.is_finite() && *value > 0.0))?)))
        {
            return Err((format!("{key} = {value}: a time in s must be a finite number above zero"), key));
        }
        let half_width = self.force_half_width.unwrap_or(Window::USUAL_HALF_WIDTH);
        let window = match (self.window.as_deref(), self.tau) {
            (Some("force-exponential"), Some(tau)) => Window::ForceExponential { half_width, tau },
            (Some("force-exponential"), None) => {
                return Err(("window = \"force-exponential\" needs tau, its time constant in s".into(), "tau"));
            }
            (_, Some(_)) => return Err(("tau has no effect without window = \"force-exponential\"".into(), "tau")),
            (Some("force"), None) => Window::Force { half_width },
            (_, None) if self.force_half_width.is_some() => {
                let told = "force_half_width has no effect without window = \"force\" or \"force-exponential\"";
                return Err((told.into(), "force_half_width"));
            }
            (None, None) => usual.estimation.window,
            (Some("none"), None) => Window::None,
            (Some("as-needed"), None) => Window::AsNeeded,
            (Some("hann"), None) => Window::Hann,
            (Some(word), None) => {
                return none_of("window", word, &["none", "as-needed", "force", "hann", "force-exponential"]);
            }
        };
        let estimation = Estimation { window, estimator, ..usual.estimation };
        Ok(Settings { search, damping_law, estimation, ..usual })
    }
}
