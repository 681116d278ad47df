//! Where a fit misses the lists, and what to look at.

use orthopanel_data::ImpactTest;

use super::list_fit::ListFit;
use super::list_problem::ListProblem;
use super::trust::Trust;

/// Errors that are written out one by one, at most.
const WRITTEN: usize = 12;
/// By so much of the largest error all errors of one sign must lie on that side.
const ONE_SIDED: f64 = 0.3;

/// How large the miss is, in which mode it is largest, and how it depends on the mode's number.
fn where_it_misses(test: &ImpactTest, problem: &ListProblem, fit: &ListFit, trust: &Trust) -> String {
    let mut errors = fit.residuals.iter();
    let mut largest = (0.0_f64, 0, 0);
    let mut rows: Vec<(usize, Vec<f64>)> = Vec::new();
    for list in &problem.lists {
        let own: Vec<f64> = errors.by_ref().take(list.measured.len()).copied().collect();
        for (mode, &error) in (1..).zip(&own) {
            if error.abs() > largest.0.abs() || largest.1 == 0 {
                largest = (error, mode, list.piece);
            }
        }
        rows.push((list.piece, own));
    }
    let several = test.pieces.len() > 1;
    let of_piece = |piece: usize| {
        if several {
            format!("piece {} ", test.pieces.get(piece).map_or("", |named| &named.name))
        } else {
            String::new()
        }
    };
    let percents = |errors: &[f64]| {
        let written: Vec<String> = errors.iter().take(WRITTEN).map(|error| format!("{:+.2}", 100.0 * error)).collect();
        format!("{}{}", written.join(", "), if errors.len() > WRITTEN { ", ..." } else { "" })
    };
    let (error, mode, piece) = largest;
    let each: Vec<String> =
        rows.iter().map(|(piece, errors)| format!("{}{} %", of_piece(*piece), percents(errors))).collect();
    format!(
        "the model misses the frequencies by {}; most in {}mode {mode} ({:+.2} %, model above measured is +); mode by mode {}{}",
        trust.said(fit),
        of_piece(piece),
        100.0 * error,
        each.join("; "),
        course(&fit.residuals, several).map_or(String::new(), |words| format!(": {words}"))
    )
}

/// How the errors go with the mode's number, where that is plain.
fn course(errors: &[f64], several: bool) -> Option<&'static str> {
    let most = errors.iter().fold(0.0_f64, |most, error| most.max(error.abs()));
    let one_sided = |sign: f64| errors.iter().all(|error| sign * error > ONE_SIDED * most);
    if one_sided(1.0) || one_sided(-1.0) {
        return Some("all of one sign, as by a wrong size, mass or held constant");
    }
    let changes = errors.windows(2).filter(|pair| pair[0] * pair[1] < 0.0).count();
    match (several, errors.len(), changes) {
        (false, 4.., 0..=2) => {
            Some("a smooth course over the modes, as by a wrong boundary or a mass or loss over the whole length")
        }
        (false, 4.., _) => {
            Some("they jump from mode to mode, as by something at one place, a mode left out or one too many")
        }
        _ => None,
    }
}

/// What to do where nothing of the catalogue meets the lists.
pub(super) fn what_to_check(test: &ImpactTest, problem: &ListProblem, fit: &ListFit, trust: &Trust) -> String {
    let held = if test.constants.is_empty() { "" } else { " and the constants held" };
    format!(
        "before another measurement check the sizes and units (m, kg/m2){held}, the boundary, and the numbering (flexible modes \
         from 1, none left out or read twice): {}. If all that is right, hit the piece and record it (kind = \"time-history\"): \
         records tell what frequencies alone do not",
        where_it_misses(test, problem, fit, trust)
    )
}

/// What is missing where effects could not be tested, the least of them of so many parameters, beside a base with so many numbers of
/// effects left open.
pub(super) fn too_few(problem: &ListProblem, for_each: usize, open: usize, of_effect: usize) -> String {
    let unknowns = problem.constants.count() + open + of_effect;
    let needed = for_each * unknowns;
    let more = needed.saturating_sub(problem.count()).max(1);
    let (beside, or) = match open {
        0 => (String::new(), String::new()),
        _ => (format!(", {open} numbers of declared effects"), ", or say the numbers of declared effects".to_owned()),
    };
    format!(
        "read {more} more natural frequencies or more: {} for {} constants{beside} and one effect are too few to judge by, {needed} are \
         the least; or hold a constant that you know under [constants]{or}",
        problem.count(),
        problem.constants.count()
    )
}
