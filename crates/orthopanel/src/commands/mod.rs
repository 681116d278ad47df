//! One file a command.

pub mod accelerance;
pub mod export;
pub mod identify;
pub mod modes;
pub mod run;
pub mod simulate;

use crate::arguments::Command;
use crate::error::CommandError;

pub fn execute(command: Command) -> Result<(), CommandError> {
    match command {
        Command::Run(arguments) => run::execute(&arguments),
        Command::Identify(arguments) => identify::execute(&arguments),
        Command::Modes(arguments) => modes::execute(&arguments),
        Command::Accelerance(arguments) => accelerance::execute(&arguments),
        Command::Export(arguments) => export::execute(&arguments),
        Command::Simulate(arguments) => simulate::execute(&arguments),
    }
}
