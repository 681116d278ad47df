//! How records become accelerances, and accelerances constants: the options that several commands share.

use clap::{Args, ValueEnum};
use orthopanel_data::{Estimation, Estimator, Window};
use orthopanel_identify::{DampingLaw, Search, Settings};

#[derive(Args)]
#[command(next_help_heading = "Records to accelerance")]
pub struct EstimationOptions {
    /// Window over each hit
    #[arg(long, value_enum, default_value_t = WindowWord::None)]
    window: WindowWord,
    /// Time constant of the exponential; a third of the record's length leaves 5 % at its end
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true, required_if_eq("window", "force-exponential"))]
    tau: Option<f64>,
    /// Half the width of the force window; must hold the whole blow
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true, default_value = "0.004")]
    force_half_width: f64,
    /// Average over the hits
    #[arg(long, value_enum, default_value_t = EstimatorWord::H1)]
    estimator: EstimatorWord,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum WindowWord {
    /// Nothing: right where the response has died away at the record's end
    None,
    /// Hann's over both channels, as in the paper: only where the blow lies well inside the record, and it widens peaks
    Hann,
    /// Force kept near its peak, exp(-t/tau) over both channels: for a response cut off while it still rings. The
    /// damping that the exponential adds is known and taken out again, so nothing is biased; needs --tau
    ForceExponential,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum EstimatorWord {
    /// Noise on the response averages out: the usual choice for a hammer
    H1,
    /// Noise on the force averages out: where peaks matter and the hammer is weak there
    H2,
    /// Between the two, for noise on both
    Hv,
}

impl EstimationOptions {
    pub fn estimation(&self) -> Estimation {
        let window = match (self.window, self.tau) {
            (WindowWord::Hann, _) => Window::Hann,
            (WindowWord::ForceExponential, Some(tau)) => {
                Window::ForceExponential { half_width: self.force_half_width, tau }
            }
            // clap has refused the exponential without its time constant.
            (WindowWord::None | WindowWord::ForceExponential, _) => Window::None,
        };
        let estimator = match self.estimator {
            EstimatorWord::H1 => Estimator::H1,
            EstimatorWord::H2 => Estimator::H2,
            EstimatorWord::Hv => Estimator::Hv,
        };
        Estimation { window, estimator, ..Estimation::default() }
    }
}

#[derive(Args)]
pub struct IdentifyOptions {
    /// How to search for the minimum
    #[arg(long, value_enum, default_value_t = SearchWord::LeastSquares)]
    search: SearchWord,
    /// How modes lose energy
    #[arg(long, value_enum, default_value_t = DampingWord::Viscous)]
    damping: DampingWord,
    #[command(flatten)]
    records: EstimationOptions,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum SearchWord {
    /// On exact derivatives: eq. 22 for frequencies, maximum likelihood over all lines for records
    LeastSquares,
    /// The paper's downhill simplex: eq. 24 for frequencies, eq. 25 for records; slower, and without its noise's weights
    Simplex,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum DampingWord {
    /// A force proportional to velocity, as in the paper's eq. 20: what an FMU can step
    Viscous,
    /// A loss factor 2 zeta at every frequency: nearer to many cores between the peaks. The same at a resonance, so the
    /// ratios carry over to the viscous model
    Hysteretic,
}

impl IdentifyOptions {
    pub fn settings(&self) -> Settings {
        Settings {
            search: match self.search {
                SearchWord::LeastSquares => Search::LeastSquares,
                SearchWord::Simplex => Search::Simplex,
            },
            damping_law: match self.damping {
                DampingWord::Viscous => DampingLaw::Viscous,
                DampingWord::Hysteretic => DampingLaw::Hysteretic,
            },
            estimation: self.records.estimation(),
        }
    }
}

/// Reads a time in s: finite, above zero.
fn seconds(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() && value > 0.0 => Ok(value),
        _ => Err("a time in s must be a finite number above zero".into()),
    }
}
