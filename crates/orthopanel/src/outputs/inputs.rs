//! The files that a command reads, none of which it may write.

use std::path::{Path, PathBuf};

use orthopanel_data::{ImpactTest, limits};

use super::sha256::sha256_of;
use crate::{Error, Test};

/// All files that a command reads, each once.
#[derive(Default)]
pub struct Inputs(Vec<Input>);

struct Input {
    path: PathBuf,
    /// Before it was read, where it was asked for.
    sha256: Option<String>,
}

impl Inputs {
    pub fn of(path: &Path) -> Self {
        Self::default().and(path)
    }

    /// Reads the test at `path`, or in the folder there; the inputs are its file and every file that it names.
    ///
    /// # Errors
    /// As [`Test::load`].
    pub fn reading_test(path: &Path) -> Result<(Self, Test), Error> {
        let inputs = Self::of(&ImpactTest::file_at(path)).hashed();
        let test = Test::load(path)?;
        let inputs = test.content().files().fold(inputs, Self::and);
        Ok((inputs, test))
    }

    pub fn and(mut self, path: &Path) -> Self {
        if !self.paths().any(|known| known == path) {
            self.0.push(Input { path: path.into(), sha256: None });
        }
        self
    }

    pub fn and_all(self, others: Self) -> Self {
        others.0.into_iter().fold(self, |mut inputs, other| {
            if !inputs.paths().any(|known| known == other.path) {
                inputs.0.push(other);
            }
            inputs
        })
    }

    /// As the command names them.
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        self.0.iter().map(|input| input.path.as_path())
    }

    /// Takes the SHA-256 of each before it is read; what cannot be read is refused by its reader.
    pub fn hashed(mut self) -> Self {
        let is_read = |found: std::fs::Metadata| found.is_file() && found.len() <= limits::RECORD_FILE.most_bytes;
        for input in self.0.iter_mut().filter(|input| input.sha256.is_none()) {
            // Nothing that may never end.
            if std::fs::metadata(&input.path).is_ok_and(is_read) {
                input.sha256 = sha256_of(&input.path).ok();
            }
        }
        self
    }

    /// Each with the SHA-256 of what was read.
    ///
    /// # Errors
    /// [`Error::Changed`] where a file is another than before it was read, [`Error::Unreadable`].
    pub fn unchanged(&self) -> Result<Vec<(&Path, String)>, Error> {
        let unchanged = |Input { path, sha256: before }: &'_ Input| {
            let now = sha256_of(path).map_err(|source| Error::Unreadable { path: path.clone(), source })?;
            match before {
                Some(before) if *before != now => Err(Error::Changed { path: path.clone() }),
                _ => Ok(now),
            }
        };
        self.0.iter().map(|input| Ok((input.path.as_path(), unchanged(input)?))).collect()
    }

    /// The input that lies at `path`, under whatever name: through links, hard links, and other spellings.
    pub fn at(&self, path: &Path) -> Option<&Path> {
        self.paths().find(|input| is_same(input, path))
    }
}

/// Whether both are there and one and the same regular file.
pub fn is_same(one: &Path, other: &Path) -> bool {
    let size = |path: &Path| std::fs::metadata(path).ok().filter(std::fs::Metadata::is_file).map(|found| found.len());
    // The size, which costs no opening, parts nearly all.
    let (one_size, other_size) = (size(one), size(other));
    one_size.is_some() && one_size == other_size && same_file::is_same_file(one, other).unwrap_or(false)
}
