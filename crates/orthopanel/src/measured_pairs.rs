//! Pairs of places with measured hits: what is wrong with each hit, and how far a model is from it.

use std::ops::RangeInclusive;
use std::path::Path;

use orthopanel_data::{Hit, HitVerdict, TimeHistory};
use orthopanel_identify::{
    ForceBetweenSamples, HistorySettings, HitComparison, IdentifyError, Misfit, compare_time_history,
};
use orthopanel_model::{ModalModel, PanelModel, Place, Readable};
use serde::Serialize;

use crate::whole_accelerance::modes_up_to;
use crate::{csv_text, tables};

/// Whether a file is a test file, by its name: a test is TOML, a model JSON, an FMU an archive.
pub fn is_test_file(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"))
}

/// A place for people: `-0.3`, or `-0.3,0.02` off the centre line.
pub fn place_text(place: Place) -> String {
    let [x, y] = [place.x, place.y].map(Readable);
    if place.y == 0.0 { x.to_string() } else { format!("{x},{y}") }
}

/// What became of one hit.
#[derive(Serialize)]
pub struct ToldHit {
    /// From 1.
    hit: usize,
    pub kept: bool,
    faults: Vec<String>,
}

impl ToldHit {
    /// Faults and what became of the hit; `None` for one without fault.
    pub fn said(&self) -> Option<String> {
        let verdict = if self.kept { "kept" } else { "left out" };
        (!self.faults.is_empty()).then(|| format!("hit {} {verdict}: {}", self.hit, self.faults.join("; ")))
    }
}

/// In the order of the hits.
pub fn told(verdicts: &[HitVerdict]) -> Vec<ToldHit> {
    let told = |(index, verdict): (usize, &HitVerdict)| ToldHit {
        hit: index + 1,
        kept: verdict.is_kept(),
        faults: verdict.faults.iter().map(ToString::to_string).collect(),
    };
    verdicts.iter().enumerate().map(told).collect()
}

/// A pair of places whose measured forces drove a model.
pub struct ComparedPair {
    pub history: TimeHistory,
    /// In the order of `history.hits`, as these that follow.
    pub verdicts: Vec<HitVerdict>,
    pub hits: Vec<HitComparison>,
    /// The modes that were driven.
    pub modes: ModalModel,
    /// Static flexibility of all flexible modes \[m/N\].
    pub static_flexibility: f64,
}

impl ComparedPair {
    /// Drives `model` with every hit of `history`.
    ///
    /// Modes up to the sampling rate, twice the highest frequency of the record, and the static part of those left out:
    /// what truncation leaves is below 1e-5 of the variance (see [`compare_time_history`]).
    pub fn of(
        model: &PanelModel,
        history: TimeHistory,
        between_samples: ForceBetweenSamples,
        band: Option<RangeInclusive<f64>>,
    ) -> Result<Self, IdentifyError> {
        let (force, response) = (history.force_at, history.response_at);
        let seen = modes_up_to(model, history.rate, force, response)?;
        let all = model.static_flexibility(seen.modes().len(), &[force], &[response])?;
        let static_flexibility = all[0][0];
        let settings = HistorySettings {
            between_samples,
            static_flexibility: Some(static_flexibility),
            band,
            ..HistorySettings::default()
        };
        let hits = compare_time_history(&seen, &history, &settings)?;
        Ok(Self { verdicts: history.verdicts(), history, hits, modes: seen, static_flexibility })
    }

    /// The hit to draw: the first without a fault that spoils it, else the first.
    pub fn shown(&self) -> usize {
        self.verdicts.iter().position(HitVerdict::is_kept).unwrap_or(0)
    }

    pub fn misfits(&self) -> Vec<HitMisfit> {
        let hits = self.hits.iter().zip(told(&self.verdicts));
        let peak = |hit: &Hit| hit.force.iter().fold(0.0_f64, |peak, force| peak.max(force.abs()));
        hits.zip(&self.history.hits)
            .map(|((compared, verdict), hit)| HitMisfit {
                force: self.history.force_at,
                response: self.history.response_at,
                verdict,
                peak_force_n: peak(hit),
                whole: compared.whole.misfit.into(),
                in_band: compared.in_band.as_ref().map(|signals| signals.misfit.into()),
                exact: None,
            })
            .collect()
    }
}

/// How far the model is from one hit.
#[derive(Serialize)]
pub struct HitMisfit {
    force: Place,
    response: Place,
    #[serde(flatten)]
    verdict: ToldHit,
    pub peak_force_n: f64,
    whole: MisfitEntry,
    /// With every line outside the band of the identification taken out; `null` where there was none.
    in_band: Option<MisfitEntry>,
    /// The exact modes and stepper beside another method, and how far that is from them; left out where it is the method.
    #[serde(skip_serializing_if = "Option::is_none")]
    exact: Option<BesideExact>,
}

#[derive(Serialize)]
struct BesideExact {
    #[serde(flatten)]
    misfit: MisfitEntry,
    /// Greatest difference of both calculated accelerations.
    apart_percent_of_peak: f64,
}

impl HitMisfit {
    /// With the exact solution of the same hit beside it.
    pub fn beside_exact(self, exact: Self, apart_percent_of_peak: f64) -> Self {
        Self { exact: Some(BesideExact { misfit: exact.whole, apart_percent_of_peak }), ..self }
    }

    /// Of the calculated acceleration from the measured one, in the band where there is one \[% of its peak\].
    pub fn rms_percent(&self) -> f64 {
        self.in_band.as_ref().unwrap_or(&self.whole).rms_percent_of_peak
    }
}

/// Error against the record.
#[derive(Serialize)]
struct MisfitEntry {
    peak_m_s2: f64,
    rms_percent_of_peak: f64,
    greatest_percent_of_peak: f64,
    variance_explained: f64,
}

impl From<Misfit> for MisfitEntry {
    fn from(misfit: Misfit) -> Self {
        Self {
            peak_m_s2: misfit.peak,
            rms_percent_of_peak: misfit.rms_percent_of_peak,
            greatest_percent_of_peak: misfit.greatest_percent_of_peak,
            variance_explained: misfit.variance_explained,
        }
    }
}

/// A row a hit, and below them what is wrong with hits.
pub fn misfit_table(misfits: &[&HitMisfit]) -> String {
    let with_band = misfits.iter().any(|misfit| misfit.in_band.is_some());
    let row = |misfit: &&HitMisfit| {
        let mut row = vec![
            place_text(misfit.force),
            place_text(misfit.response),
            misfit.verdict.hit.to_string(),
            format!("{:.1}", misfit.whole.peak_m_s2),
            format!("{:.2}", Readable(misfit.whole.rms_percent_of_peak)),
            format!("{:.2}", Readable(misfit.whole.greatest_percent_of_peak)),
            format!("{:.5}", Readable(misfit.whole.variance_explained)),
        ];
        if let Some(BesideExact { misfit: exact, apart_percent_of_peak }) = &misfit.exact {
            row.push(format!("{:.2}", Readable(exact.rms_percent_of_peak)));
            row.push(format!("{:.5}", Readable(exact.variance_explained)));
            row.push(format!("{:.4}", Readable(*apart_percent_of_peak)));
        }
        if with_band {
            row.push(
                misfit
                    .in_band
                    .as_ref()
                    .map_or(String::new(), |band| format!("{:.5}", Readable(band.variance_explained))),
            );
        }
        row
    };
    let mut heading = vec![
        "force [m]",
        "response [m]",
        "hit",
        "peak [m/s2]",
        "rms [% of peak]",
        "greatest [% of peak]",
        "variance explained",
    ];
    if misfits.iter().any(|misfit| misfit.exact.is_some()) {
        heading.extend(["exact: rms [% of peak]", "variance explained", "apart [% of peak]"]);
    }
    if with_band {
        heading.push("in the band");
    }
    let mut table = tables::aligned(&heading, &misfits.iter().map(row).collect::<Vec<_>>());
    for misfit in misfits {
        if let Some(said) = misfit.verdict.said() {
            let compared =
                if misfit.verdict.kept { "" } else { " (an accelerance leaves it out; compared here all the same)" };
            table += &format!("{} to {}: {said}{compared}\n", place_text(misfit.force), place_text(misfit.response));
        }
    }
    table
}

/// Measured and calculated acceleration of every hit, one below the other.
pub fn csv(pairs: &[ComparedPair]) -> String {
    let mut columns: [Vec<f64>; 6] = Default::default();
    for (pair_index, pair) in pairs.iter().enumerate() {
        for (hit_index, (hit, compared)) in pair.history.hits.iter().zip(&pair.hits).enumerate() {
            let signals = hit.force.iter().zip(&compared.whole.measured).zip(&compared.whole.calculated);
            for (sample, ((&force, &measured), &calculated)) in signals.enumerate() {
                let time = sample as f64 / pair.history.rate;
                let row = [(pair_index + 1) as f64, (hit_index + 1) as f64, time, force, measured, calculated];
                columns.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
            }
        }
    }
    let names = ["pair", "hit", "time_s", "force_n", "measured_m_s2", "calculated_m_s2"].map(String::from);
    csv_text::csv(&names, &columns.each_ref().map(Vec::as_slice))
}
