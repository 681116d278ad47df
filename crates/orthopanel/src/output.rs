//! Files and standard output: a command that fails leaves no file behind, and `--json` prints one object.

use std::io::Write;
use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::error::CommandError;

/// Writes `content` beside `path`, then renames: on failure nothing is left, and an older file stays as it was.
pub fn write(path: &Path, content: &[u8]) -> Result<(), CommandError> {
    let fail = |source| CommandError::Unwritable { path: path.into(), source };
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    builder.prefix(".orthopanel-");
    #[cfg(unix)]
    {
        // A temporary file is private by default; a result is an ordinary file, subject to the user's umask.
        use std::os::unix::fs::PermissionsExt as _;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.tempfile_in(folder).map_err(fail)?;
    file.write_all(content).map_err(fail)?;
    file.persist(path).map_err(|error| fail(error.error))?;
    Ok(())
}

/// The files of one command, gathered first and written together: all of them, or none.
#[derive(Default)]
pub struct Folder {
    files: Vec<(String, Vec<u8>)>,
}

impl Folder {
    pub fn add(&mut self, name: impl Into<String>, content: impl Into<Vec<u8>>) {
        self.files.push((name.into(), content.into()));
    }

    /// Writes all files into `folder`, which is made where it is not there; gives their paths.
    pub fn write(self, folder: &Path) -> Result<Vec<PathBuf>, CommandError> {
        let made = !folder.exists();
        std::fs::create_dir_all(folder).map_err(|source| CommandError::Unwritable { path: folder.into(), source })?;
        let mut written = Vec::new();
        for (name, content) in self.files {
            let path = folder.join(name);
            if let Err(error) = write(&path, &content) {
                // The first error is the one to report; clearing up after it is best effort.
                if made {
                    let _ = std::fs::remove_dir_all(folder);
                } else {
                    written.iter().for_each(|path: &PathBuf| drop(std::fs::remove_file(path)));
                }
                return Err(error);
            }
            written.push(path);
        }
        Ok(written)
    }
}

/// Prints one JSON object on standard output.
pub fn print_json(value: &impl Serialize) {
    // Every answer is made of plain numbers, texts and lists: serialisation has nothing to fail on.
    print(&(serde_json::to_string(value).unwrap_or_default() + "\n"));
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

    #[test]
    fn a_folder_that_cannot_be_filled_is_not_left_half_full() {
        let home = tempfile::tempdir().expect("a temporary folder");
        let folder = home.path().join("out");
        let mut files = Folder::default();
        files.add("first", "1");
        files.add("no-such-folder/second", "2");
        assert!(matches!(files.write(&folder), Err(CommandError::Unwritable { .. })));
        assert!(!folder.exists());
    }
}
