//! The one further measurement that would part the hypotheses best, worked out from their models.

use num_complex::Complex64;
use orthopanel_data::ImpactTest;
use orthopanel_model::{
    Damping, Effect, EffectState, ModelError, Place, ReceptanceSetup, RecordSetting, Scale, effect,
};

use super::fit::Fit;
use super::outcome::Verdict;
use super::ranking::{Ranking, Search};
use super::report::name;

/// Places tried along the piece.
const PLACES: usize = 17;
/// Mass that a tester has at hand, in parts of the piece's \[1\].
const ADDED: f64 = 0.01;

/// What to measure next, in words, with the difference that the hypotheses then show over the noise.
pub(super) fn next_experiment(
    test: &ImpactTest,
    search: &Search,
    ranking: &Ranking,
    verdict: Verdict,
    rivals: &[usize],
) -> String {
    let chosen = &ranking.fits[ranking.chosen];
    let nearest = ranking.nearest();
    match (verdict, rivals.first().copied().or(nearest)) {
        (Verdict::NothingMissing, _) => "none: the base model meets the records within their noise".to_owned(),
        (_, Some(rival)) => parting(test, search, chosen, &ranking.fits[rival], rivals.is_empty()),
        (_, None) => "none: no other effect of the catalogue can be compared".to_owned(),
    }
}

/// A further measurement.
struct Proposal {
    words: String,
    force_at: Place,
    response_at: Place,
    added_mass: f64,
}

fn parting(test: &ImpactTest, search: &Search, chosen: &Fit, rival: &Fit, sure: bool) -> String {
    let Some(record) = search.records.problem(0).records.first() else { return String::new() };
    let (force, response) = (record.force_at, record.response_at);
    let added = ADDED * search.piece.mass();
    let mut proposals = vec![Proposal {
        words: format!("repeat the test with {:.0} g more at the sensor", 1e3 * added),
        force_at: force,
        response_at: response,
        added_mass: added,
    }];
    for step in 0..PLACES {
        let x = search.piece.length * (0.96 * step as f64 / (PLACES - 1) as f64 - 0.48);
        // Places that a tester can find again: whole centimetres.
        let place = Place { x: (100.0 * x).round() / 100.0, y: 0.0 };
        if search.piece.contains(place).is_err() {
            continue;
        }
        let hit = format!("hit at x = {:.2} m, with the sensor where it is", place.x);
        let moved = format!("move the sensor to x = {:.2} m, and hit at x = {:.3} m", place.x, force.x);
        proposals.push(Proposal { words: hit, force_at: place, response_at: response, added_mass: 0.0 });
        proposals.push(Proposal { words: moved, force_at: force, response_at: place, added_mass: 0.0 });
    }
    let shown = proposals.iter().filter_map(|proposal| {
        let difference = difference(test, search, chosen, rival, proposal).ok()?;
        difference.is_finite().then_some((difference, proposal))
    });
    let Some((difference, best)) = shown.max_by(|a, b| a.0.total_cmp(&b.0)) else {
        return format!(
            "{} and {} cannot be compared by another place or mass",
            name(chosen, search.declared()),
            name(rival, search.declared())
        );
    };
    let pair = format!("{} and {}", name(chosen, search.declared()), name(rival, search.declared()));
    let sureness = if sure { "to be surer still: " } else { "" };
    format!("{sureness}{}: there {pair} differ by {difference:.1} times the noise (rms over the lines)", best.words)
}

/// Rms difference of two hypotheses over the noise in a further record, noise being that of the first one.
fn difference(
    test: &ImpactTest,
    search: &Search,
    chosen: &Fit,
    rival: &Fit,
    proposal: &Proposal,
) -> Result<f64, ModelError> {
    let problem = search.records.problem(1);
    let Some(record) = problem.records.first() else { return Ok(f64::NAN) };
    let setting = RecordSetting {
        force_at: Some(proposal.force_at),
        response_at: Some(proposal.response_at),
        ..RecordSetting::default()
    };
    let summed = search.records.summed;
    let setup = ReceptanceSetup::new(&search.piece, test.boundary, &test.suspension, &[setting], summed)?;
    let lines = |fit: &Fit| -> Result<Vec<Complex64>, ModelError> {
        let mut states = Vec::new();
        for on in &fit.state.hypothesis.effects {
            let of_one_record = on.effect.parameters().iter().any(|p| p.each_record || p.scale == Scale::Index);
            if !of_one_record {
                states.push(EffectState::new(on.effect, on.values.clone(), 1)?);
            }
        }
        if proposal.added_mass > 0.0 {
            let sensor = with_mass(&mut states, proposal.added_mass)?;
            states.push(sensor);
        }
        let ratios = fit.state.zetas.iter().map(|log| log.exp()).collect();
        let damping = Damping { ratios, beyond: problem.usual_log_zeta.exp() };
        let model = setup.model(&fit.state.constants.map(f64::exp), &damping, &states)?;
        let Some(mut evaluator) = model.evaluator(0) else { return Ok(vec![]) };
        let mut lines = Vec::with_capacity(record.s.len());
        evaluator.lines(&record.s, |_, value, _| lines.push(value));
        Ok(lines)
    };
    let (one, other) = (lines(chosen)?, lines(rival)?);
    let apart = one.iter().zip(&other).zip(&record.variance).map(|((a, b), variance)| (a - b).norm_sqr() / variance);
    Ok((apart.sum::<f64>() / record.s.len().max(1) as f64).sqrt())
}

/// A sensor heavier by `mass`, taking the place of one that is on.
fn with_mass(states: &mut Vec<EffectState>, mass: f64) -> Result<EffectState, ModelError> {
    let sensor: &'static dyn Effect = effect("sensor-mass")?;
    let before = states.iter().position(|state| state.effect.id() == sensor.id()).map(|index| states.remove(index));
    let mut values = before.map_or_else(|| vec![0.0; sensor.parameters().len()], |state| state.values);
    if let Some(first) = values.first_mut() {
        *first += mass;
    }
    EffectState::new(sensor, values, 1)
}
