//! Predicted modes of a structure with any effects, in the terms of the measured ones.

use std::collections::VecDeque;
use std::f64::consts::TAU;
use std::sync::{Arc, Mutex, PoisonError};

use num_complex::Complex64;
use orthopanel_model::{
    Action, CoreModulus, EffectSetting, EffectState, Field, Mode, ModelError, ModifiedPanel, Piece, Place,
    RecordSetting, RelaxingModes, Seat, SeenModes, Shift, StructureKind, SuspensionMotion,
};

use crate::comparison::{Comparison, UNSEEN};
use crate::coupled_damping::CoupledModes;
use crate::measured::{MeasuredRecord, Pole, SKIRT};
use crate::view::{Channel, ModeInRecord, PARTS, Relaxing, View, Views};

/// Predicted modes beyond the number of poles that take part.
const SPARE: usize = 6;
/// Up to so many times the highest measured frequency a predicted mode may be the partner of a pole.
const ABOVE: f64 = 1.3;
/// Deviation of the logarithm of the frequency of a mode that is to be matched: of a beam, and of a plate, whose modes lie closer.
const APART: [f64; 2] = [0.06, 0.015];
/// The same of the piece as a whole on its suspension.
const HANGING_APART: f64 = 0.25;
/// Step along a change of modes from which its derivative is taken: of a wave of unevenness.
const SHIFT: f64 = 1e-5;
/// Times the highest frequency of the piece as a whole from which on a remainder is that of a free piece but for small terms.
const CLEAR_OF_HANGING: f64 = 3.0;
/// Sets of modes that are kept.
const KEPT: usize = 48;
/// Modes of a plate are told up to so many times the highest pole: of what a beam may be, and of a declared plate, whose highest modes masses move most.
const WIDE: [f64; 2] = [1.25, 1.6];
/// Part of the lowest pole's frequency, from which on a predicted mode may be its partner.
const LOWEST: f64 = 0.4;
/// Part of the band up to which a mode of some strength is seen.
const MOSTLY_SEEN: f64 = 0.97;
/// Poles whose damping ratios say how far a resonance reaches at the band's end.
const BESIDE: usize = 3;
const MOST_DAMPING: f64 = 0.9;
/// Damping ratio of modes that no pole belongs to, where no pole tells one.
const USUAL_DAMPING: f64 = 0.003;

/// Deviation of the logarithm of the frequency of a mode that is to be matched.
pub(crate) fn apart(structure: StructureKind) -> f64 {
    APART[usize::from(structure == StructureKind::MindlinPlate)]
}

/// A structure with the places of a test, in which effects act.
pub(crate) struct Predictor<'a> {
    pub comparison: &'a Comparison<'a>,
    pub structure: StructureKind,
    panel: ModifiedPanel,
    setting: EffectSetting,
    /// Every place of the test once.
    places: Vec<Place>,
    /// Highest pole \[rad/s\] that is a motion of the piece as a whole, zero without one, once a base tells: the same for all hypotheses.
    pub hanging: Option<f64>,
    /// Deviation of the logarithm of the frequency of a mode of the piece itself that is to be matched.
    pub apart: f64,
    /// The partner of each pole, from the rigid modes on, where no residues were measured to match shapes by.
    pub told_partners: Option<Vec<Option<usize>>>,
    /// Modes that were found last: what acts on the channel alone asks for the same ones again.
    found: Mutex<VecDeque<(Vec<f64>, Arc<SeenModes>)>>,
}

/// What a hypothesis predicts.
pub(crate) struct Prediction {
    /// In the order of [`Comparison::values`].
    pub values: Vec<f64>,
    /// The same by the place of the force of all records, and of the response \[1/m\], along x and along y: zeros where no record tells.
    pub by_force: [Vec<f64>; 2],
    pub by_response: [Vec<f64>; 2],
    /// What was compared, of a plate: for the derivatives by what damps it.
    pub seen: Option<(Vec<Channel>, Views)>,
    /// Whether anything stands on feet, whose side moves it.
    pub on_feet: bool,
    /// Direction of each pole's residues in the complex plane, where all differ by sign alone.
    pub phase: Vec<Complex64>,
    /// Of each record and pole what a residue of size one, along the phase, brings to the remainder at each of its frequencies.
    pub brings: Vec<Vec<Vec<Complex64>>>,
    /// Of each record and pole its partner as the record sees it; `None` without one.
    pub partners: Vec<Vec<Option<PartnerInRecord>>>,
    /// Damping ratio that dashpots and windows among the effects bring to each pole.
    pub damping_of_effects: Vec<f64>,
    /// Flexible modes \[rad/s\] as the first record sees them, with a core that depends on frequency about as they are.
    pub flexible: Vec<f64>,
    /// The flexible mode of each pole, from 0; `None` without one.
    pub flexible_of_poles: Vec<Option<usize>>,
    /// Whether each pole is a motion of the piece as a whole on its suspension.
    pub hangs: Vec<bool>,
    /// Whether the piece moves as a whole: it hangs on something.
    pub is_free: bool,
    /// Highest pole that is such a motion \[rad/s\]; zero without one.
    pub hanging: f64,
    /// Number of the remainders' frequencies that lie too near such motions: cords are no springs, and damp as they like.
    pub near_hanging: usize,
}

/// The predicted mode that belongs to a pole, in one record.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PartnerInRecord {
    /// Mass-normalised deflection at the force and at the response \[kg^-1/2\].
    pub deflection: [Complex64; 2],
    /// Its pole $\lambda$ \[1/s\].
    pub pole: Complex64,
    /// Its residue over the product of the deflections.
    pub unit: Complex64,
}

impl<'a> Predictor<'a> {
    pub(crate) fn new(
        comparison: &'a Comparison<'a>,
        structure: StructureKind,
        setting: &EffectSetting,
    ) -> Result<Self, ModelError> {
        let panel = panel_at(&places_of(comparison), comparison, (structure, setting))?;
        Ok(Self::on(panel, comparison, (structure, setting)))
    }

    /// On a panel that [`Predictor::panel_at`] made for these places and others.
    pub(crate) fn on(
        panel: ModifiedPanel,
        comparison: &'a Comparison<'a>,
        (structure, setting): (StructureKind, &EffectSetting),
    ) -> Self {
        let places = places_of(comparison);
        // What is not linear shows between hits, not in modes.
        let record = RecordSetting { suspension_motion: SuspensionMotion::InTime, ..setting.record.clone() };
        let setting = EffectSetting { record, ..setting.clone() };
        let (apart, found) = (apart(structure), Mutex::default());
        Self { comparison, structure, panel, setting, places, hanging: None, apart, told_partners: None, found }
    }

    /// The panel with as many modes, seen from any of these places.
    ///
    /// # Errors
    /// As [`ModifiedPanel::new`].
    pub(crate) fn panel_at(&self, places: &[Place]) -> Result<ModifiedPanel, ModelError> {
        panel_at(places, self.comparison, (self.structure, &self.setting))
    }

    /// The piece.
    pub(crate) fn piece(&self) -> &Piece {
        &self.setting.piece
    }

    /// The setting of a record, from 0.
    pub(crate) fn setting(&self, record: usize) -> EffectSetting {
        let places = self.comparison.measured.records.get(record);
        let record = RecordSetting {
            number: record + 1,
            force_at: places.map(|record| record.force_at),
            response_at: places.map(|record| record.response_at).or(self.setting.record.response_at),
            // A record that was not taken has the sensors of the setting.
            beside: match places.map(|record| self.beside(record)) {
                Some(beside) if !beside.is_empty() => beside,
                _ => self.setting.record.beside.clone(),
            },
            ..self.setting.record.clone()
        };
        EffectSetting { record, ..self.setting.clone() }
    }

    /// The other sensors that sit on a plate while a record is taken: records whose poles are common are those of one panel with all of them.
    fn beside(&self, record: &MeasuredRecord) -> Vec<Place> {
        let measured = self.comparison.measured;
        if self.structure != StructureKind::MindlinPlate || measured.is_not_modal() {
            return vec![];
        }
        let all = distinct(measured.records.iter().map(|record| record.response_at));
        all.into_iter().filter(|place| *place != record.response_at).collect()
    }

    /// The modes of the structure as seen from these ports.
    fn modes(
        &self,
        setting: &EffectSetting,
        ports: &[Place],
        with_slopes: bool,
        constants: &[f64],
        effects: &[EffectState],
    ) -> Result<Arc<SeenModes>, ModelError> {
        let key = [f64::from(u8::from(with_slopes)), constants.len() as f64, ports.len() as f64];
        self.known((key, setting, ports), constants, effects, |effects| {
            self.panel.seen_from(setting, ports, with_slopes, constants, effects)
        })
    }

    /// The modes of a plate with their deflections where a list's names are told apart.
    fn watched(&self, constants: &[f64], effects: &[EffectState]) -> Result<Arc<SeenModes>, ModelError> {
        let key = [-1.0, constants.len() as f64, 0.0];
        self.known((key, &self.setting, &[]), constants, effects, |effects| {
            self.panel.watched_at(&self.setting, self.comparison.measured.named.places(), constants, effects)
        })
    }

    /// The first natural frequencies \[Hz\] of a plate in a setting, but those of its motions as a whole.
    ///
    /// # Errors
    /// As [`ModifiedPanel::seen_from`].
    pub(crate) fn flexible_frequencies(
        &self,
        setting: &EffectSetting,
        constants: &[f64],
        effects: &[EffectState],
        count: usize,
    ) -> Result<Vec<f64>, ModelError> {
        let modes = self.panel.watched_at(setting, &[], constants, effects)?;
        let flexible = modes.angular_frequency.iter().skip(self.panel.rigid_modes(setting.boundary));
        Ok(flexible.take(count).map(|omega| omega / TAU).collect())
    }

    /// What was found last of these modes, else what finds them with the effects that act on the structure.
    fn known(
        &self,
        (key, setting, ports): ([f64; 3], &EffectSetting, &[Place]),
        constants: &[f64],
        effects: &[EffectState],
        find: impl FnOnce(&[EffectState]) -> Result<SeenModes, ModelError>,
    ) -> Result<Arc<SeenModes>, ModelError> {
        let mut key = key.to_vec();
        key.extend(constants);
        key.extend(ports.iter().chain(&setting.record.response_at).flat_map(|place| [place.x, place.y]));
        let mut structural = Vec::new();
        for (number, state) in effects.iter().enumerate() {
            let acts = |action: &Action| {
                matches!(action, Action::Element(_) | Action::Field(_) | Action::Plate(_) | Action::Foot(_))
            };
            if state.acting_in(setting)?.iter().any(acts) {
                key.push(number as f64);
                key.extend(&state.values);
                structural.push(state.clone());
            }
        }
        let lock = || self.found.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, modes)) = lock().iter().find(|(other, _)| *other == key) {
            return Ok(Arc::clone(modes));
        }
        let modes = Arc::new(find(&structural)?);
        let mut found = lock();
        found.truncate(KEPT - 1);
        found.push_front((key, Arc::clone(&modes)));
        Ok(modes)
    }

    /// The modes of the structure as seen from a place.
    ///
    /// # Errors
    /// As [`ModifiedPanel::seen_from`].
    pub(crate) fn seen_at(
        &self,
        at: Place,
        constants: &[f64],
        effects: &[EffectState],
    ) -> Result<Arc<SeenModes>, ModelError> {
        self.modes(&self.setting(0), &[at], false, constants, effects)
    }

    /// Of each flexible mode the products of its deflections at pairs of places.
    ///
    /// # Errors
    /// As [`ModifiedPanel::seen_from`].
    pub(crate) fn flexible_shapes(
        &self,
        pairs: &[[Place; 2]],
        constants: &[f64],
        effects: &[EffectState],
    ) -> Result<Vec<Vec<f64>>, ModelError> {
        let seen = self.modes(&self.setting(0), pairs.as_flattened(), false, constants, effects)?;
        let flexible = seen.deflection.iter().skip(self.panel.rigid_modes(self.setting.boundary));
        Ok(flexible.map(|mode| mode.chunks_exact(2).map(|pair| pair[0] * pair[1]).collect()).collect())
    }

    /// The modes of the structure in a record as seen from these ports, as damped as the poles beside them, and what the channel makes of a line.
    ///
    /// # Errors
    /// As [`ModifiedPanel::seen_from`].
    pub(crate) fn in_record(
        &self,
        record: usize,
        ports: &[Place],
        constants: &[f64],
        effects: &[EffectState],
    ) -> Result<(Vec<Mode>, impl Fn(Complex64) -> Complex64 + use<>), ModelError> {
        let seen = self.modes(&self.setting(record), ports, false, constants, effects)?;
        let mode = |n: usize| {
            let omega = seen.angular_frequency[n];
            let away = |pole: &&Pole| (pole.angular_frequency / omega).ln().abs();
            let beside = self.comparison.measured.poles.iter().min_by(|a, b| away(a).total_cmp(&away(b)));
            let measured = beside.filter(|pole| away(pole) < HANGING_APART).and_then(|pole| pole.damping_ratio);
            let damping_ratio =
                if omega > 0.0 { measured.unwrap_or(USUAL_DAMPING + seen.damping_ratio[n]) } else { 0.0 };
            let deflection = seen.deflection[n].clone();
            Mode { angular_frequency: omega, damping_ratio, at_forces: deflection.clone(), at_responses: deflection }
        };
        let channel = self.channel(record, effects)?;
        Ok(((0..seen.angular_frequency.len()).map(mode).collect(), move |s| channel.at(s)))
    }

    /// The accelerance of a record at these $s$ \[1/s\].
    ///
    /// # Errors
    /// As [`ModifiedPanel::seen_from`].
    pub(crate) fn accelerance(
        &self,
        record: usize,
        (constants, effects): (&[f64], &[EffectState]),
        s: &[Complex64],
    ) -> Result<Vec<Complex64>, ModelError> {
        let own = self.channel(record, effects)?;
        let taken = &self.comparison.measured.records[record];
        let ports = [taken.force_at.moved(own.force_offset), taken.response_at.moved(own.response_offset)];
        let (modes, channel) = self.in_record(record, &ports, constants, effects)?;
        let at = |s: &Complex64| {
            let s = s + own.decay;
            let share = |mode: &Mode| {
                let (omega, zeta) = (mode.angular_frequency, mode.damping_ratio);
                mode.at_forces[0] * mode.at_responses[1] / (s * s + 2.0 * zeta * omega * s + omega * omega)
            };
            channel(s) * s * s * modes.iter().map(share).sum::<Complex64>()
        };
        Ok(s.iter().map(at).collect())
    }

    /// The modes of the structure as seen from these ports, with a core that depends on frequency.
    fn view(
        &self,
        setting: &EffectSetting,
        ports: &[Place],
        with_slopes: bool,
        constants: &[f64],
        effects: &[EffectState],
    ) -> Result<View, ModelError> {
        let Some(core) = core_of(setting, effects)? else {
            let modes = self.modes(setting, ports, with_slopes, constants, effects)?;
            return Ok(View { of: None, ports: ports.to_vec(), modes, relaxing: None });
        };
        let measured = self.comparison.measured;
        let top = measured.poles.last().map_or(TAU * measured.band[1], |pole| pole.angular_frequency);
        let nodes = core.nodes(ABOVE * top);
        let at = |node: &f64| {
            self.modes(setting, ports, with_slopes, &self.panel.with_core_times(constants, *node), effects)
        };
        let found = nodes.iter().map(at).collect::<Result<Vec<_>, _>>()?;
        let near = measured.modes_in_order() + SPARE + self.panel.rigid_modes(setting.boundary);
        let relaxing = Relaxing::new(RelaxingModes::new(core, &nodes, &found, near), measured);
        Ok(View { of: None, ports: ports.to_vec(), modes: Arc::new(relaxing.usual()), relaxing: Some(relaxing) })
    }

    fn channel(&self, record: usize, effects: &[EffectState]) -> Result<Channel, ModelError> {
        let setting = self.setting(record);
        let mut channel = Channel { decay: -self.comparison.measured.undone_decay, ..Channel::default() };
        for state in effects {
            for action in state.acting_in(&setting)? {
                match action {
                    Action::Channel(factor) => channel.factors.push(factor),
                    Action::Place(Shift { of_response, offset }) => {
                        let own = if of_response { &mut channel.response_offset } else { &mut channel.force_offset };
                        own.iter_mut().zip(offset).for_each(|(sum, by)| *sum += by);
                    }
                    Action::Window { tau } => channel.decay += tau.recip(),
                    Action::Element(element) => channel.loads |= element.seat == Seat::AtResponse,
                    Action::Field(_) | Action::Core(_) | Action::Plate(_) | Action::Foot(_) => {}
                }
            }
        }
        Ok(channel)
    }

    /// At these constants with these effects.
    ///
    /// # Errors
    /// As [`ModifiedPanel::seen_from`].
    pub(crate) fn at(
        &self,
        constants: &[f64],
        effects: &[EffectState],
        with_slopes: bool,
    ) -> Result<Prediction, ModelError> {
        let measured = self.comparison.measured;
        let channels =
            (0..measured.records.len()).map(|record| self.channel(record, effects)).collect::<Result<Vec<_>, _>>()?;
        let offset = |place: Place, by: [f64; 2]| {
            let (moved, half) = (place.moved(by), [0.5 * self.piece().length, 0.5 * self.piece().width]);
            Place { x: moved.x.clamp(-half[0], half[0]), y: moved.y.clamp(-half[1], half[1]) }
        };
        let moved = measured.records.iter().zip(&channels).map(|(record, channel)| {
            [offset(record.force_at, channel.force_offset), offset(record.response_at, channel.response_offset)]
        });
        let places: Vec<[Place; 2]> = moved.collect();
        // A structure of its own for each place of a sensor that loads it.
        let loads = channels.iter().any(|channel| channel.loads);
        let mut views: Vec<View> = Vec::new();
        for (record, [_, response]) in places.iter().enumerate() {
            let own = loads.then_some(*response);
            if views.iter().any(|view| view.of == own) {
                continue;
            }
            let ports =
                distinct(places.iter().filter(|places| own.is_none_or(|own| places[1] == own)).flatten().copied());
            let mut setting = self.setting(record);
            setting.record.response_at = setting.record.response_at.map(|_| *response);
            views.push(View { of: own, ..self.view(&setting, &ports, with_slopes, constants, effects)? });
        }
        if views.is_empty() && self.structure == StructureKind::MindlinPlate {
            let modes = self.watched(constants, effects)?;
            views.push(View { of: None, ports: vec![], modes, relaxing: None });
        } else if views.is_empty() {
            let mut acts = effects.iter().map(|state| state.acting_in(&self.setting));
            let is_plate = acts.any(|acts| acts.is_ok_and(|acts| matches!(acts[..], [Action::Plate(_)])));
            let places = if is_plate { across(self.piece()) } else { vec![] };
            views.push(self.view(&self.setting, &places, false, constants, effects)?);
        }
        let seen = Views { places, views };
        let mut at = self.compared(&channels, &seen);
        at.seen = (self.structure == StructureKind::MindlinPlate).then_some((channels, seen));
        Ok(at)
    }

    /// The partner of each pole among the modes, from the rigid ones on.
    pub(crate) fn partners_of(&self, at: &Prediction) -> Vec<Option<usize>> {
        let rigid = self.panel.rigid_modes(self.setting.boundary);
        at.flexible_of_poles.iter().map(|flexible| flexible.map(|n| rigid + n)).collect()
    }

    /// Derivatives of all values by the amplitudes of waves of a field that is uneven along the panel, at these constants, of effects with those of the
    /// channel alone.
    ///
    /// # Errors
    /// As [`ModifiedPanel::uneven`].
    pub(crate) fn uneven(
        &self,
        (constants, effects): (&[f64], &[EffectState]),
        field: Field,
        waves: usize,
    ) -> Result<Vec<Vec<f64>>, ModelError> {
        let measured = self.comparison.measured;
        let places: Vec<[Place; 2]> =
            measured.records.iter().map(|record| [record.force_at, record.response_at]).collect();
        let channels = (0..places.len()).map(|record| self.channel(record, effects)).collect::<Result<Vec<_>, _>>()?;
        let setting = self.setting(0);
        let even = self.panel.seen_from(&setting, &self.places, false, constants, &[])?;
        let values_of = |modes: SeenModes| {
            let view = View { of: None, ports: self.places.clone(), modes: Arc::new(modes), relaxing: None };
            self.compared(&channels, &Views { places: places.clone(), views: vec![view] }).values
        };
        let at = values_of(even.clone());
        let derivative = |by: SeenModes| by_shift(&values_of(shifted(&even, &by)), &at);
        let by_waves = self.panel.uneven(&setting, &self.places, constants, (field, waves))?;
        Ok(by_waves.into_iter().map(derivative).collect())
    }

    /// The partner of each pole among the modes that the first record sees, each as large as the channels show it.
    fn partners(&self, channels: &[Channel], seen: &Views, omega: &[f64], bottom: f64) -> Vec<Option<usize>> {
        let measured = self.comparison.measured;
        if let Some(told) = &self.told_partners {
            return told.iter().map(|partner| partner.filter(|n| *n < omega.len())).collect();
        }
        if measured.records.is_empty() && self.structure == StructureKind::MindlinPlate {
            // A list has what bends or twists, by name where it is told.
            let rigid = self.panel.rigid_modes(self.setting.boundary);
            let shapes: Vec<(f64, Vec<f64>)> = omega[rigid..]
                .iter()
                .zip(&seen.views[0].modes.deflection[rigid..])
                .map(|(omega, deflection)| (*omega, deflection.clone()))
                .collect();
            let found = measured.partners(&shapes, |_| self.apart);
            return found.into_iter().map(|found| Some(rigid + found?.0)).collect();
        }
        if measured.records.is_empty() {
            // A list counts the flexible modes that bend along the piece.
            let bends_along = |n: &usize| {
                let seen = &seen.views[0].modes.deflection[*n];
                seen.is_empty() || seen.chunks_exact(2).map(|pair| pair[0] * pair[1]).sum::<f64>() > 0.0
            };
            let rigid = self.panel.rigid_modes(self.setting.boundary);
            let flexible: Vec<usize> = (rigid..omega.len()).filter(bends_along).collect();
            return (0..measured.poles.len())
                .map(|pole| flexible.get(measured.number_in_order(pole)).copied())
                .collect();
        }
        let top = ABOVE * measured.poles.last().map_or(TAU * measured.band[1], |pole| pole.angular_frequency);
        let candidates: Vec<usize> = (0..omega.len()).filter(|&n| omega[n] > bottom && omega[n] < top).collect();
        let product = |record: usize, n: usize| {
            let (view, [force, response]) = seen.of_record(record);
            let shown = channels[record].at(Complex64::new(0.0, omega[n])).norm();
            view.modes.deflection.get(n).map_or(0.0, |mode| shown * mode[force] * mode[response])
        };
        let shape = |&n: &usize| (omega[n], (0..measured.records.len()).map(|record| product(record, n)).collect());
        let shapes: Vec<(f64, Vec<f64>)> = candidates.iter().map(shape).collect();
        let found =
            measured.partners(&shapes, |index| if self.hangs(candidates[index]) { HANGING_APART } else { self.apart });
        found.into_iter().map(|found| found.map(|(index, _)| candidates[index])).collect()
    }

    /// Whether a mode is a motion of the piece as a whole: those that would be at zero but for the suspension are the lowest.
    pub(crate) fn hangs(&self, mode: usize) -> bool {
        mode < self.panel.rigid_modes(self.setting.boundary)
    }

    /// Median of what damps the poles beside effects: what a mode is thought to have that no pole belongs to.
    pub(crate) fn usual_damping(&self, view: &View, partners: &[Option<usize>], channel: Option<&Channel>) -> f64 {
        let decay = channel.map_or(0.0, |channel| channel.decay);
        let own = |(pole, partner): (&Pole, &Option<usize>)| {
            let n = partner.filter(|n| !self.hangs(*n))?;
            let (omega, of_effects) = (view.modes.angular_frequency[n], view.modes.damping_ratio[n]);
            Some((pole.damping_ratio? - of_effects - decay / omega).max(0.0))
        };
        let mut ratios: Vec<f64> = self.comparison.measured.poles.iter().zip(partners).filter_map(own).collect();
        ratios.sort_by(f64::total_cmp);
        ratios.get(ratios.len() / 2).copied().unwrap_or(USUAL_DAMPING)
    }

    /// Damping ratio of a mode: that of the pole that is its partner, less what a window brings, or else what is usual beside what effects bring.
    fn damping(&self, view: &View, n: usize, pole: Option<usize>, (channel, usual): (Option<&Channel>, f64)) -> f64 {
        let omega = view.modes.angular_frequency[n];
        if omega <= 0.0 {
            return 0.0;
        }
        let measured = pole.and_then(|pole| self.comparison.measured.poles[pole].damping_ratio);
        let decay = channel.map_or(0.0, |channel| channel.decay);
        let own = measured.map_or(usual + view.modes.damping_ratio[n], |zeta| zeta - decay / omega);
        own.clamp(0.0, MOST_DAMPING)
    }

    /// Modes of a plate with what stands on it as the damping of the plate couples them.
    pub(crate) fn coupled(
        &self,
        view: &View,
        partners: &[Option<usize>],
        channel: Option<&Channel>,
    ) -> Option<CoupledModes> {
        channel?;
        let pole = |n: usize| partners.iter().position(|partner| *partner == Some(n));
        let beside = (channel, self.usual_damping(view, partners, channel));
        let zeta: Vec<f64> = (0..view.near()).map(|n| self.damping(view, n, pole(n), beside)).collect();
        let measured = self.comparison.measured;
        let deviation = |pole: usize| {
            let place = measured.poles.len() + pole;
            measured.poles[pole].damping_ratio.map(|_| measured.covariance[(place, place)].sqrt())
        };
        let deviations: Vec<Option<f64>> = (0..view.near()).map(|n| deviation(pole(n)?)).collect();
        CoupledModes::new(&view.modes, &zeta, &deviations)
    }

    /// The modes of a view through a channel; those without a partner stand by themselves where `stands` says so of their frequency.
    fn through(
        &self,
        view: &View,
        channel: &Channel,
        (coupled, partners): (Option<&CoupledModes>, &[Option<usize>]),
        stands: impl Fn(f64) -> bool,
    ) -> Vec<ModeInRecord> {
        let frequencies = &self.comparison.measured.remainder_frequencies;
        let beside = (Some(channel), self.usual_damping(view, partners, Some(channel)));
        let mode = |n: usize| {
            let pole = partners.iter().position(|partner| *partner == Some(n));
            let mode = view.mode(n, self.damping(view, n, pole, beside), coupled);
            let stands = mode.omega > 0.0 && (pole.is_some() || stands(mode.omega));
            let unit = if stands { mode.residue(channel) } else { Complex64::ZERO };
            let line = |(number, frequency): (usize, &f64)| {
                let s = Complex64::new(0.0, TAU * frequency);
                (view.line(&mode, n, (number, s), channel), mode.apart(unit, s, channel))
            };
            let lines = frequencies.iter().enumerate().map(line).collect();
            ModeInRecord { mode, pole, unit, lines }
        };
        (0..view.near()).map(mode).collect()
    }

    /// In the order of the comparison.
    fn compared(&self, channels: &[Channel], seen: &Views) -> Prediction {
        let (comparison, measured) = (self.comparison, self.comparison.measured);
        let first = &seen.views[0];
        let omega = &first.modes.angular_frequency;
        let bottom = LOWEST * measured.poles.first().map_or(0.0, |pole| pole.angular_frequency);
        // A mode whose skirt leaves the band is not told: it may be as damped as those below it are.
        let beside = measured.poles.iter().rev().take(BESIDE).filter_map(|pole| pole.damping_ratio);
        let top = MOSTLY_SEEN * TAU * measured.band[1] / (1.0 + SKIRT * beside.fold(0.0, f64::max));
        let partners = self.partners(channels, seen, omega, bottom);
        let coupled: Vec<Option<CoupledModes>> =
            seen.views.iter().map(|view| self.coupled(view, &partners, channels.first())).collect();
        let size = comparison.size();
        let mut parts = [(); PARTS].map(|()| vec![0.0; size]);
        let mut phase = vec![Complex64::I; measured.poles.len()];
        for (pole, partner) in partners.iter().enumerate() {
            // A pole without a partner tells nothing by its frequency; its residue is missed altogether.
            let own = |n: usize| match &first.relaxing {
                Some(relaxing) => {
                    relaxing
                        .mode(n, self.damping(first, n, Some(pole), (channels.first(), USUAL_DAMPING)))
                        .angular_frequency
                }
                None => {
                    let coupled = coupled[0].as_ref().and_then(|coupled| coupled.angular_frequency.get(n).copied());
                    coupled.unwrap_or(omega[n])
                }
            };
            parts[0][pole] = partner.map_or(comparison.values[pole], |n| own(n).ln());
        }
        let remainders = measured.remainder_frequencies.len();
        let mut brings = vec![vec![vec![Complex64::ZERO; remainders]; measured.poles.len()]; measured.records.len()];
        let mut in_records = vec![vec![None; measured.poles.len()]; measured.records.len()];
        let mut strength = vec![0.0; omega.len()];
        let mut through: Option<((usize, usize), Vec<ModeInRecord>)> = None;
        for (record, channel) in channels.iter().enumerate() {
            let mut put = |place: usize, of: [Complex64; PARTS]| {
                parts.iter_mut().zip(of).for_each(|(part, value)| comparison.put(part, place, value));
            };
            let mut remainder = vec![[Complex64::ZERO; PARTS]; remainders];
            let (view, ports) = seen.of_record(record);
            let number_of_view = seen.number_of(record);
            let coupled = coupled[number_of_view].as_ref();
            let is_known = |(number, of): &(usize, usize)| *number == number_of_view && channels[*of] == *channel;
            if !through.as_ref().is_some_and(|(known, _)| is_known(known)) {
                let stands = |omega: f64| omega > bottom && omega < top;
                through = Some(((number_of_view, record), self.through(view, channel, (coupled, &partners), stands)));
            }
            let modes = through.iter().flat_map(|(_, modes)| modes).enumerate();
            for (n, ModeInRecord { mode, pole, unit, lines }) in modes {
                let (deflection, shape) = view.shape((n, ports), mode.zeta, coupled);
                match *pole {
                    Some(pole) => {
                        phase[pole] = unit / unit.norm();
                        let pole_of = mode.pole() - channel.decay;
                        in_records[record][pole] = Some(PartnerInRecord { deflection, pole: pole_of, unit: *unit });
                        put(comparison.residue_place(record, pole), shape.map(|shape| shape * unit));
                    }
                    None => strength.get_mut(n).into_iter().for_each(|sum| *sum += (shape[0] * unit).norm_sqr()),
                }
                // What stands by itself is no part of the remainder.
                for (number, (line, apart)) in lines.iter().enumerate() {
                    let whole = view.shape_at_line((n, ports), number).unwrap_or(shape);
                    for (part, sum) in remainder[number].iter_mut().enumerate() {
                        *sum += whole[part] * line - shape[part] * apart[0] - shape[part].conj() * apart[1];
                    }
                    if let Some(pole) = *pole {
                        brings[record][pole][number] = (line - apart[0] - apart[1]) / unit.norm();
                    }
                }
            }
            if let Some(relaxing) = &view.relaxing {
                for (line, sum) in relaxing.lines.iter().zip(&mut remainder) {
                    let s = line.s() + channel.decay;
                    let far = relaxing.modes.far(line, ports);
                    sum.iter_mut().zip(far).for_each(|(sum, far)| *sum += channel.at(s) * far);
                }
            }
            for (number, sums) in remainder.into_iter().enumerate() {
                put(comparison.remainder_place(record, number), sums);
            }
        }
        let [mut values, force_x, response_x, force_y, response_y] = parts;
        let mut typical = comparison.residue.clone();
        typical.sort_by(f64::total_cmp);
        let typical = typical.get(typical.len() / 2).copied().unwrap_or(1.0);
        let is_unseen = |n: &usize| !partners.contains(&Some(*n)) && !self.hangs(*n);
        let size_of = |n: usize| (strength[n] / measured.records.len().max(1) as f64).sqrt() / typical;
        let mut unseen: Vec<f64> = (0..omega.len()).filter(is_unseen).map(size_of).collect();
        unseen.sort_by(|a, b| b.total_cmp(a));
        comparison.unseen().zip(unseen.into_iter().take(UNSEEN)).for_each(|(place, value)| values[place] = value);
        // By the poles where they show it, so that all hypotheses leave out the same.
        let flexible = omega.get(self.panel.rigid_modes(self.setting.boundary)).copied().unwrap_or(0.0);
        let poles = measured.poles.iter().map(|pole| pole.angular_frequency);
        let seen_hanging = self
            .hanging
            .unwrap_or_else(|| poles.filter(|omega| self.hangs(0) && *omega < LOWEST * flexible).fold(0.0, f64::max));
        let hanging = (0..omega.len()).filter(|&n| self.hangs(n)).map(|n| omega[n]).fold(0.0, f64::max);
        let hanging = if seen_hanging > 0.0 { seen_hanging } else { hanging };
        let near = |frequency: &&f64| TAU * **frequency < CLEAR_OF_HANGING * hanging;
        let near_hanging = measured.remainder_frequencies.iter().filter(near).count();
        let rigid = self.panel.rigid_modes(self.setting.boundary);
        let flexible_of_poles = partners.iter().map(|partner| partner.and_then(|n| n.checked_sub(rigid))).collect();
        let hangs: Vec<bool> = partners.iter().map(|partner| partner.is_some_and(|n| self.hangs(n))).collect();
        let decay = channels.first().map_or(0.0, |channel| channel.decay);
        let of_effects = |n: usize| first.modes.damping_ratio[n] + decay / omega[n];
        let damping_of_effects: Vec<f64> = partners.iter().map(|partner| partner.map_or(0.0, of_effects)).collect();
        // What hangs is damped by its cords, and what a core takes is not known well enough.
        let is_own = |pole: usize| !measured.records.is_empty() && !hangs[pole] && first.relaxing.is_none();
        for pole in (0..measured.poles.len()).filter(|pole| is_own(*pole)) {
            values[comparison.own_damping_place(pole)] = comparison.own_damping(pole, damping_of_effects[pole]);
        }
        Prediction {
            values,
            by_force: [force_x, force_y],
            by_response: [response_x, response_y],
            seen: None,
            on_feet: seen.views.iter().any(|view| view.modes.on_feet),
            phase,
            brings,
            partners: in_records,
            damping_of_effects,
            flexible: omega.get(rigid..).unwrap_or_default().to_vec(),
            flexible_of_poles,
            hangs,
            is_free: rigid > 0,
            hanging: seen_hanging,
            near_hanging,
        }
    }
}

fn places_of(comparison: &Comparison) -> Vec<Place> {
    distinct(comparison.measured.records.iter().flat_map(|record| [record.force_at, record.response_at]))
}

fn panel_at(
    places: &[Place],
    comparison: &Comparison,
    (structure, setting): (StructureKind, &EffectSetting),
) -> Result<ModifiedPanel, ModelError> {
    let measured = comparison.measured;
    let panel = ModifiedPanel::new(structure, setting, measured.modes_in_order() + SPARE)?;
    let top = measured.poles.last().map_or(measured.band[1], |pole| pole.angular_frequency / TAU);
    let end = [Place { x: 0.5 * setting.piece.length, y: 0.0 }];
    let number = usize::from(structure == StructureKind::MindlinPlate);
    Ok(panel.perhaps_wide(setting, if places.is_empty() { &end } else { places }, WIDE[number] * top))
}

/// Modes a step on along a change.
fn shifted(modes: &SeenModes, by: &SeenModes) -> SeenModes {
    let mut moved = modes.clone();
    let shift = |values: &mut [f64], by: &[f64]| values.iter_mut().zip(by).for_each(|(value, by)| *value += SHIFT * by);
    shift(&mut moved.angular_frequency, &by.angular_frequency);
    moved.deflection.iter_mut().zip(&by.deflection).for_each(|(mode, by)| shift(mode, by));
    moved
}

/// What values follow along that change.
fn by_shift(moved: &[f64], at: &[f64]) -> Vec<f64> {
    moved.iter().zip(at).map(|(moved, at)| (moved - at) / SHIFT).collect()
}

/// Places on the centre line, each before the one beside it on an edge: a mode that bends across or twists has not the same sign in both.
fn across(piece: &Piece) -> Vec<Place> {
    let along = ALONG.map(|part| part * piece.length);
    along.into_iter().flat_map(|x| [0.0, 0.5 * piece.width].map(|y| Place { x, y })).collect()
}

/// Parts of the length at which pairs of places across stand.
const ALONG: [f64; 6] = [-0.47, -0.31, -0.07, 0.13, 0.29, 0.47];

/// Each place once, in the order in which they come.
pub(crate) fn distinct(all: impl Iterator<Item = Place>) -> Vec<Place> {
    let mut places: Vec<Place> = Vec::new();
    for place in all {
        if !places.contains(&place) {
            places.push(place);
        }
    }
    places
}

/// The core among effects, if any depends on frequency.
///
/// # Errors
/// [`ModelError::Unsupported`] on a plate: what is found could neither be drawn nor written into a model.
fn core_of(setting: &EffectSetting, effects: &[EffectState]) -> Result<Option<CoreModulus>, ModelError> {
    let (mut core, mut is_plate) = (None, false);
    for state in effects {
        for action in state.acting_in(setting)? {
            match action {
                Action::Core(found) => core = Some(found),
                Action::Plate(_) => is_plate = true,
                _ => {}
            }
        }
    }
    if core.is_some() && is_plate {
        return Err(ModelError::Unsupported("a core that depends on frequency in a plate".to_owned()));
    }
    Ok(core)
}
