//! Parts of a line of a universal file.

/// The text in `width` columns from column `from` (from 0), trimmed; `None` where the columns are empty or absent.
pub(super) fn field(line: &str, from: usize, width: usize) -> Option<&str> {
    let text = line.get(from..(from + width).min(line.len()))?.trim();
    (!text.is_empty()).then_some(text)
}

/// Enough of a line to know it by: a corrupt file's line may be a megabyte long.
pub(super) fn shortened(text: &str) -> String {
    text.chars().take(40).collect()
}
