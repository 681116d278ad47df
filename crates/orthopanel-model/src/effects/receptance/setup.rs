//! A test as its receptances need it: piece, records, and the effects that are switched on.

use std::sync::{Arc, Mutex};

use super::modal_base::{ModalBase, SharedStructure};
use super::model::{ReceptanceModel, RecordModel};
use super::modulus_path::NodeBases;
use super::moved_structure::Moved;
use super::record::RecordPlan;
use super::view::View;
use super::wide_plate::{Summed, WidePlates};
use crate::effects::spread_effects::SpreadEffects;
use crate::effects::{CoreModulus, EffectSetting, EffectState, RecordSetting};
use crate::{
    BEAM_CONSTANTS, BeamTerms, Boundary, Damping, ModalModel, Mode, ModelError, Motion, Piece, Place, TimoshenkoBeam,
    side_by_side,
};

/// What stays the same while a search moves constants, damping and the parameters of effects.
pub struct ReceptanceSetup {
    piece: Piece,
    boundary: Boundary,
    suspension: Vec<Place>,
    records: Vec<RecordSetting>,
    summed: usize,
    beam: SharedStructure,
    /// Modes of the even beam at the constants asked for last.
    even: Mutex<Vec<Arc<ModalBase>>>,
    plates: WidePlates,
}

impl ReceptanceSetup {
    /// A beam with these records. `summed` flexible modes enter at every line: take those below 2.5 times the highest
    /// line, or the series that stands for the others ends too early. Records without a number are given that of
    /// their order, from 1.
    ///
    /// # Errors
    /// As [`TimoshenkoBeam::new`], and [`ModelError::OffPiece`] for a place off the piece.
    pub fn new(
        piece: &Piece,
        boundary: Boundary,
        suspension: &[Place],
        records: &[RecordSetting],
        summed: usize,
    ) -> Result<Self, ModelError> {
        let piece = piece.checked()?;
        let summed = summed.max(1);
        let places = records.iter().flat_map(|record| [record.force_at, record.response_at]).flatten();
        let places = once_each(places.chain(suspension.iter().copied()));
        places.iter().try_for_each(|place| piece.contains(*place))?;
        let records: Vec<_> = records.to_vec();
        let records = records.into_iter().enumerate().map(|(i, record)| record.numbered(i + 1)).collect();
        let beam = Arc::new(TimoshenkoBeam::new(&piece, boundary, basis_terms(summed))?);
        let even = Mutex::new(vec![]);
        let plates = WidePlates::new(piece, boundary, places);
        Ok(Self { piece, boundary, suspension: suspension.to_vec(), records, summed, beam, even, plates })
    }

    /// What an effect may ask about record `index`, counted from zero.
    pub fn setting(&self, index: usize) -> Option<EffectSetting> {
        let record = self.records.get(index)?.clone();
        Some(self.setting_of(record))
    }

    fn setting_of(&self, record: RecordSetting) -> EffectSetting {
        EffectSetting { piece: self.piece, boundary: self.boundary, suspension: self.suspension.clone(), record }
    }

    /// Accelerances of all records at the constants $E_x$, $G_{zx}$ (or those of the structure), these damping ratios
    /// of the flexible modes, and these effects.
    ///
    /// Damping belongs to the modes of the piece without point elements and at its relaxed modulus, but with every term
    /// that is spread over it and with its supports: $\zeta_m$ of $s^2 + 2\zeta_m\omega_ms + \omega_m^2$. Ratios in the list
    /// have a derivative each, and that of the modes beyond has one.
    ///
    /// # Errors
    /// [`ModelError::EffectValues`], [`ModelError::EffectParameter`] and [`ModelError::EffectNeeds`] where an effect cannot
    /// act, [`ModelError::OffPiece`] where it moves a place off the piece, and as [`crate::ritz_modes()`].
    pub fn model(
        &self,
        values: &[f64],
        damping: &Damping,
        effects: &[EffectState],
    ) -> Result<ReceptanceModel, ModelError> {
        let constants = BEAM_CONSTANTS.len();
        let free = damping.ratios.len();
        let first_effect = constants + free + 1;
        let Based { bases, core, columns: structural, summed } = self.based(values, effects, first_effect)?;
        let shear_modulus = values.get(1).copied().unwrap_or_default();
        let record = |record: &RecordSetting| {
            let mut plan = RecordPlan::new(&self.setting_of(record.clone()), effects, first_effect)?;
            plan.columns.structure.clone_from(&structural);
            plan.columns.zetas = (constants, free);
            Ok(match &bases {
                Bases::Real(base) => RecordModel::real(View::new(base, &plan.active, &plan.slopes)?, plan),
                Bases::Complex(bases) => {
                    let path = bases.path(&plan.active, &plan.slopes)?;
                    RecordModel::complex(path, core, shear_modulus, plan)
                }
            })
        };
        let records = side_by_side::map(&self.records, record);
        let records = records.into_iter().collect::<Result<Vec<_>, ModelError>>()?;
        let columns = first_effect + effects.iter().map(|effect| effect.values.len()).sum::<usize>();
        let zetas: Vec<f64> = (1..=summed + 1).map(|mode| damping.ratio(mode)).collect();
        Ok(ReceptanceModel::new(records, zetas, columns))
    }

    /// The modes that every line sums and that lie below `up_to` \[Hz\], without point elements, seen from these places.
    ///
    /// # Errors
    /// As [`ReceptanceSetup::model`].
    pub fn summed_modes(
        &self,
        values: &[f64],
        (damping, effects): (&Damping, &[EffectState]),
        [forces, responses]: [&[Place]; 2],
        up_to: f64,
    ) -> Result<ModalModel, ModelError> {
        let base = self.real_base(values, effects)?;
        let rows: Vec<_> = forces.iter().chain(responses).map(|&place| (Motion::Deflection, place)).collect();
        let shapes = (0..base.blocks.len()).map(|block| base.rows(block, &rows)).collect::<Result<Vec<_>, _>>()?;
        let modes = base.near.iter().enumerate().map(|(index, &(block, number))| {
            let at = |row: usize| shapes[block][(row, number)];
            let flexible = (index + 1).saturating_sub(base.rigid);
            Mode {
                angular_frequency: base.blocks[block].lambda[number].sqrt(),
                damping_ratio: if flexible == 0 { 0.0 } else { damping.ratio(flexible) },
                at_forces: (0..forces.len()).map(at).collect(),
                at_responses: (forces.len()..rows.len()).map(at).collect(),
            }
        });
        let modes = modes.take_while(|mode| mode.angular_frequency < std::f64::consts::TAU * up_to);
        ModalModel::new(forces.len(), responses.len(), modes.collect())
    }

    /// The modes that damping belongs to.
    fn real_base(&self, values: &[f64], effects: &[EffectState]) -> Result<Arc<ModalBase>, ModelError> {
        match self.based(values, effects, BEAM_CONSTANTS.len())?.bases {
            Bases::Real(base) => Ok(base),
            // Damping is of the relaxed modulus.
            Bases::Complex(_) => self.even(values),
        }
    }

    /// The modes with what effects spread over the piece; `first_effect` is the column of the first effect's first value.
    fn based(&self, values: &[f64], effects: &[EffectState], first_effect: usize) -> Result<Based, ModelError> {
        let setting = self.setting_of(self.records.first().cloned().unwrap_or_default());
        let modified = SpreadEffects::of(effects, &setting, first_effect)?;
        let constants = 0..BEAM_CONSTANTS.len();
        if let Some((ratios, column)) = modified.plate {
            let values: Vec<f64> = values.iter().chain(&ratios).copied().collect();
            let plate = self.plates.near(&values, Summed::Beam(self.summed))?;
            let base = ModalBase::new(&plate.structure, &values, plate.summed, &[], &[])?;
            let columns = constants.chain(column..column + ratios.len()).collect();
            return Ok(Based { bases: Bases::Real(Arc::new(base)), core: None, columns, summed: plate.summed });
        }
        let is_even = modified.terms.is_none();
        let (structure, moved): (SharedStructure, Vec<Moved>) = match modified.terms {
            Some(terms) => {
                let beam = Arc::new(self.uneven(terms.clone())?);
                let moved = self.moved(&terms, &beam)?;
                (beam, moved)
            }
            None => (Arc::clone(&self.beam), vec![]),
        };
        let (numbers, columns): (Vec<usize>, Vec<usize>) = modified.parameters.into_iter().unzip();
        let columns = constants.chain(columns).collect();
        let bases = match modified.core {
            Some((core, _)) => {
                Bases::Complex(NodeBases::new(&structure, values, &core, self.summed, &numbers, &moved)?)
            }
            None if is_even => Bases::Real(self.even(values)?),
            None => Bases::Real(Arc::new(ModalBase::new(&structure, values, self.summed, &numbers, &moved)?)),
        };
        Ok(Based { bases, core: modified.core, columns, summed: self.summed })
    }

    /// The modes of the even beam: starts of many effects are tried at the same constants.
    fn even(&self, values: &[f64]) -> Result<Arc<ModalBase>, ModelError> {
        let known = |bases: &[Arc<ModalBase>]| bases.iter().find(|base| base.values == values).cloned();
        // A lock that a panic has poisoned only costs the repetition.
        if let Some(base) = self.even.lock().ok().and_then(|bases| known(&bases)) {
            return Ok(base);
        }
        let base = Arc::new(ModalBase::new(&self.beam, values, self.summed, &[], &[])?);
        if let Ok(mut bases) = self.even.lock() {
            bases.truncate(KEPT - 1);
            bases.insert(0, Arc::clone(&base));
        }
        Ok(base)
    }

    fn uneven(&self, terms: BeamTerms) -> Result<TimoshenkoBeam, ModelError> {
        TimoshenkoBeam::with_terms(&self.piece, self.boundary, basis_terms(self.summed), terms)
    }

    /// The beam with span and place of each shear loss moved.
    fn moved(&self, terms: &BeamTerms, beam: &Arc<TimoshenkoBeam>) -> Result<Vec<Moved>, ModelError> {
        // Shapes bend over a tenth of the length: 1e-5 of it leaves 1e-7 of rounding and of curvature.
        let step = 1e-5 * self.piece.length;
        let side = |index: usize, span: f64, at: f64| {
            let mut terms = terms.clone();
            if let Some(loss) = terms.losses.get_mut(index) {
                loss.span += span;
                loss.at += at;
            }
            self.uneven(terms)
        };
        let mut moved = Vec::new();
        for index in 0..terms.losses.len() {
            // The rotary factor stands first; loss, span and place follow for each.
            let first = 1 + 3 * index;
            let spans = [side(index, -step, 0.0)?, side(index, step, 0.0)?];
            moved.push(Moved::new(first + 1, step, beam, spans));
            let places = [side(index, 0.0, -step)?, side(index, 0.0, step)?];
            moved.push(Moved::new(first + 2, step, beam, places));
        }
        Ok(moved)
    }
}

/// What all records share.
struct Based {
    bases: Bases,
    /// With the column of its first parameter.
    core: Option<(CoreModulus, usize)>,
    /// Column of each parameter of the structure.
    columns: Vec<usize>,
    /// Flexible modes that every line sums.
    summed: usize,
}

enum Bases {
    Real(Arc<ModalBase>),
    Complex(NodeBases),
}

fn once_each(places: impl Iterator<Item = Place>) -> Vec<Place> {
    places.fold(vec![], |mut known, place| {
        known.extend((!known.contains(&place)).then_some(place));
        known
    })
}

/// Bases of the even beam that are kept.
const KEPT: usize = 4;

/// Twice as many terms as modes, and some: the sum's modes then stand to rounding. Half of that looks like an effect.
fn basis_terms(summed: usize) -> usize {
    2 * summed + 24
}
