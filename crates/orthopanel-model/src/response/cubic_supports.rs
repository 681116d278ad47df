//! Springs whose force goes with the cube of the motion, under measured hits.

use super::lane::{LANES, Lane};
use super::propagator::Coefficients;
use crate::{ModalModel, Mode, ModelError};

use std::f64::consts::TAU;

/// The forces of springs $f_j = k_3w_j^3$ at the responses of `model` \[N\] under hits, and their
/// derivatives by $k_3$ \[m³\].
///
/// Each hit falls at a force of its own, or all at the only one. `hits` are samples of the force \[N\], `step` \[s\] apart, each from where everything is at rest; the forces run over `samples`
/// of them. Each sample of a force acts as an impulse, between which modes up to `carried` \[Hz\] move freely and exactly. For a load
/// whose band ends below half the rate this leaves of a mode's motion what it is at its own frequency. Impulses a step $h$ apart
/// make of a slow force $h\cot(\omega h/2)/2\omega$ of its motion; what that leaves of $1/\omega^2$, and all of it of modes above
/// `carried`, at most half the rate, follows the forces at once, and softens the springs. The springs' own stiffness may not be such that it swings within a
/// few samples.
///
/// # Errors
/// [`ModelError::PortCount`] for a model with another number of forces, [`ModelError::NotFinite`] where the motion has no bounds.
pub fn cubic_support_forces(
    model: &ModalModel,
    k3: f64,
    hits: &[&[f64]],
    (step, samples): (f64, usize),
    carried: f64,
) -> Result<Vec<CubicForces>, ModelError> {
    let carried = carried.min(0.5 / step);
    let found = model.force_count();
    if found != 1 && found != hits.len() {
        return Err(ModelError::PortCount { mode: 1, ports: "forces", found, expected: hits.len() });
    }
    let modes: Vec<Stepped> = model
        .modes()
        .iter()
        .filter(|mode| mode.angular_frequency <= TAU * carried)
        .map(|mode| Stepped {
            free: FreeMotion::new(mode.angular_frequency, mode.damping_ratio, step),
            struck: mode.at_forces.iter().map(|shape| step * shape).collect(),
            held: mode.at_responses.iter().map(|shape| (Lane::all(*shape), Lane::all(step * shape))).collect(),
        })
        .collect();
    let flexible = Flexibility::left_of(model, step, carried);
    let mut found = Vec::with_capacity(hits.len());
    for (index, some) in hits.chunks(LANES).enumerate() {
        found.extend(side_by_side((&modes, &flexible), k3, (index * LANES, some), samples)?);
    }
    Ok(found)
}

/// What springs did in one hit: a list of samples each.
#[derive(Debug, Clone, PartialEq)]
pub struct CubicForces {
    /// \[N\].
    pub force: Vec<Vec<f64>>,
    /// Derivative by $k_3$ \[m³\].
    pub by_k3: Vec<Vec<f64>>,
}

struct Stepped {
    free: FreeMotion,
    /// Shape times the step, of each hit's place or of all hits'.
    struck: Vec<f64>,
    /// Shape of each spring's place, and the same times the step.
    held: Vec<(Lane, Lane)>,
}

/// Rounds in which the springs' forces yield to what follows them at once: each leaves a hundredth of what the last one did, if the
/// springs at their stiffest are a hundredth of the panel's own stiffness.
const YIELDING: usize = 2;

/// Motion at the springs per force that follows it at once \[m/N\].
struct Flexibility {
    /// Of each spring, by each hit's force or by all hits'.
    struck: Vec<Vec<f64>>,
    /// By each spring's.
    held: Vec<Vec<f64>>,
}

impl Flexibility {
    fn left_of(model: &ModalModel, step: f64, carried: f64) -> Self {
        let left = |omega: f64| {
            let half = 0.5 * omega * step;
            if omega > TAU * carried {
                omega.powi(-2)
            } else if half < SLOW {
                // The series' first term: the difference would be of rounding.
                step * step / 12.0
            } else {
                (1.0 - half / half.tan()) / (omega * omega)
            }
        };
        let between = |spring: usize, force: &dyn Fn(&Mode) -> f64| {
            let of_mode = |mode: &Mode| left(mode.angular_frequency) * mode.at_responses[spring] * force(mode);
            model.modes().iter().map(of_mode).sum::<f64>()
        };
        let springs = 0..model.response_count();
        let by = |spring: usize, forces: usize, at: fn(&Mode, usize) -> f64| {
            (0..forces).map(|force| between(spring, &|mode| at(mode, force))).collect()
        };
        Self {
            struck: springs
                .clone()
                .map(|spring| by(spring, model.force_count(), |mode, i| mode.at_forces[i]))
                .collect(),
            held: springs.map(|spring| by(spring, model.response_count(), |mode, i| mode.at_responses[i])).collect(),
        }
    }
}

/// Half a step's phase below which the series holds to $10^{-8}$ of itself.
const SLOW: f64 = 3e-4;

/// $(a, \dot a)$ after a step from that before.
struct FreeMotion([[Lane; 2]; 2]);

impl FreeMotion {
    fn new(omega: f64, zeta: f64, step: f64) -> Self {
        let Coefficients { impulse, held, .. } = Coefficients::new(omega, zeta, step);
        let square = omega * omega;
        let fading = 2.0 * zeta * omega * impulse;
        Self(
            [[1.0 - square * held, impulse], [-square * impulse, 1.0 - fading - square * held]]
                .map(|row| row.map(Lane::all)),
        )
    }

    #[inline(always)]
    fn carry(&self, [a, v]: &mut [Lane; 2]) {
        let Self([[aa, av], [va, vv]]) = *self;
        (*a, *v) = (*a * aa + *v * av, *a * va + *v * vv);
    }
}

fn side_by_side(
    (modes, flexible): (&[Stepped], &Flexibility),
    k3: f64,
    (first, hits): (usize, &[&[f64]]),
    samples: usize,
) -> Result<Vec<CubicForces>, ModelError> {
    let springs = flexible.held.len();
    let of_hits = |each: &[f64]| match each {
        [one] => Lane::all(*one),
        each => Lane::of(each.get(first..).unwrap_or_default()),
    };
    let struck: Vec<Lane> = modes.iter().map(|mode| of_hits(&mode.struck)).collect();
    let at_once: Vec<Lane> = flexible.struck.iter().map(|each| of_hits(each)).collect();
    let empty = || vec![vec![0.0; samples]; springs];
    let mut found: Vec<CubicForces> = hits.iter().map(|_| CubicForces { force: empty(), by_k3: empty() }).collect();
    let mut motion = vec![[Lane::default(); 2]; modes.len()];
    let mut by_k3 = motion.clone();
    let mut forces = vec![[Lane::default(); 2]; springs];
    let mut moved = forces.clone();
    for sample in 0..samples {
        let mut blow = Lane::default();
        blow.0.iter_mut().zip(hits).for_each(|(to, hit)| *to = hit.get(sample).copied().unwrap_or(0.0));
        for (spring, moved) in moved.iter_mut().enumerate() {
            let (mut w, mut by) = (blow * at_once[spring], Lane::default());
            for ((mode, [a, _]), [da, _]) in modes.iter().zip(&motion).zip(&by_k3) {
                w = w + *a * mode.held[spring].0;
                by = by + *da * mode.held[spring].0;
            }
            *moved = [w, by];
        }
        forces.fill([Lane::default(); 2]);
        for _ in 0..=YIELDING {
            let before = forces.clone();
            for ((force, moved), row) in forces.iter_mut().zip(&moved).zip(&flexible.held) {
                let [mut w, mut by] = *moved;
                for ([f, df], c) in before.iter().zip(row) {
                    (w, by) = (w - *f * Lane::all(*c), by - *df * Lane::all(*c));
                }
                let square = w * w;
                *force = [square * w * Lane::all(k3), square * w + square * by * Lane::all(3.0 * k3)];
            }
        }
        for (spring, [force, slope]) in forces.iter().enumerate() {
            for (lane, hit) in found.iter_mut().enumerate() {
                (hit.force[spring][sample], hit.by_k3[spring][sample]) = (force.0[lane], slope.0[lane]);
            }
        }
        for (((mode, struck), motion), by_k3) in modes.iter().zip(&struck).zip(&mut motion).zip(&mut by_k3) {
            let (mut kick, mut by) = (blow * *struck, Lane::default());
            for ((_, held), [force, slope]) in mode.held.iter().zip(&forces) {
                kick = kick - *force * *held;
                by = by - *slope * *held;
            }
            motion[1] = motion[1] + kick;
            by_k3[1] = by_k3[1] + by;
            mode.free.carry(motion);
            mode.free.carry(by_k3);
        }
    }
    let last = forces.iter().flatten().chain(motion.iter().flatten()).chain(by_k3.iter().flatten());
    match last.flat_map(|lane| lane.0).find(|value| !value.is_finite()) {
        Some(value) => Err(ModelError::NotFinite { what: "motion on cubic springs", value }),
        None => Ok(found),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: f64 = 1.0 / 20480.0;
    const BAND: f64 = 8000.0;

    fn mode(omega: f64, zeta: f64, struck: f64, held: &[f64]) -> Mode {
        Mode { angular_frequency: omega, damping_ratio: zeta, at_forces: vec![struck], at_responses: held.to_vec() }
    }

    /// A free mass on one cubic spring swings with the period $T = \Gamma(1/4)^2\sqrt{m/k_3}/(\sqrt\pi\,A)$
    /// ($4\sqrt{2m/k_3}/A\int_0^1du/\sqrt{1-u^4}$, the lemniscate's quarter), and $A^4 = 2mv^2/k_3$.
    #[test]
    fn val_a_mass_on_a_cubic_spring_has_its_period() {
        let (mass, k3, impulse): (f64, f64, f64) = (0.55, 2e10, 8e-3);
        let shape = mass.sqrt().recip();
        let model = ModalModel::new(1, 1, vec![mode(0.0, 0.0, shape, &[shape])]).unwrap();
        let mut hit = vec![0.0; 40];
        hit[20] = impulse / STEP;
        let samples = 32768;
        let found = cubic_support_forces(&model, k3, &[&hit], (STEP, samples), BAND).unwrap().remove(0);
        let amplitude = (2.0 * impulse * impulse / mass / k3).powf(0.25);
        let gamma_of_a_quarter = 3.625_609_908_221_908_f64;
        let period = gamma_of_a_quarter.powi(2) * (mass / k3).sqrt() / (std::f64::consts::PI.sqrt() * amplitude);
        let force = &found.force[0];
        // Where the force rises through zero, interpolated: its cube root runs straight there.
        let root = |n: usize| force[n].cbrt();
        let rises: Vec<f64> = (21..samples)
            .filter(|&n| force[n - 1] <= 0.0 && force[n] > 0.0)
            .map(|n| (n - 1) as f64 - root(n - 1) / (root(n) - root(n - 1)))
            .collect();
        let found = (rises[rises.len() - 1] - rises[0]) / (rises.len() - 1) as f64 * STEP;
        assert!(rises.len() > 5 && (found / period - 1.0).abs() < 1e-4, "{found} {period}");
        let most = force.iter().copied().fold(0.0, f64::max);
        assert!((most / (k3 * amplitude.powi(3)) - 1.0).abs() < 1e-4);
    }

    #[test]
    fn val_each_hit_may_fall_at_a_place_of_its_own() {
        let places = [1.9, -0.4, 0.7, 1.1, -1.6];
        let of = |struck: &[f64]| {
            let rigid = Mode { at_forces: vec![1.3; struck.len()], ..mode(0.0, 0.0, 0.0, &[1.3]) };
            let flexible = Mode { at_forces: struck.to_vec(), ..mode(2100.0, 0.01, 0.0, &[0.3]) };
            ModalModel::new(struck.len(), 1, vec![rigid, flexible]).unwrap()
        };
        let hits: Vec<Vec<f64>> = (1..=5).map(|size| vec![0.0, 40.0 * f64::from(size)]).collect();
        let hits: Vec<&[f64]> = hits.iter().map(Vec::as_slice).collect();
        let together = cubic_support_forces(&of(&places), 3e10, &hits, (STEP, 500), BAND).unwrap();
        for ((found, hit), place) in together.iter().zip(&hits).zip(places) {
            assert_eq!(found, &cubic_support_forces(&of(&[place]), 3e10, &[hit], (STEP, 500), BAND).unwrap()[0]);
        }
        let refused = cubic_support_forces(&of(&places[..2]), 3e10, &hits, (STEP, 500), BAND);
        assert!(matches!(refused, Err(ModelError::PortCount { found: 2, expected: 5, .. })), "{refused:?}");
    }

    /// What a mode above those that are carried, and one near half the rate, give way by belongs to the springs: on a grid sixteen
    /// times as fine, on which both swing, they do the same.
    #[test]
    fn val_what_follows_at_once_is_what_a_finer_grid_shows() {
        let modes = vec![
            mode(0.0, 0.0, 1.3, &[1.3, 1.3]),
            mode(0.0, 0.0, -2.0, &[1.2, -1.2]),
            mode(TAU * 6000.0, 0.01, 1.5, &[2.0, -2.0]),
            mode(TAU * 9000.0, 0.01, -1.5, &[2.0, 2.0]),
        ];
        let model = ModalModel::new(1, 2, modes.clone()).unwrap();
        let without = ModalModel::new(1, 2, modes[..3].to_vec()).unwrap();
        let blow = |step: f64| -> Vec<f64> {
            // Some 10 ms, slow beside either mode.
            let part = |n: usize| (n as f64 * step / 0.01).min(1.0);
            (0..(0.02 / step) as usize).map(|n| 30.0 * (0.5 * TAU * part(n)).sin().powi(2)).collect()
        };
        let of = |model: &ModalModel, finer: usize, carried: f64| {
            let step = STEP / finer as f64;
            let played = cubic_support_forces(model, 4e11, &[&blow(step)], (step, 4096 * finer), carried).unwrap();
            played[0].force[0].iter().step_by(finer).copied().collect::<Vec<f64>>()
        };
        let fine = of(&model, 16, 1e5);
        let most = fine.iter().fold(0.0_f64, |most, force| most.max(force.abs()));
        let missed = |found: Vec<f64>| {
            found.iter().zip(&fine).fold(0.0_f64, |worst, (found, fine)| worst.max((found - fine).abs())) / most
        };
        let (with, without) = (missed(of(&model, 1, BAND)), missed(of(&without, 1, BAND)));
        assert!(with < 1e-3 && without > 10.0 * with, "{with} {without}");
    }

    /// Two springs, rigid and flexible modes, five hits: more than stand side by side.
    #[test]
    fn val_the_derivative_is_that_of_differences() {
        let modes = vec![
            mode(0.0, 0.0, 1.3, &[1.3, 1.3]),
            mode(0.0, 0.0, -2.0, &[1.2, -1.2]),
            mode(2100.0, 0.01, 1.9, &[0.3, 0.2]),
            mode(5600.0, 0.004, -1.5, &[1.1, -1.2]),
        ];
        let model = ModalModel::new(1, 2, modes).unwrap();
        let hits: Vec<Vec<f64>> =
            (1..=5).map(|size| [0.0, 30.0, 90.0, 40.0].map(|f| f * f64::from(size)).to_vec()).collect();
        let hits: Vec<&[f64]> = hits.iter().map(Vec::as_slice).collect();
        let at = |k3: f64| cubic_support_forces(&model, k3, &hits, (STEP, 4096), BAND).unwrap();
        let k3 = 3e10;
        let h = 1e-4 * k3;
        let (here, low, high) = (at(k3), at(k3 - h), at(k3 + h));
        for hit in 0..hits.len() {
            for spring in 0..2 {
                let size = here[hit].by_k3[spring].iter().fold(0.0_f64, |most, by| most.max(by.abs()));
                for sample in 0..4096 {
                    let difference = (high[hit].force[spring][sample] - low[hit].force[spring][sample]) / (2.0 * h);
                    assert!((here[hit].by_k3[spring][sample] - difference).abs() < 1e-5 * size);
                }
            }
        }
    }
}
