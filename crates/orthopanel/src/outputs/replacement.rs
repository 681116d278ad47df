//! Replacing files together: all, or on any failure none.
//!
//! New content is written and flushed beside its place, what is there is set aside by a second name, and only then names
//! change, each at once. A process killed between two of them leaves every file whole, the earlier or the new one.

use std::fs::{File, OpenOptions};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use tempfile::TempPath;

use super::folder::{DRAWN, Folder, NEW, OLD, of};
use crate::error::Error;

/// Changes that are prepared and not made yet; dropped, it leaves nothing behind.
pub struct Replacement {
    folders: Vec<Folder>,
    changes: Vec<Change>,
}

/// One name, and what it shall stand for.
struct Change {
    path: PathBuf,
    /// `None` to remove the file.
    new: Option<TempPath>,
    before: Before,
}

/// What the name stands for before the change.
enum Before {
    Nothing,
    /// A file, by its second name.
    File(TempPath),
    /// What an earlier change of the same replacement put there, which also puts back what was there before.
    Changed,
}

impl Replacement {
    /// Locks the folders in which files will change.
    pub fn in_folders(mut folders: Vec<PathBuf>) -> Self {
        // In one order, so that two commands never wait for each other.
        folders.sort_unstable();
        folders.dedup();
        Self { folders: folders.iter().map(|folder| Folder::lock(folder)).collect(), changes: Vec::new() }
    }

    /// Prepares to write `content` to `path`.
    pub fn put(&mut self, path: &Path, content: &[u8]) -> Result<(), Error> {
        let new = staged(path, content).map_err(|error| Error::unwritable(path, &error))?;
        self.changes.push(Change { path: path.into(), new: Some(new), before: before(path)? });
        Ok(())
    }

    /// Prepares to have the file at `from` at `to` too, where none is.
    pub fn copy(&mut self, from: &Path, to: &Path) -> Result<(), Error> {
        let new = set_aside(from).map_err(|error| Error::unwritable(to, &error))?;
        self.changes.push(Change { path: to.into(), new: Some(new), before: Before::Nothing });
        Ok(())
    }

    /// Prepares to remove the file at `path`.
    pub fn remove(&mut self, path: &Path) -> Result<(), Error> {
        self.changes.push(Change { path: path.into(), new: None, before: before(path)? });
        Ok(())
    }

    /// Prepares to write `content` once more to the `path` of an earlier change, when all others are made.
    pub fn put_again(&mut self, path: &Path, content: &[u8]) -> Result<(), Error> {
        let new = staged(path, content).map_err(|error| Error::unwritable(path, &error))?;
        self.changes.push(Change { path: path.into(), new: Some(new), before: Before::Changed });
        Ok(())
    }

    /// Makes all changes, in their order.
    ///
    /// # Errors
    /// [`Error::Unwritable`] of the first that fails; then all is as it was.
    pub fn commit(mut self) -> Result<(), Error> {
        for index in 0..self.changes.len() {
            let Some(change) = self.changes.get_mut(index) else { break };
            if let Err(error) = change.make() {
                let failed = Error::unwritable(&change.path, &error);
                self.changes.truncate(index);
                return Err(self.undone(failed));
            }
        }
        if let Some((folder, error)) = self.folders.iter().find_map(|folder| Some((folder, folder.flush().err()?))) {
            let failed = Error::unwritable(folder.path(), &error);
            return Err(self.undone(failed));
        }
        self.changes.clear();
        self.folders.iter().for_each(Folder::sweep);
        Ok(())
    }

    /// Puts back what was there, latest first; tells in `failed` of what could not be.
    fn undone(self, failed: Error) -> Error {
        let lost: Vec<String> = self.changes.into_iter().rev().filter_map(Change::undo).collect();
        self.folders.iter().for_each(|folder| drop(folder.flush()));
        if lost.is_empty() { failed } else { Error::NotPutBack { failed: Box::new(failed), lost: lost.join("; ") } }
    }
}

impl Change {
    fn make(&mut self) -> io::Result<()> {
        let Some(new) = self.new.take() else { return std::fs::remove_file(&self.path) };
        if !matches!(self.before, Before::Nothing) {
            return new.persist(&self.path).map_err(|error| error.error);
        }
        match new.persist_noclobber(&self.path) {
            // Not every file system can promise it.
            Err(failed) if std::fs::symlink_metadata(&self.path).is_err() => failed.path.persist(&self.path),
            // What came here meanwhile is another program's, or another result where capitals are not told apart.
            put => put,
        }
        .map_err(|failed| failed.error)
    }

    /// `Some` tells where the earlier file lies, if it cannot be put back.
    fn undo(self) -> Option<String> {
        let path = self.path.display();
        let old = match self.before {
            Before::File(old) => old,
            Before::Changed => return None,
            Before::Nothing => {
                return std::fs::remove_file(&self.path).err().map(|error| format!("{path} is new and stays: {error}"));
            }
        };
        let failed = old.persist(&self.path).err()?;
        let mut visible = self.path.clone().into_os_string();
        visible.push(".earlier");
        let lies = match failed.path.persist_noclobber(&visible) {
            Ok(()) => PathBuf::from(visible),
            Err(again) => again.path.keep().ok()?,
        };
        Some(format!("{path} is new, and the earlier one lies in {}: {}", lies.display(), failed.error))
    }
}

/// `content`, flushed to a new file beside `path`.
fn staged(path: &Path, content: &[u8]) -> io::Result<TempPath> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(NEW).rand_bytes(DRAWN);
    #[cfg(unix)]
    {
        // A temporary file is private by default; a result is an ordinary file, subject to the user's umask.
        use std::os::unix::fs::PermissionsExt as _;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let earlier = std::fs::metadata(path).ok().map(|there| there.permissions());
    // The kind alone, since the error of a temporary file names it, and nobody knows that name.
    let mut file = builder.tempfile_in(of(path)).map_err(|error| io::Error::from(error.kind()))?;
    file.write_all(content).map_err(|error| io::Error::from(error.kind()))?;
    if let Some(permissions) = earlier {
        // Who could read the earlier result can read the new one, and nobody else.
        file.as_file().set_permissions(permissions)?;
    }
    file.as_file().sync_all()?;
    Ok(file.into_temp_path())
}

fn before(path: &Path) -> Result<Before, Error> {
    let there = match std::fs::symlink_metadata(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Before::Nothing),
        there => there.and_then(|_| set_aside(path)),
    };
    there.map(Before::File).map_err(|error| Error::unwritable(path, &error))
}

/// A second name of the file at `path`.
fn set_aside(path: &Path) -> io::Result<TempPath> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(OLD).rand_bytes(DRAWN);
    let folder = of(path);
    // File systems without hard links, and files that may not have one, are copied.
    let aside = builder.make_in(folder, |aside| std::fs::hard_link(path, aside));
    let aside = aside.or_else(|_| builder.make_in(folder, |aside| copied(path, aside)));
    aside.map(tempfile::NamedTempFile::into_temp_path).map_err(|error| io::Error::from(error.kind()))
}

fn copied(from: &Path, to: &Path) -> io::Result<()> {
    let mut source = File::open(from)?;
    let mut copy = OpenOptions::new().write(true).create_new(true).open(to)?;
    let written = io::copy(&mut source, &mut copy).and_then(|_| copy.set_permissions(source.metadata()?.permissions()));
    // `make_in` takes over what was made, not what failed.
    written.and_then(|()| copy.sync_all()).inspect_err(|_| drop(std::fs::remove_file(to)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = std::fs::read_dir(folder).expect("a folder");
        let mut names: Vec<_> =
            entries.map(|entry| entry.expect("an entry").file_name().into_string().expect("UTF-8")).collect();
        names.sort();
        names
    }

    fn read(path: &Path) -> String {
        std::fs::read_to_string(path).expect("a file")
    }

    /// A list, a result and one of an earlier run; what is to become of them.
    fn prepared(home: &Path) -> Replacement {
        for name in ["list", "result", "stale"] {
            std::fs::write(home.join(name), format!("earlier {name}")).expect("written");
        }
        let mut replacement = Replacement::in_folders(vec![home.into()]);
        replacement.put(&home.join("list"), b"both").expect("prepared");
        replacement.put(&home.join("result"), b"new").expect("prepared");
        replacement.put(&home.join("further"), b"new").expect("prepared");
        replacement.remove(&home.join("stale")).expect("prepared");
        replacement.put_again(&home.join("list"), b"concluded").expect("prepared");
        replacement
    }

    #[test]
    fn all_changes_are_made_and_leftovers_swept() {
        let home = tempfile::tempdir().expect("a folder");
        let replacement = prepared(home.path());
        for name in [".orthopanel-new-abc123", ".orthopanel-old-XYZ789", ".orthopanel-notes"] {
            std::fs::write(home.path().join(name), "").expect("written");
        }
        replacement.commit().expect("replaced");
        let swept = if cfg!(unix) { names(home.path()) } else { Vec::new() };
        assert!(!cfg!(unix) || swept == [".orthopanel-notes", "further", "list", "result"], "{swept:?}");
        assert_eq!(read(&home.path().join("list")), "concluded");
        assert_eq!(read(&home.path().join("result")), "new");
    }

    #[test]
    fn after_a_failure_all_is_as_it_was() {
        let home = tempfile::tempdir().expect("a folder");
        // One after the other fails: a folder has taken the place of the file, or the file is gone.
        for (failing, earlier) in [("further", true), ("list", true), ("stale", false)] {
            let replacement = prepared(home.path());
            let place = home.path().join(failing);
            if earlier && failing == "list" {
                std::fs::remove_file(&place).expect("removed");
            }
            if earlier {
                std::fs::create_dir(&place).expect("made");
                std::fs::write(place.join("filled"), "").expect("written");
            } else {
                std::fs::remove_file(&place).expect("removed");
            }
            let refused = replacement.commit().expect_err("refused").to_string();
            assert!(refused.contains(failing) && refused.contains("cannot be written"), "{refused}");
            assert_eq!(read(&home.path().join("result")), "earlier result");
            for name in ["list", "stale"].into_iter().filter(|name| *name != failing) {
                assert_eq!(read(&home.path().join(name)), format!("earlier {name}"));
            }
            if earlier {
                std::fs::remove_dir_all(&place).expect("removed");
            }
            assert!(names(home.path()).iter().all(|name| ["list", "result", "stale"].contains(&name.as_str())));
        }
    }

    #[test]
    fn dropped_it_leaves_nothing_behind() {
        let home = tempfile::tempdir().expect("a folder");
        drop(prepared(home.path()));
        assert_eq!(names(home.path()), ["list", "result", "stale"]);
        assert_eq!(read(&home.path().join("result")), "earlier result");
    }
}
