//! Runs the program in a folder of its own, with the examples beside it.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

pub const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// A model of the paper's piece 1 with the constants of table 4.
pub const MODEL: &str = r#"{"schema": "orthopanel.model/1",
 "piece": {"length": 0.8, "width": 0.1, "thickness": 0.03, "mass_per_area": 6.88},
 "structure": "timoshenko-beam", "constants": {"e_x": 1.07e10, "g_zx": 5.363e8}, "damping": {"beyond": 0.003},
 "ports": {"forces": [[-0.3, 0]], "responses": [[0.3, 0]]}}"#;

/// A plate of the size of the paper's piece 2, with constants of the order of its faces and core.
pub const PLATE: &str = r#"{"schema": "orthopanel.model/1",
 "piece": {"length": 0.8, "width": 0.2, "thickness": 0.03, "mass_per_area": 6.88},
 "structure": "mindlin-plate", "constants":
  {"e_x": 1.07e10, "e_y": 1.07e10, "nu_xy": 0.3, "g_xy": 4.1e9, "g_yz": 3e8, "g_zx": 5.363e8},
 "damping": {"beyond": 0.003}, "ports": {"forces": [[-0.3, -0.05]], "responses": [[0.3, 0.05]]}}"#;

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
        for (name, text) in [("model.json", MODEL), ("plate.json", PLATE), ("test.toml", TEST), ("force.csv", FORCE)] {
            std::fs::write(folder.path().join(name), text).expect("a file is written");
        }
        copy(&Path::new(ROOT).join("examples"), &folder.path().join("examples"));
        Self { folder }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path(name), text).expect("a file is written");
    }

    /// The example's hits of a free beam under a file that says something more, and where that file is.
    pub fn made_hits(&self, said: &str) -> &'static str {
        let test = std::fs::read_to_string(self.path("examples/made-hits/test.toml")).expect("a test");
        let name = "examples/made-hits/said.toml";
        self.write(name, &changed(&test, "[[measurement]]", &format!("{said}[[measurement]]")));
        name
    }

    /// `orthopanel` with the words of `line`, divided by blanks; what it says is thrown away unless asked for.
    pub fn command(&self, line: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_orthopanel"));
        command.args(line.split_whitespace()).current_dir(self.folder.path());
        // Answers hold a date: two runs are to give the same bytes.
        command.env("SOURCE_DATE_EPOCH", DATE.0);
        command.stdout(Stdio::null()).stderr(Stdio::null());
        command
    }

    /// Runs `orthopanel` with the words of `line`.
    pub fn run(&self, line: &str) -> Output {
        self.command(line).stdout(Stdio::piped()).stderr(Stdio::piped()).output().expect("the program starts")
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

    /// A file that holds one JSON object.
    pub fn read_json(&self, name: &str) -> serde_json::Value {
        let text = std::fs::read_to_string(self.path(name)).expect("a JSON file");
        serde_json::from_str(&text).expect("one JSON object")
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

/// The date of all answers, in seconds after 1970 and as they tell it.
pub const DATE: (&str, &str) = ("1764527167", "2025-11-30T18:26:07Z");

pub fn number(value: &serde_json::Value, path: &str) -> f64 {
    value.pointer(path).and_then(serde_json::Value::as_f64).unwrap_or_else(|| panic!("no number at {path}: {value}"))
}

/// Runs `line` and wants it refused with `code` and one line on standard error that holds all of `said`.
pub fn refused(bench: &Bench, line: &str, code: i32, said: &[&str]) {
    let before = bench.listing();
    let output = bench.run(line);
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{line}: {message}");
    assert_eq!(message.lines().count(), 1, "{line}: {message}");
    for part in said {
        assert!(message.contains(part), "{line}: {message:?} does not say {part:?}");
    }
    assert!(output.stdout.is_empty(), "{line}: standard output is not empty");
    assert_eq!(bench.listing(), before, "{line} left something behind");
}

/// `text` with `from` replaced, which must be there.
pub fn changed(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from:?} is not in {text:?}");
    text.replacen(from, to, 1)
}

/// Makes hammer records with a known truth in `folder` of the bench, by tests/record_generator; prints why and returns
/// `None` where there is no Python for it.
pub fn made_records(bench: &Bench, folder: &str, options: &str) -> Option<serde_json::Value> {
    let Some(python) = std::env::var_os("ORTHOPANEL_PYTHON") else {
        println!("skipped: ORTHOPANEL_PYTHON names no Python with numpy, scipy and pyuff");
        return None;
    };
    let output = Command::new(python)
        .current_dir(Path::new(ROOT).join("tests"))
        .args(["-m", "record_generator"])
        .arg(bench.path(folder))
        .args(options.split_whitespace())
        .output()
        .expect("the generator starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(bench.read_json(&format!("{folder}/truth.json")))
}
