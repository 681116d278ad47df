//! `kind = "time-history"` and `"accelerance"`: a file of records, the places, and what the file does not tell of its channels.

use std::collections::BTreeMap;

use orthopanel_model::{Piece, Place};
use toml::Spanned;

use super::{super::syntax, ChannelName, Direction, Entry, RecordedResponse, Trigger, files::MeasuredFile};
use crate::{ColumnName, ColumnRole, DataError, DeclaredColumns, Motion, Unit, limits, units::Measured};

impl Entry<'_> {
    /// The records of each file of the measurement.
    pub(super) fn recorded(
        &self,
        entry: &syntax::Measurement,
        piece: &Piece,
        band: Option<[f64; 2]>,
    ) -> Result<Vec<RecordedResponse>, DataError> {
        let needed = || self.needed(entry.file.as_ref(), "file", "name a .uff or .csv file beside the test file");
        let name = entry.given.is_none().then(needed).transpose()?;
        let given = |place: &Option<Spanned<[f64; 2]>>, key: &str| {
            place.as_ref().map(|place| self.place(place, key, piece)).transpose()
        };
        let places = [given(&entry.force_at, "force_at")?, given(&entry.response_at, "response_at")?];
        let response_unit = self.response_unit(entry)?;
        let force_unit = self.unit(entry.force_unit.as_ref(), "force_unit", FORCE_UNITS)?;
        let quantity = self.quantity(entry, response_unit.as_ref())?;
        let positive = |number: &Option<Spanned<f64>>, key: &str, unit: &str| {
            number.as_ref().map(|number| self.source.positive(number, &self.name(key), unit)).transpose()
        };
        let sampling_rate = positive(&entry.sampling_rate, "sampling_rate", "Hz")?;
        let trigger = match &entry.trigger {
            None => None,
            Some(given) => Some(Trigger {
                level: positive(&given.level, "trigger.level", "N")?,
                before: positive(&given.before, "trigger.before", "s")?,
                length: positive(&given.length, "trigger.length", "s")?,
            }),
        };
        let [least, most] = limits::SAMPLING_RATE;
        if let (Some(value), Some(given)) =
            (sampling_rate.filter(|rate| !(least..=most).contains(rate)), &entry.sampling_rate)
        {
            let range = format!("must lie between {least} and {most:e} Hz");
            return Err(DataError::OutOfRange { at: self.at(given.span(), "sampling_rate"), value, range });
        }
        let direction = match entry.direction.as_ref().map(|direction| (*direction.get_ref(), direction)) {
            None => None,
            Some((1.0, _)) => Some(Direction::AlongForce),
            Some((-1.0, _)) => Some(Direction::AgainstForce),
            Some((value, direction)) => {
                let range = "must be 1 (sensor along the force) or -1 (turned round)".into();
                return Err(DataError::OutOfRange { at: self.at(direction.span(), "direction"), value, range });
            }
        };
        let record = match entry.record.as_ref().map(|record| (usize::try_from(*record.get_ref()), record)) {
            None => None,
            Some((Ok(number), _)) if number > 0 => Some(number),
            Some((_, record)) => {
                let (at, value) = (self.at(record.span(), "record"), f64::from(*record.get_ref()));
                return Err(DataError::OutOfRange { at, value, range: "records are counted from 1".into() });
            }
        };
        let one = RecordedResponse {
            force_unit,
            response_unit,
            quantity,
            force_sensitivity: positive(&entry.force_sensitivity, "force_sensitivity", "V a unit of force")?,
            response_sensitivity: positive(&entry.response_sensitivity, "response_sensitivity", "V a unit of motion")?,
            direction,
            record,
            force_channel: self.channel(entry.force_channel.as_ref(), "force_channel")?,
            response_channel: self.channel(entry.response_channel.as_ref(), "response_channel")?,
            trigger,
            sampling_rate,
            frequency_unit: self.frequency_unit(entry)?,
            window_decay: positive(&entry.window_decay, "window_decay", "s")?,
            band: self.band(entry.band.as_ref(), "band")?.or(band),
            columns: self.columns(entry.columns.as_ref())?,
            ..RecordedResponse::new("", [Place { x: 0.0, y: 0.0 }; 2])
        };
        let name = match (name, &entry.given) {
            (Some(name), _) => name,
            (None, given) => return Ok(given.iter().map(|given| RecordedResponse::clone(given)).collect()),
        };
        let mut measured = Vec::new();
        for MeasuredFile { file, response_file } in self.files(name)? {
            let of_file = RecordedResponse { file, response_file, ..one.clone() };
            match &entry.places {
                Some(given) => measured.extend(self.at_places((entry, given), of_file, places, piece)?),
                None => {
                    let keys = [("force_at", &entry.force_at), ("response_at", &entry.response_at)];
                    for (key, place) in keys {
                        self.needed(place.as_ref(), key, "give the place [x, y] in m from the piece's centre")?;
                    }
                    if let Some(origin) = &entry.origin {
                        let problem = "belongs to places: take it out, or name the file of places".into();
                        return Err(DataError::Contradiction { at: self.at(origin.span(), "origin"), problem });
                    }
                    let [force_at, response_at] = places.map(|place| place.unwrap_or(Place { x: 0.0, y: 0.0 }));
                    measured.push(RecordedResponse { force_at, response_at, ..of_file });
                }
            }
        }
        Ok(measured)
    }

    /// `columns = {time = "Time (s)", force = 2, response = 3}`.
    fn columns(
        &self,
        given: Option<&Spanned<BTreeMap<String, Spanned<toml::Value>>>>,
    ) -> Result<Option<DeclaredColumns>, DataError> {
        let Some(given) = given else { return Ok(None) };
        let mut columns = DeclaredColumns::default();
        for (name, value) in given.get_ref() {
            let key = format!("columns.{name}");
            let Some(role) = ColumnRole::ALL.into_iter().find(|role| role.name() == name) else {
                let names = ColumnRole::ALL.map(ColumnRole::name).join(", ");
                let remedy = format!("columns are told for {names}");
                return Err(DataError::UnknownName {
                    at: self.at(value.span(), "columns"),
                    name: name.clone(),
                    remedy,
                });
            };
            let column = match value.get_ref() {
                toml::Value::Integer(number) if *number > 0 => usize::try_from(*number).ok().map(ColumnName::Number),
                toml::Value::String(text) => Some(ColumnName::Name(text.clone())),
                _ => None,
            };
            let Some(column) = column else {
                let message = format!(
                    "{} given, wanted is a column's number from 1, or its name in quotes",
                    crate::error::short(&value.get_ref().to_string())
                );
                return Err(DataError::Syntax { at: self.at(value.span(), &key), message });
            };
            columns.0.insert(role, column);
        }
        Ok(Some(columns))
    }

    /// `response_unit`, or `unit`, as it was called before.
    fn response_unit(&self, entry: &syntax::Measurement) -> Result<Option<Unit>, DataError> {
        let (given, key) = match (&entry.response_unit, &entry.unit) {
            (Some(_), Some(unit)) => {
                let problem = "is another name of response_unit: leave one of them out".into();
                return Err(DataError::Contradiction { at: self.at(unit.span(), "unit"), problem });
            }
            (None, Some(unit)) => (Some(unit), "unit"),
            (given, None) => (given.as_ref(), "response_unit"),
        };
        self.unit(given, key, MOTION_UNITS)
    }

    /// The unit that a key names; `wanted` tells examples, and whether a force or a motion is.
    fn unit(
        &self,
        given: Option<&Spanned<String>>,
        key: &str,
        (is_force, wanted): (bool, &str),
    ) -> Result<Option<Unit>, DataError> {
        let Some(given) = given else { return Ok(None) };
        match Unit::parse(given.get_ref()) {
            Some(unit) if unit.is_force() == is_force && (is_force || unit.motion().is_some()) => Ok(Some(unit)),
            _ => {
                let (name, remedy) = (given.get_ref().clone(), format!("must be {wanted}"));
                Err(DataError::UnknownName { at: self.at(given.span(), key), name, remedy })
            }
        }
    }

    fn frequency_unit(&self, entry: &syntax::Measurement) -> Result<Option<Unit>, DataError> {
        let Some(given) = &entry.frequency_unit else { return Ok(None) };
        match Unit::parse(given.get_ref()).filter(|unit| unit.measured() == Some(Measured::Frequency)) {
            Some(unit) => Ok(Some(unit)),
            None => Err(DataError::UnknownName {
                at: self.at(given.span(), "frequency_unit"),
                name: given.get_ref().clone(),
                remedy: "must be \"Hz\", \"kHz\", \"rpm\" or another unit of frequency".into(),
            }),
        }
    }

    /// The channel that a key names.
    fn channel(&self, given: Option<&Spanned<toml::Value>>, key: &str) -> Result<Option<ChannelName>, DataError> {
        let Some(given) = given else { return Ok(None) };
        match given.get_ref() {
            toml::Value::Integer(number) if *number > 0 => Ok(usize::try_from(*number).ok().map(ChannelName::Number)),
            toml::Value::String(text) if !text.trim().is_empty() => Ok(Some(ChannelName::of(text))),
            other => {
                let message = format!(
                    "{} given, wanted is a record's number from 1, \"node:direction\" such as \"12:+z\", or a line of its title",
                    crate::error::short(&other.to_string())
                );
                Err(DataError::Syntax { at: self.at(given.span(), key), message })
            }
        }
    }

    /// What the sensor reads: as `quantity` tells, else as its unit does.
    fn quantity(&self, entry: &syntax::Measurement, unit: Option<&Unit>) -> Result<Option<Motion>, DataError> {
        let Some(given) = &entry.quantity else { return Ok(None) };
        let Some(quantity) = Motion::ALL.into_iter().find(|motion| motion.name() == given.get_ref()) else {
            let name = given.get_ref().clone();
            let remedy = "must be \"acceleration\", \"velocity\" or \"displacement\"".into();
            return Err(DataError::UnknownName { at: self.at(given.span(), "quantity"), name, remedy });
        };
        match unit.and_then(|unit| Some((unit, unit.motion()?))) {
            Some((unit, motion)) if motion != quantity => {
                let problem =
                    format!("a {quantity} is not in {unit}, which is a unit of {motion}: correct one of them");
                Err(DataError::Contradiction { at: self.at(given.span(), "quantity"), problem })
            }
            _ => Ok(Some(quantity)),
        }
    }
}

/// Whether a force is meant, and units of it for messages.
const FORCE_UNITS: (bool, &str) = (true, "a unit of force, such as \"N\", \"kN\", \"lbf\" or \"kgf\"");
const MOTION_UNITS: (bool, &str) =
    (false, "a unit of motion, such as \"m/s2\", \"g\", \"in/s2\", \"mm/s\", \"m/s\" or \"mm\"");
