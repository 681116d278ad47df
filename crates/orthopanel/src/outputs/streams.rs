//! Open streams of this process: a file that the shell opened for standard output or standard error is not to be renamed over, and
//! an answer is not to be appended to what it is made from.

use std::path::{Path, PathBuf};

use same_file::Handle;

/// More links in a row than a system follows.
const MOST_LINKS: usize = 64;

/// What `path` leads to, where that is an open stream: by its name, or since the shell opened the same file.
pub(super) fn stream_at(path: &Path) -> Option<&'static str> {
    if leads_through_descriptors(path) {
        return Some("an open stream");
    }
    // Nothing but files that are there: opening a pipe may wait for ever.
    std::fs::metadata(path).ok().filter(std::fs::Metadata::is_file)?;
    let there = Handle::from_path(path).ok()?;
    let is = |stream: std::io::Result<Handle>| stream.is_ok_and(|stream| stream == there);
    if is(Handle::stdout()) { Some("standard output") } else { is(Handle::stderr()).then_some("standard error") }
}

/// The first of the files that standard output is appended to.
pub fn fed_by_stdout<'a>(mut paths: impl Iterator<Item = &'a Path>) -> Option<&'a Path> {
    let stdout =
        Handle::stdout().ok().filter(|stdout| stdout.as_file().metadata().is_ok_and(|found| found.is_file()))?;
    paths.find(|path| {
        std::fs::metadata(path).is_ok_and(|found| found.is_file())
            && Handle::from_path(path).is_ok_and(|there| there == stdout)
    })
}

/// Whether `path`, or a link that it leads to, is a name of an open file: `/dev/stdout`, `/dev/fd/1`, `/proc/self/fd/1`.
fn leads_through_descriptors(path: &Path) -> bool {
    let mut path = PathBuf::from(path);
    for _ in 0..MOST_LINKS {
        if is_descriptor(&path) {
            return true;
        }
        let Ok(target) = std::fs::read_link(&path) else { break };
        path = super::folder::of(&path).join(target);
    }
    false
}

fn is_descriptor(path: &Path) -> bool {
    let Some(name) = path.file_name() else { return false };
    let Ok(folder) = std::fs::canonicalize(super::folder::of(path)) else { return false };
    let is_std = ["stdin", "stdout", "stderr"].iter().any(|std| name == *std);
    (folder == Path::new("/dev") && is_std)
        || folder == Path::new("/dev/fd")
        || (folder.starts_with("/proc") && folder.ends_with("fd"))
}
