//! How well a set of natural frequencies meets the poles that records show.

/// A mode without a pole counts as this much of a pole without a mode: sensor or hammer may sit at its node, but none of
/// many modes may be dreamt up to meet few poles.
const UNSEEN_MODE: f64 = 0.3;

/// The distances of the poles from their nearest modes, one pole a mode, in parts of the pole's frequency; a pole further than
/// `reach` from every mode is charged with that, and a mode below `top` \[Hz\] without a pole with a part of it.
pub(crate) fn pole_charge(poles: &[f64], modes: impl IntoIterator<Item = f64>, top: f64, reach: f64) -> f64 {
    let modes: Vec<f64> = modes.into_iter().take_while(|mode| *mode < top).collect();
    let mut seen = vec![false; modes.len()];
    let mut charge = 0.0;
    for pole in poles {
        let distance = |mode: usize| (modes[mode] / pole - 1.0).abs();
        let free = (0..modes.len()).filter(|&mode| !seen[mode] && distance(mode) < reach);
        match free.min_by(|&a, &b| distance(a).total_cmp(&distance(b))) {
            Some(mode) => {
                seen[mode] = true;
                charge += distance(mode);
            }
            None => charge += reach,
        }
    }
    charge + UNSEEN_MODE * reach * seen.iter().filter(|seen| !**seen).count() as f64
}
