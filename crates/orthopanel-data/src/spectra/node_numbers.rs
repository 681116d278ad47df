//! The node numbers of a test's files against the places that the test file gives them.

use orthopanel_model::Place;

use super::channels::{self, Quantity};
use crate::{
    DataError, Location, RecordedResponse,
    records::{Record, RecordFile, RecordKind},
};

/// Places this far apart \[m\] are two: a hammer strays by some millimetres about one.
const APART: f64 = 0.005;

/// What stands at a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Channel {
    Hammer,
    Sensor,
}

impl Channel {
    fn name(self) -> &'static str {
        match self {
            Self::Hammer => "hammer",
            Self::Sensor => "sensor",
        }
    }

    fn choice(self) -> &'static str {
        match self {
            Self::Hammer => "force_channel",
            Self::Sensor => "response_channel",
        }
    }

    fn key(self) -> &'static str {
        match self {
            Self::Hammer => "force_at",
            Self::Sensor => "response_at",
        }
    }
}

/// One channel of one file: the node that its records name, and the place that the test file gives it.
pub(super) struct NumberedPlace {
    channel: Channel,
    node: i64,
    place: Place,
    at: Box<Location>,
}

impl NumberedPlace {
    /// The nodes that a measurement's file tells; none for a file without numbers, such as CSV.
    ///
    /// # Errors
    /// [`DataError::Contradiction`] where records against time name several nodes of one channel: hits of several
    /// places in one file, of which the test file tells one place only.
    pub(super) fn of(file: &RecordFile, measurement: &RecordedResponse) -> Result<Vec<Self>, DataError> {
        let mut found: Vec<Self> = Vec::new();
        for (record, channel, node) in file.records.iter().zip(1..).flat_map(|(record, number)| {
            nodes(record, measurement.record.is_none_or(|chosen| chosen == number)).map(move |(c, n)| (record, c, n))
        }) {
            match found.iter().find(|earlier| earlier.channel == channel) {
                Some(earlier) if earlier.node != node => {
                    let (name, key, before) = (channel.name(), channel.key(), &earlier.at.key);
                    let problem = format!(
                        "the {name} is at node {node}, in {before} at node {}: {key} tells one place; name one by {} = \
                         \"{node}\" in its [[measurement]], or give the records of each place a file of its own",
                        earlier.node,
                        channel.choice()
                    );
                    return Err(DataError::Contradiction { at: record.at.clone(), problem });
                }
                Some(_) => {}
                None => {
                    let place = match channel {
                        Channel::Hammer => measurement.force_at,
                        Channel::Sensor => measurement.response_at,
                    };
                    found.push(Self { channel, node, place, at: record.at.clone() });
                }
            }
        }
        Ok(found)
    }
}

/// The nodes of one record: hammer and sensor of a frequency response, one of them for a record against time.
fn nodes(record: &Record, chosen: bool) -> impl Iterator<Item = (Channel, i64)> + use<> {
    let (response, reference) = (record.response.node, record.reference.node);
    let told = match (record.kind, channels::quantity(&record.numerator)) {
        (RecordKind::Time, Quantity::Force) => vec![(Channel::Hammer, response)],
        (RecordKind::Time, Quantity::Motion(_)) => vec![(Channel::Sensor, response)],
        (RecordKind::FrequencyResponse, _) if chosen => vec![(Channel::Hammer, reference), (Channel::Sensor, response)],
        _ => vec![],
    };
    told.into_iter().filter(|(_, node)| *node != 0)
}

/// Compares the numbers of one piece's files with each other: a node is one place.
///
/// Where a channel has the same number in all files, its writer left it as it was, and it tells nothing.
///
/// # Errors
/// [`DataError::Contradiction`] where one node stands at two places.
pub(super) fn check<'a>(places: impl Iterator<Item = &'a NumberedPlace> + Clone) -> Result<(), DataError> {
    for channel in [Channel::Hammer, Channel::Sensor] {
        let own = || places.clone().filter(|place| place.channel == channel);
        if own().zip(own().skip(1)).all(|(a, b)| a.node == b.node) {
            continue;
        }
        for (index, later) in own().enumerate() {
            let two = |earlier: &&NumberedPlace| {
                let (a, b) = (earlier.place, later.place);
                earlier.node == later.node && (a.x - b.x).hypot(a.y - b.y) > APART
            };
            if let Some(earlier) = own().take(index).find(two) {
                let (key, here, there) = (channel.key(), later.place, earlier.place);
                let problem = format!(
                    "the {} is at node {}, which {key} puts at ({}, {}) here and at ({}, {}) for {}: correct {key} or \
                     the node number",
                    channel.name(),
                    later.node,
                    here.x,
                    here.y,
                    there.x,
                    there.y,
                    earlier.at.file.display(),
                );
                return Err(DataError::Contradiction { at: later.at.clone(), problem });
            }
        }
    }
    Ok(())
}
