//! What the identification refuses, with the numbers in it and the way out.

use orthopanel_data::DataError;
use orthopanel_model::{ModelError, Readable};
use thiserror::Error;

pub(crate) use self::known_factor::{CALIBRATED, Factor, Mend, gain_of_no_unit, mend};
pub use self::prior_contradiction::PriorContradiction;
use self::wording::{by_factor, in_place_of, known, much_noise, other_place, untaken, which};
pub(crate) use self::wording::{one_times, spaced};
use crate::least_squares::Stuck;

mod known_factor;
mod prior_contradiction;
mod wording;

/// Sampling rate over the band of an analyser, whose anti-alias filter needs the rest.
const RATE_OVER_BAND: f64 = 2.56;

/// Errors of this crate.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum IdentifyError {
    /// Fewer measured frequencies than constants to find.
    #[error(
        "{found} natural frequencies for {needed} constants ({names}): measure at least {needed}, or hold a constant \
         at a known value under [constants]"
    )]
    TooFewFrequencies {
        /// Frequencies in the test.
        found: usize,
        /// Constants to find.
        needed: usize,
        /// Their names.
        names: String,
    },
    /// A list that is too long to be traced.
    #[error(
        "a list of {found} natural frequencies: a trace takes {most} at most, for it fits every effect to them, in time that grows \
         with the cube of their number; list the lowest, or ask `orthopanel identify` for the constants alone"
    )]
    TooManyFrequencies {
        /// Frequencies of the longest list.
        found: usize,
        /// The limit.
        most: usize,
    },
    /// Lists of one piece that are too long together to be traced.
    #[error(
        "{found} natural frequencies in the lists of {piece}: a trace takes {most} of one piece at most, for it fits every effect to all of \
         them; list the mean of repeats, with their scatter, or ask `orthopanel identify` for the constants alone"
    )]
    TooManyFrequenciesOfPiece {
        /// The piece.
        piece: String,
        /// Frequencies in its lists.
        found: usize,
        /// The limit.
        most: usize,
    },
    /// Records in which too few resonances stand out.
    #[error(
        "{found} resonances stand out from the records, for {needed} constants: {}look at the accelerance; a \
         Hann window cuts off a hit near the record's start (take none, or force-exponential), files listed under one pair \
         of places are taken as hits of it, and the sampling rate must be more than twice the highest mode asked for",
        much_noise(*.noise_percent)
    )]
    TooFewResonances {
        /// Resonances found.
        found: usize,
        /// Constants to find.
        needed: usize,
        /// Standard deviation of the median line over its size \[%\]; `None` where the records do not tell it.
        noise_percent: Option<f64>,
    },
    /// Records that end below the modes that would tell the constants.
    #[error(
        "the band of the records ends at {to:.1} Hz, by their sampling rate or by the hammer's force, and holds {found} modes of {of}, for {needed} constants: the next needed lies at about \
         {next:.0} Hz; sample at {:.0} Hz or more (2.56 times that), with a hammer tip whose force reaches it, or hold a \
         constant under [constants]", RATE_OVER_BAND * next
    )]
    BandTooLow {
        /// The highest line \[Hz\].
        to: f64,
        /// Modes in the band.
        found: usize,
        /// Constants to find.
        needed: usize,
        /// Whose modes: those of the constants that meet the records, or of usual ones.
        of: &'static str,
        /// The mode with which there would be enough \[Hz\].
        next: f64,
    },
    /// A constant that the test holds for all pieces, and a piece has of its own.
    #[error(
        "piece {piece}: own_constants names {name}, which [constants] holds for all pieces: leave one of the two out"
    )]
    HeldAndOwn {
        /// The constant.
        name: String,
        /// The piece that has it of its own.
        piece: String,
    },
    /// The test holds a constant that the structure does not have.
    #[error("constants.{name}: the structure has no such constant, it has {known}")]
    UnknownConstant {
        /// The constant.
        name: String,
        /// The constants of the structure.
        known: String,
    },
    /// Held constants of a plate beside which no likely value of the free ones has a definite law.
    #[error(
        "[constants] {held}: beside these no {free} that the data could mean has a definite law, for nu_xy must lie below \
         sqrt(e_x / e_y); look at the values held, or hold fewer"
    )]
    HeldLaw {
        /// The constants held that the law's limit is of, with their values.
        held: String,
        /// Those that are free.
        free: String,
    },
    /// The search came to no end.
    #[error(
        "no minimum after {iterations} iterations; the last error was {:.3} % rms: check the order of the frequencies and the sizes of the piece",
        Readable(*.error_percent)
    )]
    NotConverged {
        /// Iterations done.
        iterations: usize,
        /// Error of the last one \[% rms\].
        error_percent: f64,
    },
    /// A number that is none: the data and the model are too far apart to be compared.
    #[error(
        "the {what} is no finite number: the data are of another piece, or in another unit, by many orders of magnitude; check the \
         sizes of the piece, the frequencies and the units of the records"
    )]
    NotFinite {
        /// Which number.
        what: String,
    },
    /// A mode that lies far above its line on every panel.
    #[error(
        "piece {piece}, {frequency} Hz named [{}, {}]: beside the other frequencies that mode lies at about {least:.0} Hz or above, from \
         solid metal to the softest core; look at this mode's shape again", nodes[0], nodes[1]
    )]
    ImpossibleShape {
        /// Name of the piece.
        piece: String,
        /// Nodal lines across x and across y.
        nodes: [usize; 2],
        /// Of the line \[Hz\].
        frequency: f64,
        /// The lowest frequency of such a mode \[Hz\].
        least: f64,
    },
    /// A mode that no basis follows.
    #[error(
        "shape [{}, {}]: a plate of {} x {} polynomials would be needed, more than fit; with these edges shapes up to [{}, {}] can be named",
        nodes[0], nodes[1], terms[0], terms[1], most[0], most[1]
    )]
    ShapeBeyondBasis {
        /// Most nodal lines across x and across y of all shapes named.
        nodes: [usize; 2],
        /// Polynomials along x and y for them.
        terms: [usize; 2],
        /// As many nodal lines in the same proportion as a basis follows.
        most: [usize; 2],
    },
    /// The search came to no end, and would under other names of the modes.
    #[error("no minimum after {iterations} iterations; the last error was {:.3} % rms: {names}", Readable(*.error_percent))]
    DoubtfulNames {
        /// Iterations done.
        iterations: usize,
        /// Error of the last one \[% rms\].
        error_percent: f64,
        /// The lines with the names that they should have.
        names: String,
    },
    /// A plate that misses its list by so much that its constants are none.
    #[error(
        "no plate meets these frequencies under these names, the nearest misses them by {:.1} % rms: {names}",
        Readable(*.error_percent)
    )]
    FarFromList {
        /// Error of the nearest \[% rms\].
        error_percent: f64,
        /// The lines with the names that they may have, or how the list was read.
        names: String,
    },
    /// The best value lies on a bound, so it is none.
    #[error(
        "{name} = {value:e}{} lies on its bound: these frequencies do not determine it; hold it under [constants] or measure more modes", spaced(.unit)
    )]
    OnBound {
        /// The constant.
        name: &'static str,
        /// The bound.
        value: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// A band that a record cannot show.
    #[error(
        "band from {} to {} Hz: give 0 <= from < to <= {:.3} Hz, half the sampling rate",
        Readable(*.from), Readable(*.to), Readable(*.half_rate)
    )]
    HistoryBand {
        /// Lower end \[Hz\].
        from: f64,
        /// Upper end \[Hz\].
        to: f64,
        /// Half the sampling rate \[Hz\].
        half_rate: f64,
    },
    /// A model without the one force and the response that a time history has.
    #[error(
        "a time history has one force and one response, the model has {forces} and {responses}: make it for the places of the record"
    )]
    HistoryPorts {
        /// Force ports of the model.
        forces: usize,
        /// Response ports of the model.
        responses: usize,
    },
    /// A hit whose channels cannot be compared.
    #[error(
        "hit {hit}: {force} samples of force and {acceleration} of acceleration: as many of each are needed, 2 at least"
    )]
    HitSamples {
        /// The hit, from 1.
        hit: usize,
        /// Samples of force.
        force: usize,
        /// Samples of acceleration.
        acceleration: usize,
    },
    /// A hit with no acceleration to explain.
    #[error(
        "hit {hit}: the measured acceleration is constant, or has nothing in the band: leave the hit out, or widen the band"
    )]
    SilentHit {
        /// The hit, from 1.
        hit: usize,
    },
    /// A constant that the data leave open.
    #[error(
        "{name} = {value:.3e}{} is known {}: these data do not determine it; hold it under \
         [constants], measure more modes, or check that no mode is missing from the list",
        spaced(.unit), known(*.std)
    )]
    NotDetermined {
        /// The constant.
        name: &'static str,
        /// Its value at the minimum.
        value: f64,
        /// Its standard deviation.
        std: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// Records that no panel of these sizes could give.
    #[error(
        "half of all lines miss the model by more than {:.0} %, whatever the constants, most of all in {record}: either the test file says \
         other things than the records (force_at and response_at, the sensor's direction, units and gain, sizes and mass of \
         the piece, the window, the sampling rate), or they show too little: measure more places, or from below the first \
         resonance on; or the beam lacks something large: `orthopanel trace TEST.toml` looks for it, the plate of a wide panel among others",
        Readable(*.percent)
    )]
    Contradiction {
        /// Files and places of the record that misses it most.
        record: String,
        /// Median of $|H_{cal}-H_{exp}|$ over $|H_{exp}|$ or three standard deviations of it, whichever is more \[%\].
        percent: f64,
    },
    /// Records in other units than they were read in, of another quantity, or turned round.
    #[error(
        "write {lines}: {} miss the model by {:.0} % in the median line, and times {} meet it within {:.1} %, as records do that are read \
         in a wrong unit, as a wrong quantity, or of a sensor turned round; where that is not it, look at gain and mass",
        which(.records), Readable(.percent[0]), by_factor(*.factor, *.derivatives, *.delay), Readable(.percent[1])
    )]
    OtherUnits {
        /// What to write, and where.
        lines: String,
        /// Files and places of the records that are meant; `None` where all are.
        records: Option<Vec<String>>,
        /// The factor with which they meet the model, ...
        factor: f64,
        /// ... the power of $j\omega$ beside it, ...
        derivatives: i8,
        /// ... and the delay of the response \[s\] that is taken off; zero where none is.
        delay: f64,
        /// Median misfit of their lines without factor and power, and with \[%\].
        percent: [f64; 2],
    },
    /// Records that miss the plate that was found.
    #[error(
        "half of all lines miss the plate found by more than {:.0} %, most of all in {record}{}: either the test file \
         says other things than the records (force_at and response_at, the sensor's direction, units and gain, sizes and \
         mass of the piece, boundary, the window), or the search ended at other constants than the panel's: hold what is \
         known of them under [constants], and measure more places off the centre lines",
        Readable(*.percent), untaken(.resonances)
    )]
    PlateContradiction {
        /// Files and places of the record that misses it most.
        record: String,
        /// As in [`IdentifyError::Contradiction`] \[%\].
        percent: f64,
        /// Resonances that no mode of the plate took \[Hz\].
        resonances: Vec<f64>,
    },
    /// Resonances that the plate found does not have, in records that it misses by far more than their noise.
    #[error(
        "the plate found misses the records by far more than their noise, chi-square per datum {:.0} (1: all that is \
         left is noise){}: its constants are not the panel's; hold what is known of them under [constants], look whether \
         boundary, sizes and places are those of the test, and measure more places off the centre lines",
        Readable(*.chi_square), untaken(.resonances)
    )]
    UntakenResonances {
        /// Misfit per datum.
        chi_square: f64,
        /// \[Hz\].
        resonances: Vec<f64>,
    },
    /// A piece so large that no material would put its modes where the records are.
    #[error(
        "a piece {length} m long and {thickness} m thick with {mass_per_area} kg/m2 begins at {:.2} Hz or lower, even with \
         E = 1e12 Pa, and these records go to {:.0} Hz: sizes are in metres", Readable(*.first), Readable(*.to)
    )]
    PieceTooLarge {
        /// \[m\].
        length: f64,
        /// \[m\].
        thickness: f64,
        /// \[kg/m²\].
        mass_per_area: f64,
        /// Its first natural frequency, of the stiffest \[Hz\].
        first: f64,
        /// The highest line \[Hz\].
        to: f64,
    },
    /// Records that contradict the test file under the law of damping asked for, and meet it under the other.
    #[error(
        "with {asked} damping no panel meets the records; with {other} damping one does, chi-square per datum \
         {:.2} (1: all that is left is noise): give --damping {other}", Readable(*.chi_square)
    )]
    OtherDamping {
        /// The law asked for.
        asked: &'static str,
        /// The law under which they meet.
        other: &'static str,
        /// Misfit per datum under that one.
        chi_square: f64,
    },
    /// One record that contradicts the others.
    #[error(
        "{record}: half of its lines miss the model of all records by more than {:.0} %: it contradicts the \
         others{}{}{}; check its file, force_at and response_at, the sensor's direction, unit and gain",
        Readable(*.percent), other_place(.fits_at), one_times(*.factor), in_place_of(.exchanged_with)
    )]
    RecordContradiction {
        /// Its files, piece and places.
        record: String,
        /// Median of $|H_{cal}-H_{exp}|$ over $|H_{exp}|$ or three standard deviations of it, whichever is more \[%\].
        percent: f64,
        /// Where it would fit as the others do: `force_at` or `response_at`, and x \[m\]; `None` where no place explains it.
        fits_at: Option<(&'static str, f64)>,
        /// The factor with which it fits as the others do; `None` where there is none.
        factor: Option<f64>,
        /// The record in whose place it fits, and which fits in its own: the two are exchanged.
        exchanged_with: Option<String>,
    },
    /// A prior of a constant that the records contradict.
    #[error("{prior} (with it: {refused})")]
    PriorContradicted {
        /// The prior, and what the data say.
        prior: PriorContradiction,
        /// What is refused at the constants that it leads to.
        refused: Box<IdentifyError>,
    },
    /// Weights under which eq. 23 measures nothing.
    #[error(
        "weights of eq. 23: W_f = {frequency}, W_G = {magnitude}: both must be finite, zero or above, and one above zero"
    )]
    PaperWeights {
        /// $W_f$.
        frequency: f64,
        /// $W_G$.
        magnitude: f64,
    },
    /// Places or signs of records that are not those of the test.
    #[error(
        "write {write}: the modes' shapes miss those of the plate by {:.0} % rms as the test file stands, and by {:.0} % with that; where that is not it, look at \
         each record's file, force_at and response_at",
        Readable(.percent[0]), Readable(.percent[1])
    )]
    OtherPlaces {
        /// What to write, and what it means.
        write: String,
        /// What is missed of the residues of all modes, each over its size, as the test file stands, and so \[% rms\].
        percent: [f64; 2],
    },
    /// What the test of a reference refuses.
    #[error("the reference: {0}")]
    OfReference(#[source] Box<IdentifyError>),
    /// A reference that is no panel of the suspect's make.
    #[error(
        "{0}: a reference is one panel of the suspect's make, of the same structure and edges, measured up to about the same frequency"
    )]
    OtherPanel(String),
    /// A test that this version cannot evaluate.
    #[error("{0}")]
    Unsupported(String),
    /// What the records refuse.
    #[error(transparent)]
    Data(#[from] DataError),
    /// What the physics refuses.
    #[error(transparent)]
    Model(#[from] ModelError),
}

impl IdentifyError {
    /// A search whose start was refused, or that found no end.
    pub(crate) fn refused<E: Into<Self>>(stuck: Stuck<E>) -> Self {
        match stuck {
            Stuck::Refused(error) => error.into(),
            Stuck::NotFinite => Self::NotFinite { what: "misfit where the search begins".into() },
            Stuck::Iterations { count, cost } => {
                Self::NotConverged { iterations: count, error_percent: 100.0 * cost.sqrt() }
            }
        }
    }

    /// Whether the records are known to end too early, so that no other constants need be looked for.
    pub(crate) fn knows_the_band(&self) -> bool {
        matches!(self, Self::BandTooLow { .. })
    }

    /// Whether the record that is to blame is known, so that no other constants need be looked for.
    pub(crate) fn knows_the_place(&self) -> bool {
        matches!(self, Self::RecordContradiction { fits_at, exchanged_with, .. } if fits_at.is_some() || exchanged_with.is_some())
    }

    /// Whether the records themselves are refused, so that no effect which the model may lack mends them.
    pub(crate) fn is_of_records(&self) -> bool {
        matches!(
            self,
            Self::Data(_)
                | Self::OtherPlaces { .. }
                | Self::OtherUnits { .. }
                | Self::TooFewResonances { .. }
                | Self::BandTooLow { .. }
                | Self::PieceTooLarge { .. }
                | Self::RecordContradiction { .. }
        )
    }

    /// Whether another law of damping may explain what was refused.
    pub(crate) fn may_be_of_damping(&self) -> bool {
        match self {
            Self::RecordContradiction { fits_at, .. } => fits_at.is_none(),
            Self::Contradiction { .. }
            | Self::PlateContradiction { .. }
            | Self::OnBound { .. }
            | Self::TooFewResonances { .. } => true,
            _ => false,
        }
    }

    /// Whether the model cannot be evaluated, or the records not be read, whatever the search.
    pub(crate) fn is_of_model(&self) -> bool {
        matches!(
            self,
            Self::Data(_)
                | Self::Model(_)
                | Self::Unsupported(_)
                | Self::UnknownConstant { .. }
                | Self::HeldAndOwn { .. }
        )
    }

    /// Whether the test itself must be mended, rather than that its data or the model say no.
    pub fn is_bad_input(&self) -> bool {
        !matches!(
            self,
            Self::NotConverged { .. }
                | Self::NotFinite { .. }
                | Self::TooFewResonances { .. }
                | Self::DoubtfulNames { .. }
                | Self::FarFromList { .. }
                | Self::OnBound { .. }
                | Self::NotDetermined { .. }
                | Self::Contradiction { .. }
                | Self::OtherPlaces { .. }
                | Self::OtherUnits { .. }
                | Self::PriorContradicted { .. }
                | Self::PlateContradiction { .. }
                | Self::UntakenResonances { .. }
                | Self::OtherDamping { .. }
                | Self::RecordContradiction { .. }
        )
    }
}
