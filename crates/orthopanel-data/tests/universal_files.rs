//! Universal files as they are met in the wild: every layout, and every known way to write one wrong.

use crate::support::Dataset;
use num_complex::Complex64;
use orthopanel_data::{DataError, Record, RecordFile, RecordKind, Samples};

const VALUES: [f64; 5] = [1.5, -0.25, 3.0e-7, -1.0, 123456.0];

#[track_caller]
fn read(bytes: &[u8]) -> RecordFile {
    RecordFile::from_bytes(bytes, "a.uff").unwrap_or_else(|error| panic!("{error}"))
}

#[track_caller]
fn refused(bytes: &[u8]) -> DataError {
    match RecordFile::from_bytes(bytes, "a.uff") {
        Ok(file) => panic!("accepted: {file:?}"),
        Err(error) => error,
    }
}

fn real(record: &Record) -> &[f64] {
    match &record.ordinate {
        Samples::Real(values) => values,
        Samples::Complex(_) => &[],
    }
}

/// Layout number `index` of the eight, with values that single precision and six digits hold exactly.
fn layout(index: u32) -> (Dataset, Vec<f64>, Samples) {
    let [complex, double, even] = [1, 2, 4].map(|bit| index & bit != 0);
    let mut dataset = Dataset::time(&[], (12, "m/s^2"));
    dataset.complex = complex;
    dataset.double = double;
    dataset.even = even.then(|| ("2.00000e+00".into(), "5.00000e-01".into()));
    let abscissa: Vec<f64> = (0..5).map(|point| 2.0 + 0.5 * f64::from(point)).collect();
    let values = VALUES.map(|value| f64::from(value as f32)).map(|value| (value * 1e5).round() / 1e5);
    let values = if double { VALUES } else { values };
    let imaginary = |value: f64| -2.0 * value;
    dataset.points = abscissa
        .iter()
        .zip(values)
        .map(|(&x, value)| {
            let x = if even { None } else { Some(x) };
            x.into_iter().chain([value]).chain(complex.then_some(imaginary(value))).collect()
        })
        .collect();
    let ordinate = if complex {
        Samples::Complex(values.iter().map(|&value| Complex64::new(value, imaginary(value))).collect())
    } else {
        Samples::Real(values.to_vec())
    };
    (dataset, abscissa, ordinate)
}

#[track_caller]
fn assert_close(found: &Samples, expected: &Samples, tolerance: f64) {
    let parts = |samples: &Samples| match samples {
        Samples::Real(values) => values.clone(),
        Samples::Complex(values) => values.iter().flat_map(|value| [value.re, value.im]).collect(),
    };
    let (found, expected) = (parts(found), parts(expected));
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(&expected) {
        assert!((found - expected).abs() <= tolerance * expected.abs(), "{found} is not {expected}");
    }
}

#[test]
fn val_all_eight_layouts_are_read_as_text() {
    for index in 0..8 {
        let (dataset, abscissa, ordinate) = layout(index);
        let file = read(&dataset.text());
        assert_eq!(*file.records[0].abscissa, *abscissa, "layout {index}");
        // Six digits are printed.
        assert_close(&file.records[0].ordinate, &ordinate, 5e-6);
        assert_eq!(file.notes, [""; 0], "layout {index}");
    }
}

#[test]
fn val_all_eight_layouts_are_read_as_bytes_of_either_order() {
    for index in 0..8 {
        for big_endian in [false, true] {
            let (dataset, abscissa, ordinate) = layout(index);
            let file = read(&dataset.binary(big_endian));
            assert_eq!(*file.records[0].abscissa, *abscissa, "layout {index}");
            // Half a unit in the last place of single precision.
            assert_close(&file.records[0].ordinate, &ordinate, 6e-8);
            assert_eq!(file.notes, [""; 0], "layout {index}");
        }
    }
}

#[test]
fn val_the_header_tells_kind_ports_axes_and_title() {
    let mut dataset = Dataset::time(&VALUES, (12, "m/s^2"));
    (dataset.function, dataset.reference_direction) = (4, -3);
    dataset.denominator = (13, "N".into());
    let file = read(&dataset.text());
    let record = &file.records[0];
    assert_eq!(record.kind, RecordKind::FrequencyResponse);
    assert_eq!((record.response.node, record.response.direction), (7, 3));
    assert_eq!((record.reference.node, record.reference.direction), (8, -3));
    assert_eq!((record.numerator.data_type, record.numerator.unit.as_str()), (12, "m/s^2"));
    assert_eq!((record.denominator.data_type, record.denominator.unit.as_str()), (13, "N"));
    assert_eq!(record.title, "a record");
}

#[test]
fn val_wrong_byte_counts_do_not_matter() {
    let dataset = Dataset::time(&VALUES, (12, "m/s^2"));
    let data = dataset.binary_data(false);
    for announced in [0, 20, 39, 41, 80, 1_000_000] {
        let file = read(&[dataset.binary_with(false, announced, &data), dataset.binary(false)].concat());
        assert_eq!(file.records.len(), 2, "announced {announced}");
        assert_eq!(real(&file.records[0]), VALUES);
        assert!(file.notes[0].contains(&format!("announces {announced} bytes, the data have 40")), "{:?}", file.notes);
    }
}

/// pyuff with `force_double=False` says single and writes double.
#[test]
fn val_another_precision_than_announced_is_found_by_the_length() {
    let mut dataset = Dataset::time(&VALUES, (12, "m/s^2"));
    let doubles = dataset.binary_data(true);
    dataset.double = false;
    let file = read(&dataset.binary_with(true, 20, &doubles));
    assert_eq!(real(&file.records[0]), VALUES);
    assert!(file.notes[0].contains("says 32 bits a value, the data's length says 64"), "{:?}", file.notes);
}

/// The definition prints an uneven double layout with a single abscissa; some write it so in bytes as well.
#[test]
fn val_a_single_abscissa_with_double_values_is_found_by_the_length() {
    let (dataset, abscissa, ordinate) = layout(3);
    let data: Vec<u8> = dataset
        .points
        .iter()
        .flat_map(|point| {
            let (x, values) = point.split_first().unwrap();
            [(*x as f32).to_le_bytes().to_vec(), values.iter().flat_map(|value| value.to_le_bytes()).collect()].concat()
        })
        .collect();
    let file = read(&dataset.binary_with(false, data.len(), &data));
    assert_eq!(*file.records[0].abscissa, *abscissa);
    assert_close(&file.records[0].ordinate, &ordinate, 0.0);
}

#[test]
fn val_the_mark_inside_binary_data_does_not_end_them() {
    // Two doubles whose bytes read as a line end, the mark and a line end: six points of data follow it.
    let marks: Vec<f64> = [*b"\n    -1\n", *b"    -1\n0"].map(f64::from_le_bytes).to_vec();
    let values = [&marks[..], &VALUES[..]].concat();
    let dataset = Dataset::time(&values, (12, "m/s^2"));
    assert_eq!(real(&read(&dataset.binary_with(false, 7, &dataset.binary_data(false))).records[0]), values);
}

#[test]
fn val_a_value_that_looks_like_the_mark_is_a_value() {
    let dataset = Dataset::time(&VALUES[..3], (12, "m/s^2"));
    let head = String::from_utf8(dataset.text()).unwrap();
    let head = head.split_at(head.find("  1.5").unwrap()).0.trim_end_matches(' ').to_owned();
    let file = read(format!("{head}   2\n    -1\n   3\n    -1\n").as_bytes());
    assert_eq!(real(&file.records[0]), [2.0, -1.0, 3.0]);
}

#[test]
fn val_marks_may_be_doubled_or_left_out_between_datasets() {
    let text = Dataset::time(&VALUES, (12, "m/s^2")).text();
    let double: Vec<u8> = [&b"    -1\n"[..], &text, b"    -1\n", &text, b"    -1\n\x1a"].concat();
    assert_eq!(read(&double).records.len(), 2);
    let shared = [&text, text.strip_prefix(b"    -1\n").unwrap()].concat();
    assert_eq!(read(&shared).records.len(), 2);
    let windows = String::from_utf8([text.clone(), text].concat()).unwrap().replace('\n', "\r\n");
    assert_eq!(read(windows.as_bytes()).records.len(), 2);
}

/// Cut within the mark that opens the next dataset, nothing of the records is missing, and more may be.
#[test]
fn val_a_file_cut_within_the_next_mark_is_told() {
    for dataset in [layout(4).0.text(), layout(4).0.binary(false)] {
        let whole = [&dataset[..], &dataset].concat();
        assert_eq!(read(&whole).notes, [""; 0]);
        for cut in 1..=6 {
            let file = read(&whole[..dataset.len() + cut]);
            assert_eq!(file.records.len(), 1);
            let said = format!("byte {}", dataset.len() + if cut < 6 { 0 } else { 4 });
            assert!(matches!(&file.notes[..], [note] if note.contains(&said) && note.contains("may be cut off")));
        }
    }
}

#[test]
fn val_joined_fields_are_parted() {
    let dataset = Dataset { double: false, ..Dataset::time(&[-1e-100, -2e-101, -3e-102, 4.0], (12, "m/s^2")) };
    let text = String::from_utf8(dataset.text()).unwrap();
    assert!(text.contains("-1.00000e-100-2.00000e-101-3.00000e-102"), "the fields are not joined");
    assert_eq!(real(&read(text.as_bytes()).records[0]), [-1e-100, -2e-101, -3e-102, 4.0]);
}

#[test]
fn val_zeros_after_an_odd_count_are_left_out_and_said() {
    let dataset = Dataset::time(&VALUES, (12, "m/s^2"));
    let text = String::from_utf8(dataset.text()).unwrap();
    let padded = text.replacen("e+05\n    -1", "e+05   0.00000000000e+00\n    -1", 1);
    assert_ne!(text, padded);
    let file = read(padded.as_bytes());
    assert_eq!(real(&file.records[0]), VALUES);
    assert!(file.notes[0].contains("1 zeros after the last of 5 points left out"), "{:?}", file.notes);
    let data = [dataset.binary_data(false), vec![0; 8]].concat();
    let file = read(&dataset.binary_with(false, 48, &data));
    assert_eq!(real(&file.records[0]), VALUES);
    assert!(file.notes[0].contains("zero bytes after the last point left out"), "{:?}", file.notes);
}

#[test]
fn val_a_rounded_step_is_restored_and_said() {
    let mut dataset = Dataset::time(&[0.0; 1001], (12, "m/s^2"));
    dataset.even = Some(("5.00000e+00".into(), "1.95312e-02".into()));
    let file = read(&dataset.text());
    assert_eq!(file.records[0].abscissa[1000], 5.0 + 1000.0 * 0.01953125);
    assert!(file.notes[0].contains("0.0195312 is a rounded 0.01953125"), "{:?}", file.notes);
}

#[test]
fn val_other_datasets_are_skipped_and_said() {
    let geometry = b"    -1\n    55\n         1         0\n    -1\n  0.0\n    -1\n";
    let file = read(&[&geometry[..], &Dataset::time(&VALUES, (12, "m/s^2")).text()].concat());
    assert_eq!(file.records.len(), 1);
    assert!(file.notes[0].contains("dataset 55 at byte 7 skipped"), "{:?}", file.notes);
    assert!(matches!(refused(geometry), DataError::NoRecords { .. }));
}

#[test]
fn val_coherence_that_is_no_number_counts_as_none() {
    let dataset = Dataset { function: 6, ..Dataset::time(&[f64::NAN, 0.5], (0, "NONE")) };
    let file = read(&dataset.binary(false));
    assert_eq!(real(&file.records[0]), [0.0, 0.5]);
    assert!(file.notes[0].contains("not a number in 1 lines"), "{:?}", file.notes);
}

#[test]
fn val_broken_files_are_refused_with_file_and_byte() {
    let dataset = Dataset::time(&VALUES, (12, "m/s^2"));
    let (text, binary) = (String::from_utf8(dataset.text()).unwrap(), dataset.binary(false));
    let cases: [(&str, Vec<u8>, &str); 11] = [
        ("cut in the header", text.as_bytes()[..300].to_vec(), "record 1: the file ends where"),
        ("cut in text data", text.as_bytes()[..text.len() - 60].to_vec(), "values announced, the data end after"),
        ("cut in binary data", binary[..binary.len() - 20].to_vec(), "40 bytes announced, the data end after 28"),
        (
            "text data end early",
            text.replace("         5         1", "         9         1").into(),
            "9 values announced",
        ),
        (
            "too many values",
            text.replace("         5         1", "         4         1").into(),
            "4 values announced, 5",
        ),
        ("a word in the data", text.replace("1.50000000000e+00", "             what").into(), "\"what\" is no number"),
        ("not a number", dataset.text_with_nan(), "record 1: point 1 is not a finite number"),
        (
            "data type",
            text.replace("         4         5", "         3         5").into(),
            "data type 3: must be 2 or 4",
        ),
        ("no step", text.replace("1.00000e-03", "0.00000e+00").into(), "step 0: must be finite"),
        ("VAX floats", replace(&binary, b"     1     2", b"     1     1"), "floating-point format Some(1) of 58b"),
        ("no dataset number", text.replace("    58", "    ab").into(), "a dataset number expected after the mark"),
    ];
    for (name, bytes, said) in cases {
        let message = refused(&bytes).to_string();
        assert!(message.starts_with("a.uff, byte "), "{name}: {message}");
        assert!(message.contains(said), "{name}\n  said   {message}\n  wanted {said}");
    }
    let surplus = [dataset.binary_data(false), vec![1; 8]].concat();
    match refused(&dataset.binary_with(false, 40, &surplus)) {
        DataError::Surplus { needed: 40, found, .. } => assert!(found >= 48),
        other => panic!("{other}"),
    }
    assert!(matches!(refused(b"hello"), DataError::UnknownFormat { .. }));
}

impl Dataset {
    fn text_with_nan(&self) -> Vec<u8> {
        let text = String::from_utf8(self.text()).unwrap();
        text.replace("1.50000000000e+00", "              NaN").into_bytes()
    }
}

fn replace(bytes: &[u8], from: &[u8], to: &[u8]) -> Vec<u8> {
    let at = bytes.windows(from.len()).position(|window| window == from).unwrap();
    [&bytes[..at], to, &bytes[at + from.len()..]].concat()
}

/// What pyuff writes, in every layout it knows, is what we read; its own reader is not asked.
#[test]
fn val_pyuff_files_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let Some(listing) = crate::support::python("write_with_pyuff.py", "pyuff", &[folder.path()]) else { return };
    let mut files = 0;
    for line in listing.lines() {
        let record =
            RecordFile::read(folder.path().join(line)).unwrap_or_else(|error| panic!("{error}")).records.remove(0);
        let complex = line.contains("complex");
        // The script writes x = 2 + 0.5 n and y = (n + 1)^2 / 7 - 3 (1j) n for n = 0..10.
        for n in 0..11 {
            let x = 2.0 + 0.5 * n as f64;
            let (re, im) = ((n as f64 + 1.0).powi(2) / 7.0, -3.0 * n as f64);
            assert!((record.abscissa[n] - x).abs() < 1e-12, "{line}: {} is not {x}", record.abscissa[n]);
            let (found_re, found_im) = match &record.ordinate {
                Samples::Real(values) => (values[n], 0.0),
                Samples::Complex(values) => (values[n].re, values[n].im),
            };
            // Text holds 6 digits in single and 12 in double precision.
            let tolerance = if line.contains("single") { 1e-5 } else { 1e-11 };
            assert!((found_re - re).abs() < tolerance * re, "{line}: {found_re} is not {re}");
            let im = if complex { im } else { 0.0 };
            assert!((found_im - im).abs() <= tolerance * im.abs(), "{line}: {found_im} is not {im}");
        }
        assert_eq!(record.ordinate.len(), 11, "{line}");
        files += 1;
    }
    assert_eq!(files, 16);
}

#[test]
fn val_measured_files_are_read() {
    if let Some(path) = crate::support::measured("free_beam/point-0.uff") {
        let file = RecordFile::read(path).unwrap();
        let record = &file.records[0];
        assert_eq!((record.ordinate.len(), record.kind), (50945, RecordKind::FrequencyResponse));
        assert_eq!(record.abscissa[50944], 1000.0);
    }
    if let Some(path) = crate::support::measured("hammer_hits/hits.uff") {
        let file = RecordFile::read(path).unwrap();
        assert_eq!((file.records.len(), file.records[9].ordinate.len()), (10, 25600));
        assert!(file.notes.is_empty(), "{:?}", file.notes);
    }
}

/// A number that is none, or that no sensor reads, among binary data: its own byte is named.
#[test]
fn val_a_value_that_is_no_number_is_told_with_its_byte() {
    for (double, width, wrong) in [(false, 4, f64::NAN), (true, 8, f64::NAN), (true, 8, -1e200), (false, 4, 2e30)] {
        let values: Vec<f64> = (0..9).map(|index| if index == 6 { wrong } else { f64::from(index) }).collect();
        let bytes = Dataset { double, ..Dataset::time(&values, (12, "m/s^2")) }.binary(false);
        let refused = RecordFile::from_bytes(&bytes, "a.uff").unwrap_err().to_string();
        let data = bytes.len() - "\n    -1\n".len() - 9 * width;
        assert!(refused.contains(&format!("a.uff, byte {}: ", data + 6 * width)), "{refused}, data from {data}");
        assert!(refused.contains("point 7 is not a finite number"), "{refused}");
    }
}
