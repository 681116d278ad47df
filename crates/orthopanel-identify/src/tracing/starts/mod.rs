//! Where the search for one more effect begins: a grid of starts, scored with everything else free to give way.

pub(super) mod declared;
pub(super) mod losses;
pub(super) mod plate_states;
pub(super) mod plates;
pub(super) mod plates_by_poles;
pub(super) mod stiffness_grid;
pub(super) mod supports;

use orthopanel_model::{Effect, Piece, Scale};
use rayon::prelude::*;

use super::core_modes::{CORE, CoreModes};
use super::fit::{polish, polished_through, promise};
use super::hypothesis::{PLATE, Switched, has_place, is_place};
use super::record_problem::State;
use super::records_of_test::TestRecords;
use super::verdict::MET;
use crate::IdentifyError;
use crate::least_squares::Ending;
use losses::{LOSS, LossStarts};
use supports::{SUPPORT, SupportStarts, support_starts};

/// Starts that are followed for some steps before the best is taken.
const FOLLOWED: usize = 3;
const FOLLOW: Ending = Ending::far(8, 1.0).resting();
/// One pair of places hardly tells where on the panel something is: wide peaks have more minima there than several pairs leave,
/// and each costs less to follow.
const FEW_RECORDS: usize = 2;
const FOLLOWED_OF_FEW: usize = 8;
/// Starts of an effect with a place that a closer look follows on the widest lines, how many at once, and how many of these further.
const FOLLOWED_FAR: usize = 30;
const AT_ONCE: usize = 8;
const FURTHER_OF_FAR: usize = 8;
/// So many times what noise may leave the widest lines must miss without the effect, that the first place that meets the noise is taken for
/// where it is: 3 g missing were missed 1.3 times, and met at three wrong places of eight.
const STANDS_OUT: f64 = 10.0;
/// Starts that are near already which a search follows on the widest lines, images on the other half counted, and how many further.
const FOLLOWED_NEAR: usize = 4;
const FURTHER_OF_NEAR: usize = 2;
/// A plate's modes of two families change their order: one step foretells little. So many of the grid's starts are followed, and as
/// many that the poles tell.
const PLATES_FOLLOWED: usize = 4;
const PLATES_FOLLOW: Ending = Ending::far(16, 1.0).resting();

/// A state at one widening, and the sum of squares that it leaves there or promises to leave.
pub(super) type Costed = (State, f64);

/// `base` with one more effect at each of its starts, the most promising at a widening first.
///
/// Each start is scored by $c - g^TN^{-1}g$, the sum of squares that one step in all parameters promises to leave: the
/// constants, the damping and the effects that are on already answer for what they can.
///
/// # Errors
/// Where no start can be evaluated: the first one's reason, as that the test lacks what the effect needs.
pub(super) fn scored_starts(
    records: &TestRecords,
    base: &State,
    effect: &'static dyn Effect,
    (piece, stage): (&Piece, usize),
    look: Look,
) -> Result<Vec<Costed>, IdentifyError> {
    let problem = records.problem(stage);
    can_differ(effect, problem.records.len())?;
    // Where no end is clamped, the grid's own starts say so.
    let beside = if look == Look::ByPoles {
        starts_by_poles(records, base, effect, piece)?
    } else if effect.id() == SUPPORT {
        let known = SupportStarts { poles: &records.poles, held: &records.held, setup: &records.setup, piece };
        support_starts(known, base, effect, problem.records.len()).unwrap_or_default()
    } else {
        vec![]
    };
    let test = (problem.records.len(), records.band);
    // What a core stiffens and takes of energy is in the base's constants and damping already.
    let modes = if effect.id() == CORE { CoreModes::of(&problem, base) } else { None };
    let promised = |state: &State| -> Result<f64, IdentifyError> { Ok(promise(&problem.at(state)?)) };
    let switched = |values: &[f64]| {
        let at = |name: &str| {
            let index = effect.parameters().iter().position(|parameter| parameter.name == name);
            index.and_then(|index| values.get(index)).copied()
        };
        Switched::new(effect, piece, problem.records.len(), at, |_| false)
    };
    let scored: Vec<Result<Costed, IdentifyError>> = grid(effect, piece, test, look)
        .into_par_iter()
        .flat_map_iter(|start| match records.with(base, switched(&start)) {
            Ok(states) => states.into_iter().map(Ok).collect(),
            Err(error) => vec![Err(error)],
        })
        .chain(beside.into_par_iter().map(Ok))
        .map(|state| {
            let state = match &modes {
                Some(modes) => modes.begun(&problem, state?, records.band),
                None => state?,
            };
            let promised = promised(&state)?;
            Ok((state, promised))
        })
        .collect();
    let mut reason = None;
    let mut starts = Vec::new();
    for start in scored {
        match start {
            Ok(start) => starts.push(start),
            Err(error) => reason = reason.or(Some(error)),
        }
    }
    starts.sort_by(|a, b| a.1.total_cmp(&b.1));
    if effect.id() == PLATE {
        let by_poles = records.with_plates_by_poles(base, look, |ratios| switched(ratios));
        let by_poles =
            by_poles.into_par_iter().filter_map(|state| promised(&state).ok().map(|promised| (state, promised)));
        // One step foretells little: neither kind may keep the other from being followed.
        starts.truncate(PLATES_FOLLOWED);
        starts.par_extend(by_poles);
        starts.sort_by(|a, b| a.1.total_cmp(&b.1));
    }
    match (starts.is_empty(), reason) {
        (false, _) => Ok(starts),
        (true, Some(reason)) => Err(reason),
        (true, None) => Err(IdentifyError::Unsupported(format!("{}: no start", effect.id()))),
    }
}

/// What belongs to one record wants another that is without it: the gain of the only record is the gain.
///
/// # Errors
/// Where so many records cannot tell it.
pub(super) fn can_differ(effect: &dyn Effect, records: usize) -> Result<(), IdentifyError> {
    let is_of_one = effect.parameters().iter().any(|parameter| parameter.scale == Scale::Index);
    if is_of_one && records < 2 {
        return Err(IdentifyError::Unsupported("one record has no other to differ from".to_owned()));
    }
    Ok(())
}

/// `base` with an effect where the poles alone tell it; none of an effect that they do not.
fn starts_by_poles(
    records: &TestRecords,
    base: &State,
    effect: &'static dyn Effect,
    piece: &Piece,
) -> Result<Vec<State>, IdentifyError> {
    let (Some(setting), true) = (records.setup.setting(0), effect.id() == LOSS) else { return Ok(vec![]) };
    let (poles, held, setup) = (&records.poles, &records.held, &records.setup);
    let known = LossStarts { poles, held, setup, boundary: setting.boundary, piece };
    known.found(base, effect, records.problem(0).records.len())
}

/// Promises of starts that differ by less are alike.
const TOLD: f64 = 1.0;

/// The best of the first few starts after some steps on the widest lines; where these do not tell one start from another, on
/// those of the widening `narrow`: a force that goes with the cube of the motion builds up over a record.
pub(super) fn followed_where_told(records: &TestRecords, starts: &[Costed], narrow: usize) -> Option<Costed> {
    let promises = || starts.iter().map(|(_, promised)| *promised);
    let spread = promises().fold(f64::NEG_INFINITY, f64::max) - promises().fold(f64::INFINITY, f64::min);
    if narrow == 0 || starts.len() < 2 || spread > TOLD {
        return followed(records, starts, 0);
    }
    let problem = records.problem(narrow);
    let promised = |(state, _): &Costed| {
        let promised = promise(&problem.at(state).ok()?);
        Some((state.clone(), promised))
    };
    let mut again: Vec<Costed> = starts.par_iter().filter_map(promised).collect();
    again.sort_by(|a, b| a.1.total_cmp(&b.1));
    let (state, _) = followed(records, &again, narrow)?;
    let widest = records.problem(0);
    let cost = widest.at(&state).ok()?.cost;
    Some((state, cost))
}

/// The best of the first few starts after some steps at one widening.
pub(super) fn followed(records: &TestRecords, starts: &[Costed], stage: usize) -> Option<Costed> {
    // Springs and the constants beside them share a long valley, from which a spring may run off to infinity.
    if stage == 0 && latest(starts, |effect| effect.id() == SUPPORT) {
        return followed_far(records, starts, 0);
    }
    let many = if records.problem(stage).records.len() <= FEW_RECORDS { FOLLOWED_OF_FEW } else { FOLLOWED };
    least(followed_each(records, starts, (stage, many)))
}

/// The best of many starts, followed from the widest lines to those of a widening: where an effect is, one step hardly foretells.
pub(super) fn followed_far(records: &TestRecords, starts: &[Costed], to: usize) -> Option<Costed> {
    followed_first(records, starts, (FOLLOWED_FAR, FURTHER_OF_FAR), to)
}

/// The best of a few starts that are near already, in the same way.
pub(super) fn followed_near(records: &TestRecords, starts: &[Costed], to: usize) -> Option<Costed> {
    followed_first(records, starts, (FOLLOWED_NEAR, FURTHER_OF_NEAR), to)
}

/// `many` starts followed on the widest lines, and the best `few` of these on to those of a widening.
fn followed_first(records: &TestRecords, starts: &[Costed], (many, few): (usize, usize), to: usize) -> Option<Costed> {
    let widest = records.problem(0);
    let enough = MET * widest.data() as f64;
    let mut without = starts.first()?.0.clone();
    without.hypothesis.effects.pop();
    // What starts stand beside, or the base, where their constants have moved with the effect.
    let misses = |state: &State| widest.at(state).is_ok_and(|at| at.cost > STANDS_OUT * enough);
    let is_told = misses(&without) && misses(&records.start);
    let (many, patience) = follow(records, starts, many);
    let mut each: Vec<Costed> = vec![];
    for starts in starts[..many.min(starts.len())].chunks(AT_ONCE) {
        let some = starts.par_iter().filter_map(|(state, _)| polish(records, state, 0, patience).ok());
        each.par_extend(some);
        // The first that meets the noise is where the effect is; but what is nearly met without any is met at many places.
        if is_told && each.iter().any(|(_, cost)| *cost <= enough) {
            break;
        }
    }
    each.sort_by(|a, b| a.1.total_cmp(&b.1));
    each.truncate(few);
    least(each.into_par_iter().filter_map(|begun| polished_through(records, begun, 0..=to).ok()).collect())
}

fn least(fits: Vec<Costed>) -> Option<Costed> {
    fits.into_iter().min_by(|a, b| a.1.total_cmp(&b.1))
}

/// The first few starts after some steps at one widening; of an effect with a place or of clamps that yield `many`.
fn followed_each(records: &TestRecords, starts: &[Costed], (stage, many): (usize, usize)) -> Vec<Costed> {
    let (many, patience) = follow(records, starts, many);
    starts.par_iter().take(many).filter_map(|(state, _)| polish(records, state, stage, patience).ok()).collect()
}

/// How many starts are followed, `many` of an effect with a place or of clamps that yield, and how far.
fn follow(records: &TestRecords, starts: &[Costed], many: usize) -> (usize, Ending) {
    let is_plate = starts.iter().any(|(state, _)| state.hypothesis.holds_plate());
    let is_hard = is_plate && records.asked_the_poles();
    let is_wide = |effect: &'static dyn Effect| has_place(effect) || effect.id() == SUPPORT;
    if is_hard {
        (2 * PLATES_FOLLOWED, PLATES_FOLLOW)
    } else if latest(starts, is_wide) {
        (many, FOLLOW)
    } else {
        (FOLLOWED, FOLLOW)
    }
}

/// Whether the effect that these starts are about is such a one.
fn latest(starts: &[Costed], is: impl Fn(&'static dyn Effect) -> bool) -> bool {
    let on = starts.first().and_then(|(state, _)| state.hypothesis.effects.last());
    on.is_some_and(|on| is(on.effect))
}

/// Most combinations of starts, beyond which only the first of each but the place, the frequency and the record is taken.
const MOST_STARTS: usize = 30;

/// How closely starts are looked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Look {
    /// At places where the catalogue says.
    Usual,
    /// And halfway between: a mode's half-wave may be as short as the usual places are apart.
    Finer,
    /// And at plates that the poles tell, though a beam may have modes for all of them.
    Closest,
    /// Where the poles tell, alone.
    ByPoles,
    /// At this place along the piece and its image on the other half, alone.
    At(f64),
}

/// Values of all parameters, one list a start, in a test of so many records up to `band` \[Hz\].
pub(super) fn grid(
    effect: &'static dyn Effect,
    piece: &Piece,
    (records, band): (usize, f64),
    look: Look,
) -> Vec<Vec<f64>> {
    if look == Look::ByPoles {
        return vec![];
    }
    let lists: Vec<(Vec<f64>, bool)> = effect
        .parameters()
        .iter()
        .map(|parameter| {
            let mut list = match (parameter.scale, parameter.held_at) {
                (Scale::Index, _) => (1..=records).map(|record| record as f64).collect(),
                (_, Some(held)) => vec![held],
                _ => parameter.starts(piece),
            };
            if is_place(parameter) {
                match look {
                    Look::At(at) => list = vec![at, -at],
                    Look::Finer | Look::Closest => list = with_middles(&list),
                    Look::Usual | Look::ByPoles => {}
                }
            }
            if parameter.unit == "Hz" && list.len() > 3 {
                list.retain(|frequency| *frequency < band);
            }
            // Where something is matters more for a search than how much of it there is.
            (list, parameter.scale == Scale::Index || is_place(parameter) || parameter.unit == "Hz")
        })
        .collect();
    let most = if look != Look::Usual { 4 * MOST_STARTS } else { MOST_STARTS };
    let whole: usize = lists.iter().map(|(list, _)| list.len()).product();
    let lists = lists.into_iter().map(|(mut list, where_it_is)| {
        if whole > most && !where_it_is {
            list.truncate(1);
        }
        list
    });
    lists.fold(vec![vec![]], |starts, list| {
        let longer = |start: &Vec<f64>| {
            let start = start.clone();
            list.iter().map(move |&value| start.iter().copied().chain([value]).collect()).collect::<Vec<Vec<f64>>>()
        };
        starts.iter().flat_map(longer).collect()
    })
}

/// Places in rising order with those halfway between.
fn with_middles(places: &[f64]) -> Vec<f64> {
    let mut all: Vec<f64> =
        places.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).chain(places.iter().copied()).collect();
    all.sort_by(f64::total_cmp);
    all
}

#[cfg(test)]
mod tests {
    use orthopanel_model::effect;

    use super::*;

    /// What may explain the records as well as another does sits where that is, or at its image.
    #[test]
    fn a_look_at_one_place_tries_no_other() {
        let piece = Piece { length: 0.8, width: 0.1, thickness: 0.03, mass_per_area: 6.88 };
        let grid = grid(effect("local-mass").unwrap(), &piece, (5, 5000.0), Look::At(0.13));
        let mut places: Vec<f64> = grid.iter().map(|start| start[1]).collect();
        places.sort_by(f64::total_cmp);
        places.dedup();
        assert_eq!(places, [-0.13, 0.13]);
    }

    /// A loss of 72 % was not found from one of 30 %.
    #[test]
    fn a_closer_look_tries_each_loss_and_span_at_every_place() {
        let piece = Piece { length: 0.8, width: 0.1, thickness: 0.03, mass_per_area: 6.88 };
        let of = |look| grid(effect("stiffness-loss").unwrap(), &piece, (5, 5000.0), look);
        let places = |starts: &[Vec<f64>]| {
            let mut places: Vec<f64> = starts.iter().map(|start| start[2]).collect();
            places.sort_by(f64::total_cmp);
            places.dedup();
            places.len()
        };
        let (usual, closest) = (of(Look::Usual), of(Look::Closest));
        assert!(places(&closest) >= 2 * places(&usual) - 1);
        assert_eq!(closest.len(), 6 * places(&closest), "two losses and three spans");
    }
}
