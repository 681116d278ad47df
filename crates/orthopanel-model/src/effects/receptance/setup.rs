//! A test as its receptances need it: piece, records, and the effects that are switched on.

use std::sync::Arc;

use super::modal_base::ModalBase;
use super::model::{ReceptanceModel, RecordModel};
use super::modulus_path::NodeBases;
use super::record::RecordPlan;
use super::view::View;
use crate::effects::row::SharedStructure;
use crate::effects::wide_plate::{Summed, WidePlates};
use crate::effects::{CoreModulus, EffectSetting, EffectState, RecordSetting, SpreadEffects};
use crate::{Boundary, Damping, ModalModel, Mode, ModelError, Motion, Piece, Place, TimoshenkoBeam, side_by_side};

/// What stays the same while constants, damping and the parameters of effects change.
pub struct ReceptanceSetup {
    piece: Piece,
    boundary: Boundary,
    suspension: Vec<Place>,
    records: Vec<RecordSetting>,
    summed: usize,
    beam: SharedStructure,
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
        let plates = WidePlates::new(piece, boundary, places, false);
        Ok(Self { piece, boundary, suspension: suspension.to_vec(), records, summed, beam, plates })
    }

    fn setting_of(&self, record: RecordSetting) -> EffectSetting {
        EffectSetting { piece: self.piece, boundary: self.boundary, suspension: self.suspension.clone(), record }
    }

    /// Accelerances of all records at the constants $E_x$, $G_{zx}$ (or those of the structure), these damping ratios
    /// of the flexible modes, and these effects.
    ///
    /// Damping belongs to the modes of the piece without point elements and at its relaxed modulus, but with every term
    /// that is spread over it and with its supports: $\zeta_m$ of $s^2 + 2\zeta_m\omega_ms + \omega_m^2$.
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
        let (bases, summed) = self.bases(values, effects)?;
        let record = |record: &RecordSetting| {
            let plan = RecordPlan::new(&self.setting_of(record.clone()), effects)?;
            Ok(match &bases {
                Bases::Real(base) => RecordModel::real(View::new(base, &plan.rows)?, plan),
                Bases::Complex(bases, core) => RecordModel::complex(bases.path(&plan.rows)?, *core, plan),
            })
        };
        let records = side_by_side::map(&self.records, record).into_iter().collect::<Result<Vec<_>, ModelError>>()?;
        Ok(ReceptanceModel::new(records, (1..=summed + 1).map(|mode| damping.ratio(mode)).collect()))
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
        let base = match self.bases(values, effects)?.0 {
            Bases::Real(base) => base,
            // Damping is of the relaxed modulus.
            Bases::Complex(..) => ModalBase::new(&self.beam, values, self.summed)?,
        };
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

    /// The modes with what effects spread over the piece, and how many flexible ones every line sums.
    fn bases(&self, values: &[f64], effects: &[EffectState]) -> Result<(Bases, usize), ModelError> {
        let setting = self.setting_of(self.records.first().cloned().unwrap_or_default());
        let SpreadEffects { terms, core, plate, .. } = SpreadEffects::of(effects, &setting)?;
        if let Some(ratios) = plate {
            let values: Vec<f64> = values.iter().chain(&ratios).copied().collect();
            let plate = self.plates.near(&values, Summed::Beam(self.summed))?;
            return Ok((Bases::Real(ModalBase::new(&plate.structure, &values, plate.summed)?), plate.summed));
        }
        let structure: SharedStructure = match terms {
            Some(terms) => {
                let order = basis_terms(self.summed);
                Arc::new(TimoshenkoBeam::with_terms(&self.piece, self.boundary, order, terms)?)
            }
            None => Arc::clone(&self.beam),
        };
        let bases = match core {
            Some(core) => Bases::Complex(NodeBases::new(&structure, values, &core, self.summed)?, core),
            None => Bases::Real(ModalBase::new(&structure, values, self.summed)?),
        };
        Ok((bases, self.summed))
    }
}

enum Bases {
    Real(ModalBase),
    Complex(NodeBases, CoreModulus),
}

fn once_each(places: impl Iterator<Item = Place>) -> Vec<Place> {
    places.fold(vec![], |mut known, place| {
        known.extend((!known.contains(&place)).then_some(place));
        known
    })
}

/// Twice as many terms as modes, and some: the sum's modes then stand to rounding. Half of that looks like an effect.
fn basis_terms(summed: usize) -> usize {
    2 * summed + 24
}
