//! FMI 2 gives the place of the resources as a URI, FMI 3 as a native path.

use std::path::PathBuf;

use percent_encoding::percent_decode_str;

use crate::FmuError;

/// The folder behind an FMI 2 `fmuResourceLocation`: `file:///path`, `file://localhost/path` or `file:/path`,
/// percent-encoded UTF-8; on Windows also `file:///C:/path`, and of a share `file:////server/share/path` or `file://server/share/path`.
/// A plain absolute path is taken as it stands, for importers that pass one.
///
/// # Errors
/// [`FmuError::Location`] for another scheme, on other systems for another host, or where the decoded path is not UTF-8.
pub(crate) fn from_uri(location: &str) -> Result<PathBuf, FmuError> {
    if scheme_and_rest(location).is_none() {
        let (path, reason) = (PathBuf::from(location), "must be a file: URI, as file:///path/resources");
        let location = location.into();
        return if path.is_absolute() { Ok(path) } else { Err(FmuError::Location { location, reason }) };
    }
    path_of(location, cfg!(windows)).map(PathBuf::from)
}

/// The scheme `file` and what follows it.
fn scheme_and_rest(location: &str) -> Option<(&str, &str)> {
    location.split_once(':').filter(|(scheme, _)| scheme.eq_ignore_ascii_case("file"))
}

/// The path of a `file` URI, as Windows or other systems write it.
fn path_of(location: &str, windows: bool) -> Result<String, FmuError> {
    let fail = |reason| FmuError::Location { location: location.into(), reason };
    let (_, rest) = scheme_and_rest(location).unwrap_or_default();
    let mut server = "";
    let path = match rest.strip_prefix("//") {
        Some(authority) => {
            let start = authority.find('/').ok_or_else(|| fail("has no path behind file://"))?;
            let (host, path) = authority.split_at(start);
            if !host.eq_ignore_ascii_case("localhost") {
                server = host;
            }
            if !(windows || server.is_empty()) {
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
    if !windows {
        return Ok(path.into_owned());
    }
    if !server.is_empty() {
        return Ok(format!("//{server}{path}"));
    }
    let bare = path.trim_start_matches('/');
    let of_drive = matches!(bare.as_bytes(), [letter, b':', ..] if letter.is_ascii_alphabetic());
    // file:///C:/folder: the slash before a drive letter is not part of a Windows path; two before a server are.
    Ok(if of_drive || !path.starts_with("//") { bare.into() } else { format!("//{bare}") })
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
    fn val_windows_has_drives_and_shares() {
        for (uri, path) in [
            ("file:///C:/a%20b/%C3%BC/resources", "C:/a b/ü/resources"),
            ("file:/C:/a", "C:/a"),
            ("file://localhost/d:/a", "d:/a"),
            ("file:////server/share/%C3%A4/resources", "//server/share/ä/resources"),
            ("file://///server/share/a", "//server/share/a"),
            ("file://server/share/a", "//server/share/a"),
        ] {
            assert_eq!(path_of(uri, true).expect(uri), path, "{uri}");
        }
    }

    #[test]
    fn other_schemes_hosts_and_bytes_are_refused() {
        for uri in ["http://host/a", "relative/path", "file://server/a", "file://", "", "file:///%FF", "file:///%00"] {
            assert!(matches!(from_uri(uri), Err(FmuError::Location { .. })), "{uri}");
        }
        assert!(from_path("").is_err());
    }
}
