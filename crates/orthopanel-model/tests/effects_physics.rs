//! Each effect against an authority: closed forms, transcendental equations, the exact beam, a dense complex solution.

use std::f64::consts::TAU;

use crate::effects_bench::{Bench, CONSTANTS, PIECE, SLENDER, SLENDER_CONSTANTS, SLENDER_TOLERANCE, at};
use num_complex::Complex64;
use orthopanel_model::{
    BeamConstants, BeamTerms, Boundary, End, ExactBeam, Piece, ShearLoss, Structure, Support, TimoshenkoBeam,
    ritz_modes,
};

fn root(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    assert!(f(low) * f(high) < 0.0, "no root between {low} and {high}");
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if f(low) * f(middle) <= 0.0 { high = middle } else { low = middle }
    }
    0.5 * (low + high)
}

/// Frequency \[Hz\] of the slender beam at $\beta a$.
fn slender_frequency(beta: f64) -> f64 {
    beta * beta * (7e10 * 0.1 * 1e-9 / 12.0 / 0.27_f64).sqrt() / TAU
}

/// $1 + \cos\beta\cosh\beta + \gamma\beta(\cos\beta\sinh\beta - \sin\beta\cosh\beta) = 0$, with $\gamma = m/(\rho Aa)$:
/// Blevins (1979), table 8-8.
fn cantilever_roots(gamma: f64) -> [f64; 3] {
    let f = |b: f64| 1.0 / b.cosh() + b.cos() + gamma * b * (b.cos() * b.tanh() - b.sin());
    [(0.8, 1.9), (3.6, 4.7), (6.8, 7.9)].map(|(low, high)| root(f, low, high))
}

#[test]
fn val_cantilever_with_a_tip_mass() {
    let bench = Bench { force: 0.2, response: 0.5, ..Bench::cantilever() };
    for gamma in [0.02, 0.2, 0.45] {
        for beta in cantilever_roots(gamma) {
            bench.resonates(&[("sensor-mass", &[0.27 * gamma, 0.0])], slender_frequency(beta), SLENDER_TOLERANCE);
            bench.resonates(&[("local-mass", &[0.27 * gamma, 0.5])], slender_frequency(beta), SLENDER_TOLERANCE);
        }
    }
}

/// A cantilever's clamp that turns and a mass at its tip have one characteristic equation where $m/(\rho A) = EI/k$.
#[test]
fn val_tip_mass_and_turning_clamp_are_isospectral() {
    let bench = Bench { force: 0.2, response: 0.5, ..Bench::cantilever() };
    for gamma in [0.02, 0.3] {
        let stiffness = 7e10 * 0.1 * 1e-9 / 12.0 / gamma;
        let terms =
            BeamTerms { support: Some(Support { rotation: stiffness, translation: 1e12 }), ..BeamTerms::default() };
        let beam = TimoshenkoBeam::with_terms(&SLENDER, bench.boundary, 40, terms).unwrap();
        let modes = ritz_modes(&beam, &SLENDER_CONSTANTS, 3).unwrap();
        for (mode, beta) in modes.iter().zip(cantilever_roots(gamma)) {
            let expected = slender_frequency(beta) * TAU;
            assert!(
                (mode.angular_frequency / expected - 1.0).abs() < SLENDER_TOLERANCE,
                "{} {expected}",
                mode.angular_frequency
            );
        }
    }
}

/// Free beam with equal masses at both ends, symmetric modes: $\tan(\beta/2) + \tanh(\beta/2) = 2\gamma\beta\tan\tanh$... the
/// equation is written out from $w'''(a/2) = \gamma\beta^4w(a/2)$ for $w = A\cos\beta x + B\cosh\beta x$.
#[test]
fn val_free_beam_with_masses_at_both_ends() {
    let gamma = 0.1;
    let f = |b: f64| {
        let h = 0.5 * b;
        // Moment: −A cos h + B cosh h = 0, so A = cosh h, B = cos h (both over cosh h). Shear EI w''' = −m ω² w.
        let [third, w] = [h.sin() + h.cos() * h.tanh(), 2.0 * h.cos()];
        third + gamma * b * w
    };
    let bench = Bench { boundary: Boundary::FREE, force: 0.1, response: 0.2, ..Bench::cantilever() };
    for (low, high) in [(3.3, 4.72), (9.4, 10.99)] {
        let frequency = slender_frequency(root(f, low, high));
        bench.resonates(&[("edge-mass", &[0.27 * gamma])], frequency, SLENDER_TOLERANCE);
    }
}

/// Rigid motion on soft springs: $\omega^2 = 2k/M$ up and down, $2kd^2/J$ turning.
#[test]
fn val_bounce_and_pitch_on_soft_springs() {
    let bench = Bench { suspension: vec![at(-0.2), at(0.2)], ..Bench::panel() };
    let (mass, springs) = (PIECE.mass(), 2.0 * 10.0);
    let inertia = mass * (0.64 + 9e-4) / 12.0;
    let [bounce, pitch] = [springs / mass, springs * 0.04 / inertia].map(|omega2| omega2.sqrt() / TAU);
    // The panel's own give is (1 Hz / 321 Hz)² = 1e-5.
    let effects: &[(&str, &[f64])] = &[("suspension", &[10.0, 1e-3])];
    bench.resonates(effects, bounce, 2e-5);
    bench.resonates(effects, pitch, 2e-5);
}

/// A rigid mass on a spring with a second one on top, at the panel's centre: two degrees of freedom.
#[test]
fn val_resonator_parts_a_resonance_in_two() {
    // As good as rigid: its first mode lies at 32 kHz.
    let stiff = CONSTANTS.map(|constant| 1e4 * constant);
    let bench = Bench { constants: stiff, suspension: vec![at(0.0)], ..Bench::panel() };
    let (mass, spring, small) = (PIECE.mass(), 2000.0, 0.05);
    let own: f64 = (spring / mass).sqrt();
    let absorber = small * own * own;
    // (k + κ − Mλ)(κ − mλ) = κ²
    let (a, b, c) = (mass * small, -(mass * absorber + small * (spring + absorber)), spring * absorber);
    let root = (b * b - 4.0 * a * c).sqrt();
    for lambda in [(-b - root) / (2.0 * a), (-b + root) / (2.0 * a)] {
        let effects: &[(&str, &[f64])] =
            &[("suspension", &[spring, 1e-3]), ("resonator", &[small, own / TAU, 1e-4, 0.0])];
        bench.resonates(effects, lambda.sqrt() / TAU, 1e-6);
    }
}

/// Rotary inertia $f\rho I$ is that of a section $\sqrt f$ times as thick, with $E$ and $G$ scaled to its stiffness.
#[test]
fn val_rotary_inertia_is_that_of_a_thicker_section() {
    let factor: f64 = 2.4;
    let thicker = Piece { thickness: PIECE.thickness * factor.sqrt(), ..PIECE };
    let constants = BeamConstants { e_x: CONSTANTS[0] / factor.powf(1.5), g_zx: CONSTANTS[1] / factor.sqrt() };
    for frequency in ExactBeam::new(&thicker, Boundary::FREE, constants).unwrap().natural_frequencies(6) {
        Bench::panel().resonates(&[("rotary-inertia", &[factor])], frequency, 1e-8);
    }
}

/// A beam longer than the file says is one as long as it says, of other constants and a little less rotary inertia, hit and heard elsewhere on it.
#[test]
fn val_a_length_that_is_wrong_is_other_constants_other_places_and_a_factor() {
    let longer: f64 = 1.02;
    let panel = || Bench { zeta: 0.004, ..Bench::panel() };
    let truth = Bench { piece: Piece { length: longer * PIECE.length, ..PIECE }, ..panel() };
    let stated = Bench { constants: [CONSTANTS[0] / longer.powi(4), CONSTANTS[1] / longer.powi(2)], ..panel() };
    for frequency in [50.0, 600.0, 2222.0] {
        let s = Complex64::new(10.0, TAU * frequency);
        let expected = truth.accelerance(&[], s);
        let rotary: (&str, &[f64]) = ("rotary-inertia", &[longer.powi(-2)]);
        let found = stated.accelerance(&[("size-error", &[longer - 1.0]), rotary], s);
        assert!((found / expected - 1.0).norm() < 1e-8, "{frequency} Hz: {found} {expected}");
        let without = stated.accelerance(&[rotary], s);
        assert!((without / expected - 1.0).norm() > 1e-3, "{frequency} Hz: 16 mm must show");
    }
}

#[test]
fn val_loss_over_the_whole_length_is_a_softer_core() {
    let softer = Bench { constants: [CONSTANTS[0], 0.7 * CONSTANTS[1]], ..Bench::panel() };
    for frequency in [50.0, 600.0, 2222.0] {
        let s = Complex64::new(10.0, TAU * frequency);
        let found = Bench::panel().accelerance(&[("stiffness-loss", &[0.3, 0.8, 0.0])], s);
        let expected = softer.accelerance(&[], s);
        // Both bases are cut, at different terms, in what lies above the sum: 1e-4 of an accelerance near 1.
        assert!((found - expected).norm() < 1e-4, "{frequency} Hz: {found} {expected}");
    }
}

/// Springs from nothing to infinity lead from the free end over the pinned to the clamped one.
#[test]
fn val_supports_tend_to_the_ideal_ends() {
    let constants = BeamConstants { e_x: CONSTANTS[0], g_zx: CONSTANTS[1] };
    for (translation, rotation, left) in [(1e18, 1e18, End::Clamped), (1e18, 1e-6, End::Pinned)] {
        for right in [End::Free, End::Pinned] {
            let terms = BeamTerms { support: Some(Support { translation, rotation }), ..BeamTerms::default() };
            let clamped = Boundary { left: End::Clamped, right, ..Boundary::FREE };
            let beam = TimoshenkoBeam::with_terms(&PIECE, clamped, 40, terms).unwrap();
            let ideal = ExactBeam::new(&PIECE, Boundary { left, right, ..Boundary::FREE }, constants).unwrap();
            let mut found: Vec<f64> = ritz_modes(&beam, &CONSTANTS, 7)
                .unwrap()
                .iter()
                .map(|mode| mode.angular_frequency / TAU)
                .filter(|frequency| *frequency > 1.0)
                .collect();
            found.truncate(6);
            for (found, expected) in found.iter().zip(ideal.natural_frequencies(6)) {
                assert!((found / expected - 1.0).abs() < 1e-8, "{left:?} {right:?}: {found} {expected}");
            }
        }
    }
}

/// The closed static flexibility of an uneven beam on yielding clamps against the sum over its modes.
#[test]
fn val_static_flexibility_with_terms_is_the_sum_over_modes() {
    use orthopanel_model::Motion::{Curvature, Deflection, Rotation, Slope};
    let losses = vec![ShearLoss { loss: 0.6, span: 0.2, at: 0.1 }];
    let support = Some(Support { translation: 2e6, rotation: 1e4 });
    let ends = [End::Free, End::Clamped, End::Pinned];
    for (left, right) in ends.into_iter().flat_map(|left| ends.map(|right| (left, right))) {
        let boundary = Boundary { left, right, ..Boundary::FREE };
        let support = support.filter(|_| left == End::Clamped || right == End::Clamped);
        let terms = BeamTerms { rotary_factor: 2.0, losses: losses.clone(), support };
        let beam = TimoshenkoBeam::with_terms(&PIECE, boundary, 160, terms).unwrap();
        let available = beam.blocks()[0].size() / 2;
        let modes = ritz_modes(&beam, &CONSTANTS, available).unwrap();
        let closed = |a, b| beam.static_flexibility(&CONSTANTS, [a, b]).unwrap();
        let pairs = [((Deflection, 0.33), (Deflection, -0.11)), ((Rotation, -0.2), (Deflection, 0.21))];
        for ((first, x1), (second, x2)) in pairs {
            let of = |motion, x, mode: &[f64]| -> f64 {
                beam.motion_row(0, motion, at(x)).unwrap().iter().zip(mode).map(|(r, c)| r * c).sum()
            };
            let part = |c: &[f64]| of(first, x1, c) * of(second, x2, c);
            let flexible = modes.iter().filter(|mode| mode.angular_frequency > 0.0);
            let sum: f64 = flexible.map(|mode| part(&mode.coordinates) / mode.angular_frequency.powi(2)).sum();
            let whole = closed((first, at(x1)), (second, at(x2)));
            // Half of 320 terms, and a strain that jumps: the modes left out hold a few parts in a thousand.
            assert!((whole / sum - 1.0).abs() < 5e-3, "{left:?} {right:?} {first:?} {second:?}: {whole:e} {sum:e}");
        }
        for (motion, slope) in [(Deflection, Slope), (Rotation, Curvature)] {
            let (h, other) = (1e-3, (Rotation, at(0.21)));
            // Polynomials of fifth degree: three steps extrapolated leave rounding.
            let difference =
                |h: f64| (closed((motion, at(-0.2 + h)), other) - closed((motion, at(-0.2 - h)), other)) / (2.0 * h);
            let best = (4.0 * difference(h) - difference(2.0 * h)) / 3.0;
            let found = closed((slope, at(-0.2)), other);
            assert!((found - best).abs() <= 1e-8 * best.abs(), "{left:?} {right:?} {slope:?}: {found:e} {best:e}");
        }
    }
}

/// $(E K_E + g(s)G K_G + s^2M)\,x = f$ solved outright in the basis, against modes continued to the complex modulus.
#[test]
fn val_viscoelastic_core_against_the_dense_complex_solution() {
    let [strength, tau, alpha] = [0.8, 1.5e-4, 0.7];
    let beam = TimoshenkoBeam::new(&PIECE, Boundary::FREE, 320).unwrap();
    for frequency in [100.0, 900.0, 2000.0, 3700.0] {
        let s = Complex64::new(20.0, TAU * frequency);
        let power = (s * tau).powf(alpha);
        let g = 1.0 + strength * power / (1.0 + power);
        let mut receptance = Complex64::ZERO;
        for (index, block) in beam.blocks().iter().enumerate() {
            let size = block.size();
            let [k_e, k_g] = [&block.stiffness[0], &block.stiffness[1]];
            let dynamic = faer::Mat::from_fn(size, size, |i, j| {
                CONSTANTS[0] * k_e[(i, j)] + CONSTANTS[1] * g * k_g[(i, j)] + s * s * block.mass[(i, j)]
            });
            let force = beam.shape_row(index, at(-0.31));
            let load = faer::Mat::from_fn(size, 1, |i, _| Complex64::from(force[i]));
            use faer::linalg::solvers::Solve;
            let moved = dynamic.partial_piv_lu().solve(&load);
            receptance +=
                beam.shape_row(index, at(0.27)).iter().enumerate().map(|(i, r)| *r * moved[(i, 0)]).sum::<Complex64>();
        }
        let found = Bench::panel().accelerance(&[("viscoelastic-core", &[strength, tau, alpha])], s);
        // The dense basis is short of static flexibility: 80, 160 and 320 terms differ by 2e-4, 3e-5 and then 2e-5.
        let expected = s * s * receptance;
        assert!((found - expected).norm() < 3e-5 * expected.norm(), "{frequency} Hz: {found} {expected}");
    }
}

/// A record whose response went through $e^{-t/\tau}$: the integral over time of one mode's ringing.
#[test]
fn val_untold_window_against_a_ringing_mode_in_time() {
    let (omega, zeta, hit, tau): (f64, f64, f64, f64) = (TAU * 300.0, 0.01, 1e-3, 0.04);
    let s = Complex64::new(0.0, TAU * 290.0);
    let damped = omega * (1.0 - zeta * zeta).sqrt();
    let step = 2e-6;
    let integral: Complex64 = (0..400_000)
        .map(|i| {
            let t = (i as f64 + 0.5) * step;
            let ringing = (-zeta * omega * t).exp() * (damped * t).sin() / damped;
            ringing * (-(t + hit) / tau).exp() * (-s * (t + hit)).exp() * step
        })
        .sum();
    let seen = integral / (-s * hit).exp();
    let shifted = s + 1.0 / tau;
    let told = (-hit / tau).exp() / (shifted * shifted + 2.0 * zeta * omega * shifted + omega * omega);
    assert!((seen / told - 1.0).norm() < 1e-5);
    // The record's model does to the whole panel what the integral does to one mode.
    let bench = Bench { zeta: 0.01, ..Bench::panel() };
    let found = bench.accelerance(&[("exponential-window", &[tau])], s);
    let expected = bench.accelerance(&[], shifted) * (-hit / tau).exp();
    assert!((found / expected - 1.0).norm() < 1e-12);
}

#[test]
fn val_channel_effects_multiply() {
    let (bench, s) = (Bench { zeta: 0.005, ..Bench::panel() }, Complex64::new(5.0, TAU * 700.0));
    let plain = bench.accelerance(&[], s);
    let found = bench.accelerance(&[("channel-delay", &[3e-5]), ("gain", &[0.9]), ("high-pass", &[10.0])], s);
    let expected = plain * (-s * 3e-5).exp() * 0.9 * s / (s + TAU * 10.0);
    assert!((found / expected - 1.0).norm() < 1e-13);
}

/// The blow fell, or the sensor sits, there, and not at the place that is written down; what sits at the sensor moves with it.
#[test]
fn val_an_offset_is_another_place() {
    let sensor: (&str, &[f64]) = ("sensor-mass", &[0.02, 2e-5]);
    let bench = Bench { zeta: 0.004, ..Bench::panel() };
    let struck = Bench { force: bench.force + 4e-3, zeta: 0.004, ..Bench::panel() };
    let heard = Bench { response: bench.response - 6e-3, zeta: 0.004, ..Bench::panel() };
    for frequency in [50.0, 600.0, 2222.0] {
        let s = Complex64::new(10.0, TAU * frequency);
        for (offset, moved) in [(("hammer-offset", &[4e-3][..]), &struck), (("position-error", &[-6e-3][..]), &heard)] {
            let found = bench.accelerance(&[offset, sensor], s);
            let expected = moved.accelerance(&[sensor], s);
            assert!((found / expected - 1.0).norm() < 1e-12, "{s}: {found} {expected}");
            assert!((found / bench.accelerance(&[sensor], s) - 1.0).norm() > 1e-3, "{s}: millimetres must show");
        }
    }
}

#[test]
fn val_a_gain_of_one_record_is_none_of_another() {
    let (bench, s) = (Bench::panel(), Complex64::new(5.0, TAU * 700.0));
    let plain = bench.accelerance(&[], s);
    assert!((bench.accelerance(&[("record-gain", &[0.9, 1.0])], s) / plain - 0.9).norm() < 1e-14);
    assert_eq!(bench.accelerance(&[("record-gain", &[0.9, 2.0])], s), plain);
}

/// Reciprocity holds with any set of elements, and an element without mass or stiffness is none.
#[test]
fn val_reciprocity_and_empty_elements() {
    let s = Complex64::new(8.0, TAU * 1234.0);
    let bench = Bench { zeta: 0.004, suspension: vec![at(-0.2), at(0.25)], ..Bench::panel() };
    let turned = Bench { force: bench.response, response: bench.force, suspension: bench.suspension.clone(), ..bench };
    let effects: &[(&str, &[f64])] =
        &[("suspension", &[1e4, 3.0]), ("resonator", &[0.02, 700.0, 0.05, 0.1]), ("local-mass", &[-0.02, -0.33])];
    let (there, back) = (bench.accelerance(effects, s), turned.accelerance(effects, s));
    assert!((there / back - 1.0).norm() < 1e-12);
    let none: &[(&str, &[f64])] = &[("local-mass", &[0.0, 0.1]), ("edge-mass", &[0.0])];
    assert!((bench.accelerance(none, s) / bench.accelerance(&[], s) - 1.0).norm() < 1e-14);
}
