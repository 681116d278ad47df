//! `places`: one measurement for a whole roving test, with the places of the file's nodes in a file of their own.

use orthopanel_model::{Piece, Place};
use toml::Spanned;

use super::{super::syntax, ChannelName, Entry, RecordedResponse};
use crate::{
    DataError, limits,
    records::{Node, Port, nodes_of},
};

/// A declared place in place of that of a node.
type Declared = [Option<Place>; 2];

impl Entry<'_> {
    /// A measurement for each pair of nodes that the file holds records of.
    pub(super) fn at_places(
        &self,
        (entry, given): (&syntax::Measurement, &Spanned<String>),
        of_file: RecordedResponse,
        declared: Declared,
        piece: &Piece,
    ) -> Result<Vec<RecordedResponse>, DataError> {
        let path = self.source.beside(given.get_ref());
        let nodes = nodes_of(&path)?;
        let [x, y] = entry.origin.as_ref().map_or([0.0, 0.0], |origin| *origin.get_ref());
        let is_of_responses = entry.kind.as_ref().is_some_and(|kind| kind.get_ref() == "accelerance");
        let pairs = of_file.records()?.pairs(is_of_responses);
        let at = || self.at(given.span(), "places");
        let refused = |problem: String| Err(DataError::Contradiction { at: at(), problem });
        let named = [("hammer", &of_file.force_channel), ("sensor", &of_file.response_channel)];
        let is_chosen = |pair: &&[Port; 2]| {
            pair.iter().zip(named).all(|(port, (_, channel))| match channel {
                Some(ChannelName::Port { node, direction }) => {
                    port.node == *node && (*direction == 0 || port.direction == *direction)
                }
                _ => true,
            })
        };
        let mut measured = Vec::new();
        for pair in pairs.iter().filter(is_chosen) {
            let mut places = [Place { x: 0.0, y: 0.0 }; 2];
            for (channel, port) in pair.iter().enumerate() {
                places[channel] = match (placed(&nodes, port.node), declared[channel]) {
                    (_, Some(place)) => place,
                    (Some(node), None) => {
                        let place = Place { x: node.at[0] - x, y: node.at[1] - y };
                        if let Err(error) = piece.contains(place) {
                            return refused(format!(
                                "{}: node {}: {error}; places are counted from the piece's centre: where the file counts from a corner, \
                                 give origin = [x, y], the centre as the file has it",
                                path.display(),
                                port.node
                            ));
                        }
                        place
                    }
                    (None, None) => {
                        let key = ["force_at", "response_at"][channel];
                        let file = of_file.file.display();
                        let (name, node) = (named[channel].0, port.node);
                        return refused(if node == 0 {
                            format!("{file} tells no node of the {name}: give its place by {key} = [x, y]")
                        } else {
                            format!(
                                "{} has no node {node}, where {file} has the {name}: add the row {node},x,y, or give {key} = [x, y]",
                                path.display()
                            )
                        });
                    }
                };
            }
            let channel = |port: &Port, own: &Option<ChannelName>| match port.node {
                0 => own.clone(),
                node => Some(ChannelName::Port { node, direction: port.direction }),
            };
            let [force, response] = pair;
            measured.push(RecordedResponse {
                force_at: places[0],
                response_at: places[1],
                places_file: Some(path.clone()),
                force_channel: channel(force, &of_file.force_channel),
                response_channel: channel(response, &of_file.response_channel),
                ..of_file.clone()
            });
        }
        if measured.is_empty() {
            return refused(format!("{} holds no pair of force and response for it", of_file.file.display()));
        }
        self.source.at_most((measured.len(), "pairs of nodes"), limits::MEASUREMENTS, at, "split the file")?;
        Ok(measured)
    }
}

fn placed(nodes: &[Node], number: i64) -> Option<&Node> {
    nodes.iter().find(|node| node.number == number && number != 0)
}
