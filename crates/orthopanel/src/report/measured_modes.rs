//! The modes that the records show without a model, beside those of the model.

use super::figure::Figure;
use super::table::Table;
use crate::error::Error;
use crate::identified::MeasuredTable;
use crate::pictures;

pub struct MeasuredModesSection {
    pub table: Table,
    /// What is to be said of its columns.
    pub remarks: Vec<String>,
    /// None of a single record.
    pub assurance: Option<Figure>,
}

const CAPTION: &str = "How alike the shapes are, at the measured places, of each measured mode and each mode of the model; the frame is the mode that \
                       it is matched with. Dark fields beside the frames are shapes that these places do not tell apart.";

impl MeasuredModesSection {
    pub fn of(measured: &MeasuredTable) -> Result<Self, Error> {
        let (headings, rows) = measured.rows();
        let picture = |assurance| {
            pictures::modal_assurance(&measured.piece, &measured.frequencies(), &measured.partners(), assurance)
        };
        let picture = measured.assurance.as_ref().map(picture).transpose()?;
        Ok(Self {
            table: Table::new(&headings, rows),
            remarks: measured.remarks().into_iter().map(str::to_owned).collect(),
            assurance: picture.map(|svg| Figure::new(&svg, CAPTION)),
        })
    }
}
