//! The files that a command reads, none of which it may write.

use std::path::{Path, PathBuf};

use orthopanel_data::ImpactTest;

/// All files that a command reads, each once.
#[derive(Default)]
pub struct Inputs(Vec<PathBuf>);

impl Inputs {
    pub fn of(path: &Path) -> Self {
        Self(vec![path.into()])
    }

    /// The test file at `path`, or in the folder there, and every file that it names.
    pub fn of_test(path: &Path, test: &ImpactTest) -> Self {
        test.files().fold(Self::of(&ImpactTest::file_at(path)), |inputs, file| inputs.and(file))
    }

    pub fn and(mut self, path: &Path) -> Self {
        if !self.0.iter().any(|known| known == path) {
            self.0.push(path.into());
        }
        self
    }

    pub fn and_all(self, others: Self) -> Self {
        others.0.iter().fold(self, |inputs, path| inputs.and(path))
    }

    /// As the command names them.
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        self.0.iter().map(PathBuf::as_path)
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
