//! Up to where the accelerations of an FMU can do without the modes that it leaves out.

use std::f64::consts::TAU;

use num_complex::Complex64;
use orthopanel_fmu::Resource;
use orthopanel_model::{ModalModel, ModeRange, ModelError, PanelModel};

/// So many times the modes of the FMU are summed; what lies above counts as at rest.
const FURTHER: usize = 3;
const POINTS_AN_OCTAVE: usize = 48;
/// Octaves looked at below the highest mode.
const OCTAVES: usize = 10;
/// Part of the accelerance that the modes left out may add.
const ALLOWED: f64 = 0.01;

/// What the modes left out do to the accelerance of each pair of ports.
pub(crate) struct AccelerationBands {
    kept: ModalModel,
    left_out: ModalModel,
    /// The static part of the modes beyond `left_out` \[m/N\]: a row a response, a column a force.
    beyond: Vec<Vec<f64>>,
}

impl AccelerationBands {
    /// # Errors
    /// As [`PanelModel::modal_model`].
    pub(crate) fn of(panel: &PanelModel, resource: &Resource) -> Result<Self, ModelError> {
        let (kept, ports) = (resource.model(), resource.ports());
        let all = |count: usize| panel.modal_model(ModeRange::Count(count), &ports.forces, &ports.responses);
        let all = match all(FURTHER * kept.flexible().count()) {
            Err(ModelError::BasisTooSmall { available, .. }) => all(available)?,
            found => found?,
        };
        let further: Vec<_> = all.modes().iter().skip(kept.modes().len()).cloned().collect();
        let left_out = ModalModel::new(ports.forces.len(), ports.responses.len(), further)?;
        let beyond = left_out.left_of_flexibility(resource.static_remainder().to_vec());
        Ok(Self { kept: kept.clone(), left_out, beyond })
    }

    /// The frequencies \[Hz\] that are looked at, up to half an octave above the highest mode that is kept.
    fn grid(&self) -> Vec<f64> {
        let highest = self.kept.modes().last().map_or(0.0, |mode| mode.angular_frequency / TAU);
        let points = OCTAVES * POINTS_AN_OCTAVE + POINTS_AN_OCTAVE / 2;
        let octave = |point: usize| point as f64 / POINTS_AN_OCTAVE as f64 - OCTAVES as f64;
        (0..=points).map(|point| highest * octave(point).exp2()).collect()
    }

    /// Highest frequency \[Hz\] up to which what the modes left out add is within 1 % of the accelerance's root mean square over
    /// the octave around; `None` where it never is.
    pub(crate) fn within_one_percent(&self, response: usize, force: usize) -> Option<f64> {
        let remainder = self.beyond.get(response)?.get(force)?;
        let line = |frequency: f64| {
            let omega = TAU * frequency;
            let missing = self.left_out.accelerance(force, response, frequency) - omega * omega * remainder;
            (frequency, missing, self.kept.accelerance(force, response, frequency) + missing)
        };
        let lines: Vec<(f64, Complex64, Complex64)> = self.grid().into_iter().map(line).collect();
        let held = lines.windows(POINTS_AN_OCTAVE + 1).map_while(|octave| {
            let (frequency, missing, _) = octave.get(POINTS_AN_OCTAVE / 2)?;
            let mean = octave.iter().map(|(.., whole)| whole.norm_sqr()).sum::<f64>() / octave.len() as f64;
            (missing.norm_sqr() <= ALLOWED * ALLOWED * mean).then_some(*frequency)
        });
        held.last()
    }
}
