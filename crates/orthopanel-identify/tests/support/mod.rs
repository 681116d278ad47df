//! What tests share.

pub mod plate;

use std::path::{Path, PathBuf};
use std::process::Command;

use orthopanel_data::ImpactTest;
use serde_json::Value;

/// A test made by `tests/blind_tracing`, which shares no code with the crates, with its truth; `None` where
/// `ORTHOPANEL_PYTHON` names no Python for it.
pub fn made(folder: &Path, set: &str, kind: &str) -> Option<(ImpactTest, Value)> {
    made_with(folder, set, kind, 1001)
}

/// The same with a seed.
pub fn made_with(folder: &Path, set: &str, kind: &str, seed: u32) -> Option<(ImpactTest, Value)> {
    made_of(folder, set, (kind, 1), seed)
}

/// The first of a kind in a set of some count.
pub fn made_of(folder: &Path, set: &str, (kind, count): (&str, usize), seed: u32) -> Option<(ImpactTest, Value)> {
    let Some(python) = std::env::var_os("ORTHOPANEL_PYTHON") else {
        println!("skipped: ORTHOPANEL_PYTHON names no Python with numpy, scipy and pyuff");
        return None;
    };
    // Tests run in the crate's folder, whatever the variable was relative to.
    let output = Command::new(PathBuf::from(python))
        .current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests"))
        .args(["-m", "blind_tracing", "make"])
        .arg(folder)
        .args(["--set", set, "--kind", kind, "--count", &count.to_string(), "--seed", &seed.to_string()])
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let truth: Value = serde_json::from_str(&std::fs::read_to_string(folder.join("truth.json")).unwrap()).unwrap();
    let case = truth["cases"][0].clone();
    Some((ImpactTest::read(folder.join(case["case"].as_str().unwrap()).join("test.toml")).unwrap(), case))
}

/// Hammer records made by `tests/record_generator`, which shares no code with the crates; `None` where
/// `ORTHOPANEL_PYTHON` names no Python for it.
pub fn hammer_test(folder: &Path, options: &[&str]) -> Option<ImpactTest> {
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

/// A folder or file of the real measurements: named by `ORTHOPANEL_DATA`, or `../shared/data` beside the repository. Prints
/// why and returns `None` where it is absent.
pub fn shared_data(name: &str) -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let found = std::env::var_os("ORTHOPANEL_DATA").map_or(beside, PathBuf::from).join(name);
    if found.exists() {
        return Some(found);
    }
    println!("skipped: {} is not there (set ORTHOPANEL_DATA)", found.display());
    None
}

/// Normal numbers of variance one: a linear congruential generator and Box and Muller's transform.
pub struct Normal(pub u64);

impl Normal {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    pub fn next(&mut self) -> f64 {
        (-2.0 * self.uniform().ln()).sqrt() * (std::f64::consts::TAU * self.uniform()).cos()
    }
}
