//! What a hypothesis foretells for records that were not taken.

use num_complex::Complex64;
use orthopanel_model::{
    Boundary, Damping, Effect, EffectState, ModelError, Piece, Place, ReceptanceSetup, RecordSetting, Scale, effect,
};

use super::places::Proposal;
use crate::tracing::record_problem::State;

/// What further records have in common with those that were taken.
pub(super) struct Bench<'a> {
    pub piece: Piece,
    pub boundary: Boundary,
    pub suspension: &'a [Place],
    pub summed: usize,
    pub s: &'a [Complex64],
    /// The test as it was, whose modes the damping ratios of a state count.
    pub of_records: &'a ReceptanceSetup,
}

/// Accelerances of a further measurement, one a place of the force.
pub(super) struct Foretold {
    lines: Vec<Vec<Complex64>>,
    /// Whether the model has a width, and so twists.
    is_plate: bool,
}

impl Bench<'_> {
    /// What a state foretells.
    ///
    /// # Errors
    /// What the model refuses.
    pub(super) fn foretold(&self, state: &State, proposal: &Proposal) -> Result<Foretold, ModelError> {
        let record = |force: &Place| RecordSetting {
            force_at: Some(*force),
            response_at: Some(proposal.response_at),
            ..RecordSetting::default()
        };
        let settings: Vec<RecordSetting> = proposal.forces_at.iter().map(record).collect();
        let setup = ReceptanceSetup::new(&self.piece, self.boundary, self.suspension, &settings, self.summed)?;
        let mut states = Vec::new();
        for on in &state.hypothesis.effects {
            let of_one_record = on.effect.parameters().iter().any(|p| p.each_record || p.scale == Scale::Index);
            if !of_one_record {
                states.push(EffectState::new(on.effect, on.values.clone(), 1)?);
            }
        }
        let values = state.constants.map(f64::exp);
        let is_plate = state.hypothesis.holds_plate();
        let mut damping = state.damping();
        if is_plate {
            let known = self.of_records.summed_frequencies(&values, &states)?;
            damping = renumbered(&damping, &known, &setup.summed_frequencies(&values, &states)?);
        }
        if proposal.added_mass > 0.0 {
            let sensor = with_mass(&mut states, proposal.added_mass)?;
            states.push(sensor);
        }
        let model = setup.model(&values, &damping, &states)?;
        let lines = (0..settings.len()).map(|index| {
            let mut lines = Vec::with_capacity(self.s.len());
            if let Some(mut evaluator) = model.evaluator(index) {
                evaluator.lines(self.s, |_, value, _| lines.push(value));
            }
            lines
        });
        Ok(Foretold { lines: lines.collect(), is_plate })
    }
}

/// Damping ratios of the modes at `now` \[Hz\], each that of the nearest at `known`: from the middle line a plate shows no mode that
/// twists, from elsewhere it does, and these stand between the others.
fn renumbered(damping: &Damping, known: &[f64], now: &[f64]) -> Damping {
    let far = |mode: &(usize, &f64), at: f64| (mode.1 / at).ln().abs();
    let nearest = |at: f64| known.iter().enumerate().min_by(|a, b| far(a, at).total_cmp(&far(b, at)));
    let ratio = |at: &f64| nearest(*at).map_or(damping.beyond, |(mode, _)| damping.ratio(mode + 1));
    Damping { ratios: now.iter().map(ratio).collect(), beyond: damping.beyond }
}

/// Rms difference of two hypotheses over the noise of as many hits as a record has.
///
/// A beam has no twist in its model. It does not say that there is none, so twist is no evidence against it: where one of the two is a
/// beam, the mean over both ends of a line across counts, which has none.
pub(super) fn difference(one: &Foretold, other: &Foretold, variance: &[f64]) -> f64 {
    let places = one.lines.len().max(1) as f64;
    let mut square = 0.0;
    for (line, variance) in variance.iter().enumerate() {
        let apart = one.lines.iter().zip(&other.lines).map(|(a, b)| a[line] - b[line]);
        square += if one.is_plate && other.is_plate {
            apart.map(|apart| apart.norm_sqr()).sum::<f64>() / places / variance
        } else {
            (apart.sum::<Complex64>() / places).norm_sqr() / variance
        };
    }
    (square / variance.len().max(1) as f64).sqrt()
}

/// A sensor heavier by `mass`, taking the place of one that is on.
fn with_mass(states: &mut Vec<EffectState>, mass: f64) -> Result<EffectState, ModelError> {
    let sensor: &'static dyn Effect = effect("sensor-mass")?;
    let before = states.iter().position(|state| state.effect.id() == sensor.id()).map(|index| states.remove(index));
    let mut values = before.map_or_else(|| vec![0.0; sensor.parameters().len()], |state| state.values);
    if let Some(first) = values.first_mut() {
        *first += mass;
    }
    EffectState::new(sensor, values, 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tracing::hypothesis::{Hypothesis, PLATE, Switched};

    const PIECE: Piece = Piece { length: 0.8, width: 0.28, thickness: 0.02, mass_per_area: 6.0 };
    const SUMMED: usize = 8;

    /// A beam, or a plate of this $G_{xy}/E_x$; its modes' damping ratios differ.
    fn state(g_xy_ratio: Option<f64>) -> State {
        let ratios = |g_xy: f64| {
            move |name: &str| match name {
                "e_y_ratio" => Some(0.7),
                "g_xy_ratio" => Some(g_xy),
                _ => None,
            }
        };
        let plate = g_xy_ratio.map(|g_xy| Switched::new(effect(PLATE).unwrap(), &PIECE, 1, ratios(g_xy), |_| false));
        State {
            constants: [1e10_f64.ln(), 4e8_f64.ln()],
            zetas: [0.003, 0.012, 0.005, 0.02, 0.008, 0.01].map(f64::ln).to_vec(),
            hypothesis: Hypothesis { effects: plate.into_iter().collect() },
        }
    }

    fn foretold(state: &State, forces: &[Place], response: Place) -> Vec<Vec<Complex64>> {
        whole(state, forces, response).lines
    }

    fn whole(state: &State, forces: &[Place], response: Place) -> Foretold {
        let middle = RecordSetting {
            force_at: Some(at(-0.3, 0.0)),
            response_at: Some(at(0.2, 0.0)),
            ..RecordSetting::default()
        };
        let s: Vec<Complex64> =
            (1..60).map(|line| Complex64::new(10.0, std::f64::consts::TAU * 30.0 * f64::from(line))).collect();
        let bench = Bench {
            piece: PIECE,
            boundary: Boundary::default(),
            suspension: &[],
            summed: SUMMED,
            s: &s,
            of_records: &ReceptanceSetup::new(&PIECE, Boundary::default(), &[], &[middle], SUMMED).unwrap(),
        };
        let proposal =
            Proposal { words: String::new(), forces_at: forces.to_vec(), response_at: response, added_mass: 0.0 };
        bench.foretold(state, &proposal).unwrap()
    }

    fn at(x: f64, y: f64) -> Place {
        Place { x, y }
    }

    fn relative(one: &[Complex64], other: &[Complex64]) -> f64 {
        let apart: f64 = one.iter().zip(other).map(|(a, b)| (a - b).norm_sqr()).sum();
        (apart / one.iter().map(Complex64::norm_sqr).sum::<f64>()).sqrt()
    }

    #[test]
    fn a_beam_says_the_same_wherever_across_it_is_hit() {
        let lines = foretold(&state(None), &[at(-0.2, 0.0), at(-0.2, 0.11)], at(0.3, 0.05));
        assert!(relative(&lines[0], &lines[1]) < 1e-12);
    }

    /// A place off the middle line brings in modes that twist, between those that the ratios were found for.
    #[test]
    fn modes_keep_their_damping_where_twisting_ones_come_between() {
        let (plate, middle, sensor) = (state(Some(0.3)), at(-0.2, 0.0), at(0.3, 0.0));
        let alone = foretold(&plate, &[middle], sensor);
        let beside = foretold(&plate, &[middle, at(-0.2, 0.11)], sensor);
        assert!(relative(&alone[0], &beside[0]) < 2e-3, "{}", relative(&alone[0], &beside[0]));
        // And the line across shows that the plate bends there.
        assert!(relative(&beside[0], &beside[1]) > 0.05, "{}", relative(&beside[0], &beside[1]));
    }

    /// Twist, which a beam's model leaves out and any panel has, tells two plates apart and says nothing against a beam.
    #[test]
    fn twist_is_no_evidence_against_a_beam() {
        let (stiff, soft, beam) = (state(Some(0.35)), state(Some(0.2)), state(None));
        let line = [at(-0.2, 0.11), at(-0.2, -0.11)];
        let variance = vec![1.0; 59];
        // A sensor off the middle line: on it, no force shows twist.
        let of = |state: &State| whole(state, &line, at(0.3, 0.1));
        let [stiff, soft, beam] = [&stiff, &soft, &beam].map(of);
        // The same lines, taken for those of a model with twist or without.
        let taken_for = |one: &Foretold, is_plate| Foretold { lines: one.lines.clone(), is_plate };
        let counted = |one: &Foretold, other: &Foretold| {
            [true, false].map(|is_plate| difference(&taken_for(one, is_plate), &taken_for(other, true), &variance))
        };
        let [with_twist, without] = counted(&stiff, &soft);
        assert_eq!(difference(&stiff, &soft, &variance), with_twist);
        assert!(with_twist > 1.2 * without, "{with_twist} {without}");
        let [with_twist, without] = counted(&stiff, &beam);
        assert_eq!(difference(&stiff, &beam, &variance), without);
        assert!(with_twist > 1.2 * without, "{with_twist} {without}");
    }
}
