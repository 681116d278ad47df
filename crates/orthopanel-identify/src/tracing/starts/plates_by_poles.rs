//! Plates whose modes on the centre line lie nearest to the poles: where the search for one in the records begins.
//!
//! A plate's modes of two families pass each other as the constants change, so lines between them promise nothing unless each mode
//! is near its own pole. Frequencies alone find such constants, and cost a thousandth of the lines.

use std::sync::Arc;

use argmin::core::{CostFunction, Error, Executor, State as _};
use argmin::solver::neldermead::NelderMead;
use orthopanel_model::{Boundary, MindlinPlate, Piece, ReducedStructure, RitzMode, Structure, ritz_modes};
use rayon::prelude::*;

use super::stiffness_grid::StiffnessGrid;
use crate::accelerance_fit::nearest_modes;

/// Constants of a plate: $E_x$, $G_{zx}$, and $E_y/E_x$, $\nu_{xy}$, $G_{xy}/E_x$, $G_{yz}/G_{zx}$.
pub(super) type PlateStart = ([f64; 2], [f64; 4]);

/// Ratios $E_x/G_{zx}$ tried: lowest, highest and steps between.
const RATIOS: (f64, f64, usize) = (5.0, 100.0, 9);
/// $E_y/E_x$ and $G_{yz}/G_{zx}$ tried, and what isotropic faces give for the others.
const ACROSS: [f64; 5] = [0.5, 0.7, 1.0, 1.4, 2.0];
const SHEAR_ACROSS: [f64; 2] = [1.0, 0.5];
const NU_XY: f64 = 0.3;
const G_XY: f64 = 0.385;
/// One of so many lowest poles is one of so many lowest modes.
const ANCHORS: usize = 2;

/// A round of bringing plates nearer to the poles.
struct Round {
    /// So many of the lowest poles are looked at.
    poles: usize,
    /// Distance of a pole from its mode, in parts of itself, at which it begins to count for less.
    near: f64,
    /// Plates that are brought nearer, edge of the first simplex, and its steps.
    plates: usize,
    edge: f64,
    steps: u64,
}

const ROUNDS: [Round; 3] = [
    Round { poles: 10, near: 1e-2, plates: 16, edge: 0.1, steps: 100 },
    Round { poles: 12, near: 3e-3, plates: 10, edge: 0.05, steps: 120 },
    Round { poles: 14, near: 1e-3, plates: 4, edge: 0.02, steps: 150 },
];
/// Plates none of whose constants differ by more than this part are one.
const ALIKE: f64 = 0.01;
/// A mode without a pole costs this: sensor or hammer may sit at its node, but none of many modes may be dreamt up to meet few poles.
const UNSEEN_MODE: f64 = 0.25;

/// What frequencies are held against.
pub(super) struct PlatesByPoles<'a> {
    pub piece: &'a Piece,
    pub boundary: Boundary,
    /// \[Hz\], rising.
    pub poles: &'a [f64],
    /// $E_x$, $G_{zx}$ where they are declared.
    pub held: &'a [Option<f64>; 2],
}

impl PlatesByPoles<'_> {
    /// Those nearest to the poles, the nearest first. `usual` is $E_x$ of a beam there.
    pub(super) fn found(&self, usual: f64) -> Vec<PlateStart> {
        let mut found = self.tried(usual);
        for round in &ROUNDS {
            found = parted(found);
            found.truncate(round.plates);
            let nearer = |&(_, start): &(f64, PlateStart)| self.nearer(start, round);
            found = found.par_iter().filter_map(nearer).collect();
        }
        parted(found).into_iter().map(|(_, start)| start).collect()
    }

    /// A grid of ratios; how stiff the whole is follows from the lowest poles.
    fn tried(&self, usual: f64) -> Vec<(f64, PlateStart)> {
        let grid = StiffnessGrid { ratios: RATIOS, anchors: ANCHORS, poles: self.poles, held: self.held };
        let across = ACROSS.iter().flat_map(|e_y| SHEAR_ACROSS.map(|g_yz| [*e_y, NU_XY, G_XY, g_yz]));
        let across: Vec<[f64; 4]> = across.collect();
        let units: Vec<PlateStart> =
            grid.units(usual).flat_map(|unit| across.iter().map(move |own| (unit, *own))).collect();
        let round = &ROUNDS[0];
        let anchored = |unit: PlateStart| -> Vec<(f64, PlateStart)> {
            let Some(plate) = self.plate(&unit, round) else { return vec![] };
            let Some(modes) = self.modes(&plate, &unit, round) else { return vec![] };
            let start = |factor: f64| {
                let scaled: Vec<f64> = modes.iter().map(|mode| mode * factor).collect();
                (self.charge(&scaled, round), (unit.0.map(|constant| constant * factor * factor), unit.1))
            };
            grid.factors(&modes).into_iter().map(start).collect()
        };
        units.into_par_iter().flat_map_iter(anchored).collect()
    }

    /// On a basis for the modes that the poles of a round ask for, of which those that the centre line shows are kept.
    fn plate(&self, first: &PlateStart, round: &Round) -> Option<MindlinPlate> {
        let plate = MindlinPlate::with_basis_for(self.piece, self.boundary, &plate_values(first), 4 * round.poles);
        Some(plate.ok()?.only_with_nodes(&[[0, 0], [1, 0]]))
    }

    /// Frequencies \[Hz\] of the flexible modes.
    fn modes(&self, plate: &MindlinPlate, start: &PlateStart, round: &Round) -> Option<Vec<f64>> {
        Some(frequencies(&ritz_modes(plate, &plate_values(start), round.modes(plate)).ok()?))
    }

    /// The plate on the shapes that these modes take near a start: a simplex asks for them hundreds of times.
    fn reduced(&self, start: &PlateStart, round: &Round) -> Option<ReducedStructure<MindlinPlate>> {
        let plate = self.plate(start, round)?;
        let count = round.modes(&plate);
        ReducedStructure::near(Arc::new(plate), &plate_values(start), count).ok()
    }

    /// $\sum\frac12\ln(1+d^2/\delta^2)$ of the poles' distances from their nearest modes, each mode for one pole, and what modes without
    /// one cost.
    fn charge(&self, modes: &[f64], round: &Round) -> f64 {
        let poles = &self.poles[..round.poles.min(self.poles.len())];
        let top = poles.last().copied().unwrap_or(0.0) * (1.0 + round.near);
        let (distances, seen) = nearest_modes(poles, modes, f64::INFINITY);
        let charge: f64 = distances
            .iter()
            .map(|distance| distance.map_or(f64::INFINITY, |distance| 0.5 * (distance / round.near).powi(2).ln_1p()))
            .sum();
        let unseen = modes.iter().zip(&seen).filter(|(mode, seen)| **mode < top && !**seen).count();
        charge + UNSEEN_MODE * unseen as f64
    }

    /// By downhill simplex: the charge has no derivative where modes change their poles.
    fn nearer(&self, start: PlateStart, round: &Round) -> Option<(f64, PlateStart)> {
        let near = self.reduced(&start, round)?;
        let corner = |moved: usize| (1..=COORDINATES).map(|i| if i == moved { round.edge } else { 0.0 }).collect();
        let corners: Vec<Vec<f64>> = (0..=COORDINATES).map(corner).collect();
        let cost = Charge(|at: &[f64]| {
            let modes = near.natural_frequencies(&plate_values(&self.moved(&start, at)));
            modes.map_or(f64::INFINITY, |modes| self.charge(&modes, round))
        });
        let done = Executor::new(cost, NelderMead::new(corners)).configure(|state| state.max_iters(round.steps)).run();
        let done = done.ok()?;
        let state = done.state();
        Some((state.get_best_cost(), self.moved(&start, state.get_best_param()?)))
    }

    /// A start moved by logarithms, $\nu_{xy}$ by itself; declared constants stay.
    fn moved(&self, (constants, [e_y, nu, g_xy, g_yz]): &PlateStart, at: &[f64]) -> PlateStart {
        let by = |i: usize| at.get(i).copied().unwrap_or(0.0);
        let [e_x, g_zx] =
            [0, 1].map(|i| if self.held[i].is_some() { constants[i] } else { constants[i] * by(i).exp() });
        ([e_x, g_zx], [e_y * by(2).exp(), nu + by(3), g_xy * by(4).exp(), g_yz * by(5).exp()])
    }
}

impl Round {
    /// How many modes of a plate are held against the poles.
    fn modes(&self, plate: &MindlinPlate) -> usize {
        (2 * self.poles + 6).min(plate.resolved_modes())
    }
}

/// \[Hz\], of the flexible ones.
fn frequencies(modes: &[RitzMode]) -> Vec<f64> {
    let all = modes.iter().map(|mode| mode.angular_frequency / std::f64::consts::TAU);
    all.filter(|frequency| *frequency > 0.0).collect()
}

/// The nearest first, without those that are like a nearer one.
fn parted(mut found: Vec<(f64, PlateStart)>) -> Vec<(f64, PlateStart)> {
    found.retain(|(charge, _)| charge.is_finite());
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.into_iter().fold(vec![], |mut parted: Vec<(f64, PlateStart)>, (charge, start)| {
        if !parted.iter().any(|(_, other)| alike(other, &start)) {
            parted.push((charge, start));
        }
        parted
    })
}

fn alike(a: &PlateStart, b: &PlateStart) -> bool {
    plate_values(a).iter().zip(&plate_values(b)).all(|(a, b)| (a - b).abs() <= ALIKE * a.abs())
}

const COORDINATES: usize = 6;

/// What a downhill simplex makes least.
pub(super) struct Charge<F>(pub(super) F);

impl<F: Fn(&[f64]) -> f64> CostFunction for Charge<F> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, at: &Vec<f64>) -> Result<f64, Error> {
        Ok((self.0)(at))
    }
}

/// In the order of [`orthopanel_model::PLATE_CONSTANTS`].
fn plate_values(([e_x, g_zx], [e_y, nu_xy, g_xy, g_yz]): &PlateStart) -> [f64; 6] {
    [*e_x, e_y * e_x, *nu_xy, g_xy * e_x, g_yz * g_zx, *g_zx]
}

#[cfg(test)]
mod tests {
    use orthopanel_model::PLATE_CONSTANTS;

    use super::*;

    /// A plate, some of whose modes no record shows, is found again from the others' frequencies alone.
    #[test]
    fn val_a_plate_is_found_by_the_poles_that_are_seen() {
        let piece = Piece { length: 0.935, width: 0.317, thickness: 0.03, mass_per_area: 6.9 };
        let truth: PlateStart = ([1.1e10, 5e8], [0.7, 0.4, 0.35, 0.55]);
        let values = plate_values(&truth);
        let plate = MindlinPlate::with_basis_for(&piece, Boundary::FREE, &values, 90).unwrap();
        let modes = ritz_modes(&plate.only_with_nodes(&[[0, 0], [1, 0]]), &values, 30).unwrap();
        let all = modes.iter().map(|mode| mode.angular_frequency / std::f64::consts::TAU).filter(|f| *f > 0.0);
        let poles: Vec<f64> =
            all.enumerate().filter(|(n, _)| n % 5 != 3 && n % 7 != 4).map(|(_, f)| f).take(15).collect();
        let by = PlatesByPoles { piece: &piece, boundary: Boundary::FREE, poles: &poles, held: &[None; 2] };
        let found = by.found(2e10);
        let told = plate_values(&found[0]);
        // A torsion modulus shows little on the centre line, nor does the shear across.
        for (index, within) in [0.01, 0.02, 0.1, 0.2, 0.1, 0.01].into_iter().enumerate() {
            let name = PLATE_CONSTANTS[index].name;
            assert!((told[index] / values[index] - 1.0).abs() < within, "{name}: {told:?} of {values:?}");
        }
    }
}
