//! Inputs without end, numbers beyond all sense and names with control characters: refused or harmless, and said.

use crate::support::{Bench, FORCE, MODEL, TEST, changed, refused};

#[cfg(unix)]
#[test]
fn devices_and_pipes_are_refused_by_name() {
    let bench = Bench::new();
    let made = std::process::Command::new("mkfifo").arg(bench.path("pipe")).status().expect("mkfifo starts");
    assert!(made.success());
    for (input, kind) in [("/dev/zero", "it is a device"), ("pipe", "it is a pipe"), ("examples", "it is a folder")] {
        let said = [input, "cannot be read", kind, "not a file"];
        for line in [
            format!("modes {input}"),
            format!("export {input} -o x.fmu"),
            format!("accelerance {input} --force 0 --response 0 --from 1 --to 2 --lines 3"),
            format!("simulate {input} --force-file force.csv"),
            format!("simulate model.json --force-file {input}"),
        ] {
            refused(&bench, &line, 2, &said);
        }
        // A folder stands for the test file in it.
        if input != "examples" {
            for line in ["identify", "trace", "run -o out", "report -o x.html"] {
                refused(&bench, &format!("{line} {input}"), 2, &said);
            }
        }
    }
    bench.write(
        "of-a-pipe.toml",
        &(TEST.replace("natural-frequencies", "time-history").replace("values", "file = \"pipe\" #")
            + "force_at = [0.0, 0.0]\nresponse_at = [0.1, 0.0]\n"),
    );
    refused(&bench, "identify of-a-pipe.toml", 2, &["measurement[1].file", "pipe", "it is a pipe, not a file"]);
}

#[test]
fn a_file_too_large_is_refused_with_both_sizes() {
    let bench = Bench::new();
    // A hole of 20 MB: nothing is written.
    let sparse = std::fs::File::create(bench.path("large.json")).expect("made");
    sparse.set_len(20 << 20).expect("sized");
    refused(&bench, "modes large.json", 2, &["large.json", "20971520 bytes", "a model file may have 16777216"]);
    std::fs::rename(bench.path("large.json"), bench.path("large.toml")).expect("renamed");
    refused(&bench, "identify large.toml", 2, &["large.toml", "20971520 bytes", "a test file may have 4194304"]);
}

#[test]
fn counts_beyond_all_sense_are_refused() {
    let bench = Bench::new();
    let grid = "accelerance model.json --force 0 --response 0 --from 1 --to 2";
    refused(&bench, "modes model.json --count 1000000000", 2, &["1000000000 modes", "1000"]);
    refused(&bench, "modes plate.json --count 18446744073709551615", 2, &["18446744073709551615 modes", "resolves"]);
    refused(&bench, "export model.json -o x.fmu --modes 10000000", 2, &["10000000 modes", "1000"]);
    refused(
        &bench,
        &format!("{grid} --lines 3 --modes 18446744073709551615"),
        2,
        &["18446744073709551615 modes", "1000"],
    );
    for line in [
        format!("{grid} --lines 18446744073709551615"),
        "modes model.json --count 99999999999999999999".into(),
        "simulate model.json --force-file force.csv --steps 18446744073709551615".into(),
    ] {
        assert_eq!(bench.run(&line).status.code(), Some(2), "{line}");
    }
    for model in ["model.json", "plate.json"] {
        for (line, said) in
            [("-o x.fmu --up-to 1e300", "1e300 Hz"), ("-o x.fmu --force 1e-300 --up-to 1e18", "1e18 Hz")]
        {
            refused(&bench, &format!("export {model} {line}"), 2, &[said, "modes at most"]);
        }
    }
    let forces = " --force 0.1".repeat(501);
    refused(&bench, &format!("export model.json -o x.fmu{forces}"), 2, &["--force", "501 times", "500"]);
    let ports = format!("[{}]", vec!["[0.1, 0]"; 501].join(", "));
    bench.write("model.json", &changed(MODEL, "[[-0.3, 0]]", &ports));
    refused(&bench, "modes model.json", 2, &["501 ports.forces", "500"]);
    let ratios = vec!["0.003"; 1001].join(", ");
    bench.write("model.json", &changed(MODEL, "{\"beyond\"", &format!("{{\"ratios\": [{ratios}], \"beyond\"")));
    refused(&bench, "modes model.json", 2, &["1001 damping.ratios", "1000", "damping.beyond"]);
}

#[test]
fn a_list_that_would_be_traced_for_an_hour_is_refused_and_its_way_out_is_one() {
    let bench = Bench::new();
    let most = orthopanel_data::limits::FREQUENCIES_TRACED;
    let listed = |count: usize| {
        let answer = bench.json(&format!("modes model.json --count {count}"));
        let modes = answer["modes"].as_array().expect("modes");
        let values: Vec<String> =
            modes.iter().map(|mode| format!("{:.2}", crate::support::number(mode, "/frequency_hz"))).collect();
        bench.write("test.toml", &changed(TEST, "321.3, 837.5, 1520.0, 2312.5, 3150.0, 3987.5", &values.join(", ")));
    };
    listed(most + 1);
    let said =
        [&*format!("a list of {} natural frequencies", most + 1), &format!("takes {most} at most"), "list the lowest"];
    refused(&bench, "trace test.toml", 2, &said);
    // `run` does all but that.
    bench.done("identify test.toml");
    bench.done("run test.toml -o out");
    assert!(!bench.path("out/trace.json").exists());
}

/// Twenty lists of six took two minutes, and 333 had not ended after eight.
#[test]
fn regress_many_lists_of_one_piece_are_refused_together() {
    let bench = Bench::new();
    let list = "\n[[measurement]]\nkind = \"natural-frequencies\"\nvalues = [";
    let lists: String =
        (0..21).map(|i| format!("{list}{}, 837.5, 1520.0, 2312.5, 3150.0, 3987.5]\n", 321 + i)).collect();
    bench.write("test.toml", &format!("{TEST}{lists}"));
    refused(&bench, "trace test.toml", 2, &["132 natural frequencies", "takes 120 of one piece", "mean of repeats"]);
    bench.done("identify test.toml");
}

#[test]
fn nesting_has_an_end() {
    let bench = Bench::new();
    let deep = format!("{}1{}", "[".repeat(200_000), "]".repeat(200_000));
    bench.write("model.json", &changed(MODEL, "\"schema\"", &format!("\"provenance\": {{\"a\": {deep}}}, \"schema\"")));
    refused(&bench, "modes model.json", 2, &["model.json: line 1", "recursion limit"]);
}

#[test]
fn each_size_and_constant_is_blamed_on_itself() {
    let bench = Bench::new();
    for (key, value) in [("length", "0.8"), ("width", "0.1"), ("thickness", "0.03"), ("mass_per_area", "6.88")] {
        for absurd in ["1e308", "1e-308"] {
            let of_model = changed(MODEL, &format!("\"{key}\": {value}"), &format!("\"{key}\": {absurd}"));
            bench.write("model.json", &of_model);
            refused(&bench, "modes model.json", 2, &[&format!("model.json: {key} = {absurd} "), "must lie between"]);
            let of_test = changed(TEST, &format!("{key} = {value}"), &format!("{key} = {absurd}"));
            bench.write("test.toml", &of_test);
            refused(
                &bench,
                "identify test.toml",
                2,
                &["test.toml:", &format!("{key} = {absurd} "), "must lie between"],
            );
        }
    }
    for (key, value) in [("e_x", "1.07e10"), ("g_zx", "5.363e8")] {
        for absurd in ["1e308", "1e-308"] {
            bench.write("model.json", &changed(MODEL, &format!("\"{key}\": {value}"), &format!("\"{key}\": {absurd}")));
            refused(&bench, "modes model.json", 2, &[&format!("{key} = {absurd} Pa: must lie between")]);
        }
    }
}

#[test]
fn a_byte_order_mark_is_welcome_everywhere() {
    let bench = Bench::new();
    let marked = |name: &str, text: &str| bench.write(name, &format!("\u{feff}{text}"));
    marked("model.json", MODEL);
    marked("test.toml", TEST);
    marked("force.csv", FORCE);
    bench.done("modes model.json");
    bench.done("identify test.toml");
    bench.done("simulate model.json --force-file force.csv -o y.csv");
    // Of a measured hit the mark hides no column.
    let rows: String = (0..64)
        .map(|n| format!("{},{},{}\n", n as f64 * 1e-4, if n == 9 { 1.0 } else { 0.0 }, (n as f64).sin()))
        .collect();
    marked("hit.csv", &format!("time_s,force_n,acceleration_m_s2\n{rows}"));
    let output = bench.run("simulate model.json --force-file hit.csv --method exact");
    assert!(String::from_utf8_lossy(&output.stdout).contains("explained"), "{output:?}");
}

/// A test of two pieces whose names do what names of strangers may do.
fn of_strangers(first: &str, second: &str) -> String {
    let piece = |name: &str| format!("[[piece]]\nname = \"{name}\"\n{}", &TEST[8..TEST.find("[[m").expect("a list")]);
    let list = |name: &str| format!("{}piece = \"{name}\"\n", &TEST[TEST.find("[[m").expect("a list")..]);
    piece(first) + &piece(second) + &list(first) + &list(second)
}

#[test]
fn names_steer_no_picture_and_no_page() {
    let bench = Bench::new();
    let (script, steers) = ("<script>alert(1)</script>", r"]]></svg><img src=x>\u202e\u001b[2J\u0000\u0085/../../x");
    bench.write("test.toml", &of_strangers(script, steers));
    bench.done("run test.toml -o out");
    let written = bench.listing().into_iter().filter(|path| path.starts_with(bench.path("out")) && path.is_file());
    let mut pages = 0;
    for path in written {
        assert_eq!(path.parent(), Some(bench.path("out").as_path()), "{}", path.display());
        let name = path.file_name().and_then(|name| name.to_str()).expect("a name");
        assert!(name.chars().all(|of| of.is_ascii_graphic() && !"<>:\"/\\|?*".contains(of)), "{name}");
        if !(name.ends_with(".svg") || name.ends_with(".html")) {
            continue;
        }
        pages += 1;
        let text = std::fs::read_to_string(&path).expect("text");
        let steering = |of: &char| (of.is_control() && *of != '\n') || ('\u{202a}'..='\u{202e}').contains(of);
        assert_eq!(text.chars().find(steering), None, "{name}");
        assert!(!text.contains("<script") && !text.contains("<img"), "{name}");
    }
    assert!(pages > 3, "{pages}");
}

#[test]
fn long_names_and_names_alike_have_files_of_their_own() {
    let bench = Bench::new();
    let long = "long ".repeat(39);
    for (first, second) in [("Plate", "plate"), (&*(long.clone() + "1"), &*(long + "2"))] {
        bench.write("test.toml", &of_strangers(first, second));
        bench.done("identify test.toml -o out.json");
        let models = bench.listing().into_iter().filter_map(|path| {
            let name = path.file_name()?.to_str()?.to_lowercase();
            (name.starts_with("out-") && name != "out-manifest.json").then_some((name, path))
        });
        let models: Vec<_> = models.collect();
        assert_eq!(models.len(), 2, "{models:?}");
        assert_ne!(models[0].0, models[1].0);
        models.iter().for_each(|(_, path)| std::fs::remove_file(path).expect("removed"));
    }
}

#[test]
fn what_keeps_a_file_from_being_written_is_said_and_what_to_do() {
    let bench = Bench::new();
    std::fs::create_dir(bench.path("folder")).expect("made");
    for (target, said) in [
        ("nowhere/out.json", "name a place in a folder that exists"),
        ("folder", "it is a folder: name a file in it"),
        ("model.json/out.json", "a place that does not lie below a file"),
        (&*format!("{}.json", "a".repeat(300)), "give a shorter name"),
    ] {
        let before = bench.listing();
        let output = bench.run(&format!("identify test.toml -o {target}"));
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert_eq!(bench.listing(), before, "{message}");
        assert!(message.contains("cannot be written") && message.contains(said), "{message}");
    }
}

/// Whether a text holds a number that nobody reads, or one that is none.
fn unreadable(text: &str) -> Option<String> {
    let is_part = |of: char| of.is_ascii_alphanumeric() || of == '.' || of == '-' || of == '+';
    let words = text.split(|of: char| !is_part(of));
    let lost = |word: &&str| {
        let bare = word.trim_matches(['-', '+', '.']);
        let whole = bare.split('.').next().unwrap_or_default();
        matches!(bare, "NaN" | "nan" | "inf" | "infinity" | "Infinity")
            || (whole.len() > 15 && whole.bytes().all(|byte| byte.is_ascii_digit()))
    };
    words.clone().find(lost).map(str::to_owned)
}

/// Lists as far apart as a panel allows: whatever is said of them has numbers that people can read.
#[test]
fn no_output_holds_numbers_without_sense() {
    let bench = Bench::new();
    for values in [
        "0.01, 837.5, 1520.0, 2312.5, 3150.0, 3987.5, 5e6",
        "0.01, 0.0101, 0.0102, 0.0103, 0.0104, 0.0105",
        "321.3, 321.300000001, 321.300000002, 321.300000003, 321.300000004, 3e6",
        "321.3, 837.5, 1520.0, 2312.5, 3150.0, 3987.5",
    ] {
        bench.write("test.toml", &changed(TEST, "321.3, 837.5, 1520.0, 2312.5, 3150.0, 3987.5", values));
        for line in ["identify test.toml", "identify test.toml --json", "trace test.toml", "trace test.toml --json"] {
            let output = bench.run(line);
            assert!(matches!(output.status.code(), Some(0..=2)), "{line}: {output:?}");
            for text in [&output.stdout, &output.stderr] {
                let text = String::from_utf8_lossy(text);
                assert_eq!(unreadable(&text), None, "{line} of {values}: {text}");
            }
        }
        bench.run("run test.toml -o out");
        for path in bench.listing().iter().filter(|path| path.starts_with(bench.path("out"))) {
            if let Ok(text) = std::fs::read_to_string(path) {
                assert_eq!(unreadable(&text), None, "{} of {values}", path.display());
            }
        }
    }
}
