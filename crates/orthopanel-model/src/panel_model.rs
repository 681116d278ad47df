//! The model file `orthopanel.model/1`: the text that a person or `identify` writes.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

#[cfg(not(feature = "compact"))]
use crate::CorrelationMatrix;
use crate::limits;
use crate::{
    BEAM_CONSTANTS, Boundary, Constant, EffectState, ModelError, Owner, PLATE_CONSTANTS, Piece, Place, is_identifier,
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

/// What vibrates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum StructureKind {
    /// The orthotropic Timoshenko beam of the paper: constants `e_x`, `g_zx`.
    TimoshenkoBeam,
    /// The orthotropic Mindlin plate: constants `e_x`, `e_y`, `nu_xy`, `g_xy`, `g_yz`, `g_zx`.
    MindlinPlate,
}

impl StructureKind {
    /// The constants that the structure has, in the order of all its lists of values.
    pub fn constants(self) -> &'static [Constant] {
        match self {
            Self::TimoshenkoBeam => &BEAM_CONSTANTS,
            Self::MindlinPlate => &PLATE_CONSTANTS,
        }
    }

    /// Every structure.
    pub const ALL: [Self; 2] = [Self::TimoshenkoBeam, Self::MindlinPlate];

    /// Its name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::TimoshenkoBeam => "timoshenko-beam",
            Self::MindlinPlate => "mindlin-plate",
        }
    }

    /// Its name in sentences.
    pub fn title(self) -> &'static str {
        match self {
            Self::TimoshenkoBeam => "orthotropic Timoshenko beam",
            Self::MindlinPlate => "orthotropic Mindlin plate",
        }
    }

    /// Whether its shapes have nodal lines along x too: then $y$ counts at a place.
    pub fn has_modes_across(self) -> bool {
        match self {
            Self::TimoshenkoBeam => false,
            Self::MindlinPlate => true,
        }
    }
}

/// A number, with its standard deviation where it was identified; in files `1.07e10` or `{"value", "std"}`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(into = "EstimateText")]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// Its standard deviation, where known.
    pub std: Option<f64>,
}

#[derive(Serialize)]
#[serde(untagged)]
enum EstimateText {
    Bare(f64),
    Full { value: f64, std: f64 },
}

impl From<Estimate> for EstimateText {
    fn from(estimate: Estimate) -> Self {
        match estimate.std {
            None => Self::Bare(estimate.value),
            Some(std) => Self::Full { value: estimate.value, std },
        }
    }
}

/// Modal damping ratios $\zeta_m$ of the flexible modes in order, and one for all modes beyond the list.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Damping {
    /// $\zeta_1, \zeta_2, \dots$ \[1\].
    #[serde(default)]
    pub ratios: Vec<f64>,
    /// Standard deviation of each of `ratios` \[1\], `None` of one that is not known; empty where none is.
    #[cfg(not(feature = "compact"))]
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub std: Vec<Option<f64>>,
    /// Ratio of every mode after the last of `ratios` \[1\].
    #[serde(default)]
    pub beyond: f64,
}

impl Damping {
    /// Damping ratio of flexible mode `mode`, counted from 1.
    pub fn ratio(&self, mode: usize) -> f64 {
        mode.checked_sub(1).and_then(|index| self.ratios.get(index)).copied().unwrap_or(self.beyond)
    }

    pub(crate) fn check(&self) -> Result<(), ModelError> {
        let listed = self.ratios.iter().enumerate().map(|(index, &value)| (index + 1, value));
        for (mode, value) in listed.chain([(0, self.beyond)]) {
            if !(0.0..std::f64::consts::FRAC_1_SQRT_2).contains(&value) {
                return Err(ModelError::Damping { mode, value });
            }
        }
        Ok(())
    }
}

/// Where force goes in and motion comes out.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ports {
    /// Places of the forces, along +z.
    #[serde(default)]
    pub forces: Vec<Place>,
    /// Places of the responses, along +z.
    #[serde(default)]
    pub responses: Vec<Place>,
}

/// One effect of the catalogue with its parameters.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EffectEntry {
    /// Its id in the catalogue.
    pub id: String,
    /// `panel`, `rig` or `channel`.
    pub owner: String,
    /// Parameters by name, in SI units.
    #[serde(flatten)]
    pub parameters: BTreeMap<String, Estimate>,
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
