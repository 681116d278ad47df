//! All measured modes of a test, stacked: lists, accelerances and hits, of one piece or of several.

use std::ops::Range;

use faer::Mat;
use orthopanel_model::{Effect, EffectState, ModelError, Owner, StructureKind};

use crate::comparison::Comparison;
use crate::effect_places::has_place;
use crate::hypothesis::Hypothesis;
use crate::model_error::{ErrorColumns, Waves};
use crate::predicted::{Prediction, Predictor};
use crate::whitening::Split;

/// The measured modes of one list, or of the records of one piece, and what predicts them.
pub(crate) struct Block<'a> {
    pub piece: usize,
    /// Whether it is a list of a piece that was not hit beside the records of one that was: an effect at a place is on the latter.
    pub is_of_other: bool,
    pub predictor: Predictor<'a>,
    /// What unevenness does, of [`crate::model_error::waves`].
    pub waves: Waves,
}

impl<'a> Block<'a> {
    pub(crate) fn comparison(&self) -> &'a Comparison<'a> {
        self.predictor.comparison
    }

    /// Constants of the block's piece, and the effects.
    pub(crate) fn values(
        &self,
        hypothesis: &Hypothesis,
        z: &[f64],
    ) -> Result<(Vec<f64>, Vec<EffectState>), ModelError> {
        let records = self.comparison().measured.records.len();
        let acts = |effect: &dyn Effect| {
            (records > 0 || effect.owner() != Owner::Channel) && !(self.is_of_other && has_place(effect))
        };
        Ok((hypothesis.constants_of(self.piece, z), hypothesis.effects(z, records, acts)?))
    }
}

/// Blocks below each other, one at least; the records, if there are any, stand first.
pub(crate) struct Stacked<'a> {
    pub blocks: Vec<Block<'a>>,
    /// Covariance of the noise of all.
    noise: Mat<f64>,
    split: Option<Split>,
}

/// What a hypothesis predicts of every block.
pub(crate) struct Predictions {
    pub blocks: Vec<Prediction>,
    /// Of all blocks, one after the other.
    pub values: Vec<f64>,
}

impl Predictions {
    /// Of the records, where there are any.
    pub(crate) fn first(&self) -> &Prediction {
        &self.blocks[0]
    }

    /// Whether the same poles are motions of a piece as a whole.
    pub(crate) fn hangs_as(&self, other: &Self) -> bool {
        self.blocks.iter().zip(&other.blocks).all(|(own, other)| own.hangs == other.hangs)
    }

    /// Whether every pole has the same mode for its partner.
    pub(crate) fn pairs_as(&self, other: &Self) -> bool {
        self.blocks.iter().zip(&other.blocks).all(|(own, other)| own.flexible_of_poles == other.flexible_of_poles)
    }
}

impl<'a> Stacked<'a> {
    pub(crate) fn new(blocks: Vec<Block<'a>>) -> Self {
        let split = if blocks.len() == 1 { blocks[0].comparison().split() } else { None };
        let mut stacked = Self { blocks, noise: Mat::new(), split };
        let ranges: Vec<Range<usize>> = stacked.ranges().collect();
        let size = ranges.last().map_or(0, |range| range.end);
        stacked.noise = Mat::zeros(size, size);
        for (range, block) in ranges.iter().zip(&stacked.blocks) {
            let size = range.len();
            stacked.noise.submatrix_mut(range.start, range.start, size, size).copy_from(&block.comparison().noise);
        }
        stacked
    }

    /// The records, where there are any.
    pub(crate) fn first(&self) -> &Block<'a> {
        &self.blocks[0]
    }

    /// Whether the pieces are plates.
    pub(crate) fn is_of_plates(&self) -> bool {
        self.first().predictor.structure == StructureKind::MindlinPlate
    }

    /// The blocks of records, each with its number.
    pub(crate) fn recorded(&self) -> impl Iterator<Item = (usize, &Block<'a>)> {
        self.blocks.iter().enumerate().filter(|(_, block)| !block.comparison().measured.records.is_empty())
    }

    /// Of each piece that was hit the first block of its records, with its number.
    pub(crate) fn hit(&self) -> impl Iterator<Item = (usize, &Block<'a>)> {
        let is_first =
            |(number, block): &(usize, &Block)| self.blocks[..*number].iter().all(|before| before.piece != block.piece);
        self.recorded().filter(is_first)
    }

    /// Whether more than one piece was hit.
    pub(crate) fn is_of_several_pieces(&self) -> bool {
        self.hit().nth(1).is_some()
    }

    /// The block with the most poles.
    pub(crate) fn longest(&self) -> &Block<'a> {
        let poles = |block: &&Block| block.comparison().measured.poles.len();
        self.blocks.iter().rev().max_by_key(poles).unwrap_or(&self.blocks[0])
    }

    pub(crate) fn noise(&self) -> &Mat<f64> {
        &self.noise
    }

    /// How the covariance is split, of many values of one block.
    pub(crate) fn split(&self) -> Option<&Split> {
        self.split.as_ref()
    }

    /// The rows of each block.
    pub(crate) fn ranges(&self) -> impl Iterator<Item = Range<usize>> {
        let mut from = 0;
        self.blocks.iter().map(move |block| {
            let range = from..from + block.comparison().size();
            from = range.end;
            range
        })
    }

    /// # Errors
    /// As [`Predictor::at`].
    pub(crate) fn at(&self, hypothesis: &Hypothesis, z: &[f64]) -> Result<Predictions, ModelError> {
        let of_block = |block: &Block| {
            let (constants, effects) = block.values(hypothesis, z)?;
            block.predictor.at(&constants, &effects, true)
        };
        let blocks = self.blocks.iter().map(of_block).collect::<Result<Vec<_>, ModelError>>()?;
        let values = blocks.iter().flat_map(|block| block.values.iter().copied()).collect();
        Ok(Predictions { blocks, values })
    }

    /// What is measured less what is predicted.
    pub(crate) fn missed(&self, at: &Predictions) -> Vec<f64> {
        let measured = self.blocks.iter().flat_map(|block| &block.comparison().values);
        measured.zip(&at.values).map(|(measured, predicted)| measured - predicted).collect()
    }

    pub(crate) fn errors(&self, at: &Predictions) -> ErrorColumns {
        let about =
            |(block, at): (&Block, &Prediction)| (block.piece, ErrorColumns::about(&block.predictor, at, &block.waves));
        ErrorColumns::stacked(self.blocks.iter().zip(&at.blocks).map(about).collect())
    }
}
