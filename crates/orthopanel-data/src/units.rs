//! Units as people write them: `m/s^2`, `Gs`, `Newtons`, `(1/N)*(m/s²)`, `in/s2`, `kHz`.
//!
//! A text is a product of powers of the units in [`NAMES`], with prefixes; what it measures follows from its dimension.

use std::fmt;

/// Which derivative of the motion a sensor reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Motion {
    /// Accelerometers.
    Acceleration,
    /// Laser vibrometers.
    Velocity,
    /// Proximity probes, cameras.
    Displacement,
}

impl Motion {
    /// All of them, in the order of what sensors mostly read.
    pub const ALL: [Self; 3] = [Self::Acceleration, Self::Velocity, Self::Displacement];

    /// How often it has to be differentiated to become an acceleration: $a = s^n x$.
    pub fn derivatives(self) -> u8 {
        match self {
            Self::Acceleration => 0,
            Self::Velocity => 1,
            Self::Displacement => 2,
        }
    }

    /// As in test files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Acceleration => "acceleration",
            Self::Velocity => "velocity",
            Self::Displacement => "displacement",
        }
    }

    /// Its unit in SI.
    pub fn si_unit(self) -> &'static str {
        match self {
            Self::Acceleration => "m/s2",
            Self::Velocity => "m/s",
            Self::Displacement => "m",
        }
    }

    fn dimension(self) -> Dimension {
        let time = i32::from(self.derivatives()) - 2;
        Dimension { length: 1, time, ..Dimension::default() }
    }
}

impl fmt::Display for Motion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A unit, with the words that it was given in.
#[derive(Debug, Clone, PartialEq)]
pub struct Unit {
    text: String,
    to_si: f64,
    dimension: Dimension,
}

/// Exponents of metre, kilogram, second and volt.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct Dimension {
    length: i32,
    mass: i32,
    time: i32,
    voltage: i32,
}

/// What a unit measures here.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Measured {
    Motion(Motion),
    Force,
    /// Motion over force: accelerance, mobility, receptance.
    MotionOverForce(Motion),
    Voltage,
    Time,
    Frequency,
}

const FORCE: Dimension = Dimension { length: 1, mass: 1, time: -2, voltage: 0 };

impl Measured {
    const ALL: [Self; 10] = [
        Self::Motion(Motion::Acceleration),
        Self::Motion(Motion::Velocity),
        Self::Motion(Motion::Displacement),
        Self::Force,
        Self::MotionOverForce(Motion::Acceleration),
        Self::MotionOverForce(Motion::Velocity),
        Self::MotionOverForce(Motion::Displacement),
        Self::Voltage,
        Self::Time,
        Self::Frequency,
    ];

    fn dimension(self) -> Dimension {
        match self {
            Self::Motion(motion) => motion.dimension(),
            Self::Force => FORCE,
            Self::MotionOverForce(motion) => motion.dimension().times(FORCE, -1),
            Self::Voltage => Dimension { voltage: 1, ..Dimension::default() },
            Self::Time => Dimension { time: 1, ..Dimension::default() },
            Self::Frequency => Dimension { time: -1, ..Dimension::default() },
        }
    }
}

impl Dimension {
    fn times(self, other: Self, power: i32) -> Self {
        let sum = |own: i32, other: i32| own.saturating_add(other.saturating_mul(power));
        Self {
            length: sum(self.length, other.length),
            mass: sum(self.mass, other.mass),
            time: sum(self.time, other.time),
            voltage: sum(self.voltage, other.voltage),
        }
    }
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl Unit {
    /// The unit that a text names; `None` where it is none of a motion, a force, their quotient, a voltage, a time or a frequency.
    ///
    /// ```
    /// # use orthopanel_data::Unit;
    /// assert_eq!(Unit::parse("mm/s^2").map(|unit| unit.to_si()), Some(1e-3));
    /// assert_eq!(Unit::parse("Gs").map(|unit| unit.to_si()), Some(9.80665));
    /// assert_eq!(Unit::parse("furlongs"), None);
    /// ```
    pub fn parse(text: &str) -> Option<Self> {
        let plain = plain(text);
        // `m/N s` means m/(N s) to some: the first reading that measures something counts.
        let after_slash = plain.split_once('/').map(|(over, under)| format!("{over}/({under})"));
        [Some(plain), after_slash].into_iter().flatten().find_map(|plain| {
            let (to_si, dimension) = Expression { rest: plain.as_str(), depth: 0 }.whole()?;
            let unit = Self { text: text.trim().to_owned(), to_si, dimension };
            (to_si.is_finite() && to_si > 0.0 && unit.measured().is_some()).then_some(unit)
        })
    }

    /// A unit that is known by its factor.
    pub(crate) fn of_motion(text: String, motion: Motion, to_si: f64) -> Self {
        Self { text, to_si, dimension: motion.dimension() }
    }

    /// A unit of force that is known by its factor \[N\].
    pub(crate) fn of_force(text: String, to_si: f64) -> Self {
        Self { text, to_si, dimension: FORCE }
    }

    /// Factor to the SI unit of the same dimension; standard gravity is $g_n = 9.80665$ m/s² (3rd CGPM, 1901, exact).
    pub fn to_si(&self) -> f64 {
        self.to_si
    }

    /// The motion that it measures; `None` for a unit of something else.
    pub fn motion(&self) -> Option<Motion> {
        match self.measured() {
            Some(Measured::Motion(motion)) => Some(motion),
            _ => None,
        }
    }

    /// True for a unit of force.
    pub fn is_force(&self) -> bool {
        self.measured() == Some(Measured::Force)
    }

    /// True where both are the same but for their spelling.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        self.dimension == other.dimension && (self.to_si / other.to_si - 1.0).abs() < SAME
    }

    pub(crate) fn measured(&self) -> Option<Measured> {
        Measured::ALL.into_iter().find(|measured| measured.dimension() == self.dimension)
    }
}

/// Part by which factors of one unit differ: files print them with five digits or more.
const SAME: f64 = 1e-4;

/// Standard gravity \[m/s²\].
const GRAVITY: f64 = 9.806_65;
/// Inch \[m\] and pound \[kg\] (International yard and pound agreement, 1959, exact).
const INCH: f64 = 0.0254;
const POUND: f64 = 0.453_592_37;

const LENGTH: Dimension = Dimension { length: 1, mass: 0, time: 0, voltage: 0 };
const TIME: Dimension = Dimension { length: 0, mass: 0, time: 1, voltage: 0 };
const MASS: Dimension = Dimension { length: 0, mass: 1, time: 0, voltage: 0 };
const VOLTAGE: Dimension = Dimension { length: 0, mass: 0, time: 0, voltage: 1 };
const ACCELERATION: Dimension = Dimension { length: 1, mass: 0, time: -2, voltage: 0 };
const FREQUENCY: Dimension = Dimension { length: 0, mass: 0, time: -1, voltage: 0 };

/// Names in small letters, the factor to SI, the dimension, and whether prefixes go with them. Pounds are those of a hammer: forces.
const NAMES: [(&[&str], f64, Dimension, bool); 17] = [
    (&["m", "meter", "meters", "metre", "metres"], 1.0, LENGTH, true),
    (&["in", "inch", "inches"], INCH, LENGTH, false),
    (&["ft", "foot", "feet"], 12.0 * INCH, LENGTH, false),
    (&["mil", "mils"], 1e-3 * INCH, LENGTH, false),
    (&["s", "sec", "secs", "second", "seconds"], 1.0, TIME, true),
    (&["minute", "minutes"], 60.0, TIME, false),
    (&["n", "newton", "newtons"], 1.0, FORCE, true),
    (&["lbf", "lb", "lbs", "pound", "pounds", "pound-force"], POUND * GRAVITY, FORCE, false),
    (&["kgf", "kp", "kilopond"], GRAVITY, FORCE, false),
    (&["gf"], 1e-3 * GRAVITY, FORCE, false),
    (&["dyn", "dyne"], 1e-5, FORCE, false),
    (&["g", "gs", "g's", "gn", "g0", "gee", "grav"], GRAVITY, ACCELERATION, true),
    (&["gal"], 1e-2, ACCELERATION, false),
    (&["kg", "kilogram", "kilograms"], 1.0, MASS, false),
    (&["v", "volt", "volts"], 1.0, VOLTAGE, true),
    (&["hz", "hertz", "cps"], 1.0, FREQUENCY, true),
    (&["rpm", "cpm"], 1.0 / 60.0, FREQUENCY, false),
];

/// Prefixes, by whole words too.
const PREFIXES: [(&[&str], f64); 5] = [
    (&["n", "nano"], 1e-9),
    (&["u", "micro"], 1e-6),
    (&["m", "milli"], 1e-3),
    (&["c", "centi"], 1e-2),
    (&["k", "kilo"], 1e3),
];

/// A name with or without a prefix.
fn named(name: &str) -> Option<(f64, Dimension)> {
    // The only names that capitals tell apart.
    match name {
        "MN" => return Some((1e6, FORCE)),
        "MHz" => return Some((1e6, FREQUENCY)),
        _ => {}
    }
    let name = name.to_lowercase();
    let known = |name: &str, prefixed: bool| {
        let has = |of: &&(&[&str], f64, Dimension, bool)| of.0.contains(&name) && (of.3 || !prefixed);
        NAMES.iter().find(has).map(|of| (of.1, of.2))
    };
    known(&name, false).or_else(|| {
        let prefixes = PREFIXES.iter().flat_map(|(names, factor)| names.iter().map(move |name| (name, factor)));
        prefixes.into_iter().find_map(|(prefix, factor)| {
            let (own, dimension) = known(name.strip_prefix(prefix)?, true)?;
            Some((factor * own, dimension))
        })
    })
}

/// Characters of a unit: longer ones are no unit, whatever they are.
const LONGEST: usize = 60;

/// The text in ASCII: raised digits as powers, and the question marks that a universal file's reader leaves of what is no ASCII.
fn plain(text: &str) -> String {
    let mut plain = String::new();
    for character in text.trim().chars().take(LONGEST) {
        match character {
            '²' => plain.push('2'),
            '³' => plain.push('3'),
            '¹' => plain.push('1'),
            '⁻' | '−' => plain.push('-'),
            'µ' | 'μ' => plain.push('u'),
            '·' | '×' | '⋅' | '∙' => plain.push('*'),
            '[' | '{' => plain.push('('),
            ']' | '}' => plain.push(')'),
            other => plain.push(other),
        }
    }
    // A raised 2 is one byte in Latin 1 and two in UTF-8, and so is a micro.
    let plain = plain.replace("**", "^").replace("??", "?").replace("s?", "s2").replace('?', "u");
    // Written without a blank, which would make it the power of a millisecond.
    let joined = ["ms-2", "ms^-2", "ms-1", "ms^-1"];
    match joined.iter().find(|joined| plain.starts_with(**joined)) {
        Some(_) => plain.replacen("ms", "m s", 1),
        None => plain,
    }
}

/// A product of powers being read.
struct Expression<'a> {
    rest: &'a str,
    depth: usize,
}

/// Brackets within brackets, at most.
const DEEPEST: usize = 4;

impl Expression<'_> {
    fn whole(mut self) -> Option<(f64, Dimension)> {
        let product = self.product()?;
        self.rest.is_empty().then_some(product)
    }

    /// Factors, until the text or the bracket ends.
    fn product(&mut self) -> Option<(f64, Dimension)> {
        let (mut to_si, mut dimension) = self.factor()?;
        loop {
            self.skip_blanks();
            let sign = match self.rest.chars().next() {
                None | Some(')') => return Some((to_si, dimension)),
                Some('/') => -1,
                _ => 1,
            };
            if self.rest.starts_with(['/', '*', '.']) {
                self.rest = self.rest.get(1..)?;
            }
            let (factor, of) = self.factor()?;
            to_si *= factor.powi(sign);
            dimension = dimension.times(of, sign);
        }
    }

    fn factor(&mut self) -> Option<(f64, Dimension)> {
        self.skip_blanks();
        let base = if let Some(rest) = self.rest.strip_prefix('(') {
            self.depth += 1;
            if self.depth > DEEPEST {
                return None;
            }
            self.rest = rest;
            let inner = self.product()?;
            self.rest = self.rest.strip_prefix(')')?;
            self.depth -= 1;
            inner
        } else if let Some(rest) = self.rest.strip_prefix('1') {
            self.rest = rest;
            (1.0, Dimension::default())
        } else {
            // A name may hold what is no letter, yet ends before a power.
            let end = self.rest.find(|c: char| !(c.is_ascii_alphabetic() || c == '\'')).unwrap_or(self.rest.len());
            let (name, rest) = self.rest.split_at_checked(end)?;
            // Two names end in more than letters.
            let (name, rest) = match (name, rest) {
                ("pound", rest) if rest.starts_with("-force") => ("pound-force", rest.get(6..)?),
                ("g", rest) if rest.starts_with('0') => ("g0", rest.get(1..)?),
                other => other,
            };
            self.rest = rest;
            named(name)?
        };
        let power = self.power()?;
        Some((base.0.powi(power), Dimension::default().times(base.1, power)))
    }

    /// The power that follows a factor, 1 where none does.
    fn power(&mut self) -> Option<i32> {
        let raised = self.rest.strip_prefix('^');
        let text = raised.unwrap_or(self.rest);
        let sign = usize::from(text.starts_with('-'));
        let digits = text.get(sign..)?.bytes().take_while(u8::is_ascii_digit).count();
        match (digits, raised) {
            (0, None) => Some(1),
            // No unit here has more than one digit of power.
            (1, _) => {
                let (number, rest) = text.split_at_checked(sign + digits)?;
                self.rest = rest;
                number.parse().ok()
            }
            _ => None,
        }
    }

    fn skip_blanks(&mut self) {
        self.rest = self.rest.trim_start();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Factors from the definitions of SI, NIST SP 811 and the agreement of 1959, by hand.
    #[test]
    fn val_units_as_people_write_them() {
        use Measured::{Force, MotionOverForce, Voltage};
        let acceleration = Measured::Motion(Motion::Acceleration);
        let velocity = Measured::Motion(Motion::Velocity);
        let displacement = Measured::Motion(Motion::Displacement);
        let mobility = MotionOverForce(Motion::Velocity);
        let receptance = MotionOverForce(Motion::Displacement);
        let accelerance = MotionOverForce(Motion::Acceleration);
        let cases: &[(&[&str], f64, Measured)] = &[
            (
                &["m/s2", "m/s^2", "m/s²", "m/s**2", "M/S2", "m/s/s", "m s-2", "ms-2", "m.s-2", "m·s⁻²"],
                1.0,
                acceleration,
            ),
            (&["m/sec^2", "meters/second^2", "[m/s2]", "(m/s^2)", "m/s?", "m/s??", "m/(s*s)"], 1.0, acceleration),
            (&["g", "G", "Gs", "g's", "gn", "g0"], 9.80665, acceleration),
            (&["mg"], 9.80665e-3, acceleration),
            (&["mm/s2", "mm/s^2", "MM/SEC^2"], 1e-3, acceleration),
            (&["in/s2", "in/sec^2", "inch/s^2"], 0.0254, acceleration),
            (&["ft/s2"], 0.3048, acceleration),
            (&["m/s", "m s-1", "ms-1", "meter/sec"], 1.0, velocity),
            (&["mm/s", "MM/S"], 1e-3, velocity),
            (&["um/s", "µm/s", "?m/s", "??m/s"], 1e-6, velocity),
            (&["in/s", "in/sec"], 0.0254, velocity),
            (&["m", "meters"], 1.0, displacement),
            (&["mm"], 1e-3, displacement),
            (&["µm", "um", "micrometer"], 1e-6, displacement),
            (&["mil", "mils"], 2.54e-5, displacement),
            (&["N", "n", "Newton", "Newtons", "NEWTON", "kg m/s2", "kg*m/s^2"], 1.0, Force),
            (&["kN"], 1e3, Force),
            (&["mN"], 1e-3, Force),
            (&["MN"], 1e6, Force),
            (&["lbf", "lb", "lbs", "LBF", "pound-force"], 4.448_221_615_260_5, Force),
            (&["kgf", "kp"], 9.80665, Force),
            (&["m/s2/N", "(m/s^2)/N", "(1/N)*(m/s²)", "m/s^2/N", "1/kg", "kg^-1", "m/(s2 N)"], 1.0, accelerance),
            (&["g/N"], 9.80665, accelerance),
            (&["g/lbf"], 9.80665 / 4.448_221_615_260_5, accelerance),
            (&["m/s/N", "(m/s)/N", "m/(N s)", "m/N s", "s/kg"], 1.0, mobility),
            (&["m/N", "s2/kg"], 1.0, receptance),
            (&["mm/N"], 1e-3, receptance),
            (&["in/lbf"], 0.0254 / 4.448_221_615_260_5, receptance),
            (&["V", "volts"], 1.0, Voltage),
            (&["mV"], 1e-3, Voltage),
            (&["s", "sec", "Seconds"], 1.0, Measured::Time),
            (&["ms", "msec", "milliseconds"], 1e-3, Measured::Time),
            (&["us", "?s", "µs"], 1e-6, Measured::Time),
            (&["Hz", "HZ", "hertz", "1/s"], 1.0, Measured::Frequency),
            (&["kHz", "KHZ"], 1e3, Measured::Frequency),
            (&["rpm"], 1.0 / 60.0, Measured::Frequency),
        ];
        for (texts, factor, measured) in cases {
            for text in *texts {
                let unit = Unit::parse(text).unwrap_or_else(|| panic!("{text} is not read"));
                assert_eq!(unit.measured(), Some(*measured), "{text}");
                assert!((unit.to_si() / factor - 1.0).abs() < 1e-12, "{text}: {}", unit.to_si());
            }
        }
    }

    #[test]
    fn val_what_is_no_unit_here() {
        let deep = "(".repeat(1000);
        for text in
            ["", "1", "NONE", "furlong", "Pa", "deg", "m/s^22", "m^", "m/", "(m/s", "m)s", "s^99999999999", "%", &deep]
        {
            assert_eq!(Unit::parse(text), None, "{text}");
        }
    }
}
