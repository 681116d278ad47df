//! A whole panel hit at 30 places, three hits each of 16384 samples: measured modes and constants, the whole catalogue, how both grow
//! with the places, and sdypy-EMA's pole search beside the modal fit in the same run.
//!
//! `cargo bench -p orthopanel-identify --bench whole_panel` prints criterion's figures, then one line a task beside the time
//! asked. `tests/blind_tracing` makes the test, by a plate solution that shares nothing with the crates, and `benches/pyfrf_peer` runs the
//! peer, in the Python named by `ORTHOPANEL_PYTHON` (default: `.venv/bin/python`, else `python3`).
#![allow(clippy::print_stdout)]

mod python;

use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion, SamplingMode};
use orthopanel_data::ImpactTest;
use orthopanel_identify::{Settings, identify, measured_modes, trace};
use python::{answer_of, python, root};

/// Places of which times are told, to see how they grow.
const PLACES: [usize; 3] = [10, 20, 30];
/// What was asked on two cores: measured modes and constants, and a trace through the whole catalogue.
const ASKED: [Duration; 2] = [Duration::from_secs(5), Duration::from_secs(15)];

fn main() -> Result<(), String> {
    let temporary = tempfile::tempdir().map_err(|error| error.to_string())?;
    let folder = match made(temporary.path()) {
        Ok(folder) => folder,
        Err(reason) => {
            println!("not measured: no test could be made ({reason})");
            return Ok(());
        }
    };
    let test = ImpactTest::read(folder.join("test.toml")).map_err(|error| error.to_string())?;
    let of_places = |count: usize| {
        let mut part = test.clone();
        part.measurements.truncate(count);
        part
    };
    let mut criterion = Criterion::default().configure_from_args();
    let mut group = criterion.benchmark_group("whole panel");
    group.sampling_mode(SamplingMode::Flat).sample_size(10);
    for count in PLACES {
        let part = of_places(count);
        group.bench_function(BenchmarkId::new("measured modes", count), |bencher| {
            bencher.iter(|| measured_modes(black_box(&part)).expect("modes stand out"));
        });
    }
    group.finish();
    criterion.final_summary();
    if std::env::args().any(|argument| argument == "--test") {
        return Ok(());
    }

    println!("\n{:<34}{:>12}{:>12}{:>12}", "places", "modes", "constants", "trace");
    for count in PLACES {
        let part = of_places(count);
        let (modes, of_modes) = timed(|| measured_modes(&part));
        let (constants, of_constants) = timed(|| identify(&part, Settings::default()));
        let (traced, of_trace) = timed(|| trace(&part));
        let poles = modes.map_or(0, |modes| modes[0].poles.len());
        let verdict = traced.map_or("refused", |traced| traced.verdict.name());
        let found = if constants.is_ok() { "constants found" } else { "constants refused" };
        println!(
            "{count:<34}{of_modes:>10.2} s{of_constants:>10.2} s{of_trace:>10.2} s  {poles} modes, {found}, {verdict}"
        );
    }
    println!(
        "    asked: {:?} at most for modes and constants, {:?} for a trace, both of 30 places",
        ASKED[0], ASKED[1]
    );
    beside_the_peer(&folder, &test)
}

fn timed<T>(call: impl FnOnce() -> T) -> (T, f64) {
    let before = Instant::now();
    let answer = black_box(call());
    (answer, before.elapsed().as_secs_f64())
}

/// LSCF's poles up to order 120 (40 modes stand in it three times over), and shapes by least squares, of all places.
fn beside_the_peer(folder: &Path, test: &ImpactTest) -> Result<(), String> {
    let (modes, ours) = timed(|| measured_modes(test));
    let modes = modes.map_err(|error| error.to_string())?.remove(0);
    let frequencies: Vec<f64> = modes.poles.iter().map(|pole| pole.angular_frequency / std::f64::consts::TAU).collect();
    let upper = format!("{:.0}", frequencies.last().unwrap_or(&0.0) * 1.03);
    let mut command = Command::new(python());
    command.arg(root().join("benches/pyfrf_peer/peer.py")).arg(folder);
    command.args(["poles", "--repeat", "1", "--order", "120", "--upper", &upper, "--near"]);
    command.args(frequencies.iter().map(|frequency| format!("{frequency:.2}")));
    let label = "measured modes (sdypy-EMA: LSCF)";
    match answer_of(command).and_then(|said| serde_json::from_slice(&said).map_err(|error| error.to_string())) {
        Err(reason) => println!("{label:<34}{ours:>10.2} s   peer not run: {reason}"),
        Ok(answer) => {
            let answer: serde_json::Value = answer;
            let peer = answer["seconds"].as_f64().unwrap_or(f64::NAN);
            let found = answer["frequencies_hz"].as_array().map_or(0, Vec::len);
            println!(
                "{label:<34}{ours:>10.2} s{peer:>10.2} s{:>10.1}  {} modes, {found}",
                peer / ours,
                frequencies.len()
            );
        }
    }
    Ok(())
}

/// A panel with nothing missing, hit at 30 places: its folder.
fn made(folder: &Path) -> Result<PathBuf, String> {
    let out = folder.join("set");
    let mut command = Command::new(python());
    command.current_dir(root().join("tests")).args(["-m", "blind_tracing", "make"]).arg(&out);
    // Places go round with the cases: the fourth of a kind has 30.
    command.args(["--set", "whole", "--count", "2", "--seed", "5", "--kind", "none"]);
    answer_of(command)?;
    let cases = std::fs::read_dir(&out).map_err(|error| error.to_string())?;
    let mut cases = cases.flatten().map(|case| case.path());
    let last = PLACES[PLACES.len() - 1] - 1;
    cases
        .find(|case| case.join(format!("point-{last}.uff")).exists())
        .ok_or_else(|| format!("no case has {PLACES:?} places"))
}
