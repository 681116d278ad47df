//! A picture with what it shows.

/// A picture with what it shows.
pub(crate) struct Figure {
    pub(crate) svg: String,
    pub(crate) caption: String,
}

impl Figure {
    pub(crate) fn new(svg: &str, caption: impl Into<String>) -> Self {
        Self { svg: svg.to_owned(), caption: caption.into() }
    }
}
