//! Which constants a test holds, which it leaves free, and which each piece has of its own.

use faer::Mat;
use orthopanel_data::{ImpactTest, KnownConstant};
use orthopanel_model::Constant;

use crate::{Correlation, IdentifyError, NotIdentified};

/// Half of a 95 % interval in standard deviations.
pub(crate) const HALF_95: f64 = 1.96;

/// A constant to find.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FreeConstant {
    /// Its position in the structure's list.
    pub constant: usize,
    /// The piece that has it of its own; `None` where pieces share it.
    pub piece: Option<usize>,
}

/// What a constant does that is no parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Rest {
    /// Held at a value.
    Held(f64),
    /// A fixed multiple of another constant.
    Follows {
        /// The other constant.
        leader: usize,
        /// The factor.
        ratio: f64,
    },
}

/// The constants of a structure, and which of them are parameters of a search.
///
/// A parameter is the logarithm of a constant where its bounds are positive (the moduli), and the constant itself where
/// they are not (Poisson's ratio).
#[derive(Debug, Clone)]
pub(crate) struct FreeConstants {
    pub constants: Vec<Constant>,
    /// Values of the constants that are held; free ones are `None`.
    pub held: Vec<Option<f64>>,
    /// Values near which the test file has constants that are not held: starts and priors.
    pub starts: Vec<Option<f64>>,
    /// Constants that neither the test file holds nor a parameter moves, with what they do meanwhile.
    pub resting: Vec<(usize, Rest)>,
    /// One a parameter.
    pub free: Vec<FreeConstant>,
}

/// Constants of which those that rested are free too.
pub(crate) struct RestingFreed {
    pub constants: FreeConstants,
    /// Those that were free first.
    pub parameters: Vec<f64>,
    /// Standard deviation of each that rested, by what is usual for panels alone.
    pub usual_stds: Vec<f64>,
}

impl FreeConstants {
    /// What the test file says of the constants of a structure.
    ///
    /// # Errors
    /// [`IdentifyError::UnknownConstant`], [`IdentifyError::HeldAndOwn`], and a held value out of its bounds.
    pub fn of(test: &ImpactTest, constants: &[Constant]) -> Result<Self, IdentifyError> {
        let own_names = test.pieces.iter().flat_map(|piece| &piece.own_constants);
        for name in test.constants.keys().chain(test.known_constants.keys()).chain(own_names) {
            if constants.iter().all(|constant| constant.name != name) {
                let known = constants.iter().map(|constant| constant.name).collect::<Vec<_>>().join(", ");
                return Err(IdentifyError::UnknownConstant { name: name.clone(), known });
            }
        }
        let held: Vec<Option<f64>> =
            constants.iter().map(|constant| test.constants.get(constant.name).copied()).collect();
        for (constant, value) in constants.iter().zip(&held) {
            value.map_or(Ok(()), |value| constant.check(value))?;
        }
        for piece in &test.pieces {
            if let Some(name) = piece.own_constants.iter().find(|name| test.constants.contains_key(*name)) {
                return Err(IdentifyError::HeldAndOwn { name: name.clone(), piece: piece.name.clone() });
            }
        }
        let mut free = Vec::new();
        for (index, constant) in constants.iter().enumerate().filter(|(index, _)| held[*index].is_none()) {
            let is_own = |piece: &usize| test.pieces[*piece].own_constants.iter().any(|name| name == constant.name);
            let (own, sharing): (Vec<usize>, Vec<usize>) = (0..test.pieces.len()).partition(is_own);
            if !sharing.is_empty() {
                free.push(FreeConstant { constant: index, piece: None });
            }
            free.extend(own.into_iter().map(|piece| FreeConstant { constant: index, piece: Some(piece) }));
        }
        let start = |constant: &Constant| match test.known_constants.get(constant.name)? {
            KnownConstant::Start(value) | KnownConstant::Prior { value, .. } => Some(*value),
        };
        let starts: Vec<Option<f64>> = constants.iter().map(start).collect();
        for (constant, value) in constants.iter().zip(&starts) {
            value.map_or(Ok(()), |value| constant.check(value))?;
        }
        Ok(Self { constants: constants.to_vec(), held, starts, resting: Vec::new(), free })
    }

    /// The value at which the test file holds a constant.
    pub fn held_at(&self, name: &str) -> Option<f64> {
        let index = self.constants.iter().position(|constant| constant.name == name)?;
        self.held[index]
    }

    /// The value at which the test file holds a constant, or near which it has it.
    pub fn known_near(&self, name: &str) -> Option<f64> {
        let index = self.constants.iter().position(|constant| constant.name == name)?;
        self.held[index].or(self.starts[index])
    }

    /// The constants that are free, each once, in the structure's order.
    pub fn free_constants(&self) -> Vec<usize> {
        let is_free = |constant: &usize| self.free.iter().any(|free| free.constant == *constant);
        (0..self.constants.len()).filter(is_free).collect()
    }

    /// Whether a constant is a modulus, rather than a ratio.
    pub fn is_modulus(&self, constant: usize) -> bool {
        is_logarithmic(&self.constants[constant])
    }

    /// Takes a constant out of the parameters; it rests.
    pub fn rest(&mut self, constant: usize, rest: Rest) {
        self.free.retain(|free| free.constant != constant);
        self.resting.push((constant, rest));
    }

    /// What a constant rests on, if it does.
    fn resting(&self, constant: usize) -> Option<Rest> {
        self.resting.iter().find(|(resting, _)| *resting == constant).map(|(_, rest)| *rest)
    }

    /// The same with every resting constant free too, behind the others, and the parameters of both at the same values.
    pub fn with_resting_freed(&self, parameters: &[f64]) -> RestingFreed {
        let values = self.values(parameters, 0);
        let mut freed =
            RestingFreed { constants: self.clone(), parameters: parameters.to_vec(), usual_stds: Vec::new() };
        for (constant, _) in freed.constants.resting.drain(..) {
            freed.constants.free.push(FreeConstant { constant, piece: None });
            freed.parameters.push(to_scale(&self.constants[constant], values[constant]));
            freed.usual_stds.push(self.usual_std(constant));
        }
        freed
    }

    /// Standard deviation of a constant that nothing but what is usual for panels tells: its own beside the one that it
    /// follows, and that one's where it rests too.
    fn usual_std(&self, constant: usize) -> f64 {
        let is_shear = |constant: usize| is_through_the_thickness(self.constants[constant].name);
        if !self.is_modulus(constant) {
            return USUAL_POISSON_STD;
        }
        let (mut last, mut variance) = (constant, 0.0);
        for _ in 0..self.constants.len() {
            let Some(rest) = self.resting(last) else { break };
            let Rest::Follows { leader, .. } = rest else { return (variance + USUAL_LOG_STD.powi(2)).sqrt() };
            let own = match [is_shear(leader), is_shear(last)] {
                [false, false] => USUAL_LOG_STD,
                [true, true] => CORE_LOG_STD,
                _ => CORE_BESIDE_FACES_STD,
            };
            (last, variance) = (leader, variance + own * own);
        }
        variance.sqrt()
    }

    /// Whether no modulus is held: all frequencies then go with the root of a factor on all moduli.
    pub fn moduli_are_free(&self) -> bool {
        self.constants.iter().zip(&self.held).all(|(constant, held)| !is_logarithmic(constant) || held.is_none())
    }

    /// Values with a factor on every modulus that is not held.
    pub fn free_scaled(&self, values: &[f64], factor: f64) -> Vec<f64> {
        let scaled = self.scaled(values, factor);
        self.held.iter().zip(scaled).map(|(held, scaled)| held.unwrap_or(scaled)).collect()
    }

    /// Values with a factor on every modulus.
    pub fn scaled(&self, values: &[f64], factor: f64) -> Vec<f64> {
        let scaled =
            |(constant, value): (&Constant, &f64)| if is_logarithmic(constant) { factor * value } else { *value };
        self.constants.iter().zip(values).map(scaled).collect()
    }

    /// Number of parameters.
    pub fn count(&self) -> usize {
        self.free.len()
    }

    /// The parameter of each constant of a piece, or the one of the constant that it follows, straight or through others;
    /// `None` where it is held.
    pub fn parameters_of(&self, piece: usize) -> Vec<Option<usize>> {
        let of = |constant: usize| {
            let matches = |owner: Option<usize>| {
                self.free.iter().position(|free| free.constant == constant && free.piece == owner)
            };
            matches(Some(piece)).or_else(|| matches(None))
        };
        (0..self.constants.len()).map(|constant| of(self.leader(constant).0)).collect()
    }

    /// All constants of a piece at these parameters.
    pub fn values(&self, parameters: &[f64], piece: usize) -> Vec<f64> {
        let of_constant = self.parameters_of(piece);
        let own = |constant: usize| match of_constant[constant] {
            Some(parameter) => self.value(parameter, parameters[parameter]),
            None => self.held[constant].unwrap_or(f64::NAN),
        };
        let value = |constant: usize| {
            let (leader, ratio) = self.leader(constant);
            match self.resting(leader) {
                Some(Rest::Held(value)) => ratio * value,
                _ if leader == constant => own(constant),
                _ => {
                    let Constant { low, high, .. } = self.constants[constant];
                    (ratio * own(leader)).clamp(low, high)
                }
            }
        };
        (0..self.constants.len()).map(value).collect()
    }

    /// The constant at the end of those that this one follows, itself where it follows none, and the factor on it.
    pub fn leader(&self, constant: usize) -> (usize, f64) {
        let (mut last, mut factor) = (constant, 1.0);
        // No chain is longer than there are constants.
        for _ in 0..self.constants.len() {
            let Some(Rest::Follows { leader, ratio }) = self.resting(last) else { break };
            (last, factor) = (leader, factor * ratio);
        }
        (last, factor)
    }

    /// The constant of one parameter.
    pub fn value(&self, parameter: usize, at: f64) -> f64 {
        let constant = self.constant(parameter);
        let value = if is_logarithmic(constant) { at.exp() } else { at };
        // exp(ln x) may pass a bound by rounding.
        value.clamp(constant.low, constant.high)
    }

    /// The parameter at a value of its constant, within the bounds.
    pub fn parameter(&self, parameter: usize, value: f64) -> f64 {
        to_scale(self.constant(parameter), value.clamp(self.constant(parameter).low, self.constant(parameter).high))
    }

    /// $\partial c/\partial p$ of a constant at a value: the value itself for a logarithm.
    pub fn slope(&self, constant: usize, value: f64) -> f64 {
        if is_logarithmic(&self.constants[constant]) { value } else { 1.0 }
    }

    /// Bounds of the parameters.
    pub fn bounds(&self) -> Vec<(f64, f64)> {
        let bounds = |free: &FreeConstant| {
            let constant = &self.constants[free.constant];
            (to_scale(constant, constant.low), to_scale(constant, constant.high))
        };
        self.free.iter().map(bounds).collect()
    }

    /// Name, unit and bounds of a parameter's constant.
    pub fn constant(&self, parameter: usize) -> &Constant {
        &self.constants[self.free[parameter].constant]
    }

    /// Whether a parameter lies on a bound: such a value is the bound's, not the data's.
    pub fn on_bound(&self, parameter: usize, at: f64) -> bool {
        let constant = self.constant(parameter);
        let (low, high) = (to_scale(constant, constant.low), to_scale(constant, constant.high));
        at - low < 1e-6 || high - at < 1e-6
    }

    /// The direction of these changes of all parameters as a unit vector by the names of the constants: one parameter first
    /// and positive, then the largest; small ones are not told.
    fn direction(&self, first: usize, changes: &[f64]) -> Vec<(&'static str, f64)> {
        let size = changes.iter().map(|change| change * change).sum::<f64>().sqrt() * changes[first].signum();
        let mut components: Vec<(usize, f64)> = changes.iter().map(|change| change / size).enumerate().collect();
        components.retain(|(index, component)| *index == first || component.abs() > SMALL_COMPONENT);
        components.sort_by(|a, b| (b.0 == first).cmp(&(a.0 == first)).then(b.1.abs().total_cmp(&a.1.abs())));
        components.into_iter().map(|(index, component)| (self.constant(index).name, component)).collect()
    }

    /// What is said of a parameter that rests at `at` since the data leave it open by this standard deviation: its 95 % interval,
    /// and where all parameters go with it, by the covariance, of which these are the first.
    pub fn not_identified(&self, parameter: usize, at: f64, std: f64, covariance: Option<&Mat<f64>>) -> NotIdentified {
        let Constant { name, unit, .. } = *self.constant(parameter);
        let end = |sign: f64| self.value(parameter, at + sign * HALF_95 * std);
        let column = |matrix: &Mat<f64>| (0..self.count()).map(|i| matrix[(i, parameter)]).collect::<Vec<f64>>();
        NotIdentified {
            name,
            unit,
            held_at: self.value(parameter, at),
            interval: [end(-1.0), end(1.0)],
            direction: covariance.map(|matrix| self.direction(parameter, &column(matrix))).unwrap_or_default(),
        }
    }

    /// Correlation coefficient of each pair of parameters, the first ones of a covariance.
    pub fn correlations(&self, covariance: &Mat<f64>) -> Vec<Correlation> {
        let value = |i: usize, j: usize| covariance[(i, j)] / (covariance[(i, i)] * covariance[(j, j)]).sqrt();
        let pairs = (0..self.count()).flat_map(|i| (i + 1..self.count()).map(move |j| (i, j)));
        let of = |(i, j): (usize, usize)| Correlation {
            first: self.constant(i).name,
            first_piece: self.free[i].piece,
            second: self.constant(j).name,
            second_piece: self.free[j].piece,
            value: value(i, j),
        };
        pairs.map(of).collect()
    }

    /// Refuses a minimum that lies on a bound.
    pub fn refuse_bounds(&self, parameters: &[f64]) -> Result<(), IdentifyError> {
        let on_bound = |&index: &usize| self.on_bound(index, parameters[index]);
        (0..self.count()).find(on_bound).map_or(Ok(()), |index| {
            let Constant { name, unit, .. } = *self.constant(index);
            Err(IdentifyError::OnBound { name, value: self.value(index, parameters[index]), unit })
        })
    }
}

/// Components of a direction below this part of the whole are not told.
const SMALL_COMPONENT: f64 = 0.1;

/// Moduli of panels lie within some 30 % of what is usual beside the others,
const USUAL_LOG_STD: f64 = 0.3;
/// the two shear moduli through the thickness within a factor of two or so, as a honeycomb has them along and across its ribbons,
const CORE_LOG_STD: f64 = 0.5;
/// these beside the moduli of the faces within a factor of seven: cores differ that much,
pub(crate) const CORE_BESIDE_FACES_STD: f64 = 1.0;
/// and Poisson's ratios within 0.1.
const USUAL_POISSON_STD: f64 = 0.1;

fn is_through_the_thickness(name: &str) -> bool {
    matches!(name, "g_yz" | "g_zx")
}

fn is_logarithmic(constant: &Constant) -> bool {
    constant.unit == "Pa"
}

fn to_scale(constant: &Constant, value: f64) -> f64 {
    if is_logarithmic(constant) { value.ln() } else { value }
}
