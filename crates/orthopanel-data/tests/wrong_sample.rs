//! A single wrong sample, lost or cut off, found by what it leaves at half the rate; and hits without such a fault.

use crate::support::hammer::{Noise, RATE, Resonator};
use orthopanel_data::{Channel, Hit, HitFault};

/// Two slow resonances: what an anti-alias filter would let pass.
fn hit(seed: u64) -> Hit {
    let slow = Resonator { radius: 0.995, angle: 0.4 }.soft_hit(2000, 100.0);
    let fast = Resonator { radius: 0.99, angle: 1.6 }.respond(slow.force.clone());
    let acceleration = slow.acceleration.iter().zip(&fast.acceleration).map(|(a, b)| a + 5.0 * b).collect();
    Noise(seed).over(&Hit { acceleration, ..slow }, 0.02, 0.5)
}

fn quantised(hit: &Hit, bits: i32) -> Hit {
    let round = |values: &[f64]| {
        let reach = values.iter().fold(0.0, |reach: f64, value| reach.max(value.abs()));
        let step = 1.2 * reach / 2f64.powi(bits - 1);
        values.iter().map(|value| (value / step).round() * step).collect()
    };
    Hit { force: round(&hit.force), acceleration: round(&hit.acceleration) }
}

fn cut(hit: &Hit) -> Vec<f64> {
    let faults = hit.faults(RATE).into_iter();
    let cut = faults.filter_map(|fault| match fault {
        HitFault::CutCrest { sample, value, expected } => {
            assert_eq!(hit.acceleration[sample - 1], value);
            Some(expected)
        }
        _ => None,
    });
    cut.collect()
}

fn dropped(hit: &Hit) -> Vec<(Channel, usize, f64)> {
    let faults = hit.faults(RATE).into_iter();
    let dropped = faults.filter_map(|fault| match fault {
        HitFault::DroppedSample { channel, sample, expected, .. } => Some((channel, sample, expected)),
        _ => None,
    });
    dropped.collect()
}

/// A zero, or the sample before again on a flank, wherever it misses its place by more than twenty times the noise.
#[test]
fn val_a_lost_sample_is_found_where_it_stands_out_of_the_noise() {
    let (mut found, mut of) = (0, 0);
    for seed in 1..=20 {
        let whole = hit(seed);
        for at in (420..1000).step_by(29) {
            let a = &whole.acceleration;
            let flank = (a[at - 1] - a[at - 2]) * (a[at + 1] - a[at - 1]) > 0.0;
            for lost in [Some(0.0), flank.then_some(a[at - 1])].into_iter().flatten() {
                if (lost - a[at]).abs() < 20.0 * 0.5 {
                    continue;
                }
                let mut hit = whole.clone();
                hit.acceleration[at] = lost;
                of += 1;
                if let [(Channel::Acceleration, sample, expected)] = dropped(&hit)[..] {
                    assert_eq!(sample, at + 1, "sample");
                    // A tenth of all frequencies tells it to some three times the noise; four deviations of that and
                    // what the resonances themselves leave there.
                    assert!((expected - a[at]).abs() < 16.0 * 0.5, "{expected} for {}", a[at]);
                    found += 1;
                }
            }
        }
    }
    assert!(of > 200 && f64::from(found) > 0.9 * f64::from(of), "{found} of {of}");
}

/// The greatest sample alone at the end of the range: no second one is there to be alike.
#[test]
fn val_a_crest_of_one_sample_that_is_cut_off_is_found() {
    for part in [0.8, 0.9] {
        let mut found = 0;
        for seed in 1..=50 {
            let mut hit = hit(seed);
            let top = hit.acceleration.iter().copied().fold(0.0, f64::max);
            let at = hit.acceleration.iter().position(|&value| value == top).unwrap();
            hit.acceleration[at] *= part;
            if hit.acceleration.iter().any(|&value| value > hit.acceleration[at]) {
                // Not the greatest any more: the range would have cut others too.
                hit.acceleration.iter_mut().for_each(|value| *value = value.min(part * top));
            }
            let faults = hit.faults(RATE);
            found += usize::from(faults.iter().any(|fault| fault.to_string().starts_with("acceleration cut off")));
        }
        assert!(found >= 45, "{found} of 50 at {part}");
    }
}

#[test]
fn val_whole_hits_show_no_lost_sample_at_any_number_of_bits() {
    for seed in 1..=125 {
        let whole = hit(1000 + seed);
        assert_eq!((dropped(&whole), cut(&whole)), (vec![], vec![]), "seed {seed}");
        for bits in [8, 10, 12, 14, 16, 24] {
            let coarse = quantised(&whole, bits);
            assert_eq!((dropped(&coarse), cut(&coarse)), (vec![], vec![]), "seed {seed}, {bits} bits");
        }
    }
}

/// A blow shorter than a sample, of which no filter took the edge, stands beside repeated codes of its channel's noise.
#[test]
fn val_a_blow_of_one_sample_is_no_lost_one() {
    for seed in 1..=100 {
        let mut whole = hit(seed);
        whole.force.iter_mut().for_each(|force| *force = 0.0);
        whole.force[400] = 100.0;
        let hit = quantised(&Noise(seed).over(&whole, 0.02, 0.0), 16);
        assert_eq!(dropped(&hit), [], "seed {seed}");
    }
}

#[test]
fn val_a_hit_with_a_lost_sample_is_left_out_and_the_sample_named() {
    let mut hit = hit(1);
    hit.acceleration[600] = 0.0;
    let faults = hit.faults(RATE);
    let fault = faults.iter().find(|fault| fault.is_fatal()).unwrap();
    let said = fault.to_string();
    assert!(said.starts_with("sample 601 of the acceleration was lost: 0.0000 m/s2 stands where"), "{said}");
}
