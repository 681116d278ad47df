//! Records whose modes lose energy by another law than the one asked for. The accelerances come from
//! `tests/record_generator`, whose physics is its own.
//!
//! These need Python with numpy and scipy, named by `ORTHOPANEL_PYTHON`; without it they say so and pass.

use std::path::Path;
use std::process::Command;

use orthopanel_data::ImpactTest;
use orthopanel_identify::{DampingLaw, Identification, IdentifyError, Settings, identify};

/// Table 9's damping of piece 1 so many times, as a loss factor or viscous, with even noise of 0.3 % of the mean line.
const MAKE: &str = "
import sys
import numpy as np
from record_generator import beam
times, law = float(sys.argv[2]), sys.argv[3]
modes = beam.solve(beam.Panel(), (-0.3, 0.3), 65000.0)
ratios = [times * z for z in (2.364e-3, 1.306e-3, 1.108e-3, 2.251e-3, 5.485e-3, 4.488e-3)]
zeta = beam.damping(modes, ratios, 0.004 * times)
frequency = np.arange(1.0, 4500.0, 0.5)
omega = 2.0 * np.pi * frequency[:, None]
loss = modes.omega**2 if law == 'hysteretic' else modes.omega * omega
product = modes.shape[:, 0] * modes.shape[:, 1]
flexible = (product / (modes.omega**2 + 2j * zeta * loss - omega**2)).sum(1) + modes.remainder[0, 1]
clean = float(modes.rigid[:, 0] @ modes.rigid[:, 1]) - omega[:, 0] ** 2 * flexible
spread = 0.003 * abs(clean).mean()
random = np.random.default_rng(0)
noisy = clean + spread * (random.normal(size=len(clean)) + 1j * random.normal(size=len(clean))) / np.sqrt(2.0)
table = np.c_[frequency, noisy.real, noisy.imag, np.full(len(clean), spread**2)]
np.savetxt(sys.argv[1], table, '%.15g', ',', header='frequency_hz,real,imag,variance', comments='')
";

fn made(times: f64, law: &str, asked: DampingLaw) -> Option<Result<Identification, IdentifyError>> {
    let Some(python) = std::env::var_os("ORTHOPANEL_PYTHON") else {
        println!("skipped: ORTHOPANEL_PYTHON names no Python with numpy and scipy");
        return None;
    };
    let folder = tempfile::tempdir().unwrap();
    let output = Command::new(python)
        .current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests"))
        .args(["-c", MAKE])
        .arg(folder.path().join("made.csv"))
        .args([times.to_string().as_str(), law])
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = "[piece]\nlength = 0.8\nwidth = 0.1\nthickness = 0.03\nmass_per_area = 6.880\n[[measurement]]\n\
                kind = \"accelerance\"\nfile = \"made.csv\"\nforce_at = [-0.3, 0.0]\nresponse_at = [0.3, 0.0]\n";
    let test = ImpactTest::from_toml(text, folder.path().join("test.toml")).unwrap();
    Some(identify(&test, Settings { damping_law: asked, ..Settings::default() }))
}

/// The chi-square that the note promises, and what is then found.
#[test]
fn val_the_better_law_of_damping_is_named() {
    for (times, law, asked) in [(1.0, "hysteretic", DampingLaw::Viscous), (1.0, "viscous", DampingLaw::Hysteretic)] {
        let Some(found) = made(times, law, asked) else { return };
        let found = found.unwrap();
        let note = found.notes.iter().find(|note| note.contains("give --damping")).expect("a note");
        assert!(note.contains(&format!("give --damping {law}")), "{note}");
        assert!(note.contains(&format!("{:.2} with", found.chi_square.unwrap())), "{note}");
    }
    for (law, asked) in [("viscous", DampingLaw::Viscous), ("hysteretic", DampingLaw::Hysteretic)] {
        let Some(found) = made(1.0, law, asked) else { return };
        let found = found.unwrap();
        assert!(found.notes.iter().all(|note| !note.contains("--damping")), "{:?}", found.notes);
        assert!((found.chi_square.unwrap() - 1.0).abs() < 0.1, "{:?}", found.chi_square);
    }
}

/// Ten times table 9: the refusal names the law under which the records meet the test file.
#[test]
fn val_much_hysteretic_damping_is_named_where_viscous_is_refused() {
    let Some(refused) = made(10.0, "hysteretic", DampingLaw::Viscous) else { return };
    match refused {
        Err(IdentifyError::OtherDamping { asked: "viscous", other: "hysteretic", chi_square }) => {
            assert!((chi_square - 1.0).abs() < 0.1, "{chi_square}");
        }
        other => panic!("{:?}", other.map(|found| (found.constants, found.chi_square))),
    }
    let found = made(10.0, "hysteretic", DampingLaw::Hysteretic).unwrap().unwrap();
    assert!((found.constants[0].value / 1.067e10 - 1.0).abs() < 1e-3, "{:?}", found.constants);
}
