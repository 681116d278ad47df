//! Which records belong to one blow, and between which nodes a file's measurements lie.

use std::mem;

use super::{Port, Quantity, Record, RecordFile, RecordKind, quantity};

/// The records against time of each blow, by their places in the file: a force with the responses that stand beside it, behind it in
/// most files.
pub(crate) fn blows(records: &[Record], is_hammer: impl Fn(&Record) -> bool) -> Vec<Vec<usize>> {
    let times = || records.iter().enumerate().filter(|(_, record)| record.kind == RecordKind::Time);
    let behind = times().next().is_some_and(|(_, first)| is_hammer(first));
    let (mut blows, mut blow): (Vec<Vec<usize>>, Vec<usize>) = (Vec::new(), Vec::new());
    for (at, record) in times() {
        let hammer = is_hammer(record);
        if hammer && behind && !blow.is_empty() {
            blows.push(mem::take(&mut blow));
        }
        blow.push(at);
        if hammer && !behind {
            blows.push(mem::take(&mut blow));
        }
    }
    blows.push(blow);
    blows
}

/// True for a record that holds a force by what it tells.
pub(crate) fn is_force(record: &Record) -> bool {
    quantity(&record.numerator) == Quantity::Force
}

impl RecordFile {
    /// Force and response of each measurement in the file, each pair once in the order of the file: of its frequency responses where
    /// it `is_of_responses`, else of its blows. Of several directions those along z.
    pub(crate) fn pairs(&self, is_of_responses: bool) -> Vec<[Port; 2]> {
        let mut pairs: Vec<[Port; 2]> = Vec::new();
        let mut add = |pair: [Port; 2]| {
            if !pairs.contains(&pair) {
                pairs.push(pair);
            }
        };
        if is_of_responses {
            let of_kind = self.records.iter().filter(|record| record.kind == RecordKind::FrequencyResponse);
            of_kind.for_each(|record| add([record.reference, record.response]));
        } else {
            for blow in blows(&self.records, is_force) {
                let records = || blow.iter().filter_map(|&at| self.records.get(at));
                let force = records().find(|record| is_force(record));
                let motions = records()
                    .filter(|record| !is_force(record) && !matches!(quantity(&record.numerator), Quantity::Other(_)));
                if let Some(force) = force {
                    motions.for_each(|motion| add([force.response, motion.response]));
                }
            }
        }
        let is_along = |pair: &[Port; 2]| pair.iter().all(|port| matches!(port.direction.abs(), 0 | 3));
        if pairs.iter().any(is_along) {
            pairs.retain(is_along);
        }
        pairs
    }
}
