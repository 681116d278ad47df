//! Whether places or signs other than those written down meet the shapes that a plate's records show.
//!
//! Every reading moves places or turns signs of records. With $q_{rm}$ the measured residue of pole $m$ in record $r$, $s_m$ its rms over the records and
//! $W_{rm}$ that of its partner among the plate's modes where the reading puts it,
//! $$S_m = \sum_r\left(\frac{q_{rm}-W_{rm}}{s_m}\right)^2 + R\,\epsilon^2$$
//! is what it leaves of the pole, $\epsilon$ what the residues of any real panel miss. With errors of a size of its own in each pole, the same for all of its
//! records, the logarithm of the odds of one reading against another is $\tfrac12\sum_m\ln(S_m/S_m')$: a pole whose shape is another's says nothing.

use std::f64::consts::TAU;

use orthopanel_data::ImpactTest;
use orthopanel_model::{Boundary, Piece, Place, StructureKind};

use crate::IdentifyError;
use crate::declared_effects::pairs_of_places;
use crate::judge::{MOST_RESIDUE, ODDS};
use crate::measured::MeasuredModes;
use crate::predicted::apart;
use crate::structures;

/// Modes are told up to so many times the highest pole.
const ABOVE: f64 = 1.05;
/// Fewer records than this have no odd one.
const LEAST_RECORDS: usize = 4;

type Pair = (Place, Place);

/// Other readings of all places that lie on the piece, each with what it takes the test file to mean. A plate that is the same all over does not tell
/// itself from its mirror image: sensor and hammer are mirrored against each other.
fn readings(written: &[Pair], piece: &Piece) -> Vec<(&'static str, Vec<Pair>)> {
    let mirrored = |x: f64, y: f64| move |(force, at): Pair| (force, Place { x: x * at.x, y: y * at.y });
    let exchanged = |at: Place| Place { x: at.y, y: at.x };
    let all = |of: &dyn Fn(Pair) -> Pair| written.iter().map(|pair| of(*pair)).collect::<Vec<_>>();
    let turned = |(force, response): Pair| (exchanged(force), exchanged(response));
    let readings = [
        (
            "x of response_at, or of all force_at, with the other sign: one of the two counts x the other way",
            all(&mirrored(-1.0, 1.0)),
        ),
        (
            "y of response_at, or of all force_at, with the other sign: one of the two counts y the other way",
            all(&mirrored(1.0, -1.0)),
        ),
        (
            "x and y of response_at, or of all force_at, with the other sign: one of the two counts both the other way",
            all(&mirrored(-1.0, -1.0)),
        ),
        ("x and y of all places, or length and width of the piece, exchanged: x runs along the length", all(&turned)),
    ];
    let is_on_piece =
        |pairs: &Vec<Pair>| pairs.iter().all(|(force, at)| piece.contains(*force).and(piece.contains(*at)).is_ok());
    readings.into_iter().filter(|(_, pairs)| is_on_piece(pairs)).collect()
}

/// What a plate predicts, to be held against what was measured.
struct Shapes<'a> {
    measured: &'a MeasuredModes,
    sizes: Vec<f64>,
}

impl Shapes<'_> {
    /// Of each pole and record what is measured and what the partner has there, over the size; a pole without one has a zero.
    fn beside(&self, modes: &[(f64, Vec<f64>)]) -> Vec<Vec<[f64; 2]>> {
        let partners = self.measured.partners(modes, |_| apart(StructureKind::MindlinPlate));
        let records = self.measured.records.len();
        let of = |(pole, partner): (usize, &Option<(usize, Option<f64>)>)| {
            let value = |record: usize| {
                let predicted = partner.map_or(0.0, |(mode, _)| modes[mode].1[record]);
                [self.measured.product(record, pole), predicted].map(|value| value / self.sizes[pole])
            };
            (0..records).map(value).collect()
        };
        partners.iter().enumerate().map(of).collect()
    }
}

/// What is left of each pole.
fn left(beside: &[Vec<[f64; 2]>]) -> Vec<f64> {
    let of_pole = |pole: &Vec<[f64; 2]>| pole.iter().map(|[measured, predicted]| (measured - predicted).powi(2)).sum();
    beside.iter().map(of_pole).collect()
}

fn place(at: Place) -> String {
    format!("[{}, {}]", (1e6 * at.x).round() / 1e6, (1e6 * at.y).round() / 1e6)
}

/// What is said of a plate that was hit at too few places to tell.
pub(crate) fn untold(test: &ImpactTest) -> Option<String> {
    let records = pairs_of_places(test);
    let is_plate = test.structure == Some(StructureKind::MindlinPlate);
    (is_plate && (1..LEAST_RECORDS).contains(&records)).then(|| {
        format!(
            "records of {records} pair{} of places do not tell whether an axis is mirrored, a sensor turned round or two records exchanged: hit \
             {LEAST_RECORDS} places at least to have that checked",
            if records == 1 { "" } else { "s" }
        )
    })
}

/// # Errors
/// [`IdentifyError::OtherPlaces`] where another reading of the places is clearly ahead; what the plate refuses.
pub(crate) fn refuse_other_places(
    measured: &MeasuredModes,
    (piece, boundary): (&Piece, Boundary),
    constants: &[f64],
) -> Result<(), IdentifyError> {
    let (poles, records) = (measured.poles.len(), measured.records.len());
    if records < LEAST_RECORDS || poles == 0 {
        return Ok(());
    }
    let structure = structures::of(StructureKind::MindlinPlate).recorded(piece, boundary);
    let top = ABOVE * measured.poles.last().map_or(measured.band[1], |pole| pole.angular_frequency / TAU);
    let written: Vec<Pair> = measured.records.iter().map(|record| (record.force_at, record.response_at)).collect();
    let readings = readings(&written, piece);
    let all: Vec<Pair> = written.iter().chain(readings.iter().flat_map(|(_, pairs)| pairs)).copied().collect();
    let modes = structure.modes_below(constants, top, &all)?;
    // Of the places as written, then of each reading.
    let modes_of = |reading: usize| -> Vec<(f64, Vec<f64>)> {
        let own = reading * records..(reading + 1) * records;
        modes.iter().map(|mode| (TAU * mode.frequency, mode.products[own.clone()].to_vec())).collect()
    };
    let size = |pole: usize| {
        let square: f64 = (0..records).map(|record| measured.product(record, pole).powi(2)).sum();
        (square / records as f64).sqrt().max(f64::MIN_POSITIVE)
    };
    let shapes = Shapes { measured, sizes: (0..poles).map(size).collect() };
    let beside = shapes.beside(&modes_of(0));
    let own = left(&beside);
    let least = records as f64 * MOST_RESIDUE.powi(2);
    let mut best: Option<(f64, Vec<f64>, String)> = None;
    let mut count = 0;
    let mut tried = |left: Vec<f64>, write: &dyn Fn() -> String| {
        count += 1;
        let log_odds = own.iter().zip(&left).map(|(own, left)| 0.5 * ((own + least) / (left + least)).ln()).sum();
        if best.as_ref().is_none_or(|(most, ..)| log_odds > *most) {
            best = Some((log_odds, left, write()));
        }
    };
    // Of what is left by a record that is turned round, or stands in the place of another, the rest is as it was.
    let with = |changed: &[(usize, usize, f64)]| -> Vec<f64> {
        let change = |pole: &Vec<[f64; 2]>, &(record, at, sign): &(usize, usize, f64)| {
            (sign * pole[record][0] - pole[at][1]).powi(2) - (pole[record][0] - pole[record][1]).powi(2)
        };
        let of_pole = |(own, pole): (&f64, &Vec<[f64; 2]>)| {
            (own + changed.iter().map(|of| change(pole, of)).sum::<f64>()).max(0.0)
        };
        own.iter().zip(&beside).map(of_pole).collect()
    };
    for (number, (write, _)) in (1..).zip(&readings) {
        tried(left(&shapes.beside(&modes_of(number))), &|| (*write).to_owned());
    }
    let turned: Vec<(usize, usize, f64)> = (0..records).map(|record| (record, record, -1.0)).collect();
    tried(with(&turned), &|| "direction = -1 in all records: the sensor is turned round".to_owned());
    let name =
        |record: usize| format!("force_at = {}, response_at = {}", place(written[record].0), place(written[record].1));
    for record in 0..records {
        tried(with(&[(record, record, -1.0)]), &|| {
            format!("direction = -1 in the record with {}: its sensor is turned round", name(record))
        });
        for other in record + 1..records {
            let write = || {
                format!(
                    "the files of two records each in the place of the other, those with {} and with {}: they are exchanged",
                    name(record),
                    name(other)
                )
            };
            tried(with(&[(record, other, 1.0), (other, record, 1.0)]), &write);
        }
    }
    let Some((log_odds, left, write)) = best else { return Ok(()) };
    if log_odds - f64::from(count).ln() < ODDS.ln() {
        return Ok(());
    }
    let percent = |left: Vec<f64>| 100.0 * (left.iter().sum::<f64>() / (poles * records) as f64).sqrt();
    Err(IdentifyError::OtherPlaces { write, percent: [percent(own), percent(left)] })
}
