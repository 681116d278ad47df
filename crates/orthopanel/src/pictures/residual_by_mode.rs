//! What the model leaves at each place about each mode.

use plotters::prelude::*;

use super::residual::{ROW, Rows, WIDTH, names_width, place_names};
use super::shade_scale::{SCALE_AREA, shade_scale};
use super::{FONT, LAST_LABEL, MODEL, titled};
use crate::error::Error;
use crate::evidence::{PairResidual, ResidualUnit};

/// A field a pair of places and mode: the darker, the more is left of the lines to which no other of the `modes` \[Hz\] is nearer.
pub fn residual_by_place_and_mode(residuals: &[PairResidual], modes: &[f64]) -> Result<String, Error> {
    let (count, columns) = (residuals.len(), modes.len());
    let sizes: Vec<Vec<Option<f64>>> = residuals.iter().map(|pair| pair.by_mode(modes)).collect();
    let noise = residuals.iter().all(|pair| pair.unit == ResidualUnit::Noise);
    // Noise is white; beyond it each step multiplies.
    let least = if noise { 1.0 } else { 0.0 };
    let most = sizes.iter().flatten().flatten().copied().fold(if noise { 2.0 } else { f64::MIN_POSITIVE }, f64::max);
    let part = |size: f64| if noise { size.max(1.0).ln() / most.ln() } else { size / most };
    let unit = if noise { "times the noise" } else { "% of the measured rms" };
    let names = names_width(residuals);
    let height = 150 + ROW * count.max(1) as u32;
    titled("residual by place and mode", "Residual of each pair of places about each mode", (WIDTH, height), |area| {
        let (area, scale) = area.split_vertically(height as i32 - SCALE_AREA);
        let mut chart = ChartBuilder::on(&area)
            .margin(12)
            .margin_right(LAST_LABEL)
            .x_label_area_size(45)
            .y_label_area_size(names)
            .build_cartesian_2d(0.5..columns as f64 + 0.5, Rows::of(count))?;
        chart
            .configure_mesh()
            .disable_mesh()
            .x_label_formatter(&|mode| format!("{mode:.0}"))
            .y_label_formatter(&place_names(residuals))
            .x_desc("measured mode")
            .label_style((FONT, 15))
            .draw()?;
        for (pair, sizes) in sizes.iter().enumerate() {
            let low = (count - 1 - pair) as f64;
            for (mode, size) in (1..).zip(sizes) {
                let Some(size) = size else { continue };
                let (left, right) = (f64::from(mode) - 0.5, f64::from(mode) + 0.5);
                let field = [(left, low), (right, low + 1.0)];
                chart.draw_series([Rectangle::new(field, MODEL.mix(part(*size)).filled())])?;
            }
        }
        shade_scale(&scale, names as i32 + 12, [format!("{least:.0}"), format!("{most:.2} {unit}")])?;
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use orthopanel_model::Place;

    use super::super::shade_scale::STEPS;
    use super::*;

    /// Blue rectangles are fields and the steps of the scale; noise alone stays white. A name longer than its room would be cut off.
    #[test]
    fn every_place_has_a_field_for_each_mode_above_noise_and_room_for_its_name() {
        let at = |x: f64| Place { x, y: -0.179 };
        let pair = |number: u32| PairResidual {
            force: at(-0.001 * f64::from(300 + number)),
            response: at(-0.298),
            unit: ResidualUnit::Noise,
            lines: vec![(10.0, 2.0), (21.0, 5.0), (29.0, 0.9)],
        };
        let pairs: Vec<PairResidual> = (0..7).map(pair).collect();
        let picture = residual_by_place_and_mode(&pairs, &[10.0, 20.0, 30.0]).expect("a picture");
        let fields = picture.split("<rect ").filter(|part| part.contains("#005AAA")).count();
        assert_eq!(fields, 7 * 2 + STEPS, "{picture}");
        assert_eq!(picture.matches(" to -0.298,-0.179").count(), 7);
        assert!(names_width(&pairs) >= 7 * "-0.306,-0.179 to -0.298,-0.179".len() as u32);
        assert!(picture.contains("5.00 times the noise"), "{picture}");
    }
}
