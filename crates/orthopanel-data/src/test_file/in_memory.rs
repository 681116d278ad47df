//! A test that is built in memory: its values as the keys of a test file, to be checked by the same rules.

use std::collections::BTreeMap;

use orthopanel_model::Piece;
use toml::Spanned;

use super::{
    DeclaredEffect, Direction, ImpactTest, KnownConstant, Measurement, MeasurementData, NamedPiece, NaturalFrequencies,
    RecordedResponse, SizeDoubt, Source, measurements, syntax,
};
use crate::{DataError, Unit};

impl ImpactTest {
    /// Checks a test whose fields were filled without a file, as [`ImpactTest::from_toml`] checks those of a file; measurements may be
    /// [added](ImpactTest::add) later.
    ///
    /// Messages name keys as they are in test files, of `the test in memory`.
    ///
    /// ```
    /// use orthopanel_data::{ImpactTest, Measurement, MeasurementData, NamedPiece, RecordedResponse, Unit};
    /// use orthopanel_model::{Piece, Place};
    ///
    /// let piece = Piece { length: 0.8, width: 0.1, thickness: 0.03, mass_per_area: 6.88 };
    /// let mut test = ImpactTest {
    ///     pieces: vec![NamedPiece::new("strip", piece)],
    ///     suspension: vec![Place { x: -0.18, y: 0.0 }, Place { x: 0.18, y: 0.0 }],
    ///     ..ImpactTest::default()
    /// }
    /// .checked()?;
    ///
    /// // Two hits of 4096 samples at 10,240 Hz: a blow at 10 ms, and what rings after it.
    /// let rate = 10_240.0;
    /// let blow = |t: f64| 80.0 * (-0.5 * ((t - 0.01) / 1e-4).powi(2)).exp();
    /// let ringing = |t: f64| if t < 0.01 { 0.0 } else { 5.0 * (-20.0 * (t - 0.01)).exp() * (2000.0 * (t - 0.01)).sin() };
    /// let hit = |of: &dyn Fn(f64) -> f64| (0..4096).map(|n| of(f64::from(n) / rate)).collect::<Vec<f64>>();
    /// let (force, acceleration) = (vec![hit(&blow); 2], vec![hit(&ringing); 2]);
    /// let places = [Place { x: -0.3, y: 0.0 }, Place { x: 0.3, y: 0.0 }];
    /// let mut hits = RecordedResponse::of_hits([force, acceleration], rate, places)?;
    /// hits.response_unit = Unit::parse("g");
    /// test.add(Measurement { piece: 0, data: MeasurementData::TimeHistory(hits) })?;
    ///
    /// let (_, history) = &test.time_histories()?[0];
    /// assert_eq!((history.rate, history.hits.len()), (10_240.0, 2));
    /// # Ok::<(), orthopanel_data::DataError>(())
    /// ```
    ///
    /// # Errors
    /// As [`ImpactTest::from_toml`], and [`DataError::Duplicate`] for a constant that is held and known at once.
    pub fn checked(self) -> Result<Self, DataError> {
        let source = Source::in_memory();
        if let Some(name) = self.constants.keys().find(|name| self.known_constants.contains_key(*name)) {
            return Err(DataError::Duplicate { at: source.whole("constants"), name: name.clone() });
        }
        let measurement = self.measurements.iter().map(|of| entry(of, &self.pieces));
        let held = self.constants.iter().map(|(name, value)| (name.clone(), spanned(syntax::Constant::Held(*value))));
        let known = self.known_constants.iter().map(|(name, known)| (name.clone(), spanned(constant(*known))));
        let at = self.suspension.iter().map(|place| spanned(syntax::SuspensionPoint([place.x, place.y])));
        let file = syntax::TestFile {
            structure: self.structure.map(|kind| spanned(kind.name().to_owned())),
            band: None,
            piece: Some(syntax::Pieces::Several(self.pieces.iter().map(|of| spanned(piece(of))).collect())),
            boundary: self.boundary,
            suspension: Some(syntax::Suspension { at: at.collect() }),
            constants: held.chain(known).collect(),
            effect: self.effects.iter().map(effect).map(spanned).collect(),
            measurement: measurement.map(spanned).collect(),
        };
        Self::of_keys(&source, file)
    }

    /// Adds a measurement that is checked as one of a test file: of arrays, of frequencies, or of files.
    ///
    /// # Errors
    /// As [`ImpactTest::from_toml`], of `measurement[N]` with the number that it gets; then the test is as it was.
    pub fn add(&mut self, measurement: Measurement) -> Result<(), DataError> {
        let source = Source::in_memory();
        let entry = entry(&measurement, &self.pieces);
        let added = measurements::one(&source, self.measurements.len(), spanned(entry), (&self.pieces, None))?;
        let before = self.measurements.len();
        self.measurements.extend(added);
        let counted = measurements::count(&source, &self.measurements);
        if counted.is_err() {
            self.measurements.truncate(before);
        }
        counted
    }
}

/// A value without a place in a text.
fn spanned<T>(value: T) -> Spanned<T> {
    Spanned::new(0..0, value)
}

fn text(value: impl ToString) -> Spanned<String> {
    spanned(value.to_string())
}

impl NamedPiece {
    /// A piece of which nothing is known but its sizes and mass.
    pub fn new(name: impl Into<String>, piece: Piece) -> Self {
        Self { name: name.into(), piece, doubt: SizeDoubt::default(), own_constants: Vec::new() }
    }
}

fn piece(of: &NamedPiece) -> syntax::Piece {
    let NamedPiece { name, piece, doubt, own_constants } = of;
    let number = |value: f64| Some(spanned(value));
    // Zero says that nothing is declared.
    let std = |value: f64| (value != 0.0).then(|| spanned(value));
    syntax::Piece {
        name: Some(text(name)),
        length: number(piece.length),
        width: number(piece.width),
        thickness: number(piece.thickness),
        mass_per_area: number(piece.mass_per_area),
        weighings: None,
        length_std: std(doubt.length),
        width_std: std(doubt.width),
        thickness_std: std(doubt.thickness),
        mass_per_area_std: std(doubt.mass_per_area),
        own_constants: own_constants.iter().map(text).collect(),
    }
}

fn constant(known: KnownConstant) -> syntax::Constant {
    let (start, value, std) = match known {
        KnownConstant::Start(start) => (Some(start), None, None),
        KnownConstant::Prior { value, std } => (None, Some(value), Some(std)),
    };
    syntax::Constant::Known(syntax::KnownConstant { start, value, std })
}

fn effect(of: &DeclaredEffect) -> BTreeMap<String, Spanned<toml::Value>> {
    let parameters = of.parameters.iter().map(|(name, value)| (name.clone(), toml::Value::Float(*value)));
    let id = ("id".to_owned(), toml::Value::String(of.id.clone()));
    parameters.chain([id]).map(|(name, value)| (name, spanned(value))).collect()
}

fn entry(measurement: &Measurement, pieces: &[NamedPiece]) -> syntax::Measurement {
    let Measurement { piece, data } = measurement;
    // A number that is none of a piece is told as a name that is none.
    let piece = Some(pieces.get(*piece).map_or_else(|| text(format!("number {piece} from 0")), |of| text(&of.name)));
    let of_kind = |kind: &str, keys| syntax::Measurement { kind: Some(text(kind)), piece, ..keys };
    match data {
        MeasurementData::NaturalFrequencies(list) => of_kind("natural-frequencies", frequencies(list)),
        MeasurementData::TimeHistory(of) => of_kind("time-history", recorded(of)),
        MeasurementData::Accelerance(of) => of_kind("accelerance", recorded(of)),
    }
}

fn frequencies(list: &NaturalFrequencies) -> syntax::Measurement {
    let numbers = |list: &[f64]| list.iter().copied().map(spanned).collect::<Vec<_>>();
    let each = |list: &[f64]| (!list.is_empty()).then(|| spanned(syntax::OneOrEach::Each(numbers(list))));
    let shape = || spanned(list.shape.iter().copied().map(spanned).collect());
    syntax::Measurement {
        values: Some(spanned(numbers(&list.values))),
        resolution: each(&list.resolution),
        scatter: each(&list.scatter),
        shape: (!list.shape.is_empty()).then(shape),
        response_at: list.response_at.map(|place| spanned(place.into())),
        ..syntax::Measurement::default()
    }
}

fn recorded(of: &RecordedResponse) -> syntax::Measurement {
    let number = |value: Option<f64>| value.map(spanned);
    let unit = |unit: &Option<Unit>| unit.as_ref().map(text);
    let direction = of.direction.map(|direction| if direction == Direction::AlongForce { 1.0 } else { -1.0 });
    let trigger = of.trigger.map(|trigger| syntax::Trigger {
        level: number(trigger.level),
        before: number(trigger.before),
        length: number(trigger.length),
    });
    syntax::Measurement {
        force_at: Some(spanned(of.force_at.into())),
        response_at: Some(spanned(of.response_at.into())),
        force_unit: unit(&of.force_unit),
        response_unit: unit(&of.response_unit),
        quantity: of.quantity.map(text),
        force_sensitivity: number(of.force_sensitivity),
        response_sensitivity: number(of.response_sensitivity),
        trigger,
        band: of.band.map(spanned),
        sampling_rate: number(of.sampling_rate),
        frequency_unit: unit(&of.frequency_unit),
        window_decay: number(of.window_decay),
        direction: number(direction),
        record: of.record.map(|number| spanned(u32::try_from(number).unwrap_or(u32::MAX))),
        given: Some(Box::new(of.clone())),
        ..syntax::Measurement::default()
    }
}
