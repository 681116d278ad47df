//! From files of records to a first result: `records`, `init`, and the test file filled in.

use crate::support::{Bench, changed, number, refused};

const HITS: &str = "examples/made-hits/point-0.uff";

#[test]
fn val_records_lists_what_a_file_holds() {
    let bench = Bench::new();
    let answer = bench.json(&format!("records {HITS}"));
    assert_eq!(answer["schema"], "orthopanel.records/1");
    let records = answer["files"][0]["records"].as_array().expect("records");
    assert_eq!(records.len(), 6);
    assert_eq!((&records[0]["quantity"], &records[0]["unit"]), (&"force".into(), &"N".into()));
    assert_eq!((&records[1]["quantity"], &records[1]["unit"]), (&"acceleration".into(), &"m/s^2".into()));
    assert_eq!((number(&records[0], "/sampling_rate_hz"), number(&records[0], "/points")), (10240.0, 16384.0));
    let table = bench.done(&format!("records {HITS}"));
    assert_eq!(table.lines().count(), 2 + 6, "{table}");
    bench.write("frf.txt", "Freq (kHz);Mag (g/N);Phase (deg)\n0,1;2,5;0\n0,2;3,5;90\n");
    let table = bench.done("records frf.txt");
    assert!(table.contains("acceleration / force") && table.contains("100 to 200 Hz by 100 Hz"), "{table}");
}

/// The draft asks for what records do not tell, by its name; filled in, it leads to the constants.
#[test]
fn val_init_leads_to_the_constants() {
    let bench = Bench::new();
    let said = bench.run(&format!("init {HITS} -o mine.toml"));
    assert_eq!(said.status.code(), Some(0), "{}", String::from_utf8_lossy(&said.stderr));
    refused(&bench, "identify mine.toml", 2, &["mine.toml", "piece.length is missing: give it in m"]);
    // What a person has filled in is kept.
    refused(&bench, &format!("init {HITS} -o mine.toml"), 2, &["mine.toml", "may be filled in", "another place"]);
    refused(&bench, &format!("init {HITS} -o {HITS}"), 2, &["read by this command"]);
    let mut text = std::fs::read_to_string(bench.path("mine.toml")).expect("a draft");
    for key in ["length", "width", "thickness", "mass_per_area"] {
        text = changed(&text, &format!("\n# {key} = "), &format!("\n{key} = "));
    }
    let lines: Vec<&str> =
        text.lines().filter(|line| !line.contains("force_at") && !line.contains("response_at")).collect();
    let text = lines.join("\n") + "\nforce_at = [-0.3, 0.0]\nresponse_at = [0.3, 0.0]\n";
    bench.write("mine.toml", &text);
    let answer = bench.json("identify mine.toml");
    let truth = bench.read_json("examples/made-hits/truth.json");
    for name in ["e_x", "g_zx"] {
        let (found, due) =
            (number(&answer, &format!("/constants/{name}/value")), number(&truth, &format!("/constants/{name}")));
        assert!((found / due - 1.0).abs() < 3e-3, "{name}: {found:e}");
    }
}

/// A file of another format is named for what it is, with two lines to copy, each on a line of its own.
#[test]
fn val_other_formats_are_named_with_the_lines_that_convert_them() {
    let bench = Bench::new();
    std::fs::write(bench.path("x.npy"), b"\x93NUMPY\x01\x00").expect("a file is written");
    for line in ["records x.npy", "init x.npy -o new.toml"] {
        refused(&bench, line, 2, &["x.npy: a NPY or NPZ file of NumPy, which is not read", "numpy.load(\"x.npy\")"]);
        let said = bench.run(line);
        let said = String::from_utf8_lossy(&said.stderr);
        assert_eq!(said.lines().filter(|line| line.starts_with("    ")).count(), 2, "{said}");
    }
    assert!(!bench.path("new.toml").exists());
    refused(&bench, "records nowhere.uff", 2, &["nowhere.uff", "cannot be read"]);
    refused(&bench, "records examples", 2, &["examples", "a folder"]);
}
