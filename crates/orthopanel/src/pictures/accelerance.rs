//! Accelerance of the identified model between its first ports, over the measured natural frequencies.

use orthopanel_identify::PieceFit;
use orthopanel_model::{ModalModel, Place, Ports};
use plotters::prelude::*;

use super::{FONT, GRID, MEASURED, MODEL, stacked};
use crate::error::CommandError;

/// Lines drawn, and drawn again around each peak, which at zeta = 0.001 is a hundredth of that spacing wide.
const LINES: u32 = 1500;

/// `seen` is the model from `ports`, with modes enough for the valleys too.
pub fn accelerance(fit: &PieceFit, ports: &Ports, seen: &ModalModel) -> Result<String, CommandError> {
    let tau = std::f64::consts::TAU;
    let flexible = || seen.modes().iter().map(|mode| mode.angular_frequency / tau).filter(|&frequency| frequency > 0.0);
    let highest = fit.modes.iter().map(|mode| mode.measured).fold(0.0, f64::max);
    let highest = 1.12 * if highest > 0.0 { highest } else { flexible().nth(5).unwrap_or(1.0) };
    let mut lines: Vec<f64> = (1..=LINES).map(|line| highest * f64::from(line) / f64::from(LINES)).collect();
    for peak in flexible().take_while(|&peak| peak < highest) {
        lines.extend((-20..=20).map(|line| peak * (1.0 + 5e-4 * f64::from(line))).filter(|&line| line <= highest));
    }
    lines.sort_by(f64::total_cmp);
    let values: Vec<_> = lines.iter().map(|&line| (line, seen.accelerance(0, 0, line))).collect();
    let sizes = || values.iter().map(|(_, value)| value.norm()).filter(|size| *size > 0.0);
    let (low, high) = (sizes().fold(f64::INFINITY, f64::min), sizes().fold(0.0, f64::max));
    let (low, high) = if low <= high { (0.5 * low, 2.0 * high) } else { (0.1, 10.0) };
    let (from, to) = (ports.forces.first(), ports.responses.first());
    let at = |place: Option<&Place>| place.map_or(String::new(), |place| format!("({}, {}) m", place.x, place.y));
    let title = format!("Piece {}: accelerance, force at {}, response at {}", fit.name, at(from), at(to));
    stacked("accelerance", &title, [360, 240], |[upper, lower]| {
        let mut chart = ChartBuilder::on(upper)
            .margin(12)
            .x_label_area_size(30)
            .y_label_area_size(70)
            .build_cartesian_2d(0.0..highest, (low..high).log_scale())?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(GRID)
            .x_label_formatter(&|frequency| format!("{frequency:.0}"))
            .y_label_formatter(&|size| if (0.01..1e4).contains(size) { format!("{size}") } else { format!("{size:e}") })
            .y_desc("magnitude [(m/s²)/N]")
            .label_style((FONT, 15))
            .draw()?;
        for (index, mode) in fit.modes.iter().enumerate() {
            let drawn = chart.draw_series(LineSeries::new([(mode.measured, low), (mode.measured, high)], MEASURED))?;
            if index == 0 {
                drawn
                    .label("measured natural frequencies")
                    .legend(|(x, y)| PathElement::new([(x, y), (x + 16, y)], MEASURED));
            }
        }
        let magnitude = values.iter().map(|(line, value)| (*line, value.norm().max(low)));
        chart
            .draw_series(LineSeries::new(magnitude, MODEL.stroke_width(2)))?
            .label("model")
            .legend(|(x, y)| PathElement::new([(x, y), (x + 16, y)], MODEL.stroke_width(2)));
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::LowerRight)
            .background_style(WHITE)
            .border_style(GRID)
            .label_font((FONT, 15))
            .draw()?;

        let mut chart = ChartBuilder::on(lower)
            .margin(12)
            .x_label_area_size(45)
            .y_label_area_size(70)
            .build_cartesian_2d(0.0..highest, -190.0..190.0)?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(GRID)
            .x_label_formatter(&|frequency| format!("{frequency:.0}"))
            .y_label_formatter(&|phase| format!("{phase:.0}"))
            .x_desc("frequency [Hz]")
            .y_desc("phase [degrees]")
            .label_style((FONT, 15))
            .draw()?;
        let phase = values.iter().map(|(line, value)| (*line, value.arg().to_degrees()));
        chart.draw_series(LineSeries::new(phase, MODEL.stroke_width(2)))?;
        Ok(())
    })
}
