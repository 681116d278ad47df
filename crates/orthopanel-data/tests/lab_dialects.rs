//! Records as labs have them: each dialect that an independent script writes becomes the accelerance that it foretells.

use std::path::Path;

use num_complex::Complex64;
use orthopanel_data::{Accelerance, Estimation, ImpactTest};

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

/// The value at a frequency, between two lines that of the straight line through them.
fn line_at(of: &Accelerance, frequency: f64) -> Option<Complex64> {
    let next = of.frequency.iter().position(|line| *line > frequency * (1.0 - 1e-9))?;
    let found = of.frequency[next];
    if (found - frequency).abs() < 1e-6 * frequency {
        return Some(of.value[next]);
    }
    let before = next.checked_sub(1)?;
    let part = (frequency - of.frequency[before]) / (found - of.frequency[before]);
    Some(of.value[before] * (1.0 - part) + of.value[next] * part)
}

/// The worst error over the greatest of the lines about it, over what is allowed.
fn worst(folder: &Path) -> Result<(f64, Accelerance), String> {
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
        let value = line_at(accelerance, frequency).ok_or_else(|| format!("no line at {frequency} Hz"))?;
        worst = worst.max((value - Complex64::new(re, im)).norm() / greatest(frequency) / allowed);
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
    // And the other way round: no row of the table without its test.
    let rows = table
        .lines()
        .filter(|line| line.starts_with('|'))
        .filter_map(|line| line.trim_end_matches('|').rsplit('|').next());
    let named = rows.flat_map(|cell| cell.split('`').skip(1).step_by(2)).filter(|name| name.contains(": "));
    faults.extend(
        named.filter(|name| !names.lines().any(|of| of == *name)).map(|name| format!("{name}: a row without a test")),
    );
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(names.lines().count() > 40, "{names}");
}
