//! Values of an FMU's parameters, drawn from what is known of its panel.

use orthopanel_model::{ModelError, PanelModel};

use crate::ParameterValues;

/// Where the draws begin: the same panel gives the same sets.
const SEED: u64 = 0x0f1e_2d3c_4b5a_6978;

/// So many sets of the constants and damping ratios that have a standard deviation, by the names of the FMU's parameters, drawn by
/// [`PanelModel::draws`] with the model's correlation. The same panel gives the same sets.
///
/// # Errors
/// As [`PanelModel::draws`].
pub fn parameter_samples(panel: &PanelModel, count: usize) -> Result<Vec<ParameterValues>, ModelError> {
    let is_uncertain = |std: Option<f64>| std.is_some_and(|std| std > 0.0);
    let names: Vec<&String> =
        panel.constants.iter().filter(|(_, estimate)| is_uncertain(estimate.std)).map(|(name, _)| name).collect();
    let ratios: Vec<usize> =
        (0..panel.damping.std.len()).filter(|&mode| is_uncertain(panel.damping.std[mode])).collect();
    let values = |drawn: &PanelModel| {
        let constants = names.iter().filter_map(|name| Some(((*name).clone(), drawn.constants.get(*name)?.value)));
        let ratio = |mode: &usize| Some((format!("damping_ratio_{}", mode + 1), *drawn.damping.ratios.get(*mode)?));
        constants.chain(ratios.iter().filter_map(ratio)).collect()
    };
    Ok(panel.draws(count, SEED)?.iter().map(values).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_samples_are_the_draws_by_name() {
        let text = r#"{"schema": "orthopanel.model/1", "structure": "timoshenko-beam",
            "piece": {"length": 0.8, "width": 0.1, "thickness": 0.03, "mass_per_area": 6.88},
            "constants": {"e_x": {"value": 1.067e10, "std": 1e8}, "g_zx": 5.304e8},
            "damping": {"ratios": [0.002, 0.003], "std": [null, 3e-4], "beyond": 0.003}}"#;
        let panel = PanelModel::from_json(text).unwrap();
        let samples = parameter_samples(&panel, 20).unwrap();
        let draws = panel.draws(20, SEED).unwrap();
        for (values, drawn) in samples.iter().zip(&draws) {
            let due = [("e_x", drawn.constants["e_x"].value), ("damping_ratio_2", drawn.damping.ratios[1])];
            assert_eq!(*values, due.map(|(name, value)| (name.to_owned(), value)));
        }
        assert_ne!(samples[0], samples[1]);
        assert_eq!(samples, parameter_samples(&panel, 20).unwrap());
    }
}
