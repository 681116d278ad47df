//! What unevenness along a beam does to its modes, to first order.

use faer::Mat;

use super::row::Row;
use super::{EffectSetting, ModifiedPanel, SeenModes};
use crate::legendre::gauss_legendre;
use crate::timoshenko_beam::Section;
use crate::{ModelError, Motion, Place};

/// What is uneven along a beam.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Field {
    /// The shear stiffness of the core, $k'G_{zx}A$.
    Shear,
    /// The bending stiffness of the faces, $E_xI$.
    Bending,
    /// The mass, $\rho A$ and $\rho I$ alike.
    Mass,
}

impl Field {
    /// Every field.
    pub const ALL: [Self; 3] = [Self::Shear, Self::Bending, Self::Mass];
}

impl ModifiedPanel {
    /// Derivatives of the modes of the beam without effects by the amplitude of each wave $\cos k\pi(x/a+\tfrac12)$, $k$ from 1, of a
    /// relative unevenness: with $\kappa$ and $\mu$ the changes of stiffness and mass between modes,
    /// $$d\omega_m^2 = \kappa_{mm}-\omega_m^2\mu_{mm},\qquad
    /// d\phi_m = -\tfrac12\mu_{mm}\phi_m + \sum_{n\ne m}\phi_n\frac{\kappa_{nm}-\omega_m^2\mu_{nm}}{\omega_m^2-\omega_n^2}$$
    /// (Fox and Kapoor, AIAA J. 6 (1968) 2426); rigid modes, which coincide, turn by $-\tfrac12\mu$. Damping ratios and slopes are left empty.
    ///
    /// # Errors
    /// As [`ModifiedPanel::seen_from`].
    pub fn uneven(
        &self,
        setting: &EffectSetting,
        places: &[Place],
        values: &[f64],
        (field, waves): (Field, usize),
    ) -> Result<Vec<SeenModes>, ModelError> {
        let Some((base, ..)) = self.base(setting, values, &[])? else {
            return Err(ModelError::Unsupported("a plate that is uneven along x".into()));
        };
        let low = &base.low;
        let seen = |rows: &[Row]| {
            Mat::from_fn(rows.len(), low.modes.len(), |row, m| base.modes[m].motion((rows[row].0, rows[row].1.x)))
        };
        let half = 0.5 * setting.piece.length;
        let rule = gauss_legendre(2 * low.modes.len() + waves + 8);
        let rows = |motion: Motion| -> Vec<Row> {
            rule.iter().map(|(t, _)| (motion, Place { x: half * t, y: 0.0 })).collect()
        };
        let section = Section::of(&setting.piece);
        let [e_x, g_zx] = [0, 1].map(|number| values.get(number).copied().unwrap_or(0.0));
        // Motions whose products are the density of energy, with their factors.
        let rotation = || seen(&rows(Motion::Rotation));
        let densities: Vec<(f64, Mat<f64>)> = match field {
            Field::Shear => vec![(g_zx * section.shear_area, seen(&rows(Motion::Slope)) + rotation())],
            Field::Bending => vec![(e_x * section.second_moment, seen(&rows(Motion::Curvature)))],
            Field::Mass => {
                vec![(section.mass, seen(&rows(Motion::Deflection))), (section.rotary_inertia, rotation())]
            }
        };
        let ports: Vec<Row> = places.iter().map(|&place| (Motion::Deflection, place)).collect();
        let at_ports = seen(&ports);
        let wave = |number: usize| {
            let size = low.modes.len();
            let mut change = Mat::<f64>::zeros(size, size);
            for (factor, motions) in &densities {
                let weighted = Mat::from_fn(rule.len(), size, |point, m| {
                    let (t, weight) = rule[point];
                    let along = std::f64::consts::FRAC_PI_2 * (t + 1.0) * (number + 1) as f64;
                    factor * half * weight * along.cos() * motions[(point, m)]
                });
                change += motions.transpose() * weighted;
            }
            let lambda = |m: usize| low.modes[m].2;
            // Change of $K - \omega_m^2M$, and of $M$.
            let pencil =
                |n: usize, m: usize| if field == Field::Mass { -lambda(m) * change[(n, m)] } else { change[(n, m)] };
            let mass = |n: usize, m: usize| if field == Field::Mass { change[(n, m)] } else { 0.0 };
            let share = |n: usize, m: usize| {
                let gap = lambda(m) - lambda(n);
                if n == m || gap == 0.0 { -0.5 * mass(n, m) } else { pencil(n, m) / gap }
            };
            let derivative = |m: usize| if lambda(m) > 0.0 { 0.5 * pencil(m, m) / lambda(m).sqrt() } else { 0.0 };
            let moved = |m: usize| {
                (0..places.len()).map(|port| (0..size).map(|n| at_ports[(port, n)] * share(n, m)).sum()).collect()
            };
            SeenModes {
                angular_frequency: (0..size).map(derivative).collect(),
                damping_ratio: vec![],
                deflection: (0..size).map(moved).collect(),
                ..SeenModes::default()
            }
        };
        Ok((0..waves).map(wave).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        BeamTerms, Boundary, EffectState, Piece, RecordSetting, ShearLoss, StructureKind, TimoshenkoBeam, effect,
        ritz_modes,
    };

    const PIECE: Piece = Piece { length: 0.8, width: 0.1, thickness: 0.03, mass_per_area: 6.88 };
    const VALUES: [f64; 2] = [1.07e10, 5.363e8];
    const PLACES: [Place; 2] = [Place { x: -0.3, y: 0.0 }, Place { x: 0.17, y: 0.0 }];

    fn beam(piece: Piece) -> (ModifiedPanel, EffectSetting) {
        let record = RecordSetting { number: 1, ..RecordSetting::default() };
        let setting = EffectSetting { piece, boundary: Boundary::default(), suspension: vec![], record };
        (ModifiedPanel::new(StructureKind::TimoshenkoBeam, &setting, 8).expect("a beam"), setting)
    }

    /// Against differences between beams with a wave at an amplitude and at its negative.
    fn assert_derivatives(field: Field, piece: Piece, wavy: impl Fn(usize, f64) -> SeenModes) {
        let (panel, setting) = beam(piece);
        let even = panel.seen_from(&setting, &PLACES, false, &VALUES, &[]).expect("modes");
        for (number, wave) in panel.uneven(&setting, &PLACES, &VALUES, (field, 5)).expect("waves").iter().enumerate() {
            let [less, more] = [-1e-3, 1e-3].map(|amplitude| wavy(number, amplitude));
            for n in 2..8 {
                let omega = (more.angular_frequency[n] - less.angular_frequency[n]) / 2e-3;
                let own = wave.angular_frequency[n];
                assert!(
                    (own - omega).abs() < 1e-3 * even.angular_frequency[n],
                    "wave {number}, mode {n}: {own} {omega}"
                );
                // A product has no sense of its own.
                let product = |modes: &SeenModes| modes.deflection[n][0] * modes.deflection[n][1];
                let by_wave =
                    wave.deflection[n][0] * even.deflection[n][1] + even.deflection[n][0] * wave.deflection[n][1];
                let difference = (product(&more) - product(&less)) / 2e-3;
                // The sum over modes ends.
                assert!(
                    (by_wave - difference).abs() < 0.05 * difference.abs().max(5.0),
                    "wave {number}, mode {n}: {by_wave} {difference}"
                );
            }
        }
    }

    /// Spans with gaps between them that are stiffer and softer in shear. Of a wave that turns by $2u$ over a span, steps that are as high as
    /// it is at their middles hold $\sin u/u$ on the part of the length that the spans take, and else only waves shorter than these modes feel.
    #[test]
    fn val_waves_of_the_core_are_those_of_many_spans() {
        const SPANS: usize = 24;
        assert_derivatives(Field::Shear, PIECE, |number, amplitude| {
            let part = 0.5;
            let each = PIECE.length / SPANS as f64;
            let turn = std::f64::consts::PI * (number + 1) as f64 / SPANS as f64;
            let u = 0.5 * part * turn;
            let loss = |index: usize| {
                let middle = index as f64 + 0.5;
                let step = amplitude * (turn * middle).cos() * u / (u.sin() * part);
                ShearLoss { loss: -step, span: part * each, at: each * middle - 0.5 * PIECE.length }
            };
            let terms = BeamTerms { losses: (0..SPANS).map(loss).collect(), ..BeamTerms::default() };
            let beam = TimoshenkoBeam::with_terms(&PIECE, Boundary::default(), 40, terms).expect("a beam");
            let modes = ritz_modes(&beam, &VALUES, 8).expect("modes");
            SeenModes {
                angular_frequency: modes.iter().map(|mode| mode.angular_frequency).collect(),
                damping_ratio: vec![],
                deflection: modes.iter().map(|mode| PLACES.map(|at| mode.deflection(&beam, at)).to_vec()).collect(),
                ..SeenModes::default()
            }
        });
    }

    /// Masses at the points of a quadrature, heavier and lighter than none, on a beam so thin that turning takes no inertia.
    #[test]
    fn val_waves_of_mass_are_those_of_many_masses() {
        let thin = Piece { thickness: 0.003, ..PIECE };
        let (panel, setting) = beam(thin);
        assert_derivatives(Field::Mass, thin, |number, amplitude| {
            let mass = |(t, weight): &(f64, f64)| {
                let wave = (std::f64::consts::FRAC_PI_2 * (t + 1.0) * (number + 1) as f64).cos();
                let values = vec![0.5 * weight * amplitude * wave * PIECE.mass(), 0.5 * t * PIECE.length];
                EffectState::new(effect("local-mass").expect("known"), values, 1).expect("a mass")
            };
            let masses: Vec<EffectState> = gauss_legendre(24).iter().map(mass).collect();
            panel.seen_from(&setting, &PLACES, false, &VALUES, &masses).expect("modes")
        });
    }

    /// What is odd about the middle moves no frequency of an even beam to first order.
    #[test]
    fn val_odd_waves_leave_frequencies_alone() {
        let (panel, setting) = beam(PIECE);
        for field in Field::ALL {
            let waves = panel.uneven(&setting, &PLACES, &VALUES, (field, 6)).expect("waves");
            for wave in waves.iter().step_by(2) {
                assert!(
                    wave.angular_frequency.iter().all(|by| by.abs() < 1e-4),
                    "{field:?}: {:?}",
                    wave.angular_frequency
                );
            }
        }
    }
}
