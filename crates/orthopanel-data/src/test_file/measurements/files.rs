//! `file`: a name, a list of names, a pattern with `*` and `?`, or `{force = .., response = ..}` where the channels have files of their own.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use toml::Spanned;

use super::Entry;
use crate::{DataError, Location, error::short, limits, regular_file};

/// A file of a measurement, with that of the motion where it has one of its own.
pub(super) struct MeasuredFile {
    pub(super) file: PathBuf,
    pub(super) response_file: Option<PathBuf>,
}

impl Entry<'_> {
    /// The files of a measurement, in the order given; those of a pattern in the order of their names.
    ///
    /// Asked for now, so that the line is known which names a file that is not there, or is none.
    pub(super) fn files(&self, given: &Spanned<toml::Value>) -> Result<Vec<MeasuredFile>, DataError> {
        let at = || self.at(given.span(), "file");
        let wrong = |value: &toml::Value| DataError::Syntax {
            at: at(),
            message: format!(
                "{} given, wanted is a file's name in quotes, a list of names, or {{force = .., response = ..}}",
                short(&value.to_string())
            ),
        };
        let entries: Vec<&toml::Value> = match given.get_ref() {
            toml::Value::Array(list) if !list.is_empty() => list.iter().collect(),
            other => vec![other],
        };
        let mut files = Vec::new();
        for entry in entries {
            match entry {
                toml::Value::String(name) => {
                    let of_name = |file| MeasuredFile { file, response_file: None };
                    files.extend(self.named(name, &at)?.into_iter().map(of_name));
                }
                toml::Value::Table(table) => {
                    let name = |key: &str| table.get(key).and_then(toml::Value::as_str);
                    let (Some(force), Some(response), 2) = (name("force"), name("response"), table.len()) else {
                        return Err(wrong(entry));
                    };
                    let (forces, responses) = (self.named(force, &at)?, self.named(response, &at)?);
                    if forces.len() != responses.len() {
                        let (f, r) = (forces.len(), responses.len());
                        let problem = format!("{f} files of force and {r} of response: one of each a hit is needed");
                        return Err(DataError::Contradiction { at: at(), problem });
                    }
                    let pairs = forces.into_iter().zip(responses);
                    files.extend(pairs.map(|(file, response)| MeasuredFile { file, response_file: Some(response) }));
                }
                other => return Err(wrong(other)),
            }
        }
        self.source.at_most((files.len(), "files"), limits::MEASUREMENTS, at, "put some into a test of their own")?;
        Ok(files)
    }

    /// The file of a name, or those of a pattern, each of which is there.
    fn named(&self, name: &str, at: &dyn Fn() -> Box<Location>) -> Result<Vec<PathBuf>, DataError> {
        let file = self.source.beside(name);
        // A file whose name has such signs is itself.
        let is_pattern = name.contains(['*', '?']) && !file.exists();
        let unreadable = |file: &Path, error: io::Error| DataError::Unreadable {
            at: at(),
            source: io::Error::new(error.kind(), format!("{}: {error}", file.display())),
        };
        let named = match is_pattern {
            true => matching(&file).map_err(|error| unreadable(&file, error))?,
            false => vec![file],
        };
        for file in &named {
            let found = regular_file(file).and_then(|found| limits::RECORD_FILE.check(&found));
            found.map_err(|error| unreadable(file, error))?;
        }
        Ok(named)
    }
}

/// The files in the pattern's folder whose names match its last part, in the order of their names.
fn matching(pattern: &Path) -> io::Result<Vec<PathBuf>> {
    let name = pattern.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    let folder = pattern.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut found = Vec::new();
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        if entry.file_name().to_str().is_some_and(|of| matches(name.as_bytes(), of.as_bytes()))
            && entry.path().is_file()
        {
            found.push(pattern.with_file_name(entry.file_name()));
        }
    }
    found.sort();
    if found.is_empty() {
        let problem = "no file matches: * stands for any characters, ? for one, in a file's name, not in a folder's";
        return Err(io::Error::new(io::ErrorKind::NotFound, problem));
    }
    Ok(found)
}

/// Whether a name matches a pattern, in time that grows with the product of their lengths.
fn matches(pattern: &[u8], name: &[u8]) -> bool {
    // Where each prefix of the pattern may have come to in the name.
    let mut reached = vec![false; name.len() + 1];
    reached[0] = true;
    for sign in pattern {
        let mut next = vec![false; name.len() + 1];
        for at in 0..=name.len() {
            match sign {
                b'*' => next[at] = reached[at] || (at > 0 && next[at - 1]),
                _ if at > 0 => next[at] = reached[at - 1] && (*sign == b'?' || *sign == name[at - 1]),
                _ => {}
            }
        }
        reached = next;
    }
    reached[name.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_patterns_match_names() {
        for (pattern, name, is) in [
            ("hit-*.csv", "hit-12.csv", true),
            ("hit-*.csv", "hit-.csv", true),
            ("hit-?.csv", "hit-12.csv", false),
            ("*", "anything", true),
            ("*a*b", "xaxbxb", true),
            ("*a*b", "xaxbx", false),
            ("a", "", false),
        ] {
            assert_eq!(matches(pattern.as_bytes(), name.as_bytes()), is, "{pattern} {name}");
        }
    }
}
