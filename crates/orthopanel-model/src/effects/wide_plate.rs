//! The plate in place of the beam, on a few shapes of its own.

use std::sync::{Arc, Mutex, PoisonError};

use faer::Mat;

use super::known::{KEPT as KEPT_MODES, Known, known_or};
use super::low_modes::LowModes;
use super::row::{Row, SharedStructure};
use crate::mindlin_plate::Membrane;
use crate::reduced_structure::{KnownRow, known_row, rows_at};
use crate::ritz_modes::ritz_modes;
use crate::structure::{Block, Motion, Structure};
use crate::{BeamConstants, Boundary, Constant, ExactBeam, MindlinPlate, ModelError, Piece, Place, ReducedStructure};

/// The beam's two constants, then the ratios of `width-coupling`.
type Ratios = [f64; 6];

/// A [`MindlinPlate`] by the constants $E_x$, $G_{zx}$ and the ratios $E_y/E_x$, $\nu_{xy}$, $G_{xy}/E_x$, $G_{yz}/G_{zx}$.
struct RatioPlate {
    plate: MindlinPlate,
    membrane: Option<Membrane>,
    rows: Vec<KnownRow>,
}

const RATIO_CONSTANTS: [Constant; 6] = [
    Constant { name: "e_x", unit: "Pa", low: 1e3, high: 1e15 },
    Constant { name: "g_zx", unit: "Pa", low: 1e3, high: 1e15 },
    Constant { name: "e_y_ratio", unit: "1", low: 1e-3, high: 1e3 },
    Constant { name: "nu_xy", unit: "1", low: 0.0, high: 0.95 },
    Constant { name: "g_xy_ratio", unit: "1", low: 1e-4, high: 1e3 },
    Constant { name: "g_yz_ratio", unit: "1", low: 1e-3, high: 1e3 },
];

/// In the order of [`crate::PLATE_CONSTANTS`].
fn plate_constants([e_x, g_zx, e_y, nu_xy, g_xy, g_yz]: Ratios) -> [f64; 6] {
    [e_x, e_y * e_x, nu_xy, g_xy * e_x, g_yz * g_zx, g_zx]
}

fn six(values: &[f64]) -> Result<Ratios, ModelError> {
    values.try_into().map_err(|_| ModelError::ConstantCount { found: values.len(), expected: 6 })
}

impl Structure for RatioPlate {
    fn constants(&self) -> &'static [Constant] {
        &RATIO_CONSTANTS
    }

    fn coefficients(&self, values: &[f64]) -> Result<Vec<f64>, ModelError> {
        self.plate.coefficients(&plate_constants(six(values)?))
    }

    fn coefficient_derivatives(&self, _values: &[f64]) -> Result<Mat<f64>, ModelError> {
        Err(ModelError::Unsupported("derivatives of a plate by its ratios".into()))
    }

    fn blocks(&self) -> &[Block] {
        self.plate.blocks()
    }

    fn shape_row(&self, block: usize, place: Place) -> Vec<f64> {
        self.plate.shape_row(block, place)
    }

    fn motion_row(&self, block: usize, motion: Motion, place: Place) -> Option<Vec<f64>> {
        known_row(&self.rows, block, (motion, place)).or_else(|| self.plate.motion_row(block, motion, place))
    }

    fn static_remainder(&self, values: &[f64], motions: [(Motion, Place); 2]) -> Option<f64> {
        self.plate.kink(self.membrane.as_ref()?, &plate_constants(six(values).ok()?), motions)
    }

    fn static_remainders(&self, values: &[f64], motions: [&[(Motion, Place)]; 2]) -> Option<Mat<f64>> {
        self.plate.kinks(self.membrane.as_ref()?, &plate_constants(six(values).ok()?), motions)
    }

    fn inertial_remainders(&self, values: &[f64], motions: [&[(Motion, Place)]; 2]) -> Vec<Mat<f64>> {
        let (Some(membrane), Ok(values)) = (&self.membrane, six(values)) else { return vec![] };
        self.plate.inertia(membrane, &plate_constants(values), motions)
    }

    fn resolved_modes(&self) -> usize {
        self.plate.resolved_modes()
    }
}

/// A plate that lines can sum.
#[derive(Clone)]
pub(super) struct WidePlate {
    pub structure: SharedStructure,
    reduced: Arc<ReducedStructure<RatioPlate>>,
    /// The plate on its whole basis, with what it does at any place.
    pub whole: SharedStructure,
    /// Flexible modes that every line sums.
    pub summed: usize,
}

/// Up to where modes of a plate are summed.
#[derive(Debug, Clone, Copy)]
pub(super) enum Summed {
    /// Where the beam's mode of this number lies, times [`SUMMED`].
    Beam(usize),
    /// A frequency \[Hz\].
    To(f64),
}

/// The plates that a search has met.
pub(super) struct WidePlates {
    piece: Piece,
    boundary: Boundary,
    /// Where forces act and responses are seen.
    places: Vec<Place>,
    /// Whether nothing else is of interest than what is seen on the centre line.
    is_on_centre_line: bool,
    known: Mutex<Vec<(Cell, WidePlate)>>,
    /// Whole bases, each of another size.
    wholes: Mutex<Vec<Arc<RatioPlate>>>,
    /// By the values, and whether they are those of the whole basis.
    low: Known<(Vec<f64>, bool), LowModes>,
}

/// A neighbourhood of values.
type Cell = [i32; 6];

/// Its width in the logarithms of $E_x/G_{zx}$ and of the ratios (of $\nu_{xy}$ in itself). A plate on its own shapes at the middle then has
/// frequencies to 1e-7, for shapes err by the square of the way from there and frequencies by the square of that; and which plate is
/// taken follows from the values alone, not from what a search met before.
const CELL: f64 = 0.05;
/// Its width in the logarithm of $E_x$: where all moduli rise alike, shapes stay.
const SCALE: f64 = 0.3;
/// Plates that are kept: what each has of its own is a tenth of the whole basis, which they share.
const KEPT: usize = 256;
/// Sizes of whole bases that are kept.
const SIZES: usize = 4;
/// Parts of the beam's highest summed frequency (2.5 times the highest line): modes below the first are summed, those below
/// the second stand in the space besides, the rest as what forces at the places do. With modes to 1.5 times the highest line summed
/// (0.6, 0.8), lines of little noise (0.1 %) were missed by up to twice it; with those to 2.25 and 3 times no less is missed than so.
const SUMMED: f64 = 0.8;
const HELD: f64 = 1.0;

impl WidePlates {
    /// On the centre line nothing is seen of what is odd across: of a plate that nothing off it touches that is left out.
    pub(super) fn new(piece: Piece, boundary: Boundary, places: Vec<Place>, touched_anywhere: bool) -> Self {
        let is_on_centre_line = !touched_anywhere && places.iter().all(|place| place.y == 0.0);
        Self {
            piece,
            boundary,
            places,
            is_on_centre_line,
            known: Mutex::default(),
            wholes: Mutex::default(),
            low: Mutex::default(),
        }
    }

    /// Whether the shapes of these plates hold what a force on a row does.
    pub(super) fn know(&self, (motion, place): Row) -> bool {
        matches!(motion, Motion::Deflection | Motion::Foot) && self.places.contains(&place)
    }

    /// The lowest modes of a plate, on its few shapes or on its whole basis.
    pub(super) fn low_modes(
        &self,
        plate: &WidePlate,
        values: &[f64],
        on_few: bool,
    ) -> Result<Arc<LowModes>, ModelError> {
        known_or(&self.low, (values.to_vec(), on_few), KEPT_MODES, || {
            if on_few {
                return LowModes::new(plate.structure.as_ref(), values, plate.summed);
            }
            let modes = ritz_modes(plate.reduced.as_ref(), values, plate.summed)?;
            Ok(LowModes::of(modes.iter().map(|mode| plate.reduced.in_whole(mode)).collect()))
        })
    }

    /// The plate for values near these.
    pub(super) fn near(&self, values: &[f64], summed: Summed) -> Result<WidePlate, ModelError> {
        let values = six(values)?;
        for (constant, &value) in RATIO_CONSTANTS.iter().zip(&values) {
            constant.check(value)?;
        }
        let [e_x, g_zx, e_y, nu_xy, g_xy, g_yz] = values;
        let place = [
            e_x.ln() / SCALE,
            (e_x / g_zx).ln() / CELL,
            e_y.ln() / CELL,
            nu_xy / CELL,
            g_xy.ln() / CELL,
            g_yz.ln() / CELL,
        ];
        let cell: Cell = place.map(|place| place.round() as i32);
        let known = |plates: &[(Cell, WidePlate)]| plates.iter().find(|(of, _)| *of == cell).map(|(_, p)| p.clone());
        if let Some(plate) = self.known.lock().ok().and_then(|plates| known(&plates)) {
            return Ok(plate);
        }
        let [scale, ratio, e_y, nu_xy, g_xy, g_yz] = cell.map(f64::from);
        let e_x = (SCALE * scale).exp();
        let ratios = [ratio, e_y, g_xy, g_yz].map(|place| (CELL * place).exp());
        let middle = [e_x, e_x / ratios[0], ratios[1], CELL * nu_xy, ratios[2], ratios[3]];
        let plate = self.at(middle, summed)?;
        if let Ok(mut plates) = self.known.lock() {
            plates.truncate(KEPT - 1);
            plates.insert(0, (cell, plate.clone()));
        }
        Ok(plate)
    }

    /// Modes of a plate with these constants that its basis holds, where those up to a frequency \[Hz\] are summed.
    pub(super) fn held(
        piece: Piece,
        boundary: Boundary,
        constants: &[f64],
        frequency: f64,
    ) -> Result<usize, ModelError> {
        let top = HELD / SUMMED * frequency;
        Ok(MindlinPlate::estimated_nodes(&piece, boundary, constants, top)?.len().max(1))
    }

    /// A plate on a basis, the same for all that have one of its size.
    fn shared(&self, plate: MindlinPlate) -> Arc<RatioPlate> {
        let size = |plate: &MindlinPlate| (plate.terms(), plate.resolved_modes());
        let mut wholes = self.wholes.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(whole) = wholes.iter().find(|whole| size(&whole.plate) == size(&plate)) {
            return Arc::clone(whole);
        }
        let rows = rows_at(&plate, &self.places);
        let whole = Arc::new(RatioPlate { membrane: plate.membrane(), plate, rows });
        wholes.truncate(SIZES - 1);
        wholes.insert(0, Arc::clone(&whole));
        whole
    }

    fn at(&self, values: Ratios, summed: Summed) -> Result<WidePlate, ModelError> {
        let Self { piece, boundary, .. } = self;
        let [e_x, g_zx, ..] = values;
        let top = match summed {
            Summed::Beam(summed) => {
                let beam = ExactBeam::new(piece, *boundary, BeamConstants { e_x, g_zx })?;
                let mode = beam.flexible_modes().nth(summed.saturating_sub(1));
                mode.map_or(f64::INFINITY, |mode| mode.frequency())
            }
            Summed::To(frequency) => frequency / SUMMED,
        };
        let constants = plate_constants(values);
        let mut nodes = MindlinPlate::estimated_nodes(piece, *boundary, &constants, HELD * top)?;
        let mut plate = match MindlinPlate::with_basis_for(piece, *boundary, &constants, nodes.len().max(1)) {
            Err(ModelError::BasisTooSmall { available, .. }) => {
                nodes.truncate(available);
                MindlinPlate::with_basis_for(piece, *boundary, &constants, available)?
            }
            plate => plate?,
        };
        if boundary.front == boundary.back && self.is_on_centre_line {
            plate = plate.only_with_nodes(&[[0, 0], [1, 0]]);
            nodes.retain(|[_, across]| across % 2 == 0);
        }
        let whole = self.shared(plate);
        let count = nodes.len().clamp(1, whole.resolved_modes().max(1));
        let reduced = ReducedStructure::answering(Arc::clone(&whole), &values, count, &self.places)?;
        let modes = ritz_modes(&reduced, &values, count)?;
        let limit = SUMMED * top * std::f64::consts::TAU;
        let below = modes.iter().filter(|mode| (f64::MIN_POSITIVE..limit).contains(&mode.angular_frequency)).count();
        let reduced = Arc::new(reduced);
        Ok(WidePlate {
            structure: Arc::<ReducedStructure<RatioPlate>>::clone(&reduced),
            reduced,
            whole,
            summed: below.max(1),
        })
    }
}

impl std::fmt::Debug for WidePlates {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("WidePlates").field("piece", &self.piece).finish_non_exhaustive()
    }
}
