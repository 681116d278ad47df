//! Measured modes: what any data say of a test before any physics is asked.
//!
//! Every kind of data becomes [`MeasuredModes`]: poles common to the records, the residues of every record, what modes
//! below and above the band leave of it, and the covariance that the noise of the data gives all of these together.

mod accelerances;
mod drift;
mod faint;
mod frequencies;
mod hits;
mod joint_fit;
mod line_groups;
mod lines;
mod medians;
mod modal_fit;
mod noise_decay;
mod pole_search;
mod records;
pub(crate) use frequencies::names_told;
pub(crate) use hits::{HitSpectra, HitsOfRecord, transform};
pub(crate) use records::SKIRT;
mod scatter;
mod stabilisation;
pub(crate) fn is_record(measurement: &Measurement) -> bool {
    measurement.data.recorded().is_some()
}

#[cfg(test)]
mod tests;

use faer::Mat;
use num_complex::Complex64;
use orthopanel_data::{Estimation, ImpactTest, Measurement, MeasurementData, TimeHistory};
use orthopanel_model::{NamedShapes, Place, StructureKind};

use crate::IdentifyError;
use crate::structures;

/// Poles, residues and remainders of a set of records of one piece, with their covariance.
///
/// The poles are those of a joint fit: $\omega_m$ and $\zeta_m$ in common, everything linear projected out record by record (variable projection:
/// Golub and Pereyra, SIAM J. Numer. Anal. 10, 1973; Kaufman, BIT 15, 1975). Hits are not windowed: what the end of a record cuts off a
/// vibration that rings on is part of the fit. A pole is kept where it lowers the misfit by more than the logarithm of the number of data
/// for each of its parameters (Schwarz, Ann. Stat. 6, 1978).
///
/// # Limits
/// Modes much closer than their half-width are told apart by several places alone. A panel whose frequencies change from hit to hit, or whose force is not
/// linear, shows a `chi_square` far above one, and its poles are no modes. The covariance holds the noise of the data, not what hits fall beside their
/// marks or records differ in gain.
///
/// With $R$ records and $M$ modes the accelerance of record $r$ is
/// $$H_r(s) = \sum_{m=1}^{M}\left(\frac{q_{rm}}{s-\lambda_m} + \frac{\bar q_{rm}}{s-\bar\lambda_m}\right) + B_r(s),\qquad
/// \lambda_m = \omega_m\left(-\zeta_m + j\sqrt{1-\zeta_m^2}\right),$$
/// with $e^{+j\omega t}$. The remainder $B_r$ holds rigid modes, modes outside the band and every mode inside it whose skirts leave
/// the band. It is known as values at [`MeasuredModes::remainder_frequencies`], $s = 2\pi jf$, never as coefficients:
/// these are strongly correlated, the values are not.
#[derive(Debug, Clone)]
pub struct MeasuredModes {
    /// Index of the piece in the test, from 0.
    pub piece: usize,
    /// The poles, rising in frequency.
    pub poles: Vec<Pole>,
    /// Poles of the fit that do not stand by themselves, as those whose skirts leave the band: what they are is part of the remainders.
    pub beside: Vec<Pole>,
    /// One entry a record; empty where only frequencies were measured.
    pub records: Vec<MeasuredRecord>,
    /// Where a sensor sat while only frequencies were measured, if that is told.
    pub sensor_at: Option<Place>,
    /// Where the remainders are given \[Hz\], rising.
    pub remainder_frequencies: Vec<f64>,
    /// Lowest and highest frequency that was fitted \[Hz\].
    pub band: [f64; 2],
    /// Covariance of [`MeasuredModes::values`]: symmetric, in the same order.
    pub covariance: Mat<f64>,
    /// Misfit of the modal fit per degree of freedom in units of the noise, by which the covariance is scaled already; `None` for lists.
    pub chi_square: Option<f64>,
    /// Frequency of the line \[Hz\] that the modal fit misses most, over its noise; `None` for lists.
    pub missed_most: Option<f64>,
    /// Decay rate \[1/s\] of the noise of the hits, as under an exponential window, which poles, residues and remainders are free of; mostly zero.
    pub undone_decay: f64,
    /// Shapes by which a plate's list names its poles.
    pub(crate) named: NamedShapes,
    /// Of the list of a beam that passes modes over the number of each pole among those that bend along, from 0; empty where none is passed over.
    pub(crate) order: Vec<usize>,
}

impl MeasuredModes {
    /// Number of a pole of a list among the modes of a beam, from 0.
    pub(crate) fn number_in_order(&self, pole: usize) -> usize {
        self.order.get(pole).copied().unwrap_or(pole)
    }

    /// Modes of a beam up to the last one that a list holds.
    pub(crate) fn modes_in_order(&self) -> usize {
        self.order.iter().max().map_or(self.poles.len(), |last| last + 1)
    }

    /// Whether records hold what neither poles nor noise make, as a tone beside the response or a force that is not linear.
    pub(crate) fn is_not_modal(&self) -> bool {
        self.chi_square.is_some_and(|chi_square| chi_square > joint_fit::SYSTEMATIC)
    }
}

/// A pole common to all records.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pole {
    /// Undamped natural angular frequency $\omega_m$ \[rad/s\].
    pub angular_frequency: f64,
    /// Damping ratio $\zeta_m$; `None` where only frequencies were measured.
    pub damping_ratio: Option<f64>,
}

/// What one record, a pair of places, shows of the modes.
#[derive(Debug, Clone)]
pub struct MeasuredRecord {
    /// Where the force acts.
    pub force_at: Place,
    /// Where the acceleration is measured.
    pub response_at: Place,
    /// $q_{rm}$ \[(m/s²)/N · 1/s\], one a pole.
    pub residues: Vec<Complex64>,
    /// $B_r$ \[(m/s²)/N\] at each of the remainder's frequencies.
    pub remainder: Vec<Complex64>,
}

/// Measures the modes of every piece of a test: one entry for all hits of a piece, one for all its accelerances, and one a list of
/// frequencies.
///
/// ```
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/made-hits");
/// let test = orthopanel_data::ImpactTest::read(folder)?;
/// let measured = &orthopanel_identify::measured_modes(&test)?[0];
/// let first = measured.poles[0].angular_frequency / std::f64::consts::TAU;
/// // What the records were made with.
/// assert!((first - 320.8776).abs() < 0.01, "{first} Hz");
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// [`IdentifyError::Data`] where records cannot be read or no hit is usable, [`IdentifyError::TooFewResonances`] where they show none.
pub fn measured_modes(test: &ImpactTest) -> Result<Vec<MeasuredModes>, IdentifyError> {
    measured_as_named(test, &names_told(test))
}

/// Nodal lines across x and across y of each pole of a list, where they are told.
pub(crate) type Names = Vec<Option<[usize; 2]>>;

/// The same where the lists of a plate have these names, one entry a measurement.
///
/// # Errors
/// As [`measured_modes`], and names that no plate's mode has.
pub(crate) fn measured_as_named(test: &ImpactTest, names: &[Names]) -> Result<Vec<MeasuredModes>, IdentifyError> {
    let (histories, accelerances) = (test.time_histories()?, test.recorded_accelerances()?);
    let mut measured = Vec::new();
    for piece in 0..test.pieces.len() {
        let hits = of_piece(&histories, piece);
        if !hits.is_empty() {
            measured.extend(of_sensors(test, piece, &hits)?);
        }
        for (measurement, names) in test.measurements.iter().zip(names).filter(|(of, _)| of.piece == piece) {
            if let MeasurementData::NaturalFrequencies(list) = &measurement.data {
                let mut of_list = MeasuredModes::of_frequencies(piece, list);
                if test.structure == Some(StructureKind::MindlinPlate) {
                    of_list.named = named(test, piece, names)?;
                } else {
                    of_list.order = order(test, piece, names)?;
                }
                measured.push(of_list);
            }
        }
        let lines = of_piece(&accelerances, piece);
        if !lines.is_empty() {
            measured.push(MeasuredModes::of_accelerances(piece, &lines).ok_or_else(no_resonance)?);
        }
    }
    Ok(measured)
}

/// # Errors
/// Names that no plate's mode has.
fn named(test: &ImpactTest, piece: usize, names: &Names) -> Result<NamedShapes, IdentifyError> {
    let piece = &test.pieces[piece].piece;
    let told: Vec<[usize; 2]> = names.iter().flatten().copied().collect();
    if !told.is_empty() {
        structures::of(StructureKind::MindlinPlate).measured_modes(piece, test.boundary, told)?;
    }
    Ok(NamedShapes::new(piece, test.boundary, names)?)
}

/// # Errors
/// Names that no beam's mode has.
fn order(test: &ImpactTest, piece: usize, names: &Names) -> Result<Vec<usize>, IdentifyError> {
    let told: Vec<[usize; 2]> = names.iter().flatten().copied().collect();
    structures::of(StructureKind::TimoshenkoBeam).measured_modes(
        &test.pieces[piece].piece,
        test.boundary,
        told.clone(),
    )?;
    Ok(told.into_iter().map(|[nodes, _]| nodes - test.boundary.rigid_modes()).collect())
}

fn of_piece<T: Clone>(all: &[(usize, T)], piece: usize) -> Vec<T> {
    all.iter().filter(|(of, _)| *of == piece).map(|(_, record)| record.clone()).collect()
}

/// Of all hits of a piece together; of a plate whose poles are not those of one panel, apart for each place of the sensor: one that moves, with its
/// mass, changes them.
fn of_sensors(test: &ImpactTest, piece: usize, hits: &[TimeHistory]) -> Result<Vec<MeasuredModes>, IdentifyError> {
    let together = of_hits(piece, hits)?;
    let mut sensors: Vec<Place> = Vec::new();
    for place in hits.iter().map(|history| history.response_at) {
        if !sensors.contains(&place) {
            sensors.push(place);
        }
    }
    let is_plate = test.structure == Some(StructureKind::MindlinPlate);
    if !is_plate || sensors.len() < 2 || !together.is_not_modal() {
        return Ok(vec![together]);
    }
    let apart = sensors.iter().map(|sensor| {
        let own: Vec<TimeHistory> = hits.iter().filter(|history| history.response_at == *sensor).cloned().collect();
        of_hits(piece, &own).ok().filter(|own| !own.is_not_modal())
    });
    Ok(apart.collect::<Option<Vec<_>>>().unwrap_or_else(|| vec![together]))
}

/// Of the hits that are sound, up to where the force has fallen too far.
fn of_hits(piece: usize, histories: &[TimeHistory]) -> Result<MeasuredModes, IdentifyError> {
    let (sound, highest) = sound(histories)?;
    MeasuredModes::of_hits(piece, &sound, highest).ok_or_else(no_resonance)
}

/// The hits that are sound, and where the force has fallen too far \[Hz\].
///
/// # Errors
/// [`IdentifyError::Data`] where no hit is usable.
pub(crate) fn sound(histories: &[TimeHistory]) -> Result<(Vec<TimeHistory>, f64), IdentifyError> {
    let judged = histories.iter().map(|history| Ok((history, history.accelerance(Estimation::default())?)));
    let judged = judged.collect::<Result<Vec<_>, IdentifyError>>()?;
    let ends = judged.iter().filter_map(|(_, accelerance)| accelerance.frequency.last().copied());
    let highest = ends.fold(f64::INFINITY, f64::min);
    Ok((judged.iter().map(|(history, accelerance)| history.kept_in(accelerance)).collect(), highest))
}

fn no_resonance() -> IdentifyError {
    IdentifyError::TooFewResonances { found: 0, needed: 1, noise_percent: None }
}

impl Pole {
    /// $\lambda = \omega(-\zeta + j\sqrt{1-\zeta^2})$ \[rad/s\]; undamped where the damping is not known.
    pub fn lambda(&self) -> Complex64 {
        let zeta = self.damping_ratio.unwrap_or(0.0);
        self.angular_frequency * Complex64::new(-zeta, (1.0 - zeta * zeta).sqrt())
    }
}

impl MeasuredModes {
    /// All measured values in the order of the covariance: $\ln\omega_m$ of every pole; $\ln\zeta_m$ of every pole that tells it; then
    /// record by record the real and the imaginary part of each residue in turn, and of each value of the remainder.
    pub fn values(&self) -> Vec<f64> {
        let frequencies = self.poles.iter().map(|pole| pole.angular_frequency.ln());
        let damping = self.poles.iter().filter_map(|pole| pole.damping_ratio.map(f64::ln));
        let parts = |value: &Complex64| [value.re, value.im];
        let records = self.records.iter().flat_map(|record| record.residues.iter().chain(&record.remainder));
        frequencies.chain(damping).chain(records.flat_map(parts)).collect()
    }
}
