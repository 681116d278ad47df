//! How well a set of natural frequencies meets the poles that records show.

/// A mode without a pole counts as this much of a pole without a mode: sensor or hammer may sit at its node, but none of
/// many modes may be dreamt up to meet few poles.
const UNSEEN_MODE: f64 = 0.3;

/// The distances of the poles from their nearest modes, one pole a mode, in parts of the pole's frequency; a pole further than
/// `reach` from every mode is charged with that, and a mode below `top` \[Hz\] without a pole with a part of it.
pub(crate) fn pole_charge(poles: &[f64], modes: impl IntoIterator<Item = f64>, top: f64, reach: f64) -> f64 {
    let modes: Vec<f64> = modes.into_iter().take_while(|mode| *mode < top).collect();
    let (distances, seen) = nearest_modes(poles, &modes, reach);
    let charge: f64 = distances.into_iter().map(|distance| distance.unwrap_or(reach)).sum();
    charge + UNSEEN_MODE * reach * seen.iter().filter(|seen| !**seen).count() as f64
}

/// The distance of each pole from its own mode, in parts of the pole's frequency; none where it has none within `reach`. And which
/// modes were taken.
pub(crate) fn nearest_modes(poles: &[f64], modes: &[f64], reach: f64) -> (Vec<Option<f64>>, Vec<bool>) {
    let mut taken = vec![false; modes.len()];
    let own = own_modes(poles, modes, reach);
    own.iter().flatten().for_each(|&mode| taken[mode] = true);
    let distances = own.iter().zip(poles).map(|(own, pole)| own.map(|mode| distance(*pole, modes[mode]))).collect();
    (distances, taken)
}

/// The nearest mode to each pole, in turn, that no pole before it took; none where that is not below `reach`, in parts of the
/// pole's frequency.
pub(crate) fn own_modes(poles: &[f64], modes: &[f64], reach: f64) -> Vec<Option<usize>> {
    let mut taken = vec![false; modes.len()];
    let own = poles.iter().map(|&pole| {
        let away = |mode: usize| distance(pole, modes[mode]);
        let free = (0..modes.len()).filter(|&mode| !taken[mode] && away(mode) < reach);
        let nearest = free.min_by(|&a, &b| away(a).total_cmp(&away(b)))?;
        taken[nearest] = true;
        Some(nearest)
    });
    own.collect()
}

fn distance(pole: f64, mode: f64) -> f64 {
    (mode / pole - 1.0).abs()
}
