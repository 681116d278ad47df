//! Whether a declared number is wrong: a sensor's mass that the file tells too large comes back as a negative mass of the panel.

use crate::hypothesis::{Hypothesis, Part, Role};
use crate::model_error::medians;
use crate::posterior::{Following, Judged, Point};
use crate::search::{Inquiry, with_one_more};

/// Starts that are followed to the end.
const FOLLOWED: usize = 2;
/// Steps between two looks at the sizes of model error.
const ROUNDS: usize = 4;

impl Inquiry<'_> {
    /// The base with all numbers of one declared effect free, for each that the file holds a number of; with the number of that effect among
    /// those declared. A wrong number is as likely beforehand as one effect that lacks.
    pub(crate) fn doubted(&self, base: &Judged) -> Vec<(usize, Judged)> {
        let declared = base.hypothesis.parts.iter().enumerate().filter(|(_, part)| part.role == Role::Declared);
        declared.filter_map(|(index, part)| Some((index, self.freed(base, (index, part))?))).collect()
    }

    /// The base without each declared effect that the file gives no number of; with the effect's number among its own.
    pub(crate) fn left_out(&self, base: &Judged) -> Vec<(usize, Judged)> {
        let is_open = |part: &Part| part.role == Role::Declared && part.is_open();
        let open = base.hypothesis.parts.iter().enumerate().filter(|(_, part)| is_open(part)).map(|(index, _)| index);
        let without = |index: usize| {
            let (hypothesis, z) = base.hypothesis.without(index, &base.posterior.point.z);
            Some((index, self.best_from(base, hypothesis, vec![z])?))
        };
        open.filter_map(without).collect()
    }

    fn freed(&self, base: &Judged, (index, part): (usize, &Part)) -> Option<Judged> {
        // A number of its own in each record is no single value that could be carried over.
        if part.effect.parameters().iter().any(|parameter| parameter.each_record) {
            return None;
        }
        let records = self.measured().records.len();
        let of_parts = base.hypothesis.of_parts(&base.posterior.point.z);
        let values = part.values(of_parts[index]);
        let before: usize = base.hypothesis.free_constants() + of_parts[..index].iter().map(|z| z.len()).sum::<usize>();
        let (before, after) =
            (&base.posterior.point.z[..before], &base.posterior.point.z[before + of_parts[index].len()..]);
        let ways = Part::ways(part.effect, (self.predictor().piece(), self.predictor().structure), records).into_iter();
        let ways = ways.filter(|way| way.free() > part.free());
        let freed = ways.filter_map(|mut way| {
            way.role = Role::Declared;
            let starts = [vec![way.coordinates_of(&values)], way.starts(|_, _| vec![])].concat();
            let mut hypothesis = base.hypothesis.clone();
            hypothesis.parts[index] = way;
            let starts = starts.into_iter().map(|own| [before, &own[..], after].concat()).collect();
            self.best_from(base, hypothesis, starts)
        });
        freed.max_by(|a, b| a.log_odds.total_cmp(&b.log_odds))
    }

    fn best_from(&self, base: &Judged, hypothesis: Hypothesis, starts: Vec<Vec<f64>>) -> Option<Judged> {
        let problem = self.problem(&hypothesis);
        let of_base = self.problem(&base.hypothesis);
        let errors = of_base.errors(&base.posterior.point.at);
        let by = of_base.whitening(&errors, &medians())?;
        let mut points: Vec<Point> = starts.into_iter().filter_map(|z| problem.point(z, &by)).collect();
        points.sort_by(|a, b| a.misfit.total_cmp(&b.misfit));
        points.truncate(FOLLOWED);
        let ends = points.into_iter().filter_map(|point| {
            let (point, _) = problem.follow(point, &by, Following::to_the_end(8, 0.1))?;
            problem.posterior(point, medians(), ROUNDS)
        });
        let posterior = ends.max_by(|a, b| a.log_evidence.total_cmp(&b.log_evidence))?;
        Some(with_one_more(base, hypothesis, posterior, 1))
    }
}
