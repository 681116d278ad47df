//! From modes, however they were found, to the hinge [`ModalModel`].

use crate::{BeamMode, Damping, ModalModel, Mode, ModelError, Place, Ports, RitzMode, Structure, ritz_modes};

/// What the hinge asks of a mode, be it exact, Ritz or finite element.
pub(crate) trait NaturalMode {
    /// $\omega$ \[rad/s\]; zero for a rigid mode.
    fn angular_frequency(&self) -> f64;
    /// Mass-normalised deflection $W$ \[kg^-1/2\] at a place.
    fn deflection_at(&self, place: Place) -> f64;
    /// That of each of these modes, which may know what they share.
    fn deflections_at(modes: &[Self], place: Place) -> Vec<f64>
    where
        Self: Sized,
    {
        modes.iter().map(|mode| mode.deflection_at(place)).collect()
    }
    /// Its damping ratio, where that is no matter of its number in the list.
    fn own_damping(&self) -> Option<f64> {
        None
    }
    /// $c_{mn}$ \[1/s\] to the modes of the list in order, perhaps to more; empty where nothing couples it.
    fn damping_coupling(&self) -> &[f64] {
        &[]
    }
}

impl NaturalMode for BeamMode {
    fn angular_frequency(&self) -> f64 {
        BeamMode::angular_frequency(self)
    }

    fn deflection_at(&self, place: Place) -> f64 {
        self.deflection(place.x)
    }
}

/// A mode together with the structure whose coordinates it is written in.
struct ModeOf<'a> {
    structure: &'a dyn Structure,
    mode: RitzMode,
}

impl NaturalMode for ModeOf<'_> {
    fn angular_frequency(&self) -> f64 {
        self.mode.angular_frequency
    }

    fn deflection_at(&self, place: Place) -> f64 {
        self.mode.deflection(self.structure, place)
    }
}

impl ModalModel {
    /// The rigid modes and the first `count` flexible ones of a structure, as seen from the ports.
    ///
    /// This is the reduction of section 3.5: with $T$ the mass-normalised eigenvectors of eq. 26,
    /// $M\ddot x + Kx = f$, and $x = Ty$, modal damping makes it eq. 27,
    /// $$\ddot y + \Lambda\dot y + \Omega y = T^Tf,\quad \Lambda = 2\,\mathrm{diag}(\zeta_m\omega_m),\quad
    /// \Omega = \mathrm{diag}(\omega_m^2).$$
    /// Rigid modes have $\zeta = 0$, flexible mode $m$ has `damping.ratio(m)`. `values` are the constants \[Pa, 1\] in
    /// the order of [`Structure::constants`].
    ///
    /// A structure does not know its edges: check places with [`Piece::contains`](crate::Piece::contains) first.
    ///
    /// # Errors
    /// As [`ritz_modes()`] and [`ModalModel::new`].
    pub fn of_structure(
        structure: &dyn Structure,
        values: &[f64],
        count: usize,
        damping: &Damping,
        ports: &Ports,
    ) -> Result<Self, ModelError> {
        let modes = ritz_modes(structure, values, count)?;
        let modes: Vec<_> = modes.into_iter().map(|mode| ModeOf { structure, mode }).collect();
        Self::of_modes(&modes, damping, &ports.forces, &ports.responses)
    }

    /// Modes in rising order, rigid ones first, as seen from the ports.
    pub(crate) fn of_modes<M: NaturalMode>(
        modes: &[M],
        damping: &Damping,
        forces: &[Place],
        responses: &[Place],
    ) -> Result<Self, ModelError> {
        let rigid = modes.iter().take_while(|mode| mode.angular_frequency() == 0.0).count();
        let at = |places: &[Place]| places.iter().map(|&place| M::deflections_at(modes, place)).collect();
        let (at_forces, at_responses): (Vec<Vec<f64>>, Vec<Vec<f64>>) = (at(forces), at(responses));
        let seen = modes.iter().enumerate().map(|(index, mode)| {
            let own = |ports: &[Vec<f64>]| ports.iter().filter_map(|port| port.get(index).copied()).collect();
            Mode {
                angular_frequency: mode.angular_frequency(),
                damping_ratio: if index < rigid {
                    0.0
                } else {
                    mode.own_damping().unwrap_or_else(|| damping.ratio(index + 1 - rigid))
                },
                at_forces: own(&at_forces),
                at_responses: own(&at_responses),
            }
        });
        let model = Self::new(forces.len(), responses.len(), seen.collect())?;
        let rows = modes.iter().map(|mode| mode.damping_coupling().iter().take(modes.len()).copied().collect());
        let rows: Vec<Vec<f64>> = rows.collect();
        if rows.iter().flatten().all(|&damping| damping == 0.0) { Ok(model) } else { model.with_damping_coupling(rows) }
    }
}
