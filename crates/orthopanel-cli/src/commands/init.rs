//! `init`: a first test file from files of records.

use std::path::{Path, PathBuf};

use orthopanel::Error;
use orthopanel::outputs::Inputs;
use orthopanel_data::{RecordFile, draft};

use crate::console;
use crate::error::CommandError;
use crate::terminal::{self, Terminal};

/// Write a commented test file from files of records
///
/// What the records tell stands in it: files, kinds, channels, places of nodes. What they do not, sizes and mass first, stands in
/// comments; `orthopanel run` asks for each by its name until it is there.
///
/// Example: orthopanel init point-*.uff -o test.toml
#[derive(clap::Args)]
#[command(verbatim_doc_comment)]
pub struct Arguments {
    /// Files of records
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Test file to write; one that is there is kept
    #[arg(short, long, value_name = "TEST.toml")]
    output: PathBuf,
}

pub fn execute(arguments: &Arguments, words: &[String]) -> Result<(), CommandError> {
    let Arguments { files, output } = arguments;
    let inputs = files.iter().fold(Inputs::default(), |inputs, file| inputs.and(file));
    let mut outputs = terminal::outputs(inputs, words)?.planned(output)?;
    if output.exists() {
        // Somebody may have filled it in.
        let reason = "it is there, and may be filled in".to_owned();
        let kind = std::io::ErrorKind::AlreadyExists;
        return Err(Error::Unwritable { path: output.clone(), reason, kind }.into());
    }
    let mut read = Vec::new();
    for path in files {
        let file = RecordFile::read(path)?;
        let notes: Vec<String> = file.notes.iter().cloned().chain(file.questions()).collect();
        terminal::note(&format!("{}: ", path.display()), &notes);
        read.push((beside(path, output), file));
    }
    let drafted: Vec<(&Path, &RecordFile)> = read.iter().map(|(path, file)| (path.as_path(), file)).collect();
    outputs.add(output, draft(&drafted));
    outputs.write(&Terminal)?;
    console::say(format_args!(
        "wrote {}: fill in sizes, mass and places, then `orthopanel run {}`",
        output.display(),
        output.display()
    ));
    Ok(())
}

/// A file as a test file in another folder names it.
fn beside(file: &Path, test: &Path) -> PathBuf {
    let folder = |path: &Path| match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => std::fs::canonicalize(parent),
        _ => std::fs::canonicalize("."),
    };
    let (Ok(of_file), Ok(of_test), Some(name)) = (folder(file), folder(test), file.file_name()) else {
        return file.to_path_buf();
    };
    match of_file.strip_prefix(&of_test) {
        Ok(below) => below.join(name),
        Err(_) => of_file.join(name),
    }
}
