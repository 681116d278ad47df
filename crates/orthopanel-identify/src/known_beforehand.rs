//! What is known of a panel before its test: how well it was measured and weighed, and Gaussian priors of its constants.

use orthopanel_data::{ImpactTest, KnownConstant, NamedPiece};
use orthopanel_model::{ModeRange, Ports};

use crate::{Correlation, Identification, IdentifiedConstant, IdentifyError, PriorContradiction};

/// Priors and doubts of sizes carried into what was found; `again` identifies a test that holds further constants.
///
/// Constants follow the sizes as the laws of similarity have it: plates and beams vibrate alike where $D_{11}/\mu a^4$,
/// $D_{22}/\mu b^4$, $D_{12}/\mu a^2b^2$, $D_{66}/\mu a^2b^2$, $S_{zx}/\mu a^2$ and $S_{yz}/\mu b^2$ are the same (but for rotary inertia),
/// so that $E_x \propto \mu a^4/t^3$, $E_y \propto \mu b^4/t^3$, $G_{xy} \propto \mu a^2b^2/t^3$, $\nu_{xy} \propto a^2/b^2$,
/// $G_{zx} \propto \mu a^2/t$, $G_{yz} \propto \mu b^2/t$. The sizes' standard deviations come to the covariance by these exponents; of a
/// constant that pieces share each piece has the share of its modes. A prior then meets the constants as a further datum, the other
/// constants with it by their covariance.
///
/// # Errors
/// [`IdentifyError::PriorContradicted`]; as `again`, where a constant with a prior is one that the data do not show.
pub(crate) fn carried(
    test: &ImpactTest,
    mut found: Identification,
    again: impl Fn(&ImpactTest) -> Result<Identification, IdentifyError>,
) -> Result<Identification, IdentifyError> {
    let has_doubt = test.pieces.iter().any(|piece| !piece.doubt.is_none());
    let priors: Vec<(&str, f64, f64)> = test
        .known_constants
        .iter()
        .filter_map(|(name, known)| match known {
            KnownConstant::Prior { value, std } => Some((name.as_str(), *value, *std)),
            KnownConstant::Start(_) => None,
        })
        .collect();
    if !has_doubt && priors.is_empty() {
        return Ok(found);
    }
    let (shown, unseen): (Vec<_>, Vec<_>) =
        priors.into_iter().partition(|(name, ..)| found.not_identified.iter().all(|unseen| unseen.name != *name));
    // What the data do not show is what the prior says: held at its value, and the others follow it.
    let mut shifts: Vec<Identification> = Vec::new();
    if !unseen.is_empty() {
        let held_at = |beside: Option<usize>| {
            let mut held = test.clone();
            for (index, (name, value, std)) in unseen.iter().enumerate() {
                let value = value + if beside == Some(index) { *std } else { 0.0 };
                held.constants.insert((*name).to_owned(), value);
                held.known_constants.remove(*name);
            }
            again(&held)
        };
        found = held_at(None)?;
        shifts = (0..unseen.len()).map(|index| held_at(Some(index))).collect::<Result<_, _>>()?;
    }
    let mut known = Known::of(test, &found);
    for shifted in &shifts {
        known.add(&known.shift_to(shifted));
    }
    for (index, named) in test.pieces.iter().enumerate() {
        let share = known.shares(&found, test, index);
        for (relative, exponents) in relative_doubts(named) {
            let moved: Vec<f64> =
                known.names().zip(&share).map(|(name, share)| share * relative * exponent(name, exponents)).collect();
            known.add(&moved);
        }
    }
    let mut contradictions = Vec::new();
    for (name, value, std) in shown {
        contradictions.extend(known.meet(name, value, std));
    }
    known.write(test, &mut found);
    if known.moved.iter().any(|moved| *moved != 0.0) {
        at_moved_constants(test, &mut found, &again, &contradictions)?;
    }
    found.notes.extend(contradictions.iter().map(ToString::to_string));
    for (name, _, std) in unseen {
        for constant in found.constants.iter_mut().filter(|constant| constant.name == name) {
            (constant.std, constant.held) = (Some(std), false);
        }
    }
    Ok(found)
}

/// Of length, width, thickness and mass per area: relative standard deviation, and the exponents of a unit.
fn relative_doubts(named: &NamedPiece) -> impl Iterator<Item = (f64, [f64; 4])> {
    let NamedPiece { piece, doubt, .. } = named;
    let relative = [
        doubt.length / piece.length,
        doubt.width / piece.width,
        doubt.thickness / piece.thickness,
        doubt.mass_per_area / piece.mass_per_area,
    ];
    let unit = |of: usize| [0, 1, 2, 3].map(|at| f64::from(u8::from(at == of)));
    relative
        .into_iter()
        .enumerate()
        .map(move |(of, relative)| (relative, unit(of)))
        .filter(|(relative, _)| *relative > 0.0)
}

/// How a constant's logarithm follows those of length, width, thickness and mass per area.
fn exponent(name: &str, [length, width, thickness, mass]: [f64; 4]) -> f64 {
    match name {
        "e_x" => mass + 4.0 * length - 3.0 * thickness,
        "e_y" => mass + 4.0 * width - 3.0 * thickness,
        "g_xy" => mass + 2.0 * length + 2.0 * width - 3.0 * thickness,
        "nu_xy" => 2.0 * length - 2.0 * width,
        "g_zx" => mass + 2.0 * length - thickness,
        "g_yz" => mass + 2.0 * width - thickness,
        _ => 0.0,
    }
}

/// The constants that have a standard deviation, as logarithms, with their covariance.
struct Known {
    /// Places among the constants found.
    places: Vec<usize>,
    constants: Vec<IdentifiedConstant>,
    covariance: Vec<Vec<f64>>,
    /// Where priors have moved the logarithms to.
    moved: Vec<f64>,
}

impl Known {
    fn of(test: &ImpactTest, found: &Identification) -> Self {
        let places: Vec<usize> = (0..found.constants.len())
            .filter(|&place| found.constants[place].std.is_some() && !found.constants[place].held)
            .collect();
        let constants: Vec<IdentifiedConstant> = places.iter().map(|&place| found.constants[place].clone()).collect();
        let relative = |constant: &IdentifiedConstant| constant.std.unwrap_or_default() / constant.value;
        let is = |constant: &IdentifiedConstant, name: &str, piece: Option<usize>| {
            let own = piece.and_then(|piece| test.pieces.get(piece)).map(|piece| piece.name.as_str());
            constant.name == name && constant.piece.as_deref() == own
        };
        let correlation = |a: &IdentifiedConstant, b: &IdentifiedConstant| {
            let of = |pair: &&Correlation| {
                let one = |of: &IdentifiedConstant| is(of, pair.first, pair.first_piece);
                let other = |of: &IdentifiedConstant| is(of, pair.second, pair.second_piece);
                (one(a) && other(b)) || (one(b) && other(a))
            };
            found.correlations.iter().find(of).map_or(0.0, |pair| pair.value)
        };
        let covariance = (0..constants.len()).map(|i| {
            let row = (0..constants.len()).map(|j| {
                let (a, b) = (&constants[i], &constants[j]);
                let together = if i == j { 1.0 } else { correlation(a, b) };
                together * relative(a) * relative(b)
            });
            row.collect()
        });
        Self { covariance: covariance.collect(), moved: vec![0.0; constants.len()], places, constants }
    }

    fn names(&self) -> impl Iterator<Item = &'static str> + '_ {
        self.constants.iter().map(|constant| constant.name)
    }

    /// Adds an independent cause that moves the logarithms so far with one standard deviation.
    fn add(&mut self, by: &[f64]) {
        for (row, one) in self.covariance.iter_mut().zip(by) {
            row.iter_mut().zip(by).for_each(|(value, other)| *value += one * other);
        }
    }

    /// How far the logarithms move to those of another identification.
    fn shift_to(&self, other: &Identification) -> Vec<f64> {
        let of = |(place, constant): (&usize, &IdentifiedConstant)| {
            let there = other.constants.get(*place).filter(|there| there.name == constant.name);
            there.map_or(0.0, |there| (there.value / constant.value).ln())
        };
        self.places.iter().zip(&self.constants).map(of).collect()
    }

    /// The share that a piece has in each constant, by its modes.
    fn shares(&self, found: &Identification, test: &ImpactTest, piece: usize) -> Vec<f64> {
        let modes = |index: usize| found.pieces.get(index).map_or(0, |fit| fit.modes.len()) as f64;
        let name = test.pieces.get(piece).map(|named| named.name.as_str());
        let of = |constant: &IdentifiedConstant| match &constant.piece {
            Some(own) => f64::from(u8::from(Some(own.as_str()) == name)),
            None => {
                let has_own = |index: usize| test.pieces[index].own_constants.iter().any(|own| own == constant.name);
                let sharing = (0..test.pieces.len()).filter(|&index| !has_own(index));
                let all: f64 = sharing.map(modes).sum();
                if has_own(piece) || all == 0.0 { 0.0 } else { modes(piece) / all }
            }
        };
        self.constants.iter().map(of).collect()
    }

    /// A Gaussian prior of one constant as a further datum; where the data contradict it, by how much.
    fn meet(&mut self, name: &str, value: f64, std: f64) -> Vec<PriorContradiction> {
        let mut contradictions = Vec::new();
        for k in (0..self.constants.len()).filter(|&k| self.constants[k].name == name).collect::<Vec<_>>() {
            let column: Vec<f64> = self.covariance.iter().map(|row| row[k]).collect();
            let at = self.constants[k].value * self.moved[k].exp();
            let all = column[k] + (std / value).powi(2);
            let deviations = (value / at).ln().abs() / all.sqrt();
            if deviations > CONTRADICTED {
                let (name, unit) = (self.constants[k].name, self.constants[k].unit);
                let found_std = column[k].max(0.0).sqrt() * at;
                contradictions.push(PriorContradiction { name, unit, value, std, found: at, found_std, deviations });
            }
            let gain: Vec<f64> = column.iter().map(|of| of / all).collect();
            self.moved.iter_mut().zip(&gain).for_each(|(moved, gain)| *moved += gain * (value / at).ln());
            for (row, gain) in self.covariance.iter_mut().zip(&gain) {
                row.iter_mut().zip(&column).for_each(|(value, of)| *value -= gain * of);
            }
        }
        contradictions
    }

    /// Writes values, standard deviations and correlations back, and the model's frequencies at the constants that moved.
    fn write(&self, test: &ImpactTest, found: &mut Identification) {
        let std = |k: usize| self.covariance[k][k].max(0.0).sqrt();
        for (k, place) in self.places.iter().enumerate() {
            let constant = &mut found.constants[*place];
            constant.value *= self.moved[k].exp();
            constant.std = Some(std(k) * constant.value);
        }
        let index = |piece: &Option<String>| {
            piece.as_ref().and_then(|name| test.pieces.iter().position(|named| named.name == *name))
        };
        found.correlations = (0..self.constants.len())
            .flat_map(|i| (i + 1..self.constants.len()).map(move |j| (i, j)))
            .map(|(i, j)| {
                let (a, b) = (&self.constants[i], &self.constants[j]);
                Correlation {
                    first: a.name,
                    first_piece: index(&a.piece),
                    second: b.name,
                    second_piece: index(&b.piece),
                    value: self.covariance[i][j] / (std(i) * std(j)).max(f64::MIN_POSITIVE),
                }
            })
            .collect();
        if self.moved.iter().any(|moved| *moved != 0.0) && test.effects.is_empty() {
            moved_modes(test, found);
        }
    }
}

/// Standard deviations beyond which a prior and the data contradict each other.
const CONTRADICTED: f64 = 3.0;

/// The model's errors at the constants as they are now, by an identification that holds them.
///
/// # Errors
/// [`IdentifyError::PriorContradicted`] where the records contradict these constants.
fn at_moved_constants(
    test: &ImpactTest,
    found: &mut Identification,
    again: &impl Fn(&ImpactTest) -> Result<Identification, IdentifyError>,
    contradictions: &[PriorContradiction],
) -> Result<(), IdentifyError> {
    if found.constants.iter().any(|constant| constant.piece.is_some()) {
        return Ok(());
    }
    let mut held = test.clone();
    held.known_constants.clear();
    held.constants.extend(found.constants.iter().map(|constant| (constant.name.to_owned(), constant.value)));
    match (again(&held), contradictions.first()) {
        (Ok(at), _) => {
            found.pieces = at.pieces;
            found.frequency_rms_percent = at.frequency_rms_percent;
            found.left_one_out_percent = at.left_one_out_percent;
            found.accelerance_rms_percent = at.accelerance_rms_percent;
            found.chi_square = at.chi_square;
            found.accelerances = at.accelerances;
            Ok(())
        }
        (Err(refused), Some(prior)) if !refused.is_of_model() => {
            Err(IdentifyError::PriorContradicted { prior: *prior, refused: Box::new(refused) })
        }
        _ => Ok(()),
    }
}

/// The model's frequencies at the constants as they are now.
fn moved_modes(test: &ImpactTest, found: &mut Identification) {
    let mut pieces = found.pieces.clone();
    for fit in &mut pieces {
        let last = fit.modes.iter().map(|mode| mode.mode).max().unwrap_or(0);
        let model = found.panel_model(fit, test.boundary, Ports { forces: vec![], responses: vec![] });
        let Ok(modes) = model.modes(ModeRange::Count(last)) else { return };
        let flexible: Vec<f64> = modes.iter().filter(|mode| !mode.is_rigid()).map(|mode| mode.frequency()).collect();
        for mode in &mut fit.modes {
            if let Some(frequency) = flexible.get(mode.mode - 1) {
                mode.model = *frequency;
            }
        }
    }
    let errors: Vec<f64> = pieces.iter().flat_map(|fit| &fit.modes).map(|mode| mode.error_percent().powi(2)).collect();
    if !errors.is_empty() {
        found.frequency_rms_percent = (errors.iter().sum::<f64>() / errors.len() as f64).sqrt();
    }
    found.pieces = pieces;
}
