//! Plate modes through a model file: their names, their ports, how many a basis holds, and what is refused.

use orthopanel_model::{
    Boundary, End, MindlinPlate, ModeKind, ModeRange, ModelError, PanelModel, Piece, Place, Structure, ritz_modes,
};

const HONEYCOMB: [f64; 6] = [1.07e10, 8.2e9, 0.3, 2.9e9, 3.1e8, 5.363e8];
const CLAMPED: Boundary = Boundary { left: End::Clamped, right: End::Clamped, front: End::Clamped, back: End::Clamped };
const CANTILEVER: Boundary = Boundary { left: End::Clamped, ..Boundary::FREE };
const CORNER: Boundary = Boundary { left: End::Clamped, front: End::Pinned, ..Boundary::FREE };

fn panel(width: f64) -> PanelModel {
    PanelModel::from_json(&format!(
        r#"{{"schema": "orthopanel.model/1",
        "piece": {{"length": 0.8, "width": {width}, "thickness": 0.03, "mass_per_area": 6.88}},
        "structure": "mindlin-plate",
        "constants": {{"e_x": 1.07e10, "e_y": 8.2e9, "nu_xy": 0.3, "g_xy": 2.9e9, "g_yz": 3.1e8, "g_zx": 5.363e8}},
        "damping": {{"ratios": [0.002], "beyond": 0.003}}}}"#
    ))
    .unwrap()
}

fn piece(width: f64) -> Piece {
    panel(width).piece
}

#[test]
fn modes_of_a_narrow_panel_are_told_by_their_nodes() {
    let modes = panel(0.1).modes(ModeRange::Count(6)).unwrap();
    let told: Vec<_> = modes.iter().map(|mode| (mode.is_rigid(), mode.nodes())).collect();
    let expected = [
        (true, [0, 0]),
        (true, [1, 0]),
        (true, [0, 1]),
        (false, [2, 0]),
        (false, [3, 0]),
        (false, [1, 1]),
        (false, [4, 0]),
        (false, [2, 1]),
        (false, [5, 0]),
    ];
    assert_eq!(told, expected);
    assert_eq!(modes[3].name().unwrap().kind, ModeKind::Bending);
    assert_eq!(modes[5].name().unwrap().kind, ModeKind::Torsion);
}

/// Sign changes along the middle lines and the edges are the nodes that the name tells.
#[test]
fn val_names_are_the_sign_changes_of_the_shape() {
    let modes = panel(0.3).modes(ModeRange::Count(12)).unwrap();
    let changes = |values: Vec<f64>| values.windows(2).filter(|pair| pair[0] * pair[1] < 0.0).count();
    for mode in modes.iter().filter(|mode| mode.name().unwrap().kind != ModeKind::Mixed) {
        let [nodes_x, nodes_y] = mode.nodes();
        let steps = || (0..400).map(|i| (f64::from(i) + 0.5) / 400.0 - 0.5);
        let along_edge = changes(steps().map(|s| mode.deflection(Place { x: 0.8 * s, y: 0.15 })).collect());
        let across_end = changes(steps().map(|s| mode.deflection(Place { x: 0.4, y: 0.3 * s })).collect());
        assert_eq!([along_edge, across_end], [nodes_x, nodes_y], "{} Hz", mode.frequency());
    }
}

#[test]
fn val_overlaps_are_shares_of_one_shape() {
    let piece = piece(0.3);
    for boundary in [Boundary::FREE, CANTILEVER, CORNER, CLAMPED] {
        let plate = MindlinPlate::with_basis_for(&piece, boundary, &HONEYCOMB, 10).unwrap();
        for mode in ritz_modes(&plate, &HONEYCOMB, 10).unwrap() {
            let overlaps = plate.overlaps(&mode);
            let squares: f64 =
                overlaps.col_iter().flat_map(|column| column.iter()).map(|overlap| overlap.powi(2)).sum();
            let name = plate.mode_name(&mode);
            // All products together span the plate; the high ones left out hold a little,
            // most where the plate shears at a clamped edge, which these beam functions do not. What is left of rotary inertia
            // in the beam functions, 1e-6 of their mass, keeps them from being quite orthogonal.
            assert!((0.98..1.0 + 1e-6).contains(&squares), "{boundary:?} {name:?}: {squares}");
            assert_eq!(overlaps[(name.nodes[0], name.nodes[1])], name.overlap);
            assert!(name.overlap >= name.second_overlap && name.nodes != name.second_nodes);
        }
    }
}

/// On a square isotropic plate the modes with 2 + 0 and 0 + 2 nodes are sum and difference: neither has one name.
#[test]
fn val_pairs_of_a_square_plate_are_mixed() {
    let square = Piece { length: 0.5, width: 0.5, thickness: 0.02, mass_per_area: 54.0 };
    let isotropic = [7e10, 7e10, 0.3, 7e10 / 2.6, 7e10 / 2.6, 7e10 / 2.6];
    let plate = MindlinPlate::with_basis_for(&square, Boundary::FREE, &isotropic, 3).unwrap();
    let modes = ritz_modes(&plate, &isotropic, 3).unwrap();
    let names: Vec<_> = modes[3..].iter().map(|mode| plate.mode_name(mode)).collect();
    assert_eq!((names[0].nodes, names[0].kind), ([1, 1], ModeKind::Torsion));
    for name in &names[1..] {
        assert_eq!(name.kind, ModeKind::Mixed);
        assert!((name.overlap - name.second_overlap).abs() < 1e-9, "{name:?}");
    }
}

/// Chosen without constants, for equal stiffness, it holds those of panels not far from that.
#[test]
fn val_the_default_basis_holds_the_modes_of_panels() {
    for width in [0.1, 0.3, 0.8] {
        let piece = piece(width);
        let modes = |plate: &MindlinPlate| {
            let modes = ritz_modes(plate, &HONEYCOMB, 20).unwrap();
            modes.into_iter().skip(3).map(|mode| mode.angular_frequency).collect::<Vec<f64>>()
        };
        let chosen = MindlinPlate::with_default_basis(&piece, Boundary::FREE, 20).unwrap();
        let finer = MindlinPlate::new(&piece, Boundary::FREE, chosen.terms().map(|terms| terms + 5)).unwrap();
        for (coarse, fine) in modes(&chosen).into_iter().zip(modes(&finer)) {
            assert!(coarse / fine - 1.0 < 1e-4, "{width} {:?}: {:e}", chosen.terms(), coarse / fine - 1.0);
        }
    }
}

#[test]
fn val_the_chosen_basis_holds_its_modes() {
    let wood = [1.2e10, 6e8, 0.4, 7e8, 5e7, 6e8];
    let across = [6e8, 1.2e10, 0.02, 7e8, 6e8, 5e7];
    for boundary in [Boundary::FREE, CANTILEVER, CORNER, CLAMPED] {
        for width in [0.1, 0.3, 0.8] {
            for values in [HONEYCOMB, wood, across] {
                let piece = piece(width);
                let chosen = MindlinPlate::with_basis_for(&piece, boundary, &values, 20).unwrap();
                let finer = MindlinPlate::new(&piece, boundary, chosen.terms().map(|terms| terms + 5)).unwrap();
                let (coarse, fine) =
                    (ritz_modes(&chosen, &values, 20).unwrap(), ritz_modes(&finer, &values, 20).unwrap());
                for (c, f) in coarse.iter().zip(&fine).filter(|(_, f)| f.angular_frequency > 0.0) {
                    let difference = c.angular_frequency / f.angular_frequency - 1.0;
                    assert!(difference > -1e-9, "{boundary:?} {width} {values:?}: from above, {difference:e}");
                    assert!(difference < 1e-4, "{boundary:?} {width} {values:?} {:?}: {difference:e}", chosen.terms());
                }
            }
        }
    }
}

/// At free edges of wide thin panels the twisting moment turns into shear within a length of the order of the thickness: 14 x 7
/// terms, as many as the nodes of six modes take, leave 1e-3 to 5e-3 there.
#[test]
fn val_the_chosen_basis_follows_the_layers_at_free_edges() {
    let metal = [7e10, 7e10, 0.3, 2.7e10, 2.7e10, 2.7e10];
    for (length, width) in [(0.8, 0.2), (0.8, 0.8)] {
        for (width_over_thickness, boundary, count) in [
            (10.0, Boundary::FREE, 3),
            (30.0, Boundary::FREE, 3),
            (30.0, Boundary::FREE, 20),
            (30.0, CORNER, 6),
            (50.0, CANTILEVER, 6),
            (100.0, Boundary::FREE, 6),
        ] {
            for values in [HONEYCOMB, metal] {
                let piece = Piece { length, width, thickness: width / width_over_thickness, mass_per_area: 6.88 };
                let modes = |plate: &MindlinPlate| ritz_modes(plate, &values, count).unwrap();
                let chosen = MindlinPlate::with_basis_for(&piece, boundary, &values, count).unwrap();
                // The layers lie at x = +-a/2 and y = +-b/2 alike: both directions are refined.
                let finer = MindlinPlate::new(&piece, boundary, chosen.terms().map(|terms| terms + 8)).unwrap();
                for (c, f) in modes(&chosen).iter().zip(modes(&finer)).filter(|(_, f)| f.angular_frequency > 0.0) {
                    let difference = c.angular_frequency / f.angular_frequency - 1.0;
                    assert!(
                        difference < 1e-4,
                        "{length} x {width}, b/t {width_over_thickness}, {boundary:?}, {values:?}, {count} modes, {:?}: \
                             {difference:e}",
                        chosen.terms()
                    );
                }
            }
        }
    }
}

/// Of a panel wider than the paper's, 20 modes: each step of the basis gains more than the one before, as no power does, and
/// 24 x 12 hold them to 2e-7.
#[test]
fn val_the_basis_converges_faster_than_any_power() {
    let modes = |terms: [usize; 2]| {
        let plate = MindlinPlate::new(&piece(0.3), Boundary::FREE, terms).unwrap();
        let modes = ritz_modes(&plate, &HONEYCOMB, 20).unwrap();
        modes.into_iter().map(|mode| mode.angular_frequency).collect::<Vec<f64>>()
    };
    let fine = modes([32, 20]);
    let error = |terms: [usize; 2]| {
        let pairs = modes(terms).into_iter().zip(&fine).skip(3).map(|(coarse, fine)| coarse / fine - 1.0);
        pairs.fold(0.0, f64::max)
    };
    let errors = [[16, 8], [18, 9], [20, 10], [24, 12]].map(error);
    assert!(errors[1] < 1e-4 && errors[3] < 2e-7, "{errors:?}");
    assert!(errors.windows(2).all(|pair| pair[1] < 0.4 * pair[0]), "{errors:?}");
}

#[test]
fn a_range_up_to_a_frequency_holds_all_modes_below() {
    let panel = panel(0.3);
    let counted = panel.modes(ModeRange::Count(25)).unwrap();
    let ranged = panel.modes(ModeRange::UpTo(3000.0)).unwrap();
    let below: Vec<_> = counted.iter().take_while(|mode| mode.frequency() < 3000.0).collect();
    assert_eq!(ranged.len(), below.len());
    for (found, expected) in ranged.iter().zip(below) {
        assert!((found.frequency() - expected.frequency()).abs() <= 1e-4 * expected.frequency());
    }
}

#[test]
fn val_accelerance_between_two_corners_is_reciprocal_and_rigid_at_zero() {
    let panel = panel(0.3);
    let [one, other] = [Place { x: -0.4, y: -0.15 }, Place { x: 0.3, y: 0.12 }];
    let forth = panel.modal_model(ModeRange::Count(12), &[one], &[other]).unwrap();
    let back = panel.modal_model(ModeRange::Count(12), &[other], &[one]).unwrap();
    for frequency in [0.0, 150.0, 408.0, 1400.0] {
        let (forth, back) = (forth.accelerance(0, 0, frequency), back.accelerance(0, 0, frequency));
        assert!((forth - back).norm() < 1e-12 * forth.norm());
    }
    // A rigid rectangle with its rotary inertia, about its centre.
    let Piece { length, width, thickness, .. } = panel.piece;
    let turn = |a: f64, x: f64, y: f64| 12.0 * x * y / (a * a + thickness * thickness);
    let rigid = (1.0 + turn(length, one.x, other.x) + turn(width, one.y, other.y)) / panel.piece.mass();
    assert!((forth.accelerance(0, 0, 0.0).re / rigid - 1.0).abs() < 1e-9);
}

#[test]
fn what_a_plate_cannot_do_is_refused_with_its_limit() {
    let panel = panel(0.3);
    let off = panel.modal_model(ModeRange::Count(4), &[Place { x: 0.0, y: 0.16 }], &[]);
    assert!(matches!(off, Err(ModelError::OffPiece { y: 0.16, .. })));
    let Err(ModelError::BasisTooSmall { asked: 900, available }) = panel.modes(ModeRange::Count(900)) else {
        panic!("900 modes are more than a basis holds");
    };
    assert!(panel.modes(ModeRange::Count(available + 1)).is_err());
    let Err(ModelError::BeyondBasis { reached, .. }) = panel.modes(ModeRange::UpTo(1e5)) else {
        panic!("100 kHz lies beyond");
    };
    assert!(panel.modes(ModeRange::UpTo(0.9 * reached)).is_ok());
    let plate = MindlinPlate::new(&panel.piece, Boundary::FREE, [8, 6]).unwrap();
    let error = ritz_modes(&plate, &HONEYCOMB, 20).unwrap_err();
    assert_eq!(error, ModelError::BasisTooSmall { asked: 20, available: plate.resolved_modes() });
    for terms in [[3, 8], [8, 200]] {
        assert!(matches!(MindlinPlate::new(&panel.piece, Boundary::FREE, terms), Err(ModelError::TermCount { .. })));
    }
}

/// A strip's modes all have their nodes along it: more of them than polynomials follow are refused with the number that can be had. A
/// trace that looked for the plate behind saturated records ended with the number of polynomials as its error.
#[test]
fn more_modes_of_a_strip_than_polynomials_follow_are_refused_with_their_number() {
    let strip = Piece { length: 0.8, width: 0.01, thickness: 0.003, mass_per_area: 6.88 };
    let built = |count: usize| MindlinPlate::with_basis_for(&strip, Boundary::FREE, &HONEYCOMB, count);
    for count in 20..120 {
        match built(count) {
            Ok(_) => continue,
            Err(ModelError::BasisTooSmall { asked, available }) => {
                assert!(asked == count && available < count && built(available).is_ok(), "{count}: {available}");
            }
            Err(error) => panic!("{count}: {error}"),
        }
    }
    assert!(built(120).is_err());
}

/// The word follows what the width does: a clamped edge along it lets it neither move nor turn as one.
#[test]
fn val_the_kind_of_a_mode_is_what_its_width_does() {
    let kinds = |front: End, back: End| -> Vec<([usize; 2], ModeKind)> {
        let mut model = panel(0.3);
        (model.boundary.front, model.boundary.back) = (front, back);
        let modes = model.modes(ModeRange::Count(6)).unwrap();
        let flexible = modes.iter().filter(|mode| !mode.is_rigid());
        flexible
            .map(|mode| (mode.nodes(), mode.name().unwrap().kind))
            .filter(|(_, kind)| *kind != ModeKind::Mixed)
            .collect()
    };
    let held = kinds(End::Clamped, End::Free);
    assert!(held.len() > 3 && held.iter().all(|(_, kind)| *kind == ModeKind::Transverse), "{held:?}");
    let hinged = kinds(End::Pinned, End::Free);
    let of = |nodes: [usize; 2]| hinged.iter().find(|line| line.0 == nodes).map(|line| line.1);
    assert_eq!(of([1, 0]), Some(ModeKind::Torsion), "{hinged:?}");
    assert!(hinged.iter().all(|(nodes, kind)| (nodes[1] == 0) == (*kind == ModeKind::Torsion)), "{hinged:?}");
}
