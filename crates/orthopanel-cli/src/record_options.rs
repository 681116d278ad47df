//! How records become accelerances, and accelerances constants: the options that several commands share.

use clap::{Args, ValueEnum};
use orthopanel::Test;
use orthopanel_data::{Estimation, Estimator, Measurement, MeasurementData, Window};
use orthopanel_identify::{DampingLaw, PaperWeights, Search, Settings};

use orthopanel_model::Readable;

use crate::error::CommandError;
use crate::terminal;

#[derive(Args)]
#[command(next_help_heading = "Records to accelerance")]
pub struct EstimationOptions {
    /// Window over each hit [default: as-needed to identify and trace, else none]
    #[arg(long, value_enum)]
    window: Option<WindowWord>,
    /// Time constant of the exponential; a third of the record's length leaves 5 % at its end
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true, required_if_eq("window", "force-exponential"))]
    tau: Option<f64>,
    /// Half the width of the force window; must hold the whole blow [default: 0.004]
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    force_half_width: Option<f64>,
    /// Average over the hits [default: h1]
    #[arg(long, value_enum)]
    estimator: Option<EstimatorWord>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum WindowWord {
    /// Nothing: right where the response has died away at the record's end
    None,
    /// None where the response has died away, else exp(-t/tau) with the time constant that the rest needs; the force kept
    /// near its blow where its channel's noise, read before the blow, counts
    AsNeeded,
    /// Force kept near its peak, the response as it is: for a force channel with noise
    Force,
    /// Hann's over both channels, as in the paper: only where the blow lies well inside the record, and it widens peaks
    Hann,
    /// Force kept near its peak, exp(-t/tau) over both channels: for a response cut off while it still rings. The
    /// damping that the exponential adds is known, a CSV of lines carries it, and `identify` takes it out. Needs --tau
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
    /// The estimation, with the window `unsaid` where none is asked for.
    ///
    /// # Errors
    /// [`CommandError::Option`] for the size of a window that is not asked for.
    pub fn estimation(&self, unsaid: Window) -> Result<Estimation, CommandError> {
        let window = match (self.window, self.tau) {
            (Some(WindowWord::ForceExponential), Some(tau)) => {
                Window::ForceExponential { half_width: self.force_half_width.unwrap_or(Window::USUAL_HALF_WIDTH), tau }
            }
            (Some(WindowWord::Force), None) => {
                Window::Force { half_width: self.force_half_width.unwrap_or(Window::USUAL_HALF_WIDTH) }
            }
            (window, tau) => {
                let needs = [
                    ("tau", tau, "--window force-exponential"),
                    ("force-half-width", self.force_half_width, "--window force or force-exponential"),
                ];
                for (option, value, needed) in needs {
                    if let Some(value) = value {
                        let remedy = format!("it has no effect without {needed}: give both or neither");
                        return Err(CommandError::Option { option, value: Readable(value).to_string(), remedy });
                    }
                }
                match window {
                    None => unsaid,
                    Some(WindowWord::Hann) => Window::Hann,
                    Some(WindowWord::AsNeeded) => Window::AsNeeded,
                    Some(WindowWord::None | WindowWord::Force | WindowWord::ForceExponential) => Window::None,
                }
            }
        };
        let estimator = match self.estimator {
            None | Some(EstimatorWord::H1) => Estimator::H1,
            Some(EstimatorWord::H2) => Estimator::H2,
            Some(EstimatorWord::Hv) => Estimator::Hv,
        };
        Ok(Estimation { window, estimator, ..Estimation::default() })
    }

    /// The first option that was given.
    pub fn given(&self) -> Option<&'static str> {
        let Self { window, tau, force_half_width, estimator } = self;
        let given = [
            (window.is_some(), "window"),
            (tau.is_some(), "tau"),
            (force_half_width.is_some(), "force-half-width"),
            (estimator.is_some(), "estimator"),
        ];
        given.into_iter().find_map(|(given, name)| given.then_some(name))
    }

    /// Says on standard error where an option was given and the test has nothing for it to act on.
    pub fn say_if_idle(&self, test: &Test) {
        let has_hits = test.content().measurements.iter().any(|of| matches!(of.data, MeasurementData::TimeHistory(_)));
        if let (Some(option), false) = (self.given(), has_hits) {
            terminal::note("", &[format!("--{option} has no effect: no measurement of this test is a time-history")]);
        }
    }
}

#[derive(Args)]
pub struct IdentifyOptions {
    /// How to search for the minimum
    #[arg(long, value_enum, default_value_t = SearchWord::LeastSquares)]
    search: SearchWord,
    /// W_f of the paper's eq. 23, on records: what a resonance's frequency counts; needs --search simplex [default: 0.1]
    #[arg(long, value_name = "W_F", value_parser = weight, allow_negative_numbers = true)]
    frequency_weight: Option<f64>,
    /// W_G of the paper's eq. 23, on records: what a resonance's magnitude counts; needs --search simplex [default: 10000]
    #[arg(long, value_name = "W_G", value_parser = weight, allow_negative_numbers = true)]
    magnitude_weight: Option<f64>,
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
    /// # Errors
    /// As [`EstimationOptions::estimation`].
    pub fn settings(&self) -> Result<Settings, CommandError> {
        let weights = [("frequency-weight", self.frequency_weight), ("magnitude-weight", self.magnitude_weight)];
        if let (SearchWord::LeastSquares, Some((option, value))) =
            (self.search, weights.into_iter().find_map(|(option, value)| Some((option, value?))))
        {
            let remedy = "eq. 23 is what --search simplex brings down on records: give both or neither".into();
            return Err(CommandError::Option { option, value: Readable(value).to_string(), remedy });
        }
        let usual = PaperWeights::default();
        Ok(Settings {
            paper_weights: PaperWeights {
                frequency: self.frequency_weight.unwrap_or(usual.frequency),
                magnitude: self.magnitude_weight.unwrap_or(usual.magnitude),
            },
            search: match self.search {
                SearchWord::LeastSquares => Search::LeastSquares,
                SearchWord::Simplex => Search::Simplex,
            },
            damping_law: match self.damping {
                DampingWord::Viscous => DampingLaw::Viscous,
                DampingWord::Hysteretic => DampingLaw::Hysteretic,
            },
            estimation: self.records.estimation(Settings::default().estimation.window)?,
        })
    }

    /// As [`EstimationOptions::say_if_idle`], of the law of damping too.
    pub fn say_if_idle(&self, test: &Test) {
        self.records.say_if_idle(test);
        let is_frequencies = |of: &Measurement| matches!(of.data, MeasurementData::NaturalFrequencies(_));
        if self.damping == DampingWord::Hysteretic && test.content().measurements.iter().all(is_frequencies) {
            terminal::note(
                "",
                &["--damping hysteretic has no effect: natural frequencies tell nothing of the damping".into()],
            );
        }
    }
}

/// Reads a weight: finite, zero or above.
fn weight(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() && value >= 0.0 => Ok(value),
        _ => Err("a weight must be a finite number, zero or above".into()),
    }
}

/// Reads a time in s: finite, above zero.
fn seconds(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() && value > 0.0 => Ok(value),
        _ => Err("a time in s must be a finite number above zero".into()),
    }
}
