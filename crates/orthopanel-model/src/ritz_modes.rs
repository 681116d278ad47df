//! Modes of any [`Structure`]: one symmetric eigenproblem a block, the blocks side by side.

use crate::block_krylov::{BlockKrylov, lowest_modes_near};
use crate::block_pencil::{BlockPencil, Eigenpair};
use crate::order::{sort, sorted_modes};
use crate::structure::{Block, RitzMode, Structure};
use crate::{Constant, ModelError, side_by_side};

/// The rigid modes, then the first `count` flexible ones in rising order, at these values of the constants.
///
/// Small blocks are solved whole, large ones for their lowest modes alone. Then a count of negative pivots between the
/// last mode and the next proves that none is missing; a block where one is, is solved whole.
///
/// # Errors
/// [`ModelError::Constant`] for a value outside its bounds, what [`Structure::coefficients`] refuses,
/// [`ModelError::BasisTooSmall`] where `count` is more than the basis resolves, [`ModelError::Eigenproblem`] where the
/// stiffness is not positive.
pub fn ritz_modes(structure: &dyn Structure, values: &[f64], count: usize) -> Result<Vec<RitzMode>, ModelError> {
    let available = structure.resolved_modes();
    if count > available {
        return Err(ModelError::BasisTooSmall { asked: count, available });
    }
    let coefficients = checked_coefficients(structure, values)?;
    let blocks = structure.blocks();
    // Blocks share the modes evenly but for a few.
    let wanted = count.div_ceil(blocks.len().max(1));
    let solve = |block| SolvedBlock::new(BlockPencil::new(block, &coefficients)?, wanted);
    let mut solved: Vec<SolvedBlock> = side_by_side::map(blocks, solve).into_iter().collect::<Result<_, _>>()?;
    let limit = loop {
        let limit = limit_above(&solved, count);
        if solved.iter().all(|block| block.knows_below(limit)) {
            break limit;
        }
        side_by_side::try_each(&mut solved, |block| block.solve_below(limit))?;
    };
    side_by_side::try_each(&mut solved, |block| block.prove_below(limit))?;

    let mut modes = flexible(solved.into_iter().map(|block| block.modes(count)));
    modes.truncate(count);
    Ok(rigid(blocks).chain(modes).collect())
}

/// The modes of [`ritz_modes`], sooner where `near` has nearly these and some more of each block: such as those of a
/// [`ReducedStructure`](crate::ReducedStructure) at the same values. Frequencies are exact to rounding, shapes to some 1e-6.
///
/// # Errors
/// As [`ritz_modes`].
pub fn ritz_modes_near(
    structure: &dyn Structure,
    values: &[f64],
    count: usize,
    near: &[RitzMode],
) -> Result<Vec<RitzMode>, ModelError> {
    let mut near: Vec<&RitzMode> = near.iter().filter(|mode| mode.angular_frequency > 0.0).collect();
    near.sort_by(|a, b| a.angular_frequency.total_cmp(&b.angular_frequency));
    if count > 0 && count < near.len() && near.iter().all(|mode| fits(structure, mode)) {
        let coefficients = checked_coefficients(structure, values)?;
        if let Some(modes) = proven_near(structure.blocks(), &coefficients, count, &near)? {
            return Ok(rigid(structure.blocks()).chain(modes).collect());
        }
    }
    ritz_modes(structure, values, count)
}

fn fits(structure: &dyn Structure, mode: &RitzMode) -> bool {
    structure.blocks().get(mode.block).is_some_and(|block| block.size() == mode.coordinates.len())
}

/// The first `count` flexible modes, each block's as many as `near` has among them; `None` where the count of negative
/// pivots says that these are not the lowest.
fn proven_near(
    blocks: &[Block],
    coefficients: &[f64],
    count: usize,
    near: &[&RitzMode],
) -> Result<Option<Vec<RitzMode>>, ModelError> {
    let numbered: Vec<(usize, &Block)> = blocks.iter().enumerate().collect();
    let solved = side_by_side::map(&numbered, |&(index, block)| {
        let pencil = BlockPencil::new(block, coefficients)?;
        let wanted = near[..count].iter().filter(|mode| mode.block == index).count();
        let own = near.iter().filter(|mode| mode.block == index);
        let shapes: Vec<&[f64]> = own.map(|mode| &mode.coordinates[..]).collect();
        Ok(lowest_modes_near(&pencil, wanted, &shapes).map(|modes| (pencil, modes)))
    });
    let solved: Vec<Option<(BlockPencil, Vec<Eigenpair>)>> = solved.into_iter().collect::<Result<_, ModelError>>()?;
    let Some(solved) = solved.into_iter().collect::<Option<Vec<_>>>() else { return Ok(None) };
    let last = solved.iter().flat_map(|(_, modes)| modes.iter().map(|mode| mode.0)).fold(0.0, f64::max);
    let limit = last * (1.0 + CLOSE);
    let proven = side_by_side::map(&solved, |(pencil, modes)| {
        pencil.count_below(limit) == Some(modes.len() + pencil.rigid_count())
    });
    let all = proven.into_iter().all(|proven| proven);
    Ok(all.then(|| flexible(solved.into_iter().map(|(_, modes)| modes))))
}

/// Modes whose squares of frequencies differ by a smaller part are counted together: between them a pivot nearly vanishes.
const CLOSE: f64 = 1e-6;

/// The rigid modes, then as many flexible ones as the basis has coordinates left, rising.
pub(crate) fn all_ritz_modes(structure: &dyn Structure, values: &[f64]) -> Result<Vec<RitzMode>, ModelError> {
    let coefficients = checked_coefficients(structure, values)?;
    let blocks = structure.blocks();
    let solve = |block| BlockPencil::new(block, &coefficients)?.all_modes();
    let solved: Vec<Vec<Eigenpair>> =
        side_by_side::map(blocks, solve).into_iter().collect::<Result<_, ModelError>>()?;
    Ok(rigid(blocks).chain(flexible(solved.into_iter())).collect())
}

/// How many flexible modes lie below each of these angular frequencies \[rad/s\], by counts of negative pivots alone.
///
/// # Errors
/// As [`ritz_modes`].
pub fn modes_below(
    structure: &dyn Structure,
    values: &[f64],
    angular_frequencies: &[f64],
) -> Result<Vec<usize>, ModelError> {
    let coefficients = checked_coefficients(structure, values)?;
    let count = |block| -> Result<Vec<usize>, ModelError> {
        let pencil = BlockPencil::new(block, &coefficients)?;
        let below = |omega: &f64| match pencil.count_below(omega * omega) {
            Some(count) => Ok(count.saturating_sub(pencil.rigid_count())),
            None => Ok(pencil.all_modes()?.iter().filter(|mode| mode.0 < omega * omega).count()),
        };
        angular_frequencies.iter().map(below).collect()
    };
    let mut sums = vec![0; angular_frequencies.len()];
    for counts in side_by_side::map(structure.blocks(), count) {
        sums.iter_mut().zip(counts?).for_each(|(sum, count)| *sum += count);
    }
    Ok(sums)
}

/// Modes that coincide in one block are looked for up to so many.
const COINCIDENT: usize = 4;

/// The modes known of one block.
struct SolvedBlock<'a> {
    pencil: BlockPencil<'a>,
    known: Known,
}

/// The lowest flexible modes, or all of them.
enum Known {
    Lowest(Box<BlockKrylov>),
    All(Vec<Eigenpair>),
}

impl<'a> SolvedBlock<'a> {
    fn new(pencil: BlockPencil<'a>, wanted: usize) -> Result<Self, ModelError> {
        let known = Known::Lowest(Box::new(BlockKrylov::new(&pencil, 1)));
        let mut block = Self { pencil, known };
        block.solve(wanted)?;
        Ok(block)
    }

    fn solve(&mut self, wanted: usize) -> Result<(), ModelError> {
        if let Known::Lowest(krylov) = &mut self.known
            && !krylov.grow(&self.pencil, wanted)
        {
            self.known = Known::All(self.pencil.all_modes()?);
        }
        Ok(())
    }

    /// Rising; of modes that have not converged from above.
    fn omega2s(&self) -> Vec<f64> {
        match &self.known {
            Known::Lowest(krylov) => krylov.omega2s(&self.pencil).collect(),
            Known::All(modes) => modes.iter().map(|mode| mode.0).collect(),
        }
    }

    fn count_below(&self, limit: f64) -> usize {
        self.omega2s().iter().filter(|omega2| **omega2 < limit).count()
    }

    fn knows_below(&self, limit: f64) -> bool {
        match &self.known {
            Known::Lowest(krylov) => self.count_below(limit) <= krylov.converged(),
            Known::All(_) => true,
        }
    }

    fn solve_below(&mut self, limit: f64) -> Result<(), ModelError> {
        self.solve(self.count_below(limit))
    }

    /// Makes sure that no mode with $\omega^2$ below `limit` is missing.
    fn prove_below(&mut self, limit: f64) -> Result<(), ModelError> {
        if matches!(self.known, Known::All(_)) {
            return Ok(());
        }
        let below = self.pencil.count_below(limit).and_then(|count| count.checked_sub(self.pencil.rigid_count()));
        if below != Some(self.known_below(limit)) {
            self.known = match below.and_then(|count| self.known_from_more(count, limit)) {
                Some(krylov) => Known::Lowest(Box::new(krylov)),
                None => Known::All(self.pencil.all_modes()?),
            };
        }
        Ok(())
    }

    /// One vector finds one of two modes that coincide; this finds `count` modes below `limit` from several.
    fn known_from_more(&self, count: usize, limit: f64) -> Option<BlockKrylov> {
        let mut krylov = BlockKrylov::new(&self.pencil, COINCIDENT);
        let all = krylov.grow(&self.pencil, count) && krylov.known_below(&self.pencil, limit) == count;
        all.then_some(krylov)
    }

    fn known_below(&self, limit: f64) -> usize {
        match &self.known {
            Known::Lowest(krylov) => krylov.known_below(&self.pencil, limit),
            Known::All(_) => self.count_below(limit),
        }
    }

    fn modes(self, most: usize) -> Vec<Eigenpair> {
        match self.known {
            Known::Lowest(krylov) => krylov.modes(&self.pencil, most),
            Known::All(modes) => modes,
        }
    }
}

/// An $\omega^2$ between the mode of number `count` and the next that clearly lies above it.
fn limit_above(solved: &[SolvedBlock], count: usize) -> f64 {
    let mut all: Vec<f64> = solved.iter().flat_map(SolvedBlock::omega2s).collect();
    sort(&mut all);
    let last = count.checked_sub(1).and_then(|index| all.get(index)).copied().unwrap_or(0.0);
    let clear = all.iter().find(|&&omega2| omega2 > last * (1.0 + CLOSE));
    clear.map_or(last * (1.0 + CLOSE), |next| 0.5 * (last + next))
}

/// The coefficients at these values, which must lie inside their bounds.
pub(crate) fn checked_coefficients(structure: &dyn Structure, values: &[f64]) -> Result<Vec<f64>, ModelError> {
    check_constants(structure.constants(), values)?;
    structure.coefficients(values)
}

fn check_constants(constants: &[Constant], values: &[f64]) -> Result<(), ModelError> {
    if constants.len() != values.len() {
        return Err(ModelError::ConstantCount { found: values.len(), expected: constants.len() });
    }
    constants.iter().zip(values).try_for_each(|(constant, &value)| constant.check(value))
}

fn rigid(blocks: &[Block]) -> impl Iterator<Item = RitzMode> {
    blocks.iter().enumerate().flat_map(|(block, matrices)| {
        matrices.rigid.iter().map(move |coordinates| RitzMode {
            angular_frequency: 0.0,
            block,
            coordinates: coordinates.clone(),
        })
    })
}

/// The modes of all blocks, rising; those that coincide in the order of their blocks.
fn flexible(solved: impl Iterator<Item = Vec<Eigenpair>>) -> Vec<RitzMode> {
    let of_block = |(block, modes): (usize, Vec<Eigenpair>)| {
        modes.into_iter().map(move |(omega2, coordinates)| RitzMode {
            angular_frequency: omega2.sqrt(),
            block,
            coordinates,
        })
    };
    sorted_modes(solved.enumerate().flat_map(of_block).collect(), |mode| mode.angular_frequency)
}

#[cfg(test)]
mod tests {
    use faer::Mat;

    use super::*;
    use crate::Place;

    /// Springs side by side, every two or three of them alike.
    struct Springs {
        blocks: Vec<Block>,
    }

    impl Structure for Springs {
        fn constants(&self) -> &'static [Constant] {
            &[Constant { name: "k", unit: "N/m", low: 0.1, high: 10.0 }]
        }

        fn coefficients(&self, values: &[f64]) -> Result<Vec<f64>, ModelError> {
            Ok(values.to_vec())
        }

        fn coefficient_derivatives(&self, _values: &[f64]) -> Result<Mat<f64>, ModelError> {
            Ok(Mat::identity(1, 1))
        }

        fn blocks(&self) -> &[Block] {
            &self.blocks
        }

        fn shape_row(&self, _block: usize, _place: Place) -> Vec<f64> {
            vec![0.0; 150]
        }
    }

    /// The space of one vector holds one mode of each group: the count tells the others.
    #[test]
    fn val_modes_that_coincide_in_a_block_are_all_found() {
        for alike in [2, 3, 7] {
            let stiffness = |i: usize| ((1 + i / alike) as f64).powi(3);
            let matrix = Mat::from_fn(150, 150, |i, j| if i == j { stiffness(i) } else { 0.0 });
            let mass = Mat::<f64>::identity(150, 150);
            let blocks = vec![Block { stiffness: vec![matrix.into()], mass: mass.into(), rigid: vec![] }];
            let modes = ritz_modes(&Springs { blocks }, &[2.0], 9).unwrap();
            for (i, mode) in modes.iter().enumerate() {
                let expected = 2.0 * stiffness(i);
                assert!((mode.angular_frequency.powi(2) / expected - 1.0).abs() < 1e-10, "{alike}, mode {i}");
                for other in &modes[..i] {
                    let both: f64 = mode.coordinates.iter().zip(&other.coordinates).map(|(a, b)| a * b).sum();
                    assert!(both.abs() < 1e-7, "{alike}: {both:e}");
                }
            }
            assert_eq!(modes.len(), 9);
        }
    }
}
