//! Pictures as SVG: what was measured in orange, what the model says in blue.

mod accelerance;
mod beam_mode_shapes;
mod coherence;
mod control_chart;
mod curve;
mod cut;
mod envelope;
mod frequencies;
mod frequency_axes;
mod measured_accelerance;
mod modal_assurance;
mod plate_map;
mod plate_mode_shapes;
mod residual;
mod residual_by_mode;
mod response;
mod shade_scale;
mod time_history;

pub use accelerance::accelerance;
pub use beam_mode_shapes::{ModeShape, beam_mode_shapes};
pub use coherence::coherence;
pub use control_chart::control_chart;
pub use cut::cut;
pub use frequencies::frequencies;
pub use measured_accelerance::measured_accelerance;
pub use modal_assurance::modal_assurance;
pub use plate_map::{FoundPlace, plate_map};
pub use plate_mode_shapes::plate_mode_shapes;
pub use residual::{residual_by_frequency, residual_by_level, residual_by_place};
pub use residual_by_mode::residual_by_place_and_mode;
pub use response::response;
pub use time_history::time_history;

use orthopanel_model::printable;
use plotters::coord::Shift;
use plotters::prelude::*;

use crate::error::Error;

const MEASURED: RGBColor = RGBColor(213, 94, 0);
const MODEL: RGBColor = RGBColor(0, 90, 170);
/// What the model says with the effects that were found, where it stands beside the base model.
const WITH_EFFECTS: RGBColor = RGBColor(0, 140, 100);
const ERROR: RGBColor = RGBColor(90, 90, 90);
const GRID: RGBColor = RGBColor(225, 225, 225);
const FONT: &str = "sans-serif";

/// Room on the right for the half of the last tick's label that stands beyond the axis \[pixels\].
const LAST_LABEL: u32 = 32;

const SIZE: (u32, u32) = (900, 640);

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Drawn = Result<(), Box<dyn std::error::Error>>;

/// A picture of charts one above the other under a title, of these heights \[pixels\]; the last takes what is left.
fn stacked<const CHARTS: usize>(
    name: &'static str,
    title: &str,
    heights: [u32; CHARTS],
    draw: impl for<'a> FnOnce(&[Area<'a>; CHARTS]) -> Drawn,
) -> Result<String, Error> {
    titled(name, title, SIZE, |mut rest| {
        let mut placed = 1;
        let charts = heights.map(|height| {
            if placed == CHARTS {
                return rest.clone();
            }
            placed += 1;
            let (chart, left) = rest.split_vertically(height);
            rest = left;
            chart
        });
        draw(&charts)
    })
}

/// A picture of this size \[pixels\]: a title, and below it what `draw` puts there.
fn titled(
    name: &'static str,
    title: &str,
    size: (u32, u32),
    draw: impl for<'a> FnOnce(Area<'a>) -> Drawn,
) -> Result<String, Error> {
    let mut text = String::new();
    let drawn = (|| {
        let area = SVGBackend::with_string(&mut text, size).into_drawing_area();
        area.fill(&WHITE)?;
        draw(area.titled(title, (FONT, 22))?)?;
        area.present()?;
        Ok(())
    })();
    let failed = |error: Box<dyn std::error::Error>| Error::Picture { name, problem: error.to_string() };
    drawn.map_err(failed).map(|()| printable(&curve::in_pixels(&text)).into_owned())
}

/// A range with a twentieth of its width to spare at both ends, never empty.
fn spaced(values: impl Iterator<Item = f64>) -> std::ops::Range<f64> {
    let (low, high) =
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    let (low, high) = if low <= high { (low, high) } else { (0.0, 0.0) };
    let spare = if high > low { 0.05 * (high - low) } else { 1.0 };
    low - spare..high + spare
}
