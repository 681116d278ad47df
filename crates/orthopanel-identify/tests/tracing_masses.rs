//! A cantilever with six masses, of which one was taken off: which, told by five natural frequencies.
//!
//! Real: Sousa and Machado, Data in Brief 2024, 110043, by github BalakumaranM/Transformer-based-Structural-Health-
//! Monitoring-using-Frequency-Response-Function-FRF, commit 3ad1fac0 (MIT). The masses sit at other places in each sample.

mod support;

use std::fmt::Write;
use std::path::{Path, PathBuf};

use orthopanel_data::{Estimation, ImpactTest};
use orthopanel_identify::{Settings, Tracing, Verdict, identify, trace};
use support::shared_data;

const LENGTH: f64 = 0.38;
/// Aluminium, since neither material nor width is stated: frequencies tell ratios only.
const PIECE: &str = "[piece]\nlength = 0.38\nwidth = 0.03\nthickness = 0.00475\nmass_per_area = 12.825\n\
                     [boundary]\nleft = \"clamped\"\nright = \"free\"\n";
const BEAM_MASS: f64 = 12.825 * 0.38 * 0.03;
/// Each mass is 2.96 % of beam and masses together.
const EACH: f64 = 0.0296 / (1.0 - 6.0 * 0.0296) * BEAM_MASS;
/// Where each resonance lies \[Hz\]. The sixth does not stand out in all records.
const WITHIN: [(f64, f64); 5] = [(15.0, 30.0), (110.0, 170.0), (330.0, 430.0), (650.0, 850.0), (1000.0, 1300.0)];

/// Samples by their number: those that tell the base and its scatter, and those that are judged.
fn base_samples() -> impl Iterator<Item = usize> {
    (1..=40).step_by(2)
}

fn judged_samples() -> impl Iterator<Item = usize> {
    (2..=40).step_by(2)
}

struct Rig {
    folder: PathBuf,
    /// From the clamp \[m\].
    places: Vec<Vec<f64>>,
}

/// What the samples with all masses say: modulus, rotation and translation stiffness of the clamp, and by how much each
/// frequency then misses \[1\].
struct Base {
    values: [f64; 3],
    scatter: [f64; 5],
}

impl Rig {
    fn read(folder: PathBuf) -> Self {
        let text = std::fs::read_to_string(folder.join("positions_m.csv")).unwrap();
        let rows = text.lines().filter(|line| !line.starts_with('#'));
        Self { places: rows.map(|row| row.split(',').map(|x| x.trim().parse().unwrap()).collect()).collect(), folder }
    }

    fn frequencies(&self, kind: &str, sample: usize) -> Vec<f64> {
        resonances(&self.folder.join(kind).join(format!("sample-{sample:02}.uff")))
    }

    /// A test of these frequencies with all six masses declared.
    fn test(&self, sample: usize, frequencies: &[f64], base: Option<&Base>) -> ImpactTest {
        let mut text = PIECE.to_owned();
        let clamp = base.map_or(String::new(), |Base { values: [e_x, rotation, translation], .. }| {
            writeln!(text, "[constants]\ne_x = {e_x}\ng_zx = 2.6e10").unwrap();
            format!("rotation = {rotation}\ntranslation = {translation}\n")
        });
        if base.is_none() {
            text += "[constants]\ng_zx = 2.6e10\n";
        }
        write!(text, "[[effect]]\nid = \"support-compliance\"\n{clamp}").unwrap();
        for place in &self.places[sample - 1] {
            writeln!(text, "[[effect]]\nid = \"local-mass\"\nmass = {EACH}\nx = {}", place - 0.5 * LENGTH).unwrap();
        }
        write!(text, "[[measurement]]\nkind = \"natural-frequencies\"\nvalues = {frequencies:?}\n").unwrap();
        if let Some(base) = base {
            let scatter: Vec<f64> = base.scatter.iter().zip(frequencies).map(|(part, f)| part * f).collect();
            writeln!(text, "scatter = {scatter:?}").unwrap();
        }
        ImpactTest::from_toml(&text, "masses.toml").unwrap()
    }

    fn base(&self) -> Base {
        let mut found: [Vec<f64>; 3] = Default::default();
        for sample in base_samples() {
            let fit =
                identify(&self.test(sample, &self.frequencies("all", sample), None), Settings::default()).unwrap();
            let clamp = &fit.effects.iter().find(|effect| effect.id == "support-compliance").unwrap().parameters;
            let of = |name: &str| clamp.iter().find(|known| known.name == name).unwrap().values[0].value;
            let e_x = fit.constants.iter().find(|constant| constant.name == "e_x").unwrap().value;
            [e_x, of("rotation"), of("translation")].iter().zip(&mut found).for_each(|(value, list)| list.push(*value));
        }
        let mut base = Base { values: found.map(median), scatter: [1.0; 5] };
        let mut squares = [0.0; 5];
        for sample in base_samples() {
            let fit = identify(&self.test(sample, &self.frequencies("all", sample), Some(&base)), Settings::default());
            let modes = fit.unwrap().pieces.swap_remove(0).modes;
            squares.iter_mut().zip(modes).for_each(|(sum, mode)| *sum += (mode.error_percent() / 100.0).powi(2));
        }
        base.scatter = squares.map(|sum| (sum / base_samples().count() as f64).sqrt());
        base
    }

    fn traced(&self, kind: &str, sample: usize, base: &Base) -> Tracing {
        trace(&self.test(sample, &self.frequencies(kind, sample), Some(base))).unwrap()
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// The highest line of each stretch, between lines by a parabola through the logarithms of three.
fn resonances(file: &Path) -> Vec<f64> {
    let places = "force_at = [-0.15, 0.0]\nresponse_at = [0.19, 0.0]";
    let text = format!("{PIECE}[[measurement]]\nkind = \"accelerance\"\nfile = {file:?}\n{places}\n");
    let test = ImpactTest::from_toml(&text, "sample.toml").unwrap();
    let (_, record) = test.accelerances(Estimation::default()).unwrap().swap_remove(0);
    let level: Vec<f64> = record.value.iter().map(|value| value.norm().ln()).collect();
    let of_stretch = |&(low, high): &(f64, f64)| {
        let inside = |i: &usize| (low..high).contains(&record.frequency[*i]);
        let top = (1..level.len() - 1).filter(inside).max_by(|&a, &b| level[a].total_cmp(&level[b])).unwrap();
        let [left, peak, right] = [level[top - 1], level[top], level[top + 1]];
        let step = record.frequency[top] - record.frequency[top - 1];
        record.frequency[top] + 0.5 * step * (left - right) / (left - 2.0 * peak + right)
    };
    WITHIN.iter().map(of_stretch).collect()
}

#[test]
fn val_the_mass_that_was_taken_off_is_found_by_its_place() {
    let Some(folder) = shared_data("beam_masses") else { return };
    let rig = Rig::read(folder);
    let base = rig.base();
    let (mut near, mut right, mut missed, mut alarms, mut count) = (0, 0, 0, 0, 0);
    for sample in judged_samples() {
        count += 1;
        alarms += usize::from(rig.traced("all", sample, &base).verdict != Verdict::NothingMissing);
        let found = rig.traced("minus-1", sample, &base);
        missed += usize::from(found.verdict == Verdict::NothingMissing);
        let candidate = found.candidates.iter().find(|candidate| candidate.id == "local-mass").unwrap();
        let parameters = &candidate.effects[0].parameters;
        let of = |name: &str| parameters.iter().find(|known| known.name == name).unwrap().values[0].value;
        let (mass, place) = (of("mass"), of("x") + 0.5 * LENGTH);
        let away: Vec<f64> = rig.places[sample - 1].iter().map(|known| (place - known).abs()).collect();
        near += usize::from(mass < 0.0 && away[0] < 0.015);
        right += usize::from(mass < 0.0 && away.iter().all(|other| away[0] <= *other));
        println!(
            "{sample}: {} {mass:.5} kg at {place:.4} m, was at {:.4}",
            found.verdict.name(),
            rig.places[sample - 1][0]
        );
    }
    println!("of {count}: within 15 mm {near}, right place {right}, unseen {missed}, false alarms {alarms}");
    println!("base {:?}, scatter {:?}", base.values, base.scatter);
    assert!(10 * near >= 8 * count && 10 * right >= 9 * count, "{near} and {right} of {count}");
    assert!(10 * missed <= count && 20 * alarms <= count, "{missed} unseen, {alarms} false alarms of {count}");
}
