//! Panels drawn from what is known of one: constants by their standard deviations.

use orthopanel_model::{Constant, ModelError, PanelModel};

use crate::ParameterValues;

/// Draws for one constant before it is given up: its bounds then leave next to nothing of its distribution.
const TRIES: usize = 1000;

/// So many sets of the constants that have a standard deviation, each normal about its value and within its bounds, independently: a model
/// file holds no correlation. The same panel gives the same sets.
///
/// # Errors
/// [`ModelError::Constant`] for a value so far outside its bounds that a thousand draws leave none within.
pub fn parameter_samples(panel: &PanelModel, count: usize) -> Result<Vec<ParameterValues>, ModelError> {
    let mut normal = Normal { state: 0x0f1e_2d3c_4b5a_6978 };
    let known = panel.structure.constants();
    let of_panel = |normal: &mut Normal| {
        let drawn = panel.constants.iter().filter_map(|(name, estimate)| {
            let std = estimate.std.filter(|std| *std > 0.0)?;
            let constant = known.iter().find(|constant| constant.name == name)?;
            Some(normal.within(constant, estimate.value, std).map(|value| (name.clone(), value)))
        });
        drawn.collect::<Result<ParameterValues, ModelError>>()
    };
    (0..count).map(|_| of_panel(&mut normal)).collect()
}

/// Normal deviates: uniform ones by `SplitMix64` (Steele, Lea, Flood, OOPSLA 2014) through the polar method of Box and Muller.
struct Normal {
    state: u64,
}

impl Normal {
    /// In (0, 1).
    fn uniform(&mut self) -> f64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (((z ^ (z >> 31)) >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    fn next(&mut self) -> f64 {
        let (radius, angle) = ((-2.0 * self.uniform().ln()).sqrt(), std::f64::consts::TAU * self.uniform());
        radius * angle.cos()
    }

    fn within(&mut self, constant: &Constant, value: f64, std: f64) -> Result<f64, ModelError> {
        let mut draws = (0..TRIES).map(|_| value + std * self.next());
        match draws.find(|drawn| constant.check(*drawn).is_ok()) {
            Some(drawn) => Ok(drawn),
            None => constant.check(value).map(|()| value),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PANEL: &str = r#"{"schema": "orthopanel.model/1", "structure": "timoshenko-beam",
        "piece": {"length": 0.8, "width": 0.1, "thickness": 0.03, "mass_per_area": 6.88},
        "constants": {"e_x": {"value": 1.067e10, "std": 1e8}, "g_zx": 5.304e8}, "damping": {"beyond": 0.003}}"#;

    #[test]
    fn val_samples_have_the_mean_and_the_deviation() {
        let panel = PanelModel::from_json(PANEL).unwrap();
        let samples = parameter_samples(&panel, 4000).unwrap();
        assert!(samples.iter().all(|values| matches!(&values[..], [(name, _)] if name == "e_x")));
        let values: Vec<f64> = samples.iter().map(|values| (values[0].1 - 1.067e10) / 1e8).collect();
        let mean = values.iter().sum::<f64>() / 4000.0;
        let variance = values.iter().map(|value| value * value).sum::<f64>() / 4000.0 - mean * mean;
        // Five standard errors, and as many beyond one deviation as a normal distribution has.
        assert!(mean.abs() < 0.08 && (variance - 1.0).abs() < 0.11, "{mean} {variance}");
        let beyond = values.iter().filter(|value| value.abs() > 1.0).count() as f64 / 4000.0;
        assert!((beyond - 0.3173).abs() < 0.037, "{beyond}");
        assert_eq!(samples, parameter_samples(&panel, 4000).unwrap());
    }

    #[test]
    fn val_samples_stay_within_bounds() {
        let panel = PanelModel::from_json(&PANEL.replace("1e8}", "1e10}")).unwrap();
        let samples = parameter_samples(&panel, 500).unwrap();
        assert!(samples.iter().all(|values| values[0].1 > 0.0));
    }
}
