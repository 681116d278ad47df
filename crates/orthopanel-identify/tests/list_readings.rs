//! Lists of beams that are not what the test file takes them for: modes missing, a line misread, a piece of another make, a constant that no line shows.

use std::f64::consts::TAU;

use orthopanel_data::ImpactTest;
use orthopanel_identify::{Identification, Search, Verdict, identify, trace};

use crate::support::plate;

/// The paper's piece 1 (table 5, "Experiment") \[Hz\].
const PIECE_1: [f64; 6] = [321.3, 837.5, 1520.0, 2312.5, 3150.0, 3987.5];
/// Its model (table 4), by `orthopanel modes` \[Hz\].
const MODEL: [f64; 8] = [321.38, 837.56, 1522.45, 2306.08, 3141.71, 4000.46, 4866.42, 5731.42];
/// What each line of a sound panel may miss \[1\].
const SCATTER: [f64; 8] = [1e-3, -0.6e-3, 0.2e-3, -1.2e-3, 0.4e-3, 0.9e-3, -0.7e-3, 0.1e-3];

fn list(piece: &str, values: &[f64], more: &str) -> String {
    format!("[[measurement]]\npiece = \"{piece}\"\nkind = \"natural-frequencies\"\nvalues = {values:?}\n{more}\n")
}

fn piece(name: &str) -> String {
    format!("[[piece]]\nname = \"{name}\"\nlength = 0.8\nwidth = 0.1\nthickness = 0.03\nmass_per_area = 6.88\n")
}

fn test(text: &str) -> ImpactTest {
    ImpactTest::from_toml(text, "list.toml").unwrap()
}

fn of_one(values: &[f64], more: &str) -> ImpactTest {
    test(&(piece("1") + &list("1", values, more)))
}

fn identified(test: &ImpactTest) -> Identification {
    identify(test, Search::LeastSquares).unwrap()
}

fn measured() -> Vec<f64> {
    MODEL.iter().zip(SCATTER).map(|(frequency, miss)| frequency * (1.0 + miss)).collect()
}

/// E_x was 1.02e11 without a word.
#[test]
fn val_a_list_without_its_first_mode_is_read_from_the_second() {
    let whole = identified(&of_one(&PIECE_1, ""));
    assert!(whole.notes.is_empty() && whole.question.is_none(), "{:?}", whole.notes);
    let found = identified(&of_one(&PIECE_1[1..], ""));
    let told = identified(&of_one(&PIECE_1[1..], "shape = [[3, 0], [4, 0], [5, 0], [6, 0], [7, 0]]"));
    for index in 0..2 {
        assert!((found.constants[index].value / whole.constants[index].value - 1.0).abs() < 0.01, "{found:?}");
        assert_eq!(found.constants[index], told.constants[index]);
    }
    assert!(found.notes[0].contains("missing below the first frequency (near 321."), "{:?}", found.notes);
    assert!(told.notes.is_empty(), "{:?}", told.notes);
}

#[test]
fn modes_missing_below_and_between_are_told() {
    let frequencies = measured();
    let two_below = identified(&of_one(&frequencies[2..], ""));
    assert!(two_below.notes[0].contains("2 modes seem to be missing below"), "{:?}", two_below.notes);
    let between = [&frequencies[..3], &frequencies[4..]].concat();
    let between = identified(&of_one(&between, ""));
    assert!(
        between.notes[0].contains("missing between 1522.") && between.notes[0].contains("(near 230"),
        "{:?}",
        between.notes
    );
    for found in [two_below, between] {
        assert!((found.constants[0].value / 1.07e10 - 1.0).abs() < 0.01, "{:?}", found.constants);
    }
}

/// The beam's modes stood for the first ones, whatever `shape` named them.
#[test]
fn a_trace_goes_by_the_shapes_of_a_beams_list() {
    let found = trace(&of_one(&PIECE_1[1..], "shape = [[3, 0], [4, 0], [5, 0], [6, 0], [7, 0]]")).unwrap();
    assert!(found.error.before.fitted < 0.3, "{:?}", found.error);
    let read = trace(&of_one(&PIECE_1[1..], "")).unwrap();
    assert_eq!((read.verdict, read.error.before), (Verdict::Ambiguous, found.error.before));
    assert!(read.notes[0].contains("a mode seems to be missing"), "{:?}", read.notes);
}

#[test]
fn a_line_that_fits_no_mode_is_left_out_and_told_by_how_much() {
    let mut frequencies = measured();
    frequencies[4] *= 1.04;
    let test = of_one(&frequencies, "");
    let found = identified(&test);
    let said = &found.notes[0];
    assert!(said.contains("mode 5, 3268.") && said.contains("+4.0") && said.contains("left out"), "{said}");
    assert_eq!(found.pieces[0].modes.len(), MODEL.len() - 1);
    assert!(found.frequency_rms_percent < 0.1 && found.question.is_none());
    let traced = trace(&test).unwrap();
    assert_eq!((traced.verdict, &traced.notes[0]), (Verdict::NothingMissing, said));
    // Of the paper's six lines, which scatter by 0.2 %, it is not clear: asked, not left out.
    let mut frequencies = PIECE_1;
    frequencies[3] += 100.0;
    let test = of_one(&frequencies, "");
    let (found, traced) = (identified(&test), trace(&test).unwrap());
    let question = found.question.as_deref().unwrap();
    assert!(question.contains("mode 4, 2412.5 Hz") && question.contains("+4.6"), "{question}");
    assert_eq!(found.pieces[0].modes.len(), PIECE_1.len());
    assert_eq!((traced.verdict, traced.next_experiment.as_str()), (Verdict::Ambiguous, question));
}

#[test]
fn a_piece_that_is_none_of_the_others_is_left_out_and_told_by_how_much() {
    let text: String = ["a", "b", "c"].into_iter().map(piece).collect();
    let of = |name: &str, factor: f64, turn: usize| {
        let values: Vec<f64> = (0..6).map(|mode| factor * MODEL[mode] * (1.0 + SCATTER[(mode + turn) % 8])).collect();
        list(name, &values, "")
    };
    let alike = identified(&test(&(text.clone() + &of("a", 1.0, 0) + &of("b", 1.0, 3) + &of("c", 1.0, 5))));
    assert!(alike.notes.is_empty(), "{:?}", alike.notes);
    let found = identified(&test(&(text + &of("a", 1.0, 0) + &of("b", 1.0, 3) + &of("c", 1.08, 5))));
    let said = &found.notes[0];
    assert!(said.starts_with("piece c does not fit") && said.contains("+8.") && said.contains("left out"), "{said}");
    assert_eq!(found.pieces.iter().map(|piece| piece.modes.len()).collect::<Vec<_>>(), [6, 6, 0]);
    assert!((found.constants[0].value / 1.07e10 - 1.0).abs() < 0.01, "{:?}", found.constants);
}

/// What a mass does to all modes is no line that is misread.
#[test]
fn a_list_of_a_panel_with_a_mass_is_read_as_it_stands() {
    let masses = [312.23, 805.43, 1473.19, 2112.94, 2913.38, 3915.37, 4620.07, 5626.65, 6292.9, 6770.6];
    let found = identified(&of_one(&masses, ""));
    assert!(found.notes.is_empty() && found.question.is_none(), "{:?}", found.notes);
}

/// A free bar without shear and rotary inertia, $f_m = \lambda_m^2/(2\pi L^2)\sqrt{EI/\mu}$, whose lines rise by noise where shear would have them fall: the
/// shear modulus ran to its bound, and the list was refused.
#[test]
fn val_a_thin_strips_shear_modulus_is_held_and_said() {
    let (length, width, thickness, mass_per_area, e_x) = (1.25, 0.16, 0.003_f64, 23.5, 2e11);
    let root = (e_x * thickness.powi(3) / (12.0 * mass_per_area)).sqrt();
    let lambda =
        |mode: usize| [4.730_040_745, 7.853_204_624].get(mode).copied().unwrap_or((mode as f64 + 1.5) * TAU / 2.0);
    let values: Vec<f64> =
        (0..9).map(|mode| (1.0 + 3e-4 * mode as f64) * lambda(mode).powi(2) * root / (TAU * length * length)).collect();
    let text = format!(
        "[[piece]]\nname = \"1\"\nlength = {length}\nwidth = {width}\nthickness = {thickness}\nmass_per_area = {mass_per_area}\n"
    );
    let found = identified(&test(&(text + &list("1", &values, ""))));
    assert!((found.constants[0].value / e_x - 1.0).abs() < 0.02, "{:?}", found.constants);
    assert!(found.constants[1].held && found.constants[0].std.is_some(), "{:?}", found.constants);
    let [unseen] = &found.not_identified[..] else { panic!("{:?}", found.not_identified) };
    assert_eq!(unseen.name, "g_zx");
    assert!(found.notes.is_empty(), "{:?}", found.notes);
}

/// Not far better, for all lines scatter by 0.6 %, but as likely.
#[test]
fn neighbours_that_may_have_each_others_names_are_told() {
    let scatter = |line: usize| 0.006 * [1.0, -1.0, 0.3][line % 3];
    let mut lines = plate::FREE.map(|(frequency, nodes)| (frequency, nodes));
    lines.iter_mut().enumerate().for_each(|(line, (frequency, _))| *frequency *= 1.0 + scatter(line));
    let named = lines;
    (lines[8].1, lines[9].1) = (named[9].1, named[8].1);
    let found = identified(&plate::listed(&lines, "", ""));
    let said = "named [5, 1] and ";
    assert!(
        found.notes.iter().any(|note| note.contains(said) && note.contains("each other's names")),
        "{:?}",
        found.notes
    );
    let right = identified(&plate::listed(&named, "", ""));
    assert!(right.notes.iter().all(|note| !note.contains("each other's names")), "{:?}", right.notes);
}

/// 30 g at 210 mm and a disbond of 60 % over 80 mm at -120 mm, put in by `orthopanel modes`: neither explains much by itself.
#[test]
fn two_effects_that_each_do_little_alone_are_found_together() {
    let values =
        [320.24, 808.79, 1403.83, 2214.34, 3049.22, 3700.33, 4442.19, 5276.0, 6240.78, 6950.71, 7548.42, 8439.82];
    let found = trace(&of_one(&values, "")).unwrap();
    let ids: Vec<&str> = found.effects.iter().map(|effect| effect.id).collect();
    assert_eq!((found.verdict, &ids[..]), (Verdict::Explained, &["local-mass", "stiffness-loss"][..]));
    let value = |effect: usize, name: &str| {
        found.effects[effect].parameters.iter().find(|parameter| parameter.name == name).unwrap().values[0].value
    };
    for (found, truth) in [(value(0, "mass"), 0.03), (value(1, "loss"), 0.6), (value(1, "span"), 0.08)] {
        assert!((found / truth - 1.0).abs() < 0.01, "{found} {truth}");
    }
}
