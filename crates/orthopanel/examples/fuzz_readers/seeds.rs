//! The readers, and good files of each that together reach all of it; mutation does the rest.

use std::{
    fs,
    io::{Cursor, Write as _},
    path::Path,
};

use zip::{CompressionMethod, ZipWriter, write::SimpleFileOptions};

use crate::readers;

pub struct Reader {
    /// Of the coverage-guided target, too.
    pub name: &'static str,
    /// Reads, and tells whether the file was accepted.
    pub feed: fn(&[u8]) -> bool,
    pub files: Vec<Vec<u8>>,
}

/// Samples of a record.
const POINTS: usize = 64;

pub fn readers() -> Vec<Reader> {
    let pulse: Vec<f64> = (0..POINTS).map(|n| if n == 9 { 1.0 } else { 0.0 }).collect();
    let ringing: Vec<f64> =
        (0..POINTS).map(|n| if n < 9 { 0.0 } else { 0.8f64.powi(n as i32 - 9) * (n as f64).sin() }).collect();
    let rows = |columns: &str, row: fn(usize) -> String| {
        (columns.to_owned() + &(0..32).map(row).collect::<String>()).into_bytes()
    };
    vec![
        Reader { name: "uff", feed: readers::records, files: universal_files(&pulse, &ringing) },
        Reader {
            name: "csv_records",
            feed: readers::records,
            files: vec![
                rows("time_s,force_n,acceleration_m_s2\n", |n| format!("{n}e-3,{},{n}e-3\n", n % 7)),
                rows("frequency_hz,real,imag,coherence\n", |n| format!("{n},1.5,-{n},0.9\n")),
                rows("frequency_hz,real,imag,variance,decay_rate_1_s\n", |n| format!("{n},1.5,-{n},0.01,2\n")),
                blow(),
            ],
        },
        Reader {
            name: "test_toml",
            feed: readers::test_toml,
            files: [vec![EVERY_KEY.into()], files("examples", "toml")].concat(),
        },
        Reader { name: "model_json", feed: readers::model_json, files: files("examples", "json") },
        Reader {
            name: "force_csv",
            feed: readers::force_csv,
            files: vec![
                rows("time_s,force_n\n", |n| format!("{n}e-5,{}.25\n", n % 7)),
                rows("# two places\ntime_s, note, force_2_n, force_1_n\n", |n| format!("{n}, a, 0, {n}\n")),
            ],
        },
        Reader { name: "fmu_archive", feed: readers::fmu_archive, files: vec![archive()] },
        Reader { name: "fmu_description", feed: readers::fmu_description, files: files("modelDescription", "xml") },
    ]
}

const EVERY_KEY: &str = r#"structure = "timoshenko-beam"
[[piece]]
name = "1"
length = 0.8
width = 0.1
thickness = 0.03
weighings = [[0.1, 0.1, 6.862e-2]]
own_constants = ["g_zx"]
[[piece]]
name = "2"
length = 0.6
width = 0.1
thickness = 0.03
mass_per_area = 6.9
[boundary]
left = "free"
[suspension]
at = [-0.22, 0.22]
[constants]
e_x = 7.0e10
[[effect]]
id = "sensor-mass"
owner = "rig"
mass = 0.005
[[measurement]]
kind = "natural-frequencies"
piece = "1"
values = [321.3, 837.5]
resolution = 1.25
scatter = [0.5, 2]
shape = [[2, 0], [1, 1]]
response_at = [0.3, 0.0]
[[measurement]]
kind = "accelerance"
piece = "2"
file = "point-0.uff"
record = 2
force_at = [0.0, 0.0]
response_at = [0.3, 0.0]
response_unit = "mm/s"
force_unit = "lbf"
quantity = "velocity"
response_sensitivity = 0.01
force_sensitivity = 0.002
response_channel = "12:+z"
force_channel = 1
window_decay = 0.25
direction = -1
[[measurement]]
kind = "time-history"
piece = "1"
file = ["point-*.uff"]
sampling_rate = 25600
trigger = {level = 30, before = 0.02, length = 1.6}
force_at = [0.0, 0.0]
response_at = [0.3, 0.0]
unit = "g"
"#;

/// What comes before records: units, and places of nodes in both of their datasets.
const BEFORE_RECORDS: &str = "    -1
   164
         7IN: Inch (pound f)           2
   3.9370078740000000D+01   2.2480894310000000D-01   1.0000000000000000D+00
   2.7315000000000000D+02
    -1
    -1
    15
         1         0         0         8 -3.00000e-01  0.00000e+00  0.00000e+00
    -1
    -1
  2411
         2         0         0         8
   3.0000000000000000D-01   0.0000000000000000D+00   0.0000000000000000D+00
    -1
";

/// What is no good file for the reader of its ending.
const OTHERS: [&str; 2] = ["truth.json", "terminalsAndIcons.xml"];

/// The files of an ending in a folder of the repository and in the folders there; none is larger than a mutation can go over.
fn files(folder: &str, ending: &str) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(folder);
    let entries = |folder: &Path| fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let (folders, files): (Vec<_>, Vec<_>) = entries(&folder).partition(|path| path.is_dir());
    let inner = folders.iter().flat_map(|folder| entries(folder));
    let mut paths: Vec<_> = files.iter().cloned().chain(inner).collect();
    // One order on every machine, or a seed would not repeat a run.
    paths.sort();
    let named = paths.iter().filter(|path| path.extension().is_some_and(|found| found == ending));
    let good = named.filter(|path| !OTHERS.iter().any(|other| path.ends_with(other)));
    good.map(|path| fs::read(path).expect("a file")).collect()
}

/// CSV of a blow that is kept, with a little noise.
fn blow() -> Vec<u8> {
    let row = |n: u32| {
        let after = f64::from(n) - 100.0;
        let push = if (0.0..8.0).contains(&after) { (after * std::f64::consts::PI / 8.0).sin() } else { 0.0 };
        let ringing = if after < 0.0 { 0.0 } else { 0.97f64.powf(after) * after.sin() };
        let noise = f64::from(n * n);
        format!("{n}e-4,{:.6},{:.6}\n", push + 1e-4 * noise.sin(), ringing + 1e-4 * noise.cos())
    };
    ("time_s,force_n,acceleration_m_s2\n".to_owned() + &(0..512).map(row).collect::<String>()).into_bytes()
}

/// Datasets 58 and 58b in both byte orders and all eight layouts: a force with its acceleration, or an accelerance.
fn universal_files(force: &[f64], motion: &[f64]) -> Vec<Vec<u8>> {
    let mut files = Vec::new();
    for order in 0..3 {
        for layout in 0..8 {
            let (complex, double, even) = (layout & 4 > 0, layout & 2 > 0, layout & 1 > 0);
            let dataset = |axes, samples: &[f64]| dataset(order, [complex, double, even], axes, samples);
            let (newton, metre, none) = ((13, "N"), (12, "m/s^2"), (0, "NONE"));
            let (untold_force, speed) = ((13, "NONE"), (11, "NONE"));
            files.push(if complex {
                dataset([metre, newton], motion)
            } else {
                [dataset([newton, none], force), dataset([metre, none], motion)].concat()
            });
            let in_file_units = if complex {
                dataset([speed, untold_force], motion)
            } else {
                [dataset([untold_force, none], force), dataset([speed, none], motion)].concat()
            };
            files.push([BEFORE_RECORDS.as_bytes(), &in_file_units].concat());
        }
    }
    files
}

/// `order` is 1 or 2 as in a 58b, 0 for text.
fn dataset(order: u8, [complex, double, even]: [bool; 3], axes: [(i64, &str); 2], samples: &[f64]) -> Vec<u8> {
    let axis = |(kind, unit): (i64, &str)| format!("{kind:10}{:5}{:5}{:5} {:<20} {unit:<20}\n", 0, 0, 0, "NONE");
    let data_type = match (complex, double) {
        (false, false) => 2,
        (false, true) => 4,
        (true, false) => 5,
        (true, true) => 6,
    };
    let abscissa = if complex { (18, "Hz") } else { (17, "s") };
    let header = format!("{:<80}\n", "NONE").repeat(5)
        + &format!(
            "{:5}{:10}{:5}{:10} {:>10}{:10}{:4} {:>10}{:10}{:4}\n",
            if complex { 4 } else { 1 },
            0,
            0,
            0,
            "NONE",
            1,
            3,
            "NONE",
            1,
            3
        )
        + &format!(
            "{data_type:10}{:10}{:10}{:>13}{:>13}{:>13}\n",
            samples.len(),
            u8::from(even),
            "0.00000e+00",
            "1.95312e-04",
            "0.0e+00"
        )
        + &[abscissa, axes[0], axes[1], (0, "NONE")].map(axis).concat();
    let numbers = samples.iter().enumerate().flat_map(|(index, &sample)| {
        let abscissa = (!even).then_some(index as f64 * 1.95312e-4);
        abscissa.into_iter().chain([sample]).chain(complex.then_some(-sample))
    });
    let data: Vec<u8> = match (order, double) {
        (0, _) => numbers.flat_map(|number| format!("{number:20.11e}\n").into_bytes()).collect(),
        (1, true) => numbers.flat_map(f64::to_le_bytes).collect(),
        (_, true) => numbers.flat_map(f64::to_be_bytes).collect(),
        (1, false) => numbers.flat_map(|number| (number as f32).to_le_bytes()).collect(),
        (_, false) => numbers.flat_map(|number| (number as f32).to_be_bytes()).collect(),
    };
    let first = match order {
        0 => "    -1\n    58\n".to_owned(),
        _ => {
            format!("    -1\n    58b{order:6}     2          11{:12}     0     0           0           0\n", data.len())
        }
    };
    [first.as_bytes(), header.as_bytes(), &data, b"\n    -1\n"].concat()
}

/// An archive with a file stored and one compressed.
fn archive() -> Vec<u8> {
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, method) in [("a", CompressionMethod::Stored), ("resources/b", CompressionMethod::Deflated)] {
        let options = SimpleFileOptions::default().compression_method(method);
        writer.start_file(name, options).expect("an entry");
        writer.write_all(&[b'x'; 100]).expect("its content");
    }
    writer.finish().expect("an archive").into_inner()
}
