//! The hit and the acceleration that answers it.

use plotters::prelude::*;

use super::curve::curve;
use super::{FONT, GRID, LAST_LABEL, MEASURED, MODEL, spaced, stacked};
use crate::error::Error;
use crate::force_file::ForceHistory;
use crate::motion::Motion;

/// How much of the response is drawn \[ms\]: later the ringing is a solid band.
const SHOWN: f64 = 20.0;

pub fn response(force: &ForceHistory, motions: &[Motion]) -> Result<String, Error> {
    let last = force.time.last().map_or(0.0, |&time| 1000.0 * time).min(SHOWN);
    stacked("response", "Simulated hit and response of the model", [230, 370], |[upper, lower]| {
        let rows = [
            (upper, force.forces.first(), "force [N]", "", MEASURED),
            (lower, motions.first().map(|motion| &motion.acceleration), "acceleration [m/s²]", "time [ms]", MODEL),
        ];
        for (area, values, what, below, colour) in rows {
            let motion = || {
                let samples = force.time.iter().zip(values.into_iter().flatten());
                samples.map(|(&time, &value)| (1000.0 * time, value)).take_while(|&(time, _)| time <= last)
            };
            let mut chart = ChartBuilder::on(area)
                .margin(12)
                .margin_right(LAST_LABEL)
                .x_label_area_size(if below.is_empty() { 30 } else { 45 })
                .y_label_area_size(70)
                .build_cartesian_2d(0.0..last, spaced(motion().map(|(_, value)| value)))?;
            chart
                .configure_mesh()
                .light_line_style(TRANSPARENT)
                .bold_line_style(GRID)
                .x_label_formatter(&|time| format!("{time:.0}"))
                .y_label_formatter(&|value| format!("{value:.0}"))
                .x_desc(below)
                .y_desc(what)
                .label_style((FONT, 15))
                .draw()?;
            let motion = curve(&chart, motion(), colour.stroke_width(2));
            chart.draw_series([motion])?;
        }
        Ok(())
    })
}
