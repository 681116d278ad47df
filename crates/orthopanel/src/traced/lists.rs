//! The model with the effects beside lists of natural frequencies.

use orthopanel_data::{ImpactTest, MeasurementData};
use orthopanel_identify::{PieceFit, TracedEffect};
use orthopanel_model::{
    EffectEntry, EffectSetting, EffectState, ModeRange, ModelError, Owner, PanelModel, RecordSetting, StructureKind,
    natural_frequencies,
};

use super::Traced;

/// A plate's modes are looked for up to this part of the highest frequency measured.
const BEYOND: f64 = 1.25;
/// By so much of itself the error may differ from the trace's own,
const ALIKE: f64 = 0.02;
/// and by what a trace's own modes may miss, five times \[%\].
const MISSED: f64 = 1e-3;

impl Traced {
    /// Natural frequencies \[Hz\] of the model with the effects, those of the rig too, for every mode of each piece's
    /// fit; `None` where no effect was found, where records were traced and not lists, and where the error is not that which
    /// the trace tells, as with declared effects of the rig.
    pub(crate) fn frequencies(&self, test: &ImpactTest, pieces: &[PieceFit]) -> Option<Vec<Vec<f64>>> {
        let panels = self.panels().filter(|panels| panels.len() == pieces.len())?;
        if !self.tracing.accelerances.is_empty() {
            return None;
        }
        let found = pieces.iter().zip(panels).enumerate();
        let found: Option<Vec<Vec<f64>>> =
            found.map(|(index, (fit, panel))| self.of_piece(test, index, fit, panel)).collect();
        let found = found?;
        let modes = pieces.iter().flat_map(|fit| &fit.modes).zip(found.iter().flatten());
        let errors: Vec<f64> = modes.map(|(mode, model)| 100.0 * (model / mode.measured - 1.0)).collect();
        let rms = (errors.iter().map(|error| error * error).sum::<f64>() / errors.len().max(1) as f64).sqrt();
        let told = self.tracing.error.after.fitted;
        ((rms - told).abs() <= ALIKE * told + MISSED).then_some(found)
    }

    fn of_piece(&self, test: &ImpactTest, index: usize, fit: &PieceFit, panel: &PanelModel) -> Option<Vec<f64>> {
        if fit.modes.is_empty() {
            return Some(vec![]);
        }
        if panel.structure == StructureKind::MindlinPlate {
            return of_plate(fit, panel);
        }
        let rig = self.tracing.effects.iter().filter(|effect| effect.owner != Owner::Panel);
        let entries: Vec<EffectEntry> = panel.effects.iter().cloned().chain(rig.map(entry)).collect();
        let effects: Result<Vec<EffectState>, ModelError> = entries.iter().map(EffectState::from_entry).collect();
        let response_at = test.measurements.iter().filter(|of| of.piece == index).find_map(|of| match &of.data {
            MeasurementData::NaturalFrequencies(list) => list.response_at,
            _ => None,
        });
        let setting = EffectSetting {
            piece: panel.piece,
            boundary: panel.boundary,
            suspension: test.suspension.clone(),
            record: RecordSetting { number: 1, response_at, ..RecordSetting::default() },
        };
        let values = ["e_x", "g_zx"].map(|name| panel.constants.get(name).map(|constant| constant.value));
        let values: Vec<f64> = values.into_iter().collect::<Option<_>>()?;
        let last = fit.modes.iter().map(|mode| mode.mode).max()?;
        let found = natural_frequencies(&setting, &values, &effects.ok()?, last).ok()?;
        fit.modes.iter().map(|mode| found.get(mode.mode.checked_sub(1)?).copied()).collect()
    }
}

/// A plate has modes between those of a beam, which nodal lines tell.
fn of_plate(fit: &PieceFit, panel: &PanelModel) -> Option<Vec<f64>> {
    let highest = fit.modes.iter().map(|mode| mode.measured).fold(0.0, f64::max);
    let modes = panel.modes(ModeRange::UpTo(BEYOND * highest)).ok()?;
    let of = |nodes: [usize; 2]| modes.iter().find(|mode| !mode.is_rigid() && mode.nodes() == nodes);
    fit.modes.iter().map(|mode| Some(of(mode.nodes)?.frequency())).collect()
}

fn entry(effect: &TracedEffect) -> EffectEntry {
    let values = effect.parameters.iter().filter_map(|of| Some((of.name.to_owned(), *of.values.first()?)));
    EffectEntry { id: effect.id.to_owned(), owner: effect.owner.name().to_owned(), parameters: values.collect() }
}
