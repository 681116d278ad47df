//! Accelerances that a file holds already: their unit, coherence and variance.

use crate::support::{
    Dataset,
    recorded::{measurement, pair, records},
};
use orthopanel_data::{Accelerance, RecordFile, RecordedResponse};

fn response(points: usize) -> Dataset {
    Dataset {
        function: 4,
        complex: true,
        denominator: (13, "N".into()),
        points: (0..points).map(|line| vec![1.0, line as f64]).collect(),
        ..Dataset::time(&[], (12, "m/s^2"))
    }
}

#[test]
fn val_a_recorded_accelerance_brings_variance_from_its_coherence() {
    let coherence = Dataset { function: 6, ..Dataset::time(&[1.0, 0.5, 0.0], (0, "NONE")) };
    let found = Accelerance::from_records(records(&[response(3), coherence]), &measurement()).unwrap();
    // The line at 0 Hz is left out: 1 + 1j at coherence 1/2, 1 + 2j at none.
    assert_eq!(found.frequency, [0.001, 0.002]);
    assert_eq!(found.coherence.unwrap(), [0.5, 0.0]);
    assert_eq!(found.variance.unwrap(), [2.0, f64::INFINITY]);
    assert_eq!(Accelerance::from_records(records(&[response(3)]), &measurement()).unwrap().variance, None);
}

#[test]
fn val_one_of_several_frequency_responses_is_named_by_its_number() {
    let twice = Dataset { points: vec![vec![2.0, 0.0]; 3], ..response(3) };
    let file = || records(&[pair()[0].clone(), response(3), twice.clone()]);
    let of = |record| Accelerance::from_records(file(), &RecordedResponse { record, ..measurement() });
    assert_eq!(of(Some(3)).unwrap().value[0].re, 2.0);
    assert_eq!(of(Some(2)).unwrap().value[0].re, 1.0);
    let said = of(None).unwrap_err().to_string();
    assert!(said.contains("record 3: a second frequency response: say which by record = N"), "{said}");
    assert!(said.contains("one of 2, 3, or"), "{said}");
    let said = of(Some(1)).unwrap_err().to_string();
    assert!(said.contains("record = 1 is no frequency response: those of the file are 2, 3"), "{said}");
}

/// What `orthopanel accelerance TEST -o x.csv` writes is read back, with its variance.
#[test]
fn val_an_accelerance_csv_may_bring_its_variance() {
    let read = |text: &str| {
        let file = RecordFile::from_bytes(text.as_bytes(), "a.csv").unwrap();
        Accelerance::from_records(file, &measurement()).map_err(|error| error.to_string())
    };
    let found = read("frequency_hz,real,imag,coherence,variance\n0,1,0,1,9\n1,2,3,0.5,0.25\n2,4,5,1,0\n").unwrap();
    assert_eq!(found.variance.unwrap(), [0.25, 0.0]);
    assert_eq!(found.coherence.unwrap(), [0.5, 1.0]);
    assert_eq!(found.notes.iter().filter(|note| note.contains("variance")).count(), 0);
    let refused = read("frequency_hz,real,imag,variance\n1,2,3,-1\n").unwrap_err();
    assert!(refused.contains("a.csv:2: variance: variance -1 at point 1: must be zero or more"), "{refused}");
}

#[test]
fn val_what_is_no_single_accelerance_is_refused() {
    let strain = Dataset { numerator: (3, "1".into()), ..response(3) };
    let magnitude = Dataset { complex: false, points: vec![vec![1.0]; 3], ..response(3) };
    let shorter = Dataset { function: 6, ..Dataset::time(&[1.0; 2], (0, "NONE")) };
    let above_one = Dataset { function: 6, ..Dataset::time(&[1.0, 1.5, 1.0], (0, "NONE")) };
    let cases = [
        (vec![response(3), response(3)], "a second frequency response"),
        (vec![strain], "Other(3) over Force: motion over force is needed"),
        (vec![magnitude], "must be complex"),
        (vec![response(3), shorter], "other frequencies"),
        (vec![response(3), above_one], "coherence 1.5 at point 2"),
        (pair().to_vec(), "no frequency response"),
    ];
    for (datasets, said) in cases {
        let error = Accelerance::from_records(records(&datasets), &measurement()).unwrap_err().to_string();
        assert!(error.contains(said), "\n  said   {error}\n  wanted {said}");
    }
}

#[test]
fn val_the_measured_beam_is_read() {
    let Some(path) = crate::support::measured("free_beam/test.toml") else { return };
    let test = orthopanel_data::ImpactTest::read(path).unwrap();
    for measurement in &test.measurements {
        let orthopanel_data::MeasurementData::Accelerance(recorded) = &measurement.data else { panic!("another kind") };
        let found = Accelerance::read(recorded).unwrap();
        let peak = found.value.iter().enumerate().max_by(|a, b| a.1.norm().total_cmp(&b.1.norm())).unwrap().0;
        // The README of these files states modes at 111.994, 306.854, 596.367 and 974.14 Hz; the highest line is one.
        let modes = [111.994, 306.854, 596.367, 974.14];
        assert!(modes.iter().any(|mode| (found.frequency[peak] - mode).abs() < 0.1), "{}", found.frequency[peak]);
    }
}

#[test]
fn val_an_accelerance_csv_carries_the_decay_rate_of_its_window() {
    let read = |text: &str| {
        let file = RecordFile::from_bytes(text.as_bytes(), "a.csv").unwrap();
        Accelerance::from_records(file, &measurement()).map_err(|error| error.to_string())
    };
    assert_eq!(read("frequency_hz,real,imag,decay_rate_1_s\n1,2,3,12.5\n2,4,5,12.5\n").unwrap().decay_rate, 12.5);
    assert_eq!(read("frequency_hz,real,imag\n1,2,3\n").unwrap().decay_rate, 0.0);
    for (wrong, value) in [("1,2,3,12.5\n2,4,5,13\n", 13.0), ("1,2,3,1\n2,4,5,-1\n", -1.0)] {
        let refused = read(&format!("frequency_hz,real,imag,decay_rate_1_s\n{wrong}")).unwrap_err();
        let said = format!("a.csv:3: decay_rate_1_s: decay rate {value} at point 2: must be zero or more, the same");
        assert!(refused.contains(&said), "{refused}");
    }
}

/// Lines that an analyser filled with zeros are no measurement; where hardly another is there, the file is refused.
#[test]
fn val_lines_that_are_exactly_zero_are_left_out_and_said() {
    let read = |text: &str| {
        let file =
            RecordFile::from_bytes(format!("frequency_hz,real,imag,variance\n{text}").as_bytes(), "a.csv").unwrap();
        Accelerance::from_records(file, &measurement()).map_err(|error| error.to_string())
    };
    let found = read("1,2,3,0.1\n2,0,0,0\n3,4,5,0.3\n4,0,5,0.4\n5,0,0,0\n").unwrap();
    assert_eq!((found.frequency, found.variance.unwrap()), (vec![1.0, 3.0, 4.0], vec![0.1, 0.3, 0.4]));
    assert!(
        found.notes.iter().any(|note| note.contains("2 of 5 lines are exactly zero, the first at 2 Hz")),
        "{:?}",
        found.notes
    );
    let refused = read("1,2,3,0.1\n2,0,0,0\n3,0,0,0\n").unwrap_err();
    assert!(refused.contains("2 of 3 lines are exactly zero: nothing was measured"), "{refused}");
}
