//! A measured hit, and the accelerations measured and calculated under it, as the paper's figures 9 to 12.

use orthopanel_data::Hit;
use plotters::prelude::*;

use super::curve::curve;
use super::envelope::envelope;
use super::{Area, Drawn, ERROR, FONT, GRID, LAST_LABEL, MEASURED, MODEL, spaced, stacked};
use crate::error::Error;
use crate::measured_pairs::{ComparedPair, place_text};

/// What the two upper charts show \[s\], from before the blow: later the ringing is a solid band.
const SHOWN: f64 = 0.02;
/// Of that, before the force is greatest \[s\].
const BEFORE: f64 = 0.001;

struct Signal<'a> {
    label: &'static str,
    values: &'a [f64],
    colour: RGBColor,
    width: u32,
}

pub fn time_history(piece: &str, pair: &ComparedPair) -> Result<String, Error> {
    let index = pair.shown();
    let history = &pair.history;
    let (Some(hit), Some(compared)) = (history.hits.get(index), pair.hits.get(index)) else {
        return Err(Error::Picture { name: "time history", problem: "there is no hit".into() });
    };
    let (force, response) = (place_text(history.force_at), place_text(history.response_at));
    let title = format!("Piece {piece}: hit {} at {force} m, response at {response} m", index + 1);
    let compared = &compared.whole;
    let error: Vec<f64> = compared.measured.iter().zip(&compared.calculated).map(|(m, c)| m - c).collect();
    let signal = |label, values, colour, width| Signal { label, values, colour, width };
    let measured = || signal("measured", &compared.measured, MEASURED, 3);
    let from = blow(hit).saturating_sub((BEFORE * history.rate) as usize);
    let close = from..from + (SHOWN * history.rate) as usize;
    let rate = history.rate;
    stacked("time history", &title, [160, 240, 200], |[top, middle, bottom]| {
        draw(top, rate, close.clone(), "force [N]", &[signal("", &hit.force, MEASURED, 2)])?;
        let calculated = signal("calculated", &compared.calculated, MODEL, 1);
        draw(middle, rate, close.clone(), "acceleration [m/s²]", &[measured(), calculated])?;
        let missed = signal("measured less calculated", &error, ERROR, 1);
        draw(bottom, rate, 0..error.len(), "acceleration [m/s²]", &[measured(), missed])
    })
}

/// The sample of the greatest force.
fn blow(hit: &Hit) -> usize {
    let sizes = hit.force.iter().map(|force| force.abs()).enumerate();
    sizes.fold((0, 0.0), |best, (index, size)| if size > best.1 { (index, size) } else { best }).0
}

fn draw(area: &Area, rate: f64, samples: std::ops::Range<usize>, what: &str, signals: &[Signal]) -> Drawn {
    let time = |sample: usize| 1000.0 * sample as f64 / rate;
    let points = |values: &[f64]| -> Vec<(f64, f64)> {
        let shown = values.iter().enumerate().skip(samples.start).take(samples.len());
        envelope(shown.map(|(sample, &value)| (time(sample), value)).collect())
    };
    let heights = signals.iter().flat_map(|signal| points(signal.values)).map(|(_, height)| height);
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .margin_right(LAST_LABEL)
        .x_label_area_size(40)
        .y_label_area_size(70)
        .build_cartesian_2d(time(samples.start)..time(samples.end), spaced(heights))?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(GRID)
        .y_labels(6)
        .x_label_formatter(&|time| format!("{time:.0}"))
        .y_label_formatter(&|value| format!("{value:.0}"))
        .x_desc("time [ms]")
        .y_desc(what)
        .label_style((FONT, 15))
        .draw()?;
    for signal in signals {
        let style = signal.colour.stroke_width(signal.width);
        let drawn = curve(&chart, points(signal.values), style);
        let drawn = chart.draw_series([drawn])?;
        if signals.len() > 1 {
            drawn.label(signal.label).legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], style));
        }
    }
    if signals.len() > 1 {
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperRight)
            .background_style(WHITE)
            .border_style(GRID)
            .label_font((FONT, 15))
            .draw()?;
    }
    Ok(())
}
