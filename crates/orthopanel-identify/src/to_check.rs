//! What to look at where nothing of the catalogue explains the records: another measurement would not part what does not fit.

use orthopanel_data::ImpactTest;
use orthopanel_model::Readable;

/// What may be wrong in the test file, the declared effects among it, and what says so.
pub(crate) fn to_check(test: &ImpactTest, sign: &str) -> String {
    let declared: Vec<&str> = test.effects.iter().map(|effect| effect.id.as_str()).collect();
    let mut told = vec!["the sizes and their units (m, kg/m2)".to_owned(), "the boundary".to_owned()];
    told.push("the places of hammer and sensor".to_owned());
    told.push("the unit and sign of both channels".to_owned());
    if !test.constants.is_empty() {
        told.push("the constants held".to_owned());
    }
    if !declared.is_empty() {
        told.push(format!("the numbers of what is declared ({})", declared.join(", ")));
    }
    let last = told.pop().unwrap_or_default();
    format!(
        "before you measure again, check {} and {last}: {sign}. If all that is right, the cause is not in the \
         catalogue: hit further places, for how what is left goes with the place shows where it sits",
        told.join(", ")
    )
}

/// The sign that `left` times the noise is.
pub(crate) fn times_the_noise(left: f64) -> String {
    format!("{:.1} times the noise is left", Readable(left))
}
