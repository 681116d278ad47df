//! Where an effect on a plate begins: a net of places.
//!
//! Of a plate's many places the right one stands out by the direction in which an effect there moves the predictions, under the base's own sizes of model
//! error: how much of it there is follows from that to first order. What vibrates by itself is tuned to the most missed pole at all places, and
//! to the others at the best few of these.

use orthopanel_model::Place;
use rayon::prelude::*;

use super::Inquiry;
use super::further_effect::Score;
use crate::hypothesis::Part;
use crate::measured::Pole;
use crate::posterior::{Judged, Point, Problem};

/// Places at which what vibrates by itself is tuned to all of the missed poles.
const TUNED: usize = 9;

/// Places that lie no further apart than this part of a side, one and a half spaces of the net, are beside each other.
const BESIDE: f64 = 0.1;

/// The net about a base.
pub(super) struct NetOnPlate<'a> {
    inquiry: &'a Inquiry<'a>,
    base: &'a Judged,
    missed: &'a [Pole],
    score: Score,
}

impl Inquiry<'_> {
    /// `None` where the base's curvature is singular.
    pub(super) fn net_on_plate<'a>(&'a self, base: &'a Judged, missed: &'a [Pole]) -> Option<NetOnPlate<'a>> {
        Some(NetOnPlate { inquiry: self, base, missed, score: self.score(base)? })
    }
}

impl NetOnPlate<'_> {
    /// The starts of the last part of a hypothesis, each with what it makes good to first order as its cost, negative.
    pub(super) fn starts(&self, problem: &Problem) -> Vec<Point> {
        let Some(part) = problem.hypothesis.parts.last() else { return vec![] };
        let tuned = |poles: &[Pole], mass: f64, at: Place| self.inquiry.tuned(self.base, poles, mass, at);
        let first = self.missed.get(..1).unwrap_or_default();
        let starts = part.starts(|mass, at| tuned(first, mass, at));
        // Much of an effect is not what a little of it is, many times over.
        let much = if self.inquiry.is_led_away(self.base) { part.with_much(&starts) } else { vec![] };
        let mut coarse = [self.scored(problem, starts), self.as_they_are(problem, much)].concat();
        coarse.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        let own = self.base.posterior.point.z.len();
        if !part.is_tuned() {
            return self.peaks(part, coarse);
        }
        let mut places: Vec<Place> = Vec::new();
        for point in &coarse {
            let place = part.place(&point.z[own..]).filter(|place| !places.contains(place));
            places.extend(place.filter(|_| places.len() < TUNED));
        }
        let others = self.missed.get(1..).unwrap_or_default();
        let at_places = part.starts(|mass, at| if places.contains(&at) { tuned(others, mass, at) } else { vec![] });
        coarse.extend(self.scored(problem, at_places));
        coarse
    }

    /// Of starts, the best first, those that no better one lies beside: one peak of the score is one place.
    fn peaks(&self, part: &Part, starts: Vec<Point>) -> Vec<Point> {
        let own = self.base.posterior.point.z.len();
        let piece = self.inquiry.predictor().piece();
        let sides = [piece.length, piece.width].map(|side| BESIDE * side);
        let mut peaks: Vec<(Option<Place>, Point)> = Vec::new();
        for start in starts {
            let place = part.place(&start.z[own..]);
            let beside = |(other, _): &(Option<Place>, Point)| match (place, *other) {
                (Some(a), Some(b)) => (a.x - b.x).abs() < sides[0] && (a.y - b.y).abs() < sides[1],
                _ => false,
            };
            if !peaks.iter().any(beside) {
                peaks.push((place, start));
            }
        }
        peaks.into_iter().map(|(_, start)| start).collect()
    }

    fn as_they_are(&self, problem: &Problem, starts: Vec<Vec<f64>>) -> Vec<Point> {
        let at_base = &self.base.posterior.point;
        let scored = |start: Vec<f64>| {
            let point = problem.unjudged([&at_base.z[..], &start].concat())?;
            let is_alike = point.at.hangs_as(&at_base.at);
            is_alike.then(|| Point { cost: -self.score.there(&at_base.at.values, &point.at.values), ..point })
        };
        starts.into_par_iter().filter_map(scored).collect()
    }

    fn scored(&self, problem: &Problem, starts: Vec<Vec<f64>>) -> Vec<Point> {
        let at_base = &self.base.posterior.point;
        let own = at_base.z.len();
        let scored = |start: Vec<f64>| {
            let mut point = problem.unjudged([&at_base.z[..], &start].concat())?;
            // Motions of the piece as a whole have errors of their own: how far these are met is not told by a direction.
            if !point.at.hangs_as(&at_base.at) {
                return Some(Point { cost: f64::NEG_INFINITY, ..point });
            }
            let (gain, share) = self.score.towards(&at_base.at.values, &point.at.values)?;
            let part = problem.hypothesis.parts.last()?;
            part.scale(&mut point.z[own..], share);
            Some(Point { cost: -gain, ..point })
        };
        starts.into_par_iter().filter_map(scored).collect()
    }
}
