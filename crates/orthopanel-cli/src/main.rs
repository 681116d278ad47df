//! The command `orthopanel`: all of it is in the library beside it.

use std::process::ExitCode;

/// A trace takes and returns small matrices by the million, from several threads.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    ExitCode::from(orthopanel_cli::main(std::env::args_os()))
}
