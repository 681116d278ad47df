//! The report: one HTML page that needs nothing beside it, no network and no script.

mod constants;
mod figure;
mod measured_modes;
mod pieces;
mod table;
mod trace;

use std::path::Path;

use askama::Template;
use orthopanel_model::printable;

use crate::error::Error;
use crate::evidence::{Evidence, HitsWithEffects};
use crate::identified::Identified;
use crate::observer::Observer;
use crate::traced::Traced;
use crate::{Test, notes};
pub(crate) use figure::Figure;
use measured_modes::MeasuredModesSection;
use pieces::PieceSection;
pub(crate) use table::Table;
use trace::TraceSection;

/// The page; askama escapes every text that is put into it, but for the pictures.
#[derive(Template)]
#[template(path = "report.html")]
struct Page {
    title: String,
    made_by: String,
    lead: Vec<String>,
    /// None where nothing was identified.
    constants: Option<Table>,
    about_constants: Vec<String>,
    trace: Option<TraceSection>,
    /// Why there is no trace.
    not_traced: Option<String>,
    pieces: Vec<PieceSection>,
    notes: Vec<String>,
}

const SUPERSEDED: &str = "These are the constants of the base model, before effects. Those of the model that is written stand \
                          under \"What the model lacks\".";

const MADE_BY: &str = concat!("Written by orthopanel ", env!("CARGO_PKG_VERSION"));
const TRACED_ALONE: &str =
    "The records were traced all the same: from the best that a beam can do with them, for what it lacks.";

impl Identified {
    /// One HTML page of the test, which needs no network and nothing beside it, with what was traced or why nothing was.
    ///
    /// # Errors
    /// [`Error::Data`] where records cannot be read any more, [`Error::Picture`].
    pub fn page(&self, traced: Result<&Traced, &str>, observer: &dyn Observer) -> Result<String, Error> {
        page(self, traced, &Evidence::of(self, traced.ok(), observer)?)
    }
}

/// The page of a test.
pub fn page(identified: &Identified, traced: Result<&Traced, &str>, evidence: &Evidence) -> Result<String, Error> {
    let found = &identified.found;
    let pieces = found.pieces.iter().zip(&evidence.pieces);
    let piece_name = found.pieces.first().map_or("", |piece| piece.name.as_str());
    let has_effects = traced.is_ok_and(|traced| !traced.tracing.effects.is_empty());
    let superseded = traced.is_ok_and(Traced::explains);
    let mut about_constants = constants::remarks(found);
    if superseded {
        about_constants.insert(0, SUPERSEDED.into());
    }
    let hits: Vec<&HitsWithEffects> = evidence.pieces.iter().flat_map(|piece| &piece.hits_with_effects).collect();
    let modes = found.pieces.first().map(pieces::measured_modes).unwrap_or_default();
    let page = Page {
        title: title(identified.test.path()),
        made_by: MADE_BY.to_owned(),
        lead: constants::lead(found),
        constants: Some(constants::table(found)),
        about_constants,
        trace: traced.ok().map(|traced| TraceSection::of(piece_name, traced, &hits, &modes)).transpose()?,
        not_traced: traced.err().map(str::to_owned),
        pieces: pieces
            .map(|(fit, shown)| {
                let measured = identified.measured_modes(&fit.name).map(MeasuredModesSection::of);
                Ok(PieceSection {
                    measured: measured.collect::<Result<_, _>>()?,
                    ..PieceSection::of(fit, shown, has_effects)?
                })
            })
            .collect::<Result<_, Error>>()?,
        notes: notes::counted(&found.notes).collect(),
    };
    page.rendered()
}

/// The page of a test whose records its base model contradicts, as `refused` says: what its trace tells.
pub fn page_of_trace(test: &Test, refused: &str, traced: &Traced, evidence: &Evidence) -> Result<String, Error> {
    let (path, test) = (test.path(), test.content());
    let pieces = test.pieces.iter().zip(&evidence.pieces);
    let piece_name = test.pieces.first().map_or("", |named| named.name.as_str());
    let hits: Vec<&HitsWithEffects> = evidence.pieces.iter().flat_map(|piece| &piece.hits_with_effects).collect();
    let page = Page {
        title: title(path),
        made_by: MADE_BY.to_owned(),
        lead: vec![format!("No base model was identified: {refused}."), TRACED_ALONE.to_owned()],
        constants: None,
        about_constants: vec![],
        trace: Some(TraceSection::of(piece_name, traced, &hits, &[])?),
        not_traced: None,
        pieces: pieces.map(|(named, shown)| PieceSection::of_trace(named, shown)).collect::<Result<_, _>>()?,
        notes: vec![],
    };
    page.rendered()
}

fn title(path: &Path) -> String {
    format!("Hammer test {}", path.display())
}

impl Page {
    fn rendered(&self) -> Result<String, Error> {
        let page = self.render().map(|page| printable(&page).into_owned());
        page.map_err(|error| Error::Picture { name: "report", problem: error.to_string() })
    }
}
