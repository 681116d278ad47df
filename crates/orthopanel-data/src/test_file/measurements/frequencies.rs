//! `kind = "natural-frequencies"`: read off an analyser, so each is known to a bin.

use toml::Spanned;

use super::{
    super::{pieces::NamedPiece, syntax},
    Entry,
    natural_frequencies::NaturalFrequencies,
};
use crate::{DataError, limits};

/// Nodes that a beam's mode has at most, by its index from 0: one more than its number, where both ends are free.
fn most_nodes(index: usize) -> u32 {
    u32::try_from(index + 2).unwrap_or(u32::MAX)
}

impl Entry<'_> {
    pub(super) fn natural_frequencies(
        &self,
        entry: &syntax::Measurement,
        named: &NamedPiece,
    ) -> Result<NaturalFrequencies, DataError> {
        let remedy = "list the natural frequencies in Hz, flexible modes from 1";
        let list = self.needed(entry.values.as_ref(), "values", remedy)?;
        if list.get_ref().is_empty() {
            return Err(DataError::Count { at: self.at(list.span(), "values"), found: 0, remedy: remedy.into() });
        }
        let (count, most) = (list.get_ref().len(), limits::FREQUENCIES);
        let at = || self.at(list.span(), "values");
        self.source.at_most((count, "natural frequencies"), most, at, "list the lowest, which tell the constants")?;
        let shape = self.shape(entry, count)?;
        let mut values: Vec<f64> = Vec::with_capacity(list.get_ref().len());
        for (index, number) in list.get_ref().iter().enumerate() {
            let key = format!("values[{}]", index + 1);
            let value = self.source.positive(number, &self.name(&key), "Hz")?;
            let nodes = shape.get(index).copied().unwrap_or([most_nodes(index), 0]);
            let (least, most) = named.piece.possible_frequencies(nodes);
            if !(least..=most).contains(&value) {
                let [softest, stiffest] = limits::MODULUS;
                let range = format!(
                    "no mode of a piece of these sizes and mass lies there: between E = {softest:e} Pa, softer than any foam, and \
                     {stiffest:e} Pa, stiffer than diamond, it has {least:.1e} to {most:.1e} Hz; frequencies are in Hz, sizes in m"
                );
                return Err(DataError::OutOfRange { at: self.at(number.span(), &key), value, range });
            }
            if let Some(&previous) = values.last() {
                // Names by shape make order needless; without them the order is the name.
                if value <= previous && shape.is_empty() {
                    let (at, piece) = (self.at(number.span(), &key), format!("piece {}", named.name));
                    return Err(DataError::Order { at, piece, mode: index + 1, value, previous });
                }
            }
            values.push(value);
        }
        let resolution = self.each_mode(entry.resolution.as_ref(), "resolution", &values)?;
        let scatter = self.each_mode(entry.scatter.as_ref(), "scatter", &values)?;
        let response_at = {
            let place = entry.response_at.as_ref();
            place.map(|place| self.place(place, "response_at", &named.piece)).transpose()?
        };
        Ok(NaturalFrequencies { values, resolution, scatter, shape, response_at }.rising())
    }

    fn shape(&self, entry: &syntax::Measurement, modes: usize) -> Result<Vec<[u32; 2]>, DataError> {
        let Some(list) = &entry.shape else { return Ok(Vec::new()) };
        let found = list.get_ref().len();
        if found != modes {
            let remedy = format!("give one [nodes_x, nodes_y] a mode, {modes} in all");
            return Err(DataError::Count { at: self.at(list.span(), "shape"), found, remedy });
        }
        let mut shape = Vec::with_capacity(found);
        for (index, pair) in list.get_ref().iter().enumerate() {
            let nodes = *pair.get_ref();
            if shape.contains(&nodes) {
                let at = self.at(pair.span(), &format!("shape[{}]", index + 1));
                return Err(DataError::Duplicate { at, name: format!("{nodes:?}") });
            }
            shape.push(nodes);
        }
        Ok(shape)
    }

    /// One number \[Hz\] for all modes, or one a mode; below the frequency it belongs to, or it would say that nothing was measured.
    fn each_mode(
        &self,
        given: Option<&Spanned<syntax::OneOrEach>>,
        key: &str,
        values: &[f64],
    ) -> Result<Vec<f64>, DataError> {
        let Some(given) = given else { return Ok(Vec::new()) };
        let modes = values.len();
        let below = |number: &Spanned<f64>, key: &str, frequency: f64| {
            let value = self.source.positive(number, &self.name(key), "Hz")?;
            if value < frequency {
                return Ok(value);
            }
            let range = format!("must lie below the natural frequency that it belongs to, {frequency} Hz");
            Err(DataError::OutOfRange { at: self.at(number.span(), key), value, range })
        };
        match given.get_ref() {
            syntax::OneOrEach::One(value) => {
                let number = Spanned::new(given.span(), *value);
                let lowest = values.iter().copied().fold(f64::INFINITY, f64::min);
                Ok(vec![below(&number, key, lowest)?; modes])
            }
            syntax::OneOrEach::Each(list) if list.len() != modes => {
                let remedy = format!("give one number in Hz, or one a mode, {modes} in all");
                Err(DataError::Count { at: self.at(given.span(), key), found: list.len(), remedy })
            }
            syntax::OneOrEach::Each(list) => {
                let each = list.iter().zip(values).enumerate();
                each.map(|(index, (number, &value))| below(number, &format!("{key}[{}]", index + 1), value)).collect()
            }
        }
    }
}
