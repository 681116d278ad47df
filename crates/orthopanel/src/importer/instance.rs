//! What is run of an FMU, whatever its version: the variables that orthopanel's FMUs have, and the calls.

use std::collections::HashMap;

use crate::fmu_refusal::{FmuRefusal, limited};

/// Numbers in all variables of a kind together.
const MOST_NUMBERS: usize = 100_000;

/// One FMU instance, whatever its version. `Err` carries the name of the call that failed.
pub(super) trait Instance {
    /// Sets whether forces run linearly over a step; before [`Instance::initialise`].
    fn set_force_linear(&self, linear: bool) -> Result<(), &'static str>;
    fn set_forces(&self, forces: &[f64]) -> Result<(), &'static str>;
    /// Starts the clock at `start` \[s\] with these forces \[N\], from which a linear force runs on.
    fn initialise(&self, start: f64, forces: &[f64]) -> Result<(), &'static str>;
    fn step(&self, from: f64, step: f64) -> Result<(), &'static str>;
    /// Accelerations of all responses, then velocities, then displacements.
    fn outputs(&self) -> Result<Vec<f64>, &'static str>;
    fn terminate(&self) -> Result<(), &'static str>;
}

/// Value references of the variables that orthopanel's FMUs have.
pub(super) struct References {
    pub(super) force_linear: u32,
    pub(super) forces: Vec<u32>,
    pub(super) force_count: usize,
    pub(super) outputs: Vec<u32>,
    /// Numbers in all outputs together.
    pub(super) output_count: usize,
}

/// What is known of a variable.
#[derive(Debug, Clone, Copy)]
pub(super) struct Variable {
    pub(super) reference: u32,
    /// Numbers that it holds.
    pub(super) numbers: usize,
    /// Whether it is an input or an output.
    pub(super) is_signal: bool,
}

impl References {
    /// Finds the variables by name: one a port, in the order of their numbers or, where ports have names, of their references; or one
    /// array for all ports of a kind.
    pub(super) fn find(variables: &HashMap<&str, Variable>) -> Result<Self, FmuRefusal> {
        let needed = |kind: &str| -> Result<(Vec<u32>, usize), FmuRefusal> {
            let of_kind =
                |name: &str| name == kind || name.strip_prefix(kind).is_some_and(|rest| rest.starts_with('_'));
            let signals = variables.iter().filter(|(name, variable)| variable.is_signal && of_kind(name));
            let numbered = |(name, variable): (&&str, &Variable)| {
                let number = name.get(kind.len() + 1..).and_then(|rest| rest.parse::<u32>().ok());
                (number.unwrap_or(variable.reference), number.is_some(), *variable)
            };
            let mut found: Vec<_> = signals.map(numbered).collect();
            let all_numbered = found.iter().all(|(_, has_number, _)| *has_number);
            found.sort_by_key(|(number, _, variable)| if all_numbered { *number } else { variable.reference });
            let found: Vec<_> =
                found.into_iter().map(|(.., variable)| (variable.reference, variable.numbers)).collect();
            let numbers = found.iter().map(|(_, size)| *size).fold(0, usize::saturating_add);
            if numbers == 0 {
                return Err(FmuRefusal::Foreign(format!("it has neither a variable {kind}_1 nor an array {kind}")));
            }
            limited(&format!("dimensions of {kind}"), numbers, MOST_NUMBERS, "numbers")?;
            Ok((found.iter().map(|(reference, _)| *reference).collect(), numbers))
        };
        let (mut outputs, responses) = needed("acceleration")?;
        let (velocities, of_velocity) = needed("velocity")?;
        let (displacements, of_displacement) = needed("displacement")?;
        if of_velocity != responses || of_displacement != responses {
            return Err(FmuRefusal::Foreign(format!(
                "it has {responses} accelerations, {of_velocity} velocities and {of_displacement} displacements"
            )));
        }
        outputs.extend(velocities.into_iter().chain(displacements));
        let missing = || FmuRefusal::Foreign("it has no variable force_linear".into());
        let force_linear = variables.get("force_linear").ok_or_else(missing)?.reference;
        let (forces, force_count) = needed("force")?;
        Ok(Self { force_linear, forces, force_count, outputs, output_count: 3 * responses })
    }
}
