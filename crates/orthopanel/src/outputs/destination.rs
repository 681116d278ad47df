//! Where files really go, and whether they can go there: judged before anything is computed, and once more when they are written.

use std::io::ErrorKind;
use std::path::{Component, Path, PathBuf};

use super::inputs::Inputs;
use super::{folder, streams};
use crate::error::Error;

/// Where a file really goes: behind a link, the file it points to, whether that is there or not. What is there must be a file,
/// since renaming onto a device or a pipe would take its place, and none that the command reads.
pub(super) fn destination(path: &Path, inputs: &Inputs) -> Result<PathBuf, Error> {
    if let Some(stream) = streams::stream_at(path) {
        let reason = format!("it is {stream}, and a file would take its place");
        return Err(Error::Unwritable { path: path.into(), reason, kind: ErrorKind::Other });
    }
    let there = match std::fs::metadata(path) {
        Ok(there) => there,
        Err(error) if error.kind() != ErrorKind::NotFound => return Err(Error::unwritable(path, &error)),
        Err(error) => {
            let folder = folder::of(path);
            if let Ok(target) = std::fs::read_link(path) {
                return destination(&folder.join(target), inputs);
            }
            let Some(name) = path.file_name() else {
                let reason = "it ends in no name of a file".into();
                return Err(Error::Unwritable { path: path.into(), reason, kind: error.kind() });
            };
            // One spelling of the folder, by which it is locked.
            return Ok(std::fs::canonicalize(folder).map_or_else(|_| path.into(), |folder| folder.join(name)));
        }
    };
    if !there.is_file() {
        let (kind, what) = match there.is_dir() {
            true => (ErrorKind::IsADirectory, "a folder"),
            false => (ErrorKind::Other, "no regular file"),
        };
        return Err(Error::Unwritable { path: path.into(), reason: format!("it is {what}"), kind });
    }
    if let Some(input) = inputs.at(path) {
        return Err(Error::OutputIsInput { path: path.into(), input: input.into() });
    }
    // Renaming would take the place of a file that its owner protects.
    if there.permissions().readonly() {
        let reason = "it is read-only".into();
        return Err(Error::Unwritable { path: path.into(), reason, kind: ErrorKind::PermissionDenied });
    }
    std::fs::canonicalize(path).map_err(|error| Error::unwritable(path, &error))
}

/// Whether `path` ends as the name of a folder, by a separator or by one and a dot; both are forgotten by its components.
pub fn ends_as_folder(path: &Path) -> bool {
    let text = path.to_string_lossy();
    text.strip_suffix('.').unwrap_or(&text).ends_with(std::path::is_separator)
}

pub(super) fn names_file(path: &Path) -> Result<(), Error> {
    if ends_as_folder(path) {
        let reason = "it ends as the name of a folder does".into();
        return Err(Error::Unwritable { path: path.into(), reason, kind: ErrorKind::IsADirectory });
    }
    Ok(())
}

/// Whether a folder that is not there can be made, as far as names tell: below a folder, and not by way of one that is not there.
pub(super) fn makeable(folder: &Path) -> Result<(), Error> {
    let is_there = |path: &&Path| path.as_os_str().is_empty() || std::fs::symlink_metadata(path).is_ok();
    let there = folder.ancestors().find(is_there).unwrap_or(folder);
    let missing = folder.strip_prefix(there).unwrap_or(folder);
    let (reason, kind) = if there.is_symlink() && !there.exists() {
        ("a link in it leads nowhere", ErrorKind::NotFound)
    } else if !(there.is_dir() || there.as_os_str().is_empty()) {
        ("a file is where a folder should be", ErrorKind::NotADirectory)
    } else if missing.components().any(|part| part == Component::ParentDir) {
        ("it goes up from a folder that is not there", ErrorKind::NotFound)
    } else {
        return Ok(());
    };
    Err(Error::Unwritable { path: folder.into(), reason: reason.into(), kind })
}

/// Makes a folder and those it lies in; gives those that were not there, innermost first.
pub(super) fn made(folder: &Path) -> Result<Vec<PathBuf>, Error> {
    let missing = folder.ancestors().take_while(|folder| !folder.as_os_str().is_empty() && !folder.exists());
    let missing: Vec<_> = missing.map(Path::to_path_buf).collect();
    match std::fs::create_dir_all(folder) {
        Ok(()) => Ok(missing),
        Err(error) => {
            unmade(&missing);
            Err(Error::unwritable(folder, &error))
        }
    }
}

pub(super) fn unmade(folders: &[PathBuf]) {
    // Best effort: a folder that another program filled meanwhile stays.
    folders.iter().for_each(|folder| drop(std::fs::remove_dir(folder)));
}
