//! Up to where the motions of an FMU can do without the modes that it leaves out.

use std::f64::consts::TAU;

use num_complex::Complex64;
use orthopanel_fmu::Resource;
use orthopanel_model::{ModalModel, Mode, ModeRange, ModelError, PanelModel};

/// So many times the modes of the FMU are summed; what lies above counts as at rest.
const FURTHER: usize = 3;
const POINTS_AN_OCTAVE: usize = 48;
/// Octaves looked at below the highest mode.
const OCTAVES: usize = 10;
/// Part of the accelerance that the modes left out may add.
const ALLOWED: f64 = 0.01;

/// What the modes left out do to the accelerance of each pair of ports.
pub(crate) struct AccelerationBands {
    /// Up to where each holds: a row a response, a column a force.
    bands: Vec<Vec<Band>>,
    /// What the modes left out add at rest \[m/N\], alike.
    at_rest: Vec<Vec<f64>>,
    /// See [`AccelerationBands::frequency_change`].
    frequency_change: Option<f64>,
}

/// Up to where an acceleration lacks less than a hundredth \[Hz\]; `None` where it never does.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Band {
    /// Of the accelerance's root mean square over the octave around.
    pub of_octave: Option<f64>,
    /// Of the accelerance at each line by itself, those near antiresonances too.
    pub of_each_line: Option<f64>,
}

/// At one frequency \[Hz\]: what the modes left out add to the accelerance, and the whole.
type Line = (f64, Complex64, Complex64);
/// Accelerances at one frequency: a row a response, a column a force.
type Rows = Vec<Vec<Complex64>>;

impl AccelerationBands {
    /// # Errors
    /// As [`PanelModel::modal_model`].
    pub(crate) fn of(panel: &PanelModel, resource: &Resource) -> Result<Self, ModelError> {
        if panel.relaxes() { Self::beside_core(panel, resource) } else { Self::of_modes(panel, resource) }
    }

    /// Up to where what the modes left out add is within 1 %.
    pub(crate) fn within_one_percent(&self, response: usize, force: usize) -> Band {
        self.bands.get(response).and_then(|row| row.get(force)).copied().unwrap_or_default()
    }

    /// What the modes that are left out add to a displacement at rest, before residual modes stand for them \[m/N\].
    pub(crate) fn at_rest(&self, response: usize, force: usize) -> f64 {
        self.at_rest.get(response).and_then(|row| row.get(force)).copied().unwrap_or_default()
    }

    /// By how much of itself the frequency of a mode of the FMU differs at most on the larger basis of three times as many modes;
    /// not told beside a core.
    pub(crate) fn frequency_change(&self) -> Option<f64> {
        self.frequency_change
    }

    fn of_modes(panel: &PanelModel, resource: &Resource) -> Result<Self, ModelError> {
        let ports = resource.ports();
        let (kept, residual) = parts(resource)?;
        let all = |count: usize| panel.modal_model(ModeRange::Count(count), &ports.forces, &ports.responses);
        let all = match all(FURTHER * kept.flexible().count()) {
            Err(ModelError::BasisTooSmall { available, .. }) => all(available)?,
            found => found?,
        };
        let further: Vec<_> = all.modes().iter().skip(kept.modes().len()).cloned().collect();
        let left_out = ModalModel::new(ports.forces.len(), ports.responses.len(), further)?;
        let lacking = panel.static_remainder(&kept, &ports.forces, &ports.responses)?;
        let beyond = left_out.left_of_flexibility(lacking.clone());
        let line = |response: usize, force: usize, frequency: f64| {
            let at_rest = (TAU * frequency).powi(2) * beyond[response][force];
            let all = left_out.accelerance(force, response, frequency) - at_rest;
            let missing = all - residual.accelerance(force, response, frequency);
            (frequency, missing, kept.accelerance(force, response, frequency) + all)
        };
        let grid = grid(kept.modes().last().map_or(0.0, |mode| mode.angular_frequency / TAU));
        let band = |response: usize, force: usize| {
            band(&grid.iter().map(|&frequency| line(response, force, frequency)).collect::<Vec<Line>>())
        };
        let row = |response: usize| (0..ports.forces.len()).map(|force| band(response, force)).collect();
        let changes = kept.flexible().zip(all.flexible());
        let changes = changes.map(|(own, finer)| (own.angular_frequency / finer.angular_frequency - 1.0).abs());
        Ok(Self {
            bands: (0..ports.responses.len()).map(row).collect(),
            at_rest: lacking,
            frequency_change: Some(changes.fold(0.0, f64::max)),
        })
    }

    /// Line by line with the core's own law, on the coordinates that the FMU steps and on those of three times as many modes.
    fn beside_core(panel: &PanelModel, resource: &Resource) -> Result<Self, ModelError> {
        let (count, ports) = (resource.flexible_modes(), resource.ports());
        let last = |modes: Vec<orthopanel_model::PanelMode>| modes.last().map_or(0.0, |mode| mode.angular_frequency());
        let grid = grid(last(panel.modes(ModeRange::Count(count))?) / TAU);
        let further = |count| panel.relaxing_lines(ModeRange::Count(count), &ports.forces, &ports.responses);
        let whole = match further(FURTHER * count) {
            Err(ModelError::BasisTooSmall { available, .. }) => further(available)?,
            found => found?,
        };
        let own = panel.relaxing_lines_of_modes(ModeRange::Count(count), &ports.forces, &ports.responses)?;
        let (kept, residual) = parts(resource)?;
        let at_rest = kept.left_of_flexibility(panel.static_flexibility(count, &ports.forces, &ports.responses)?);
        let Some((whole, own)) = whole.zip(own) else {
            let never = vec![vec![Band::default(); ports.forces.len()]; ports.responses.len()];
            return Ok(Self { bands: never, at_rest, frequency_change: None });
        };
        let lines = grid.iter().map(|&frequency| {
            let s = Complex64::new(0.0, TAU * frequency);
            (frequency, whole.at(s), own.at(s))
        });
        let lines: Vec<_> = lines.collect();
        let one = |response: usize, force: usize| {
            let line = |(frequency, whole, own): &(f64, Rows, Rows)| {
                let whole = whole[response][force];
                let beside = residual.accelerance(force, response, *frequency);
                (*frequency, whole - own[response][force] - beside, whole)
            };
            band(&lines.iter().map(line).collect::<Vec<Line>>())
        };
        let row = |response: usize| (0..ports.forces.len()).map(|force| one(response, force)).collect();
        let bands = (0..ports.responses.len()).map(row).collect();
        Ok(Self { bands, at_rest, frequency_change: None })
    }
}

/// The modes that are kept, and the residual ones.
fn parts(resource: &Resource) -> Result<(ModalModel, ModalModel), ModelError> {
    let model = resource.panel_alone()?;
    let (kept, residual) = model.modes().split_at(model.modes().len() - resource.residual_modes());
    let of = |modes: &[Mode]| ModalModel::new(model.force_count(), model.response_count(), modes.to_vec());
    Ok((of(kept)?, of(residual)?))
}

/// The frequencies \[Hz\] that are looked at, up to half an octave above the highest mode that is kept.
fn grid(highest: f64) -> Vec<f64> {
    let points = OCTAVES * POINTS_AN_OCTAVE + POINTS_AN_OCTAVE / 2;
    let octave = |point: usize| point as f64 / POINTS_AN_OCTAVE as f64 - OCTAVES as f64;
    (0..=points).map(|point| highest * octave(point).exp2()).collect()
}

/// See [`AccelerationBands::within_one_percent`].
fn band(lines: &[Line]) -> Band {
    let of_octave = lines.windows(POINTS_AN_OCTAVE + 1).map_while(|octave| {
        let (frequency, missing, _) = octave.get(POINTS_AN_OCTAVE / 2)?;
        let mean = octave.iter().map(|(.., whole)| whole.norm_sqr()).sum::<f64>() / octave.len() as f64;
        (missing.norm_sqr() <= ALLOWED * ALLOWED * mean).then_some(*frequency)
    });
    let of_octave = of_octave.last();
    let each = lines.iter().map_while(|(frequency, missing, whole)| {
        let within = missing.norm() <= ALLOWED * whole.norm() && of_octave.is_some_and(|band| *frequency <= band);
        within.then_some(*frequency)
    });
    Band { of_octave, of_each_line: each.last() }
}

#[cfg(test)]
mod tests {
    use orthopanel_fmu::{Connections, Residual};
    use orthopanel_model::{Place, Ports};

    use super::*;

    /// Beside a core the modes that an FMU steps, internal variables and fit and all, lack a hundredth at the end of the band, and
    /// no more below.
    #[test]
    fn val_beside_a_core_the_modes_of_the_fmu_hold_as_far_as_is_told() {
        let text = r#"{"schema": "orthopanel.model/1", "structure": "timoshenko-beam",
            "piece": {"length": 0.8, "width": 0.1, "thickness": 0.03, "mass_per_area": 6.88},
            "constants": {"e_x": 1.067e10, "g_zx": 5.304e8}, "damping": {"beyond": 0.01},
            "effects": [{"id": "viscoelastic-core", "owner": "panel", "strength": 0.05, "tau": 1e-4, "alpha": 0.6}]}"#;
        let panel = PanelModel::from_json(text).unwrap();
        let at = |x| Place { x, y: 0.0 };
        let ports = Ports { forces: vec![at(-0.3)], responses: vec![at(-0.3)] };
        let (resource, fit) =
            Resource::of_panel(&panel, ModeRange::Count(5), ports, Residual::None, Connections::default()).unwrap();
        assert!(fit.unwrap().error < 1e-3, "small beside a hundredth");
        let told = AccelerationBands::of(&panel, &resource).unwrap().within_one_percent(0, 0).of_octave.unwrap();
        let whole = panel.relaxing_lines(ModeRange::Count(30), &[at(-0.3)], &[at(-0.3)]).unwrap().unwrap();
        let share = |frequency: f64| {
            let whole = |frequency: f64| whole.at(Complex64::new(0.0, TAU * frequency))[0][0];
            let octave = (0..=48).map(|point| whole(frequency * ((f64::from(point) - 24.0) / 48.0).exp2()).norm_sqr());
            let rms = (octave.sum::<f64>() / 49.0).sqrt();
            (resource.model().accelerance(0, 0, frequency) - whole(frequency)).norm() / rms
        };
        for part in [0.1, 0.2, 0.4, 0.6, 0.8, 0.9] {
            assert!(share(part * told) < 0.012, "at {part} of {told} Hz: {}", share(part * told));
        }
        assert!((0.006..0.014).contains(&share(told)), "{told} Hz: {}", share(told));
    }
}
