//! From a model file to an FMU through the library: `export MODEL -o X.fmu [--fmi 2|3] [--modes N]
//! [--force X[,Y]].. [--response X[,Y]]..`, the same words as the command `orthopanel`.
#![allow(clippy::print_stderr)]

use std::error::Error;
use std::path::Path;

use orthopanel_export::{FmiVersion, Fmu, FmuOptions};
use orthopanel_model::{ModeRange, PanelModel, Place};

fn main() -> Result<(), Box<dyn Error>> {
    let words = std::env::args().skip(1).filter(|word| word != "export");
    // `--force=X` is `--force X`: a value that begins with a minus sign reads better so.
    let words: Vec<String> = words.flat_map(|word| word.splitn(2, '=').map(String::from).collect::<Vec<_>>()).collect();
    let mut words = words.into_iter();
    let model_file = words.next().ok_or("usage: export MODEL -o X.fmu ...")?;
    let panel = PanelModel::from_json(&std::fs::read_to_string(&model_file)?)?;
    let (mut output, mut range, mut options) = (None, ModeRange::Count(6), FmuOptions::default());
    let mut ports = orthopanel_model::Ports::default();
    while let Some(key) = words.next() {
        let value = words.next().ok_or_else(|| format!("{key} needs a value"))?;
        match key.as_str() {
            "-o" => output = Some(value),
            "--fmi" => options.version = if value == "3" { FmiVersion::Fmi3 } else { FmiVersion::Fmi2 },
            "--modes" => range = ModeRange::Count(value.parse()?),
            "--force" => ports.forces.push(place(&value)?),
            "--response" => ports.responses.push(place(&value)?),
            other => return Err(format!("{other}: no such option").into()),
        }
    }
    if ports.forces.is_empty() {
        ports.forces.clone_from(&panel.ports.forces);
    }
    if ports.responses.is_empty() {
        ports.responses.clone_from(&panel.ports.responses);
    }
    let output = output.ok_or("-o X.fmu is missing")?;
    Fmu::of_panel(&panel, range, ports, &options)?.write(Path::new(&output))?;
    eprintln!("wrote {output}");
    Ok(())
}

fn place(text: &str) -> Result<Place, std::num::ParseFloatError> {
    let (x, y) = text.split_once(',').unwrap_or((text, "0"));
    Ok(Place { x: x.parse()?, y: y.parse()? })
}
