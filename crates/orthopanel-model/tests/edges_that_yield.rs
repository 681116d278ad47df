//! Edges of a plate that yield, and that carry masses, against Levy's solution by transfer of states.

use std::f64::consts::{PI, TAU};

use orthopanel_model::{
    Boundary, EffectSetting, EffectState, End, ModifiedPanel, Piece, RecordSetting, SHEAR_COEFFICIENT, StructureKind,
    effect,
};

const PIECE: [f64; 4] = [0.8, 0.5, 0.03, 6.88];
const VALUES: [f64; 6] = [1.07e10, 8.2e9, 0.3, 2.9e9, 3.1e8, 5.363e8];

type Square = [[f64; 6]; 6];

/// What each of two edges has in all: springs \[N/m, N m/rad\] and a mass \[kg\].
#[derive(Debug, Clone, Copy, Default)]
struct Edge {
    translation: f64,
    rotation: f64,
    mass: f64,
}

fn product(a: &Square, b: &Square) -> Square {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..6).map(|k| a[i][k] * b[k][j]).sum()))
}

/// $e^A$ by Taylor's series of $A/2^n$, squared n times.
fn exponential(a: &Square) -> Square {
    let norm = a.iter().map(|row| row.iter().map(|value| value.abs()).sum::<f64>()).fold(0.0, f64::max);
    let halvings = norm.log2().ceil().max(0.0) as i32 + 3;
    let a: Square = a.map(|row| row.map(|value| value * 0.5_f64.powi(halvings)));
    let unit: Square = std::array::from_fn(|i| std::array::from_fn(|j| f64::from(u8::from(i == j))));
    let (mut sum, mut term) = (unit, unit);
    for order in 1..14 {
        term = product(&term, &a).map(|row| row.map(|value| value / f64::from(order)));
        sum.iter_mut().zip(&term).for_each(|(sum, term)| sum.iter_mut().zip(term).for_each(|(s, t)| *s += t));
    }
    (0..halvings).fold(sum, |whole, _| product(&whole, &whole))
}

/// Of $w = W\sin\beta y$, $\psi_x = X\sin\beta y$, $\psi_y = Y\cos\beta y$ between hard pinned edges $y = 0$ and $b$, the state
/// $(W, X, Y, Q_x, M_x, M_{xy})$ obeys six equations of first order along x, which Hamilton's principle gives. Springs hold $x = \pm a/2$: of the
/// three states that the centre line may have, even or odd about it, the determinant of what the springs leave is zero at a natural frequency.
/// A mass is a spring of $-m\omega^2$.
fn determinant(omega: f64, (n, is_odd): (usize, bool), Edge { translation, rotation, mass }: Edge) -> f64 {
    let ([length, width, t, density], [e_x, e_y, nu_xy, g_xy, g_yz, g_zx]) = (PIECE, VALUES);
    let bending = t.powi(3) / 12.0;
    let rest = 1.0 - nu_xy * nu_xy * e_y / e_x;
    let (d_11, d_22, d_66) = (bending * e_x / rest, bending * e_y / rest, bending * g_xy);
    let d_12 = nu_xy * d_22;
    let (a_55, a_44) = (SHEAR_COEFFICIENT * t * g_zx, SHEAR_COEFFICIENT * t * g_yz);
    let beta = n as f64 * PI / width;
    let square = omega * omega;
    let rotary = density * t * t / 12.0;
    let mut a: Square = [
        [0.0, -1.0, 0.0, 1.0 / a_55, 0.0, 0.0],
        [0.0, 0.0, d_12 * beta / d_11, 0.0, 1.0 / d_11, 0.0],
        [0.0, -beta, 0.0, 0.0, 0.0, 1.0 / d_66],
        [a_44 * beta * beta - density * square, 0.0, a_44 * beta, 0.0, 0.0, 0.0],
        [0.0, -rotary * square, 0.0, 1.0, 0.0, beta],
        [0.0; 6],
    ];
    let curvature = a[1];
    a[5] = std::array::from_fn(|j| -beta * d_12 * curvature[j]);
    a[5][0] += a_44 * beta;
    a[5][2] += a_44 + d_22 * beta * beta - rotary * square;
    let transfer = exponential(&a.map(|row| row.map(|value| 0.5 * value * length)));
    let springs = [(translation - mass * square) / width, rotation / width, rotation / width];
    // On the centre line what is of the other parity is zero.
    let free = if is_odd { [1, 3, 5] } else { [0, 2, 4] };
    // Scaled to the springs, so that stiff ones are no large numbers.
    let left = |i: usize, of: usize| {
        (transfer[i + 3][free[of]] + springs[i] * transfer[i][free[of]]) / (1.0 + springs[i].abs())
    };
    let minor = |i: usize, j: usize| left(1, i) * left(2, j) - left(1, j) * left(2, i);
    left(0, 0) * minor(1, 2) - left(0, 1) * minor(0, 2) + left(0, 2) * minor(0, 1)
}

/// All natural frequencies \[Hz\] below one.
fn levy(highest: f64, edge: Edge) -> Vec<f64> {
    let mut roots = Vec::new();
    for (n, is_odd) in (1..8).flat_map(|n| [(n, false), (n, true)]) {
        let at = |frequency: f64| determinant(TAU * frequency, (n, is_odd), edge);
        let mut low = 5.0;
        while low < highest {
            let high = low + 4.0;
            if at(low) * at(high) < 0.0 {
                let mut between = [low, high];
                for _ in 0..40 {
                    let middle = 0.5 * (between[0] + between[1]);
                    let half = usize::from(at(between[0]) * at(middle) <= 0.0);
                    between[half] = middle;
                }
                roots.push(between[0]);
            }
            low = high;
        }
    }
    roots.sort_by(f64::total_cmp);
    roots
}

/// As the tests of a panel predict them: on springs, or on ideal edges.
fn found(boundary: Boundary, springs: Option<[f64; 2]>) -> Vec<f64> {
    let yields = springs.map(|[translation, rotation]| ("support-compliance", [rotation, translation]));
    found_of((PIECE, VALUES), boundary, yields)
}

fn found_of(
    ([length, width, thickness, mass_per_area], values): ([f64; 4], [f64; 6]),
    boundary: Boundary,
    with: Option<(&str, [f64; 2])>,
) -> Vec<f64> {
    let piece = Piece { length, width, thickness, mass_per_area };
    let setting = EffectSetting { piece, boundary, suspension: vec![], record: RecordSetting::default() };
    let panel = ModifiedPanel::new(StructureKind::MindlinPlate, &setting, 14).unwrap();
    let panel = panel.perhaps_wide(&setting, &[], 2500.0);
    let state = |(id, values): (&str, [f64; 2])| EffectState::new(effect(id).unwrap(), values.to_vec(), 1).unwrap();
    let effects = with.map(state);
    let modes = panel.seen_from(&setting, &[], false, &values, effects.as_slice()).unwrap();
    modes.angular_frequency.iter().map(|omega| omega / TAU).take_while(|frequency| *frequency < 2500.0).collect()
}

/// The plate turned by a right angle: sizes and constants with x and y exchanged.
fn turned(
    ([length, width, t, mass], [e_x, e_y, nu_xy, g_xy, g_yz, g_zx]): ([f64; 4], [f64; 6]),
) -> ([f64; 4], [f64; 6]) {
    ([width, length, t, mass], [e_y, e_x, nu_xy * e_y / e_x, g_xy, g_zx, g_yz])
}

const HELD: Boundary = Boundary { left: End::Clamped, right: End::Clamped, front: End::Pinned, back: End::Pinned };

#[test]
fn val_two_edges_that_yield_follow_levy() {
    for springs in [[1e15, 1e12], [1e6, 1e4], [3e7, 2e3], [1e3, 1.0]] {
        let [translation, rotation] = springs;
        let (own, exact) = (found(HELD, Some(springs)), levy(2500.0, Edge { translation, rotation, mass: 0.0 }));
        assert!(own.len() > 8 && own.len() == exact.len(), "{} of {}", own.len(), exact.len());
        for (own, exact) in own.iter().zip(&exact) {
            assert!((own / exact - 1.0).abs() < 1e-4, "{springs:?}: {own} Hz for {exact} Hz");
        }
    }
}

/// Springs as stiff as numbers go are the clamp, and those as soft none, along either pair of edges, and of one edge.
#[test]
fn val_springs_tend_to_the_clamp_and_to_none() {
    let turned = Boundary { left: End::Pinned, right: End::Pinned, front: End::Clamped, back: End::Clamped };
    let one = Boundary { left: End::Clamped, ..Boundary::FREE };
    let around = Boundary { left: End::Clamped, right: End::Clamped, front: End::Clamped, back: End::Clamped };
    let free = |end: End| if end == End::Clamped { End::Free } else { end };
    for held in [HELD, turned, one, around] {
        let Boundary { left, right, front, back } = held;
        let none = Boundary { left: free(left), right: free(right), front: free(front), back: free(back) };
        for (springs, ideal) in [([1e15, 1e12], held), ([1e2, 1.0], none)] {
            // A free panel's motions as a whole have a low frequency on springs.
            let flexible = |frequencies: Vec<f64>| frequencies.into_iter().filter(|frequency| *frequency > 5.0);
            let (own, ideal) = (flexible(found(held, Some(springs))), flexible(found(ideal, None)));
            let count = own.zip(ideal).filter(|(own, ideal)| {
                assert!((own / ideal - 1.0).abs() < 5e-4, "{held:?} {springs:?}: {own} Hz for {ideal} Hz");
                true
            });
            let count = count.count();
            assert!(count > 6, "{held:?} {springs:?}: {count}");
        }
    }
}

/// Masses along left and right, and of the plate turned along front and back, between pinned edges: 2 % of the plate's mass in all, 10 %, and 4 % cut off.
#[test]
fn val_masses_along_two_edges_follow_levy() {
    let free = Boundary { left: End::Free, right: End::Free, ..HELD };
    let around = Boundary { left: End::Pinned, right: End::Pinned, front: End::Free, back: End::Free };
    let bare = levy(2500.0, Edge::default());
    for mass in [0.03, 0.14, -0.05] {
        let exact = levy(2500.0, Edge { mass, ..Edge::default() });
        let moved = exact.iter().zip(&bare).map(|(exact, bare)| (exact / bare - 1.0).abs()).fold(0.0, f64::max);
        assert!(moved > 5e-3, "{mass}: {moved}");
        let of_plate = (PIECE, VALUES);
        let sets = [
            found_of(of_plate, free, Some(("edge-mass", [mass, 0.0]))),
            found_of(turned(of_plate), around, Some(("edge-mass", [0.0, mass]))),
        ];
        for own in sets {
            // As many are told as the bare plate has there: a heavy edge brings more below.
            assert!(own.len() > 10 && own.len() <= exact.len(), "{mass} kg: {} of {}", own.len(), exact.len());
            for (own, exact) in own.iter().zip(&exact) {
                assert!((own / exact - 1.0).abs() < 1e-4, "{mass} kg: {own} Hz for {exact} Hz");
            }
        }
    }
}

/// Along all four edges of a free plate, of each pair another: the plate turned has the same modes, and masses of next to nothing leave it as it is.
#[test]
fn val_masses_along_all_edges_turn_with_the_plate() {
    let of_plate = (PIECE, VALUES);
    let with = |of, masses: [f64; 2]| found_of(of, Boundary::FREE, Some(("edge-mass", masses)));
    let (own, other) = (with(of_plate, [0.08, 0.03]), with(turned(of_plate), [0.03, 0.08]));
    let exchanged = with(of_plate, [0.03, 0.08]);
    assert!(own.len() > 12 && own.len() == other.len(), "{} {}", own.len(), other.len());
    assert!(own[..3].iter().all(|frequency| *frequency == 0.0), "{own:?}");
    for n in 3..own.len() {
        assert!((own[n] / other[n] - 1.0).abs() < 2e-6, "mode {n}: {} {}", own[n], other[n]);
    }
    assert!((3..own.len()).any(|n| (own[n] / exchanged[n] - 1.0).abs() > 5e-3), "pairs are told apart");
    let (bare, none) = (found(Boundary::FREE, None), with(of_plate, [1e-9, 1e-9]));
    assert!(bare.iter().zip(&none).skip(3).all(|(bare, none)| (none / bare - 1.0).abs() < 1e-5), "{bare:?} {none:?}");
}
