//! What the fits of the lists mean.

use std::collections::BTreeMap;

use orthopanel_data::ImpactTest;
use orthopanel_model::{Damping, Estimate, MODEL_SCHEMA, Owner, PanelModel, Ports, StructureKind, effect};

use super::DATA_FOR_EACH;
use super::bounds;
use super::hypothesis::PLATE;
use super::lacking::{self, what_to_check};
use super::list_fit::ListFit;
use super::list_problem::ListProblem;
use super::parting::next_experiment;
use super::pieces_that_differ::in_place_of_the_plate;
use super::traced_effects::effects_of;
use super::trust::Trust;
use super::verdict::{CLEAR, Choice};
use super::width::as_plate;
use crate::IdentifyError;
use crate::outcome::{
    Candidate, FittedError, NotTested, Removed, TracedEffect, TracedError, TracedParameter, Tracing, Verdict,
};

const UNTOLD: &str = "no list of frequencies tells its scatter: the criterion takes it from the residuals themselves, and a margin of 10 is clear";
const UNMEASURED: &str =
    "no noise is told either: the noise floor here is what the chosen fit leaves, and judges nothing";
const MIRRORED: &str = "frequencies of a piece held alike at both ends are the same with an effect at x and at -x: places are given \
                        with x > 0, and a record of hits at one end tells the side";
const TOLD: &str =
    "the criterion weighs each frequency by the scatter that the test file tells, and a margin of 10 is clear";

pub(super) fn report(
    test: &ImpactTest,
    problem: &ListProblem,
    fits: Vec<ListFit>,
    (not_tested, wants_more): (Vec<NotTested>, Vec<(&'static str, usize)>),
    declared: usize,
) -> Result<Tracing, IdentifyError> {
    let mut order: Vec<usize> = (0..fits.len()).collect();
    // Where two fit alike to a unit of the criterion, the effect of fewer parameters comes first.
    let parameters = |index: usize| fits[index].hypothesis.effects.iter().map(|on| on.held_or_free()).sum::<usize>();
    order.sort_by(|&a, &b| {
        let alike = |index: usize| (fits[index].bic().round(), parameters(index), index);
        let ((bic_a, size_a, at_a), (bic_b, size_b, at_b)) = (alike(a), alike(b));
        bic_a.total_cmp(&bic_b).then(size_a.cmp(&size_b)).then(at_a.cmp(&at_b))
    });
    let best = order.first().copied().unwrap_or(0);
    let pays = fits[0].bic() - fits[best].bic() > CLEAR && fits[best].left_out_percent() < fits[0].left_out_percent();
    let chosen = if pays { best } else { 0 };
    let rivals: Vec<usize> = order
        .iter()
        .copied()
        .filter(|&index| index != 0 && index != chosen && chosen != 0 && fits[index].bic() < fits[chosen].bic() + CLEAR)
        .collect();
    let trust = Trust::of(problem);
    let on_bound = bounds::on_bound(&fits[chosen].hypothesis, declared, &problem.largest_piece());
    let choice = Choice { chosen, rivals, on_bound, wants_more };
    let verdict = choice.verdict(&fits, &trust);
    let told = problem.scatter();
    let floor = problem.noise().map(|noise| rms(&noise));
    let error = |fit: &ListFit| FittedError { fitted: fit.percent(), held_out: fit.left_out_percent() };
    let candidate = |&index: &usize| {
        let fit = &fits[index];
        let effects = traced(problem, fit, declared);
        Candidate::by_criterion(name(fit, index == 0, declared), fit.bic(), fit.left_out_percent(), effects)
    };
    let too_few = verdict == Verdict::Ambiguous && chosen == 0;
    let untested = verdict == Verdict::Ambiguous && (too_few || choice.leaves_room(&fits[chosen], &trust));
    let rivals = choice.rivals.iter().map(|&index| name(&fits[index], false, declared));
    let alternatives =
        rivals.chain(choice.wants_more.iter().filter(|_| untested).map(|(id, _)| (*id).to_owned())).collect();
    let next_experiment = match verdict {
        Verdict::Unexplained => what_to_check(test, problem, &fits[chosen], &trust),
        _ if too_few => lacking::too_few(problem, DATA_FOR_EACH, fits[0].hypothesis.size(), 1),
        Verdict::Ambiguous if choice.rivals.is_empty() => {
            let least = choice.wants_more.iter().map(|(_, free)| *free).min().unwrap_or(1);
            lacking::too_few(problem, DATA_FOR_EACH, fits[0].hypothesis.size(), least)
        }
        _ => next_experiment(problem, &fits, chosen, &choice.rivals, &order),
    };
    let mut notes = vec![if told.is_some() { TOLD } else { UNTOLD }.to_owned()];
    if floor.is_none() {
        notes.push(UNMEASURED.to_owned());
    }
    notes.push(trust.note());
    if choice.rivals.iter().chain([&chosen]).any(|&index| fits[index].mirrored) {
        notes.push(MIRRORED.to_owned());
    }
    notes.extend(choice.rivals.iter().chain([&chosen]).filter_map(|&index| elsewhere(&fits[index])));
    let plate = fits[chosen].plate.as_ref();
    notes.extend(plate.and_then(|plate| in_place_of_the_plate(&as_plate(test), plate)));
    if let Some(parameter) = &choice.on_bound {
        notes.push(bounds::note(parameter));
    }
    // The chosen one, then the others by the criterion.
    let mut ranked = order.clone();
    ranked.sort_by(|&a, &b| (a != chosen).cmp(&(b != chosen)).then(fits[a].bic().total_cmp(&fits[b].bic())));
    let mut panels = panels(test, problem, &fits[chosen]);
    let removed = take_out(problem, &fits[chosen], declared, &mut panels);
    Ok(Tracing {
        verdict,
        effects: if chosen == 0 { vec![] } else { traced(problem, &fits[chosen], declared) },
        alternatives,
        error: TracedError {
            measure: "natural frequencies, % rms; held out: each predicted from the others".to_owned(),
            before: error(&fits[0]),
            after: error(&fits[chosen]),
            noise_floor: 100.0 * floor.unwrap_or_else(|| fits[chosen].scatter()),
        },
        model_error: None,
        candidates: ranked.iter().map(candidate).collect(),
        not_tested,
        next_experiment,
        chi_square: match trust {
            Trust::Told(_) => trust.chi_square(&fits[chosen]),
            // Noise is then taken from what is left, up to what is usual.
            Trust::Untold(_) => trust.chi_square(&fits[chosen]).max(1.0),
        },
        panels,
        removed,
        accelerances: vec![],
        base_accelerances: vec![],
        notes,
    })
}

/// Of an effect that does as well at other places.
fn elsewhere(fit: &ListFit) -> Option<String> {
    let ((from, to), on) = (fit.reaches?, fit.hypothesis.effects.last()?);
    Some(format!(
        "{} meets these frequencies as well at other places from x = {from:.2} to {to:.2} m: the intervals of all its parameters reach \
         over these",
        on.effect.id()
    ))
}

pub(super) fn rms(told: &[f64]) -> f64 {
    (told.iter().map(|std| std * std).sum::<f64>() / told.len().max(1) as f64).sqrt()
}

pub(super) fn name(fit: &ListFit, is_base: bool, declared: usize) -> String {
    let ids: Vec<&str> = fit.hypothesis.effects.iter().skip(declared).map(|on| on.effect.id()).collect();
    match (is_base, fit.plate.is_some()) {
        (true, _) => "base".to_owned(),
        (_, true) => PLATE.to_owned(),
        _ => ids.join(" + "),
    }
}

fn traced(problem: &ListProblem, fit: &ListFit, declared: usize) -> Vec<TracedEffect> {
    let Some(plate) = &fit.plate else {
        let std: Vec<Option<f64>> =
            fit.std.iter().skip(problem.constants.count()).map(|std| std.is_finite().then_some(*std)).collect();
        let mut effects = effects_of(&fit.hypothesis, &std);
        return effects.split_off(declared.min(effects.len()));
    };
    let value =
        |name: &str| plate.constants.iter().find(|constant| constant.name == name).map(|constant| constant.value);
    let ratio = |above: &str, below: &str| value(above).zip(value(below)).map(|(above, below)| above / below);
    let found = [
        ("e_y_ratio", ratio("e_y", "e_x")),
        ("nu_xy", value("nu_xy")),
        ("g_xy_ratio", ratio("g_xy", "e_x")),
        ("g_yz_ratio", ratio("g_yz", "g_zx")),
    ];
    let std = plate.constants.iter().find(|constant| constant.name == "nu_xy").and_then(|constant| constant.std);
    let parameters = found.into_iter().filter_map(|(name, value)| {
        let std = if name == "nu_xy" { std } else { None };
        Some(TracedParameter { name, unit: "1", values: vec![Estimate { value: value?, std }] })
    });
    vec![TracedEffect { id: PLATE, owner: Owner::Panel, parameters: parameters.collect() }]
}

/// A model of each piece, without effects; damping is not told by frequencies.
fn panels(test: &ImpactTest, problem: &ListProblem, fit: &ListFit) -> Vec<PanelModel> {
    let ports = || Ports { forces: vec![], responses: vec![] };
    if let Some(plate) = &fit.plate {
        return plate.pieces.iter().map(|piece| plate.panel_model(piece, test.boundary, ports())).collect();
    }
    let free = problem.constants.count();
    let of_piece = |(index, named): (usize, &orthopanel_data::NamedPiece)| {
        let values = problem.constants.values(fit.parameters.get(..free).unwrap_or_default(), index);
        let parameters = problem.constants.parameters_of(index);
        let mut constants = BTreeMap::new();
        for (at, constant) in problem.constants.constants.iter().enumerate() {
            let log = parameters.get(at).copied().flatten().and_then(|parameter| fit.std.get(parameter));
            let std = log.filter(|std| std.is_finite()).map(|std| std * problem.constants.slope(at, values[at]));
            constants.insert(constant.name.to_owned(), Estimate { value: values[at], std });
        }
        PanelModel {
            name: None,
            schema: MODEL_SCHEMA.to_owned(),
            piece: named.piece,
            boundary: test.boundary,
            structure: StructureKind::TimoshenkoBeam,
            constants,
            damping: Damping { ratios: vec![], beyond: 0.0 },
            effects: vec![],
            ports: ports(),
            provenance: BTreeMap::new(),
        }
    };
    test.pieces.iter().enumerate().map(of_piece).collect()
}

fn take_out(problem: &ListProblem, fit: &ListFit, declared: usize, panels: &mut [PanelModel]) -> Vec<Removed> {
    if fit.plate.is_some() {
        return vec![];
    }
    let mut removed = Vec::new();
    for (index, found) in traced(problem, fit, 0).into_iter().enumerate() {
        if effect(found.id).is_ok_and(|effect| effect.owner() != Owner::Panel) {
            removed.push(Removed::of(&found, index < declared));
            continue;
        }
        for panel in &mut *panels {
            panel.effects.push(found.entry());
        }
    }
    removed
}
