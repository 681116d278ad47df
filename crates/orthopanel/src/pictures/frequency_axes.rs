//! The axes of an accelerance: magnitude above, phase below, both over frequency.

use std::ops::Range;

use plotters::coord::combinators::LogCoord;
use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use super::curve::Chart;
use super::{Area, FONT, GRID, LAST_LABEL};

type OverFrequency<'a, 'b, Y> = Chart<'a, 'b, RangedCoordf64, Y>;
type Built<T> = Result<T, Box<dyn std::error::Error>>;

/// Logarithmic, from `low` to `high` \[(m/s²)/N\], up to the frequency `highest` \[Hz\].
pub fn magnitude<'a, 'b>(
    area: &'b Area<'a>,
    highest: f64,
    low: f64,
    high: f64,
) -> Built<OverFrequency<'a, 'b, LogCoord<f64>>> {
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .margin_right(LAST_LABEL)
        .x_label_area_size(30)
        .y_label_area_size(70)
        .build_cartesian_2d(0.0..highest, (low..high).log_scale())?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(GRID)
        .x_label_formatter(&|frequency| format!("{frequency:.0}"))
        .y_label_formatter(&|size| if (0.01..1e4).contains(size) { format!("{size}") } else { format!("{size:e}") })
        .y_desc("magnitude [(m/s²)/N]")
        .label_style((FONT, 15))
        .draw()?;
    Ok(chart)
}

/// Quarters of a turn, where ticks stand \[degrees\].
const QUARTERS: [f64; 5] = [-90.0, 0.0, 90.0, 180.0, 270.0];

/// An axis of degrees with its ticks at [`QUARTERS`]: plotters would put them at round hundreds.
pub struct Phases(RangedCoordf64);

impl Ranged for Phases {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        self.0.map(value, limit)
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        QUARTERS.to_vec()
    }

    fn range(&self) -> Range<f64> {
        self.0.range()
    }
}

/// Phases as [`degrees`] gives them, up to the frequency `highest` \[Hz\].
pub fn phase<'a, 'b>(area: &'b Area<'a>, highest: f64) -> Built<OverFrequency<'a, 'b, Phases>> {
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .margin_right(LAST_LABEL)
        .x_label_area_size(45)
        .y_label_area_size(70)
        .build_cartesian_2d(0.0..highest, Phases((-100.0..280.0).into()))?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(GRID)
        .x_label_formatter(&|frequency| format!("{frequency:.0}"))
        .y_label_formatter(&|phase| format!("{phase:.0}"))
        .x_desc("frequency [Hz]")
        .y_desc("phase [degrees]")
        .label_style((FONT, 15))
        .draw()?;
    Ok(chart)
}

/// Degrees from -90 to 270: between its resonances a lightly damped panel has a phase of 0 or 180 degrees, and a cut
/// there would let noise draw lines from edge to edge.
pub fn degrees(radians: f64) -> f64 {
    let degrees = radians.to_degrees();
    if degrees < -90.0 { degrees + 360.0 } else { degrees }
}
