//! What every test by hand has beside what it is made for, as numbers with a distribution beforehand.
//!
//! A hammer falls beside its mark, an oblique blow reads a little low, no core is even. All that the hits of a record share of
//! it stands in no scatter between them, so a model without it misses far more than their noise, whatever effect is on. Each
//! hypothesis is therefore given the same small offsets, gains and waves of the core ([`orthopanel_model::roughness`]), each
//! normal about none:
//! $$c = \sum_i\frac{|r_i|^2}{s_i^2} + \sum_j\frac{\theta_j^2}{\sigma_j^2} .$$
//! To first order the least of this over $\theta$ is the misfit under the covariance $S + JPJ^T$ with
//! $P = \text{diag}\,\sigma_j^2$ (Woodbury's identity), but no peak need be so wide that first order holds.

pub(super) mod rest;
pub(super) mod rounds;
pub(super) mod search;

use orthopanel_model::{CORE_WAVES, Piece, roughness};

use super::hypothesis::{FreeParameter, Hypothesis, Switched};
use crate::least_squares::Quadratic;

/// Id of the roughness among the effects of a hypothesis.
pub(super) const ROUGHNESS: &str = "roughness";

/// Standard deviations beforehand, shared by all hypotheses that are compared: were each to take its own, a model without the
/// effect would call the effect rough.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RoughScales {
    /// Of the place where a record's force falls \[m\].
    pub place: f64,
    /// Of a record's gain \[1\].
    pub gain: f64,
    /// Of the core's shear stiffness along the piece \[1\], rms.
    pub core: f64,
}

impl RoughScales {
    /// Where the estimate of the scales begins: a careful test by hand.
    pub(super) const USUAL: Self = Self { place: 1e-3, gain: 5e-3, core: 5e-3 };
    /// More than these no test by hand has: what needs more is no roughness.
    pub(super) const MOST: Self = Self { place: 3e-3, gain: 1e-2, core: 1e-2 };
    /// And so much is what tests by hand are known to have: no estimate goes further, for a loose core takes up what an effect does.
    const KNOWN: Self = Self { core: 6e-3, ..Self::MOST };
    /// Less is none.
    const LEAST: Self = Self { place: 3e-5, gain: 1e-4, core: 1e-4 };

    /// Standard deviation of a parameter of the roughness, by its number.
    pub(super) fn of(&self, parameter: usize) -> f64 {
        match parameter {
            0 => self.place,
            1 => self.gain,
            // The mean square of a cosine is a half.
            _ => self.core * (2.0 / CORE_WAVES as f64).sqrt(),
        }
    }

    /// With the scale of the place no more than [`MARK`] times what the mean of a record's hits scatters by \[m\], and no less
    /// than a third of it. What is further from the mark is an offset of the hammer, to be named.
    pub(super) fn with_hits(self, mean: f64) -> Self {
        let mean = mean.max(Self::LEAST.place);
        Self { place: self.place.clamp(mean / 3.0, MARK * mean), ..self }
    }

    /// Says to people that a test is rough, and how rough.
    pub(super) fn note(&self) -> String {
        let Self { place, gain, core } = self;
        format!(
            "this test is rough: the blows of a record fall {:.1} mm beside their place in the mean, gains of records differ by \
             {:.1} % and the core's shear stiffness by {:.1} % along the piece (standard deviations); every hypothesis was \
             judged beside that",
            1e3 * place,
            1e2 * gain,
            1e2 * core
        )
    }

    /// Whether one of them differs by more than this factor.
    pub(super) fn differ(&self, other: &Self, factor: f64) -> bool {
        let pairs = [(self.place, other.place), (self.gain, other.gain), (self.core, other.core)];
        pairs.iter().any(|(a, b)| (a / b).ln().abs() > factor.ln())
    }

    /// The scales at which what was found is likeliest: $\sigma^2 = \overline{\theta^2 + \text{var}\,\theta}$, one step of
    /// expectation and maximisation, within the bounds of a test by hand. `std` are those of the hypothesis' coordinates.
    pub(super) fn estimated(hypothesis: &Hypothesis, std: &[Option<f64>]) -> Self {
        let mut sums = [(0.0, 0.0_f64); 3];
        for (at, free, value) in free_of(hypothesis) {
            let kind = &mut sums[free.parameter.min(2)];
            kind.0 += value * value + std.get(at).copied().flatten().unwrap_or(0.0).powi(2);
            kind.1 += 1.0;
        }
        let [place, gain, wave] = sums.map(|(sum, count)| (sum / count.max(1.0)).sqrt());
        let core = wave * (0.5 * CORE_WAVES as f64).sqrt();
        let (least, most) = (Self::LEAST, Self::KNOWN);
        Self {
            place: place.clamp(least.place, most.place),
            gain: gain.clamp(least.gain, most.gain),
            core: core.clamp(least.core, most.core),
        }
    }
}

/// Whether the roughness that was found is more than a test by hand has: by its rms, over [`RoughScales::MOST`] and by
/// [`SPARE`] of that for what a few numbers scatter, or by one record's place or gain, [`ALONE`] times that.
pub(super) fn exceeds_any_test(hypothesis: &Hypothesis) -> bool {
    let mut sums = [(0.0, 0.0); 3];
    for (_, free, value) in free_of(hypothesis) {
        let kind = &mut sums[free.parameter.min(2)];
        let over = value / RoughScales::MOST.of(free.parameter);
        if free.parameter < 2 && over.abs() > ALONE {
            return true;
        }
        kind.0 += over * over;
        kind.1 += 1.0;
    }
    sums.iter().any(|(sum, count)| *sum > SPARE * SPARE * count)
}

const SPARE: f64 = 1.3;
const ALONE: f64 = 2.5;
const MARK: f64 = 1.5;

/// Whether an effect of a hypothesis is the roughness.
/// By how much the force of each record falls beside the place written down \[m\]; empty without roughness.
///
/// It is the first parameter of the roughness, one a record.
pub(super) fn offsets(hypothesis: &Hypothesis) -> &[f64] {
    let Some(rough) = hypothesis.effects.iter().find(|on| is_roughness(on)) else { return &[] };
    let each = rough.free.iter().filter(|free| free.parameter == 0).count();
    rough.values.get(..each).unwrap_or_default()
}

pub(super) fn is_roughness(on: &Switched) -> bool {
    on.effect.id() == ROUGHNESS
}

/// The roughness of a test of so many records, none to begin with.
pub(super) fn none_yet(piece: &Piece, records: usize) -> Switched {
    Switched::new(roughness(), piece, records, |_| None, |_| false)
}

/// The free parameters of the roughness, with where among the hypothesis' coordinates each stands, and its coordinate: zero is none.
pub(super) fn free_of(hypothesis: &Hypothesis) -> impl Iterator<Item = (usize, &FreeParameter, f64)> {
    let own = hypothesis.each_free().enumerate().filter(|(_, (on, _))| is_roughness(on));
    own.map(|(at, (on, free))| (at, free, free.coordinate(on.values[free.at])))
}

/// Adds what is known of the roughness beforehand; `first` is the place of the hypothesis' first coordinate.
pub(super) fn add_prior(prior: &mut Quadratic, hypothesis: &Hypothesis, scales: &RoughScales, first: usize) {
    for (at, free, value) in free_of(hypothesis) {
        let over = 1.0 / scales.of(free.parameter);
        prior.add_row(over * value, &[(first + at, over)]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PIECE: Piece = Piece { length: 0.8, width: 0.1, thickness: 0.03, mass_per_area: 6.88 };
    const RECORDS: usize = 4;

    /// Offsets of this size to either side, logarithms of gains, and amplitudes of waves.
    fn rough(place: f64, gain: f64, wave: f64) -> Hypothesis {
        let sizes = [vec![place; RECORDS], vec![gain; RECORDS], vec![wave; CORE_WAVES]].concat();
        let coordinates: Vec<f64> =
            sizes.iter().enumerate().map(|(i, size)| if i % 2 == 0 { *size } else { -size }).collect();
        Hypothesis { effects: vec![none_yet(&PIECE, RECORDS)] }.at(&coordinates)
    }

    /// Numbers that are known surely have the scale that they scatter by; what is not known adds to it.
    #[test]
    fn val_scales_are_those_of_what_was_found() {
        let core = 5e-3;
        // The mean square of a cosine is a half.
        let wave = core * (2.0 / CORE_WAVES as f64).sqrt();
        let hypothesis = rough(1e-3, 3e-3, wave);
        let sure = RoughScales::estimated(&hypothesis, &vec![Some(0.0); hypothesis.size()]);
        for (found, expected) in [(sure.place, 1e-3), (sure.gain, 3e-3), (sure.core, core)] {
            assert!((found / expected - 1.0).abs() < 1e-12, "{sure:?}");
        }
        let unsure = RoughScales::estimated(&hypothesis, &vec![Some(1e-3); hypothesis.size()]);
        assert!((unsure.place / (1e-3 * 2.0_f64.sqrt()) - 1.0).abs() < 1e-12, "{unsure:?}");
    }

    #[test]
    fn no_test_by_hand_is_rougher_than_its_bounds() {
        let found = RoughScales::estimated(&rough(9e-3, 0.05, 0.01), &[]);
        assert_eq!(found, RoughScales::KNOWN);
        assert!(exceeds_any_test(&rough(9e-3, 0.0, 0.0)) && exceeds_any_test(&rough(0.0, 0.05, 0.0)));
        assert!(!exceeds_any_test(&rough(3e-3, 0.01, 1e-3)));
        let one = |gain: f64| {
            let gains = (0..RECORDS).map(|record| if record == 2 { gain } else { 0.0 });
            let coordinates = [vec![0.0; RECORDS], gains.collect(), vec![0.0; CORE_WAVES]].concat();
            exceeds_any_test(&Hypothesis { effects: vec![none_yet(&PIECE, RECORDS)] }.at(&coordinates))
        };
        assert!(one(0.026) && !one(0.02), "an rms of 1 % either way");
    }

    /// What hits scatter by bounds how far their mean may lie: 4 mm beside is an offset of the hammer, to be named.
    #[test]
    fn hits_that_fall_together_allow_no_large_offset() {
        let found = RoughScales::MOST.with_hits(4e-4);
        assert!((found.place - MARK * 4e-4).abs() < 1e-15, "{found:?}");
        assert_eq!((found.gain, found.core), (RoughScales::MOST.gain, RoughScales::MOST.core));
    }
}
