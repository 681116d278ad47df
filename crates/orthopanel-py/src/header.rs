//! What Python says of a test and of its records, as JSON whose numbers it has checked.

use std::collections::BTreeMap;

use orthopanel::data::{
    DeclaredEffect, Direction, ImpactTest, KnownConstant, Motion, NamedPiece, NaturalFrequencies, RecordedResponse,
    SizeDoubt, Trigger, Unit,
};
use orthopanel::{Piece, Place};
use orthopanel_model::{Boundary, StructureKind};
use serde::Deserialize;

/// All of a test but its measurements.
#[derive(Deserialize)]
pub struct Header {
    structure: Option<StructureKind>,
    pieces: Vec<PieceEntry>,
    #[serde(default)]
    boundary: Boundary,
    #[serde(default)]
    suspension: Vec<[f64; 2]>,
    #[serde(default)]
    constants: BTreeMap<String, Constant>,
    #[serde(default)]
    effects: Vec<Effect>,
}

#[derive(Deserialize)]
struct PieceEntry {
    name: String,
    length: f64,
    width: f64,
    thickness: f64,
    mass_per_area: f64,
    length_std: f64,
    width_std: f64,
    thickness_std: f64,
    mass_per_area_std: f64,
    own_constants: Vec<String>,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Constant {
    Held(f64),
    Prior { value: f64, std: f64 },
    Start { start: f64 },
}

#[derive(Deserialize)]
struct Effect {
    id: String,
    #[serde(flatten)]
    parameters: BTreeMap<String, f64>,
}

impl Header {
    pub fn into_test(self) -> ImpactTest {
        let piece = |of: PieceEntry| NamedPiece {
            doubt: SizeDoubt {
                length: of.length_std,
                width: of.width_std,
                thickness: of.thickness_std,
                mass_per_area: of.mass_per_area_std,
            },
            own_constants: of.own_constants,
            ..NamedPiece::new(
                of.name,
                Piece { length: of.length, width: of.width, thickness: of.thickness, mass_per_area: of.mass_per_area },
            )
        };
        let mut test = ImpactTest {
            structure: self.structure,
            pieces: self.pieces.into_iter().map(piece).collect(),
            boundary: self.boundary,
            suspension: self.suspension.into_iter().map(|[x, y]| Place { x, y }).collect(),
            effects: self
                .effects
                .into_iter()
                .map(|effect| DeclaredEffect { id: effect.id, parameters: effect.parameters })
                .collect(),
            ..ImpactTest::default()
        };
        for (name, constant) in self.constants {
            let known = match constant {
                Constant::Held(value) => {
                    test.constants.insert(name, value);
                    continue;
                }
                Constant::Prior { value, std } => KnownConstant::Prior { value, std },
                Constant::Start { start } => KnownConstant::Start(start),
            };
            test.known_constants.insert(name, known);
        }
        test
    }
}

/// How records in memory are to be read; as those of a test file where nothing is said.
#[derive(Deserialize, Default)]
#[serde(default)]
pub struct ReadAs {
    force_unit: Option<String>,
    response_unit: Option<String>,
    quantity: Option<String>,
    force_sensitivity: Option<f64>,
    response_sensitivity: Option<f64>,
    direction: Option<i8>,
    band: Option<[f64; 2]>,
    window_decay: Option<f64>,
    trigger: Option<TriggerEntry>,
}

#[derive(Deserialize)]
struct TriggerEntry {
    level: Option<f64>,
    before: Option<f64>,
    length: Option<f64>,
}

impl ReadAs {
    /// # Errors
    /// What is no unit, no quantity or no direction, and its key.
    pub fn on(self, mut records: RecordedResponse) -> Result<RecordedResponse, (String, &'static str)> {
        let unit = |text: Option<String>, key: &'static str| match text {
            None => Ok(None),
            Some(text) => Unit::parse(&text).map(Some).ok_or((
                format!(
                    "{key} = {text:?} is no unit that is known: give one as \"N\", \"lbf\", \"m/s2\", \"g\" or \"mm/s\""
                ),
                key,
            )),
        };
        records.force_unit = unit(self.force_unit, "force_unit")?;
        records.response_unit = unit(self.response_unit, "response_unit")?;
        records.quantity = match self.quantity.as_deref() {
            None => None,
            Some("acceleration") => Some(Motion::Acceleration),
            Some("velocity") => Some(Motion::Velocity),
            Some("displacement") => Some(Motion::Displacement),
            Some(other) => {
                let told = format!("quantity = {other:?}: must be \"acceleration\", \"velocity\" or \"displacement\"");
                return Err((told, "quantity"));
            }
        };
        records.direction = match self.direction {
            None => None,
            Some(1) => Some(Direction::AlongForce),
            Some(-1) => Some(Direction::AgainstForce),
            Some(other) => return Err((format!("direction = {other}: must be 1 or -1"), "direction")),
        };
        records.force_sensitivity = self.force_sensitivity;
        records.response_sensitivity = self.response_sensitivity;
        records.band = self.band;
        records.window_decay = self.window_decay;
        records.trigger = self.trigger.map(|TriggerEntry { level, before, length }| Trigger { level, before, length });
        Ok(records)
    }
}

/// A list of natural frequencies.
#[derive(Deserialize)]
pub struct Frequencies {
    values: Vec<f64>,
    #[serde(default)]
    resolution: Vec<f64>,
    #[serde(default)]
    scatter: Vec<f64>,
    #[serde(default)]
    shape: Vec<[u32; 2]>,
    response_at: Option<[f64; 2]>,
}

impl From<Frequencies> for NaturalFrequencies {
    fn from(of: Frequencies) -> Self {
        let Frequencies { values, resolution, scatter, shape, response_at } = of;
        Self { values, resolution, scatter, shape, response_at: response_at.map(|[x, y]| Place { x, y }) }
    }
}
