//! Arguments that several commands share.

use std::path::Path;

use clap::Args;
use orthopanel::USUAL_MODES;
use orthopanel_export::PortNames;
use orthopanel_model::limits;
use orthopanel_model::{ModeRange, PanelModel, Place, Ports, is_identifier};

use crate::error::CommandError;

#[derive(Args)]
pub struct ModeArguments {
    /// Number of flexible modes beside the rigid ones [default: 20]
    #[arg(long, value_name = "N", value_parser = count, allow_negative_numbers = true, conflicts_with = "up_to")]
    modes: Option<usize>,
    /// Every flexible mode up to this frequency
    #[arg(long, value_name = "HZ", value_parser = frequency, allow_negative_numbers = true)]
    up_to: Option<f64>,
}

impl ModeArguments {
    pub fn range(&self) -> ModeRange {
        match (self.modes, self.up_to) {
            (_, Some(frequency)) => ModeRange::UpTo(frequency),
            (Some(count), None) => ModeRange::Count(count),
            (None, None) => USUAL_MODES,
        }
    }

    pub fn is_given(&self) -> bool {
        self.modes.is_some() || self.up_to.is_some()
    }
}

#[derive(Args)]
pub struct PortArguments {
    /// Where force goes in, in m from the centre; may be repeated [default: the model's own force ports]
    #[arg(long = "force", value_name = "X[,Y]", value_parser = place, allow_hyphen_values = true)]
    forces: Vec<Place>,
    /// Where motion comes out, in m from the centre; may be repeated [default: the model's own response ports]
    #[arg(long = "response", value_name = "X[,Y]", value_parser = place, allow_hyphen_values = true)]
    responses: Vec<Place>,
}

/// A place with the name of what is joined to it, which then stands in the names of variables.
#[derive(Debug, Clone, PartialEq)]
struct NamedPlace {
    name: Option<String>,
    place: Place,
}

/// As [`PortArguments`], and names.
#[derive(Args)]
pub struct NamedPortArguments {
    /// Where force goes in, in m from the centre, and what its variables are called; may be repeated [default: the model's own force
    /// ports, numbered]
    #[arg(long = "force", value_name = "[NAME=]X[,Y]", value_parser = named_place, allow_hyphen_values = true)]
    forces: Vec<NamedPlace>,
    /// Where motion comes out, in m from the centre, and what its variables are called; may be repeated [default: the model's own response
    /// ports, numbered]
    #[arg(long = "response", value_name = "[NAME=]X[,Y]", value_parser = named_place, allow_hyphen_values = true)]
    responses: Vec<NamedPlace>,
}

impl NamedPortArguments {
    /// As [`PortArguments::needed`].
    pub fn needed(&self, model: &PanelModel, path: &Path) -> Result<Ports, CommandError> {
        let places = |named: &[NamedPlace]| named.iter().map(|named| named.place).collect();
        PortArguments { forces: places(&self.forces), responses: places(&self.responses) }.needed(model, path)
    }

    pub fn names(&self) -> PortNames {
        let names = |named: &[NamedPlace]| match named.iter().all(|named| named.name.is_none()) {
            true => vec![],
            false => named.iter().map(|named| named.name.clone()).collect(),
        };
        PortNames { forces: names(&self.forces), responses: names(&self.responses) }
    }
}

impl PortArguments {
    /// The places given, and the model's own for a kind that is not given.
    fn ports(&self, model: &PanelModel) -> Ports {
        let or_own = |given: &Vec<Place>, own: &Vec<Place>| if given.is_empty() { own.clone() } else { given.clone() };
        Ports {
            forces: or_own(&self.forces, &model.ports.forces),
            responses: or_own(&self.responses, &model.ports.responses),
        }
    }

    /// The places given, or the model's own; neither kind may be empty.
    pub fn needed(&self, model: &PanelModel, path: &Path) -> Result<Ports, CommandError> {
        let ports = self.ports(model);
        for (places, kind, key) in [(&ports.forces, "force", "forces"), (&ports.responses, "response", "responses")] {
            if places.is_empty() {
                return Err(CommandError::NoPort { path: path.into(), kind, key });
            }
            if places.len() > limits::PORTS {
                let (value, most) = (format!("given {} times", places.len()), limits::PORTS);
                let remedy = format!("a model may have {most} places of each kind at most");
                return Err(CommandError::Option { option: kind, value, remedy });
            }
            on_piece(model, kind, places)?;
        }
        Ok(ports)
    }

    pub fn is_given(&self) -> bool {
        !(self.forces.is_empty() && self.responses.is_empty())
    }
}

/// Checks that the places given with `--{option}` lie on the piece.
pub fn on_piece(model: &PanelModel, option: &'static str, places: &[Place]) -> Result<(), CommandError> {
    let refuse = |place: Place| move |source| CommandError::Place { option, place, source };
    places.iter().try_for_each(|&place| model.piece.contains(place).map_err(refuse(place)))
}

/// Reads `X` or `X,Y` in m.
pub fn place(text: &str) -> Result<Place, String> {
    let (x, y) = text.split_once(',').unwrap_or((text, "0"));
    let coordinate = |text: &str| match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(format!("{text:?} is no finite number: give a place as X or X,Y in m, such as -0.3 or -0.3,0.02")),
    };
    Ok(Place { x: coordinate(x)?, y: coordinate(y)? })
}

/// Reads `X`, `X,Y` or either behind `NAME=`.
fn named_place(text: &str) -> Result<NamedPlace, String> {
    let Some((name, rest)) = text.split_once('=') else { return Ok(NamedPlace { name: None, place: place(text)? }) };
    if !is_identifier(name) {
        return Err(format!(
            "{name:?} is no name of letters, digits and _ (no digit first): give a place as seat_left=-0.3,0.02"
        ));
    }
    Ok(NamedPlace { name: Some(name.into()), place: place(rest)? })
}

/// Reads the name of an FMU.
pub fn identifier(text: &str) -> Result<String, String> {
    match is_identifier(text) {
        true => Ok(text.into()),
        false => Err("must be of letters, digits and _ (128 at most, no digit first), as floor_left".into()),
    }
}

/// Reads a number of modes.
pub fn count(text: &str) -> Result<usize, String> {
    text.trim().parse().map_err(|_| "a number of modes must be a whole number, not below zero".into())
}

/// Reads a frequency in Hz: finite, not negative.
pub fn frequency(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() && value >= 0.0 => Ok(value),
        _ => Err("a frequency in Hz must be a finite number, not below zero".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_may_have_a_name() {
        let named = named_place("seat_left=-0.3,0.02").unwrap();
        assert_eq!(named, NamedPlace { name: Some("seat_left".into()), place: Place { x: -0.3, y: 0.02 } });
        assert_eq!(named_place("-0.3").unwrap().name, None);
        for text in ["seat left=0.1", "2=0.1", "=0.1", "a=", "a=b", "a=0.1=0.2", "ä=0"] {
            assert!(named_place(text).is_err(), "{text:?} was read as a place with a name");
        }
    }

    #[test]
    fn a_place_is_one_or_two_finite_numbers() {
        assert_eq!(place("-0.3"), Ok(Place { x: -0.3, y: 0.0 }));
        assert_eq!(place("-0.3, 0.02"), Ok(Place { x: -0.3, y: 0.02 }));
        for text in ["", "a", "0.1,", "0.1,0.2,0.3", "nan", "0,inf"] {
            assert!(place(text).is_err(), "{text:?} was read as a place");
        }
    }
}
