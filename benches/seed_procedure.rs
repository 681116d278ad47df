//! The paper's first problem: six exact modes and one identification, with a SciPy port of the paper's procedure
//! beside them in the same run.
//!
//! `cargo bench -p orthopanel-identify` prints criterion's figures, then one line a task with both times and their
//! ratio. The port runs in the Python named by `ORTHOPANEL_PYTHON` (default: `.venv/bin/python`, else `python3`),
//! which needs scipy; without it the ratios are left out, and the run says so.
#![allow(clippy::print_stdout)]

use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use criterion::Criterion;
use orthopanel_data::ImpactTest;
use orthopanel_identify::{Search, identify};
use orthopanel_model::{BeamConstants, Boundary, ExactBeam, Piece};

const TEST: &str = r#"
    [piece]
    length = 0.8
    width = 0.1
    thickness = 0.03
    mass_per_area = 6.880
    [[measurement]]
    kind = "natural-frequencies"
    values = [321.3, 837.5, 1520.0, 2312.5, 3150.0, 3987.5]
"#;

/// Pieces 1 and 2 as one plate.
const TWO_PLATES: &str = r#"
    structure = "mindlin-plate"
    [[piece]]
    name = "1"
    length = 0.8
    width = 0.1
    thickness = 0.03
    mass_per_area = 6.880
    [[piece]]
    name = "2"
    length = 0.8
    width = 0.2
    thickness = 0.03
    mass_per_area = 6.880
    [[measurement]]
    piece = "1"
    kind = "natural-frequencies"
    values = [321.3, 837.5, 1520.0, 2312.5, 3150.0, 3987.5]
    [[measurement]]
    piece = "2"
    kind = "natural-frequencies"
    values = [322.5, 842.5, 1555.0, 2362.0, 3212.5, 3962.5]
"#;

/// What was asked of that identification.
const PLATES_ASKED: Duration = Duration::from_millis(50);

fn main() {
    let piece = Piece { length: 0.8, width: 0.1, thickness: 0.03, mass_per_area: 6.880 };
    let test = ImpactTest::from_toml(TEST, "test.toml").expect("the test file above is valid");
    let modes = || {
        let constants = BeamConstants { e_x: black_box(1.070e10), g_zx: black_box(5.363e8) };
        ExactBeam::new(&piece, Boundary::FREE, constants).expect("valid constants").modes(6)
    };
    let least_squares = || identify(black_box(&test), Search::LeastSquares).expect("six frequencies");
    let plates = ImpactTest::from_toml(TWO_PLATES, "test.toml").expect("the test file above is valid");
    let two_plates = || identify(black_box(&plates), Search::LeastSquares).expect("twelve frequencies");
    let simplex = || identify(black_box(&test), Search::Simplex).expect("six frequencies");

    let mut criterion = Criterion::default().configure_from_args();
    criterion.bench_function("six exact modes", |bencher| bencher.iter(modes));
    criterion.bench_function("identification, least squares", |bencher| bencher.iter(least_squares));
    criterion.bench_function("identification, simplex", |bencher| bencher.iter(simplex));
    criterion.bench_function("identification, two plates", |bencher| bencher.iter(two_plates));
    criterion.final_summary();

    println!("\n{:<34}{:>12}{:>14}{:>10}", "task", "ours", "SciPy port", "ratio");
    beside_port("six exact modes", "modes", median(modes));
    let ours = median(least_squares);
    beside_port("identification (port: simplex)", "simplex", ours);
    beside_port("identification (port: squares)", "least-squares", ours);
    let (ours, asked) = (median(two_plates).as_secs_f64() * 1e3, PLATES_ASKED.as_secs_f64() * 1e3);
    println!("identification of two plates      {ours:>9.1} ms   asked: {asked} ms");
}

/// Median time of a call, over a second or so.
fn median<T>(mut call: impl FnMut() -> T) -> Duration {
    let started = Instant::now();
    let mut times = Vec::new();
    while times.len() < 21 || (started.elapsed() < Duration::from_secs(1) && times.len() < 20_001) {
        let before = Instant::now();
        black_box(call());
        times.push(before.elapsed());
    }
    times.sort();
    times[times.len() / 2]
}

fn beside_port(label: &str, task: &str, ours: Duration) {
    let ours_us = ours.as_secs_f64() * 1e6;
    match port_seconds(task) {
        Ok(seconds) => {
            let ratio = seconds / ours.as_secs_f64();
            println!("{label:<34}{ours_us:>9.1} us{:>11.0} us{ratio:>10.0}", seconds * 1e6);
        }
        Err(reason) => println!("{label:<34}{ours_us:>9.1} us   port not run: {reason}"),
    }
}

fn port_seconds(task: &str) -> Result<f64, String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let own = root.join(".venv/bin/python");
    let python = std::env::var_os("ORTHOPANEL_PYTHON")
        .map(PathBuf::from)
        .unwrap_or_else(|| if own.exists() { own } else { PathBuf::from("python3") });
    let output = Command::new(python)
        .arg(root.join("benches/scipy_port/seed_port.py"))
        .args([task, "--repeat", "15"])
        .output()
        .map_err(|error| error.to_string())?;
    if !output.status.success() {
        let message = String::from_utf8_lossy(&output.stderr);
        return Err(message.lines().last().unwrap_or("no message").to_owned());
    }
    let line: serde_json::Value = serde_json::from_slice(&output.stdout).map_err(|error| error.to_string())?;
    line["seconds"].as_f64().ok_or_else(|| "no `seconds` in its answer".to_owned())
}
