//! What every test by hand has beside what it is made for: no effect to be named, and in no catalogue.

use super::{Action, ChannelFactor, Effect, EffectParameter, EffectSetting, FieldTerm, Owner, Shift};
use crate::ModelError;

#[derive(Debug, Clone, Copy)]
struct Roughness;

/// Waves of the core, the highest of as many half-waves over the length. A mode of $m$ half-waves feels one of $2m$, and $m$ and
/// $n$ are mixed by those of $m \pm n$.
pub const CORE_WAVES: usize = 20;

static ROUGHNESS: Roughness = Roughness;

/// Roughness of a test: each record's force place is an `offset` \[m\] beside the one written down, each record has a
/// `gain` \[1\] of its own, and the core's shear stiffness is uneven by [`CORE_WAVES`] cosines, see
/// [`crate::BeamTerms::core_waves`] (not in a plate, which stays even).
///
/// None of these is to be found for its own sake: a search gives each a distribution beforehand, about no roughness. The
/// bounds are ten times what a test by hand has.
pub fn roughness() -> &'static dyn Effect {
    &ROUGHNESS
}

const OFFSET: EffectParameter = EffectParameter::linear("offset", "m", [-0.02, 0.02], &[0.0]).in_each_record();
const GAIN: EffectParameter = EffectParameter::log("gain", "1", [0.8, 1.25], &[1.0]).in_each_record();
const WAVE: EffectParameter = EffectParameter::linear("wave", "1", [-0.045, 0.045], &[0.0]);

const PARAMETERS: [EffectParameter; 2 + CORE_WAVES] = {
    let mut all = [WAVE; 2 + CORE_WAVES];
    (all[0], all[1]) = (OFFSET, GAIN);
    all
};

impl Effect for Roughness {
    fn id(&self) -> &'static str {
        "roughness"
    }

    fn owner(&self) -> Owner {
        Owner::Channel
    }

    fn parameters(&self) -> &'static [EffectParameter] {
        &PARAMETERS
    }

    fn act(&self, values: &[f64], setting: &EffectSetting) -> Result<Vec<Action>, ModelError> {
        self.check(values, &setting.piece)?;
        let [offset, gain, waves @ ..] = values else { return Ok(vec![]) };
        let mut actions = Vec::new();
        if !setting.record.is_reaction {
            actions.push(Action::Place(Shift { of_response: false, offset: *offset, parameter: 0 }));
        }
        actions.push(Action::Channel(ChannelFactor::Gain { gain: *gain }, vec![1]));
        let wave = |(number, &amplitude): (usize, &f64)| {
            Action::Field(FieldTerm::CoreWave(number, amplitude), vec![2 + number])
        };
        actions.extend(waves.iter().enumerate().map(wave));
        Ok(actions)
    }
}
