//! Name, unit, bounds and starting values of an effect's parameter.

use crate::Piece;

/// One parameter of an effect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EffectParameter {
    /// Name in files.
    pub name: &'static str,
    /// SI unit of the value.
    pub unit: &'static str,
    low: f64,
    high: f64,
    /// Where it is looked for in an effect that nobody declared, where that is narrower.
    looked_for: Option<(f64, f64)>,
    starts: &'static [f64],
    relative_to: Reference,
    /// How a search should step.
    pub scale: Scale,
    /// Whether each record has a value of its own.
    pub each_record: bool,
    /// The value that it keeps unless it is asked for; `None` where the effect always needs it.
    pub held_at: Option<f64>,
    /// What is thought of it before a test.
    pub prior: Prior,
    /// Whether it is a place, an offset or a mass across the panel: a plate has it, and on a beam it is that of the centre line.
    pub across: bool,
    /// Whether it is a factor, of which one is none of the effect.
    pub is_factor: bool,
    /// Whether on a plate it may be none where another is some of the effect: masses along one pair of edges.
    pub none_beside_another: bool,
}

/// What is thought of a parameter before a test: an honest range over panels, sensors and rigs, in the parameter's own unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Prior {
    /// Evenly between its bounds.
    Even,
    /// Its size is log-normal: two of three lie within a factor of the median.
    Size {
        /// The median.
        median: f64,
        /// The factor, above one.
        factor: f64,
        /// Whether it is as likely below zero.
        signed: bool,
    },
    /// Gaussian.
    Gaussian {
        /// The mean.
        mean: f64,
        /// The standard deviation.
        std: f64,
    },
}

/// How a search should step through the values of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// In the value itself.
    Linear,
    /// In its logarithm: it spans decades.
    Log,
    /// One whole number after the other.
    Index,
}

/// What bounds and starting values are counted in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Reference {
    /// The parameter's own unit.
    Unit,
    /// The piece's length.
    Length,
    /// The piece's width.
    Width,
    /// The piece's mass.
    Mass,
}

impl EffectParameter {
    pub(super) const fn linear(
        name: &'static str,
        unit: &'static str,
        range: [f64; 2],
        starts: &'static [f64],
    ) -> Self {
        let ([low, high], relative_to, scale) = (range, Reference::Unit, Scale::Linear);
        Self {
            name,
            unit,
            low,
            high,
            looked_for: None,
            starts,
            relative_to,
            scale,
            each_record: false,
            held_at: None,
            prior: Prior::Even,
            across: false,
            is_factor: false,
            none_beside_another: false,
        }
    }

    pub(super) const fn log(name: &'static str, unit: &'static str, range: [f64; 2], starts: &'static [f64]) -> Self {
        Self { scale: Scale::Log, ..Self::linear(name, unit, range, starts) }
    }

    /// Looked for between these where the effect is not declared.
    pub(super) const fn looked_for_in(self, [low, high]: [f64; 2]) -> Self {
        Self { looked_for: Some((low, high)), ..self }
    }

    /// Held at a value unless it is asked for.
    pub(super) const fn held_at(self, value: f64) -> Self {
        Self { held_at: Some(value), ..self }
    }

    /// With a size that is log-normal: its median, and the factor within which two of three lie.
    pub(super) const fn sized(self, median: f64, factor: f64) -> Self {
        Self { prior: Prior::Size { median, factor, signed: false }, ..self }
    }

    /// With a size that is log-normal, and either sign.
    pub(super) const fn signed(self, median: f64, factor: f64) -> Self {
        Self { prior: Prior::Size { median, factor, signed: true }, ..self }
    }

    /// A factor, of which one is none of the effect.
    pub(super) const fn factor(self) -> Self {
        Self { is_factor: true, ..self }
    }

    /// None where another parameter is some of the effect, on a plate.
    pub(super) const fn none_beside_another(self) -> Self {
        Self { none_beside_another: true, ..self }
    }

    /// Gaussian about a mean.
    pub(super) const fn about(self, mean: f64, std: f64) -> Self {
        Self { prior: Prior::Gaussian { mean, std }, ..self }
    }

    /// With a value of its own in each record.
    pub(super) const fn in_each_record(self) -> Self {
        Self { each_record: true, ..self }
    }

    /// The number of a record, from 1.
    pub(super) const fn record() -> Self {
        Self { scale: Scale::Index, ..Self::linear("record", "1", [1.0, 1e6], &[1.0]) }
    }

    pub(super) const fn of(self, relative_to: Reference) -> Self {
        Self { relative_to, ..self }
    }

    /// A place along x, anywhere on the piece.
    pub(super) const fn place() -> Self {
        const GRID: &[f64] = &[-0.45, -0.35, -0.25, -0.15, -0.05, 0.05, 0.15, 0.25, 0.35, 0.45];
        Self::linear("x", "m", [-0.5, 0.5], GRID).of(Reference::Length)
    }

    /// A place along y, anywhere on a plate.
    pub(super) const fn place_across() -> Self {
        Self::linear("y", "m", [-0.5, 0.5], &[0.0]).across("y").of(Reference::Width)
    }

    /// The same across the panel, where a beam has none.
    pub(super) const fn across(self, name: &'static str) -> Self {
        Self { name, across: true, held_at: Some(0.0), ..self }
    }

    /// Least and greatest value for a piece.
    pub fn range(&self, piece: &Piece) -> (f64, f64) {
        let scale = self.relative_to.of(piece);
        (self.low * scale, self.high * scale)
    }

    /// The same for an effect that is not declared.
    pub fn range_looked_for(&self, piece: &Piece) -> (f64, f64) {
        let scale = self.relative_to.of(piece);
        self.looked_for.map_or_else(|| self.range(piece), |(low, high)| (low * scale, high * scale))
    }

    /// Where a search should start, the likeliest first.
    pub fn starts(&self, piece: &Piece) -> Vec<f64> {
        let scale = self.relative_to.of(piece);
        self.starts.iter().map(|start| start * scale).collect()
    }
}

impl Reference {
    fn of(self, piece: &Piece) -> f64 {
        match self {
            Self::Unit => 1.0,
            Self::Length => piece.length,
            Self::Width => piece.width,
            Self::Mass => piece.mass(),
        }
    }
}
