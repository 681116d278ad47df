//! A panel with effects, and the coordinates in which its modes are found.

use std::sync::{Arc, Mutex, OnceLock};

use faer::Mat;

use super::beam_base::BeamBase;
use super::coupled_system::{FoundMode, System};
use super::foot::{more_yield, on_feet, port};
use super::known::{KEPT, Known, known_in_search, known_or};
use super::low_modes::{Asked, FarAnswers, LowModes};
use super::own_modes::OwnModes;
use super::row::{Row, SharedStructure};
use super::spread_effects::SpreadEffects;
use super::wide_plate::{Summed, WidePlates};
use super::{Action, CoreModulus, EffectSetting, EffectState, ElementLaw, PointElement, Seat, ShearPatch};
use crate::dense::product;
use crate::mindlin_plate::PlateTerms;
use crate::nodes::crossings;
use crate::structure::{Motion, ShearMoment, Structure};
use crate::{BeamTerms, Boundary, Damping, MindlinPlate, ModeName, ModelError, Piece, Place, RitzMode, TimoshenkoBeam};

/// Modes of the bare structure beyond those asked for.
const SPARE_MODES: usize = 10;
/// What stands where nothing does: its place has a residual shape all the same.
const NOTHING: ElementLaw = ElementLaw::Mass { mass: 0.0 };

/// A panel with effects, in coordinates of its bare modes, of the static residual shape under each element, and of each
/// resonator's own mass (Rubin, AIAA J. 13 (1975) 995).
///
/// With $C_0$, $C_1$ the residual flexibility and its next term, stiffness and mass are
/// $\mathrm{diag}(\omega_m^2)\oplus C_0$ and $I\oplus C_1$, and an element at row $r_p = (\phi_m(p), C_{0,p})$ adds
/// $k\,r_pr_p^T$ or $m\,r_pr_p^T$.
pub(crate) struct CoupledPanel {
    pub(super) structure: SharedStructure,
    piece: Piece,
    pub(super) values: Vec<f64>,
    /// Block, coordinates and $\omega^2$ of each bare mode.
    pub(super) bare: Vec<(usize, Vec<f64>, f64)>,
    rigid: usize,
    /// The residual shapes.
    pub(super) residuals: Vec<Residual>,
    plate: Option<Arc<MindlinPlate>>,
    grid: OnceLock<Vec<Vec<f64>>>,
}

/// What a force at a place does beyond the bare coordinates.
pub(super) struct Residual {
    pub row: Row,
    /// Share of each bare coordinate in what the force does altogether, for a structure that knows that in closed form.
    pub image: Vec<f64>,
    /// Else the part of it in the basis, in the coordinates of each block.
    pub shape: Vec<Vec<f64>>,
}

/// What vibrates where no effect acts.
#[derive(Debug, Clone)]
pub(crate) enum Even {
    /// A beam on a basis for the modes asked for.
    Beam(Arc<EvenBeam>),
    /// A plate, whose basis follows from its constants and from what is spread over it.
    Plate(Arc<PlatesAlone>),
}

/// Plates with what is spread over them and along their edges, but nothing that stands on them, that were found last, with their modes: a search moves what
/// stands on a plate more often than these.
pub(crate) type PlatesAlone = Known<PlateKey, (Arc<MindlinPlate>, Arc<LowModes>)>;

/// Such a plate: its size, edges, constants, how many flexible modes, and what is spread.
#[derive(Debug, PartialEq)]
pub(crate) struct PlateKey((Piece, Boundary), Vec<f64>, usize, PlateTerms);

/// Plates that are kept, of some 10 MB each: as many as a core that relaxes has nodes, and more.
const PLATES: usize = 8;

impl Even {
    /// A plate.
    pub(crate) fn plate() -> Self {
        Self::Plate(Arc::default())
    }

    /// A beam for `count` modes and some.
    pub(crate) fn beam(setting: &EffectSetting, count: usize) -> Result<Self, ModelError> {
        let terms = BeamTerms::default();
        let order = basis_terms(count + SPARE_MODES);
        let beam = Arc::new(TimoshenkoBeam::with_terms(&setting.piece, setting.boundary, order, terms)?);
        Ok(Self::Beam(Arc::new(EvenBeam { beam, known: Mutex::default(), bases: Mutex::default() })))
    }
}

/// A beam with the modes that were last found of it: a search moves what is on a beam more often than its constants.
#[derive(Debug)]
pub(crate) struct EvenBeam {
    beam: Arc<TimoshenkoBeam>,
    /// By the values of the constants, and how many modes.
    known: Known<(Vec<f64>, usize), LowModes>,
    /// Its exact modes, by constants, rotary factor and number, and by the ends.
    bases: Known<([f64; 4], Boundary), BeamBase>,
}

impl EvenBeam {
    /// With its exact modes between these ends, rigid ones and `count` flexible ones.
    pub(super) fn base(
        &self,
        (piece, boundary): (&Piece, Boundary),
        values: [f64; 2],
        rotary_factor: f64,
        count: usize,
    ) -> Result<Arc<BeamBase>, ModelError> {
        let key = ([values[0], values[1], rotary_factor, count as f64], boundary);
        known_or(&self.bases, key, KEPT, || BeamBase::new((piece, boundary), values, rotary_factor, count))
    }

    fn low_modes(&self, values: &[f64], count: usize) -> Result<Arc<LowModes>, ModelError> {
        known_or(&self.known, (values.to_vec(), count), KEPT, || LowModes::new(self.beam.as_ref(), values, count))
    }
}

/// What a panel with effects is made of.
#[derive(Clone, Copy)]
pub(crate) struct PanelWithEffects<'a> {
    pub setting: &'a EffectSetting,
    /// The panel where no effect acts, and its constants.
    pub even: &'a Even,
    pub values: &'a [f64],
    pub effects: &'a [EffectState],
    /// Of the bare modes.
    pub damping: &'a Damping,
}

fn basis_terms(summed: usize) -> usize {
    2 * summed + 24
}

/// The structure of a panel with its lowest modes, before any element joins it.
pub(super) struct ModifiedStructure {
    structure: SharedStructure,
    plate: Option<Arc<MindlinPlate>>,
    piece: Piece,
    values: Vec<f64>,
    pub(super) low: Arc<LowModes>,
    pub(super) elements: Vec<PointElement>,
    pub(super) core: Option<CoreModulus>,
    /// Side \[m\] of the feet of the elements, where it is not the usual one.
    foot: Option<f64>,
}

impl ModifiedStructure {
    /// On as many modes as `count` flexible ones with the elements want.
    pub(super) fn for_modes(parts: PanelWithEffects, count: usize) -> Result<Self, ModelError> {
        Self::new(parts, count + SPARE_MODES).map_err(|error| match error {
            // Those that are spare are no modes that one could have.
            ModelError::BasisTooSmall { available, .. } => {
                ModelError::BasisTooSmall { asked: count, available: available.saturating_sub(SPARE_MODES) }
            }
            other => other,
        })
    }

    /// A plate in the place of the beam with these constants, by its ratios, with its modes up to a frequency \[Hz\] and the elements of
    /// `others`; `effects` are all, of which no other may be spread over the panel.
    pub(super) fn wide(
        plates: &WidePlates,
        highest: f64,
        (setting, values, ratios): (&EffectSetting, &[f64], [f64; 4]),
        effects: &[EffectState],
        others: &[EffectState],
    ) -> Result<Self, ModelError> {
        let spread = SpreadEffects::of(effects, setting)?;
        if spread.terms.is_some() || spread.core.is_some() {
            return Err(ModelError::Unsupported("width-coupling beside another effect spread over the panel".into()));
        }
        let values = [values, &ratios].concat();
        let plate = plates.near(&values, Summed::To(highest))?;
        let mut elements = on_feet(elements(others, setting)?);
        add_patches(&mut elements, &spread.patches, plate.whole.as_ref(), &values)?;
        let is_known = elements.iter().filter_map(row).all(|row| plates.know(row));
        let low = plates.low_modes(&plate, &values, is_known)?;
        let structure = if is_known { plate.structure } else { plate.whole };
        Ok(Self { structure, plate: None, piece: setting.piece, values, low, elements, core: None, foot: spread.foot })
    }

    /// On the first `summed` flexible modes of the structure with what effects spread over it.
    pub(super) fn new(parts: PanelWithEffects, summed: usize) -> Result<Self, ModelError> {
        let PanelWithEffects { setting, even, values, effects, .. } = parts;
        let (piece, boundary) = (setting.piece, setting.boundary);
        let spread = SpreadEffects::of(effects, setting)?;
        if spread.plate.is_some() {
            return Err(ModelError::Unsupported(
                "width-coupling in a model file: write structure \"mindlin-plate\" with its six constants".into(),
            ));
        }
        let mut elements = elements(effects, setting)?;
        let is_even = spread.terms.is_none();
        let (structure, plate): (SharedStructure, _) = match (even, spread.terms) {
            (Even::Beam(even), None) => (Arc::<TimoshenkoBeam>::clone(&even.beam), None),
            (Even::Beam(_), Some(terms)) => {
                let order = basis_terms(summed);
                (Arc::new(TimoshenkoBeam::with_terms(&piece, boundary, order, terms)?), None)
            }
            (Even::Plate(known), terms) => {
                let edge_mass = take_edge_mass(&mut elements);
                elements = on_feet(elements);
                let terms = PlateTerms { spread: terms.unwrap_or_default(), edge_mass };
                let key = || PlateKey((piece, boundary), values.to_vec(), summed, terms.clone());
                let found = known_in_search(known, key, PLATES, || {
                    let plate = MindlinPlate::uneven_with_basis_for((&piece, boundary), values, summed, &terms)?;
                    let low = LowModes::new(&plate, values, summed)?;
                    Ok((Arc::new(plate), Arc::new(low)))
                })?;
                let (plate, low) = found.as_ref();
                add_patches(&mut elements, &spread.patches, plate.as_ref(), values)?;
                (Arc::<MindlinPlate>::clone(plate), Some((Arc::clone(plate), Arc::clone(low))))
            }
        };
        let (plate, low) = match (even, plate) {
            (_, Some((plate, low))) => (Some(plate), low),
            (Even::Beam(even), None) if is_even => (None, even.low_modes(values, summed)?),
            _ => (None, Arc::new(LowModes::new(structure.as_ref(), values, summed)?)),
        };
        Ok(Self {
            structure,
            plate,
            piece,
            values: values.to_vec(),
            low,
            elements,
            core: spread.core,
            foot: spread.foot,
        })
    }

    /// The panel without any element.
    pub(super) fn panel(&self) -> CoupledPanel {
        CoupledPanel {
            structure: Arc::clone(&self.structure),
            piece: self.piece,
            values: self.values.clone(),
            bare: self.low.modes.clone(),
            rigid: self.low.rigid,
            residuals: vec![],
            plate: self.plate.clone(),
            grid: OnceLock::new(),
        }
    }

    /// What the modes beyond the lowest do at the elements and at `ports`.
    pub(super) fn far_answers(&self, ports: &[Place]) -> Result<FarAnswers, ModelError> {
        self.far_answers_in(&self.ports(ports), &[], 0)
    }

    /// What moves at each of some places: where an element stands, its foot.
    pub(super) fn ports(&self, places: &[Place]) -> Vec<Row> {
        let standing: Vec<Row> = self.elements.iter().filter_map(row).collect();
        places.iter().map(|&place| port(place, &standing)).collect()
    }

    /// The same in any rows, and in others where no force acts, with second shapes of the first `twice` elements.
    pub(super) fn far_answers_in(
        &self,
        ports: &[Row],
        watched: &[Row],
        twice: usize,
    ) -> Result<FarAnswers, ModelError> {
        let elements: Vec<Row> = self.elements.iter().filter_map(row).collect();
        let asked = Asked { elements: &elements, ports, watched, twice };
        let mut answers = self.low.far_answers(self.structure.as_ref(), &self.values, asked)?;
        if let Some(side) = self.foot {
            let more = more_yield(side, shear_stiffnesses(self.structure.as_ref(), &self.values)?);
            let forces = [&elements[..], ports].concat();
            let [far, _] = &mut answers.series;
            for (q, foot) in forces.iter().enumerate().filter(|(_, row)| row.0 == Motion::Foot) {
                let same = (0..forces.len()).filter(|p| forces[*p] == *foot);
                same.for_each(|p| far[(p, q)] += more);
            }
        }
        Ok(answers)
    }

    /// With the residual shapes of all elements and of `ports`, where elements without mass stand: the panel and its matrices.
    /// `answers` are of these, and may be of more ports.
    pub(super) fn with_residuals(
        &self,
        answers: &FarAnswers,
        ports: &[Place],
        damping: &Damping,
    ) -> (CoupledPanel, System) {
        let mut panel = self.panel();
        let without_mass = |(motion, place)| PointElement { law: NOTHING, seat: Seat::At(place), motion };
        let ports = self.ports(ports).into_iter().map(without_mass);
        let elements: Vec<PointElement> = self.elements.iter().copied().chain(ports).collect();
        for (number, row) in elements.iter().filter_map(row).enumerate() {
            let share = |(m, mode): (usize, &(usize, Vec<f64>, f64))| {
                if mode.2 > 0.0 { answers.near[(m, number)] / mode.2 } else { 0.0 }
            };
            let image = panel.bare.iter().enumerate().map(share).collect();
            let shape = if self.plate.is_some() { answers.shape(number) } else { vec![] };
            panel.residuals.push(Residual { row, image, shape });
        }
        let system = System::new(&self.low, answers, &elements, damping);
        (panel, system)
    }

    /// The modes of the panel itself, with its patches, and their shares in modes with all that stands on it; none where nothing does.
    pub(super) fn own_modes(
        &self,
        answers: &FarAnswers,
        damping: &Damping,
        modes: &[FoundMode],
    ) -> Result<OwnModes, ModelError> {
        let is_of_panel = |element: &PointElement| matches!(element.motion, Motion::Shear(_));
        if self.elements.iter().all(is_of_panel) {
            return Ok(OwnModes::default());
        }
        let alone = |element: &PointElement| PointElement {
            law: if is_of_panel(element) { element.law } else { NOTHING },
            ..*element
        };
        let mut patches: Vec<PointElement> = self.elements.iter().map(alone).collect();
        // The ports stand behind the elements, with nothing on them.
        patches.resize(answers.series[1].ncols(), PointElement { law: NOTHING, ..self.elements[0] });
        let system = System::new(&self.low, answers, &patches, damping);
        let size = system.panel;
        let own = system.solve()?;
        let shapes = |modes: &[FoundMode]| Mat::from_fn(size, modes.len(), |i, n| modes[n].2[i]);
        let images = product(system.mass.submatrix(0, 0, size, size), shapes(modes).as_ref());
        let shares = product(shapes(&own).transpose(), images.as_ref());
        Ok(OwnModes {
            angular_frequency: own.iter().map(|(omega, ..)| *omega).collect(),
            shares: (0..modes.len()).map(|n| shares.col_as_slice(n).to_vec()).collect(),
        })
    }
}

impl CoupledPanel {
    /// How many of the bare modes are rigid.
    pub(super) fn rigid(&self) -> usize {
        self.rigid
    }

    /// The deflections of all coordinates at points along the piece: mode m has about m + 1 nodes, and eight points between
    /// two of them part every pair.
    pub(super) fn grid(&self, count: usize) -> Vec<Vec<f64>> {
        let points = 8 * (count + 2);
        let place =
            |index: usize| Place { x: self.piece.length * ((index as f64 + 0.5) / points as f64 - 0.5), y: 0.0 };
        (0..points).map(|index| self.deflections(place(index))).collect()
    }

    /// Nodes along a beam, of `count` modes that are asked for.
    pub(super) fn nodes(&self, shares: &[f64], count: usize) -> usize {
        nodes(self.grid.get_or_init(|| self.grid(count)), shares)
    }

    /// The name of a plate's mode; `None` for a beam's.
    pub(super) fn name(&self, shares: &[f64]) -> Option<ModeName> {
        let plate = self.plate.as_ref()?;
        let block = |(block, matrices): (usize, &crate::Block)| {
            let mut coordinates = vec![0.0; matrices.size()];
            let mut add =
                |share: f64, shape: &[f64]| coordinates.iter_mut().zip(shape).for_each(|(sum, s)| *sum += share * s);
            for ((_, shape, _), share) in self.bare.iter().zip(shares).filter(|((own, ..), _)| *own == block) {
                add(*share, shape);
            }
            for (residual, share) in self.residuals.iter().zip(shares.iter().skip(self.bare.len())) {
                add(*share, residual.shape.get(block).map_or(&[][..], |shape| shape));
            }
            RitzMode { angular_frequency: 0.0, block, coordinates }
        };
        let parts: Vec<RitzMode> = self.structure.blocks().iter().enumerate().map(block).collect();
        Some(plate.name_of_sum(&parts))
    }

    /// Values of all bare coordinates in one row.
    pub(super) fn bare_row(&self, (motion, place): Row) -> Result<Vec<f64>, ModelError> {
        let row = |block: usize| self.structure.motion_row(block, motion, place);
        let rows: Option<Vec<Vec<f64>>> = (0..self.structure.blocks().len()).map(row).collect();
        let rows = rows.ok_or_else(|| ModelError::Unsupported("an effect on a rotation of this structure".into()))?;
        Ok(self.bare.iter().map(|(block, shape, _)| seen(&rows, *block, shape)).collect())
    }

    /// Deflection at a place of each coordinate of the panel: bare coordinates, then residual shapes.
    pub(super) fn deflections(&self, place: Place) -> Vec<f64> {
        let rows: Vec<_> =
            (0..self.structure.blocks().len()).map(|block| self.structure.shape_row(block, place)).collect();
        let port = self.port(place);
        let bare: Vec<f64> = self.bare.iter().map(|(block, shape, _)| seen(&rows, *block, shape)).collect();
        let residual = |residual: &Residual| -> f64 {
            let shape = residual.shape.iter().enumerate().map(|(block, shape)| seen(&rows, block, shape)).sum::<f64>();
            shape + self.beyond_basis(port, &bare, residual)
        };
        let residuals: Vec<f64> = self.residuals.iter().map(residual).collect();
        bare.into_iter().chain(residuals).collect()
    }

    /// What moves at a place: where an element stands, its foot.
    pub(super) fn port(&self, place: Place) -> Row {
        port(place, &self.residuals.iter().map(|residual| residual.row).collect::<Vec<_>>())
    }

    /// What the basis lacks of a residual shape in a row where the bare coordinates have these values.
    pub(super) fn beyond_basis(&self, row: Row, bare: &[f64], residual: &Residual) -> f64 {
        match self.structure.static_flexibility(&self.values, [row, residual.row]) {
            Some(whole) => whole - bare.iter().zip(&residual.image).map(|(a, b)| a * b).sum::<f64>(),
            None => self.structure.static_remainder(&self.values, [row, residual.row]).unwrap_or_default(),
        }
    }

    /// The modes of the panel and its matrices, in rising order, `count` flexible ones.
    pub(super) fn solve(parts: PanelWithEffects, count: usize) -> Result<(Self, System, Vec<FoundMode>), ModelError> {
        let modified = ModifiedStructure::for_modes(parts, count)?;
        let answers = modified.far_answers(&[])?;
        modified.solve(&answers, parts.damping, count)
    }
}

impl ModifiedStructure {
    /// As [`CoupledPanel::solve`], with answers that may be of ports too.
    pub(super) fn solve(
        &self,
        answers: &FarAnswers,
        damping: &Damping,
        count: usize,
    ) -> Result<(CoupledPanel, System, Vec<FoundMode>), ModelError> {
        if self.core.is_some() {
            return Err(ModelError::Unsupported("a core that relaxes in a model of modes".into()));
        }
        let (panel, system) = self.with_residuals(answers, &[], damping);
        let mut found = system.solve()?;
        found.truncate(panel.rigid() + count);
        Ok((panel, system, found))
    }
}

/// A shape of one block in rows of all blocks.
fn seen(rows: &[Vec<f64>], block: usize, shape: &[f64]) -> f64 {
    rows.get(block).map_or(0.0, |row| row.iter().zip(shape).map(|(r, c)| r * c).sum())
}

pub(super) fn nodes(grid: &[Vec<f64>], shares: &[f64]) -> usize {
    let along = grid.iter().map(|row| row.iter().zip(shares).map(|(value, share)| value * share).sum());
    crossings(&along.collect::<Vec<f64>>())
}

/// Where an element of [`elements`] sits.
pub(super) fn row(element: &PointElement) -> Option<Row> {
    match element.seat {
        Seat::At(place) | Seat::AlongEdge { middle: place, .. } => Some((element.motion, place)),
        Seat::AtResponse => None,
    }
}

/// The elements of all effects, each at a place of its own.
pub(crate) fn elements(effects: &[EffectState], setting: &EffectSetting) -> Result<Vec<PointElement>, ModelError> {
    let mut elements = Vec::new();
    for state in effects {
        for action in state.effect.act(&state.values_in(1)?, setting)? {
            let Action::Element(mut element) = action else { continue };
            if element.seat == Seat::AtResponse {
                let Some(place) = setting.record.response_at else { continue };
                element.seat = Seat::At(place);
            }
            elements.push(element);
        }
    }
    Ok(elements)
}

/// Degrees of the strains of a patch, both ways together, at most: over a few centimetres no mode has more.
const PATCH_DEGREES: usize = 3;

fn shear_stiffnesses(plate: &dyn Structure, values: &[f64]) -> Result<[f64; 2], ModelError> {
    let [_, _, _, _, a_55, a_44, ..] = plate.coefficients(values)?[..] else { return Ok([f64::INFINITY; 2]) };
    Ok([a_55, a_44])
}

/// Adds what patches take from a plate's shear stiffnesses: springs that push on the moments of the strain,
/// $-\text{loss}\,A\int\gamma^2dx\,dy$ in all.
fn add_patches(
    elements: &mut Vec<PointElement>,
    patches: &[ShearPatch],
    plate: &dyn Structure,
    values: &[f64],
) -> Result<(), ModelError> {
    for &ShearPatch { loss, span, at } in patches {
        for (across, shear) in [false, true].into_iter().zip(shear_stiffnesses(plate, values)?) {
            let all = (0..=PATCH_DEGREES).flat_map(|i| (0..=PATCH_DEGREES - i).map(move |j| [i, j]));
            elements.extend(all.map(|degrees| PointElement {
                law: ElementLaw::Spring { stiffness: -loss * shear, damping: 0.0 },
                seat: Seat::At(at),
                motion: Motion::Shear(ShearMoment { across, span, degrees }),
            }));
        }
    }
    Ok(())
}

/// Takes the masses along edges from the list: what each of left and right carries, and each of front and back, for either pair carries the same.
fn take_edge_mass(elements: &mut Vec<PointElement>) -> [f64; 2] {
    let mut both = [0.0; 2];
    elements.retain(|element| match (element.seat, element.law) {
        (Seat::AlongEdge { along_x, .. }, ElementLaw::Mass { mass }) => {
            both[usize::from(along_x)] += mass;
            false
        }
        _ => true,
    });
    both.map(|mass| 0.5 * mass)
}
