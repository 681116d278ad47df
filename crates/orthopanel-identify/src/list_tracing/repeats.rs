//! A list that stands twice to the last digit is one measurement.

use orthopanel_data::{ImpactTest, Measurement};

/// The test with each list once, and what was left out, a sentence each.
pub(crate) fn without_repeats(test: &ImpactTest) -> (ImpactTest, Vec<String>) {
    let mut once = test.clone();
    once.measurements.clear();
    let mut notes = Vec::new();
    for (number, measurement) in (1..).zip(&test.measurements) {
        let alike = |kept: &Measurement| kept.piece == measurement.piece && kept.data == measurement.data;
        if once.measurements.iter().any(alike) {
            notes.push(format!(
                "measurement {number} is the list of an earlier one to the last digit: it counts once, for a copy tells nothing"
            ));
        } else {
            once.measurements.push(measurement.clone());
        }
    }
    (once, notes)
}
