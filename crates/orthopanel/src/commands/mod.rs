//! One file a command.

pub mod accelerance;
pub mod export;
pub mod identify;
pub mod init;
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
#[command(version, propagate_version = true, max_term_width = 110)]
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
}

pub fn execute(arguments: Arguments) -> Result<(), CommandError> {
    match arguments.command {
        Command::Records(arguments) => records::execute(&arguments),
        Command::Init(arguments) => init::execute(&arguments),
        Command::Run(arguments) => run::execute(&arguments),
        Command::Identify(arguments) => identify::execute(&arguments),
        Command::Trace(arguments) => trace::execute(&arguments),
        Command::Modes(arguments) => modes::execute(&arguments),
        Command::Accelerance(arguments) => accelerance::execute(&arguments),
        Command::Export(arguments) => export::execute(&arguments),
        Command::Simulate(arguments) => simulate::execute(&arguments),
        Command::Report(arguments) => report::execute(&arguments),
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
