//! Shapes of the modes of a plate, a map each: contours of the deflection seen from above, nodal lines drawn through.

use contour::ContourBuilder;
use orthopanel_model::{Piece, Place};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use super::beam_mode_shapes::ModeShape;
use super::{Area, Drawn, FONT, MEASURED, MODEL, titled};
use crate::error::Error;

const WIDTH: u32 = 900;
/// What the title takes \[pixels\].
const TITLE: u32 = 40;
/// What a map's name takes \[pixels\].
const NAME: u32 = 30;
/// Around a map and its labels \[pixels\].
const MARGIN: u32 = 12;
/// What labels take below and beside a map \[pixels\].
const LABELS: (u32, u32) = (22, 44);
/// Right of a map, for half of its last label \[pixels\].
const AFTER: u32 = 28;
/// Least and greatest height of a map \[pixels\].
const HEIGHTS: (u32, u32) = (60, 420);
/// Cells along the longer side.
const CELLS: f64 = 120.0;
/// Levels, of the greatest deflection, at which the colour changes.
const LEVELS: [f64; 10] = [-0.9, -0.7, -0.5, -0.3, -0.1, 0.1, 0.3, 0.5, 0.7, 0.9];

type Map<'a, 'b> = ChartContext<'b, SVGBackend<'a>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;
type Ring = Vec<(f64, f64)>;

/// Orange is up, blue is down; x to the right, y upwards, both to one scale and in millimetres from the centre.
pub fn plate_mode_shapes(piece: &Piece, shapes: &[ModeShape]) -> Result<String, Error> {
    let Piece { length, width, thickness, .. } = piece;
    // A map wider than high gets half of the picture, a square one a third.
    let across = if *length >= 2.0 * width { 2 } else { 3 };
    let map_width = WIDTH / across - MARGIN - AFTER - LABELS.1;
    let map_height = (f64::from(map_width) * width / length).round().clamp(HEIGHTS.0.into(), HEIGHTS.1.into()) as u32;
    let rows = shapes.len().div_ceil(across as usize);
    let title = format!("Modes of the piece of {length} x {width} x {thickness} m");
    let height = TITLE + (NAME + map_height + LABELS.0 + 2 * MARGIN) * rows as u32;
    titled("mode shapes", &title, (WIDTH, height), |area| {
        if rows == 0 {
            return Ok(());
        }
        let areas = area.split_evenly((rows, across as usize));
        areas.iter().zip(shapes).try_for_each(|(area, shape)| map(area, piece, shape))
    })
}

fn map(area: &Area, piece: &Piece, shape: &ModeShape) -> Drawn {
    let (half_x, half_y) = (0.5 * piece.length, 0.5 * piece.width);
    let longer = piece.length.max(piece.width);
    let cells = |side: f64| (CELLS * side / longer).ceil().max(12.0) as usize;
    let (columns, rows) = (cells(piece.length), cells(piece.width));
    // Values stand at the middles of the cells.
    let (step_x, step_y) = (piece.length / columns as f64, piece.width / rows as f64);
    let at = |row: usize, column: usize| {
        let place = Place { x: (column as f64 + 0.5) * step_x - half_x, y: (row as f64 + 0.5) * step_y - half_y };
        (shape.deflection)(place)
    };
    let deflections: Vec<f64> = (0..rows)
        .flat_map(|row| (0..columns).map(move |column| (row, column)))
        .map(|(row, column)| at(row, column))
        .collect();
    let greatest = deflections.iter().fold(0.0_f64, |greatest, w| greatest.max(w.abs()));
    // A mode has no sign of its own: up is the first place from the lower left corner that moves by half the greatest.
    let moving = deflections.iter().find(|w| w.abs() > 0.5 * greatest);
    let scale = moving.map_or(1.0, |w| w.signum() / greatest);
    let scaled: Vec<f64> = deflections.iter().map(|w| scale * w).collect();

    let contours =
        ContourBuilder::new(columns, rows, true).x_origin(-half_x).y_origin(-half_y).x_step(step_x).y_step(step_y);
    let mut chart: Map = ChartBuilder::on(area)
        .margin(MARGIN)
        .margin_right(AFTER)
        .caption(&shape.name, (FONT, 15))
        .x_label_area_size(LABELS.0)
        .y_label_area_size(LABELS.1)
        .build_cartesian_2d(-half_x..half_x, -half_y..half_y)?;
    // Adding zero takes the sign off a negative one.
    let millimetres = |metres: &f64| format!("{}", (1000.0 * metres).round() + 0.0);
    chart
        .configure_mesh()
        .disable_mesh()
        .x_labels(5)
        .y_labels(4)
        .x_label_formatter(&|x| format!("{} mm", millimetres(x)))
        .y_label_formatter(&millimetres)
        .label_style((FONT, 12))
        .draw()?;
    let whole = [(-half_x, -half_y), (half_x, half_y)];
    chart.draw_series([Rectangle::new(whole, colour(-1.0).filled())])?;
    // From the lowest level up, each over the one before it.
    for above in contours.contours(&scaled, &LEVELS)? {
        let fill = colour(above.threshold() + 0.1).filled();
        for polygon in above.geometry() {
            let outline = polygon.exterior().coords().map(|at| at.x_y()).collect();
            let holes = polygon.interiors().iter().map(|hole| hole.coords().map(|at| at.x_y()).collect());
            chart.draw_series([Polygon::new(with_holes(outline, holes), fill)])?;
        }
    }
    for nodal in contours.lines(&scaled, &[0.0])? {
        for line in nodal.geometry() {
            let points: Ring = line.coords().map(|at| at.x_y()).collect();
            for inside in off_the_edges(&points, half_x, half_y) {
                chart.draw_series(LineSeries::new(inside, BLACK.stroke_width(2)))?;
            }
        }
    }
    chart.draw_series([Rectangle::new(whole, BLACK.mix(0.5))])?;
    Ok(())
}

/// White at rest, orange at 1, blue at -1.
fn colour(level: f64) -> RGBColor {
    let full = if level > 0.0 { MEASURED } else { MODEL };
    let part = level.abs().min(1.0);
    let mix = |of: u8| (255.0 - part * (255.0 - f64::from(of))).round() as u8;
    RGBColor(mix(full.0), mix(full.1), mix(full.2))
}

/// One ring around a polygon and its holes: each hole is reached and left on the same line, which encloses nothing.
fn with_holes(mut ring: Ring, holes: impl Iterator<Item = Ring>) -> Ring {
    let Some(&start) = ring.first() else { return ring };
    for hole in holes {
        ring.extend(hole);
        ring.push(start);
    }
    ring
}

/// The parts of a contour inside the piece; contours close along its edges, where the plate need not be at rest.
fn off_the_edges(points: &[(f64, f64)], half_x: f64, half_y: f64) -> Vec<Ring> {
    let on_edge = |&(x, y): &(f64, f64)| half_x - x.abs() < 1e-9 * half_x || half_y - y.abs() < 1e-9 * half_y;
    let along_edge = |a: &(f64, f64), b: &(f64, f64)| on_edge(a) && on_edge(b);
    points.chunk_by(|a, b| !along_edge(a, b)).filter(|part| part.len() > 1).map(<[_]>::to_vec).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_contour_loses_what_runs_along_the_edges() {
        let ring = [(-1.0, 0.5), (0.0, 0.4), (1.0, 0.5), (1.0, -1.0), (-1.0, -1.0), (-1.0, 0.5)];
        assert_eq!(off_the_edges(&ring, 1.0, 1.0), [vec![(-1.0, 0.5), (0.0, 0.4), (1.0, 0.5)]]);
    }

    #[test]
    fn colours_run_from_blue_over_white_to_orange() {
        assert_eq!((colour(-1.0), colour(0.0), colour(1.0)), (MODEL, WHITE, MEASURED));
    }
}
