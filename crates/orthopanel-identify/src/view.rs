//! Modes as a record sees them: between two places, through its channel, with a core that may depend on frequency.

use std::f64::consts::TAU;
use std::sync::{Arc, Mutex, PoisonError};

use num_complex::Complex64;
use orthopanel_model::{ChannelFactor, ModesAtLine, Place, RelaxingMode, RelaxingModes, SeenModes};

use crate::coupled_damping::CoupledModes;
use crate::measured::MeasuredModes;

/// Of what a record sees: the value, and how it follows the place of the force along x, that of the response, and both along y.
pub(crate) const PARTS: usize = 5;

/// What acts on one record besides the structure.
#[derive(Default, PartialEq)]
pub(crate) struct Channel {
    pub factors: Vec<ChannelFactor>,
    /// Along x and along y.
    pub force_offset: [f64; 2],
    pub response_offset: [f64; 2],
    /// $1/\tau$ of windows \[1/s\], less what is undone of them in what was measured.
    pub decay: f64,
    /// Whether the sensor loads the structure.
    pub loads: bool,
}

impl Channel {
    pub(crate) fn at(&self, s: Complex64) -> Complex64 {
        self.factors.iter().map(|factor| factor.at(s)).product()
    }
}

/// Modes as records see them.
pub(crate) struct Views {
    /// Places of force and response of each record, with what offsets bring.
    pub places: Vec<[Place; 2]>,
    pub views: Vec<View>,
}

impl Views {
    /// Number of the modes that a record sees.
    pub(crate) fn number_of(&self, record: usize) -> usize {
        let own = |view: &View| view.of.is_none_or(|of| of == self.places[record][1]);
        self.views.iter().position(own).unwrap_or(0)
    }

    /// The modes that a record sees, and its ports of force and response.
    pub(crate) fn of_record(&self, record: usize) -> (&View, [usize; 2]) {
        let places = self.places[record];
        let view = &self.views[self.number_of(record)];
        (view, places.map(|place| view.ports.iter().position(|port| *port == place).unwrap_or(0)))
    }
}

/// Modes as some records see them.
pub(crate) struct View {
    /// The place of the sensor, where it loads the structure.
    pub of: Option<Place>,
    pub ports: Vec<Place>,
    /// With a core that depends on frequency, about as they are.
    pub modes: Arc<SeenModes>,
    pub relaxing: Option<Relaxing>,
}

impl View {
    /// How many modes count each by itself.
    pub(crate) fn near(&self) -> usize {
        self.modes.angular_frequency.len()
    }

    /// A mode with this damping ratio, and with what it has of others that damping couples it with.
    pub(crate) fn mode(&self, n: usize, zeta: f64, coupled: Option<&CoupledModes>) -> ModeOfView {
        if let Some(relaxing) = &self.relaxing {
            let mode = relaxing.mode(n, zeta);
            return ModeOfView { omega: mode.angular_frequency, zeta, core: Some((mode.damping, mode.by_s)) };
        }
        let omega = coupled.and_then(|coupled| coupled.angular_frequency.get(n).copied());
        ModeOfView { omega: omega.unwrap_or(self.modes.angular_frequency[n]), zeta, core: None }
    }

    /// The deflections of a mode at the ports of force and response, and their product.
    pub(crate) fn shape(
        &self,
        (n, [force, response]): (usize, [usize; 2]),
        zeta: f64,
        coupled: Option<&CoupledModes>,
    ) -> ([Complex64; 2], [Complex64; PARTS]) {
        if let Some(relaxing) = &self.relaxing {
            let mode = relaxing.mode(n, zeta);
            let shape =
                between(|port| mode.deflection[port], |axis, port| at(&mode.slopes[axis], port), [force, response]);
            return ([force, response].map(|port| mode.deflection[port]), shape);
        }
        let of_mode = |values: &[Vec<f64>], port: usize| {
            Complex64::from(values.get(n).and_then(|of| of.get(port)).copied().unwrap_or(0.0))
        };
        let slopes = [&self.modes.slope, &self.modes.slope_across];
        let deflection = |port: usize| {
            let mixed = coupled.and_then(|coupled| coupled.deflection(n, port));
            mixed.unwrap_or_else(|| of_mode(&self.modes.deflection, port))
        };
        let slope = |axis: usize, port: usize| {
            let mixed = coupled.and_then(|coupled| coupled.slope(axis, n, port));
            mixed.unwrap_or_else(|| of_mode(slopes[axis], port))
        };
        ([force, response].map(deflection), between(deflection, slope, [force, response]))
    }

    /// A mode's accelerance over the product of deflections, as the channel shows it, at a frequency of the remainder.
    pub(crate) fn line(
        &self,
        mode: &ModeOfView,
        n: usize,
        (number, s): (usize, Complex64),
        channel: &Channel,
    ) -> Complex64 {
        let s = s + channel.decay;
        let factor = channel.at(s) * s * s;
        match (&self.relaxing, mode.core) {
            (Some(relaxing), Some((damping, _))) => factor / (s * s + damping * s + relaxing.lines[number].lambda[n]),
            _ => factor / (s * s + 2.0 * mode.zeta * mode.omega * s + mode.omega * mode.omega),
        }
    }

    /// The product of deflections there, where it is another than at the pole: with a core that depends on frequency.
    pub(crate) fn shape_at_line(&self, (n, ports): (usize, [usize; 2]), number: usize) -> Option<[Complex64; PARTS]> {
        let line = &self.relaxing.as_ref()?.lines[number];
        let slope = |axis: usize, port: usize| at(&line.slopes[n][axis], port);
        Some(between(|port| line.deflection[n][port], slope, ports))
    }
}

/// The product of deflections at force and response, and how that follows either place, along x and along y.
fn between(
    deflection: impl Fn(usize) -> Complex64,
    slope: impl Fn(usize, usize) -> Complex64,
    [force, response]: [usize; 2],
) -> [Complex64; PARTS] {
    let by = |axis: usize| [slope(axis, force) * deflection(response), deflection(force) * slope(axis, response)];
    let ([force_x, response_x], [force_y, response_y]) = (by(0), by(1));
    [deflection(force) * deflection(response), force_x, response_x, force_y, response_y]
}

/// A slope at a port, if slopes were asked for.
fn at(slopes: &[Complex64], port: usize) -> Complex64 {
    slopes.get(port).copied().unwrap_or(Complex64::ZERO)
}

/// Modes of a panel whose core depends on frequency.
pub(crate) struct Relaxing {
    pub modes: RelaxingModes,
    /// At the remainder's frequencies.
    pub lines: Vec<ModesAtLine>,
    /// The last mode that was asked for at a damping ratio: records ask one after the other.
    pub known: Mutex<Vec<Option<(f64, RelaxingMode)>>>,
}

impl Relaxing {
    pub(crate) fn new(modes: RelaxingModes, measured: &MeasuredModes) -> Self {
        let line = |frequency: &f64| modes.at(Complex64::new(0.0, TAU * frequency));
        let lines = measured.remainder_frequencies.iter().map(line).collect();
        let known = Mutex::new(vec![None; modes.near()]);
        Self { modes, lines, known }
    }

    pub(crate) fn mode(&self, n: usize, zeta: f64) -> RelaxingMode {
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        match &known[n] {
            Some((own, mode)) if *own == zeta => mode.clone(),
            _ => {
                let mode = self.modes.mode(n, zeta);
                known[n] = Some((zeta, mode.clone()));
                mode
            }
        }
    }

    /// Each mode as it is without damping beside the core's, without phases.
    pub(crate) fn usual(&self) -> SeenModes {
        let real = |values: &[Complex64]| values.iter().map(|value| value.re).collect::<Vec<f64>>();
        let modes: Vec<RelaxingMode> = (0..self.modes.near()).map(|n| self.modes.mode(n, 0.0)).collect();
        SeenModes {
            angular_frequency: modes.iter().map(|mode| mode.angular_frequency).collect(),
            damping_ratio: modes.iter().map(RelaxingMode::core_damping).collect(),
            deflection: modes.iter().map(|mode| real(&mode.deflection)).collect(),
            slope: modes.iter().map(|mode| real(&mode.slopes[0])).collect(),
            slope_across: modes.iter().map(|mode| real(&mode.slopes[1])).collect(),
            ..SeenModes::default()
        }
    }
}

/// A mode: $\omega$ and $\zeta$.
pub(crate) struct ModeOfView {
    pub omega: f64,
    pub zeta: f64,
    /// With a core that depends on frequency what damps it beside that, and the derivative of its dynamic stiffness at the pole.
    pub core: Option<(f64, Complex64)>,
}

impl ModeOfView {
    /// $\lambda$.
    pub(crate) fn pole(&self) -> Complex64 {
        self.omega * Complex64::new(-self.zeta, (1.0 - self.zeta * self.zeta).sqrt())
    }

    /// Residue of the accelerance over the product of deflections, $c(\lambda)\lambda^2/(\lambda-\bar\lambda)$.
    pub(crate) fn residue(&self, channel: &Channel) -> Complex64 {
        let lambda = self.pole();
        let by_s = self.core.map_or(lambda - lambda.conj(), |(_, by_s)| by_s);
        channel.at(lambda) * lambda * lambda / by_s
    }

    /// The two terms of a residue over the product of deflections and over its conjugate, which stand by themselves.
    pub(crate) fn apart(&self, residue: Complex64, s: Complex64, channel: &Channel) -> [Complex64; 2] {
        let lambda = self.pole() - channel.decay;
        [residue / (s - lambda), residue.conj() / (s - lambda.conj())]
    }
}

/// A mode through a channel.
pub(crate) struct ModeInRecord {
    pub mode: ModeOfView,
    /// The pole that is its partner.
    pub pole: Option<usize>,
    /// Its residue over the product of deflections; zero of a mode that does not stand by itself.
    pub unit: Complex64,
    /// At each frequency of the remainder [`View::line`] and [`ModeOfView::apart`].
    pub lines: Vec<(Complex64, [Complex64; 2])>,
}
