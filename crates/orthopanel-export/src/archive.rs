//! The zip archive: the same content gives the same bytes.

use std::io::{Cursor, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use crate::ExportError;

/// One file of the archive.
pub(crate) struct Entry<'a> {
    pub path: String,
    pub content: &'a [u8],
    /// Some importers unpack with the permissions of the archive and then want to run the library.
    pub executable: bool,
}

/// Packs `entries` in their order, dated 1980-01-01.
pub(crate) fn pack(entries: &[Entry]) -> Result<Vec<u8>, ExportError> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    for entry in entries {
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Deflated)
            .last_modified_time(DateTime::default())
            .unix_permissions(if entry.executable { 0o755 } else { 0o644 });
        archive.start_file(entry.path.as_str(), options).map_err(assemble)?;
        archive.write_all(entry.content).map_err(assemble)?;
    }
    Ok(archive.finish().map_err(assemble)?.into_inner())
}

fn assemble(error: impl std::fmt::Display) -> ExportError {
    ExportError::Assemble(error.to_string())
}
