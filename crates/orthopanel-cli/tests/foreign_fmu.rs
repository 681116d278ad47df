//! An `.fmu` is a stranger's file: whatever it holds, it is run or refused, within bounds and without running anybody's code unasked.

use std::io::{Cursor, Read as _, Write as _};
use std::process::{Command, Output};

use crate::support::{Bench, changed};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

const DESCRIPTION: &str = "modelDescription.xml";

/// The files of an FMU, in order.
#[derive(Clone)]
struct Files(Vec<(String, Vec<u8>)>);

impl Files {
    /// Of the bench's beam, exported with these options.
    fn exported(bench: &Bench, options: &str) -> Self {
        bench.done(&format!("export model.json -o panel.fmu {options}"));
        let mut archive =
            ZipArchive::new(std::fs::File::open(bench.path("panel.fmu")).expect("an FMU")).expect("an archive");
        let count = archive.len();
        let one = |index| {
            let mut file = archive.by_index(index).expect("an entry");
            let mut content = Vec::new();
            file.read_to_end(&mut content).expect("it unpacks");
            (file.name().expect("a name").into_owned(), content)
        };
        Self((0..count).map(one).collect())
    }

    fn content(&mut self, name: &str) -> &mut Vec<u8> {
        let found = self.0.iter_mut().find(|(own, _)| own == name);
        &mut found.unwrap_or_else(|| panic!("no entry {name}")).1
    }

    fn library(&mut self) -> &mut (String, Vec<u8>) {
        self.0.iter_mut().find(|(name, _)| name.starts_with("binaries/")).expect("a library")
    }

    /// With `from` replaced in the description.
    fn described(&self, from: &str, to: &str) -> Self {
        let mut files = self.clone();
        let content = files.content(DESCRIPTION);
        *content = changed(str::from_utf8(content).expect("UTF-8"), from, to).into_bytes();
        files
    }

    fn with(&self, name: &str, content: &[u8]) -> Self {
        let mut files = self.clone();
        files.0.push((name.into(), content.into()));
        files
    }

    fn packed(&self, method: CompressionMethod) -> Vec<u8> {
        let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
        let options = SimpleFileOptions::default().compression_method(method);
        for (name, content) in &self.0 {
            archive.start_file(name.as_str(), options).expect("an entry");
            archive.write_all(content).expect("it is packed");
        }
        archive.finish().expect("an archive").into_inner()
    }

    fn deflated(&self) -> Vec<u8> {
        self.packed(CompressionMethod::Deflated)
    }
}

/// Simulates an FMU of these bytes, within 1.5 GB where the system can hold a program to that.
fn simulated(bench: &Bench, archive: &[u8], option: &str) -> Output {
    let temporary = bench.path("temporary");
    std::fs::create_dir_all(&temporary).expect("a folder");
    std::fs::write(bench.path("foreign.fmu"), archive).expect("a file is written");
    let program = env!("CARGO_BIN_EXE_orthopanel");
    let mut command = if cfg!(target_os = "linux") {
        let mut shell = Command::new("sh");
        shell.args(["-c", "ulimit -v 1500000 && exec \"$0\" \"$@\"", program]);
        shell
    } else {
        Command::new(program)
    };
    command.args(["simulate", "foreign.fmu", "--force-file", "force.csv"]).args(option.split_whitespace());
    command.current_dir(bench.folder.path()).env("TMPDIR", &temporary);
    let output = command.output().expect("the program starts");
    let left: Vec<_> = std::fs::read_dir(&temporary).expect("a folder").collect();
    assert!(left.is_empty(), "left behind: {left:?}");
    output
}

/// Wants it refused as bad input, in one line that holds all of `said`.
fn refused(bench: &Bench, archive: &[u8], option: &str, said: &[&str]) {
    let output = simulated(bench, archive, option);
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said:?}: {message}");
    assert_eq!(message.lines().count(), 1, "{message}");
    assert!(message.starts_with("orthopanel: foreign.fmu: ") && message.len() < 1500, "{message}");
    for part in said {
        assert!(message.contains(part), "{message:?} does not say {part:?}");
    }
    assert!(output.stdout.is_empty(), "{message}: standard output is not empty");
}

fn moved(bench: &Bench, archive: &[u8], option: &str) -> String {
    let output = simulated(bench, archive, option);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// Sets bytes of the central header of the entry `name`, which begins 46 bytes before the name's last place.
fn patched(mut archive: Vec<u8>, name: &str, offset: usize, bytes: &[u8]) -> Vec<u8> {
    let at = archive.windows(name.len()).rposition(|window| window == name.as_bytes()).expect("a name") - 46 + offset;
    archive[at..at + bytes.len()].copy_from_slice(bytes);
    archive
}

fn replaced(archive: &[u8], from: &str, to: &str) -> Vec<u8> {
    assert_eq!(from.len(), to.len());
    let mut archive = archive.to_vec();
    for at in 0..archive.len() - from.len() {
        if archive[at..].starts_with(from.as_bytes()) {
            archive[at..at + to.len()].copy_from_slice(to.as_bytes());
        }
    }
    archive
}

#[test]
fn the_carried_library_is_run_however_it_is_packed() {
    let bench = Bench::new();
    for options in ["--fmi 2", "--fmi 3", "--fmi 3 --arrays"] {
        let mut files = Files::exported(&bench, options);
        let expected = bench.done("simulate panel.fmu --force-file force.csv");
        files.0.reverse();
        let files = files.with("resources/", b"").with("binaries/more/x.so", b"none").with("extra/x", b"");
        for method in [CompressionMethod::Stored, CompressionMethod::Deflated] {
            assert_eq!(moved(&bench, &files.packed(method), ""), expected);
        }
    }
}

#[test]
fn another_library_wants_trust() {
    let bench = Bench::new();
    for options in ["--fmi 2", "--fmi 3"] {
        let mut files = Files::exported(&bench, options);
        let expected = bench.done("simulate panel.fmu --force-file force.csv");
        let (name, content) = files.library();
        content.push(0);
        let (name, size) = (name.clone(), format!("{} bytes", content.len()));
        refused(&bench, &files.deflated(), "", &[&name, &size, "--trust", "all that you may"]);
        assert_eq!(moved(&bench, &files.deflated(), "--trust"), expected);
    }
    assert!(bench.done("simulate --help").contains("--trust"));
}

#[test]
fn regress_a_library_that_is_cut_short_is_not_loaded() {
    let bench = Bench::new();
    let files = Files::exported(&bench, "");
    for keep in [0, 10, 100, 5000, 200_000] {
        let mut cut = files.clone();
        cut.library().1.truncate(keep);
        refused(&bench, &cut.deflated(), "", &["not the one that this orthopanel carries"]);
        refused(&bench, &cut.deflated(), "--trust", &["cut short or damaged", "binaries/"]);
    }
    let mut text = files.clone();
    text.library().1 = b"#!/bin/sh\nexit 0\n".to_vec();
    refused(&bench, &text.deflated(), "--trust", &["cut short or damaged"]);
    // Whole, and no FMU's.
    text.library().1 = std::fs::read(env!("CARGO_BIN_EXE_orthopanel")).expect("a program");
    refused(&bench, &text.deflated(), "--trust", &["cannot be loaded"]);
}

#[test]
fn regress_a_model_identifier_names_no_file_elsewhere() {
    let bench = Bench::new();
    for (options, kinds) in
        [("--fmi 2", ["CoSimulation", "ModelExchange"]), ("--fmi 3", ["ModelExchange", "CoSimulation"])]
    {
        let files = Files::exported(&bench, options);
        for kind in kinds {
            for name in ["../../../elsewhere", "/elsewhere", "a.b", ""] {
                let description = String::from_utf8(files.clone().content(DESCRIPTION).clone()).expect("UTF-8");
                let start = description.find(&format!("<{kind} ")).expect("the kind");
                let from = "modelIdentifier=\"panel\"";
                let mut files = files.clone();
                let tail = changed(&description[start..], from, &format!("modelIdentifier=\"{name}\""));
                *files.content(DESCRIPTION) = (description[..start].to_owned() + &tail).into_bytes();
                refused(&bench, &files.deflated(), "--trust", &["modelIdentifier", "C identifier", name]);
            }
        }
    }
}

#[test]
fn what_is_not_there_is_named() {
    let bench = Bench::new();
    let files = Files::exported(&bench, "");
    let mut elsewhere = files.clone();
    elsewhere.library().0 = "binaries/another/panel.so".into();
    let said = ["no library for this platform", "binaries/", "only binaries/another/panel.so"];
    refused(&bench, &elsewhere.deflated(), "", &said);
    let without = |start: &str| Files(files.0.iter().filter(|(name, _)| !name.starts_with(start)).cloned().collect());
    refused(&bench, &without("binaries/").deflated(), "", &["no library for this platform", "none for another"]);
    refused(&bench, &without("model").deflated(), "", &["not an FMU", "no modelDescription.xml"]);
    // The library itself refuses, and says why.
    refused(&bench, &without("resources/").deflated(), "", &["refuses to start: ", "resource"]);
    let mut changed = files.clone();
    changed.content("resources/panel.json").push(b' ');
    refused(&bench, &changed.deflated(), "", &["refuses to start: ", "panel.json", "export the FMU again"]);
    let unknown = files.described("valueReference=\"4\"", "valueReference=\"9999\"").deflated();
    let output = simulated(&bench, &unknown, "");
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(1) && message.contains("fails at fmi2GetReal: "), "{message}");
    assert!(message.contains("9999"), "{message}");
    let archive = files.deflated();
    for keep in [4, 100, archive.len() / 2, archive.len() - 1] {
        refused(&bench, &archive[..keep], "", &["zip archive is broken"]);
    }
    let fails = patched(archive, "resources/panel.json", 16, &[1, 2, 3, 4]);
    refused(&bench, &fails, "", &["zip archive is broken", "panel.json", "checksum"]);
}

#[test]
fn a_description_that_cannot_be_run_says_why() {
    let bench = Bench::new();
    let files = Files::exported(&bench, "");
    let described = |from: &str, to: &str| files.described(from, to).deflated();
    refused(&bench, &described("</ModelVariables>", ""), "", &["modelDescription.xml is broken"]);
    refused(&bench, &described("<fmiModelDescription", "<fmiModelDescription <"), "", &["is broken"]);
    refused(&bench, &described("fmiVersion=\"2.0\"", "fmiVersion=\"1.0\""), "", &["fmiVersion is 1.0", "2.0 and 3.0"]);
    refused(&bench, &described("fmiVersion=\"2.0\"", ""), "", &["no element fmiModelDescription with an fmiVersion"]);
    refused(&bench, &described("\"force_linear\"", "\"x\""), "", &["not an FMU that orthopanel wrote", "force_linear"]);
    refused(&bench, &described("\"velocity_1\"", "\"x\""), "", &["not an FMU that orthopanel wrote", "velocity_1"]);
    let mut latin = files.clone();
    latin.content(DESCRIPTION).push(0xe9);
    refused(&bench, &latin.deflated(), "", &["modelDescription.xml is broken", "UTF-8"]);
    let mut marked = files.clone();
    marked.content(DESCRIPTION).splice(0..0, *b"\xef\xbb\xbf");
    moved(&bench, &marked.deflated(), "");
    // Control characters and long texts stay off the terminal.
    let long = format!("fmiVersion=\"\u{9b}2J{}\"", "9".repeat(5000));
    refused(&bench, &described("fmiVersion=\"2.0\"", &long), "", &["\\u{9b}2J99", "..."]);
}

#[test]
fn regress_descriptions_are_bounded() {
    let bench = Bench::new();
    let files = Files::exported(&bench, "");
    let inside = |text: &str| files.described("<ModelVariables>", &format!("{text}<ModelVariables>")).deflated();
    let start = "<fmiModelDescription";
    let bomb = format!("<!DOCTYPE x [<!ENTITY e \"{}\">]>\n{start}", "e".repeat(12_000_000));
    let bombed = files.described(start, &bomb).described("<ModelVariables>", &("&e;".repeat(250) + "<ModelVariables>"));
    refused(&bench, &bombed.deflated(), "", &["document type declaration"]);
    let small = files.described(start, &format!("<!DOCTYPE x [<!ENTITY e \"eeee\">]>\n{start}"));
    refused(&bench, &small.deflated(), "", &["document type declaration"]);
    refused(&bench, &files.described(start, &format!("<!DOCTYPE x>{start}")).deflated(), "", &["document type"]);
    refused(&bench, &inside(&"\n".repeat(65 << 20)), "", &["modelDescription.xml", "67108864 bytes"]);
    refused(&bench, &inside(&format!("<!--{}-->", "x".repeat(2 << 20))), "", &["1048576 bytes"]);
    refused(&bench, &inside(&"<a>".repeat(1_000_000)), "", &["32 levels"]);
    refused(&bench, &inside(&"<a/>".repeat(1_000_001)), "", &["1000000 elements and attributes"]);
    let attributes: String = (0..80_000).map(|n| format!(" a{n}=\"\"")).collect();
    refused(&bench, &inside(&format!("<a{attributes}/>")), "", &["64 attributes"]);
    let variable = |n| format!("<ScalarVariable name=\"v{n}\" valueReference=\"9\"><Real/></ScalarVariable>");
    let variables: String = (0..50_001).map(variable).collect();
    let many = files.described("</ModelVariables>", &(variables + "</ModelVariables>"));
    refused(&bench, &many.deflated(), "", &["50000 variables"]);
}

#[test]
fn regress_dimensions_are_bounded() {
    let bench = Bench::new();
    let files = Files::exported(&bench, "--fmi 3 --arrays --force 0 --force 0.1 --response 0.3 --response 0.1");
    let dimension = "<Dimension start=\"2\"/>";
    let (huge, half) = ("<Dimension start=\"18446744073709551615\"/>", "<Dimension start=\"4294967296\"/>");
    let told = "<Dimension valueReference=\"0\"/>";
    for dimensions in [huge, &huge.repeat(3), &half.repeat(2), &half.repeat(3), told, "<Dimension start=\"100001\"/>"] {
        let said = ["dimensions of ", "100000 numbers"];
        refused(&bench, &files.described(dimension, dimensions).deflated(), "", &said);
    }
    let other = files.described(dimension, "<Dimension start=\"0\"/>");
    refused(&bench, &other.deflated(), "", &["not an FMU that orthopanel wrote"]);
    let overflowing = files.described(dimension, "<Dimension start=\"18446744073709551616\"/>");
    refused(&bench, &overflowing.deflated(), "", &["18446744073709551616"]);
}

#[test]
fn archives_are_bounded() {
    let bench = Bench::new();
    let files = Files::exported(&bench, "");
    let zeros = vec![0; 70 << 20];
    let bomb = files.with("resources/zeros", &zeros).deflated();
    assert!(bomb.len() < 2 << 20);
    refused(&bench, &bomb, "", &["resources/zeros", "67108864 bytes"]);
    let lying = patched(bomb, "resources/zeros", 24, &[10, 0, 0, 0]);
    refused(&bench, &lying, "", &["resources/zeros", "larger than its declared"]);
    // What is not needed is never unpacked.
    moved(&bench, &files.with("documentation/zeros", &zeros).deflated(), "");
    let five = (0..5).fold(files.clone(), |files, n| files.with(&format!("resources/{n}"), &zeros[..60 << 20]));
    refused(&bench, &five.deflated(), "", &["files to unpack", "268435456 bytes"]);
    let many = (0..10_001).fold(files, |mut files, n| {
        files.0.push((format!("extra/{n}"), Vec::new()));
        files
    });
    refused(&bench, &many.packed(CompressionMethod::Stored), "", &["10000 entries"]);
}

#[test]
fn entries_that_no_fmu_may_have() {
    let bench = Bench::new();
    let files = Files::exported(&bench, "");
    let named = |name: &str| {
        let stand_in = "resources/".to_owned() + &"_".repeat(name.len() - 10);
        replaced(&files.with(&stand_in, b"x").deflated(), &stand_in, name)
    };
    refused(&bench, &named("/resources/elsewhere"), "", &["/resources/elsewhere", "absolute path"]);
    refused(&bench, &named("C:/resources/elsewhere"), "", &["C:/resources", "absolute path"]);
    refused(&bench, &named("resources/../../elsewhere"), "", &["resources/../../elsewhere", "leads out"]);
    refused(&bench, &named("resources\\elsewhere"), "", &["resources\\elsewhere", "backslash"]);
    refused(&bench, &named("resources/\u{1b}[2J"), "", &["\\u{1b}[2J", "control characters"]);
    refused(&bench, &named("resources/panel.json"), "", &["two entries of one name"]);
    let twice = replaced(&files.with("modelDescription.xmk", b"<x/>").deflated(), "modelDescription.xmk", DESCRIPTION);
    refused(&bench, &twice, "", &["two entries of one name"]);

    let archive = files.with("resources/other", b"/etc/passwd").deflated();
    let other = |offset: usize, bytes: &[u8]| patched(archive.clone(), "resources/other", offset, bytes);
    refused(&bench, &other(8, &[1]), "", &["resources/other", "encrypted"]);
    refused(&bench, &other(10, &[12, 0]), "", &["resources/other", "deflate"]);
    // Made on unix (3), with a mode in the upper half of the external attributes: link, device, pipe.
    for mode in [0o120_777_u32, 0o060_666, 0o020_666, 0o010_666] {
        let linked = patched(other(5, &[3]), "resources/other", 38, &(mode << 16).to_le_bytes());
        refused(&bench, &linked, "", &["resources/other", "link or a device"]);
    }
}

#[test]
fn what_keeps_an_fmu_from_being_unpacked_or_loaded_is_named() {
    let bench = Bench::new();
    let mut files = Files::exported(&bench, "");
    let refused = |script: &str, said: &[&str]| {
        let line = format!("{script} exec \"$0\" simulate panel.fmu --force-file force.csv --trust");
        let mut shell = Command::new("sh");
        let output =
            shell.args(["-c", &line, env!("CARGO_BIN_EXE_orthopanel")]).current_dir(bench.folder.path()).output();
        let output = output.expect("a shell");
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{script}: {message}");
        for part in said {
            assert!(message.contains(part), "{script}: {message:?} does not say {part:?}");
        }
    };
    refused("TMPDIR=nowhere", &["panel.fmu: it cannot be unpacked: nowhere", "No such file", "TMPDIR can name"]);
    refused("TMPDIR=force.csv", &["it cannot be unpacked: force.csv", "Not a directory"]);
    // As on a full disk, but that one is not made here: no file may be longer than 10 kB.
    let limited = "trap '' XFSZ; ulimit -f 20;";
    refused(limited, &["binaries/", "cannot be written: File too large"]);
    files.library().1 = std::fs::read(env!("CARGO_BIN_EXE_orthopanel")).expect("a program");
    std::fs::write(bench.path("panel.fmu"), files.deflated()).expect("written");
    refused("", &["panel.fmu: its library binaries/", "cannot be loaded: ", "cannot dynamically load"]);
}

/// One folder is made where temporary files lie, by whoever unpacks, and it is removed.
#[cfg(target_os = "linux")]
#[test]
fn an_archive_is_unpacked_once() {
    use rustix::fs::inotify;

    let bench = Bench::new();
    for options in ["--fmi 2", "--fmi 3"] {
        let files = Files::exported(&bench, options);
        let folder = bench.path("watched");
        std::fs::create_dir_all(&folder).expect("a folder");
        let watch = inotify::init(inotify::CreateFlags::NONBLOCK).expect("inotify");
        let events = inotify::WatchFlags::CREATE | inotify::WatchFlags::MOVED_TO;
        inotify::add_watch(&watch, &folder, events).expect("watched");
        std::fs::write(bench.path("foreign.fmu"), files.deflated()).expect("written");
        let mut command = bench.command("simulate foreign.fmu --force-file force.csv");
        assert!(command.env("TMPDIR", &folder).status().expect("the program starts").success());
        let mut buffer = [std::mem::MaybeUninit::uninit(); 4096];
        let mut reader = inotify::Reader::new(&watch, &mut buffer);
        let mut made = Vec::new();
        while let Ok(event) = reader.next() {
            made.push(event.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default());
        }
        assert!(matches!(&made[..], [only] if only.starts_with("orthopanel-")), "{options}: {made:?}");
        assert_eq!(std::fs::read_dir(&folder).expect("a folder").count(), 0);
    }
}

/// A sample of damaged archives: none may end the program otherwise than by its own exit status.
#[test]
fn damaged_archives_are_run_or_refused() {
    let bench = Bench::new();
    let archive = Files::exported(&bench, "--fmi 3").packed(CompressionMethod::Stored);
    let library = archive.windows(4).position(|window| window == b"\x7fELF").unwrap_or(0);
    let mut state = 1_u64;
    let mut random = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    for _ in 0..150 {
        let mut damaged = archive.clone();
        for _ in 0..=random(4) {
            // Before the library lie description and resource, behind it the list of entries.
            let at = if random(2) == 0 { random(library.max(1)) } else { archive.len() - 1 - random(800) };
            damaged[at] = random(256) as u8;
        }
        let output = simulated(&bench, &damaged, "");
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(matches!(output.status.code(), Some(0..=2)), "{:?}: {message}", output.status);
        assert!(!message.contains("panicked"), "{message}");
    }
}
