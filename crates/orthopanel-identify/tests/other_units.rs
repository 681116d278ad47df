//! Records in other units than they are read in, of another quantity, or turned round: `identify` and every trace say the line that mends
//! them, before they search for anything; with it the constants are right.

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::Path;

use num_complex::Complex64;
use orthopanel_data::{Estimation, ImpactTest, MeasurementData, TimeHistory, Window};
use orthopanel_identify::{IdentifyError, Settings, Verdict, identify, trace};

const HEAD: &str = "[piece]\nlength = 0.8\nwidth = 0.1\nthickness = 0.03\nmass_per_area = 6.88\n";

fn example() -> TimeHistory {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/made-hits/test.toml");
    let test = ImpactTest::read(path).unwrap();
    let MeasurementData::TimeHistory(recorded) = &test.measurements[0].data else { panic!("hits") };
    TimeHistory::read(recorded).unwrap()
}

fn measurement(kind: &str, file: &str) -> String {
    format!("[[measurement]]\nkind = \"{kind}\"\nfile = \"{file}\"\nforce_at = [-0.3, 0]\nresponse_at = [0.3, 0]\n")
}

/// The accelerance of the example over $cs^n$, as a file says it; `label` stands in brackets behind its columns.
fn write_lines(folder: &Path, factor: f64, derivatives: i32, label: &str) {
    write_late_lines(folder, factor, derivatives, label, 0.0);
}

/// The same, sampled late by `delay` \[s\].
fn write_late_lines(folder: &Path, factor: f64, derivatives: i32, label: &str, delay: f64) {
    let lines = example().accelerance(Estimation { window: Window::None, ..Estimation::default() }).unwrap();
    let mut text = format!("frequency (Hz),real ({label}),imag ({label})\n");
    for (frequency, value) in lines.frequency.iter().zip(&lines.value).filter(|(f, _)| (10.0..4500.0).contains(*f)) {
        let value = value / (factor * Complex64::new(0.0, TAU * frequency).powi(derivatives));
        let value = value * Complex64::cis(-TAU * frequency * delay);
        writeln!(text, "{frequency},{:e},{:e}", value.re, value.im).unwrap();
    }
    std::fs::write(folder.join("lines.csv"), text).unwrap();
}

fn test_of(folder: &Path, text: &str) -> ImpactTest {
    ImpactTest::from_toml(text, folder.join("test.toml")).unwrap()
}

/// What all refuse alike.
fn refused(test: &ImpactTest) -> String {
    let said = identify(test, Settings::default()).unwrap_err();
    assert!(matches!(said, IdentifyError::OtherUnits { .. }), "{said}");
    let said = said.to_string();
    assert_eq!(trace(test).unwrap_err().to_string(), said);
    said
}

/// The lines that a refusal says to write in each measurement, with the likeliest unit.
fn lines_of(said: &str) -> String {
    let lines = said.split("write ").nth(1).and_then(|rest| rest.split(" in each [[measurement]]").next()).unwrap();
    lines.split(", or ").next().unwrap().replace(" and ", "\n") + "\n"
}

fn assert_constants(test: &ImpactTest) {
    let found = identify(test, Settings::default()).unwrap();
    for (constant, truth) in found.constants.iter().zip([1.067e10, 5.304e8]) {
        assert!((constant.value / truth - 1.0).abs() < 5e-3, "{}: {:e}", constant.name, constant.value);
    }
}

/// The unit that a label tells, the factor and the power of $s$ that bring what is read to an accelerance, and the line that is said.
#[test]
fn val_lines_in_another_unit_or_quantity_are_mended_by_what_is_said() {
    let folder = tempfile::tempdir().unwrap();
    for (label, factor, derivatives, said) in [
        ("", 9.80665, 0, "response_unit = \"g\""),
        ("", 2.2046e-3, 0, "response_unit = \"mg\" and force_unit = \"lbf\""),
        ("", 1.0 / 9.80665, 0, "force_unit = \"kgf\""),
        ("", -1e-3, 0, "direction = -1 and quantity = \"acceleration\" and response_unit = \"mm/s2\""),
        ("", 1.0 / 4.448_222, 0, "force_unit = \"lbf\""),
        ("m/s^2/N", 0.0254 / 4.448_222, 0, "response_unit = \"in/s2\" and force_unit = \"lbf\""),
        ("m/s^2/N", 1.0, 1, "quantity = \"velocity\" and response_unit = \"m/s\""),
        ("m/s^2/N", -1e-3, 1, "direction = -1 and quantity = \"velocity\" and response_unit = \"mm/s\""),
        ("m/s^2/N", 1e-6, 2, "quantity = \"displacement\" and response_unit = \"um\""),
        // Labelled a mobility in mm/s, and an accelerance in m/s2.
        ("mm/s/N", 1e-3, -1, "quantity = \"acceleration\" and response_unit = \"m/s2\""),
        // In m/s2 under the label of gravities, and in inches under that of millimetres.
        ("g/N", 1.0, 0, "quantity = \"acceleration\" and response_unit = \"m/s2\""),
        ("mm/s^2/N", 0.0254, 0, "quantity = \"acceleration\" and response_unit = \"in/s2\""),
    ] {
        // What a label says is taken off by the reader.
        let labelled = if label == "mm/s/N" { 1.0 } else { factor };
        write_lines(folder.path(), labelled, if label == "mm/s/N" { 0 } else { derivatives }, label);
        let text = format!("{HEAD}{}", measurement("accelerance", "lines.csv"));
        let refusal = refused(&test_of(folder.path(), &text));
        assert!(refusal.starts_with("write ") && refusal.contains(said), "{label} {factor} {derivatives}: {refusal}");
        assert_constants(&test_of(folder.path(), &(text + &lines_of(&refusal))));
    }
}

/// A delay of the response turns the phase of the highest lines by a quarter and more, and hides neither sign nor quantity nor unit.
#[test]
fn val_what_is_late_is_known_all_the_same() {
    let folder = tempfile::tempdir().unwrap();
    for (factor, derivatives, delay, said) in [
        (-1.0, 0, 20e-6, "write direction = -1 in each"),
        (-1.0, 0, 50e-6, "write direction = -1 in each"),
        (9.80665, 0, 50e-6, "response_unit = \"g\" in each"),
        (1.0, 1, 50e-6, "quantity = \"velocity\" and response_unit = \"m/s\" in each"),
    ] {
        write_late_lines(folder.path(), factor, derivatives, "m/s^2/N", delay);
        let text = format!("{HEAD}{}", measurement("accelerance", "lines.csv"));
        let refusal = refused(&test_of(folder.path(), &text));
        let late = refusal.split("a delay of ").nth(1).and_then(|rest| rest.split(' ').next()).unwrap();
        assert!(refusal.contains(said), "{factor} {derivatives}: {refusal}");
        assert!((late.parse::<f64>().unwrap() * 1e-6 / delay - 1.0).abs() < 0.05, "{delay}: {late}");
    }
}

/// A factor of five percent leaves the constants as they are, and is the first that is said of it.
#[test]
fn val_a_small_factor_on_all_records_is_said_first() {
    let folder = tempfile::tempdir().unwrap();
    write_lines(folder.path(), 1.0 / 1.05, 0, "m/s^2/N");
    let test = test_of(folder.path(), &format!("{HEAD}{}", measurement("accelerance", "lines.csv")));
    let found = identify(&test, Settings::default()).unwrap();
    let gain = found.common_gain.unwrap();
    assert!((gain.value / 1.05 - 1.0).abs() < 5e-3 && gain.std.is_some_and(|std| std < 0.01), "{gain:?}");
    assert!(found.notes[0].starts_with("all records together are 1.05"), "{:?}", found.notes);
    assert_constants(&test);
    let traced = trace(&test).unwrap();
    assert!(traced.notes[0].starts_with("all records together are 1.05"), "{:?}", traced.notes);
    assert_eq!((traced.verdict, traced.effects[0].id), (Verdict::Explained, "gain"));
    write_lines(folder.path(), 1.0, 0, "m/s^2/N");
    assert_eq!(identify(&test, Settings::default()).unwrap().common_gain, None);
}

/// A factor that no unit is: a declared gain has no bound.
#[test]
fn val_any_other_factor_is_a_gain_to_declare() {
    let folder = tempfile::tempdir().unwrap();
    for (factor, said) in [
        (25.4, "in/s2 converted as mm/s2"),
        (1000.0, "m/s2 converted as mm/s2"),
        (137.0, "a sensitivity"),
        (0.5, "a sensitivity"),
        // 2.5 % beside ft/s2 over kgf, and 3 % beside g: no unit, and the near one is named beside.
        (1.0 / 33.0, "a sensitivity"),
        (9.80665 / 1.03, "response_unit = \"g\" would leave 3.0 %"),
    ] {
        write_lines(folder.path(), factor, 0, "");
        let text = format!("{HEAD}{}", measurement("accelerance", "lines.csv"));
        let refusal = refused(&test_of(folder.path(), &text));
        let begins = "write an [[effect]] with id = \"gain\" and gain = ";
        assert!(refusal.starts_with(begins) && refusal.contains(said), "{factor}: {refusal}");
        let gain = refusal[begins.len()..].split(' ').next().unwrap();
        assert_constants(&test_of(folder.path(), &format!("{text}[[effect]]\nid = \"gain\"\ngain = {gain}\n")));
        let free = test_of(folder.path(), &format!("{text}[[effect]]\nid = \"gain\"\n"));
        let found = identify(&free, Settings::default()).unwrap();
        let value = found.effects[0].parameters[0].values[0].value;
        assert!((value * factor - 1.0).abs() < 0.01, "{factor}: {value}");
    }
}

/// The hits of the example, as another file says them.
fn write_hits(folder: &Path, name: &str, of: impl Fn(&[f64], f64) -> Vec<f64>) {
    let history = example();
    for (number, hit) in history.hits.iter().enumerate() {
        let mut text = String::from("time_s,force_n,acceleration_m_s2\n");
        for (n, (force, motion)) in hit.force.iter().zip(of(&hit.acceleration, history.rate)).enumerate() {
            writeln!(text, "{},{force:e},{motion:e}", n as f64 / history.rate).unwrap();
        }
        std::fs::write(folder.join(format!("{name}-{number}.csv")), text).unwrap();
    }
}

#[test]
fn val_hits_in_another_unit_or_quantity_are_mended_by_what_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let times = |factor: f64| move |of: &[f64], _: f64| of.iter().map(|value| value / factor).collect();
    write_hits(folder.path(), "inch", times(0.0254));
    write_hits(folder.path(), "turned", times(-1.0));
    // A vibrometer's velocity in mm/s, summed from the accelerations by the third order of Adams and Moulton: right below a fifth of the rate.
    write_hits(folder.path(), "velocity", |of: &[f64], rate: f64| {
        let mean = of.iter().sum::<f64>() / of.len() as f64;
        let at = |n: usize| of.get(n).map_or(0.0, |value| value - mean);
        let mut velocity = vec![0.0];
        for n in 1..of.len() {
            let before = if n < 2 { 0.0 } else { at(n - 2) };
            velocity.push(velocity[n - 1] + (5.0 * at(n) + 8.0 * at(n - 1) - before) / (12.0 * rate));
        }
        velocity.into_iter().map(|velocity| 1e3 * velocity).collect()
    });
    // Summed by the rule of trapezoids, as most programs do it: a third too low at a third of the sampling rate.
    write_hits(folder.path(), "trapezoids", |of: &[f64], rate: f64| {
        let mean = of.iter().sum::<f64>() / of.len() as f64;
        let mut velocity = vec![0.0];
        for pair in of.windows(2) {
            let last = velocity[velocity.len() - 1];
            velocity.push(last + (0.5 * (pair[0] + pair[1]) - mean) / rate);
        }
        velocity
    });
    for (name, said) in [
        ("trapezoids", "quantity = \"velocity\" and response_unit = \"m/s\""),
        ("inch", "quantity = \"acceleration\" and response_unit = \"in/s2\""),
        ("turned", "direction = -1"),
        ("velocity", "quantity = \"velocity\" and response_unit = \"mm/s\""),
    ] {
        let band = if name == "trapezoids" { 4000.0 } else { 2000.0 };
        let text = format!("{HEAD}{}band = [20.0, {band:?}]\n", measurement("time-history", &format!("{name}-*.csv")));
        let refusal = refused(&test_of(folder.path(), &text));
        assert!(refusal.starts_with("write ") && refusal.contains(said), "{name}: {refusal}");
        assert_constants(&test_of(folder.path(), &(text + &lines_of(&refusal))));
    }
}
