//! The zip archive of an FMU, read as a stranger's file: entries are judged by name and kind before any is unpacked, and what
//! comes out of one is counted, whatever its header claims.

use std::fs::File;
use std::io::{Cursor, Read};
use std::path::Path;

use zip::read::ZipFileEntry;
use zip::{CompressionMethod, ZipArchive};

use crate::fmu_refusal::{FmuRefusal, limited, shown};

const MOST_BYTES: u64 = 128 << 20;
const MOST_ENTRIES: usize = 10_000;
const MOST_UNPACKED: u64 = 256 << 20;
const MOST_UNPACKED_OF_ONE: u64 = 64 << 20;
const LONGEST_NAME: usize = 255;
const DEEPEST_NAME: usize = 16;

/// How the record of an entry in the list at the archive's end begins.
const LISTED: &[u8] = b"PK\x01\x02";

/// File types of unix in the upper bits of an entry's mode.
const TYPE_BITS: u32 = 0o170_000;
const FOLDER: u32 = 0o040_000;
const REGULAR: u32 = 0o100_000;

/// An archive whose entries all have names that stay below a folder, each its own.
pub(super) struct Archive {
    /// In memory, so that nobody changes it between two looks.
    archive: ZipArchive<Cursor<Vec<u8>>>,
    unpacked: u64,
}

impl Archive {
    pub(super) fn new(file: impl Read) -> Result<Self, FmuRefusal> {
        let mut bytes = Vec::new();
        file.take(MOST_BYTES + 1).read_to_end(&mut bytes).map_err(FmuRefusal::Read)?;
        if bytes.len() as u64 > MOST_BYTES {
            return Err(too_many_bytes("a zip archive", MOST_BYTES));
        }
        // Counted before the list is read, which would take up memory for each.
        let listed = bytes.windows(LISTED.len()).filter(|window| *window == LISTED).count();
        limited("a zip archive", listed, MOST_ENTRIES, "entries")?;
        let archive = ZipArchive::new(Cursor::new(bytes)).map_err(broken)?;
        for index in 0..archive.len() {
            let entry = archive.by_index_data(index).map_err(broken)?;
            let name = entry.name().map_err(broken)?;
            if let Some(problem) = name_problem(&name).or_else(|| kind_problem(&entry)) {
                return Err(FmuRefusal::Entry { name: shown(&name), problem });
            }
        }
        if archive.has_duplicate_names() {
            return Err(FmuRefusal::TwoEntries);
        }
        Ok(Self { archive, unpacked: 0 })
    }

    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.archive.file_names_raw().filter_map(|name| str::from_utf8(name).ok())
    }

    /// Unpacks an entry into memory; `None` where there is none of that name.
    pub(super) fn take(&mut self, name: &str, most: u64) -> Result<Option<Vec<u8>>, FmuRefusal> {
        let Some(index) = self.archive.index_for_name(name) else { return Ok(None) };
        let most = most.min(MOST_UNPACKED_OF_ONE);
        let left = MOST_UNPACKED.saturating_sub(self.unpacked);
        let broken_entry = |error: &dyn std::fmt::Display| FmuRefusal::Archive(format!("{}: {error}", shown(name)));
        let reader = self.archive.by_index(index).map_err(|error| broken_entry(&error))?;
        let mut content = Vec::new();
        let read = reader.take(most.min(left).saturating_add(1)).read_to_end(&mut content);
        let size = read.map_err(|error| broken_entry(&error))? as u64;
        if size > most {
            return Err(too_many_bytes(&format!("an entry {}", shown(name)), most));
        }
        if size > left {
            return Err(too_many_bytes("files to unpack", MOST_UNPACKED));
        }
        self.unpacked += size;
        Ok(Some(content))
    }

    /// Unpacks all files that `wanted` names into `folder`, where none of them may lie already.
    pub(super) fn unpack(&mut self, folder: &Path, wanted: impl Fn(&str) -> bool) -> Result<(), FmuRefusal> {
        let names: Vec<_> =
            self.names().filter(|name| wanted(name) && !name.ends_with('/')).map(String::from).collect();
        for name in names {
            if let Some(content) = self.take(&name, MOST_UNPACKED_OF_ONE)? {
                place(folder, &name, &content)?;
            }
        }
        Ok(())
    }
}

/// Writes a file of the archive below `folder`; an existing one is left as it is and an error.
pub(super) fn place(folder: &Path, name: &str, content: &[u8]) -> Result<(), FmuRefusal> {
    use std::io::Write as _;
    let path = folder.join(name);
    let write = || {
        std::fs::create_dir_all(path.parent().unwrap_or(folder))?;
        File::create_new(&path)?.write_all(content)
    };
    write().map_err(|source| FmuRefusal::Unpack { what: "written", path: path.clone(), source })
}

/// What a name does that could lead out of a folder, here or on another system.
fn name_problem(name: &str) -> Option<&'static str> {
    let parts = || name.strip_suffix('/').unwrap_or(name).split('/');
    if name.contains('\\') {
        Some("has a backslash: pack it anew with / between folders")
    } else if name.starts_with('/') || name.contains(':') {
        Some("is the absolute path of a file: pack it anew with paths inside the FMU")
    } else if parts().any(|part| matches!(part, "" | "." | "..")) {
        Some("leads out of its folder: pack it anew without . and .. in paths")
    } else if name.chars().any(char::is_control) {
        Some("has control characters in its name: pack it anew without them")
    } else if name.len() > LONGEST_NAME || parts().count() > DEEPEST_NAME {
        Some("has a path of more than 255 bytes or 16 folders: pack it anew with shorter ones")
    } else {
        None
    }
}

/// What an entry is that no FMU may hold.
fn kind_problem(entry: &ZipFileEntry) -> Option<&'static str> {
    let kind = entry.unix_mode().unwrap_or(0) & TYPE_BITS;
    if entry.encrypted() {
        Some("is encrypted: pack it anew without a password")
    } else if ![0, FOLDER, REGULAR].contains(&kind) {
        Some("is a link or a device: pack it anew with files alone")
    } else if !matches!(entry.compression(), CompressionMethod::Stored | CompressionMethod::Deflated) {
        Some("is compressed by another method than deflate: pack it anew as a plain zip archive")
    } else {
        None
    }
}

fn too_many_bytes(what: &str, most: u64) -> FmuRefusal {
    FmuRefusal::TooMuch { what: what.into(), most, unit: "bytes" }
}

fn broken(error: impl std::fmt::Display) -> FmuRefusal {
    FmuRefusal::Archive(error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stay_below_a_folder() {
        let long = ["a/".repeat(16) + "b", "a".repeat(256)];
        let bad = [
            "/etc/x",
            "..",
            "a/../b",
            "a//b",
            "./a",
            "a/..",
            "C:/x",
            "a\\b",
            "a\u{1b}[2J",
            "",
            "/",
            &long[0],
            &long[1],
        ];
        for name in bad {
            assert!(name_problem(name).is_some(), "{name:?}");
        }
        for name in ["modelDescription.xml", "resources/", "resources/a b/ü..x", &"a".repeat(255)] {
            assert_eq!(name_problem(name), None, "{name:?}");
        }
    }
}
