//! Tables of the page.

/// Rows under headings.
pub struct Table {
    pub columns: Vec<Column>,
    pub rows: Vec<Vec<String>>,
}

pub struct Column {
    pub heading: &'static str,
    /// Words that may run over several lines, rather than a number.
    pub is_text: bool,
}

impl Table {
    /// A heading that begins with `"` stands over words.
    pub fn new(headings: &[&'static str], rows: Vec<Vec<String>>) -> Self {
        let column = |heading: &&'static str| match heading.strip_prefix('"') {
            Some(heading) => Column { heading, is_text: true },
            None => Column { heading, is_text: false },
        };
        Self { columns: headings.iter().map(column).collect(), rows }
    }
}
