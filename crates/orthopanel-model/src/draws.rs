//! Panels drawn from what is known of one.

use crate::correlation::{damping_ratio_name, factor};
use crate::{Constant, Estimate, ModelError, PanelModel, StructureKind};

/// Draws for one panel before it is given up: bounds then leave next to nothing of the distribution.
const TRIES: usize = 1000;

/// What has a standard deviation.
enum Uncertain<'a> {
    /// A constant: normal about its value.
    Constant(&'static Constant, Estimate),
    /// The damping ratio of a flexible mode, from 0: its logarithm is normal.
    Ratio(usize, &'a f64, f64),
}

impl Uncertain<'_> {
    fn name(&self) -> String {
        match self {
            Self::Constant(constant, _) => constant.name.to_owned(),
            Self::Ratio(index, ..) => damping_ratio_name(index + 1),
        }
    }
}

impl PanelModel {
    /// So many panels, each with constants and damping ratios drawn by their standard deviations and
    /// [correlation](PanelModel::correlation), within the bounds of constants and with a definite law; without deviations of their own.
    ///
    /// A constant is normal about its value, $c_i = \bar c_i + \sigma_i\sum_jL_{ij}z_j$ with $\rho = LL^T$ and independent normal $z$; so is
    /// the logarithm of a damping ratio, $\ln\zeta_i = \ln\bar\zeta_i + \sigma_i/\bar\zeta_i\sum_jL_{ij}z_j$. One panel and seed give the same draws.
    ///
    /// # Errors
    /// [`ModelError::Correlation`] as of a model file; [`ModelError::Constant`], [`ModelError::IndefiniteLaw`] or [`ModelError::Damping`] for
    /// values so far outside their bounds that of a thousand draws none lies within.
    pub fn draws(&self, count: usize, seed: u64) -> Result<Vec<Self>, ModelError> {
        self.check_correlation()?;
        let uncertain = self.uncertain();
        let names: Vec<String> = uncertain.iter().map(Uncertain::name).collect();
        let correlation = |(i, a): (usize, &String), (j, b): (usize, &String)| match &self.correlation {
            _ if i == j => 1.0,
            Some(matrix) => matrix.of(a, b),
            None => 0.0,
        };
        let row = |a| names.iter().enumerate().map(|b| correlation(a, b)).collect::<Vec<f64>>();
        let matrix: Vec<Vec<f64>> = names.iter().enumerate().map(row).collect();
        let lower = factor(&matrix)
            .ok_or(ModelError::Correlation { problem: "matrix is not positive semi-definite".into() })?;
        let mut normal = Normal { state: seed };
        let certain = {
            let mut panel = self.clone();
            panel.correlation = None;
            panel.damping.std.clear();
            panel.constants.values_mut().for_each(|estimate| estimate.std = None);
            panel
        };
        (0..count).map(|_| certain.drawn(&uncertain, &lower, &mut normal)).collect()
    }

    /// Constants in the structure's order, then damping ratios.
    fn uncertain(&self) -> Vec<Uncertain<'_>> {
        let known = self.structure.constants().iter();
        let constants = known.filter_map(|constant| {
            let estimate = self.constants.get(constant.name)?;
            estimate.std.filter(|std| *std > 0.0).map(|_| Uncertain::Constant(constant, *estimate))
        });
        let ratios = self.damping.ratios.iter().zip(&self.damping.std).enumerate();
        let ratios = ratios.filter_map(|(index, (ratio, std))| {
            std.filter(|std| *std > 0.0 && *ratio > 0.0).map(|std| Uncertain::Ratio(index, ratio, std))
        });
        constants.chain(ratios).collect()
    }

    fn drawn(&self, uncertain: &[Uncertain], lower: &[Vec<f64>], normal: &mut Normal) -> Result<Self, ModelError> {
        let mut refused = Ok(());
        for _ in 0..TRIES {
            let mut panel = self.clone();
            let z: Vec<f64> = uncertain.iter().map(|_| normal.next()).collect();
            for (of, row) in uncertain.iter().zip(lower) {
                let by: f64 = row.iter().zip(&z).map(|(part, z)| part * z).sum();
                match of {
                    Uncertain::Constant(constant, Estimate { value, std }) => {
                        let value = value + std.unwrap_or(0.0) * by;
                        panel.constants.insert(constant.name.to_owned(), Estimate { value, std: None });
                    }
                    Uncertain::Ratio(index, ratio, std) => {
                        panel.damping.ratios[*index] = **ratio * (std / **ratio * by).exp()
                    }
                }
            }
            match panel.is_possible() {
                Ok(()) => return Ok(panel),
                error => refused = error,
            }
        }
        refused.map(|()| self.clone())
    }

    /// Whether constants lie within their bounds, the law is definite, and damping ratios are those of modes.
    fn is_possible(&self) -> Result<(), ModelError> {
        for constant in self.structure.constants() {
            self.constants.get(constant.name).map_or(Ok(()), |estimate| constant.check(estimate.value))?;
        }
        let value = |name: &str| self.constants.get(name).map(|estimate| estimate.value);
        if let (StructureKind::MindlinPlate, Some(e_x), Some(e_y), Some(nu_xy)) =
            (self.structure, value("e_x"), value("e_y"), value("nu_xy"))
        {
            let limit = (e_x / e_y).sqrt();
            if nu_xy >= limit {
                return Err(ModelError::IndefiniteLaw { e_x, e_y, nu_xy, limit });
            }
        }
        self.damping.check()
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
        "constants": {"e_x": {"value": 1.067e10, "std": 1e8}, "g_zx": {"value": 5.304e8, "std": 1e7}},
        "damping": {"ratios": [0.002, 0.003], "std": [null, 3e-4], "beyond": 0.003},
        "correlation": {"names": ["g_zx", "e_x", "damping_ratio_2"], "matrix": [[1, -0.8, 0.3], [-0.8, 1, 0], [0.3, 0, 1]]}}"#;
    const COUNT: usize = 4000;

    /// Deviations of `e_x`, `g_zx` and the logarithm of the second ratio, over their standard deviations.
    fn deviations(panel: &PanelModel) -> Vec<[f64; 3]> {
        let of = |drawn: &PanelModel| {
            assert_eq!((drawn.damping.ratios[0], &drawn.correlation, drawn.damping.std.len()), (0.002, &None, 0));
            let value = |name: &str| drawn.constants[name].value;
            [
                (value("e_x") - 1.067e10) / 1e8,
                (value("g_zx") - 5.304e8) / 1e7,
                (drawn.damping.ratios[1] / 0.003).ln() / 0.1,
            ]
        };
        panel.draws(COUNT, 7).unwrap().iter().map(of).collect()
    }

    #[test]
    fn val_draws_have_mean_deviation_and_correlation() {
        let panel = PanelModel::from_json(PANEL).unwrap();
        let found = deviations(&panel);
        let mean = |of: &dyn Fn(&[f64; 3]) -> f64| found.iter().map(of).sum::<f64>() / COUNT as f64;
        // Five standard errors of each.
        let error = 5.0 / (COUNT as f64).sqrt();
        for (i, j, due) in [(0, 0, 1.0), (1, 1, 1.0), (2, 2, 1.0), (0, 1, -0.8), (1, 2, 0.3), (0, 2, 0.0)] {
            assert!(mean(&|of| of[i]).abs() < error, "{i}");
            let together = mean(&|of| of[i] * of[j]);
            assert!((together - due).abs() < error * f64::sqrt(1.0 + due * due), "{i} {j} {together}");
        }
        let beyond = mean(&|of| f64::from(u8::from(of[0].abs() > 1.0)));
        assert!((beyond - 0.3173).abs() < 5.0 * (0.3173f64 * 0.6827 / COUNT as f64).sqrt(), "{beyond}");
        assert_eq!(panel.draws(3, 7).unwrap(), panel.draws(COUNT, 7).unwrap()[..3]);
        assert_ne!(panel.draws(3, 7).unwrap(), panel.draws(3, 8).unwrap());
    }

    #[test]
    fn val_draws_stay_within_bounds() {
        let wide = PanelModel::from_json(&PANEL.replace("\"std\": 1e8", "\"std\": 1e10")).unwrap();
        assert!(wide.draws(500, 1).unwrap().iter().all(|drawn| drawn.constants["e_x"].value > 0.0));
        let plate = r#"{"schema": "orthopanel.model/1", "structure": "mindlin-plate",
            "piece": {"length": 0.8, "width": 0.5, "thickness": 0.03, "mass_per_area": 6.88}, "constants": {"e_x": 1e10, "e_y": 1.2e10,
            "nu_xy": {"value": 0.85, "std": 0.1}, "g_xy": 4e9, "g_yz": 3e8, "g_zx": 5e8}}"#;
        let limit = (1e10f64 / 1.2e10).sqrt();
        let drawn = PanelModel::from_json(plate).unwrap().draws(200, 1).unwrap();
        assert!(drawn.iter().all(|drawn| (0.0..limit).contains(&drawn.constants["nu_xy"].value)));
        let mut far = wide;
        far.constants.insert("e_x".into(), Estimate { value: -1e12, std: Some(1.0) });
        assert!(matches!(far.draws(1, 1), Err(ModelError::Constant { name: "e_x", .. })));
    }
}
