//! A test: what was measured on which pieces, from a file or from memory.

use std::path::{Path, PathBuf};

use orthopanel_data::{ImpactTest, Measurement};

use crate::suffixes::suffixes;
use crate::{Error, given_file};

/// What messages call a test without a file.
const IN_MEMORY: &str = "the test in memory";

/// A hammer test, read and checked.
///
/// # Examples
/// ```
/// let test = orthopanel::Test::load("../../examples/piece-1/test.toml")?;
/// let fit = test.identify()?;
/// let e_x = fit.constant("e_x").expect("a beam has it");
/// // The paper's table 4.
/// assert!((e_x.value / 1.07e10 - 1.0).abs() < 1e-3);
/// # Ok::<(), orthopanel::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Test {
    content: ImpactTest,
    path: PathBuf,
}

impl Test {
    /// Reads the test file at `path`; a folder stands for the `test.toml` in it. Records that it names are read when they are needed.
    ///
    /// # Errors
    /// [`Error::Data`] with file, line and key, and [`Error::OtherKind`] for a file that is something else.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        Ok(Self { content: given_file::read_test(path)?, path: path.into() })
    }

    /// Reads the text of a test file; `path` names it in messages, and files that it names are looked for beside it.
    ///
    /// # Errors
    /// [`Error::Data`] with line and key.
    ///
    /// # Examples
    /// ```
    /// let text = "
    ///     [piece]
    ///     length = 0.8          # m
    ///     width = 0.1           # m
    ///     thickness = 0.03      # m
    ///     mass_per_area = 6.88  # kg/m2
    ///     [[measurement]]
    ///     kind = 'natural-frequencies'
    ///     values = [321.3, 837.5, 1520.0, 2312.5, 3150.0, 3987.5] # Hz
    /// ";
    /// let test = orthopanel::Test::from_toml(text, "piece-1")?;
    /// assert_eq!(test.identify()?.models().len(), 1);
    /// # Ok::<(), orthopanel::Error>(())
    /// ```
    pub fn from_toml(text: &str, path: impl Into<PathBuf>) -> Result<Self, Error> {
        let path = path.into();
        Ok(Self { content: ImpactTest::from_toml(text, &path)?, path })
    }

    /// A test that was put together in memory, checked as one of a file; measurements may be [added](Test::add).
    ///
    /// # Errors
    /// [`Error::Data`] with the key.
    ///
    /// # Examples
    /// ```
    /// use orthopanel::data::{ImpactTest, Measurement, MeasurementData, NamedPiece, RecordedResponse};
    /// use orthopanel::{Piece, Place, Test};
    ///
    /// let piece = Piece { length: 0.8, width: 0.1, thickness: 0.03, mass_per_area: 6.88 };
    /// let mut test = Test::of(ImpactTest { pieces: vec![NamedPiece::new("strip", piece)], ..ImpactTest::default() })?;
    /// let (force, acceleration) = (vec![vec![0.0; 4096]; 2], vec![vec![0.0; 4096]; 2]); // hits x samples
    /// let places = [Place { x: -0.3, y: 0.0 }, Place { x: 0.3, y: 0.0 }];
    /// let hits = RecordedResponse::of_hits([force, acceleration], 10_240.0, places)?;
    /// test.add(Measurement { piece: 0, data: MeasurementData::TimeHistory(hits) })?;
    /// // Nobody hit it.
    /// assert!(test.identify().is_err());
    /// # Ok::<(), orthopanel::Error>(())
    /// ```
    pub fn of(content: ImpactTest) -> Result<Self, Error> {
        Ok(Self { content: content.checked()?, path: IN_MEMORY.into() })
    }

    /// Adds a measurement: arrays, natural frequencies, or files.
    ///
    /// # Errors
    /// [`Error::Data`] with the key; then the test is as it was.
    pub fn add(&mut self, measurement: Measurement) -> Result<(), Error> {
        Ok(self.content.add(measurement)?)
    }

    /// What was tested, how it was held, and what was measured.
    pub fn content(&self) -> &ImpactTest {
        &self.content
    }

    /// `-NAME` of each piece where there are several, safe in file names; nothing for a single one.
    pub fn suffixes(&self) -> impl Iterator<Item = String> {
        suffixes(&self.content)
    }

    /// As the test was named.
    pub fn path(&self) -> &Path {
        &self.path
    }
}
