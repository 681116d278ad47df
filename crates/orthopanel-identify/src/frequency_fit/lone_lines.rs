//! Lines of a list on which a constant rests alone: whatever their names, some value of the constant meets them.

use faer::Mat;
use orthopanel_data::ImpactTest;

use super::problem::FrequencyProblem;
use super::uncertainty::leverage;
use crate::least_squares::Linearised;
use crate::structures::Shown;

/// A line that the others would put so much elsewhere \[1\] is checked by none of them.
const FAR_ELSEWHERE: f64 = 0.05;

/// A sentence for each line of a plate's list that the others say nothing about, with the constant that it alone tells.
///
/// Without line $i$ the fit misses it by $r_i/(1-h_i)$ ([`super::uncertainty::left_one_out_percent`]), and with the line's row $a$ of the
/// Jacobian the variance of constant $j$ is $C_{jj} + (Ca)_j^2/(1-h_i)$ in place of $C_{jj}$: the one that grows most is named.
pub(super) fn lone_lines(test: &ImpactTest, problem: &FrequencyProblem, at: &Linearised) -> Vec<String> {
    let free = problem.constants.count();
    // Where every constant rests, none rests on a line.
    if problem.structure.shown() == Shown::Wholly || free == 0 || problem.count() <= free {
        return Vec::new();
    }
    let Some(covariance) = at.quadratic().covariance() else { return Vec::new() };
    let lines = problem.sets.iter().flat_map(|set| {
        let piece = &test.pieces[set.piece].name;
        set.measured.iter().zip(set.modes.nodes()).map(move |(measured, nodes)| (piece, measured, nodes))
    });
    let mut notes = Vec::new();
    for (index, (piece, measured, nodes)) in lines.enumerate() {
        let left = (1.0 - leverage(at, &covariance, index)).max(f64::EPSILON);
        if at.residuals[index].abs() < FAR_ELSEWHERE * left {
            continue;
        }
        let constant = problem.constants.constant(most_grown(at, &covariance, index)).name;
        notes.push(format!(
            "piece {piece}, {measured} Hz named {nodes:?}: {constant} rests on this line alone, so that no other would show a wrong \
             name; look at this mode's shape again"
        ));
    }
    notes
}

/// The parameter whose variance grows by the greatest factor without the line.
fn most_grown(at: &Linearised, covariance: &Mat<f64>, line: usize) -> usize {
    let free = covariance.nrows();
    let growth = |j: usize| {
        let along: f64 = (0..free).map(|k| covariance[(j, k)] * at.jacobian[(line, k)]).sum();
        along * along / covariance[(j, j)]
    };
    (0..free).max_by(|a, b| growth(*a).total_cmp(&growth(*b))).unwrap_or_default()
}
