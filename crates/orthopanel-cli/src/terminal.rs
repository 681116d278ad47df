//! What the facade tells, on the terminal, and where its results go.

use orthopanel::outputs::{Inputs, Outputs, fed_by_stdout};
use orthopanel::{Observer, Steps, Work};

use crate::error::CommandError;
use crate::{console, progress};

/// Hears for the one who sits before standard error.
pub struct Terminal;

impl Observer for Terminal {
    fn say(&self, message: &str) {
        console::say(message);
    }

    fn begin(&self, work: &'static str, steps: Steps) -> Box<dyn Work + '_> {
        Box::new(match steps {
            Steps::Unknown => progress::spinner(work),
            Steps::Of(count) => progress::bar(work, count),
            Steps::Named => progress::counted(work),
        })
    }
}

/// The outputs of a command of these `words` that reads `inputs`.
///
/// # Errors
/// [`CommandError::InputIsAnswer`] where standard output goes to one of them.
pub fn outputs(inputs: Inputs, words: &[String]) -> Result<Outputs, CommandError> {
    if let Some(input) = fed_by_stdout(inputs.paths()) {
        return Err(CommandError::InputIsAnswer { input: input.into() });
    }
    Ok(Outputs::of(inputs).by(words.to_vec()))
}

/// Says each note once, with how often it was made, behind `about`.
pub fn note(about: &str, notes: &[String]) {
    orthopanel::notes::note(&Terminal, about, notes);
}
