//! Hits of one place that do not agree: one alone is left out, two groups are refused, two hits are told.

use crate::support::hammer::{Noise, Resonator, history};
use orthopanel_data::{Estimation, Hit, HitVerdict, TimeHistory};

const PIECE: Resonator = Resonator { radius: 0.97, angle: 0.5 };
const ELSEWHERE: Resonator = Resonator { radius: 0.97, angle: 2.2 };

fn hit(piece: Resonator, height: f64, seed: u64) -> Hit {
    Noise(seed).over(&piece.hit(2000, height), 0.005, 0.02)
}

/// The one sample of the force that its channel cuts off: nothing in the hit itself tells.
fn cut_off(mut hit: Hit, at: f64) -> Hit {
    let top = hit.force.iter().copied().fold(0.0, f64::max);
    hit.force.iter_mut().for_each(|force| *force = force.min(at * top));
    hit
}

/// Notes, hits that took part, and the median line's error.
fn notes(hits: Vec<Hit>) -> (Vec<String>, usize, f64) {
    let found = history(hits).accelerance(Estimation::default()).unwrap();
    let mut errors: Vec<f64> = found
        .frequency
        .iter()
        .zip(&found.value)
        .map(|(&frequency, value)| (value / PIECE.transfer(0.0, frequency) - 1.0).norm())
        .collect();
    errors.sort_by(f64::total_cmp);
    let median = errors[errors.len() / 2];
    (found.notes, found.hits, median)
}

#[test]
fn val_hits_alike_are_kept_and_nothing_is_said() {
    for seed in 0..40 {
        let hits = [80.0, 100.0, 130.0].iter().zip(1..).map(|(&height, n)| hit(PIECE, height, 10 * seed + n));
        let (notes, kept, _) = notes(hits.collect());
        assert_eq!((notes.len(), kept), (0, 3), "{notes:?}");
    }
}

#[test]
fn val_a_hit_whose_crest_was_cut_off_is_left_out_of_three() {
    let good = |seed| hit(PIECE, 100.0 + seed as f64, seed);
    // The top two samples of the pulse are 0.6 and 0.72 of its height: at 0.85 of the top one sample is cut.
    let cut = cut_off(good(2), 0.85);
    let cut_alone = cut.faults(1000.0);
    let (notes, kept, error) = notes(vec![good(1), cut, good(3)]);
    assert_eq!(kept, 2, "{notes:?}");
    if cut_alone.is_empty() {
        assert!(notes[0].contains("hit 2 left out: its accelerance is"), "{notes:?}");
        assert!(notes[0].contains("above that of the other hits over the whole band"), "{notes:?}");
    }
    assert!(error < 0.03, "{error}");
}

#[test]
fn val_of_two_hits_that_differ_neither_is_left_out_but_it_is_said() {
    let mut stronger = hit(PIECE, 120.0, 2);
    stronger.acceleration.iter_mut().for_each(|a| *a *= 1.15);
    let (notes, kept, _) = notes(vec![hit(PIECE, 100.0, 1), stronger]);
    assert_eq!(kept, 2);
    assert!(notes[0].contains("hit 1, hit 2 differ by 1"), "{notes:?}");
    assert!(notes[0].contains("nothing tells which is right"), "{notes:?}");
}

#[test]
fn val_a_hit_of_another_place_is_left_out_and_two_groups_are_refused() {
    let (here, there) = (|seed| hit(PIECE, 100.0, seed), |seed| hit(ELSEWHERE, 100.0, seed));
    let (notes, kept, error) = notes(vec![there(1), here(2), here(3)]);
    assert_eq!(kept, 2, "{notes:?}");
    assert!(notes[0].contains("hit 1 left out: its accelerance differs by"), "{notes:?}");
    assert!(error < 0.03, "{error}");
    let mut all = history(vec![here(1), here(2)]);
    all.join(TimeHistory { file: "other.csv".into(), ..history(vec![there(3), there(4)]) }).unwrap();
    let said = all.accelerance(Estimation::default()).unwrap_err().to_string();
    assert!(said.contains("hit 3 (other.csv), hit 4 (other.csv) differ by"), "{said}");
    assert!(said.contains("they belong to another place; correct force_at or response_at"), "{said}");
}

/// What a hit is told to be is what became of it in the accelerance, whatever found its fault.
#[test]
fn verdicts_are_those_that_the_accelerance_stands_on() {
    let (here, there) = (|seed| hit(PIECE, 100.0, seed), hit(ELSEWHERE, 100.0, 1));
    let of = history(vec![here(2), there.clone(), here(3)]);
    let kept = |verdicts: Vec<HitVerdict>| verdicts.iter().map(HitVerdict::is_kept).collect::<Vec<_>>();
    assert_eq!(kept(of.verdicts()), [true, false, true]);
    let accelerance = of.accelerance(Estimation::default()).unwrap();
    assert_eq!(of.kept_in(&accelerance).hits, [here(2), here(3)]);
    let [left_out] = &of.left_out_of(&accelerance.verdicts)[..] else { panic!("{accelerance:?}") };
    assert!(left_out.starts_with("hit 2 left out: its accelerance differs by"), "{left_out}");
    assert_eq!(kept(accelerance.verdicts), [true, false, true]);
    // Two groups make no accelerance; each hit by itself is without fault.
    let parted = history(vec![here(2), here(3), there, hit(ELSEWHERE, 100.0, 4)]);
    assert_eq!(kept(parted.verdicts()), [true; 4]);
}
