//! Files of places: nodes and where they are.

use std::path::Path;

use super::{Node, text, uff};
use crate::{DataError, Location, limits};

/// The nodes of a file: a table with the columns `node,x,y`, in m unless they tell another unit, or a universal file with dataset 15
/// or 2411.
///
/// # Errors
/// As [`super::RecordFile::read`]; [`DataError::NoRecords`] where no node is in it.
pub(crate) fn nodes_of(path: &Path) -> Result<Vec<Node>, DataError> {
    let read = limits::RECORD_FILE.read(path);
    let bytes = read.map_err(|source| DataError::Unreadable { at: Location::whole(path), source })?;
    let nodes = if uff::recognises(&bytes) {
        uff::parts(&bytes, path)?.nodes
    } else {
        let unknown =
            || DataError::NoRecords { at: Location::whole(path), what: "row under the column names node,x,y" };
        let [numbers, x, y] = text::columns(&bytes, path, ["node", "x", "y"]).ok_or_else(unknown)??;
        let node = |((number, x), y): ((f64, f64), f64)| Node { number: number as i64, at: [x, y, 0.0] };
        numbers.into_iter().zip(x).zip(y).map(node).collect()
    };
    if nodes.is_empty() {
        return Err(DataError::NoRecords {
            at: Location::whole(path),
            what: "node (dataset 15 or 2411, or rows node,x,y)",
        });
    }
    Ok(nodes)
}
