//! Moment and shear force along a beam under one load that stands still.

use crate::structure::Motion;

/// $M(x)$ a cubic and $V(x)$ a parabola, with a step, a kink or a peak at the load's place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct StaticField {
    moment: [f64; 4],
    shear: [f64; 3],
    /// Where the load sits.
    at: f64,
    /// Added beyond the load: a step of the moment, and a shear force that goes on.
    step: [f64; 2],
    /// Dirac peaks of moment and shear force at the load's place.
    peak: [f64; 2],
}

impl StaticField {
    /// $M = c + dx$, $V = d$ without any load.
    pub(super) fn linear(at_centre: f64, slope: f64) -> Self {
        let (moment, shear) = ([at_centre, slope, 0.0, 0.0], [slope, 0.0, 0.0]);
        Self { moment, shear, at: 0.0, step: [0.0; 2], peak: [0.0; 2] }
    }

    /// What a unit load adds beyond its place. A force: $V$ falls by one. A couple on $\psi$: $M$ falls by one. The loads
    /// of slope and curvature are the derivatives of these two by the place.
    pub(super) fn of_load(motion: Motion, at: f64) -> Self {
        let (step, peak) = match motion {
            Motion::Deflection | Motion::Foot => ([0.0, -1.0], [0.0; 2]),
            Motion::Slope => ([1.0, 0.0], [0.0, 1.0]),
            Motion::Rotation => ([-1.0, 0.0], [0.0; 2]),
            Motion::Curvature => ([0.0; 2], [1.0, 0.0]),
            Motion::SlopeAcross | Motion::Shear(_) => ([0.0; 2], [0.0; 2]),
        };
        Self { moment: [0.0; 4], shear: [0.0; 3], at, step, peak }
    }

    pub(super) fn place(&self) -> f64 {
        self.at
    }

    pub(super) fn add_smooth(&mut self, moment: [f64; 4], shear: [f64; 3]) {
        self.moment.iter_mut().zip(moment).for_each(|(total, value)| *total += value);
        self.shear.iter_mut().zip(shear).for_each(|(total, value)| *total += value);
    }

    /// Takes off `share` of a field that has no load.
    pub(super) fn take(&mut self, other: &Self, share: f64) {
        self.add_smooth(other.moment.map(|value| -share * value), other.shear.map(|value| -share * value));
    }

    /// Moment and shear force, the peaks apart; in a step, its middle.
    pub(super) fn at(&self, x: f64) -> [f64; 2] {
        let passed = if x > self.at {
            1.0
        } else if x == self.at {
            0.5
        } else {
            0.0
        };
        self.with_step(x, passed)
    }

    /// As [`StaticField::at`], before any load at this place.
    pub(super) fn before(&self, x: f64) -> [f64; 2] {
        self.with_step(x, 0.0)
    }

    /// As [`StaticField::at`], beyond every load.
    pub(super) fn beyond(&self, x: f64) -> [f64; 2] {
        self.with_step(x, 1.0)
    }

    fn with_step(&self, x: f64, passed: f64) -> [f64; 2] {
        let series = |coefficients: &[f64]| coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c);
        let mut value = [series(&self.moment), series(&self.shear)];
        if passed > 0.0 {
            value[0] += passed * self.step[0] + if x > self.at { self.step[1] * (x - self.at) } else { 0.0 };
            value[1] += passed * self.step[1];
        }
        value
    }

    /// What the peaks of two fields add to the integrals of both products.
    ///
    /// Two peaks at one place have no finite product; none is asked for.
    pub(super) fn concentrated(a: &Self, b: &Self) -> [f64; 2] {
        let part = |peaked: &Self, other: &Self, kind: usize| {
            if peaked.peak[kind] == 0.0 { 0.0 } else { peaked.peak[kind] * other.at(peaked.at)[kind] }
        };
        [0, 1].map(|kind| part(a, b, kind) + part(b, a, kind))
    }

    /// What this field's peak of shear force adds to $\int V_1V_2$ of a stretch that holds it, or not.
    pub(super) fn concentrated_shear(&self, other: &Self, inside: bool) -> f64 {
        if inside && self.peak[1] != 0.0 { self.peak[1] * other.at(self.at)[1] } else { 0.0 }
    }
}
