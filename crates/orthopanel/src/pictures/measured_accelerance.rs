//! Measured against calculated accelerance, as the paper's figures 5 to 8.

use orthopanel_identify::AcceleranceFit;
use plotters::prelude::*;

use super::envelope::envelope;
use super::{FONT, GRID, MEASURED, MODEL, stacked};
use crate::error::CommandError;
use crate::measured_pairs::place_text;

/// Least measured magnitude that stretches the axis, over the greatest \[1\]; calculated valleys have no floor at all.
const DEPTH: f64 = 1e-6;

/// `decay_rate` is that of the window over the records \[1/s\], which both curves carry alike.
pub fn measured_accelerance(piece: &str, fit: &AcceleranceFit, decay_rate: f64) -> Result<String, CommandError> {
    let (force, response) = (place_text(fit.force_at), place_text(fit.response_at));
    let window = if decay_rate > 0.0 { format!(", window exp(-{decay_rate:.3} t)") } else { String::new() };
    let title = format!("Piece {piece}: accelerance, force at {force} m, response at {response} m{window}");
    let highest = fit.frequency.last().copied().unwrap_or(1.0);
    let greatest = fit.measured.iter().chain(&fit.model).map(|value| value.norm()).fold(0.0, f64::max);
    let greatest = if greatest > 0.0 { greatest } else { 1.0 };
    let sizes = fit.measured.iter().map(|value| value.norm()).filter(|size| *size > DEPTH * greatest);
    let low = 0.5 * sizes.fold(greatest, f64::min);
    stacked("measured accelerance", &title, [360, 240], |[upper, lower]| {
        let mut chart = ChartBuilder::on(upper)
            .margin(12)
            .x_label_area_size(30)
            .y_label_area_size(70)
            .build_cartesian_2d(0.0..highest, (low..2.0 * greatest).log_scale())?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(GRID)
            .x_label_formatter(&|frequency| format!("{frequency:.0}"))
            .y_label_formatter(&|size| if (0.01..1e4).contains(size) { format!("{size}") } else { format!("{size:e}") })
            .y_desc("magnitude [(m/s²)/N]")
            .label_style((FONT, 15))
            .draw()?;
        let curves = [("measured", &fit.measured, MEASURED, 3), ("calculated", &fit.model, MODEL, 1)];
        for (label, values, colour, width) in curves {
            let sizes = fit.frequency.iter().zip(values).map(|(&line, value)| (line, value.norm().max(low)));
            chart
                .draw_series(LineSeries::new(envelope(sizes.collect()), colour.stroke_width(width)))?
                .label(label)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], colour.stroke_width(width)));
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::LowerRight)
            .background_style(WHITE)
            .border_style(GRID)
            .label_font((FONT, 15))
            .draw()?;

        let mut chart = ChartBuilder::on(lower)
            .margin(12)
            .x_label_area_size(45)
            .y_label_area_size(70)
            .build_cartesian_2d(0.0..highest, -100.0..280.0)?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(GRID)
            .y_labels(5)
            .x_label_formatter(&|frequency| format!("{frequency:.0}"))
            .y_label_formatter(&|phase| format!("{phase:.0}"))
            .x_desc("frequency [Hz]")
            .y_desc("phase [degrees]")
            .label_style((FONT, 15))
            .draw()?;
        for (_, values, colour, width) in curves {
            let phases = fit.frequency.iter().zip(values).map(|(&line, value)| (line, phase(value.arg())));
            chart.draw_series(LineSeries::new(envelope(phases.collect()), colour.stroke_width(width)))?;
        }
        Ok(())
    })
}

/// Degrees from -90 to 270: between its resonances a lightly damped panel has a phase of 0 or 180 degrees, and a cut
/// there would let noise draw lines from edge to edge.
fn phase(radians: f64) -> f64 {
    let degrees = radians.to_degrees();
    if degrees < -90.0 { degrees + 360.0 } else { degrees }
}
