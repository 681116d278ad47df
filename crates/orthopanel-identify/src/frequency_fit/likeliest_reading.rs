//! Lists of beams read otherwise than the test file has them: with modes missing, a line that fits no mode, or a piece that is none of the others'.

use std::fmt::Write as _;

use orthopanel_data::{ImpactTest, MeasurementData, NaturalFrequencies};
use orthopanel_model::{Readable, StructureKind};
use rayon::prelude::*;

use super::problem::{FrequencyProblem, Line, Renamed};
use super::reading_evidence::{Weighed, weighed};
use super::starting_values::starting_values;
use crate::free_constants::FreeConstant;
use crate::judge::{ODDS, TOLD, log_prior};
use crate::measured::MeasuredModes;
use crate::measured::is_record;
use crate::structures::bending_nodes;

/// Readings that are taken one after the other, at most: more that does not fit is no list of these pieces.
const MOST_TAKEN: usize = 3;
/// Modes that may be missing below a list.
const MOST_BELOW: usize = 2;
/// Pieces from which on one may be told to differ from the others.
const FEWEST_PIECES: usize = 3;
/// Lines that must be left beside the constants: with fewer anything is met.
const LINES_LEFT: usize = 2;
/// Lines up to which a list is read otherwise: each is a reading of its own, and longer lists show their constants whatever one line says.
const MOST_LINES: usize = 60;

/// Lists as they are likeliest read.
pub(crate) struct Reread {
    /// The test with the lists as they are read: the test file's own where no other reading is clearly likelier.
    pub test: ImpactTest,
    /// What was read otherwise.
    pub notes: Vec<String>,
    /// What is to be asked where another reading is not clearly behind or ahead.
    pub question: Option<String>,
    /// The test with the lists as the likeliest reading has them, clear or not.
    pub likeliest: ImpactTest,
    /// What the logarithm of the odds of the likeliest reading has beside the evidence of what it leaves: the prior of its slips, and the likelihood of what
    /// is left out.
    pub log_beside: f64,
}

/// How the lists are read.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    /// As the test file has them.
    AsTold,
    /// So many modes are missing before the first line, and one before another; of all lists alike, or of one.
    Missing { list: Option<usize>, below: usize, before: Option<usize> },
    /// A line is no mode that a beam has there.
    LineApart(Line),
    /// A piece has constants of its own.
    PieceApart(usize),
}

/// A reading with what is found under it.
struct Tried {
    kind: Kind,
    problem: FrequencyProblem,
    found: Weighed,
    log_odds: f64,
}

/// The likeliest reading of the lists of beams: where it is clearly likelier than the test file's own, lines and pieces that do not fit are left out, and
/// lists in which modes are missing are numbered so; where it is not clear, it is asked about.
///
/// Readings are compared by their evidence ([`weighed`]). Each kind of slip has the prior odds of an effect, one of the catalogue's in each of so many ways
/// alike. A line that fits no mode may lie anywhere between its neighbours. `None` where the test file's own reading is the likeliest, for plates, beside
/// records, and with declared effects, which lists of beams are not read with.
pub(crate) fn likeliest_reading(test: &ImpactTest) -> Option<Reread> {
    let is_of_beams = test.structure != Some(StructureKind::MindlinPlate) && !test.measurements.iter().any(is_record);
    if !is_of_beams || !test.effects.is_empty() {
        return None;
    }
    let mut read =
        Reread { test: test.clone(), notes: vec![], question: None, likeliest: test.clone(), log_beside: 0.0 };
    for _ in 0..MOST_TAKEN {
        let Some((told, tried)) = compared(&read.test) else { break };
        let Some(best) = tried.first() else { break };
        let ahead = best.log_odds - told.log_odds;
        if ahead < -TOLD.ln() {
            break;
        }
        let near = tried[1..].iter().filter(|other| best.log_odds - other.log_odds < TOLD.ln());
        let likely: Vec<&Tried> = std::iter::once(best).chain(near).collect();
        read.likeliest = best.of(&read.test);
        read.log_beside += best.log_odds - log_evidence(&read.likeliest)?;
        if ahead < ODDS.ln() || likely.len() > 1 {
            read.question = Some(asked(&read.test, &told, &likely));
            break;
        }
        read.notes.push(said(&read.test, &told, best));
        read.test.clone_from(&read.likeliest);
    }
    (!read.notes.is_empty() || read.question.is_some()).then_some(read)
}

/// The evidence of lists as a test has them.
fn log_evidence(test: &ImpactTest) -> Option<f64> {
    let problem = FrequencyProblem::of(test).ok()?;
    Some(weighed(&problem, &variances_of(test), &starting_values(&problem).ok()?)?.log_evidence)
}

/// The lists as told, and every other reading, the likeliest first.
fn compared(test: &ImpactTest) -> Option<(Tried, Vec<Tried>)> {
    let whole = FrequencyProblem::of(test).ok()?;
    if whole.count() > MOST_LINES || whole.count() < whole.constants.count() + LINES_LEFT {
        return None;
    }
    let lists = lists(test);
    let variances: Vec<Vec<f64>> = lists.iter().map(|list| variances(list)).collect();
    let told = tried(test, &whole, &variances, (Kind::AsTold, 1))?;
    let readings = readings(test, &whole);
    let of = |of: &(Kind, usize)| tried(test, &whole, &variances, *of);
    let mut others: Vec<Tried> = readings.par_iter().filter_map(of).collect();
    others.sort_by(|a, b| b.log_odds.total_cmp(&a.log_odds));
    Some((told, others))
}

fn lists(test: &ImpactTest) -> Vec<&NaturalFrequencies> {
    let of = test.measurements.iter().filter_map(|measurement| match &measurement.data {
        MeasurementData::NaturalFrequencies(list) => Some(list),
        _ => None,
    });
    of.collect()
}

/// Relative variance of each line, as far as its list tells.
fn variances(list: &NaturalFrequencies) -> Vec<f64> {
    let measured = MeasuredModes::of_frequencies(0, list);
    (0..list.values.len()).map(|line| measured.covariance[(line, line)]).collect()
}

/// The same of all lists, one after the other.
pub(super) fn variances_of(test: &ImpactTest) -> Vec<f64> {
    lists(test).into_iter().flat_map(variances).collect()
}

/// Every other reading, with the number of those of its kind.
fn readings(test: &ImpactTest, whole: &FrequencyProblem) -> Vec<(Kind, usize)> {
    let in_order: Vec<usize> = (0..whole.sets.len()).filter(|&list| lists(test)[list].shape.is_empty()).collect();
    let mut missing = Vec::new();
    let mut lines = Vec::new();
    for (list, set) in whole.sets.iter().enumerate() {
        let count = set.measured.len();
        if in_order.contains(&list) {
            let gaps = || std::iter::once(None).chain((1..count).map(Some));
            let all = (0..=MOST_BELOW).flat_map(|below| gaps().map(move |before| (below, before)));
            missing.extend(all.filter(|way| *way != (0, None)).map(|(below, before)| Kind::Missing {
                list: Some(list),
                below,
                before,
            }));
        }
        if count > LINES_LEFT {
            lines.extend((0..count).map(|line| Kind::LineApart(Line { set: list, line })));
        }
    }
    if in_order.len() > 1 {
        missing.extend((1..=MOST_BELOW).map(|below| Kind::Missing { list: None, below, before: None }));
    }
    let mut pieces: Vec<usize> = whole.sets.iter().map(|set| set.piece).collect();
    pieces.sort_unstable();
    pieces.dedup();
    if pieces.len() < FEWEST_PIECES {
        pieces.clear();
    }
    let pieces = pieces.into_iter().map(Kind::PieceApart).collect();
    [missing, lines, pieces]
        .into_iter()
        .flat_map(|kinds| {
            let ways = kinds.len();
            kinds.into_iter().map(move |kind| (kind, ways))
        })
        .collect()
}

fn tried(
    test: &ImpactTest,
    whole: &FrequencyProblem,
    variances: &[Vec<f64>],
    (kind, ways): (Kind, usize),
) -> Option<Tried> {
    let left_out = match kind {
        Kind::LineApart(line) => Some(line),
        _ => None,
    };
    let mut problem = whole.read_as(test, &kind.names(test, whole), left_out).ok()?;
    if let Kind::PieceApart(piece) = kind {
        let shared: Vec<FreeConstant> =
            problem.constants.free.iter().filter(|free| free.piece.is_none()).copied().collect();
        let own = shared.iter().map(|free| FreeConstant { piece: Some(piece), ..*free });
        let is_new = |own: &FreeConstant| !whole.constants.free.contains(own);
        let before = problem.constants.free.len();
        problem.constants.free.extend(own.filter(is_new));
        if problem.constants.free.len() == before {
            return None;
        }
    }
    let is_kept = |set: usize, line: usize| left_out != Some(Line { set, line });
    let kept = variances.iter().enumerate().flat_map(|(set, own)| {
        own.iter().enumerate().filter(move |(line, _)| is_kept(set, *line)).map(|(_, variance)| *variance)
    });
    let start = starting_values(&problem).ok()?;
    let found = weighed(&problem, &kept.collect::<Vec<f64>>(), &start)?;
    let prior = if kind == Kind::AsTold { 0.0 } else { log_prior(ways) };
    let anywhere = left_out.map_or(0.0, |line| -width(&whole.sets[line.set].measured, line.line).ln());
    let log_odds = found.log_evidence + prior + anywhere;
    Some(Tried { kind, problem, found, log_odds })
}

/// The logarithmic width of where a line may lie that keeps its place in the order.
fn width(measured: &[f64], line: usize) -> f64 {
    let (own, last) = (measured[line], measured.len() - 1);
    let below = if line > 0 { own / measured[line - 1] } else { measured[1] / own };
    let above = if line < last { measured[line + 1] / own } else { own / measured[last - 1] };
    (below * above).ln()
}

impl Kind {
    /// The names of the lines that have others than in the test file.
    fn names(self, test: &ImpactTest, whole: &FrequencyProblem) -> Vec<Renamed> {
        let Kind::Missing { list, below, before } = self else { return vec![] };
        let of_list = |set: usize| {
            let renamed = move |(line, nodes): (usize, &[usize; 2])| {
                let passed_over = below + usize::from(before.is_some_and(|before| line >= before));
                Renamed { set, line, nodes: [nodes[0] + passed_over, nodes[1]] }
            };
            whole.sets[set].modes.nodes().iter().enumerate().map(renamed).collect::<Vec<_>>()
        };
        let is_read = |set: &usize| list.is_none_or(|list| list == *set) && lists(test)[*set].shape.is_empty();
        (0..whole.sets.len()).filter(is_read).flat_map(of_list).collect()
    }
}

impl Tried {
    /// The test as it is read.
    fn of(&self, test: &ImpactTest) -> ImpactTest {
        let mut read = test.clone();
        let mut set = 0;
        for measurement in &mut read.measurements {
            let MeasurementData::NaturalFrequencies(list) = &mut measurement.data else { continue };
            if let Kind::LineApart(left_out) = self.kind
                && left_out.set == set
            {
                [&mut list.values, &mut list.resolution, &mut list.scatter].into_iter().for_each(|of| {
                    if left_out.line < of.len() {
                        of.remove(left_out.line);
                    }
                });
            }
            let nodes = self.problem.sets[set].modes.nodes();
            let is_in_order = *nodes == bending_nodes(test.boundary, nodes.len())[..];
            if !is_in_order || !list.shape.is_empty() {
                list.shape = nodes.iter().map(|nodes| nodes.map(|count| count as u32)).collect();
            }
            set += 1;
        }
        if let Kind::PieceApart(piece) = self.kind {
            read.measurements.retain(|measurement| measurement.piece != piece);
            read.pieces[piece].own_constants.clear();
        }
        read
    }

    /// Rms of the relative misses of the lines that the shared constants are to meet.
    fn rms(&self) -> f64 {
        let of_others = |piece: usize| !matches!(self.kind, Kind::PieceApart(apart) if apart == piece);
        let misses = self.misses().into_iter().filter(|(piece, _)| of_others(*piece));
        let squares: Vec<f64> = misses.flat_map(|(_, misses)| misses).map(|miss| miss * miss).collect();
        (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
    }

    /// Of each list its piece and by how much the model is above each line, in parts of it.
    fn misses(&self) -> Vec<(usize, Vec<f64>)> {
        let of_set = |set: &super::problem::FrequencySet| {
            let values = self.problem.constants.values(&self.found.parameters, set.piece);
            let model = set.modes.frequencies(&values).unwrap_or_default();
            (set.piece, model.iter().zip(&set.measured).map(|(model, measured)| model / measured - 1.0).collect())
        };
        self.problem.sets.iter().map(of_set).collect()
    }

    /// The constants that the pieces share.
    fn constants(&self) -> String {
        let constants = &self.problem.constants;
        let values = constants.values(&self.found.parameters, usize::MAX);
        let of = |(constant, value): (&orthopanel_model::Constant, f64)| {
            let coefficient = if constant.name == "g_zx" { " (k' = 2/3)" } else { "" };
            format!("{} {value:.3e} {}{coefficient}", constant.name, constant.unit)
        };
        constants.constants.iter().zip(values).map(of).collect::<Vec<_>>().join(", ")
    }

    /// What does not fit, and by how much.
    fn sentence(&self, test: &ImpactTest, told: &Tried) -> String {
        let named = |piece: usize| &test.pieces[piece].name;
        let whole = &told.problem;
        match self.kind {
            Kind::AsTold => "the lists are as the test file has them".to_owned(),
            Kind::Missing { list, below, before } => {
                let of = match list {
                    Some(list) => format!("piece {}", named(whole.sets[list].piece)),
                    None => "all lists".to_owned(),
                };
                let mut said = match below {
                    0 => format!("{of}: a mode seems to be missing"),
                    1 => format!("{of}: a mode seems to be missing below the first frequency"),
                    _ => format!("{of}: {below} modes seem to be missing below the first frequency"),
                };
                let set = &self.problem.sets[list.unwrap_or(0)];
                if let Some(before) = before {
                    let (from, to) = (set.measured[before - 1], set.measured[before]);
                    let also = if below > 0 { " and one" } else { "" };
                    _ = write!(said, "{also} between {from} and {to} Hz");
                }
                if let Some(passed_over) = self.passed_over(list.unwrap_or(0)) {
                    _ = write!(said, " (near {passed_over} Hz)");
                }
                said
            }
            Kind::LineApart(Line { set: number, line }) => {
                let set = &whole.sets[number];
                let (measured, nodes) = (set.measured[line], set.modes.nodes()[line]);
                let mode = nodes[0] - test.boundary.rigid_modes() + 1;
                let values = self.problem.constants.values(&self.found.parameters, set.piece);
                let there = set.modes.frequencies(&values).ok().and_then(|model| model.get(line).copied());
                let there = there.unwrap_or(f64::NAN);
                format!(
                    "piece {}: mode {mode}, {measured} Hz, does not fit the other frequencies: it lies {:+.2} % off the {there:.1} Hz where these put it",
                    named(set.piece),
                    100.0 * (measured / there - 1.0),
                )
            }
            Kind::PieceApart(piece) => {
                let sets = whole.sets.iter().filter(|set| set.piece == piece);
                let shared = self.problem.constants.values(&self.found.parameters, usize::MAX);
                let off = sets.flat_map(|set| {
                    let model = set.modes.frequencies(&shared).unwrap_or_default();
                    let off = set.measured.iter().zip(model).map(|(measured, model)| 100.0 * (measured / model - 1.0));
                    off.collect::<Vec<f64>>()
                });
                let off: Vec<String> = off.take(WRITTEN).map(|off| format!("{off:+.2}")).collect();
                format!(
                    "piece {} does not fit the other pieces: mode by mode its frequencies lie {} % off those that their constants give",
                    named(piece),
                    off.join(", ")
                )
            }
        }
    }

    /// Frequencies \[Hz\] of the modes that a list passes over.
    fn passed_over(&self, list: usize) -> Option<String> {
        let set = &self.problem.sets[list];
        let values = self.problem.constants.values(&self.found.parameters, set.piece);
        let spectrum = set.modes.spectrum(&values).ok()?;
        let missing = spectrum.iter().filter(|line| !set.modes.nodes().contains(&line.nodes));
        Some(missing.map(|line| format!("{:.1}", line.frequency)).collect::<Vec<_>>().join(" and "))
    }

    fn way_out(&self) -> &'static str {
        match self.kind {
            Kind::AsTold => "",
            Kind::Missing { .. } => {
                "look for a resonance there, and check the boundary, for a wrong one looks the same; or say which modes the lines are by their nodal \
                 lines, shape = [[nodes, 0], ...]"
            }
            Kind::LineApart(_) => {
                "look at this frequency again, or leave it out (shape = [[nodes, 0], ...] names the others)"
            }
            Kind::PieceApart(_) => {
                "look at its sizes, mass and units, or give it constants of its own (own_constants in its [[piece]])"
            }
        }
    }
}

/// Lines whose miss is written out.
const WRITTEN: usize = 12;

/// What is said of a reading that is taken.
fn said(test: &ImpactTest, told: &Tried, best: &Tried) -> String {
    let taken = match best.kind {
        Kind::AsTold | Kind::Missing { .. } => "it is read so",
        Kind::LineApart(_) | Kind::PieceApart(_) => "it is left out",
    };
    let less = Readable((best.log_odds - told.log_odds).exp());
    format!(
        "{}; {taken}: a beam meets the lists to {:.2} % rms then ({}), and as the test file has them to {:.2} % ({}), which is {less:.0} times less likely; {}",
        best.sentence(test, told),
        100.0 * best.rms(),
        best.constants(),
        100.0 * told.rms(),
        told.constants(),
        best.way_out(),
    )
}

/// What is asked of readings that are not clearly ahead or behind.
fn asked(test: &ImpactTest, told: &Tried, likely: &[&Tried]) -> String {
    let of = |other: &&Tried| {
        let odds = Readable((other.log_odds - told.log_odds).exp());
        format!(
            "{} (odds of {odds:.2} to 1 against the lists as they stand): read so, a beam meets them to {:.2} % rms with {}; {}",
            other.sentence(test, told),
            100.0 * other.rms(),
            other.constants(),
            other.way_out(),
        )
    };
    let others: Vec<String> = likely.iter().map(of).collect();
    format!(
        "the lists do not tell how they are to be read: as the test file has them a beam meets them to {:.2} % rms with {}. Otherwise: {}",
        100.0 * told.rms(),
        told.constants(),
        others.join(". Or "),
    )
}
