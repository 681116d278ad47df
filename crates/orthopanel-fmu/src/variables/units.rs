//! Units of the variables.

/// A unit with its exponents of kg, m and s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    /// Name.
    pub name: &'static str,
    /// Exponents of the base units, those that are zero left out; empty where FMI, which has whole exponents only,
    /// cannot say them.
    pub exponents: &'static [(&'static str, i8)],
    /// Name of the unit that people read, and how many of it one of this is.
    pub display: Option<(&'static str, f64)>,
}

impl Unit {
    const fn of(name: &'static str, exponents: &'static [(&'static str, i8)]) -> Self {
        Self { name, exponents, display: None }
    }

    const fn shown_in(self, name: &'static str, factor: f64) -> Self {
        Self { display: Some((name, factor)), ..self }
    }
}

pub(super) const MODAL_POSITION: &str = "m.kg^(1/2)";
pub(super) const MODAL_VELOCITY: &str = "m.kg^(1/2)/s";
pub(super) const MODAL_ACCELERATION: &str = "m.kg^(1/2)/s2";

/// Every unit in use.
pub const UNITS: [Unit; 19] = [
    Unit::of("s", &[("s", 1)]),
    Unit::of("N", &[("kg", 1), ("m", 1), ("s", -2)]),
    Unit::of("m/s2", &[("m", 1), ("s", -2)]),
    Unit::of("m/s", &[("m", 1), ("s", -1)]),
    Unit::of("m", &[("m", 1)]).shown_in("mm", 1e3),
    Unit::of("kg/m2", &[("kg", 1), ("m", -2)]),
    Unit::of("Pa", &[("kg", 1), ("m", -1), ("s", -2)]).shown_in("GPa", 1e-9),
    Unit::of("kg", &[("kg", 1)]),
    Unit::of("Hz", &[("s", -1)]),
    Unit::of("1", &[]),
    Unit::of("N/m", &[("kg", 1), ("s", -2)]),
    Unit::of("N.s/m", &[("kg", 1), ("s", -1)]),
    Unit::of("N.m", &[("kg", 1), ("m", 2), ("s", -2)]),
    Unit::of("rad", &[("rad", 1)]),
    Unit::of("rad/s", &[("rad", 1), ("s", -1)]),
    Unit::of("rad/s2", &[("rad", 1), ("s", -2)]),
    Unit::of(MODAL_POSITION, &[]),
    Unit::of(MODAL_VELOCITY, &[]),
    Unit::of(MODAL_ACCELERATION, &[]),
];
