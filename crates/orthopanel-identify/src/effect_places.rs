//! Whether an effect sits at a place of its own, or in a record of its own: several pieces, or kinds of records, do not share it.

use orthopanel_model::{Effect, EffectParameter, Scale};

/// Why an effect at a place is not looked for on several pieces.
pub(crate) const OF_PIECE: &str = "each piece would have a place of its own: trace one piece in a test file";

/// Why an effect of a record is not looked for in records of several pieces or of two kinds.
pub(crate) const OF_RECORD: &str = "records of several pieces, or hits beside files of accelerances, are not numbered together: give each a test file of \
                                    its own";

/// Whether an effect sits at a place of its own: a piece may have several of it.
pub(crate) fn has_place(effect: &dyn Effect) -> bool {
    effect.parameters().iter().any(is_place)
}

/// Whether an effect is of one record, or has a value in each.
pub(crate) fn is_of_record(effect: &dyn Effect) -> bool {
    effect.parameters().iter().any(|parameter| parameter.each_record || parameter.scale == Scale::Index)
}

/// Whether a parameter is the place of an effect along the piece.
fn is_place(parameter: &EffectParameter) -> bool {
    parameter.name == "x"
}
