//! Datasets 15 and 2411: where the nodes are.

use super::{cursor::Cursor, fortran, line::field};
use crate::{
    limits,
    records::{Node, reading::may_be_read},
};

/// Reads from the line after the dataset's number up to its end, with its unit of length in `metre`s. What is no node is passed over:
/// places choose among records, and what they do not tell is asked about.
pub(super) fn read(cursor: &mut Cursor, dataset: u32, metre: f64, nodes: &mut Vec<Node>) {
    // Number and coordinates on one line, or on two, of columns of their own.
    let (first, width) = if dataset == 15 { (40, 13) } else { (0, 25) };
    let mut number = None;
    while let Some(line) = cursor.line() {
        if line.is_mark() && cursor.dataset_may_end_here() {
            return;
        }
        let text = line.text();
        if dataset == 15 || number.is_none() {
            number = field(&text, 0, 10).and_then(|text| text.parse().ok());
            if dataset != 15 {
                continue;
            }
        }
        let place = |axis: usize| {
            field(&text, first + axis * width, width).and_then(fortran::number).map(|value| metre * value)
        };
        if let (Some(number), Some(x), Some(y), Some(z)) = (number.take(), place(0), place(1), place(2))
            && [x, y, z].into_iter().all(may_be_read)
            && nodes.len() < limits::RECORDS
        {
            nodes.push(Node { number, at: [x, y, z] });
        }
    }
}
