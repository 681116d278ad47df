//! Panels drawn from what is known of one: constants and damping by their standard deviations and correlation.

use orthopanel_model::{Constant, ModelError, PanelModel};

use crate::ParameterValues;

/// Draws for one set before it is given up: bounds then leave next to nothing of the distribution, and the set is of the values themselves.
const TRIES: usize = 1000;

/// So many sets of the constants and damping ratios (`damping_ratio_1`, ..) that have a standard deviation: normal about their values, as correlated
/// as the model says, and within their bounds, a set at a time. The same panel gives the same sets.
///
/// # Errors
/// [`ModelError::Constant`] for a value so far outside its bounds that a thousand draws leave none within, [`ModelError::Correlation`] for what is
/// none.
pub fn parameter_samples(panel: &PanelModel, count: usize) -> Result<Vec<ParameterValues>, ModelError> {
    let mut normal = Normal { state: 0x0f1e_2d3c_4b5a_6978 };
    let known = panel.structure.constants();
    let constants = panel.constants.iter().filter_map(|(name, estimate)| {
        let constant = known.iter().find(|constant| constant.name == name);
        Some(Uncertain { name: name.clone(), value: estimate.value, std: estimate.std?, constant })
    });
    let ratios = (1..).zip(panel.damping.ratios.iter().zip(&panel.damping.std));
    let ratios = ratios.map(|(mode, (&value, &std))| Uncertain {
        name: format!("damping_ratio_{mode}"),
        value,
        std,
        constant: None,
    });
    let uncertain: Vec<Uncertain> = constants.chain(ratios).filter(|one| one.std > 0.0).collect();
    let together =
        panel.correlation.as_ref().map(|correlation| Ok((&correlation.names, correlation.factor()?))).transpose()?;
    let one = |normal: &mut Normal| -> ParameterValues {
        let joint = together.as_ref().map_or(vec![], |(names, factor)| {
            let draws: Vec<f64> = names.iter().map(|_| normal.next()).collect();
            let values = factor.iter().map(|row| row.iter().zip(&draws).map(|(share, draw)| share * draw).sum());
            names.iter().zip(values).collect::<Vec<(&String, f64)>>()
        });
        let mut drawn = |one: &Uncertain| {
            let found = joint.iter().find(|(name, _)| **name == one.name);
            (one.name.clone(), one.value + one.std * found.map_or_else(|| normal.next(), |(_, deviate)| *deviate))
        };
        uncertain.iter().map(&mut drawn).collect()
    };
    let of_panel = |normal: &mut Normal| {
        let within =
            |values: &ParameterValues| uncertain.iter().zip(values).all(|(one, (_, value))| one.check(*value).is_ok());
        let found = (0..TRIES).map(|_| one(normal)).find(within);
        found.map_or_else(
            || uncertain.iter().map(|one| one.check(one.value).map(|()| (one.name.clone(), one.value))).collect(),
            Ok,
        )
    };
    (0..count).map(|_| of_panel(&mut normal)).collect()
}

/// A constant or a damping ratio.
struct Uncertain {
    name: String,
    value: f64,
    std: f64,
    /// Its bounds; a damping ratio has none here.
    constant: Option<&'static Constant>,
}

impl Uncertain {
    fn check(&self, value: f64) -> Result<(), ModelError> {
        match self.constant {
            Some(constant) => constant.check(value),
            None if (0.0..std::f64::consts::FRAC_1_SQRT_2).contains(&value) => Ok(()),
            None => Err(ModelError::Damping { mode: 0, value }),
        }
    }
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
    fn val_samples_hang_together_as_the_model_says() {
        let text = PANEL
            .replace("5.304e8", r#"{"value": 5.304e8, "std": 4e6}"#)
            .replace(r#"{"beyond""#, r#"{"ratios": [0.01, 0.02], "std": [1e-3, 2e-3], "beyond""#);
        let with = r#""correlation": {"names": ["e_x", "damping_ratio_2", "g_zx"],
            "matrix": [[1, 0.3, -0.9], [0.3, 1, 0], [-0.9, 0, 1]]}, "damping""#;
        let panel = PanelModel::from_json(&text.replace(r#""damping""#, with)).unwrap();
        let samples = parameter_samples(&panel, 4000).unwrap();
        let names: Vec<&str> = samples[0].iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["e_x", "g_zx", "damping_ratio_1", "damping_ratio_2"]);
        let known = [(1.067e10, 1e8), (5.304e8, 4e6), (0.01, 1e-3), (0.02, 2e-3)];
        let of = |index: usize| samples.iter().map(move |values| (values[index].1 - known[index].0) / known[index].1);
        let asked = [[1.0, -0.9, 0.0, 0.3], [-0.9, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.3, 0.0, 0.0, 1.0]];
        for (i, row) in asked.iter().enumerate() {
            for (j, asked) in row.iter().enumerate() {
                let found = of(i).zip(of(j)).map(|(a, b)| a * b).sum::<f64>() / 4000.0;
                // Five standard errors of a covariance of two normal numbers, at most.
                assert!(
                    (found - asked).abs() < 5.0 * (1.0 + asked * asked).sqrt() / 4000.0_f64.sqrt(),
                    "{i} {j}: {found}"
                );
            }
        }
    }

    #[test]
    fn val_samples_stay_within_bounds() {
        let panel = PanelModel::from_json(&PANEL.replace("1e8}", "1e10}")).unwrap();
        let samples = parameter_samples(&panel, 500).unwrap();
        assert!(samples.iter().all(|values| values[0].1 > 0.0));
    }
}
