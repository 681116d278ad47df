//! The base model with declared effects, from lists of natural frequencies.

use orthopanel_data::ImpactTest;
use orthopanel_model::StructureKind;

use super::hypothesis::Hypothesis;
use super::list_fit::fit;
use super::list_problem::ListProblem;
use super::repeats::without_repeats;
use super::seen::only_seen;
use super::traced_effects::effects_of;
use crate::frequency_fit::identified_constants;
use crate::structures::bending_nodes;
use crate::{Identification, IdentifyError, ModeFit, PieceFit};

/// Constants, and what the test file leaves open of the declared effects.
///
/// # Errors
/// As [`Hypothesis::declared`] and [`fit`].
pub(crate) fn identify_lists(test: &ImpactTest) -> Result<Identification, IdentifyError> {
    let declared = Hypothesis::declared(test)?;
    let (test, mut notes) = without_repeats(test);
    let test = &test;
    let problem = ListProblem::of(test)?;
    let (declared, held) = only_seen(&problem, &problem.usual(), declared)?;
    notes.extend(held);
    let found = fit(&problem, &declared, &problem.usual())?;
    let (constants, _) = found.parameters.split_at(problem.constants.count());
    problem.constants.refuse_bounds(constants)?;
    let std: Vec<Option<f64>> = found.std.iter().map(|std| Some(*std).filter(|std| std.is_finite())).collect();
    let (of_constants, of_effects) = std.split_at(constants.len());
    let mut pieces: Vec<PieceFit> = test.pieces.iter().map(PieceFit::of).collect();
    let mut errors = found.residuals.iter();
    for list in &problem.lists {
        let nodes = bending_nodes(test.boundary, list.measured.len());
        let modes = (0..).zip(list.measured.iter().zip(nodes)).zip(errors.by_ref());
        pieces[list.piece].modes.extend(modes.map(|((index, (&measured, nodes)), error)| ModeFit {
            mode: index + 1,
            nodes,
            measured,
            measured_std: list.rounding.get(index).map(|std| std * measured),
            model: measured * (1.0 + error),
            damping: None,
        }));
    }
    Ok(Identification {
        question: None,
        common_gain: None,
        structure: StructureKind::TimoshenkoBeam,
        constants: identified_constants(test, &problem.constants, constants, of_constants),
        not_identified: vec![],
        correlations: vec![],
        pieces,
        frequency_rms_percent: found.percent(),
        left_one_out_percent: (problem.count() > found.size).then(|| found.left_out_percent()),
        accelerance_rms_percent: None,
        chi_square: None,
        accelerances: vec![],
        effects: effects_of(&found.hypothesis, of_effects),
        notes,
    })
}
