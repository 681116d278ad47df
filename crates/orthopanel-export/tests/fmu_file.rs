//! The archive as a file: its parts, its bytes, and what a failure leaves behind.

use std::io::Read as _;

use orthopanel_export::{ExportError, FmiVersion, Fmu, FmuOptions};
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
        if cfg!(all(target_os = "linux", target_arch = "x86_64")) {
            let mut library = archive.by_name(&format!("binaries/{folder}/orthopanel.so")).expect("library");
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
    for name in ["", "  ", "a\u{1}b"] {
        let options = FmuOptions { name: name.into(), ..FmuOptions::default() };
        assert!(matches!(Fmu::new(model(1, 1), ports(1, 1), &options), Err(ExportError::Name { .. })), "{name:?}");
    }
}

#[test]
fn names_are_escaped_in_the_xml() {
    let options = FmuOptions { name: "a<b & \"c\"".into(), ..FmuOptions::default() };
    let fmu = Fmu::new(model(1, 1), ports(1, 1), &options).expect("a sound FMU");
    assert!(
        fmu.model_description().contains("modelName=\"a&lt;b &amp; &quot;c&quot;\""),
        "{}",
        fmu.model_description()
    );
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
