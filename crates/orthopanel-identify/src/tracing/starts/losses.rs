//! Where a closer search for a face off the core begins: spans with which the modes lie nearest to the poles.
//!
//! Lines between the poles call a search to such a span from beside it alone, and each place costs a fit of its own. Frequencies
//! call from further off, and cost a hundredth of that.

use argmin::core::{Executor, State as _};
use argmin::solver::neldermead::NelderMead;
use faer::Mat;
use faer::linalg::solvers::SolveLstsq;
use orthopanel_model::{
    BeamTerms, Boundary, Effect, ModelError, Piece, ReceptanceSetup, ShearLoss, TimoshenkoBeam, ritz_modes,
};
use rayon::prelude::*;

use super::plates_by_poles::Charge;
use crate::IdentifyError;
use crate::accelerance_fit::own_modes;
use crate::tracing::hypothesis::Switched;
use crate::tracing::record_problem::State;

/// The effect.
pub(super) const LOSS: &str = "stiffness-loss";
/// A pole further than this from every mode of the base belongs to none, in parts of its frequency.
const REACH: f64 = 0.08;
/// Poles at least: three numbers of a span, two constants, and one to judge by.
const LEAST_POLES: usize = 6;
/// Losses tried, and spans in lengths of the piece.
const LOSSES: [f64; 3] = [-0.2, 0.25, 0.6];
const SPANS: [f64; 3] = [0.04, 0.1, 0.25];
/// Places tried along the piece, which are not its middle, where one half is the other's image.
const PLACES: usize = 24;
/// Spans that are brought nearer; edge of the first simplex, in lengths for the place and in logarithms for the span and what is left
/// of the stiffness; and its steps.
const BROUGHT: usize = 12;
const PLACE_EDGE: f64 = 0.03;
const LOGARITHM_EDGE: f64 = 0.3;
const STEPS: u64 = 60;
/// Spans no further apart than this part of the length, in place and in span, and whose losses differ by no more than it, are one.
const ALIKE: f64 = 0.02;
/// Spans that are handed on, their images on the other half besides.
const STARTS: usize = 6;
/// Sums of squares up to which one more span is handed on, over the least and what poles tell at best.
const FURTHER: f64 = 100.0;
const TOLD: f64 = 1e-8;
/// Terms of the basis beyond two a mode: edges inside the beam bring their own.
const MORE_TERMS: usize = 8;
/// What a constant is moved by for its derivative.
const STEP: f64 = 1e-4;

/// What tells where to begin.
pub(super) struct LossStarts<'a> {
    /// Resonances \[Hz\], rising.
    pub poles: &'a [f64],
    /// $E_x$, $G_{zx}$ where they are declared.
    pub held: &'a [Option<f64>; 2],
    pub setup: &'a ReceptanceSetup,
    pub boundary: Boundary,
    pub piece: &'a Piece,
}

impl LossStarts<'_> {
    /// `base` with losses with which its modes lie nearest to the poles, the nearest first; none where too few poles tell.
    ///
    /// # Errors
    /// What the model refuses.
    pub(super) fn found(
        &self,
        base: &State,
        effect: &'static dyn Effect,
        records: usize,
    ) -> Result<Vec<State>, IdentifyError> {
        let values = base.constants.map(f64::exp);
        let modes = self.setup.summed_frequencies(&values, &base.hypothesis.states(records)?)?;
        let own = own_modes(self.poles, &modes, REACH);
        let told: Vec<(usize, f64)> = own
            .into_iter()
            .zip(self.poles)
            .filter_map(|(mode, pole)| mode.map(|mode| (mode, (pole / modes[mode]).ln())))
            .collect();
        if told.len() < LEAST_POLES {
            return Ok(vec![]);
        }
        let shifts = self.shifts(values, told)?;
        let found = self.nearest(&shifts);
        let is_even = self.boundary.left == self.boundary.right;
        let placed: Vec<_> =
            found.into_iter().take(STARTS).filter_map(|loss| Some((loss, shifts.left(loss)?))).collect();
        let least = placed.first().map_or(0.0, |(_, (left, _))| *left);
        let near = placed.into_iter().filter(|(_, (left, _))| *left <= FURTHER * (least + TOLD));
        let both_halves = near.map(|(loss, (_, by))| (loss, by)).flat_map(|(loss, by)| {
            let image = ShearLoss { at: -loss.at, ..loss };
            if is_even { vec![(loss, by), (image, by)] } else { vec![(loss, by)] }
        });
        let state = |(loss, by): (ShearLoss, [f64; 2])| {
            let value = |name: &str| match name {
                "loss" => Some(loss.loss),
                "span" => Some(loss.span),
                _ => Some(loss.at),
            };
            let switched = Switched::new(effect, self.piece, records, value, |_| false);
            let constants = [0, 1].map(|constant| base.constants[constant] + by[constant]);
            State { constants, hypothesis: base.hypothesis.and(switched), ..base.clone() }
        };
        Ok(both_halves.map(state).collect())
    }

    /// A grid of losses, of which the nearest are brought nearer by downhill simplex.
    fn nearest(&self, shifts: &Shifts) -> Vec<ShearLoss> {
        let length = self.piece.length;
        let is_even = self.boundary.left == self.boundary.right;
        let places = (0..PLACES).map(|i| ((i as f64 + 0.5) / PLACES as f64 - 0.5) * length);
        let places: Vec<f64> = places.filter(|at| !is_even || *at > 0.0).collect();
        let tried: Vec<ShearLoss> = LOSSES
            .iter()
            .flat_map(|&loss| SPANS.map(|span| (loss, span * length)))
            .flat_map(|(loss, span)| places.iter().map(move |&at| ShearLoss { loss, span, at }))
            .collect();
        let grid = tried.into_par_iter().filter_map(|loss| shifts.left(loss).map(|(left, _)| (left, loss))).collect();
        let brought: Vec<(f64, ShearLoss)> = parted(grid, (length, is_even))
            .into_par_iter()
            .take(BROUGHT)
            .filter_map(|(_, loss)| self.brought_nearer(shifts, loss))
            .collect();
        parted(brought, (length, is_even)).into_iter().map(|(_, loss)| loss).collect()
    }

    /// Moved in $\ln(1 - \text{loss})$, in the logarithm of the span and in lengths.
    fn brought_nearer(&self, shifts: &Shifts, from: ShearLoss) -> Option<(f64, ShearLoss)> {
        let length = self.piece.length;
        let moved = |by: &[f64]| {
            let &[left, span, at] = by else { return None };
            let at = from.at + at * length;
            let loss = 1.0 - (1.0 - from.loss) * left.exp();
            let span = from.span * span.exp();
            let is_there =
                (-0.5..0.98).contains(&loss) && at.abs() < 0.5 * length && (0.01 * length..length).contains(&span);
            is_there.then_some(ShearLoss { loss, span, at })
        };
        let corners = (0..=3).map(|moved| {
            (1..=3)
                .map(|i| match (i == moved, i) {
                    (false, _) => 0.0,
                    (true, 3) => PLACE_EDGE,
                    (true, _) => LOGARITHM_EDGE,
                })
                .collect()
        });
        let cost =
            Charge(|by: &[f64]| moved(by).and_then(|loss| shifts.left(loss)).map_or(f64::INFINITY, |(left, _)| left));
        let solver = NelderMead::new(corners.collect());
        let done = Executor::new(cost, solver).configure(|state| state.max_iters(STEPS)).run().ok()?;
        let state = done.state();
        Some((state.get_best_cost(), moved(state.get_best_param()?)?))
    }

    /// What the base leaves of the poles, $\ln(f_\text{pole}/f_\text{mode})$ of these modes.
    fn shifts(&self, values: [f64; 2], told: Vec<(usize, f64)>) -> Result<Shifts, ModelError> {
        let count = told.iter().map(|(mode, _)| mode + 1).max().unwrap_or(0);
        let mut shifts = Shifts {
            piece: *self.piece,
            boundary: self.boundary,
            values,
            count,
            even: vec![],
            told,
            by_constants: vec![],
        };
        shifts.even = shifts.logarithms(&values, None)?;
        for constant in (0..2).filter(|&constant| self.held[constant].is_none()) {
            let mut beside = values;
            beside[constant] *= STEP.exp();
            let beside = shifts.logarithms(&beside, None)?;
            let by = shifts.told.iter().map(|&(mode, _)| (beside[mode] - shifts.even[mode]) / STEP);
            shifts.by_constants.push((constant, by.collect()));
        }
        Ok(shifts)
    }
}

/// How the poles lie beside the modes of the base.
struct Shifts {
    piece: Piece,
    boundary: Boundary,
    values: [f64; 2],
    /// Modes that are looked at.
    count: usize,
    /// Logarithms of the even beam's frequencies.
    even: Vec<f64>,
    /// Mode of each pole, and what the base misses.
    told: Vec<(usize, f64)>,
    /// What the logarithms of the free constants do to these modes.
    by_constants: Vec<(usize, Vec<f64>)>,
}

impl Shifts {
    fn logarithms(&self, values: &[f64], loss: Option<ShearLoss>) -> Result<Vec<f64>, ModelError> {
        let terms = BeamTerms { losses: loss.into_iter().collect(), ..BeamTerms::default() };
        let beam = TimoshenkoBeam::with_terms(&self.piece, self.boundary, 2 * self.count + MORE_TERMS, terms)?;
        let modes = ritz_modes(&beam, values, self.count)?;
        Ok(modes.iter().map(|mode| mode.angular_frequency).filter(|omega| *omega > 0.0).map(f64::ln).collect())
    }

    /// Sum of squares of what a loss leaves beside the constants that answer best for the rest, and by how much their logarithms
    /// move for that; none where there is no such beam.
    fn left(&self, loss: ShearLoss) -> Option<(f64, [f64; 2])> {
        let moved = self.logarithms(&self.values, Some(loss)).ok()?;
        let left = |&(mode, missed): &(usize, f64)| Some(missed - (moved.get(mode)? - self.even.get(mode)?));
        let left: Vec<f64> = self.told.iter().map(left).collect::<Option<_>>()?;
        // Declared constants answer for nothing, and no columns leave nothing to solve.
        if self.by_constants.is_empty() {
            return Some((left.iter().map(|left| left * left).sum(), [0.0; 2]));
        }
        let by = |row: usize, constant: usize| self.by_constants[constant].1[row];
        let by = Mat::from_fn(left.len(), self.by_constants.len(), by);
        let left = Mat::from_fn(left.len(), 1, |row, _| left[row]);
        let step = by.qr().solve_lstsq(&left);
        let mut constants = [0.0; 2];
        self.by_constants.iter().enumerate().for_each(|(i, (constant, _))| constants[*constant] = step[(i, 0)]);
        Some(((left - by * step).squared_norm_l2(), constants))
    }
}

/// The nearest first, without those that are like a nearer one, or like its image where the ends are alike.
fn parted(mut found: Vec<(f64, ShearLoss)>, (length, is_even): (f64, bool)) -> Vec<(f64, ShearLoss)> {
    let place = |loss: &ShearLoss| if is_even { loss.at.abs() } else { loss.at };
    let alike = |a: &ShearLoss, b: &ShearLoss| {
        (place(a) - place(b)).abs() < ALIKE * length
            && (a.span - b.span).abs() < ALIKE * length
            && (a.loss - b.loss).abs() < ALIKE
    };
    found.retain(|(missed, _)| missed.is_finite());
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.into_iter().fold(vec![], |mut parted: Vec<(f64, ShearLoss)>, found| {
        if !parted.iter().any(|(_, other)| alike(other, &found.1)) {
            parted.push(found);
        }
        parted
    })
}

#[cfg(test)]
mod tests {
    use orthopanel_model::{RecordSetting, effect};

    use super::*;
    use crate::tracing::hypothesis::Hypothesis;

    /// Frequencies of a beam that has lost shear stiffness over a span tell which, though the base's constants are off and one
    /// mode has no pole.
    #[test]
    fn val_a_loss_is_found_by_the_poles() {
        let piece = Piece { length: 0.8, width: 0.1, thickness: 0.03, mass_per_area: 6.88 };
        let truth = ShearLoss { loss: 0.55, span: 0.09, at: -0.3 };
        let terms = BeamTerms { losses: vec![truth], ..BeamTerms::default() };
        let beam = TimoshenkoBeam::with_terms(&piece, Boundary::FREE, 60, terms).unwrap();
        let modes = ritz_modes(&beam, &[1e10, 4e8], 12).unwrap();
        let frequencies = modes.iter().map(|mode| mode.angular_frequency / std::f64::consts::TAU).filter(|f| *f > 0.0);
        let poles: Vec<f64> = frequencies.enumerate().filter(|(mode, _)| *mode != 4).map(|(_, f)| f).collect();
        let setup = ReceptanceSetup::new(&piece, Boundary::FREE, &[], &[RecordSetting::default()], 14).unwrap();
        let constants = [0.98e10_f64.ln(), 3.9e8_f64.ln()];
        let base = State { constants, zetas: vec![0.01_f64.ln()], hypothesis: Hypothesis { effects: vec![] } };
        let starts =
            LossStarts { poles: &poles, held: &[None; 2], setup: &setup, boundary: Boundary::FREE, piece: &piece };
        let found = starts.found(&base, effect(LOSS).unwrap(), 1).unwrap();
        let near = |state: &State| {
            let &[loss, span, at] = &state.hypothesis.effects[0].values[..] else { panic!("three parameters") };
            // What is lost tells more than over how much of the length.
            (at.abs() - 0.3).abs() < 0.01 && (loss * span / (truth.loss * truth.span) - 1.0).abs() < 0.25
        };
        let told: Vec<_> = found.iter().map(|state| state.hypothesis.effects[0].values.clone()).collect();
        assert!(found.iter().take(2).all(near), "{told:?}");
        let ends: Vec<f64> = told.iter().take(2).map(|values| values[2].signum()).collect();
        assert_eq!(ends[0], -ends[1], "the image on the other half: {told:?}");
    }

    #[test]
    fn images_are_one_where_both_ends_are_alike() {
        let right = ShearLoss { loss: 0.4, span: 0.1, at: 0.2 };
        let both = vec![(1.0, right), (2.0, ShearLoss { at: -0.2, ..right })];
        assert_eq!(parted(both.clone(), (0.8, true)), [(1.0, right)]);
        assert_eq!(parted(both, (0.8, false)).len(), 2);
    }

    /// With both constants declared nothing else answers for what a loss leaves: least squares without columns.
    #[test]
    fn declared_constants_leave_the_loss_alone() {
        let piece = Piece { length: 0.8, width: 0.1, thickness: 0.03, mass_per_area: 6.88 };
        let truth = ShearLoss { loss: 0.4, span: 0.1, at: 0.2 };
        let (values, boundary) = ([1e10, 4e8], Boundary::FREE);
        let mut shifts =
            Shifts { piece, boundary, values, count: 10, even: vec![], told: vec![], by_constants: vec![] };
        shifts.even = shifts.logarithms(&values, None).unwrap();
        let lost = shifts.logarithms(&values, Some(truth)).unwrap();
        shifts.told = (0..8).map(|mode| (mode, lost[mode] - shifts.even[mode])).collect();
        let (left, constants) = shifts.left(truth).unwrap();
        assert!(left < 1e-20, "{left}");
        assert_eq!(constants, [0.0; 2]);
        assert!(shifts.left(ShearLoss { at: 0.1, ..truth }).unwrap().0 > 1e-8);
    }
}
