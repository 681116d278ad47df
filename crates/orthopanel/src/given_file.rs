//! What a file is that was given where another is wanted, and which command wants it.

use std::fs::File;
use std::io::Read as _;
use std::path::Path;

use orthopanel_data::{DataError, ImpactTest, limits, regular_file};
use serde::Deserialize;

use crate::error::Error;
use crate::force_file::{Fault, ForceHistory};

/// What a command wants.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Wanted {
    Test,
    Model,
    Force,
}

/// A kind of file that commands read or write.
struct Kind {
    name: &'static str,
    /// As what it is right, if as anything.
    fits: Option<Wanted>,
    taken: &'static str,
}

const fn kind(name: &'static str, fits: Option<Wanted>, taken: &'static str) -> Kind {
    Kind { name, fits, taken }
}

const FMU: Kind = kind("an FMU", None, "`orthopanel simulate X.fmu --force-file X.csv` takes it");
const TEST: Kind =
    kind("a test file", Some(Wanted::Test), "`orthopanel identify`, `trace`, `run` and `report` take it");
const MODEL: Kind = kind(
    "a model file",
    Some(Wanted::Model),
    "`orthopanel modes`, `accelerance`, `export` and `simulate MODEL --force-file X.csv` take it",
);
const FORCE: Kind = kind("a force file", Some(Wanted::Force), "`orthopanel simulate MODEL --force-file` takes it");
const RECORDS: Kind = kind(
    "a file of records",
    Some(Wanted::Force),
    "name it in a test file, as the `file` of a [[measurement]], for `orthopanel identify`, `trace`, `run` and `report`",
);
const MANIFEST: Kind = kind("the list of a run's results", None, "no command takes it: name one of the files in it");
const IDENTIFIED: Kind = kind(
    "what `orthopanel identify --json` answers",
    None,
    "no command takes it: `orthopanel identify TEST -o model.json` writes a model",
);
const TRACED: Kind = kind(
    "what `orthopanel trace --json` answers",
    None,
    "no command takes it: `orthopanel trace TEST -o model.json` writes a model",
);
const ANSWER: Kind = kind("what an orthopanel command answers with --json", None, "no command takes it");
const RESOURCE: Kind = kind("the resource inside an FMU", None, "`orthopanel simulate` takes the whole FMU");

/// More than any model file has.
const LOOKED_AT: u64 = 1 << 24;

/// `refused`, or in its place what the file at `path` is, where that is something else than what is `wanted`.
pub fn or_kind_of(path: &Path, wanted: Wanted, refused: Error) -> Error {
    let Some(found) = kind_of(path).filter(|found| found.fits != Some(wanted)) else { return refused };
    let wanted = match wanted {
        Wanted::Test => "a test file (TOML)",
        Wanted::Model => "a model file (JSON)",
        Wanted::Force => "a force file (CSV), or measured hits,",
    };
    Error::OtherKind { path: path.into(), given: found.name, wanted, taken: found.taken.into() }
}

impl ForceHistory {
    /// Reads a force file for `places` force places.
    ///
    /// # Errors
    /// [`Error::Unreadable`], [`Error::ForceFile`] with the line, [`Error::OtherKind`].
    pub fn read(path: &Path, places: usize) -> Result<Self, Error> {
        let text = limits::FORCE_FILE.read_text(path);
        let text = text.map_err(|source| Error::Unreadable { path: path.into(), source });
        let force = text.and_then(|text| {
            Self::from_csv(&text, places).map_err(|Fault { line, problem }| Error::ForceFile {
                path: path.into(),
                line,
                problem,
            })
        });
        force.map_err(|refused| or_kind_of(path, Wanted::Force, refused))
    }
}

/// The test at `path`, or in the folder there.
pub fn read_test(path: &Path) -> Result<ImpactTest, Error> {
    ImpactTest::read(path)
        .map_err(|refused: DataError| or_kind_of(&ImpactTest::file_at(path), Wanted::Test, Error::Data(refused)))
}

fn kind_of(path: &Path) -> Option<Kind> {
    regular_file(path).ok()?;
    let mut bytes = Vec::new();
    File::open(path).ok()?.take(LOOKED_AT).read_to_end(&mut bytes).ok()?;
    kind_of_bytes(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes))
}

fn kind_of_bytes(bytes: &[u8]) -> Option<Kind> {
    #[derive(Deserialize)]
    struct Schema {
        schema: String,
    }
    if bytes.starts_with(b"PK\x03\x04") {
        return Some(FMU);
    }
    if bytes.trim_ascii_start().starts_with(b"{") {
        let Schema { schema } = serde_json::from_slice(bytes).ok()?;
        return Some(match schema.strip_prefix("orthopanel.")?.split('/').next()? {
            "model" => MODEL,
            "identified" => IDENTIFIED,
            "trace" => TRACED,
            "manifest" => MANIFEST,
            "fmu" => RESOURCE,
            _ => ANSWER,
        });
    }
    let mut lines = bytes.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii);
    let is_header = |line: &&[u8]| matches!(*line, b"[piece]" | b"[[piece]]" | b"[[measurement]]");
    let mut columns =
        lines.clone().find(|line| !line.is_empty() && !line.starts_with(b"#"))?.split(|&byte| byte == b',');
    let first = columns.next()?.trim_ascii();
    match first {
        b"-1" | b"frequency_hz" => Some(RECORDS),
        b"time_s" if columns.any(|column| column.trim_ascii() == b"acceleration_m_s2") => Some(RECORDS),
        b"time_s" => Some(FORCE),
        _ => lines.any(|line| is_header(&line)).then_some(TEST),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_kind_is_known_by_its_content() {
        for (content, name) in [
            ("PK\u{3}\u{4}", "an FMU"),
            ("{\"piece\": 1, \"schema\": \"orthopanel.model/9\"}", "a model file"),
            ("{\"schema\": \"orthopanel.modes/1\"}", "what an orthopanel command answers with --json"),
            ("# a list\n[piece]\n", "a test file"),
            ("    -1\n    58\n", "a file of records"),
            ("frequency_hz,real,imag\n", "a file of records"),
            ("time_s,force_n,acceleration_m_s2\n", "a file of records"),
            ("# a hit\ntime_s,force_n\n0,1\n", "a force file"),
        ] {
            assert_eq!(kind_of_bytes(content.as_bytes()).map(|kind| kind.name), Some(name), "{content}");
        }
        for content in ["", "{\"schema\": \"other/1\"}", "{", "a,b\n1,2\n", "\u{0}\u{0}"] {
            assert!(kind_of_bytes(content.as_bytes()).is_none(), "{content}");
        }
    }
}
