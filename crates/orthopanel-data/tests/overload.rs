//! A channel cut off at the end of its range, told from crests that are flat or meet by chance.

use crate::support::hammer::{Noise, RATE, Resonator, history};
use orthopanel_data::{Channel, Estimation, Hit, HitFault};

const DAMPED: Resonator = Resonator { radius: 0.9, angle: 0.5 };

/// A blow of half a sine over `samples` samples from sample 200, its crest at `phase` of a sample.
fn blow(samples: f64, phase: f64, height: f64) -> Hit {
    let push = |n: usize| (n as f64 - 200.0 - phase) / samples;
    let force = |x: f64| if (0.0..1.0).contains(&x) { height * (std::f64::consts::PI * x).sin() } else { 0.0 };
    DAMPED.respond((0..1000).map(|n| force(push(n))).collect())
}

fn overloads(hit: &Hit) -> Vec<(Channel, usize)> {
    let faults = hit.faults(RATE).into_iter();
    let found = faults.filter_map(|fault| match fault {
        HitFault::Overload { channel, samples, .. } => Some((channel, samples)),
        _ => None,
    });
    found.collect()
}

/// Rounded to `codes` steps up to `range`.
fn quantised(hit: &Hit, range: [f64; 2], codes: f64) -> Hit {
    let round = |values: &[f64], range: f64| {
        let step = range / codes;
        values.iter().map(|value| (value / step).round() * step).collect()
    };
    Hit { force: round(&hit.force, range[0]), acceleration: round(&hit.acceleration, range[1]) }
}

#[test]
fn val_a_force_flat_for_two_to_seven_samples_is_cut_off() {
    // Long blows have round tops: cut at 99 %, the flank drops by less than a hundredth beside the flat.
    for (samples, limit) in [(8.0, 80.0), (12.0, 90.0), (30.0, 98.0), (40.0, 97.0)] {
        for codes in [None, Some(32768.0)] {
            let noisy = Noise(7).over(&blow(samples, 0.3, 100.0), 0.01, 0.01);
            let mut hit = match codes {
                None => noisy,
                Some(codes) => quantised(&noisy, [120.0, 400.0], codes),
            };
            let limit = codes.map_or(limit, |codes| (limit / 120.0 * codes).round() * (120.0 / codes));
            hit.force.iter_mut().for_each(|force| *force = force.min(limit));
            let flat = hit.force.iter().filter(|&&force| force == limit).count();
            assert!((2..=7).contains(&flat), "{samples}: {flat} samples flat");
            assert_eq!(overloads(&hit), [(Channel::Force, flat)], "{samples} at {limit}, {codes:?}");
        }
    }
}

#[test]
fn val_free_crests_of_blows_of_any_width_are_no_overload() {
    let mut checked = 0;
    for seed in 0..60u32 {
        let width = 5.0 + 0.7 * f64::from(seed);
        let clean = blow(width, f64::from(seed) / 60.0, 100.0);
        let noisy = Noise(u64::from(seed) + 1).over(&clean, 0.02, 0.02);
        for hit in [
            clean.clone(),
            noisy.clone(),
            quantised(&clean, [120.0, 400.0], 32768.0),
            quantised(&noisy, [120.0, 400.0], 32768.0),
            quantised(&noisy, [1000.0, 4000.0], 32768.0),
        ] {
            assert_eq!(overloads(&hit), [], "width {width}, seed {seed}");
            checked += 1;
        }
    }
    assert_eq!(checked, 300);
}

#[test]
fn val_slow_and_lightly_damped_responses_in_whole_codes_are_no_overload() {
    for (index, radius) in [0.99, 0.997, 0.999, 0.9995].into_iter().enumerate() {
        for angle in [0.05, 0.11, 0.5, 1.31, 2.2] {
            let hit = Noise(index as u64 + 11).over(&Resonator { radius, angle }.soft_hit(1000, 100.0), 0.05, 0.05);
            let reach = hit.acceleration.iter().fold(0.0, |reach: f64, value| reach.max(value.abs()));
            for codes in [128.0, 2048.0, 32768.0] {
                assert_eq!(overloads(&quantised(&hit, [120.0, 1.5 * reach], codes)), [], "{radius} {angle} {codes}");
            }
        }
    }
}

#[test]
fn val_crests_that_touch_the_range_a_few_times_are_an_overload() {
    let free = Noise(3).over(&Resonator { radius: 0.995, angle: 1.31 }.hit(1000, 100.0), 0.01, 0.01);
    let mut sorted = free.acceleration.clone();
    sorted.sort_by(f64::total_cmp);
    // A range that the five greatest samples pass, one or two at a crest: fewer than eight touches.
    let limit = sorted[sorted.len() - 6];
    let mut hit = free.clone();
    hit.acceleration.iter_mut().for_each(|value| *value = value.min(limit));
    assert_eq!(overloads(&free), []);
    assert_eq!(overloads(&hit), [(Channel::Acceleration, 6)]);
}

/// One sample on the range in each hit is a crest like any other; the same value in three hits is the range's end.
#[test]
fn val_hits_that_share_their_extreme_are_cut_off() {
    let hits = |limit: f64| -> Vec<Hit> {
        let heights = [96.0, 98.0, 100.0, 103.0].into_iter().enumerate();
        let blows = heights.map(|(index, height)| Noise(index as u64 + 1).over(&blow(8.0, 0.0, height), 0.01, 0.01));
        blows.map(|hit| Hit { force: hit.force.iter().map(|force| force.min(limit)).collect(), ..hit }).collect()
    };
    let free = history(hits(1e9)).accelerance(Estimation::default()).unwrap();
    assert_eq!(free.hits, 4);
    let refused = history(hits(95.0)).accelerance(Estimation::default()).unwrap_err().to_string();
    assert_eq!(refused.matches("at exactly 95.0000 N").count(), 4, "{refused}");
    // The same hit read thrice shares every sample, and is no overload: it counts once.
    let thrice = history(vec![hits(1e9).remove(0); 3]).accelerance(Estimation::default()).unwrap();
    assert_eq!(thrice.hits, 1);
    assert!(!thrice.notes.concat().contains("at exactly"), "{:?}", thrice.notes);
}

/// A response cut off at four fifths of its peak, which two samples in a row reached: free ones are hardly ever alike to
/// the last bit of a fine converter.
#[test]
fn val_two_samples_cut_off_to_the_same_bit_are_an_overload() {
    let cut = |codes: Option<f64>| {
        let free = Noise(5).over(&Resonator { radius: 0.9, angle: 0.9 }.soft_hit(1000, 100.0), 0.01, 0.01);
        let reach = free.acceleration.iter().fold(0.0, |reach: f64, value| reach.max(value.abs()));
        let hit = codes.map_or(free.clone(), |codes| quantised(&free, [200.0, 1.5 * reach], codes));
        let mut sorted = hit.acceleration.clone();
        sorted.sort_by(f64::total_cmp);
        let limit = sorted[sorted.len() - 2];
        (hit.clone(), Hit { acceleration: hit.acceleration.iter().map(|value| value.min(limit)).collect(), ..hit })
    };
    for codes in [None, Some(8_388_608.0)] {
        let (free, cut) = cut(codes);
        assert_eq!((overloads(&free), overloads(&cut)), (vec![], vec![(Channel::Acceleration, 2)]), "{codes:?}");
    }
    // Of 16 bits two free samples are alike too often to say so.
    assert_eq!(overloads(&cut(Some(32768.0)).1), []);
    // Nor do four printed digits tell, or a computed blow that is even about its middle.
    let (_, hit) = cut(None);
    let printed = |values: &[f64]| values.iter().map(|value| format!("{value:.3e}").parse().unwrap()).collect();
    assert_eq!(overloads(&Hit { force: printed(&hit.force), acceleration: printed(&hit.acceleration) }), []);
    assert_eq!(overloads(&blow(4.0, 0.5, 100.0)), []);
}

/// A blow of three samples whose middle one is cut off looks like any other; the same ceiling in two hits does not.
#[test]
fn val_two_short_blows_that_share_their_ceiling_to_the_last_bit_are_cut_off() {
    let hits = |limit: f64| -> Vec<Hit> {
        let heights = [(96.0, 0.1), (103.0, 0.05)].into_iter().enumerate();
        let blows =
            heights.map(|(index, (height, phase))| Noise(index as u64 + 1).over(&blow(4.0, phase, height), 0.01, 0.01));
        blows.map(|hit| Hit { force: hit.force.iter().map(|force| force.min(limit)).collect(), ..hit }).collect()
    };
    assert_eq!(history(hits(1e9)).accelerance(Estimation::default()).unwrap().hits, 2);
    let cut = hits(90.0);
    assert!(cut.iter().all(|hit| overloads(hit).is_empty()), "one sample at the ceiling tells nothing");
    let refused = history(cut).accelerance(Estimation::default()).unwrap_err().to_string();
    assert_eq!(refused.matches("1 sample at exactly 90.0000 N").count(), 2, "{refused}");
}

/// What a sharp anti-alias filter makes of a blow much shorter than a sample: it rings on either side.
#[test]
fn val_a_rate_too_low_for_the_blow_is_no_double_hit() {
    let sinc = |x: f64| if x == 0.0 { 1.0 } else { (std::f64::consts::PI * x).sin() / (std::f64::consts::PI * x) };
    let ringing = DAMPED.respond((0..1000).map(|n| 100.0 * sinc(n as f64 - 200.5)).collect());
    let [fault @ HitFault::RateTooLow { samples, rate: RATE }] = ringing.faults(RATE)[..] else {
        panic!("{:?}", ringing.faults(RATE))
    };
    assert!(samples <= 2 && fault.is_fatal(), "{samples}");
    assert!(fault.to_string().contains("the sampling rate of 1000.0 Hz is too low for this blow"), "{fault}");
    // Two short blows without a pull between them stay two blows.
    let mut twice = blow(4.0, 0.3, 100.0).force;
    for n in 0..700 {
        twice[n + 60] += 0.3 * twice[n];
    }
    let twice = DAMPED.respond(twice).faults(RATE);
    assert!(matches!(twice[..], [HitFault::DoubleHit { .. }]), "{twice:?}");
}
