//! A reference: a sound panel of the same make, whose model error the suspect shares.
//!
//! With $\theta$ the constants, $\delta$ what is wrong with the suspect alone, and $e$ what the model misses of both, the logarithms of the measured
//! frequencies are
//! $$y_\text{ref} = f(\theta_\text{ref}, 0) + e + n_\text{ref}\ ,\qquad y = f(\theta, \delta) + e + e' + n\ .$$
//! From those of the suspect $\hat e = y_\text{ref} - f(\hat\theta_\text{ref}, 0)$ is subtracted, mode by mode. What is left to the suspect's own model
//! error $e'$ is estimated as ever: it falls as far as the two share their error. Residues are not corrected: places and gains differ from one test to
//! the next.

use orthopanel_data::ImpactTest;
use orthopanel_model::Place;

use crate::IdentifyError;
use crate::comparison::Comparison;
use crate::inference::from_base;
use crate::measured::MeasuredModes;
use crate::predicted::apart;
use crate::shared_error::SharedError;
use crate::structures;

/// Modes that both panels show, at least.
const LEAST: usize = 3;

/// A mode of the reference.
struct ReferenceMode {
    /// Number among the flexible modes, from 0.
    flexible: usize,
    /// Measured \[rad/s\].
    angular_frequency: f64,
    /// Products of its deflections at the places of the suspect's records.
    shape: Vec<f64>,
    /// What the model misses of the logarithm of its frequency, and the variance of that by noise.
    missed: (f64, f64),
}

/// Subtracts what the model misses of a reference from what was measured of a suspect.
///
/// # Errors
/// [`IdentifyError::OfReference`] for what the reference's own test refuses, [`IdentifyError::OtherPanel`] for one that is not of the suspect's make.
pub(crate) fn without_shared_error(
    reference: &ImpactTest,
    suspect: &ImpactTest,
    comparison: &mut Comparison,
) -> Result<SharedError, IdentifyError> {
    for (test, whose) in [(suspect, "the suspect"), (reference, "the reference")] {
        if test.pieces.len() > 1 {
            return Err(IdentifyError::OtherPanel(format!("{whose} has {} pieces", test.pieces.len())));
        }
    }
    if reference.structure != suspect.structure || reference.boundary != suspect.boundary {
        return Err(IdentifyError::OtherPanel("structure or boundary of the two tests differ".to_owned()));
    }
    let measured = comparison.measured;
    let modes = modes_of(reference, measured).map_err(|error| IdentifyError::OfReference(Box::new(error)))?;
    let partners: Vec<Option<&ReferenceMode>> = if measured.records.is_empty() {
        // A list counts the modes.
        (0..measured.poles.len())
            .map(|pole| modes.iter().find(|mode| mode.flexible == measured.number_in_order(pole)))
            .collect()
    } else {
        let shapes: Vec<(f64, Vec<f64>)> =
            modes.iter().map(|mode| (mode.angular_frequency, mode.shape.clone())).collect();
        let partners = measured.partners(&shapes, |_| apart(structures::of_test(suspect).kind()));
        partners.into_iter().map(|partner| partner.map(|(index, _)| &modes[index])).collect()
    };
    let shared = partners.iter().flatten().count();
    if shared < LEAST {
        let found = measured.poles.len();
        return Err(IdentifyError::OtherPanel(format!("of {found} modes of the suspect the reference shows {shared}")));
    }
    let missed = partners.into_iter().map(|mode| Some(mode?.missed)).collect();
    Ok(SharedError::removed_from(comparison, missed))
}

/// The modes that a reference shows, seen at the places of a suspect.
fn modes_of(reference: &ImpactTest, suspect: &MeasuredModes) -> Result<Vec<ReferenceMode>, IdentifyError> {
    let pairs: Vec<[Place; 2]> = suspect.records.iter().map(|record| [record.force_at, record.response_at]).collect();
    from_base(reference, None, &|_| {}, |inquiry, base| {
        let (block, at) = (inquiry.stacked.first(), base.posterior.point.at.first());
        let (constants, effects) = block.values(&base.hypothesis, &base.posterior.point.z)?;
        let shapes = block.predictor.flexible_shapes(&pairs, &constants, &effects)?;
        let comparison = block.comparison();
        let mode = |pole: usize| {
            let flexible = at.flexible_of_poles[pole]?;
            Some(ReferenceMode {
                flexible,
                angular_frequency: comparison.measured.poles[pole].angular_frequency,
                shape: shapes.get(flexible)?.clone(),
                missed: (comparison.values[pole] - at.values[pole], comparison.noise[(pole, pole)]),
            })
        };
        Ok((0..comparison.measured.poles.len()).filter_map(mode).collect())
    })
}
