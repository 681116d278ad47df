//! A folder while results in it are replaced: locked against other commands, swept of what a killed one left, flushed.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

/// How long another command may hold a folder; a replacement takes milliseconds.
#[cfg(unix)]
const PATIENCE: std::time::Duration = std::time::Duration::from_secs(10);

/// New files before they take their place.
pub const NEW: &str = ".orthopanel-new-";
/// Earlier files until the new ones are all in place.
pub const OLD: &str = ".orthopanel-old-";
/// Letters and digits after these, as `tempfile` draws them.
pub const DRAWN: usize = 6;

/// Dropping it gives the folder free; so does the end of the process, whatever ends it.
pub struct Folder {
    path: PathBuf,
    /// `None` where the system locks no folders.
    lock: Option<File>,
}

impl Folder {
    pub fn lock(path: &Path) -> Self {
        Self { path: path.into(), lock: locked(path) }
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Flushes the names of its files to disk.
    pub fn flush(&self) -> io::Result<()> {
        flush(&self.path)
    }

    /// Removes what a killed command left here. Under the lock such names are no living command's.
    pub fn sweep(&self) {
        let Some(entries) = self.lock.as_ref().and_then(|_| std::fs::read_dir(&self.path).ok()) else { return };
        for entry in entries.flatten() {
            if entry.file_type().is_ok_and(|kind| kind.is_file()) && entry.file_name().to_str().is_some_and(is_drawn) {
                // Another try comes with the next command.
                let _ = std::fs::remove_file(entry.path());
            }
        }
    }
}

/// The folder that holds `path`.
pub fn of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Whether a file is called as this program calls those under way.
fn is_drawn(name: &str) -> bool {
    let drawn = [NEW, OLD].iter().find_map(|prefix| name.strip_prefix(prefix));
    drawn.is_some_and(|drawn| drawn.len() == DRAWN && drawn.bytes().all(|byte| byte.is_ascii_alphanumeric()))
}

#[cfg(unix)]
fn locked(path: &Path) -> Option<File> {
    use rustix::fs::{FlockOperation, flock};
    let folder = File::open(path).ok()?;
    let begun = std::time::Instant::now();
    loop {
        match flock(&folder, FlockOperation::NonBlockingLockExclusive) {
            Ok(()) => return Some(folder),
            Err(rustix::io::Errno::WOULDBLOCK) if begun.elapsed() < PATIENCE => {
                std::thread::sleep(std::time::Duration::from_millis(10));
            }
            Err(_) => return None,
        }
    }
}

#[cfg(not(unix))]
fn locked(_: &Path) -> Option<File> {
    None
}

#[cfg(unix)]
pub fn flush(folder: &Path) -> io::Result<()> {
    match File::open(folder).and_then(|folder| folder.sync_all()) {
        // A folder that may be written to and not read, and file systems that flush no folders.
        Err(error)
            if matches!(
                error.kind(),
                io::ErrorKind::PermissionDenied | io::ErrorKind::InvalidInput | io::ErrorKind::Unsupported
            ) =>
        {
            Ok(())
        }
        flushed => flushed,
    }
}

/// Elsewhere folders cannot be flushed; the system keeps their order.
#[cfg(not(unix))]
pub fn flush(_: &Path) -> io::Result<()> {
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_names_of_this_program_are_swept() {
        assert!(is_drawn(".orthopanel-new-aB3dE9") && is_drawn(".orthopanel-old-000000"));
        for name in [".orthopanel-new-", ".orthopanel-new-aB3dE9.csv", ".orthopanel-aB3dE9", "orthopanel-new-aB3dE9"] {
            assert!(!is_drawn(name), "{name}");
        }
    }
}
