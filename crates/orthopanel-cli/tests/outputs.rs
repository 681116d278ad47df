//! No input and no earlier result is lost: outputs that are inputs, results that cannot be replaced, the manifest.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

use crate::support::{Bench, MODEL, changed, refused};

const PIECE: &str = "[piece]\nlength = 0.8\nwidth = 0.1\nthickness = 0.03\nmass_per_area = 6.88\n";

/// An accelerance of `lines` lines from each of the files.
fn accelerances(bench: &Bench, folder: &str, names: &[&str], lines: usize) {
    std::fs::create_dir_all(bench.path(folder)).expect("a folder is made");
    let mut test = PIECE.to_owned();
    for (place, name) in names.iter().enumerate() {
        let x = -0.3 + 0.05 * place as f64;
        test += &format!(
            "[[measurement]]\nkind = \"accelerance\"\nfile = \"{name}\"\nforce_at = [{x:.2}, 0.0]\nresponse_at = [0.3, 0.0]\n"
        );
        let line = |line: usize| format!("{line},{},{}\n", x * line as f64, folder.len() + line);
        let text: String = (1..=lines).map(line).collect();
        bench.write(&format!("{folder}/{name}"), &format!("frequency_hz,real,imag\n{text}"));
    }
    bench.write(&format!("{folder}/test.toml"), &test);
}

/// Every file below `folder` and what is in it.
fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut contents = BTreeMap::new();
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            contents.extend(self::contents(&path));
        } else {
            contents.insert(path.display().to_string(), std::fs::read(&path).expect("a file"));
        }
    }
    contents
}

/// `line` names an input as its output: refused in one sentence, and every file as it was.
fn input_refused(bench: &Bench, line: &str) {
    let before = contents(bench.folder.path());
    refused(bench, line, 2, &["not written", "this command", "name another place"]);
    assert!(contents(bench.folder.path()) == before, "{line} changed a file");
}

const GRID: &str = "accelerance model.json --force 0 --response 0.1 --from 1 --to 9 --lines 3";
const HITS: &str = "examples/made-hits/test.toml";
const RECORD: &str = "examples/made-hits/point-0.uff";

#[test]
fn regress_an_output_that_is_an_input_is_refused() {
    let bench = Bench::new();
    for line in [
        "identify test.toml -o test.toml",
        "identify . -o test.toml",
        "trace test.toml -o test.toml",
        "report test.toml -o test.toml",
        &format!("identify {HITS} -o {RECORD}"),
        &format!("trace {HITS} -o {RECORD}"),
        &format!("report {HITS} -o {RECORD}"),
        &format!("accelerance {HITS} -o {RECORD}"),
        &format!("accelerance {HITS} -o {HITS}"),
        "modes model.json --picture model.json",
        &format!("{GRID} -o model.json"),
        "simulate model.json --force-file force.csv -o force.csv",
        "simulate model.json --force-file force.csv -o model.json",
        &format!("simulate model.json --force-file {HITS} -o {RECORD}"),
        &format!("simulate model.json --force-file {RECORD} -o {RECORD}"),
        // Other spellings of the path.
        "identify test.toml -o ./examples/../test.toml",
        &format!("accelerance {HITS} -o examples/../{RECORD}"),
    ] {
        input_refused(&bench, line);
    }
    let whole = bench.path("test.toml").display().to_string();
    input_refused(&bench, &format!("identify test.toml -o {whole}"));
    bench.write("model.fmu", MODEL);
    bench.write("library.fmu", "no library, which is seen later");
    input_refused(&bench, "export model.fmu -o model.fmu");
    input_refused(&bench, "export model.json --library x86_64-windows=library.fmu -o library.fmu");
}

#[test]
fn regress_results_of_several_files_are_none_of_the_inputs() {
    let bench = Bench::new();
    // `run` into the folder of a record that is called as one of its results.
    accelerances(&bench, "named", &["response.csv"], 3);
    input_refused(&bench, "run named/test.toml -o named");
    input_refused(&bench, "run named -o named/../named");
    // One file a pair of places.
    accelerances(&bench, "pairs", &["h-1.csv", "h-2.csv"], 3);
    input_refused(&bench, "accelerance pairs/test.toml -o pairs/h.csv");
    accelerances(&bench, "folder", &["accelerance-1.csv", "b.csv"], 3);
    input_refused(&bench, "accelerance folder/test.toml -o folder");
    // One model a piece.
    let text = std::fs::read_to_string(bench.path("examples/pieces-3-4/test.toml")).expect("a test");
    bench.write("panel-4.toml", &text);
    input_refused(&bench, "identify panel-4.toml -o panel.toml");
    input_refused(&bench, "trace panel-4.toml -o panel.toml");
}

#[test]
fn regress_an_input_is_known_by_its_other_names() {
    let bench = Bench::new();
    std::fs::hard_link(bench.path("test.toml"), bench.path("hard.json")).expect("linked");
    std::fs::hard_link(bench.path(RECORD), bench.path("hard.csv")).expect("linked");
    input_refused(&bench, "identify test.toml -o hard.json");
    input_refused(&bench, &format!("accelerance {HITS} -o hard.csv"));
    #[cfg(unix)]
    {
        use std::os::unix::fs::symlink;
        symlink("test.toml", bench.path("soft.json")).expect("linked");
        symlink(RECORD, bench.path("soft.csv")).expect("linked");
        symlink("examples/made-hits", bench.path("elsewhere")).expect("linked");
        input_refused(&bench, "identify test.toml -o soft.json");
        input_refused(&bench, "identify soft.json -o test.toml");
        input_refused(&bench, &format!("accelerance {HITS} -o soft.csv"));
        input_refused(&bench, &format!("accelerance {HITS} -o elsewhere/point-0.uff"));
        std::fs::create_dir(bench.path("out")).expect("a folder is made");
        symlink(bench.path(RECORD), bench.path("out/response.csv")).expect("linked");
        input_refused(&bench, &format!("run {HITS} -o out"));
    }
}

#[test]
fn an_output_beside_the_inputs_is_written() {
    let bench = Bench::new();
    let before = contents(bench.folder.path());
    bench.done("identify test.toml -o model-of-test.json");
    // The second time over the first, which is no input.
    bench.done("identify test.toml -o model-of-test.json");
    let mut after = contents(bench.folder.path());
    assert!(after.remove(&bench.path("model-of-test.json").display().to_string()).is_some());
    assert!(after == before);
}

#[test]
fn regress_an_output_that_cannot_be_is_refused_before_anything_is_computed() {
    let bench = Bench::new();
    let begun = std::time::Instant::now();
    // Reading and tracing these would take seconds, and say things.
    for target in ["new/..", "new/../out", "new/deep/../..", "model.json/out", "model.json/.."] {
        refused(&bench, &format!("run {HITS} -o {target}"), 2, &["cannot be written", "name a"]);
    }
    for line in ["identify", "trace", "accelerance", "report"].map(|command| format!("{command} {HITS}")) {
        for target in ["new/../out.csv", "new/..", "model.json/out.csv"] {
            refused(&bench, &format!("{line} -o {target}"), 2, &["cannot be written", "name a"]);
        }
    }
    assert!(begun.elapsed().as_secs() < 20, "{:?}", begun.elapsed());
}

#[cfg(unix)]
#[test]
fn a_link_to_a_file_that_is_not_there_is_written_through() {
    use std::os::unix::fs::symlink;

    let bench = Bench::new();
    std::fs::create_dir(bench.path("elsewhere")).expect("a folder is made");
    std::fs::create_dir(bench.path("links")).expect("a folder is made");
    symlink("../elsewhere/file", bench.path("links/near")).expect("linked");
    symlink("links/near", bench.path("far")).expect("linked");
    for line in [
        "identify test.toml -o far",
        "trace test.toml -o far",
        "report test.toml -o far",
        "modes model.json --picture far",
        &format!("{GRID} -o far"),
        &format!("accelerance {HITS} -o far"),
        "simulate model.json --force-file force.csv -o far",
    ] {
        bench.done(line);
        assert!(bench.path("far").is_symlink() && bench.path("links/near").is_symlink(), "{line}");
        std::fs::remove_file(bench.path("elsewhere/file")).expect(line);
    }
    std::fs::create_dir(bench.path("out")).expect("a folder is made");
    symlink("../elsewhere/model", bench.path("out/model.json")).expect("linked");
    bench.done("run test.toml -o out");
    assert!(bench.path("out/model.json").is_symlink() && bench.path("elsewhere/model").exists());
    // Into a folder that is not there, and round in a circle.
    symlink("nowhere/file", bench.path("broken.fmu")).expect("linked");
    symlink("circle.fmu", bench.path("circle.fmu")).expect("linked");
    symlink("nowhere", bench.path("folder")).expect("linked");
    refused(
        &bench,
        "export model.json -o broken.fmu",
        2,
        &["broken.fmu: cannot be written", "in a folder that exists"],
    );
    refused(&bench, "export model.json -o circle.fmu", 2, &["circle.fmu: cannot be written"]);
    refused(&bench, "run test.toml -o folder", 2, &["folder: cannot be written", "leads nowhere"]);
}

/// Names in `folder`, hidden ones too.
fn names(bench: &Bench, folder: &str) -> Vec<String> {
    let entries = std::fs::read_dir(bench.path(folder)).expect("a folder");
    let mut names: Vec<_> =
        entries.map(|entry| entry.expect("an entry").file_name().into_string().expect("UTF-8")).collect();
    names.sort();
    names
}

/// SHA-256 of the first file that [`accelerances`] writes into a folder called `out`.
const MINE_SHA256: &str = "d0a308de98c57b59e12e9565602b1459979461a88ed1cf72bcab01a9dfb7c06e";
const MANIFEST: &str = "out/accelerance-manifest.json";

#[test]
fn a_manifest_tells_what_the_results_were_made_from() {
    let bench = Bench::new();
    bench.done("run test.toml -o out");
    let first = contents(&bench.path("out"));
    let manifest = bench.read_json("out/manifest.json");
    assert_eq!(manifest["schema"], "orthopanel.manifest/1");
    assert_eq!(manifest["command"], serde_json::json!(["run", "test.toml", "-o", "out"]));
    assert_eq!(manifest["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(manifest["inputs"][0]["file"], "test.toml");
    // By sha256sum, of `TEST`.
    assert_eq!(manifest["inputs"][0]["sha256"], "70b637e122f81df655e3e05c0b7477a41c8213f40d86fda4097616379199ab90");
    let listed = manifest["files"].as_array().expect("a list");
    let mut files: Vec<_> = listed.iter().map(|listed| listed["file"].as_str().expect("a name").to_owned()).collect();
    assert!(listed.iter().all(|listed| listed["sha256"].as_str().is_some_and(|sha256| sha256.len() == 64)));
    files.push("manifest.json".into());
    files.sort();
    assert_eq!(files, names(&bench, "out"));
    bench.done("run test.toml -o out");
    assert!(contents(&bench.path("out")) == first, "a second run differs from the first");
}

#[test]
fn results_of_another_run_do_not_stay() {
    let bench = Bench::new();
    bench.done("run examples/pieces-3-4/test.toml -o out");
    bench.write("out/notes.txt", "my own");
    bench.write("out/response-3.csv", "changed by hand");
    let said = bench.run("run test.toml -o out");
    let message = String::from_utf8_lossy(&said.stderr);
    assert_eq!(said.status.code(), Some(0), "{message}");
    assert!(message.contains("response-3.csv: left by an earlier run, and kept: it was changed since"), "{message}");
    assert!(message.contains("removed ") && message.contains("response-4.csv, left by an earlier run"), "{message}");
    bench.done("run test.toml -o alone");
    let mut expected = names(&bench, "alone");
    expected.extend(["notes.txt", "response-3.csv"].map(String::from));
    expected.sort();
    assert_eq!(names(&bench, "out"), expected);
}

#[test]
fn each_command_removes_its_own_results_alone() {
    let bench = Bench::new();
    accelerances(&bench, "three", &["a.csv", "b.csv", "c.csv"], 3);
    accelerances(&bench, "two", &["a.csv", "b.csv"], 3);
    bench.done("run test.toml -o out");
    let of_run = names(&bench, "out");
    bench.done("accelerance three/test.toml -o out");
    bench.done("accelerance two/test.toml -o out");
    let own = ["accelerance-1.csv", "accelerance-2.csv", "accelerance-manifest.json"].map(String::from);
    let mut expected: Vec<String> = of_run.into_iter().chain(own).collect();
    expected.sort();
    assert_eq!(names(&bench, "out"), expected);
}

/// Results that share a stem, those of one command in `csv`, those of another in `json`.
#[test]
fn results_beside_each_other_have_a_manifest() {
    let bench = Bench::new();
    accelerances(&bench, "three", &["a.csv", "b.csv", "c.csv"], 3);
    accelerances(&bench, "two", &["a.csv", "b.csv"], 3);
    accelerances(&bench, "one", &["a.csv"], 3);
    std::fs::create_dir(bench.path("out")).expect("a folder is made");
    bench.write("out/h-4.csv", "of somebody else");
    let mut expected = vec!["h-4.csv"];
    let mut done = |line: &str, gone: &[&'static str], come: &[&'static str]| {
        bench.done(line);
        expected.retain(|name| !gone.contains(name));
        expected.extend(come);
        expected.sort_unstable();
        assert_eq!(names(&bench, "out"), expected, "{line}");
    };
    let three = ["h-1.csv", "h-2.csv", "h-3.csv"];
    done("accelerance three/test.toml -o out/h.csv", &[], &[&three[..], &["h-manifest.json"]].concat());
    let manifest = bench.read_json("out/h-manifest.json");
    assert_eq!(manifest["schema"], "orthopanel.manifest/1");
    assert_eq!(manifest["command"][0], "accelerance");
    assert_eq!(manifest["inputs"].as_array().expect("a list").len(), 4);
    assert_eq!(manifest["inputs"][1]["sha256"].as_str().map(str::len), Some(64));
    assert_eq!(manifest["files"][2]["file"], "h-3.csv");
    let (pieces, models) = ("examples/pieces-3-4/test.toml", ["h-3.json", "h-4.json"]);
    done(&format!("identify {pieces} -o out/h.json"), &[], &models);
    done("accelerance two/test.toml -o out/h.csv", &["h-3.csv"], &[]);
    // A single result takes the place of several.
    done("accelerance one/test.toml -o out/h.csv", &["h-1.csv", "h-2.csv"], &["h.csv"]);
    done(&format!("trace {pieces} -o out/h.json"), &[], &[]);
    done("identify test.toml -o out/h.json", &models, &["h.json"]);
    // Where none was ever several, there is nothing to list.
    done("identify test.toml -o out/single.json", &[], &["single.json"]);
    bench.write("out/x-manifest.json", "{\"name\": \"of another program\"}");
    done("identify test.toml -o out/x.json", &[], &["x-manifest.json", "x.json"]);
    // The manifest is an output like others.
    bench.write("pairs-manifest.json", "");
    std::fs::rename(bench.path("two/a.csv"), bench.path("two/h-manifest.json")).expect("renamed");
    let test = std::fs::read_to_string(bench.path("two/test.toml")).expect("a test");
    bench.write("two/test.toml", &changed(&test, "\"a.csv\"", "\"h-manifest.json\""));
    input_refused(&bench, "accelerance two/test.toml -o two/h.csv");
}

#[test]
fn a_result_that_was_edited_is_kept_beside_the_new_one() {
    let bench = Bench::new();
    bench.write("mine.toml", &changed(crate::support::TEST, "837.5", "837.6"));
    std::fs::create_dir(bench.path("out")).expect("a folder is made");
    bench.write("out/report.html", "my own");
    let said = |line: &str| {
        let output = bench.run(line);
        assert_eq!(output.status.code(), Some(0), "{line}: {output:?}");
        String::from_utf8(output.stderr).expect("UTF-8").lines().filter(|line| line.contains("kept")).count()
    };
    let read = |name: &str| std::fs::read_to_string(bench.path(name)).expect("a file");
    assert_eq!(said("run test.toml -o out"), 1);
    assert_eq!(read("out/report.html.edited"), "my own");
    let model = read("out/model.json");
    for (count, edited) in [("", "edited"), ("-2", "edited again")] {
        bench.write("out/model.json", edited);
        assert_eq!(said("run test.toml -o out"), 1);
        assert_eq!(read(&format!("out/model.json.edited{count}")), edited);
        assert_eq!(read("out/model.json"), model);
    }
    // What nobody changed is replaced without a word.
    let before = names(&bench, "out");
    assert_eq!(said("run mine.toml -o out"), 0);
    assert_eq!(names(&bench, "out"), before);
    assert_ne!(read("out/model.json"), model);
    // Of results beside each other too.
    let pieces = "examples/pieces-3-4/test.toml";
    bench.done(&format!("identify {pieces} -o m.json"));
    bench.write("m-4.json", "edited");
    assert_eq!(said(&format!("identify {pieces} -o m.json")), 1);
    assert_eq!(read("m-4.json.edited"), "edited");
}

#[test]
fn a_manifest_removes_nothing_outside_its_folder_and_no_input() {
    let bench = Bench::new();
    accelerances(&bench, "three", &["a.csv", "b.csv", "c.csv"], 3);
    accelerances(&bench, "out", &["mine.csv", "other.csv"], 3);
    bench.done("accelerance three/test.toml -o out");
    std::fs::create_dir(bench.path("out/deep")).expect("a folder is made");
    bench.write("out/deep/file", "kept");
    bench.write("outside", "kept");
    let manifest = std::fs::read_to_string(bench.path(MANIFEST)).expect("a manifest");
    // SHA-256 of "kept".
    let sha256 = "79f076abdd19a752db7267bfff2f9022161d120dea919fdaca2ffdfc24ca8c96";
    let mine = bench.path("out/mine.csv");
    let whole = bench.path("outside").display().to_string();
    let listed: String = ["../outside", &whole, "deep/file", "deep", ".", "..", "", "mine.csv"]
        .map(|file| {
            format!(
                "{{\"file\": {file:?}, \"sha256\": \"{}\"}},",
                if file == "mine.csv" { MINE_SHA256 } else { sha256 }
            )
        })
        .concat();
    bench.write(MANIFEST, &changed(&manifest, "\"files\": [", &format!("\"files\": [{listed}")));
    let before = std::fs::read(&mine).expect("a record");
    bench.done("accelerance out/test.toml -o out");
    assert_eq!(std::fs::read(&mine).expect("a record"), before);
    for kept in ["outside", "out/deep/file"] {
        assert_eq!(std::fs::read_to_string(bench.path(kept)).expect("a file"), "kept");
    }
    let expected = ["accelerance-1.csv", "accelerance-2.csv", "accelerance-manifest.json", "deep"];
    assert_eq!(names(&bench, "out"), [&expected[..], &["mine.csv", "other.csv", "test.toml"]].concat());
}

#[test]
fn a_broken_manifest_is_said_and_kept() {
    let bench = Bench::new();
    accelerances(&bench, "two", &["a.csv", "b.csv"], 3);
    for (count, broken) in ["{\"files\": 3}", "", "{\"name\": \"of another program\"}"].into_iter().enumerate() {
        std::fs::create_dir_all(bench.path("out")).expect("a folder is made");
        bench.write(MANIFEST, broken);
        let output = bench.run("accelerance two/test.toml -o out");
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{message}");
        assert!(message.contains("accelerance-manifest.json: no manifest of orthopanel"), "{message}");
        assert_eq!(bench.read_json(MANIFEST)["schema"], "orthopanel.manifest/1");
        let kept = format!("out/accelerance-manifest-{}.json", count + 1);
        assert_eq!(std::fs::read_to_string(bench.path(&kept)).expect("a file"), broken);
    }
}

/// A file that cannot be replaced, as root or another: where the file system knows immutable files and this process may make
/// them.
#[test]
fn regress_one_result_that_cannot_be_replaced_leaves_all_as_they_were() {
    let bench = Bench::new();
    accelerances(&bench, "before", &["a.csv", "b.csv", "c.csv"], 3);
    accelerances(&bench, "then", &["a.csv", "b.csv", "c.csv"], 3);
    bench.done("accelerance before/test.toml -o out");
    let earlier = contents(&bench.path("out"));
    let immutable = |flag: &str| {
        let file = bench.path("out/accelerance-2.csv");
        Command::new("chattr").arg(flag).arg(file).output().is_ok_and(|output| output.status.success())
    };
    if !immutable("+i") {
        println!("skipped: no file can be made immutable here");
        return;
    }
    let output = bench.run("accelerance then/test.toml -o out");
    assert!(immutable("-i"));
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains("accelerance-2.csv: cannot be written"), "{message}");
    assert!(contents(&bench.path("out")) == earlier);
    bench.done("accelerance then/test.toml -o out");
    assert!(contents(&bench.path("out")) != earlier);
}

/// SIGKILL at moments spread over a whole command; `outputs::tests` kills where files are replaced.
#[cfg(unix)]
#[test]
fn a_command_killed_at_any_moment_leaves_every_result_whole() {
    use std::time::Instant;

    const RUNS: u32 = 50;
    // In memory where there is such a folder: what a kill leaves there is the same, and flushing takes no time.
    let folder = tempfile::tempdir_in("/dev/shm").or_else(|_| tempfile::tempdir()).expect("a temporary folder");
    let bench = Bench { folder };
    accelerances(&bench, "one", &["a.csv", "b.csv", "c.csv", "d.csv"], 50);
    accelerances(&bench, "other", &["a.csv", "b.csv", "c.csv"], 50);
    let lines = ["accelerance one/test.toml -o out", "accelerance other/test.toml -o out"];
    let whole = lines.map(|line| {
        bench.done(line);
        contents(&bench.path("out"))
    });
    let begun = Instant::now();
    bench.done(lines[0]);
    let longest = begun.elapsed();
    let manifest = bench.path(MANIFEST);
    for run in 0..RUNS {
        let mut process = bench.command(lines[usize::from(run % 2 == 0)]).spawn().expect("the program starts");
        std::thread::sleep(longest * (run * 17 % RUNS) / RUNS);
        process.kill().expect("killed, or ended before");
        process.wait().expect("ended");
        for (path, content) in contents(&bench.path("out")) {
            let is_result = Path::new(&path) != manifest && !path.contains("/.orthopanel-");
            let is_whole = !is_result || whole.iter().any(|whole| whole.get(&path) == Some(&content));
            assert!(is_whole, "run {run}: {path} is not whole");
        }
        assert_eq!(bench.read_json(MANIFEST)["schema"], "orthopanel.manifest/1");
        for number in 1..=3 {
            assert!(bench.path(&format!("out/accelerance-{number}.csv")).exists(), "run {run} lost file {number}");
        }
    }
    // Nothing is left behind of those that were killed.
    for (line, whole) in lines.iter().zip(&whole) {
        bench.done(line);
        assert!(contents(&bench.path("out")) == *whole);
    }
}

#[test]
fn regress_a_run_without_a_model_leaves_the_results_of_an_earlier_one() {
    let bench = Bench::new();
    bench.done(&format!("run {HITS} -o out"));
    let earlier = contents(&bench.path("out"));
    let test = std::fs::read_to_string(bench.path(HITS)).expect("a test");
    let length = test.lines().find(|line| line.starts_with("length = ")).expect("a length");
    bench.write(HITS, &changed(&test, length, "length = 1.4"));
    let output = bench.run(&format!("run {HITS} -o out"));
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert_eq!(message.matches("note: out: the results in it are of an earlier run").count(), 1, "{message}");
    assert!(!message.contains("wrote ") && !message.contains("removed "), "{message}");
    assert!(contents(&bench.path("out")) == earlier);
    // Where there are none, what the trace found is written.
    let output = bench.run(&format!("run {HITS} -o new"));
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(!message.contains("earlier run"), "{message}");
    assert_eq!(names(&bench, "new"), ["manifest.json", "report.html", "trace.json"]);
}

/// An input that grows all the while: what the results are of is what the manifest lists, or there are none.
#[test]
fn regress_an_input_that_changes_while_it_is_read_is_no_input() {
    use std::io::Write as _;

    let bench = Bench::new();
    accelerances(&bench, "pairs", &["a.csv", "b.csv"], 20_000);
    for (line, input) in [
        (format!("run {HITS} -o out"), HITS),
        ("accelerance pairs/test.toml -o out".into(), "pairs/test.toml"),
        ("accelerance pairs/test.toml -o out".into(), "pairs/b.csv"),
        ("accelerance pairs/test.toml -o h.csv".into(), "pairs/b.csv"),
    ] {
        let before = bench.listing();
        let mut file = std::fs::File::options().append(true).open(bench.path(input)).expect("an input");
        let mut process = bench.command(&line);
        let mut process = process.stderr(std::process::Stdio::piped()).spawn().expect("the program starts");
        while process.try_wait().expect("a process").is_none() {
            file.write_all(b"# one line more\n").expect("written");
            std::thread::sleep(std::time::Duration::from_micros(20));
        }
        let output = process.wait_with_output().expect("ended");
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{line}: {message}");
        let name = input.rsplit('/').next().unwrap_or(input);
        assert!(message.contains(&format!("{name}: changed while it was read: run again")), "{line}: {message}");
        assert_eq!(bench.listing(), before, "{line} wrote something");
    }
}
