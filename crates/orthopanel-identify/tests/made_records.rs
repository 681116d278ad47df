//! Identification from hammer records made by `tests/record_generator`, which shares no code with the crates.
//!
//! These need Python with numpy and scipy, named by `ORTHOPANEL_PYTHON`; without it they say so and pass.

use std::path::{Path, PathBuf};
use std::process::Command;

use orthopanel_data::ImpactTest;
use orthopanel_identify::{Identification, IdentifyError, PaperWeights, Search, Settings, identify};

/// Table 9's constants and damping, which the generator puts in unless told otherwise.
const E_X: f64 = 1.067e10;
const G_ZX: f64 = 5.304e8;
const ZETAS: [f64; 6] = [2.364e-3, 1.306e-3, 1.108e-3, 2.251e-3, 5.485e-3, 4.488e-3];

/// Makes a test with the generator; `None` where there is no Python for it.
fn made(folder: &Path, options: &[&str]) -> Option<ImpactTest> {
    let Some(python) = std::env::var_os("ORTHOPANEL_PYTHON") else {
        println!("skipped: ORTHOPANEL_PYTHON names no Python with numpy and scipy");
        return None;
    };
    // Tests run in the crate's folder, whatever the variable was relative to.
    let output = Command::new(PathBuf::from(python))
        .current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests"))
        .args(["-m", "record_generator"])
        .arg(folder)
        .args(options)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(ImpactTest::read(folder.join("test.toml")).unwrap())
}

fn assert_truth(found: &Identification, zeta_tolerance: f64, name: &str) {
    let relative = |index: usize, truth: f64| (found.constants[index].value / truth - 1.0).abs();
    assert!(relative(0, E_X) < 1e-3, "{name}: E_x {:e}", found.constants[0].value);
    assert!(relative(1, G_ZX) < 3e-3, "{name}: G_zx {:e}", found.constants[1].value);
    for (mode, truth) in ZETAS.iter().enumerate() {
        let zeta = found.pieces[0].damping[mode].value;
        assert!((zeta / truth - 1.0).abs() < zeta_tolerance, "{name}: zeta {} = {zeta:e}, truth {truth:e}", mode + 1);
    }
}

#[test]
fn val_one_place_gives_constants_and_damping() {
    for noise in ["0.001", "0.003", "0.01"] {
        let folder = tempfile::tempdir().unwrap();
        let Some(test) = made(&folder.path().join("one"), &["--noise", noise, "--seed", "11"]) else { return };
        let found = identify(&test, Settings::default()).unwrap();
        assert_truth(&found, 0.03, &format!("noise {noise}"));
        // The records lack nothing that the model has, so the misfit is the noise.
        let chi_square = found.chi_square.unwrap();
        assert!((0.8..1.25).contains(&chi_square), "noise {noise}: chi-square {chi_square}");
    }
}

#[test]
fn val_five_places_give_constants_and_damping() {
    for noise in ["0.001", "0.01"] {
        let folder = tempfile::tempdir().unwrap();
        let options = ["--five-places", "--noise", noise, "--seed", "12", "--format", "uff-binary"];
        let Some(test) = made(&folder.path().join("five"), &options) else { return };
        let found = identify(&test, Settings::default()).unwrap();
        assert_truth(&found, 0.01, &format!("noise {noise}"));
        let misses = found.pieces[0].modes.iter().filter(|mode| mode.error_percent().abs() > 0.01).count();
        assert_eq!(misses, 0, "{:?}", found.pieces[0].modes);
    }
}

/// The paper's own search on the same records: eq. 23 reads the resonances alone, and finds the same panel.
#[test]
fn val_the_papers_error_leads_to_the_same_constants() {
    for (places, noise) in [(1, "0.01"), (5, "0.001"), (5, "0.01")] {
        let folder = tempfile::tempdir().unwrap();
        let mut options = vec!["--noise", noise, "--seed", "13", "--format", "uff-binary"];
        options.extend((places == 5).then_some("--five-places"));
        let Some(test) = made(&folder.path().join("made"), &options) else { return };
        let found = identify(&test, Search::Simplex).unwrap();
        assert_truth(&found, 0.03, &format!("{places} places, noise {noise}"));
    }
}

/// With the weight on magnitudes taken away, eq. 23 is eq. 22 of the records' own resonances, and damping stays that of
/// the poles.
#[test]
fn val_weights_of_the_papers_error_are_heeded() {
    let folder = tempfile::tempdir().unwrap();
    let options = ["--five-places", "--noise", "0.01", "--seed", "13", "--format", "uff-binary"];
    let Some(test) = made(&folder.path().join("five"), &options) else { return };
    let paper_weights = PaperWeights { frequency: 1.0, magnitude: 0.0 };
    let settings = Settings { search: Search::Simplex, paper_weights, ..Settings::default() };
    let found = identify(&test, settings).unwrap();
    assert_truth(&found, 0.03, "frequencies alone");
    // Frequencies are known to a part of a line, so they meet far closer than where magnitudes have a say.
    assert!(found.frequency_rms_percent < 0.01, "{} %", found.frequency_rms_percent);
}

/// The hammer's place typed wrongly: the resonances are right, the lines between them are not.
#[test]
fn a_wrong_place_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let Some(_) = made(&folder.path().join("one"), &["--noise", "0.003", "--seed", "14"]) else { return };
    let path = folder.path().join("one/test.toml");
    let text = std::fs::read_to_string(&path).unwrap().replace("force_at = [-0.3", "force_at = [-0.02");
    let refused = identify(&ImpactTest::from_toml(&text, &path).unwrap(), Settings::default());
    assert!(matches!(refused, Err(IdentifyError::Contradiction { .. })), "{:?}", refused.map(|found| found.constants));
}

/// One place of five typed with the wrong sign, the others right: the record is named by what the test file says of it.
#[test]
fn one_wrong_place_among_five_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let options = ["--five-places", "--noise", "0.003", "--seed", "15", "--format", "uff-binary"];
    let Some(test) = made(&folder.path().join("five"), &options) else { return };
    assert!(identify(&test, Settings::default()).is_ok());
    let path = folder.path().join("five/test.toml");
    let places: Vec<f64> = test
        .measurements
        .iter()
        .filter_map(|of| match &of.data {
            orthopanel_data::MeasurementData::TimeHistory(of) => Some(of.force_at.x),
            _ => None,
        })
        .collect();
    let wrong = places.into_iter().find(|x| *x < 0.0).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    let mended = text.replacen(&format!("force_at = [{wrong}"), &format!("force_at = [{}", -0.83 * wrong), 1);
    assert_ne!(text, mended);
    let refused = identify(&ImpactTest::from_toml(&mended, &path).unwrap(), Settings::default());
    match refused {
        Err(IdentifyError::RecordContradiction { record, percent }) => {
            assert!(record.contains(&format!("force at ({}", -0.83 * wrong)) && percent > 80.0, "{record} {percent}");
        }
        other => panic!("{:?}", other.map(|found| found.constants)),
    }
}
