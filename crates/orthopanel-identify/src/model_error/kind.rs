//! Kinds of model error, with what is known of their sizes before any data.

use orthopanel_model::StructureKind;

/// A kind of model error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Of the logarithm of each frequency, by itself; of a plate with what mixes its modes.
    Frequency,
    /// Of each residue along its predicted phase.
    Residue,
    /// The same in quadrature: small, for delays and filters show there.
    Quadrature,
    /// Of the damping between two modes, over the geometric mean of their own: without it modes are real.
    Coupling,
    /// Of the place of each record's hits \[m\].
    ForcePlace,
    /// Of the gain of each record.
    RecordGain,
    /// Of the sensor's place \[m\].
    ResponsePlace,
    /// Of the gain of all records alike.
    Gain,
    /// Of what modes beyond the band leave in each record.
    Remainder,
    /// Of what motions of the piece as a whole leave in each record above them, and of their residues: cords are no springs, and damp as they
    /// like.
    Hanging,
    /// Of the core's shear stiffness along the panel in each of its waves, by their length: see [`LENGTHS`](super::LENGTHS).
    LongestCore,
    LongCore,
    ShortCore,
    ShortestCore,
    /// Of the faces' bending stiffness, alike.
    LongestFaces,
    LongFaces,
    ShortFaces,
    ShortestFaces,
    /// Of the mass, alike.
    LongestMass,
    LongMass,
    ShortMass,
    ShortestMass,
}

/// Least size of any kind.
const LEAST: f64 = 1e-6;

/// Part of what sound panels usually miss that a plate is computed to: converged elements with a patch or a mass have the same frequencies to 1e-4. Were it
/// trusted further, small effects would be found that make up for how it is computed.
const COMPUTED: f64 = 0.2;

/// Median of damping between two modes over the geometric mean of their own.
pub(super) const COUPLING: f64 = 3e-2;

/// Median of a kind's size before any test, and the factor within which two of three lie.
const PRIORS: [(Kind, f64, f64); 22] = [
    (Kind::Frequency, 5e-4, 4.0),
    (Kind::Residue, 3e-3, 4.0),
    (Kind::Quadrature, 1e-3, 4.0),
    (Kind::Coupling, COUPLING, 5.0),
    (Kind::ForcePlace, 8e-4, 1.6),
    (Kind::RecordGain, 3e-3, 1.6),
    (Kind::ResponsePlace, 4e-4, 1.3),
    (Kind::Gain, 3e-3, 1.3),
    (Kind::Remainder, 5e-3, 4.0),
    (Kind::Hanging, 2e-2, 4.0),
    (Kind::LongestCore, 1e-2, 2.0),
    (Kind::LongCore, 1e-2, 2.0),
    (Kind::ShortCore, 5e-3, 2.5),
    (Kind::ShortestCore, 2e-3, 2.5),
    (Kind::LongestFaces, 3e-3, 2.2),
    (Kind::LongFaces, 3e-3, 2.2),
    (Kind::ShortFaces, 1.5e-3, 2.5),
    (Kind::ShortestFaces, 7e-4, 2.5),
    (Kind::LongestMass, 2e-3, 2.2),
    (Kind::LongMass, 2e-3, 2.2),
    (Kind::ShortMass, 1e-3, 2.5),
    (Kind::ShortestMass, 5e-4, 2.5),
];

/// Kinds of error.
pub(crate) const KINDS: usize = PRIORS.len();

/// $\ln\tau_k$ of every kind at its median.
pub(crate) fn medians() -> [f64; KINDS] {
    PRIORS.map(|(_, median, _)| median.ln())
}

/// Median of $\tau_f$, and the factor within which two of three lie.
pub(crate) fn frequency_prior() -> (f64, f64) {
    let (_, median, factor) = PRIORS[Kind::Frequency as usize];
    (median, factor)
}

/// $\ln\tau_k$ of every kind at its least: of a plate by what its model is computed to.
pub(crate) fn least_sizes(structure: StructureKind) -> [f64; KINDS] {
    let of_plate = [Kind::Frequency, Kind::Residue, Kind::Quadrature].map(|kind| kind as usize);
    std::array::from_fn(|kind| match structure {
        StructureKind::MindlinPlate if of_plate.contains(&kind) => (COMPUTED * PRIORS[kind].1).ln(),
        _ => LEAST.ln(),
    })
}

/// Least error of a residue of a plate in quadrature.
pub(super) fn least_quadrature() -> f64 {
    COMPUTED * PRIORS[Kind::Quadrature as usize].1
}

/// Standard deviation of $\ln\tau_k$ of every kind.
pub(crate) fn deviations() -> [f64; KINDS] {
    PRIORS.map(|(_, _, factor)| factor.ln())
}
