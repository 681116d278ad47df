//! Parts of the sentences of errors that depend on their numbers.

use orthopanel_model::Readable;

use super::known_factor::cause_of;

/// Noise of the median line \[%\] beside which few resonances are no wonder.
const MUCH_NOISE: f64 = 30.0;

pub(super) fn much_noise(percent: Option<f64>) -> String {
    percent.filter(|&percent| percent > MUCH_NOISE).map_or(String::new(), |percent| {
        format!(
            "too much noise, {:.0} % of the line in the median line (hit harder, average more hits, mend cable and range); or ",
            Readable(percent)
        )
    })
}

/// The records that are meant.
pub(super) fn which(records: &Option<Vec<String>>) -> &'static str {
    match records.as_deref() {
        None => "all records",
        Some([_]) => "its lines",
        Some(_) => "these records",
    }
}

/// A factor, a power of $j\omega$, and a delay \[s\].
pub(super) fn by_factor(factor: f64, derivatives: i8, delay: f64) -> String {
    let slope = match derivatives {
        0 => "",
        1 => " j omega",
        2 => " (j omega)^2",
        -1 => " / (j omega)",
        _ => " / (j omega)^2",
    };
    let size = if (1e-3..1e4).contains(&factor.abs()) { format!("{factor:.4}") } else { format!("{factor:.3e}") };
    let late = match delay {
        0.0 => String::new(),
        _ => format!(" and without a delay of {:.1} us, which stays to be declared or traced", 1e6 * delay),
    };
    size + slope + &late
}

/// What is said of one record that a factor mends.
pub(crate) fn one_times(factor: Option<f64>) -> String {
    factor.map_or(String::new(), |factor| format!("; times {:.3} it fits ({})", Readable(factor), cause_of(factor)))
}

/// How well a constant is known by its standard deviation.
pub(super) fn known(std: f64) -> String {
    if std.is_finite() { format!("no better than to +- {std:.1e}") } else { "not at all".to_owned() }
}

/// A unit behind its number; pure numbers have none.
pub(crate) fn spaced(unit: &str) -> String {
    if unit == "1" { String::new() } else { format!(" {unit}") }
}

pub(super) fn untaken(resonances: &[f64]) -> String {
    let told: Vec<String> = resonances.iter().map(|frequency| format!("{frequency:.1}")).collect();
    match &told[..] {
        [] => String::new(),
        told => format!(", and has no mode for the resonance at {} Hz", told.join(", ")),
    }
}

/// What is said of a record that fits in the place of another, as that fits in its own.
pub(super) fn in_place_of(exchanged_with: &Option<String>) -> String {
    exchanged_with.as_ref().map_or(String::new(), |other| {
        format!("; it fits in the place of {other}, and that in its own: the two are exchanged, write the file of each in the place of the other")
    })
}

pub(super) fn other_place(fits_at: &Option<(&'static str, f64)>) -> String {
    fits_at.map_or(String::new(), |(key, x)| format!(", and would fit with {key} x = {x:.3} m"))
}
