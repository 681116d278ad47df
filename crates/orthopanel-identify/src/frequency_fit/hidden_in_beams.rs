//! A constant of beams that their lists do not show: the shear modulus of a thin strip, say.

use orthopanel_data::ImpactTest;

use super::hidden_constants::{carried, worst_hidden};
use super::likeliest_reading::variances_of;
use super::minimum::{Minimum, minimise};
use super::problem::FrequencyProblem;
use super::reading_evidence::weighed;
use super::unseen_constants::reports;
use crate::free_constants::Rest;
use crate::{IdentifyError, NotIdentified, Search};

/// The minimum that was `found`, where the lists show all constants; else that without the one which they do not show, and what is said of it.
///
/// It rests beside the first other modulus, at the ratio that is most probable of a panel with these frequencies ([`weighed`]).
pub(super) fn minimum_where_shown(
    test: &ImpactTest,
    problem: &mut FrequencyProblem,
    found: Vec<f64>,
    search: Search,
) -> Result<(Vec<f64>, Vec<NotIdentified>), IdentifyError> {
    let minimum = Minimum { predictions: problem.predictions(&found)?, parameters: found, quick: None };
    let hidden = if problem.count() < problem.constants.count() { None } else { worst_hidden(problem, &minimum) };
    let leads = |constant: &usize| Some(*constant) != hidden && problem.constants.is_modulus(*constant);
    let leader = problem.constants.free_constants().into_iter().find(leads);
    let probable = || weighed(problem, &variances_of(test), &minimum.parameters);
    let Some(((hidden, leader), probable)) = hidden.zip(leader).and_then(|pair| Some((pair, probable()?))) else {
        return Ok((minimum.parameters, vec![]));
    };
    let all = problem.constants.clone();
    let values = all.values(&probable.parameters, problem.sets[0].piece);
    problem.constants.rest(hidden, Rest::Follows { leader, ratio: values[hidden] / values[leader] });
    let start = carried(&all, &probable.parameters, &problem.constants);
    let parameters = minimise(problem, &start, search)?;
    let minimum = Minimum { predictions: problem.predictions(&parameters)?, parameters, quick: None };
    let said = reports(problem, &all, &minimum);
    Ok((minimum.parameters, said))
}
