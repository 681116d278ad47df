//! CSV of time histories and accelerances.

use crate::support::recorded::measurement;
use num_complex::Complex64;
use orthopanel_data::{RecordFile, RecordKind, Samples, TimeHistory};

fn read(text: &str) -> Result<RecordFile, String> {
    RecordFile::from_bytes(text.as_bytes(), "a.csv").map_err(|error| error.to_string())
}

#[test]
fn val_a_time_history_gives_force_and_acceleration() {
    let file = read("\u{feff}# hit 1\r\ntime_s, acceleration_m_s2, force_n\r\n0,1,2\r\n0.5, -3e-1,4\r\n").unwrap();
    let [acceleration, force] = &file.records[..] else { panic!("{file:?}") };
    assert_eq!((force.kind, &force.abscissa[..]), (RecordKind::Time, &[0.0, 0.5][..]));
    assert_eq!((&force.ordinate, force.numerator.unit.as_str()), (&Samples::Real(vec![2.0, 4.0]), "N"));
    assert_eq!(acceleration.ordinate, Samples::Real(vec![1.0, -0.3]));
}

#[test]
fn val_an_accelerance_may_bring_its_coherence() {
    let file = read("frequency_hz,real,imag,coherence\n1,2,3,1\n2,4,5,0.5\n").unwrap();
    let values = vec![Complex64::new(2.0, 3.0), Complex64::new(4.0, 5.0)];
    assert_eq!(file.records[0].ordinate, Samples::Complex(values));
    assert_eq!(file.records[1].ordinate, Samples::Real(vec![1.0, 0.5]));
    assert_eq!(read("frequency_hz,real,imag\n1,2,3\n").unwrap().records.len(), 1);
}

/// The line where a row was lost is named, not one far from it at which the times no longer fit the mean step.
#[test]
fn val_a_lost_row_is_named() {
    let row = |n: usize| format!("{},{},{}\n", n as f64 / 1000.0, if n == 50 { 1.0 } else { 0.0 }, (n as f64).sin());
    let text: String = (0..2000).filter(|n| *n != 1200).map(row).collect();
    let file = read(&format!("time_s,force_n,acceleration_m_s2\n{text}")).unwrap();
    let message = TimeHistory::from_records(file, &measurement()).unwrap_err().to_string();
    assert!(message.starts_with("a.csv:1202: ") && message.contains("2.000 times the usual step"), "{message}");
}

#[test]
fn val_faults_name_file_line_and_column() {
    let cases = [
        ("frequency_hz,real\n0,1\n", "a.csv:1: column imag is missing among \"frequency_hz\", \"real\""),
        ("frequency_hz,real,imag,real\n0,1,2,3\n", "a.csv:1: column real stands twice"),
        ("frequency_hz,real,imag\n1,2,x\n", "a.csv:2: imag: \"x\" is no number"),
        ("frequency_hz,real,imag\n1,2,3\n2,NaN,3\n", "a.csv:3: real: point 2 is not a finite number"),
        ("frequency_hz,real,imag\n1,2,3\n2,1e200,3\n", "a.csv:3: real: point 2 is not a finite number below 1e30"),
        ("frequency_hz,real,imag\n1,2,3\n1,2,3\n", "a.csv:3: frequency_hz: 1 does not rise"),
        ("frequency_hz,real,imag\n1,2,3\n2,2\n", "a.csv:3: 2 values where the first line names 3 columns"),
        ("frequency_hz,real,imag\n", "a.csv:1: no row under the column names in it"),
        (
            "1,2,3\n2,3,4\n",
            "a.csv:1: 3 columns of numbers, and no line that names them: say which is which by columns = {time = 1",
        ),
        ("A,B,C\n1,2,3\n2,3,4\n", "a.csv:1: no column of times or frequencies among \"A\", \"B\", \"C\": say which"),
        ("words alone\n", "a.csv: not a file of records; read are: universal file"),
    ];
    for (text, said) in cases {
        let message = read(text).unwrap_err();
        assert!(message.contains(said), "\n  said   {message}\n  wanted {said}");
    }
}
