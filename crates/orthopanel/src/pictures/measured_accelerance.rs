//! Measured against calculated accelerance, as the paper's figures 5 to 8.

use orthopanel_identify::AcceleranceFit;
use plotters::prelude::*;

use super::curve::curve;
use super::envelope::envelope;
use super::frequency_axes::{self, degrees};
use super::{FONT, GRID, MEASURED, MODEL, stacked};
use crate::error::Error;
use crate::measured_pairs::place_text;

/// Least measured magnitude that stretches the axis, over the greatest \[1\]; calculated valleys have no floor at all.
const DEPTH: f64 = 1e-6;

/// Both curves carry the decay rate of the window over the records alike.
pub fn measured_accelerance(piece: &str, fit: &AcceleranceFit) -> Result<String, Error> {
    let (force, response) = (place_text(fit.force_at), place_text(fit.response_at));
    let decay_rate = fit.decay_rate;
    let window = if decay_rate > 0.0 { format!(", window exp(-{decay_rate:.3} t)") } else { String::new() };
    let title = format!("Piece {piece}: accelerance, force at {force} m, response at {response} m{window}");
    let highest = fit.frequency.last().copied().unwrap_or(1.0);
    let greatest = fit.measured.iter().chain(&fit.model).map(|value| value.norm()).fold(0.0, f64::max);
    let greatest = if greatest > 0.0 { greatest } else { 1.0 };
    let sizes = fit.measured.iter().map(|value| value.norm()).filter(|size| *size > DEPTH * greatest);
    let low = 0.5 * sizes.fold(greatest, f64::min);
    stacked("measured accelerance", &title, [360, 240], |[upper, lower]| {
        let mut chart = frequency_axes::magnitude(upper, highest, low, 2.0 * greatest)?;
        let curves = [("measured", &fit.measured, MEASURED, 3), ("calculated", &fit.model, MODEL, 1)];
        for (label, values, colour, width) in curves {
            let sizes = fit.frequency.iter().zip(values).map(|(&line, value)| (line, value.norm().max(low)));
            let sizes = curve(&chart, envelope(sizes.collect()), colour.stroke_width(width));
            chart
                .draw_series([sizes])?
                .label(label)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], colour.stroke_width(width)));
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::LowerRight)
            .background_style(WHITE)
            .border_style(GRID)
            .label_font((FONT, 15))
            .draw()?;

        let mut chart = frequency_axes::phase(lower, highest)?;
        for (_, values, colour, width) in curves {
            let phases = fit.frequency.iter().zip(values).map(|(&line, value)| (line, degrees(value.arg())));
            let phases = curve(&chart, envelope(phases.collect()), colour.stroke_width(width));
            chart.draw_series([phases])?;
        }
        Ok(())
    })
}
