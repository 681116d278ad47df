//! Curves drawn where their points are: plotters hands whole pixels to its backend, which makes steps of gentle slopes.

use std::fmt::Write;

use plotters::coord::ranged1d::Ranged;
use plotters::element::{Drawable, PointCollection};
use plotters::prelude::*;
use plotters_backend::{BackendColor, BackendCoord, BackendStyle, DrawingErrorKind};

/// A chart with axes, in which curves are drawn.
pub(super) type Chart<'a, 'b, X, Y> = ChartContext<'b, SVGBackend<'a>, Cartesian2d<X, Y>>;

/// Parts of a pixel in which a curve's points are handed over.
const FINE: i32 = 100;
/// Added to the stroke width of such a curve, by which [`in_pixels`] knows it.
const MARK: u32 = 10_000;

/// A line through these points, those beyond the chart's edges drawn on them.
pub fn curve<X, Y>(
    chart: &Chart<X, Y>,
    points: impl IntoIterator<Item = (f64, f64)>,
    style: impl Into<ShapeStyle>,
) -> Curve
where
    X: Ranged<ValueType = f64>,
    Y: Ranged<ValueType = f64>,
{
    let axes = chart.as_coord_spec();
    let [across, up] = [axes.get_x_axis_pixel_range(), axes.get_y_axis_pixel_range()]
        .map(|range| (FINE * range.start, FINE * range.end));
    let fine = |(x, y): (f64, f64)| {
        let x = axes.x_spec().map(&x, across).clamp(across.0, across.1);
        // Pixels are counted from above.
        (x, axes.y_spec().map(&y, (up.1, up.0)).clamp(up.0, up.1))
    };
    Curve { points: points.into_iter().map(fine).collect(), style: style.into() }
}

/// Made by [`curve`].
pub struct Curve {
    /// In parts of a pixel.
    points: Vec<BackendCoord>,
    style: ShapeStyle,
}

/// None for plotters to turn into pixels.
impl<'a> PointCollection<'a, (f64, f64)> for &'a Curve {
    type Point = &'a (f64, f64);
    type IntoIter = &'a [(f64, f64)];

    fn point_iter(self) -> Self::IntoIter {
        &[]
    }
}

impl<DB: DrawingBackend> Drawable<DB> for Curve {
    fn draw<I: Iterator<Item = BackendCoord>>(
        &self,
        _: I,
        backend: &mut DB,
        _: (u32, u32),
    ) -> Result<(), DrawingErrorKind<DB::ErrorType>> {
        backend.draw_path(self.points.iter().copied(), &Marked(self.style))
    }
}

struct Marked(ShapeStyle);

impl BackendStyle for Marked {
    fn color(&self) -> BackendColor {
        BackendStyle::color(&self.0)
    }

    fn stroke_width(&self) -> u32 {
        MARK + self.0.stroke_width
    }
}

/// The picture with the points of its curves in pixels.
pub fn in_pixels(svg: &str) -> String {
    const TAG: &str = "<polyline";
    let mut parts = svg.split(TAG);
    let mut out = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        out.push_str(TAG);
        if scaled(part, &mut out).is_none() {
            out.push_str(part);
        }
    }
    out
}

/// Writes what follows the tag of a marked curve; `None`, and nothing written, where it is not marked.
fn scaled(part: &str, out: &mut String) -> Option<()> {
    let (before, rest) = part.split_once("stroke-width=\"")?;
    let (width, rest) = rest.split_once('"')?;
    let width = width.parse::<u32>().ok()?.checked_sub(MARK)?;
    let (between, rest) = rest.split_once("points=\"")?;
    let (points, after) = rest.split_once('"')?;
    let pixels = |part: &str| part.parse::<i32>().ok().map(|part| f64::from(part) / f64::from(FINE));
    let points: Option<Vec<(f64, f64)>> = points
        .split_whitespace()
        .map(|point| point.split_once(',').and_then(|(x, y)| pixels(x).zip(pixels(y))))
        .collect();
    let points = points?.into_iter().fold(String::new(), |mut text, (x, y)| {
        // A String takes whatever is written.
        _ = write!(text, "{x},{y} ");
        text
    });
    _ = write!(
        out,
        "{before}stroke-width=\"{width}\" stroke-linejoin=\"round\"{between}points=\"{}\"{after}",
        points.trim_end()
    );
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn() -> String {
        let mut text = String::new();
        {
            let area = SVGBackend::with_string(&mut text, (200, 100)).into_drawing_area();
            let mut chart = ChartBuilder::on(&area).build_cartesian_2d(0.0..1.0, 0.0..1.0).unwrap();
            // A quarter of a pixel up, then far beyond the edge.
            let slope = curve(
                &chart,
                [(0.0, 0.0), (0.25, 25.0 / 9900.0), (1.0, 7.0)],
                ShapeStyle { stroke_width: 2, ..BLUE.into() },
            );
            chart.draw_series([slope]).unwrap();
            chart.draw_series(LineSeries::new([(0.0, 0.0), (1.0, 1.0)], RED)).unwrap();
            area.present().unwrap();
        }
        in_pixels(&text)
    }

    /// 199 and 99 pixels: a quarter of the way stands at 49.75.
    #[test]
    fn points_between_pixels_are_drawn_there() {
        let text = drawn();
        assert!(
            text.contains("stroke-width=\"2\" stroke-linejoin=\"round\" points=\"0,99 49.75,98.75 199,0\""),
            "{text}"
        );
        assert!(text.contains("stroke-width=\"1\" points=\"0,99 199,0 \""), "{text}");
        assert!(!text.contains("1000"), "{text}");
    }

    #[test]
    fn other_elements_stay_as_they_are() {
        for text in ["", "<svg/>", "<polyline/>", "<polyline stroke-width=\"3\" points=\"1,2 3,4\"/>"] {
            assert_eq!(in_pixels(text), text);
        }
    }
}
