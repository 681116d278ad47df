//! Which coherence belongs to which frequency response.

use crate::records::{Port, Record, RecordKind};

/// What a file holds for a frequency response.
pub(super) enum Pairing<'a> {
    /// No coherence at all, or each belongs to another response.
    None,
    /// Its own.
    Own(&'a Record),
    /// Some may be its own, and nothing tells which.
    Untold {
        /// Coherences that may be.
        coherences: usize,
        /// Frequency responses that they may belong to.
        responses: usize,
    },
}

/// The coherence of the frequency response at `index` among the records of a file, by their places and directions, and among those of
/// one pair of places by their order.
pub(super) fn of_response(records: &[Record], index: usize) -> Pairing<'_> {
    let Some(response) = records.get(index) else { return Pairing::None };
    // Those that may belong together, in the order of the file: true for a frequency response.
    let together: Vec<(usize, bool)> = records
        .iter()
        .enumerate()
        .filter_map(|(at, record)| match record.kind {
            RecordKind::FrequencyResponse if same(record, response) => Some((at, true)),
            RecordKind::Coherence if same(record, response) => Some((at, false)),
            _ => None,
        })
        .collect();
    let of_kind = |wanted: bool| together.iter().filter(move |(_, kind)| *kind == wanted).map(|(at, _)| *at);
    let (responses, coherences) = (of_kind(true).count(), of_kind(false).count());
    if coherences == 0 {
        return Pairing::None;
    }
    let turn = of_kind(true).position(|at| at == index).unwrap_or(0);
    let own = |at: Option<usize>| at.and_then(|at| records.get(at)).map_or(Pairing::None, Pairing::Own);
    // Each behind its own, each before its own, or all of the one and then all of the other: as many of either pair in turn.
    let alternates = together.chunks(2).all(|pair| matches!(pair, [a, b] if a.1 != b.1));
    let blocks = together.windows(2).filter(|pair| pair[0].1 != pair[1].1).count() == 1;
    if responses == coherences && (alternates || blocks) {
        return own(of_kind(false).nth(turn));
    }
    // Else some responses have none: the others' stand all behind, or all before, their own.
    let beside = |behind: bool| {
        let order: Vec<(usize, bool)> =
            if behind { together.clone() } else { together.iter().rev().copied().collect() };
        let follows = order.windows(2).all(|pair| pair[1].1 || pair[0].1) && order.first().is_some_and(|first| first.1);
        let place = order.iter().position(|(at, _)| *at == index)?;
        follows.then(|| order.get(place + 1).filter(|(_, kind)| !kind).map(|(at, _)| *at))
    };
    match (beside(true), beside(false)) {
        (Some(at), None) | (None, Some(at)) => own(at),
        _ => Pairing::Untold { coherences, responses },
    }
}

/// The same, where it is told.
pub(crate) fn own_coherence(records: &[Record], index: usize) -> Option<&Record> {
    match of_response(records, index) {
        Pairing::Own(coherence) => Some(coherence),
        Pairing::None | Pairing::Untold { .. } => None,
    }
}

/// Whether two records are of one pair of places and directions, as far as both tell; of a coherence either place may be named first.
fn same(record: &Record, response: &Record) -> bool {
    let fits = |a: Port, b: Port| {
        let agree = |a: i64, b: i64| a == 0 || b == 0 || a == b;
        agree(a.node, b.node) && agree(a.direction.abs(), b.direction.abs())
    };
    (fits(record.response, response.response) && fits(record.reference, response.reference))
        || (record.kind == RecordKind::Coherence
            && fits(record.response, response.reference)
            && fits(record.reference, response.response))
}
