//! Short lists of a plate's frequencies: what they do not show is held and said, never printed as a result.

use crate::support::plate::{FREE, TRUTH, listed};
use orthopanel_identify::{Identification, Search, identify};

/// The plate of [`FREE`] with all edges pinned, by Navier's series, and clamped, by scikit-fem: modes without nodes along y come first.
const PINNED: [(f64, [usize; 2]); 5] =
    [(1711.2, [0, 0]), (1974.2, [1, 0]), (2391.5, [2, 0]), (2932.8, [3, 0]), (3565.3, [4, 0])];
const CLAMPED: [(f64, [usize; 2]); 5] =
    [(2159.0, [0, 0]), (2341.9, [1, 0]), (2674.8, [2, 0]), (3147.4, [3, 0]), (3728.4, [4, 0])];

fn identified(edges: &str, lines: &[(f64, [usize; 2])], held: &str) -> Identification {
    let boundary =
        format!("[boundary]\nleft = \"{edges}\"\nright = \"{edges}\"\nfront = \"{edges}\"\nback = \"{edges}\"\n{held}");
    let test = listed(lines, &boundary, "");
    identify(&test, Search::LeastSquares).unwrap_or_else(|error| panic!("{edges} {lines:?}: {error}"))
}

/// Every constant is either held and told with an interval that holds its place and a direction that begins with it, or has an
/// interval that holds the truth and is narrower than a factor of seven.
fn assert_honest(found: &Identification, of: &str) {
    for (constant, (name, truth)) in found.constants.iter().zip(TRUTH) {
        assert_eq!(constant.name, name);
        let unseen = found.not_identified.iter().find(|unseen| unseen.name == name);
        assert_eq!(constant.held, unseen.is_some(), "{of}: {name}");
        match unseen {
            Some(unseen) => {
                let [low, high] = unseen.interval;
                assert!(low <= constant.value && constant.value <= high, "{of}: {unseen:?}");
                assert_eq!(unseen.direction.first().map(|(name, _)| *name), Some(name), "{of}");
            }
            None => {
                let std = constant.std.unwrap_or_else(|| panic!("{of}: {name} without deviation"));
                assert!(std < 0.6 * constant.value, "{of}: {constant:?}");
                // Few residuals hardly tell their own scatter, so the widest is Student's of two.
                assert!(
                    (constant.value - truth).abs() < 4.3 * std + 2e-3 * truth,
                    "{of}: {constant:?}, truth {truth:e}"
                );
            }
        }
    }
}

#[test]
fn val_any_number_of_frequencies_is_answered_honestly() {
    for (edges, lines) in [("free", &FREE[..]), ("pinned", &PINNED), ("clamped", &CLAMPED)] {
        for count in 1..=lines.len() {
            assert_honest(&identified(edges, &lines[..count], ""), &format!("{edges}, {count} lines"));
        }
        for line in lines {
            assert_honest(&identified(edges, &[*line], ""), &format!("{edges}, {line:?} alone"));
        }
    }
}

/// One torsion mode tells the shear modulus of the faces, and not their stiffness in bending.
#[test]
fn one_torsion_mode_shows_the_shear_modulus_alone() {
    let found = identified("free", &FREE[1..2], "");
    let free: Vec<&str> = found.constants.iter().filter(|constant| !constant.held).map(|one| one.name).collect();
    assert_eq!(free, ["g_xy"]);
}

/// With a constant held the search starts beside it, wherever that is: all are found as they are without.
#[test]
fn val_held_constants_are_where_a_search_starts() {
    let scaled = |factor: f64| FREE.map(|(value, nodes)| (value * factor.sqrt(), nodes));
    for factor in [1e-3, 1.0, 30.0] {
        for (name, truth) in TRUTH {
            let truth = if name == "nu_xy" { truth } else { factor * truth };
            let found = identified("free", &scaled(factor), &format!("[constants]\n{name} = {truth:e}"));
            assert!(found.frequency_rms_percent < 0.05, "{name}, {factor}: {} %", found.frequency_rms_percent);
            let e_x = found.constants[0].value / (factor * TRUTH[0].1);
            assert!((e_x - 1.0).abs() < 0.02, "{name}, {factor}: e_x {e_x}");
        }
    }
}
