//! The records of a measurement: of its file, or of the two that hold a channel each.

use super::RecordedResponse;
use crate::{
    DataError, Motion, Unit,
    records::{Quantity, Record, RecordFile, RecordKind, data_type, quantity},
};

impl RecordedResponse {
    /// The records of the measurement's files; where there are two, force and response in turn. Of records in memory a copy.
    ///
    /// # Errors
    /// As [`RecordFile::read`].
    pub fn records(&self) -> Result<RecordFile, DataError> {
        if let Some(records) = &self.in_memory {
            let mut file = RecordFile::clone(records);
            let in_time = file.records.iter_mut().filter(|record| record.kind == RecordKind::Time);
            let untold = in_time.filter(|record| quantity(&record.numerator) == Quantity::Untold);
            untold.for_each(|record| record.numerator.data_type = self.data_type());
            return Ok(file);
        }
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

    /// The data type of the motion that the measurement declares, an acceleration where it declares none.
    pub(crate) fn data_type(&self) -> i64 {
        let by_unit = self.response_unit.as_ref().and_then(Unit::motion);
        match self.quantity.or(by_unit).unwrap_or(Motion::Acceleration) {
            Motion::Acceleration => data_type::ACCELERATION,
            Motion::Velocity => data_type::VELOCITY,
            Motion::Displacement => data_type::DISPLACEMENT,
        }
    }
}
