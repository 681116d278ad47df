//! From files of records to a first result: `records`, `init`, and the test file filled in.

use crate::support::{Bench, changed, number, refused};

const HITS: &str = "examples/made-hits/point-0.uff";

/// What a refused line says.
fn said(bench: &Bench, line: &str, code: i32) -> String {
    let output = bench.run(line);
    assert_eq!(output.status.code(), Some(code), "{line}");
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn val_records_lists_what_a_file_holds() {
    let bench = Bench::new();
    let answer = bench.json(&format!("records {HITS}"));
    assert_eq!(answer["schema"], "orthopanel.records/1");
    let records = answer["files"][0]["records"].as_array().expect("records");
    assert_eq!(records.len(), 6);
    assert_eq!((&records[0]["quantity"], &records[0]["unit"]), (&"force".into(), &"N".into()));
    assert_eq!((&records[1]["quantity"], &records[1]["unit"]), (&"acceleration".into(), &"m/s2".into()));
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
        let said = said(&bench, line, 2);
        assert!(said.contains("x.npy: a NPY or NPZ file of NumPy, which is not read"), "{said}");
        let lines: Vec<&str> = said.lines().filter(|line| line.starts_with("    ")).collect();
        assert!(lines.len() == 2 && lines[0].contains("numpy.load(\"x.npy\")"), "{said}");
    }
    assert!(!bench.path("new.toml").exists());
    refused(&bench, "records nowhere.uff", 2, &["nowhere.uff", "cannot be read"]);
    refused(&bench, "records examples", 2, &["examples", "a folder"]);
}

/// One file that is not read hides no other.
#[test]
fn val_records_lists_the_others_beside_a_file_that_is_not_read() {
    let bench = Bench::new();
    std::fs::write(bench.path("x.npy"), b"\x93NUMPY\x01\x00").expect("a file is written");
    let output = bench.run(&format!("records x.npy nowhere.uff {HITS} --json"));
    assert_eq!(output.status.code(), Some(2));
    let answer: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(answer["files"][0]["records"].as_array().map(Vec::len), Some(6));
    let not_read: Vec<&str> =
        answer["not_read"].as_array().expect("a list").iter().filter_map(|of| of["file"].as_str()).collect();
    assert_eq!(not_read, ["x.npy", "nowhere.uff"]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.contains("x.npy: a NPY") && said.contains("nowhere.uff: cannot be read"), "{said}");
}

/// Force and response in files of their own are one measurement, and responses to one blow are one each.
#[test]
fn val_init_pairs_files_and_names_channels() {
    let bench = Bench::new();
    let table = |names: &str, columns: usize| {
        let row = |n: usize| format!("{}{}\n", n as f64 / 12800.0, ",1".repeat(columns));
        format!("{names}\n{}", (0..64).map(row).collect::<String>())
    };
    for hit in 1..3 {
        bench.write(&format!("hammer-{hit}.csv"), &table("Time (s),Force (N)", 1));
        bench.write(&format!("acc-{hit}.csv"), &table("Time (s),Acc (m/s2)", 1));
    }
    bench.done("init hammer-1.csv hammer-2.csv acc-1.csv acc-2.csv -o two.toml");
    let text = std::fs::read_to_string(bench.path("two.toml")).expect("a draft");
    for hit in 1..3 {
        assert!(
            text.contains(&format!("file = {{force = \"hammer-{hit}.csv\", response = \"acc-{hit}.csv\"}}")),
            "{text}"
        );
    }
    assert_eq!(text.matches("[[measurement]]\n").count(), 2, "{text}");
    bench.write("three.csv", &table("Time (s),Force (N),Acc A (m/s2),Acc B (m/s2)", 3));
    bench.done("init three.csv -o three.toml");
    let text = std::fs::read_to_string(bench.path("three.toml")).expect("a draft");
    for name in ["Acc A", "Acc B"] {
        assert!(text.contains(&format!("file = \"three.csv\"\nresponse_channel = \"{name}\"")), "{text}");
    }
    let lines: String = (1..200).map(|line| format!("{},1,0\n", 0.02 * f64::from(line))).collect();
    bench.write("khz.csv", &format!("frequency,real,imag\n{lines}"));
    let said = bench.run("init khz.csv -o khz.toml");
    assert!(
        String::from_utf8_lossy(&said.stderr).contains("are they in kHz? write frequency_unit = \"kHz\""),
        "{said:?}"
    );
}

/// A unit that all records lack is named by `identify`, `trace` and `run` alike, before anything is searched.
#[test]
fn val_a_unit_that_all_records_lack_is_named_first() {
    let bench = Bench::new();
    bench.done("accelerance examples/made-hits/test.toml -o lines.csv");
    let lines = std::fs::read_to_string(bench.path("lines.csv")).expect("lines");
    let mut rows = lines.lines();
    let names: Vec<&str> = rows.next().expect("names").split(',').collect();
    let mut text = String::from("frequency_hz,real,imag\n");
    for row in rows {
        let numbers: Vec<f64> = row.split(',').filter_map(|number| number.parse().ok()).collect();
        let of = |name: &str| numbers[names.iter().position(|of| *of == name).expect("a column")];
        text += &format!("{},{},{}\n", of("frequency_hz"), of("real") / 9.80665, of("imag") / 9.80665);
    }
    bench.write("g.csv", &text);
    let test = std::fs::read_to_string(bench.path("examples/made-hits/test.toml")).expect("a test");
    let piece = test.split("[[measurement]]").next().expect("a piece");
    bench.write("g.toml", &format!(
        "{piece}[[measurement]]\nkind = \"accelerance\"\nfile = \"g.csv\"\nforce_at = [-0.3, 0]\nresponse_at = [0.3, 0]\n"
    ));
    for command in ["identify g.toml", "trace g.toml", "run g.toml -o out"] {
        let said = said(&bench, command, 1);
        let first =
            "g.toml: write quantity = \"acceleration\" and response_unit = \"g\" in each [[measurement]]: all records";
        assert!(said.contains(first), "{command}: {said}");
    }
}
