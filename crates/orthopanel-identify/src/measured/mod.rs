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
mod modes;
mod noise_decay;
mod pole_search;
mod records;
pub(crate) use frequencies::names_told;
pub(crate) use hits::{HitSpectra, HitsOfRecord, transform};
pub(crate) use modes::Names;
pub use modes::{MeasuredModes, MeasuredRecord, Pole};
pub(crate) use records::SKIRT;
mod scatter;
mod stabilisation;
pub(crate) fn is_record(measurement: &Measurement) -> bool {
    measurement.data.recorded().is_some()
}

#[cfg(test)]
mod tests;

use num_complex::Complex64;
use orthopanel_data::{Estimation, ImpactTest, Measurement, MeasurementData, TimeHistory};
use orthopanel_model::{NamedShapes, Place, StructureKind};

use crate::IdentifyError;
use crate::structures;

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
