//! A plate from above: where it was hit and seen, what the model leaves there, and where an effect was found.

use orthopanel_model::{Piece, Place};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::{ERROR, FONT, LAST_LABEL, MEASURED, MODEL, WITH_EFFECTS, titled};
use crate::error::Error;
use crate::evidence::{PairResidual, ResidualUnit};

/// Narrower than other pictures: the page shows it whole on a telephone.
const WIDTH: u32 = 640;
/// Greatest height of the map \[pixels\].
const MOST_HIGH: f64 = 440.0;
/// What title, labels and legend take below and above the map \[pixels\], and labels beside it.
const ABOVE: u32 = 165;
const BESIDE: u32 = 70;
/// Radii of the circle of the least and of the greatest residual \[pixels\].
const RADII: [f64; 2] = [4.0, 18.0];
/// Corners of a region's outline.
const CORNERS: usize = 72;

/// Where an effect was found on a plate.
pub struct FoundPlace {
    /// Such as `local-mass`.
    pub name: String,
    pub at: Place,
    /// Half axes of the region that holds the place in 95 of 100 cases \[m\], as if errors along x and along y went each by itself.
    pub region: Option<[f64; 2]>,
    /// Side of the square that it takes up \[m\], where it is more than a point.
    pub span: Option<f64>,
}

/// A circle a place that was hit, the larger the more is left there; a triangle a sensor, a cross an effect.
pub fn plate_map(piece: &Piece, residuals: &[PairResidual], found: &[FoundPlace]) -> Result<String, Error> {
    let (half_x, half_y) = (0.5 * piece.length, 0.5 * piece.width);
    // Circles at an edge stand over it.
    let around = 2.0 * RADII[1];
    let across = f64::from(WIDTH - BESIDE - 2 * LAST_LABEL) - around;
    let scale = (across / piece.length).min(MOST_HIGH / piece.width);
    let [map_width, map_height] = [piece.length, piece.width].map(|side| (scale * side + around) as u32);
    let shown = |half: f64| -half - 0.5 * around / scale..half + 0.5 * around / scale;
    let spare = (WIDTH - BESIDE).saturating_sub(map_width) / 2;
    let greatest = residuals.iter().map(PairResidual::rms).fold(0.0, f64::max);
    let noise = residuals.iter().all(|pair| pair.unit == ResidualUnit::Noise);
    let unit = if noise { "times the noise" } else { "% of the measured rms" };
    // Adding zero takes the sign off a negative one.
    let centimetres = |metres: &f64| format!("{:.2}", (100.0 * metres).round() / 100.0 + 0.0);
    let title = "Places of the test, and what was found";
    titled("map of the plate", title, (WIDTH, map_height + ABOVE), |area| {
        let (area, legend) = area.split_vertically(map_height + 75);
        let mut chart = ChartBuilder::on(&area)
            .margin_top(12)
            .margin_left(spare.saturating_sub(LAST_LABEL))
            .margin_right(spare + LAST_LABEL)
            .x_label_area_size(45)
            .y_label_area_size(BESIDE)
            .build_cartesian_2d(shown(half_x), shown(half_y))?;
        chart
            .configure_mesh()
            .disable_mesh()
            .x_labels(5)
            .y_labels(5)
            .x_label_formatter(&centimetres)
            .y_label_formatter(&centimetres)
            .x_desc("x [m]")
            .y_desc("y [m]")
            .label_style((FONT, 15))
            .draw()?;
        chart.draw_series([Rectangle::new([(-half_x, -half_y), (half_x, half_y)], BLACK.stroke_width(2))])?;
        let radius = |pair: &PairResidual| {
            let part = if greatest > 0.0 { (pair.rms() / greatest).sqrt() } else { 0.0 };
            (RADII[0] + (RADII[1] - RADII[0]) * part).round() as i32
        };
        let at = |place: Place| (place.x, place.y);
        chart.draw_series(
            residuals.iter().map(|pair| Circle::new(at(pair.force), radius(pair), MODEL.mix(0.35).filled())),
        )?;
        chart.draw_series(residuals.iter().map(|pair| Circle::new(at(pair.force), 2, MODEL.filled())))?;
        chart.draw_series(residuals.iter().map(|pair| TriangleMarker::new(at(pair.response), 9, MEASURED.filled())))?;
        for of in found {
            if let Some(span) = of.span {
                let side = |middle: f64, half: f64, sign: f64| (middle + 0.5 * sign * span).clamp(-half, half);
                let corner = |sign: f64| (side(of.at.x, half_x, sign), side(of.at.y, half_y, sign));
                chart.draw_series([Rectangle::new([corner(-1.0), corner(1.0)], WITH_EFFECTS.mix(0.2).filled())])?;
                chart.draw_series([Rectangle::new([corner(-1.0), corner(1.0)], WITH_EFFECTS.stroke_width(2))])?;
            }
            if let Some([along, over]) = of.region {
                let outline = (0..=CORNERS).map(|corner| {
                    let angle = std::f64::consts::TAU * corner as f64 / CORNERS as f64;
                    let inside = |value: f64, half: f64| value.clamp(-half, half);
                    (inside(of.at.x + along * angle.cos(), half_x), inside(of.at.y + over * angle.sin(), half_y))
                });
                chart.draw_series([PathElement::new(outline.collect::<Vec<_>>(), WITH_EFFECTS.stroke_width(2))])?;
            }
            chart.draw_series([Cross::new(at(of.at), 8, WITH_EFFECTS.stroke_width(3))])?;
            // Off the square and the region, on the side of the middle.
            let [region_x, region_y] = of.region.unwrap_or_default();
            let half_span = 0.5 * of.span.unwrap_or(0.0);
            let (side, x) = if of.at.x > 0.0 { (HPos::Right, 1.0) } else { (HPos::Left, -1.0) };
            let (end, y, off) = if of.at.y > 0.0 { (VPos::Top, -1.0, 12) } else { (VPos::Bottom, 1.0, -12) };
            let corner = (of.at.x + x * region_x.max(half_span), of.at.y + y * region_y.max(half_span));
            let corner = (corner.0.clamp(-half_x, half_x), corner.1.clamp(-half_y, half_y));
            let style = (FONT, 16).into_font().color(&WITH_EFFECTS).pos(Pos::new(side, end));
            chart.draw_series([EmptyElement::at(corner) + Text::new(of.name.clone(), (0, off), style)])?;
        }
        let said = (FONT, 15).into_font().color(&ERROR);
        let line = |row: i32| 4 + 22 * row;
        legend.draw(&Circle::new((BESIDE as i32, line(0) + 7), 9, MODEL.mix(0.35).filled()))?;
        legend.draw(&Circle::new((BESIDE as i32, line(0) + 7), 2, MODEL.filled()))?;
        let most = format!("hit, with what the model leaves there: {greatest:.2} {unit} at the largest circle");
        legend.draw(&Text::new(most, (BESIDE as i32 + 16, line(0)), said.clone()))?;
        legend.draw(&TriangleMarker::new((BESIDE as i32, line(1) + 7), 9, MEASURED.filled()))?;
        legend.draw(&Text::new("sensor", (BESIDE as i32 + 16, line(1)), said.clone()))?;
        if !found.is_empty() {
            let beside = BESIDE as i32 + 120;
            legend.draw(&Cross::new((beside, line(1) + 7), 8, WITH_EFFECTS.stroke_width(3)))?;
            let what = "found, with the region that holds it in 95 of 100 cases";
            legend.draw(&Text::new(what, (beside + 16, line(1)), said))?;
        }
        Ok(())
    })
}
