//! Places that a search finds no way to: the other side of the panel, and spans that end inside it.
//!
//! A place and its mirror image change every frequency of an even panel alike.
//!
//! What parts them is how the peaks' sizes and the lines between them change. A search that has come down on the wrong side finds
//! no way across, for each place between changes the frequencies.
//!
//! A span that reaches over a free end has an outer edge where no shear force is: no derivative calls it back, though the edge may
//! belong well inside.

use orthopanel_model::EffectParameter;

use super::fit::{Fit, PATIENCE, fit, polish};
use super::hypothesis::{Hypothesis, is_place};
use super::ranking::LITTLE;
use super::record_problem::State;
use super::records_of_test::TestRecords;
use crate::IdentifyError;

/// Widening from which the other side is followed: there the constants and the damping give way to the new place.
const FROM: usize = 1;

/// Puts the best of the fits elsewhere where that fits better. `declared` effects stay where the file puts them.
pub(super) fn put_elsewhere(records: &TestRecords, fits: &mut [Fit], declared: usize) {
    let best = fits.iter_mut().filter(|fit| fit.given_up.is_none()).min_by(|a, b| a.cost.total_cmp(&b.cost));
    let Some(best) = best else { return };
    for position in declared..best.state.hypothesis.effects.len() {
        let elsewhere = mirrored(&best.state.hypothesis, position).into_iter();
        for hypothesis in elsewhere.chain(drawn_in(&best.state.hypothesis, position)) {
            let turned = State { hypothesis, ..best.state.clone() };
            if let Ok(Some(other)) = fit_where_better(records, turned, best)
                && other.cost < best.cost
            {
                *best = other;
            }
        }
    }
}

/// A fit from another place; none where it has come down on wide lines and leaves more there than `best`, which need not lie at its
/// minimum there: [`LITTLE`] is for that, and for what narrower lines may tell apart.
fn fit_where_better(records: &TestRecords, turned: State, best: &Fit) -> Result<Option<Fit>, IdentifyError> {
    let problem = records.problem(FROM);
    let here = problem.at(&best.state)?.cost;
    let (turned, there) = polish(records, &turned, FROM, PATIENCE[FROM])?;
    if there > here + LITTLE { Ok(None) } else { fit(records, turned, FROM + 1).map(Some) }
}

/// With the place of one effect on the other side; `None` where it has none that is free.
fn mirrored(hypothesis: &Hypothesis, position: usize) -> Option<Hypothesis> {
    let mut turned = hypothesis.clone();
    let on = turned.effects.get_mut(position)?;
    let at = on.free.iter().find(|free| is_place(&on.effect.parameters()[free.parameter]))?.at;
    on.values[at] = -on.values[at];
    Some(turned)
}

/// Where a span's outer edge is drawn in to, as a part of the way from its inner edge to the panel's end.
const DRAWN_IN_TO: f64 = 0.6;

/// With the span of one effect ending inside the panel; `None` where it does already, or has none that is free.
fn drawn_in(hypothesis: &Hypothesis, position: usize) -> Option<Hypothesis> {
    let mut drawn = hypothesis.clone();
    let on = drawn.effects.get_mut(position)?;
    let free = |is: &dyn Fn(&EffectParameter) -> bool| {
        on.free.iter().find(|free| is(&on.effect.parameters()[free.parameter])).copied()
    };
    let (place, span) = (free(&is_place)?, free(&|parameter| parameter.name == "span")?);
    let (side, from_centre) = (on.values[place.at].signum(), on.values[place.at].abs());
    let (inner, end) = (from_centre - 0.5 * on.values[span.at], place.range.1);
    if from_centre + 0.5 * on.values[span.at] < end {
        return None;
    }
    let outer = inner + DRAWN_IN_TO * (end - inner);
    on.values[place.at] = side * 0.5 * (inner + outer);
    on.values[span.at] = outer - inner;
    Some(drawn)
}

#[cfg(test)]
mod tests {
    use orthopanel_model::{Piece, effect};

    use super::*;
    use crate::tracing::hypothesis::Switched;

    fn of_span(span: f64, at: f64) -> Hypothesis {
        let piece = Piece { length: 0.8, width: 0.1, thickness: 0.03, mass_per_area: 6.88 };
        let value = |name: &str| match name {
            "loss" => Some(0.5),
            "span" => Some(span),
            _ => Some(at),
        };
        Hypothesis { effects: vec![Switched::new(effect("stiffness-loss").unwrap(), &piece, 5, value, |_| false)] }
    }

    #[test]
    fn a_span_over_the_end_is_drawn_in_and_keeps_its_inner_edge() {
        for side in [-1.0, 1.0] {
            // From 0.3 to 0.42 m, on a panel that ends at 0.4.
            let drawn = drawn_in(&of_span(0.12, side * 0.36), 0).unwrap();
            let &[loss, span, at] = &drawn.effects[0].values[..] else { panic!("three parameters") };
            assert!((side * at - 0.5 * span - 0.3).abs() < 1e-12, "{span} at {at}");
            assert!((side * at + 0.5 * span - 0.36).abs() < 1e-12, "{span} at {at}");
            assert_eq!(loss, 0.5);
        }
        assert!(drawn_in(&of_span(0.12, 0.3), 0).is_none(), "it ends inside the panel");
        assert!(drawn_in(&of_span(0.12, 0.36), 1).is_none(), "no such effect");
    }
}
