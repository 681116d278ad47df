//! From a [`PanelModel`] to its modes and to the hinge, [`ModalModel`].

use std::sync::Arc;

use crate::effects::{CoupledPanel, Even, PanelWithEffects};
use crate::limits;
use crate::structure_modes::NaturalMode as _;
use crate::{
    BeamConstants, BeamMode, EffectSetting, EffectState, ExactBeam, MindlinPlate, ModalModel, ModelError, Owner,
    PLATE_CONSTANTS, PanelMode, PanelModel, Place, RitzMode, Structure, StructureKind, TimoshenkoBeam, ritz_modes,
};

/// Which modes to keep beside the rigid ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ModeRange {
    /// This many flexible modes.
    Count(usize),
    /// Every flexible mode up to this frequency \[Hz\].
    UpTo(f64),
}

impl ModeRange {
    /// Most flexible modes that one model may have; a plate has as many as its basis resolves, which are fewer.
    pub const MOST: usize = limits::MODES;

    /// The range, if it has a meaning. What a plate holds its basis tells.
    pub(crate) fn checked(self, structure: StructureKind) -> Result<Self, ModelError> {
        match self {
            Self::Count(count) if count > Self::MOST && structure != StructureKind::MindlinPlate => {
                Err(ModelError::BasisTooSmall { asked: count, available: Self::MOST })
            }
            Self::UpTo(frequency) if !(frequency.is_finite() && frequency > 0.0) => {
                Err(ModelError::Size { name: "highest frequency", value: frequency, unit: "Hz" })
            }
            _ => Ok(self),
        }
    }
}

/// A place, in lengths and widths from the centre, on no line of symmetry; modes have their nodes elsewhere.
const MARK: [f64; 2] = [0.463_7, 0.381_9];

impl PanelModel {
    /// The rigid modes, then the flexible ones of `range`, in rising order, of whatever structure the model has: exact
    /// for a beam, and for a plate on a basis that holds them to about 1e-4 of their frequencies. With a viscoelastic core each
    /// at the core's storage modulus at its own frequency, with the core's loss in its damping ratio.
    ///
    /// # Errors
    /// [`ModelError::MissingConstant`], [`ModelError::Constant`], [`ModelError::Size`] or
    /// [`ModelError::IndefiniteLaw`] where the model has no physical meaning, [`ModelError::BasisTooSmall`] or
    /// [`ModelError::BeyondBasis`] for more modes than can be found, [`ModelError::Unsupported`] for an effect that this
    /// version cannot solve.
    pub fn modes(&self, range: ModeRange) -> Result<Vec<PanelMode>, ModelError> {
        if self.relaxes() { self.modes_with_core(range) } else { self.modes_without_core(range) }
    }

    fn modes_without_core(&self, range: ModeRange) -> Result<Vec<PanelMode>, ModelError> {
        match self.structure {
            _ if !self.effects.is_empty() => self.coupled_modes(range.checked(self.structure)?),
            StructureKind::TimoshenkoBeam => {
                let modes = self.beam_modes(range)?;
                let rigid = self.boundary.rigid_modes();
                let number = |index: usize| (index + 1).saturating_sub(rigid);
                let named = |(index, mode)| PanelMode::of_beam(mode, self.piece.length, number(index));
                Ok(modes.into_iter().enumerate().map(named).collect())
            }
            StructureKind::MindlinPlate => {
                self.check()?;
                let (plate, modes) = self.plate_modes(range.checked(self.structure)?)?;
                let plate = Arc::new(plate);
                Ok(modes.into_iter().map(|mode| PanelMode::of_plate(&plate, mode)).collect())
            }
        }
    }

    /// The structure on a basis that holds its first `count` flexible modes, and the values of its constants in the
    /// order of [`Structure::constants`].
    ///
    /// # Errors
    /// As [`PanelModel::modes`].
    pub(crate) fn structure_for(&self, count: usize) -> Result<(Box<dyn Structure>, Vec<f64>), ModelError> {
        self.check()?;
        Ok(match self.structure {
            StructureKind::TimoshenkoBeam => {
                let values = vec![self.constant("e_x")?, self.constant("g_zx")?];
                // 60 terms hold 20 modes to 1e-9, 220 terms 100 (tests/beam_three_ways.rs).
                let terms = 2 * count + 20;
                (Box::new(TimoshenkoBeam::new(&self.piece, self.boundary, terms)?), values)
            }
            StructureKind::MindlinPlate => {
                let values = self.plate_constants()?;
                (Box::new(MindlinPlate::with_basis_for(&self.piece, self.boundary, &values, count)?), values.to_vec())
            }
        })
    }

    /// Modes of a panel with effects. Those of the bare modes' damping ratios that they hold mix in each.
    fn coupled_modes(&self, range: ModeRange) -> Result<Vec<PanelMode>, ModelError> {
        let (values, effects) = self.with_effects()?;
        let setting = EffectSetting::of_panel(&self.piece, self.boundary);
        let first = |count: usize| {
            let even = self.even(&setting, count)?;
            let parts = self.on_even(&setting, &even, &values, &effects);
            CoupledPanel::modes(parts, count)
        };
        let modes = match range {
            ModeRange::Count(count) => first(count)?,
            ModeRange::UpTo(frequency) => {
                let limit = frequency * std::f64::consts::TAU;
                // As many as the bare panel has there, and what resonators and masses may bring down.
                let mut count = self.bare_count(&values, frequency)?.saturating_add(effects.len() + 4);
                loop {
                    let (exhausted, modes) = match first(count.min(ModeRange::MOST)) {
                        Err(ModelError::BasisTooSmall { available, .. }) if available > 0 => (true, first(available)?),
                        found => (count >= ModeRange::MOST, found?),
                    };
                    let reached = modes.last().map_or(0.0, |mode| mode.angular_frequency);
                    if reached > limit {
                        break modes.into_iter().filter(|mode| mode.angular_frequency <= limit).collect();
                    }
                    if exhausted {
                        let available = modes.iter().filter(|mode| mode.angular_frequency > 0.0).count();
                        let reached = reached / std::f64::consts::TAU;
                        return Err(ModelError::BeyondBasis { frequency, available, reached });
                    }
                    count *= 2;
                }
            }
        };
        Ok(modes.into_iter().map(PanelMode::of_coupled).collect())
    }

    /// What vibrates without effects, on a basis for `count` modes.
    pub(crate) fn even(&self, setting: &EffectSetting, count: usize) -> Result<Even, ModelError> {
        match self.structure {
            StructureKind::TimoshenkoBeam => Even::beam(setting, count),
            StructureKind::MindlinPlate => Ok(Even::plate()),
        }
    }

    /// The panel with these effects on what vibrates without them, at these values of its constants.
    pub(crate) fn on_even<'a>(
        &'a self,
        setting: &'a EffectSetting,
        even: &'a Even,
        values: &'a [f64],
        effects: &'a [EffectState],
    ) -> PanelWithEffects<'a> {
        PanelWithEffects { setting, even, values, effects, damping: &self.damping }
    }

    /// Flexible modes without effects up to a frequency \[Hz\]: of a plate roughly.
    pub(crate) fn bare_count(&self, values: &[f64], frequency: f64) -> Result<usize, ModelError> {
        match (self.structure, values) {
            (StructureKind::TimoshenkoBeam, &[e_x, g_zx]) => {
                Ok(ExactBeam::new(&self.piece, self.boundary, BeamConstants { e_x, g_zx })?.count_below(frequency))
            }
            _ => MindlinPlate::estimated_count(&self.piece, self.boundary, values, frequency),
        }
    }

    /// The values of the constants, and the effects, all of which are the panel's.
    pub(crate) fn with_effects(&self) -> Result<(Vec<f64>, Vec<EffectState>), ModelError> {
        self.check()?;
        let effects = self.effects.iter().map(EffectState::from_entry).collect::<Result<Vec<_>, _>>()?;
        if let Some(state) = effects.iter().find(|state| state.effect.owner() != Owner::Panel) {
            let (effect, owner) = (state.effect.id(), state.effect.owner().name());
            return Err(ModelError::EffectOwner { effect, owner });
        }
        let values = match self.structure {
            StructureKind::TimoshenkoBeam => {
                effects.iter().try_for_each(EffectState::on_centre_line)?;
                let constants = BeamConstants { e_x: self.constant("e_x")?, g_zx: self.constant("g_zx")? }.checked()?;
                vec![constants.e_x, constants.g_zx]
            }
            StructureKind::MindlinPlate => self.plate_constants()?.to_vec(),
        };
        Ok((values, effects))
    }

    pub(crate) fn plate_constants(&self) -> Result<[f64; 6], ModelError> {
        let mut values = [0.0; 6];
        for (value, constant) in values.iter_mut().zip(&PLATE_CONSTANTS) {
            *value = self.constant(constant.name)?;
            constant.check(*value)?;
        }
        Ok(values)
    }

    fn plate_modes(&self, range: ModeRange) -> Result<(MindlinPlate, Vec<RitzMode>), ModelError> {
        let values = self.plate_constants()?;
        let first = |count: usize| {
            let plate = MindlinPlate::with_basis_for(&self.piece, self.boundary, &values, count)?;
            let modes = ritz_modes(&plate, &values, count)?;
            Ok::<_, ModelError>((plate, modes))
        };
        let frequency = match range {
            ModeRange::Count(count) => return first(count),
            ModeRange::UpTo(frequency) => frequency,
        };
        let limit = frequency * std::f64::consts::TAU;
        let estimate = MindlinPlate::estimated_count(&self.piece, self.boundary, &values, frequency)?;
        let mut count = estimate.saturating_add(estimate / 4).saturating_add(4);
        loop {
            let (exhausted, (plate, mut modes)) = match first(count) {
                Err(ModelError::BasisTooSmall { available, .. }) if available > 0 => (true, first(available)?),
                found => (false, found?),
            };
            let reached = modes.last().map_or(0.0, |mode| mode.angular_frequency);
            if reached > limit {
                modes.retain(|mode| mode.angular_frequency <= limit);
                return Ok((plate, modes));
            }
            if exhausted {
                let available = modes.iter().filter(|mode| mode.angular_frequency > 0.0).count();
                let reached = reached / std::f64::consts::TAU;
                return Err(ModelError::BeyondBasis { frequency, available, reached });
            }
            count += count / 2;
        }
    }

    fn check_effects(&self) -> Result<(), ModelError> {
        match self.effects.first() {
            Some(effect) => Err(ModelError::Unsupported(format!("effect {:?}", effect.id))),
            None => Ok(()),
        }
    }

    /// The exact modes of a beam: the rigid ones, then the flexible ones of `range`, in rising order.
    ///
    /// # Errors
    /// [`ModelError::MissingConstant`], [`ModelError::Constant`] or [`ModelError::Size`] where the model has no
    /// physical meaning; [`ModelError::Unsupported`] for a plate, or an effect that this version cannot solve.
    fn beam_modes(&self, range: ModeRange) -> Result<Vec<BeamMode>, ModelError> {
        self.check()?;
        if self.structure != StructureKind::TimoshenkoBeam {
            return Err(ModelError::Unsupported("the exact beam of structure \"mindlin-plate\"".into()));
        }
        self.check_effects()?;
        let constants = BeamConstants { e_x: self.constant("e_x")?, g_zx: self.constant("g_zx")? };
        let beam = ExactBeam::new(&self.piece, self.boundary, constants)?;
        Ok(match range.checked(self.structure)? {
            ModeRange::Count(count) => beam.modes(count),
            ModeRange::UpTo(frequency) => {
                let below = beam.flexible_modes().take_while(|mode| mode.frequency() <= frequency);
                let flexible: Vec<BeamMode> = below.take(ModeRange::MOST + 1).collect();
                if flexible.len() > ModeRange::MOST {
                    let reached = flexible[ModeRange::MOST - 1].frequency();
                    return Err(ModelError::BeyondBasis { frequency, available: ModeRange::MOST, reached });
                }
                beam.rigid_modes().into_iter().chain(flexible).collect()
            }
        })
    }

    /// The modes of `range` as seen from these ports.
    ///
    /// # Errors
    /// As [`PanelModel::modes`], [`ModelError::OffPiece`] for a port off the piece, and [`ModelError::Unsupported`] for a
    /// viscoelastic core, in which each mode would stand for another modulus: see [`PanelModel::time_model`].
    pub fn modal_model(
        &self,
        range: ModeRange,
        forces: &[Place],
        responses: &[Place],
    ) -> Result<ModalModel, ModelError> {
        for &place in forces.iter().chain(responses) {
            self.piece.contains(place)?;
        }
        if self.relaxes() {
            return Err(ModelError::Unsupported("a core that relaxes in a sum of modes".into()));
        }
        self.as_seen(&self.modes_without_core(range)?, forces, responses)
    }

    /// These modes as seen from ports, each in the sense in which it is up at one place of the piece.
    ///
    /// The sense of a mode is free, and what a solver leaves to its rounding. An FMU solves its modes again where parameters are
    /// set, by other loops than the command that exported it, and its states must mean the same motion before and after.
    pub(crate) fn as_seen(
        &self,
        modes: &[PanelMode],
        forces: &[Place],
        responses: &[Place],
    ) -> Result<ModalModel, ModelError> {
        let model = ModalModel::of_modes(modes, &self.damping, forces, responses)?;
        let mark = Place { x: MARK[0] * self.piece.length, y: MARK[1] * self.piece.width };
        let down: Vec<bool> =
            PanelMode::deflections_at(modes, mark).into_iter().map(|deflection| deflection < 0.0).collect();
        Ok(model.turned(&down))
    }
}
