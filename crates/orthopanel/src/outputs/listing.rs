//! What the manifest of several results brings about: earlier ones are removed, and what somebody changed is kept.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::inputs::is_same;
use super::manifest::{self, Listed, Manifest};
use super::replacement::Replacement;
use super::sha256::sha256_of;
use super::{Outputs, with_suffix};
use crate::error::Error;

/// What a manifest tells and brings about.
pub(super) struct Listing {
    pub manifest: Manifest,
    /// Files to remove.
    pub stale: Vec<PathBuf>,
    /// What to say when all is done.
    pub notes: Vec<String>,
}

impl Outputs {
    /// Prepares the manifest, which goes to `path`, as the first change, and copies of results that somebody changed.
    pub(super) fn prepare_manifest(
        &self,
        manifest: &Path,
        path: &Path,
        destinations: &[PathBuf],
        replacement: &mut Replacement,
    ) -> Result<Listing, Error> {
        let mut notes = Vec::new();
        let earlier = match manifest::listed(path) {
            Ok(listed) => listed,
            Err(problem) => {
                let kept = free_name(|number| with_suffix(path, &format!("-{number}")));
                notes.push(format!(
                    "note: {}: no manifest of orthopanel, kept as {}; what earlier runs left is not removed: {problem}",
                    manifest.display(),
                    kept.display()
                ));
                replacement.copy(path, &kept)?;
                Vec::new()
            }
        };
        let is_own = |listed: &Listed| {
            let extension = Path::new(&listed.file).extension().unwrap_or_default();
            self.extension.as_ref().is_none_or(|own| own == extension)
        };
        let (earlier, others): (Vec<_>, Vec<_>) = earlier.into_iter().partition(is_own);
        let name = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let mut files: Vec<Listed> =
            self.files.iter().map(|(path, content)| Listed::of(&name(path), content)).collect();
        for ((file, destination), (path, _)) in files.iter().zip(destinations).zip(&self.files) {
            let is_known = |sha256: &String| {
                let known = earlier.iter().filter(|listed| listed.file == file.file).chain([file]);
                known.into_iter().any(|listed| listed.sha256 == *sha256)
            };
            if sha256_of(destination).is_ok_and(|sha256| !is_known(&sha256)) {
                let kept = free_name(|number| edited(destination, number));
                replacement.copy(destination, &kept)?;
                let (path, kept) = (path.display(), kept.display());
                notes.push(format!("note: {path}: changed since an earlier run, or none wrote it; kept as {kept}"));
            }
        }
        let stale = self.stale(manifest, &earlier, &files, destinations, &mut notes);
        let mut replacing = earlier;
        replacing.retain(|listed| !files.contains(listed));
        files.extend(others);
        let manifest = Manifest::new(&self.command, &self.inputs, files, replacing)?;
        replacement.put(path, manifest.text().as_bytes())?;
        Ok(Listing { manifest, stale, notes })
    }

    /// The files of earlier runs that this one does not write and that are as they were left.
    fn stale(
        &self,
        manifest: &Path,
        earlier: &[Listed],
        files: &[Listed],
        destinations: &[PathBuf],
        notes: &mut Vec<String>,
    ) -> Vec<PathBuf> {
        let is_written = |name: &str| files.iter().any(|file| file.file == name);
        let names: BTreeSet<&str> = earlier.iter().filter_map(Listed::plain_name).collect();
        let mut stale = Vec::new();
        for name in names.into_iter().filter(|name| !is_written(name)) {
            let path = manifest.with_file_name(name);
            let is_file = std::fs::symlink_metadata(&path).is_ok_and(|found| found.is_file());
            if !is_file || destinations.iter().any(|destination| is_same(destination, &path)) {
                continue;
            }
            let sha256 = sha256_of(&path).ok();
            let is_as_left =
                earlier.iter().any(|listed| listed.file == name && Some(&listed.sha256) == sha256.as_ref());
            if is_as_left && self.inputs.at(&path).is_none() {
                notes.push(format!("removed {}, left by an earlier run", path.display()));
                stale.push(path);
            } else {
                let why = if is_as_left { "this command reads it" } else { "it was changed since" };
                notes.push(format!("note: {}: left by an earlier run, and kept: {why}", path.display()));
            }
        }
        stale
    }
}

/// The first of the names numbered from 1 that no file has.
fn free_name(numbered: impl Fn(u64) -> PathBuf) -> PathBuf {
    (1..u64::MAX).map(numbered).find(|name| std::fs::symlink_metadata(name).is_err()).unwrap_or_default()
}

/// `path.edited`, from the second on `path.edited-NUMBER`: no name of a result.
fn edited(path: &Path, number: u64) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(if number == 1 { ".edited".into() } else { format!(".edited-{number}") });
    name.into()
}
