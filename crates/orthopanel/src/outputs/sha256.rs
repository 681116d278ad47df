//! SHA-256 of files.

use std::io::Read as _;
use std::path::Path;

use sha2::{Digest as _, Sha256};

/// Of a file as it lies.
pub(super) fn sha256_of(path: &Path) -> std::io::Result<String> {
    let (mut file, mut hash, mut part) = (std::fs::File::open(path)?, Sha256::new(), vec![0; 1 << 16]);
    loop {
        match file.read(&mut part)? {
            0 => return Ok(hexadecimal(hash.finalize().as_slice())),
            length => hash.update(part.get(..length).unwrap_or_default()),
        }
    }
}

pub(super) fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
