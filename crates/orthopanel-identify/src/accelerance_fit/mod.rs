//! Identification by accelerance: maximum likelihood over the whole complex band, or the paper's eq. 23.

mod line_block;
mod line_noise;
mod matching;
mod outcome;
mod paper_error;
mod poles;
mod problem;
mod record_poles;
mod records;
mod resonance_point;
mod resonance_start;
mod smooth_part;
mod start;
mod structures;
mod synthesis;

use orthopanel_data::ImpactTest;
use orthopanel_model::StructureKind;

use crate::least_squares::{Minimum, levenberg_marquardt};
use crate::{Identification, IdentifyError, Search, Settings};
use problem::{AcceleranceProblem, PieceProblem};
use start::{Start, start, usual_log_zeta};

pub(crate) use record_poles::{RecordPole, record_poles};
pub(crate) use resonance_start::{ResonanceStart, resonance_starts};
pub use synthesis::DampingLaw;

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

fn assemble(start: &Start, settings: Settings) -> Result<AcceleranceProblem, IdentifyError> {
    let pieces = start.pieces.iter().zip(&start.poles).zip(&start.matching.values).map(|((piece, poles), values)| {
        let reach = poles.structure.reach() * poles.band;
        let modes = poles.structure.modes_below(values, reach, &[])?;
        let frequencies: Vec<f64> = modes.iter().map(|mode| mode.frequency).collect();
        let synthesis = poles.structure.synthesis(values, frequencies.len().max(1))?;
        Ok(PieceProblem::new(piece.index, piece.sizes, synthesis, piece.records.clone(), &frequencies))
    });
    let pieces = pieces.collect::<Result<Vec<_>, IdentifyError>>()?;
    let usual = usual_log_zeta(start.pieces.iter().flat_map(|piece| &piece.poles));
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
