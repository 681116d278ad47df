//! What `simulate` is asked.

use std::path::PathBuf;

use orthopanel::driving_force::Hold;

use crate::arguments::{ModeArguments, PortArguments};

/// Calculate the motion of a model, or of an FMU, under a force given against time
///
/// A made-up force is CSV with the columns time_s,force_n (several force places: time_s,force_1_n,force_2_n,...).
/// The panel is at rest before the first sample. Between samples the force runs linearly, unless --hold says
/// otherwise; each mode is then stepped exactly, so the samples may be as far apart as the force allows. Without -o the CSV
/// (time_s,force_n,acceleration_m_s2,velocity_m_s,displacement_m) goes to standard output.
///
/// An FMU is unpacked and run as a simulator would run it, where its library is byte for byte the one that this orthopanel
/// carries. Any other is run by --trust alone: a library is code, which may do all that you may.
///
/// Measured hits drive a model too, and then its acceleration is held against the measured one: a test file (.toml)
/// with its records, a UFF file, or a CSV of time_s,force_n,acceleration_m_s2. The table gives the error of each hit in
/// per cent of the peak, and the part of the variance that the model explains; -o writes
/// pair,hit,time_s,force_n,measured_m_s2,calculated_m_s2. Between measured samples the force is the band-limited
/// function through them, as an anti-alias filter leaves it, unless --hold linear is given. The places are those of the
/// test file, else the model's ports or --force and --response.
///
/// --method runge-kutta does the paper's section 3.5 on the same hits: beam elements with modal damping (eqs 26 to 28),
/// integrated by the classic Runge-Kutta method under the measured force, interpolated. The exact modes and stepper
/// under the same force stand beside it, each with its error against the record, and how far the two are apart: that is
/// what the elements' frequencies and the steps err. What the steps alone err, against the exact stepper on the same
/// elements, is said for each pair of places, with the --steps that take it down to 1e-8 of the peak: it falls with the
/// fourth power of their number.
///
/// Examples: orthopanel simulate out/panel.fmu --force-file examples/half-sine.csv -o response.csv
///           orthopanel simulate out/model.json --force-file examples/made-hits/test.toml
///           orthopanel simulate out/model.json --force-file examples/made-hits/test.toml --method runge-kutta
#[derive(clap::Args)]
#[command(verbatim_doc_comment)]
pub struct Arguments {
    /// Model file (orthopanel.model/1, JSON) or FMU written by `orthopanel export`
    #[arg(value_name = "MODEL|X.fmu")]
    pub(super) model: PathBuf,
    /// Force against time (CSV), or measured hits (test.toml, UFF, CSV)
    #[arg(long, value_name = "X.csv|X.uff|TEST.toml")]
    pub(super) force_file: PathBuf,
    /// Run the library of an FMU that this orthopanel does not carry: a stranger's code, which may do all that you may
    #[arg(long)]
    pub(super) trust: bool,
    /// How the force runs between samples [default: linear; of measured hits band-limited]
    #[arg(long, value_enum)]
    pub(super) hold: Option<HoldWord>,
    /// How measured hits are followed
    #[arg(long, value_enum, default_value_t = Method::Exact)]
    pub(super) method: Method,
    /// Steps of Runge-Kutta from one sample to the next [default: what the highest mode needs, 0.2 of its angle a step]
    #[arg(long, value_name = "N", value_parser = steps)]
    pub(super) steps: Option<usize>,
    /// CSV file to write
    #[arg(short, long, value_name = "Y.csv")]
    pub(super) output: Option<PathBuf>,
    #[command(flatten)]
    pub(super) modes: ModeArguments,
    #[command(flatten)]
    pub(super) ports: PortArguments,
    /// Print one JSON object (orthopanel.simulation/1) on standard output
    #[arg(long)]
    pub(super) json: bool,
}

/// How a force runs between two samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum HoldWord {
    /// In a straight line from sample to sample: loses 1 - sinc^2 of what lies near half the sampling rate (19 % at a
    /// quarter of the rate, 1 % at an eighteenth), so it matters where the samples are few on the blow
    Linear,
    /// As the smooth function without content above half the rate: for a force measured through an anti-alias filter;
    /// the samples must be even, and the force end as it begins
    BandLimited,
    /// At the value of the earlier sample
    #[value(alias = "step")]
    Held,
}

impl From<HoldWord> for Hold {
    fn from(word: HoldWord) -> Self {
        match word {
            HoldWord::Linear => Self::Linear,
            HoldWord::BandLimited => Self::BandLimited,
            HoldWord::Held => Self::Held,
        }
    }
}

/// How the motion is found from sample to sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum Method {
    /// Exact modes, each stepped exactly
    Exact,
    /// Finite elements with modal damping, integrated by Runge-Kutta as in the paper's section 3.5, beside the exact one
    RungeKutta,
}

/// Steps of Runge-Kutta between two samples at most; the exact method takes one.
const MOST_STEPS: usize = 100_000;

/// Reads a number of steps.
fn steps(text: &str) -> Result<usize, String> {
    match text.trim().parse() {
        Ok(steps) if steps <= MOST_STEPS => Ok(steps),
        _ => Err(format!("steps from one sample to the next must be a whole number, {MOST_STEPS} at most")),
    }
}
