//! The constants of a plate from its measured modes, as an identification.

use std::f64::consts::TAU;

use orthopanel_data::ImpactTest;
use orthopanel_model::{
    Damping, Estimate, MODEL_SCHEMA, ModeRange, PLATE_CONSTANTS, PanelModel, Piece, Place, Ports, StructureKind,
};

use super::too_few_places::TooFewPlaces;
use crate::accelerance_fit::told_variance;
use crate::free_constants::HALF_95;
use crate::judge::ODDS;
use crate::measured::{MeasuredModes, measured_modes};
use crate::place_readings::refuse_other_places;
use crate::plate_start::{PlateFit, PlateStart, held};
use crate::settings::Settings;
use crate::structures;
use crate::{
    AcceleranceFit, Correlation, HiddenMode, Identification, IdentifiedConstant, IdentifyError, ModeFit, NotIdentified,
    PieceFit,
};

/// How far modes may lie from their poles once constants are found, in logarithms of frequencies.
const APART: f64 = 0.015;
/// A constant of whose deviation beforehand the data leave more than this part is not shown by them.
const OPEN: f64 = 0.7;
/// Components of a direction below this are not told.
const SMALL: f64 = 0.1;
/// Pairs of places from which no mode of a few that overlap is hidden.
const ALL_OVER: usize = 10;
/// Frequencies that a plate misses by less are those of an ideal one.
const IDEAL: f64 = 1e-4;
/// Lines sum modes up to so many times the band.
const SUMMED: f64 = 1.6;
/// Poles that stay alone, of those that stand out, beyond which the records are not those of this plate.
const MOST_ALONE: f64 = 0.4;

/// A constant that is held is contradicted by frequencies, where these are likelier by [`ODDS`] with none held, if it lies so many standard deviations off
/// what they say.
const CONTRADICTED: f64 = 3.0;

/// Residues all this many times as large as the plate's, or as small, are those of another unit: two units differ by more, and residues of
/// real panels by less.
const MOST_FACTOR: f64 = 2.0;

/// A plate with the modes that its records show.
pub(crate) struct PlateByModes {
    measured: MeasuredModes,
    piece: Piece,
    fit: PlateFit,
    not_identified: Vec<NotIdentified>,
    /// What the frequencies say of constants that the test file holds.
    of_held: Option<String>,
}

impl PlateByModes {
    /// `None` where the modes lead to no plate.
    ///
    /// # Errors
    /// Records that cannot be read or show no resonances, and what the plate refuses.
    pub(crate) fn of(test: &ImpactTest) -> Result<Option<Self>, IdentifyError> {
        let Some(measured) = measured_modes(test)?.into_iter().map(MeasuredModes::without_faint).next() else {
            return Ok(None);
        };
        let piece = test.pieces[measured.piece].piece;
        let mut held = held(test);
        let start = PlateStart::new(&measured, (piece, test.boundary), held);
        let Some((_, values)) = start.constants()?.into_iter().next() else { return Ok(None) };
        let mut fit = start.fit(values)?;
        // What is open is held at what is usual, the most open first, and said.
        let mut not_identified: Vec<NotIdentified> = Vec::new();
        while let Some(place) = fit.most_open(OPEN) {
            let constant = fit.free[place];
            let mut unseen = not_identified_of(&fit, place);
            let at = PlateFit::usual(constant, &fit.values);
            unseen.held_at = at;
            not_identified.push(unseen);
            held[constant] = Some(at);
            let mut values = fit.values;
            values[constant] = at;
            fit = PlateStart::new(&measured, (piece, test.boundary), held).fit(values)?;
        }
        let is_missed = fit.missed > IDEAL && held_values(test).next().is_some();
        let of_held = if is_missed { said_of_held(test, &measured, &fit)? } else { None };
        Ok(Some(Self { measured, piece, fit, not_identified, of_held }))
    }

    /// # Errors
    /// As [`refuse_other_places`].
    pub(crate) fn refuse_other_places(&self, test: &ImpactTest) -> Result<(), IdentifyError> {
        refuse_other_places(&self.measured, (&self.piece, test.boundary), &self.fit.values)
    }

    /// Whether the modes lie where those of an ideal plate do.
    pub(crate) fn is_ideal(&self) -> bool {
        self.fit.missed < IDEAL
    }

    /// Whether the places tell modes apart that overlap: lines then say no more than modes do.
    pub(crate) fn is_seen_all_over(&self) -> bool {
        self.measured.records.len() >= ALL_OVER
    }

    /// What is said of the test.
    ///
    /// # Errors
    /// Records that are not those of such a plate, and what the model refuses.
    pub(crate) fn identification(
        &self,
        test: &ImpactTest,
        settings: Settings,
    ) -> Result<Identification, IdentifyError> {
        let (constants, correlations) = self.constants();
        let not_identified = self.not_identified.clone();
        let all = self.fit.values;
        let measured = &self.measured;
        let (pairs, band) = (self.pairs(), measured.band[1]);
        let structure = structures::of(StructureKind::MindlinPlate).recorded(&self.piece, test.boundary);
        let modes = structure.modes_below(&all, 1.1 * band, &pairs)?;
        let candidates: Vec<(f64, Vec<f64>)> =
            modes.iter().map(|mode| (TAU * mode.frequency, mode.products.clone())).collect();
        let partners = measured.partners(&candidates, |_| APART);
        let shapes = partners.iter().enumerate().filter_map(|(pole, partner)| {
            Some(modes[partner.as_ref()?.0].products.iter().enumerate().map(move |(record, of)| (record, pole, *of)))
        });
        let mut ratios: Vec<f64> =
            shapes.flatten().map(|(record, pole, predicted)| measured.product(record, pole) / predicted).collect();
        ratios.sort_by(f64::total_cmp);
        let usual = ratios.get(ratios.len() / 2).copied().unwrap_or(0.0);
        if !(1.0 / MOST_FACTOR..MOST_FACTOR).contains(&usual) {
            return Err(IdentifyError::Unsupported(format!("records {usual:.3} times as large as those of a plate")));
        }
        let mut fit = PieceFit::of(&test.pieces[measured.piece]);
        let mut ratios: Vec<Option<Estimate>> = vec![None; modes.iter().filter(|mode| mode.frequency < band).count()];
        for (pole, partner) in partners.iter().enumerate() {
            let Some((mode, _)) = partner else { continue };
            let own = measured.poles[pole];
            let deviation = |place: usize| measured.covariance[(place, place)].sqrt();
            let damping = own
                .damping_ratio
                .map(|value| Estimate { value, std: Some(value * deviation(measured.poles.len() + pole)) });
            ratios.get_mut(*mode).into_iter().for_each(|ratio| *ratio = damping);
            let frequency = own.angular_frequency / TAU;
            fit.modes.push(ModeFit {
                mode: mode + 1,
                nodes: modes[*mode].nodes,
                measured: frequency,
                measured_std: Some(frequency * deviation(pole)),
                model: modes[*mode].frequency,
                damping,
            });
        }
        let logs: Vec<f64> = ratios.iter().flatten().map(|ratio| ratio.value.ln()).collect();
        let usual = (logs.iter().sum::<f64>() / logs.len().max(1) as f64).exp();
        fit.hidden = modes
            .iter()
            .zip(&ratios)
            .enumerate()
            .filter(|(_, (_, ratio))| ratio.is_none())
            .map(|(number, (mode, _))| HiddenMode {
                mode: number + 1,
                nodes: mode.nodes,
                model: mode.frequency,
                damping: None,
            })
            .collect();
        fit.damping = ratios.into_iter().map(|ratio| ratio.unwrap_or(Estimate { value: usual, std: None })).collect();
        let alone: Vec<String> = partners
            .iter()
            .zip(&measured.poles)
            .filter(|(partner, _)| partner.is_none())
            .map(|(_, pole)| format!("{:.1} Hz", pole.angular_frequency / TAU))
            .collect();
        if alone.len() as f64 > MOST_ALONE * measured.poles.len() as f64 {
            return Err(IdentifyError::UntakenResonances {
                chi_square: measured.chi_square.unwrap_or(f64::NAN),
                resonances: measured
                    .poles
                    .iter()
                    .zip(&partners)
                    .filter(|(_, partner)| partner.is_none())
                    .map(|(pole, _)| pole.angular_frequency / TAU)
                    .collect(),
            });
        }
        let accelerances = self.accelerances(test, settings, &all, &fit)?;
        let pairs = || accelerances.iter().flat_map(|fit| fit.model.iter().zip(&fit.measured));
        let missed: f64 = pairs().map(|(model, measured)| (model - measured).norm_sqr()).sum();
        let total: f64 = pairs().map(|(_, measured)| measured.norm_sqr()).sum();
        let count = fit.modes.len().max(1) as f64;
        let frequency_rms_percent =
            (fit.modes.iter().map(|mode| mode.error_percent().powi(2)).sum::<f64>() / count).sqrt();
        let held: Vec<&str> = held_values(test).map(|(constant, _)| PLATE_CONSTANTS[constant].name).collect();
        let beside = if held.is_empty() {
            String::new()
        } else {
            format!(" with {} as the test file holds them", held.join(", "))
        };
        let mut notes = vec![format!(
            "constants are from the frequencies of the modes that the records show, which the nearest plate{beside} misses by {:.3} % (standard \
             deviation, estimated with the constants and part of theirs)",
            100.0 * self.fit.missed
        )];
        notes.extend(self.of_held.clone());
        let places = measured.records.len();
        notes.extend(TooFewPlaces::of(&modes, &fit.damping, places).map(|too_few| too_few.to_string()));
        if !alone.is_empty() {
            notes.push(format!("resonances that are no mode of the plate: {}", alone.join(", ")));
        }
        Ok(Identification {
            structure: StructureKind::MindlinPlate,
            constants,
            not_identified,
            correlations,
            pieces: vec![fit],
            frequency_rms_percent,
            left_one_out_percent: None,
            accelerance_rms_percent: Some(100.0 * (missed / total).sqrt()),
            chi_square: None,
            accelerances,
            effects: Vec::new(),
            question: None,
            common_gain: None,
            notes,
        })
    }

    fn pairs(&self) -> Vec<(Place, Place)> {
        self.measured.records.iter().map(|record| (record.force_at, record.response_at)).collect()
    }

    /// All constants, and the correlations of those that the data show.
    fn constants(&self) -> (Vec<IdentifiedConstant>, Vec<Correlation>) {
        let PlateFit { values, free, covariance, .. } = &self.fit;
        let deviation = |place: usize| covariance[(place, place)].sqrt();
        let constant = |(i, constant): (usize, &orthopanel_model::Constant)| {
            let place = free.iter().position(|free| *free == i);
            let unit = if PlateFit::is_logarithmic(i) { values[i] } else { 1.0 };
            IdentifiedConstant {
                name: constant.name,
                unit: constant.unit,
                value: values[i],
                std: place.map(|place| unit * deviation(place)),
                held: place.is_none(),
                piece: None,
            }
        };
        let mut correlations = Vec::new();
        for (a, &of_a) in free.iter().enumerate() {
            for (b, &of_b) in free.iter().enumerate().skip(a + 1) {
                correlations.push(Correlation {
                    first: PLATE_CONSTANTS[of_a].name,
                    first_piece: None,
                    second: PLATE_CONSTANTS[of_b].name,
                    second_piece: None,
                    value: covariance[(a, b)] / (deviation(a) * deviation(b)),
                });
            }
        }
        (PLATE_CONSTANTS.iter().enumerate().map(constant).collect(), correlations)
    }

    /// Measured and calculated lines of every record, up to the end of the band.
    fn accelerances(
        &self,
        test: &ImpactTest,
        settings: Settings,
        values: &[f64],
        fit: &PieceFit,
    ) -> Result<Vec<AcceleranceFit>, IdentifyError> {
        let records = test.accelerances(settings.estimation)?;
        let (forces, responses): (Vec<Place>, Vec<Place>) =
            records.iter().map(|(_, record)| (record.force_at, record.response_at)).unzip();
        let ratios: Vec<f64> = fit.damping.iter().map(|ratio| ratio.value).collect();
        let beyond = ratios.last().copied().unwrap_or_default();
        let model = PanelModel {
            schema: MODEL_SCHEMA.to_owned(),
            name: None,
            piece: self.piece,
            boundary: test.boundary,
            structure: StructureKind::MindlinPlate,
            constants: PLATE_CONSTANTS
                .iter()
                .zip(values)
                .map(|(constant, value)| (constant.name.to_owned(), Estimate { value: *value, std: None }))
                .collect(),
            damping: Damping { ratios, beyond, ..Damping::default() },
            correlation: None,
            effects: vec![],
            ports: Ports { forces: forces.clone(), responses: responses.clone() },
            provenance: std::collections::BTreeMap::new(),
        };
        let band = self.measured.band[1];
        let modes = model.modal_model(ModeRange::UpTo(SUMMED * band), &forces, &responses)?;
        let curve = |(number, (piece, record)): (usize, &(usize, orthopanel_data::Accelerance))| {
            let lines = record.frequency.partition_point(|frequency| *frequency <= band);
            AcceleranceFit {
                piece: *piece,
                force_at: record.force_at,
                response_at: record.response_at,
                decay_rate: record.decay_rate,
                frequency: record.frequency[..lines].to_vec(),
                measured: record.value[..lines].to_vec(),
                model: record.frequency[..lines].iter().map(|f| modes.accelerance(number, number, *f)).collect(),
                variance: told_variance(record).map(|variance| variance[..lines].to_vec()),
            }
        };
        Ok(records.iter().enumerate().map(curve).collect())
    }
}

/// Numbers and values of the constants that a test holds.
fn held_values(test: &ImpactTest) -> impl Iterator<Item = (usize, f64)> {
    held(test).into_iter().enumerate().filter_map(|(constant, value)| Some((constant, value?)))
}

/// Of the constants that a test holds those that the frequencies alone put elsewhere, and how well a plate that has them there meets these.
///
/// # Errors
/// What the plate refuses.
fn said_of_held(test: &ImpactTest, measured: &MeasuredModes, fit: &PlateFit) -> Result<Option<String>, IdentifyError> {
    let start = PlateStart::new(measured, (test.pieces[measured.piece].piece, test.boundary), [None; 6]);
    let Some((_, values)) = start.constants()?.into_iter().next() else { return Ok(None) };
    let free = start.fit(values)?;
    // Beside what either leaves alone, the same poles are paired.
    let apart = free.apart().max(fit.apart());
    let as_held = PlateStart::new(measured, (test.pieces[measured.piece].piece, test.boundary), held(test));
    if start.log_evidence(&free.values, apart)? - as_held.log_evidence(&fit.values, apart)? < ODDS.ln() {
        return Ok(None);
    }
    let elsewhere = |(constant, at): (usize, f64)| {
        let deviation = free.covariance[(constant, constant)].sqrt();
        let (value, is_log) = (free.values[constant], PlateFit::is_logarithmic(constant));
        let apart = if is_log { (value / at).ln() } else { value - at };
        let std = if is_log { value * deviation } else { deviation };
        let name = PLATE_CONSTANTS[constant].name;
        (apart.abs() > CONTRADICTED * deviation).then(|| format!("{name} = {at:.3e}, free {value:.3e} +- {std:.1e}"))
    };
    let elsewhere: Vec<String> = held_values(test).filter_map(elsewhere).collect();
    Ok((!elsewhere.is_empty()).then(|| {
        format!(
            "of the constants held the frequencies contradict {}; with none held a plate misses them by {:.3} %: correct these values or leave \
             them out of [constants]",
            elsewhere.join("; "),
            100.0 * free.missed
        )
    }))
}

/// A constant that the data leave open, number `place` of the free ones.
fn not_identified_of(PlateFit { values, free, covariance, .. }: &PlateFit, place: usize) -> NotIdentified {
    let (number, constant) = (free[place], &PLATE_CONSTANTS[free[place]]);
    let (value, deviation) = (values[number], covariance[(place, place)].sqrt());
    let end = |sign: f64| {
        let by = sign * HALF_95 * deviation;
        if PlateFit::is_logarithmic(number) { value * by.exp() } else { value + by }.clamp(constant.low, constant.high)
    };
    let size = (0..free.len()).map(|j| covariance[(j, place)].powi(2)).sum::<f64>().sqrt();
    let of = |(j, &of): (usize, &usize)| (PLATE_CONSTANTS[of].name, covariance[(j, place)] / size);
    let mut direction: Vec<(&'static str, f64)> = free.iter().enumerate().map(of).collect();
    // Itself first.
    direction.sort_by(|a, b| (b.0 == constant.name).cmp(&(a.0 == constant.name)).then(b.1.abs().total_cmp(&a.1.abs())));
    direction.retain(|(name, part)| *name == constant.name || part.abs() > SMALL);
    NotIdentified {
        name: constant.name,
        unit: constant.unit,
        held_at: value,
        interval: [end(-1.0), end(1.0)],
        direction,
    }
}
