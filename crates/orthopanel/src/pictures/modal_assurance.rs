//! Modal assurance criteria: measured modes against those of the model.

use orthopanel_identify::ModalAssurance;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::residual::{Rows, WIDTH};
use super::shade_scale::shade_scale;
use super::{FONT, LAST_LABEL, MEASURED, MODEL, titled};
use crate::error::Error;

/// Room for the frequencies of the rows \[pixels\].
const NAMES: u32 = 110;
/// Height of a row \[pixels\]: of few modes, and of many.
const ROWS: [u32; 2] = [22, 44];
/// Height of the fields of few modes together \[pixels\].
const FIELDS: u32 = 440;
/// Height of the title, and of the scale at the bottom \[pixels\].
const TITLE: i32 = 30;
const SCALE_HEIGHT: i32 = 34;
/// Modes of the model up to which a field holds its number.
const NUMBERED: usize = 14;
/// A shade from which letters on it are white.
const DARK: f64 = 0.5;

/// A field a measured mode and mode of the model: the darker, the more alike their shapes are. `frequencies` \[Hz\] are those measured, and `partners` the
/// numbers, from 1, of the modes that they are matched with, which have a frame.
pub fn modal_assurance(
    piece: &str,
    frequencies: &[f64],
    partners: &[Option<usize>],
    assurance: &ModalAssurance,
) -> Result<String, Error> {
    let (rows, columns) = (frequencies.len(), assurance.frequencies.len());
    let row = (FIELDS / rows.max(1) as u32).clamp(ROWS[0], ROWS[1]);
    let height = 90 + SCALE_HEIGHT as u32 + row * rows.max(1) as u32;
    let title = format!("Piece {piece}: modal assurance criterion, measured modes against the model's");
    titled("modal assurance", &title, (WIDTH, height), |area| {
        let (area, scale) = area.split_vertically(height as i32 - TITLE - SCALE_HEIGHT);
        let mut chart = ChartBuilder::on(&area)
            .margin(12)
            .margin_right(LAST_LABEL)
            .x_label_area_size(45)
            .y_label_area_size(NAMES)
            .build_cartesian_2d(0.5..columns as f64 + 0.5, Rows::of(rows))?;
        let name = |height: &f64| {
            let of_row = frequencies.iter().rev().nth(height.max(0.0) as usize);
            of_row.map_or(String::new(), |frequency| format!("{frequency:.1} Hz"))
        };
        chart
            .configure_mesh()
            .disable_mesh()
            .x_labels(columns.min(2 * NUMBERED))
            .x_label_formatter(&|mode| format!("{mode:.0}"))
            .y_label_formatter(&name)
            .x_desc("mode of the model")
            .label_style((FONT, 15))
            .draw()?;
        let field = |measured: usize, mode: usize| {
            let low = (rows - 1 - measured) as f64;
            [(mode as f64 - 0.5, low), (mode as f64 + 0.5, low + 1.0)]
        };
        for (measured, criteria) in assurance.of_poles.iter().enumerate() {
            for (mode, &criterion) in (1..).zip(criteria) {
                let shade = MODEL.mix(criterion).filled();
                chart.draw_series([Rectangle::new(field(measured, mode), shade)])?;
                if columns <= NUMBERED {
                    let color = if criterion > DARK { &WHITE } else { &BLACK };
                    let style = (FONT, 14).into_font().color(color).pos(Pos::new(HPos::Center, VPos::Center));
                    let middle = (mode as f64, (rows - 1 - measured) as f64 + 0.5);
                    chart.draw_series([Text::new(format!("{criterion:.2}"), middle, style)])?;
                }
            }
        }
        for (measured, mode) in partners.iter().enumerate() {
            let Some(mode) = mode.filter(|mode| *mode <= columns) else { continue };
            chart.draw_series([Rectangle::new(field(measured, mode), MEASURED.stroke_width(2))])?;
        }
        shade_scale(&scale, NAMES as i32 + 12, ["0".to_owned(), "1: the same shape".to_owned()])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pair_of_modes_has_a_field_with_its_number_and_partners_a_frame() {
        let of_poles = vec![vec![0.99, 0.02, 0.1], vec![0.01, 0.13, 0.97]];
        let assurance = ModalAssurance { frequencies: vec![320.0, 600.0, 840.0], of_poles };
        let picture = modal_assurance("1", &[321.3, 837.5], &[Some(1), Some(3)], &assurance).expect("a picture");
        for text in ["0.99", "0.13", "0.97", "321.3 Hz", "837.5 Hz", "mode of the model"] {
            assert!(picture.contains(text), "{text}: {picture}");
        }
        let frames = picture.split("<rect ").filter(|part| part.contains("fill=\"none\"") && part.contains("#D55E00"));
        assert_eq!(frames.count(), 2, "{picture}");
    }

    #[test]
    fn of_many_modes_fields_stand_without_numbers() {
        let frequencies: Vec<f64> = (1..=30).map(|mode| 10.0 * f64::from(mode)).collect();
        let of_poles = vec![vec![0.5; 30]; 30];
        let assurance = ModalAssurance { frequencies: frequencies.clone(), of_poles };
        let picture = modal_assurance("1", &frequencies, &[None; 30], &assurance).expect("a picture");
        assert!(!picture.contains("0.50") && picture.contains("300.0 Hz"), "{picture}");
    }
}
