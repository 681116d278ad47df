//! What a time stepper needs of a panel: its modes, and the internal variables of a core that relaxes.

use crate::effects::{CoreFit, CoupledPanel};
use crate::{
    EffectSetting, ModalModel, ModeRange, ModelError, PanelModel, Place, StructureKind, VISCOELASTIC_CORE, modes_below,
};

/// Modes as seen from ports, ready to be stepped.
#[derive(Debug, Clone, PartialEq)]
pub struct TimeModel {
    /// The modes; with a core, those of the panel and its internal variables together.
    pub modes: ModalModel,
    /// Flexible modes of the panel itself that these hold.
    pub flexible: usize,
    /// Residual modes behind all others: see [`TimeModel::with_residual_modes`].
    pub residual: usize,
    /// How the core's modulus is fitted, where there is one.
    pub core: Option<CoreFit>,
}

impl PanelModel {
    /// Whether a viscoelastic core is among the effects.
    pub fn relaxes(&self) -> bool {
        self.effects.iter().any(|entry| entry.id == VISCOELASTIC_CORE)
    }

    /// The modes of `range` as seen from these ports, and with a viscoelastic core those of the enlarged panel: the same
    /// number whatever the constants. Beside a core, damping ratios are those of the bare modes without it.
    ///
    /// # Errors
    /// As [`PanelModel::modal_model`].
    pub fn time_model(&self, range: ModeRange, forces: &[Place], responses: &[Place]) -> Result<TimeModel, ModelError> {
        if let Some(model) = self.relaxing_model(range, forces, responses)? {
            return Ok(model);
        }
        let modes = self.modal_model(range, forces, responses)?;
        let flexible = modes.flexible().count();
        Ok(TimeModel { modes, flexible, residual: 0, core: None })
    }

    /// What the flexible modes that these leave out add to displacements at rest, $\sum W_rW_f/\omega^2$ \[m/N\]: a row a response,
    /// a column a force.
    ///
    /// # Errors
    /// As [`PanelModel::static_flexibility`].
    pub fn static_remainder(
        &self,
        modes: &ModalModel,
        forces: &[Place],
        responses: &[Place],
    ) -> Result<Vec<Vec<f64>>, ModelError> {
        let all = self.static_flexibility(modes.flexible().count(), forces, responses)?;
        Ok(modes.left_of_flexibility(all))
    }

    /// `None` for a panel without a viscoelastic core.
    fn relaxing_model(
        &self,
        range: ModeRange,
        forces: &[Place],
        responses: &[Place],
    ) -> Result<Option<TimeModel>, ModelError> {
        if !self.relaxes() {
            return Ok(None);
        }
        for &place in forces.iter().chain(responses) {
            self.piece.contains(place)?;
        }
        let (values, effects) = self.with_effects()?;
        let flexible = match range.checked(self.structure)? {
            ModeRange::Count(count) => count,
            ModeRange::UpTo(frequency) => self.flexible_below(&values, frequency)?.max(FEWEST_RELAXING),
        };
        // The first two frequencies make a band; more modes than these many make no stepper.
        if !(FEWEST_RELAXING..=MOST_RELAXING).contains(&flexible) {
            return Err(ModelError::Unsupported(format!(
                "a core that relaxes with {flexible} modes: from {FEWEST_RELAXING} to {MOST_RELAXING} can be stepped"
            )));
        }
        let setting = EffectSetting::of_panel(&self.piece, self.boundary);
        let even = self.even(&setting, flexible)?;
        let parts = self.on_even(&setting, &even, &values, &effects);
        let found = CoupledPanel::relaxing_modes(parts, flexible)?;
        let Some((modes, fit)) = found else { return Ok(None) };
        let modes: Vec<_> = modes.into_iter().map(crate::PanelMode::of_coupled).collect();
        let modes = self.as_seen(&modes, forces, responses)?;
        Ok(Some(TimeModel { modes, flexible, residual: 0, core: Some(fit) }))
    }

    /// Flexible modes without effects up to a frequency \[Hz\]; of a plate at most as many as its largest basis resolves.
    fn flexible_below(&self, values: &[f64], frequency: f64) -> Result<usize, ModelError> {
        let estimate = self.bare_count(values, frequency)?;
        if self.structure == StructureKind::TimoshenkoBeam {
            return Ok(estimate.saturating_sub(self.boundary.rigid_modes()));
        }
        let (plate, values) = match self.structure_for(estimate.saturating_add(estimate / 4).saturating_add(4)) {
            Err(ModelError::BasisTooSmall { available, .. }) => self.structure_for(available)?,
            found => found?,
        };
        let below = modes_below(plate.as_ref(), &values, &[frequency * std::f64::consts::TAU])?;
        Ok(below.first().copied().unwrap_or(0))
    }
}

/// Two frequencies make a band.
const FEWEST_RELAXING: usize = 2;

/// Each mode brings its internal variables, and all are coupled: a step costs the square of their number.
const MOST_RELAXING: usize = 60;
