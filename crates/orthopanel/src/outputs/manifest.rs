//! The list of what belongs to a run, beside its results: `orthopanel.manifest/1`.
//!
//! While files are replaced, it lists the earlier ones too, so that none of a run that was killed is forgotten. It holds
//! no time; the date stands in `identified.json` and `trace.json`: two runs of the same inputs differ in these alone, and in nothing
//! where `SOURCE_DATE_EPOCH` tells the date.

use std::io::Read as _;
use std::path::Path;

use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};

use super::inputs::Inputs;
use super::sha256::hexadecimal;
use crate::error::Error;
use crate::json;

const SCHEMA: &str = "orthopanel.manifest/1";

/// Far more than the lists of any test take.
const LONGEST: u64 = 1 << 26;

#[derive(Clone, Serialize)]
pub struct Manifest {
    schema: &'static str,
    /// The words after the program's name.
    command: Vec<String>,
    version: &'static str,
    inputs: Vec<Listed>,
    files: Vec<Listed>,
    /// Files of earlier runs that this one is replacing.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    replacing: Vec<Listed>,
}

/// A file and what was in it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Listed {
    /// Of an input its path as the command reads it, of a result its name in the folder.
    pub file: String,
    /// Hexadecimal.
    pub sha256: String,
}

impl Manifest {
    /// Of a command of these words.
    ///
    /// # Errors
    /// As [`Inputs::unchanged`].
    pub fn new(command: &[String], inputs: &Inputs, files: Vec<Listed>, replacing: Vec<Listed>) -> Result<Self, Error> {
        let listed = |(path, sha256): (&Path, String)| Listed { file: path.to_string_lossy().into_owned(), sha256 };
        Ok(Self {
            schema: SCHEMA,
            command: command.to_vec(),
            version: env!("CARGO_PKG_VERSION"),
            inputs: inputs.unchanged()?.into_iter().map(listed).collect(),
            files,
            replacing,
        })
    }

    pub fn text(&self) -> String {
        json::laid_out(self)
    }

    /// When all earlier files are replaced.
    pub fn concluded(&self) -> Self {
        Self { replacing: Vec::new(), ..self.clone() }
    }

    pub fn is_concluded(&self) -> bool {
        self.replacing.is_empty()
    }
}

/// What an earlier manifest lists.
#[derive(Deserialize)]
struct Earlier {
    schema: String,
    files: Vec<Listed>,
    #[serde(default)]
    replacing: Vec<Listed>,
}

/// The results that the manifest at `path` lists, none where there is no manifest.
///
/// # Errors
/// Why it is none that this version can read.
pub fn listed(path: &Path) -> Result<Vec<Listed>, String> {
    let text = match std::fs::File::open(path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Vec::new()),
        opened => opened.and_then(|file| {
            let mut text = String::new();
            file.take(LONGEST).read_to_string(&mut text).map(|_| text)
        }),
    };
    let text = text.map_err(|error| error.to_string())?;
    let earlier: Earlier = serde_json::from_str(&text).map_err(|error| error.to_string())?;
    if earlier.schema != SCHEMA {
        return Err(format!("its schema is {:?}, not {SCHEMA:?}", earlier.schema));
    }
    Ok(earlier.files.into_iter().chain(earlier.replacing).collect())
}

impl Listed {
    pub fn of(file: &str, content: &[u8]) -> Self {
        Self { file: file.into(), sha256: hexadecimal(Sha256::digest(content).as_slice()) }
    }

    /// The name, where it is that of a file in the folder itself.
    pub fn plain_name(&self) -> Option<&str> {
        let name = Path::new(&self.file);
        (name.file_name() == Some(name.as_os_str()) && !self.file.contains(['/', '\\', ':'])).then_some(&self.file)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_the_digest_is_that_of_fips_180() {
        // FIPS 180-4, the example "abc".
        let digest = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(Listed::of("x", b"abc").sha256, digest);
    }

    #[test]
    fn only_names_in_the_folder_itself_are_plain() {
        let plain = |name: &str| Listed { file: name.into(), sha256: String::new() }.plain_name().is_some();
        assert!(plain("model-a%2Fb.json") && plain("..csv"));
        for name in ["", ".", "..", "../x", "a/b", "/x", "a/", "./x", "C:x", "a\\b"] {
            assert!(!plain(name), "{name:?}");
        }
    }
}
