//! Where connections stand among the inputs of the modes, what is read of them, and how springs couple the modes.

use std::collections::BTreeMap;

use orthopanel_model::{DeflectionRow, ModalModel, ModalStepper, Mode, ModelError, Place, Ports, RigidMotion};

/// What an input does to the modes.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Load {
    /// Works on this row of deflections.
    Works(DeflectionRow),
    /// Moves the base of the spring, or of the dashpot, of a mount, which stands where this row says.
    Base(DeflectionRow),
    /// Accelerates the frame, and through it the masses of the panel: $-\Gamma_r$.
    Frame(RigidMotion, DeflectionRow),
}

impl Load {
    fn row(&self) -> &DeflectionRow {
        match self {
            Self::Works(row) | Self::Base(row) | Self::Frame(_, row) => row,
        }
    }
}

/// An input behind the forces.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Input {
    pub name: String,
    pub unit: &'static str,
    pub description: String,
    pub load: Load,
}

/// What an output is read from, by its place among the responses or the inputs of the modes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Signal {
    Displacement(usize),
    Velocity(usize),
    Acceleration(usize),
    Input(usize),
}

/// A weighted sum of signals.
pub(crate) type Terms = Vec<(Signal, f64)>;

/// An output behind the motions of the ports.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Output {
    pub name: String,
    pub unit: &'static str,
    pub description: String,
    pub terms: Terms,
    pub moved_by: MovedBy,
}

/// Which tunable parameters change an output at once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum MovedBy {
    /// The place of a response.
    Response(usize),
    /// Those of a mount.
    Mount(usize),
    /// All that pushes or damps the panel.
    Loads,
}

/// A spring and a dashpot, $k(w-u) + c(\dot w-\dot u)$: its two inputs, and the response that it follows.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Spring {
    pub at: Place,
    pub stiffness: f64,
    pub damping: f64,
    pub displacement: usize,
    pub velocity: usize,
    pub response: usize,
}

/// Inputs and responses of the modes in their order: those of the ports, then those of the connections.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Layout {
    forces: Vec<DeflectionRow>,
    pub inputs: Vec<Input>,
    pub outputs: Vec<Output>,
    /// What is read of each mode, at the ports and for outputs of connections.
    responses: Vec<DeflectionRow>,
    pub springs: Vec<Spring>,
    /// The motions of the frame, each with its own inertia $\Gamma_r(r)$; their coordinates stand before all modes.
    pub frame: Vec<(RigidMotion, f64)>,
}

impl Layout {
    pub(super) fn of_ports(ports: &Ports) -> Self {
        let rows = |places: &[Place]| places.iter().copied().map(DeflectionRow::at).collect();
        Self {
            forces: rows(&ports.forces),
            inputs: vec![],
            outputs: vec![],
            responses: rows(&ports.responses),
            springs: vec![],
            frame: vec![],
        }
    }

    /// Inputs and responses in all.
    pub(crate) fn counts(&self) -> (usize, usize) {
        (self.forces.len() + self.inputs.len(), self.responses.len())
    }

    /// Adds an input; its place among all.
    #[cold]
    pub(super) fn input(&mut self, name: String, unit: &'static str, description: String, load: Load) -> usize {
        self.inputs.push(Input { name, unit, description, load });
        self.counts().0 - 1
    }

    /// Adds something to be read of each mode; its place among all.
    #[cold]
    pub(super) fn response(&mut self, row: DeflectionRow) -> usize {
        self.responses.push(row);
        self.responses.len() - 1
    }

    /// What each input pushes a frame by in a motion; nothing for one that moves a base or the frame.
    #[cold]
    pub(super) fn resultants(&self, motion: RigidMotion) -> Terms {
        let rows = self.forces.iter().chain(self.inputs.iter().map(|input| input.load.row()));
        let works = self.forces.iter().map(|_| true);
        let works = works.chain(self.inputs.iter().map(|input| matches!(input.load, Load::Works(_))));
        let all = rows.zip(works).enumerate();
        all.filter(|(_, (_, works))| *works)
            .map(|(index, (row, _))| (Signal::Input(index), row.of_rigid(motion)))
            .collect()
    }

    /// Where deflections of the modes kept must be known, each once.
    #[cold]
    pub(crate) fn places(&self) -> Vec<Place> {
        let mut known = Numbers::default();
        self.rows().for_each(|row| row.places().for_each(|place| _ = known.number(place)));
        known.places
    }

    /// Where those of residual modes must be: uniform loads leave these alone.
    #[cold]
    pub(crate) fn near_places(&self) -> Vec<Place> {
        let mut known = Numbers::default();
        self.rows().filter(|row| is_near(row)).for_each(|row| row.places().for_each(|place| _ = known.number(place)));
        known.places
    }

    fn rows(&self) -> impl Iterator<Item = &DeflectionRow> {
        self.forces.iter().chain(self.inputs.iter().map(|input| input.load.row())).chain(&self.responses)
    }

    /// The modes as inputs and responses see them, from those with the deflections at [`Layout::places`] and residual ones with those at
    /// [`Layout::near_places`], behind the coordinates of the frame; without the springs.
    #[cold]
    pub(crate) fn seen(&self, kept: &ModalModel, residual: &[Mode]) -> Result<ModalModel, ModelError> {
        let all = Numbers::of(self.places());
        let near = Numbers::of(self.near_places());
        let (inputs, responses) = self.counts();
        let of = |mode: &Mode, known: &Numbers, only_near: bool| {
            let value = |row: &DeflectionRow| {
                let at = |place: Place| known.find(place).and_then(|index| mode.at_forces.get(index)).copied();
                let counts = !only_near || is_near(row);
                if counts { row.of_mode(mode.angular_frequency, |place| at(place).unwrap_or(f64::NAN)) } else { 0.0 }
            };
            let forces = self.forces.iter().chain(self.inputs.iter().map(|input| input.load.row()));
            Mode {
                at_forces: forces.map(value).collect(),
                at_responses: self.responses.iter().map(value).collect(),
                ..*mode
            }
        };
        // $\sqrt{\Gamma_r(r)}\,b_r$: then it is mass-normalised as the others are.
        let frame = self.frame.iter().map(|&(motion, inertia)| {
            let moved = |input: &Input| match input.load {
                Load::Frame(own, _) if own == motion => inertia.sqrt(),
                _ => 0.0,
            };
            Mode {
                angular_frequency: 0.0,
                damping_ratio: 0.0,
                at_forces: self.forces.iter().map(|_| 0.0).chain(self.inputs.iter().map(moved)).collect(),
                at_responses: self.responses.iter().map(|row| row.of_rigid(motion) / inertia.sqrt()).collect(),
            }
        });
        let modes = frame.chain(kept.modes().iter().map(|mode| of(mode, &all, false)));
        let modes: Vec<Mode> = modes.chain(residual.iter().map(|mode| of(mode, &near, true))).collect();
        let size = modes.len();
        let model = ModalModel::new(inputs, responses, modes)?;
        if kept.damping_coupling().is_empty() {
            return Ok(model);
        }
        let first = self.frame.len();
        let mut coupling = vec![vec![0.0; size]; size];
        for (row, own) in coupling.iter_mut().skip(first).zip(kept.damping_coupling()) {
            row.iter_mut().skip(first).zip(own).for_each(|(value, own)| *value = *own);
        }
        model.with_damping_coupling(coupling)
    }

    /// The terms of all outputs.
    pub(crate) fn terms(&self) -> Vec<Terms> {
        self.outputs.iter().map(|output| output.terms.clone()).collect()
    }

    /// These modes on the springs.
    #[cold]
    pub(crate) fn mounted(&self, model: &ModalModel) -> Result<ModalModel, ModelError> {
        mounted(model, &self.springs)
    }
}

/// Whether a row is one of a few places: so are all but those of uniform loads.
fn is_near(row: &DeflectionRow) -> bool {
    row.resonators.is_empty() && row.terms.len() <= 2
}

/// The modes on springs: with $\phi$ the deflection that a spring works on and $\phi'$ the one that it follows, which a frame moves too,
/// $$k_{mn} \mathrel{+}= k\,\phi_m\phi'_n,\qquad c_{mn} \mathrel{+}= c\,\phi_m\phi'_n,$$
/// and the displacement and velocity of its base push the modes by $k\phi_m$ and $c\phi_m$.
///
/// Modes keep their coordinates, so that stiffness and damping may change while these go on.
fn mounted(model: &ModalModel, springs: &[Spring]) -> Result<ModalModel, ModelError> {
    if springs.is_empty() {
        return Ok(model.clone());
    }
    let mut modes = model.modes().to_vec();
    let size = modes.len();
    let mut stiffness = vec![vec![0.0; size]; size];
    let mut damping = model.damping_coupling().to_vec();
    damping.resize(size, vec![0.0; size]);
    for spring in springs {
        let pushed: Vec<f64> =
            modes.iter().map(|mode| mode.at_forces.get(spring.displacement).copied().unwrap_or(f64::NAN)).collect();
        let followed: Vec<f64> =
            modes.iter().map(|mode| mode.at_responses.get(spring.response).copied().unwrap_or(f64::NAN)).collect();
        for (m, pushed) in pushed.iter().enumerate() {
            for (n, followed) in followed.iter().enumerate() {
                let both = pushed * followed;
                stiffness[m][n] += spring.stiffness * both;
                damping[m][n] += spring.damping * both;
            }
        }
        for mode in &mut modes {
            for (input, law) in [(spring.displacement, spring.stiffness), (spring.velocity, spring.damping)] {
                if let Some(value) = mode.at_forces.get_mut(input) {
                    *value *= law;
                }
            }
        }
    }
    ModalModel::new(model.force_count(), model.response_count(), modes)?
        .with_damping_coupling(damping)?
        .with_stiffness_coupling(stiffness)
}

/// The value of an output \[its unit\] of modes under these inputs; `None` where it asks for what there is not.
pub(crate) fn value(terms: &Terms, stepper: &ModalStepper, inputs: &[f64]) -> Option<f64> {
    let signal = |signal: Signal| match signal {
        Signal::Displacement(response) => stepper.displacement(response),
        Signal::Velocity(response) => stepper.velocity(response),
        Signal::Acceleration(response) => stepper.acceleration(response),
        Signal::Input(input) => inputs.get(input).copied(),
    };
    terms.iter().try_fold(0.0, |sum, &(of, weight)| Some(sum + weight * signal(of)?))
}

/// Places by their number, each once.
#[derive(Default)]
struct Numbers {
    places: Vec<Place>,
    known: BTreeMap<[u64; 2], usize>,
}

impl Numbers {
    fn of(places: Vec<Place>) -> Self {
        let mut numbers = Self::default();
        places.into_iter().for_each(|place| _ = numbers.number(place));
        numbers
    }

    #[cold]
    fn number(&mut self, place: Place) -> usize {
        let next = self.places.len();
        let number = *self.known.entry(bits(place)).or_insert(next);
        if number == next {
            self.places.push(place);
        }
        number
    }

    fn find(&self, place: Place) -> Option<usize> {
        self.known.get(&bits(place)).copied()
    }
}

fn bits(place: Place) -> [u64; 2] {
    [place.x, place.y].map(f64::to_bits)
}
