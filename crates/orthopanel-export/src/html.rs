//! Text in HTML.

use orthopanel_model::printable;

/// A text with what HTML would read as its own escaped, and without what cannot be printed.
pub(crate) fn escaped(text: &str) -> String {
    quick_xml::escape::escape(printable(text)).into_owned()
}
