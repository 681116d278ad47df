//! Arrays of FMI 3.0: all forces as one variable, and each kind of output as another.

use std::ops::Range;

use orthopanel_model::{Place, Ports};

use super::quantity::HOLD;

/// Variables of one kind as one array.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Array {
    /// Name, without a number.
    pub name: &'static str,
    /// Description, with the places in the order of the elements.
    pub description: String,
    /// References of the elements.
    pub references: Range<u32>,
}

/// The arrays of a panel with these ports, in the order of the table.
pub(super) fn of(ports: &Ports) -> Vec<Array> {
    // `time` and `force_linear` come first.
    let mut next = 3;
    let kinds: [(&str, &str, &[Place], Option<&str>); 4] = [
        ("force", "Forces", &ports.forces, Some(HOLD)),
        ("acceleration", "The panel's accelerations", &ports.responses, None),
        ("velocity", "The panel's velocities", &ports.responses, None),
        ("displacement", "The panel's displacements", &ports.responses, None),
    ];
    let array = |(name, words, places, also): (&'static str, &str, &[Place], Option<&str>)| {
        let at = || places.iter().map(|place| format!("({}, {})", place.x, place.y)).collect::<Vec<_>>().join(", ");
        let first = next;
        // As many places fit into memory: the number never reaches 2^32.
        next += u32::try_from(places.len()).unwrap_or(u32::MAX);
        let also = also.map(|also| described!(". {also}")).unwrap_or_default();
        let description = described!("{words} at (x, y) = {} m from the centre, positive along +z{also}", at());
        Array { name, description, references: first..next }
    };
    kinds.into_iter().map(array).collect()
}
