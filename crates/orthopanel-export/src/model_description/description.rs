//! What the XML says.

use orthopanel_fmu::{Variable, VariableTable};

use crate::FmuOptions;

/// What the XML says.
pub(super) struct Description<'a> {
    pub options: &'a FmuOptions,
    pub token: &'a str,
    pub variables: VariableTable,
    pub interfaces: Interfaces,
    /// Step size and stop time that suit the model \[s\].
    pub experiment: (f64, f64),
}

impl Description<'_> {
    /// Variables of which the standard wants to know what they depend on: outputs, then derivatives of the states.
    pub(super) fn unknowns(&self) -> impl Iterator<Item = (Unknown, &Variable)> {
        let all = self.variables.variables();
        let outputs = all.iter().filter(|variable| variable.quantity.causality() == "output");
        let derivatives = all.iter().filter(|variable| variable.derivative_of.is_some());
        outputs.map(|variable| (Unknown::Output, variable)).chain(derivatives.map(|v| (Unknown::Derivative, v)))
    }

    pub(super) fn causality(&self, reference: u32) -> Option<&'static str> {
        self.variables.get(reference).map(|variable| variable.quantity.causality())
    }
}

/// What an unknown is, beside being an initial unknown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Unknown {
    Output,
    Derivative,
}

/// What the FMU offers, with the attributes of each.
pub(crate) type Interfaces = Vec<(&'static str, &'static [(&'static str, &'static str)])>;
