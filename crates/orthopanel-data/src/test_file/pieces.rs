//! `[piece]` or `[[piece]]`: sizes and mass of the test pieces.

use std::ops::Range;

use orthopanel_model::{ModelError, Piece};
use toml::Spanned;

use super::{source::Source, syntax};
use crate::{DataError, limits};

/// A test piece and the name that measurements call it by.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedPiece {
    /// Its name; `"1"` for a single piece without one.
    pub name: String,
    /// Its sizes and mass per area.
    pub piece: Piece,
    /// Standard deviations of its sizes and mass, where declared.
    pub doubt: SizeDoubt,
    /// `own_constants`: names of the constants that this piece has of its own, each once; the pieces share all others.
    pub own_constants: Vec<String>,
}

/// Standard deviations of a piece's sizes and mass; zero where nothing is declared.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SizeDoubt {
    /// Of the length \[m\].
    pub length: f64,
    /// Of the width \[m\].
    pub width: f64,
    /// Of the thickness \[m\].
    pub thickness: f64,
    /// Of the mass per area \[kg/m²\].
    pub mass_per_area: f64,
}

impl SizeDoubt {
    /// Whether nothing is declared.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }
}

pub(super) fn pieces(source: &Source, pieces: Option<syntax::Pieces>) -> Result<Vec<NamedPiece>, DataError> {
    let missing = || DataError::Missing {
        at: source.whole("piece"),
        remedy: "write [piece] with length, width, thickness (m) and mass_per_area (kg/m2)",
    };
    let several = match pieces.ok_or_else(missing)? {
        syntax::Pieces::One(piece) => return Ok(vec![one(source, *piece, "piece", Some("1"))?]),
        syntax::Pieces::Several(several) if several.is_empty() => return Err(missing()),
        syntax::Pieces::Several(several) => several,
    };
    let at = || source.at(several.first().map_or(0..0, Spanned::span), "piece");
    source.at_most((several.len(), "pieces"), limits::PIECES, at, "give the others a test file of their own")?;
    let single_name = (several.len() == 1).then_some("1");
    let mut read: Vec<NamedPiece> = Vec::with_capacity(several.len());
    for (index, piece) in several.into_iter().enumerate() {
        let key = format!("piece[{}]", index + 1);
        let span = piece.get_ref().name.as_ref().map_or(piece.span(), Spanned::span);
        let piece = one(source, piece.into_inner(), &key, single_name)?;
        if read.iter().any(|earlier| earlier.name == piece.name) {
            return Err(DataError::Duplicate { at: source.at(span, format!("{key}.name")), name: piece.name });
        }
        read.push(piece);
    }
    Ok(read)
}

fn one(source: &Source, piece: syntax::Piece, key: &str, default_name: Option<&str>) -> Result<NamedPiece, DataError> {
    let size = |number: &Option<Spanned<f64>>, name: &str| {
        let key = format!("{key}.{name}");
        let missing = DataError::Missing { at: source.whole(&key), remedy: "give it in m" };
        source.positive(number.as_ref().ok_or(missing)?, &key, "m")
    };
    let (length, width) = (size(&piece.length, "length")?, size(&piece.width, "width")?);
    let thickness = size(&piece.thickness, "thickness")?;
    let mass_per_area = mass_per_area(source, &piece, key)?;
    let sizes = Piece { length, width, thickness, mass_per_area };
    if let Err(error) = sizes.checked() {
        return Err(DataError::Model { at: source.at(of_size(&piece, &error), key), source: error });
    }
    if let Err(error) = sizes.solid() {
        let spans = [&piece.thickness, &piece.length].into_iter().flatten().next();
        let at = spans.map_or_else(|| source.whole(key), |number| source.at(number.span(), format!("{key}.thickness")));
        let problem = format!("{error}, weighings in m, m and kg");
        return Err(DataError::Contradiction { at, problem });
    }
    let name = match &piece.name {
        Some(name) if !name.get_ref().trim().is_empty() => name.get_ref().clone(),
        given => default_name.filter(|_| given.is_none()).map(str::to_owned).ok_or_else(|| DataError::Missing {
            at: source.whole(format!("{key}.name")),
            remedy: "with several pieces each needs a name, which measurements then give as piece = \"...\"",
        })?,
    };
    let characters = name.chars().count();
    if characters > limits::NAME {
        let span = piece.name.as_ref().map_or(0..0, Spanned::span);
        let at = || source.at(span, format!("{key}.name"));
        source.at_most((characters, "characters"), limits::NAME, at, "give a shorter name")?;
    }
    let doubt = doubt(source, (&piece, &sizes), key)?;
    let own_constants = own_constants(source, piece.own_constants, key)?;
    Ok(NamedPiece { name, piece: sizes, doubt, own_constants })
}

/// The standard deviations that are declared: above zero, and less than what they are of.
fn doubt(source: &Source, (given, sizes): (&syntax::Piece, &Piece), key: &str) -> Result<SizeDoubt, DataError> {
    let std = |number: &Option<Spanned<f64>>, size: f64, name: &str, unit: &str| {
        let Some(number) = number else { return Ok(0.0) };
        let key = format!("{key}.{name}_std");
        let value = source.positive(number, &key, unit)?;
        if value < size {
            return Ok(value);
        }
        let range = format!("must be less than {name} itself, {size} {unit}: it is its standard deviation");
        Err(DataError::OutOfRange { at: source.at(number.span(), key), value, range })
    };
    Ok(SizeDoubt {
        length: std(&given.length_std, sizes.length, "length", "m")?,
        width: std(&given.width_std, sizes.width, "width", "m")?,
        thickness: std(&given.thickness_std, sizes.thickness, "thickness", "m")?,
        mass_per_area: std(&given.mass_per_area_std, sizes.mass_per_area, "mass_per_area", "kg/m2")?,
    })
}

/// Where the size stands that is refused.
fn of_size(piece: &syntax::Piece, error: &ModelError) -> Range<usize> {
    let (ModelError::Size { name, .. } | ModelError::SizeRange { name, .. }) = error else { return 0..0 };
    let number = match *name {
        "length" => &piece.length,
        "width" => &piece.width,
        "thickness" => &piece.thickness,
        _ => &piece.mass_per_area,
    };
    let weighed = || piece.weighings.as_ref().map(Spanned::span);
    number.as_ref().map(Spanned::span).or_else(weighed).unwrap_or(0..0)
}

/// Which names a structure has is judged where the structure is known.
fn own_constants(source: &Source, given: Vec<Spanned<String>>, key: &str) -> Result<Vec<String>, DataError> {
    let at = || source.at(given.first().map_or(0..0, Spanned::span), format!("{key}.own_constants"));
    source.at_most((given.len(), "names"), limits::OWN_CONSTANTS, at, "a structure has no more constants")?;
    let mut names: Vec<String> = Vec::with_capacity(given.len());
    for (index, name) in given.into_iter().enumerate() {
        let at = source.at(name.span(), format!("{key}.own_constants[{}]", index + 1));
        let name = name.into_inner();
        if name.trim().is_empty() {
            return Err(DataError::Missing { at, remedy: "give a constant's name, such as \"g_zx\"" });
        }
        if names.contains(&name) {
            return Err(DataError::Duplicate { at, name });
        }
        names.push(name);
    }
    Ok(names)
}

/// $\rho t$ as given, or the mean of mass / (length x width) over the weighed coupons (the paper's table 2).
fn mass_per_area(source: &Source, piece: &syntax::Piece, key: &str) -> Result<f64, DataError> {
    let weighings = match (&piece.mass_per_area, &piece.weighings) {
        (Some(number), None) => return source.positive(number, &format!("{key}.mass_per_area"), "kg/m2"),
        (None, Some(weighings)) => weighings,
        (Some(_), Some(weighings)) => {
            return Err(DataError::Contradiction {
                at: source.at(weighings.span(), format!("{key}.weighings")),
                problem: "mass_per_area is given too: keep one of them".into(),
            });
        }
        (None, None) => {
            return Err(DataError::Missing {
                at: source.whole(format!("{key}.mass_per_area")),
                remedy: "give it in kg/m2, or weighings = [[length, width, mass], ...] in m, m, kg",
            });
        }
    };
    let key = format!("{key}.weighings");
    let coupons = weighings.get_ref();
    if coupons.is_empty() {
        let remedy = "give at least one [length, width, mass] in m, m, kg".into();
        return Err(DataError::Count { at: source.at(weighings.span(), key), found: 0, remedy });
    }
    let at = || source.at(weighings.span(), key.as_str());
    source.at_most((coupons.len(), "coupons"), limits::WEIGHINGS, at, "weigh fewer: their mean counts")?;
    let mut sum = 0.0;
    for (index, [length, width, mass]) in coupons.iter().enumerate() {
        let entry = |position: usize| format!("{key}[{}][{position}]", index + 1);
        let length = source.positive(length, &entry(1), "m")?;
        let width = source.positive(width, &entry(2), "m")?;
        sum += source.positive(mass, &entry(3), "kg")? / (length * width);
    }
    let mean = sum / coupons.len() as f64;
    // Sizes of 1e-200 m are positive numbers, and their quotient still is none.
    let number = Spanned::new(weighings.span(), mean);
    source.positive(&number, &key, "kg/m2")
}
