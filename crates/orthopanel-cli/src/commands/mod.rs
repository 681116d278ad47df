//! One file a command.

pub mod accelerance;
pub mod batch;
pub mod export;
pub mod identify;
pub mod init;
pub mod lot;
pub mod modes;
pub mod records;
pub mod report;
pub mod run;
pub mod simulate;
pub mod trace;

use clap::{Parser, Subcommand};

use crate::error::CommandError;

/// From a hammer test of a honeycomb sandwich panel to its elastic constants and an FMU.
///
/// Units are SI; x and y are counted from the piece's centre, force and motion positive along +z.
/// Exit status: 0 done, 1 the data or the model says no, 2 bad usage or input.
#[derive(Parser)]
#[command(name = "orthopanel", version, propagate_version = true, max_term_width = 110)]
pub struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Records(records::Arguments),
    Init(init::Arguments),
    Run(run::Arguments),
    Identify(identify::Arguments),
    Trace(trace::Arguments),
    Modes(modes::Arguments),
    Accelerance(accelerance::Arguments),
    Export(export::Arguments),
    Simulate(simulate::Arguments),
    Report(report::Arguments),
    Batch(batch::Arguments),
    Lot(lot::Arguments),
}

/// `words` are those after the program's name, for a manifest.
pub fn execute(arguments: Arguments, words: &[String]) -> Result<(), CommandError> {
    match arguments.command {
        Command::Records(arguments) => records::execute(&arguments),
        Command::Init(arguments) => init::execute(&arguments, words),
        Command::Run(arguments) => run::execute(&arguments, words),
        Command::Identify(arguments) => identify::execute(&arguments, words),
        Command::Trace(arguments) => trace::execute(&arguments, words),
        Command::Modes(arguments) => modes::execute(&arguments, words),
        Command::Accelerance(arguments) => accelerance::execute(&arguments, words),
        Command::Export(arguments) => export::execute(&arguments, words),
        Command::Simulate(arguments) => simulate::execute(&arguments, words),
        Command::Report(arguments) => report::execute(&arguments, words),
        Command::Batch(arguments) => batch::execute(&arguments, words),
        Command::Lot(arguments) => lot::execute(&arguments, words),
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    use super::*;

    #[test]
    fn arguments_are_consistent() {
        Arguments::command().debug_assert();
    }
}
