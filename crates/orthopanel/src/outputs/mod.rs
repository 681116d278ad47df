//! Files that a command writes: never over a file that it reads, and all of them or none.
//!
//! A command names its inputs and the outputs that it may write before it computes anything, then adds what it found and
//! writes all at once. Where results are several, in a folder of their own or beside each other, a manifest with them lists what
//! belongs to the run; what an earlier one lists and the new run does not write is removed, unless somebody changed it since, and
//! of a result that somebody changed and the new run replaces a copy is kept.

mod destination;
mod folder;
mod inputs;
mod listing;
mod manifest;
mod replacement;
mod sha256;
mod streams;

use std::ffi::OsString;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use crate::{Error, Observer};
pub use destination::ends_as_folder;
use destination::{made, makeable, unmade};
pub use inputs::Inputs;
pub use manifest::Listed;
use replacement::Replacement;
pub use streams::fed_by_stdout;

/// The outputs of one command.
pub struct Outputs {
    inputs: Inputs,
    command: Vec<String>,
    /// Made where it is not there.
    folder: Option<PathBuf>,
    manifest: Option<PathBuf>,
    /// Extension of the results, where the manifest may list those of another one too, which another command wrote.
    extension: Option<OsString>,
    files: Vec<(PathBuf, Vec<u8>)>,
}

impl Outputs {
    /// Of what is made from `inputs`.
    pub fn of(inputs: Inputs) -> Self {
        Self { inputs, command: vec![], folder: None, manifest: None, extension: None, files: Vec::new() }
    }

    /// Of a command of these words, which a manifest tells.
    pub fn by(self, command: Vec<String>) -> Self {
        Self { command, ..self }
    }

    /// `folder` is to be made where it is not there.
    pub fn making(self, folder: &Path) -> Self {
        Self { folder: Some(folder.into()), ..self }
    }

    /// The results fill `folder`, made where it is not there, and a manifest of that name lists them.
    pub fn filling(self, folder: &Path, manifest: &'static str) -> Self {
        Self { folder: Some(folder.into()), manifest: Some(folder.join(manifest)), ..self }.hashing()
    }

    pub fn inputs(&self) -> &Inputs {
        &self.inputs
    }

    /// The inputs are to be read, and a manifest or an answer may list them.
    pub fn hashing(self) -> Self {
        Self { inputs: self.inputs.hashed(), ..self }
    }

    /// The results are called as `output`, with a suffix each where they are `several`; then `STEM-manifest.json` lists them, and
    /// where it lists some of an earlier run.
    ///
    /// # Errors
    /// As [`Outputs::planned`], of the manifest.
    pub fn beside(self, output: &Path, several: bool) -> Result<Self, Error> {
        destination::names_file(output)?;
        let manifest = with_suffix(output, "-manifest").with_extension("json");
        let is_used = several || manifest::listed(&manifest).is_ok_and(|listed| !listed.is_empty());
        let extension = Some(output.extension().unwrap_or_default().into());
        let manifest = is_used.then_some(manifest);
        let outputs = if is_used { self.hashing() } else { self };
        Self { manifest: manifest.clone(), extension, ..outputs }.all_planned(manifest)
    }

    /// Names an output that may be written later.
    ///
    /// # Errors
    /// [`Error::OutputIsInput`], and [`Error::Unwritable`] where no file can be put there.
    pub fn planned(self, path: &Path) -> Result<Self, Error> {
        match &self.folder {
            Some(own) if !own.exists() => makeable(own)?,
            Some(own) if !own.is_dir() => {
                let (path, reason) = (own.clone(), "it is there and is no folder".into());
                return Err(Error::Unwritable { path, reason, kind: ErrorKind::NotADirectory });
            }
            _ => {}
        }
        destination::names_file(path)?;
        let destination = destination::destination(path, &self.inputs)?;
        if self.folder.as_ref().is_none_or(|own| own.exists()) {
            std::fs::metadata(folder::of(&destination)).map_err(|error| Error::unwritable(path, &error))?;
        }
        Ok(self)
    }

    /// As [`Outputs::planned`], of several.
    pub fn all_planned(self, paths: impl IntoIterator<Item = PathBuf>) -> Result<Self, Error> {
        paths.into_iter().try_fold(self, |outputs, path| outputs.planned(&path))
    }

    /// As [`Outputs::planned`], of names in the folder of the results.
    pub fn planned_inside(self, names: impl IntoIterator<Item = String>) -> Result<Self, Error> {
        let paths: Vec<_> = names.into_iter().map(|name| self.inside(&name)).chain(self.manifest.clone()).collect();
        self.all_planned(paths)
    }

    /// Adds a file in the folder of the results.
    pub fn add_inside(&mut self, name: &str, content: impl Into<Vec<u8>>) {
        self.add(self.inside(name), content);
    }

    pub fn add(&mut self, path: impl Into<PathBuf>, content: impl Into<Vec<u8>>) {
        self.files.push((path.into(), content.into()));
    }

    /// Writes all files that were added, gives their paths; says what became of those of an earlier run.
    ///
    /// # Errors
    /// As [`Outputs::planned`], whether named before or not; then every file is as it was.
    pub fn write(self, observer: &dyn Observer) -> Result<Vec<PathBuf>, Error> {
        if self.files.is_empty() {
            return Ok(Vec::new());
        }
        let made = self.folder.as_deref().map_or(Ok(Vec::new()), made)?;
        self.replaced(observer).inspect_err(|_| unmade(&made))?;
        for parent in made.iter().filter_map(|folder| folder.parent()) {
            // What is in the new folder lies on disk; that its name does is best effort.
            let _ = folder::flush(parent);
        }
        Ok(self.files.into_iter().map(|(path, _)| path).chain(self.manifest).collect())
    }

    fn replaced(&self, observer: &dyn Observer) -> Result<(), Error> {
        let mut destinations = Vec::with_capacity(self.files.len() + 1);
        for path in self.files.iter().map(|(path, _)| path).chain(&self.manifest) {
            let destination = destination::destination(path, &self.inputs)?;
            if destinations.contains(&destination) {
                let reason = "another result of this command goes to the same file".into();
                return Err(Error::Unwritable { path: path.clone(), reason, kind: ErrorKind::Other });
            }
            destinations.push(destination);
        }
        let mut replacement =
            Replacement::in_folders(destinations.iter().map(|path| folder::of(path).into()).collect());
        let listing = match (&self.manifest, destinations.split_last()) {
            (Some(manifest), Some((path, files))) => {
                Some((path, self.prepare_manifest(manifest, path, files, &mut replacement)?))
            }
            _ => None,
        };
        for (path, (_, content)) in destinations.iter().zip(&self.files) {
            replacement.put(path, content)?;
        }
        if let Some((path, listing)) = &listing
            && !listing.manifest.is_concluded()
        {
            listing.stale.iter().try_for_each(|path| replacement.remove(path))?;
            replacement.put_again(path, listing.manifest.concluded().text().as_bytes())?;
        }
        replacement.commit()?;
        for note in listing.into_iter().flat_map(|(_, listing)| listing.notes) {
            observer.say(&note);
        }
        Ok(())
    }

    fn inside(&self, name: &str) -> PathBuf {
        self.folder.as_ref().map_or(name.into(), |folder| folder.join(name))
    }
}

/// Whether the manifest at `path` lists results that are still there.
pub fn lists_results(path: &Path) -> bool {
    let is_there = |name: &str| path.with_file_name(name).is_file();
    manifest::listed(path).is_ok_and(|listed| listed.iter().filter_map(manifest::Listed::plain_name).any(is_there))
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

    fn write(path: &Path, content: &str) -> Result<Vec<PathBuf>, Error> {
        let mut outputs = Outputs::of(Inputs::default());
        outputs.add(path, content);
        outputs.write(&crate::Silent)
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
        assert!(matches!(write(home.path(), "x"), Err(Error::Unwritable { .. })));
        assert!(matches!(write(Path::new("/dev/null"), "x"), Err(Error::Unwritable { .. })));
        // Two results behind links to one file: the second would take the place of the first.
        let mut outputs = Outputs::of(Inputs::default());
        outputs.add(&link, "one");
        outputs.add(&real, "two");
        assert!(matches!(outputs.write(&crate::Silent), Err(Error::Unwritable { .. })));
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
            let destination = destination::destination(&home.path().join("out/../out").join(name), &outputs.inputs)
                .expect("writable");
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
        assert!(matches!(outputs.write(&crate::Silent), Err(Error::Unwritable { .. })));
        assert!(!home.path().join("deep").exists());
    }

    /// Names where the process lives that replaces files until it is killed.
    #[cfg(unix)]
    const KILLED_IN: &str = "ORTHOPANEL_KILLED_IN";
    #[cfg(unix)]
    const RESULTS: usize = 8;

    /// Results full of one letter; `a` has one more than `b`.
    #[cfg(unix)]
    fn replace_by(letter: char, folder: &Path) -> Result<Vec<PathBuf>, Error> {
        let mut outputs = Outputs::of(Inputs::default()).filling(folder, "manifest.json");
        for number in 0..RESULTS + usize::from(letter == 'a') {
            outputs.add_inside(&format!("result-{number}"), letter.to_string().repeat(5000 + number));
        }
        outputs.write(&crate::Silent)
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
            let mut letters = std::collections::BTreeSet::new();
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
