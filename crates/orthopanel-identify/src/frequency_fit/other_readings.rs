//! A list read otherwise: one line stands against all others, or names are shifted by one from a line on.
//!
//! A mode that was passed over shifts all names behind it, and a name that no mode has there bends all constants, so that the line
//! that is missed most need not be the wrong one. The line whose absence mends the list is.

use orthopanel_data::ImpactTest;
use rayon::prelude::*;

use super::all_at_once::meets_at_once;
use super::changed_pairs::USUAL_MISS;
use super::minimum::Minimum;
use super::noise::Noise;
use super::other_starts::cost;
use super::problem::{FrequencyProblem, Line, Renamed};
use super::seen_constants::minimise_what_is_seen;
use super::starting_values::starting_values;
use crate::IdentifyError;
use crate::free_constants::FreeConstants;
use crate::starting_constants::{SOFTNESS, guess};

/// Readings that are tried, the likeliest first.
const MOST_READINGS: usize = 24;
/// and of those that leave most open, so many with all constants at once.
const AT_ONCE: usize = 2;
/// A list is met where it is missed by no more than so many times what its lines scatter.
const MET: f64 = 1.5;
/// Lines that must be left beside the constants found: with fewer anything is met.
const LINES_LEFT: usize = 3;
/// $E_y/E_x$ of the panels by which readings are ranked.
const RATIOS: [f64; 3] = [1.0, 0.5, 2.0];
/// A mode of the model is a line's where it lies this near.
const NEAR: f64 = 0.01;

/// How a list is read, with one line left out.
#[derive(Debug, Clone)]
struct Reading {
    left_out: Line,
    names: Vec<Renamed>,
    kind: Kind,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    /// The line left out stands against all others.
    Apart,
    /// From the line left out on, each name belongs to the next line: it is a mode that has no name in the list.
    NamePassedOver,
    /// From this line on, each line has the name of the next: the mode that it is named by was not measured. The last line has
    /// no name.
    LinePassedOver(usize),
}

/// A sentence on the reading that leaves less than `most` of the sum of squares of all lines.
pub(super) fn read_otherwise(
    test: &ImpactTest,
    whole: &FrequencyProblem,
    most: f64,
) -> Result<Vec<String>, IdentifyError> {
    let readings = likeliest(whole);
    let mut tried: Vec<Tried> = Vec::new();
    for few in readings.chunks(2) {
        tried.extend(few.par_iter().filter_map(|reading| Tried::of(test, whole, reading)).collect::<Vec<_>>());
        if tried.iter().any(Tried::is_met) {
            break;
        }
    }
    tried.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
    if !tried.first().is_some_and(Tried::is_met) {
        tried.iter_mut().take(AT_ONCE).for_each(Tried::try_at_once);
        tried.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
    }
    let best = tried.into_iter().find(|tried| tried.cost() < most);
    best.map_or(Ok(Vec::new()), |best| Ok(vec![best.sentence(test, whole)?]))
}

/// All readings with one line left out, those that come nearest to a usual panel of the right size first.
fn likeliest(whole: &FrequencyProblem) -> Vec<Reading> {
    let panels: Vec<Vec<Vec<f64>>> = SOFTNESS
        .iter()
        .flat_map(|softness| RATIOS.map(|ratio| (*softness, ratio)))
        .filter_map(|(softness, ratio)| frequencies_of_usual(whole, softness, ratio))
        .collect();
    let mut readings: Vec<(f64, Reading)> = all_readings(whole)
        .into_iter()
        .map(|reading| {
            let scores = panels.iter().map(|frequencies| score(whole, &reading, frequencies));
            (scores.fold(f64::INFINITY, f64::min), reading)
        })
        .collect();
    readings.sort_by(|a, b| a.0.total_cmp(&b.0));
    readings.into_iter().map(|(_, reading)| reading).take(MOST_READINGS).collect()
}

fn all_readings(whole: &FrequencyProblem) -> Vec<Reading> {
    let mut readings = Vec::new();
    for (set, own) in whole.sets.iter().enumerate() {
        let (nodes, count) = (own.modes.nodes(), own.measured.len());
        if count <= LINES_LEFT {
            continue;
        }
        for line in 0..count {
            readings.push(Reading { left_out: Line { set, line }, names: Vec::new(), kind: Kind::Apart });
        }
        for line in 0..count - 1 {
            let later = line + 1..count;
            let names = later.clone().map(|line| Renamed { set, line, nodes: nodes[line - 1] }).collect();
            readings.push(Reading { left_out: Line { set, line }, names, kind: Kind::NamePassedOver });
            let names = later.map(|name| Renamed { set, line: name - 1, nodes: nodes[name] }).collect();
            let left_out = Line { set, line: count - 1 };
            readings.push(Reading { left_out, names, kind: Kind::LinePassedOver(line) });
        }
    }
    readings
}

/// Frequencies of the lines' names on a usual panel, list by list.
fn frequencies_of_usual(whole: &FrequencyProblem, softness: f64, ratio: f64) -> Option<Vec<Vec<f64>>> {
    let mut usual = guess(&whole.constants, softness);
    for (constant, value) in whole.constants.constants.iter().zip(&mut usual) {
        if constant.name == "e_y" && whole.constants.held_at(constant.name).is_none() {
            *value *= ratio;
        }
    }
    whole.sets.iter().map(|set| set.modes.rough_frequencies(&usual).ok()).collect()
}

/// How far the lines that are left lie beside a panel of the size that most of them want.
fn score(whole: &FrequencyProblem, reading: &Reading, frequencies: &[Vec<f64>]) -> f64 {
    let mut ratios = Vec::new();
    for (set, own) in whole.sets.iter().enumerate() {
        for (line, measured) in own.measured.iter().enumerate() {
            if reading.left_out == (Line { set, line }) {
                continue;
            }
            let renamed = reading.names.iter().find(|name| name.set == set && name.line == line);
            let name = renamed.and_then(|name| own.modes.nodes().iter().position(|nodes| *nodes == name.nodes));
            ratios.push((frequencies[set][name.unwrap_or(line)] / measured).ln());
        }
    }
    let mut sorted = ratios.clone();
    sorted.sort_by(f64::total_cmp);
    let Some(size) = sorted.get(sorted.len() / 2) else { return f64::INFINITY };
    ratios.iter().map(|ratio| ((ratio - size) / USUAL_MISS).powi(2).ln_1p()).sum()
}

/// A reading, and the plate that was found under it.
struct Tried {
    reading: Reading,
    all: FreeConstants,
    problem: FrequencyProblem,
    minimum: Minimum,
}

impl Tried {
    /// `None` where nothing is found, or with so few lines that anything would be met.
    fn of(test: &ImpactTest, whole: &FrequencyProblem, reading: &Reading) -> Option<Self> {
        let mut problem = whole.read_as(test, &reading.names, Some(reading.left_out)).ok()?;
        let all = problem.constants.clone();
        let start = starting_values(&problem).ok()?;
        let minimum = minimise_what_is_seen(&mut problem, &start).ok()?;
        let told = problem.count() >= problem.constants.count() + LINES_LEFT;
        told.then(|| Self { reading: reading.clone(), all, problem, minimum })
    }

    fn cost(&self) -> f64 {
        cost(&self.problem, &self.minimum)
    }

    fn rms(&self) -> f64 {
        (self.cost() / self.problem.count().max(1) as f64).sqrt()
    }

    fn is_met(&self) -> bool {
        self.rms() < MET * Noise::stated(&self.problem).variance.sqrt()
    }

    fn try_at_once(&mut self) {
        if let Some(met) = meets_at_once(&mut self.problem, &self.all, &self.minimum) {
            self.minimum = met;
        }
    }

    fn sentence(&self, test: &ImpactTest, whole: &FrequencyProblem) -> Result<String, IdentifyError> {
        let Line { set, line } = self.reading.left_out;
        let own = &whole.sets[set];
        let (nodes, measured, piece) = (own.modes.nodes(), &own.measured, &test.pieces[own.piece].name);
        let percent = 100.0 * self.rms();
        let may_be = match self.name_of(measured[line])? {
            Some(name) => format!("may be {name:?}"),
            None => "has no mode near it".to_owned(),
        };
        Ok(match self.reading.kind {
            Kind::Apart => format!(
                "piece {piece}, {} Hz named {:?}: a plate meets all other lines to {percent:.2} % rms, and this frequency {may_be}; look \
                 at it and at its mode's shape again",
                measured[line], nodes[line]
            ),
            Kind::NamePassedOver => format!(
                "piece {piece}: from {} Hz named {:?} on the names are shifted by one: this line {may_be}, and each name from there on is \
                 that of the next line; a plate meets the list read so to {percent:.2} % rms; look for the mode that was passed over",
                measured[line], nodes[line]
            ),
            Kind::LinePassedOver(first) => format!(
                "piece {piece}: from {} Hz named {:?} on the names are shifted by one: no frequency of the mode {:?} was measured, each line \
                 from there on has the name of the next one, and the last, {} Hz, {may_be}; a plate meets the list read so to {percent:.2} % \
                 rms; look for the mode that was passed over",
                measured[first], nodes[first], nodes[first], measured[line]
            ),
        })
    }

    /// The nodal lines of the plate's mode at the frequency of the line left out, where the list does not name it.
    fn name_of(&self, measured: f64) -> Result<Option<[usize; 2]>, IdentifyError> {
        let set = self.reading.left_out.set;
        let (modes, values) = (&self.problem.sets[set].modes, &self.minimum.predictions[set].values);
        let spectrum = modes.spectrum(values)?;
        let miss = |frequency: f64| (frequency / measured - 1.0).abs();
        let free = spectrum.iter().filter(|line| miss(line.frequency) < NEAR && !modes.nodes().contains(&line.nodes));
        Ok(free.min_by(|a, b| miss(a.frequency).total_cmp(&miss(b.frequency))).map(|line| line.nodes))
    }
}
