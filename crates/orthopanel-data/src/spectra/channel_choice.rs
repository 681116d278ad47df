//! Which records of a file belong to a measurement, where the file holds more than one pair of channels.
//!
//! Chosen by `force_channel` and `response_channel`; without them by the places of the file's nodes (datasets 15 and 2411), and by the
//! direction, where only one record is along z.

use std::sync::Arc;

use super::channels::{self, Quantity};
use crate::{
    ChannelName, DataError, RecordedResponse,
    error::some_of,
    listing::port_text,
    records::{Node, Port, Record, RecordFile, RecordKind, blows, data_type, is_force as tells_force, without_unit},
};

/// A node and a place this far apart \[m\] are one: places are measured to millimetres.
const NEAR: f64 = 0.005;

/// Which of the two channels.
#[derive(Clone, Copy, PartialEq)]
enum Role {
    Force,
    Response,
}

impl Role {
    fn key(self) -> &'static str {
        match self {
            Self::Force => "force_channel",
            Self::Response => "response_channel",
        }
    }

    fn declared(self, measurement: &RecordedResponse) -> Option<&ChannelName> {
        match self {
            Self::Force => measurement.force_channel.as_ref(),
            Self::Response => measurement.response_channel.as_ref(),
        }
    }

    /// Where the channel stands in a record: that of a force against time is its own, of a frequency response its reference.
    fn port(self, record: &Record) -> Port {
        match (self, record.kind) {
            (Self::Force, RecordKind::FrequencyResponse) => record.reference,
            _ => record.response,
        }
    }

    /// The node of the file that stands where the test file puts the channel; `None` where none or several do.
    fn node(self, nodes: &[Node], measurement: &RecordedResponse) -> Option<i64> {
        let place = match self {
            Self::Force => measurement.force_at,
            Self::Response => measurement.response_at,
        };
        let mut near = nodes.iter().filter(|node| (node.at[0] - place.x).hypot(node.at[1] - place.y) < NEAR);
        let found = near.next()?.number;
        near.next().is_none().then_some(found)
    }
}

impl ChannelName {
    /// Whether a record is of this channel; `numbered` is the record that a number names.
    fn is(&self, record: &Record, role: Role, numbered: Option<&Record>) -> bool {
        let port = role.port(record);
        match self {
            Self::Number(number) if record.number == *number => true,
            // Further hits of the channel that the number names: told by node, or by name.
            Self::Number(_) => numbered.is_some_and(|named| {
                let own = role.port(named);
                record.kind == RecordKind::Time
                    && record.numerator.data_type == named.numerator.data_type
                    && own.node != 0
                    && own == port
            }),
            Self::Port { node, direction } => port.node == *node && (*direction == 0 || port.direction == *direction),
            // With its unit or without.
            Self::Name(name) => record.title.split(" | ").any(|line| line == name || without_unit(line) == name),
        }
    }
}

/// The file with the records of one measurement of hits: force and response in turn, where a choice had to be made. Of a file that
/// others read too what is chosen is copied.
///
/// # Errors
/// [`DataError::Channels`] where a declared channel is not in the file.
pub(super) fn hits(file: Arc<RecordFile>, measurement: &RecordedResponse) -> Result<RecordFile, DataError> {
    let Some(pairs) = pairs(&file, measurement)? else { return Ok(Arc::unwrap_or_clone(file)) };
    if pairs.is_empty() {
        return Err(DataError::NoRecords {
            at: crate::Location::whole(&measurement.file),
            what: "blow with a record of both channels that its measurement names",
        });
    }
    let chosen = |records: &mut dyn FnMut(usize) -> Option<Record>| {
        let mut taken = Vec::with_capacity(2 * pairs.len());
        for (force, response) in &pairs {
            // What is chosen needs no type of its own.
            if let (Some(mut force), Some(mut response)) = (records(*force), records(*response)) {
                if !tells_force(&force) {
                    force.numerator.data_type = data_type::FORCE;
                }
                if !matches!(channels::quantity(&response.numerator), Quantity::Motion(_)) {
                    response.numerator.data_type = measurement.data_type();
                }
                taken.extend([force, response]);
            }
        }
        taken
    };
    Ok(match Arc::try_unwrap(file) {
        Ok(RecordFile { records, notes, nodes }) => {
            let mut records: Vec<Option<Record>> = records.into_iter().map(Some).collect();
            RecordFile { records: chosen(&mut |at| records.get_mut(at).and_then(Option::take)), notes, nodes }
        }
        Err(shared) => RecordFile {
            records: chosen(&mut |at| shared.records.get(at).cloned()),
            notes: shared.notes.clone(),
            nodes: shared.nodes.clone(),
        },
    })
}

/// Places of force and response of each blow among the records of a file; `None` where nothing has to be chosen.
fn pairs(file: &RecordFile, measurement: &RecordedResponse) -> Result<Option<Vec<(usize, usize)>>, DataError> {
    let in_time = |record: &&Record| record.kind == RecordKind::Time;
    let [force, response] = [Role::Force, Role::Response].map(|role| chosen(file, measurement, role, in_time));
    let (force, response) = (force?, response?);
    if force.is_none() && response.is_none() {
        return Ok(None);
    }
    let is_force = |record: &Record| match &force {
        Some(force) => force.contains(&record.number),
        None => tells_force(record),
    };
    let is_response = |record: &Record| match &response {
        Some(response) => response.contains(&record.number),
        None => {
            !is_force(record) && !matches!(channels::quantity(&record.numerator), Quantity::Force | Quantity::Other(_))
        }
    };
    let mut pairs = Vec::new();
    for blow in blows(&file.records, |record| is_force(record) || tells_force(record)) {
        let of_blow =
            |is: &dyn Fn(&Record) -> bool| blow.iter().copied().find(|&at| file.records.get(at).is_some_and(is));
        let force = of_blow(&is_force);
        // A force or a response alone is of another measurement.
        if let (Some(force), Some(response)) = (force, of_blow(&|record| is_response(record) && !is_force(record))) {
            pairs.push((force, response));
        }
    }
    Ok(Some(pairs))
}

/// The numbers of the frequency responses that a measurement may mean: one where one fits alone.
///
/// # Errors
/// [`DataError::Channels`] where a declared channel is not in the file.
pub(super) fn response(file: &RecordFile, measurement: &RecordedResponse) -> Result<Vec<usize>, DataError> {
    if let Some(record) = measurement.record {
        return Ok(vec![record]);
    }
    let of_kind = |record: &&Record| record.kind == RecordKind::FrequencyResponse;
    let [force, response] = [Role::Force, Role::Response].map(|role| chosen(file, measurement, role, of_kind));
    let (force, response) = (force?, response?);
    let fits = |record: &&Record| {
        let is_in = |chosen: &Option<Vec<usize>>| chosen.as_ref().is_none_or(|chosen| chosen.contains(&record.number));
        is_in(&force) && is_in(&response)
    };
    Ok(file.records.iter().filter(of_kind).filter(fits).map(|record| record.number).collect())
}

/// Numbers of the records of one channel; `None` where nothing has to be chosen, or nothing tells it.
fn chosen(
    file: &RecordFile,
    measurement: &RecordedResponse,
    role: Role,
    of_kind: impl Fn(&&Record) -> bool,
) -> Result<Option<Vec<usize>>, DataError> {
    let numbers = |is: &dyn Fn(&Record) -> bool| -> Vec<usize> {
        file.records.iter().filter(&of_kind).filter(|record| is(record)).map(|record| record.number).collect()
    };
    if let Some(name) = role.declared(measurement) {
        let numbered = match name {
            ChannelName::Number(number) => file.records.iter().find(|record| record.number == *number),
            _ => None,
        };
        let found = numbers(&|record| name.is(record, role, numbered));
        if found.is_empty() {
            let at = crate::Location::whole(&measurement.file);
            let problem = format!("{} = {name} is none of its channels: {}", role.key(), listed(file, role, &of_kind));
            return Err(DataError::Channels { at, problem });
        }
        return Ok(Some(found));
    }
    let may_be = |record: &Record| match (record.kind, channels::quantity(&record.numerator)) {
        (RecordKind::FrequencyResponse, _) => true,
        (_, Quantity::Force) => role == Role::Force,
        (_, Quantity::Motion(_)) => role == Role::Response,
        _ => false,
    };
    let ports = |of: &[usize]| {
        let mut ports: Vec<Port> = Vec::new();
        for record in file.records.iter().filter(|record| of.contains(&record.number)) {
            let port = role.port(record);
            if !ports.contains(&port) {
                ports.push(port);
            }
        }
        ports
    };
    let mut left = numbers(&may_be);
    if ports(&left).len() < 2 {
        return Ok(None);
    }
    let all = left.len();
    if let Some(node) = role.node(&file.nodes, measurement) {
        left = numbers(&|record| may_be(record) && role.port(record).node == node);
    }
    if let [first, second, ..] = ports(&left)[..]
        && first.node == second.node
        && ports(&left).iter().all(|port| port.node == first.node)
        && ports(&left).iter().filter(|port| port.direction.abs() == 3).count() == 1
    {
        left.retain(|number| {
            file.records.iter().any(|record| record.number == *number && role.port(record).direction.abs() == 3)
        });
    }
    Ok((!left.is_empty() && left.len() < all).then_some(left))
}

/// The lines that each choose one of these channels, for messages.
pub(super) fn written((key, records): (&str, &Vec<Record>)) -> String {
    let mut lines: Vec<String> = Vec::new();
    for record in records {
        let name = match port_text(record.response) {
            port if !port.is_empty() => format!("{port:?}"),
            _ => match without_unit(record.title.split(" | ").next().unwrap_or_default()) {
                "" => record.number.to_string(),
                title => format!("{:?}", crate::error::short(title)),
            },
        };
        let line = format!("{key} = {name}");
        if !lines.contains(&line) {
            lines.push(line);
        }
    }
    some_of(&lines, ", or ")
}

/// The channels of a file, for messages.
fn listed(file: &RecordFile, role: Role, of_kind: impl Fn(&&Record) -> bool) -> String {
    let name = |record: &Record| {
        let Port { node, direction } = role.port(record);
        let sign = if direction < 0 { "-" } else { "+" };
        let along = match direction.abs() {
            1 => "x",
            2 => "y",
            3 => "z",
            _ => "",
        };
        let title = crate::error::short(&record.title);
        match (node, along) {
            (0, _) => format!("{} ({title:?})", record.number),
            (_, "") => format!("\"{node}\""),
            _ => format!("\"{node}:{sign}{along}\""),
        }
    };
    let mut names: Vec<String> = Vec::new();
    for found in file.records.iter().filter(of_kind).map(name) {
        if !names.contains(&found) {
            names.push(found);
        }
    }
    some_of(&names, ", ")
}
