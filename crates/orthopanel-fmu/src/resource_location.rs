//! FMI 2 gives the place of the resources as a URI, FMI 3 as a native path.

use std::path::PathBuf;

use percent_encoding::percent_decode_str;

use crate::FmuError;

/// The folder behind an FMI 2 `fmuResourceLocation`: `file:///path`, `file://localhost/path` or `file:/path`,
/// percent-encoded UTF-8. A plain absolute path is taken as it stands, for importers that pass one.
///
/// # Errors
/// [`FmuError::Location`] for another scheme or host, or where the decoded path is not UTF-8.
pub(crate) fn from_uri(location: &str) -> Result<PathBuf, FmuError> {
    let fail = |reason| FmuError::Location { location: location.into(), reason };
    let Some((_, rest)) = location.split_once(':').filter(|(scheme, _)| scheme.eq_ignore_ascii_case("file")) else {
        let path = PathBuf::from(location);
        return if path.is_absolute() { Ok(path) } else { Err(fail("must be a file: URI, as file:///path/resources")) };
    };
    let path = match rest.strip_prefix("//") {
        Some(authority) => {
            let start = authority.find('/').ok_or_else(|| fail("has no path behind file://"))?;
            let (host, path) = authority.split_at(start);
            if !(host.is_empty() || host.eq_ignore_ascii_case("localhost")) {
                return Err(fail("names another machine: resources must lie on this one"));
            }
            path
        }
        None => rest,
    };
    let path = percent_decode_str(path).decode_utf8().map_err(|_| fail("is not UTF-8 once percent-decoded"))?;
    if path.contains('\0') {
        return Err(fail("holds a NUL character"));
    }
    // file:///C:/folder: the slash before a drive letter is not part of a Windows path.
    let path = if cfg!(windows) { path.trim_start_matches('/') } else { &path };
    Ok(PathBuf::from(path))
}

/// The folder behind an FMI 3 `resourcePath`: a native absolute path, with or without a separator at its end.
///
/// # Errors
/// [`FmuError::Location`] where it is empty.
pub(crate) fn from_path(location: &str) -> Result<PathBuf, FmuError> {
    if location.is_empty() {
        return Err(FmuError::Location { location: location.into(), reason: "is empty" });
    }
    Ok(PathBuf::from(location))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_uri_forms_of_rfc_8089_name_the_same_path() {
        for uri in ["file:///a/b", "file:/a/b", "file://localhost/a/b", "FILE://LOCALHOST/a/b", "/a/b"] {
            assert_eq!(from_uri(uri).expect(uri), PathBuf::from("/a/b"), "{uri}");
        }
    }

    #[test]
    fn blanks_per_cent_signs_and_non_ascii_are_decoded() {
        let path = from_uri("file:///a%20b/50%25/%C3%BC%E6%9D%BF/r").expect("a sound URI");
        assert_eq!(path, PathBuf::from("/a b/50%/ü板/r"));
        assert_eq!(from_uri("file:///a b/ü").expect("not encoded"), PathBuf::from("/a b/ü"));
    }

    #[test]
    fn other_schemes_hosts_and_bytes_are_refused() {
        for uri in ["http://host/a", "relative/path", "file://server/a", "file://", "", "file:///%FF", "file:///%00"] {
            assert!(matches!(from_uri(uri), Err(FmuError::Location { .. })), "{uri}");
        }
        assert!(from_path("").is_err());
    }
}
