//! By how much a sound model of a real panel misses: the only place that says how far a model is trusted.
//!
//! The covariance of what is measured less what is predicted is
//! $$C = C_\text{noise} + \sum_k\tau_k^2F_kF_k^T,$$
//! where each kind $k$ of error has its columns $F_k$ and a size $\tau_k$, which is estimated with the rest and has a log-normal prior.

mod column;
mod coupling;
mod kind;
mod mixing;
mod panel_damping;

use std::ops::Range;

use faer::Mat;
use num_complex::Complex64;
use orthopanel_model::{EffectState, Field, ModelError, StructureKind};

use column::{Column, Power};
pub(crate) use kind::{KINDS, Kind, deviations, frequency_prior, least_sizes, medians};

use crate::comparison::Comparison;
use crate::predicted::{Prediction, Predictor, distinct};
use crate::whitening::{Split, Whitening};

/// The frequency of a motion of the piece as a whole on its suspension is predicted so many times worse.
const HANGING: f64 = 10.0;
/// Part of an error of a remainder that is in quadrature.
const QUADRATURE: f64 = 0.3;
/// Waves of unevenness along the panel.
const WAVES: usize = 20;
/// Shortest length \[m\] of waves of each size but the last: cells are stretched, and adhesive is spread, alike over some 50 to 200 mm, so that
/// sizes fall towards short waves, each octave by one of its own.
const LENGTHS: [f64; 3] = [0.5, 0.25, 0.125];

/// The columns $F$ of all kinds, side by side.
#[derive(Clone)]
pub(crate) struct ErrorColumns {
    /// Number of values.
    size: usize,
    /// Places and values that are not zero.
    columns: Vec<Vec<(usize, f64)>>,
    /// Of each column its kind, as a number below [`KINDS`], and the power of its size that it goes with.
    kinds: Vec<(usize, Power)>,
    /// Of columns that are of the piece, not of one measurement of it, the number of the mode or of the wave.
    of_piece: Vec<Option<usize>>,
    /// Values that tell no more than their size, with their variance: near motions of the piece as a whole,
    uninformative: Vec<(usize, f64)>,
    /// and residues of poles that are no modes of the model, which may be false.
    without_partner: Vec<(usize, f64)>,
}

/// What unevenness along the panel does to all values: of each wave its kind and its column.
pub(crate) type Waves = Vec<(usize, Vec<f64>)>;

/// [`Waves`] of every field; of a plate none.
///
/// # Errors
/// As [`Predictor::uneven`].
pub(crate) fn waves(predictor: &Predictor, constants: &[f64], effects: &[EffectState]) -> Result<Waves, ModelError> {
    let mut waves = Vec::new();
    if predictor.structure == StructureKind::MindlinPlate {
        return Ok(waves);
    }
    for field in Field::ALL {
        for (number, column) in predictor.uneven((constants, effects), field, WAVES)?.into_iter().enumerate() {
            let length = 2.0 * predictor.piece().length / (number + 1) as f64;
            let first = match field {
                Field::Shear => Kind::LongestCore,
                Field::Bending => Kind::LongestFaces,
                Field::Mass => Kind::LongestMass,
            };
            let octave = LENGTHS.iter().filter(|shortest| length < **shortest).count();
            waves.push((first as usize + octave, column));
        }
    }
    Ok(waves)
}

/// Kinds whose columns are parts of what is predicted of a record.
const OF_PREDICTED: [Kind; 6] =
    [Kind::Frequency, Kind::Coupling, Kind::ForcePlace, Kind::RecordGain, Kind::ResponsePlace, Kind::Gain];

/// Makes errors that are parts of what a record is predicted to show as large as the record is: a hypothesis that predicts less of it would else have
/// smaller errors, and a gain of 0.78 was named where nothing is missing (Peelle's pertinent puzzle; Frühwirth et al., EPJ Web Conf. 27 (2012) 00008).
fn as_measured(columns: &mut [Column], comparison: &Comparison, at: &Prediction) {
    let ratio = |record: usize| {
        let poles = (0..comparison.measured.poles.len()).filter(|pole| at.partners[record][*pole].is_some());
        let places: Vec<usize> = poles.map(|pole| comparison.residue_place(record, pole)).collect();
        let square = |values: &[f64]| -> f64 {
            places.iter().map(|place| values[*place].powi(2) + values[place + 1].powi(2)).sum()
        };
        let ratio = (square(&comparison.values) / square(&at.values)).sqrt();
        if ratio.is_normal() { ratio } else { 1.0 }
    };
    let ratios: Vec<f64> = (0..comparison.measured.records.len()).map(ratio).collect();
    let of_predicted = OF_PREDICTED.map(|kind| kind as usize);
    for (_, column) in columns.iter_mut().filter(|((kind, _), _)| of_predicted.contains(kind)) {
        for (place, value) in column {
            *value *= comparison.record_of(*place).map_or(1.0, |record| ratios[record]);
        }
    }
}

impl ErrorColumns {
    /// About a prediction; `waves` as [`waves()`] finds them.
    pub(crate) fn about(predictor: &Predictor, at: &Prediction, waves: &Waves) -> Self {
        let comparison = predictor.comparison;
        let mut columns: Vec<Column> = Vec::new();
        let first_order = |kind: Kind| (kind as usize, 1);
        let measured = comparison.measured;
        // A list that tells no noise has it in the same size.
        let of_mode = |pole: usize| at.flexible_of_poles[pole].filter(|_| measured.covariance[(pole, pole)] > 0.0);
        let mut of_piece: Vec<Option<usize>> = (0..measured.poles.len()).map(of_mode).collect();
        for pole in 0..measured.poles.len() {
            let times = if at.hangs[pole] { HANGING } else { 1.0 };
            columns.push((first_order(Kind::Frequency), vec![(pole, times)]));
        }
        for record in 0..measured.records.len() {
            for pole in 0..measured.poles.len() {
                let place = comparison.residue_place(record, pole);
                let phase = at.phase[pole];
                let kinds = if at.hangs[pole] { [Kind::Hanging; 2] } else { [Kind::Residue, Kind::Quadrature] };
                for (kind, turn) in kinds.into_iter().zip([Complex64::ONE, Complex64::I]) {
                    let mut column = vec![(place, (phase * turn).re), (place + 1, (phase * turn).im)];
                    // A mode that is another is so in all of its lines.
                    for (number, brings) in at.brings[record][pole].iter().enumerate() {
                        let value = comparison.residue[pole] / comparison.rigid * brings * turn;
                        let place = comparison.remainder_place(record, number);
                        column.extend([(place, value.re), (place + 1, value.im)]);
                    }
                    columns.push((first_order(kind), column));
                }
            }
            // Modes below the band and above: on springs, as masses, and as springs.
            let frequencies = &measured.remainder_frequencies;
            let clear = &frequencies[at.near_hanging.min(frequencies.len())..];
            let end = |power: i32| if power < 0 { clear.first() } else { clear.last() }.copied().unwrap_or(1.0);
            let mut along = |kind: Kind, part: usize, power: i32, times: f64| {
                let value = |(number, frequency): (usize, &f64)| {
                    (comparison.remainder_place(record, number) + part, times * (frequency / end(power)).powi(power))
                };
                let column = frequencies.iter().enumerate().skip(at.near_hanging).map(value);
                columns.push((first_order(kind), column.collect()));
            };
            along(Kind::Remainder, 0, 0, 1.0);
            along(Kind::Remainder, 0, 2, 1.0);
            along(Kind::Remainder, 1, 1, QUADRATURE);
            if at.near_hanging > 0 {
                // The series of a hanging mode in 1/s, far above it.
                for (power, times) in [(-1, 1.0), (-2, 1.0), (-3, QUADRATURE), (-4, QUADRATURE)] {
                    along(Kind::Hanging, usize::from(power % 2 != 0), power, times);
                }
            } else if at.is_free {
                // A pendulum on strings, with what damps it.
                along(Kind::Hanging, 0, -2, 1.0);
                along(Kind::Hanging, 1, -1, QUADRATURE);
            }
        }
        columns.extend(coupling::columns(comparison, at));
        // Modes of a beam lie far apart.
        if predictor.structure == StructureKind::MindlinPlate {
            columns.extend(mixing::columns(comparison, at));
            columns.extend(panel_damping::columns(predictor, at));
        }
        let unseen = comparison.unseen().start;
        let is_told = |along: &[f64]| along.iter().any(|value| *value != 0.0);
        let dense = |kind: Kind, from: &[f64], range: std::ops::Range<usize>| {
            (first_order(kind), range.map(|place| (place, from[place])).collect::<Vec<_>>())
        };
        for record in 0..measured.records.len() {
            let range = comparison.block_of(record);
            for along in at.by_force.iter().filter(|along| is_told(along)) {
                columns.push(dense(Kind::ForcePlace, along, range.clone()));
            }
            columns.push(dense(Kind::RecordGain, &at.values, range));
        }
        of_piece.resize(columns.len(), None);
        of_piece.extend((0..waves.len()).map(Some));
        columns.extend(
            waves.iter().map(|(kind, wave)| ((*kind, 1), wave.iter().copied().enumerate().take(unseen).collect())),
        );
        if !measured.records.is_empty() {
            let residues = comparison.residue_place(0, 0)..unseen;
            columns.push(dense(Kind::Gain, &at.values, residues));
            for own in distinct(measured.records.iter().map(|record| record.response_at)) {
                for along in at.by_response.iter().filter(|along| is_told(along)) {
                    let mut column = vec![0.0; comparison.size()];
                    let of_sensor = measured.records.iter().enumerate().filter(|(_, record)| record.response_at == own);
                    for (number, _) in of_sensor {
                        let range = comparison.block_of(number);
                        column[range.clone()].copy_from_slice(&along[range]);
                    }
                    columns.push(dense(Kind::ResponsePlace, &column, 0..unseen));
                }
            }
        }
        let near = (0..measured.records.len())
            .flat_map(|record| (0..at.near_hanging).map(move |number| comparison.remainder_place(record, number)));
        // A pole that is no mode of the model may be a false one: its residues tell no more than their size, and it may lie anywhere in the band.
        let of_size = |place: usize| [place, place + 1].map(|place| (place, comparison.variance_of_size(place)));
        let uninformative = near.flat_map(of_size).collect();
        let anywhere = (measured.band[1] / measured.band[0]).ln().powi(2) / 12.0;
        let mut without_partner = Vec::new();
        for (record, partners) in at.partners.iter().enumerate() {
            for (pole, _) in partners.iter().enumerate().filter(|(_, partner)| partner.is_none()) {
                without_partner.extend(of_size(comparison.residue_place(record, pole)));
                // The frequency is the same in all records.
                without_partner.extend((record == 0).then_some((pole, anywhere)));
            }
        }
        let is_alone = |pole: &usize| measured.records.is_empty() && at.flexible_of_poles[*pole].is_none();
        without_partner.extend((0..measured.poles.len()).filter(is_alone).map(|pole| (pole, anywhere)));
        of_piece.resize(columns.len(), None);
        // Rates of beams were judged without.
        if predictor.structure == StructureKind::MindlinPlate {
            as_measured(&mut columns, comparison, at);
        }
        let (kinds, columns) = columns.into_iter().unzip();
        Self { size: comparison.size(), columns, kinds, of_piece, uninformative, without_partner }
    }

    /// Of blocks that stand below each other, each with its piece: what is of a piece is the same in all that was measured of it.
    pub(crate) fn stacked(mut all: Vec<(usize, Self)>) -> Self {
        if all.len() == 1 {
            return all.remove(0).1;
        }
        let size = all.iter().map(|(_, own)| own.size).sum();
        let (mut kinds, mut keys) = (vec![], vec![]);
        let mut places: Vec<Vec<usize>> = Vec::new();
        for (piece, own) in &all {
            let place = |(kind, number): (&(usize, Power), &Option<usize>)| {
                let key = number.map(|number| (*piece, *kind, number));
                let known = key.is_some().then(|| keys.iter().position(|known| *known == key)).flatten();
                known.unwrap_or_else(|| {
                    kinds.push(*kind);
                    keys.push(key);
                    kinds.len() - 1
                })
            };
            places.push(own.kinds.iter().zip(&own.of_piece).map(place).collect());
        }
        let columns = vec![vec![]; kinds.len()];
        let mut stacked =
            Self { size, columns, kinds, of_piece: vec![], uninformative: vec![], without_partner: vec![] };
        let mut row = 0;
        for ((_, own), places) in all.into_iter().zip(places) {
            for (column, place) in own.columns.into_iter().zip(places) {
                stacked.columns[place].extend(column.into_iter().map(|(i, value)| (row + i, value)));
            }
            stacked.uninformative.extend(own.uninformative.into_iter().map(|(place, of)| (row + place, of)));
            stacked.without_partner.extend(own.without_partner.into_iter().map(|(place, of)| (row + place, of)));
            row += own.size;
        }
        stacked
    }

    /// The same where every pole is to be a mode of the model: for the search of an effect that gives it one.
    pub(crate) fn with_every_partner(mut self) -> Self {
        self.without_partner.clear();
        self
    }

    /// What tells no more than its size: places and variances.
    fn variances(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.uninformative.iter().chain(&self.without_partner).copied()
    }

    /// Columns side by side, each times its size, where they are not zero in a range of values.
    fn scaled(&self, numbers: &[usize], range: &Range<usize>, log_sizes: &[f64; KINDS]) -> Mat<f64> {
        let mut scaled = Mat::zeros(range.len(), numbers.len());
        for (column, &number) in numbers.iter().enumerate() {
            let (kind, power) = self.kinds[number];
            let size = (f64::from(power) * log_sizes[kind]).exp();
            self.columns[number].iter().for_each(|(place, value)| scaled[(place - range.start, column)] = size * value);
        }
        scaled
    }

    /// $C_\text{noise} + \sum\tau_k^2F_kF_k^T$.
    pub(crate) fn covariance(&self, noise: &Mat<f64>, log_sizes: &[f64; KINDS]) -> Mat<f64> {
        let all: Vec<usize> = (0..self.columns.len()).collect();
        let scaled = self.scaled(&all, &(0..self.size), log_sizes);
        let mut covariance = noise + &scaled * scaled.transpose();
        self.variances().for_each(|(place, variance)| covariance[(place, place)] += variance);
        covariance
    }

    /// Numbers of the columns that lie in each range alone, and of those that do not.
    fn parted(&self, split: &Split) -> (Vec<Vec<usize>>, Vec<usize>) {
        let (mut own, mut common) = (vec![vec![]; split.ranges.len()], vec![]);
        for (number, column) in self.columns.iter().enumerate() {
            match split.range_of(column.iter().map(|(place, _)| *place)) {
                Some(range) => own[range].push(number),
                None => common.push(number),
            }
        }
        (own, common)
    }

    /// The covariance, with `more` on its diagonal; `None` where it is not positive definite.
    pub(crate) fn whitening(
        &self,
        (noise, split): (&Mat<f64>, Option<&Split>),
        log_sizes: &[f64; KINDS],
        more: &[(usize, f64)],
    ) -> Option<Whitening> {
        let Some(split) = split else {
            let mut covariance = self.covariance(noise, log_sizes);
            more.iter().for_each(|(place, variance)| covariance[(*place, *place)] += variance);
            return Whitening::new(&covariance);
        };
        let (own, common) = self.parted(split);
        let block = |(range, own): (&Range<usize>, &Vec<usize>)| {
            let (from, size) = (range.start, range.len());
            let shared = split.common.subrows(from, size);
            let scaled = self.scaled(own, range, log_sizes);
            let block = noise.submatrix(from, from, size, size) - shared * shared.transpose();
            (range.clone(), block + &scaled * scaled.transpose())
        };
        let mut blocks: Vec<(Range<usize>, Mat<f64>)> = split.ranges.iter().zip(&own).map(block).collect();
        for (place, variance) in self.variances().chain(more.iter().copied()) {
            let Some(number) = split.range_of([place].into_iter()) else { continue };
            let (range, block) = &mut blocks[number];
            block[(place - range.start, place - range.start)] += variance;
        }
        let common = self.scaled(&common, &(0..self.size), log_sizes);
        Whitening::split(blocks, Some(faer::concat![[split.common, common]]))
    }

    /// Derivatives of $\tfrac12(\ln\det C + r^TC^{-1}r)$ by every $\ln\tau_k$, and their expected curvature, $\mathrm{tr}\,2\,C^{-1}G_kC^{-1}G_l$ with
    /// $G_k = \tau_k^2F_kF_k^T$; `missed` is $Wr$. Where the covariance is split, products of two columns that share no range are left out of the
    /// curvature: they are small.
    pub(crate) fn scores(
        &self,
        (by, split): (&Whitening, Option<&Split>),
        log_sizes: &[f64; KINDS],
        missed: &[f64],
    ) -> (Mat<f64>, Mat<f64>) {
        let (mut slope, mut curvature) = (Mat::<f64>::zeros(KINDS, 1), Mat::<f64>::zeros(KINDS, KINDS));
        let mut add = |numbers: &[usize], products: Mat<f64>, crossed: &[f64]| {
            for (j, &of_j) in numbers.iter().enumerate() {
                let (kind_of_j, power_of_j) = self.kinds[of_j];
                slope[(kind_of_j, 0)] += f64::from(power_of_j) * (products[(j, j)] - crossed[j].powi(2));
                for (i, &of_i) in numbers.iter().enumerate() {
                    let (kind_of_i, power_of_i) = self.kinds[of_i];
                    let powers = f64::from(power_of_i * power_of_j);
                    curvature[(kind_of_i, kind_of_j)] += 2.0 * powers * products[(i, j)].powi(2);
                }
            }
        };
        let all: Vec<usize> = (0..self.columns.len()).collect();
        let common = match split {
            Some(split) => {
                let (own, common) = self.parted(split);
                for (block, (range, own)) in split.ranges.iter().zip(own).enumerate() {
                    let (products, crossed) = by.products_in(block, self.scaled(&own, range, log_sizes), missed);
                    add(&own, products, &crossed);
                }
                common
            }
            None => all,
        };
        let mut columns = self.scaled(&common, &(0..self.size), log_sizes);
        by.whiten(&mut columns);
        let along = |j: usize| columns.col_as_slice(j).iter().zip(missed).map(|(a, b)| a * b).sum();
        let crossed: Vec<f64> = (0..common.len()).map(along).collect();
        add(&common, columns.transpose() * &columns, &crossed);
        (slope, curvature)
    }
}
