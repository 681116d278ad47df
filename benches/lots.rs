//! A lot of a hundred lists of natural frequencies: `batch`, from files to the table on disk, beside the identifications and traces themselves.
//!
//! `cargo bench --profile release -p orthopanel --bench lots` prints both times and their ratio beside the one asked. Both go over the same ten panels in turn, so that
//! whatever else the machine does is in both.
#![allow(clippy::print_stdout)]

use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use orthopanel::lot::{self, Batch};
use orthopanel::{Analysis, ModeRange, Settings, Silent, Test};
use rayon::prelude::*;

const PANELS: usize = 100;
const AT_ONCE: usize = 10;
/// What was asked of the ratio.
const ASKED: f64 = 1.2;

fn main() -> Result<(), Box<dyn Error>> {
    if std::env::args().any(|argument| argument == "--test") {
        return Ok(());
    }
    let folder = tempfile::tempdir()?;
    let tests = (0..PANELS).map(|panel| made(folder.path(), panel)).collect::<Result<Vec<_>, _>>()?;
    let [mut themselves, mut batch] = [Duration::ZERO; 2];
    for some in tests.chunks(AT_ONCE) {
        let start = Instant::now();
        let found = some.par_iter().map(|path| Ok(analysed(path)?.identified().is_some()));
        let found = found.collect::<Result<Vec<bool>, orthopanel::Error>>()?;
        themselves += start.elapsed();
        let start = Instant::now();
        let table = folder.path().join("lot.parquet");
        let known = lot::known(&table)?;
        let rows = Batch::new(some.to_vec(), known).run(|_, _| ());
        lot::save(&table, &rows)?;
        batch += start.elapsed();
        if found.len() != rows.len() || rows.iter().any(|row| row.failed.is_some()) {
            return Err("a panel failed".into());
        }
    }
    let [themselves, batch] = [themselves, batch].map(|took| took.as_secs_f64());
    println!(
        "{PANELS} lists: {themselves:.1} s identified and traced, {batch:.1} s through batch: {:.3}, asked {ASKED}",
        batch / themselves
    );
    Ok(())
}

fn analysed(path: &Path) -> Result<Analysis, orthopanel::Error> {
    Analysis::of(&Test::load(path)?, None, Settings::default(), &Silent)
}

/// A test file of the paper's piece 1 with moduli of its own, its frequencies to a tenth of a hertz.
fn made(folder: &Path, panel: usize) -> Result<PathBuf, Box<dyn Error>> {
    let [e_x, g_zx] =
        [(1.07e10, 0.618), (5.36e8, 0.414)].map(|(mean, turn)| mean * (1.0 + 0.02 * (turn * panel as f64).sin()));
    let model = format!(
        r#"{{"schema": "orthopanel.model/1", "piece": {{"length": 0.8, "width": 0.1, "thickness": 0.03, "mass_per_area": 6.88}},
            "structure": "timoshenko-beam", "constants": {{"e_x": {e_x}, "g_zx": {g_zx}}}}}"#
    );
    let modes = orthopanel::Model::from_json(&model, "made")?.modes(ModeRange::Count(8))?;
    let values: Vec<String> =
        modes.iter().filter(|mode| !mode.is_rigid()).map(|mode| format!("{:.1}", mode.frequency())).collect();
    let path = folder.join(format!("{panel:03}.toml"));
    let text = format!(
        "[piece]\nlength = 0.8\nwidth = 0.1\nthickness = 0.03\nmass_per_area = 6.88\n[[measurement]]\nkind = \"natural-frequencies\"\n\
         values = [{}]\nresolution = 0.1\n",
        values.join(", ")
    );
    std::fs::write(&path, text)?;
    Ok(path)
}
