//! How a continuous record was cut into hits: the force, the level, and what each hit is.

use orthopanel_data::Cut;
use plotters::prelude::*;

use super::curve::curve;
use super::{ERROR, FONT, GRID, LAST_LABEL, MEASURED, MODEL, spaced, titled};
use crate::error::Error;

const SIZE: (u32, u32) = (900, 300);

pub fn cut(piece: &str, cut: &Cut) -> Result<String, Error> {
    let count = cut.hits.len();
    let left_out = match cut.left_out.len() {
        0 => String::new(),
        blows => format!(", {blows} left out (grey)"),
    };
    let title = format!("Piece {piece}: a record of {:.2} s, cut into {count} hits (blue){left_out}", cut.duration);
    titled("cut", &title, SIZE, |area| {
        let heights = spaced(cut.force.iter().flatten().copied().chain([cut.level]));
        let mut chart = ChartBuilder::on(&area)
            .margin(12)
            .margin_right(LAST_LABEL)
            .x_label_area_size(45)
            .y_label_area_size(70)
            .build_cartesian_2d(0.0..cut.duration, heights.clone())?;
        let bands = cut
            .hits
            .iter()
            .map(|[from, to]| Rectangle::new([(*from, heights.start), (*to, heights.end)], MODEL.mix(0.12).filled()));
        chart.draw_series(bands)?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(GRID)
            .y_labels(6)
            .x_desc("time [s]")
            .y_desc("force [N]")
            .label_style((FONT, 15))
            .draw()?;
        let step = cut.duration / cut.force.len().max(1) as f64;
        let points = cut.force.iter().enumerate().flat_map(|(at, [least, most])| {
            let time = (at as f64 + 0.5) * step;
            [(time, *least), (time, *most)]
        });
        let force = curve(&chart, points.collect::<Vec<_>>(), MEASURED);
        chart.draw_series([force])?;
        let level = curve(&chart, [(0.0, cut.level), (cut.duration, cut.level)], MODEL);
        chart.draw_series([level])?;
        for time in &cut.left_out {
            let mark = curve(&chart, [(*time, heights.start), (*time, heights.end)], ERROR);
            chart.draw_series([mark])?;
        }
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cut_is_drawn_with_its_hits() {
        let force = (0..200).map(|at| [-0.1, if at % 50 == 5 { 80.0 } else { 0.1 }]).collect();
        let drawn = Cut { duration: 8.0, force, level: 8.0, hits: vec![[0.1, 1.9], [2.1, 3.9]], left_out: vec![6.2] };
        let picture = cut("1", &drawn).expect("a picture");
        assert!(picture.contains("cut into 2 hits (blue), 1 left out (grey)"), "{picture}");
        assert_eq!(picture.matches("<rect").count(), 1 + 2, "the ground and two hits");
    }
}
