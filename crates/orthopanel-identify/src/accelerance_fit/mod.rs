//! Identification by accelerance: maximum likelihood over the whole complex band, or the paper's eq. 23.

mod line_block;
mod line_noise;
mod matching;
mod outcome;
mod paper_error;
mod pole_constants;
mod poles;
mod problem;
mod records;
mod resonance_point;
mod smooth_part;
mod synthesis;

use orthopanel_data::ImpactTest;
use orthopanel_model::{BeamConstants, ExactBeam, Piece};
use rayon::prelude::*;

use crate::elastic_constants::held_constants;
use crate::least_squares::{Minimum, Stuck, levenberg_marquardt};
use crate::{Identification, IdentifyError, Search, Settings};
use matching::{Matching, PiecePoles, match_at, match_poles};
use poles::{Pole, poles};
use problem::{AcceleranceProblem, PieceProblem};
use records::PlaceRecord;

pub use synthesis::DampingLaw;

/// What stands before the fit: records, their poles, and which modes these are.
struct Start {
    pieces: Vec<StartPiece>,
    poles: Vec<PiecePoles>,
    matching: Matching,
    held: [Option<f64>; 2],
    notes: Vec<String>,
}

impl Start {
    /// Whether the starting model's resonances overlap those of the records, so that a fit line by line can pull them
    /// together. Where one lies wholly beside its peak, the misfit has no slope towards it: damping would grow instead.
    fn resonances_meet(&self) -> Result<bool, IdentifyError> {
        let [e_x, g_zx] = self.matching.constants;
        for ((piece, own), matched) in self.poles.iter().zip(&self.pieces).zip(&self.matching.modes) {
            let beam = ExactBeam::new(&piece.sizes, piece.boundary, BeamConstants { e_x, g_zx })?;
            let modes = beam.natural_frequencies(matched.iter().flatten().max().map_or(0, |mode| mode + 1));
            for (pole, mode) in own.poles.iter().zip(matched) {
                let Some(mode) = mode.and_then(|mode| modes.get(mode)) else { continue };
                if (mode - pole.frequency).abs() > OVERLAP * pole.zeta * pole.frequency {
                    return Ok(false);
                }
            }
        }
        Ok(true)
    }
}

/// Resonances overlap well within this part of half a half-power width.
const OVERLAP: f64 = 0.5;

struct StartPiece {
    index: usize,
    sizes: Piece,
    records: Vec<PlaceRecord>,
    poles: Vec<Pole>,
}

/// Finds constants and damping from the records of a test.
///
/// 1. Poles are read off the resonances without a model, all places together.
/// 2. The constants whose modes meet the poles best are the start, with the poles' damping.
/// 3. Levenberg-Marquardt on the complex misfit of every line, over its noise:
///    $\min \sum |H_{cal}-H_{exp}|^2/\mathrm{var}$ over $\ln E_x$, $\ln G_{zx}$ and every $\ln\zeta_m$. Modes beyond
///    the band enter through their static part.
///
/// Standard deviations are $(J^TJ)^{-1}$, widened by the misfit per datum where that is above one. Where the model
/// misses the records by far more than their noise, a line by line fit would bend damping to make up for a wrong
/// frequency; then the constants come from the poles' frequencies, the damping from the poles, and a note says so.
pub(crate) fn identify_records(test: &ImpactTest, settings: Settings) -> Result<Identification, IdentifyError> {
    let start = start(test, settings)?;
    let problem = assemble(test, &start, settings)?;
    let parameters = starting_parameters(&problem, &start);
    let minimum = match settings.search {
        Search::LeastSquares if !start.resonances_meet()? => {
            return outcome::from_poles(test, start, &problem, &parameters);
        }
        Search::LeastSquares => {
            let fitted = levenberg_marquardt(|p| problem.linearise(p), &parameters, &problem.bounds());
            match fitted {
                Ok(minimum) => minimum,
                // What cannot be fitted line by line is judged by its resonances, and refused there if need be.
                Err(_) => return outcome::from_poles(test, start, &problem, &parameters),
            }
        }
        Search::Simplex => {
            let parameters = paper_error::minimise(&problem, &start, &parameters, settings.paper_weights)?;
            Minimum { at: problem.linearise(&parameters)?, parameters }
        }
    };
    outcome::outcome(test, settings, start, &problem, minimum)
}

fn start(test: &ImpactTest, settings: Settings) -> Result<Start, IdentifyError> {
    let held = held_constants(test)?;
    let mut pieces: Vec<StartPiece> = Vec::new();
    let mut notes = Vec::new();
    let accelerances = test.accelerances(settings.estimation)?;
    let records: Vec<PlaceRecord> =
        accelerances.par_iter().map(|(_, accelerance)| PlaceRecord::of(accelerance)).collect();
    for ((index, accelerance), record) in accelerances.into_iter().zip(records) {
        let (force, response) = (accelerance.force_at, accelerance.response_at);
        let pair = format!("force at ({}, {}), response at ({}, {})", force.x, force.y, response.x, response.y);
        notes.extend(accelerance.notes.iter().map(|note| format!("{pair}: {note}")));
        match pieces.iter_mut().find(|piece| piece.index == index) {
            Some(piece) => piece.records.push(record),
            None => {
                let sizes = test.pieces[index].piece;
                pieces.push(StartPiece { index, sizes, records: vec![record], poles: Vec::new() });
            }
        }
    }
    for piece in &mut pieces {
        piece.poles = poles(&piece.records);
    }
    let poles: Vec<PiecePoles> = pieces
        .iter()
        .map(|piece| PiecePoles {
            sizes: piece.sizes,
            boundary: test.boundary,
            frequencies: piece.poles.iter().map(|pole| pole.frequency).collect(),
            band: piece.records.iter().map(PlaceRecord::band_end).fold(0.0, f64::max),
        })
        .collect();
    let free = held.iter().filter(|held| held.is_none()).count();
    let found: usize = poles.iter().map(|piece| piece.frequencies.len()).sum();
    let too_few = || IdentifyError::TooFewResonances { found, needed: free.max(1) };
    if found < free {
        return Err(too_few());
    }
    let mut matching = match_poles(&poles, held)?.ok_or_else(too_few)?;
    // Twice: better constants may find modes for more poles.
    for _ in 0..2 {
        let matched: usize = matching.modes.iter().flatten().flatten().count();
        if matched < free.max(1) {
            return Err(too_few());
        }
        let minimum = pole_constants::fit_constants(&poles, &matching, held).map_err(|stuck| match stuck {
            Stuck::Refused(error) => IdentifyError::from(error),
            Stuck::Iterations { count, cost } => {
                IdentifyError::NotConverged { iterations: count, error_percent: 100.0 * (cost / matched as f64).sqrt() }
            }
        })?;
        let mut logs = minimum.parameters.iter();
        let constants = held.map(|held| held.unwrap_or_else(|| logs.next().map_or(f64::NAN, |log| log.exp())));
        matching = match_at(&poles, constants)?;
    }
    Ok(Start { pieces, poles, matching, held, notes })
}

fn assemble(test: &ImpactTest, start: &Start, settings: Settings) -> Result<AcceleranceProblem, IdentifyError> {
    let [e_x, g_zx] = start.matching.constants;
    let pieces = start.pieces.iter().zip(&start.poles).map(|(piece, poles)| {
        let beam = ExactBeam::new(&piece.sizes, test.boundary, BeamConstants { e_x, g_zx })?;
        let reach = 2.5 * poles.band;
        let frequencies: Vec<f64> =
            beam.flexible_modes().take(400).map(|mode| mode.frequency()).take_while(|&f| f < reach).collect();
        Ok(PieceProblem::new(piece.index, piece.sizes, test.boundary, piece.records.clone(), &frequencies)?)
    });
    let pieces = pieces.collect::<Result<Vec<_>, IdentifyError>>()?;
    let logs: Vec<f64> = start.pieces.iter().flat_map(|piece| &piece.poles).map(|pole| pole.zeta.ln()).collect();
    let usual = logs.iter().sum::<f64>() / logs.len().max(1) as f64;
    Ok(AcceleranceProblem::new(start.held, settings.damping_law, pieces, usual))
}

/// Logarithms of the free constants and of each damping ratio, from the poles.
fn starting_parameters(problem: &AcceleranceProblem, start: &Start) -> Vec<f64> {
    let mut parameters: Vec<f64> = problem.free.iter().map(|&index| start.matching.constants[index].ln()).collect();
    for ((piece, own), matched) in problem.pieces.iter().zip(&start.pieces).zip(&start.matching.modes) {
        let mut zetas = vec![problem.usual_log_zeta; piece.free_zetas];
        for (pole, mode) in own.poles.iter().zip(matched) {
            if let Some(zeta) = mode.and_then(|mode| zetas.get_mut(mode)) {
                *zeta = pole.zeta.ln();
            }
        }
        parameters.append(&mut zetas);
    }
    parameters
}
