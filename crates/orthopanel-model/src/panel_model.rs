//! The model file `orthopanel.model/1`: the text that a person or `identify` writes.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

#[cfg(not(feature = "compact"))]
use crate::CorrelationMatrix;
use crate::limits;
use crate::{
    Boundary, Damping, EffectEntry, EffectState, Estimate, ModelError, Owner, Piece, Ports, StructureKind,
    is_identifier,
};

/// The schema that this version reads and writes.
pub const MODEL_SCHEMA: &str = "orthopanel.model/1";

/// A panel with its constants, damping and ports, as written in a model file (JSON).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PanelModel {
    /// [`MODEL_SCHEMA`].
    pub schema: String,
    /// What its FMU is called, as in C.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// The piece.
    pub piece: Piece,
    /// What holds its ends; free unless said.
    #[serde(default)]
    pub boundary: Boundary,
    /// What vibrates.
    pub structure: StructureKind,
    /// Elastic constants by name \[Pa, Poisson's ratio 1\].
    pub constants: BTreeMap<String, Estimate>,
    /// Modal damping.
    #[serde(default)]
    pub damping: Damping,
    /// Correlation of constants and damping ratios, where it was identified.
    // An FMU has none, and its library is smaller without.
    #[cfg(not(feature = "compact"))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub correlation: Option<CorrelationMatrix>,
    /// Physical effects beyond the base model.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub effects: Vec<EffectEntry>,
    /// Places of force and response.
    #[serde(default)]
    pub ports: Ports,
    /// Where the model comes from; free text by key.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub provenance: BTreeMap<String, serde_json::Value>,
}

impl PanelModel {
    /// Checks sizes, damping, the names of the constants and the places of the ports; the values of the constants are
    /// checked by the structure they belong to.
    ///
    /// # Errors
    /// The first of [`ModelError::Name`], [`ModelError::Size`], [`ModelError::SizeRange`], [`ModelError::Density`], [`ModelError::Damping`],
    /// [`ModelError::TooMany`], [`ModelError::UnknownConstant`],
    /// [`ModelError::OffPiece`] that holds.
    pub fn check(&self) -> Result<(), ModelError> {
        if let Some(name) = self.name.as_ref().filter(|name| !is_identifier(name)) {
            return Err(ModelError::Name { name: name.clone() });
        }
        self.piece.checked()?.solid()?;
        self.damping.check()?;
        for (found, what, most, remedy) in [
            (
                self.damping.ratios.len(),
                "damping.ratios",
                limits::DAMPING_RATIOS,
                "leave out the last, and give damping.beyond",
            ),
            (self.ports.forces.len(), "ports.forces", limits::PORTS, "leave out those that nothing is joined to"),
            (self.ports.responses.len(), "ports.responses", limits::PORTS, "leave out those that nobody reads"),
            (self.effects.len(), "effects", limits::EFFECTS, "leave out those that count least"),
        ] {
            if found > most {
                return Err(ModelError::TooMany { found, what, most, remedy });
            }
        }
        let known = self.structure.constants();
        if let Some(name) = self.constants.keys().find(|name| known.iter().all(|constant| constant.name != **name)) {
            let known = known.iter().map(|constant| constant.name).collect::<Vec<_>>().join(", ");
            return Err(ModelError::UnknownConstant { name: name.clone(), known });
        }
        for &place in self.ports.forces.iter().chain(&self.ports.responses) {
            self.piece.contains(place)?;
        }
        Ok(())
    }

    /// Checks the standard deviations, which a file may give; a fit that tells none may leave what is no number.
    pub(crate) fn check_deviations(&self) -> Result<(), ModelError> {
        let of_constants = self.constants.iter().map(|(name, estimate)| (format!("constants.{name}.std"), estimate));
        let of_effects = self.effects.iter().enumerate().flat_map(|(index, effect)| {
            effect.parameters.iter().map(move |(name, estimate)| (format!("effects[{index}].{name}.std"), estimate))
        });
        for (name, Estimate { std, .. }) in of_constants.chain(of_effects) {
            if let Some(value) = std.filter(|std| !(0.0..f64::INFINITY).contains(std)) {
                return Err(ModelError::Deviation { name, value });
            }
        }
        Ok(())
    }

    /// Checks the standard deviations of damping ratios, and the correlation.
    #[cfg(not(feature = "compact"))]
    pub(crate) fn check_covariance(&self) -> Result<(), ModelError> {
        let (std, ratios) = (&self.damping.std, self.damping.ratios.len());
        let not_one = |std: &Option<f64>| std.filter(|std| !(0.0..f64::INFINITY).contains(std));
        if let Some((index, value)) = std.iter().enumerate().find_map(|(index, std)| Some((index, not_one(std)?))) {
            return Err(ModelError::Deviation { name: format!("damping.std[{index}]"), value });
        }
        if !std.is_empty() && std.len() != ratios {
            return Err(ModelError::DampingDeviations { found: std.len(), ratios });
        }
        self.check_correlation()
    }

    /// Checks the correlation alone.
    #[cfg(not(feature = "compact"))]
    pub(crate) fn check_correlation(&self) -> Result<(), ModelError> {
        let is_constant = |name: &str| self.constants.contains_key(name);
        let check = |of: &CorrelationMatrix| of.check(self.damping.ratios.len(), is_constant);
        self.correlation.as_ref().map_or(Ok(()), check)
    }

    /// The model without the effects of rig and measuring chain, which are no part of a panel, and the ids of these.
    ///
    /// # Errors
    /// [`ModelError::UnknownEffect`] and its like for an entry that is no effect of the catalogue.
    pub fn panel_alone(&self) -> Result<(Self, Vec<&'static str>), ModelError> {
        let mut model = Self { effects: vec![], ..self.clone() };
        let mut left_out = Vec::new();
        for entry in &self.effects {
            let effect = EffectState::from_entry(entry)?.effect;
            match effect.owner() {
                Owner::Panel => model.effects.push(entry.clone()),
                Owner::Rig | Owner::Channel => left_out.push(effect.id()),
            }
        }
        Ok((model, left_out))
    }

    /// The value of a constant by name.
    ///
    /// # Errors
    /// [`ModelError::MissingConstant`] where the file does not give it.
    pub fn constant(&self, name: &'static str) -> Result<f64, ModelError> {
        self.constants.get(name).map(|estimate| estimate.value).ok_or(ModelError::MissingConstant { name })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_structure_has_one_name_in_all_files() {
        for kind in StructureKind::ALL {
            assert_eq!(serde_json::to_value(kind).unwrap(), kind.name(), "{kind:?}");
            assert_eq!(serde_json::from_value::<StructureKind>(kind.name().into()).unwrap(), kind);
        }
    }
}
