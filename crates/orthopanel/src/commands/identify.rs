//! `identify`: elastic constants from a test.

use std::path::{Path, PathBuf};

use orthopanel_identify::{PieceFit, Search};

use crate::error::CommandError;
use crate::identified::Identified;
use crate::output;

/// Identify the elastic constants from a test
///
/// Finds e_x and g_zx so that the model's natural frequencies meet the measured ones in the least squares of their
/// relative errors. Given are the standard deviations, the correlation, and the error of each frequency predicted
/// from all the others. With several pieces in the test, -o writes one model a piece: MODEL-NAME.json.
///
/// Example: orthopanel identify examples/piece-1/test.toml -o model.json
#[derive(clap::Args)]
#[command(verbatim_doc_comment)]
pub struct Arguments {
    /// Test file (test.toml)
    test: PathBuf,
    /// Model file to write (orthopanel.model/1, JSON)
    #[arg(short, long, value_name = "MODEL.json")]
    output: Option<PathBuf>,
    /// How to search: on exact sensitivities, or by the paper's downhill simplex
    #[arg(long, value_enum, default_value_t = SearchWord::LeastSquares)]
    search: SearchWord,
    /// Print one JSON object (orthopanel.identified/1) on standard output
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum SearchWord {
    LeastSquares,
    Simplex,
}

impl From<SearchWord> for Search {
    fn from(word: SearchWord) -> Self {
        match word {
            SearchWord::LeastSquares => Self::LeastSquares,
            SearchWord::Simplex => Self::Simplex,
        }
    }
}

pub fn execute(arguments: &Arguments) -> Result<(), CommandError> {
    let identified = Identified::from_test(&arguments.test, arguments.search.into())?;
    if let Some(path) = &arguments.output {
        let mut files = output::Files::default();
        for (fit, model) in identified.found.pieces.iter().zip(&identified.models) {
            files.add(model_path(path, &identified, fit), model.to_json());
        }
        for path in files.write()? {
            eprintln!("wrote {}", path.display());
        }
    }
    if arguments.json {
        output::print_json(&identified.answer);
    } else {
        output::print(&identified.tables());
    }
    Ok(())
}

fn model_path(path: &Path, identified: &Identified, fit: &PieceFit) -> PathBuf {
    let suffix = identified.suffix(fit);
    if suffix.is_empty() {
        return path.to_path_buf();
    }
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let extension = path.extension().map_or(String::new(), |extension| format!(".{}", extension.to_string_lossy()));
    path.with_file_name(format!("{stem}{suffix}{extension}"))
}
