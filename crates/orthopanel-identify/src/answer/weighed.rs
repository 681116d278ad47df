//! What is said of the hypotheses of a test, whatever was measured.

use std::f64::consts::TAU;

use orthopanel_data::ImpactTest;
use orthopanel_model::{Piece, Readable};

use crate::IdentifyError;
use crate::hypothesis::Role;
use crate::judge::{judged, not_modal, without_mode};
use crate::measured::{MeasuredModes, Pole};
use crate::outcome::Verdict;
use crate::posterior::Judged;
use crate::search::Inquiry;

use super::bounds::{notes_on_bound, notes_on_prior_alone};
use super::doubt::{Doubt, doubts, notes_on_not_shown};
use super::estimates::{Estimates, id};

/// The hypothesis that is chosen, and what stands beside it.
pub(super) struct Weighed<'a> {
    pub chosen: &'a Judged,
    /// With nothing missing.
    pub base: &'a Judged,
    pub verdict: Verdict,
    /// Where that is ambiguous, the hypotheses that are not clearly behind; of nothing missing, those that are ahead of it.
    pub near: Vec<&'a Judged>,
    doubts: Vec<Doubt>,
}

/// Of which piece something is, where a test has several.
fn of_piece(test: &ImpactTest, piece: usize) -> String {
    if test.pieces.len() > 1 { format!(" of piece {}", test.pieces[piece].name) } else { String::new() }
}

/// What is said of a pole that no mode of the model is.
pub(super) fn no_mode(test: &ImpactTest, (piece, pole): &(usize, Pole)) -> String {
    let of = of_piece(test, *piece);
    format!("the resonance at {:.1} Hz{of} is no mode of this model", pole.angular_frequency / TAU)
}

/// What is said of records that poles and noise do not make.
pub(super) fn no_resonance(test: &ImpactTest, measured: &MeasuredModes) -> String {
    let of = of_piece(test, measured.piece);
    let at = measured.missed_most.map_or(String::new(), |at| format!(", most at {at:.1} Hz"));
    format!(
        "the records{of} hold what is neither resonance nor noise{at} (chi-square per datum of the modal fit {:.2}): a tone such as mains hum, a cable \
         that rubs, a force that is not linear",
        Readable(measured.chi_square.unwrap_or(f64::NAN))
    )
}

impl<'a> Weighed<'a> {
    /// # Errors
    /// [`IdentifyError::TooFewResonances`] where there is no hypothesis.
    pub(super) fn of(inquiry: &Inquiry, all: &'a [Judged]) -> Result<Self, IdentifyError> {
        let measured = inquiry.measured();
        let none = IdentifyError::TooFewResonances { found: measured.poles.len(), needed: 2, noise_percent: None };
        let (chosen, verdict, near) = judged(all, &inquiry.stacked).ok_or(none)?;
        let base = all.iter().find(|judged| judged.names().is_empty()).unwrap_or(chosen);
        let mut doubts = doubts(inquiry, base, &all[0]);
        let is_unexplained = verdict == Verdict::Unexplained;
        doubts.retain(|doubt| doubt.is_rival || is_unexplained);
        let verdict = if is_unexplained || doubts.is_empty() { verdict } else { Verdict::Ambiguous };
        Ok(Self { chosen, base, verdict, near, doubts })
    }

    /// A declared number that is to be checked before anything else.
    pub(super) fn check(&self) -> Option<&Doubt> {
        self.doubts.first().filter(|_| self.verdict != Verdict::Unexplained)
    }

    pub(super) fn alternatives(&self) -> Vec<String> {
        let names = self.chosen.names();
        let mut rivals: Vec<&str> = self.near.iter().flat_map(|judged| judged.names()).collect();
        rivals.retain(|name| !names.contains(name));
        rivals.sort_unstable();
        rivals.dedup();
        let doubted = self.doubts.iter().filter(|_| self.verdict != Verdict::Unexplained).map(|doubt| doubt.id);
        doubted.chain(rivals).map(str::to_owned).collect()
    }

    /// The rivals, or else the likeliest other hypothesis that lacks one of the effects.
    pub(super) fn nearest(&self, all: &'a [Judged]) -> Vec<&'a Judged> {
        if !self.near.is_empty() {
            return self.near.clone();
        }
        let names = self.chosen.names();
        let is_other = |judged: &&Judged| {
            let own = judged.names();
            !own.is_empty() && names.iter().any(|name| !own.contains(name))
        };
        all.iter().find(is_other).into_iter().collect()
    }

    pub(super) fn notes(&self, inquiry: &Inquiry, test: &ImpactTest, estimates: &Estimates) -> Vec<String> {
        let measured = inquiry.measured();
        let is_no_mode =
            |of: (usize, Pole)| format!("{}: something swings there that it does not hold", no_mode(test, &of));
        let mut notes: Vec<String> = without_mode(self.chosen, &inquiry.stacked).into_iter().map(is_no_mode).collect();
        notes.extend(not_modal(self.chosen, &inquiry.stacked).map(|measured| no_resonance(test, measured)));
        notes.extend(self.doubts.iter().map(|doubt| doubt.sentence.clone()));
        notes.extend(self.near.iter().map(|rival| self.standing(rival)));
        notes.extend(self.looks_like(&test.pieces[measured.piece].piece));
        notes.extend(notes_on_not_shown(inquiry, self.base));
        notes.extend(notes_on_prior_alone(self.chosen, estimates));
        notes.extend(notes_on_bound(estimates, &test.pieces[measured.piece].piece));
        notes
    }

    /// What in the test file would show the same as what was found, were it wrong.
    fn looks_like(&self, piece: &Piece) -> Vec<String> {
        let Judged { hypothesis, posterior, .. } = self.chosen;
        let parts = hypothesis.parts.iter().zip(hypothesis.of_parts(&posterior.point.z));
        let found = parts.filter(|(part, _)| part.role == Role::Found);
        found.filter_map(|(part, z)| part.effect.looks_like(&part.values(z), piece)).collect()
    }

    fn standing(&self, rival: &Judged) -> String {
        let apart = rival.log_odds - self.chosen.log_odds;
        let (place, odds) = if apart < 0.0 { ("behind", -apart) } else { ("ahead of", apart) };
        format!(
            "{} is {place} {} by {:.1} in the natural logarithm of the odds: these data do not part the two",
            id(rival),
            id(self.chosen),
            Readable(odds)
        )
    }
}
