//! What an identification found.

use std::collections::BTreeMap;

use crate::{IdentifyError, TracedEffect};
use num_complex::Complex64;
use orthopanel_data::NamedPiece;
use orthopanel_model::{
    Boundary, CorrelationMatrix, Damping, Estimate, MODEL_SCHEMA, Owner, PanelModel, Piece, Place, Ports, StructureKind,
};

/// Constants, their uncertainty, and how the model meets each measured mode.
#[derive(Debug, Clone, PartialEq)]
pub struct Identification {
    /// What vibrates.
    pub structure: StructureKind,
    /// Every constant of the structure, in its order; one that pieces have of their own stands once a piece, behind the
    /// shared one.
    pub constants: Vec<IdentifiedConstant>,
    /// Constants that the data do not show; in `constants` they stand as held.
    pub not_identified: Vec<NotIdentified>,
    /// Correlation of each pair of identified constants.
    pub correlations: Vec<Correlation>,
    /// How the model meets each piece.
    pub pieces: Vec<PieceFit>,
    /// Root of eq. 22 \[%\]: rms of $(f_{exp}-f_{cal})/f_{exp}$ over all modes.
    pub frequency_rms_percent: f64,
    /// Rms error \[%\] of each frequency predicted from all the others; `None` where leaving one out leaves fewer
    /// frequencies than constants.
    pub left_one_out_percent: Option<f64>,
    /// Rms of the misfit of the accelerances over the rms measured \[%\], where there are records.
    pub accelerance_rms_percent: Option<f64>,
    /// Misfit of the accelerances per datum, in units of the records' own noise: near 1 where the model lacks nothing;
    /// `None` without records, or where these do not tell their noise.
    pub chi_square: Option<f64>,
    /// Measured and calculated accelerances, one a pair of places.
    pub accelerances: Vec<AcceleranceFit>,
    /// The effects that the test file declares, with what was identified of them.
    pub effects: Vec<TracedEffect>,
    /// What is to be asked before these numbers count: a window that the test file does not declare. It stands in `notes` too.
    pub question: Option<String>,
    /// The factor on all records beside what sizes, mass and constants make of them, where it is far outside of what calibrated chains
    /// leave; the first of `notes` says so.
    pub common_gain: Option<Estimate>,
    /// What was left out, cut, assumed or found wanting, a sentence each.
    pub notes: Vec<String>,
}

/// One constant.
#[derive(Debug, Clone, PartialEq)]
pub struct IdentifiedConstant {
    /// Name, such as `e_x`.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Value.
    pub value: f64,
    /// Standard deviation; `None` where the constant was held, or where the data cannot tell (as many frequencies as
    /// constants, and no resolution stated).
    pub std: Option<f64>,
    /// Whether it was held at this value: by the test file, or since the data do not show it.
    pub held: bool,
    /// Name of the piece that has it of its own; `None` where pieces share it.
    pub piece: Option<String>,
}

/// A constant that the data do not show.
#[derive(Debug, Clone, PartialEq)]
pub struct NotIdentified {
    /// Name.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// The value at which it was held.
    pub held_at: f64,
    /// What the data leave open: the 95 % interval, cut at the bounds.
    pub interval: [f64; 2],
    /// Where the constants go when this one moves and the others make up for it as far as they can: components of a unit
    /// vector by name, this one first, in logarithms of the moduli and in Poisson's ratio itself.
    pub direction: Vec<(&'static str, f64)>,
}

impl NotIdentified {
    /// The direction as text, such as `ln g_yz +0.98, nu_xy -0.17`.
    pub fn direction_text(&self) -> String {
        let component = |(name, value): &(&str, f64)| {
            let logarithm = if *name == "nu_xy" { "" } else { "ln " };
            format!("{logarithm}{name} {value:+.2}")
        };
        self.direction.iter().map(component).collect::<Vec<_>>().join(", ")
    }
}

/// Correlation coefficient of two identified constants.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Correlation {
    /// Name of the one.
    pub first: &'static str,
    /// Index of the piece that has it of its own; `None` where pieces share it.
    pub first_piece: Option<usize>,
    /// Name of the other.
    pub second: &'static str,
    /// Index of the piece that has that of its own.
    pub second_piece: Option<usize>,
    /// The coefficient, from -1 to 1.
    pub value: f64,
}

/// How the model meets one piece.
#[derive(Debug, Clone, PartialEq)]
pub struct PieceFit {
    /// Name in the test file.
    pub name: String,
    /// The piece.
    pub piece: Piece,
    /// The modes that the test shows.
    pub modes: Vec<ModeFit>,
    /// Modes inside the band of the records of which no resonance stands out.
    pub hidden: Vec<HiddenMode>,
    /// Damping ratio of every flexible mode inside the band, in order; empty where the test measures none.
    pub damping: Vec<Estimate>,
}

impl PieceFit {
    /// Of a piece, before any mode is held against it.
    pub(crate) fn of(named: &NamedPiece) -> Self {
        let name = named.name.clone();
        Self { name, piece: named.piece, modes: vec![], hidden: vec![], damping: vec![] }
    }

    /// The damping ratios that the records tell, with a resonance of their own or without.
    pub fn measured_damping(&self) -> impl Iterator<Item = Estimate> + '_ {
        let seen = self.modes.iter().map(|mode| mode.damping);
        seen.chain(self.hidden.iter().map(|mode| mode.damping)).flatten()
    }
}

/// Accelerance of one pair of places, measured and of the model.
#[derive(Debug, Clone, PartialEq)]
pub struct AcceleranceFit {
    /// Index of the piece in the test, from 0.
    pub piece: usize,
    /// Where the force acts.
    pub force_at: Place,
    /// Where the acceleration is measured.
    pub response_at: Place,
    /// $\sigma$ \[1/s\] of $s = \sigma + j\omega$ at which both stand, as the window over the records has it; else zero.
    pub decay_rate: f64,
    /// Lines \[Hz\].
    pub frequency: Vec<f64>,
    /// Measured \[(m/s²)/N\].
    pub measured: Vec<Complex64>,
    /// Calculated \[(m/s²)/N\].
    pub model: Vec<Complex64>,
    /// Variance $E|\hat H-H|^2$ of each measured line, smooth over frequency, as the fit weighs it \[((m/s²)/N)²\];
    /// `None` where the records do not tell it.
    pub variance: Option<Vec<f64>>,
}

/// One measured mode and the model's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModeFit {
    /// Flexible mode, from 1: its place among all flexible modes of the structure.
    pub mode: usize,
    /// Nodal lines across x and across y.
    pub nodes: [usize; 2],
    /// Measured natural frequency \[Hz\].
    pub measured: f64,
    /// Standard deviation of the same \[Hz\]: from the noise of the records and what these differ by among each other,
    /// or from the bins stated beside a list of frequencies; `None` where neither is told.
    pub measured_std: Option<f64>,
    /// The model's \[Hz\].
    pub model: f64,
    /// Modal damping ratio, where the test measures it.
    pub damping: Option<Estimate>,
}

/// A mode inside the band of the records that stands out of none of them, as where its neighbours or a node hide it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HiddenMode {
    /// Flexible mode, from 1.
    pub mode: usize,
    /// Nodal lines across x and across y.
    pub nodes: [usize; 2],
    /// The model's natural frequency \[Hz\].
    pub model: f64,
    /// Modal damping ratio, where the lines of all records tell it together; else the model has a usual one.
    pub damping: Option<Estimate>,
}

impl ModeFit {
    /// $(f_{cal}-f_{exp})/f_{exp}$ \[%\].
    pub fn error_percent(&self) -> f64 {
        100.0 * (self.model - self.measured) / self.measured
    }
}

impl Identification {
    /// Refuses a constant whose standard deviation exceeds it: that is no result.
    pub(crate) fn determined(self) -> Result<Self, IdentifyError> {
        let open = self.constants.iter().find_map(|constant| {
            let std = constant.std.filter(|std| *std > constant.value || std.is_nan())?;
            let &IdentifiedConstant { name, unit, value, .. } = constant;
            Some(IdentifyError::NotDetermined { name, value, std, unit })
        });
        open.map_or(Ok(self), Err)?.finite()
    }

    /// Refuses an identification of which a number is not finite.
    fn finite(self) -> Result<Self, IdentifyError> {
        let told = |what: &str, value: Option<f64>| value.map(|value| (what.to_owned(), value));
        let errors = [
            told("error of the frequencies", Some(self.frequency_rms_percent)),
            told("error of each frequency predicted from the others", self.left_one_out_percent),
            told("error of the accelerances", self.accelerance_rms_percent),
            told("misfit per datum", self.chi_square),
        ];
        let constants = self.constants.iter().map(|constant| (format!("value of {}", constant.name), constant.value));
        let modes = self.pieces.iter().flat_map(|piece| &piece.modes);
        let modes = modes.map(|mode| (format!("frequency of mode {}", mode.mode), mode.model));
        let lost = errors.into_iter().flatten().chain(constants).chain(modes).find(|(_, value)| !value.is_finite());
        lost.map_or(Ok(self), |(what, _)| Err(IdentifyError::NotFinite { what }))
    }

    /// The correlation of the constants of a piece that have a standard deviation; damping ratios, which shift no resonance, are independent
    /// of them to first order.
    fn correlation_of(&self, fit: &PieceFit) -> Option<CorrelationMatrix> {
        let of_piece = |constant: &&IdentifiedConstant| constant.piece.as_ref().is_none_or(|name| *name == fit.name);
        // A piece's own constant stands behind the shared one.
        let own = |constant: &orthopanel_model::Constant| {
            self.constants
                .iter()
                .filter(of_piece)
                .rfind(|own| own.name == constant.name)
                .filter(|own| own.std.is_some())
        };
        let known: Vec<&IdentifiedConstant> = self.structure.constants().iter().filter_map(own).collect();
        let is = |of: &IdentifiedConstant, name: &str, piece: Option<usize>| {
            let own = piece.and_then(|piece| self.pieces.get(piece)).map(|piece| piece.name.as_str());
            of.name == name && of.piece.as_deref() == own
        };
        let coefficient = |i: usize, j: usize| {
            let of = |pair: &&Correlation| {
                let between = |a: &IdentifiedConstant, b: &IdentifiedConstant| {
                    is(a, pair.first, pair.first_piece) && is(b, pair.second, pair.second_piece)
                };
                between(known[i], known[j]) || between(known[j], known[i])
            };
            self.correlations.iter().find(of).map_or(0.0, |pair| pair.value)
        };
        CorrelationMatrix::between(known.iter().map(|constant| constant.name.to_owned()).collect(), coefficient)
    }

    /// The model of one piece with the identified constants, ready for a model file.
    ///
    /// Damping holds the ratios that were measured; `beyond` is left at zero for the caller to state.
    pub fn panel_model(&self, fit: &PieceFit, boundary: Boundary, ports: Ports) -> PanelModel {
        let estimate = |constant: &IdentifiedConstant| Estimate { value: constant.value, std: constant.std };
        // A piece's own constant stands behind the shared one, and so replaces it.
        let of_piece = |constant: &&IdentifiedConstant| constant.piece.as_ref().is_none_or(|name| *name == fit.name);
        let (ratios, std): (Vec<f64>, Vec<_>) = fit.damping.iter().map(|ratio| (ratio.value, ratio.std)).unzip();
        let std = told(&std);
        // An effect at a place is on the piece that was hit.
        let hit = self.accelerances.first().and_then(|record| self.pieces.get(record.piece));
        let is_elsewhere = hit.is_some_and(|hit| hit.name != fit.name);
        let acts = |effect: &&TracedEffect| effect.owner == Owner::Panel && !(is_elsewhere && effect.has_place());
        PanelModel {
            name: None,
            schema: MODEL_SCHEMA.to_owned(),
            piece: fit.piece,
            boundary,
            structure: self.structure,
            constants: self
                .constants
                .iter()
                .filter(of_piece)
                .map(|constant| (constant.name.to_owned(), estimate(constant)))
                .collect(),
            damping: Damping { ratios, std, beyond: 0.0 },
            correlation: self.correlation_of(fit),
            effects: self.effects.iter().filter(acts).map(TracedEffect::entry).collect(),
            ports,
            provenance: BTreeMap::new(),
        }
    }
}

/// As a model has standard deviations: nothing where none is known.
pub(crate) fn told(std: &[Option<f64>]) -> Vec<Option<f64>> {
    if std.iter().any(Option::is_some) { std.to_vec() } else { Vec::new() }
}
