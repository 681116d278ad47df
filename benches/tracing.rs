//! A roving test (five places, three hits each, 32768 samples) traced through the whole catalogue, held-out judging
//! included, and what an effect costs.
//!
//! `cargo bench -p orthopanel-identify --bench tracing` prints criterion's figures, then the time of each whole trace
//! beside the one asked. `tests/blind_tracing` makes the tests, in the Python named by `ORTHOPANEL_PYTHON` (default:
//! `.venv/bin/python`, else `python3`); without numpy and scipy only effects are measured.
#![allow(clippy::print_stdout)]

mod python;

use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion};
use orthopanel_data::ImpactTest;
use orthopanel_identify::trace;
use orthopanel_model::{
    Boundary, EffectSetting, EffectState, ModifiedPanel, Piece, Place, RecordSetting, StructureKind, effect,
};
use python::{answer_of, python, root};

/// What was asked of a whole trace on two cores.
const ASKED: Duration = Duration::from_secs(3);
/// Kinds of missing effects that are traced: one of each owner, and the one that alters the structure most.
const KINDS: [&str; 4] = ["sensor-mass", "local-mass", "hammer-offset", "stiffness-loss"];
const SEED: &str = "1000";

fn main() -> Result<(), String> {
    let mut criterion = Criterion::default().configure_from_args();
    effects(&mut criterion);
    criterion.final_summary();
    if std::env::args().any(|argument| argument == "--test") {
        return Ok(());
    }
    println!("\n{:<20}{:>10}{:>10}", "missing", "trace", "asked");
    for kind in KINDS {
        let temporary = tempfile::tempdir().map_err(|error| error.to_string())?;
        match made(temporary.path(), kind) {
            Err(reason) => println!("{kind:<20} not measured: no test could be made ({reason})"),
            Ok(file) => {
                let test = ImpactTest::read(&file).map_err(|error| error.to_string())?;
                let start = Instant::now();
                let found = trace(black_box(&test)).map_err(|error| error.to_string())?;
                let (took, word) = (start.elapsed().as_secs_f64(), found.verdict.name());
                println!("{kind:<20}{took:>8.2} s{:>8} s  {word}", ASKED.as_secs());
            }
        }
    }
    Ok(())
}

/// The modes that a prediction begins with, beside none to four masses.
fn effects(criterion: &mut Criterion) {
    let piece = Piece { length: 0.8, width: 0.1, thickness: 0.03, mass_per_area: 6.88 };
    let record = RecordSetting { number: 1, ..RecordSetting::default() };
    let setting = EffectSetting { piece, boundary: Boundary::FREE, suspension: vec![], record };
    let panel = ModifiedPanel::new(StructureKind::TimoshenkoBeam, &setting, 14).expect("a beam");
    let places = [-0.31, 0.27].map(|x| Place { x, y: 0.0 });
    let masses: Vec<EffectState> = [-0.2, 0.05, 0.15, 0.33]
        .into_iter()
        .map(|x| EffectState::new(effect("local-mass").expect("in the catalogue"), vec![0.01, x], 1).expect("valid"))
        .collect();
    let mut group = criterion.benchmark_group("modes with point effects");
    for count in 0..=masses.len() {
        group.bench_function(BenchmarkId::from_parameter(count), |bencher| {
            bencher.iter(|| {
                let values = black_box([1.07e10, 5.4e8]);
                panel.seen_from(&setting, &places, false, &values, &masses[..count]).expect("modes")
            });
        });
    }
    group.finish();
}

/// A made test that lacks one effect: its file.
fn made(folder: &Path, kind: &str) -> Result<PathBuf, String> {
    let out = folder.join("set");
    let mut command = Command::new(python());
    command.current_dir(root().join("tests")).args(["-m", "blind_tracing", "make"]).arg(&out);
    command.args(["--set", "clean", "--count", "1", "--seed", SEED, "--kind", kind]);
    answer_of(command)?;
    Ok(out.join("case-000/test.toml"))
}
