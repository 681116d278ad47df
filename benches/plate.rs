//! Twenty modes of the paper's two widths as orthotropic Mindlin plates, to 1e-4 of their frequencies.
//!
//! `cargo bench -p orthopanel-model --bench plate` prints criterion's figures: with the basis built, with the derivatives
//! by all six stiffnesses, on the plate's own shapes at constants a few per cent away (a step of an identification), and
//! cold (basis, matrices and modes). Then it runs
//! `fmpy-checks/plate_by_scikit_fem.py` on the same plates, in the Python named by `ORTHOPANEL_PYTHON` (default:
//! `.venv/bin/python`, else `python3`), and prints both times and their ratio; its mesh is the coarsest that holds 1e-4.
#![allow(clippy::print_stdout)]

use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;
use std::time::Instant;

use criterion::{BenchmarkId, Criterion};
use orthopanel_model::{Boundary, MindlinPlate, Piece, ReducedStructure, RitzMode, Structure, ritz_modes};

/// Constants of the order of the paper's panels: $E_x, E_y$ \[Pa\], $\nu_{xy}$, $G_{xy}, G_{yz}, G_{zx}$ \[Pa\].
const CONSTANTS: [f64; 6] = [1.07e10, 8.2e9, 0.3, 2.9e9, 3.1e8, 5.363e8];
const MODES: usize = 20;
/// How far constants move in a step near the end of an identification.
const AWAY: f64 = 0.03;

fn plate(width: f64) -> MindlinPlate {
    let piece = Piece { length: 0.8, width, thickness: 0.03, mass_per_area: 6.880 };
    MindlinPlate::with_basis_for(&piece, Boundary::FREE, &CONSTANTS, MODES).expect("a valid piece")
}

/// On its shapes where the constants differ by [`AWAY`], up and down in turn.
fn reduced(width: f64) -> ReducedStructure<MindlinPlate> {
    let mut sign = -1.0;
    let there = CONSTANTS.map(|value| {
        sign = -sign;
        value * (1.0 + sign * AWAY)
    });
    ReducedStructure::near(Arc::new(plate(width)), &there, MODES).expect("valid constants")
}

/// Greatest difference of a frequency from those of the whole basis, as a part of it.
fn worst(structure: &dyn Structure, whole: &MindlinPlate) -> f64 {
    let flexible = |mode: &RitzMode| mode.angular_frequency > 0.0;
    let pairs = modes(structure).into_iter().filter(flexible).zip(modes(whole).into_iter().filter(flexible));
    pairs.map(|(own, whole)| (own.angular_frequency / whole.angular_frequency - 1.0).abs()).fold(0.0, f64::max)
}

fn modes(plate: &dyn Structure) -> Vec<RitzMode> {
    ritz_modes(plate, black_box(&CONSTANTS), MODES).expect("valid constants")
}

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    let mut group = criterion.benchmark_group("20 plate modes");
    for width in [0.1, 0.2] {
        let built = plate(width);
        group.bench_function(BenchmarkId::new("built", width), |bencher| bencher.iter(|| modes(&built)));
        let sensitive =
            || -> Vec<Vec<f64>> { modes(&built).iter().map(|mode| mode.coefficient_sensitivity(&built)).collect() };
        group.bench_function(BenchmarkId::new("built, with derivatives", width), |bencher| bencher.iter(sensitive));
        let reduced = reduced(width);
        group.bench_function(BenchmarkId::new("built on its own shapes", width), |bencher| {
            bencher.iter(|| modes(&reduced));
        });
        group.bench_function(BenchmarkId::new("cold", width), |bencher| bencher.iter(|| modes(&plate(width))));
    }
    group.finish();
    criterion.final_summary();
    println!("\n{:<26}{:>12}{:>14}{:>10}", "20 plate modes", "ours", "scikit-fem", "ratio");
    for width in [0.1, 0.2] {
        let built = plate(width);
        let reduced = reduced(width);
        let peer = scikit_fem(width);
        beside(&format!("{width} m wide, built"), median(|| modes(&built)), peer.as_ref().map(|peer| peer.0));
        let own_shapes = median(|| modes(&reduced));
        beside(&format!("{width} m wide, own shapes"), own_shapes, peer.as_ref().map(|peer| peer.0));
        println!("    its frequencies are off by {:.1e} at most, {:.0} % away", worst(&reduced, &built), 100.0 * AWAY);
        beside(&format!("{width} m wide, cold"), median(|| modes(&plate(width))), peer.as_ref().map(|peer| peer.1));
    }
}

/// Median seconds of 51 calls.
fn median<T>(call: impl Fn() -> T) -> f64 {
    let timed = |_| {
        let before = Instant::now();
        black_box(call());
        before.elapsed().as_secs_f64()
    };
    let mut times: Vec<f64> = (0..51).map(timed).collect();
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

fn beside(label: &str, ours: f64, peer: Result<f64, &String>) {
    match peer {
        Ok(peer) => println!("{label:<26}{:>9.2} ms{:>11.1} ms{:>10.0}", ours * 1e3, peer * 1e3, peer / ours),
        Err(reason) => println!("{label:<26}{:>9.2} ms   scikit-fem not run: {reason}", ours * 1e3),
    }
}

/// Seconds that scikit-fem takes with the matrices built, and cold.
fn scikit_fem(width: f64) -> Result<(f64, f64), String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let [e_x, e_y, nu_xy, g_xy, g_yz, g_zx] = CONSTANTS;
    let model = serde_json::json!({
        "piece": {"length": 0.8, "width": width, "thickness": 0.03, "mass_per_area": 6.880},
        "constants": {"e_x": e_x, "e_y": e_y, "nu_xy": nu_xy, "g_xy": g_xy, "g_yz": g_yz, "g_zx": g_zx},
    });
    let file = std::env::temp_dir().join(format!("orthopanel-plate-{}-{width}.json", std::process::id()));
    std::fs::write(&file, model.to_string()).map_err(|error| error.to_string())?;
    let own = root.join(".venv/bin/python");
    let python = std::env::var_os("ORTHOPANEL_PYTHON").map(PathBuf::from);
    let python = python.unwrap_or_else(|| if own.exists() { own } else { "python3".into() });
    let done = Command::new(python)
        .arg(root.join("fmpy-checks/plate_by_scikit_fem.py"))
        .arg(&file)
        .args(["--cells", "10", "3", "--repeat", "9"])
        .output()
        .map_err(|error| error.to_string());
    let _ = std::fs::remove_file(&file);
    let done = done?;
    if !done.status.success() {
        return Err(String::from_utf8_lossy(&done.stderr).lines().last().unwrap_or("it failed").to_owned());
    }
    let answer: serde_json::Value = serde_json::from_slice(&done.stdout).map_err(|error| error.to_string())?;
    let seconds = |key: &str| answer[key].as_f64().ok_or_else(|| format!("no {key} in its answer"));
    Ok((seconds("built_s")?, seconds("cold_s")?))
}
