//! Files that a person names: regular ones, of a size that is told before they are read.

use std::{
    fs::{self, File, FileType, Metadata},
    io::{self, Read as _},
    path::Path,
};

/// What a file is read as, and how large it may be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct InputKind {
    /// In messages, such as `a test file`.
    pub name: &'static str,
    /// Bytes at most.
    pub most_bytes: u64,
}

impl InputKind {
    /// The bytes of a file of this kind.
    ///
    /// # Errors
    /// As [`regular_file`], and where the file is too large, with its size and the limit.
    pub fn read(self, path: &Path) -> io::Result<Vec<u8>> {
        self.check(&regular_file(path)?)?;
        let mut bytes = Vec::new();
        // One more than may be there: a file may grow, or lie about its size as those of the system do.
        File::open(path)?.take(self.most_bytes + 1).read_to_end(&mut bytes)?;
        let found = bytes.len() as u64;
        if found > self.most_bytes {
            Err(self.too_large(format!("more than {} bytes", self.most_bytes)))
        } else {
            Ok(bytes)
        }
    }

    /// The text of a file of this kind, without a byte order mark.
    ///
    /// # Errors
    /// As [`InputKind::read`], and where the file is not UTF-8.
    pub fn read_text(self, path: &Path) -> io::Result<String> {
        let bytes = self.read(path)?;
        let text = String::from_utf8(bytes).map_err(|error| {
            let at = error.utf8_error().valid_up_to();
            io::Error::new(io::ErrorKind::InvalidData, format!("byte {at} is not UTF-8 text: save the file as UTF-8"))
        })?;
        Ok(text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text))
    }

    /// Refuses a file that is too large.
    ///
    /// # Errors
    /// With the size and the limit.
    pub fn check(self, file: &Metadata) -> io::Result<()> {
        if file.len() <= self.most_bytes { Ok(()) } else { Err(self.too_large(format!("{} bytes", file.len()))) }
    }

    fn too_large(self, found: String) -> io::Error {
        let Self { name, most_bytes } = self;
        let problem = format!("it has {found}, and {name} may have {most_bytes}: is it the right file? else split it");
        io::Error::new(io::ErrorKind::FileTooLarge, problem)
    }
}

/// What the system tells of a file; links are followed.
///
/// # Errors
/// Where nothing is there or may be seen, and for what is no regular file: a pipe may never end, a device gives what it likes, and
/// opening one may wait for ever.
pub fn regular_file(path: &Path) -> io::Result<Metadata> {
    let found = fs::metadata(path)?;
    if found.is_file() {
        return Ok(found);
    }
    let kind = name_of(found.file_type());
    Err(io::Error::new(io::ErrorKind::InvalidInput, format!("it is {kind}, not a file: name a file on disk")))
}

fn name_of(kind: FileType) -> &'static str {
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt as _;
        if kind.is_fifo() {
            return "a pipe";
        }
        if kind.is_char_device() || kind.is_block_device() {
            return "a device";
        }
        if kind.is_socket() {
            return "a socket";
        }
    }
    if kind.is_dir() { "a folder" } else { "something else" }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SMALL: InputKind = InputKind { name: "a small file", most_bytes: 8 };

    #[test]
    fn a_file_of_the_greatest_size_is_read_and_one_byte_more_is_refused() {
        let home = tempfile::tempdir().expect("a temporary folder");
        let path = home.path().join("input");
        std::fs::write(&path, "12345678").expect("written");
        assert_eq!(SMALL.read(&path).expect("read"), b"12345678");
        std::fs::write(&path, "123456789").expect("written");
        let said = SMALL.read(&path).expect_err("too large").to_string();
        assert!(said.contains("9 bytes") && said.contains("a small file may have 8"), "{said}");
    }

    #[test]
    fn a_byte_order_mark_is_no_text() {
        let home = tempfile::tempdir().expect("a temporary folder");
        let path = home.path().join("input");
        std::fs::write(&path, "\u{feff}12345").expect("written");
        assert_eq!(SMALL.read_text(&path).expect("read"), "12345");
        std::fs::write(&path, b"ab\xff").expect("written");
        assert!(SMALL.read_text(&path).expect_err("Latin 1").to_string().starts_with("byte 2 is not UTF-8"));
    }

    #[cfg(unix)]
    #[test]
    fn folders_and_devices_are_refused_by_name() {
        let home = tempfile::tempdir().expect("a temporary folder");
        for (path, kind) in [(home.path(), "a folder"), (Path::new("/dev/zero"), "a device")] {
            let said = SMALL.read(path).expect_err("no file").to_string();
            assert!(said.contains(kind) && said.contains("not a file"), "{said}");
        }
    }
}
