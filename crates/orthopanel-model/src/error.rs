//! What the physics layer refuses, with the numbers in it and the way out.

use thiserror::Error;

use crate::End;

/// Errors of this crate.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ModelError {
    /// A size that is zero, negative or not a number.
    #[error("{name} = {}{}: must be finite and greater than zero", Readable(*.value), spaced(.unit))]
    Size {
        /// Name of the size.
        name: &'static str,
        /// Its value.
        value: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// A size that no piece has.
    #[error(
        "{name} = {value:e} {unit}: must lie between {low:e} and {high:e} {unit}; sizes are in metres, mass_per_area in kg/m2"
    )]
    SizeRange {
        /// Name of the size.
        name: &'static str,
        /// Its value.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// Least value allowed.
        low: f64,
        /// Greatest value allowed.
        high: f64,
    },
    /// More of something than a model may hold.
    #[error("{found} {what}, and a model may have {most} at most: {remedy}")]
    TooMany {
        /// Number found.
        found: usize,
        /// What there are too many of, by its key.
        what: &'static str,
        /// The limit.
        most: usize,
        /// The way out.
        remedy: &'static str,
    },
    /// A thickness and a mass per area that no solid has together.
    #[error(
        "a thickness of {} m and {} kg/m2 make {} kg/m3, and solids have {lightest} to \
         {heaviest}: sizes are in metres, mass_per_area in kg/m2",
        Readable(*.thickness), Readable(*.mass_per_area), Readable(to_thousandths(*.density))
    )]
    Density {
        /// Thickness \[m\].
        thickness: f64,
        /// Mass per area \[kg/m²\].
        mass_per_area: f64,
        /// What they make \[kg/m³\].
        density: f64,
        /// Of the lightest solid.
        lightest: f64,
        /// Of the heaviest.
        heaviest: f64,
    },
    /// An elastic constant outside its bounds.
    #[error("{name} = {value:e}{}: must lie between {} and {}", spaced(.unit), short(.low), short(.high))]
    Constant {
        /// Name of the constant.
        name: &'static str,
        /// Its value.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// Least value allowed.
        low: f64,
        /// Greatest value allowed.
        high: f64,
    },
    /// A beam that is held along its front or back.
    #[error("{edge} = {end}: a beam is free there; leave it out, or take the structure \"mindlin-plate\"")]
    HeldSide {
        /// `front` or `back`.
        edge: &'static str,
        /// What holds it.
        end: End,
    },
    /// Constants of a plate whose law is not positive definite.
    #[error(
        "nu_xy = {nu_xy} with e_x = {e_x:e} Pa and e_y = {e_y:e} Pa has no definite law: nu_xy must lie below \
         sqrt(e_x / e_y) = {limit:.4}"
    )]
    IndefiniteLaw {
        /// $E_x$.
        e_x: f64,
        /// $E_y$.
        e_y: f64,
        /// $\nu_{xy}$.
        nu_xy: f64,
        /// $\sqrt{E_x/E_y}$.
        limit: f64,
    },
    /// A plate too thin for its basis to keep the digits of its shear strain.
    #[error(
        "thickness = {thickness} m: shear stiffness is {ratio:.1e} times bending stiffness, the plate's basis takes up to \
         {limit:.0e}: from {least:.2e} m on it holds these constants"
    )]
    TooThin {
        /// Thickness \[m\].
        thickness: f64,
        /// $k'Gta^2/D$ at these constants.
        ratio: f64,
        /// Greatest ratio taken.
        limit: f64,
        /// Thickness \[m\] at which the ratio is met.
        least: f64,
    },
    /// A number of basis functions along one direction that the plate does not take.
    #[error("{found} terms along one direction of the plate: take {least} to {most}")]
    TermCount {
        /// Number asked for.
        found: usize,
        /// Fewest.
        least: usize,
        /// Most.
        most: usize,
    },
    /// A place outside the piece.
    #[error(
        "place ({}, {}) m lies off the piece: |x| <= {} m and |y| <= {} m, from its centre{}",
        Readable(*.x), Readable(*.y), Readable(*.x_limit), Readable(*.y_limit), other_readings([*.x, *.y], [*.x_limit, *.y_limit])
    )]
    OffPiece {
        /// x of the place.
        x: f64,
        /// y of the place.
        y: f64,
        /// Half the length.
        x_limit: f64,
        /// Half the width.
        y_limit: f64,
    },
    /// A modal damping ratio outside $0 \le \zeta < 1/\sqrt 2$ (eq. 25).
    #[error("mode {mode}: damping ratio {} must satisfy 0 <= zeta < 0.7071 (eq. 25)", Readable(*.value))]
    Damping {
        /// Flexible mode, from 1; 0 stands for the ratio of all modes beyond.
        mode: usize,
        /// The ratio.
        value: f64,
    },
    /// Standard deviations of damping ratios, not one a ratio.
    #[cfg(not(feature = "compact"))]
    #[error(
        "damping.std has {found} entries beside {ratios} of damping.ratios: give one a ratio, null where it is not known"
    )]
    DampingDeviations {
        /// Number found.
        found: usize,
        /// Number of ratios.
        ratios: usize,
    },
    /// A correlation that is none of the model's constants and damping ratios.
    #[cfg(not(feature = "compact"))]
    #[error("correlation: {problem}")]
    Correlation {
        /// What is wrong, and what must be.
        problem: String,
    },
    /// A modal model whose lists do not fit each other.
    #[error("mode {mode}: {found} shape values at the {ports}, expected {expected}")]
    PortCount {
        /// Position of the mode in the list, from 1.
        mode: usize,
        /// `forces` or `responses`.
        ports: &'static str,
        /// Number found.
        found: usize,
        /// Number expected.
        expected: usize,
    },
    /// An angular frequency that no mode has.
    #[error("mode {mode}: angular frequency {} rad/s must be finite, and zero (rigid) or greater", Readable(*.value))]
    Frequency {
        /// Position of the mode in the list, from 1.
        mode: usize,
        /// Its angular frequency \[rad/s\].
        value: f64,
    },
    /// A step over which the motion cannot be computed.
    #[error(
        "step = {} s: too long for numbers to hold the motion of a mode of {} rad/s: take a shorter one",
        Readable(*.step), Readable(*.angular_frequency)
    )]
    LongStep {
        /// The step \[s\].
        step: f64,
        /// Angular frequency of the mode \[rad/s\].
        angular_frequency: f64,
    },
    /// A standard deviation that is none.
    #[error("{name} = {}: must be a finite number, zero or more", Readable(*.value))]
    Deviation {
        /// What it is of, as the file has it.
        name: String,
        /// Its value.
        value: f64,
    },
    /// A number that is not finite where one is needed.
    #[error("{what} = {}: must be a finite number", Readable(*.value))]
    NotFinite {
        /// What it is.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// A number too large to be reckoned with.
    #[error("{what} = {value:e}: must be at most {largest:e}")]
    TooLarge {
        /// What it is.
        what: &'static str,
        /// Its value.
        value: f64,
        /// Largest value allowed.
        largest: f64,
    },
    /// A model file whose text cannot be read.
    #[error("line {line}: {problem}")]
    ModelText {
        /// Line of the file, from 1.
        line: usize,
        /// The key, what was found there and what is wanted.
        problem: String,
    },
    /// A model file of another schema.
    #[error("schema = {found:?}: this version reads {expected:?}")]
    Schema {
        /// The schema found.
        found: String,
        /// The schema read.
        expected: &'static str,
    },
    /// A model file that does not say its schema.
    #[error("schema is missing: a model file begins with {{\"schema\": {expected:?}, ...")]
    MissingSchema {
        /// The schema read.
        expected: &'static str,
    },
    /// A model's name that is no identifier.
    #[error(
        "name = {name:?}: must be of letters, digits and _ (128 at most, no digit first), as floor_left: its FMU is called so"
    )]
    Name {
        /// Name in the file.
        name: String,
    },
    /// A constant that the structure does not have.
    #[error("constants.{name} is unknown: the structure has {known}")]
    UnknownConstant {
        /// Name in the file.
        name: String,
        /// Names that the structure has.
        known: String,
    },
    /// A constant that the structure needs and the file lacks.
    #[error("constants.{name} is missing: the structure needs it")]
    MissingConstant {
        /// Name of the constant.
        name: &'static str,
    },
    /// Another number of forces than the model has force ports.
    #[error("{found} forces given: the model has {expected} force ports")]
    ForceCount {
        /// Number found.
        found: usize,
        /// Number expected.
        expected: usize,
    },
    /// Force records of unequal length.
    #[error("force {port}: {found} samples, the first force has {expected}: all forces need the same instants")]
    RecordLength {
        /// Force port, from 1.
        port: usize,
        /// Samples found.
        found: usize,
        /// Samples of the first force.
        expected: usize,
    },
    /// A step of the Runge-Kutta method that is too long for a mode.
    #[error("mode {mode} ({frequency:.0} Hz): {steps} steps between samples grow without bound, take {needed} or more")]
    UnstableStep {
        /// Position of the mode in the model, rigid modes included, from 1.
        mode: usize,
        /// Its frequency \[Hz\].
        frequency: f64,
        /// Steps asked for.
        steps: usize,
        /// Steps at which it is stable.
        needed: usize,
    },
    /// Another number of modal states than the model has modes.
    #[error("states of {found} modes given: the model has {expected} modes")]
    StateCount {
        /// Number found.
        found: usize,
        /// Number expected.
        expected: usize,
    },
    /// More modes asked than the basis resolves.
    #[error("{asked} modes asked, but the basis resolves {available}: ask for {available} or fewer")]
    BasisTooSmall {
        /// Flexible modes asked for.
        asked: usize,
        /// Modes that the basis resolves.
        available: usize,
    },
    /// Modes up to a frequency that the largest basis, or the most modes of a beam, do not reach.
    #[error(
        "modes up to {} Hz asked, but the model resolves {available} modes at most, up to {} Hz: ask for that \
         frequency or less", Readable(*.frequency), Readable(.reached.floor())
    )]
    BeyondBasis {
        /// Frequency asked for \[Hz\].
        frequency: f64,
        /// Flexible modes that are resolved.
        available: usize,
        /// Frequency of the last of them \[Hz\].
        reached: f64,
    },
    /// Another number of constants than the structure has.
    #[error("{found} constants given, the structure has {expected}")]
    ConstantCount {
        /// Number given.
        found: usize,
        /// Number of the structure.
        expected: usize,
    },
    /// A stiffness or mass matrix that is not positive: the constants have no physical meaning together.
    #[error("the eigenproblem has no real solution: stiffness or mass is not positive at these constants")]
    Eigenproblem,
    /// An effect that is not in the catalogue.
    #[error("effect {id:?} is not in the catalogue: take one of {known}")]
    UnknownEffect {
        /// The id given.
        id: String,
        /// The ids of the catalogue.
        known: String,
    },
    /// Another number of values than an effect has parameters.
    #[error("effect {effect}: {found} values given, it has {expected} parameters")]
    EffectValues {
        /// Its id.
        effect: &'static str,
        /// Number given.
        found: usize,
        /// Number of its parameters.
        expected: usize,
    },
    /// A parameter of an effect outside its bounds.
    #[error("effect {effect}: {name} = {value:e}{}: must lie between {} and {}", spaced(.unit), short(.low), short(.high))]
    EffectParameter {
        /// Id of the effect.
        effect: &'static str,
        /// Name of the parameter.
        name: &'static str,
        /// Its value.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// Least value allowed.
        low: f64,
        /// Greatest value allowed.
        high: f64,
    },
    /// An effect in a test that does not tell what the effect needs.
    #[error("effect {effect} needs {what}: say it in the test file, or leave the effect out")]
    EffectNeeds {
        /// Id of the effect.
        effect: &'static str,
        /// What it needs.
        what: &'static str,
    },
    /// An effect of a model file that cannot be read.
    #[error("effect {effect}: {what}")]
    EffectText {
        /// Its id.
        effect: &'static str,
        /// What is wrong with it.
        what: String,
    },
    /// An effect in a model file that is none of the panel's.
    #[error("effect {effect} belongs to the {owner}, not to the panel: leave it out of the model file")]
    EffectOwner {
        /// Its id.
        effect: &'static str,
        /// `rig` or `channel`.
        owner: &'static str,
    },
    /// What this version cannot solve.
    #[error("{0} is not supported by this version of orthopanel")]
    Unsupported(String),
}

/// What has decimals, with three of them.
fn to_thousandths(value: f64) -> f64 {
    if (1e-3..1e9).contains(&value) { (1e3 * value).round() / 1e3 } else { value }
}

/// A number for people: in exponent form where it is huge or tiny. With a number of digits behind the point (`{:.2}`) in that form
/// only where it is huge, for what is tiny is zero to so many digits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Readable(pub f64);

impl std::fmt::Display for Readable {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let size = self.0.abs();
        if let Some(digits) = f.precision() {
            return match (size < 1e9 || !size.is_finite(), f.sign_plus()) {
                (true, true) => write!(f, "{:+.digits$}", self.0),
                (true, false) => write!(f, "{:.digits$}", self.0),
                (false, true) => write!(f, "{:+.2e}", self.0),
                (false, false) => write!(f, "{:.2e}", self.0),
            };
        }
        let plain = size == 0.0 || !size.is_finite() || (1e-6..1e9).contains(&size);
        if plain { write!(f, "{}", self.0) } else { write!(f, "{:e}", self.0) }
    }
}

/// How else a place off the piece may be meant, where it lies on the piece so.
fn other_readings([x, y]: [f64; 2], half: [f64; 2]) -> String {
    let readings = [
        (
            "counted from the corner at the lower left",
            [x - half[0], y - half[1]],
            "subtract half the length and half the width from every place",
        ),
        ("with x and y exchanged", [y, x], "x runs along the length"),
        ("in millimetres", [1e-3 * x, 1e-3 * y], "write metres"),
    ];
    let lies_on = |place: &[f64; 2]| place.iter().zip(half).all(|(at, half)| at.abs() <= half + 1e-9);
    // A place in metres that is none of the piece's lies on it in millimetres too: by its middle.
    let is_far = [x, y].iter().zip(half).any(|(at, half)| at.abs() > 10.0 * half);
    let readings = &readings[..if is_far { 3 } else { 2 }];
    let said = |(reading, place, write): &(&str, [f64; 2], &str)| {
        let [x, y] = place.map(|at| Readable((1e9 * at).round() / 1e9));
        format!("; {reading} it is ({x}, {y}): {write}")
    };
    readings.iter().filter(|(_, place, _)| lies_on(place)).map(said).collect()
}

/// A unit behind its number; pure numbers have none.
fn spaced(unit: &str) -> String {
    if unit == "1" { String::new() } else { format!(" {unit}") }
}

/// A bound, which is worked out from sizes, to four digits.
fn short(bound: &f64) -> String {
    let rounded = format!("{bound:.3e}");
    rounded.parse::<f64>().map_or(rounded, |value| format!("{value:e}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_off_the_piece_is_told_how_else_it_may_be_meant() {
        let said = |x, y| ModelError::OffPiece { x, y, x_limit: 0.4, y_limit: 0.3 }.to_string();
        let corner = said(0.7, 0.1);
        assert!(
            corner.ends_with("it is (0.3, -0.2): subtract half the length and half the width from every place"),
            "{corner}"
        );
        let exchanged = said(-0.2, -0.35);
        assert!(
            exchanged.ends_with("; with x and y exchanged it is (-0.35, -0.2): x runs along the length"),
            "{exchanged}"
        );
        let millimetres = said(-350.0, 120.0);
        assert!(millimetres.ends_with("; in millimetres it is (-0.35, 0.12): write metres"), "{millimetres}");
        assert!(said(0.9, -0.1).ends_with("from its centre"));
    }

    #[test]
    fn no_number_for_people_is_long() {
        let said = [1e300, -6.8e9, 1e-300, 12.345, 1e8].map(|value| format!("{:.1} {0}", Readable(value)));
        let plain = ["1.00e300 1e300", "-6.80e9 -6.8e9", "0.0 1e-300", "12.3 12.345", "100000000.0 100000000"];
        assert_eq!(said, plain);
        assert_eq!([0.5, 5e20].map(|value| format!("{:+.2}", Readable(value))), ["+0.50", "+5.00e20"]);
    }
}
