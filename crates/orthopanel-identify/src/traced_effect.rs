//! An effect with what was found of it.

use orthopanel_model::{EffectEntry, Estimate, Owner};

use crate::effect_places::has_place;

/// An effect with what was found of it.
#[derive(Debug, Clone, PartialEq)]
pub struct TracedEffect {
    /// Its id in the catalogue.
    pub id: &'static str,
    /// Who it belongs to.
    pub owner: Owner,
    /// Its parameters, in the catalogue's order.
    pub parameters: Vec<TracedParameter>,
}

impl TracedEffect {
    /// Whether it sits at a place of its own.
    pub(crate) fn has_place(&self) -> bool {
        orthopanel_model::effect(self.id).is_ok_and(has_place)
    }

    /// As a model file holds it.
    pub(crate) fn entry(&self) -> EffectEntry {
        let first = |parameter: &TracedParameter| Some((parameter.name.to_owned(), *parameter.values.first()?));
        EffectEntry {
            id: self.id.to_owned(),
            owner: self.owner.name().to_owned(),
            parameters: self.parameters.iter().filter_map(first).collect(),
        }
    }
}

/// A parameter of an effect.
#[derive(Debug, Clone, PartialEq)]
pub struct TracedParameter {
    /// Its name.
    pub name: &'static str,
    /// SI unit.
    pub unit: &'static str,
    /// Its value; one a record, in order, where each record has its own.
    pub values: Vec<Estimate>,
}
