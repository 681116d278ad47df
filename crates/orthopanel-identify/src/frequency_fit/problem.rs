//! Eq. 22 over the measurements of a test.

use std::sync::Arc;

use faer::Mat;
use orthopanel_data::{ImpactTest, MeasurementData, NaturalFrequencies};
use orthopanel_model::RitzMode;
use rayon::prelude::*;

use super::impossible_names::{NamedLine, refuse_impossible_names};
use crate::IdentifyError;
use crate::free_constants::FreeConstants;
use crate::least_squares::Linearised;
use crate::structures::{self, MeasuredModes, Prediction, SearchedStructure, Shown, Solved, bending_nodes};

/// Measured frequencies of one piece.
#[derive(Debug)]
pub(super) struct FrequencySet {
    /// Index of the piece in the test.
    pub piece: usize,
    /// The modes they belong to.
    pub modes: Box<dyn MeasuredModes>,
    /// Frequencies \[Hz\].
    pub measured: Vec<f64>,
    /// Standard deviation of each by rounding to a bin \[Hz\], where the bin is stated.
    pub rounding: Vec<f64>,
}

/// A line of a list.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Line {
    /// Index of the list.
    pub set: usize,
    /// Index of the line in it.
    pub line: usize,
}

/// Another name for a line of a list.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Renamed {
    /// Index of the list.
    pub set: usize,
    /// Index of the line in it.
    pub line: usize,
    /// Nodal lines across x and across y.
    pub nodes: [usize; 2],
}

/// One set's modes at some constants.
pub(super) struct SetPrediction {
    /// The constants of its piece.
    pub values: Vec<f64>,
    /// The measured modes, in the test's order.
    pub modes: Vec<Prediction>,
    /// The shapes that these were found among, where they help to solve again.
    pub shapes: Vec<RitzMode>,
}

/// The measurements, and which constants are free.
#[derive(Debug)]
pub(super) struct FrequencyProblem {
    pub structure: &'static dyn SearchedStructure,
    pub constants: FreeConstants,
    pub sets: Arc<[FrequencySet]>,
}

impl FrequencyProblem {
    pub(super) fn of(test: &ImpactTest) -> Result<Self, IdentifyError> {
        let structure = structures::of_test(test);
        let constants = FreeConstants::of(test, structure.kind().constants())?;
        refuse_impossible_names(test, structure, &constants, &named_lines(test))?;
        let sets = frequency_sets(test, structure)?.into();
        let problem = Self { structure, constants, sets };
        // What frequencies show in part may be held; what they show wholly has nothing to hold.
        let needed = match structure.shown() {
            Shown::Wholly => problem.constants.count(),
            Shown::InPart => problem.constants.count().min(1),
        };
        if problem.count() < needed {
            let names: Vec<&str> =
                (0..problem.constants.count()).map(|at| problem.constants.constant(at).name).collect();
            return Err(IdentifyError::TooFewFrequencies { found: problem.count(), needed, names: names.join(", ") });
        }
        Ok(problem)
    }

    /// The same lists with some lines named otherwise, and without one; an error where one name stands twice.
    pub(super) fn read_as(
        &self,
        test: &ImpactTest,
        names: &[Renamed],
        without: Option<Line>,
    ) -> Result<Self, IdentifyError> {
        let read = |(index, set): (usize, &FrequencySet)| {
            let mut nodes = set.modes.nodes().to_vec();
            names.iter().filter(|name| name.set == index).for_each(|name| nodes[name.line] = name.nodes);
            let is_kept = |line: &usize| without != Some(Line { set: index, line: *line });
            let kept: Vec<usize> = (0..nodes.len()).filter(is_kept).collect();
            let nodes: Vec<[usize; 2]> = kept.iter().map(|&line| nodes[line]).collect();
            if (1..nodes.len()).any(|line| nodes[..line].contains(&nodes[line])) {
                return Err(IdentifyError::Unsupported("two frequencies of one mode".to_owned()));
            }
            let modes = self.structure.measured_modes(&test.pieces[set.piece].piece, test.boundary, nodes)?;
            let measured = kept.iter().map(|&line| set.measured[line]).collect();
            let rounding = kept.iter().filter_map(|&line| set.rounding.get(line).copied()).collect();
            Ok(FrequencySet { piece: set.piece, modes, measured, rounding })
        };
        let sets = self.sets.iter().enumerate().map(read).collect::<Result<Arc<[_]>, _>>()?;
        Ok(Self { structure: self.structure, constants: self.constants.clone(), sets })
    }

    /// Number of measured frequencies.
    pub(super) fn count(&self) -> usize {
        self.sets.iter().map(|set| set.measured.len()).sum()
    }

    /// The modes of every set at these parameters.
    pub(super) fn predictions(&self, parameters: &[f64]) -> Result<Vec<SetPrediction>, IdentifyError> {
        self.predictions_from(parameters, None)
    }

    /// The same, sooner where `quick` predicts quickly near by.
    pub(super) fn predictions_from(
        &self,
        parameters: &[f64],
        quick: Option<&Arc<[FrequencySet]>>,
    ) -> Result<Vec<SetPrediction>, IdentifyError> {
        let predict = |(index, set): (usize, &FrequencySet)| {
            let values = self.constants.values(parameters, set.piece);
            let known = quick.map(|sets| sets[index].modes.shapes(&values)).transpose()?.unwrap_or_default();
            let Solved { predictions, shapes } = set.modes.solve(&values, &known)?;
            Ok(SetPrediction { modes: predictions, values, shapes })
        };
        self.sets.par_iter().enumerate().map(predict).collect()
    }

    /// What predicts the same quickly near these predictions, and less well further off; `None` where this one is quick.
    pub(super) fn near(&self, at: &[SetPrediction]) -> Result<Option<Arc<[FrequencySet]>>, IdentifyError> {
        let near = |(set, at): (&FrequencySet, &SetPrediction)| {
            let modes = set.modes.near(&at.values, &at.shapes)?;
            let (measured, rounding) = (set.measured.clone(), set.rounding.clone());
            Ok(modes.map(|modes| FrequencySet { piece: set.piece, modes, measured, rounding }))
        };
        let pairs = self.sets.par_iter().zip(at);
        let sets = pairs.map(near).collect::<Result<Option<Vec<_>>, IdentifyError>>()?;
        Ok(sets.map(Arc::from))
    }

    /// The same constants, on these sets.
    pub(super) fn on(&self, sets: &Arc<[FrequencySet]>) -> Self {
        Self { structure: self.structure, constants: self.constants.clone(), sets: Arc::clone(sets) }
    }

    /// Relative residuals $(f_{cal}-f_{exp})/f_{exp}$ and their derivatives by the parameters.
    pub(super) fn linearise(&self, parameters: &[f64]) -> Result<Linearised, IdentifyError> {
        Ok(self.linearised(&self.predictions(parameters)?, &self.constants))
    }

    /// The same from modes that stand already, with any constants free.
    pub(super) fn linearised(&self, predictions: &[SetPrediction], constants: &FreeConstants) -> Linearised {
        let mut residuals = Vec::with_capacity(self.count());
        let mut rows = Vec::with_capacity(self.count());
        for (set, SetPrediction { values, modes, .. }) in self.sets.iter().zip(predictions) {
            let of_constant = constants.parameters_of(set.piece);
            for (prediction, measured) in modes.iter().zip(&set.measured) {
                let ratio = prediction.frequency / measured;
                residuals.push(ratio - 1.0);
                let mut row = vec![0.0; constants.count()];
                for (constant, parameter) in of_constant.iter().enumerate() {
                    if let &Some(parameter) = parameter {
                        let slope = constants.slope(constant, values[constant]);
                        row[parameter] += ratio * prediction.by_constant[constant] * slope;
                    }
                }
                rows.push(row);
            }
        }
        let jacobian = Mat::from_fn(rows.len(), constants.count(), |i, j| rows[i][j]);
        Linearised { residuals, jacobian }
    }

    /// These parameters with the factor on all moduli that meets the frequencies best, where no modulus is held.
    pub(super) fn at_right_size(&self, parameters: &[f64]) -> Result<Vec<f64>, IdentifyError> {
        if !self.constants.moduli_are_free() {
            return Ok(parameters.to_vec());
        }
        let (mut sum, mut squares) = (0.0, 0.0);
        for set in self.sets.iter() {
            let calculated = set.modes.rough_frequencies(&self.constants.values(parameters, set.piece))?;
            for (calculated, measured) in calculated.iter().zip(&set.measured) {
                let quotient = calculated / measured;
                (sum, squares) = (sum + quotient, squares + quotient * quotient);
            }
        }
        let log_factor = 2.0 * (sum / squares).ln();
        let scaled = |(index, parameter): (usize, &f64)| {
            let is_modulus = self.constants.is_modulus(self.constants.free[index].constant);
            if is_modulus { parameter + log_factor } else { *parameter }
        };
        Ok(parameters.iter().enumerate().map(scaled).collect())
    }

    /// Eq. 22.
    pub(super) fn error(&self, parameters: &[f64]) -> Result<f64, IdentifyError> {
        let mut sum = 0.0;
        for set in self.sets.iter() {
            let calculated = set.modes.frequencies(&self.constants.values(parameters, set.piece))?;
            let misses = calculated.iter().zip(&set.measured).map(|(calculated, measured)| calculated / measured - 1.0);
            sum += misses.map(|miss| miss * miss).sum::<f64>();
        }
        Ok(sum / self.count() as f64)
    }
}

/// Nodal lines of a list of frequencies: those given, else bending modes in order.
fn nodes_of(test: &ImpactTest, data: &NaturalFrequencies) -> Vec<[usize; 2]> {
    match &data.shape[..] {
        [] => bending_nodes(test.boundary, data.values.len()),
        shape => shape.iter().map(|pair| pair.map(|count| count as usize)).collect(),
    }
}

fn named_lines(test: &ImpactTest) -> Vec<NamedLine> {
    let mut lines = Vec::new();
    for measurement in &test.measurements {
        let MeasurementData::NaturalFrequencies(data) = &measurement.data else { continue };
        let named = data.values.iter().zip(nodes_of(test, data));
        lines.extend(named.map(|(&measured, nodes)| NamedLine { piece: measurement.piece, measured, nodes }));
    }
    lines
}

fn frequency_sets(test: &ImpactTest, structure: &dyn SearchedStructure) -> Result<Vec<FrequencySet>, IdentifyError> {
    let mut sets = Vec::new();
    for measurement in &test.measurements {
        let MeasurementData::NaturalFrequencies(data) = &measurement.data else { continue };
        let nodes = nodes_of(test, data);
        sets.push(FrequencySet {
            piece: measurement.piece,
            modes: structure.measured_modes(&test.pieces[measurement.piece].piece, test.boundary, nodes)?,
            measured: data.values.clone(),
            // A value rounded to a bin is uniform over it.
            rounding: data.resolution.iter().map(|bin| bin / 12.0_f64.sqrt()).collect(),
        });
    }
    Ok(sets)
}
