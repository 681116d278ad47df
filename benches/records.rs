//! The paper's second problem on hammer records of five places: files to accelerances, the fit of six modes, and the modal fit that
//! asks no physics, with pyuff, pyFRF and sdypy-EMA beside them in the same run.
//!
//! `cargo bench -p orthopanel-identify --bench records` prints criterion's figures, then one line a task with both
//! times and their ratio. `tests/record_generator` makes the records, and `benches/pyfrf_peer` runs the peers, in the
//! Python named by `ORTHOPANEL_PYTHON` (default: `.venv/bin/python`, else `python3`). Without numpy and scipy there are
//! no records to measure on; without a peer its ratio is left out, and the run says so.
#![allow(clippy::print_stdout)]

mod python;

use std::hint::black_box;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use criterion::{Criterion, SamplingMode};
use num_complex::Complex64;
use orthopanel_data::{Accelerance, Estimation, ImpactTest};
use orthopanel_identify::{Identification, MeasuredModes, Settings, identify, measured_modes};
use python::{answer_of, python, root};

/// What was asked of reading and transforming: times faster than pyuff and pyFRF.
const RATIO_ASKED: f64 = 5.0;

/// What was asked of the fit of six modes at five places.
const FIT_ASKED: Duration = Duration::from_millis(200);

/// Duration of the blow \[s\]: the generator's own, whose band holds nine modes, and one whose band ends behind the sixth.
const HARD_TIP: &str = "0.0002";
const SOFT_TIP: &str = "0.0004";

fn main() -> Result<(), String> {
    let temporary = tempfile::tempdir().map_err(|error| error.to_string())?;
    let [folder, softer] = ["five", "softer"].map(|name| temporary.path().join(name));
    let made = make_records(&folder, HARD_TIP).and_then(|()| make_records(&softer, SOFT_TIP));
    if let Err(reason) = made {
        println!("not measured: no records could be made ({reason})");
        return Ok(());
    }
    let read_from = |folder: &Path| -> Vec<(usize, Accelerance)> {
        let test = ImpactTest::read(black_box(&folder.join("test.toml"))).expect("the generator's test file is valid");
        test.accelerances(Estimation::default()).expect("the generator's records are sound")
    };
    let all_from = |folder: &Path| -> Identification {
        let test = ImpactTest::read(black_box(&folder.join("test.toml"))).expect("the generator's test file is valid");
        identify(&test, Settings::default()).expect("the generator's records hold six modes")
    };
    let modes_from = |folder: &Path| -> MeasuredModes {
        let test = ImpactTest::read(black_box(&folder.join("test.toml"))).expect("the generator's test file is valid");
        measured_modes(&test).expect("the generator's records hold six modes").remove(0)
    };
    let (read, all) = (|| read_from(&folder), || all_from(&folder));

    let mut criterion = Criterion::default().configure_from_args();
    let mut group = criterion.benchmark_group("five places");
    group.sampling_mode(SamplingMode::Flat).sample_size(20);
    group.bench_function("files to accelerances", |bencher| bencher.iter(read));
    group.bench_function("files to constants and damping", |bencher| bencher.iter(all));
    group.finish();
    criterion.final_summary();

    // In turns, so that a slow spell of the machine falls on both: their difference is the fit.
    let (reading, whole) = medians(read, all);
    println!("\n{:<34}{:>12}{:>14}{:>10}", "task", "ours", "peer", "ratio");
    beside_reader(&folder, reading, &read());
    beside_fit(&folder, whole.saturating_sub(reading), &all());
    let modes = || modes_from(&folder);
    let (reading, whole) = medians(read, modes);
    beside_modes(&folder, whole.saturating_sub(reading), &modes());
    let (read, all) = (|| read_from(&softer), || all_from(&softer));
    let (reading, whole) = medians(read, all);
    beside_fit(&softer, whole.saturating_sub(reading), &all());
    Ok(())
}

/// Median times of two calls, made in turns over two seconds or so.
fn medians<A, B>(first: impl Fn() -> A, second: impl Fn() -> B) -> (Duration, Duration) {
    fn timed<T>(call: impl Fn() -> T) -> Duration {
        let before = Instant::now();
        black_box(call());
        before.elapsed()
    }
    let started = Instant::now();
    let (mut firsts, mut seconds) = (Vec::new(), Vec::new());
    while firsts.len() < 9 || (started.elapsed() < Duration::from_secs(2) && firsts.len() < 101) {
        firsts.push(timed(&first));
        seconds.push(timed(&second));
    }
    firsts.sort();
    seconds.sort();
    (firsts[firsts.len() / 2], seconds[seconds.len() / 2])
}

fn beside_reader(folder: &Path, ours: Duration, accelerances: &[(usize, Accelerance)]) {
    let label = "files to accelerances (pyFRF)";
    let answer = match peer(folder, &["accelerances", "--repeat", "15"]) {
        Ok(answer) => answer,
        Err(reason) => return println!("{label:<34}{:>9.2} ms   peer not run: {reason}", milliseconds(ours)),
    };
    show(label, ours, &answer);
    println!(
        "    asked: at least {RATIO_ASKED} times faster; greatest difference {}",
        difference(&answer, accelerances)
    );
}

fn beside_fit(folder: &Path, ours: Duration, found: &Identification) {
    let label = "the fit alone (sdypy-EMA: LSCF)";
    let modes = found.pieces.first().map_or(0, |piece| piece.modes.len());
    let lines: usize = found.accelerances.iter().map(|place| place.frequency.len()).sum();
    let near = found.pieces.iter().flat_map(|piece| &piece.modes).map(|mode| format!("{:.1}", mode.measured));
    let near: Vec<String> = near.collect();
    let mut arguments = vec!["poles", "--repeat", "5", "--near"];
    arguments.extend(near.iter().map(String::as_str));
    match peer(folder, &arguments) {
        Ok(answer) => show(label, ours, &answer),
        Err(reason) => println!("{label:<34}{:>9.2} ms   peer not run: {reason}", milliseconds(ours)),
    }
    let places = found.accelerances.len();
    println!("    asked: {FIT_ASKED:?} at most; took part: {modes} modes, {places} places, {lines} lines in all");
}

/// The peer's poles are those of accelerances, ours of the hits themselves, each with its standard deviation.
fn beside_modes(folder: &Path, ours: Duration, found: &MeasuredModes) {
    let label = "measured modes (sdypy-EMA: LSCF)";
    let frequency = |omega: f64| omega / std::f64::consts::TAU;
    let near: Vec<String> =
        found.poles.iter().map(|pole| format!("{:.1}", frequency(pole.angular_frequency))).collect();
    let mut arguments = vec!["poles", "--repeat", "5", "--near"];
    arguments.extend(near.iter().map(String::as_str));
    match peer(folder, &arguments) {
        Ok(answer) => show(label, ours, &answer),
        Err(reason) => println!("{label:<34}{:>9.2} ms   peer not run: {reason}", milliseconds(ours)),
    }
    println!("    took part: {} modes, {} places", found.poles.len(), found.records.len());
}

fn show(label: &str, ours: Duration, answer: &serde_json::Value) {
    let peer = answer["seconds"].as_f64().unwrap_or(f64::NAN);
    let ratio = peer / ours.as_secs_f64();
    println!("{label:<34}{:>9.2} ms{:>11.1} ms{ratio:>10.1}", milliseconds(ours), 1e3 * peer);
}

/// Greatest difference between the peer's accelerances and ours over the lines the peer names, as a part of the line:
/// small where both did the same work.
fn difference(answer: &serde_json::Value, accelerances: &[(usize, Accelerance)]) -> String {
    let samples = answer["samples"].as_array().map(Vec::as_slice).unwrap_or_default();
    let step = answer["step_hz"].as_f64().unwrap_or(f64::NAN);
    let (mut worst, mut compared) = (0.0_f64, 0);
    for sample in samples {
        let number = |index: usize| sample[index].as_f64().unwrap_or(f64::NAN);
        let Some((_, ours)) = accelerances.get(number(0) as usize) else { continue };
        let frequency = step * number(1);
        let Some(line) = ours.frequency.iter().position(|own| (own - frequency).abs() < 0.01 * step) else { continue };
        let theirs = Complex64::new(number(2), number(3));
        worst = worst.max((ours.value[line] - theirs).norm() / theirs.norm());
        compared += 1;
    }
    format!("{worst:.1e} of a line, over {compared} lines compared")
}

fn milliseconds(duration: Duration) -> f64 {
    1e3 * duration.as_secs_f64()
}

fn make_records(folder: &Path, pulse: &str) -> Result<(), String> {
    let records = ["--five-places", "--format", "uff-binary", "--noise", "0.003", "--seed", "5"];
    let options = records.into_iter().chain(["--pulse-duration", pulse]);
    let mut command = Command::new(python());
    command.current_dir(root().join("tests")).args(["-m", "record_generator"]).arg(folder).args(options);
    answer_of(command).map(|_| ())
}

fn peer(folder: &Path, arguments: &[&str]) -> Result<serde_json::Value, String> {
    let mut command = Command::new(python());
    command.arg(root().join("benches/pyfrf_peer/peer.py")).arg(folder).args(arguments);
    serde_json::from_slice(&answer_of(command)?).map_err(|error| error.to_string())
}
