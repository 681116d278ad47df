//! Records as labs have them: each dialect that an independent script writes becomes the accelerance that it foretells.

use std::path::Path;

use orthopanel_data::{Estimation, ImpactTest};

use crate::support::python;

/// Frequency, real and imaginary part, relative error allowed.
fn expected(path: &Path) -> Vec<[f64; 4]> {
    let text = std::fs::read_to_string(path).unwrap();
    let row = |line: &str| {
        let numbers: Vec<f64> = line.split(',').map(|number| number.parse().unwrap()).collect();
        [numbers[0], numbers[1], numbers[2], numbers[3]]
    };
    text.lines().map(row).collect()
}

/// The worst error over the greatest of the lines about it, over what is allowed.
fn worst(folder: &Path) -> Result<(f64, orthopanel_data::Accelerance), String> {
    let test = ImpactTest::read(folder).map_err(|error| error.to_string())?;
    let found = test.accelerances(Estimation::default()).map_err(|error| error.to_string())?;
    let [(_, accelerance)] = &found[..] else { return Err(format!("{} accelerances", found.len())) };
    let due = expected(&folder.join("expected.csv"));
    let greatest = |at: f64| {
        let near = due.iter().filter(|row| (row[0] - at).abs() < 20.0);
        near.map(|row| row[1].hypot(row[2])).fold(0.0, f64::max)
    };
    let mut worst = 0.0f64;
    for [frequency, re, im, allowed] in due.iter().copied() {
        let line = accelerance.frequency.iter().position(|line| (line - frequency).abs() < 1e-6 * frequency);
        let value = accelerance.value[line.ok_or_else(|| format!("no line at {frequency} Hz"))?];
        worst = worst.max((value.re - re).hypot(value.im - im) / greatest(frequency) / allowed);
    }
    Ok((worst, accelerance.clone()))
}

#[test]
fn val_every_dialect_becomes_the_same_accelerance() {
    let folder = tempfile::tempdir().unwrap();
    let Some(names) = python("write_lab_dialects.py", "pyuff", &[folder.path()]) else { return };
    let table = include_str!("../../../docs/records-as-labs-have-them.md");
    let mut faults = Vec::new();
    for name in names.lines() {
        match worst(&folder.path().join(name)) {
            Err(problem) => faults.push(format!("{name}: {problem}")),
            Ok((worst, _)) if worst > 1.0 => faults.push(format!("{name}: {worst:.3} of the error allowed")),
            Ok((_, accelerance)) => {
                // Of two coherences the good one is its own.
                if name.starts_with("coherence") && accelerance.coherence.as_ref().is_none_or(|all| all[9] != 0.99) {
                    faults.push(format!(
                        "{name}: {:?}, {:?}",
                        accelerance.coherence.map(|all| all[9]),
                        accelerance.notes
                    ));
                }
            }
        }
        if !table.contains(&format!("`{name}`")) {
            faults.push(format!("{name}: no row in docs/records-as-labs-have-them.md"));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(names.lines().count() > 40, "{names}");
}
