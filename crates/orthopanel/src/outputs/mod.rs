//! Files that a command writes: never over a file that it reads, and all of them or none.
//!
//! A command names its inputs and the outputs that it may write before it computes anything, then adds what it found and
//! writes all at once. Where results fill a folder of their own, a manifest beside them lists what belongs to the run; what
//! an earlier one lists and the new run does not write is removed, unless somebody changed it since.

mod folder;
mod inputs;
mod manifest;
mod replacement;

use std::collections::BTreeSet;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use crate::console;
use crate::error::CommandError;
pub use inputs::Inputs;
use inputs::is_same;
use manifest::{Listed, Manifest};
use replacement::Replacement;

/// The outputs of one command.
pub struct Outputs {
    inputs: Inputs,
    /// Made where it is not there.
    folder: Option<PathBuf>,
    /// Its name in the folder.
    manifest: Option<&'static str>,
    files: Vec<(PathBuf, Vec<u8>)>,
}

impl Outputs {
    /// Of a command that reads `inputs`.
    pub fn of(inputs: Inputs) -> Self {
        Self { inputs, folder: None, manifest: None, files: Vec::new() }
    }

    /// `folder` is to be made where it is not there.
    pub fn making(self, folder: &Path) -> Self {
        Self { folder: Some(folder.into()), ..self }
    }

    /// The results fill `folder`, made where it is not there, and a manifest of that name lists them.
    pub fn filling(self, folder: &Path, manifest: &'static str) -> Self {
        Self { folder: Some(folder.into()), manifest: Some(manifest), ..self }
    }

    /// Names an output that may be written later.
    ///
    /// # Errors
    /// [`CommandError::OutputIsInput`], and [`CommandError::Unwritable`] where no file can be put there.
    pub fn planned(self, path: &Path) -> Result<Self, CommandError> {
        self.destination(path)?;
        let folder = folder::of(path);
        match &self.folder {
            Some(own) if !own.exists() => {}
            Some(own) if !own.is_dir() => {
                let (path, reason) = (own.clone(), "it is there and is no folder".into());
                return Err(CommandError::Unwritable { path, reason, kind: ErrorKind::NotADirectory });
            }
            _ => {
                std::fs::metadata(folder).map_err(|error| CommandError::unwritable(path, &error))?;
            }
        }
        Ok(self)
    }

    /// As [`Outputs::planned`], of several.
    pub fn all_planned(self, paths: impl IntoIterator<Item = PathBuf>) -> Result<Self, CommandError> {
        paths.into_iter().try_fold(self, |outputs, path| outputs.planned(&path))
    }

    /// As [`Outputs::planned`], of names in the folder of the results.
    pub fn planned_inside(self, names: impl IntoIterator<Item = String>) -> Result<Self, CommandError> {
        let manifest = self.manifest.map(String::from);
        let paths: Vec<_> = names.into_iter().chain(manifest).map(|name| self.inside(&name)).collect();
        self.all_planned(paths)
    }

    /// Adds a file in the folder of the results.
    pub fn add_inside(&mut self, name: &str, content: impl Into<Vec<u8>>) {
        self.add(self.inside(name), content);
    }

    pub fn add(&mut self, path: impl Into<PathBuf>, content: impl Into<Vec<u8>>) {
        self.files.push((path.into(), content.into()));
    }

    /// Writes all files that were added, gives their paths.
    ///
    /// # Errors
    /// As [`Outputs::planned`], whether named before or not; then every file is as it was.
    pub fn write(self) -> Result<Vec<PathBuf>, CommandError> {
        if self.files.is_empty() {
            return Ok(Vec::new());
        }
        let made = self.folder.as_deref().map_or(Ok(Vec::new()), made)?;
        self.replaced().inspect_err(|_| unmade(&made))?;
        for parent in made.iter().filter_map(|folder| folder.parent()) {
            // What is in the new folder lies on disk; that its name does is best effort.
            let _ = folder::flush(parent);
        }
        let manifest = self.manifest_path();
        Ok(self.files.into_iter().map(|(path, _)| path).chain(manifest).collect())
    }

    fn replaced(&self) -> Result<(), CommandError> {
        let mut destinations = Vec::with_capacity(self.files.len());
        for (path, _) in &self.files {
            let destination = self.destination(path)?;
            if destinations.contains(&destination) {
                let reason = "another result of this command goes to the same file".into();
                return Err(CommandError::Unwritable { path: path.clone(), reason, kind: ErrorKind::Other });
            }
            destinations.push(destination);
        }
        let manifest = self.manifest_path().map(|path| self.destination(&path)).transpose()?;
        let folders = destinations.iter().chain(&manifest).map(|path| folder::of(path).into()).collect();
        let mut replacement = Replacement::in_folders(folders);
        let concluded = match &manifest {
            Some(path) => self.prepare_manifest(path, &destinations, &mut replacement)?,
            None => None,
        };
        for (path, (_, content)) in destinations.iter().zip(&self.files) {
            replacement.put(path, content)?;
        }
        let mut removed = Vec::new();
        if let (Some(path), Some(Concluded { stale, manifest })) = (&manifest, concluded) {
            stale.iter().try_for_each(|path| replacement.remove(path))?;
            replacement.put_again(path, manifest.text().as_bytes())?;
            removed = stale;
        }
        replacement.commit()?;
        for path in removed {
            console::say(format_args!("removed {}, left by an earlier run", path.display()));
        }
        Ok(())
    }

    /// Prepares the manifest as the first change; gives what is left to do when the files are in place.
    fn prepare_manifest(
        &self,
        path: &Path,
        destinations: &[PathBuf],
        replacement: &mut Replacement,
    ) -> Result<Option<Concluded>, CommandError> {
        let earlier = match manifest::listed(path) {
            Ok(listed) => listed,
            Err(problem) => {
                let kept = free_name(path);
                console::say(format_args!(
                    "note: {}: no manifest of orthopanel, kept as {}; what earlier runs left is not removed: {problem}",
                    path.display(),
                    kept.display()
                ));
                replacement.copy(path, &kept)?;
                Vec::new()
            }
        };
        let name = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let files: Vec<Listed> = self.files.iter().map(|(path, content)| Listed::of(&name(path), content)).collect();
        let stale = self.stale(&earlier, &files, destinations);
        let mut replacing = earlier;
        replacing.retain(|listed| !files.contains(listed));
        let manifest = Manifest::new(&self.inputs, files, replacing)?;
        replacement.put(path, manifest.text().as_bytes())?;
        Ok((!manifest.is_concluded()).then(|| Concluded { stale, manifest: manifest.concluded() }))
    }

    /// The files of earlier runs that this one does not write and that are as they were left.
    fn stale(&self, earlier: &[Listed], files: &[Listed], destinations: &[PathBuf]) -> Vec<PathBuf> {
        let Some(folder) = &self.folder else { return Vec::new() };
        let is_written = |name: &str| files.iter().any(|file| file.file == name);
        let names: BTreeSet<&str> = earlier.iter().filter_map(Listed::plain_name).collect();
        let mut stale = Vec::new();
        for name in names.into_iter().filter(|name| !is_written(name)) {
            let path = folder.join(name);
            let is_file = std::fs::symlink_metadata(&path).is_ok_and(|found| found.is_file());
            if !is_file || destinations.iter().any(|destination| is_same(destination, &path)) {
                continue;
            }
            let sha256 = manifest::sha256_of(&path).ok();
            let is_as_left =
                earlier.iter().any(|listed| listed.file == name && Some(&listed.sha256) == sha256.as_ref());
            if is_as_left && self.inputs.at(&path).is_none() {
                stale.push(path);
            } else {
                let why = if is_as_left { "this command reads it" } else { "it was changed since" };
                console::say(format_args!("note: {}: left by an earlier run, and kept: {why}", path.display()));
            }
        }
        stale
    }

    fn inside(&self, name: &str) -> PathBuf {
        self.folder.as_ref().map_or(name.into(), |folder| folder.join(name))
    }

    fn manifest_path(&self) -> Option<PathBuf> {
        self.manifest.map(|name| self.inside(name))
    }

    /// Where a file really goes: behind a link, the file it points to. What is there must be a file, since renaming onto a
    /// device or a pipe would take its place, and none that the command reads.
    fn destination(&self, path: &Path) -> Result<PathBuf, CommandError> {
        match std::fs::metadata(path) {
            // Renaming would take the place of a file that its owner protects.
            Ok(there) if there.is_file() && there.permissions().readonly() && self.inputs.at(path).is_none() => {
                let reason = "it is read-only".into();
                return Err(CommandError::Unwritable { path: path.into(), reason, kind: ErrorKind::PermissionDenied });
            }
            Ok(there) if there.is_file() => {}
            Ok(there) => {
                let (kind, what) = match there.is_dir() {
                    true => (ErrorKind::IsADirectory, "a folder"),
                    false => (ErrorKind::Other, "no regular file"),
                };
                return Err(CommandError::Unwritable { path: path.into(), reason: format!("it is {what}"), kind });
            }
            Err(_) => {
                // One spelling of the folder, by which it is locked.
                let folder = std::fs::canonicalize(folder::of(path)).ok();
                return Ok(folder
                    .zip(path.file_name())
                    .map_or_else(|| path.into(), |(folder, name)| folder.join(name)));
            }
        }
        if let Some(input) = self.inputs.at(path) {
            return Err(CommandError::OutputIsInput { path: path.into(), input: input.into() });
        }
        std::fs::canonicalize(path).map_err(|error| CommandError::unwritable(path, &error))
    }
}

/// What follows when the files of a run are in place.
struct Concluded {
    stale: Vec<PathBuf>,
    manifest: Manifest,
}

/// Makes a folder and those it lies in; gives those that were not there, innermost first.
fn made(folder: &Path) -> Result<Vec<PathBuf>, CommandError> {
    let missing = folder.ancestors().take_while(|folder| !folder.as_os_str().is_empty() && !folder.exists());
    let missing: Vec<_> = missing.map(Path::to_path_buf).collect();
    match std::fs::create_dir_all(folder) {
        Ok(()) => Ok(missing),
        Err(error) => {
            unmade(&missing);
            Err(CommandError::unwritable(folder, &error))
        }
    }
}

fn unmade(folders: &[PathBuf]) {
    // Best effort: a folder that another program filled meanwhile stays.
    folders.iter().for_each(|folder| drop(std::fs::remove_dir(folder)));
}

/// A name beside `path` that no file has: `manifest-1.json`, ...
fn free_name(path: &Path) -> PathBuf {
    let names = (1..u64::MAX).map(|number| with_suffix(path, &format!("-{number}")));
    names.into_iter().find(|name| std::fs::symlink_metadata(name).is_err()).unwrap_or_default()
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

#[cfg(test)]
mod tests {
    use super::*;

    fn write(path: &Path, content: &str) -> Result<Vec<PathBuf>, CommandError> {
        let mut outputs = Outputs::of(Inputs::default());
        outputs.add(path, content);
        outputs.write()
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
        // Two results behind links to one file: the second would take the place of the first.
        let mut outputs = Outputs::of(Inputs::default());
        outputs.add(&link, "one");
        outputs.add(&real, "two");
        assert!(matches!(outputs.write(), Err(CommandError::Unwritable { .. })));
        assert_eq!(std::fs::read_to_string(&real).expect("read"), "new");
    }

    #[test]
    fn a_file_that_its_owner_protects_is_kept() {
        let home = tempfile::tempdir().expect("a temporary folder");
        let path = home.path().join("model.json");
        std::fs::write(&path, "old").expect("written");
        let mut permissions = std::fs::metadata(&path).expect("there").permissions();
        permissions.set_readonly(true);
        std::fs::set_permissions(&path, permissions).expect("protected");
        let refused = write(&path, "new").expect_err("refused");
        assert!(refused.to_string().contains("it is read-only"), "{refused}");
        assert_eq!(std::fs::read_to_string(&path).expect("read"), "old");
    }

    /// A folder that is locked twice is waited for.
    #[test]
    fn regress_a_folder_has_one_spelling_whether_its_files_are_there_or_not() {
        let home = tempfile::tempdir().expect("a temporary folder");
        std::fs::create_dir(home.path().join("out")).expect("made");
        std::fs::write(home.path().join("out/old"), "").expect("written");
        let outputs = Outputs::of(Inputs::default());
        let folder = |name: &str| {
            let destination = outputs.destination(&home.path().join("out/../out").join(name)).expect("writable");
            folder::of(&destination).to_path_buf()
        };
        assert_eq!(folder("old"), folder("new"));
    }

    #[test]
    fn files_are_written_all_or_none() {
        let home = tempfile::tempdir().expect("a temporary folder");
        let folder = home.path().join("deep/out");
        let mut outputs = Outputs::of(Inputs::default()).making(&folder);
        outputs.add_inside("first", "1");
        outputs.add_inside("no-such-folder/second", "2");
        assert!(matches!(outputs.write(), Err(CommandError::Unwritable { .. })));
        assert!(!home.path().join("deep").exists());
    }

    /// Names where the process lives that replaces files until it is killed.
    #[cfg(unix)]
    const KILLED_IN: &str = "ORTHOPANEL_KILLED_IN";
    #[cfg(unix)]
    const RESULTS: usize = 8;

    /// Results full of one letter; `a` has one more than `b`.
    #[cfg(unix)]
    fn replace_by(letter: char, folder: &Path) -> Result<Vec<PathBuf>, CommandError> {
        let mut outputs = Outputs::of(Inputs::default()).filling(folder, "manifest.json");
        for number in 0..RESULTS + usize::from(letter == 'a') {
            outputs.add_inside(&format!("result-{number}"), letter.to_string().repeat(5000 + number));
        }
        outputs.write()
    }

    /// SIGKILL at 200 moments while results are replaced: each is the earlier or the new one, whole.
    #[cfg(unix)]
    #[test]
    fn killed_while_files_are_replaced_each_is_whole() {
        use std::time::Duration;

        // In memory where there is such a folder: what a kill leaves there is the same, and flushing takes no time.
        let home = tempfile::tempdir_in("/dev/shm").or_else(|_| tempfile::tempdir()).expect("a temporary folder");
        replace_by('a', home.path()).expect("written");
        let mut halfway = 0;
        for run in 0..200_u64 {
            let mut process = std::process::Command::new(std::env::current_exe().expect("this program"));
            process.args(["--exact", "outputs::tests::replaces_until_killed", "--ignored"]).env(KILLED_IN, home.path());
            process.stdout(std::process::Stdio::null()).stderr(std::process::Stdio::null());
            let mut process = process.spawn().expect("it starts");
            std::thread::sleep(Duration::from_micros(10_000 + 61 * run));
            process.kill().expect("killed");
            process.wait().expect("ended");
            let mut letters = BTreeSet::new();
            for number in 0..=RESULTS {
                let path = home.path().join(format!("result-{number}"));
                let Ok(text) = std::fs::read_to_string(&path) else {
                    assert_eq!(number, RESULTS, "run {run} lost {}", path.display());
                    continue;
                };
                letters.extend(text.chars());
                let is_whole = ["a", "b"].iter().any(|letter| text == letter.repeat(5000 + number));
                assert!(is_whole, "run {run}: {} is not whole", path.display());
            }
            halfway += usize::from(letters.len() == 2);
            let listed = manifest::listed(&home.path().join("manifest.json")).expect("a whole manifest");
            assert!(listed.len() >= RESULTS, "run {run}: {listed:?}");
        }
        assert!(halfway > 0, "no process was killed between two files");
        replace_by('b', home.path()).expect("written");
        let left = std::fs::read_dir(home.path()).expect("a folder").count();
        assert_eq!(left, RESULTS + 1, "something of the killed is left behind");
    }

    #[cfg(unix)]
    #[test]
    #[ignore = "the process that `killed_while_files_are_replaced_each_is_whole` kills"]
    fn replaces_until_killed() {
        let Some(folder) = std::env::var_os(KILLED_IN).map(PathBuf::from) else { return };
        loop {
            for letter in ['b', 'a'] {
                replace_by(letter, &folder).expect("written");
            }
        }
    }
}
