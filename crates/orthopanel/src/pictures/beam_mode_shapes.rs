//! Shapes of the modes of a beam, a small chart each: the deflection along the piece.

use orthopanel_model::{Piece, Place};
use plotters::prelude::*;

use super::curve::curve;
use super::{Area, Drawn, FONT, GRID, MODEL, titled};
use crate::error::Error;

/// Charts side by side.
const ACROSS: usize = 2;
/// Height of a chart \[pixels\].
const HEIGHT: u32 = 130;
const WIDTH: u32 = 900;
/// What the title takes \[pixels\].
const TITLE: u32 = 40;
/// Points of a line.
const POINTS: u32 = 300;

/// One mode as it is drawn.
pub struct ModeShape<'a> {
    /// Such as `mode 1: 321.4 Hz, 2 nodes`.
    pub name: String,
    /// Deflection at a place, to any scale.
    pub deflection: Box<dyn Fn(Place) -> f64 + 'a>,
}

pub fn beam_mode_shapes(piece: &Piece, shapes: &[ModeShape]) -> Result<String, Error> {
    let rows = shapes.len().div_ceil(ACROSS);
    let Piece { length, width, thickness, .. } = piece;
    let title = format!("Modes of the piece of {length} x {width} x {thickness} m");
    titled("mode shapes", &title, (WIDTH, TITLE + HEIGHT * rows as u32), |area| {
        if rows == 0 {
            return Ok(());
        }
        area.split_evenly((rows, ACROSS)).iter().zip(shapes).try_for_each(|(chart, shape)| line(chart, piece, shape))
    })
}

/// The deflection over the piece at rest, its greatest value one.
fn line(area: &Area, piece: &Piece, shape: &ModeShape) -> Drawn {
    let half = 0.5 * piece.length;
    let place = |point: u32| half * (2.0 * f64::from(point) / f64::from(POINTS) - 1.0);
    let points: Vec<(f64, f64)> =
        (0..=POINTS).map(place).map(|x| (x, (shape.deflection)(Place { x, y: 0.0 }))).collect();
    let greatest = points.iter().fold(0.0_f64, |greatest, (_, w)| greatest.max(w.abs()));
    let scale = if greatest > 0.0 { greatest.recip() } else { 1.0 };
    let mut chart = ChartBuilder::on(area)
        .margin(8)
        .margin_left(24)
        .margin_right(24)
        .caption(&shape.name, (FONT, 15))
        .x_label_area_size(22)
        .build_cartesian_2d(-1.03 * half..1.03 * half, -1.15..1.15)?;
    chart
        .configure_mesh()
        .disable_y_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(GRID)
        .x_labels(5)
        // Adding zero takes the sign off a negative one.
        .x_label_formatter(&|x| format!("{} mm", (1000.0_f64 * x).round() + 0.0))
        .label_style((FONT, 12))
        .draw()?;
    chart.draw_series(LineSeries::new([(-half, 0.0), (half, 0.0)], BLACK.mix(0.5)))?;
    let deflected = curve(&chart, points.iter().map(|(x, w)| (*x, scale * w)), MODEL.stroke_width(2));
    chart.draw_series([deflected])?;
    // Nodes, where the deflection changes sign: a sensor there is blind to the mode.
    let node = |pair: &[(f64, f64)]| match *pair {
        [(left, a), (right, b)] if (a < 0.0) != (b < 0.0) => Some((left + (right - left) * a / (a - b), 0.0)),
        _ => None,
    };
    chart.draw_series(points.windows(2).filter_map(node).map(|at| Circle::new(at, 4, MODEL.filled())))?;
    Ok(())
}
