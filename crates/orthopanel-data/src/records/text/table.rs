//! Rows of numbers under their names.

use std::{path::Path, sync::Arc};

use super::{
    heading::is_idle,
    meaning::{Column, Meaning},
    separator::{self, Separator},
};
use crate::{
    ColumnName, ColumnRole, DataError, DeclaredColumns, Location, Position,
    error::{short, some_of},
    records::reading::may_be_read,
};

/// One table of a text.
pub(super) struct Table<'a> {
    /// From the first row on.
    pub(super) text: &'a str,
    /// Line of the first row, from 1.
    pub(super) first_line: usize,
    pub(super) separator: Separator,
    pub(super) columns: Vec<Column>,
    /// Whether a line names the columns.
    pub(super) is_named: bool,
    /// Line of the names.
    pub(super) names_at: usize,
    /// Whether it ends before the text does, and rows may have remarks at their ends.
    pub(super) is_part: bool,
    /// Start and step of times that no column holds.
    pub(super) even: Option<(f64, f64)>,
}

/// The numbers of a table's columns.
pub(super) struct Rows {
    /// Of the columns asked for, in that order.
    pub(super) values: Vec<Vec<f64>>,
    /// Line of each row.
    pub(super) lines: Arc<[usize]>,
}

/// How to tell columns apart where names do not.
const WAY_OUT: &str = "say which is which by columns = {time = 1, force = 2, response = 3}, or {frequency = 1, real = 2, imag = 3}, \
                       numbers or names, in its [[measurement]]";

impl Table<'_> {
    pub(super) fn at(&self, path: &Path, line: usize, key: &str) -> Box<Location> {
        Box::new(Location { file: path.to_path_buf(), position: Position::Line(line), key: key.into() })
    }

    pub(super) fn refused(&self, path: &Path, problem: String) -> DataError {
        DataError::Header { at: self.at(path, self.names_at, ""), problem }
    }

    /// The names of the columns, for messages.
    pub(super) fn names(&self) -> String {
        some_of(&self.columns.iter().map(|column| format!("{:?}", short(&column.name))).collect::<Vec<_>>(), ", ")
    }

    /// The columns as a test file declares them, and no others; without a declaration as they are.
    pub(super) fn declared(mut self, path: &Path, declared: Option<&DeclaredColumns>) -> Result<Self, DataError> {
        let Some(DeclaredColumns(declared)) = declared else { return self.told(path) };
        let mut meanings = vec![Meaning::Untold; self.columns.len()];
        for (role, name) in declared {
            let place = match name {
                ColumnName::Number(number) => number.checked_sub(1).filter(|place| *place < self.columns.len()),
                ColumnName::Name(name) => self.columns.iter().position(|column| column.name == *name),
            };
            let Some(place) = place else {
                let problem = format!("columns.{} = {name} is none of its columns: {}", role.name(), self.names());
                return Err(self.refused(path, problem));
            };
            let own = self.columns[place].meaning;
            meanings[place] = match (role, own) {
                (ColumnRole::Time, _) => Meaning::Time,
                (ColumnRole::Frequency, _) => Meaning::Frequency,
                (ColumnRole::Force, _) => Meaning::Force,
                (ColumnRole::Response, Meaning::Motion(motion)) => Meaning::Motion(motion),
                (ColumnRole::Response, _) => Meaning::Response,
                (ColumnRole::Real, _) => Meaning::Real,
                (ColumnRole::Imag, _) => Meaning::Imaginary,
                (ColumnRole::Magnitude, _) => Meaning::Magnitude,
                (ColumnRole::Phase, _) => Meaning::Phase,
                (ColumnRole::Coherence, _) => Meaning::Coherence,
            };
        }
        let tells_abscissa = meanings.iter().any(|meaning| meaning.is_abscissa());
        for (column, meaning) in self.columns.iter_mut().zip(meanings) {
            // What is not declared is not read, but for the times.
            let stays = !tells_abscissa && column.meaning.is_abscissa() && meaning == Meaning::Untold;
            column.meaning = match meaning {
                _ if stays => column.meaning,
                Meaning::Untold => Meaning::NotRead,
                declared => declared,
            };
        }
        if self.abscissa().is_none() && self.even.is_none() {
            if self.columns.iter().any(|column| column.meaning.is_part_of_response()) {
                return Err(self.refused(path, "columns tells no frequency: add it, such as frequency = 1".into()));
            }
            // Counted: the test file's sampling rate counts instead.
            self.even = Some((0.0, 1.0));
        }
        Ok(self)
    }

    /// Refuses a table that does not tell what its columns are.
    fn told(self, path: &Path) -> Result<Self, DataError> {
        if !self.is_named {
            let count = self.columns.len();
            return Err(
                self.refused(path, format!("{count} columns of numbers, and no line that names them: {WAY_OUT}"))
            );
        }
        if self.abscissa().is_none() && self.even.is_none() {
            let problem = format!("no column of times or frequencies among {}: {WAY_OUT}", self.names());
            return Err(self.refused(path, problem));
        }
        Ok(self)
    }

    /// The column of times or frequencies.
    pub(super) fn abscissa(&self) -> Option<usize> {
        self.columns.iter().position(|column| column.meaning.is_abscissa())
    }

    /// The only column of a meaning.
    ///
    /// # Errors
    /// [`DataError::Header`] where there are several.
    pub(super) fn only(&self, meaning: Meaning, path: &Path) -> Result<Option<usize>, DataError> {
        let mut found = (0..self.columns.len()).filter(|&column| self.columns[column].meaning == meaning);
        match (found.next(), found.next()) {
            (first, None) => Ok(first),
            (first, Some(second)) => {
                let name = |column: Option<usize>| column.map_or("", |column| self.columns[column].name.as_str());
                let (first, second) = (name(first), name(Some(second)));
                let twice = if first == second {
                    format!("column {first} stands twice")
                } else {
                    format!("columns {first:?} and {second:?} hold the same")
                };
                Err(self.refused(path, format!("{twice}: {WAY_OUT}")))
            }
        }
    }

    /// Reads the columns asked for, by their places; the first must rise where it `rises`.
    ///
    /// # Errors
    /// [`DataError::BadNumber`], [`DataError::NotFinite`] and [`DataError::Header`] with the line; [`DataError::NoRecords`] where there
    /// is no row.
    pub(super) fn rows(&self, path: &Path, wanted: &[usize], rises: bool) -> Result<Rows, DataError> {
        let mut values: Vec<Vec<f64>> = vec![Vec::new(); wanted.len()];
        let (mut lines, mut fields) = (Vec::new(), Vec::new());
        for (line, number) in self.text.lines().zip(self.first_line..) {
            if is_idle(line) || line.trim() == "\u{1a}" {
                if self.is_part && line.trim().is_empty() {
                    break;
                }
                continue;
            }
            self.separator.split(line, &mut fields);
            if self.is_part && !fields.iter().take(2).any(|field| separator::number(field).is_some()) {
                break;
            }
            let told = fields.iter().rposition(|field| !field.is_empty()).map_or(0, |last| last + 1);
            if told != self.columns.len() && !(self.is_part && told > 0) {
                let problem = format!("{told} values where the first line names {} columns", self.columns.len());
                return Err(DataError::Header { at: self.at(path, number, ""), problem });
            }
            lines.push(number);
            for (column, (&place, values)) in wanted.iter().zip(&mut values).enumerate() {
                let name = || self.columns.get(place).map_or("", |column| column.name.as_str());
                let field = fields.get(place).copied().unwrap_or_default();
                let value = separator::number(field).ok_or_else(|| {
                    let text = field.chars().take(40).collect();
                    DataError::BadNumber { at: self.at(path, number, name()), text }
                })?;
                let value = match self.columns.get(place).map(|column| column.meaning) {
                    // Analysers divide 0 by 0 where no force was.
                    Some(Meaning::Coherence) if value.is_nan() => 0.0,
                    _ => value,
                };
                if !may_be_read(value) {
                    return Err(DataError::NotFinite { at: self.at(path, number, name()), point: lines.len() });
                }
                if rises && column == 0 && values.last().is_some_and(|&before| before >= value) {
                    let problem = format!(
                        "{} does not rise above the row before: sort the rows, once each",
                        orthopanel_model::Readable(value)
                    );
                    return Err(DataError::Header { at: self.at(path, number, name()), problem });
                }
                values.push(value);
            }
        }
        if lines.is_empty() {
            return Err(DataError::NoRecords {
                at: self.at(path, self.names_at, ""),
                what: "row under the column names",
            });
        }
        Ok(Rows { values, lines: lines.into() })
    }
}
