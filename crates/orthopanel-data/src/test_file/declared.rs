//! `[suspension]`, `[constants]` and `[[effect]]`: what is known before the test is evaluated.

use std::collections::BTreeMap;

use orthopanel_model::{Place, StructureKind, effect};
use toml::Spanned;

use super::{pieces::NamedPiece, source::Source, syntax};
use crate::{DataError, limits};

/// Names of the elastic constants; `nu_xy` is a Poisson's ratio, the others are moduli \[Pa\].
const CONSTANTS: [&str; 6] = ["e_x", "e_y", "nu_xy", "g_xy", "g_yz", "g_zx"];

/// A modulus outside these \[Pa\] is a slip of unit: the softest foam core has 1e4, diamond 1e12.
const MODULUS: (f64, f64) = (1e2, 1e13);

/// Orthotropic Poisson's ratios pass 1/2 freely, since only $\nu_{xy}^2 < E_x/E_y$ binds them; the plate takes them up to this.
const POISSON_LIMIT: f64 = 0.95;

/// An effect known beforehand: part of the base model.
///
/// Whether the id and the parameters stand in the catalogue is judged where the catalogue is; a parameter left out
/// is one to identify.
#[derive(Debug, Clone, PartialEq)]
pub struct DeclaredEffect {
    /// Its id, such as `sensor-mass`.
    pub id: String,
    /// Its parameters by name \[SI units\], all finite.
    pub parameters: BTreeMap<String, f64>,
}

pub(super) fn structure(source: &Source, name: &Spanned<String>) -> Result<StructureKind, DataError> {
    let of_name = StructureKind::ALL.into_iter().find(|kind| kind.name() == name.get_ref());
    of_name.ok_or_else(|| {
        let known = StructureKind::ALL.map(|kind| format!("\"{}\"", kind.name())).join(" or ");
        let at = source.at(name.span(), "structure");
        DataError::UnknownName { at, name: name.get_ref().clone(), remedy: format!("must be {known}") }
    })
}

pub(super) fn suspension(
    source: &Source,
    suspension: Option<syntax::Suspension>,
    pieces: &[NamedPiece],
) -> Result<Vec<Place>, DataError> {
    let given = suspension.map_or(Vec::new(), |suspension| suspension.at);
    let at = || source.at(given.first().map_or(0..0, Spanned::span), "suspension.at");
    source.at_most((given.len(), "points"), limits::SUSPENSION_POINTS, at, "name those that carry the piece")?;
    let mut places = Vec::new();
    for (index, point) in given.into_iter().enumerate() {
        let key = format!("suspension.at[{}]", index + 1);
        let [x, y] = point.get_ref().0.map(|part| source.finite(&Spanned::new(point.span(), part), &key));
        let place = Place { x: x?, y: y? };
        for NamedPiece { piece, .. } in pieces {
            let at = |_| source.at(point.span(), &key);
            piece.contains(place).map_err(|error| DataError::Model { at: at(()), source: error })?;
        }
        places.push(place);
    }
    Ok(places)
}

/// What is known of a constant that is not held.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum KnownConstant {
    /// `{start = ..}`: the search begins there.
    Start(f64),
    /// `{value = .., std = ..}`: Gaussian.
    Prior {
        /// Its mean \[Pa; Poisson's ratio 1\].
        value: f64,
        /// Its standard deviation, in the same unit.
        std: f64,
    },
}

/// `[constants]`: those held, and what is known of others.
pub(super) struct Constants {
    pub(super) held: BTreeMap<String, f64>,
    pub(super) known: BTreeMap<String, KnownConstant>,
}

pub(super) fn constants(
    source: &Source,
    given: BTreeMap<String, Spanned<syntax::Constant>>,
) -> Result<Constants, DataError> {
    let mut constants = Constants { held: BTreeMap::new(), known: BTreeMap::new() };
    for (name, given) in given {
        let at = || source.at(given.span(), format!("constants.{name}"));
        if !CONSTANTS.contains(&name.as_str()) {
            let remedy = format!("the constants are {}", CONSTANTS.join(", "));
            return Err(DataError::UnknownName { at: at(), name, remedy });
        }
        let in_range = |value: f64| {
            let (low, high, unit) = match name.as_str() {
                "nu_xy" => (0.0, POISSON_LIMIT, ""),
                _ => (MODULUS.0, MODULUS.1, " Pa"),
            };
            if (low..=high).contains(&value) {
                return Ok(value);
            }
            let range = format!("must lie between {low:e} and {high:e}{unit}");
            Err(DataError::OutOfRange { at: at(), value, range })
        };
        match given.get_ref() {
            syntax::Constant::Held(value) => {
                let value = in_range(*value)?;
                constants.held.insert(name, value);
            }
            syntax::Constant::Known(known) => {
                let known = match (known.start, known.value, known.std) {
                    (Some(start), None, None) => KnownConstant::Start(in_range(start)?),
                    (None, Some(value), Some(std)) if std > 0.0 && std.is_finite() => {
                        KnownConstant::Prior { value: in_range(value)?, std }
                    }
                    (None, Some(_), Some(value)) => {
                        let range =
                            "std must be finite and greater than zero; a number alone holds the constant".into();
                        return Err(DataError::OutOfRange { at: at(), value, range });
                    }
                    _ => {
                        let message = "wanted is a number (held), {start = ..}, or {value = .., std = ..}".into();
                        return Err(DataError::Syntax { at: at(), message });
                    }
                };
                constants.known.insert(name, known);
            }
        }
    }
    let held = |name: &str| constants.held.get(name).copied();
    if let (Some(e_x), Some(e_y), Some(nu_xy)) = (held("e_x"), held("e_y"), held("nu_xy")) {
        let limit = (e_x / e_y).sqrt();
        if nu_xy >= limit {
            let range = format!("must lie below {limit:.4}, the root of e_x/e_y, or the stiffness is indefinite");
            return Err(DataError::OutOfRange { at: source.whole("constants.nu_xy"), value: nu_xy, range });
        }
    }
    Ok(constants)
}

pub(super) fn effects(
    source: &Source,
    given: Vec<Spanned<BTreeMap<String, Spanned<toml::Value>>>>,
) -> Result<Vec<DeclaredEffect>, DataError> {
    let at = || source.at(given.first().map_or(0..0, Spanned::span), "effect");
    source.at_most((given.len(), "effects"), limits::EFFECTS, at, "declare those that are known and count")?;
    let mut effects = Vec::with_capacity(given.len());
    for (index, entry) in given.into_iter().enumerate() {
        let key = format!("effect[{}]", index + 1);
        let table = source.at(entry.span(), format!("{key}.id"));
        let (mut id, mut owner, mut parameters) = (None, None, BTreeMap::new());
        for (name, value) in entry.into_inner() {
            let span = value.span();
            let key = format!("{key}.{name}");
            let number = match (name.as_str(), value.into_inner()) {
                ("id", toml::Value::String(text)) => {
                    id = Some(text);
                    continue;
                }
                ("owner", toml::Value::String(text)) => {
                    owner = Some((source.at(span, key), text));
                    continue;
                }
                ("id", _) => {
                    let message = "must be text, such as \"sensor-mass\"".into();
                    return Err(DataError::Syntax { at: source.at(span, key), message });
                }
                (_, toml::Value::Float(number)) => number,
                (_, toml::Value::Integer(number)) => number as f64,
                (_, other) => {
                    let message = format!("{} given, a number in SI units expected", other.type_str());
                    return Err(DataError::Syntax { at: source.at(span, key), message });
                }
            };
            parameters.insert(name, source.finite(&Spanned::new(span, number), &key)?);
        }
        let remedy = "give the effect's id, such as \"sensor-mass\"";
        let id = id.ok_or(DataError::Missing { at: table, remedy })?;
        // Copied from a model file, where an effect tells its owner. An id that is unknown is judged later.
        if let (Some((at, given)), Ok(effect)) = (owner, effect(&id)) {
            let owner = effect.owner().name();
            if given != owner {
                return Err(DataError::EffectOwner { at, effect: id, given, owner });
            }
        }
        effects.push(DeclaredEffect { id, parameters });
    }
    Ok(effects)
}
