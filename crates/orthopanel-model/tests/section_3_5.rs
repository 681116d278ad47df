//! Section 3.5: the finite element model with modal damping under a blow, by Runge-Kutta and by the exact stepper.

use std::collections::BTreeMap;

use orthopanel_model::{
    BeamConstants, BeamElements, Boundary, Damping, Estimate, ForceRecord, MODEL_SCHEMA, ModalModel, Mode, ModeRange,
    ModelError, PanelModel, Piece, Place, Ports, StructureKind,
};
use proptest::prelude::*;

/// Piece 1 of table 3 with its column of table 9.
const PIECE: Piece = Piece { length: 0.8, width: 0.1, thickness: 0.03, mass_per_area: 6.880 };
const CONSTANTS: BeamConstants = BeamConstants { e_x: 1.067e10, g_zx: 5.304e8 };
const ZETAS: [f64; 6] = [2.364e-3, 1.306e-3, 1.108e-3, 2.251e-3, 5.485e-3, 4.488e-3];

fn damping() -> Damping {
    Damping { ratios: ZETAS.to_vec(), ..Damping::default() }
}

/// The places of figures 9 to 12.
fn ports() -> Ports {
    Ports { forces: vec![Place { x: -0.3, y: 0.0 }], responses: vec![Place { x: 0.3, y: 0.0 }] }
}

/// The exact beam with the two rigid and six flexible modes of the paper.
fn exact() -> ModalModel {
    let constant = |value| Estimate { value, std: None };
    let constants = [("e_x".into(), constant(CONSTANTS.e_x)), ("g_zx".into(), constant(CONSTANTS.g_zx))];
    let panel = PanelModel {
        name: None,
        schema: MODEL_SCHEMA.into(),
        piece: PIECE,
        boundary: Boundary::FREE,
        structure: StructureKind::TimoshenkoBeam,
        constants: constants.into(),
        damping: damping(),
        correlation: None,
        effects: Vec::new(),
        ports: ports(),
        provenance: BTreeMap::new(),
    };
    panel.modal_model(ModeRange::Count(6), &panel.ports.forces, &panel.ports.responses).unwrap()
}

fn elements(count: usize) -> ModalModel {
    let structure = BeamElements::new(&PIECE, Boundary::FREE, count).unwrap();
    ModalModel::of_structure(&structure, &[CONSTANTS.e_x, CONSTANTS.g_zx], 6, &damping(), &ports()).unwrap()
}

/// A half-sine blow of 100 N and 0.2 ms after 1 ms of rest, 20 ms in all, sampled at 65 kHz.
fn blow() -> ForceRecord {
    let rate = 65536.0;
    let force = |n: i32| {
        let phase = (f64::from(n) / rate - 1e-3) / 2e-4;
        if (0.0..1.0).contains(&phase) { 100.0 * (std::f64::consts::PI * phase).sin() } else { 0.0 }
    };
    ForceRecord::new(1.0 / rate, vec![(0..1311).map(force).collect()]).unwrap()
}

/// Largest difference over the peak of `reference`.
fn difference(values: &[Vec<f64>], reference: &[Vec<f64>]) -> f64 {
    let pairs = values.iter().flatten().zip(reference.iter().flatten());
    let peak = reference.iter().flatten().fold(0.0_f64, |peak, value| peak.max(value.abs()));
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / peak
}

#[test]
fn val_runge_kutta_meets_the_exact_stepper_at_its_converged_step() {
    let (model, record) = (elements(32), blow());
    let exact = model.acceleration_under(&record).unwrap();
    let error = |steps| difference(&model.acceleration_by_runge_kutta(&record, steps).unwrap(), &exact);
    let errors = [4, 8, 16, 32].map(error);
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((3.9..4.1).contains(&order), "order {order}, errors {errors:?}");
    }
    let converged = error(64);
    assert!(converged < 1e-8, "{converged:e} of the peak, errors before {errors:?}");
}

#[test]
fn val_elements_answer_a_blow_as_the_exact_beam_does() {
    let record = blow();
    let exact = exact().acceleration_under(&record).unwrap();
    let error = |count| difference(&elements(count).acceleration_under(&record).unwrap(), &exact);
    // The element's length halves from one to the next; frequencies, and with them phases, converge with its fourth
    // power.
    let errors = [16, 32, 64, 128].map(error);
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((3.8..4.2).contains(&order), "order {order}, errors {errors:?}");
    }
    // A hundredth of a per cent is below what any hammer test resolves.
    assert!(errors[3] < 1e-4, "128 elements: {:e} of the peak", errors[3]);
}

#[test]
fn val_a_structure_is_seen_as_the_exact_beam_is() {
    let (by_elements, exact) = (elements(64), exact());
    assert_eq!(by_elements.modes().len(), 8);
    for (a, b) in by_elements.modes().iter().zip(exact.modes()) {
        assert_eq!(a.damping_ratio, b.damping_ratio);
        let (a, b) = (a.angular_frequency, b.angular_frequency);
        // Twenty elements a wave and the fourth power: some 20^-4.
        assert!((a - b).abs() <= 6e-6 * b, "{a} {b}");
    }
    let ratios: Vec<f64> = by_elements.modes().iter().map(|mode| mode.damping_ratio).collect();
    assert_eq!(ratios[..2], [0.0, 0.0]);
    assert_eq!(ratios[2..], ZETAS);
}

#[test]
fn records_that_make_no_sense_are_refused() {
    let of = |interval, forces| ForceRecord::new(interval, forces);
    for interval in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(of(interval, vec![vec![0.0]]), Err(ModelError::Size { name: "sampling interval", .. })));
    }
    let unequal = of(1.0, vec![vec![0.0; 3], vec![0.0; 2]]).unwrap_err();
    assert!(matches!(unequal, ModelError::RecordLength { port: 2, found: 2, expected: 3 }), "{unequal}");
    assert!(matches!(of(1.0, vec![vec![f64::NAN]]), Err(ModelError::NotFinite { what: "force", .. })));

    let (model, record) = (exact(), blow());
    let two = ForceRecord::new(1.0, vec![vec![0.0]; 2]).unwrap();
    for refused in [model.acceleration_under(&two), model.acceleration_by_runge_kutta(&two, 1)] {
        assert!(matches!(refused, Err(ModelError::ForceCount { found: 2, expected: 1 })));
    }
    assert!(matches!(model.acceleration_by_runge_kutta(&record, 0), Err(ModelError::Size { .. })));
}

#[test]
fn a_step_too_long_is_refused_and_the_one_named_is_stable() {
    let model = exact();
    // 0.5 ms between samples: 12 rad at mode 6.
    let record = ForceRecord::new(5e-4, vec![[&[1.0][..], &[0.0; 2000]].concat()]).unwrap();
    let refused = model.acceleration_by_runge_kutta(&record, 1).unwrap_err();
    let ModelError::UnstableStep { needed, .. } = refused else { panic!("{refused}") };
    assert!(model.acceleration_by_runge_kutta(&record, needed - 1).is_err());
    let accelerations = model.acceleration_by_runge_kutta(&record, needed).unwrap();
    let rms = |part: &[f64]| part.iter().map(|value| value * value).sum::<f64>().sqrt();
    let (first, last) = accelerations[0].split_at(1000);
    assert!(rms(last) < rms(first), "it grows");
}

proptest! {
    /// Runge-Kutta at a fine step is the exact answer for any damped mode and any force.
    #[test]
    fn val_runge_kutta_is_the_exact_answer_in_the_limit(
        omega in 0.0..3.0_f64, zeta in 0.0..0.7_f64, shapes in [-1.0..1.0_f64, -1.0..1.0, 0.2..1.0],
        forces in prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64), 2..20),
    ) {
        let mode = Mode {
            angular_frequency: omega,
            damping_ratio: zeta,
            at_forces: shapes[..2].to_vec(),
            at_responses: vec![shapes[2]],
        };
        let model = ModalModel::new(2, 1, vec![mode]).unwrap();
        let (first, second) = forces.into_iter().unzip();
        let record = ForceRecord::new(1.0, vec![first, second]).unwrap();
        let exact = model.acceleration_under(&record).unwrap();
        let by_steps = model.acceleration_by_runge_kutta(&record, 600).unwrap();
        for (a, b) in by_steps[0].iter().zip(&exact[0]) {
            // omega h is 0.005 at most: 19 of its fourth power over 120 a unit of time, over 19 units; modal forces
            // are at most 2 and amplitudes at most ten times that.
            prop_assert!((a - b).abs() < 20.0 * 57.0 * 0.005_f64.powi(4) / 120.0 + 1e-11, "{a} {b}");
        }
    }
}
