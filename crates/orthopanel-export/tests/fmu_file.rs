//! The archive as a file: its parts, its bytes, and what a failure leaves behind.

use std::io::Read as _;

use orthopanel_export::{ExportError, FmiVersion, Fmu, FmuOptions, Library, Platform, PortNames};
use orthopanel_fmu::RESOURCE_SCHEMA;
use orthopanel_model::{ModalModel, Mode, Place, Ports};

fn ports(forces: usize, responses: usize) -> Ports {
    let places = |count: usize| (0..count).map(|n| Place { x: 0.1 * n as f64, y: 0.0 }).collect();
    Ports { forces: places(forces), responses: places(responses) }
}

fn model(forces: usize, responses: usize) -> ModalModel {
    let mode = Mode {
        angular_frequency: 2019.0,
        damping_ratio: 0.0024,
        at_forces: vec![1.7; forces],
        at_responses: vec![-0.4; responses],
    };
    ModalModel::new(forces, responses, vec![mode]).expect("a sound model")
}

fn options(version: FmiVersion) -> FmuOptions {
    FmuOptions { version, ..FmuOptions::default() }
}

#[test]
fn the_archive_holds_each_part_where_the_standard_wants_it() {
    let folders = [(FmiVersion::Fmi2, "linux64"), (FmiVersion::Fmi3, "x86_64-linux")];
    for (version, folder) in folders {
        let fmu = Fmu::new(model(1, 1), ports(1, 1), &options(version)).expect("a sound FMU");
        let bytes = fmu.to_bytes().expect("an archive");
        let mut archive = zip::ZipArchive::new(std::io::Cursor::new(bytes)).expect("a zip");
        let mut text = String::new();
        archive.by_name("modelDescription.xml").expect("XML").read_to_string(&mut text).expect("text");
        assert_eq!(text, fmu.model_description());
        archive.by_name("resources/panel.json").expect("resource");
        archive.by_name("documentation/index.html").expect("documentation");
        for (name, said) in [("license.txt", "faer 0."), ("rust-standard-library.html", "The Rust Standard Library")] {
            let mut text = String::new();
            let path = format!("documentation/licenses/{name}");
            archive.by_name(&path).expect("licences").read_to_string(&mut text).expect("text");
            assert!(text.contains(said), "{name}");
        }
        let icon = if version == FmiVersion::Fmi2 { "model.png" } else { "terminalsAndIcons/icon.png" };
        let mut start = [0; 8];
        archive.by_name(icon).expect("icon").read_exact(&mut start).expect("bytes");
        assert_eq!(&start, b"\x89PNG\r\n\x1a\n");
        if cfg!(all(target_os = "linux", target_arch = "x86_64")) {
            let mut library = archive.by_name(&format!("binaries/{folder}/panel.so")).expect("library");
            assert_eq!(library.unix_mode().map(|mode| mode & 0o111), Some(0o111), "executable");
            let mut start = [0; 4];
            library.read_exact(&mut start).expect("bytes");
            assert_eq!(&start, b"\x7fELF");
        }
    }
}

#[test]
fn the_same_content_gives_the_same_bytes_and_another_model_another_token() {
    let make = |response: usize| Fmu::new(model(1, response), ports(1, response), &FmuOptions::default());
    let (one, again, other) = (make(1).expect("fmu"), make(1).expect("fmu"), make(2).expect("fmu"));
    assert_eq!(one.to_bytes().expect("bytes"), again.to_bytes().expect("bytes"));
    let guid = |fmu: &Fmu| fmu.model_description().split("guid=").nth(1).map(|rest| rest[..40].to_string());
    assert!(guid(&one).is_some());
    assert_ne!(guid(&one), guid(&other));
}

#[test]
fn models_without_ports_or_name_are_refused() {
    for (forces, responses) in [(0, 1), (1, 0)] {
        let refused = Fmu::new(model(forces, responses), ports(forces, responses), &FmuOptions::default());
        assert!(matches!(refused, Err(ExportError::NoPort { .. })));
    }
    let refused = Fmu::new(model(1, 1), ports(1, 2), &FmuOptions::default());
    assert!(matches!(refused, Err(ExportError::Resource(_))));
    for name in ["", "  ", "a\u{1}b", "a b", "2a", "ä", "../x"] {
        let options = FmuOptions { name: name.into(), ..FmuOptions::default() };
        assert!(matches!(Fmu::new(model(1, 1), ports(1, 1), &options), Err(ExportError::Name { .. })), "{name:?}");
    }
}

/// Bytes that pass for the runtime of a platform: its header with the processor, and the names that it would hold.
fn made_library(platform: &str) -> Vec<u8> {
    let mut header = vec![0; 0x50];
    let mut put = |at: usize, bytes: &[u8]| header[at..at + bytes.len()].copy_from_slice(bytes);
    match platform {
        "x86_64-linux" | "linux64" => (put(0, b"\x7fELF"), put(18, &[0x3e, 0])),
        "aarch64-linux" => (put(0, b"\x7fELF"), put(18, &[0xb7, 0])),
        "x86_64-windows" | "win64" => (put(0, b"MZ"), (put(0x3c, &[0x40]), put(0x40, b"PE\0\0\x64\x86")).0),
        "aarch64-darwin" => (put(0, b"\xcf\xfa\xed\xfe"), put(4, &[0x0c, 0, 0, 1])),
        other => panic!("{other}"),
    };
    let names = [b"..fmi2Instantiate..fmi3InstantiateCoSimulation..", RESOURCE_SCHEMA.as_bytes(), b".."].concat();
    [header, names].concat()
}

fn platform(name: &str) -> Platform {
    name.parse().expect("a platform")
}

#[test]
fn libraries_of_several_platforms_lie_side_by_side() {
    let given = ["win64", "aarch64-darwin", "x86_64-linux"];
    let libraries: Result<Vec<_>, _> =
        given.iter().map(|name| Library::new(platform(name), made_library(name))).collect();
    let options = FmuOptions { libraries: libraries.expect("sound libraries"), ..FmuOptions::default() };
    for (version, paths) in [
        (FmiVersion::Fmi2, ["win64/panel.dll", "aarch64-darwin/panel.dylib", "linux64/panel.so"]),
        (FmiVersion::Fmi3, ["x86_64-windows/panel.dll", "aarch64-darwin/panel.dylib", "x86_64-linux/panel.so"]),
    ] {
        let options = FmuOptions { version, ..options.clone() };
        let bytes = Fmu::new(model(1, 1), ports(1, 1), &options).and_then(|fmu| fmu.to_bytes()).expect("an archive");
        let mut archive = zip::ZipArchive::new(std::io::Cursor::new(bytes)).expect("a zip");
        for (path, name) in paths.iter().zip(given) {
            let mut content = Vec::new();
            let mut entry = archive.by_name(&format!("binaries/{path}")).expect(path);
            entry.read_to_end(&mut content).expect("bytes");
            // The one given for this platform stands in place of the embedded one.
            assert_eq!(content, made_library(name), "{path}");
        }
    }
}

#[test]
fn libraries_that_cannot_be_the_runtime_are_refused() {
    assert!(
        matches!("solaris".parse::<Platform>(), Err(ExportError::Platform { known, .. }) if known.contains("linux"))
    );
    for (content, reason) in [
        (made_library("win64"), "not an ELF"),
        (made_library("aarch64-linux"), "another processor: its header has machine 0xb7, not 0x3e"),
        (b"\x7fELF".to_vec(), "cut off"),
        (made_library("linux64")[..0x50].to_vec(), "no orthopanel-fmu of this version"),
        (made_library("linux64").iter().map(|&byte| if byte == b'2' { b'1' } else { byte }).collect(), "this version"),
        (Vec::new(), "not an ELF"),
    ] {
        let refused = Library::new(platform("linux64"), content);
        assert!(
            matches!(&refused, Err(ExportError::Library { reason: said, .. }) if said.contains(reason)),
            "{refused:?}"
        );
    }
    let twice =
        ["win64", "x86_64-windows"].map(|name| Library::new(platform(name), made_library(name)).expect("sound"));
    let options = FmuOptions { libraries: twice.to_vec(), ..FmuOptions::default() };
    let refused = Fmu::new(model(1, 1), ports(1, 1), &options);
    assert!(matches!(refused, Err(ExportError::Library { reason, .. }) if reason.contains("twice")));
}

/// The embedded runtime is small enough to lie in every FMU, and passes for what it is.
#[test]
fn the_runtime_is_below_its_limit() {
    if !cfg!(all(target_os = "linux", target_arch = "x86_64")) {
        return;
    }
    let bytes = Fmu::new(model(1, 1), ports(1, 1), &FmuOptions::default()).and_then(|fmu| fmu.to_bytes());
    let mut archive = zip::ZipArchive::new(std::io::Cursor::new(bytes.expect("an archive"))).expect("a zip");
    let mut content = Vec::new();
    archive.by_name("binaries/linux64/panel.so").expect("library").read_to_end(&mut content).expect("bytes");
    assert!(content.len() < 1_500_000, "{} bytes", content.len());
    Library::new(platform("linux64"), content).expect("what is embedded may be given too");
}

/// The embedded runtime tells nobody where it was built, and so may be the same bytes wherever that is.
#[test]
fn the_runtime_holds_no_path_of_the_builder() {
    if !cfg!(all(target_os = "linux", target_arch = "x86_64")) {
        return;
    }
    let bytes = Fmu::new(model(1, 1), ports(1, 1), &FmuOptions::default()).and_then(|fmu| fmu.to_bytes());
    let mut archive = zip::ZipArchive::new(std::io::Cursor::new(bytes.expect("an archive"))).expect("a zip");
    let mut content = Vec::new();
    archive.by_name("binaries/linux64/panel.so").expect("library").read_to_end(&mut content).expect("bytes");
    let holds = |text: &str| content.windows(text.len()).any(|window| window == text.as_bytes());
    // Such as panics name: else nothing is searched.
    assert!(holds(".rs"), "no file of source is named at all");
    let workspace = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).expect("a workspace");
    let homes = ["HOME", "USERPROFILE", "CARGO_HOME", "RUSTUP_HOME"].map(|name| std::env::var(name).ok());
    let folders = homes.into_iter().flatten().chain([workspace.display().to_string()]);
    for folder in folders.filter(|folder| folder.len() > 1).chain(["/.cargo/".into(), "registry/src/".into()]) {
        assert!(!holds(&folder), "{folder}");
    }
}

/// Two panels in one vehicle have two names; so have their libraries, or importers that load both overwrite one by the other.
#[test]
fn the_name_is_that_of_model_identifier_and_library() {
    for version in [FmiVersion::Fmi2, FmiVersion::Fmi3] {
        let options = FmuOptions { name: "floor_left".into(), version, ..FmuOptions::default() };
        let fmu = Fmu::new(model(1, 1), ports(1, 1), &options).expect("a sound FMU");
        let text = fmu.model_description();
        assert!(text.contains("modelName=\"floor_left\""), "{text}");
        assert_eq!(text.matches("modelIdentifier=\"floor_left\"").count(), 2);
        let bytes = fmu.to_bytes().expect("an archive");
        let archive = zip::ZipArchive::new(std::io::Cursor::new(bytes)).expect("a zip");
        let mut names = archive.file_names().map(|name| name.expect("a name").into_owned());
        assert!(names.all(|name| !name.starts_with("binaries/") || name.contains("/floor_left.")));
    }
}

#[test]
fn ports_with_names_name_their_variables() {
    let named = |forces: &[Option<&str>], responses: &[Option<&str>]| {
        let list = |names: &[Option<&str>]| names.iter().map(|name| name.map(String::from)).collect();
        let names = PortNames { forces: list(forces), responses: list(responses) };
        let options = FmuOptions { names, version: FmiVersion::Fmi3, ..FmuOptions::default() };
        Fmu::new(model(2, 2), ports(2, 2), &options).map(|fmu| fmu.model_description().to_owned())
    };
    let text = named(&[Some("seat_left")], &[None, Some("seat_left")]).expect("a sound FMU");
    for name in ["force_seat_left", "force_2", "acceleration_1", "velocity_seat_left", "displacement_seat_left"] {
        assert!(text.contains(&format!("name=\"{name}\"")), "{name}: {text}");
    }
    assert!(!text.contains("\"force_1\"") && !text.contains("\"velocity_2\""));
    for (forces, said) in [
        (&[Some("seat left")][..], "port \"seat left\": must be a name of letters"),
        (&[Some("2")][..], "port \"2\": must be a name of letters"),
        (&[Some("a"), Some("a")][..], "two variables are called \"force_a\""),
        (&[Some("linear")][..], "two variables are called \"force_linear\""),
        (&[None, None, Some("a")][..], "3 names for 2 force ports"),
    ] {
        let refused = named(forces, &[]).expect_err(said).to_string();
        assert!(refused.starts_with(said), "{refused}");
    }
}

/// OMSimulator reaches into its list of values by the reference.
#[test]
fn references_count_from_one_without_gaps() {
    let references = |text: &str| -> Vec<usize> {
        let (_, variables) = text.split_once("<ModelVariables>").expect("variables");
        let (variables, _) = variables.split_once("</ModelVariables>").expect("an end");
        let parts = variables.split("valueReference=\"").skip(1);
        parts.map(|part| part.split('"').next().and_then(|number| number.parse().ok()).expect("a number")).collect()
    };
    for (version, arrays) in [(FmiVersion::Fmi2, false), (FmiVersion::Fmi3, false), (FmiVersion::Fmi3, true)] {
        let options = FmuOptions { version, arrays, ..FmuOptions::default() };
        let fmu = Fmu::new(model(2, 3), ports(2, 3), &options).expect("a sound FMU");
        let found = references(fmu.model_description());
        assert_eq!(found, (1..=found.len()).collect::<Vec<_>>(), "{version:?}, arrays {arrays}");
    }
}

#[test]
fn a_file_that_cannot_be_written_leaves_nothing_behind() {
    let folder = tempfile::tempdir().expect("a folder");
    let fmu = Fmu::new(model(1, 1), ports(1, 1), &FmuOptions::default()).expect("a sound FMU");
    // A folder stands where the file should go; and a folder is missing.
    let taken = folder.path().join("taken.fmu");
    std::fs::create_dir(&taken).expect("a folder");
    for path in [taken, folder.path().join("missing").join("x.fmu")] {
        assert!(matches!(fmu.write(&path), Err(ExportError::Write { .. })), "{}", path.display());
    }
    let names = std::fs::read_dir(folder.path()).expect("listing").map(|entry| entry.expect("entry").file_name());
    assert_eq!(names.collect::<Vec<_>>(), ["taken.fmu"]);
    let good = folder.path().join("good.fmu");
    fmu.write(&good).expect("written");
    fmu.write(&good).expect("written over");
    assert_eq!(std::fs::read(&good).expect("read"), fmu.to_bytes().expect("bytes"));
}
