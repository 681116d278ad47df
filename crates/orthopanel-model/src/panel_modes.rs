//! From a [`PanelModel`] to its modes and to the hinge, [`ModalModel`].

use crate::{BeamConstants, BeamMode, ExactBeam, ModalModel, ModelError, PanelModel, Place, StructureKind};

/// Which modes to keep beside the rigid ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ModeRange {
    /// This many flexible modes.
    Count(usize),
    /// Every flexible mode up to this frequency \[Hz\].
    UpTo(f64),
}

/// Most flexible modes that one model may have.
const MOST_MODES: usize = 1000;

impl ModeRange {
    fn checked(self) -> Result<Self, ModelError> {
        match self {
            Self::Count(count) if count > MOST_MODES => {
                Err(ModelError::BasisTooSmall { asked: count, available: MOST_MODES })
            }
            Self::UpTo(frequency) if !(frequency.is_finite() && frequency > 0.0) => {
                Err(ModelError::Size { name: "highest frequency", value: frequency, unit: "Hz" })
            }
            _ => Ok(self),
        }
    }
}

impl PanelModel {
    /// The rigid modes, then the flexible ones of `range`, in rising order.
    ///
    /// # Errors
    /// [`ModelError::MissingConstant`], [`ModelError::Constant`] or [`ModelError::Size`] where the model has no
    /// physical meaning; [`ModelError::Unsupported`] for a structure or an effect that this version cannot solve.
    pub fn beam_modes(&self, range: ModeRange) -> Result<Vec<BeamMode>, ModelError> {
        self.check()?;
        if self.structure != StructureKind::TimoshenkoBeam {
            return Err(ModelError::Unsupported("structure \"mindlin-plate\"".into()));
        }
        if let Some(effect) = self.effects.first() {
            return Err(ModelError::Unsupported(format!("effect {:?}", effect.id)));
        }
        let constants = BeamConstants { e_x: self.constant("e_x")?, g_zx: self.constant("g_zx")? };
        let beam = ExactBeam::new(&self.piece, self.boundary, constants)?;
        Ok(match range.checked()? {
            ModeRange::Count(count) => beam.modes(count),
            ModeRange::UpTo(frequency) => {
                let flexible = beam.flexible_modes().take(MOST_MODES).take_while(|mode| mode.frequency() <= frequency);
                beam.rigid_modes().into_iter().chain(flexible).collect()
            }
        })
    }

    /// The modes of `range` as seen from these ports.
    ///
    /// # Errors
    /// As [`PanelModel::beam_modes`], and [`ModelError::OffPiece`] for a port off the piece.
    pub fn modal_model(
        &self,
        range: ModeRange,
        forces: &[Place],
        responses: &[Place],
    ) -> Result<ModalModel, ModelError> {
        for &place in forces.iter().chain(responses) {
            self.piece.contains(place)?;
        }
        ModalModel::of_modes(&self.beam_modes(range)?, &self.damping, forces, responses)
    }
}
