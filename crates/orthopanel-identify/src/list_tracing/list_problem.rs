//! The lists of a test, and their relative errors at some constants and effects.

use orthopanel_data::{ImpactTest, Measurement, MeasurementData};
use orthopanel_model::{BEAM_CONSTANTS, EffectSetting, ModelError, NaturalFrequencies, Piece, RecordSetting};

use super::hypothesis::Hypothesis;
use crate::IdentifyError;
use crate::free_constants::FreeConstants;

/// One list of one piece.
#[derive(Debug, Clone)]
pub(super) struct FrequencyList {
    pub piece: usize,
    pub setting: EffectSetting,
    /// Of as many modes as were measured.
    model: NaturalFrequencies,
    /// Flexible modes 1, 2, ... \[Hz\].
    pub measured: Vec<f64>,
    /// Relative standard deviation of each by rounding to a bin; empty where the bin is not told.
    pub rounding: Vec<f64>,
    /// Relative standard deviation of each as the file tells it; empty where it does not.
    pub scatter: Vec<f64>,
}

/// $E_x$ and $G_{zx}$ from which a search begins \[Pa\].
const USUAL: [f64; 2] = [1e10, 5e8];

/// All lists.
#[derive(Clone)]
pub(super) struct ListProblem {
    pub lists: Vec<FrequencyList>,
    pub constants: FreeConstants,
}

impl ListProblem {
    pub(super) fn of(test: &ImpactTest) -> Result<Self, IdentifyError> {
        let constants = FreeConstants::of(test, &BEAM_CONSTANTS)?;
        let list = |measurement: &Measurement| {
            let MeasurementData::NaturalFrequencies(data) = &measurement.data else { return Ok(None) };
            let setting = EffectSetting {
                piece: test.pieces[measurement.piece].piece,
                boundary: test.boundary,
                suspension: test.suspension.clone(),
                record: RecordSetting { number: 1, response_at: data.response_at, ..RecordSetting::default() },
            };
            let rounding = data.resolution.iter().zip(&data.values).map(|(bin, f)| bin / 12.0_f64.sqrt() / f).collect();
            let scatter = data.scatter.iter().zip(&data.values).map(|(std, f)| std / f).collect();
            let measured = data.values.clone();
            let model = NaturalFrequencies::new(&setting, measured.len())?;
            Ok(Some(FrequencyList { piece: measurement.piece, setting, model, measured, rounding, scatter }))
        };
        let lists = test.measurements.iter().filter_map(|measurement| list(measurement).transpose());
        Ok(Self { lists: lists.collect::<Result<_, IdentifyError>>()?, constants })
    }

    /// Without what the lists tell of their scatter.
    pub(super) fn unweighed(&self) -> Self {
        let mut alike = self.clone();
        alike.lists.iter_mut().for_each(|list| list.scatter.clear());
        alike
    }

    /// Number of frequencies.
    pub(super) fn count(&self) -> usize {
        self.lists.iter().map(|list| list.measured.len()).sum()
    }

    /// Every frequency that was measured \[Hz\], list by list.
    pub(super) fn listed(&self) -> Vec<f64> {
        self.lists.iter().flat_map(|list| list.measured.iter().copied()).collect()
    }

    /// The highest frequency \[Hz\].
    pub(super) fn top(&self) -> f64 {
        self.listed().into_iter().fold(0.0, f64::max)
    }

    /// Number of frequencies of the longest list.
    pub(super) fn longest(&self) -> usize {
        self.lists.iter().map(|list| list.measured.len()).max().unwrap_or(0)
    }

    /// Parameters of the constants where nothing else is known.
    pub(super) fn usual(&self) -> Vec<f64> {
        let usual = |i: usize| USUAL.get(self.constants.free[i].constant).copied().unwrap_or(USUAL[0]);
        (0..self.constants.count()).map(|i| self.constants.parameter(i, usual(i))).collect()
    }

    /// Number of pieces that have a list.
    pub(super) fn pieces(&self) -> usize {
        let mut pieces: Vec<usize> = self.lists.iter().map(|list| list.piece).collect();
        pieces.sort_unstable();
        pieces.dedup();
        pieces.len()
    }

    /// The piece that bounds are counted in.
    pub(super) fn largest_piece(&self) -> Piece {
        let largest = self.lists.iter().max_by(|a, b| a.setting.piece.mass().total_cmp(&b.setting.piece.mass()));
        largest.map_or(Piece { length: 1.0, width: 1.0, thickness: 1.0, mass_per_area: 1.0 }, |list| list.setting.piece)
    }

    /// $(f_{cal}-f_{exp})/f_{exp}$ of every frequency.
    pub(super) fn residuals(&self, parameters: &[f64], like: &Hypothesis) -> Result<Vec<f64>, ModelError> {
        let (constants, coordinates) = parameters.split_at(self.constants.count().min(parameters.len()));
        let states = like.at(coordinates).states()?;
        let mut residuals = Vec::with_capacity(self.count());
        for list in &self.lists {
            let values = self.constants.values(constants, list.piece);
            let found = list.model.at(&values, &states)?;
            if found.len() < list.measured.len() {
                return Err(ModelError::Eigenproblem);
            }
            residuals.extend(found.iter().zip(&list.measured).map(|(f, measured)| f / measured - 1.0));
        }
        Ok(residuals)
    }

    /// The same over their standard deviations, where the lists tell these.
    pub(super) fn weighed(&self, parameters: &[f64], like: &Hypothesis) -> Result<Vec<f64>, ModelError> {
        let residuals = self.residuals(parameters, like)?;
        Ok(match self.scatter() {
            Some(scatter) => residuals.iter().zip(scatter).map(|(residual, scatter)| residual / scatter).collect(),
            None => residuals,
        })
    }

    /// Relative standard deviation of every frequency, where every list tells it.
    pub(super) fn scatter(&self) -> Option<Vec<f64>> {
        let told: Vec<f64> = self.lists.iter().flat_map(|list| list.scatter.iter().copied()).collect();
        (!told.is_empty() && told.len() == self.count()).then_some(told)
    }

    /// Relative standard deviation of every frequency by its scatter or else by rounding to a bin, where every list tells one.
    pub(super) fn noise(&self) -> Option<Vec<f64>> {
        let of_list = |list: &FrequencyList| {
            if list.scatter.is_empty() { list.rounding.clone() } else { list.scatter.clone() }
        };
        let told: Vec<f64> = self.lists.iter().flat_map(of_list).collect();
        (!told.is_empty() && told.len() == self.count()).then_some(told)
    }
}
