//! Another place of hammer or sensor, a mass beside the sensor, or a line of hits across the width.

use orthopanel_data::ImpactTest;
use orthopanel_model::{Piece, Place};
use rayon::prelude::*;

use super::Further;
use super::foretold::{Bench, Foretold, difference};
use crate::tracing::fit::Fit;
use crate::tracing::ranking::Search;

/// Places tried along the piece, and those of lines across it.
const PLACES: usize = 17;
const LINES: usize = 9;
/// Where a line across ends, as a part of half the width: near the edge, and still on the face.
const ACROSS: f64 = 0.8;
/// Mass that a tester has at hand, in parts of the piece's \[1\].
const ADDED: f64 = 0.01;
/// A plate has no finite answer right under a point force: none nearer than so many thicknesses is proposed for one.
const NEAR: f64 = 3.0;

/// What a tester changes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Proposal {
    pub words: String,
    /// One, or the two ends of a line across.
    pub forces_at: Vec<Place>,
    pub response_at: Place,
    /// \[kg\].
    pub added_mass: f64,
}

/// Every such measurement with what it parts.
pub(super) fn places(test: &ImpactTest, search: &Search, chosen: &Fit, rivals: &[&Fit]) -> Vec<Further> {
    let problem = search.records.problem(1);
    let Some(record) = problem.records.first() else { return vec![] };
    let wide = rivals.iter().chain([&chosen]).any(|fit| fit.state.hypothesis.holds_plate());
    let bench = Bench {
        piece: search.piece,
        boundary: test.boundary,
        suspension: &test.suspension,
        summed: search.records.summed,
        s: &record.s,
        of_records: &search.records.setup,
    };
    let foretold = |fit: &Fit, proposal: &Proposal| -> Option<Foretold> { bench.foretold(&fit.state, proposal).ok() };
    let shown = |proposal: Proposal| {
        let one = foretold(chosen, &proposal);
        let apart = rivals.iter().map(|rival| {
            let pair = one.as_ref().zip(foretold(rival, &proposal));
            pair.map_or(f64::NAN, |(one, other)| difference(one, &other, &record.variance))
        });
        Further { apart: apart.collect(), words: proposal.words }
    };
    proposals(&search.piece, [record.force_at, record.response_at], wide).into_par_iter().map(shown).collect()
}

/// What can be changed of a record of hits at `force` and a sensor at `response`. `wide` says that a plate is among the hypotheses: a
/// beam answers alike wherever across the width it is hit.
fn proposals(piece: &Piece, [force, response]: [Place; 2], wide: bool) -> Vec<Proposal> {
    let added = ADDED * piece.mass();
    let mut proposals = vec![Proposal {
        words: format!("repeat the test with {:.0} g more at the sensor", 1e3 * added),
        forces_at: vec![force],
        response_at: response,
        added_mass: added,
    }];
    for x in along(piece, PLACES) {
        let place = Place { x, y: 0.0 };
        proposals.push(Proposal {
            words: format!("hit at x = {x:.2} m, with the sensor where it is"),
            forces_at: vec![place],
            response_at: response,
            added_mass: 0.0,
        });
        proposals.push(Proposal {
            words: format!("move the sensor to x = {x:.2} m, and hit at x = {:.3} m", force.x),
            forces_at: vec![force],
            response_at: place,
            added_mass: 0.0,
        });
    }
    if wide {
        // Whole millimetres: a width has few centimetres.
        let y = (1e3 * ACROSS * 0.5 * piece.width).round() / 1e3;
        proposals.extend(along(piece, LINES).map(|x| Proposal {
            words: format!(
                "hit on a line across the width at x = {x:.2} m, y = {y:.3} and -{y:.3} m, with the sensor where it is"
            ),
            forces_at: vec![Place { x, y }, Place { x, y: -y }],
            response_at: response,
            added_mass: 0.0,
        }));
    }
    let far = |proposal: &Proposal| {
        let from_sensor = |place: &Place| (place.x - proposal.response_at.x).hypot(place.y - proposal.response_at.y);
        proposal.forces_at.iter().all(|place| from_sensor(place) > NEAR * piece.thickness)
    };
    let on_piece = |proposal: &Proposal| {
        proposal.forces_at.iter().chain([&proposal.response_at]).all(|place| piece.contains(*place).is_ok())
    };
    proposals.retain(|proposal| on_piece(proposal) && (!wide || far(proposal)));
    proposals
}

/// Places that a tester can find again: whole centimetres.
fn along(piece: &Piece, count: usize) -> impl Iterator<Item = f64> + use<> {
    let length = piece.length;
    (0..count).map(move |step| (100.0 * length * (0.96 * step as f64 / (count - 1) as f64 - 0.48)).round() / 100.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const PIECE: Piece = Piece { length: 0.8, width: 0.3, thickness: 0.02, mass_per_area: 6.0 };

    #[test]
    fn a_line_across_is_proposed_where_a_plate_is_compared() {
        // One of the places tried.
        let sensor = Place { x: 0.38, y: 0.0 };
        let of = |wide| proposals(&PIECE, [Place { x: -0.3, y: 0.0 }, sensor], wide);
        let across = |proposal: &&Proposal| proposal.forces_at.iter().any(|place| place.y != 0.0);
        assert_eq!(of(false).iter().filter(across).count(), 0);
        let wide = of(true);
        let lines: Vec<&Proposal> = wide.iter().filter(across).collect();
        assert!(lines.len() >= LINES - 1, "{}", lines.len());
        assert!(lines.iter().all(|line| line.forces_at.iter().all(|place| place.y.abs() == 0.12)), "{lines:?}");
        // Under the hammer a plate's sensor would see no bound.
        assert!(of(false).iter().any(|proposal| proposal.forces_at.contains(&sensor)));
        assert!(!wide.iter().any(|proposal| proposal.forces_at.contains(&sensor)));
    }
}
