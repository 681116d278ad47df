//! A lot's control chart: individuals with their own deviations, and moving ranges below.

use plotters::prelude::*;

use super::{Area, Drawn, ERROR, FONT, GRID, LAST_LABEL, MEASURED, MODEL, spaced, stacked};
use crate::error::Error;
use crate::lot::control_chart::ControlChart;

/// Of one constant, whose name and unit is `label`.
pub fn control_chart(label: &str, values: &[f64], stds: &[f64], chart: &ControlChart) -> Result<String, Error> {
    stacked("control chart", label, [390, 210], |[upper, lower]| {
        let individuals = Curves { lines: vec![chart.centre, chart.limits[0], chart.limits[1]], out: &chart.beyond };
        let points: Vec<(f64, f64, f64)> =
            (1..).zip(values.iter().zip(stds)).map(|(n, (v, s))| (f64::from(n), *v, *s)).collect();
        draw(upper, values.len(), "", label, &points, &individuals)?;
        let ranges: Vec<(f64, f64, f64)> =
            (2..).zip(&chart.ranges).map(|(n, range)| (f64::from(n), *range, 0.0)).collect();
        let moving = Curves { lines: vec![chart.mean_range, chart.range_limit], out: &chart.jumps };
        draw(lower, values.len(), "panel", "moving range", &ranges, &moving)
    })
}

/// Lines across a chart, the first the mean, and the points, counted from 0, that are out of control.
struct Curves<'a> {
    lines: Vec<f64>,
    out: &'a [usize],
}

fn draw(area: &Area, count: usize, across: &str, up: &str, points: &[(f64, f64, f64)], told: &Curves) -> Drawn {
    let ends = points.iter().flat_map(|(_, value, std)| [value - std, value + std]);
    let range = spaced(ends.chain(told.lines.iter().copied()));
    let last = count as f64 + 0.5;
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .margin_right(LAST_LABEL)
        .x_label_area_size(if across.is_empty() { 28 } else { 45 })
        .y_label_area_size(100)
        .build_cartesian_2d(0.5..last, range)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(GRID)
        .x_label_formatter(&|panel| format!("{panel:.0}"))
        .y_label_formatter(&|value| format!("{value:.3e}"))
        .x_desc(across)
        .y_desc(up)
        .label_style((FONT, 15))
        .draw()?;
    for (number, line) in told.lines.iter().enumerate() {
        let style = if number == 0 { MODEL.stroke_width(2) } else { ERROR.stroke_width(1) };
        chart.draw_series(LineSeries::new([(0.5, *line), (last, *line)], style))?;
    }
    chart.draw_series(points.iter().filter(|(_, _, std)| *std > 0.0).map(|(panel, value, std)| {
        PathElement::new(vec![(*panel, value - std), (*panel, value + std)], MEASURED.stroke_width(1))
    }))?;
    let is_out = |panel: f64| told.out.iter().any(|out| (*out as f64 + 1.0 - panel).abs() < 0.5);
    chart.draw_series(points.iter().map(|&(panel, value, _)| {
        let style = if is_out(panel) { RED.filled() } else { MEASURED.filled() };
        Circle::new((panel, value), if is_out(panel) { 6 } else { 4 }, style)
    }))?;
    Ok(())
}
