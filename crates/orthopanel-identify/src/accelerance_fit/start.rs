//! Before the fit: poles of the records, which modes they are, and the constants that meet them.

use orthopanel_data::{Accelerance, ImpactTest};
use orthopanel_model::Boundary;
use rayon::prelude::*;

use super::band::{low_band_of_usual_panel, refuse_large_pieces};
use super::followed_modes::follow;
use super::matching::{Matching, PiecePoles, candidates, match_at};
use super::misfit::noise_percent;
use super::mode_group::{NearMode, Overlap, group_pole};
use super::pole::Pole;
use super::poles::{NoisePower, alike, poles};
use super::record_name::pair_name;
use super::recorded::{Recorded, StartPiece};
use super::records::PlaceRecord;
use crate::IdentifyError;
use crate::free_constants::FreeConstants;
use crate::frequency_fit::{PoleFit, PoleSet, fit_poles};
use crate::least_squares::Quadratic;
use crate::structures::{self, SearchedStructure, Shown};

/// What stands before the fit: which modes the poles are, and constants.
pub(super) struct Start<'a> {
    pub recorded: &'a Recorded,
    /// Those of each piece.
    pub poles: Vec<Vec<Pole>>,
    pub matching: Matching,
    /// Constants that meet the poles best, and which of them the poles show.
    pub fit: PoleFit,
}

impl<'a> Start<'a> {
    /// At constants that were found without the poles.
    pub fn at(recorded: &'a Recorded, constants: &FreeConstants, parameters: &[f64]) -> Result<Self, IdentifyError> {
        let parameters = &parameters[..constants.count()];
        let values = recorded.pieces.iter().map(|piece| constants.values(parameters, piece.index)).collect();
        let fit = PoleFit {
            constants: constants.clone(),
            parameters: parameters.to_vec(),
            at: Quadratic::zero(parameters.len()),
            not_identified: Vec::new(),
        };
        Ok(Self { recorded, poles: poles_of(recorded), matching: match_at(&recorded.poles, values)?, fit })
    }

    /// Whether the starting model's resonances overlap those of the records, so that a fit line by line can pull them
    /// together. Where one lies wholly beside its peak, the misfit has no slope towards it: damping would grow instead.
    pub fn resonances_meet(&self) -> bool {
        self.beside().all(|half_widths| half_widths.abs() <= OVERLAP)
    }

    /// Resonances \[Hz\] that no mode took; those below the lowest mode may come from the piece's suspension.
    pub fn untaken_resonances(&self) -> Vec<f64> {
        let mut untaken = Vec::new();
        for ((poles, modes), seen) in self.poles.iter().zip(&self.matching.modes).zip(&self.matching.seen) {
            let lowest = seen.first().map_or(f64::INFINITY, |mode| mode.frequency);
            let lonely = poles.iter().zip(modes).filter(|(pole, mode)| mode.is_none() && pole.frequency > lowest);
            untaken.extend(lonely.map(|(pole, _)| pole.frequency));
        }
        untaken
    }

    /// How far the model's resonances lie beside those of the records, in half widths, rms; zero of none.
    pub fn half_widths_beside(&self) -> f64 {
        let (sum, count) = self.beside().fold((0.0, 0.0), |(sum, count), beside| (sum + beside * beside, count + 1.0));
        if count > 0.0 { (sum / count).sqrt() } else { 0.0 }
    }

    /// How many half widths each matched pole's mode lies beside it.
    fn beside(&self) -> impl Iterator<Item = f64> + '_ {
        let pieces = self.poles.iter().zip(&self.matching.modes).zip(&self.matching.seen);
        pieces.flat_map(|((poles, modes), seen)| {
            poles.iter().zip(modes).filter_map(|(pole, mode)| {
                let mode = seen.get((*mode)?)?;
                Some((mode.frequency - pole.frequency) / (pole.zeta * pole.frequency))
            })
        })
    }
}

fn poles_of(recorded: &Recorded) -> Vec<Vec<Pole>> {
    recorded.pieces.iter().map(|piece| piece.poles.clone()).collect()
}

/// What is known of a mode's $\ln\zeta$ where its neighbours hide it.
const HIDDEN: f64 = 2.0;
/// A damping ratio this many times the usual one is no place to begin: two resonances look like one.
const UNLIKELY: f64 = 3.0;

/// How often overlapping resonances are fitted anew.
const PASSES: usize = 3;

impl Start<'_> {
    /// The same with resonances that overlap fitted together, and the constants of their frequencies.
    pub fn grouped(mut self) -> Result<Self, IdentifyError> {
        let Recorded { structure, boundary, constants, pieces, .. } = self.recorded;
        for (index, piece) in pieces.iter().enumerate() {
            let usual = usual_log_zeta(&self.poles[index]).exp();
            let mut near: Vec<NearMode> = self.matching.seen[index]
                .iter()
                .map(|mode| NearMode { frequency: mode.frequency, zeta: usual, products: mode.products.clone() })
                .collect();
            let matched = self.poles[index].iter().zip(&self.matching.modes[index]);
            for (pole, mode) in matched {
                if let Some(mode) = mode.and_then(|mode| near.get_mut(mode)) {
                    mode.frequency = pole.frequency;
                    mode.zeta = if pole.zeta < UNLIKELY * usual { pole.zeta } else { usual };
                }
            }
            let (poles, modes) = (&mut self.poles[index], &mut self.matching.modes[index]);
            for _ in 0..PASSES {
                regroup(&piece.records, &mut near, poles, modes);
            }
        }
        let Some(values) = self.matching.values.first() else { return Ok(self) };
        self.fit = fit_poles(*structure, constants, values, pole_sets(pieces, &self.poles, &self.matching, *boundary))?;
        Ok(self)
    }
}

/// One pass over all modes; the next takes a mode's neighbours from where this one found them.
fn regroup(records: &[PlaceRecord], near: &mut [NearMode], poles: &mut Vec<Pole>, modes: &mut Vec<Option<usize>>) {
    let told: Vec<Overlap> = (0..near.len()).map(|mode| group_pole(records, near, mode)).collect();
    for (mode, overlap) in told.into_iter().enumerate() {
        let known = modes.iter().position(|of| *of == Some(mode));
        if let Overlap::Told(pole) = &overlap {
            (near[mode].frequency, near[mode].zeta) = (pole.frequency, pole.zeta);
        }
        match (overlap, known) {
            (Overlap::Alone, _) | (Overlap::Hidden, None) => {}
            (Overlap::Told(pole), Some(at)) => poles[at] = pole,
            (Overlap::Told(pole), None) => {
                poles.push(pole);
                modes.push(Some(mode));
            }
            (Overlap::Hidden, Some(at)) => poles[at].log_zeta_std = HIDDEN,
        }
    }
}

/// Resonances overlap well within this part of half a half-power width.
const OVERLAP: f64 = 0.5;

/// The records of a test, as they are read, and their poles read off them.
pub(super) fn recorded_of(test: &ImpactTest, accelerances: &[(usize, Accelerance)]) -> Result<Recorded, IdentifyError> {
    let structure = structures::of_test(test);
    let constants = FreeConstants::of(test, structure.kind().constants())?;
    let mut pieces: Vec<StartPiece> = Vec::new();
    let mut notes = Vec::new();
    let records: Vec<PlaceRecord> =
        accelerances.par_iter().map(|(_, accelerance)| PlaceRecord::of(accelerance)).collect();
    for ((index, accelerance), record) in accelerances.iter().zip(records) {
        let index = *index;
        let pair = pair_name(accelerance.force_at, accelerance.response_at);
        notes.extend(accelerance.notes.iter().map(|note| format!("{pair}: {note}")));
        match pieces.iter_mut().find(|piece| piece.index == index) {
            Some(piece) => piece.records.push(record),
            None => {
                let sizes = test.pieces[index].piece;
                pieces.push(StartPiece { index, sizes, records: vec![record], poles: Vec::new() });
            }
        }
    }
    refuse_large_pieces(&pieces)?;
    for piece in &mut pieces {
        piece.poles = poles(&piece.records);
        let decays: Vec<(f64, f64)> = piece.poles.iter().map(|pole| (pole.decay_rate(), pole.frequency)).collect();
        piece.records.iter_mut().for_each(|record| record.heed_window(&decays));
    }
    let poles: Vec<PiecePoles> = pieces.iter().map(|piece| piece_poles(piece, structure, test.boundary)).collect();
    Ok(Recorded { structure, boundary: test.boundary, constants, pieces, poles, notes })
}

/// The constants that meet the poles best.
pub(super) fn start(recorded: &Recorded) -> Result<Start<'_>, IdentifyError> {
    let Recorded { structure, boundary, constants, pieces, poles, .. } = recorded;
    let structure = *structure;
    let needed = match structure.shown() {
        Shown::Wholly => constants.count().max(1),
        Shown::InPart => constants.count().clamp(1, 2),
    };
    let found: usize = poles.iter().map(|piece| piece.frequencies.len()).sum();
    let too_few =
        || IdentifyError::TooFewResonances { found, needed, noise_percent: noise_percent(recorded.records()) };
    if found < needed {
        return Err(low_band_of_usual_panel(recorded)?.unwrap_or_else(too_few));
    }
    let candidates = candidates(poles, structure.shown(), constants, tried(structure.shown()))?;
    if structure.shown() == Shown::InPart {
        let found = follow(poles, constants, candidates)?;
        let (matching, fit) = found.filter(|(matching, _)| matching.count() >= needed).ok_or_else(too_few)?;
        return Ok(Start { recorded, poles: poles_of(recorded), matching, fit });
    }
    let own_poles = poles_of(recorded);
    let fitted = candidates.into_iter().map(|candidate| {
        let sets = |matching: &Matching| pole_sets(pieces, &own_poles, matching, *boundary);
        fit_candidate(poles, structure, constants, needed, sets, candidate)
    });
    let mut best: Option<(Matching, PoleFit)> = None;
    let mut first_refusal = None;
    for fitted in fitted {
        match fitted {
            Ok(Some(fitted)) if best.as_ref().is_none_or(|(least, _)| fitted.0.charge < least.charge) => {
                best = Some(fitted);
            }
            Ok(_) => {}
            Err(error) => first_refusal = first_refusal.or(Some(error)),
        }
    }
    let (matching, fit) = best.ok_or_else(|| first_refusal.unwrap_or_else(too_few))?;
    Ok(Start { recorded, poles: poles_of(recorded), matching, fit })
}

/// Candidates that are fitted to their poles: modes both ways cost far more, and are told by their shapes.
fn tried(shown: Shown) -> usize {
    match shown {
        Shown::Wholly => 12,
        Shown::InPart => 3,
    }
}

/// A candidate with the constants that meet its poles best; `None` where too few poles meet a mode.
fn fit_candidate(
    poles: &[PiecePoles],
    structure: &'static dyn SearchedStructure,
    constants: &FreeConstants,
    needed: usize,
    sets: impl Fn(&Matching) -> Vec<PoleSet>,
    mut matching: Matching,
) -> Result<Option<(Matching, PoleFit)>, IdentifyError> {
    let mut fit = None;
    // Twice: better constants may find modes for more poles.
    for _ in 0..2 {
        if matching.count() < needed {
            return Ok(None);
        }
        let values = matching.values.first().cloned().unwrap_or_default();
        let found = fit_poles(structure, constants, &values, sets(&matching))?;
        let values = poles.iter().map(|own| found.constants.values(&found.parameters, own.piece)).collect();
        matching = match_at(poles, values)?;
        fit = Some(found);
    }
    Ok(fit.map(|fit| (matching, fit)))
}

fn piece_poles(piece: &StartPiece, structure: &dyn SearchedStructure, boundary: Boundary) -> PiecePoles {
    // At a resonance H = jP/2ζ: the imaginary part has the sign and the size of P.
    let amplitude = |record: &PlaceRecord, pole: &Pole| {
        let line = record.frequency.partition_point(|&frequency| frequency < pole.frequency);
        record.value.get(line).map_or(0.0, |value| value.im)
    };
    PiecePoles {
        piece: piece.index,
        structure: structure.recorded(&piece.sizes, boundary),
        pairs: piece.records.iter().map(|record| (record.force_at, record.response_at)).collect(),
        frequencies: piece.poles.iter().map(|pole| pole.frequency).collect(),
        amplitudes: piece
            .poles
            .iter()
            .map(|pole| piece.records.iter().map(|record| amplitude(record, pole)).collect())
            .collect(),
        usual_zeta: usual_log_zeta(&piece.poles).exp(),
        noise: NoisePower::of(&alike(&piece.records)),
        band: piece.records.iter().map(PlaceRecord::band_end).fold(0.0, f64::max),
    }
}

/// The matched poles of every piece with their modes' nodal lines.
fn pole_sets(pieces: &[StartPiece], poles: &[Vec<Pole>], matching: &Matching, boundary: Boundary) -> Vec<PoleSet> {
    let of_piece = |(index, piece): (usize, &StartPiece)| {
        let seen = &matching.seen[index];
        let matched = poles[index].iter().zip(&matching.modes[index]);
        let matched = matched.filter_map(|(pole, mode)| Some((pole, seen.get((*mode)?)?)));
        let (nodes, frequencies) = matched.map(|(pole, mode)| (mode.nodes, pole.frequency)).unzip();
        PoleSet { piece: piece.index, sizes: piece.sizes, boundary, nodes, frequencies }
    };
    pieces.iter().enumerate().map(of_piece).collect()
}

/// Mean of the logarithms of the damping ratios.
pub(super) fn usual_log_zeta<'a>(poles: impl IntoIterator<Item = &'a Pole>) -> f64 {
    let logs: Vec<f64> = poles.into_iter().map(|pole| pole.zeta.ln()).collect();
    logs.iter().sum::<f64>() / logs.len().max(1) as f64
}
