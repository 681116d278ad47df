//! Tests of arrays in memory, held against those of files with the same samples.

use std::path::Path;

use num_complex::Complex64;
use orthopanel_data::{
    Accelerance, DataError, Estimation, ImpactTest, KnownConstant, Measurement, MeasurementData, Motion, NamedPiece,
    NaturalFrequencies, RecordedResponse, Unit,
};
use orthopanel_model::{Piece, Place};

const PIECE: Piece = Piece { length: 0.8, width: 0.1, thickness: 0.03, mass_per_area: 6.88 };
const PLACES: [Place; 2] = [Place { x: -0.3, y: 0.0 }, Place { x: 0.3, y: 0.0 }];

fn strip() -> ImpactTest {
    ImpactTest { pieces: vec![NamedPiece::new("strip", PIECE)], ..ImpactTest::default() }.checked().unwrap()
}

fn with(data: MeasurementData) -> Result<ImpactTest, DataError> {
    let mut test = strip();
    test.add(Measurement { piece: 0, data }).map(|()| test)
}

fn made_hits() -> ImpactTest {
    ImpactTest::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/made-hits")).unwrap()
}

/// The channels of the hits of `examples/made-hits`, and their sampling rate.
fn samples() -> ([Vec<Vec<f64>>; 2], f64) {
    let (_, history) = made_hits().time_histories().unwrap().remove(0);
    (
        history.hits.into_iter().map(|hit| (hit.force, hit.acceleration)).unzip::<_, _, Vec<_>, Vec<_>>().into(),
        history.rate,
    )
}

fn hits(times: f64) -> RecordedResponse {
    let ([force, mut response], rate) = samples();
    response.iter_mut().flatten().for_each(|value| *value *= times);
    RecordedResponse::of_hits([force, response], rate, PLACES).unwrap()
}

#[test]
fn val_arrays_give_the_spectra_of_files() {
    let of_file = made_hits().accelerances(Estimation::default()).unwrap();
    let of_arrays = with(MeasurementData::TimeHistory(hits(1.0))).unwrap();
    let of_arrays = of_arrays.accelerances(Estimation::default()).unwrap();
    let (file, arrays) = (&of_file[0].1, &of_arrays[0].1);
    assert_eq!((&file.frequency, &file.value, &file.variance), (&arrays.frequency, &arrays.value, &arrays.variance));
    assert_eq!((&file.coherence, &file.verdicts, &file.bias), (&arrays.coherence, &arrays.verdicts, &arrays.bias));
    assert!(arrays.notes[0].contains("hit 1, response: unit of the acceleration not told"), "{:?}", arrays.notes);
    let of_spectrum =
        |of: &Accelerance| of.notes.iter().filter(|note| note.contains("band cut")).cloned().collect::<Vec<_>>();
    assert_eq!((of_spectrum(arrays).len(), of_spectrum(arrays)), (1, of_spectrum(file)));
}

#[test]
fn val_units_sensitivities_and_motions_of_arrays_are_put_right() {
    // Powers of two scale without rounding.
    let plain = &with(MeasurementData::TimeHistory(hits(1.0))).unwrap().time_histories().unwrap()[0].1.hits;
    let mut volts = hits(0.25);
    volts.response_sensitivity = Some(0.25);
    let read = with(MeasurementData::TimeHistory(volts)).unwrap().time_histories().unwrap().remove(0).1;
    assert_eq!(&read.hits, plain);
    assert!(read.notes[0].contains("brought from volts at 0.25 V a m/s2"), "{:?}", read.notes);
    let mut gravities = hits(1.0);
    gravities.response_unit = Unit::parse("g");
    let read = with(MeasurementData::TimeHistory(gravities)).unwrap().time_histories().unwrap().remove(0).1;
    assert_eq!(read.hits[0].acceleration[100], 9.80665 * plain[0].acceleration[100]);
    let mut velocity = hits(1.0);
    velocity.quantity = Some(Motion::Velocity);
    let read = with(MeasurementData::TimeHistory(velocity)).unwrap().time_histories().unwrap().remove(0).1;
    assert_eq!(read.read_as.motion, Motion::Velocity);
    assert!(read.notes.iter().any(|note| note.contains("velocity differentiated")), "{:?}", read.notes);
}

#[test]
fn val_lines_in_memory_are_those_of_the_spectrum() {
    let own =
        with(MeasurementData::TimeHistory(hits(1.0))).unwrap().accelerances(Estimation::default()).unwrap().remove(0).1;
    let lines = |value: Vec<Complex64>| {
        RecordedResponse::of_lines(own.frequency.clone(), value, own.coherence.clone(), PLACES).unwrap()
    };
    let read = with(MeasurementData::Accelerance(lines(own.value.clone()))).unwrap();
    let read = read.accelerances(Estimation::default()).unwrap().remove(0).1;
    assert_eq!((&read.frequency, &read.value, &read.coherence), (&own.frequency, &own.value, &own.coherence));
    assert!(read.variance.is_some() && read.force_at == PLACES[0] && read.response_at == PLACES[1]);
    // A mobility is told, or asked for.
    let mobility: Vec<Complex64> = own
        .value
        .iter()
        .zip(&own.frequency)
        .map(|(value, f)| value / Complex64::new(0.0, std::f64::consts::TAU * f))
        .collect();
    let asked = with(MeasurementData::Accelerance(lines(mobility.clone()))).unwrap().recorded_accelerances();
    assert!(asked.unwrap_err().to_string().contains("declare quantity = \"velocity\""));
    let mut told = lines(mobility);
    told.quantity = Some(Motion::Velocity);
    let read = with(MeasurementData::Accelerance(told)).unwrap().recorded_accelerances().unwrap().remove(0).1;
    let missed = read.value.iter().zip(&own.value).map(|(read, own)| (read - own).norm() / own.norm());
    assert!(missed.fold(0.0, f64::max) < 1e-14);
}

#[test]
fn a_test_in_memory_is_that_of_its_file() {
    let text = "structure = \"mindlin-plate\"\n[[piece]]\nname = \"a\"\nlength = 0.8\nwidth = 0.5\nthickness = 0.03\nmass_per_area = 6.88\n\
        length_std = 1e-3\nown_constants = [\"g_zx\"]\n[boundary]\nleft = \"clamped\"\n[suspension]\nat = [[-0.18, 0.1], 0.2]\n\
        [constants]\nnu_xy = 0.3\ne_x = {start = 1e10}\ne_y = {value = 1e10, std = 1e9}\n\
        [[effect]]\nid = \"sensor-mass\"\nmass = 0.005\n\
        [[measurement]]\nkind = \"natural-frequencies\"\nvalues = [90.0, 70.0]\nshape = [[0, 2], [2, 0]]\nresolution = 0.5\nscatter = [0.1, 0.2]\nresponse_at = [0.1, 0]\n";
    let read = ImpactTest::from_toml(text, "test.toml").unwrap();
    let built = ImpactTest { measurements: vec![], ..read.clone() }.checked().unwrap();
    assert_eq!(read.clone().checked().unwrap(), read);
    let mut added = built;
    added.add(read.measurements[0].clone()).unwrap();
    assert_eq!(added, read);
    // Of files likewise.
    let read = made_hits();
    assert_eq!(read.clone().checked().unwrap(), read);
}

#[test]
fn arrays_of_one_pair_of_places_are_hits_of_one_history_and_no_two_are_one_file() {
    let ([force, response], rate) = samples();
    let one = |hit: usize| {
        let of_hit = |of: &[Vec<f64>]| vec![of[hit].clone()];
        let recorded = RecordedResponse::of_hits([of_hit(&force), of_hit(&response)], rate, PLACES).unwrap();
        Measurement { piece: 0, data: MeasurementData::TimeHistory(recorded) }
    };
    let mut test = strip();
    for hit in [0, 1, 2] {
        test.add(one(hit)).unwrap();
    }
    let histories = test.time_histories().unwrap();
    let (_, whole) = with(MeasurementData::TimeHistory(hits(1.0))).unwrap().time_histories().unwrap().remove(0);
    assert_eq!((histories.len(), &histories[0].1.hits), (1, &whole.hits));
    assert_eq!(test.files().count(), 0);
    test.add(one(1)).unwrap();
    let said = test.time_histories().unwrap_err().to_string();
    assert_eq!(
        said,
        "records added at force_at = [-0.3, 0], response_at = [0.3, 0]: the test lists this record twice: it would count twice; list it once"
    );
}

#[test]
fn arrays_that_are_none_are_refused_by_name() {
    const AT: &str = "records added at force_at = [-0.3, 0], response_at = [0.3, 0]: ";
    let channel = |hits: usize, samples: usize| vec![vec![1.0; samples]; hits];
    let of_hits = |force, response, rate| RecordedResponse::of_hits([force, response], rate, PLACES).map(|_| ());
    let mut ragged = channel(2, 20);
    ragged[1].pop();
    let mut spoilt = channel(2, 20);
    spoilt[1][3] = f64::NAN;
    let mut infinite = channel(2, 20);
    infinite[0][0] = f64::NEG_INFINITY;
    let value = |count: usize| vec![Complex64::new(1.0, 0.5); count];
    let of_lines = |frequency: &[f64], value, coherence| {
        RecordedResponse::of_lines(frequency.to_vec(), value, coherence, PLACES).map(|_| ())
    };
    type Is = fn(&DataError) -> bool;
    let is_shape: Is = |error| matches!(error, DataError::Shape { .. });
    let is_no_number: Is = |error| matches!(error, DataError::NotFinite { .. });
    let is_out: Is = |error| matches!(error, DataError::OutOfRange { .. });
    let is_nothing: Is = |error| matches!(error, DataError::NoRecords { .. });
    let is_disorder: Is = |error| matches!(error, DataError::Channels { .. });
    for (found, is, said) in [
        (of_hits(channel(2, 20), channel(3, 20), 1e4), is_shape, "response: 3 hits, where the others have 2"),
        (
            of_hits(channel(2, 20), ragged.clone(), 1e4),
            is_shape,
            "hit 2, response: 19 samples, where the others have 20",
        ),
        (of_hits(ragged, channel(2, 20), 1e4), is_shape, "hit 2, force: 19 samples, where the others have 20"),
        (of_hits(channel(2, 20), spoilt, 1e4), is_no_number, "hit 2, response: point 4 is not a finite number"),
        (of_hits(infinite, channel(2, 20), 1e4), is_no_number, "hit 1, force: point 1 is not a finite number"),
        (of_hits(vec![], vec![], 1e4), is_nothing, "force: no hit in it"),
        (of_hits(channel(2, 0), channel(2, 0), 1e4), is_nothing, "force: no hit in it"),
        (
            of_hits(channel(2, 20), channel(2, 20), 0.0),
            is_out,
            "sampling_rate = 0: must be a number of Hz between 100 and 2e7",
        ),
        (of_hits(channel(2, 20), channel(2, 20), -51200.0), is_out, "sampling_rate = -51200: must be"),
        (of_hits(channel(2, 20), channel(2, 20), f64::NAN), is_out, "sampling_rate = NaN: must be"),
        (of_lines(&[], vec![], None), is_nothing, "frequency: no line in it"),
        (of_lines(&[1.0, 2.0], value(3), None), is_shape, "value: 3 lines, where the others have 2"),
        (of_lines(&[1.0, 2.0], value(2), Some(vec![1.0])), is_shape, "coherence: 1 lines, where the others have 2"),
        (of_lines(&[1.0, f64::INFINITY], value(2), None), is_no_number, "frequency: point 2 is not"),
        (
            of_lines(&[1.0, 1.0], value(2), None),
            is_disorder,
            "frequency: line 2 is at 1 Hz, and the line before it at 1 Hz",
        ),
        (of_lines(&[1.0], vec![Complex64::new(1.0, f64::NAN)], None), is_no_number, "value: point 1 is not"),
    ] {
        let error = found.expect_err(said);
        assert!(is(&error) && error.to_string().starts_with(&format!("{AT}{said}")), "{error} / {said}");
    }
}

#[test]
fn what_is_wrong_with_a_test_in_memory_is_said_by_its_key() {
    let off = || RecordedResponse::of_hits(samples().0, samples().1, [Place { x: -0.5, y: 0.0 }, PLACES[1]]).unwrap();
    let of = |change: fn(&mut RecordedResponse)| {
        let mut hits = hits(1.0);
        change(&mut hits);
        with(MeasurementData::TimeHistory(hits)).map(|_| ())
    };
    let list = |values: Vec<f64>, shape: Vec<[u32; 2]>| {
        let (resolution, scatter, response_at) = (vec![], vec![], None);
        let list = NaturalFrequencies { values, shape, resolution, scatter, response_at };
        with(MeasurementData::NaturalFrequencies(list)).map(|_| ())
    };
    let test = |change: fn(&mut ImpactTest)| {
        let mut test = strip();
        change(&mut test);
        test.checked().map(|_| ())
    };
    let listed = MeasurementData::NaturalFrequencies(NaturalFrequencies {
        values: vec![150.0],
        resolution: vec![],
        scatter: vec![],
        shape: vec![],
        response_at: None,
    });
    for (found, said) in [
        (with(MeasurementData::TimeHistory(off())).map(|_| ()), "measurement[1].force_at: place (-0.5, 0)"),
        (
            of(|hits| hits.response_unit = Unit::parse("N")),
            "measurement[1].response_unit = \"N\": must be a unit of motion",
        ),
        (of(|hits| hits.force_unit = Unit::parse("g")), "measurement[1].force_unit = \"g\": must be a unit of force"),
        (of(|hits| hits.response_sensitivity = Some(0.0)), "measurement[1].response_sensitivity = 0: must be"),
        (of(|hits| hits.sampling_rate = Some(-1.0)), "measurement[1].sampling_rate = -1: must be"),
        (of(|hits| hits.band = Some([100.0, 10.0])), "measurement[1].band = 10: a band is [from, to]"),
        (list(vec![], vec![]), "measurement[1].values has 0 entries"),
        (list(vec![200.0, 150.0], vec![]), "measurement[1].values[2]: "),
        (list(vec![f64::NAN], vec![]), "measurement[1].values[1] = NaN: must be a finite number of Hz"),
        (list(vec![200.0], vec![[2, 0], [0, 2]]), "measurement[1].shape has 2 entries"),
        (
            strip().add(Measurement { piece: 7, data: listed }),
            "measurement[1].piece = \"number 7 from 0\": the pieces are named \"strip\"",
        ),
        (test(|test| test.pieces[0].piece.length = f64::NAN), "piece[1].length = NaN: must be a finite number of m"),
        (test(|test| test.pieces.clear()), "piece is missing"),
        (test(|test| test.pieces.push(test.pieces[0].clone())), "piece[2].name = \"strip\": the name stands before"),
        (test(|test| test.pieces[0].doubt.width = -1.0), "piece[1].width_std = -1: must be"),
        (test(|test| test.suspension.push(Place { x: 3.0, y: 0.0 })), "suspension.at[1]: place (3, 0)"),
        (test(|test| test.constants.extend([("e_z".into(), 1e9)])), "constants.e_z = \"e_z\": the constants are"),
        (test(|test| test.constants.extend([("e_x".into(), f64::NAN)])), "constants.e_x = NaN: must lie between"),
        (
            test(|test| {
                test.constants.insert("e_x".into(), 1e10);
                test.known_constants.insert("e_x".into(), KnownConstant::Start(1e10));
            }),
            "constants = \"e_x\": the name stands before",
        ),
    ] {
        let error = found.expect_err(said).to_string();
        assert!(error.starts_with(&format!("the test in memory: {said}")), "{error} / {said}");
    }
}
