//! Records that contradict the test file, or do not reach far enough: refused with what is wrong, or kept with a sentence.
//!
//! These need Python with numpy, scipy and pyuff, named by `ORTHOPANEL_PYTHON`; without it they say so and pass.

use crate::support::hammer_test;
use orthopanel_data::{Estimation, ImpactTest, Window};
use orthopanel_identify::{Identification, IdentifyError, Settings, Verdict, identify, trace};

/// One place at 0.3 % noise, with something in the test file written otherwise.
fn one_place_with(written: &str, instead: &str) -> Option<Result<Identification, IdentifyError>> {
    let folder = tempfile::tempdir().unwrap();
    hammer_test(&folder.path().join("one"), &["--noise", "0.003", "--seed", "14"])?;
    let path = folder.path().join("one/test.toml");
    let text = std::fs::read_to_string(&path).unwrap().replace(written, instead);
    Some(identify(&ImpactTest::from_toml(&text, &path).unwrap(), Settings::default()))
}

/// The hammer's place typed wrongly: the resonances are right, the lines between them are not.
#[test]
fn a_wrong_place_is_refused() {
    let Some(refused) = one_place_with("force_at = [-0.3", "force_at = [-0.02") else { return };
    match refused {
        Err(IdentifyError::Contradiction { record, .. }) => {
            assert!(record.contains("one/point-0-hit-1.csv"), "{record}")
        }
        other => panic!("{:?}", other.map(|found| found.constants)),
    }
}

/// The five places at 0.3 % noise, with something in the test file written otherwise.
struct Roving(tempfile::TempDir);

impl Roving {
    fn new() -> Option<Self> {
        let folder = tempfile::tempdir().unwrap();
        let options = ["--five-places", "--noise", "0.003", "--seed", "15", "--format", "uff-binary", "--hits", "3"];
        hammer_test(&folder.path().join("five"), &options)?;
        Some(Self(folder))
    }

    fn with(&self, written: &str, instead: &str) -> Result<Identification, IdentifyError> {
        let path = self.0.path().join("five/test.toml");
        let text = std::fs::read_to_string(&path).unwrap();
        let changed = text.replace(written, instead);
        assert_eq!(changed == text, written == instead, "{written} is not in the test file");
        identify(&ImpactTest::from_toml(&changed, &path).unwrap(), Settings::default())
    }
}

/// One force place of five written wrongly: by its sign, 50 mm and 30 mm beside. The others agree, so the record is left out, and named with its file and
/// the place at which it fits.
#[test]
fn one_wrong_place_among_five_is_left_out_and_named_with_the_right_one() {
    let Some(test) = Roving::new() else { return };
    let right = test.with("", "").unwrap();
    assert!(right.notes.iter().all(|note| !note.contains("orthopanel trace") && !note.contains("left out")));
    for (truth, wrong) in [(-0.21, 0.21), (0.13, 0.18), (-0.05, -0.08)] {
        let found = test.with(&format!("force_at = [{truth},"), &format!("force_at = [{wrong},")).unwrap();
        let said = &found.notes[0];
        assert!(said.contains(&format!("force at ({wrong}, 0)")) && said.contains(".uff"), "{said}");
        assert!(said.contains("left out") && said.contains(&format!("fit with force_at x = {truth:.3}")), "{said}");
        assert_eq!(found.accelerances.len(), 4, "{said}");
        for (constant, of_all) in found.constants.iter().zip(&right.constants) {
            assert!((constant.value / of_all.value - 1.0).abs() < 1e-4, "{constant:?} {of_all:?}");
        }
    }
}

#[test]
fn two_records_that_are_exchanged_are_named() {
    let Some(test) = Roving::new() else { return };
    // The places of each in the place of the other.
    let path = test.0.path().join("five/test.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    let changed =
        text.replace("force_at = [-0.21,", "force_at = [#").replace("[0.13,", "[-0.21,").replace("[#", "[0.13,");
    match identify(&ImpactTest::from_toml(&changed, &path).unwrap(), Settings::default()) {
        Err(IdentifyError::RecordContradiction { record, exchanged_with: Some(other), .. }) => {
            let both = [record, other];
            for place in ["(-0.21, 0)", "(0.13, 0)"] {
                assert_eq!(both.iter().filter(|name| name.contains(place)).count(), 1, "{both:?}");
            }
        }
        other => panic!("{:?}", other.map(|found| (found.constants, found.notes))),
    }
}

#[test]
#[ignore = "20 s of a core; all such run by `cargo test --release -- --ignored`"]
fn a_trace_leaves_out_the_record_that_contradicts_the_others() {
    let Some(test) = Roving::new() else { return };
    let path = test.0.path().join("five/test.toml");
    let text = std::fs::read_to_string(&path).unwrap().replace("force_at = [0.13,", "force_at = [0.18,");
    let found = trace(&ImpactTest::from_toml(&text, &path).unwrap()).unwrap();
    assert_eq!((found.verdict, found.effects.len()), (Verdict::NothingMissing, 0), "{:?}", found.effects);
    let said = &found.notes[0];
    assert!(said.contains("force at (0.18, 0)") && said.contains("left out"), "{said}");
}

/// A hammer that struck 6 mm beside its mark is no contradiction: constants are found, and the record is named.
#[test]
fn a_hammer_beside_its_mark_is_kept_and_named() {
    let Some(test) = Roving::new() else { return };
    let found = test.with("force_at = [0.13,", "force_at = [0.136,").unwrap();
    assert!((found.constants[0].value / 1.067e10 - 1.0).abs() < 1e-3, "{:?}", found.constants);
    let named = |note: &&String| note.contains("force at (0.136, 0)") && note.contains("force_at x = 0.13");
    assert_eq!(found.notes.iter().filter(named).count(), 1, "{:?}", found.notes);
}

/// The sensor some millimetres beside its place in every record: no record stands apart, and no sentence blames the
/// resonances, which meet.
#[test]
fn lines_between_resonances_are_not_laid_on_the_resonances() {
    let Some(test) = Roving::new() else { return };
    let found = test.with("response_at = [0.3,", "response_at = [0.285,").unwrap();
    assert!(found.frequency_rms_percent < 0.02, "{}", found.frequency_rms_percent);
    assert!(found.notes.iter().all(|note| !note.contains("lie beside")), "{:?}", found.notes);
    assert!(found.notes.iter().any(|note| note.contains("the lines between them")), "{:?}", found.notes);
}

/// Sampled so slowly that no mode, or one of two, lies in the band: the flanks of higher modes do not make up for it.
#[test]
fn a_rate_too_low_for_the_modes_is_refused_with_the_one_needed() {
    for (rate, pulse, held) in [("640", "0.001", 0), ("500", "0.002", 0), ("1000", "0.002", 1)] {
        for seed in ["3", "4"] {
            let folder = tempfile::tempdir().unwrap();
            let options = ["--hits", "3", "--samples", "1024", "--seed", seed, "--sampling-rate", rate];
            let options = [&options[..], &["--pulse-duration", pulse]].concat();
            let Some(test) = hammer_test(&folder.path().join("slow"), &options) else { return };
            match identify(&test, Settings::default()) {
                Err(error @ IdentifyError::BandTooLow { found, needed: 2, next, .. }) => {
                    assert_eq!(found, held, "{rate} Hz: {error}");
                    assert!((740.0..940.0).contains(&next), "{rate} Hz: {error}");
                }
                other => panic!("{rate} Hz: {:?}", other.map(|found| found.constants)),
            }
        }
    }
}

/// One fault in all records alike: the sensor turned round and not declared, and g taken for m/s2.
#[test]
fn a_factor_on_all_records_is_named() {
    for (factor, said) in [(-1.0, "direction = -1"), (9.80665, "response_unit = \"g\"")] {
        let folder = tempfile::tempdir().unwrap();
        let Some(_) = hammer_test(&folder.path().join("one"), &["--hits", "3", "--seed", "16"]) else { return };
        for hit in 1..=3 {
            let file = folder.path().join(format!("one/point-0-hit-{hit}.csv"));
            let text = std::fs::read_to_string(&file).unwrap();
            let wrong = |line: &str| match line.rsplit_once(',').map(|(rest, last)| (rest, last.parse::<f64>())) {
                Some((rest, Ok(value))) => format!("{rest},{}\n", value / factor),
                _ => format!("{line}\n"),
            };
            std::fs::write(&file, text.lines().map(wrong).collect::<String>()).unwrap();
        }
        let test = ImpactTest::read(folder.path().join("one/test.toml")).unwrap();
        let refused = identify(&test, Settings::default()).unwrap_err();
        assert!(refused.to_string().contains(said), "{refused}");
        match refused {
            IdentifyError::OtherUnits { factor: found, derivatives: 0, records: None, .. } => {
                assert!((found / factor - 1.0).abs() < 0.01, "{found}");
            }
            other => panic!("{other}"),
        }
    }
}

/// Records in which nothing but noise is left: no constants come out of them.
#[test]
fn mere_noise_gives_no_constants() {
    let folder = tempfile::tempdir().unwrap();
    let Some(test) = hammer_test(&folder.path().join("one"), &["--hits", "3", "--seed", "17"]) else { return };
    // Hann's window is zero where the blow is: 256 samples after the start.
    let estimation = Estimation { window: Window::Hann, ..Estimation::default() };
    let refused = identify(&test, Settings { estimation, ..Settings::default() }).map(|found| found.constants);
    match refused {
        Err(error @ IdentifyError::TooFewResonances { noise_percent: Some(_), .. }) => {
            let said = error.to_string();
            assert!(said.contains("too much noise") && said.contains("Hann"), "{said}");
            // The files are in order: it is what they hold that says no.
            assert!(!error.is_bad_input());
        }
        other => panic!("{other:?}"),
    }
}

/// A length in another unit, with a thickness that is right: told at once, and not searched for among thousands of modes.
#[test]
fn a_piece_too_large_for_its_records_is_told() {
    let Some(refused) = one_place_with("length = 0.8", "length = 80") else { return };
    match refused {
        Err(refused @ IdentifyError::PieceTooLarge { .. }) => {
            assert!(refused.to_string().contains("a piece 80 m long"), "{refused}")
        }
        other => panic!("{:?}", other.map(|found| found.constants)),
    }
}
