//! Units of the variables.

/// A unit with its exponents of kg, m and s.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Unit {
    /// Name.
    pub name: &'static str,
    /// Exponents of the base units, those that are zero left out; empty where FMI, which has whole exponents only,
    /// cannot say them.
    pub exponents: &'static [(&'static str, i8)],
}

pub(super) const MODAL_POSITION: &str = "m.kg^(1/2)";
pub(super) const MODAL_VELOCITY: &str = "m.kg^(1/2)/s";
pub(super) const MODAL_ACCELERATION: &str = "m.kg^(1/2)/s2";

/// Every unit in use.
pub const UNITS: [Unit; 11] = [
    Unit { name: "s", exponents: &[("s", 1)] },
    Unit { name: "N", exponents: &[("kg", 1), ("m", 1), ("s", -2)] },
    Unit { name: "m/s2", exponents: &[("m", 1), ("s", -2)] },
    Unit { name: "m/s", exponents: &[("m", 1), ("s", -1)] },
    Unit { name: "m", exponents: &[("m", 1)] },
    Unit { name: "kg/m2", exponents: &[("kg", 1), ("m", -2)] },
    Unit { name: "Pa", exponents: &[("kg", 1), ("m", -1), ("s", -2)] },
    Unit { name: "1", exponents: &[] },
    Unit { name: MODAL_POSITION, exponents: &[] },
    Unit { name: MODAL_VELOCITY, exponents: &[] },
    Unit { name: MODAL_ACCELERATION, exponents: &[] },
];
