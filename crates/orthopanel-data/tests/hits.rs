//! Faults of hits, each found.

use crate::support::{
    hammer::{Noise, RATE, Resonator},
    recorded::{DAMPED, good, measurement},
};
use orthopanel_data::{Channel, Hit, HitFault, RecordFile, TimeHistory};

#[test]
fn val_a_good_hit_has_no_fault() {
    assert_eq!(good().faults(RATE), []);
    // A bare pulse without noise: its exact zeros are no overload.
    assert_eq!(DAMPED.hit(1000, 100.0).faults(RATE), []);
}

#[test]
fn val_overload_is_found_in_either_channel() {
    let mut hit = good();
    hit.force.iter_mut().for_each(|force| *force = force.min(80.0));
    let [fault @ HitFault::Overload { channel: Channel::Force, first, samples: 3, value: 80.0 }] = hit.faults(RATE)[..]
    else {
        panic!("{:?}", hit.faults(RATE))
    };
    // Samples are counted from one.
    assert_eq!(hit.force.iter().position(|force| *force == 80.0), Some(first - 1));
    let said =
        format!("force cut off from sample {first} on: 3 samples at exactly 80.0000 N (overload): set a greater range");
    assert!(fault.to_string().starts_with(&said), "{fault}");
    let mut hit = good();
    let greatest = hit.acceleration.iter().copied().fold(0.0, f64::max);
    hit.acceleration.iter_mut().for_each(|a| *a = a.clamp(-0.5 * greatest, 0.5 * greatest));
    let [HitFault::Overload { channel: Channel::Acceleration, value, .. }] = hit.faults(RATE)[..] else {
        panic!("{:?}", hit.faults(RATE))
    };
    assert_eq!(value, 0.5 * greatest);
}

#[test]
fn val_a_peak_flat_by_few_bits_is_no_overload() {
    let mut hit = Resonator { radius: 0.99, angle: 0.05 }.soft_hit(1000, 100.0);
    let greatest = hit.acceleration.iter().copied().fold(0.0, f64::max);
    // Eight bits over the whole range: the slow wave's top holds four samples of one code.
    let bit = greatest / 128.0;
    hit.acceleration.iter_mut().for_each(|a| *a = (*a / bit).round() * bit);
    let top = hit.acceleration.iter().copied().fold(0.0, f64::max);
    assert!(hit.acceleration.windows(3).any(|three| three.iter().all(|value| *value == top)), "no flat peak");
    assert!(!hit.faults(RATE).iter().any(|fault| fault.is_fatal()), "{:?}", hit.faults(RATE));
}

#[test]
fn val_a_double_hit_is_found_with_its_time_and_size() {
    let mut force = good().force;
    for n in 0..700 {
        force[n + 300] += 0.2 * force[n];
    }
    let hit = DAMPED.respond(force);
    let [HitFault::DoubleHit { after, ratio }] = hit.faults(RATE)[..] else { panic!("{:?}", hit.faults(RATE)) };
    // The run above 5 % of the peak is found; the softer pulse passes that level later by 1 to 3 samples.
    assert!((after - 0.3).abs() < 0.004 && (ratio - 0.2).abs() < 0.01, "{after} {ratio}");
}

#[test]
fn val_the_hammers_own_ringing_is_no_second_hit() {
    let mut hit = good();
    // An anti-alias filter's overshoot right after the pulse: 10 % of it.
    hit.force[212] += 10.0;
    assert_eq!(hit.faults(RATE), []);
}

#[test]
fn val_a_weak_force_a_ringing_response_and_a_silent_channel_are_found() {
    let weak = Noise(5).over(&DAMPED.soft_hit(1000, 100.0), 10.0, 0.01);
    let [HitFault::WeakForce { signal_to_noise }] = weak.faults(RATE)[..] else { panic!("{:?}", weak.faults(RATE)) };
    // 100 N over a noise of 10 N, and whatever the noise adds at the peak.
    assert!((signal_to_noise - 10.0).abs() < 3.0, "{signal_to_noise}");

    let ringing = Resonator { radius: 0.9975, angle: 0.5 }.soft_hit(1000, 100.0);
    let [fault @ HitFault::NotDecayed { ratio }] = ringing.faults(RATE)[..] else {
        panic!("{:?}", ringing.faults(RATE))
    };
    assert!(!fault.is_fatal());
    // From the twentieth after the hit to the last one are 15 twentieths of 50 samples.
    assert!((ratio / 0.9975f64.powi(750) - 1.0).abs() < 0.3, "{ratio}");

    let mut silent = good();
    silent.acceleration.fill(0.1);
    assert_eq!(silent.faults(RATE), [HitFault::Silent(Channel::Acceleration)]);
}

/// A channel that touches its range for a sample at a time, at every crest, as a fast oscillation does.
#[test]
fn val_a_range_touched_again_and_again_is_an_overload() {
    let rate = 16384.0;
    let push =
        |n: usize| if (40..50).contains(&n) { (std::f64::consts::PI * (n - 40) as f64 / 10.0).sin() } else { 0.0 };
    let force: Vec<f64> = (0..8192).map(|n| 100.0 * push(n) + 1e-3 * (n as f64 * 1.7).sin()).collect();
    let free = |n: usize| 500.0 * (-(n as f64) / 700.0).exp() * (n as f64 * 1.31).sin();
    let hit = |limit: f64| Hit {
        force: force.clone(),
        acceleration: (0..8192).map(|n| if n < 45 { 0.0 } else { free(n - 45).clamp(-limit, limit) }).collect(),
    };
    let overloaded = |hit: &Hit| hit.faults(rate).iter().any(|fault| matches!(fault, HitFault::Overload { .. }));
    assert!(overloaded(&hit(300.0)));
    assert!(!overloaded(&hit(1e9)), "{:?}", hit(1e9).faults(rate));
}

/// A weak hit between good ones: left out with its reason, not taken for swapped channels, however long its noise lasts.
#[test]
fn val_a_weak_hit_is_left_out_and_the_others_count() {
    let csv = |hit: &Hit| {
        let rows = hit.force.iter().zip(&hit.acceleration).enumerate();
        let rows: String = rows.map(|(n, (f, a))| format!("{},{f},{a}\n", n as f64 / RATE)).collect();
        format!("time_s,force_n,acceleration_m_s2\n{rows}")
    };
    let piece = Resonator { radius: 0.99, angle: 0.5 };
    let clean = piece.hit(8000, 100.0);
    for part in [0.1, 0.03, 0.01] {
        let weak = Hit {
            force: clean.force.iter().map(|force| part * force).collect(),
            acceleration: clean.acceleration.iter().map(|a| part * a).collect(),
        };
        let read = |hit: &Hit, seed: u64| {
            let noisy = Noise(seed).over(hit, 0.4, 0.1);
            let file = RecordFile::from_bytes(csv(&noisy).as_bytes(), "hits.csv").unwrap();
            TimeHistory::from_records(file, &measurement()).unwrap_or_else(|refused| panic!("{part}: {refused}"))
        };
        let mut all = read(&clean, 1);
        all.join(read(&weak, 2)).unwrap();
        all.join(read(&clean, 3)).unwrap();
        let found = all.accelerance(orthopanel_data::Estimation::default()).unwrap();
        let said = found.notes.iter().any(|note| note.contains("hit 2 (hits.uff) left out: force only"));
        // 7.2 N over 0.4 N is 18.
        assert!(said && found.hits == 2, "{part}: {:?}", found.notes);
    }
}

/// A hit that just stands out of its noise differs from strong ones in every line, which is no fault of its place.
#[test]
fn val_a_hit_just_above_its_noise_is_weighed_not_left_out() {
    let clean = DAMPED.hit(8000, 100.0);
    let part = |part: f64, seed| {
        let scaled = |channel: &[f64]| channel.iter().map(|value| part * value).collect();
        let hit = Hit { force: scaled(&clean.force), acceleration: scaled(&clean.acceleration) };
        Noise(seed).over(&hit, 0.002, 0.01)
    };
    let hits = vec![part(1.0, 1), part(0.001, 2), part(1.0, 3)];
    let found = crate::support::hammer::history(hits).accelerance(orthopanel_data::Estimation::default()).unwrap();
    assert_eq!((found.hits, found.notes.len()), (3, 0), "{:?}", found.notes);
}

#[test]
fn val_noise_is_no_second_touch() {
    for (noise, seed) in [(1.0, 11), (2.0, 12), (3.0, 13)] {
        let hit = Noise(seed).over(&DAMPED.hit(30_000, 100.0), noise, 0.01);
        assert_eq!(hit.faults(RATE), [], "{noise} N under 72 N");
    }
    let touched_before = {
        let mut force = good().force;
        for n in 0..700 {
            force[n] += 0.2 * force[n + 100];
        }
        DAMPED.respond(force)
    };
    let fault = touched_before.faults(RATE)[0].to_string();
    assert!(fault.contains("of the force touched before, by 99"), "{fault}");
}

/// A pulse of three samples that rings on, as a band-limited one does, and 40 % of it again: the ringing has long died.
#[test]
fn val_a_second_touch_of_a_short_blow_is_a_double_hit() {
    let ringing = |n: f64| if n == 0.0 { 1.0 } else { (2.0 * n).sin() / (2.0 * n) };
    let blow = |at: f64| move |n: usize| if (n as f64 - at).abs() < 12.0 { ringing(n as f64 - at) } else { 0.0 };
    let (first, second) = (blow(200.3), blow(260.3));
    let once = DAMPED.respond((0..1000).map(|n| 100.0 * first(n)).collect());
    let twice = DAMPED.respond((0..1000).map(|n| 100.0 * (first(n) + 0.4 * second(n))).collect());
    let [HitFault::DoubleHit { after, ratio }] = twice.faults(RATE)[..] else { panic!("{:?}", twice.faults(RATE)) };
    assert!((after - 0.06).abs() < 0.002 && (ratio - 0.4).abs() < 0.05, "{after} {ratio}");
    assert!(!matches!(once.faults(RATE)[..], [HitFault::DoubleHit { .. }]), "{:?}", once.faults(RATE));
}
