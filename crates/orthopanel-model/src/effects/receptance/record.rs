//! The effects of one record, sorted by what they do.

use crate::effects::row::Row;
use crate::effects::{Action, ChannelFactor, EffectSetting, EffectState, ElementLaw, Seat};
use crate::{ModelError, Motion};

/// What one record is made of, before any modes are known.
#[derive(Debug, Clone)]
pub(super) struct RecordPlan {
    /// Force, response, then the elements.
    pub rows: Vec<Row>,
    /// Joined elements.
    pub elements: Vec<ElementLaw>,
    /// Factors of the channel.
    pub factors: Vec<ChannelFactor>,
    /// $\tau$ of untold windows.
    pub windows: Vec<f64>,
    pub hit_time: f64,
}

impl RecordPlan {
    /// From the effects' actions in this record.
    pub(super) fn new(setting: &EffectSetting, effects: &[EffectState]) -> Result<Self, ModelError> {
        let record = &setting.record;
        let (Some(mut force), Some(mut response)) = (record.force_at, record.response_at) else {
            return Err(ModelError::Unsupported(format!("record {} without force_at and response_at", record.number)));
        };
        let (mut elements, mut factors, mut windows) = (vec![], vec![], vec![]);
        for effect in effects {
            for action in effect.acting_in(setting)? {
                match action {
                    Action::Element(element) => elements.push(element),
                    Action::Channel(factor) => factors.push(factor),
                    Action::Place(shift) if shift.of_response => response = response.moved(shift.offset),
                    Action::Place(shift) => force = force.moved(shift.offset),
                    Action::Window { tau } => windows.push(tau),
                    // Of the structure, the same in every record.
                    Action::Field(_) | Action::Core(_) | Action::Plate(_) | Action::Foot(_) => {}
                }
            }
        }
        let mut rows = Vec::new();
        for place in [force, response] {
            setting.piece.contains(place)?;
            rows.push((Motion::Deflection, place));
        }
        rows.extend(elements.iter().map(|element| {
            let place = match element.seat {
                Seat::At(place) | Seat::AlongEdge { middle: place, .. } => place,
                // It moves with the response.
                Seat::AtResponse => response,
            };
            (element.motion, place)
        }));
        let elements = elements.iter().map(|element| element.law).collect();
        Ok(Self { rows, elements, factors, windows, hit_time: record.hit_time })
    }
}
