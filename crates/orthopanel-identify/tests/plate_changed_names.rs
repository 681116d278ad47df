//! Lists of a plate's modes in which two lines next to each other have changed their names. `fmpy-checks/test_plate_names.py` changes
//! every two of a list.

use crate::support::plate::{FREE, listed};
use orthopanel_data::ImpactTest;
use orthopanel_identify::{Search, identify};
use orthopanel_model::{Boundary, MindlinPlate, Piece, ritz_modes};

/// What is said of the list with two names changed: the notes, or the error where no search ends.
fn told(one: usize, other: usize) -> String {
    let mut lines = FREE;
    (lines[one].1, lines[other].1) = (FREE[other].1, FREE[one].1);
    match identify(&listed(&lines, "", ""), Search::LeastSquares) {
        Ok(found) => found.notes.join("; "),
        Err(error) => error.to_string(),
    }
}

fn assert_told(one: usize, other: usize) {
    let told = told(one, other);
    for (own, wrong) in [(FREE[one], FREE[other]), (FREE[other], FREE[one])] {
        assert!(told.contains(&format!("{} Hz named {:?}", own.0, wrong.1)), "{one} {other}: {told}");
        assert!(told.contains(&format!("and {:?} at", own.1)), "{one} {other}: {told}");
    }
}

/// Pairs whose search under the names of the file found no minimum at first. Since all constants move at once the search of each of the
/// 45 pairs ends somewhere, so that no refusal for want of a minimum is left to be tested here; the pairs must be told all the same.
#[test]
fn pairs_that_led_to_no_minimum_are_told() {
    [(3, 5), (4, 5), (5, 7)].into_iter().for_each(|(one, other)| assert_told(one, other));
}

/// 3144.8 and 3191.4 Hz: with each other's names no line misses by 1 %.
#[test]
fn near_lines_that_changed_their_names_are_told() {
    assert_told(8, 9);
}

#[test]
fn neighbours_that_changed_their_names_are_told() {
    for one in [0, 2, 5, 7] {
        assert_told(one, one + 1);
    }
}

/// The refusal of the list with one line named otherwise.
fn refusal(line: usize, nodes: [usize; 2]) -> String {
    let mut lines = FREE;
    lines[line].1 = nodes;
    let error = identify(&listed(&lines, "", ""), Search::LeastSquares).unwrap_err();
    assert!(error.is_bad_input(), "{error}");
    error.to_string()
}

/// A mode that lies far above its line on every panel: no basis is built for it. This took up to 42 s, and memory without limit.
#[test]
fn a_name_that_no_panel_has_there_is_refused_at_once() {
    for (line, nodes) in [(9, [9, 9]), (0, [9, 9]), (4, [40, 40]), (9, [0, 30]), (9, [400, 0])] {
        let said = refusal(line, nodes);
        assert!(said.contains(&format!("{} Hz named {nodes:?}", FREE[line].0)) && said.contains("or above"), "{said}");
    }
}

/// The other lines put a mode of sixteen half-waves far above the last line: the line is named, not the constants bent to meet it.
#[test]
fn a_line_far_from_the_mode_that_it_names_is_refused() {
    let mut lines = FREE;
    lines[9].1 = [16, 0];
    let said = identify(&listed(&lines, "", ""), Search::LeastSquares).unwrap_err().to_string();
    assert!(said.contains("3191.4 Hz named [16, 0]: the other frequencies put that mode elsewhere"), "{said}");
}

/// A single line may be any mode that a basis follows.
#[test]
fn a_name_beyond_the_basis_is_refused_with_the_limit() {
    let refused = identify(&listed(&[(68000.0, [60, 45])], "", ""), Search::LeastSquares).unwrap_err();
    let said = refused.to_string();
    assert!(refused.is_bad_input() && said.contains("shape [60, 45]") && said.contains("108 x 82"), "{said}");
    assert!(said.contains("shapes up to [20, 15]"), "{said}");
}

/// Wood: its second bending mode across the grain lies low, and is no wrong name.
#[test]
fn modes_across_the_grain_are_not_refused() {
    let piece = Piece { length: 0.8, width: 0.3, thickness: 0.02, mass_per_area: 9.0 };
    let wood = [1.2e10, 4e8, 0.35, 7e8, 5e7, 7e8];
    let plate = MindlinPlate::with_basis_for(&piece, Boundary::FREE, &wood, 8).unwrap();
    let modes = ritz_modes(&plate, &wood, 8).unwrap();
    let flexible = modes.iter().filter(|mode| mode.angular_frequency > 0.0);
    let named = flexible.map(|mode| (mode.angular_frequency / std::f64::consts::TAU, plate.mode_name(mode).nodes));
    let (values, shapes): (Vec<f64>, Vec<[usize; 2]>) = named.unzip();
    assert!(shapes.contains(&[0, 2]) && shapes.contains(&[2, 0]), "{shapes:?}");
    let text = format!(
        "structure = \"mindlin-plate\"\n[piece]\nlength = 0.8\nwidth = 0.3\nthickness = 0.02\nmass_per_area = 9.0\n\
         [[measurement]]\nkind = \"natural-frequencies\"\nvalues = {values:?}\nshape = {shapes:?}\n"
    );
    let found = identify(&ImpactTest::from_toml(&text, "test.toml").unwrap(), Search::LeastSquares).unwrap();
    assert!(found.frequency_rms_percent < 0.05, "{} %", found.frequency_rms_percent);
}
