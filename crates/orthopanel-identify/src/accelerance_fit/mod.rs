//! Identification by accelerance: maximum likelihood over the whole complex band, or the paper's eq. 23.

mod line_block;
mod line_noise;
mod matching;
mod outcome;
mod paper_error;
mod poles;
mod problem;
mod records;
mod resonance_point;
mod resonance_start;
mod smooth_part;
mod structures;
mod synthesis;

use orthopanel_data::ImpactTest;
use orthopanel_model::{Boundary, Piece, StructureKind};
use rayon::prelude::*;

use crate::free_constants::FreeConstants;
use crate::frequency_fit::{PoleFit, PoleSet, constants, fit_poles};
use crate::least_squares::{Minimum, levenberg_marquardt};
use crate::{Identification, IdentifyError, Search, Settings};
use matching::{Matching, PiecePoles, match_at, match_poles};
use poles::{Pole, poles};
use problem::{AcceleranceProblem, PieceProblem};
use records::PlaceRecord;
use structures::SeenMode;

pub(crate) use resonance_start::{ResonanceStart, resonance_starts};
pub use synthesis::DampingLaw;

/// What stands before the fit: records, their poles, and which modes these are.
struct Start {
    structure: StructureKind,
    pieces: Vec<StartPiece>,
    poles: Vec<PiecePoles>,
    matching: Matching,
    /// Constants that meet the poles best, and which of them the poles show.
    fit: PoleFit,
    notes: Vec<String>,
}

impl Start {
    /// Whether the starting model's resonances overlap those of the records, so that a fit line by line can pull them
    /// together. Where one lies wholly beside its peak, the misfit has no slope towards it: damping would grow instead.
    fn resonances_meet(&self) -> bool {
        let pieces = self.pieces.iter().zip(&self.matching.modes).zip(&self.matching.seen);
        let mut matched = pieces.flat_map(|((own, modes), seen)| {
            own.poles.iter().zip(modes).filter_map(|(pole, mode)| Some((pole, seen.get((*mode)?)?)))
        });
        matched.all(|(pole, mode)| (mode.frequency - pole.frequency).abs() <= OVERLAP * pole.zeta * pole.frequency)
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
    let mut problem = assemble(&start, settings)?;
    let parameters = starting_parameters(&problem, &start);
    let minimum = match settings.search {
        Search::LeastSquares if !start.resonances_meet() => {
            return outcome::from_poles(test, start, &problem, &parameters);
        }
        Search::LeastSquares => {
            // Lines tell far more than poles: what these do not show, lines may.
            let seen = problem.constants.clone();
            let all = problem.free_resting(&parameters);
            let fitted = levenberg_marquardt(|p| problem.linearise(p), &all, &problem.bounds());
            match fitted {
                Ok(minimum) if !outcome::is_far_from_noise(&problem, &minimum) => minimum,
                // What cannot be fitted line by line is judged by its resonances, and refused there if need be.
                fitted => {
                    let own = |minimum: Minimum| {
                        let zetas = minimum.parameters.into_iter().skip(all.len() - parameters.len() + seen.count());
                        parameters[..seen.count()].iter().copied().chain(zetas).collect()
                    };
                    let parameters = fitted.map_or_else(|_| parameters.clone(), own);
                    (problem.constants, problem.usual) = (seen, Vec::new());
                    return outcome::from_poles(test, start, &problem, &parameters);
                }
            }
        }
        Search::Simplex if start.structure != StructureKind::TimoshenkoBeam => {
            let message = "the paper's search on records is for beams: leave out --search simplex";
            return Err(IdentifyError::Unsupported(message.to_owned()));
        }
        Search::Simplex => {
            let parameters =
                paper_error::minimise(&problem, &start, test.boundary, &parameters, settings.paper_weights)?;
            Minimum { at: problem.linearise(&parameters)?, parameters }
        }
    };
    outcome::outcome(test, settings, start, &mut problem, minimum)
}

fn start(test: &ImpactTest, settings: Settings) -> Result<Start, IdentifyError> {
    let structure = test.structure.unwrap_or(StructureKind::TimoshenkoBeam);
    let constants = FreeConstants::of(test, constants(structure))?;
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
    let poles: Vec<PiecePoles> = pieces.iter().map(|piece| piece_poles(piece, structure, test.boundary)).collect();
    let needed = match structure {
        StructureKind::TimoshenkoBeam => constants.count().max(1),
        StructureKind::MindlinPlate => constants.count().clamp(1, 2),
    };
    let found: usize = poles.iter().map(|piece| piece.frequencies.len()).sum();
    let too_few = || IdentifyError::TooFewResonances { found, needed };
    if found < needed {
        return Err(too_few());
    }
    let mut matching = match_poles(&poles, structure, &constants)?.ok_or_else(too_few)?;
    let mut fit = None;
    // Twice: better constants may find modes for more poles.
    for _ in 0..2 {
        if matching.count() < needed {
            return Err(too_few());
        }
        let values = matching.values.first().cloned().unwrap_or_default();
        let found = fit_poles(structure, &constants, &values, pole_sets(&pieces, &matching, test.boundary))?;
        let values = pieces.iter().map(|piece| found.constants.values(&found.parameters, piece.index)).collect();
        matching = match_at(&poles, values)?;
        fit = Some(found);
    }
    let fit = fit.ok_or_else(too_few)?;
    Ok(Start { structure, pieces, poles, matching, fit, notes })
}

fn piece_poles(piece: &StartPiece, structure: StructureKind, boundary: Boundary) -> PiecePoles {
    // At a resonance H = jP/2ζ: the imaginary part has the sign and the size of P.
    let amplitude = |record: &PlaceRecord, pole: &Pole| {
        let line = record.frequency.partition_point(|&frequency| frequency < pole.frequency);
        record.value.get(line).map_or(0.0, |value| value.im)
    };
    PiecePoles {
        structure: structures::of(structure, &piece.sizes, boundary),
        pairs: piece.records.iter().map(|record| (record.force_at, record.response_at)).collect(),
        frequencies: piece.poles.iter().map(|pole| pole.frequency).collect(),
        amplitudes: piece
            .poles
            .iter()
            .map(|pole| piece.records.iter().map(|record| amplitude(record, pole)).collect())
            .collect(),
        band: piece.records.iter().map(PlaceRecord::band_end).fold(0.0, f64::max),
    }
}

/// The matched poles of every piece with their modes' nodal lines.
fn pole_sets(pieces: &[StartPiece], matching: &Matching, boundary: Boundary) -> Vec<PoleSet> {
    let of_piece = |((piece, modes), seen): ((&StartPiece, &Vec<Option<usize>>), &Vec<SeenMode>)| {
        let matched = piece.poles.iter().zip(modes).filter_map(|(pole, mode)| Some((pole, seen.get((*mode)?)?)));
        let (nodes, frequencies) = matched.map(|(pole, mode)| (mode.nodes, pole.frequency)).unzip();
        PoleSet { piece: piece.index, sizes: piece.sizes, boundary, nodes, frequencies }
    };
    pieces.iter().zip(&matching.modes).zip(&matching.seen).map(of_piece).collect()
}

fn assemble(start: &Start, settings: Settings) -> Result<AcceleranceProblem, IdentifyError> {
    let pieces = start.pieces.iter().zip(&start.poles).zip(&start.matching.values).map(|((piece, poles), values)| {
        let reach = poles.structure.reach() * poles.band;
        let modes = poles.structure.modes_below(values, reach, &[])?;
        let frequencies: Vec<f64> = modes.iter().map(|mode| mode.frequency).collect();
        let synthesis = poles.structure.synthesis(values, frequencies.len().max(1))?;
        Ok(PieceProblem::new(piece.index, piece.sizes, synthesis, piece.records.clone(), &frequencies))
    });
    let pieces = pieces.collect::<Result<Vec<_>, IdentifyError>>()?;
    let logs: Vec<f64> = start.pieces.iter().flat_map(|piece| &piece.poles).map(|pole| pole.zeta.ln()).collect();
    let usual = logs.iter().sum::<f64>() / logs.len().max(1) as f64;
    Ok(AcceleranceProblem::new(start.fit.constants.clone(), settings.damping_law, pieces, usual))
}

/// The free constants and the logarithm of each damping ratio, from the poles.
fn starting_parameters(problem: &AcceleranceProblem, start: &Start) -> Vec<f64> {
    let mut parameters = start.fit.parameters.clone();
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
