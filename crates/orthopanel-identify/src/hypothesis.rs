//! A hypothesis: effects with free parameters, in coordinates in which each prior is a standard one.

use faer::Mat;
use orthopanel_model::{
    Action, Effect, EffectParameter, EffectState, FOOT_SIDE, GAIN, ModelError, Piece, Place, Prior, Scale, Shift,
    StructureKind,
};

use crate::effect_places::has_place;
use crate::free_constants::FreeConstants;
use crate::plate_start::PlateFit;
use crate::predicted::Predictor;

/// Largest size of a coordinate with a Gaussian prior.
const FARTHEST: f64 = 5.0;
/// Places along a beam at which a search begins,
const PLACES: usize = 15;
/// along and across a plate, two to a half-wave of its high modes, and of what vibrates by itself there, which has frequencies to begin from as well.
const EACH_WAY: [usize; 2] = [17, 13];
const EACH_WAY_TUNED: [usize; 2] = [9, 9];

/// From a coordinate to a value.
#[derive(Debug, Clone, Copy)]
enum Map {
    /// Size and sign: $\pm m\,f^z$.
    Size { median: f64, log_factor: f64, sign: f64 },
    /// $\mu + \sigma z$.
    Gaussian { mean: f64, std: f64 },
    /// Even between two bounds, $-1 \le z \le 1$.
    Even { low: f64, high: f64 },
}

/// A value that is free, between bounds.
#[derive(Debug, Clone, Copy)]
struct Coordinate {
    map: Map,
    range: (f64, f64),
}

impl Coordinate {
    fn value(&self, z: f64) -> f64 {
        let value = match self.map {
            Map::Size { median, log_factor, sign } => sign * median * (log_factor * z).exp(),
            Map::Gaussian { mean, std } => mean + std * z,
            Map::Even { low, high } => low + 0.5 * (high - low) * (z + 1.0),
        };
        value.clamp(self.range.0, self.range.1)
    }

    /// The coordinate of a value, as near as the prior comes to it.
    fn of_value(&self, value: f64) -> f64 {
        let z = match self.map {
            Map::Size { median, log_factor, sign } => (sign * value / median).max(f64::MIN_POSITIVE).ln() / log_factor,
            Map::Gaussian { mean, std } => (value - mean) / std,
            Map::Even { low, high } => 2.0 * (value - low) / (high - low) - 1.0,
        };
        z.clamp(-self.farthest(), self.farthest())
    }

    fn farthest(&self) -> f64 {
        if matches!(self.map, Map::Even { .. }) { 1.0 } else { FARTHEST }
    }

    /// $dv/dz$.
    fn slope(&self, z: f64) -> f64 {
        match self.map {
            Map::Size { log_factor, .. } => log_factor * self.value(z),
            Map::Gaussian { std, .. } => std,
            Map::Even { low, high } => 0.5 * (high - low),
        }
    }
}

/// A value of an effect.
#[derive(Debug, Clone, Copy)]
enum Slot {
    Held(f64),
    Free(Coordinate),
}

impl Slot {
    fn coordinate(&self) -> Option<&Coordinate> {
        match self {
            Self::Free(coordinate) => Some(coordinate),
            Self::Held(_) => None,
        }
    }
}

/// The values of some slots, whose coordinates stand first in `z`.
fn values<'a>(slots: impl IntoIterator<Item = &'a Slot>, z: &[f64]) -> Vec<f64> {
    let mut z = z.iter();
    let value = |slot: &Slot| match slot {
        Slot::Held(value) => *value,
        Slot::Free(coordinate) => coordinate.value(z.next().copied().unwrap_or(0.0)),
    };
    slots.into_iter().map(value).collect()
}

/// Why an effect is part of a hypothesis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    /// The test file declares it.
    Declared,
    /// The hypothesis says that the base lacks it.
    Found,
    /// It is what another effect, which is not linear, looks like in the mean over hits ([`Effect::linearised`]).
    Linearised,
    /// Unknown, but no effect that the base lacks: a nuisance parameter of every hypothesis.
    Nuisance,
}

/// An effect in one of the ways in which it may act: a mass added or one that is missing, the gain of this record or of that.
#[derive(Clone)]
pub(crate) struct Part {
    pub effect: &'static dyn Effect,
    slots: Vec<Slot>,
    pub role: Role,
}

impl Part {
    /// Every way in which an effect may act in a test of so many records.
    pub(crate) fn ways(effect: &'static dyn Effect, of: (&Piece, StructureKind), records: usize) -> Vec<Self> {
        let mut ways: Vec<Vec<Slot>> = vec![vec![]];
        for parameter in effect.parameters() {
            let choices: Vec<Vec<Slot>> = choices(parameter, of, records);
            ways = ways.iter().flat_map(|way| choices.iter().map(|choice| [&way[..], choice].concat())).collect();
        }
        if effect.parameters().iter().any(|parameter| parameter.none_beside_another) {
            // None of anything is no way.
            ways.retain(|way| way.iter().any(|slot| slot.coordinate().is_some()));
        }
        ways.into_iter().map(|slots| Self { effect, slots, role: Role::Found }).collect()
    }

    /// As declared: the values that the test file gives are held.
    pub(crate) fn declared(
        effect: &'static dyn Effect,
        values: &[Option<f64>],
        (piece, structure): (&Piece, StructureKind),
        records: usize,
    ) -> Option<Self> {
        let mut way = Self::ways(effect, (piece, structure), records).into_iter().next()?;
        let numbers: Vec<usize> = way.numbers_of_parameters().map(|(number, _)| number).collect();
        for (slot, number) in way.slots.iter_mut().zip(numbers) {
            let parameter = &effect.parameters()[number];
            match (values.get(number).copied().flatten(), slot) {
                (Some(value), slot) => *slot = Slot::Held(value),
                // What is looked for in a part of its range may be anywhere in it once it is declared.
                (None, Slot::Free(Coordinate { map: Map::Size { median, log_factor, .. }, range }))
                    if parameter.range_looked_for(piece) != *range =>
                {
                    *log_factor = (range.1 / *median).ln() / FARTHEST;
                }
                (None, _) => {}
            }
        }
        Some(Self { role: Role::Declared, ..way })
    }

    /// The side of the feet on which all stands that stands on a plate; beams may turn out plates (`width-coupling`).
    fn foot(of: (&Piece, StructureKind)) -> Option<Self> {
        let way = Self::ways(FOOT_SIDE, of, 1).into_iter().next()?;
        Some(Self { role: Role::Nuisance, ..way })
    }

    fn coordinates(&self) -> impl Iterator<Item = &Coordinate> {
        self.slots.iter().filter_map(Slot::coordinate)
    }

    pub(crate) fn free(&self) -> usize {
        self.coordinates().count()
    }

    /// Whether all of its values are looked for.
    pub(crate) fn is_open(&self) -> bool {
        self.free() == self.slots.len()
    }

    /// The parameter of each value.
    pub(crate) fn parameters(&self) -> impl Iterator<Item = &'static EffectParameter> {
        self.numbers_of_parameters().map(|(number, _)| &self.effect.parameters()[number])
    }

    /// Of each value the number of its parameter, and of the record that has it of its own.
    fn numbers_of_parameters(&self) -> impl Iterator<Item = (usize, Option<usize>)> {
        let parameters = self.effect.parameters();
        let own = parameters.iter().filter(|parameter| parameter.each_record).count();
        let records = (self.slots.len() + own).saturating_sub(parameters.len()).checked_div(own).unwrap_or(0);
        parameters.iter().enumerate().flat_map(move |(number, parameter)| {
            let times = if parameter.each_record { records } else { 1 };
            (0..times).map(move |record| (number, parameter.each_record.then_some(record)))
        })
    }

    /// The coordinates nearest to these values.
    pub(crate) fn coordinates_of(&self, values: &[f64]) -> Vec<f64> {
        let pairs = self.slots.iter().zip(values);
        pairs.filter_map(|(slot, value)| Some(slot.coordinate()?.of_value(*value))).collect()
    }

    /// The values at these coordinates.
    pub(crate) fn values(&self, z: &[f64]) -> Vec<f64> {
        values(&self.slots, z)
    }

    /// The same by the names of the parameters.
    pub(crate) fn named(&self, z: &[f64]) -> Vec<(&'static str, f64)> {
        self.parameters().map(|parameter| parameter.name).zip(self.values(z)).collect()
    }

    /// Where a search begins at values known by name: what is not known begins in its middle, a size on either side of it.
    pub(crate) fn starts_at(&self, known: &[(&str, f64)]) -> Vec<Vec<f64>> {
        let mut starts: Vec<Vec<f64>> = vec![vec![]];
        for (slot, parameter) in self.slots.iter().zip(self.parameters()) {
            let Some(coordinate) = slot.coordinate() else { continue };
            let net = match (known.iter().find(|(name, _)| *name == parameter.name), coordinate.map) {
                (Some((_, value)), _) => vec![coordinate.of_value(*value)],
                (None, Map::Size { .. }) => vec![-0.8, 0.8],
                (None, _) => vec![0.0],
            };
            starts = starts.iter().flat_map(|start| net.iter().map(|z| [&start[..], &[*z]].concat())).collect();
        }
        starts
    }

    /// Of each coordinate, the derivative of the value that follows it.
    pub(crate) fn slopes(&self, z: &[f64]) -> Vec<f64> {
        self.coordinates().zip(z).map(|(coordinate, z)| coordinate.slope(*z)).collect()
    }

    /// How the value of a coordinate moves places of a record \[1\]; `None` where it does more than that.
    pub(crate) fn shifts(&self, predictor: &Predictor, record: usize, coordinate: usize) -> Option<Vec<Shift>> {
        let of_slots = self.slots.iter().zip(self.numbers_of_parameters());
        let mut free = of_slots.filter_map(|(slot, number)| slot.coordinate().map(|_| number));
        let (parameter, own) = free.nth(coordinate)?;
        // What moves places follows its values in proportion.
        let value = self.effect.parameters()[parameter].range(predictor.piece()).1;
        let mut values = vec![0.0; self.effect.parameters().len()];
        values[parameter] = value;
        let shift = |action: Action| match action {
            Action::Place(shift) => Some(Shift { offset: shift.offset.map(|offset| offset / value), ..shift }),
            _ => None,
        };
        let acts = self.effect.act(&values, &predictor.setting(record)).ok()?;
        let shifts = acts.into_iter().map(shift).collect::<Option<Vec<Shift>>>()?;
        Some(if own.is_none_or(|own| own == record) { shifts } else { vec![] })
    }

    /// Whether another structure stands in the place of the one that the constants are of.
    pub(crate) fn replaces_structure(&self, predictor: &Predictor) -> bool {
        let values = self.values(&vec![0.0; self.free()]);
        let acts = self.effect.act(&values, &predictor.setting(0));
        acts.is_ok_and(|acts| acts.iter().any(|action| matches!(action, Action::Plate(_))))
    }

    /// Its place at these coordinates.
    pub(crate) fn place(&self, z: &[f64]) -> Option<Place> {
        let named = self.named(z);
        let of = |wanted: &str| named.iter().find(|(name, _)| *name == wanted).map(|(_, value)| *value);
        Some(Place { x: of("x")?, y: of("y").unwrap_or(0.0) })
    }

    /// Whether it vibrates by itself at a place.
    pub(crate) fn is_tuned(&self) -> bool {
        has_place(self.effect) && self.effect.parameters().iter().any(|parameter| parameter.unit == "Hz")
    }

    /// Whether the first coordinate says how much of the effect there is, and says the least that is looked for.
    pub(crate) fn is_least(&self, z: &[f64]) -> bool {
        let first = self.coordinates().next().zip(z.first());
        first.is_some_and(|(coordinate, z)| {
            matches!(coordinate.map, Map::Size { .. }) && !self.is_factor() && *z <= -coordinate.farthest()
        })
    }

    /// Of a factor, of which one is none, the logarithm of the odds with it against those without by the ratio of the prior and the posterior density there:
    /// $$\ln B = \frac{(z-z_0)^2}{2\sigma^2} + \ln\sigma - \frac{z_0^2}{2} .$$
    pub(crate) fn gain_beside_none(&self, z: &[f64], deviation: f64) -> Option<f64> {
        let (coordinate, z) =
            self.coordinates().next().zip(z.first()).filter(|_| self.is_factor() && self.free() == 1)?;
        let none = coordinate.of_value(1.0);
        Some(0.5 * ((z - none) / deviation).powi(2) + deviation.ln() - 0.5 * none * none)
    }

    /// Whether one is none of the effect.
    fn is_factor(&self) -> bool {
        self.effect.parameters().first().is_some_and(|first| first.is_factor)
    }

    /// So many times as much of the effect, where its first coordinate says how much: of a factor, beside one.
    pub(crate) fn scale(&self, z: &mut [f64], times: f64) {
        if let (Some(coordinate), Some(z)) = (self.coordinates().next(), z.first_mut())
            && matches!(coordinate.map, Map::Size { .. })
            && times > 0.0
        {
            let none = if self.is_factor() { 1.0 } else { 0.0 };
            *z = coordinate.of_value(none + times * (coordinate.value(*z) - none));
        }
    }

    /// These starts with much of the effect, where the first coordinate says how much: what one of fifteen has more of.
    pub(crate) fn with_much(&self, starts: &[Vec<f64>]) -> Vec<Vec<f64>> {
        const MUCH: f64 = 1.5;
        let is_size = self.coordinates().next().is_some_and(|first| matches!(first.map, Map::Size { .. }));
        let much = |start: &Vec<f64>| start.iter().enumerate().map(|(i, z)| if i == 0 { MUCH } else { *z }).collect();
        if is_size { starts.iter().map(much).collect() } else { vec![] }
    }

    /// Where a search begins: a net over the prior, the finer the fewer the coordinates. What vibrates by itself at a place begins where the
    /// panel with it has a mode at each of the measured frequencies, as `tuned(mass, place)` finds them \[Hz\].
    pub(crate) fn starts(&self, tuned: impl Fn(f64, Place) -> Vec<f64>) -> Vec<Vec<f64>> {
        if self.role == Role::Nuisance {
            return vec![vec![0.0; self.free()]];
        }
        let unit = |number: usize| self.effect.parameters().get(number).map_or("", |parameter| parameter.unit);
        let free = || self.slots.iter().enumerate().filter_map(|(number, slot)| Some((number, slot.coordinate()?)));
        let units: Vec<&str> = free().map(|(number, _)| unit(number)).collect();
        let has_place = has_place(self.effect);
        let is_even = |of: &&Coordinate| matches!(of.map, Map::Even { .. });
        let is_on_plate = self.coordinates().filter(is_even).count() > 1;
        let each_way = if units.contains(&"Hz") { EACH_WAY_TUNED } else { EACH_WAY };
        let net = |each_size: bool| {
            let mut starts: Vec<Vec<f64>> = vec![vec![]];
            let mut directions = each_way.into_iter();
            for (index, (_, coordinate)) in free().enumerate() {
                let net: Vec<f64> = match coordinate.map {
                    Map::Even { .. } if is_on_plate => even_net(directions.next().unwrap_or(PLACES), 0.95),
                    Map::Even { .. } => even_net(PLACES, 0.95),
                    Map::Size { .. } if units.len() == 1 => even_net(9, 2.0),
                    // Frequencies are many there.
                    Map::Size { .. } if units.contains(&"Hz") && is_on_plate => vec![0.0],
                    // How much of it there is on a plate follows from what a little does.
                    Map::Size { .. } if index == 0 && is_on_plate => vec![-0.8],
                    Map::Size { .. } if index == 0 || each_size => vec![-0.8, 0.8],
                    Map::Size { .. } | Map::Gaussian { .. } => vec![0.0],
                };
                starts = starts.iter().flat_map(|start| net.iter().map(|z| [&start[..], &[*z]].concat())).collect();
            }
            starts
        };
        let mut starts = net(false);
        if !has_place && units.len() > 1 {
            starts.extend(net(true));
        }
        let of = |wanted: &str| units.iter().position(|unit| *unit == wanted);
        let (Some(mass), Some(frequency), Some(x)) = (of("kg"), of("Hz"), of("m")) else { return starts };
        let y = units.iter().skip(x + 1).position(|unit| *unit == "m").map(|number| x + 1 + number);
        let coordinates: Vec<&Coordinate> = self.coordinates().collect();
        let tune = |start: Vec<f64>| {
            let value = |number: usize| coordinates[number].value(start[number]);
            let (mass, place) = (value(mass), Place { x: value(x), y: y.map_or(0.0, value) });
            let at = |hertz: f64| {
                let mut start = start.clone();
                start[frequency] = coordinates[frequency].of_value(hertz);
                start
            };
            tuned(mass, place).into_iter().map(at).collect::<Vec<_>>()
        };
        starts.into_iter().flat_map(tune).collect()
    }
}

/// Numbers that lie evenly from $-$`to` to `to`.
pub(crate) fn even_net(count: usize, to: f64) -> Vec<f64> {
    (0..count).map(|i| to * (2.0 * i as f64 / (count - 1) as f64 - 1.0)).collect()
}

fn choices(parameter: &EffectParameter, (piece, structure): (&Piece, StructureKind), records: usize) -> Vec<Vec<Slot>> {
    let range = parameter.range(piece);
    if parameter.scale == Scale::Index {
        return (1..=records.max(1)).map(|record| vec![Slot::Held(record as f64)]).collect();
    }
    let times = if parameter.each_record { records.max(1) } else { 1 };
    let of = |map: Map| vec![Slot::Free(Coordinate { map, range }); times];
    let free = match parameter.prior {
        Prior::Even => vec![of(Map::Even { low: range.0, high: range.1 })],
        Prior::Gaussian { mean, std } => vec![of(Map::Gaussian { mean, std })],
        Prior::Size { median, factor, signed } => {
            let signs: &[f64] = if signed { &[1.0, -1.0] } else { &[1.0] };
            signs.iter().map(|&sign| of(Map::Size { median, log_factor: factor.ln(), sign })).collect()
        }
    };
    // As it is unless it pays to free it: a place across a beam never does, and that on a plate has to be found.
    let held = parameter.held_at.map(|value| vec![Slot::Held(value); times]);
    match (parameter.across, structure) {
        (true, StructureKind::TimoshenkoBeam) => held.into_iter().collect(),
        (_, StructureKind::MindlinPlate) if parameter.none_beside_another => {
            free.into_iter().chain([vec![Slot::Held(0.0)]]).collect()
        }
        (true, StructureKind::MindlinPlate) => free,
        _ => held.into_iter().chain(free).collect(),
    }
}

/// Constants and effects, all that is free in one list of coordinates: the constants first.
#[derive(Clone)]
pub(crate) struct Hypothesis {
    constants: Vec<ConstantSlot>,
    pub parts: Vec<Part>,
}

/// A constant of the structure, by its number, and the piece that has it of its own.
#[derive(Clone)]
struct ConstantSlot {
    constant: usize,
    piece: Option<usize>,
    slot: Slot,
}

/// Factor within which two of three constants lie of where a search begins: any start serves, and all hypotheses share it.
const CONSTANTS: f64 = 2.0;

impl Hypothesis {
    /// Constants about these values, where the test does not hold them, with what is declared of a piece.
    pub(crate) fn new(
        constants: &FreeConstants,
        about: &[f64],
        declared: &[Part],
        of: (&Piece, StructureKind),
    ) -> Self {
        let mut slots = Vec::new();
        for (constant, (held, about)) in constants.held.iter().zip(about).enumerate() {
            let of = &constants.constants[constant];
            let free = Slot::Free(if constants.is_modulus(constant) {
                let map = Map::Size { median: *about, log_factor: CONSTANTS.ln(), sign: 1.0 };
                Coordinate { map, range: (0.0, f64::MAX) }
            } else {
                Coordinate {
                    map: Map::Gaussian { mean: *about, std: PlateFit::prior(constant) },
                    range: (of.low, of.high),
                }
            });
            match held {
                Some(value) => slots.push(ConstantSlot { constant, piece: None, slot: Slot::Held(*value) }),
                None => {
                    slots.extend(constants.free.iter().filter(|of| of.constant == constant).map(|of| ConstantSlot {
                        constant,
                        piece: of.piece,
                        slot: free,
                    }))
                }
            }
        }
        Self { constants: slots, parts: Part::foot(of).into_iter().chain(declared.iter().cloned()).collect() }
    }

    /// How many numbers are looked for, nuisance parameters apart.
    pub(crate) fn unknowns(&self) -> usize {
        let sought = self.parts.iter().filter(|part| part.role != Role::Nuisance);
        self.free_constants() + sought.map(Part::free).sum::<usize>()
    }

    /// Number of the coordinate that is the side of the feet.
    pub(crate) fn foot(&self) -> usize {
        self.free_constants()
    }

    /// With one part more.
    pub(crate) fn with(&self, part: Part) -> Self {
        let mut more = self.clone();
        more.parts.push(part);
        more
    }

    /// Without one of its parts, and the coordinates that remain.
    pub(crate) fn without(&self, part: usize, z: &[f64]) -> (Self, Vec<f64>) {
        let mut fewer = self.clone();
        fewer.parts.remove(part);
        let before = self.free_constants() + self.parts[..part].iter().map(Part::free).sum::<usize>();
        (fewer, [&z[..before], &z[before + self.parts[part].free()..]].concat())
    }

    fn coordinates(&self) -> impl Iterator<Item = &Coordinate> {
        self.of_slots().filter_map(Slot::coordinate).chain(self.parts.iter().flat_map(Part::coordinates))
    }

    pub(crate) fn free_constants(&self) -> usize {
        self.of_slots().filter_map(Slot::coordinate).count()
    }

    /// The effects that the base lacks.
    pub(crate) fn undeclared(&self) -> impl Iterator<Item = &Part> {
        self.parts.iter().filter(|part| part.role == Role::Found)
    }

    /// Which coordinate each constant is, in the order of [`Self::constant_numbers`]; `None` of one that is held.
    pub(crate) fn coordinates_of_constants(&self) -> Vec<Option<usize>> {
        let mut next = 0..;
        self.of_slots().map(|slot| slot.coordinate().and_then(|_| next.next())).collect()
    }

    fn of_slots(&self) -> impl Iterator<Item = &Slot> {
        self.constants.iter().map(|of| &of.slot)
    }

    /// Number and piece of each constant, in the order of [`Self::values_with_deviations`].
    pub(crate) fn constant_numbers(&self) -> impl Iterator<Item = (usize, Option<usize>)> {
        self.constants.iter().map(|of| (of.constant, of.piece))
    }

    /// Of a piece, in the structure's order.
    pub(crate) fn constants_of(&self, piece: usize, z: &[f64]) -> Vec<f64> {
        let all = values(self.of_slots(), z);
        let of_piece = self.constants.iter().zip(all).filter(|(of, _)| of.piece.is_none_or(|own| own == piece));
        let mut found: Vec<(usize, bool, f64)> =
            of_piece.map(|(of, value)| (of.constant, of.piece.is_none(), value)).collect();
        // Its own before the one that others share.
        found.sort_by_key(|(constant, is_shared, _)| (*constant, *is_shared));
        found.dedup_by_key(|(constant, ..)| *constant);
        found.into_iter().map(|(.., value)| value).collect()
    }

    /// The coordinates of these constants, as far as they are free.
    pub(crate) fn of_constants(&self, values: &[f64]) -> Vec<f64> {
        let of = |of: &ConstantSlot| Some(of.slot.coordinate()?.of_value(*values.get(of.constant)?));
        self.constants.iter().filter_map(of).collect()
    }

    /// The coordinates at which a free factor on all records is so many times what it is; `None` where there is none.
    pub(crate) fn multiplied(&self, z: &[f64], times: f64) -> Option<Vec<f64>> {
        let number = self.parts.iter().position(|part| part.effect.id() == GAIN && part.free() > 0)?;
        let (part, own) = (&self.parts[number], self.of_parts(z)[number]);
        let before = self.free_constants() + self.parts[..number].iter().map(Part::free).sum::<usize>();
        let value = part.values(own).first()? * times;
        let moved = part.coordinates_of(&[value]);
        value.is_finite().then(|| [&z[..before], &moved, &z[before + own.len()..]].concat())
    }

    /// Numbers of the coordinates that are places of what the base lacks.
    pub(crate) fn places(&self, axis: &str) -> Vec<usize> {
        let mut places = Vec::new();
        let mut at = self.free_constants();
        for part in &self.parts {
            for (slot, parameter) in part.slots.iter().zip(part.parameters()) {
                if slot.coordinate().is_none() {
                    continue;
                }
                if part.role == Role::Found && has_place(part.effect) && parameter.name == axis {
                    places.push(at);
                }
                at += 1;
            }
        }
        places
    }

    /// The coordinates of each part, in order.
    pub(crate) fn of_parts<'z>(&self, z: &'z [f64]) -> Vec<&'z [f64]> {
        let mut from = self.free_constants();
        let part = |part: &Part| {
            let own = &z[from..from + part.free()];
            from += part.free();
            own
        };
        self.parts.iter().map(part).collect()
    }

    /// The effects that act on measured modes of so many records.
    ///
    /// # Errors
    /// As [`EffectState::new`].
    pub(crate) fn effects(
        &self,
        z: &[f64],
        records: usize,
        acts: impl Fn(&dyn Effect) -> bool,
    ) -> Result<Vec<EffectState>, ModelError> {
        let acting = self.parts.iter().zip(self.of_parts(z)).filter(|(part, _)| acts(part.effect));
        acting.map(|(part, z)| EffectState::new(part.effect, part.values(z), records.max(1))).collect()
    }

    /// Constants, then the values of each effect, with their standard deviations where they are free.
    pub(crate) fn values_with_deviations(&self, z: &[f64], covariance: &Mat<f64>) -> Vec<(f64, Option<f64>)> {
        let slots = self.of_slots().chain(self.parts.iter().flat_map(|part| &part.slots));
        let mut place = 0..;
        let value = |slot: &Slot| match slot {
            Slot::Held(value) => (*value, None),
            Slot::Free(coordinate) => {
                let at = place.next().unwrap_or(0);
                let std = covariance[(at, at)].sqrt() * coordinate.slope(z[at]).abs();
                (coordinate.value(z[at]), Some(std))
            }
        };
        slots.map(value).collect()
    }

    /// Logarithm of the prior density of the coordinates.
    pub(crate) fn log_prior(&self, z: &[f64]) -> f64 {
        let density = |(coordinate, z): (&Coordinate, &f64)| match coordinate.map {
            Map::Even { .. } => -std::f64::consts::LN_2,
            _ => -0.5 * z * z - 0.5 * std::f64::consts::TAU.ln(),
        };
        self.coordinates().zip(z).map(density).sum()
    }

    /// Curvature of its negative: one, or zero where it is even.
    pub(crate) fn precision(&self) -> Vec<f64> {
        self.coordinates().map(|coordinate| f64::from(u8::from(coordinate.farthest() != 1.0))).collect()
    }

    /// Within its bounds.
    pub(crate) fn clamp(&self, z: &mut [f64]) {
        z.iter_mut().zip(self.coordinates()).for_each(|(z, of)| *z = z.clamp(-of.farthest(), of.farthest()));
    }

    /// Largest size of each coordinate.
    pub(crate) fn farthest(&self) -> Vec<f64> {
        self.coordinates().map(Coordinate::farthest).collect()
    }
}
