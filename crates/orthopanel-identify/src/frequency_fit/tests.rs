//! The traps of a simplex with bounds, each met on purpose.

use super::minimum::minimise;
use super::problem::FrequencyProblem;
use crate::IdentifyError;
use crate::Search;
use orthopanel_data::ImpactTest;

fn piece_1() -> FrequencyProblem {
    let text = r#"
        [piece]
        length = 0.8
        width = 0.1
        thickness = 0.03
        mass_per_area = 6.880
        [[measurement]]
        kind = "natural-frequencies"
        values = [321.3, 837.5, 1520.0, 2312.5, 3150.0, 3987.5]
    "#;
    FrequencyProblem::of(&ImpactTest::from_toml(text, "test.toml").unwrap()).unwrap()
}

fn minimum(problem: &FrequencyProblem, start: [f64; 2], search: Search) -> [f64; 2] {
    let found = minimise(problem, &start.map(f64::ln), search).unwrap_or_else(|error| panic!("{error}"));
    [0, 1].map(|parameter| problem.constants.value(parameter, found[parameter]))
}

fn assert_close(found: [f64; 2], expected: [f64; 2]) {
    for (f, e) in found.iter().zip(expected) {
        assert!((f / e - 1.0).abs() < 1e-6, "{found:?}, expected {expected:?}");
    }
}

/// An infinite penalty stalls a simplex whose first corners lie outside: these all do.
#[test]
fn a_simplex_that_starts_outside_its_bounds_comes_in() {
    let problem = piece_1();
    let expected = minimum(&problem, [1e10, 5e8], Search::LeastSquares);
    assert_close(minimum(&problem, [1e17, 1e17], Search::Simplex), expected);
    assert_close(minimum(&problem, [1.0, 1.0], Search::Simplex), expected);
}

/// Clipping to the box flattens a simplex on a bound that lies near the minimum.
#[test]
fn a_bound_close_to_the_minimum_does_not_flatten_the_simplex() {
    let mut problem = piece_1();
    let expected = minimum(&problem, [1e10, 5e8], Search::LeastSquares);
    problem.constants.constants[0].high = expected[0] * 1.001;
    problem.constants.constants[1].low = expected[1] * 0.999;
    assert_close(minimum(&problem, [expected[0] * 0.8, expected[1]], Search::Simplex), expected);
}

/// A start on a bound is not an answer.
#[test]
fn a_start_on_a_bound_is_left() {
    let mut problem = piece_1();
    let expected = minimum(&problem, [1e10, 5e8], Search::LeastSquares);
    problem.constants.constants[0].low = 5e9;
    problem.constants.constants[1].low = 1e8;
    for search in [Search::Simplex, Search::LeastSquares] {
        assert_close(minimum(&problem, [5e9, 1e8], search), expected);
    }
}

/// Where the minimum itself lies beyond a bound, the bound is refused as a result.
#[test]
fn a_minimum_on_a_bound_is_refused() {
    let mut problem = piece_1();
    problem.constants.constants[0].high = 8e9;
    for search in [Search::Simplex, Search::LeastSquares] {
        let Ok(found) = minimise(&problem, &[7e9_f64.ln(), 5e8_f64.ln()], search) else { panic!("no minimum") };
        let refused = problem.constants.refuse_bounds(&found);
        assert!(matches!(refused, Err(IdentifyError::OnBound { name: "e_x", .. })), "{search:?}: {refused:?}");
    }
}
