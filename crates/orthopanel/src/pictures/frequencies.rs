//! Natural frequencies: measured against model, and the error of each.

use orthopanel_identify::PieceFit;
use plotters::prelude::*;

use super::{FONT, GRID, MEASURED, MODEL, spaced, stacked};
use crate::error::CommandError;

pub fn frequencies(fit: &PieceFit) -> Result<String, CommandError> {
    let title = format!("Piece {}: natural frequencies of the flexible modes", fit.name);
    let last = fit.modes.iter().map(|mode| mode.mode).max().unwrap_or(1);
    let across = 0.5..last as f64 + 0.5;
    let highest = fit.modes.iter().map(|mode| mode.measured.max(mode.model)).fold(1.0, f64::max);
    stacked("frequencies", &title, [360, 240], |[upper, lower]| {
        let mut chart = ChartBuilder::on(upper)
            .margin(12)
            .x_label_area_size(30)
            .y_label_area_size(70)
            .build_cartesian_2d(across.clone(), 0.0..1.08 * highest)?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(GRID)
            .x_labels(last + 1)
            .x_label_formatter(&|mode| format!("{mode:.0}"))
            .y_label_formatter(&|frequency| format!("{frequency:.0}"))
            .y_desc("natural frequency [Hz]")
            .label_style((FONT, 15))
            .draw()?;
        let model = fit.modes.iter().map(|mode| Cross::new((mode.mode as f64, mode.model), 7, MODEL.stroke_width(2)));
        chart.draw_series(model)?.label("model").legend(|(x, y)| Cross::new((x + 8, y), 6, MODEL.stroke_width(2)));
        let measured =
            fit.modes.iter().map(|mode| Circle::new((mode.mode as f64, mode.measured), 6, MEASURED.stroke_width(2)));
        chart
            .draw_series(measured)?
            .label("measured")
            .legend(|(x, y)| Circle::new((x + 8, y), 5, MEASURED.stroke_width(2)));
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperLeft)
            .background_style(WHITE)
            .border_style(GRID)
            .label_font((FONT, 15))
            .draw()?;

        let errors = fit.modes.iter().map(|mode| mode.error_percent());
        let greatest = errors.clone().fold(0.0_f64, |greatest, error| greatest.max(error.abs()));
        // Two digits, and more where the greatest error needs them.
        let digits = if greatest > 0.0 { (1.0 - greatest.log10()).ceil().clamp(2.0, 9.0) as usize } else { 2 };
        let mut chart = ChartBuilder::on(lower)
            .margin(12)
            .x_label_area_size(45)
            .y_label_area_size(70)
            .build_cartesian_2d(across.clone(), spaced(errors.chain([0.0])))?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(GRID)
            .x_labels(last + 1)
            .x_label_formatter(&|mode| format!("{mode:.0}"))
            .y_label_formatter(&|error| match format!("{error:+.digits$}") {
                text if text.bytes().any(|byte| (b'1'..=b'9').contains(&byte)) => text,
                _ => "0".into(),
            })
            .x_desc("flexible mode")
            .y_desc("(model - measured) / measured [%]")
            .label_style((FONT, 15))
            .draw()?;
        let bar = |mode: f64, error: f64| Rectangle::new([(mode - 0.15, 0.0), (mode + 0.15, error)], MODEL.filled());
        chart.draw_series(fit.modes.iter().map(|mode| bar(mode.mode as f64, mode.error_percent())))?;
        chart.draw_series(LineSeries::new([(across.start, 0.0), (across.end, 0.0)], BLACK))?;
        Ok(())
    })
}
