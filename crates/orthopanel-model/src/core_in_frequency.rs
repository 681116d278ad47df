//! A panel with a viscoelastic core in the frequency domain: modes, and lines of its accelerance.

use std::f64::consts::TAU;

use num_complex::Complex64;

use crate::effects::{Action, CoreModulus, CoupledMode, CoupledPanel, RelaxingLines};
use crate::panel_modes::ModeRange;
use crate::{EffectSetting, EffectState, ModelError, PanelMode, PanelModel, Place, VISCOELASTIC_CORE};

/// Steps of the search for a mode's own modulus: each leaves a tenth of the last one's change or less.
const MOST_STEPS: usize = 40;
/// Change of a frequency at which the search ends.
const SETTLED: f64 = 1e-11;
/// Step of the modulus by which the share of the core in a mode's stiffness is told.
const DIFFERENCE: f64 = 1e-3;

impl PanelModel {
    /// Modes of a panel with a viscoelastic core: each is the natural mode at the core's storage modulus at the mode's own
    /// frequency, $\mathrm{Re}\,g(j\omega_m)$, and its damping ratio holds the core's loss,
    /// $$\zeta_m = \zeta + \tfrac12\,\mathrm{Im}\,g(j\omega_m)\,\frac{\phi_m^TS\phi_m}{\omega_m^2}.$$
    ///
    /// Source: modal strain energy, Johnson and Kienholz, AIAA J. 20 (1982) 1284. Good to the square of the loss.
    pub(crate) fn modes_with_core(&self, range: ModeRange) -> Result<Vec<PanelMode>, ModelError> {
        let (values, effects) = self.with_effects()?;
        let setting = EffectSetting::of_panel(&self.piece, self.boundary);
        let (elastic, core) = apart(effects, &setting)?;
        let moduli: Vec<usize> = (self.structure.constants().iter().enumerate())
            .filter(|(_, constant)| matches!(constant.name, "g_zx" | "g_yz"))
            .map(|(index, _)| index)
            .collect();
        let (count, highest) = match range.checked(self.structure)? {
            ModeRange::Count(count) => (count, f64::INFINITY),
            // A core only stiffens: no more modes than at its low modulus.
            ModeRange::UpTo(frequency) => (self.bare_count(&values, frequency)? + self.effects.len() + 4, frequency),
        };
        let even = self.even(&setting, count)?;
        let at = |factor: f64| {
            let mut values = values.clone();
            moduli.iter().for_each(|&index| values[index] *= factor);
            let parts = self.on_even(&setting, &even, &values, &elastic);
            CoupledPanel::modes(parts, count)
        };
        let low = at(1.0)?;
        let mut modes = Vec::new();
        for (index, first) in low.iter().enumerate() {
            let mode =
                if first.angular_frequency > 0.0 { own_mode(index, first.clone(), core, at)? } else { first.clone() };
            if mode.angular_frequency > TAU * highest {
                break;
            }
            modes.push(PanelMode::of_coupled(mode));
        }
        Ok(modes)
    }

    /// Lines of the accelerances of a panel with a viscoelastic core from forces to responses, on the modes that lie up to
    /// about `highest` \[Hz\]; `None` for a panel without a core.
    ///
    /// Each place adds shapes of its own to the basis of all lines. So a line differs a little by which places are asked for
    /// together.
    ///
    /// # Errors
    /// As [`PanelModel::modes`], and [`ModelError::OffPiece`].
    pub fn relaxing_lines(
        &self,
        highest: ModeRange,
        forces: &[Place],
        responses: &[Place],
    ) -> Result<Option<RelaxingLines>, ModelError> {
        self.lines_of_core(highest, (forces, responses), true)
    }

    /// As [`PanelModel::relaxing_lines`], of the coordinates alone that [`PanelModel::time_model`] steps: without what forces at the
    /// places do beyond these.
    ///
    /// # Errors
    /// As there.
    pub fn relaxing_lines_of_modes(
        &self,
        modes: ModeRange,
        forces: &[Place],
        responses: &[Place],
    ) -> Result<Option<RelaxingLines>, ModelError> {
        self.lines_of_core(modes, (forces, responses), false)
    }

    fn lines_of_core(
        &self,
        highest: ModeRange,
        (forces, responses): (&[Place], &[Place]),
        with_ports: bool,
    ) -> Result<Option<RelaxingLines>, ModelError> {
        if !self.relaxes() {
            return Ok(None);
        }
        forces.iter().chain(responses).try_for_each(|place| self.piece.contains(*place))?;
        let (values, effects) = self.with_effects()?;
        let setting = EffectSetting::of_panel(&self.piece, self.boundary);
        let count = match highest.checked(self.structure)? {
            ModeRange::Count(count) => count,
            ModeRange::UpTo(frequency) => self.bare_count(&values, frequency)?,
        };
        let count = count.max(1);
        let even = self.even(&setting, count)?;
        let parts = self.on_even(&setting, &even, &values, &effects);
        RelaxingLines::new(parts, count, (forces, responses), with_ports)
    }
}

/// All effects but the core, and that.
fn apart(effects: Vec<EffectState>, setting: &EffectSetting) -> Result<(Vec<EffectState>, CoreModulus), ModelError> {
    let (cores, others): (Vec<_>, Vec<_>) =
        effects.into_iter().partition(|state| state.effect.id() == VISCOELASTIC_CORE);
    let mut found = None;
    for state in cores {
        for action in state.effect.act(&state.values, setting)? {
            if let Action::Core(core) = action {
                found = Some(core);
            }
        }
    }
    let core = found.ok_or_else(|| ModelError::Unsupported("a core without a modulus".into()))?;
    Ok((others, core))
}

/// The mode of this number at the modulus that the core has at its frequency, with the core's loss.
fn own_mode(
    index: usize,
    first: CoupledMode,
    core: CoreModulus,
    at: impl Fn(f64) -> Result<Vec<CoupledMode>, ModelError>,
) -> Result<CoupledMode, ModelError> {
    let modulus = |mode: &CoupledMode| core.factor(Complex64::new(0.0, mode.angular_frequency));
    let solved = |factor: f64| at(factor)?.into_iter().nth(index).ok_or(ModelError::Eigenproblem);
    let mut mode = first;
    for _ in 0..MOST_STEPS {
        let next = solved(modulus(&mode).re)?;
        let change = (next.angular_frequency / mode.angular_frequency - 1.0).abs();
        mode = next;
        if change < SETTLED {
            break;
        }
    }
    let own = modulus(&mode);
    let square =
        |side: f64| Ok::<f64, ModelError>(solved(own.re * (1.0 + side * DIFFERENCE))?.angular_frequency.powi(2));
    // The share of the shear stiffness at its storage modulus; S is at the low one.
    let share = (square(1.0)? - square(-1.0)?) / (2.0 * DIFFERENCE * mode.angular_frequency.powi(2));
    let zeta = (mode.damping_ratio + 0.5 * own.im / own.re * share).min(MOST_ZETA);
    mode.damping_ratio = zeta;
    Ok(mode)
}

/// A mode that loses more is no mode any longer.
const MOST_ZETA: f64 = 0.7;
