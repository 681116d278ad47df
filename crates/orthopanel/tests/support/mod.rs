//! Runs the program in a folder of its own, with the examples beside it.

// Each test file uses its own part of this.
#![allow(dead_code)]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use tempfile::TempDir;

pub const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// A model of the paper's piece 1 with the constants of table 4.
pub const MODEL: &str = r#"{"schema": "orthopanel.model/1",
 "piece": {"length": 0.8, "width": 0.1, "thickness": 0.03, "mass_per_area": 6.88},
 "structure": "timoshenko-beam", "constants": {"e_x": 1.07e10, "g_zx": 5.363e8}, "damping": {"beyond": 0.003},
 "ports": {"forces": [[-0.3, 0]], "responses": [[0.3, 0]]}}"#;

/// A test of the paper's piece 1 (table 5).
pub const TEST: &str = "[piece]\nlength = 0.8\nwidth = 0.1\nthickness = 0.03\nmass_per_area = 6.88\n[[measurement]]\n\
                        kind = \"natural-frequencies\"\nvalues = [321.3, 837.5, 1520.0, 2312.5, 3150.0, 3987.5]\n";

/// A half-sine hit, coarse and not even in time.
pub const FORCE: &str = "time_s,force_n\n0,0\n1e-4,58.8\n2.5e-4,100\n4e-4,58.8\n5e-4,0\n6e-4,0\n2e-3,0\n5e-3,0\n";

pub struct Bench {
    pub folder: TempDir,
}

impl Bench {
    pub fn new() -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        for (name, text) in [("model.json", MODEL), ("test.toml", TEST), ("force.csv", FORCE)] {
            std::fs::write(folder.path().join(name), text).expect("a file is written");
        }
        copy(&Path::new(ROOT).join("examples"), &folder.path().join("examples"));
        Self { folder }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Runs `orthopanel` with the words of `line`, divided by blanks.
    pub fn run(&self, line: &str) -> Output {
        Command::new(env!("CARGO_BIN_EXE_orthopanel"))
            .args(line.split_whitespace())
            .current_dir(self.folder.path())
            .output()
            .expect("the program starts")
    }

    /// Runs and wants success; gives standard output.
    pub fn done(&self, line: &str) -> String {
        let output = self.run(line);
        assert_eq!(output.status.code(), Some(0), "{line}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).expect("UTF-8")
    }

    /// Runs with `--json`; standard output must hold one JSON object and nothing else.
    pub fn json(&self, line: &str) -> serde_json::Value {
        let text = self.done(&format!("{line} --json"));
        let value: serde_json::Value = serde_json::from_str(&text).expect("one JSON object");
        assert!(value.is_object());
        value
    }

    /// The rows of numbers of a CSV file.
    pub fn rows(&self, name: &str) -> Vec<Vec<f64>> {
        let text = std::fs::read_to_string(self.path(name)).expect("a CSV file");
        let row = |line: &str| line.split(',').map(|cell| cell.parse().expect("a number")).collect();
        text.lines().skip(1).map(row).collect()
    }

    /// Names of all files and folders here, those below folders too.
    pub fn listing(&self) -> Vec<PathBuf> {
        let mut found = Vec::new();
        let mut folders = vec![self.folder.path().to_path_buf()];
        while let Some(folder) = folders.pop() {
            for entry in std::fs::read_dir(folder).expect("a folder") {
                let path = entry.expect("an entry").path();
                if path.is_dir() {
                    folders.push(path.clone());
                }
                found.push(path);
            }
        }
        found.sort();
        found
    }
}

fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).expect("a folder is made");
    for entry in std::fs::read_dir(from).expect("a folder") {
        let entry = entry.expect("an entry");
        let target = to.join(entry.file_name());
        if entry.path().is_dir() {
            copy(&entry.path(), &target);
        } else {
            std::fs::copy(entry.path(), target).expect("a file is copied");
        }
    }
}

pub fn number(value: &serde_json::Value, path: &str) -> f64 {
    value.pointer(path).and_then(serde_json::Value::as_f64).unwrap_or_else(|| panic!("no number at {path}: {value}"))
}
