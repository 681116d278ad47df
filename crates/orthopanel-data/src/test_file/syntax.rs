//! The keys of a test file as they are written, before their meaning is checked.
//!
//! Keys that must be there are optional here too, so that the message for a missing one can say what to write. A
//! measurement is one flat table, not an enum tagged by `kind`: serde buffers tagged enums, and loses the spans.

use std::{collections::BTreeMap, fmt};

use orthopanel_model::Boundary;
use serde::{
    Deserialize, Deserializer,
    de::{MapAccess, SeqAccess, Visitor, value::MapAccessDeserializer, value::SeqAccessDeserializer},
};
use toml::Spanned;

use super::RecordedResponse;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TestFile {
    pub(super) structure: Option<Spanned<String>>,
    pub(super) band: Option<Spanned<[f64; 2]>>,
    pub(super) piece: Option<Pieces>,
    #[serde(default)]
    pub(super) boundary: Boundary,
    pub(super) suspension: Option<Suspension>,
    #[serde(default)]
    pub(super) constants: BTreeMap<String, Spanned<Constant>>,
    #[serde(default)]
    pub(super) effect: Vec<Spanned<BTreeMap<String, Spanned<toml::Value>>>>,
    #[serde(default)]
    pub(super) measurement: Vec<Spanned<Measurement>>,
}

/// `[piece]` or `[[piece]]`.
pub(super) enum Pieces {
    One(Box<Piece>),
    Several(Vec<Spanned<Piece>>),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Piece {
    pub(super) name: Option<Spanned<String>>,
    pub(super) length: Option<Spanned<f64>>,
    pub(super) width: Option<Spanned<f64>>,
    pub(super) thickness: Option<Spanned<f64>>,
    pub(super) mass_per_area: Option<Spanned<f64>>,
    pub(super) weighings: Option<Spanned<Vec<[Spanned<f64>; 3]>>>,
    pub(super) length_std: Option<Spanned<f64>>,
    pub(super) width_std: Option<Spanned<f64>>,
    pub(super) thickness_std: Option<Spanned<f64>>,
    pub(super) mass_per_area_std: Option<Spanned<f64>>,
    #[serde(default)]
    pub(super) own_constants: Vec<Spanned<String>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Suspension {
    pub(super) at: Vec<Spanned<SuspensionPoint>>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Measurement {
    pub(super) kind: Option<Spanned<String>>,
    pub(super) piece: Option<Spanned<String>>,
    pub(super) values: Option<Spanned<Vec<Spanned<f64>>>>,
    pub(super) resolution: Option<Spanned<OneOrEach>>,
    pub(super) scatter: Option<Spanned<OneOrEach>>,
    pub(super) shape: Option<Spanned<Vec<Spanned<[u32; 2]>>>>,
    pub(super) file: Option<Spanned<toml::Value>>,
    pub(super) force_at: Option<Spanned<[f64; 2]>>,
    pub(super) response_at: Option<Spanned<[f64; 2]>>,
    pub(super) unit: Option<Spanned<String>>,
    pub(super) response_unit: Option<Spanned<String>>,
    pub(super) force_unit: Option<Spanned<String>>,
    pub(super) quantity: Option<Spanned<String>>,
    pub(super) response_sensitivity: Option<Spanned<f64>>,
    pub(super) force_sensitivity: Option<Spanned<f64>>,
    pub(super) force_channel: Option<Spanned<toml::Value>>,
    pub(super) response_channel: Option<Spanned<toml::Value>>,
    pub(super) trigger: Option<Trigger>,
    pub(super) columns: Option<Spanned<BTreeMap<String, Spanned<toml::Value>>>>,
    pub(super) places: Option<Spanned<String>>,
    pub(super) origin: Option<Spanned<[f64; 2]>>,
    pub(super) band: Option<Spanned<[f64; 2]>>,
    pub(super) sampling_rate: Option<Spanned<f64>>,
    pub(super) frequency_unit: Option<Spanned<String>>,
    pub(super) window_decay: Option<Spanned<f64>>,
    pub(super) direction: Option<Spanned<f64>>,
    pub(super) record: Option<Spanned<u32>>,
    /// In place of `file`: records that no text names, with channels and columns as they are.
    #[serde(skip)]
    pub(super) given: Option<Box<RecordedResponse>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Trigger {
    pub(super) level: Option<Spanned<f64>>,
    pub(super) before: Option<Spanned<f64>>,
    pub(super) length: Option<Spanned<f64>>,
}

/// A number at which a constant is held, or what is known of it beforehand.
pub(super) enum Constant {
    Held(f64),
    Known(KnownConstant),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct KnownConstant {
    pub(super) start: Option<f64>,
    pub(super) value: Option<f64>,
    pub(super) std: Option<f64>,
}

/// A point that carries the piece: x alone, on the centre line, or x and y.
pub(super) struct SuspensionPoint(pub(super) [f64; 2]);

/// One number for all modes, or one a mode.
pub(super) enum OneOrEach {
    One(f64),
    Each(Vec<Spanned<f64>>),
}

// The enums below are told apart by the shape of the value, through visitors: serde's `untagged` would buffer the
// value, lose its spans, and answer a wrong key with "data did not match any variant".

impl<'de> Deserialize<'de> for Pieces {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct PiecesVisitor;
        impl<'de> Visitor<'de> for PiecesVisitor {
            type Value = Pieces;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a table [piece], or tables [[piece]]")
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Pieces, A::Error> {
                Piece::deserialize(MapAccessDeserializer::new(map)).map(|piece| Pieces::One(Box::new(piece)))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Pieces, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(seq)).map(Pieces::Several)
            }
        }
        deserializer.deserialize_any(PiecesVisitor)
    }
}

impl<'de> Deserialize<'de> for Constant {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ConstantVisitor;
        impl<'de> Visitor<'de> for ConstantVisitor {
            type Value = Constant;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number, {start = ..} or {value = .., std = ..}")
            }

            fn visit_f64<E>(self, value: f64) -> Result<Constant, E> {
                Ok(Constant::Held(value))
            }

            fn visit_i64<E>(self, value: i64) -> Result<Constant, E> {
                Ok(Constant::Held(value as f64))
            }

            fn visit_u64<E>(self, value: u64) -> Result<Constant, E> {
                Ok(Constant::Held(value as f64))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Constant, A::Error> {
                KnownConstant::deserialize(MapAccessDeserializer::new(map)).map(Constant::Known)
            }
        }
        deserializer.deserialize_any(ConstantVisitor)
    }
}

impl<'de> Deserialize<'de> for SuspensionPoint {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct PointVisitor;
        impl<'de> Visitor<'de> for PointVisitor {
            type Value = SuspensionPoint;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("x in m, or [x, y]")
            }

            fn visit_f64<E>(self, x: f64) -> Result<SuspensionPoint, E> {
                Ok(SuspensionPoint([x, 0.0]))
            }

            fn visit_i64<E>(self, x: i64) -> Result<SuspensionPoint, E> {
                Ok(SuspensionPoint([x as f64, 0.0]))
            }

            fn visit_u64<E>(self, x: u64) -> Result<SuspensionPoint, E> {
                Ok(SuspensionPoint([x as f64, 0.0]))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<SuspensionPoint, A::Error> {
                <[f64; 2]>::deserialize(SeqAccessDeserializer::new(seq)).map(SuspensionPoint)
            }
        }
        deserializer.deserialize_any(PointVisitor)
    }
}

impl<'de> Deserialize<'de> for OneOrEach {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct OneOrEachVisitor;
        impl<'de> Visitor<'de> for OneOrEachVisitor {
            type Value = OneOrEach;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("one number [Hz], or a list with one number a mode")
            }

            fn visit_f64<E>(self, value: f64) -> Result<OneOrEach, E> {
                Ok(OneOrEach::One(value))
            }

            fn visit_i64<E>(self, value: i64) -> Result<OneOrEach, E> {
                Ok(OneOrEach::One(value as f64))
            }

            fn visit_u64<E>(self, value: u64) -> Result<OneOrEach, E> {
                Ok(OneOrEach::One(value as f64))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<OneOrEach, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(seq)).map(OneOrEach::Each)
            }
        }
        deserializer.deserialize_any(OneOrEachVisitor)
    }
}
