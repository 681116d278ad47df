//! Python beside a benchmark: makers of test data, and peers.

use std::path::{Path, PathBuf};
use std::process::Command;

/// Standard output of a command that went well; else the last line it complained with.
pub fn answer_of(mut command: Command) -> Result<Vec<u8>, String> {
    let output = command.output().map_err(|error| error.to_string())?;
    if output.status.success() {
        return Ok(output.stdout);
    }
    let message = String::from_utf8_lossy(&output.stderr);
    Err(message.lines().last().unwrap_or("no message").to_owned())
}

pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

pub fn python() -> PathBuf {
    let own = root().join(".venv/bin/python");
    let named = std::env::var_os("ORTHOPANEL_PYTHON").map(PathBuf::from);
    named.unwrap_or_else(|| if own.exists() { own } else { PathBuf::from("python3") })
}
