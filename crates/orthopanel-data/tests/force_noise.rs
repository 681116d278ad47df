//! Noise of the force's channel: a window over the blow, what the noise makes too low, and how it ties lines together.

use crate::support::hammer::{Noise, Resonator, history};
use num_complex::Complex64;
use orthopanel_data::{Accelerance, DataError, Estimation, Hit, Window};

const DAMPED: Resonator = Resonator { radius: 0.9, angle: 0.5 };
const AS_NEEDED: Estimation =
    Estimation { window: Window::AsNeeded, estimator: orthopanel_data::Estimator::H1, force_drop: 30.0 };
/// 0.6 s of quiet before the blow.
const SAMPLES: usize = 3000;

/// Hits of several strengths with this noise of the force \[N\], and hardly any on the response.
fn hits(noise: &mut Noise, strengths: &[f64], force: f64) -> Vec<Hit> {
    strengths.iter().map(|&height| noise.over(&DAMPED.hit(SAMPLES, height), force, 1e-4)).collect()
}

#[test]
fn val_the_force_is_windowed_where_its_noise_counts() {
    let quiet = history(hits(&mut Noise(1), &[100.0, 100.0], 0.01)).accelerance(AS_NEEDED).unwrap();
    assert_eq!((&quiet.force_noise, quiet.decay_rate), (&None, 0.0));
    let noisy = history(hits(&mut Noise(1), &[100.0, 100.0], 1.0)).accelerance(AS_NEEDED).unwrap();
    assert!(noisy.force_noise.is_some_and(|noise| (0.03..0.1).contains(&noise.half_width)));
    assert!(noisy.notes.iter().any(|note| note.contains("the force is kept within")), "{:?}", noisy.notes);
}

/// Two per cent of the blow, 0.3 s after it, is too little for a double hit. Without a window it does no harm; a window takes it from
/// the force, but not from the response.
#[test]
fn val_a_push_that_a_force_window_cuts_off_is_said() {
    let noise = &mut Noise(3);
    let touched = |noise: &mut Noise, second: f64| {
        let mut force = DAMPED.hit(SAMPLES, 100.0).force;
        for n in 0..SAMPLES - 300 {
            let push = second * DAMPED.hit(SAMPLES, 100.0).force[n];
            force[n + 300] += push;
        }
        noise.over(&DAMPED.respond(force), 0.03, 1e-4)
    };
    let force_window = Estimation { window: Window::Force { half_width: 0.1 }, ..Estimation::default() };
    for (second, said) in [(0.02, true), (0.0, false)] {
        let hits = history(vec![touched(noise, 0.0), touched(noise, second)]);
        let notes = hits.accelerance(force_window).unwrap().notes;
        let told = notes.iter().find(|note| note.contains("cuts off a push"));
        assert_eq!(told.is_some(), said, "{notes:?}");
        assert!(
            told.is_none_or(|note| note.contains("hit 2") && note.contains("of 2.") && note.contains("300 ms after")),
            "{told:?}"
        );
        let notes = hits.accelerance(Estimation::default()).unwrap().notes;
        assert!(notes.iter().all(|note| !note.contains("cuts off")), "{notes:?}");
    }
}

/// A blow in the middle of a record whose response rings on: the exponential begins at the blow. From the record's start it made
/// the blow smaller than the noise before it.
#[test]
fn val_the_exponential_begins_at_the_blow() {
    let ringing = Resonator { radius: 0.999, angle: 0.5 };
    let late = |noise: &mut Noise| {
        let mut force = vec![0.0; 4000];
        force.extend(ringing.hit(4000, 100.0).force);
        noise.over(&ringing.respond(force), 0.05, 0.05)
    };
    let noise = &mut Noise(4);
    let found = history((0..4).map(|_| late(noise)).collect()).accelerance(AS_NEEDED).unwrap();
    assert!(found.decay_rate > 0.0);
    let errors: Vec<f64> = found
        .frequency
        .iter()
        .zip(&found.value)
        .map(|(&frequency, value)| (value / ringing.transfer(found.decay_rate, frequency) - 1.0).norm())
        .collect();
    let rms = mean(errors.iter().map(|error| error * error)).sqrt();
    // Noise of 0.05 under the exponential leaves 0.05; from the record's start on, noise is all there is.
    assert!(rms < 0.1, "{rms}");
}

/// The force's spectrum drowns in its noise: nothing can be divided by it.
#[test]
fn val_a_force_below_its_noise_is_refused_with_the_number() {
    // A blow of one sample's width, twenty-five times its noise, over hundreds of samples of it.
    let blow = |noise: &mut Noise| {
        let force: Vec<f64> = (0..SAMPLES).map(|n| if n == 600 { 25.0 } else { 0.0 }).collect();
        noise.over(&DAMPED.respond(force), 1.0, 1e-4)
    };
    let noise = &mut Noise(2);
    let refused = history(vec![blow(noise), blow(noise)]).accelerance(AS_NEEDED);
    match refused {
        Err(DataError::NoUsableHit { reasons, .. }) => assert!(reasons.contains("too much noise"), "{reasons}"),
        Ok(found) => assert!(found.force_noise.is_some(), "kept without a word"),
        Err(other) => panic!("{other}"),
    }
}

/// The quotient at a line over the truth, of many accelerances.
fn errors(found: &[Accelerance], line: usize) -> Vec<Complex64> {
    found.iter().map(|of| of.value[line] / DAMPED.transfer(0.0, of.frequency[line]) - 1.0).collect()
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count): (f64, f64), value| (sum + value, count + 1.0));
    sum / count
}

const REPETITIONS: usize = 1000;

/// Bias, variance and correlation of lines as stated, against many repetitions with three unequal hits.
#[test]
fn val_what_is_stated_of_the_forces_noise_is_what_repetitions_show() {
    let noise = &mut Noise(3);
    let window = Estimation { window: Window::Force { half_width: 0.05 }, ..AS_NEEDED };
    let repeat = |_| history(hits(noise, &[220.0, 300.0, 400.0], 6.0)).accelerance(window).unwrap();
    let found: Vec<Accelerance> = (0..REPETITIONS).map(repeat).collect();
    for of in &found {
        assert_eq!(of.hits, 3, "{:?}", of.notes);
    }
    let line_at = |frequency: f64| found[0].frequency.partition_point(|&line| line < frequency - 1e-6);
    // Ten lines that the window ties together by no more than a fifth.
    let (mut biases, mut variances, mut stated_biases, mut quotients) = (vec![], vec![], vec![], vec![]);
    for line in (2..12).map(|ten| line_at(10.0 * f64::from(ten))) {
        let own = errors(&found, line);
        let noises = || found.iter().map(|of| of.force_noise.as_ref().unwrap());
        let transfer = DAMPED.transfer(0.0, found[0].frequency[line]).norm_sqr();
        let variance = mean(own.iter().map(|error| error.norm_sqr()));
        quotients.push(mean(noises().map(|noise| noise.variance[line])) / transfer / variance);
        biases.push(-mean(own.iter().map(|error| error.re)));
        stated_biases.push(mean(found.iter().map(|of| of.bias.as_ref().unwrap()[line])));
        variances.push(variance);
    }
    let of = |values: &[f64]| mean(values.iter().copied());
    // Ten lines of a thousand repetitions tell a variance to 1 %; the noise's second order is a hundredth or two.
    assert!((of(&quotients) - 1.0).abs() < 0.06, "{quotients:?}");
    let known = (of(&variances) / 2.0 / (10 * REPETITIONS) as f64).sqrt();
    let (bias, stated) = (of(&biases), of(&stated_biases));
    assert!(bias > 5.0 * known, "no bias to be told: {bias} +- {known}");
    assert!((bias - stated).abs() < 4.0 * known, "{bias} +- {known}, stated {stated}");

    // sinc(2 h df): 0.1 s ties lines 5 Hz apart to 2/pi, those 10 Hz apart not at all.
    for (apart, expected) in [(5.0, std::f64::consts::FRAC_2_PI), (10.0, 0.0)] {
        let (own, other) = (errors(&found, line_at(60.0)), errors(&found, line_at(60.0 + apart)));
        let tied = mean(own.iter().zip(&other).map(|(a, b)| (a.conj() * b).re));
        let size = |errors: &[Complex64]| mean(errors.iter().map(|error| error.norm_sqr())).sqrt();
        let correlation = tied / (size(&own) * size(&other));
        assert!((correlation - expected).abs() < 0.1, "{apart} Hz: {correlation}");
    }
}

/// All of the record's noise comes into S_ff without a force window, and under an exponential over the whole force what that leaves.
#[test]
fn val_the_bias_is_stated_without_a_force_window_too() {
    let noise = &mut Noise(5);
    let whole = Window::ForceExponential { half_width: 10.0, tau: 0.4 };
    for (window, force) in [(Window::None, 1.1), (whole, 2.0)] {
        let repeat = |_| {
            let hits = hits(noise, &[220.0, 300.0, 400.0], force);
            history(hits).accelerance(Estimation { window, ..AS_NEEDED }).unwrap()
        };
        let found: Vec<Accelerance> = (0..REPETITIONS).map(repeat).collect();
        // Lines are independent here, or nearly: two hundred of them in place of so many more repetitions.
        let lines = 100..300;
        let known =
            |line: usize, error: &Complex64| error / DAMPED.transfer(found[0].decay_rate, found[0].frequency[line]);
        let mean_of = |each: &dyn Fn(&Accelerance, usize) -> f64| {
            mean(found.iter().flat_map(|of| lines.clone().map(move |line| (of, line))).map(|(of, line)| each(of, line)))
        };
        let bias = mean_of(&|of, line| 1.0 - known(line, &of.value[line]).re);
        let square = mean_of(&|of, line| (1.0 - known(line, &of.value[line])).norm_sqr());
        let stated = mean_of(&|of, line| of.bias.as_ref().unwrap()[line]);
        let uncertain = (square / 2.0 / (found.len() * lines.len()) as f64).sqrt();
        assert!(bias > 10.0 * uncertain, "no bias to be told: {bias} +- {uncertain}");
        // Of second order are 5 % of it.
        assert!((bias / stated - 1.0).abs() < 0.06, "{window:?}: {bias} +- {uncertain}, stated {stated}");
        assert!(found.iter().all(|of| of.force_noise.is_none()));
    }
}
