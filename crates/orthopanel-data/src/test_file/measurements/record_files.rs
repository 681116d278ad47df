//! The records of a measurement: of its file, or of the two that hold a channel each.

use super::RecordedResponse;
use crate::{
    DataError,
    records::{Quantity, Record, RecordFile, RecordKind, data_type, quantity},
};

impl RecordedResponse {
    /// The records of the measurement's files; where there are two, force and response in turn.
    ///
    /// # Errors
    /// As [`RecordFile::read`].
    pub fn records(&self) -> Result<RecordFile, DataError> {
        let columns = self.columns.as_ref();
        let file = RecordFile::read_columns(&self.file, columns)?;
        let Some(response_file) = &self.response_file else { return Ok(file) };
        let responses = RecordFile::read_columns(response_file, columns)?;
        let RecordFile { records: forces, mut notes, mut nodes } = file;
        notes.extend(responses.notes);
        nodes.extend(responses.nodes);
        let in_time = |record: &Record| record.kind == RecordKind::Time;
        let mut forces: Vec<Record> = forces.into_iter().filter(in_time).collect();
        let mut motions: Vec<Record> = responses.records.into_iter().filter(in_time).collect();
        // What is named a channel needs no type of its own; beside a force, what tells nothing is the motion.
        let untold = forces.iter_mut().filter(|record| quantity(&record.numerator) == Quantity::Untold);
        untold.for_each(|record| record.numerator.data_type = data_type::FORCE);
        forces.iter_mut().chain(&mut motions).zip(1..).for_each(|(record, number)| record.number = number);
        let mut records = Vec::with_capacity(forces.len() + motions.len());
        let several = motions.len().checked_div(forces.len()).unwrap_or(0).max(1);
        let mut motions = motions.into_iter();
        for force in forces {
            records.push(force);
            records.extend(motions.by_ref().take(several));
        }
        records.extend(motions);
        Ok(RecordFile { records, notes, nodes })
    }
}
