//! How the edges of a piece are held.

use serde::{Deserialize, Serialize};

use crate::{End, ModelError};

/// The four edges of a piece, free unless said: `left` and `right` at $x = \mp a/2$, `front` and `back` at
/// $y = \mp b/2$.
///
/// A beam has its two ends only; its front and back are free, and every beam refuses others.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Boundary {
    /// The end at $x = -a/2$.
    pub left: End,
    /// The end at $x = +a/2$.
    pub right: End,
    /// The edge at $y = -b/2$.
    #[serde(skip_serializing_if = "is_free")]
    pub front: End,
    /// The edge at $y = +b/2$.
    #[serde(skip_serializing_if = "is_free")]
    pub back: End,
}

impl Boundary {
    /// All edges free, as hung in the paper's tests.
    pub const FREE: Self = Self { left: End::Free, right: End::Free, front: End::Free, back: End::Free };

    /// Number of rigid modes of a beam: 2 free-free, 1 where one end is pinned and the other free, else 0.
    pub fn rigid_modes(self) -> usize {
        match (self.left, self.right) {
            (End::Free, End::Free) => 2,
            (End::Free, End::Pinned) | (End::Pinned, End::Free) => 1,
            _ => 0,
        }
    }

    /// The same with every clamped edge free.
    pub(crate) fn released(self) -> Self {
        let released = |end: End| if end == End::Clamped { End::Free } else { end };
        let Self { left, right, front, back } = self;
        Self { left: released(left), right: released(right), front: released(front), back: released(back) }
    }

    /// Checks that front and back are free, as a beam has them.
    pub(crate) fn of_beam(self) -> Result<Self, ModelError> {
        match [("front", self.front), ("back", self.back)].into_iter().find(|(_, end)| *end != End::Free) {
            Some((edge, end)) => Err(ModelError::HeldSide { edge, end }),
            None => Ok(self),
        }
    }
}

// A beam's file names its two ends only.
fn is_free(end: &End) -> bool {
    *end == End::Free
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_beam_is_free_along_its_long_edges() {
        let held = Boundary { back: End::Clamped, ..Boundary::FREE };
        let said = held.of_beam().expect_err("held").to_string();
        assert_eq!(said, "back = clamped: a beam is free there; leave it out, or take the structure \"mindlin-plate\"");
        assert_eq!(Boundary::FREE.of_beam(), Ok(Boundary::FREE));
    }

    #[test]
    fn free_front_and_back_stay_out_of_files() {
        assert_eq!(serde_json::to_string(&Boundary::FREE).expect("text"), r#"{"left":"free","right":"free"}"#);
        let held: Boundary = serde_json::from_str(r#"{"front": "pinned"}"#).expect("a boundary");
        assert_eq!(held, Boundary { front: End::Pinned, ..Boundary::FREE });
        assert_eq!(serde_json::from_str::<Boundary>(&serde_json::to_string(&held).expect("text")).expect("back"), held);
    }
}
