//! A beam or a plate with the effects that its test file declares, from its measured modes, as an identification.

use std::f64::consts::TAU;

use orthopanel_data::{Estimation, ImpactTest};
use orthopanel_model::{Estimate, ModelError, Readable, StructureKind};

use crate::free_constants::{FreeConstant, FreeConstants};
use crate::frequency_fit::identified_constants;
use crate::inference::from_base;
use crate::measured::MeasuredModes;
use crate::posterior::Judged;
use crate::predicted::Prediction;
use crate::search::Inquiry;
use crate::stacked::{Block, Stacked};
use crate::structures::{self, bending_nodes};
use crate::{AcceleranceFit, HiddenMode, Identification, IdentifiedConstant, IdentifyError, ModeFit, PieceFit};

use super::bounds::{notes_on_bound, notes_on_prior_alone};
use super::damping::TracedDamping;
use super::doubt::notes_on_not_shown;
use super::estimates::Estimates;
use super::lines::{Drawn, Lines};
use super::lists::{notes_on_hidden, percent};
use super::{curves_of, drawn, lists_beside, not_finite};

/// Modes are named up to so many times the highest pole.
const ABOVE: f64 = 1.2;

/// Identifies constants from records, with the effects that the test declares, a parameter that it leaves out too, and with lists of natural
/// frequencies beside them.
///
/// # Errors
/// As [`from_base`], and [`IdentifyError::OnBound`].
pub(crate) fn identify_with_effects(
    test: &ImpactTest,
    estimation: Estimation,
) -> Result<Identification, IdentifyError> {
    from_base(test, None, &|_| {}, |inquiry, base| identification(test, (&inquiry, &base), estimation))
}

/// The same from lists of natural frequencies, of one piece or several.
///
/// # Errors
/// As [`from_base`], [`IdentifyError::OnBound`], and [`IdentifyError::Unsupported`] for an effect that no frequency shows.
pub(crate) fn identify_lists_with_effects(test: &ImpactTest) -> Result<Identification, IdentifyError> {
    from_base(test, None, &|_| {}, |inquiry, base| {
        let mut notes = notes_on_hidden(test, &inquiry)?;
        let (found, needed) = (inquiry.frequencies(), base.hypothesis.unknowns());
        // Where priors tell the rest, one frequency is left to judge by.
        if found < needed && found <= base.determined() {
            let names = "constants and numbers of declared effects".to_owned();
            return Err(IdentifyError::TooFewFrequencies { found, needed, names });
        }
        let estimates = Estimates::of(&base);
        notes.extend(notes_on_prior_alone(&base, &estimates));
        notes.extend(notes_on_bound(&estimates, inquiry.predictor().piece()));
        notes.extend(inquiry.of_lists.notes.iter().cloned());
        let pieces = pieces_of_lists(test, &inquiry, &base)?;
        notes.extend(each_alone(&inquiry.stacked, &base));
        let error = percent(&inquiry, &base).ok_or_else(|| not_finite("error of the frequencies"))?;
        let is_judged = inquiry.frequencies() > base.determined();
        let constants = FreeConstants::of(test, inquiry.predictor().structure.constants())?;
        Ok(Identification {
            structure: inquiry.predictor().structure,
            constants: constants_of(test, (&constants, &base), &estimates)?,
            not_identified: vec![],
            correlations: constants.correlations(&base.posterior.covariance),
            frequency_rms_percent: error.fitted,
            left_one_out_percent: is_judged.then_some(error.held_out),
            accelerance_rms_percent: None,
            chi_square: None,
            effects: estimates.of_test(),
            pieces,
            accelerances: vec![],
            question: inquiry.of_lists.question.clone(),
            common_gain: None,
            notes,
        })
    })
}

/// Nodal lines of the flexible modes of a block's panel itself, at least of those in the band.
///
/// # Errors
/// What the plate refuses.
fn nodes_of(test: &ImpactTest, block: &Block, base: &Judged, at: &Prediction) -> Result<Vec<[usize; 2]>, ModelError> {
    let count = at.flexible.len();
    if block.predictor.structure == StructureKind::TimoshenkoBeam {
        return Ok(bending_nodes(test.boundary, count));
    }
    let (constants, _) = block.values(&base.hypothesis, &base.posterior.point.z)?;
    let structure = structures::of(StructureKind::MindlinPlate).recorded(block.predictor.piece(), test.boundary);
    let measured = block.comparison().measured;
    let top = measured.poles.last().map_or(0.0, |pole| pole.angular_frequency / TAU).max(measured.band[1]);
    let modes = structure.modes_below(&constants, ABOVE * top, &[])?;
    Ok(modes.into_iter().map(|mode| mode.nodes).take(count).collect())
}

/// Each piece with the modes of its lists beside those of the panel.
///
/// # Errors
/// What the plate refuses.
fn pieces_of_lists(test: &ImpactTest, inquiry: &Inquiry, base: &Judged) -> Result<Vec<PieceFit>, ModelError> {
    let mut pieces: Vec<PieceFit> = test.pieces.iter().map(PieceFit::of).collect();
    let blocks = inquiry.stacked.blocks.iter().zip(&base.posterior.point.at.blocks);
    for (block, at) in blocks.filter(|(block, _)| block.comparison().measured.records.is_empty()) {
        let measured = block.comparison().measured;
        let nodes = nodes_of(test, block, base, at)?;
        for (index, pole) in measured.poles.iter().enumerate() {
            let Some((mode, &nodes)) = at.flexible_of_poles[index].and_then(|mode| Some((mode, nodes.get(mode)?)))
            else {
                continue;
            };
            let frequency = pole.angular_frequency / TAU;
            let std = measured.covariance[(index, index)].sqrt();
            pieces[block.piece].modes.push(ModeFit {
                mode: mode + 1,
                nodes,
                measured: frequency,
                measured_std: Some(frequency * std).filter(|_| std > 0.0),
                model: at.values[index].exp() / TAU,
                damping: None,
            });
        }
    }
    Ok(pieces)
}

/// # Errors
/// [`IdentifyError::OnBound`].
fn constants_of(
    test: &ImpactTest,
    (constants, base): (&FreeConstants, &Judged),
    estimates: &Estimates,
) -> Result<Vec<IdentifiedConstant>, IdentifyError> {
    let of = |(parameter, free): (usize, &FreeConstant)| {
        let place = base.hypothesis.constant_numbers().position(|number| number == (free.constant, free.piece));
        let Estimate { value, std } = estimates.constants[place.unwrap_or_default()];
        (constants.parameter(parameter, value), std.map(|std| std / constants.slope(free.constant, value)))
    };
    let (free, log_std): (Vec<f64>, Vec<Option<f64>>) = constants.free.iter().enumerate().map(of).unzip();
    constants.refuse_bounds(&free)?;
    Ok(identified_constants(test, constants, &free, &log_std))
}

fn identification(
    test: &ImpactTest,
    (inquiry, base): (&Inquiry, &Judged),
    estimation: Estimation,
) -> Result<Identification, IdentifyError> {
    let estimates = Estimates::of(base);
    let constants = FreeConstants::of(test, inquiry.predictor().structure.constants())?;
    let identified = constants_of(test, (&constants, base), &estimates)?;
    let lines = Lines::of(test, estimation)?;
    let drawn = drawn(test, (inquiry, base), &lines)?;
    let curves = curves_of(&drawn);
    let mut pieces = pieces_of_lists(test, inquiry, base)?;
    // Of a piece that was hit its records say more.
    for ((number, hit), Drawn { damping, .. }) in inquiry.stacked.hit().zip(drawn) {
        let at = &base.posterior.point.at.blocks[number];
        let nodes = nodes_of(test, hit, base, at)?;
        let damping = if inquiry.stacked.is_of_plates() {
            let partners = (&at.flexible_of_poles[..], &at.damping_of_effects[..]);
            TracedDamping::of_partners(hit.comparison().measured, partners, at.flexible.len())
        } else {
            damping
        };
        pieces[hit.piece] = piece_fit(test, (hit.comparison().measured, at), nodes, &damping);
    }
    let modes = || pieces.iter().flat_map(|piece| &piece.modes);
    let errors: f64 = modes().map(|mode| mode.error_percent().powi(2)).sum();
    let pairs = || curves.iter().flat_map(|curve| curve.model.iter().zip(&curve.measured));
    let missed: f64 = pairs().map(|(model, measured)| (model - measured).norm_sqr()).sum();
    let total: f64 = pairs().map(|(_, measured)| measured.norm_sqr()).sum();
    let mut notes = lines.notes_of_records();
    notes.extend(lists_beside(inquiry));
    notes.extend(each_alone(&inquiry.stacked, base));
    notes.extend(notes_on_not_shown(inquiry, base));
    notes.extend(notes_on_prior_alone(base, &estimates));
    notes.extend(notes_on_bound(&estimates, inquiry.predictor().piece()));
    Ok(Identification {
        structure: inquiry.predictor().structure,
        constants: identified,
        not_identified: vec![],
        // Coordinates go with the logarithms of the constants, which come first.
        correlations: constants.correlations(&base.posterior.covariance),
        frequency_rms_percent: (errors / modes().count().max(1) as f64).sqrt(),
        left_one_out_percent: None,
        accelerance_rms_percent: Some(100.0 * (missed / total).sqrt()),
        chi_square: chi_square(&curves),
        effects: estimates.of_test(),
        pieces,
        accelerances: curves,
        question: None,
        common_gain: None,
        notes,
    })
}

/// The modes of the panel beside the poles that are theirs, and those in the band without one.
fn piece_fit(
    test: &ImpactTest,
    (measured, at): (&MeasuredModes, &Prediction),
    nodes: Vec<[usize; 2]>,
    damping: &TracedDamping,
) -> PieceFit {
    let mut fit = PieceFit::of(&test.pieces[measured.piece]);
    let in_band = at.flexible.iter().take_while(|omega| **omega < TAU * measured.band[1]).count();
    let ratio = |mode: usize| Estimate {
        value: damping.damping.ratios.get(mode).copied().unwrap_or(damping.damping.beyond),
        std: damping.std.get(mode).copied().flatten(),
    };
    fit.damping = (0..in_band).map(ratio).collect();
    for (index, nodes) in nodes.into_iter().enumerate() {
        let mode = index + 1;
        match at.flexible_of_poles.iter().position(|of| *of == Some(index)) {
            Some(pole) => {
                let frequency = measured.poles[pole].angular_frequency / TAU;
                fit.modes.push(ModeFit {
                    mode,
                    nodes,
                    measured: frequency,
                    measured_std: Some(frequency * measured.covariance[(pole, pole)].sqrt()),
                    model: at.values[pole].exp() / TAU,
                    damping: Some(ratio(index)),
                });
            }
            None if index < in_band => {
                let told = Some(ratio(index)).filter(|ratio| ratio.std.is_some());
                fit.hidden.push(HiddenMode { mode, nodes, model: at.flexible[index] / TAU, damping: told });
            }
            None => {}
        }
    }
    fit
}

/// Of each block [`alone`].
fn each_alone(stacked: &Stacked, base: &Judged) -> Vec<String> {
    let blocks = stacked.blocks.iter().zip(&base.posterior.point.at.blocks);
    blocks.filter_map(|(block, at)| alone(block.comparison().measured, at)).collect()
}

/// A sentence on the resonances that are no mode of the panel; `None` where there are none.
fn alone(measured: &MeasuredModes, at: &Prediction) -> Option<String> {
    let of_poles = measured.poles.iter().zip(&at.flexible_of_poles).zip(&at.hangs);
    let alone: Vec<String> = of_poles
        .filter(|((_, mode), hangs)| mode.is_none() && !**hangs)
        .map(|((pole, _), _)| format!("{:.1} Hz", Readable(pole.angular_frequency / TAU)))
        .collect();
    (!alone.is_empty()).then(|| {
        format!("resonances that are no mode of the panel with what the test file declares: {}", alone.join(", "))
    })
}

/// Misfit of the lines per datum, where all records tell their noise.
fn chi_square(curves: &[AcceleranceFit]) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0);
    for AcceleranceFit { measured, model, variance, .. } in curves {
        for ((measured, model), variance) in measured.iter().zip(model).zip(variance.as_ref()?) {
            sum += (measured - model).norm_sqr() / variance;
            count += 1;
        }
    }
    (count > 0).then(|| sum / f64::from(count))
}
