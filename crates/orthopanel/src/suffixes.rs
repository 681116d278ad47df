//! What tells the files of several pieces of a test apart.

use orthopanel_data::{ImpactTest, NamedPiece};

/// `-NAME` of one of several pieces, safe in file names; nothing for a single one.
///
/// A long name is cut. One that was cut, one that differs from another piece's by capitals alone, which are the same to some
/// systems, and one that would be the manifest's, ends in its checksum.
pub fn suffix(name: &str, pieces: &[NamedPiece]) -> String {
    if pieces.len() <= 1 {
        return String::new();
    }
    let part = file_name_part(name);
    let is_alike = |other: &&NamedPiece| file_name_part(&other.name).eq_ignore_ascii_case(&part);
    let is_manifest = part.eq_ignore_ascii_case("manifest");
    if part.len() <= LONGEST_PART && !is_manifest && pieces.iter().filter(is_alike).count() <= 1 {
        return format!("-{part}");
    }
    let cut = part.get(..LONGEST_PART).unwrap_or(&part);
    format!("-{cut}-{:08x}", checksum(name))
}

/// That of every piece of a test.
pub fn suffixes(test: &ImpactTest) -> impl Iterator<Item = String> {
    test.pieces.iter().map(|piece| suffix(&piece.name, &test.pieces))
}

/// Bytes of a file's name that a piece's name may take: systems allow 255 for the whole.
const LONGEST_PART: usize = 100;

/// FNV-1a (RFC 9923) of 32 bits.
fn checksum(name: &str) -> u32 {
    name.bytes().fold(0x811c_9dc5, |hash, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193))
}

/// A name as part of a file name: letters, digits, `-` and `_` stay, every other byte becomes `%XX`.
fn file_name_part(name: &str) -> String {
    let part = |byte: u8| match byte {
        b'-' | b'_' => char::from(byte).to_string(),
        _ if byte.is_ascii_alphanumeric() => char::from(byte).to_string(),
        _ => format!("%{byte:02X}"),
    };
    name.bytes().map(part).collect()
}

#[cfg(test)]
mod tests {
    use orthopanel_model::Piece;

    use super::*;

    #[test]
    fn file_names_stay_in_their_folder_and_apart() {
        assert_eq!(file_name_part("piece_2-a"), "piece_2-a");
        assert_eq!(file_name_part("../x"), "%2E%2E%2Fx");
        assert_ne!(file_name_part("a/b"), file_name_part("a_b"));
    }

    #[test]
    fn names_of_files_are_short_and_differ_by_more_than_capitals() {
        let piece = Piece { length: 0.8, width: 0.1, thickness: 0.03, mass_per_area: 6.88 };
        let pieces = |names: &[&str]| -> Vec<NamedPiece> {
            let named = |name: &&str| NamedPiece {
                name: (*name).to_owned(),
                piece,
                doubt: Default::default(),
                own_constants: vec![],
            };
            names.iter().map(named).collect()
        };
        assert_eq!(suffix("a", &pieces(&["a"])), "");
        assert_eq!(suffix("a", &pieces(&["a", "b"])), "-a");
        assert_ne!(suffix("manifest", &pieces(&["a", "manifest"])), "-manifest");
        let alike = pieces(&["Piece", "piece"]);
        let [first, second] = ["Piece", "piece"].map(|name| suffix(name, &alike).to_lowercase());
        assert_ne!(first, second);
        let (long, longer) = ("木".repeat(90), "木".repeat(91));
        let both = pieces(&[&long, &longer]);
        let [first, second] = [&long, &longer].map(|name| suffix(name, &both));
        assert!(first != second && first.len() < 120 && second.len() < 120, "{first} {second}");
    }
}
