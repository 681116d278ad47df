//! A cantilever with six masses, of which one was taken off: which, told by five natural frequencies.
//!
//! Real: Sousa and Machado, Data in Brief 2024, 110043, by github BalakumaranM/Transformer-based-Structural-Health-
//! Monitoring-using-Frequency-Response-Function-FRF, commit 3ad1fac0 (MIT). The masses sit at other places in each sample.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use crate::support::shared_data;
use orthopanel_data::{Estimation, ImpactTest};
use orthopanel_identify::{Identification, Settings, Tracing, Verdict, identify, trace};
use rayon::prelude::*;

const LENGTH: f64 = 0.38;
/// Aluminium, since neither material nor width is stated: frequencies tell ratios only.
const PIECE: &str = "[piece]\nlength = 0.38\nwidth = 0.03\nthickness = 0.00475\nmass_per_area = 12.825\n\
                     [boundary]\nleft = \"clamped\"\nright = \"free\"\n";
const BEAM_MASS: f64 = 12.825 * 0.38 * 0.03;
/// Each mass is 2.96 % of beam and masses together.
const EACH: f64 = 0.0296 / (1.0 - 6.0 * 0.0296) * BEAM_MASS;
/// Where each resonance lies \[Hz\]. The sixth does not stand out in all records.
const WITHIN: [(f64, f64); 5] = [(15.0, 30.0), (110.0, 170.0), (330.0, 430.0), (650.0, 850.0), (1000.0, 1300.0)];

/// A frequency list of a cantilever does not tell its modulus from its clamp: of these the one that the samples miss least \[Pa\].
const MODULI: [f64; 3] = [7.2e10, 7.6e10, 8.0e10];

/// Samples by their number: those that tell modulus and clamp. All odd ones tell how the model lies beside the frequencies, and all
/// even ones are judged.
const OF_MODULUS: [usize; 4] = [1, 9, 17, 25];

fn base_samples() -> impl Iterator<Item = usize> {
    (1..=40).step_by(2)
}

fn judged_samples() -> Vec<usize> {
    (2..=40).step_by(2).collect()
}

struct Rig {
    folder: PathBuf,
    /// From the clamp \[m\].
    places: Vec<Vec<f64>>,
}

/// What the odd samples with all masses say: modulus, rotation and translation stiffness of the clamp, and how each frequency then
/// misses.
struct Base {
    e_x: f64,
    clamp: [f64; 2],
    /// Mean of what the model is above each frequency, and the scatter about that \[1\].
    beside: [f64; 5],
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

    /// A test of these frequencies with all six masses declared; without a base the clamp is identified.
    fn test(&self, sample: usize, frequencies: &[f64], e_x: f64, base: Option<&Base>) -> ImpactTest {
        let clamp = base.map_or(String::new(), |Base { clamp: [rotation, translation], .. }| {
            format!("rotation = {rotation}\ntranslation = {translation}\n")
        });
        // What the model is beside the base it is beside every sample.
        let beside = base.map_or([0.0; 5], |base| base.beside);
        let frequencies: Vec<f64> = frequencies.iter().zip(beside).map(|(f, beside)| f * (1.0 + beside)).collect();
        let mut text = format!("{PIECE}[constants]\ne_x = {e_x}\ng_zx = 2.6e10\n");
        write!(text, "[[effect]]\nid = \"support-compliance\"\n{clamp}").unwrap();
        for place in &self.places[sample - 1] {
            writeln!(text, "[[effect]]\nid = \"local-mass\"\nmass = {EACH}\nx = {}", place - 0.5 * LENGTH).unwrap();
        }
        write!(text, "[[measurement]]\nkind = \"natural-frequencies\"\nvalues = {frequencies:?}\n").unwrap();
        if let Some(base) = base {
            let scatter: Vec<f64> = base.scatter.iter().zip(&frequencies).map(|(part, f)| part * f).collect();
            writeln!(text, "scatter = {scatter:?}").unwrap();
        }
        ImpactTest::from_toml(&text, "masses.toml").unwrap()
    }

    fn identified(&self, sample: usize, e_x: f64, base: Option<&Base>) -> Identification {
        identify(&self.test(sample, &self.frequencies("all", sample), e_x, base), Settings::default()).unwrap()
    }

    fn base(&self) -> Base {
        let missed = |e_x: f64| -> f64 {
            OF_MODULUS.iter().map(|&sample| self.identified(sample, e_x, None).frequency_rms_percent.powi(2)).sum()
        };
        let e_x = MODULI.into_iter().min_by(|&a, &b| missed(a).total_cmp(&missed(b))).unwrap();
        let clamps: Vec<[f64; 2]> = OF_MODULUS
            .iter()
            .map(|&sample| {
                let effects = self.identified(sample, e_x, None).effects;
                let clamp = &effects.iter().find(|effect| effect.id == "support-compliance").unwrap().parameters;
                ["rotation", "translation"]
                    .map(|name| clamp.iter().find(|known| known.name == name).unwrap().values[0].value)
            })
            .collect();
        let clamp = [0, 1].map(|side| median(clamps.iter().map(|clamp| clamp[side]).collect()));
        // Equal for all: how the samples scatter is what the loop finds.
        let mut base = Base { e_x, clamp, beside: [0.0; 5], scatter: [0.01; 5] };
        let count = base_samples().count() as f64;
        let (mut sums, mut squares) = ([0.0; 5], [0.0; 5]);
        for sample in base_samples() {
            let modes = self.identified(sample, e_x, Some(&base)).pieces.swap_remove(0).modes;
            for (mode, (sum, square)) in modes.iter().zip(sums.iter_mut().zip(&mut squares)) {
                let miss = mode.error_percent() / 100.0;
                (*sum, *square) = (*sum + miss, *square + miss * miss);
            }
        }
        base.beside = sums.map(|sum| sum / count);
        base.scatter =
            std::array::from_fn(|mode| ((squares[mode] - sums[mode].powi(2) / count) / (count - 1.0)).sqrt());
        base
    }

    fn traced(&self, kind: &str, sample: usize, base: &Base) -> Tracing {
        trace(&self.test(sample, &self.frequencies(kind, sample), base.e_x, Some(base))).unwrap()
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    0.5 * (values[(values.len() - 1) / 2] + values[values.len() / 2])
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

/// What a trace says of one sample, without mass 1 and with all.
struct Judged {
    is_near: bool,
    is_right: bool,
    is_missed: bool,
    names_more: bool,
    leaves_more: bool,
}

impl Judged {
    fn of(rig: &Rig, sample: usize, base: &Base) -> Self {
        let with_all = rig.traced("all", sample, base);
        let found = rig.traced("minus-1", sample, base);
        let candidate = found.candidates.iter().find(|candidate| candidate.id == "local-mass").unwrap();
        let parameters = &candidate.effects[0].parameters;
        let of = |name: &str| parameters.iter().find(|known| known.name == name).unwrap().values[0].value;
        let (mass, place) = (of("mass"), of("x") + 0.5 * LENGTH);
        let away: Vec<f64> = rig.places[sample - 1].iter().map(|known| (place - known).abs()).collect();
        println!(
            "{sample}: {} {mass:.5} kg at {place:.4} m, was at {:.4}",
            found.verdict.name(),
            rig.places[sample - 1][0]
        );
        Self {
            is_near: mass < 0.0 && away[0] < 0.015,
            is_right: mass < 0.0 && away.iter().all(|other| away[0] <= *other),
            is_missed: found.verdict == Verdict::NothingMissing,
            names_more: !with_all.effects.is_empty(),
            leaves_more: with_all.verdict == Verdict::Unexplained,
        }
    }
}

/// Asked: within 15 mm in 80 %, nearest to its own place in 90 %, each to two standard errors of what is reached (70 and 80 %); false alarms in 5 % at
/// most. What the model is beside the frequencies of the base it is beside those of a sample: without that the place was 9 mm too near to the clamp.
#[test]
fn val_the_mass_that_was_taken_off_is_found_by_its_place() {
    let Some(folder) = shared_data("beam_masses") else { return };
    let rig = Rig::read(folder);
    let base = rig.base();
    let judged: Vec<Judged> = judged_samples().into_par_iter().map(|sample| Judged::of(&rig, sample, &base)).collect();
    let (count, of) = (judged.len(), |is: fn(&Judged) -> bool| judged.iter().filter(|one| is(one)).count());
    let (near, right, missed) = (of(|one| one.is_near), of(|one| one.is_right), of(|one| one.is_missed));
    let (named, unexplained) = (of(|one| one.names_more), of(|one| one.leaves_more));
    println!(
        "of {count}: within 15 mm {near}, right place {right}, unseen {missed}; with all masses {named} named an effect, \
         {unexplained} unexplained"
    );
    println!("modulus {}, clamp {:?}, {:?} +- {:?}", base.e_x, base.clamp, base.beside, base.scatter);
    let reaches = |found: usize, asked: f64| {
        let rate = found as f64 / count as f64;
        rate + 2.0 * (rate * (1.0 - rate) / count as f64).sqrt() >= asked
    };
    assert!(reaches(near, 0.8) && reaches(right, 0.9), "{near} and {right} of {count}");
    assert!(
        2 * missed < count && 20 * (named + unexplained) <= count,
        "{missed} unseen, {named} + {unexplained} of {count}"
    );
}
