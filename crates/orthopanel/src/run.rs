//! The whole way from a test to models, FMUs, a response, pictures and a page, in one folder.

use std::path::{Path, PathBuf};

use orthopanel_data::ImpactTest;
use orthopanel_export::{FmiVersion, Fmu, FmuOptions};
use orthopanel_identify::{Settings, Tracing};
use orthopanel_model::{ModeRange, ModelError, PanelModel};
use serde::Serialize;

use crate::analysis::{Analysis, Found};
use crate::driving_force::DrivingForce;
use crate::driving_force::Hold;
use crate::error::InFile as _;
use crate::evidence::PieceEvidence;
use crate::force_file::ForceHistory;
use crate::identified::Answer;
use crate::measured_pairs::{HitMisfit, misfit_table};
use crate::observer::{Observer, Steps};
use crate::outputs::{self, Inputs, Outputs};
use crate::provenance::{Provenance, WithProvenance};
use crate::suffixes::suffixes;
use crate::time_response;
use crate::{Error, Silent, Test, json, pictures};

/// How many modes go into an FMU or a simulation, beside the rigid ones, unless said.
///
/// Twenty reach past 16 kHz on the paper's thin pieces, four times the band of their hammer.
pub const USUAL_MODES: ModeRange = ModeRange::Count(20);

/// Lists the results in the folder, with the command, the version and the inputs they are of.
const MANIFEST: &str = "manifest.json";

impl Test {
    /// Does all of it: identifies the panel, traces what its model lacks, makes its FMUs, simulates a hit and draws the result; the
    /// files go into `folder`, all of them or none.
    ///
    /// # Errors
    /// As [`Test::identify`] and [`Test::trace`]; [`Error::Unwritable`].
    ///
    /// # Examples
    /// ```
    /// let folder = tempfile::tempdir().unwrap();
    /// let run = orthopanel::Test::load("../../examples/piece-1/test.toml")?.run(folder.path())?;
    /// assert!(run.files().iter().any(|file| file.ends_with("panel.fmu")));
    /// # Ok::<(), orthopanel::Error>(())
    /// ```
    pub fn run(&self, folder: impl AsRef<Path>) -> Result<Run, Error> {
        let own = ImpactTest::file_at(self.path());
        let own = if own.is_file() { Inputs::of(&own) } else { Inputs::default() };
        let files = self.content().files().fold(own, Inputs::and);
        PlannedRun::new(self, Outputs::of(files), folder.as_ref())?.run(None, Settings::default(), &Silent)
    }
}

/// A run whose results are known to have a place.
pub struct PlannedRun<'a> {
    test: &'a Test,
    files: Outputs,
    /// Whether the folder holds results of an earlier run.
    holds_earlier: bool,
}

/// What a run did.
pub struct Run {
    analysis: Analysis,
    provenance: Provenance,
    /// How far the base model is from every measured hit.
    hits: Vec<HitMisfit>,
    files: Vec<PathBuf>,
}

#[derive(Serialize)]
struct HitsAnswer<'a> {
    schema: &'static str,
    hits: &'a [HitMisfit],
}

/// Whether `folder` holds results of an earlier run.
pub fn holds_results(folder: &Path) -> bool {
    outputs::lists_results(&folder.join(MANIFEST))
}

impl<'a> PlannedRun<'a> {
    /// # Errors
    /// As [`Outputs::planned`], of every result that the test may have.
    pub fn new(test: &'a Test, files: Outputs, folder: &Path) -> Result<Self, Error> {
        let holds_earlier = holds_results(folder);
        let files = files.filling(folder, MANIFEST).planned_inside(names(test))?;
        Ok(Self { test, files, holds_earlier })
    }

    /// # Errors
    /// As [`Analysis::of`]; then the folder is as it was.
    pub fn run(self, reference: Option<&Test>, settings: Settings, observer: &dyn Observer) -> Result<Run, Error> {
        let Self { test, mut files, holds_earlier } = self;
        let analysis = Analysis::of(test, reference, settings, observer)?;
        let explains = analysis.traced().is_ok_and(|traced| traced.explains());
        // A run that finds no model leaves the results of an earlier one as they are.
        if matches!(analysis.found, Found::Contradicted { .. }) && !explains && holds_earlier {
            let provenance = Provenance::of(test, files.inputs())?;
            return Ok(Run { analysis, provenance, hits: vec![], files: vec![] });
        }
        let evidence = analysis.evidence(observer)?;
        let page = analysis.page_of(&evidence)?;
        let provenance = Provenance::of(test, files.inputs())?;
        let hits = match &analysis.found {
            Found::Identified { identified, .. } => {
                files.add_inside("identified.json", identified.to_json_with(&provenance));
                files.add_inside("report.html", page);
                for ((fit, model), shown) in
                    identified.found.pieces.iter().zip(&analysis.panels()).zip(&evidence.pieces)
                {
                    let suffix = identified.suffix(fit);
                    add_model(&mut files, test.path(), &suffix, model, observer)?;
                    add_pictures(&mut files, &suffix, shown);
                }
                if let Ok(traced) = analysis.traced() {
                    files.add_inside("trace.json", traced.to_json_with(&provenance));
                }
                evidence.into_hits()
            }
            Found::Contradicted { traced, .. } => {
                files.add_inside("trace.json", traced.to_json_with(&provenance));
                files.add_inside("report.html", page);
                for (suffix, model) in suffixes(test.content()).zip(&analysis.panels()) {
                    add_model(&mut files, test.path(), &suffix, model, observer)?;
                }
                vec![]
            }
        };
        if !hits.is_empty() {
            let answer = HitsAnswer { schema: "orthopanel.simulated-hits/1", hits: &hits };
            files.add_inside("time-histories.json", json::line(&answer));
        }
        let files = files.write(observer)?;
        Ok(Run { analysis, provenance, hits, files })
    }
}

#[derive(Serialize)]
struct RunAnswer<'a> {
    schema: &'static str,
    /// `null` where the records contradict a beam, and only the trace tells what they are of.
    identified: Option<WithProvenance<'a, Answer>>,
    /// `null` where the test cannot be traced.
    trace: Option<WithProvenance<'a, Tracing>>,
    /// Why it cannot.
    #[serde(skip_serializing_if = "Option::is_none")]
    not_traced: Option<&'a str>,
    /// One entry a measured hit.
    hits: &'a [HitMisfit],
    files: &'a [PathBuf],
}

impl Run {
    /// What was identified and traced.
    pub fn analysis(&self) -> &Analysis {
        &self.analysis
    }

    /// What was written.
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// One JSON object (`orthopanel.run/1`) on one line.
    pub fn to_json(&self) -> String {
        let provenance = &self.provenance;
        json::line(&RunAnswer {
            schema: "orthopanel.run/1",
            identified: self.analysis.identified().map(|of| WithProvenance { answer: &of.answer, provenance }),
            trace: self.analysis.traced().ok().map(|of| WithProvenance { answer: &of.tracing, provenance }),
            not_traced: self.analysis.traced().err(),
            hits: &self.hits,
            files: &self.files,
        })
    }

    /// For people.
    pub fn text(&self) -> String {
        let traced = self.analysis.traced();
        let Some(identified) = self.analysis.identified() else {
            return traced.map_or(String::new(), |traced| traced.text());
        };
        let has_effects = traced.is_ok_and(|traced| !traced.tracing.effects.is_empty());
        let mut text = if has_effects { "the base model, before effects\n".to_owned() } else { String::new() };
        text += &identified.text();
        text += &match traced {
            Ok(traced) => format!("\n{}", traced.text()),
            Err(why) => format!("\n{why}\n"),
        };
        if !self.hits.is_empty() {
            let model = if has_effects { "the base model, before effects," } else { "the model" };
            let table = misfit_table(&self.hits.iter().collect::<Vec<_>>());
            text += &format!("\nmeasured hits, and {model} driven by their forces\n{table}");
        }
        text
    }

    /// Where the base model was refused and the trace explains nothing, the refusal stands.
    ///
    /// # Errors
    /// That refusal.
    pub fn end(self) -> Result<(), Error> {
        self.analysis.end()
    }
}

/// Every name that a result of the test may have.
fn names(test: &Test) -> Vec<String> {
    let test = test.content();
    let of_test = ["identified.json", "report.html", "trace.json", "time-histories.json"].map(String::from);
    let of_piece = |suffix: String| {
        let named = [
            format!("model{suffix}.json"),
            format!("panel{suffix}.fmu"),
            format!("panel{suffix}-fmi3.fmu"),
            format!("response{suffix}.csv"),
            format!("response{suffix}.svg"),
            format!("frequencies{suffix}.svg"),
            format!("coherence{suffix}.svg"),
        ];
        let pairs = test.measurements.len();
        let numbers = (0..pairs).map(|index| numbered(index, pairs)).chain([numbered(0, 1)]);
        let of_pairs = ["accelerance", "time-history", "cut"];
        let pictures: Vec<_> =
            numbers.flat_map(|number| of_pairs.map(|name| format!("{name}{suffix}{number}.svg"))).collect();
        named.into_iter().chain(pictures)
    };
    of_test.into_iter().chain(suffixes(test).flat_map(of_piece)).collect()
}

/// Model, FMUs and a simulated hit of one piece.
fn add_model(
    files: &mut Outputs,
    test: &Path,
    suffix: &str,
    model: &PanelModel,
    observer: &dyn Observer,
) -> Result<(), Error> {
    files.add_inside(&format!("model{suffix}.json"), model.to_json());
    let ports = &model.ports;
    let seen = match time_response::seen(model, USUAL_MODES, ports) {
        // The trace may find what has no modes; the model file holds it all the same.
        Err(ModelError::Unsupported(what)) if !model.effects.is_empty() => {
            observer.say(&format!(
                "no FMU and no simulated hit: {what} is not supported by this version; model{suffix}.json holds it"
            ));
            return Ok(());
        }
        seen => seen.in_file(test)?,
    };
    let _shown = observer.begin("making the FMUs", Steps::Unknown);
    for (version, ending) in [(FmiVersion::Fmi2, ""), (FmiVersion::Fmi3, "-fmi3")] {
        let options = FmuOptions { name: fmu_name(model, suffix), version, ..FmuOptions::default() };
        let fmu = Fmu::of_panel(model, USUAL_MODES, ports.clone(), &options)?;
        files.add_inside(&format!("panel{suffix}{ending}.fmu"), fmu.to_bytes()?);
    }
    let hit = DrivingForce::new(ForceHistory::half_sine(ports.forces.len()), Hold::Linear, test, observer)?;
    let motions = time_response::simulate(&seen.modes, &hit).in_file(test)?;
    let hit = hit.samples;
    files.add_inside(&format!("response{suffix}.csv"), time_response::csv(&hit, &motions));
    files.add_inside(&format!("response{suffix}.svg"), pictures::response(&hit, &motions)?);
    Ok(())
}

/// The model's own, or what the file is called, with `_` for what no name has: each piece's FMU has another.
fn fmu_name(model: &PanelModel, suffix: &str) -> String {
    let of_file = || format!("panel{suffix}").replace(|other: char| !other.is_ascii_alphanumeric(), "_");
    model.name.clone().unwrap_or_else(of_file)
}

fn add_pictures(files: &mut Outputs, suffix: &str, shown: &PieceEvidence) {
    for (name, picture) in [("frequencies", &shown.frequencies), ("coherence", &shown.coherence)] {
        if let Some(picture) = picture {
            files.add_inside(&format!("{name}{suffix}.svg"), picture.as_str());
        }
    }
    let of_pairs =
        [("accelerance", &shown.accelerances), ("time-history", &shown.time_histories), ("cut", &shown.cuts)];
    for (name, pictures) in of_pairs {
        for (index, picture) in pictures.iter().enumerate() {
            files.add_inside(&format!("{name}{suffix}{}.svg", numbered(index, pictures.len())), picture.as_str());
        }
    }
}

/// `-NUMBER` from 1 where there are several.
fn numbered(index: usize, of: usize) -> String {
    if of == 1 { String::new() } else { format!("-{}", index + 1) }
}
