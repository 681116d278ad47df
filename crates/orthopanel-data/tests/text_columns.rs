//! Columns of numbers in texts of any kind: what is assumed is said, and what cannot be told is asked about.

use orthopanel_data::{ColumnName, ColumnRole, DeclaredColumns, RecordFile, RecordKind, Samples};

fn read(text: &str) -> Result<RecordFile, String> {
    RecordFile::from_bytes(text.as_bytes(), "a.txt").map_err(|error| error.to_string())
}

fn values(file: &RecordFile, record: usize) -> Vec<f64> {
    match &file.records[record].ordinate {
        Samples::Real(values) => values.clone(),
        Samples::Complex(values) => values.iter().map(|value| value.re).collect(),
    }
}

#[test]
fn val_what_was_assumed_is_said_in_one_line() {
    let file = read("Messung\n\nZeit;Hammer;Beschl. 1\n[ms];[N];[g]\n0;1,5;-2e-3\n0,5;2;0,25;\n").unwrap();
    assert_eq!(
        file.notes[0],
        "columns divided by semicolons, from line 5: \"Zeit\" (time) in ms, \"Hammer\" (force) in N, \"Beschl. 1\" (acceleration) in g"
    );
    assert_eq!(&file.records[0].abscissa[..], &[0.0, 5e-4]);
    assert_eq!((values(&file, 0), values(&file, 1)), (vec![1.5, 2.0], vec![-2e-3, 0.25]));
    assert_eq!(file.records[1].numerator.unit, "g");
    // This project's own names say it all.
    assert!(read("time_s,force_n,acceleration_m_s2\n0,1,2\n1,1,2\n").unwrap().notes.is_empty());
}

#[test]
fn val_every_column_over_time_is_a_channel() {
    let file = read("Time (s)\tForce (N)\tTemp\tAcc x (g)\tAcc z (g)\n0\t1\t2\t3\t4\n1\t1\t2\t3\t4\n").unwrap();
    let titles: Vec<&str> = file.records.iter().map(|record| record.title.as_str()).collect();
    assert_eq!(titles, ["Force (N)", "Temp", "Acc x (g)", "Acc z (g)"]);
    assert!(file.records.iter().all(|record| record.kind == RecordKind::Time));
    let listed = file.listed();
    let quantities: Vec<&str> = listed.iter().map(|record| record.quantity.as_str()).collect();
    assert_eq!(quantities, ["force", "untold", "acceleration", "acceleration"]);
}

#[test]
fn val_magnitudes_and_phases_become_complex() {
    let file = read("Frequency (kHz),Magnitude (dB re 1 (m/s^2)/N),Phase (deg)\n0.1,20,0\n0.2,40,90\n").unwrap();
    let Samples::Complex(values) = &file.records[0].ordinate else { panic!("{file:?}") };
    assert!((values[0].re - 10.0).abs() < 1e-12 && (values[1].im - 100.0).abs() < 1e-10, "{values:?}");
    assert_eq!(&file.records[0].abscissa[..], &[100.0, 200.0]);
    assert_eq!(file.records[0].numerator.unit, "(m/s^2)/N");
    // Degrees that no label tells go beyond a turn of radians.
    let file = read("f,mag,phase\n1,1,0\n2,1,180\n3,1,-90\n").unwrap();
    assert!(file.notes.iter().any(|note| note.contains("taken as degrees: it goes to 180")), "{:?}", file.notes);
    let Samples::Complex(values) = &file.records[0].ordinate else { panic!("{file:?}") };
    assert!((values[1].re + 1.0).abs() < 1e-12, "{values:?}");
}

#[test]
fn val_a_labview_file_has_a_record_a_stretch_and_channel() {
    let stretch = "Channels\t2\t\t\nSamples\t2\t2\t\nY_Unit_Label\tNewtons\tm/s^2\t\nX0\t0\t0\t\nDelta_X\t0.5\t0.5\t\n***End_of_Header***\t\t\t\n\
                   X_Value\tHammer\tVoltage\tComment\n\t1\t2\tstart\n\t3\t4\n\n";
    let head = "LabVIEW Measurement\t\nSeparator\tTab\nX_Columns\tNo\n***End_of_Header***\t\n\n";
    let file = read(&format!("{head}{stretch}{stretch}")).unwrap();
    assert_eq!(file.records.len(), 4, "{file:?}");
    assert_eq!((values(&file, 2), &file.records[2].abscissa[..]), (vec![1.0, 3.0], &[0.0, 0.5][..]));
    assert_eq!(file.records[3].numerator.unit, "m/s^2");
    assert!(
        file.notes[0].starts_with("columns divided by tabs, from line 13: \"Hammer\" (force) in Newtons"),
        "{:?}",
        file.notes
    );
}

#[test]
fn val_columns_are_declared_by_number_and_by_name() {
    let home = tempfile::tempdir().unwrap();
    let path = home.path().join("a.txt");
    std::fs::write(&path, "0 5 1\n1 6 2\n2 7 3\n").unwrap();
    let declared = |of: &[(ColumnRole, usize)]| {
        DeclaredColumns(of.iter().map(|(role, number)| (*role, ColumnName::Number(*number))).collect())
    };
    let columns = declared(&[(ColumnRole::Time, 1), (ColumnRole::Force, 3), (ColumnRole::Response, 2)]);
    let file = RecordFile::read_columns(&path, Some(&columns)).unwrap();
    let quantities: Vec<String> = file.listed().into_iter().map(|record| record.quantity).collect();
    assert_eq!((quantities[0].as_str(), values(&file, 0)), ("untold", vec![5.0, 6.0, 7.0]));
    assert_eq!((quantities[1].as_str(), values(&file, 1)), ("force", vec![1.0, 2.0, 3.0]));
    // Rows are counted where no column tells the times: the measurement's sampling_rate counts then.
    let counted = RecordFile::read_columns(&path, Some(&declared(&[(ColumnRole::Force, 3)]))).unwrap();
    assert_eq!(&counted.records[0].abscissa[..], &[0.0, 1.0, 2.0]);
    assert!(counted.notes[0].ends_with("rows counted in place of times"), "{:?}", counted.notes);
    let wrong = RecordFile::read_columns(&path, Some(&declared(&[(ColumnRole::Force, 4)]))).unwrap_err().to_string();
    assert!(
        wrong.contains("columns.force = 4 is none of its columns: \"column 1\", \"column 2\", \"column 3\""),
        "{wrong}"
    );
}

/// The formats that Python reads: what they are, and the lines that make columns of them.
#[test]
fn val_foreign_files_are_named_for_what_they_are() {
    let hdf5_behind_a_block = [&[b' '; 512][..], b"\x89HDF\r\n\x1a\n"].concat();
    for (bytes, name, needed) in [
        (&b"MATLAB 5.0 MAT-file, Platform: GLNXA64"[..], "a MAT file", "scipy.io.loadmat(\"x.bin\""),
        (b"\x89HDF\r\n\x1a\n....", "an HDF5 file", "h5py.File(\"x.bin\")"),
        (&hdf5_behind_a_block, "an HDF5 file", "h5py"),
        (b"TDSm\x0e\x00\x00\x00", "a TDMS file", "nptdms"),
        (b"RIFF\x24\x00\x00\x00WAVEfmt ", "a WAV file", "wavfile.read"),
        (b"PK\x03\x04....xl/workbook.xml", "an Excel workbook", "pandas.read_excel"),
        (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1....", "an Excel workbook", "pandas"),
        (b"\x93NUMPY\x01\x00", "a NPY or NPZ file", "numpy.load"),
        (b"PK\x03\x04....force.npy", "a NPY or NPZ file", "numpy.load"),
    ] {
        let said = RecordFile::from_bytes(bytes, "some/x.bin").unwrap_err().to_string();
        let lines: Vec<&str> = said.lines().collect();
        assert!(said.contains(name) && said.contains(needed) && lines.len() == 3, "{said}");
        assert!(lines[2].contains("hit.csv"), "{said}");
    }
    let said = RecordFile::from_bytes(b"\x00\x01\x02\x03", "x").unwrap_err().to_string();
    assert!(said.contains("not a file of records; read are: universal file"), "{said}");
}
