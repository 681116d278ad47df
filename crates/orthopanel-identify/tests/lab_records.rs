//! Records as labs have them: whatever kind they are of, the constants are those of the panel.

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::Path;

use num_complex::Complex64;
use orthopanel_data::{Estimation, ImpactTest, MeasurementData, TimeHistory, Window};
use orthopanel_identify::{Settings, identify};

/// $E_x$ and $G_{zx}$ with which the example and the folders of labs were made \[Pa\].
const TRUTH: [f64; 2] = [1.067e10, 5.304e8];

const HEAD: &str = "[piece]\nlength = 0.8\nwidth = 0.1\nthickness = 0.03\nmass_per_area = 6.88\n";

fn assert_constants(name: &str, test: &ImpactTest) {
    let found = identify(test, Settings::default()).unwrap_or_else(|error| panic!("{name}: {error}"));
    for (constant, truth) in found.constants.iter().zip(TRUTH) {
        let error = constant.value / truth - 1.0;
        assert!(error.abs() < 5e-3, "{name}: {} = {:e}", constant.name, constant.value);
    }
}

/// Folders that labs' tools made, one of a kind each.
#[test]
fn val_folders_of_labs_give_the_constants() {
    for (name, keys) in [
        ("f02e_nonode", ""),
        ("f04_mobility", ""),
        ("f05b_rec_0", "quantity = \"displacement\""),
        ("f06c_164", ""),
        ("f08_kHz", ""),
        ("f13_expwin", "window_decay = 0.25"),
        ("f16_runs", ""),
        ("t01_multi", ""),
        ("t03_cont", ""),
    ] {
        let Some(folder) = crate::support::shared_data(&format!("../cases/records/{name}")) else { return };
        let text = std::fs::read_to_string(folder.join("test.toml")).unwrap();
        let text = text.replace("kind = \"accelerance\"\n", &format!("kind = \"accelerance\"\n{keys}\n"));
        assert_constants(name, &ImpactTest::from_toml(&text, folder.join("test.toml")).unwrap());
    }
}

fn example() -> TimeHistory {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/made-hits/test.toml");
    let test = ImpactTest::read(path).unwrap();
    let MeasurementData::TimeHistory(recorded) = &test.measurements[0].data else { panic!("hits") };
    TimeHistory::read(recorded).unwrap()
}

fn read(folder: &Path, kind: &str, text: &str, keys: &str) -> ImpactTest {
    std::fs::write(folder.join("records.txt"), text).unwrap();
    let places = "force_at = [-0.3, 0]\nresponse_at = [0.3, 0]\n";
    let test = format!("{HEAD}[[measurement]]\nkind = \"{kind}\"\nfile = \"records.txt\"\n{places}{keys}\n");
    ImpactTest::from_toml(&test, folder.join("test.toml")).unwrap()
}

/// The example's lines over $s^n$, as analysers export them.
#[test]
fn val_frequency_responses_of_each_kind_give_the_constants() {
    let folder = tempfile::tempdir().unwrap();
    let lines = example().accelerance(Estimation { window: Window::None, ..Estimation::default() }).unwrap();
    type Row = fn(f64, Complex64) -> String;
    let parts: Row = |f, h| format!("{f},{:e},{:e}", h.re, h.im);
    let degrees: Row = |f, h| format!("{f},{:e},{:e}", h.norm(), h.arg().to_degrees());
    let kinds: [(&str, &str, f64, i32, Row, &str); 9] = [
        ("accelerance in g over lbf", "f (Hz),Re (g/lbf),Im (g/lbf)", 9.80665 / 4.448_221_615, 0, parts, ""),
        ("accelerance in in/s2", "f (Hz),Re (in/s^2/N),Im (in/s^2/N)", 0.0254, 0, parts, ""),
        (
            "units declared",
            "f,Re,Im",
            0.0254 / 4.448_221_615,
            0,
            parts,
            "response_unit = \"in/s2\"\nforce_unit = \"lbf\"",
        ),
        ("mobility in mm/s", "f / Hz,|Y| / (mm/s)/N,phase / deg", 1e-3, 1, degrees, ""),
        ("mobility, declared", "f (Hz),Re,Im", 1.0, 1, parts, "quantity = \"velocity\""),
        ("receptance in um", "f (Hz),mag (um/N),phase (deg)", 1e-6, 2, degrees, ""),
        ("kHz", "f (kHz),Re,Im", 1.0, 0, |f, h| format!("{},{:e},{:e}", f / 1e3, h.re, h.im), ""),
        (
            "dB",
            "f (Hz),H (dB re 1 (m/s^2)/N),phase (rad)",
            1.0,
            0,
            |f, h| format!("{f},{},{}", 20.0 * h.norm().log10(), h.arg()),
            "",
        ),
        (
            "columns by number",
            "nothing",
            1.0,
            0,
            |f, h| format!("{:e},{f},{:e}", h.im, h.re),
            "columns = {frequency = 2, real = 3, imag = 1}",
        ),
    ];
    for (name, head, factor, derivatives, row, keys) in kinds {
        let mut text = format!("{head}\n");
        for (frequency, value) in lines.frequency.iter().zip(&lines.value).filter(|(f, _)| (10.0..4500.0).contains(*f))
        {
            let value = value / (factor * Complex64::new(0.0, TAU * frequency).powi(derivatives));
            writeln!(text, "{}", row(*frequency, value)).unwrap();
        }
        assert_constants(name, &read(folder.path(), "accelerance", &text, keys));
    }
}

/// The example's hits, as recorders leave them.
#[test]
fn val_hits_of_each_kind_give_the_constants() {
    let folder = tempfile::tempdir().unwrap();
    let history = example();
    let rate = history.rate;
    type Row = fn(f64, f64, f64) -> String;
    let kinds: [(&str, &str, Row, &str); 3] = [
        (
            "g and lbf",
            "Time (s);Hammer (lbf);Acc (g)",
            |t, f, a| format!("{t};{:e};{:e}", f / 4.448_221_615, a / 9.80665),
            "",
        ),
        ("times in ms", "t / ms;F / kN;a / mm/s2", |t, f, a| format!("{};{:e};{:e}", 1e3 * t, 1e-3 * f, 1e3 * a), ""),
        (
            "one of several channels",
            "Time (s);Hammer (N);Acc 1 (m/s2);Acc 2 (m/s2)",
            |t, f, a| format!("{t};{f:e};{:e};{a:e}", -3.0 * a),
            "response_channel = \"Acc 2\"",
        ),
    ];
    let hit = &history.hits[0];
    for (name, head, row, keys) in kinds {
        let mut text = format!("{head}\n");
        for (n, (force, motion)) in hit.force.iter().zip(&hit.acceleration).enumerate() {
            writeln!(text, "{}", row(n as f64 / rate, *force, *motion)).unwrap();
        }
        assert_constants(name, &read(folder.path(), "time-history", &text, keys));
    }
    // All hits in one continuous record.
    let mut text = String::from("time_s,force_n,acceleration_m_s2\n");
    let all = history.hits.iter().flat_map(|hit| hit.force.iter().zip(&hit.acceleration));
    for (n, (force, motion)) in all.enumerate() {
        writeln!(text, "{},{force:e},{motion:e}", n as f64 / rate).unwrap();
    }
    let test = read(folder.path(), "time-history", &text, "trigger = {level = 20}");
    assert_eq!(test.accelerances(Estimation::default()).unwrap()[0].1.hits, history.hits.len());
    assert_constants("continuous", &test);
}
