//! What forces of the suspension take off the accelerances of one record, with its derivatives.

use num_complex::Complex64;
use orthopanel_model::{Damping, EffectState, ModelError, ReceptanceModel};

use super::{Ratios, Reactions, cubic};
use crate::tracing::record_problem::{Grouping, State};
use crate::tracing::rough::offsets;
use crate::tracing::widened_lines::WidenedLines;

/// The forces of a suspension at one state, in all records.
pub(in crate::tracing) struct ReactionLines {
    /// From every suspension point to the sensor.
    reach: ReceptanceModel,
    points: usize,
    ratios: Vec<Ratios>,
    /// Of $k_3$ among the derivatives.
    column: usize,
}

/// To be taken off the lines of one group of data.
#[derive(Clone)]
pub(in crate::tracing) struct Taken {
    /// One a line.
    pub value: Vec<Complex64>,
    /// For each line its derivatives, one for each column that was asked for.
    pub by: Vec<Vec<Complex64>>,
}

impl ReactionLines {
    /// On the lines of some records, each by its number. `None` where no such force is on, or the records cannot tell it.
    ///
    /// # Errors
    /// What the model refuses.
    pub(in crate::tracing) fn of(
        reactions: Option<&Reactions>,
        state: &State,
        (damping, effects): (&Damping, &[EffectState]),
        lines: &[(usize, &WidenedLines)],
    ) -> Result<Option<Self>, ModelError> {
        let first = state.constants.len() + state.zetas.len();
        let (Some(reactions), Some((k3, column))) = (reactions, cubic(&state.hypothesis, first)) else {
            return Ok(None);
        };
        let constants = state.constants.map(f64::exp);
        let mut ratios = vec![vec![]; lines.iter().map(|(index, _)| index + 1).max().unwrap_or(0)];
        let offsets = offsets(&state.hypothesis);
        let found = reactions.ratios((k3, offsets), &constants, (damping, effects), lines)?;
        for ((index, _), found) in lines.iter().zip(found) {
            ratios[*index] = found;
        }
        let (reach, points) = reactions.reach(&constants, damping, effects)?;
        Ok(Some(Self { reach, points, ratios, column }))
    }

    /// Of record `index`, for each group of its data: `columns` and factors are those of the derivatives that are asked for.
    pub(in crate::tracing) fn taken(
        &self,
        index: usize,
        record: &WidenedLines,
        grouping: Grouping,
        columns: &[(usize, f64)],
    ) -> Vec<Taken> {
        let Some(hits) = self.ratios.get(index) else { return vec![] };
        let lines = record.s.len();
        let none = Taken { value: vec![Complex64::ZERO; lines], by: vec![vec![Complex64::ZERO; columns.len()]; lines] };
        let groups: Vec<Vec<usize>> = match grouping {
            Grouping::Places => vec![(0..hits.len()).collect()],
            Grouping::Hits => (0..hits.len()).map(|hit| vec![hit]).collect(),
        };
        let mut taken = vec![none; groups.len()];
        for point in 0..self.points {
            let Some(mut evaluator) = self.reach.evaluator(index * self.points + point) else { continue };
            evaluator.lines(&record.s, |line, value, by| {
                for (group, taken) in groups.iter().zip(&mut taken) {
                    let [ratio, slope] = mean(hits, record, (group, point, line));
                    taken.value[line] += value * ratio;
                    for (entry, &(column, factor)) in taken.by[line].iter_mut().zip(columns) {
                        *entry += factor * if column == self.column { value * slope } else { by.of(column) * ratio };
                    }
                }
            });
        }
        taken
    }
}

/// The ratio and its derivative over some hits, weighed as the hits' own accelerances are.
fn mean(hits: &Ratios, record: &WidenedLines, (group, point, line): (&[usize], usize, usize)) -> [Complex64; 2] {
    let (mut sums, mut weights) = ([Complex64::ZERO; 2], 0.0);
    for &hit in group {
        let weight = record.hits.get(hit).map_or(0.0, |hit| hit.weight[line]);
        let [ratio, slope] = &hits[hit][point];
        sums[0] += weight * ratio[line];
        sums[1] += weight * slope[line];
        weights += weight;
    }
    sums.map(|sum| sum / weights)
}
