//! Accelerance of the identified model between its first ports, over the measured natural frequencies.

use orthopanel_identify::PieceFit;
use orthopanel_model::Place;
use plotters::prelude::*;

use super::curve::curve;
use super::frequency_axes::{self, degrees};
use super::{FONT, GRID, MEASURED, MODEL, stacked};
use crate::error::Error;
use crate::measured_pairs::place_text;
use crate::whole_accelerance::WholeAccelerance;

/// Lines drawn, and drawn again around each peak, which at zeta = 0.001 is a hundredth of that spacing wide.
const LINES: u32 = 1500;

/// `seen` is the model's, from the first of `places` to the second.
pub fn accelerance(fit: &PieceFit, places: [Place; 2], seen: &WholeAccelerance) -> Result<String, Error> {
    let highest = fit.modes.iter().map(|mode| mode.measured).fold(0.0, f64::max);
    let highest = 1.12 * if highest > 0.0 { highest } else { seen.natural_frequencies().nth(5).unwrap_or(1.0) };
    let mut lines: Vec<f64> = (1..=LINES).map(|line| highest * f64::from(line) / f64::from(LINES)).collect();
    for peak in seen.natural_frequencies().take_while(|&peak| peak < highest) {
        lines.extend((-20..=20).map(|line| peak * (1.0 + 5e-4 * f64::from(line))).filter(|&line| line <= highest));
    }
    lines.sort_by(f64::total_cmp);
    let values: Vec<_> = lines.iter().map(|&line| (line, seen.at(line))).collect();
    let sizes = || values.iter().map(|(_, (re, im))| re.hypot(*im)).filter(|size| *size > 0.0);
    let (low, high) = (sizes().fold(f64::INFINITY, f64::min), sizes().fold(0.0, f64::max));
    let (low, high) = if low <= high { (0.5 * low, 2.0 * high) } else { (0.1, 10.0) };
    let [from, to] = places.map(place_text);
    let title = format!("Piece {}: accelerance, force at {from} m, response at {to} m", fit.name);
    stacked("accelerance", &title, [360, 240], |[upper, lower]| {
        let mut chart = frequency_axes::magnitude(upper, highest, low, high)?;
        for (index, mode) in fit.modes.iter().enumerate() {
            let drawn = chart.draw_series(LineSeries::new([(mode.measured, low), (mode.measured, high)], MEASURED))?;
            if index == 0 {
                drawn
                    .label("measured natural frequencies")
                    .legend(|(x, y)| PathElement::new([(x, y), (x + 16, y)], MEASURED));
            }
        }
        let magnitude = values.iter().map(|(line, (re, im))| (*line, re.hypot(*im).max(low)));
        let magnitude = curve(&chart, magnitude, MODEL.stroke_width(2));
        chart
            .draw_series([magnitude])?
            .label("model")
            .legend(|(x, y)| PathElement::new([(x, y), (x + 16, y)], MODEL.stroke_width(2)));
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::LowerRight)
            .background_style(WHITE)
            .border_style(GRID)
            .label_font((FONT, 15))
            .draw()?;

        let mut chart = frequency_axes::phase(lower, highest)?;
        let phase = values.iter().map(|(line, (re, im))| (*line, degrees(im.atan2(*re))));
        let phase = curve(&chart, phase, MODEL.stroke_width(2));
        chart.draw_series([phase])?;
        Ok(())
    })
}
