//! Lists of natural frequencies that no effect meets, or that are too short to tell: no word of comfort for these.

use orthopanel_data::ImpactTest;
use orthopanel_identify::{Tracing, Verdict, trace};

/// The paper's piece 1 (table 5, "Experiment") \[Hz\].
const PIECE_1: [f64; 6] = [321.3, 837.5, 1520.0, 2312.5, 3150.0, 3987.5];

/// Frequencies \[Hz\] of piece 1's model with effects put in, by `orthopanel modes`.
const TWO_MASSES: [f64; 10] = [312.23, 805.43, 1473.19, 2112.94, 2913.38, 3915.37, 4620.07, 5626.65, 6292.9, 6770.6];
const LOOSE_BRACKET: [f64; 10] = [321.04, 759.4, 1004.4, 1558.89, 2309.77, 3142.96, 4009.22, 4874.63, 5732.43, 6590.66];

struct List<'a> {
    length: f64,
    values: &'a [f64],
    of_list: &'a str,
    of_test: &'a str,
}

impl Default for List<'_> {
    fn default() -> Self {
        Self { length: 0.8, values: &PIECE_1, of_list: "", of_test: "" }
    }
}

impl List<'_> {
    fn test(&self) -> ImpactTest {
        let Self { length, values, of_list, of_test } = self;
        let text = format!(
            "[piece]\nlength = {length}\nwidth = 0.1\nthickness = 0.03\nmass_per_area = 6.88\n{of_test}\n\
             [[measurement]]\nkind = \"natural-frequencies\"\nvalues = {values:?}\n{of_list}\n"
        );
        ImpactTest::from_toml(&text, "list.toml").unwrap()
    }

    fn traced(&self) -> Tracing {
        trace(&self.test()).unwrap()
    }
}

#[test]
fn a_list_that_the_model_misses_is_not_called_complete() {
    let clamped = List { of_test: "[boundary]\nleft = \"clamped\"", ..List::default() };
    let wrong_unit = List { length: 800.0, ..List::default() };
    let held = List { of_test: "[constants]\ne_x = 1e8", ..List::default() };
    let bracket = List { values: &LOOSE_BRACKET, ..List::default() };
    let masses = List { values: &TWO_MASSES, ..List::default() };
    for (list, missed, largest) in
        [(wrong_unit, 100.0, 1), (held, 88.2, 1), (clamped, 6.9, 2), (bracket, 12.5, 1), (masses, 2.5, 4)]
    {
        let found = list.traced();
        assert_eq!(found.verdict, Verdict::Unexplained, "{missed} %");
        assert!((found.error.before.fitted - missed).abs() < 0.1, "{:?}", found.error);
        let said = &found.next_experiment;
        assert!(said.contains(&format!("mode {largest} (")) && said.contains("numbering"), "{said}");
    }
}

/// The rounding of an analyser is noise that a list tells; what models of panels miss beside it is no lack.
#[test]
fn a_resolution_is_noise_to_judge_by() {
    let fine = List { of_list: "resolution = 1.25", ..List::default() };
    assert_eq!(fine.traced().verdict, Verdict::NothingMissing);
    let values = [321.3, 837.5, 1540.0, 2312.5, 3120.0, 3987.5];
    let off = List { values: &values, of_list: "resolution = 0.01", ..List::default() };
    assert_eq!(off.traced().verdict, Verdict::Unexplained);
}

#[test]
fn a_list_too_short_to_test_an_effect_is_ambiguous_with_the_count() {
    let found = List { values: &PIECE_1[..3], ..List::default() }.traced();
    assert_eq!(found.verdict, Verdict::Ambiguous);
    assert!(found.alternatives.iter().any(|id| id == "edge-mass"), "{:?}", found.alternatives);
    assert!(found.next_experiment.starts_with("read 3 more"), "{}", found.next_experiment);
}
