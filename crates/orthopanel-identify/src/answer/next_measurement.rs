//! The one further measurement that would part the chosen hypothesis from its rivals best, worked out from what each predicts of it.

use faer::Mat;
use orthopanel_data::ImpactTest;
use orthopanel_model::{
    EffectState, ModelError, ModifiedPanel, Place, RecordSetting, SENSOR_MASS, Scale, StructureKind, effect,
};
use rayon::prelude::*;

use super::estimates::id;
use super::weighed::{no_mode, no_resonance};
use crate::comparison::Comparison;
use crate::judge::{not_modal, without_mode};
use crate::measured::{MeasuredModes, MeasuredRecord};
use crate::model_error::{ErrorColumns, waves};
use crate::outcome::Verdict;
use crate::posterior::Judged;
use crate::predicted::{Predictor, distinct};
use crate::search::Inquiry;
use crate::to_check::{times_the_noise, to_check};

/// Places tried along a beam, and along either side of a plate.
const PLACES: usize = 17;
const PLACES_EACH_WAY: usize = 7;
/// Mass that a tester has at hand, in parts of the piece's \[1\].
const ADDED: f64 = 0.01;
/// Times noise and model error from which a measurement parts two hypotheses.
pub(super) const PARTS: f64 = 3.0;

/// What a tester changes of the first record.
struct Proposal {
    words: String,
    force_at: Place,
    response_at: Place,
    /// \[kg\].
    added_mass: f64,
}

/// What to measure next, in words; `left` is what the chosen hypothesis leaves, over noise and model error.
pub(super) fn next_measurement(
    (test, inquiry): (&ImpactTest, &Inquiry),
    (chosen, verdict, left): (&Judged, Verdict, f64),
    (rivals, all): (&[&Judged], &[Judged]),
) -> String {
    let names = chosen.names();
    let is_other = |judged: &&Judged| {
        let own = judged.names();
        !own.is_empty() && names.iter().any(|name| !own.contains(name))
    };
    match verdict {
        Verdict::NothingMissing => "none: the base model meets the measured modes".to_owned(),
        Verdict::Unexplained => {
            let (strangers, other) = (without_mode(chosen, &inquiry.stacked), not_modal(chosen, &inquiry.stacked));
            match (strangers.first(), other) {
                (Some(stranger), _) => to_check(test, &no_mode(test, stranger)),
                (None, Some(measured)) => to_check(test, &no_resonance(test, measured)),
                (None, None) => to_check(test, &times_the_noise(left)),
            }
        }
        _ if !rivals.is_empty() => parting(inquiry, chosen, rivals),
        _ => match all.iter().find(is_other) {
            Some(nearest) => format!("to be surer still: {}", parting(inquiry, chosen, &[nearest])),
            None => "none: no other effect of the catalogue could be tried".to_owned(),
        },
    }
}

/// The proposal whose least difference is the greatest.
fn parting(inquiry: &Inquiry, chosen: &Judged, rivals: &[&Judged]) -> String {
    let predictor = inquiry.predictor();
    let proposals = proposals(predictor);
    // One panel for all: its modes are the same wherever it is hit.
    let places = distinct(proposals.iter().flat_map(|proposal| [proposal.force_at, proposal.response_at]));
    let panel = predictor.panel_at(&places);
    let told = |proposal: Proposal| {
        let further = Further::new((predictor, panel.as_ref().ok()?), &proposal)?;
        let apart: Option<Vec<f64>> = rivals.iter().map(|rival| further.difference(chosen, rival).ok()?).collect();
        let least = apart?.into_iter().enumerate().min_by(|a, b| a.1.total_cmp(&b.1))?;
        Some((proposal.words, least))
    };
    let all: Vec<(String, (usize, f64))> = proposals.into_par_iter().filter_map(told).collect();
    let names: Vec<String> = rivals.iter().map(|rival| id(rival)).collect();
    let (of, others) = (id(chosen), names.join(", "));
    let best = all.into_iter().max_by(|a, b| a.1.1.total_cmp(&b.1.1));
    match (best, &names[..]) {
        (Some((words, (_, apart))), [rival]) if apart > PARTS => {
            format!("{words}: there {of} and {rival} differ by {apart:.1} times noise and model error")
        }
        (Some((words, (least, apart))), _) if apart > PARTS => format!(
            "{words}: there {of} differs from each of {others} by {apart:.1} times noise and model error or more, least from {}",
            names.get(least).map_or("", String::as_str)
        ),
        _ => format!(
            "no other place of hammer or sensor and no mass beside it parts {of} and {others} clearly: hit more places, and each more often"
        ),
    }
}

/// Another place of hammer or sensor, or a mass beside the sensor.
fn proposals(predictor: &Predictor) -> Vec<Proposal> {
    let piece = predictor.piece();
    let Some(record) = predictor.comparison.measured.records.first() else { return vec![] };
    let (force_at, response_at) = (record.force_at, record.response_at);
    let added_mass = ADDED * piece.mass();
    let mut proposals = vec![Proposal {
        words: format!("repeat the test with {:.0} g more at the sensor", 1e3 * added_mass),
        force_at,
        response_at,
        added_mass,
    }];
    // Places that a tester can find again: whole centimetres.
    let net = |size: f64, count: usize| -> Vec<f64> {
        let part = |step: usize| 0.96 * step as f64 / (count - 1) as f64 - 0.48;
        (0..count).map(|step| (100.0 * size * part(step)).round() / 100.0).collect()
    };
    let places: Vec<Place> = match predictor.structure {
        StructureKind::TimoshenkoBeam => {
            net(piece.length, PLACES).into_iter().map(|x| Place { x, ..force_at }).collect()
        }
        StructureKind::MindlinPlate => {
            let across = net(piece.width, PLACES_EACH_WAY);
            let along = net(piece.length, PLACES_EACH_WAY).into_iter();
            along.flat_map(|x| across.iter().map(move |&y| Place { x, y })).collect()
        }
    };
    let said = |at: Place, digits: usize| match predictor.structure {
        StructureKind::TimoshenkoBeam => format!("x = {:.digits$} m", at.x),
        StructureKind::MindlinPlate => format!("x = {:.digits$}, y = {:.digits$} m", at.x, at.y),
    };
    for at in places {
        proposals.push(Proposal {
            words: format!("hit at {}, with the sensor where it is", said(at, 2)),
            force_at: at,
            response_at,
            added_mass: 0.0,
        });
        let sensor_at =
            if predictor.structure == StructureKind::TimoshenkoBeam { Place { y: response_at.y, ..at } } else { at };
        proposals.push(Proposal {
            words: format!("move the sensor to {}, and hit at {}", said(sensor_at, 2), said(force_at, 3)),
            force_at,
            response_at: sensor_at,
            added_mass: 0.0,
        });
    }
    let on_piece = |place: Place| piece.contains(place).is_ok();
    proposals.retain(|proposal| on_piece(proposal.force_at) && on_piece(proposal.response_at));
    proposals
}

/// A record that was not taken, as sure as the first of those that were.
struct Further<'a> {
    of: &'a Predictor<'a>,
    panel: &'a ModifiedPanel,
    measured: MeasuredModes,
    added_mass: f64,
}

impl<'a> Further<'a> {
    fn new((of, panel): (&'a Predictor<'a>, &'a ModifiedPanel), proposal: &Proposal) -> Option<Self> {
        let taken = of.comparison.measured;
        let first = taken.records.first()?;
        let record = MeasuredRecord {
            force_at: proposal.force_at,
            response_at: proposal.response_at,
            // Their sizes are the scales of the test.
            residues: of.comparison.residue.iter().map(|&size| num_complex::Complex64::new(0.0, size)).collect(),
            remainder: first.remainder.clone(),
        };
        let of_poles = taken.values().len() - taken.records.len() * 2 * (first.residues.len() + first.remainder.len());
        let size = of_poles + 2 * (first.residues.len() + first.remainder.len());
        let measured = MeasuredModes {
            records: vec![record],
            covariance: Mat::from_fn(size, size, |i, j| taken.covariance[(i, j)]),
            ..taken.clone()
        };
        Some(Self { of, panel, measured, added_mass: proposal.added_mass })
    }

    /// $\sqrt{d^TC^{-1}d}$ of the difference $d$ of what two hypotheses predict; `None` where one predicts nothing.
    ///
    /// # Errors
    /// What the model refuses.
    fn difference(&self, one: &Judged, other: &Judged) -> Result<Option<f64>, ModelError> {
        let comparison = Comparison::new(&self.measured, self.of.piece().mass());
        let mut setting = self.of.setting(0);
        setting.record = RecordSetting { response_at: Some(self.measured.records[0].response_at), ..setting.record };
        let mut predictor = Predictor::on(self.panel.clone(), &comparison, (self.of.structure, &setting));
        let mut predicted = |judged: &Judged| -> Result<_, ModelError> {
            // Its residues are no more than sizes.
            predictor.told_partners = Some(self.of.partners_of(judged.posterior.point.at.first()));
            let (constants, effects) =
                (judged.hypothesis.constants_of(self.measured.piece, &judged.posterior.point.z), self.effects(judged)?);
            Ok((predictor.at(&constants, &effects, true)?, constants, effects))
        };
        let (other, ..) = predicted(other)?;
        let (at, constants, effects) = predicted(one)?;
        let uneven = waves(&predictor, &constants, &effects)?;
        let errors = ErrorColumns::about(&predictor, &at, &uneven);
        let by = errors.whitening((&comparison.noise, None), &one.posterior.log_sizes, &[]);
        let apart: Vec<f64> = at.values.iter().zip(&other.values).map(|(one, other)| one - other).collect();
        Ok(by.map(|by| by.whitened(&apart).iter().map(|value| value * value).sum::<f64>().sqrt()))
    }

    /// The effects that are not of one record alone.
    fn effects(&self, judged: &Judged) -> Result<Vec<EffectState>, ModelError> {
        let (hypothesis, z) = (&judged.hypothesis, &judged.posterior.point.z);
        let mut states = Vec::new();
        for (part, z) in hypothesis.parts.iter().zip(hypothesis.of_parts(z)) {
            let of_one = part.effect.parameters().iter().any(|p| p.each_record || p.scale == Scale::Index);
            if !of_one {
                states.push(EffectState::new(part.effect, part.values(z), 1)?);
            }
        }
        if self.added_mass > 0.0 {
            let sensor = sensor_with(self.added_mass, &mut states)?;
            states.push(sensor);
        }
        Ok(states)
    }
}

/// A sensor heavier by this mass \[kg\], in the place of one that is on.
pub(super) fn sensor_with(mass: f64, states: &mut Vec<EffectState>) -> Result<EffectState, ModelError> {
    let sensor = effect(SENSOR_MASS)?;
    let before = states.iter().position(|state| state.effect.id() == sensor.id()).map(|index| states.remove(index));
    let mut values = before.map_or_else(|| vec![0.0; sensor.parameters().len()], |state| state.values);
    values.first_mut().into_iter().for_each(|first| *first += mass);
    EffectState::new(sensor, values, 1)
}
