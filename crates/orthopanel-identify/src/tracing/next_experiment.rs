//! The one further measurement that would part the hypotheses best, worked out from their models.

use num_complex::Complex64;
use orthopanel_data::ImpactTest;
use orthopanel_model::{Effect, EffectState, ModelError, Place, ReceptanceSetup, RecordSetting, Scale, effect};

use super::fit::Fit;
use super::hypothesis::CUBIC;
use super::outcome::Verdict;
use super::ranking::{Ranking, Search};
use super::reactions::cubic;
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
        (_, Some(rival)) => {
            let rival = &ranking.fits[rival];
            let sureness = if rivals.is_empty() { "to be surer still: " } else { "" };
            let level_tells = [chosen, rival].iter().any(|fit| cubic(&fit.state.hypothesis, 0).is_some());
            let proposal =
                if level_tells { harder(search, chosen, rival) } else { parting(test, search, chosen, rival) };
            format!("{sureness}{proposal}")
        }
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

/// A hit of another strength: what is linear answers to it alike.
///
/// The motion under hits `HARDER` times as hard on springs $k_3w^3$ is that under these hits on springs $c^2k_3$, times c.
fn harder(search: &Search, chosen: &Fit, rival: &Fit) -> String {
    let problem = search.records.problem(1);
    let lines = |fit: &Fit| {
        let mut state = fit.state.clone();
        let springs = state.hypothesis.effects.iter_mut().filter(|on| on.effect.id() == CUBIC);
        springs.flat_map(|on| on.values.first_mut()).for_each(|k3| *k3 *= HARDER * HARDER);
        problem.lines(&state)
    };
    let pair = format!("{} and {}", name(chosen, search.declared()), name(rival, search.declared()));
    let (Ok(one), Ok(other)) = (lines(chosen), lines(rival)) else {
        return format!("{pair} cannot be compared by harder hits");
    };
    let (mut apart, mut count) = (0.0, 0_usize);
    for ((one, other), record) in one.iter().zip(&other).zip(problem.records) {
        let pairs = one.iter().zip(other).zip(&record.variance);
        apart += pairs.map(|((a, b), variance)| HARDER * HARDER * (a - b).norm_sqr() / variance).sum::<f64>();
        count += record.s.len();
    }
    let difference = (apart / count.max(1) as f64).sqrt();
    format!(
        "hit {HARDER:.0} times as hard, at the same places: there {pair} differ by {difference:.1} times the noise (rms over \
         the lines)"
    )
}

/// How much harder.
const HARDER: f64 = 2.0;

fn parting(test: &ImpactTest, search: &Search, chosen: &Fit, rival: &Fit) -> String {
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
    format!("{}: there {pair} differ by {difference:.1} times the noise (rms over the lines)", best.words)
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
        let model = setup.model(&fit.state.constants.map(f64::exp), &fit.state.damping(), &states)?;
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
