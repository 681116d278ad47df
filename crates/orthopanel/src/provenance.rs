//! What an answer is of: the program, the test with its pieces, the date, and the files that were read.

use std::path::Path;

use orthopanel_data::ImpactTest;
use serde::Serialize;
use time::OffsetDateTime;

use crate::outputs::{Inputs, Listed};
use crate::{Error, Test};

/// Tells the date in place of the clock, in seconds since 1970: so the same inputs give the same bytes
/// (<https://reproducible-builds.org/specs/source-date-epoch/>).
const SOURCE_DATE_EPOCH: &str = "SOURCE_DATE_EPOCH";

/// Key `provenance` of `identified.json` and `trace.json`.
#[derive(Serialize)]
pub struct Provenance {
    program: &'static str,
    /// The test file, as the command reads it.
    test: String,
    pieces: Vec<String>,
    /// UTC, ISO 8601.
    date: String,
    inputs: Vec<Listed>,
}

/// An answer with what it is of.
#[derive(Serialize)]
pub(crate) struct WithProvenance<'a, T> {
    #[serde(flatten)]
    pub(crate) answer: &'a T,
    pub(crate) provenance: &'a Provenance,
}

impl Provenance {
    /// Of a test.
    ///
    /// # Errors
    /// As [`Inputs::unchanged`].
    pub fn of(test: &Test, inputs: &Inputs) -> Result<Self, Error> {
        let (path, test) = (test.path(), test.content());
        let listed = |(path, sha256): (&Path, String)| Listed { file: path.to_string_lossy().into_owned(), sha256 };
        Ok(Self {
            program: concat!("orthopanel ", env!("CARGO_PKG_VERSION")),
            test: ImpactTest::file_at(path).to_string_lossy().into_owned(),
            pieces: test.pieces.iter().map(|piece| piece.name.clone()).collect(),
            date: date(std::env::var(SOURCE_DATE_EPOCH).ok().as_deref()),
            inputs: inputs.unchanged()?.into_iter().map(listed).collect(),
        })
    }
}

/// At this time, or as many seconds after 1970 as the text says.
fn date(epoch: Option<&str>) -> String {
    let told = epoch.and_then(|text| OffsetDateTime::from_unix_timestamp(text.trim().parse().ok()?).ok());
    let at = told.unwrap_or_else(OffsetDateTime::now_utc);
    let (year, month, day) = at.to_calendar_date();
    let (hour, minute, second) = at.to_hms();
    format!("{year:04}-{:02}-{day:02}T{hour:02}:{minute:02}:{second:02}Z", u8::from(month))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_dates_are_those_of_gnu_date() {
        // date --utc --date=@... +%FT%TZ
        for (seconds, due) in [
            ("0", "1970-01-01T00:00:00Z"),
            ("951782400", "2000-02-29T00:00:00Z"),
            (" 1764527167\n", "2025-11-30T18:26:07Z"),
        ] {
            assert_eq!(date(Some(seconds)), due);
        }
        let now = date(Some("yesterday"));
        assert!(now.len() == 20 && now > date(Some("1764527167")), "{now}");
    }
}
