//! Hits to accelerance: against a closed form, against pyFRF, and its variance against repetition.

use crate::support::hammer::{Noise, Resonator, deviation, history};
use num_complex::Complex64;
use orthopanel_data::{Estimation, Estimator, Hit, ImpactTest, MeasurementData, TimeHistory, Window};

const DAMPED: Resonator = Resonator { radius: 0.9, angle: 0.5 };
const ALL_LINES: Estimation = Estimation { window: Window::None, estimator: Estimator::H1, force_drop: f64::INFINITY };

#[test]
fn val_every_estimator_gives_the_transfer_function_without_noise() {
    let history = history(vec![DAMPED.hit(1000, 100.0), DAMPED.hit(1000, 150.0)]);
    for estimator in [Estimator::H1, Estimator::H2, Estimator::Hv] {
        let found = history.accelerance(Estimation { estimator, ..ALL_LINES }).unwrap();
        assert_eq!((found.frequency.len(), found.frequency[0], found.frequency[499]), (500, 1.0, 500.0));
        // 0.9^800 of the response is cut off; the transform rounds at 1e-16 of the greatest line.
        let worst = deviation(&found, DAMPED);
        assert!(worst < 1e-9, "{estimator:?}: {worst}");
        assert!(found.coherence.unwrap().iter().all(|gamma| (gamma - 1.0).abs() < 1e-9));
    }
}

/// The response rings on at the end of the record: only the exponential on both channels keeps it exact.
#[test]
fn val_force_and_exponential_window_gives_the_transfer_function_at_its_decay_rate() {
    let ringing = Resonator { radius: 0.999, angle: 0.5 };
    let mut hit = ringing.hit(1000, 100.0);
    // Offsets of both channels are found in the force's median and before the hit.
    hit.force.iter_mut().for_each(|force| *force += 0.5);
    hit.acceleration.iter_mut().for_each(|acceleration| *acceleration -= 3.0);
    let history = history(vec![hit]);
    let window = Window::ForceExponential { half_width: 0.06, tau: 0.04 };
    let found = history.accelerance(Estimation { window, ..ALL_LINES }).unwrap();
    assert_eq!(found.decay_rate, 25.0);
    // e^(-(25 + 1) 0.8), 1e-9, of the response is left at the end, and 0.6^60 of the pulse is cut off.
    let worst = deviation(&found, ringing);
    assert!(worst < 1e-7, "{worst}");
    assert!(deviation(&history.accelerance(ALL_LINES).unwrap(), ringing) > 1e-3, "no leakage to be mended");
}

#[test]
fn val_hann_window_keeps_a_flat_system_flat() {
    // Acceleration proportional to force: any window common to both cancels.
    let mut hit = DAMPED.hit(500, 100.0);
    hit.acceleration = hit.force.iter().map(|force| 0.25 * force).collect();
    let found = history(vec![hit]).accelerance(Estimation { window: Window::Hann, ..ALL_LINES }).unwrap();
    for (frequency, value) in found.frequency.iter().zip(&found.value) {
        assert!((value - 0.25).norm() < 1e-9, "{frequency} Hz: {value}");
    }
}

fn noisy(clean: &Hit, seed: u64, hits: usize, force: f64, acceleration: f64) -> TimeHistory {
    let mut noise = Noise(seed);
    history((0..hits).map(|_| noise.over(clean, force, acceleration)).collect())
}

/// $|H_1| \le |H_v| \le |H_2|$ with one phase, and $\gamma^2 = |H_1|/|H_2|$: Cauchy's inequality.
#[test]
fn val_estimators_are_ordered_and_their_quotient_is_the_coherence() {
    let history = noisy(&DAMPED.hit(400, 100.0), 1, 4, 1.0, 1.0);
    let by = |estimator| history.accelerance(Estimation { estimator, ..ALL_LINES }).unwrap();
    let (h1, h2, hv) = (by(Estimator::H1), by(Estimator::H2), by(Estimator::Hv));
    let coherence = h1.coherence.unwrap();
    let lines = h1.value.iter().zip(&h2.value).zip(&hv.value).zip(coherence);
    for (((h1, h2), hv), gamma) in lines {
        let [low, middle, high] = [h1, hv, h2].map(|value| value.norm());
        assert!(low <= middle * (1.0 + 1e-12) && middle <= high * (1.0 + 1e-12));
        assert!((low / high - gamma).abs() < 1e-9);
        assert!((h1 / low - h2 / high).norm() < 1e-9 && (h1 / low - hv / middle).norm() < 1e-9);
    }
}

/// Mean squared deviation over many repetitions against the mean of the variance each of them states.
fn stated_over_seen(clean: &Hit, hits: usize, force: f64, acceleration: f64, estimation: Estimation) -> f64 {
    let (mut seen, mut stated) = (0.0, 0.0);
    for seed in 0..300 {
        let found = noisy(clean, 1000 + seed, hits, force, acceleration).accelerance(estimation).unwrap();
        let variance = found.variance.unwrap();
        for ((frequency, value), variance) in found.frequency.iter().zip(&found.value).zip(variance).take(60) {
            let exact = DAMPED.transfer(0.0, *frequency);
            seen += (value - exact).norm_sqr() / exact.norm_sqr();
            stated += variance / exact.norm_sqr();
        }
    }
    stated / seen
}

#[test]
fn val_variance_from_scatter_is_the_mean_squared_error() {
    for hits in [2, 5] {
        let ratio = stated_over_seen(&DAMPED.hit(400, 100.0), hits, 0.0, 0.3, ALL_LINES);
        // 300 tests of 60 lines: the ratio scatters by 1 %.
        assert!((ratio - 1.0).abs() < 0.04, "{hits} hits: {ratio}");
    }
}

#[test]
fn val_variance_of_one_hit_from_the_noise_above_the_band_is_the_mean_squared_error() {
    let estimation = Estimation { force_drop: 20.0, ..ALL_LINES };
    let ratio = stated_over_seen(&DAMPED.soft_hit(1000, 100.0), 1, 0.05, 0.3, estimation);
    // 110 lines of noise in each of 300 tests: their medians scatter by 1 % together, and are biased by as much.
    assert!((ratio - 1.0).abs() < 0.05, "{ratio}");
}

#[test]
fn val_the_band_ends_where_the_force_does() {
    let history = noisy(&DAMPED.soft_hit(1000, 100.0), 7, 3, 0.0, 0.1);
    let found = history.accelerance(Estimation { force_drop: 20.0, ..ALL_LINES }).unwrap();
    let end = *found.frequency.last().unwrap();
    // exp(-(2 pi f 2 ms)^2 / 2) is 20 dB down at 170.8 Hz; the smoothing over nine lines moves it by a few.
    assert!((end - 170.8).abs() < 5.0, "{end}");
    assert!(found.notes.iter().any(|note| note.starts_with("band cut at")), "{:?}", found.notes);
    let tight = history.accelerance(Estimation { force_drop: 6.0, ..ALL_LINES }).unwrap();
    assert!(*tight.frequency.last().unwrap() < end);
}

#[test]
fn val_a_bad_hit_is_left_out_and_said() {
    let good = DAMPED.hit(1000, 100.0);
    let mut clipped = good.clone();
    clipped.force.iter_mut().for_each(|force| *force = force.min(50.0));
    let with = |hits: Vec<Hit>| history(hits).accelerance(ALL_LINES);
    let found = with(vec![good, clipped.clone(), DAMPED.hit(1000, 110.0)]).unwrap();
    assert_eq!(found.hits, 2);
    assert!(found.notes.iter().any(|note| note.starts_with("hit 2 left out: force cut off")), "{:?}", found.notes);
    let message = with(vec![clipped]).unwrap_err().to_string();
    assert!(message.starts_with("hits.uff: no hit can be used: hit 1 left out: force cut off"), "{message}");
}

/// A response cut off while it rings leaks; the window that is chosen for it leaves the accelerance on its own s exact.
/// One that has died away is not touched.
#[test]
fn val_the_window_as_needed_takes_the_leak_away() {
    let as_needed = Estimation { window: Window::AsNeeded, ..ALL_LINES };
    let ringing = Resonator { radius: 0.9975, angle: 0.5 };
    let miss = |estimation| {
        let found = history(vec![ringing.soft_hit(1000, 100.0)]).accelerance(estimation).unwrap();
        let lines = found.frequency.iter().zip(&found.value).take(100);
        let misses = lines.map(|(frequency, value)| {
            let exact = ringing.transfer(found.decay_rate, *frequency);
            (value - exact).norm() / exact.norm()
        });
        (misses.fold(0.0, f64::max), found.decay_rate, found.notes)
    };
    let (leaking, _, _) = miss(ALL_LINES);
    let (windowed, decay_rate, notes) = miss(as_needed);
    // 15 % is left, and the exponential brings that to 1e-6 of the greatest. The tail's own spectrum is that of a blow of
    // its size in two samples: some six times 1e-6 beside the pulse, which falls to half by 100 Hz.
    assert!(leaking > 0.05 && windowed < 1e-5, "{leaking} {windowed}");
    assert!(decay_rate > 0.0 && notes.iter().any(|note| note.contains("tau = ")), "{notes:?}");
    let quiet = history(vec![DAMPED.hit(1000, 100.0)]);
    assert_eq!(quiet.accelerance(as_needed).unwrap(), quiet.accelerance(ALL_LINES).unwrap());
}

#[test]
fn val_settings_without_sense_are_refused() {
    let history = history(vec![DAMPED.hit(100, 1.0)]);
    for estimation in [
        Estimation { window: Window::ForceExponential { half_width: 0.0, tau: 1.0 }, ..ALL_LINES },
        Estimation { window: Window::ForceExponential { half_width: 1.0, tau: f64::NAN }, ..ALL_LINES },
        Estimation { force_drop: -3.0, ..ALL_LINES },
    ] {
        assert!(history.accelerance(estimation).is_err(), "{estimation:?}");
    }
}

/// The measured hits, and pyFRF run on them: same H1, same coherence.
#[test]
fn val_measured_hits_agree_with_pyfrf() {
    let Some(path) = crate::support::measured("hammer_hits/hits.uff") else { return };
    let folder = tempfile::tempdir().unwrap();
    let test = folder.path().join("test.toml");
    std::fs::write(&test, format!(
        "[piece]\nlength = 1\nwidth = 1\nthickness = 0.01\nmass_per_area = 1\n[[measurement]]\nkind = \"time-history\"\n\
         file = {:?}\nforce_at = [0, 0]\nresponse_at = [0, 0]\n", path.canonicalize().unwrap())).unwrap();
    let test = ImpactTest::read(test).unwrap();
    let MeasurementData::TimeHistory(measurement) = &test.measurements[0].data else { panic!("another kind") };
    let history = TimeHistory::read(measurement).unwrap();
    assert_eq!((history.hits.len(), history.rate), (5, 25600.0));
    let found = history.accelerance(ALL_LINES).unwrap();
    assert_eq!(found.hits, 5, "{:?}", found.notes);
    assert!(found.notes.iter().any(|note| note.contains("not decayed")), "{:?}", found.notes);

    let Some(lines) = crate::support::python("h1_with_pyfrf.py", "pyFRF", &[&path]) else { return };
    let lines: Vec<Vec<f64>> =
        lines.lines().map(|line| line.split(' ').map(|text| text.parse().unwrap()).collect()).collect();
    assert_eq!(lines.len(), found.value.len());
    let scale = found.value.iter().map(|value| value.norm()).fold(0.0, f64::max);
    let coherence = found.coherence.unwrap();
    for (line, expected) in lines.iter().enumerate() {
        let exact = Complex64::new(expected[0], expected[1]);
        let error = (found.value[line] - exact).norm();
        assert!(error <= 1e-9 * exact.norm() + 1e-15 * scale, "line {line}: {} and {exact}", found.value[line]);
        assert!((coherence[line] - expected[2]).abs() < 1e-9, "line {line}: {} {}", coherence[line], expected[2]);
    }
}

/// A soft blow of 2 ms (standard deviation): a force window that cuts it is refused with the width that holds it, one that
/// cuts a little is told, and the width named is enough.
#[test]
fn val_a_force_window_narrower_than_the_blow_is_told() {
    let history = noisy(&DAMPED.soft_hit(1000, 100.0), 7, 3, 0.0, 0.1);
    let under = |half_width| history.accelerance(Estimation { window: Window::Force { half_width }, ..ALL_LINES });
    let refused = under(1e-5).unwrap_err().to_string();
    assert!(refused.contains("% of the blow (rms): half its width is 0.010 ms, and"), "{refused}");
    let named: f64 = refused.split("a half width of ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    // What a normal pulse has beyond x is erfc(x/s) of its energy: 2.5e-5 at 3 standard deviations.
    assert!((0.005..0.0075).contains(&named), "{named}");
    let said = |half_width| under(half_width).unwrap().notes.iter().any(|note| note.contains("cuts off"));
    assert!(!said(named) && said(0.7 * named));
}

/// Hann's window leaves damping in doubt by its slope at the blow: nothing else does.
#[test]
fn val_hanns_window_tells_what_it_leaves_in_doubt() {
    let history = noisy(&DAMPED.soft_hit(1000, 100.0), 1, 2, 0.0, 0.1);
    let of = |window| history.accelerance(Estimation { window, ..ALL_LINES }).unwrap().decay_rate_in_doubt;
    assert_eq!(of(Window::None), 0.0);
    assert_eq!(of(Window::ForceExponential { half_width: 0.004, tau: 0.2 }), 0.0);
    let length = history.hits[0].force.len() as f64;
    let force = &history.hits[0].force;
    let blow = (0..force.len()).max_by(|&a, &b| force[a].total_cmp(&force[b])).unwrap() as f64;
    let slope = 1.0 / (std::f64::consts::PI * blow / length).tan().abs();
    let expected = std::f64::consts::TAU * history.rate / length * slope.max(1.0);
    assert!((of(Window::Hann) / expected - 1.0).abs() < 1e-9, "{} {expected}", of(Window::Hann));
}

/// A blow at a fiftieth of the record, where Hann's window is a three hundredth of its greatest: what is seen of any decay
/// is the window's, and that is said.
#[test]
fn val_a_blow_that_hanns_window_cuts_off_is_told() {
    let cut = |from: usize| {
        let hit = DAMPED.soft_hit(1000, 100.0);
        let hit = Hit { force: hit.force[from..].to_vec(), acceleration: hit.acceleration[from..].to_vec() };
        history(vec![hit]).accelerance(Estimation { window: Window::Hann, ..ALL_LINES }).unwrap()
    };
    for (from, told) in [(0, false), (100, false), (185, true)] {
        let found = cut(from);
        assert_eq!(
            found.notes.iter().any(|note| note.contains("greatest where the blow is")),
            told,
            "{:?}",
            found.notes
        );
        assert_eq!(found.decay_rate_in_doubt.is_infinite(), told, "{}", found.decay_rate_in_doubt);
    }
}
