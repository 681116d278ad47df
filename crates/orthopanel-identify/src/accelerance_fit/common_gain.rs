//! What all records together say of the model that was found: one factor on all of them, or nothing.

use orthopanel_data::{Accelerance, ImpactTest, ReadAs};
use orthopanel_model::{Estimate, Readable};

use super::contradiction::contradicted;
use super::misfit::median;
use super::records::PlaceRecord;
use super::scale::{Compared, common_delay};
use crate::error::CALIBRATED;
use crate::structures::{self, Shown};
use crate::{AcceleranceFit, IdentifyError, Settings};

/// A factor further from one than so many standard deviations is no matter of chance.
const FAR: f64 = 3.0;
/// A median deviation times this is a standard deviation, of normal errors.
const NORMAL: f64 = 1.4826;

/// The factor on all records, over what sizes, mass and constants make of them, where it lies far outside of what calibrated chains leave;
/// `None` where it does not, or where the records want factors of their own.
///
/// Its standard deviation is that of the records' factors among each other, and that with which each is known: each resonance has an
/// error of its own, which the lines around it share, and there are so many `modes`.
pub(crate) fn common_gain(fits: &[AcceleranceFit], modes: usize) -> Option<Estimate> {
    let compared =
        fits.iter().map(|fit| Compared::of(&PlaceRecord::of_fit(fit, ReadAs::SI), &fit.frequency, &fit.model));
    let compared: Vec<Compared> = compared.collect::<Option<_>>()?;
    let delay = common_delay(&compared);
    let scales: Vec<_> = compared.iter().map(|of| of.scale(delay)).collect();
    if scales.is_empty() || scales.iter().any(|scale| scale.factor <= 0.0 || !scale.factor.is_finite()) {
        return None;
    }
    let log = median(scales.iter().map(|scale| -scale.factor.ln()));
    let scatter = NORMAL * median(scales.iter().map(|scale| (-scale.factor.ln() - log).abs()));
    let known = 0.01 * median(scales.iter().map(|scale| scale.left)) / (modes.max(1) as f64).sqrt();
    let is_far = log.abs() > FAR * CALIBRATED.hypot(known).hypot(scatter);
    let std = known.hypot(scatter / (scales.len() as f64).sqrt());
    is_far.then(|| Estimate { value: log.exp(), std: Some(std * log.exp()) })
}

/// That factor as a sentence, with the lines that mend it.
pub(crate) fn said_of_gain(gain: Estimate, test: &ImpactTest) -> String {
    let mass = match &test.pieces[..] {
        [only] => format!("mass_per_area = {:.4}", Readable(only.piece.mass_per_area / gain.value)),
        _ => "another mass_per_area".to_owned(),
    };
    let sensitivity = match structures::of_test(test).shown() {
        Shown::Wholly => format!("write an [[effect]] with id = \"gain\" and gain = {:.4}", Readable(gain.value)),
        Shown::InPart => format!("divide the motions by {:.4} in the files", Readable(gain.value)),
    };
    format!(
        "all records together are {:.4} +- {:.4} times what sizes, mass and constants make of them, far outside of what calibrated chains \
         leave ({:.1} %): {sensitivity} where a sensitivity is wrong, or {mass} where the mass is: the constants go with it",
        Readable(gain.value),
        Readable(gain.std.unwrap_or(f64::NAN)),
        100.0 * CALIBRATED
    )
}

/// Refuses a model that misses most of the motion.
///
/// # Errors
/// [`IdentifyError::OtherUnits`] where a factor explains that, else [`IdentifyError::Contradiction`] or, of a plate,
/// [`IdentifyError::PlateContradiction`].
pub(crate) fn refuse_missed(test: &ImpactTest, fits: &[AcceleranceFit]) -> Result<(), IdentifyError> {
    let records: Vec<PlaceRecord> = fits.iter().map(|fit| PlaceRecord::of_fit(fit, ReadAs::SI)).collect();
    let lines: Vec<_> = fits.iter().map(|fit| fit.model.clone()).collect();
    let of_pieces = |records: &[PlaceRecord]| {
        let placed: Vec<(usize, &PlaceRecord)> = fits.iter().map(|fit| fit.piece).zip(records).collect();
        contradicted(test, &placed, &lines, &[])
    };
    if of_pieces(&records).is_none() {
        return Ok(());
    }
    // Which unit is wrong depends on which was read.
    let read = test.accelerances(Settings::default().estimation)?;
    let as_read = |fit: &AcceleranceFit| {
        let is_it = |(piece, record): &&(usize, Accelerance)| {
            *piece == fit.piece && (record.force_at, record.response_at) == (fit.force_at, fit.response_at)
        };
        read.iter().find(is_it).map_or(ReadAs::SI, |(_, record)| record.read_as)
    };
    let records: Vec<PlaceRecord> = fits.iter().map(|fit| PlaceRecord::of_fit(fit, as_read(fit))).collect();
    of_pieces(&records).map_or(Ok(()), Err)
}
