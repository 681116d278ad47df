//! The result of this crate: an accelerance with its variance.

use num_complex::Complex64;
use orthopanel_model::{Place, Readable};

use super::beside_response::{decay_rate, matching_coherence, matching_variance};
use super::channel_choice;
use super::channels::{self, Calibration, Quantity};
use super::coherence::{self, Pairing};
use super::force_noise::ForceNoise;
use super::frequencies;
use super::hit_verdict::HitVerdict;
use super::likely_motion::likely_motion;
use super::read_as::ReadAs;
use crate::{
    DataError, Location, Motion, RecordedResponse,
    error::some_of,
    limits,
    records::{Record, RecordFile, RecordKind, Samples},
};

/// Acceleration over force in the frequency domain, $e^{+j\omega t}$, of one pair of places.
///
/// `frequency`, `value`, and where they are known `variance` and `coherence` are equally long.
#[derive(Debug, Clone, PartialEq)]
pub struct Accelerance {
    /// Where the force acts.
    pub force_at: Place,
    /// Where the acceleration is measured.
    pub response_at: Place,
    /// Frequencies \[Hz\], rising, greater than zero.
    pub frequency: Vec<f64>,
    /// Accelerance \[(m/s²)/N\].
    pub value: Vec<Complex64>,
    /// Variance $E|\hat H - H|^2$ of each line, real and imaginary part together \[((m/s²)/N)²\]; `None` where the
    /// records do not tell it.
    pub variance: Option<Vec<f64>>,
    /// Coherence $\gamma^2$ of each line, 0 to 1; `None` where unknown, as for a single hit.
    pub coherence: Option<Vec<f64>>,
    /// Hits averaged; 0 where the file does not tell. The variance is estimated with `2 (hits - 1)` degrees of freedom.
    pub hits: usize,
    /// What became of each hit of the history; empty where the file gives the accelerance itself.
    pub verdicts: Vec<HitVerdict>,
    /// The accelerance stands at $s = \sigma + j\omega$ with this $\sigma$ \[1/s\]: see
    /// [`Window::ForceExponential`](crate::Window::ForceExponential); else zero.
    pub decay_rate: f64,
    /// By how much a window may have moved the decay rate of a resonance \[1/s\], where that cannot be taken out: under
    /// [`Window::Hann`](crate::Window::Hann) $\frac{2\pi}{T}\max(1, |\cot(\pi t_0/T)|)$ with the blow at $t_0$ of a record
    /// of length $T$, infinite where the window all but cuts off the blow; else zero.
    pub decay_rate_in_doubt: f64,
    /// What a force window leaves of the force's noise, equally long; `None` without such a window, and where the records
    /// show no quiet stretch before the blow to read it from.
    pub force_noise: Option<ForceNoise>,
    /// The part of its size by which each line is too low for the force's noise in $S_{ff}$, equally long; not taken out of
    /// `value`. `None` where the records show no quiet stretch before the blow to read the noise from.
    pub bias: Option<Vec<f64>>,
    /// As what the records were read.
    pub read_as: ReadAs,
    /// What was left out, cut, mended or assumed, a sentence each.
    pub notes: Vec<String>,
}

impl Accelerance {
    pub(super) fn empty(force_at: Place, response_at: Place) -> Self {
        Self {
            force_at,
            response_at,
            frequency: Vec::new(),
            value: Vec::new(),
            variance: None,
            coherence: None,
            hits: 0,
            verdicts: Vec::new(),
            decay_rate: 0.0,
            decay_rate_in_doubt: 0.0,
            force_noise: None,
            bias: None,
            read_as: ReadAs::SI,
            notes: Vec::new(),
        }
    }

    /// Reads the file of an accelerance measurement.
    ///
    /// # Errors
    /// As [`RecordFile::read`], and as [`Accelerance::from_records`].
    pub fn read(measurement: &RecordedResponse) -> Result<Self, DataError> {
        Self::from_records(measurement.records()?, measurement)
    }

    /// Takes the frequency response of a file, the one that [`RecordedResponse::record`] names where there are several, with its coherence where that is there too, and puts unit and
    /// direction right.
    ///
    /// Mobilities and receptances become accelerances, $A = s^n H$, their variance with them.
    ///
    /// With coherence the variance is $|H|^2 (1 - \gamma^2)/\gamma^2$, that of one hit: files do not tell how many
    /// were averaged, so it is the greatest it may be; the weights of the lines among each other are right.
    ///
    /// # Errors
    /// [`DataError::NoRecords`] where no frequency response is in the file; [`DataError::Channels`] where there are
    /// several and none is named, where it is not complex or no motion over force, or where unit or coherence do not fit.
    pub fn from_records(file: RecordFile, measurement: &RecordedResponse) -> Result<Self, DataError> {
        Self::of_file(&file, measurement)
    }

    /// As [`Accelerance::from_records`], of a file that others read too.
    pub(super) fn of_file(file: &RecordFile, measurement: &RecordedResponse) -> Result<Self, DataError> {
        let named = channel_choice::response(file, measurement)?;
        let RecordFile { records, notes, .. } = file;
        let mut notes = notes.clone();
        let of_kind = |kind| records.iter().filter(move |record| record.kind == kind);
        let responses: Vec<(usize, &Record)> =
            (1..).zip(records).filter(|(_, record)| record.kind == RecordKind::FrequencyResponse).collect();
        let numbers = |of: &[usize]| some_of(&of.iter().map(usize::to_string).collect::<Vec<_>>(), ", ");
        let all: Vec<usize> = responses.iter().map(|(number, _)| *number).collect();
        let refused = |record: &Record, problem: String| Err(DataError::Channels { at: record.at.clone(), problem });
        let Some((_, first)) = responses.first() else {
            let at = Location::whole(&measurement.file);
            return Err(DataError::NoRecords { at, what: "frequency response (function type 4)" });
        };
        let is_chosen = measurement.force_channel.is_some() || measurement.response_channel.is_some();
        let number = match named[..] {
            [number] => number,
            [_, second, ..] => {
                let another =
                    responses.iter().find(|(number, _)| *number == second).map_or(*first, |(_, record)| *record);
                let which = numbers(&named);
                let problem = if is_chosen {
                    format!(
                        "several frequency responses, of this pair of channels as runs of one test are: say which by record = N in its \
                         [[measurement]], one of {which}"
                    )
                } else {
                    format!(
                        "a second frequency response: say which by record = N in its [[measurement]], one of {which}, or by \
                         response_channel and force_channel, or give each pair of places a file of its own"
                    )
                };
                return refused(another, problem);
            }
            [] => {
                let problem = format!(
                    "no frequency response is of both the force_channel and the response_channel of its [[measurement]]: correct one of \
                     them, or say which by record = N, one of {}",
                    numbers(&all)
                );
                return refused(first, problem);
            }
        };
        let Some(&(_, record)) = responses.iter().find(|(of, _)| *of == number) else {
            let problem =
                format!("record = {number} is no frequency response: those of the file are {}", numbers(&all));
            return refused(first, problem);
        };
        match (channels::quantity(&record.numerator), channels::quantity(&record.denominator)) {
            (Quantity::Motion(_) | Quantity::Untold, Quantity::Force | Quantity::Untold) => {}
            (numerator, denominator) => {
                return refused(record, format!("{numerator:?} over {denominator:?}: motion over force is needed"));
            }
        }
        let (Calibration { factor, motion, .. }, read_as) = channels::response(record, measurement, &mut notes)?;
        let Samples::Complex(values) = &record.ordinate else {
            return refused(record, "a frequency response must be complex: magnitude alone is not enough".into());
        };
        // What tells nothing is an accelerance, unless its lines say otherwise.
        let told = channels::quantity(&record.numerator) != Quantity::Untold || channels::is_declared(measurement);
        if let (false, Some(likely @ (Motion::Velocity | Motion::Displacement))) =
            (told, likely_motion(&record.abscissa, values))
        {
            let name = if likely == Motion::Velocity { "mobility" } else { "receptance" };
            let problem = format!(
                "tells neither type nor unit, and falls over frequency as a {name} does: is it one? declare quantity = \"{likely}\" in \
                 its [[measurement]], or quantity = \"acceleration\" where it is an accelerance"
            );
            return refused(record, problem);
        }
        let coherence = match coherence::of_response(records, number - 1) {
            Pairing::None => None,
            Pairing::Own(coherence) => Some(matching_coherence(record, coherence)?),
            Pairing::Untold { coherences, responses } => {
                notes.push(format!(
                    "{}: left without coherence: {coherences} of the file may belong to {responses} frequency responses, and neither \
                     their order nor their nodes tell which",
                    record.at.key
                ));
                None
            }
        };
        let told = of_kind(RecordKind::Variance).next();
        let told = told.map(|variance| matching_variance(record, variance)).transpose()?;
        let mut result = Self::empty(measurement.force_at, measurement.response_at);
        let positive = record.abscissa.partition_point(|&frequency| frequency <= 0.0);
        if positive > 0 {
            notes.push(format!("{}: {positive} lines at or below 0 Hz left out", record.at.key));
        }
        result.read_as = read_as;
        let to_hertz = frequencies::to_hertz(record, measurement)?;
        result.frequency = record.abscissa.iter().skip(positive).map(|frequency| frequency * to_hertz).collect();
        if result.frequency.is_empty() {
            return refused(record, "no line above 0 Hz".into());
        }
        let [least, most] = limits::HERTZ;
        if let Some(line) = result.frequency.last().filter(|line| !(least..=most).contains(*line)) {
            let problem =
                format!("the last line is at {} Hz: frequencies are in Hz, {least} to {most:e}", Readable(*line));
            return refused(record, problem);
        }
        result.value = values.iter().skip(positive).map(|value| value * factor).collect();
        if let Some(coherence) = coherence {
            let coherence: Vec<f64> = coherence.into_iter().skip(positive).collect();
            let variance = result.value.iter().zip(&coherence).map(|(value, &gamma)| {
                // A line without coherence says nothing: an infinite variance gives it no weight.
                value.norm_sqr() * (1.0 - gamma) / gamma
            });
            result.variance = Some(variance.map(|value| if value.is_nan() { f64::INFINITY } else { value }).collect());
            result.coherence = Some(coherence);
            if told.is_none() {
                notes.push(format!("{}: number of averages not told, variance is that of one hit", record.at.key));
            }
        }
        if let Some(variance) = told {
            // Told by who averaged the hits: better than what one hit's coherence bounds.
            let factor = factor * factor;
            result.variance = Some(variance.into_iter().skip(positive).map(|variance| variance * factor).collect());
        }
        result.decay_rate = decay_rate(of_kind(RecordKind::DecayRate).next(), measurement.window_decay)?;
        if motion != Motion::Acceleration {
            result.differentiate(motion.derivatives());
            notes.push(format!(
                "{}: {motion} over force differentiated to an accelerance, with its noise",
                record.at.key
            ));
        }
        result.notes = notes;
        result.leave_out_zeros(record)?;
        result.cut_to(measurement.band, || record.at.clone())?;
        Ok(result)
    }

    /// Times $s^n$, and the noise with it: a motion becomes its derivative. Under an exponential window a line stands at
    /// $s = \sigma + j\omega$.
    fn differentiate(&mut self, times: u8) {
        let factors = self
            .frequency
            .iter()
            .map(|f| Complex64::new(self.decay_rate, std::f64::consts::TAU * f).powu(times.into()));
        let factors: Vec<Complex64> = factors.collect();
        self.value.iter_mut().zip(&factors).for_each(|(value, factor)| *value *= factor);
        if let Some(variance) = &mut self.variance {
            variance.iter_mut().zip(&factors).for_each(|(variance, factor)| *variance *= factor.norm_sqr());
        }
    }

    /// Leaves out the lines that are exactly zero: no measurement gives one, but where an analyser fills what it did not take.
    fn leave_out_zeros(&mut self, record: &Record) -> Result<(), DataError> {
        let is_told = |line: usize| self.value[line] != Complex64::default();
        let told: Vec<usize> = (0..self.value.len()).filter(|&line| is_told(line)).collect();
        let (all, zeros) = (self.value.len(), self.value.len() - told.len());
        if zeros == 0 {
            return Ok(());
        }
        let first = (0..all).find(|&line| !is_told(line)).map_or(0.0, |line| self.frequency[line]);
        if told.len() < LEAST_LINES {
            let problem =
                format!("{zeros} of {all} lines are exactly zero: nothing was measured, or it was lost on export");
            return Err(DataError::Channels { at: record.at.clone(), problem });
        }
        self.notes.push(format!(
            "{}: {zeros} of {all} lines are exactly zero, the first at {} Hz, as no measurement is: left out",
            record.at.key,
            Readable(first)
        ));
        self.keep(&told);
        Ok(())
    }

    /// Leaves out all lines outside the declared band.
    pub(super) fn cut_to(
        &mut self,
        band: Option<[f64; 2]>,
        at: impl FnOnce() -> Box<Location>,
    ) -> Result<(), DataError> {
        let Some([from, to]) = band else { return Ok(()) };
        let inside: Vec<usize> =
            (0..self.frequency.len()).filter(|&line| (from..=to).contains(&self.frequency[line])).collect();
        if inside.len() < LEAST_LINES {
            let ends = self.frequency.first().zip(self.frequency.last());
            let (first, last) = ends.map_or((0.0, 0.0), |(first, last)| (*first, *last));
            let problem = format!(
                "band = [{from}, {to}] leaves {} of its lines, which go from {} to {} Hz: widen it",
                inside.len(),
                Readable(first),
                Readable(last)
            );
            return Err(DataError::Channels { at: at(), problem });
        }
        if inside.len() < self.frequency.len() {
            self.keep(&inside);
        }
        Ok(())
    }

    /// Keeps these lines and no others.
    fn keep(&mut self, lines: &[usize]) {
        let kept = |values: &[f64]| lines.iter().map(|&line| values[line]).collect::<Vec<f64>>();
        self.value = lines.iter().map(|&line| self.value[line]).collect();
        self.frequency = kept(&self.frequency);
        self.variance = self.variance.as_deref().map(kept);
        self.coherence = self.coherence.as_deref().map(kept);
        self.bias = self.bias.as_deref().map(kept);
        if let Some(noise) = &mut self.force_noise {
            noise.keep(lines);
        }
    }
}

/// Fewer lines than these show no resonance.
const LEAST_LINES: usize = 3;
