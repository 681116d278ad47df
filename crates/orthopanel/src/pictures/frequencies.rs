//! Natural frequencies: measured against model, and the error of each; where effects were found, with them too.

use orthopanel_identify::PieceFit;
use plotters::prelude::*;

use super::{Area, Drawn, FONT, GRID, LAST_LABEL, MEASURED, MODEL, WITH_EFFECTS, spaced, stacked};
use crate::error::Error;

/// One model's frequencies.
struct Told {
    label: &'static str,
    colour: RGBColor,
    /// Mode and frequency \[Hz\].
    frequencies: Vec<(f64, f64)>,
    /// Mode and error \[%\].
    errors: Vec<(f64, f64)>,
    /// Where its bars stand beside the modes, and half their width.
    beside: f64,
    half: f64,
}

/// `with_effects` are those of the model with the effects, one a mode of `fit`.
pub fn frequencies(fit: &PieceFit, with_effects: Option<&[f64]>) -> Result<String, Error> {
    let title = format!("Piece {}: natural frequencies of the flexible modes", fit.name);
    let number = |mode: usize| mode as f64;
    let told = |label, colour, found: &dyn Fn(usize) -> f64, (beside, half)| {
        let modes = || fit.modes.iter().enumerate();
        let error = |index: usize, measured: f64| 100.0 * (found(index) - measured) / measured;
        Told {
            label,
            colour,
            frequencies: modes().map(|(index, mode)| (number(mode.mode), found(index))).collect(),
            errors: modes().map(|(index, mode)| (number(mode.mode), error(index, mode.measured))).collect(),
            beside,
            half,
        }
    };
    let base = |index: usize| fit.modes.get(index).map_or(f64::NAN, |mode| mode.model);
    let models = match with_effects {
        None => vec![told("model", MODEL, &base, (0.0, 0.15))],
        Some(after) => {
            let after = |index: usize| after.get(index).copied().unwrap_or(f64::NAN);
            vec![
                told("base model", MODEL, &base, (-0.11, 0.1)),
                told("with the effects", WITH_EFFECTS, &after, (0.11, 0.1)),
            ]
        }
    };
    let measured: Vec<(f64, f64)> = fit.modes.iter().map(|mode| (number(mode.mode), mode.measured)).collect();
    let last = fit.modes.iter().map(|mode| mode.mode).max().unwrap_or(1);
    stacked("frequencies", &title, [360, 240], |[upper, lower]| {
        draw_frequencies(upper, last, &measured, &models)?;
        draw_errors(lower, last, &models)
    })
}

fn across(last: usize) -> std::ops::Range<f64> {
    0.5..last as f64 + 0.5
}

fn draw_frequencies(area: &Area, last: usize, measured: &[(f64, f64)], models: &[Told]) -> Drawn {
    let all = measured.iter().chain(models.iter().flat_map(|told| &told.frequencies));
    let highest = all.map(|(_, frequency)| *frequency).fold(1.0, f64::max);
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .margin_right(LAST_LABEL)
        .x_label_area_size(30)
        .y_label_area_size(LABELS)
        .build_cartesian_2d(across(last), 0.0..1.08 * highest)?;
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
    for told in models {
        let style = told.colour.stroke_width(2);
        let crosses = told.frequencies.iter().map(|&at| Cross::new(at, 7, style));
        chart.draw_series(crosses)?.label(told.label).legend(move |(x, y)| Cross::new((x + 8, y), 6, style));
    }
    let rings = measured.iter().map(|&at| Circle::new(at, 6, MEASURED.stroke_width(2)));
    chart.draw_series(rings)?.label("measured").legend(|(x, y)| Circle::new((x + 8, y), 5, MEASURED.stroke_width(2)));
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperLeft)
        .background_style(WHITE)
        .border_style(GRID)
        .label_font((FONT, 15))
        .draw()?;
    Ok(())
}

/// Room for the ticks' labels and the axis's beside them \[pixels\].
const LABELS: u32 = 100;

fn draw_errors(area: &Area, last: usize, models: &[Told]) -> Drawn {
    let errors = || models.iter().flat_map(|told| &told.errors).map(|(_, error)| *error);
    let greatest = errors().fold(0.0_f64, |greatest, error| greatest.max(error.abs()));
    // Two digits, and more where the greatest error needs them.
    let digits = if greatest > 0.0 { (1.0 - greatest.log10()).ceil().clamp(2.0, 9.0) as usize } else { 2 };
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .margin_right(LAST_LABEL)
        .x_label_area_size(45)
        .y_label_area_size(LABELS)
        .build_cartesian_2d(across(last), spaced(errors().chain([0.0])))?;
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
        .y_desc("model's error [%]")
        .label_style((FONT, 15))
        .draw()?;
    for told in models {
        let bar = |&(mode, error): &(f64, f64)| {
            let middle = mode + told.beside;
            Rectangle::new([(middle - told.half, 0.0), (middle + told.half, error)], told.colour.filled())
        };
        chart.draw_series(told.errors.iter().map(bar))?;
    }
    let edges = across(last);
    chart.draw_series(LineSeries::new([(edges.start, 0.0), (edges.end, 0.0)], BLACK))?;
    Ok(())
}
