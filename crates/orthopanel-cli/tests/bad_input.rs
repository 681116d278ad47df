//! Bad input: one message that names file, key and what would be right; exit status 2; nothing left behind.

use crate::support::{Bench, FORCE, MODEL, PLATE, TEST, changed, refused};

/// Every command that reads a test refuses this one.
fn test_refused(from: &str, to: &str, said: &[&str]) {
    let bench = Bench::new();
    std::fs::write(bench.path("test.toml"), changed(TEST, from, to)).expect("a file is written");
    let said = [&["test.toml"], said].concat();
    refused(&bench, "identify test.toml -o out.json", 2, &said);
    refused(&bench, "run test.toml -o out", 2, &said);
}

/// Every command that reads a model refuses this one.
fn model_refused(from: &str, to: &str, said: &[&str]) {
    let bench = Bench::new();
    std::fs::write(bench.path("model.json"), changed(MODEL, from, to)).expect("a file is written");
    let said = [&["model.json"], said].concat();
    for line in [
        "modes model.json",
        "accelerance model.json --force 0 --response 0 --from 1 --to 2 --lines 3 -o out.csv",
        "export model.json -o out.fmu",
        "simulate model.json --force-file force.csv -o out.csv",
    ] {
        refused(&bench, line, 2, &said);
    }
}

#[test]
fn a_test_with_a_key_missing() {
    test_refused("length = 0.8\n", "", &["piece.length", "missing", "m"]);
    test_refused("mass_per_area = 6.88\n", "", &["piece.mass_per_area", "kg/m2", "weighings"]);
    test_refused("kind = \"natural-frequencies\"\n", "", &["measurement[1].kind", "natural-frequencies"]);
}

#[test]
fn a_test_with_an_unknown_key() {
    test_refused("length", "lenght", &["lenght"]);
    test_refused("values", "frequencies", &["frequencies"]);
}

#[test]
fn a_test_with_impossible_sizes() {
    for size in ["0.0", "-0.03", "nan", "inf"] {
        test_refused("thickness = 0.03", &format!("thickness = {size}"), &["piece.thickness"]);
    }
    test_refused("6.88", "-6.88", &["piece.mass_per_area", "-6.88"]);
}

#[test]
fn a_test_with_fewer_frequencies_than_constants() {
    test_refused(
        "[321.3, 837.5, 1520.0, 2312.5, 3150.0, 3987.5]",
        "[321.3]",
        &["1 natural frequenc", "2", "e_x", "g_zx"],
    );
}

#[test]
fn a_test_with_frequencies_out_of_order() {
    test_refused("2312.5, 3150.0", "3150.0, 2312.5", &["mode 5", "2312.5", "mode 4", "3150", "rising order"]);
}

#[test]
fn a_test_with_a_place_off_the_piece() {
    let sensor = "kind = \"natural-frequencies\"\nresponse_at = [0.5, 0.0]";
    test_refused("kind = \"natural-frequencies\"", sensor, &["response_at", "0.5", "0.4"]);
}

#[test]
fn a_test_that_is_not_there() {
    let bench = Bench::new();
    refused(&bench, "run nowhere.toml -o out", 2, &["nowhere.toml", "cannot be read"]);
}

#[test]
fn a_model_of_another_schema() {
    model_refused("orthopanel.model/1", "orthopanel.model/9", &["schema", "orthopanel.model/9", "orthopanel.model/1"]);
    model_refused("\"schema\": \"orthopanel.model/1\",", "", &["schema is missing", "orthopanel.model/1"]);
}

#[test]
fn a_model_with_keys_missing_or_unknown() {
    model_refused("\"length\": 0.8, ", "", &["length"]);
    model_refused("\"length\"", "\"lenght\"", &["lenght", "length"]);
    model_refused(", \"g_zx\": 5.363e8", "", &["g_zx", "missing"]);
    model_refused("\"e_x\"", "\"e_y\": 1e9, \"e_x\"", &["constants.e_y is unknown", "e_x, g_zx"]);
}

#[test]
fn a_model_with_impossible_numbers() {
    for size in ["0", "-0.8", "1e999", "\"long\""] {
        model_refused("\"length\": 0.8", &format!("\"length\": {size}"), &["length"]);
    }
    model_refused("\"length\": 0.8", "\"length\": -0.8", &["length = -0.8 m", "greater than zero"]);
    model_refused("1.07e10", "\"stiff\"", &["model.json: line 3: constants.e_x: must be a number", "\"stiff\""]);
    model_refused("1.07e10", "-1.07e10", &["e_x", "must lie between"]);
    model_refused("0.003", "1.5", &["damping", "1.5"]);
    model_refused("[-0.3, 0]", "[-0.5, 0]", &["-0.5", "off the piece", "0.4"]);
}

#[test]
fn a_place_on_the_command_line_off_the_piece() {
    let bench = Bench::new();
    refused(&bench, "export model.json -o out.fmu --force -0.3 --response 0,0.06", 2, &["--response 0,0.06", "0.05"]);
    refused(&bench, "simulate model.json --force-file force.csv --force=-0.41", 2, &["--force -0.41", "0.4"]);
    let line = "accelerance model.json --force 0 --response 9 --from 1 --to 2 --lines 3";
    refused(&bench, line, 2, &["--response 9", "0.4"]);
}

#[test]
fn a_target_that_cannot_be_written() {
    let bench = Bench::new();
    for line in [
        "identify test.toml -o nowhere/out.json",
        "accelerance model.json --force 0 --response 0 --from 1 --to 2 --lines 3 -o nowhere/out.csv",
        "export model.json -o nowhere/out.fmu",
        "simulate model.json --force-file force.csv -o nowhere/out.csv",
    ] {
        let before = bench.listing();
        let output = bench.run(line);
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{line}: {message}");
        assert!(message.contains("nowhere") && message.contains("cannot be written"), "{line}: {message}");
        assert_eq!(bench.listing(), before, "{line} left something behind");
    }
    // A file stands where the folder should be.
    let output = bench.run("run test.toml -o model.json");
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("model.json: cannot be written"));
}

#[test]
fn a_force_file_that_does_not_fit() {
    let bench = Bench::new();
    std::fs::write(bench.path("force.csv"), changed(FORCE, "1e-4", "-1")).expect("a file is written");
    refused(&bench, "simulate model.json --force-file force.csv -o out.csv", 2, &["force.csv:3", "time_s", "rise"]);
    let line = "simulate model.json --force-file force.csv --force -0.3 --force 0.1";
    refused(&bench, line, 2, &["force.csv:1", "force_1_n", "time_s,force_1_n,force_2_n"]);
}

#[test]
fn an_fmu_that_is_none_of_ours() {
    let bench = Bench::new();
    std::fs::write(bench.path("broken.fmu"), b"PK\x03\x04 and then nothing of a zip archive")
        .expect("a file is written");
    refused(&bench, "simulate broken.fmu --force-file force.csv -o out.csv", 2, &["broken.fmu", "zip archive"]);
    std::fs::write(bench.path("junk.fmu"), "no archive at all").expect("a file is written");
    refused(&bench, "simulate junk.fmu --force-file force.csv", 2, &["junk.fmu", "not an FMU", "no zip archive"]);
    // The smallest zip archive: one empty file named "a", its directory, and the end record.
    let local = b"PK\x03\x04\x0a\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x01\0\0\0a";
    let directory = [&b"PK\x01\x02\x0a\0\x0a\0"[..], &[0; 20], b"\x01\0", &[0; 16], b"a"].concat();
    let end = b"PK\x05\x06\0\0\0\0\x01\0\x01\0\x2f\0\0\0\x1f\0\0\0\0\0";
    std::fs::write(bench.path("empty.fmu"), [&local[..], &directory, end].concat()).expect("a file is written");
    refused(&bench, "simulate empty.fmu --force-file force.csv", 2, &["empty.fmu", "no modelDescription.xml"]);
    bench.done("export model.json -o panel.fmu");
    refused(&bench, "modes panel.fmu", 2, &["panel.fmu: an FMU", "model file"]);
    refused(&bench, "simulate panel.fmu --force-file force.csv --modes 3", 2, &["panel.fmu", "orthopanel export"]);
}

#[test]
fn effects_of_a_model() {
    let bench = Bench::new();
    for (effect, code, said) in [
        (r#"{"id": "flux", "owner": "panel"}"#, 2, &["\"flux\"", "catalogue", "local-mass"][..]),
        (r#"{"id": "sensor-mass", "owner": "rig", "mass": 0.005}"#, 2, &["sensor-mass", "rig", "not to the panel"]),
        // Not bad input: this version cannot solve it.
        (
            r#"{"id": "width-coupling", "owner": "panel", "e_y_ratio": 0.9, "nu_xy": 0.3, "g_xy_ratio": 0.3, "g_yz_ratio": 0.6}"#,
            1,
            &["width-coupling", "mindlin-plate", "not supported"],
        ),
    ] {
        let with = changed(MODEL, "\"structure\"", &format!("\"effects\": [{effect}], \"structure\""));
        std::fs::write(bench.path("model.json"), with).expect("a file is written");
        refused(&bench, "modes model.json", code, &[&["model.json"], said].concat());
    }
}

#[test]
fn a_plate_that_cannot_be() {
    let bench = Bench::new();
    for (from, to, said) in [
        ("\"e_y\": 1.07e10, ", "", &["constants.e_y is missing"][..]),
        ("1.07e10, \"nu_xy\": 0.3", "1.07e12, \"nu_xy\": 0.3", &["nu_xy", "e_y"]),
        ("[[-0.3, -0.05]]", "[[-0.3, -0.11]]", &["-0.11", "off the piece", "0.1"]),
    ] {
        std::fs::write(bench.path("plate.json"), changed(PLATE, from, to)).expect("a file is written");
        refused(&bench, "modes plate.json", 2, &[&["plate.json"], said].concat());
        refused(&bench, "export plate.json -o out.fmu", 2, &[&["plate.json"], said].concat());
    }
    std::fs::write(bench.path("plate.json"), PLATE).expect("a file is written");
    refused(&bench, "modes plate.json --count 900", 2, &["900 modes asked", "resolves"]);
    let grid = "accelerance plate.json --force 0,0.05 --response 0,0.05 --from 1 --lines 3";
    refused(&bench, &format!("{grid} --to 1e6"), 2, &["1000000 Hz", "resolves"]);
}

#[test]
fn a_number_below_zero_is_told_what_is_allowed() {
    let bench = Bench::new();
    let grid = "accelerance model.json --force 0 --response 0 --from 1 --to 2";
    for (line, said) in [
        ("modes model.json --count -1", "whole number, not below zero"),
        ("modes model.json --count 2.5", "whole number, not below zero"),
        ("export model.json -o x.fmu --modes -3", "whole number, not below zero"),
        ("export model.json -o x.fmu --up-to -3", "finite number, not below zero"),
        (&format!("{grid} --lines 3 --modes -3"), "whole number, not below zero"),
        (&format!("{grid} --lines -3"), "not in 1..=10000000"),
        ("identify test.toml --window force-exponential --tau -1", "finite number above zero"),
        ("identify test.toml --search simplex --frequency-weight -1", "finite number, zero or above"),
        ("identify test.toml --search simplex --magnitude-weight nan", "finite number, zero or above"),
    ] {
        let output = bench.run(line);
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{line}");
        assert!(message.contains(said) && !message.contains("use '--"), "{line}: {message}");
    }
}

#[test]
fn an_option_that_would_be_ignored_is_refused() {
    let bench = Bench::new();
    refused(&bench, "identify test.toml --tau 0.1", 2, &["--tau 0.1", "no effect", "--window force-exponential"]);
    refused(&bench, "identify test.toml --magnitude-weight 1", 2, &["--magnitude-weight 1", "--search simplex"]);
    let nothing = "identify test.toml --search simplex --frequency-weight 0 --magnitude-weight 0";
    refused(&bench, nothing, 2, &["W_f = 0, W_G = 0", "one above zero"]);
    refused(&bench, "run test.toml --window hann --force-half-width 0.1 -o out", 2, &["--force-half-width", "both"]);
    let grid = "accelerance model.json --force 0 --response 0 --from 1 --to 2 --lines 3";
    refused(&bench, &format!("{grid} --window hann"), 2, &["--window", "hammer records", "a test file"]);
    refused(&bench, &format!("{grid} --estimator h2"), 2, &["--estimator", "hammer records"]);
    // Here it would be right in another test, so it is said and no more.
    let output = bench.run("identify test.toml --window hann");
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && message.contains("--window has no effect"), "{message}");
    let output = bench.run("identify test.toml --damping hysteretic");
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && message.contains("--damping hysteretic has no effect"), "{message}");
}

#[test]
fn modes_up_to_a_frequency_that_none_reach_are_refused() {
    let bench = Bench::new();
    let mass = r#""effects": [{"id": "edge-mass", "owner": "panel", "mass": 0.05}], "damping""#;
    bench.write("modified.json", &changed(PLATE, r#""damping""#, mass));
    for model in ["model.json", "plate.json", "modified.json"] {
        let said = [model, "100000000 Hz", "modes at most, up to", "ask for that frequency or less"];
        refused(&bench, &format!("export {model} -o x.fmu --up-to 1e8"), 2, &said);
    }
    assert!(!bench.path("x.fmu").exists());
    // The lines of a beam's accelerance reach as far as its modes do.
    let grid = "accelerance model.json --force 0 --response 0.1 --from 1 --lines 3";
    refused(&bench, &format!("{grid} --to 1e8"), 2, &["100000000 Hz", "1000 modes at most"]);
    bench.done(&format!("{grid} --to 3e5 -o h.csv"));
    assert_eq!(bench.rows("h.csv").len(), 3);
}

#[test]
fn regress_an_fmu_is_named_as_importers_ask() {
    let bench = Bench::new();
    for name in ["notfmu.txt", "panel", "panel.fmu.zip"] {
        let line = format!("export model.json -o {name} --modes 2");
        refused(&bench, &line, 2, &[name, "does not end in .fmu", "upper or lower case"]);
        assert!(!bench.path(name).exists());
    }
    for name in ["panel.fmu", "panel.FMU"] {
        bench.done(&format!("export model.json -o {name} --modes 2"));
        assert!(bench.path(name).exists());
    }
}

#[test]
fn a_band_limited_force_wants_even_times() {
    let bench = Bench::new();
    let line = "simulate model.json --force-file force.csv --hold band-limited";
    refused(&bench, line, 2, &["force.csv", "sample 2", "even"]);
}

#[test]
fn bad_usage_leaves_with_two() {
    let bench = Bench::new();
    for line in [
        "",
        "modes",
        "modes model.json --count -1",
        "export model.json",
        "export model.json -o x.fmu --fmi 1",
        "export model.json -o x.fmu --modes 3 --up-to 100",
        "export model.json -o x.fmu --force a",
        "accelerance model.json --force 0 --response 0 --from 5 --to 2 --lines 3",
        "accelerance model.json --force 0 --response 0 --from nan --to 2 --lines 3",
        "accelerance model.json --force 0 --response 0 --from 1 --to 2 --lines 0",
    ] {
        let output = bench.run(line);
        assert_eq!(output.status.code(), Some(2), "{line}");
        assert!(output.stdout.is_empty() && !output.stderr.is_empty(), "{line}");
    }
    assert!(!bench.path("x.fmu").exists());
}

#[test]
fn a_file_of_another_kind_is_called_by_its_name() {
    let bench = Bench::new();
    bench.done("run test.toml -o out");
    bench.write("test.json", crate::support::TEST);
    let records = "examples/made-hits/point-0.uff";
    let model = &["a model file, where a test file (TOML) is wanted", "`orthopanel modes`"][..];
    for line in ["identify model.json", "trace model.json", "report model.json -o x.html", "run model.json -o x"] {
        refused(&bench, line, 2, model);
    }
    bench.write("model.toml", crate::support::MODEL);
    refused(&bench, "accelerance model.toml", 2, model);
    refused(&bench, "simulate model.json --force-file model.toml", 2, model);
    for (line, said) in [
        (
            "modes out/identified.json",
            &["`orthopanel identify --json` answers", "a model file (JSON)", "-o model.json"][..],
        ),
        (
            "export out/trace.json -o x.fmu",
            &["`orthopanel trace --json` answers", "a model file (JSON)", "-o model.json"],
        ),
        ("modes out/manifest.json", &["the list of a run's results, where a model file (JSON) is wanted"]),
        (
            "simulate model.json --force-file model.json",
            &["a model file, where a force file (CSV)", "`orthopanel modes`"],
        ),
        ("simulate out/panel.fmu --force-file plate.json", &["a model file, where a force file (CSV)"]),
        ("simulate model.json --force-file out/panel.fmu", &["an FMU, where a force file (CSV)", "simulate X.fmu"]),
        ("simulate model.json --force-file test.json", &["a test file, where a force file", "`orthopanel identify`"]),
        ("simulate force.csv --force-file force.csv", &["a force file, where a model file", "--force-file"]),
        ("modes test.json", &["a test file, where a model file", "`orthopanel identify`"]),
        ("modes test.toml", &["a test file, where a model file", "`orthopanel identify test.toml -o model.json`"]),
        ("modes out/panel.fmu", &["an FMU, where a model file", "that the FMU was made from"]),
        (&format!("identify {records}"), &["a file of records, where a test file", "[[measurement]]"]),
        (&format!("modes {records}"), &["a file of records, where a model file", "[[measurement]]"]),
        ("identify out/panel.fmu", &["an FMU, where a test file", "`orthopanel simulate X.fmu"]),
        ("identify out/response.csv", &["a file of records, where a test file"]),
    ] {
        refused(&bench, line, 2, said);
    }
}

#[test]
fn regress_a_name_that_ends_as_a_folder_is_no_file() {
    let bench = Bench::new();
    for line in [
        "report test.toml",
        "identify test.toml",
        "trace test.toml",
        "identify examples/pieces-3-4",
        "trace examples/pieces-3-4",
        "accelerance model.json --force 0 --response 0.1 --from 1 --to 9 --lines 3",
        "simulate model.json --force-file force.csv",
    ] {
        for output in ["new/", "new//", "new/.", "examples/new/"] {
            refused(&bench, &format!("{line} -o {output}"), 2, &["cannot be written", "folder", "name a file in it"]);
        }
    }
    // Here a folder is as good as a file, whether the test has one pair of places or several.
    for (test, output) in [("examples/one", "one/"), ("examples/made-hits", "several/")] {
        std::fs::create_dir_all(bench.path("examples/one")).expect("a folder is made");
        bench.write("examples/one/a.csv", "frequency_hz,real,imag\n1,2,3\n2,3,4\n3,4,5\n");
        let measured = "kind = \"accelerance\"\nfile = \"a.csv\"\nforce_at = [0.1, 0]\nresponse_at = [0.3, 0]\n";
        let pieces = TEST.split("[[measurement]]").next().unwrap_or_default();
        bench.write("examples/one/test.toml", &format!("{pieces}[[measurement]]\n{measured}"));
        bench.done(&format!("accelerance {test}/test.toml -o {output}"));
        assert!(bench.path(&format!("{output}accelerance-1.csv")).is_file(), "{output}");
    }
}

#[test]
fn regress_a_force_beyond_all_numbers_is_blamed_on_its_file() {
    let bench = Bench::new();
    bench.done("export model.json -o panel.fmu");
    for force in ["1e308", "-1e308", "1e200", "1e30"] {
        bench.write("force.csv", &changed(FORCE, "58.8", force));
        for model in ["model.json", "panel.fmu"] {
            for hold in ["", " --hold held"] {
                let line = format!("simulate {model} --force-file force.csv{hold} -o out.csv");
                refused(&bench, &line, 2, &["force.csv:3: force_n = ", "must be less than", " N"]);
            }
        }
    }
}

#[test]
fn regress_records_with_a_byte_order_mark_are_records() {
    let bench = Bench::new();
    let plain = bench.done("accelerance examples/made-hits/test.toml --json");
    for entry in std::fs::read_dir(bench.path("examples/made-hits")).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|extension| extension == "uff") {
            let content = std::fs::read(&path).expect("a record");
            std::fs::write(&path, [b"\xef\xbb\xbf", &content[..]].concat()).expect("written");
        }
    }
    assert_eq!(bench.done("accelerance examples/made-hits/test.toml --json"), plain);
    refused(&bench, "modes examples/made-hits/point-0.uff", 2, &["a file of records, where a model file"]);
}

#[test]
fn regress_a_standard_deviation_below_zero_is_none() {
    for (std, said) in
        [("-1e7", "constants.e_x.std = -"), ("-1e-9", "constants.e_x.std = -"), ("1e999", "out of range")]
    {
        model_refused("1.07e10", &format!("{{\"value\": 1.07e10, \"std\": {std}}}"), &[said]);
    }
    let effects = "\"effects\": [{\"id\": \"point-mass\", \"owner\": \"rig\", \"m\": {\"value\": 0.01, \"std\": -1}}]";
    model_refused("\"ports\"", &format!("{effects}, \"ports\""), &["effects[0].m.std = -1", "zero or more"]);
}
