//! Residual modes against sums over many modes, and what they keep of a force that stands still.

use std::f64::consts::TAU;

use orthopanel_model::{Attachments, Mode, ModeRange, PanelModel, Place, TimeModel};

const BEAM: &str = r#""structure":"timoshenko-beam","constants":{"e_x":1.067e10,"g_zx":5.304e8},
    "piece":{"length":0.8,"width":0.1,"thickness":0.03,"mass_per_area":6.88}"#;
const FLOOR: &str = r#""structure":"mindlin-plate",
    "constants":{"e_x":1.07e10,"e_y":9.6e9,"nu_xy":0.31,"g_xy":3.7e9,"g_yz":2.9e8,"g_zx":5.363e8},
    "piece":{"length":2.4,"width":0.9,"thickness":0.03,"mass_per_area":6.88}"#;
const PLATE: &str = r#""structure":"mindlin-plate",
    "constants":{"e_x":1.07e10,"e_y":9.6e9,"nu_xy":0.31,"g_xy":3.7e9,"g_yz":2.9e8,"g_zx":5.363e8},
    "piece":{"length":0.8,"width":0.4,"thickness":0.03,"mass_per_area":6.88}"#;
const CLAMPED: &str = r#""structure":"timoshenko-beam","constants":{"e_x":1.067e10,"g_zx":5.304e8},
    "boundary":{"left":"clamped","right":"pinned"},
    "piece":{"length":0.8,"width":0.1,"thickness":0.03,"mass_per_area":6.88}"#;
const LOSS: &str = r#"{"id":"stiffness-loss","owner":"panel","loss":0.4,"span":0.1,"x":-0.1}"#;
const CORE: &str = r#"{"id":"viscoelastic-core","owner":"panel","strength":0.2,"tau":1e-4,"alpha":0.6}"#;
const ON_BEAM: [[f64; 2]; 2] = [[-0.31, 0.0], [0.13, 0.0]];
const ON_FLOOR: [[f64; 2]; 5] = [[-1.0, -0.35], [1.0, -0.35], [1.0, 0.35], [-1.0, 0.35], [0.4, 0.0]];

fn panel(of: &str, effects: &str) -> PanelModel {
    let text = format!(r#"{{"schema":"orthopanel.model/1",{of},"damping":{{"beyond":0.01}},"effects":[{effects}]}}"#);
    PanelModel::from_json(&text).unwrap()
}

fn places(at: &[[f64; 2]]) -> Vec<Place> {
    at.iter().map(|&[x, y]| Place { x, y }).collect()
}

/// With residual modes of the forces; `count` of them.
fn with_residual(
    panel: &PanelModel,
    modes: usize,
    (forces, responses): (&[Place], &[Place]),
    count: Option<usize>,
) -> TimeModel {
    let attachments = Attachments { places: forces.to_vec(), count, damping_ratio: 0.01 };
    let kept = panel.time_model(ModeRange::Count(modes), forces, responses).unwrap();
    kept.with_residual_modes(panel, &attachments, forces, responses).unwrap()
}

/// Driving points against 220 modes and the static part of the rest: displacement, velocity and acceleration alike, for they are
/// derivatives of each other. By the root mean square of the accelerance over the octave around, and at each line, where an antiresonance
/// leaves little to compare with.
#[test]
fn val_driving_points_are_within_one_percent_of_220_modes_up_to_four_fifths_of_the_band() {
    for (of, effects, modes, all, at) in [
        (BEAM, "", 6, 220, &ON_BEAM[..]),
        (BEAM, "", 20, 220, &ON_BEAM[..]),
        (CLAMPED, "", 6, 220, &ON_BEAM[..]),
        (BEAM, LOSS, 6, 60, &ON_BEAM[..]),
        (FLOOR, "", 20, 220, &ON_FLOOR[..]),
    ] {
        let (panel, places) = (panel(of, effects), places(at));
        let found = with_residual(&panel, modes, (&places, &places), None);
        let whole = panel.modal_model(ModeRange::Count(all), &places, &places).unwrap();
        // At a plate's point force no sum ends: both hold it on the same basis.
        let rest = whole.left_of_flexibility(panel.static_flexibility(modes, &places, &places).unwrap());
        let exact = |p: usize, f: f64| whole.accelerance(p, p, f) - (TAU * f).powi(2) * rest[p][p];
        let kept = panel.modal_model(ModeRange::Count(modes), &places, &places).unwrap();
        let top = kept.modes().last().unwrap().angular_frequency / TAU;
        for p in 0..places.len() {
            let [mut of_octave, mut of_line, mut without] = [0.0_f64; 3];
            for n in 1..=160 {
                let f = 0.8 * top * f64::from(n) / 160.0;
                let octave = (-12..=12).map(|k| exact(p, f * (f64::from(k) / 24.0).exp2()).norm_sqr());
                let rms = (octave.sum::<f64>() / 25.0).sqrt();
                let error = (found.modes.accelerance(p, p, f) - exact(p, f)).norm();
                of_octave = of_octave.max(error / rms);
                of_line = of_line.max(error / exact(p, f).norm());
                without = without.max((kept.accelerance(p, p, f) - exact(p, f)).norm() / rms);
            }
            let text = format!("{of} {effects}, {modes} modes, place {p}");
            assert!(of_octave < 0.01 && of_line < 0.02, "{text}: octave {of_octave:e}, line {of_line:e}");
            assert!(without > 0.05, "{text}: there was something to mend: {without}");
        }
    }
}

/// A force that stands still has its whole answer at all places, its own or not, and no residual mode lies among those kept.
#[test]
fn val_static_answers_are_whole() {
    let resonator = r#"{"id":"resonator","owner":"panel","mass":0.02,"frequency":400,"zeta":0.05,"x":0.1}"#;
    for (of, effects, at, tolerance) in [
        (BEAM, "", &ON_BEAM[..], 1e-9),
        (CLAMPED, "", &ON_BEAM[..], 1e-9),
        (BEAM, resonator, &ON_BEAM[..], 1e-5),
        (BEAM, LOSS, &ON_BEAM[..], 1e-9),
        // Modes and static part stand on two bases; beside the core its variables hold a part of the rest.
        (BEAM, CORE, &ON_BEAM[..], 2e-2),
        (FLOOR, "", &ON_FLOOR[..], 1e-3),
    ] {
        let (panel, forces) = (panel(of, effects), places(at));
        let responses = places(&[[0.2, 0.03], at[0]]);
        let before = panel.time_model(ModeRange::Count(6), &forces, &responses).unwrap();
        let after = with_residual(&panel, 6, (&forces, &responses), None);
        let all = panel.static_flexibility(6, &forces, &responses).unwrap();
        let [lacking, left] = [&before, &after].map(|model| model.modes.left_of_flexibility(all.clone()));
        let size = lacking.iter().flatten().fold(0.0, |most: f64, value| most.max(value.abs()));
        for left in left.iter().flatten() {
            assert!(left.abs() < tolerance * size, "{of} {effects}: {left:e} of {size:e}");
        }
        assert_eq!(after.residual, 2 * forces.len());
        let (kept, residual) = after.modes.modes().split_at(before.modes.modes().len());
        assert_eq!(kept, before.modes.modes());
        let last = panel.modes(ModeRange::Count(6)).unwrap().last().unwrap().angular_frequency();
        assert!(residual.iter().all(|mode| mode.angular_frequency > last && mode.damping_ratio == 0.01));
        assert!(residual.windows(2).all(|pair| pair[0].angular_frequency <= pair[1].angular_frequency));
    }
}

/// However many modes a plate keeps, a force brings its two, and all together yield alike at rest: to some per cent, for each basis cuts
/// the logarithm under a point force elsewhere.
#[test]
fn val_plates_of_many_modes_have_two_residual_modes_of_a_force() {
    let (panel, at) = (panel(PLATE, ""), places(&[[0.1, 0.0], [0.31, 0.12]]));
    let whole = |modes: usize| {
        let found = with_residual(&panel, modes, (&at, &at), None);
        assert_eq!(found.residual, 4, "{modes} modes");
        [0, 1].map(|p| {
            let part = |mode: &Mode| mode.at_forces[p] * mode.at_responses[p] / mode.angular_frequency.powi(2);
            found.modes.flexible().map(part).sum::<f64>()
        })
    };
    let few = whole(10);
    for modes in [20, 40, 70, 100, 150] {
        for (many, few) in whole(modes).iter().zip(few) {
            assert!((many / few - 1.0).abs() < 0.08, "{modes} modes: {many:e}, {few:e} of 10");
        }
    }
}

/// Two forces at one place, or at places that nothing moves, bring no more than they are; asked for a number, modes without shape fill up.
#[test]
fn val_forces_at_one_place_bring_their_modes_once() {
    let beam = panel(BEAM, "");
    let (one, three) = (places(&[[0.13, 0.0]]), places(&[[0.13, 0.0], [0.13, 0.02], [0.13, 0.0]]));
    let [alone, together] = [&one, &three].map(|forces| with_residual(&beam, 6, (forces, &one), None));
    assert_eq!([alone.residual, together.residual], [2, 2]);
    for f in [100.0, 1500.0, 3000.0] {
        let [alone, together] = [&alone, &together].map(|model| model.modes.accelerance(0, 0, f));
        assert!((alone - together).norm() < 1e-9 * alone.norm(), "{alone} {together}");
    }
    let filled = with_residual(&beam, 6, (&three, &one), Some(6));
    assert_eq!(filled.residual, 6);
    assert_eq!(filled.modes.accelerance(0, 0, 1500.0), together.modes.accelerance(0, 0, 1500.0));
    let held = with_residual(&panel(CLAMPED, ""), 6, (&places(&[[-0.4, 0.0]]), &one), None);
    assert_eq!(held.residual, 0, "a clamped end does not move");
}

/// Without any mode kept a held panel still has inertia.
#[test]
fn val_no_mode_kept() {
    let (panel, at) = (panel(CLAMPED, ""), places(&[[0.1, 0.0]]));
    let found = with_residual(&panel, 0, (&at, &at), None);
    let whole = panel.static_flexibility(0, &at, &at).unwrap()[0][0];
    assert_eq!(found.residual, 1);
    let mode = &found.modes.modes()[0];
    let static_answer = mode.at_forces[0] * mode.at_responses[0] / mode.angular_frequency.powi(2);
    assert!((static_answer / whole - 1.0).abs() < 1e-9);
    // Rayleigh's quotient of the static shape lies somewhat above the first frequency.
    let first = panel.modes(ModeRange::Count(1)).unwrap()[0].angular_frequency();
    assert!((1.0..1.2).contains(&(mode.angular_frequency / first)), "{}", mode.angular_frequency / first);
}
