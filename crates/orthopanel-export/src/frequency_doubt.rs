//! How well the frequencies of an FMU are known: what the standard deviations of the constants make of them.

use orthopanel_model::{Estimate, ModeRange, ModelError, PanelModel};

/// Part of its deviation by which a constant is moved, up and down: frequencies follow it linearly within.
const MOVE: f64 = 0.1;

/// $\sigma_{f_m}/f_m = \sqrt{\sum_{ij}\rho_{ij}\,s_{mi}\,s_{mj}}$, $s_{mi} = \sigma_i\,\partial\ln f_m/\partial c_i$, of the first `count` flexible modes, with the
/// correlation $\rho$ of the model file; of one that tells none the constants count as independent, which identified ones are not, so that the
/// true deviation is as a rule less. Nothing where no constant has a deviation.
///
/// # Errors
/// As [`PanelModel::modes`].
pub(crate) fn of(panel: &PanelModel, count: usize) -> Result<Vec<f64>, ModelError> {
    let frequencies = |panel: &PanelModel| -> Result<Vec<f64>, ModelError> {
        let modes = panel.modes(ModeRange::Count(count))?;
        Ok(modes.iter().map(|mode| mode.frequency()).filter(|frequency| *frequency > 0.0).collect())
    };
    let mut shares: Vec<(&str, Vec<f64>)> = Vec::new();
    for (name, estimate) in &panel.constants {
        let Some(std) = estimate.std.filter(|std| *std > 0.0) else { continue };
        let moved = |sign: f64| {
            let mut moved = panel.clone();
            let value = estimate.value + sign * MOVE * std;
            moved.constants.insert(name.clone(), Estimate { value, std: None });
            frequencies(&moved)
        };
        // A deviation that reaches past a bound tells nothing linear.
        let (Ok(up), Ok(down)) = (moved(1.0), moved(-1.0)) else { continue };
        let share = |(up, down): (&f64, &f64)| (up / down).ln() / (2.0 * MOVE);
        shares.push((name, up.iter().zip(&down).map(share).collect()));
    }
    let together = |first: &str, second: &str| match &panel.correlation {
        _ if first == second => 1.0,
        Some(matrix) => matrix.of(first, second),
        None => 0.0,
    };
    let share = |of: &[f64], mode: usize| of.get(mode).copied().unwrap_or(0.0);
    let modes = shares.iter().map(|(_, of)| of.len()).max().unwrap_or(0);
    let variance = |mode: usize| -> f64 {
        let pairs = shares.iter().flat_map(|one| shares.iter().map(move |other| (one, other)));
        pairs.map(|((a, one), (b, other))| together(a, b) * share(one, mode) * share(other, mode)).sum()
    };
    Ok((0..modes).map(|mode| variance(mode).max(0.0).sqrt()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All moduli together by 1 % would move all frequencies by 0.5 %; independently, their shares add up in squares, and $\partial\ln f$
    /// by the logarithms of both is a half in all.
    #[test]
    fn val_shares_of_both_moduli_make_a_half() {
        let with = |e: f64, g: f64| {
            let text = format!(
                r#"{{"schema": "orthopanel.model/1", "structure": "timoshenko-beam", "constants": {{
                "e_x": {{"value": 1.067e10, "std": {}}}, "g_zx": {{"value": 5.304e8, "std": {}}}}}, "damping": {{"beyond": 0.003}},
                "piece": {{"length": 0.8, "width": 0.1, "thickness": 0.03, "mass_per_area": 6.88}}}}"#,
                1.067e10 * e,
                5.304e8 * g
            );
            of(&PanelModel::from_json(&text).unwrap(), 6).unwrap()
        };
        let (by_e, by_g, both) = (with(0.01, 0.0), with(0.0, 0.01), with(0.01, 0.01));
        assert_eq!(by_e.len(), 6);
        for ((e, g), both) in by_e.iter().zip(&by_g).zip(&both) {
            assert!((e + g - 0.005).abs() < 1e-8 && (both - e.hypot(*g)).abs() < 1e-12, "{e} {g} {both}");
        }
        assert!(with(0.0, 0.0).is_empty());
    }

    /// Constants that err together move frequencies by the sum of their shares, and those that err against each other by the difference.
    #[test]
    fn val_shares_of_constants_that_err_together_add_up() {
        let with = |coefficient: f64| {
            let text = format!(
                r#"{{"schema": "orthopanel.model/1", "structure": "timoshenko-beam", "constants": {{
                "e_x": {{"value": 1.067e10, "std": 1.067e8}}, "g_zx": {{"value": 5.304e8, "std": 5.304e6}}}}, "damping": {{"beyond": 0.003}},
                "piece": {{"length": 0.8, "width": 0.1, "thickness": 0.03, "mass_per_area": 6.88}},
                "correlation": {{"names": ["e_x", "g_zx"], "matrix": [[1, {coefficient}], [{coefficient}, 1]]}}}}"#
            );
            of(&PanelModel::from_json(&text).unwrap(), 6).unwrap()
        };
        for ((together, apart), against) in with(1.0).iter().zip(with(0.0)).zip(with(-1.0)) {
            assert!(
                (together - 0.005).abs() < 1e-8 && against < apart && apart < *together,
                "{together} {apart} {against}"
            );
        }
    }
}
