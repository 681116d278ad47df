//! Coherence of the records: how much of the acceleration answers the force.

use orthopanel_data::Accelerance;
use plotters::prelude::*;

use super::curve::curve;
use super::envelope::envelope;
use super::{FONT, GRID, LAST_LABEL, MODEL, titled};
use crate::error::Error;

const SIZE: (u32, u32) = (900, 300);

/// A line a record; `None` where no record tells it.
pub fn coherence(piece: &str, records: &[&Accelerance]) -> Result<Option<String>, Error> {
    let told: Vec<(&Accelerance, &Vec<f64>)> =
        records.iter().filter_map(|record| Some((*record, record.coherence.as_ref()?))).collect();
    if told.is_empty() {
        return Ok(None);
    }
    let highest = told.iter().filter_map(|(record, _)| record.frequency.last()).fold(1.0_f64, |a, b| a.max(*b));
    let title = format!("Piece {piece}: coherence of {} records", told.len());
    let colour = MODEL.mix(if told.len() == 1 { 1.0 } else { 0.5 });
    let drawn = titled("coherence", &title, SIZE, |area| {
        let mut chart = ChartBuilder::on(&area)
            .margin(12)
            .margin_right(LAST_LABEL)
            .x_label_area_size(45)
            .y_label_area_size(70)
            .build_cartesian_2d(0.0..highest, 0.0..1.05)?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(GRID)
            .x_label_formatter(&|frequency| format!("{frequency:.0}"))
            .y_labels(6)
            .x_desc("frequency [Hz]")
            .y_desc("coherence")
            .label_style((FONT, 15))
            .draw()?;
        for (record, coherence) in &told {
            let points = record.frequency.iter().copied().zip(coherence.iter().copied()).collect();
            let points = curve(&chart, envelope(points), colour);
            chart.draw_series([points])?;
        }
        Ok(())
    });
    drawn.map(Some)
}
