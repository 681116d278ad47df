//! Tracing on hammer tests made by `tests/blind_tracing`, which shares no code with the crates.
//!
//! These need Python with numpy, scipy and pyuff, named by `ORTHOPANEL_PYTHON`; without it they say so and pass.

use std::path::{Path, PathBuf};
use std::process::Command;

use orthopanel_data::ImpactTest;
use orthopanel_identify::{Tracing, Verdict, trace};
use serde_json::Value;

/// A made test with its truth; `None` where there is no Python for it.
fn made(folder: &Path, set: &str, kind: &str) -> Option<(ImpactTest, Value)> {
    let Some(python) = std::env::var_os("ORTHOPANEL_PYTHON") else {
        println!("skipped: ORTHOPANEL_PYTHON names no Python with numpy, scipy and pyuff");
        return None;
    };
    // Tests run in the crate's folder, whatever the variable was relative to.
    let output = Command::new(PathBuf::from(python))
        .current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests"))
        .args(["-m", "blind_tracing", "make"])
        .arg(folder)
        .args(["--set", set, "--kind", kind, "--count", "1", "--seed", "1001"])
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let truth: Value = serde_json::from_str(&std::fs::read_to_string(folder.join("truth.json")).unwrap()).unwrap();
    let case = truth["cases"][0].clone();
    Some((ImpactTest::read(folder.join(case["case"].as_str().unwrap()).join("test.toml")).unwrap(), case))
}

fn value(found: &Tracing, parameter: &str) -> (f64, f64) {
    let estimate = found.effects[0].parameters.iter().find(|known| known.name == parameter).unwrap().values[0];
    (estimate.value, estimate.std.unwrap())
}

#[test]
fn val_an_effect_put_in_is_named_and_measured() {
    for (kind, parameter) in [("sensor-mass", "mass"), ("record-gain", "gain"), ("channel-delay", "delay")] {
        let folder = tempfile::tempdir().unwrap();
        let Some((test, case)) = made(&folder.path().join("set"), "clean", kind) else { return };
        let found = trace(&test).unwrap();
        assert!(matches!(found.verdict, Verdict::Explained | Verdict::Ambiguous), "{kind}: {}", found.verdict.name());
        assert_eq!(found.effects[0].id, kind);
        let truth = case["effects"][0]["parameters"][parameter].as_f64().unwrap();
        let (value, std) = value(&found, parameter);
        // Five standard deviations: the generator's own solution may differ by a small part of the noise.
        assert!((value - truth).abs() < 5.0 * std + 1e-3 * truth.abs(), "{kind}: {value} +- {std}, truth {truth}");
        assert!(found.error.after.held_out < 1.2 * found.error.noise_floor, "{kind}: {:?}", found.error);
    }
}

#[test]
fn val_nothing_is_missing_where_nothing_was_put_in() {
    let folder = tempfile::tempdir().unwrap();
    let Some((test, _)) = made(&folder.path().join("set"), "none", "none") else { return };
    let found = trace(&test).unwrap();
    assert_eq!((found.verdict, found.effects.len()), (Verdict::NothingMissing, 0));
    assert_eq!(found.error.before, found.error.after);
    let json = serde_json::to_value(&found).unwrap();
    assert_eq!((&json["schema"], &json["verdict"]), (&"orthopanel.trace/1".into(), &"nothing-missing".into()));
    // A free piece has no clamp that could yield.
    let reason = found.not_tested.iter().find(|known| known.id == "support-compliance").unwrap();
    assert!(reason.reason.contains("clamped"), "{}", reason.reason);
}
