//! What the model leaves unexplained: against frequency, against the place, against the level of the hit.

use std::ops::Range;

use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use super::curve::curve;
use super::{ERROR, FONT, GRID, LAST_LABEL, MEASURED, MODEL, spaced, titled};
use crate::error::Error;
use crate::evidence::{PairResidual, ResidualUnit, banded};
use crate::measured_pairs::place_text;

pub(super) const WIDTH: u32 = 900;
/// Bands of frequency over which residuals are averaged.
const BANDS: usize = 80;
/// Height of a row of the places \[pixels\].
pub(super) const ROW: u32 = 24;
/// Width of a letter of the names of rows, and the least of all names \[pixels\].
const LETTER: u32 = 8;
const LEAST_NAMES: u32 = 150;

fn unit_text(residuals: &[PairResidual]) -> &'static str {
    match residuals.first().map(|pair| pair.unit) {
        Some(ResidualUnit::Noise) => "residual over noise, rms",
        _ => "residual [% of measured rms]",
    }
}

/// A thin line a pair of places, a thick one for all of them.
pub fn residual_by_frequency(residuals: &[PairResidual]) -> Result<String, Error> {
    let lines = || residuals.iter().flat_map(|pair| &pair.lines);
    let highest = lines().map(|(frequency, _)| *frequency).fold(1.0, f64::max);
    let pairs: Vec<_> = residuals.iter().map(|pair| banded(pair.lines.iter(), highest, BANDS)).collect();
    let all = banded(lines(), highest, BANDS);
    let sizes = || pairs.iter().flatten().map(|(_, size)| *size).filter(|size| *size > 0.0);
    let noise = residuals.iter().all(|pair| pair.unit == ResidualUnit::Noise);
    let low = sizes().fold(if noise { 0.5 } else { f64::INFINITY }, f64::min);
    let high = sizes().fold(if noise { 2.0 } else { 0.0 }, f64::max);
    let (low, high) = if low < high { (0.8 * low, 1.25 * high) } else { (0.1, 10.0) };
    titled("residual by frequency", "Residual against frequency", (WIDTH, 340), |area| {
        let mut chart = ChartBuilder::on(&area)
            .margin(12)
            .margin_right(LAST_LABEL)
            .x_label_area_size(45)
            .y_label_area_size(70)
            .build_cartesian_2d(0.0..highest, (low..high).log_scale())?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(GRID)
            .x_label_formatter(&|frequency| format!("{frequency:.0}"))
            .y_label_formatter(&|size| format!("{size}"))
            .x_desc("frequency [Hz]")
            .y_desc(unit_text(residuals))
            .label_style((FONT, 15))
            .draw()?;
        if noise {
            chart.draw_series(LineSeries::new([(0.0, 1.0), (highest, 1.0)], BLACK.mix(0.6)))?;
        }
        if pairs.len() > 1 {
            for pair in pairs {
                let pair = curve(&chart, pair, MODEL.mix(0.35));
                chart.draw_series([pair])?;
            }
        }
        let all = curve(&chart, all, MODEL.stroke_width(3));
        chart.draw_series([all])?;
        Ok(())
    })
}

/// A bar a pair of places.
pub fn residual_by_place(residuals: &[PairResidual]) -> Result<String, Error> {
    let count = residuals.len();
    let highest = residuals.iter().map(PairResidual::rms).fold(0.0, f64::max);
    let noise = residuals.iter().all(|pair| pair.unit == ResidualUnit::Noise);
    let highest = if highest > 0.0 { highest.max(if noise { 1.2 } else { 0.0 }) } else { 1.0 };
    let height = 105 + ROW * count.max(1) as u32;
    let title = "Residual of each pair of places, force to response [m]";
    titled("residual by place", title, (WIDTH, height), |area| {
        let mut chart = ChartBuilder::on(&area)
            .margin(12)
            .margin_right(LAST_LABEL)
            .x_label_area_size(45)
            .y_label_area_size(names_width(residuals))
            .build_cartesian_2d(0.0..1.05 * highest, Rows::of(count))?;
        chart
            .configure_mesh()
            .disable_y_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(GRID)
            .y_label_formatter(&place_names(residuals))
            .x_desc(unit_text(residuals))
            .label_style((FONT, 15))
            .draw()?;
        for (index, pair) in residuals.iter().enumerate() {
            let middle = (count - 1 - index) as f64 + 0.5;
            let mut bar = Rectangle::new([(0.0, middle - 0.5), (pair.rms(), middle + 0.5)], MODEL.filled());
            bar.set_margin(4, 4, 0, 0);
            chart.draw_series([bar])?;
        }
        if noise {
            chart.draw_series(LineSeries::new([(1.0, 0.0), (1.0, count as f64)], ERROR.stroke_width(2)))?;
        }
        Ok(())
    })
}

fn name_of(pair: &PairResidual) -> String {
    format!("{} to {}", place_text(pair.force), place_text(pair.response))
}

/// The pair of a row about this height: the first on top, each one high.
pub(super) fn place_names(residuals: &[PairResidual]) -> impl Fn(&f64) -> String {
    |height| residuals.iter().rev().nth(height.max(0.0) as usize).map_or(String::new(), name_of)
}

/// What the longest of these names takes \[pixels\].
pub(super) fn names_width(residuals: &[PairResidual]) -> u32 {
    let longest = residuals.iter().map(|pair| name_of(pair).len()).max().unwrap_or(0);
    (LETTER * longest as u32).max(LEAST_NAMES)
}

/// An axis of so many rows, a tick in the middle of each.
pub(super) struct Rows {
    count: usize,
    range: RangedCoordf64,
}

impl Rows {
    pub(super) fn of(count: usize) -> Self {
        Self { count, range: (0.0..count as f64).into() }
    }
}

impl Ranged for Rows {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        self.range.map(value, limit)
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        (0..self.count).map(|row| row as f64 + 0.5).collect()
    }

    fn range(&self) -> Range<f64> {
        self.range.range()
    }
}

/// A dot a hit: its greatest force \[N\], and how far the calculated acceleration is from the measured one \[% of peak\].
pub fn residual_by_level(points: &[(f64, f64)]) -> Result<String, Error> {
    let highest = |of: fn(&(f64, f64)) -> f64| 1.1 * points.iter().map(of).fold(f64::MIN_POSITIVE, f64::max);
    let across = spaced(points.iter().map(|point| point.0));
    titled("residual by level", "Misfit of each hit against its level", (WIDTH, 300), |area| {
        let mut chart = ChartBuilder::on(&area)
            .margin(12)
            .margin_right(LAST_LABEL)
            .x_label_area_size(45)
            .y_label_area_size(70)
            .build_cartesian_2d(across, 0.0..highest(|point| point.1))?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(GRID)
            .x_label_formatter(&|force| format!("{force:.0}"))
            .x_desc("greatest force of the hit [N]")
            .y_desc("misfit [% of peak]")
            .label_style((FONT, 15))
            .draw()?;
        chart.draw_series(points.iter().map(|&point| Circle::new(point, 5, MEASURED.filled())))?;
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use orthopanel_model::Place;

    use super::*;

    /// Bars are the blue rectangles.
    #[test]
    fn every_pair_of_places_has_its_bar_and_its_name() {
        let pair = |x: f64| PairResidual {
            force: Place { x, y: 0.0 },
            response: Place { x: 0.3, y: 0.0 },
            unit: ResidualUnit::Noise,
            lines: vec![(10.0, 2.0)],
        };
        for count in [1, 2, 5] {
            let pairs: Vec<PairResidual> = (0..count).map(|index| pair(-0.1 * index as f64)).collect();
            let picture = residual_by_place(&pairs).expect("a picture");
            let bars: Vec<&str> = picture.split("<rect ").filter(|part| part.contains("#005AAA")).collect();
            assert_eq!(bars.len(), count, "{picture}");
            assert!(bars.iter().all(|bar| !bar.contains("width=\"0\"") && !bar.contains("height=\"0\"")), "{bars:?}");
            assert_eq!(picture.matches(" to 0.3").count(), count);
        }
    }
}
