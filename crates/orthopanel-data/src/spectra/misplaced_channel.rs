//! A channel that is missing or stands twice.

use orthopanel_model::Readable;

use super::hit::Hit;
use crate::{DataError, Location};

/// Part of a channel's greatest value within which two channels are the same: last digits of single precision.
const SAME: f64 = 1e-6;

/// Where a record stands, and whether it is a force.
pub(super) type Ordered = (Box<Location>, bool);

/// Refuses records that are neither pairs nor two blocks: behind a missing and a doubled one, all would be paired wrongly.
/// `order` is that of the file, with as many forces as accelerations.
pub(super) fn check_order(order: &[Ordered]) -> Result<(), DataError> {
    let one_kind = |block: &[Ordered]| block.iter().all(|record| Some(record.1) == block.first().map(|first| first.1));
    let (first, second) = order.split_at(order.len() / 2);
    let broken = order.chunks(2).position(|pair| matches!(pair, [a, b] if a.1 == b.1));
    let (Some(hit), false) = (broken, one_kind(first) && one_kind(second)) else { return Ok(()) };
    let Some((at, is_force)) = order.get(2 * hit + 1) else { return Ok(()) };
    let (twice, missing) = if *is_force { ("force", "acceleration") } else { ("acceleration", "force") };
    let problem = format!(
        "a second {twice} where the {missing} of hit {} is due, though there are as many of either: one record is missing and \
         another one too many; give force and acceleration of hit after hit, or all of the one, then all of the other",
        hit + 1
    );
    Err(DataError::Channels { at: at.clone(), problem })
}

/// Where numbers of forces and accelerations differ: names the first record that has no partner, in pairs or in two blocks;
/// `first` is the file's first record.
pub(super) fn alone(order: &[Ordered], problem: String, first: Box<Location>) -> DataError {
    let changes = order.windows(2).filter(|pair| pair[0].1 != pair[1].1).count();
    let index = if changes <= 1 && order.len() > 3 {
        let one = order.iter().take_while(|record| record.1 == order[0].1).count();
        let other = order.len() - one;
        if one > other { other } else { 2 * one }
    } else {
        order.chunks(2).take_while(|pair| matches!(pair, [a, b] if a.1 != b.1)).count() * 2
    };
    let Some((at, is_force)) = order.get(index) else { return DataError::Channels { at: first, problem } };
    let (own, other) = if *is_force { ("force", "acceleration") } else { ("acceleration", "force") };
    DataError::Channels { at: at.clone(), problem: format!("{problem}; this {own} has no {other}") }
}

/// Refuses a hit whose acceleration is its force, but for a factor; `at` is where the acceleration stands.
pub(super) fn check_apart(hit: &Hit, at: Box<Location>) -> Result<(), DataError> {
    let pairs = || hit.force.iter().zip(&hit.acceleration);
    let greatest = pairs().max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
    let Some((&force, &motion)) = greatest.filter(|(force, motion)| **force != 0.0 && **motion != 0.0) else {
        return Ok(());
    };
    let factor = motion / force;
    let near = SAME * motion.abs();
    if pairs().any(|(force, motion)| (motion - factor * force).abs() > near) {
        return Ok(());
    }
    let problem = format!(
        "the acceleration is the force times {:.6}, sample for sample: one channel stands twice, and the other is missing",
        Readable(factor)
    );
    Err(DataError::Channels { at, problem })
}
