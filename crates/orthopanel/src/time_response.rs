//! Response of a model to a force history, and the table it is written as.

use orthopanel_model::{Attachments, ModalModel, ModalStepper, ModeRange, ModelError, PanelModel, Ports, TimeModel};
use serde::Serialize;

pub use crate::driving_force::Hold;
pub use crate::motion::Motion;

use crate::driving_force::DrivingForce;
use crate::force_file::ForceHistory;
use crate::{csv_text, json};

/// Sizes of the steps between samples; samples that are even but for the rounding of their times get one size, since a
/// stepper is quick only while its step stays the same.
pub fn steps(time: &[f64]) -> Vec<f64> {
    let differences = || time.windows(2).map(|pair| pair[1] - pair[0]);
    let (Some(&first), Some(&last)) = (time.first(), time.last()) else { return Vec::new() };
    let even = (last - first) / (time.len() - 1).max(1) as f64;
    let rounding = 8.0 * f64::EPSILON * first.abs().max(last.abs());
    if differences().all(|step| (step - even).abs() <= rounding) {
        vec![even; time.len() - 1]
    } else {
        differences().collect()
    }
}

/// The modes of a range as seen from these ports, and residual modes of the forces, as an FMU has them.
pub fn seen(panel: &PanelModel, range: ModeRange, ports: &Ports) -> Result<TimeModel, ModelError> {
    let Ports { forces, responses } = ports;
    let seen = panel.time_model(range, forces, responses)?;
    let attachments = Attachments::new(panel, seen.flexible, forces);
    seen.with_residual_modes(panel, &attachments, forces, responses)
}

/// Steps the model, at rest before the first sample, through the force history; one [`Motion`] a response port,
/// at the samples.
pub fn simulate(model: &ModalModel, driving: &DrivingForce) -> Result<Vec<Motion>, ModelError> {
    let force = driving.stepped();
    let mut stepper = ModalStepper::new(model);
    let mut motions = vec![Motion::default(); model.response_count()];
    let record = |stepper: &ModalStepper, motions: &mut [Motion]| {
        for (port, motion) in motions.iter_mut().enumerate() {
            motion.acceleration.extend(stepper.acceleration(port));
            motion.velocity.extend(stepper.velocity(port));
            motion.displacement.extend(stepper.displacement(port));
        }
    };
    stepper.set_forces(&force.at(0))?;
    record(&stepper, &mut motions);
    for (index, step) in steps(&force.time).into_iter().enumerate() {
        let forces = force.at(index + 1);
        if driving.is_held() {
            stepper.advance_held(step)?;
            stepper.set_forces(&forces)?;
        } else {
            stepper.advance_linear(step, &forces)?;
        }
        record(&stepper, &mut motions);
    }
    Ok(driving.at_samples(motions))
}

#[derive(Serialize)]
struct Answer<'a> {
    schema: &'static str,
    time_s: &'a [f64],
    forces: &'a [Vec<f64>],
    responses: Vec<ResponseEntry<'a>>,
}

#[derive(Serialize)]
struct ResponseEntry<'a> {
    acceleration_m_s2: &'a [f64],
    velocity_m_s: &'a [f64],
    displacement_m: &'a [f64],
}

/// One JSON object (`orthopanel.simulation/1`) on one line.
pub fn to_json(force: &ForceHistory, motions: &[Motion]) -> String {
    let responses = motions.iter().map(|motion| ResponseEntry {
        acceleration_m_s2: &motion.acceleration,
        velocity_m_s: &motion.velocity,
        displacement_m: &motion.displacement,
    });
    json::line(&Answer {
        schema: "orthopanel.simulation/1",
        time_s: &force.time,
        forces: &force.forces,
        responses: responses.collect(),
    })
}

/// Picks one quantity of a motion.
type Column = fn(&Motion) -> &[f64];

/// Time, forces and motions as CSV: `time_s,force_n,acceleration_m_s2,velocity_m_s,displacement_m`; where there are
/// several places of a kind their columns are numbered, as in `acceleration_2_m_s2`.
pub fn csv(force: &ForceHistory, motions: &[Motion]) -> String {
    let mut names = vec!["time_s".to_owned()];
    let mut columns: Vec<&[f64]> = vec![&force.time];
    for (port, column) in force.forces.iter().enumerate() {
        names.push(name("force", "n", port, force.forces.len()));
        columns.push(column);
    }
    let quantities: [(&str, &str, Column); 3] = [
        ("acceleration", "m_s2", |motion| &motion.acceleration),
        ("velocity", "m_s", |motion| &motion.velocity),
        ("displacement", "m", |motion| &motion.displacement),
    ];
    for (quantity, unit, of) in quantities {
        for (port, motion) in motions.iter().enumerate() {
            names.push(name(quantity, unit, port, motions.len()));
            columns.push(of(motion));
        }
    }
    csv_text::csv(&names, &columns)
}

fn name(quantity: &str, unit: &str, port: usize, ports: usize) -> String {
    if ports == 1 { format!("{quantity}_{unit}") } else { format!("{quantity}_{}_{unit}", port + 1) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn even_times_give_one_step_and_uneven_ones_their_own() {
        let even: Vec<f64> = (0..1000).map(|index| f64::from(index) * 1e-5).collect();
        let sizes = steps(&even);
        assert!(sizes.iter().all(|&size| size == sizes[0]));
        assert_eq!(steps(&[0.0, 0.5, 0.75]), [0.5, 0.25]);
    }
}
