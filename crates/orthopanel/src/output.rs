//! Files and standard output: a command that fails leaves no file behind, and `--json` prints one object.

use std::io::Write;
use std::path::{Path, PathBuf};

use serde::Serialize;
use tempfile::NamedTempFile;

use crate::error::CommandError;

/// Files of one command, gathered first and written together: all of them, or none.
#[derive(Default)]
pub struct Files(Vec<(PathBuf, Vec<u8>)>);

impl Files {
    pub fn add(&mut self, path: impl Into<PathBuf>, content: impl Into<Vec<u8>>) {
        self.0.push((path.into(), content.into()));
    }

    /// Writes each file beside its place, then renames them all: on failure nothing new is left, and an older file is
    /// as it was unless its own rename was done.
    pub fn write(self) -> Result<Vec<PathBuf>, CommandError> {
        let stage_one = |(path, content): (PathBuf, Vec<u8>)| {
            let path = destination(path)?;
            stage(&path, &content).map(|file| (file, path))
        };
        let staged: Vec<_> = self.0.into_iter().map(stage_one).collect::<Result<_, _>>()?;
        let mut written: Vec<PathBuf> = Vec::with_capacity(staged.len());
        for (file, path) in staged {
            if let Err(error) = file.persist(&path) {
                // The first error is the one to report; clearing up after it is best effort.
                written.iter().for_each(|path| drop(std::fs::remove_file(path)));
                return Err(unwritable(&path, &error.error));
            }
            written.push(path);
        }
        Ok(written)
    }

    /// As [`Files::write`], into `folder`, which is made where it is not there.
    pub fn write_into(self, folder: &Path) -> Result<Vec<PathBuf>, CommandError> {
        let made = !folder.exists();
        std::fs::create_dir_all(folder).map_err(|error| unwritable(folder, &error))?;
        let inside = self.0.into_iter().map(|(path, content)| (folder.join(path), content));
        Self(inside.collect()).write().inspect_err(|_| {
            if made {
                let _ = std::fs::remove_dir(folder);
            }
        })
    }
}

/// `folder/stem.extension` as `folder/stem{suffix}.extension`.
pub fn with_suffix(path: &Path, suffix: &str) -> PathBuf {
    if suffix.is_empty() {
        return path.to_path_buf();
    }
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let extension = path.extension().map_or(String::new(), |extension| format!(".{}", extension.to_string_lossy()));
    path.with_file_name(format!("{stem}{suffix}{extension}"))
}

/// Writes one file, or leaves nothing behind.
pub fn write(path: &Path, content: impl Into<Vec<u8>>) -> Result<(), CommandError> {
    let mut files = Files::default();
    files.add(path, content);
    files.write().map(drop)
}

/// As [`write()`], into a folder that is made where it is not there.
pub fn write_with_folder(path: &Path, content: impl Into<Vec<u8>>) -> Result<(), CommandError> {
    let (Some(folder), Some(name)) = (path.parent(), path.file_name()) else { return write(path, content) };
    if folder.as_os_str().is_empty() {
        return write(path, content);
    }
    let mut files = Files::default();
    files.add(name, content);
    files.write_into(folder).map(drop)
}

/// Where a file really goes: behind a link, the file it points to. What is there must be a file, since renaming onto a
/// device or a pipe would take its place.
fn destination(path: PathBuf) -> Result<PathBuf, CommandError> {
    match std::fs::metadata(&path) {
        Ok(there) if there.is_file() => std::fs::canonicalize(&path).map_err(|error| unwritable(&path, &error)),
        Ok(_) => Err(unwritable(&path, &"it is there and is no regular file")),
        Err(_) => Ok(path),
    }
}

fn stage(path: &Path, content: &[u8]) -> Result<NamedTempFile, CommandError> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    // Asked first, since the error of the temporary file would name a file that nobody knows.
    std::fs::metadata(folder).map_err(|error| unwritable(path, &error))?;
    let mut builder = tempfile::Builder::new();
    builder.prefix(".orthopanel-");
    #[cfg(unix)]
    {
        // A temporary file is private by default; a result is an ordinary file, subject to the user's umask.
        use std::os::unix::fs::PermissionsExt as _;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.tempfile_in(folder).map_err(|error| unwritable(path, &error.kind()))?;
    file.write_all(content).map_err(|error| unwritable(path, &error.kind()))?;
    Ok(file)
}

fn unwritable(path: &Path, reason: &impl std::fmt::Display) -> CommandError {
    CommandError::Unwritable { path: path.into(), reason: reason.to_string() }
}

/// One JSON object on one line.
pub fn json(value: &impl Serialize) -> String {
    // Every answer is made of plain numbers, texts and lists: serialisation has nothing to fail on.
    serde_json::to_string(value).unwrap_or_default() + "\n"
}

/// Prints one JSON object on standard output.
pub fn print_json(value: &impl Serialize) {
    print(&json(value));
}

/// Prints on standard output; a reader that has gone away (`| head`) is no error.
pub fn print(text: &str) {
    let _ = std::io::stdout().write_all(text.as_bytes());
}

/// Columns of numbers as CSV, each number with as many digits as bring it back exactly.
pub fn csv(names: &[String], columns: &[&[f64]]) -> String {
    let mut text = names.join(",") + "\n";
    let rows = columns.iter().map(|column| column.len()).min().unwrap_or(0);
    for row in 0..rows {
        let numbers = columns.iter().filter_map(|column| column.get(row));
        let numbers: Vec<String> = numbers.map(|number| number_text(*number)).collect();
        text += &numbers.join(",");
        text.push('\n');
    }
    text
}

/// The shortest text that reads back as `number`: plain near one, with an exponent far from it.
fn number_text(number: f64) -> String {
    if number == 0.0 || (1e-4..1e15).contains(&number.abs()) { format!("{number}") } else { format!("{number:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn csv_numbers_read_back_exactly() {
        let numbers = [0.0, -0.3, 1.0 / 3.0, 1e-300, -2.5e20, f64::MIN_POSITIVE];
        let text = csv(&["a".into()], &[&numbers]);
        let back: Vec<f64> = text.lines().skip(1).map(|line| line.parse().expect("a number")).collect();
        assert_eq!(back, numbers);
    }

    #[cfg(unix)]
    #[test]
    fn what_is_no_regular_file_is_not_replaced_and_a_link_is_followed() {
        let home = tempfile::tempdir().expect("a temporary folder");
        let (real, link) = (home.path().join("real"), home.path().join("link"));
        std::fs::write(&real, "old").expect("written");
        std::os::unix::fs::symlink(&real, &link).expect("linked");
        write(&link, "new").expect("written");
        assert!(std::fs::symlink_metadata(&link).expect("there").is_symlink());
        assert_eq!(std::fs::read_to_string(&real).expect("read"), "new");
        assert!(matches!(write(home.path(), "x"), Err(CommandError::Unwritable { .. })));
        assert!(matches!(write(Path::new("/dev/null"), "x"), Err(CommandError::Unwritable { .. })));
    }

    #[test]
    fn files_are_written_all_or_none() {
        let home = tempfile::tempdir().expect("a temporary folder");
        let folder = home.path().join("out");
        let mut files = Files::default();
        files.add("first", "1");
        files.add("no-such-folder/second", "2");
        assert!(matches!(files.write_into(&folder), Err(CommandError::Unwritable { .. })));
        assert!(!folder.exists());
    }
}
