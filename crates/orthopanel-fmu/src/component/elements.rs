//! References of arrays, taken apart into those of their elements.

use std::borrow::Cow;

use super::Component;
use crate::FmuError;

impl Component {
    /// The references of all elements, in their order; without arrays the references themselves.
    pub(crate) fn elements<'a>(&self, references: &'a [u32]) -> Result<Cow<'a, [u32]>, FmuError> {
        if self.variables.arrays().is_empty() {
            return Ok(Cow::Borrowed(references));
        }
        Ok(Cow::Owned(references.iter().flat_map(|&reference| self.variables.seen_as(reference)).collect()))
    }

    /// `values`, one a reference, repeated for each element.
    pub(crate) fn for_elements(&self, references: &[u32], values: &[i32]) -> Result<Vec<i32>, FmuError> {
        super::values::same_count(values.len(), references.len())?;
        let mut all = Vec::with_capacity(values.len());
        for (reference, &value) in references.iter().zip(values) {
            let count = self.elements(std::slice::from_ref(reference))?.len();
            all.extend(std::iter::repeat_n(value, count));
        }
        Ok(all)
    }
}
