//! Which modes the frequencies of a plate are that a list gives without `shape`: by frequency alone.

use orthopanel_data::{ImpactTest, Measurement, MeasurementData, NaturalFrequencies};
use orthopanel_model::{PLATE_CONSTANTS, Readable, StructureKind};

use crate::frequency_fit::identify_frequencies;
use crate::judge::ODDS;
use crate::measured::is_record;
use crate::measured::{MeasuredModes, Names, names_told};
use crate::plate_start::{PlateStart, held};
use crate::structures::{self, bending_nodes};
use crate::{Identification, IdentifyError, Search};

/// Fewest frequencies that part readings: with one for each constant any names are met.
const FEWEST: usize = 6;
/// Modes are looked for up to so many times the highest frequency.
const ABOVE: f64 = 1.1;

/// A test whose lists have shapes.
pub(crate) struct Read {
    pub test: ImpactTest,
    /// Of each measurement the shapes that are clear.
    pub clear: Vec<Names>,
    /// How each list was read.
    pub notes: Vec<String>,
    /// What is to be asked where another reading is not clearly behind.
    pub question: Option<String>,
    /// Whether other constants give a list other shapes, not clearly less likely.
    pub is_open: bool,
}

/// The nodal lines of a mode along x and along y.
type Shape = [u32; 2];

/// The shapes of a list's frequencies, those without one `None`, and twice the negative logarithm of the likelihood.
struct Reading {
    names: Vec<Option<Shape>>,
    cost: f64,
    /// Lines that may have another shape at the same constants, with what that costs.
    doubts: Vec<Doubt>,
}

/// The lists of a plate read by frequency alone, where they tell no shapes; `None` where all do, or one has too few frequencies.
///
/// Constants are looked for from sizes and mass alone. A reading is as likely as its frequencies are at the constants that meet them best, with
/// the error of the model estimated; each mode in the band that the list lacks, and each frequency that no mode has, counts against it.
///
/// # Errors
/// What the plate refuses.
pub(crate) fn shapes_by_frequency(test: &ImpactTest) -> Result<Option<Read>, IdentifyError> {
    let clear = names_told(test);
    let mut read = Read { test: test.clone(), clear, notes: vec![], question: None, is_open: false };
    for (measurement, clear) in read.test.measurements.iter_mut().zip(&mut read.clear) {
        let MeasurementData::NaturalFrequencies(list) = &mut measurement.data else { continue };
        if !list.shape.is_empty() {
            continue;
        }
        if list.values.len() < FEWEST {
            return Ok(None);
        }
        let readings = readings(test, measurement.piece, list)?;
        let Some(best) = readings.first() else { return Ok(None) };
        let piece = &test.pieces[measurement.piece].name;
        let left_out: Vec<String> = list
            .values
            .iter()
            .zip(&best.names)
            .filter(|(_, name)| name.is_none())
            .map(|(f, _)| format!("{f} Hz"))
            .collect();
        if 2 * left_out.len() > list.values.len() {
            return Ok(None);
        }
        read.notes
            .push(format!("the list of piece {piece} has no `shape`: read by frequency alone as {}", text(list, best)));
        if !left_out.is_empty() {
            read.notes
                .push(format!("piece {piece}: {} is no mode of this plate and was left out", left_out.join(", ")));
        }
        read.is_open |= readings.get(1).is_some_and(|other| other.cost - best.cost < 2.0 * ODDS.ln());
        let doubts = doubts(&readings);
        let is_clear = |line: &usize| doubts.iter().all(|(doubtful, ..)| doubtful != line);
        let of_line =
            |line: usize| best.names[line].filter(|_| is_clear(&line)).map(|shape| shape.map(|count| count as usize));
        *clear = (0..list.values.len()).map(of_line).collect();
        if let Some(question) = asked(list, piece, &best.names, &doubts) {
            read.notes.push(question.clone());
            read.question = read.question.or(Some(question));
        }
        name(list, best);
    }
    Ok(Some(read).filter(|read| !read.notes.is_empty()))
}

/// The names of a plate's lists, one entry a measurement, with what is to be said of them.
#[derive(Default)]
pub(crate) struct NamedLists {
    pub names: Vec<Names>,
    /// Constants near which the plate lies, those that the lists do not show at what is usual.
    pub near: Option<Vec<f64>>,
    pub notes: Vec<String>,
    pub question: Option<String>,
    /// Whether other constants give other names, not clearly less likely.
    pub is_open: bool,
}

/// What the lists of a test name their modes: as the test file does, else as [`identify_frequencies`] reads them; where that does not meet them, the
/// shapes that frequencies alone tell clearly. Beside records modes are told by these.
///
/// # Errors
/// What the plate refuses, and lists that no plate meets.
pub(crate) fn names_of_lists(test: &ImpactTest) -> Result<NamedLists, IdentifyError> {
    let names = names_told(test);
    let is_plate = test.structure == Some(StructureKind::MindlinPlate);
    if !is_plate || test.measurements.iter().any(is_record) {
        return Ok(NamedLists { names, ..NamedLists::default() });
    }
    let identified = |test: &ImpactTest| identify_frequencies(test, Search::LeastSquares);
    let near = |found: &Identification| {
        let shared = found.constants.iter().filter(|constant| constant.piece.is_none());
        Some(shared.map(|constant| constant.value).collect())
            .filter(|near: &Vec<f64>| near.len() == PLATE_CONSTANTS.len())
    };
    let of = |(measurement, told): (&Measurement, Names)| match &measurement.data {
        MeasurementData::NaturalFrequencies(list) if told.is_empty() => {
            bending_nodes(test.boundary, list.values.len()).into_iter().map(Some).collect()
        }
        _ => told,
    };
    match identified(test) {
        Ok(found) => {
            let names = test.measurements.iter().zip(names).map(of).collect();
            Ok(NamedLists { names, near: near(&found), ..NamedLists::default() })
        }
        Err(_) if names.iter().all(|names| !names.is_empty()) => Ok(NamedLists { names, ..NamedLists::default() }),
        Err(refused) => {
            let read = shapes_by_frequency(test)?.ok_or(refused)?;
            let near = identified(&read.test).ok().and_then(|found| near(&found));
            let Read { clear: names, notes, question, is_open, .. } = read;
            Ok(NamedLists { names, near, notes, question, is_open })
        }
    }
}

/// Every reading that some start leads to, the likeliest first.
fn readings(test: &ImpactTest, piece: usize, list: &NaturalFrequencies) -> Result<Vec<Reading>, IdentifyError> {
    let measured = MeasuredModes::of_frequencies(piece, list);
    let sizes = test.pieces[piece].piece;
    let start = PlateStart::new(&measured, (sizes, test.boundary), held(test));
    let structure = structures::of(StructureKind::MindlinPlate).recorded(&sizes, test.boundary);
    let highest = list.values.iter().copied().fold(0.0, f64::max);
    let mut readings: Vec<Reading> = Vec::new();
    for (_, values) in start.constants()? {
        let fit = start.fit(values)?;
        let read = start.reading(&fit)?;
        let nodes = structure.modes_below(&fit.values, ABOVE * highest, &[])?;
        let shape = |mode: usize| Some(nodes.get(mode)?.nodes.map(|count| count as u32));
        let names: Vec<Option<Shape>> = read.modes.iter().map(|mode| shape((*mode)?)).collect();
        let near = read.others.iter().filter(|(.., cost)| *cost < 2.0 * ODDS.ln());
        let doubts = near.filter_map(|(line, mode, cost)| Some((*line, shape(*mode)?, *cost))).collect();
        if read.cost.is_finite() && readings.iter().all(|other| other.names != names) {
            readings.push(Reading { names, cost: read.cost, doubts });
        }
    }
    readings.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    Ok(readings)
}

/// Gives a list the names of a reading; what has none leaves it.
fn name(list: &mut NaturalFrequencies, reading: &Reading) {
    let kept = |values: &[f64]| -> Vec<f64> {
        values.iter().zip(&reading.names).filter(|(_, name)| name.is_some()).map(|(value, _)| *value).collect()
    };
    list.resolution = kept(&list.resolution);
    list.scatter = kept(&list.scatter);
    list.values = kept(&list.values);
    list.shape = reading.names.iter().flatten().copied().collect();
}

fn text(list: &NaturalFrequencies, reading: &Reading) -> String {
    let pairs = list.values.iter().zip(&reading.names);
    pairs.filter_map(|(value, name)| Some(format!("{value} Hz {:?}", (*name)?))).collect::<Vec<_>>().join(", ")
}

/// A line that may have another shape, and what that costs.
type Doubt = (usize, Shape, f64);

/// The lines that other constants give another shape, not clearly less likely, and those that may have another at these.
fn doubts(readings: &[Reading]) -> Vec<Doubt> {
    let Some(best) = readings.first() else { return vec![] };
    let mut doubts = best.doubts.clone();
    for other in &readings[1..] {
        let cost = other.cost - best.cost;
        let differ = (0..best.names.len()).filter(|line| best.names[*line] != other.names[*line]);
        doubts.extend(
            differ.filter(|_| cost < 2.0 * ODDS.ln()).filter_map(|line| Some((line, other.names[line]?, cost))),
        );
    }
    doubts.sort_by(|a, b| (a.0, a.1).cmp(&(b.0, b.1)).then(a.2.total_cmp(&b.2)));
    doubts.dedup_by_key(|(line, shape, _)| (*line, *shape));
    doubts
}

/// Which lines to look at: each with the shape that it may have in place of that of the reading.
fn asked(list: &NaturalFrequencies, piece: &str, names: &[Option<Shape>], doubts: &[Doubt]) -> Option<String> {
    let said = |(line, shape, cost): &Doubt| {
        let own = names[*line].map_or_else(|| "no mode".to_owned(), |own| format!("{own:?}"));
        let times = Readable((0.5 * cost.abs()).exp());
        let compared = if *cost >= 0.0 {
            format!("{times:.1} times less likely than {own}")
        } else {
            // The reading is that of least cost by frequencies near these constants; what is exchanged moves the constants too.
            format!("{times:.1} times likelier than {own}, as which it is read, once the constants follow")
        };
        format!("{} Hz may be {shape:?}, {compared}", list.values[*line])
    };
    let said: Vec<String> = doubts.iter().map(said).collect();
    (!said.is_empty()).then(|| {
        format!(
            "piece {piece}: frequencies alone do not tell all shapes clearly: {}; look at the nodal lines of these modes, and give shape = \
             [[nodes_x, nodes_y], ...]",
            said.join("; ")
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_shape_is_told_by_how_much_less_or_more_likely_it_is() {
        let (resolution, scatter, shape) = (vec![], vec![], vec![]);
        let list = NaturalFrequencies { values: vec![403.5, 455.5], resolution, scatter, shape, response_at: None };
        let names = [Some([4, 0]), Some([1, 2])];
        let doubts = [(0, [1, 3], 2.0 * 3.0_f64.ln()), (1, [3, 1], -2.0 * 2.0_f64.ln())];
        let said = asked(&list, "2L", &names, &doubts).expect("doubts");
        assert!(said.contains("403.5 Hz may be [1, 3], 3.0 times less likely than [4, 0]; 455.5 Hz"), "{said}");
        assert!(said.contains("[3, 1], 2.0 times likelier than [1, 2], as which it is read"), "{said}");
        assert_eq!(asked(&list, "2L", &names, &[]), None);
    }
}
