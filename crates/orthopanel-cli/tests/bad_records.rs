//! Bad records: one message that names file and line or byte, exit status 2, nothing left behind.

use crate::support::{Bench, ROOT, changed, refused};

const PIECE: &str = "[piece]\nlength = 0.8\nwidth = 0.1\nthickness = 0.03\nmass_per_area = 6.88\n";

fn measurement(file: &str) -> String {
    format!(
        "[[measurement]]\nkind = \"time-history\"\nfile = \"{file}\"\nforce_at = [-0.3, 0.0]\nresponse_at = [0.3, 0.0]\n"
    )
}

/// A blow of some 0.3 ms and a piece that rings at 320 and 836 Hz.
fn hit(samples: usize, rate: f64) -> String {
    let mut text = String::from("time_s,force_n,acceleration_m_s2\n");
    for sample in 0..samples {
        let time = sample as f64 / rate;
        let after = time - 0.005;
        let blow = std::f64::consts::PI * after / (4.0 / rate).max(3e-4);
        let force = if (0.0..std::f64::consts::PI).contains(&blow) { 100.0 * blow.sin() } else { 0.0 };
        let ring = |frequency: f64| (std::f64::consts::TAU * frequency * after).sin() * (-20.0 * after).exp();
        // What lies above half the rate, the anti-alias filter takes out.
        let upper = if 2.0 * 836.0 < rate { 200.0 * ring(836.0) } else { 0.0 };
        let acceleration = if after > 0.0 { 300.0 * ring(320.0) + upper } else { 0.0 };
        text += &format!("{time},{force},{acceleration}\n");
    }
    text
}

/// Every command that reads records refuses `test.toml` with these measurements and files.
fn test_refused(test: &str, files: &[(&str, &[u8])], said: &[&str]) {
    let bench = Bench::new();
    std::fs::write(bench.path("test.toml"), test).expect("a file is written");
    for (name, bytes) in files {
        std::fs::write(bench.path(name), bytes).expect("a file is written");
    }
    for line in [
        "identify test.toml -o out.json",
        "run test.toml -o out",
        "accelerance test.toml -o out.csv",
        "simulate model.json --force-file test.toml -o out.csv",
    ] {
        refused(&bench, line, 2, said);
    }
}

/// One CSV file of a hit, changed.
fn hit_refused(text: &str, said: &[&str]) {
    test_refused(&(PIECE.to_owned() + &measurement("hit.csv")), &[("hit.csv", text.as_bytes())], said);
}

/// The example's binary universal file, cut after `bytes`.
fn cut_example(bytes: usize) -> Vec<u8> {
    let whole = std::fs::read(format!("{ROOT}/examples/made-hits/point-0.uff")).expect("the example");
    whole[..bytes].to_vec()
}

#[test]
fn channels_swapped_or_missing() {
    let text = hit(4096, 16384.0);
    let swapped = changed(&text, "force_n,acceleration_m_s2", "acceleration_m_s2,force_n");
    hit_refused(&swapped, &["hit.csv", "swapped"]);
    hit_refused(
        &changed(&text, ",acceleration_m_s2", ""),
        &["hit.csv:2", "3 values where the first line names 2 columns"],
    );
    hit_refused(&changed(&text, "force_n", "voltage"), &["hit.csv:1", "the force is in volts", "force_sensitivity"]);
}

#[test]
fn a_sample_that_is_no_number() {
    let text = hit(4096, 16384.0);
    let line = text.lines().nth(100).expect("a line");
    let (time, _) = line.split_once(',').expect("a cell");
    hit_refused(&changed(&text, line, &format!("{time},0,NaN")), &["hit.csv:101", "acceleration_m_s2", "finite"]);
    hit_refused(&changed(&text, line, &format!("{time},oops,0")), &["hit.csv:101", "force_n", "oops"]);
}

#[test]
fn lengths_that_differ() {
    // Within a file: the last row has lost its end.
    let text = hit(4096, 16384.0);
    let cut = text.trim_end().rsplit_once(',').expect("a cell").0;
    hit_refused(cut, &["hit.csv", "4097"]);
    // Between hits of one pair of places.
    let test = PIECE.to_owned() + &measurement("hit.csv") + &measurement("short.csv");
    let short = hit(2048, 16384.0);
    let files = [("hit.csv", text.as_bytes()), ("short.csv", short.as_bytes())];
    test_refused(&test, &files, &["short.csv", "2048", "4096", "must agree"]);
}

#[test]
fn a_file_cut_off() {
    let test = PIECE.to_owned() + &measurement("point-0.uff");
    let middle = cut_example(50_000);
    test_refused(&test, &[("point-0.uff", &middle)], &["point-0.uff, byte", "cut off"]);
    let nothing: &[u8] = b"";
    test_refused(&test, &[("point-0.uff", nothing)], &["point-0.uff"]);
    test_refused(&test, &[("point-0.uff", b"\x89PNG and so on")], &["point-0.uff", "not a file of records"]);
}

#[test]
fn a_file_that_is_not_there() {
    test_refused(
        &(PIECE.to_owned() + &measurement("nowhere.uff")),
        &[],
        &["test.toml:8", "measurement[1].file", "nowhere.uff"],
    );
}

#[test]
fn places_and_units_that_contradict() {
    let text = hit(4096, 16384.0);
    let files = [("hit.csv", text.as_bytes())];
    let test = PIECE.to_owned() + &measurement("hit.csv");
    test_refused(&changed(&test, "[0.3, 0.0]", "[0.5, 0.0]"), &files, &["test.toml:10", "response_at", "0.5", "0.4"]);
    test_refused(&changed(&test, "response_at = [0.3, 0.0]\n", ""), &files, &["measurement[1].response_at", "missing"]);
    test_refused(&(test + "unit = \"g\"\n"), &files, &["hit.csv", "m/s2", "another unit"]);
}

/// Half the rate lies below the second mode: there is nothing to tell two constants apart.
#[test]
fn a_sampling_rate_too_low() {
    let bench = Bench::new();
    std::fs::write(bench.path("test.toml"), PIECE.to_owned() + &measurement("hit.csv")).expect("a file is written");
    std::fs::write(bench.path("hit.csv"), hit(1024, 1000.0)).expect("a file is written");
    let before = bench.listing();
    for line in ["identify test.toml -o out.json", "run test.toml -o out"] {
        let output = bench.run(line);
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{line}: {message}");
        assert!(message.contains("test.toml") && message.contains("2 constants"), "{line}: {message}");
        assert_eq!(bench.listing(), before, "{line} left something behind");
    }
}

/// The records themselves say no: every hit is a double one.
#[test]
fn no_hit_left_is_no_bad_input() {
    let bench = Bench::new();
    let text = hit(4096, 16384.0);
    let twice: String = text
        .lines()
        .enumerate()
        .map(|(index, line)| {
            let mut cells: Vec<&str> = line.split(',').collect();
            if (200..204).contains(&index) {
                cells[1] = "60";
            }
            cells.join(",") + "\n"
        })
        .collect();
    std::fs::write(bench.path("test.toml"), PIECE.to_owned() + &measurement("hit.csv")).expect("a file is written");
    std::fs::write(bench.path("hit.csv"), twice).expect("a file is written");
    refused(&bench, "identify test.toml -o out.json", 1, &["hit.csv", "hit 1 left out", "double hit"]);
    refused(&bench, "accelerance test.toml -o out.csv", 1, &["hit.csv", "hit 1 left out", "double hit"]);
}

#[test]
fn options_that_do_not_fit_records() {
    let bench = Bench::new();
    let test = "examples/made-hits/test.toml";
    refused(&bench, &format!("accelerance {test} --force 0"), 2, &["made-hits", "--force", "leave it out"]);
    refused(&bench, "accelerance model.json --force 0", 2, &["model.json", "--response", "--lines"]);
    refused(&bench, "accelerance test.toml", 2, &["test.toml", "no records"]);
    refused(&bench, &format!("simulate model.json --force-file {test} --force 0"), 2, &["made-hits", "leave out"]);
    refused(&bench, &format!("simulate model.json --force-file {test} --hold held"), 2, &["--hold held"]);
    refused(&bench, &format!("simulate model.json --force-file {test} --modes 3"), 2, &["--modes"]);
    bench.done("export model.json -o panel.fmu");
    refused(&bench, &format!("simulate panel.fmu --force-file {test}"), 2, &["panel.fmu", "MODEL.json"]);
    for line in ["--window force-exponential", "--window hamming", "--tau 0", "--estimator h3", "--damping none"] {
        let output = bench.run(&format!("identify {test} {line}"));
        assert_eq!(output.status.code(), Some(2), "{line}");
        assert!(output.stdout.is_empty() && !output.stderr.is_empty(), "{line}");
    }
}
