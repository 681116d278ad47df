//! The accelerances that a model with effects foretells for the records that it is held against.

use num_complex::Complex64;
use orthopanel_data::Accelerance;
use orthopanel_model::{Damping, EffectState, ReceptanceSetup};
use rayon::prelude::*;

use crate::accelerance_fit::told_variance;
use crate::{AcceleranceFit, IdentifyError};

/// Measured and calculated, up to `band` \[Hz\], record by record of a piece; `setup` has the records in the same order.
///
/// # Errors
/// What the model refuses.
pub(crate) fn curves(
    accelerances: &[Accelerance],
    (piece, setup): (usize, &ReceptanceSetup),
    (constants, damping, effects): (&[f64], &Damping, &[EffectState]),
    band: f64,
) -> Result<Vec<AcceleranceFit>, IdentifyError> {
    let model = setup.model(constants, damping, effects)?;
    let curve = |(index, record): (usize, &Accelerance)| {
        let lines = record.frequency.partition_point(|&frequency| frequency <= band);
        let frequency = record.frequency[..lines].to_vec();
        let at = |f: &f64| Complex64::new(record.decay_rate, std::f64::consts::TAU * f);
        let s: Vec<Complex64> = frequency.iter().map(at).collect();
        AcceleranceFit {
            piece,
            force_at: record.force_at,
            response_at: record.response_at,
            model: model.accelerances(index, &s).unwrap_or_default(),
            measured: record.value[..lines].to_vec(),
            decay_rate: record.decay_rate,
            // Smooth: over what a few hits scatter line by line, noise alone would leave 1.4 where there are three.
            variance: told_variance(record).map(|variance| variance[..lines].to_vec()),
            frequency,
        }
    };
    Ok(accelerances.par_iter().enumerate().map(curve).collect())
}
