//! Measured modes of the Mindlin plate, told by their nodal lines.

use std::borrow::Borrow;
use std::sync::Arc;

use orthopanel_model::{
    Boundary, End, MindlinPlate, ModelError, Piece, ReducedStructure, RitzMode, Structure, modes_below, ritz_modes,
    ritz_modes_near,
};

use crate::IdentifyError;
use crate::structures::{MeasuredModes, Prediction, Solved, SpectrumLine, just_below};

/// Modes of a plate by their nodal lines.
#[derive(Debug)]
pub(super) struct PlateModes {
    plate: MindlinPlate,
    nodes: Vec<[usize; 2]>,
    /// Modes solved for: those measured lie among them.
    reach: usize,
    /// The plate in the parities of the measured modes alone, and the most modes solved for there.
    own: Arc<MindlinPlate>,
    own_reach: usize,
    /// The same on fewer polynomials.
    rough: MindlinPlate,
}

/// Modes solved for beyond those that lie below the last measured one if all pairs of nodes exist.
const SPARE_MODES: usize = 6;

impl PlateModes {
    pub(super) fn new(piece: &Piece, boundary: Boundary, nodes: Vec<[usize; 2]>) -> Result<Self, IdentifyError> {
        if let Some([x, y]) = nodes.iter().find(|nodes| is_rigid(boundary, **nodes)) {
            return Err(IdentifyError::Unsupported(format!(
                "shape [{x}, {y}] is a rigid motion of a plate with these edges and has no frequency: the lowest flexible \
                 modes of a free plate have the shapes [1, 1], [2, 0] and [0, 2]"
            )));
        }
        let [most_x, most_y] = [0, 1].map(|axis| nodes.iter().map(|pair| pair[axis]).max().unwrap_or(0));
        let terms = terms(piece, boundary, [most_x, most_y])?;
        if !MindlinPlate::can_have(boundary, terms) {
            let most = most_nodes(piece, boundary, [most_x, most_y])?;
            return Err(IdentifyError::ShapeBeyondBasis { nodes: [most_x, most_y], terms, most });
        }
        let plate = MindlinPlate::within_ellipse(piece, boundary, terms)?;
        let reach = ((most_x + 2) * (most_y + 3) + SPARE_MODES).min(plate.resolved_modes());
        let own = Arc::new(plate.only_with_nodes(&nodes));
        let share = reach * own.blocks().len() / plate.blocks().len();
        let own_reach = (share + SPARE_MODES).min(own.resolved_modes());
        let rough = own.with_fewer_terms([most_x, most_y].map(|most| most + ROUGH_SPARE));
        Ok(Self { plate, nodes, reach, own, own_reach, rough })
    }
}

/// Whether a plate moves so without strain: at most once turned, for with a turn both ways it twists.
fn is_rigid(Boundary { left, right, front, back }: Boundary, nodes: [usize; 2]) -> bool {
    let rigid = [[left, right], [front, back]].map(|ends| match ends {
        [End::Free, End::Free] => 2,
        [End::Free, End::Pinned] | [End::Pinned, End::Free] => 1,
        _ => 0,
    });
    let twists = nodes[0] + 1 == rigid[0] && nodes[1] + 1 == rigid[1];
    nodes[0] < rigid[0] && nodes[1] < rigid[1] && !twists
}

/// Most polynomials along a direction for a layer at a free edge: what is left then is 4e-4 of a twisting mode's frequency.
const MOST_FOR_LAYER: usize = 28;

/// Polynomials along x and y for modes of so many nodes, whatever the constants.
fn terms(piece: &Piece, boundary: Boundary, [most_x, most_y]: [usize; 2]) -> Result<[usize; 2], ModelError> {
    let layers = MindlinPlate::layer_terms(piece, boundary)?.map(|layer| layer.min(MOST_FOR_LAYER));
    let waves = MindlinPlate::terms_for_nodes(boundary, [most_x, most_y]);
    let least = [most_x + 11, (most_y + 6).max(7)];
    Ok([0, 1].map(|axis| least[axis].max(waves[axis]).max(layers[axis])))
}

/// The most nodes, in the proportion of these, for which a plate can be built.
fn most_nodes(piece: &Piece, boundary: Boundary, [x, y]: [usize; 2]) -> Result<[usize; 2], ModelError> {
    let longest = x.max(y);
    for length in (0..longest).rev() {
        let fewer = [x * length / longest, y * length / longest];
        if MindlinPlate::can_have(boundary, terms(piece, boundary, fewer)?) {
            return Ok(fewer);
        }
    }
    Ok([0, 0])
}

/// Polynomials beyond the number of nodes that hold a frequency to some per cent.
const ROUGH_SPARE: usize = 4;

/// Modes solved for at first beyond those measured.
const FIRST_SPARE: usize = 2;
/// Shapes beyond those measured that a solution of the whole plate begins with.
const NEAR_SPARE: usize = 8;

impl PlateModes {
    /// As many of the lowest modes as tell which the measured ones are.
    fn first_count(&self) -> usize {
        (self.nodes.len() + FIRST_SPARE).min(self.own_reach)
    }

    /// Which modes of a plate in the parities of the measured ones these are, and as many modes as tell it.
    fn told(
        &self,
        plate: &MindlinPlate,
        values: &[f64],
        known: &[RitzMode],
    ) -> Result<(Told, Vec<RitzMode>), ModelError> {
        let reach = self.own_reach.min(plate.resolved_modes());
        let mut count = self.first_count().min(reach);
        loop {
            let modes = ritz_modes_near(plate, values, count, known)?;
            let told = Told::of(plate, &self.nodes, modes.iter());
            if told.all_sure() || count == reach {
                return Ok((told, modes));
            }
            count = reach;
        }
    }
}

impl MeasuredModes for PlateModes {
    fn predict(&self, values: &[f64]) -> Result<Vec<Prediction>, ModelError> {
        Ok(self.solve(values, &[])?.predictions)
    }

    fn solve(&self, values: &[f64], known: &[RitzMode]) -> Result<Solved, ModelError> {
        let (told, mut shapes) = self.told(&self.own, values, known)?;
        let predictions = told.predictions(self.own.as_ref(), &shapes, values)?;
        // What predicts near here lies in the span of these shapes, so none that was told may be missing.
        let lowest = shapes.partition_point(|mode| mode.angular_frequency == 0.0) + self.first_count();
        shapes.truncate(told.highest().map_or(lowest, |highest| lowest.max(highest + 1 + FIRST_SPARE)));
        Ok(Solved { predictions, shapes })
    }

    fn rough_frequencies(&self, values: &[f64]) -> Result<Vec<f64>, ModelError> {
        let (told, modes) = self.told(&self.rough, values, &[])?;
        told.frequencies(&modes)
    }

    fn nodes(&self) -> &[[usize; 2]] {
        &self.nodes
    }

    fn near(&self, values: &[f64], shapes: &[RitzMode]) -> Result<Option<Box<dyn MeasuredModes>>, ModelError> {
        let reduced = ReducedStructure::on(Arc::clone(&self.own), values, shapes)?;
        let (plate, nodes) = (Arc::clone(&self.own), self.nodes.clone());
        Ok(Some(Box::new(NearbyModes { plate, reduced, nodes })))
    }

    fn numbers(&self, values: &[f64], frequencies: &[f64]) -> Result<Vec<usize>, ModelError> {
        let limits: Vec<f64> = frequencies.iter().map(|f| just_below(*f) * std::f64::consts::TAU).collect();
        Ok(modes_below(&self.plate, values, &limits)?.into_iter().map(|below| below + 1).collect())
    }

    fn spectrum(&self, values: &[f64]) -> Result<Vec<SpectrumLine>, ModelError> {
        let modes = ritz_modes(&self.plate, values, self.reach)?;
        let flexible = modes.iter().filter(|mode| mode.angular_frequency > 0.0);
        let line = |mode: &RitzMode| SpectrumLine {
            frequency: mode.angular_frequency / std::f64::consts::TAU,
            nodes: self.plate.mode_name(mode).nodes,
        };
        Ok(flexible.map(line).collect())
    }
}

/// The same modes near some values of the constants.
#[derive(Debug)]
struct NearbyModes {
    plate: Arc<MindlinPlate>,
    reduced: ReducedStructure<MindlinPlate>,
    nodes: Vec<[usize; 2]>,
}

impl MeasuredModes for NearbyModes {
    fn predict(&self, values: &[f64]) -> Result<Vec<Prediction>, ModelError> {
        let modes = self.reduced.modes(values)?;
        let told = Told::of(&self.plate, &self.nodes, modes.iter().map(|mode| self.reduced.in_whole(mode)));
        told.predictions(&self.reduced, &modes, values)
    }

    fn nodes(&self) -> &[[usize; 2]] {
        &self.nodes
    }

    fn shapes(&self, values: &[f64]) -> Result<Vec<RitzMode>, ModelError> {
        let modes = self.reduced.modes(values)?;
        let flexible = modes.iter().filter(|mode| mode.angular_frequency > 0.0);
        Ok(flexible.take(self.nodes.len() + NEAR_SPARE).map(|mode| self.reduced.in_whole(mode)).collect())
    }

    fn spectrum(&self, _: &[f64]) -> Result<Vec<SpectrumLine>, ModelError> {
        Ok(Vec::new())
    }
}

/// Which modes the measured ones are: of each pair of nodes the number of its mode and the overlap with it.
///
/// A mode whose own largest overlap is with the pair comes before one whose overlap with it is larger, but has another name:
/// where two modes veer, one may hold more of both products. No mode is two.
struct Told(Vec<Option<(usize, f64)>>);

/// Squares of a product's overlaps with all modes add up to one at most, and so do those of a mode with all products: beyond a
/// half there is no larger one.
const SURE_SHARE: f64 = 0.5;

/// A mode that may be the one of a pair of nodes.
struct Candidate {
    pair: usize,
    index: usize,
    overlap: f64,
    is_named: bool,
}

impl Told {
    /// From the plate's modes in rising order, rigid ones first, as far as it takes.
    fn of(plate: &MindlinPlate, nodes: &[[usize; 2]], modes: impl Iterator<Item = impl Borrow<RitzMode>>) -> Self {
        let mut sure = vec![None; nodes.len()];
        let mut candidates = Vec::new();
        for (index, mode) in modes.enumerate() {
            let mode = mode.borrow();
            if mode.angular_frequency == 0.0 {
                continue;
            }
            let overlaps = plate.overlaps(mode);
            let largest = overlaps.col_iter().flat_map(|column| column.iter()).copied().fold(0.0, f64::max);
            for (pair, &[x, y]) in nodes.iter().enumerate() {
                let overlap = if x < overlaps.nrows() && y < overlaps.ncols() { overlaps[(x, y)] } else { 0.0 };
                if overlap * overlap > SURE_SHARE {
                    sure[pair] = Some((index, overlap));
                }
                candidates.push(Candidate { pair, index, overlap, is_named: overlap > 0.0 && overlap == largest });
            }
            if sure.iter().all(Option::is_some) {
                return Self(sure);
            }
        }
        candidates.sort_by(|a, b| b.is_named.cmp(&a.is_named).then(b.overlap.total_cmp(&a.overlap)));
        let mut told = Self(vec![None; nodes.len()]);
        for Candidate { pair, index, overlap, .. } in candidates {
            let mut others = told.0.iter().zip(nodes).filter(|(_, other)| **other != nodes[pair]);
            let is_taken = others.any(|(other, _)| other.is_some_and(|(taken, _)| taken == index));
            if told.0[pair].is_none() && !is_taken {
                told.0[pair] = Some((index, overlap));
            }
        }
        told
    }

    /// The number of the highest mode that is one of the measured ones.
    fn highest(&self) -> Option<usize> {
        self.0.iter().flatten().map(|(index, _)| *index).max()
    }

    fn all_sure(&self) -> bool {
        self.0.iter().all(|nearest| nearest.is_some_and(|(_, overlap)| overlap * overlap > SURE_SHARE))
    }

    /// \[Hz\].
    fn frequencies(&self, modes: &[RitzMode]) -> Result<Vec<f64>, ModelError> {
        let frequency =
            |nearest: &Option<(usize, f64)>| Some(modes[(*nearest)?.0].angular_frequency / std::f64::consts::TAU);
        let frequencies: Option<Vec<f64>> = self.0.iter().map(frequency).collect();
        frequencies.ok_or(ModelError::BasisTooSmall { asked: self.0.len(), available: modes.len() })
    }

    /// `modes` are in the coordinates of `structure`.
    fn predictions(
        &self,
        structure: &dyn Structure,
        modes: &[RitzMode],
        values: &[f64],
    ) -> Result<Vec<Prediction>, ModelError> {
        let by_constants = structure.coefficient_derivatives(values)?;
        let prediction = |nearest: &Option<(usize, f64)>| {
            let (index, overlap) = (*nearest)?;
            let mode = &modes[index];
            let by_coefficient = mode.coefficient_sensitivity(structure);
            let twice_omega2 = 2.0 * mode.angular_frequency.powi(2);
            let by = |constant: usize| {
                let sum: f64 = by_coefficient.iter().enumerate().map(|(i, by)| by * by_constants[(i, constant)]).sum();
                sum / twice_omega2
            };
            let frequency = mode.angular_frequency / std::f64::consts::TAU;
            Some(Prediction { frequency, by_constant: (0..values.len()).map(by).collect(), share: overlap * overlap })
        };
        let predictions: Option<Vec<Prediction>> = self.0.iter().map(prediction).collect();
        predictions.ok_or(ModelError::BasisTooSmall { asked: self.0.len(), available: modes.len() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bending modes of a narrow plate lie far apart among those of their parity: of six of them the lowest
    /// eight do not hold the last.
    #[test]
    fn what_predicts_quickly_has_the_values_and_slopes_of_the_whole_where_it_is_made() {
        let piece = Piece { length: 0.8, width: 0.3, thickness: 0.03, mass_per_area: 6.88 };
        let nodes = (2..8).map(|x| [x, 0]).collect();
        let modes = PlateModes::new(&piece, Boundary::FREE, nodes).unwrap();
        let values = [1.07e10, 8.6e9, 0.34, 3.2e9, 2.6e8, 5.363e8];
        let whole = modes.solve(&values, &[]).unwrap();
        let quick = modes.near(&values, &whole.shapes).unwrap().unwrap().predict(&values).unwrap();
        for (whole, quick) in whole.predictions.iter().zip(&quick) {
            assert!((quick.frequency / whole.frequency - 1.0).abs() < 1e-9, "{quick:?}, {whole:?}");
            let slopes = whole.by_constant.iter().zip(&quick.by_constant).zip(values);
            slopes.for_each(|((whole, quick), value)| assert!((value * (quick - whole)).abs() < 1e-5));
        }
    }
}
