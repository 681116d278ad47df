//! Where an effect's search in lists begins: the valleys of a grid that is fine along the piece.
//!
//! How much an attachment at $x$ shifts mode $n$ goes as $\phi_n^2(x)$, which has $n$ humps along a free piece: a start half a hump away
//! leads to another minimum.

use orthopanel_model::{EffectParameter, Piece};

use super::hypothesis::{Switched, is_place};

/// Starts along each hump of the highest listed mode.
const ON_A_HUMP: usize = 6;
/// Unit of what a resonator is tuned to: one of the listed frequencies is its own mode's, no further off than the modes beside it push it.
const TUNED_IN: &str = "Hz";
/// Relative difference of what two starts leave that are one another's mirror images: one of them is followed.
const MIRRORED: f64 = 1e-9;

/// Starting values of each parameter; a start takes one of each.
pub(super) struct StartGrid {
    lists: Vec<Vec<f64>>,
}

impl StartGrid {
    /// In lists of up to so many `modes` that hold the frequencies `listed` \[Hz\]; a parameter that is not free begins from one value.
    pub(super) fn of(on: &Switched, piece: &Piece, modes: usize, listed: &[f64]) -> Self {
        let list = |(index, parameter): (usize, &EffectParameter)| match parameter.held_at {
            Some(held) => vec![held],
            None if is_place(parameter) => along(parameter.range(piece), ON_A_HUMP * modes.max(1) + 1),
            None => {
                let mut starts = parameter.starts(piece);
                if on.free.iter().all(|free| free.at != index) {
                    starts.truncate(1);
                } else if parameter.unit == TUNED_IN {
                    starts.extend_from_slice(listed);
                }
                starts.sort_by(f64::total_cmp);
                starts.dedup();
                starts
            }
        };
        Self { lists: on.effect.parameters().iter().enumerate().map(list).collect() }
    }

    fn count(&self) -> usize {
        self.lists.iter().map(Vec::len).product()
    }

    /// Every start in turn, the last parameter fastest.
    pub(super) fn starts(&self) -> impl Iterator<Item = Vec<f64>> + '_ {
        (0..self.count()).map(|start| self.lists.iter().zip(self.places(start)).map(|(list, at)| list[at]).collect())
    }

    fn places(&self, start: usize) -> Vec<usize> {
        let strides = self.strides();
        self.lists.iter().zip(strides).map(|(list, stride)| start / stride % list.len()).collect()
    }

    /// By how much a start's number grows with one step of each parameter.
    fn strides(&self) -> Vec<usize> {
        (0..self.lists.len()).map(|of| self.lists[of + 1..].iter().map(Vec::len).product()).collect()
    }

    /// The starts that leave no more than those one step away, by what they leave, the least first; of mirror images one.
    pub(super) fn valleys(&self, left: &[f64]) -> Vec<usize> {
        let strides = self.strides();
        let is_valley = |start: &usize| {
            self.places(*start).iter().zip(&self.lists).zip(&strides).all(|((&at, list), &stride)| {
                (at == 0 || left[*start] <= left[start - stride])
                    && (at + 1 == list.len() || left[*start] <= left[start + stride])
            })
        };
        let mut valleys: Vec<usize> = (0..left.len()).filter(is_valley).collect();
        valleys.sort_by(|&a, &b| left[a].total_cmp(&left[b]));
        valleys.dedup_by(|later, kept| (left[*later] - left[*kept]).abs() <= MIRRORED * left[*kept]);
        valleys
    }
}

/// Places from one end to the other, so many steps; with an odd number none lies in the middle, where by symmetry no frequency tells which
/// way to go.
pub(super) fn along((low, high): (f64, f64), steps: usize) -> Vec<f64> {
    (0..=steps).map(|step| low + (high - low) * step as f64 / steps as f64).collect()
}

#[cfg(test)]
mod tests {
    use orthopanel_model::effect;

    use super::*;

    #[test]
    fn valleys_of_the_grid_are_followed_once_each() {
        let piece = Piece { length: 0.8, width: 0.1, thickness: 0.03, mass_per_area: 6.88 };
        let on = Switched::new(effect("local-mass").unwrap(), &piece, |_| None, |_| false);
        let grid = StartGrid::of(&on, &piece, 10, &[]);
        let starts: Vec<Vec<f64>> = grid.starts().collect();
        assert_eq!(starts.len(), 3 * 62);
        assert!(starts.iter().all(|start| start[1].abs() <= 0.4));
        // Two valleys of different depth, each with its image on the other side of the middle.
        let left: Vec<f64> = starts
            .iter()
            .map(|start| {
                (start[0] - 0.0055).powi(2) + (start[1].abs() - 0.1).abs().min(0.01 + (start[1].abs() - 0.3).abs())
            })
            .collect();
        let valleys = grid.valleys(&left);
        let at: Vec<f64> = valleys.iter().map(|&start| starts[start][1].abs()).collect();
        assert_eq!(at.len(), 2, "{at:?}");
        assert!((at[0] - 0.1).abs() < 0.007 && (at[1] - 0.3).abs() < 0.007, "{at:?}");
    }
}
