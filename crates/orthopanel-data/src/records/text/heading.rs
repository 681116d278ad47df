//! Names and units of columns, as they stand above the numbers.

use super::separator::{Separator, number};
use crate::Unit;

/// Lines above the numbers at most.
const LINES_ABOVE: usize = 10_000;

/// Where the numbers of a text begin, and what stands above them.
#[derive(Debug, PartialEq)]
pub(super) struct Heading {
    pub(super) separator: Separator,
    /// Columns of the first row of numbers.
    pub(super) columns: usize,
    /// A name a column; empty where no line names them.
    pub(super) names: Vec<String>,
    /// A unit a column, as its row tells them; empty where there is none.
    pub(super) units: Vec<String>,
    /// Line of the names, from 1; that of the first row where there is none.
    pub(super) names_at: usize,
    /// Byte and line, from 1, of the first row.
    pub(super) rows_at: (usize, usize),
}

/// A line above the numbers.
#[derive(Clone, Copy)]
struct Line<'a> {
    number: usize,
    start: usize,
    text: &'a str,
}

/// True for a line that says nothing of columns: a blank one, or a comment.
pub(super) fn is_idle(line: &str) -> bool {
    line.trim_start().is_empty() || comment(line).is_some()
}

/// What a comment says.
fn comment(line: &str) -> Option<&str> {
    let line = line.trim_start();
    ["#", "%", "//"].iter().find_map(|mark| line.strip_prefix(mark)).map(str::trim)
}

impl Heading {
    /// Where the numbers of a text begin; `None` where none do.
    ///
    /// `is_abscissa` tells whether a name is that of a time or a frequency.
    pub(super) fn of(text: &str, is_abscissa: impl Fn(&str) -> bool) -> Option<Self> {
        let lines = numbered(text);
        let told: Vec<&Line> = lines.iter().filter(|line| !is_idle(line.text)).collect();
        // A line of names with numbers below it, though the first row may be spoilt.
        let named = told.iter().zip(told.iter().skip(1)).find_map(|(line, next)| {
            Separator::ALL.into_iter().find_map(|separator| {
                let (fields, below) = (separator.fields(line.text), separator.fields(next.text));
                let is_heading = fields.len() > 1 && fields.first().is_some_and(|name| is_abscissa(name));
                let begins = below.first().is_some_and(|field| number(field).is_some());
                let fits = separator.numbers(next.text).map_or(begins && separator != Separator::Blanks, |columns| {
                    separator != Separator::Blanks || columns == fields.len()
                });
                // Remarks at the ends of rows have a name, and may be empty.
                let columns = separator.numbers(next.text).filter(|_| fields.len() > below.len());
                (is_heading && begins && fits).then_some((separator, columns.unwrap_or(fields.len()), **next))
            })
        });
        // Two rows alike, for one alone may be a date.
        let begins = |least: usize| {
            (0..told.len()).find_map(|at| {
                Separator::ALL.into_iter().find_map(|separator| {
                    let columns = separator.numbers(told[at].text).filter(|columns| *columns >= least)?;
                    let next = told.get(at + 1).map_or(Some(columns), |next| separator.numbers(next.text));
                    (next == Some(columns)).then_some((separator, columns, *told[at]))
                })
            })
        };
        // Names alone, with nothing below them.
        let last = lines.last().copied()?;
        let nothing = Line { number: last.number + 1, start: text.len(), text: "" };
        let empty = || {
            Separator::ALL.into_iter().find_map(|separator| {
                let fields = separator.fields(told.last()?.text);
                let is_heading = fields.len() > 1 && fields.first().is_some_and(|name| is_abscissa(name));
                is_heading.then_some((separator, fields.len(), nothing))
            })
        };
        let (separator, columns, first) = named.or_else(|| begins(2)).or_else(|| begins(1)).or_else(empty)?;
        let above: Vec<Line> = lines.iter().take_while(|line| line.number < first.number).copied().collect();
        let (names, units, names_at) = names_above(&above, separator, columns);
        Some(Self {
            separator,
            columns,
            names,
            units,
            names_at: names_at.unwrap_or(first.number),
            rows_at: (first.start, first.number),
        })
    }
}

/// The first lines of a text.
fn numbered(text: &str) -> Vec<Line<'_>> {
    let mut start = 0;
    let lines = text.split_inclusive('\n').take(LINES_ABOVE).zip(1..).map(|(line, number)| {
        let at = start;
        start += line.len();
        Line { number, start: at, text: line.trim_end_matches(['\n', '\r']) }
    });
    lines.collect()
}

/// Names and units of the columns and the line of the names, from the lines above them.
fn names_above(above: &[Line], separator: Separator, columns: usize) -> (Vec<String>, Vec<String>, Option<usize>) {
    let named = |line: &Line| named_columns(line.text, separator, columns);
    let of_kind = |comments: bool| {
        let lines = above.iter().rev().filter(|line| !line.text.trim().is_empty());
        let texts = lines.filter_map(|line| match (comments, comment(line.text)) {
            (false, None) => Some(*line),
            (true, Some(text)) => Some(Line { text, ..*line }),
            _ => None,
        });
        texts.take(3).collect::<Vec<Line>>()
    };
    // Names in a comment, as numpy writes them, only where none stand outside.
    for lines in [of_kind(false), of_kind(true)] {
        let Some(last) = lines.first() else { continue };
        let Some(fields) = named(last) else { continue };
        let are_units = fields.iter().all(|field| field.is_empty() || unit_of(field).is_some());
        if let (true, Some((line, names))) =
            (are_units, lines.get(1).and_then(|line| named(line).map(|names| (line, names))))
        {
            return (names, fields, Some(line.number));
        }
        return (fields, Vec::new(), Some(last.number));
    }
    (Vec::new(), Vec::new(), None)
}

/// The names in a line, one a column at least.
fn named_columns(line: &str, separator: Separator, columns: usize) -> Option<Vec<String>> {
    let fits = |fields: Vec<&str>| {
        // A column of remarks may be empty in every row.
        let fields: Vec<String> = fields.into_iter().map(str::to_owned).collect();
        (fields.len() >= columns && fields.iter().any(|name| !name.is_empty())).then_some(fields)
    };
    let wide = || fits(line.split("  ").map(str::trim).filter(|field| !field.is_empty()).collect());
    match separator {
        // Names hold blanks, too: by tabs, by several blanks, then by each.
        Separator::Blanks => fits(Separator::Tab.fields(line))
            .or_else(|| fits(Separator::Comma.fields(line)))
            .or_else(|| fits(Separator::Semicolon.fields(line)))
            .or_else(wide)
            .or_else(|| fits(Separator::Blanks.fields(line))),
        _ => fits(separator.fields(line)).or_else(wide),
    }
}

/// The unit that a field of a row of units tells, out of its brackets.
pub(super) fn unit_of(field: &str) -> Option<&str> {
    let field = field.trim();
    let bare = field
        .strip_prefix('[')
        .and_then(|rest| rest.strip_suffix(']'))
        .or_else(|| {
            field.strip_prefix('(').and_then(|rest| rest.strip_suffix(')')).filter(|inner| !inner.contains('('))
        })
        .unwrap_or(field)
        .trim();
    let is_angle = ["deg", "degree", "degrees", "°", "rad", "radians"].iter().any(|of| bare.eq_ignore_ascii_case(of));
    let is_level = bare.get(..2).is_some_and(|start| start.eq_ignore_ascii_case("db"));
    (is_angle || is_level || bare == "-" || Unit::parse(bare).is_some()).then_some(bare)
}
