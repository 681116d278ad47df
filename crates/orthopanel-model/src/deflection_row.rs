//! A weighted sum of deflections: what a force, a couple, a pressure or a weight works on.

use crate::Place;

/// How a panel moves as a whole, without strain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum RigidMotion {
    /// By 1 m along +z.
    AlongZ,
    /// By 1 rad about +x: $w = y$.
    AboutX,
    /// By 1 rad about +y: $w = -x$.
    AboutY,
}

impl RigidMotion {
    /// $r(x, y)$ \[m or m/rad\].
    pub fn deflection(self, Place { x, y }: Place) -> f64 {
        match self {
            Self::AlongZ => 1.0,
            Self::AboutX => y,
            Self::AboutY => -x,
        }
    }
}

/// The functional $\sum_ic_iw(x_i) + \sum_jc_jq_j$ of a motion with the deflections $w$, and of the masses of resonators with the
/// displacements $q$.
///
/// A load that does this work on every motion puts the force $\sum_ic_iW_m(x_i)+\dots$ on mode $m$, and its resultant in a rigid motion is
/// the functional of that motion.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DeflectionRow {
    /// $x_i$ and $c_i$.
    pub terms: Vec<(Place, f64)>,
    /// The seat of a resonator, $c_j$, and its $\omega_j^2$ \[1/s²\] on a seat that is held.
    pub resonators: Vec<(Place, f64, f64)>,
}

impl DeflectionRow {
    /// The deflection at one place.
    pub fn at(place: Place) -> Self {
        Self { terms: vec![(place, 1.0)], resonators: vec![] }
    }

    /// The same times `factor`.
    #[must_use]
    pub fn scaled(mut self, factor: f64) -> Self {
        self.terms.iter_mut().for_each(|(_, weight)| *weight *= factor);
        self.resonators.iter_mut().for_each(|(_, weight, _)| *weight *= factor);
        self
    }

    /// Where deflections enter.
    pub fn places(&self) -> impl Iterator<Item = Place> + '_ {
        self.terms.iter().map(|(place, _)| *place).chain(self.resonators.iter().map(|(place, ..)| *place))
    }

    /// Of an undamped mode: at its frequency a resonator's mass moves by $q = w\,\omega_j^2/(\omega_j^2-\omega^2)$ on a seat that moves by
    /// $w$, and where they are equal the seat stands still and nothing is told of the mass.
    pub fn of_mode(&self, angular_frequency: f64, deflection: impl Fn(Place) -> f64) -> f64 {
        let panel: f64 = self.terms.iter().map(|&(place, weight)| weight * deflection(place)).sum();
        let resonators = self.resonators.iter().map(|&(place, weight, own)| {
            let gap = own - angular_frequency * angular_frequency;
            if gap == 0.0 { 0.0 } else { weight * deflection(place) * own / gap }
        });
        panel + resonators.sum::<f64>()
    }

    /// Of a motion without strain, which takes resonators along.
    pub fn of_rigid(&self, motion: RigidMotion) -> f64 {
        self.of_mode(0.0, |place| motion.deflection(place))
    }
}
