//! The effects of one record, sorted by what they do.

use super::coupling::Columns;
use super::modal_base::Row;
use crate::effects::{Action, ChannelFactor, EffectSetting, EffectState, PointElement, Seat};
use crate::{ModelError, Motion, Place};

/// What one record is made of, before any modes are known.
#[derive(Debug, Clone, Default)]
pub(super) struct RecordPlan {
    /// Rows that take part: force, response, elements.
    pub active: Vec<Row>,
    /// Rows whose place moves with a parameter.
    pub slopes: Vec<Row>,
    /// Joined elements.
    pub elements: Vec<PointElement>,
    /// Factors of the channel, with the column of each number.
    pub factors: Vec<(ChannelFactor, Vec<usize>)>,
    /// $1/\tau$ of untold windows: $\tau$ and its column.
    pub windows: Vec<(f64, usize)>,
    pub hit_time: f64,
    pub columns: Columns,
}

impl RecordPlan {
    /// From the effects' actions in this record; `first` is the column of the first effect's first parameter.
    pub(super) fn new(setting: &EffectSetting, effects: &[EffectState], first: usize) -> Result<Self, ModelError> {
        let record = &setting.record;
        let (Some(force), Some(response)) = (record.force_at, record.response_at) else {
            return Err(ModelError::Unsupported(format!("record {} without force_at and response_at", record.number)));
        };
        let mut plan = Self { hit_time: record.hit_time, ..Self::default() };
        // Shifts first: what sits at the response moves with it.
        let mut places = [force, response];
        let mut moved: [Vec<usize>; 2] = Default::default();
        let mut elements = Vec::new();
        for (effect, start) in effects.iter().zip(EffectState::starts(effects, first)) {
            let column = |parameter: usize| start + effect.position(parameter, record.number);
            for action in effect.effect.act(&effect.values_in(record.number)?, setting)? {
                match action {
                    Action::Element(element) => {
                        let columns = element.shares.iter().map(|share| column(share.parameter)).collect();
                        let place =
                            if let Seat::Free(_, parameter) = element.seat { Some(column(parameter)) } else { None };
                        elements.push((element, columns, place));
                    }
                    Action::Channel(factor, numbers) => {
                        plan.factors.push((factor, numbers.into_iter().map(column).collect()));
                    }
                    Action::Place(shift) => {
                        let side = usize::from(shift.of_response);
                        places[side].x += shift.offset;
                        moved[side].push(column(shift.parameter));
                    }
                    Action::Window { tau, parameter } => plan.windows.push((tau, column(parameter))),
                    // Of the structure, the same in every record.
                    Action::Field(..) | Action::Core(_) | Action::Plate(_) => {}
                }
            }
        }
        plan.columns.frequency = !plan.windows.is_empty();
        for place in places {
            setting.piece.contains(place)?;
            plan.active.push((Motion::Deflection, place));
        }
        for (side, columns) in moved.iter().enumerate() {
            columns.iter().for_each(|&column| plan.moves(side, column));
        }
        for (element, columns, place) in elements {
            plan.join(element, columns, place, places[1], &moved[1]);
        }
        Ok(plan)
    }

    fn moves(&mut self, row: usize, column: usize) {
        let (motion, place) = self.active[row];
        self.slopes.push((motion.by_place(), place));
        self.columns.places.push((row, column));
    }

    fn join(
        &mut self,
        element: PointElement,
        columns: Vec<usize>,
        place: Option<usize>,
        response: Place,
        moved: &[usize],
    ) {
        let at = match element.seat {
            Seat::At(place) | Seat::Free(place, _) | Seat::AlongEdge(place) => place,
            Seat::AtResponse => response,
        };
        let (row, number) = (self.active.len(), self.elements.len());
        self.active.push((element.motion, at));
        if element.seat == Seat::AtResponse {
            moved.iter().for_each(|&column| self.moves(row, column));
        }
        if let Some(column) = place {
            self.moves(row, column);
        }
        let shares = element.shares.iter().zip(columns);
        self.columns.elements.extend(shares.map(|(share, column)| (number, share.number, column, share.factor)));
        self.elements.push(element);
    }
}
