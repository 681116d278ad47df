//! The scale of a picture of shaded fields: from white to the full colour.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::{Area, Drawn, ERROR, FONT, MODEL};

/// Steps of the scale.
pub(super) const STEPS: usize = 24;
/// Its size \[pixels\].
const SCALE: (i32, i32) = (240, 14);
/// Height of the area that holds it \[pixels\].
pub(super) const SCALE_AREA: i32 = 75;

/// Draws the scale from `left` \[pixels\] on, with what its ends stand for.
pub(super) fn shade_scale(area: &Area, left: i32, [least, most]: [String; 2]) -> Drawn {
    let top = 6;
    for step in 0..STEPS {
        let at = |step: usize| left + SCALE.0 * step as i32 / STEPS as i32;
        let shade = MODEL.mix((step as f64 + 0.5) / STEPS as f64);
        area.draw(&Rectangle::new([(at(step), top), (at(step + 1), top + SCALE.1)], shade.filled()))?;
    }
    area.draw(&Rectangle::new([(left, top), (left + SCALE.0, top + SCALE.1)], ERROR))?;
    let said = |side| (FONT, 15).into_font().color(&ERROR).pos(Pos::new(side, VPos::Top));
    let (before, after) = ((left - 8, top - 1), (left + SCALE.0 + 8, top - 1));
    area.draw(&Text::new(least, before, said(HPos::Right)))?;
    area.draw(&Text::new(most, after, said(HPos::Left)))?;
    Ok(())
}
