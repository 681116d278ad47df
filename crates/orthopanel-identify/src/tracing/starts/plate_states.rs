//! States at which a search goes on with a plate in place of the beam.

use std::sync::OnceLock;

use orthopanel_data::{ImpactTest, TimeHistory};
use orthopanel_model::{Boundary, ModelError, Piece};

use super::Look;
use super::plates::plate_starts;
use super::plates_by_poles::{PlateStart, PlatesByPoles};
use crate::accelerance_fit::ResonanceStart;
use crate::tracing::hypothesis::{Hypothesis, PLATE, Switched};
use crate::tracing::record_problem::State;
use crate::tracing::records_of_test::{FREE_DAMPING, TestRecords};

/// One resonance more than a beam has may be something loose; so many are a plate's.
const STRANGE: usize = 2;

/// What records show of a plate before any is fitted.
pub(in crate::tracing) struct PlateEvidence {
    /// How many of the poles the beam has no mode for.
    strange_poles: usize,
    /// The piece and its edges, where all places lie on a centre line that shows nothing of what is odd across.
    on_centre_line: Option<(Piece, Boundary)>,
    /// What [`PlatesByPoles`] found there, once it was asked.
    by_poles: OnceLock<Vec<PlateStart>>,
}

impl PlateEvidence {
    pub(in crate::tracing) fn of(test: &ImpactTest, histories: &[TimeHistory], start: &ResonanceStart) -> Self {
        let strange_poles = start.poles.len().saturating_sub(start.modes.iter().flatten().count());
        let mut places = histories.iter().flat_map(|history| [history.force_at, history.response_at]);
        let is_even = test.boundary.front == test.boundary.back && places.all(|place| place.y == 0.0);
        let on_centre_line = is_even.then_some((test.pieces[0].piece, test.boundary));
        Self { strange_poles, on_centre_line, by_poles: OnceLock::new() }
    }
}

impl TestRecords {
    /// Whether there are resonances that the beam has no modes for: then its constants are no start for a plate.
    pub(in crate::tracing) fn shows_more_than_a_beam(&self) -> bool {
        self.plates.strange_poles >= STRANGE
    }

    /// Whether a plate is begun from the poles: the search for one is long then.
    pub(super) fn asked_the_poles(&self) -> bool {
        self.shows_more_than_a_beam() || self.plates.by_poles.get().is_some()
    }

    /// States with one more effect, at which a search may begin. A plate has more modes than the beam, and the constants of a beam
    /// that misses its modes are no start for it.
    ///
    /// # Errors
    /// What the model refuses.
    pub(in crate::tracing) fn with(&self, before: &State, switched: Switched) -> Result<Vec<State>, ModelError> {
        let is_plate = switched.effect.id() == PLATE;
        let after = State { hypothesis: before.hypothesis.and(switched), ..before.clone() };
        if !is_plate {
            return Ok(vec![after]);
        }
        let usual = before.constants.map(f64::exp);
        let effects = after.hypothesis.states(self.widened.first().map_or(0, Vec::len))?;
        let starts = if self.shows_more_than_a_beam() {
            plate_starts(&self.setup, &effects, (&self.poles, &self.held), usual[0])?
        } else {
            vec![]
        };
        let as_plate = self.plates_after(before)?;
        let all = starts.into_iter().chain([usual]);
        all.map(|constants| as_plate(constants, after.hypothesis.clone())).collect()
    }

    /// The same of a plate, where the poles alone tell its constants; none where the records show no more than a beam, or where places
    /// or edges show what is odd across. `plate` makes one of ratios.
    pub(super) fn with_plates_by_poles(
        &self,
        before: &State,
        look: Look,
        plate: impl Fn(&[f64; 4]) -> Switched,
    ) -> Vec<State> {
        let Some((piece, boundary)) =
            self.plates.on_centre_line.filter(|_| self.shows_more_than_a_beam() || look == Look::Closest)
        else {
            return vec![];
        };
        let by = PlatesByPoles { piece: &piece, boundary, poles: &self.poles, held: &self.held };
        // Whose constants come first is all the same: the lowest poles say how stiff the whole is.
        let found = self.plates.by_poles.get_or_init(|| by.found(before.constants[0].exp()));
        let Ok(as_plate) = self.plates_after(before) else { return vec![] };
        let state = |(constants, ratios): &PlateStart| as_plate(*constants, before.hypothesis.and(plate(ratios))).ok();
        found.iter().filter_map(state).collect()
    }

    /// Makes plates of constants, each of their modes with the damping of the nearest mode before.
    fn plates_after(
        &self,
        before: &State,
    ) -> Result<impl Fn([f64; 2], Hypothesis) -> Result<State, ModelError>, ModelError> {
        let records = self.widened.first().map_or(0, Vec::len);
        let effects = before.hypothesis.states(records)?;
        let known = self.setup.summed_frequencies(&before.constants.map(f64::exp), &effects)?;
        let damping = move |frequency: f64| {
            let away = |other: &f64| (other / frequency).ln().abs();
            let nearest = (0..known.len()).min_by(|&a, &b| away(&known[a]).total_cmp(&away(&known[b])));
            nearest.and_then(|mode| before.zetas.get(mode)).copied().unwrap_or(self.usual_log_zeta)
        };
        Ok(move |constants: [f64; 2], hypothesis: Hypothesis| {
            let modes = self.setup.summed_frequencies(&constants, &hypothesis.states(records)?)?;
            let own = modes.into_iter().take_while(|&f| f < FREE_DAMPING * self.band).map(&damping);
            let zetas = own.chain(before.zetas.last().copied()).collect();
            Ok(State { constants: constants.map(f64::ln), zetas, hypothesis })
        })
    }
}
