//! Lists of a plate's modes whose names are shifted by one from a line on, lists with one line that is no mode of the others' plate, and
//! pieces that differ in a constant: what is said of them.

use crate::support::plate::{FREE, TRUTH, listed};
use orthopanel_data::ImpactTest;
use orthopanel_identify::{Search, identify};
use orthopanel_model::{Boundary, MindlinPlate, Piece, ritz_modes};

/// What is said of a list: the notes, or the refusal.
fn told(test: &ImpactTest) -> String {
    match identify(test, Search::LeastSquares) {
        Ok(found) => found.notes.join("; "),
        Err(error) => error.to_string(),
    }
}

/// The values and the names of [`FREE`], each without one, as far as both go.
fn listed_without(value: Option<usize>, name: Option<usize>) -> ImpactTest {
    let kept = |left_out: Option<usize>| (0..FREE.len()).filter(move |line| Some(*line) != left_out);
    let lines: Vec<(f64, [usize; 2])> =
        kept(value).zip(kept(name)).map(|(value, name)| (FREE[value].0, FREE[name].1)).collect();
    listed(&lines, "", "")
}

/// A mode was measured but passed over when names were given.
#[test]
fn names_shifted_by_a_name_passed_over_are_told() {
    for passed in [3, 5] {
        let told = told(&listed_without(None, Some(passed)));
        let (value, nodes) = FREE[passed];
        assert!(
            told.contains(&format!("from {value} Hz named")) && told.contains("shifted by one"),
            "{passed}: {told}"
        );
        assert!(told.contains(&format!("this line may be {nodes:?}")), "{passed}: {told}");
    }
}

/// A mode was not measured, and the others were given the names in order.
#[test]
fn names_shifted_by_a_mode_that_was_not_measured_are_told() {
    for passed in [1, 6] {
        let told = told(&listed_without(Some(passed), None));
        let nodes = FREE[passed].1;
        assert!(told.contains(&format!("from {} Hz named {nodes:?}", FREE[passed + 1].0)), "{passed}: {told}");
        assert!(told.contains(&format!("no frequency of the mode {nodes:?} was measured")), "{passed}: {told}");
        assert!(told.contains("3191.4 Hz, may be [5, 1]"), "{passed}: {told}");
    }
}

/// The line that is missed most is another one.
#[test]
fn the_line_with_an_impossible_name_is_blamed() {
    for (line, nodes) in [(5, [7, 3]), (3, [6, 1]), (6, [0, 4])] {
        let mut lines = FREE;
        lines[line].1 = nodes;
        let told = told(&listed(&lines, "", ""));
        assert!(told.contains(&format!("{} Hz named {nodes:?}", FREE[line].0)), "{line}: {told}");
        let others = FREE.iter().filter(|own| own.0 != FREE[line].0);
        others.for_each(|other| assert!(!told.contains(&format!("{} Hz named", other.0)), "{line}: {told}"));
        // No other line shows e_y: a plate soft across the width has a mode [0, 4] there.
        let likely =
            if nodes == [0, 4] { "e_y rests on this line alone".to_owned() } else { format!("{:?}", FREE[line].1) };
        assert!(told.contains(&likely), "{line}: {told}");
    }
}

/// The first modes of a plate.
fn modes(piece: &Piece, values: &[f64], count: usize) -> (Vec<f64>, Vec<[usize; 2]>) {
    let plate = MindlinPlate::with_basis_for(piece, Boundary::FREE, values, count).unwrap();
    let modes = ritz_modes(&plate, values, count).unwrap();
    let flexible = modes.iter().filter(|mode| mode.angular_frequency > 0.0);
    flexible.map(|mode| (mode.angular_frequency / std::f64::consts::TAU, plate.mode_name(mode).nodes)).unzip()
}

/// Two pieces of which one has a stiffer core.
#[test]
fn a_constant_that_pieces_do_not_share_is_named() {
    let mut text = "structure = \"mindlin-plate\"\n".to_owned();
    for (name, width, factor) in [("narrow", 0.2, 1.0), ("wide", 0.3, 1.2)] {
        let piece = Piece { length: 0.8, width, thickness: 0.03, mass_per_area: 6.88 };
        let mut values = TRUTH.map(|(_, value)| value);
        values[5] *= factor;
        let (values, shapes) = modes(&piece, &values, 10);
        text += &format!(
            "[[piece]]\nname = \"{name}\"\nlength = 0.8\nwidth = {width}\nthickness = 0.03\nmass_per_area = 6.88\n\
             [[measurement]]\npiece = \"{name}\"\nkind = \"natural-frequencies\"\nvalues = {values:?}\nshape = {shapes:?}\n"
        );
    }
    let found = identify(&ImpactTest::from_toml(&text, "test.toml").unwrap(), Search::LeastSquares).unwrap();
    assert!(found.frequency_rms_percent > 0.5, "{} %", found.frequency_rms_percent);
    assert!(found.notes.iter().any(|note| note.contains("own_constants = [\"g_zx\"]")), "{:?}", found.notes);
    let own = text.replace("name = \"wide\"\nlength", "name = \"wide\"\nown_constants = [\"g_zx\"]\nlength");
    let found = identify(&ImpactTest::from_toml(&own, "test.toml").unwrap(), Search::LeastSquares).unwrap();
    assert!(found.frequency_rms_percent < 0.05 && found.notes.is_empty(), "{:?}", found.notes);
}
