//! Tests of a lot, one after the other on every core; what is known already is kept.

use std::path::{Path, PathBuf};
use std::sync::Mutex;

use orthopanel_data::ImpactTest;
use orthopanel_identify::Settings;
use rayon::prelude::*;
use sha2::{Digest as _, Sha256};

use super::LotRow;
use crate::outputs::Inputs;
use crate::{Analysis, Error, Silent, Test};

/// Tests to be identified and traced.
pub struct Batch {
    tests: Vec<PathBuf>,
    known: Vec<LotRow>,
}

impl Batch {
    /// Of these test files, with the rows of an earlier batch, which is so resumed: of a test whose files and version are as they were
    /// its rows are kept.
    pub fn new(tests: Vec<PathBuf>, known: Vec<LotRow>) -> Self {
        Self { tests, known }
    }

    /// How many tests there are.
    pub fn len(&self) -> usize {
        self.tests.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.tests.is_empty()
    }

    /// The rows of all tests, in their order. After each test `done` is told how many are done, and what gives the rows so far, the known ones of
    /// tests that are still to come among them: whoever writes them loses nothing.
    pub fn run(&self, done: impl Fn(usize, &dyn Fn() -> Vec<LotRow>) + Sync) -> Vec<LotRow> {
        let found: Mutex<Vec<Option<Vec<LotRow>>>> = Mutex::new(vec![None; self.tests.len()]);
        let lock = || found.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let of_test = |(rows, test): (&Option<Vec<LotRow>>, &PathBuf)| {
            let known = || self.known.iter().filter(|row| row.test == named(test)).cloned().collect();
            rows.clone().unwrap_or_else(known)
        };
        let so_far =
            |found: &[Option<Vec<LotRow>>]| found.iter().zip(&self.tests).flat_map(of_test).collect::<Vec<_>>();
        self.tests.par_iter().enumerate().for_each(|(index, test)| {
            let rows = self.rows(test);
            let mut found = lock();
            found[index] = Some(rows);
            done(found.iter().flatten().count(), &|| so_far(&found));
        });
        so_far(&lock())
    }

    fn rows(&self, path: &Path) -> Vec<LotRow> {
        let file = ImpactTest::file_at(path);
        let called =
            if file.file_stem().is_some_and(|stem| stem == "test") { file.parent() } else { Some(file.as_path()) };
        let common = LotRow {
            panel: called
                .and_then(Path::file_stem)
                .map_or_else(String::new, |name| name.to_string_lossy().into_owned()),
            test: named(path),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            ..LotRow::default()
        };
        let (inputs, test) = match Inputs::reading_test(path) {
            Ok(read) => read,
            Err(error) => return vec![LotRow::refused(&common, &error)],
        };
        let common = match inputs.unchanged() {
            Ok(hashes) => LotRow { sha256: digest(hashes.iter().map(|(_, hash)| hash.as_str())), ..common },
            Err(error) => return vec![LotRow::refused(&common, &error)],
        };
        let is_same =
            |row: &&LotRow| (&row.test, &row.sha256, &row.version) == (&common.test, &common.sha256, &common.version);
        let known: Vec<LotRow> = self.known.iter().filter(is_same).cloned().collect();
        if known.is_empty() {
            found(&test, &common).unwrap_or_else(|error| vec![LotRow::refused(&common, &error)])
        } else {
            known
        }
    }
}

/// A test as its rows have it.
fn named(test: &Path) -> String {
    test.display().to_string()
}

fn found(test: &Test, common: &LotRow) -> Result<Vec<LotRow>, Error> {
    let analysis = Analysis::of(test, None, Settings::default(), &Silent)?;
    let rows = LotRow::of(common, &analysis);
    // Where nothing explains the records, the refusal stands.
    if rows.is_empty() { analysis.end().map(|()| rows) } else { Ok(rows) }
}

fn digest<'a>(hashes: impl Iterator<Item = &'a str>) -> String {
    let mut digest = Sha256::new();
    hashes.for_each(|hash| digest.update(hash));
    digest.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Test files: a file as it is, of a folder every `test.toml` in it and below, in the order of their names.
///
/// # Errors
/// [`Error::Unreadable`].
pub fn tests_in(paths: &[PathBuf]) -> Result<Vec<PathBuf>, Error> {
    let mut tests = Vec::new();
    for path in paths {
        if path.is_dir() {
            gather(path, &mut tests)?;
        } else {
            tests.push(path.clone());
        }
    }
    Ok(tests)
}

fn gather(folder: &Path, tests: &mut Vec<PathBuf>) -> Result<(), Error> {
    let unreadable = |source| Error::Unreadable { path: folder.into(), source };
    let entries = std::fs::read_dir(folder).map_err(unreadable)?.collect::<Result<Vec<_>, _>>().map_err(unreadable)?;
    let mut entries: Vec<_> = entries.into_iter().map(|entry| (entry.file_type(), entry.path())).collect();
    entries.sort_by(|(_, one), (_, other)| one.cmp(other));
    for (kind, path) in entries {
        // No link is followed into a folder: it may lead back.
        if kind.is_ok_and(|kind| kind.is_dir()) {
            gather(&path, tests)?;
        } else if path.file_name().is_some_and(|name| name == "test.toml") {
            tests.push(path);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_under_way_keeps_known_rows_of_tests_to_come() {
        let tests = ["piece-1", "piece-3"].map(|name| PathBuf::from("../../examples").join(name)).to_vec();
        let known = Batch::new(tests.clone(), vec![]).run(|_, _| ());
        assert!(known.len() == 2 && known.iter().all(|row| row.failed.is_none()), "{known:?}");
        Batch::new(tests, known.clone()).run(|_, rows| assert_eq!(rows(), known));
    }
}
