//! The constants with their intervals, and how well the model meets the test.

use orthopanel_identify::{Identification, IdentifiedConstant};
use orthopanel_model::Readable;

use super::table::Table;
use crate::identified::{called, shown_correlations};
use crate::tables::{HALF_95, shown_unit, with_unit};

/// A number with as many digits as tell it from another a tenth of `std` away.
fn to_std(value: f64, std: f64) -> String {
    let needed = (value / std).abs().log10() + 2.0;
    let digits = if needed.is_finite() { needed.clamp(3.0, 12.0) as usize } else { 3 };
    format!("{value:.digits$e}")
}

/// The 95 % interval about an estimate.
pub fn interval(value: f64, std: f64) -> String {
    let [low, high] = [-HALF_95, HALF_95].map(|widths| to_std(value + widths * std, std));
    format!("{low} to {high}")
}

/// Percent to three digits behind the point, or two significant ones below a hundredth.
fn percent(value: f64) -> String {
    if value == 0.0 || value >= 0.01 { format!("{:.3} %", Readable(value)) } else { format!("{value:.1e} %") }
}

/// What was identified, and the error that is left, a sentence each.
pub fn lead(found: &Identification) -> Vec<String> {
    let structure = found.structure.title();
    let modes: usize = found.pieces.iter().map(|fit| fit.modes.len()).sum();
    let data = match found.accelerances.len() {
        0 if modes == 1 => "one natural frequency".into(),
        0 => format!("{modes} natural frequencies"),
        1 => "the records of one pair of places".into(),
        pairs => format!("the records of {pairs} pairs of places"),
    };
    let mut sentences = vec![format!("The panel was identified as an {structure} from {data}.")];
    let mut frequencies = format!("The natural frequencies are met to {} rms", percent(found.frequency_rms_percent));
    if let Some(error) = found.left_one_out_percent {
        frequencies += &format!("; each predicted from the others, to {} rms", percent(error));
    }
    sentences.push(frequencies + ".");
    if let Some(error) = found.accelerance_rms_percent {
        let mut accelerances = format!("The accelerances are met to {:.2} % rms", Readable(error));
        if let Some(chi_square) = found.chi_square {
            accelerances +=
                &format!("; chi-square per datum is {:.2}, and 1 where only noise is left", Readable(chi_square));
        }
        sentences.push(accelerances + ".");
    }
    sentences
}

pub fn table(found: &Identification) -> Table {
    let row = |constant: &IdentifiedConstant| {
        let IdentifiedConstant { name, unit, value, std, held, piece } = constant;
        let name = match piece {
            Some(piece) => format!("{name} of piece {piece}"),
            None => (*name).to_owned(),
        };
        let (deviation, interval) = match std {
            Some(std) => (format!("{std:.1e}"), interval(*value, *std)),
            None if *held => ("held".into(), String::new()),
            None => ("unknown".into(), String::new()),
        };
        vec![name, format!("{value:.4e}"), deviation, interval, shown_unit(unit).to_owned()]
    };
    let headings = ["constant", "value", "std", "95 % interval", "unit"];
    Table::new(&headings, found.constants.iter().map(row).collect())
}

/// What the data do not show, and what hangs together.
pub fn remarks(found: &Identification) -> Vec<String> {
    let unseen = found.not_identified.iter().map(|unseen| {
        let [low, high] = unseen.interval;
        format!(
            "{} is not identified and held at {}: these data leave it open from {low:.2e} to {high:.2e}, along {}.",
            unseen.name,
            with_unit(&format!("{:.3e}", unseen.held_at), unseen.unit),
            unseen.direction_text()
        )
    });
    let (shown, others) = shown_correlations(found);
    let correlations = shown.into_iter().map(|pair| {
        let [first, second] = [(pair.first, pair.first_piece), (pair.second, pair.second_piece)]
            .map(|(name, piece)| called(found, name, piece));
        format!("{first} and {second} {:+.3}", pair.value)
    });
    let correlations = correlations.chain(others).collect::<Vec<_>>().join(", ");
    let correlations = (!correlations.is_empty()).then(|| format!("Correlations: {correlations}."));
    unseen.chain(correlations).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_those_that_the_deviation_leaves() {
        assert_eq!(to_std(1.067e10, 1.4e4), "1.0670000e10");
        assert_eq!(to_std(0.3, 0.2), "3.000e-1");
        assert_eq!(to_std(1.0, 0.0), "1.000e0");
    }

    #[test]
    fn small_percentages_are_not_zero() {
        assert_eq!([0.215, 4e-4, 0.0].map(percent), ["0.215 %", "4.0e-4 %", "0.000 %"]);
    }
}
