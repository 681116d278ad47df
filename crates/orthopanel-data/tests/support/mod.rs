//! Universal files made by hand, and the places of things that may be absent.

pub mod hammer;
pub mod recorded;

use std::{fmt::Write, path::PathBuf, process::Command};

/// A dataset 58 or 58b to be written, and the ways to write it wrong.
#[derive(Clone)]
pub struct Dataset {
    pub title: String,
    pub function: i64,
    pub response_node: i64,
    pub reference_node: i64,
    pub response_direction: i64,
    pub reference_direction: i64,
    pub complex: bool,
    pub double: bool,
    /// Start and step of an even abscissa; `None` writes the abscissa with each value.
    pub even: Option<(String, String)>,
    pub numerator: (i64, String),
    pub denominator: (i64, String),
    /// Values a point as stored: abscissa (if uneven), real, imaginary (if complex).
    pub points: Vec<Vec<f64>>,
}

impl Dataset {
    pub fn time(points: &[f64], numerator: (i64, &str)) -> Self {
        Self {
            title: "a record".into(),
            function: 1,
            response_node: 7,
            reference_node: 8,
            response_direction: 3,
            reference_direction: 3,
            complex: false,
            double: true,
            even: Some(("0.00000e+00".into(), "1.00000e-03".into())),
            numerator: (numerator.0, numerator.1.into()),
            denominator: (0, "NONE".into()),
            points: points.iter().map(|&value| vec![value]).collect(),
        }
    }

    /// The eleven header lines, without the dataset number.
    pub fn header(&self) -> String {
        let mut text = format!("{:<80}\n", self.title);
        text += &format!("{:<80}\n", "NONE").repeat(4);
        let (response, reference) = (self.response_direction, self.reference_direction);
        let function = self.function;
        writeln!(
            text,
            "{function:5}{:10}{:5}{:10} {:>10}{:10}{response:4} {:>10}{:10}{reference:4}",
            0, 0, 0, "NONE", self.response_node, "NONE", self.reference_node
        )
        .unwrap();
        let data_type = 2 + 2 * i64::from(self.double) + if self.complex { 3 - i64::from(self.double) } else { 0 };
        let even = i64::from(self.even.is_some());
        let (start, step) = self.even.clone().unwrap_or(("0.00000e+00".into(), "0.00000e+00".into()));
        let count = self.points.len();
        writeln!(text, "{data_type:10}{count:10}{even:10}{start:>13}{step:>13}{:>13}", "0.00000e+00").unwrap();
        let axis = |(data_type, unit): &(i64, String)| {
            format!("{data_type:10}{:5}{:5}{:5} {:<20} {unit:<20}\n", 0, 0, 0, "NONE")
        };
        let none = (0, "NONE".to_owned());
        text + &[&none, &self.numerator, &self.denominator, &none].map(axis).concat()
    }

    /// Values as Fortran's columns, 13 wide for singles and abscissas, 20 for doubles.
    pub fn text_data(&self) -> String {
        let mut text = String::new();
        let per_line = if self.double { 4 } else { 6 };
        let mut written = 0;
        for point in &self.points {
            for (index, &value) in point.iter().enumerate() {
                let abscissa = self.even.is_none() && index == 0;
                text += &if self.double && !abscissa { fortran(value, 20, 11) } else { fortran(value, 13, 5) };
                written += 1;
                if written % per_line == 0 {
                    text.push('\n');
                }
            }
            // The uneven double layouts hold whole points a line.
            if self.double && self.even.is_none() && !text.ends_with('\n') {
                text.push('\n');
                written = 0;
            }
        }
        if text.ends_with('\n') { text } else { text + "\n" }
    }

    pub fn binary_data(&self, big_endian: bool) -> Vec<u8> {
        let values = self.points.iter().flatten();
        let bytes = |&value: &f64| match (self.double, big_endian) {
            (true, false) => value.to_le_bytes().to_vec(),
            (true, true) => value.to_be_bytes().to_vec(),
            (false, false) => (value as f32).to_le_bytes().to_vec(),
            (false, true) => (value as f32).to_be_bytes().to_vec(),
        };
        values.flat_map(bytes).collect()
    }

    pub fn text(&self) -> Vec<u8> {
        format!("    -1\n    58{:74}\n{}{}    -1\n", "", self.header(), self.text_data()).into_bytes()
    }

    pub fn binary(&self, big_endian: bool) -> Vec<u8> {
        let data = self.binary_data(big_endian);
        self.binary_with(big_endian, data.len(), &data)
    }

    /// A 58b with any announced count and any data.
    pub fn binary_with(&self, big_endian: bool, announced: usize, data: &[u8]) -> Vec<u8> {
        let order = 1 + i64::from(big_endian);
        let first = format!("    -1\n    58b{order:6}{:6}{:12}{announced:12}{:6}{:6}{:12}{:12}\n", 2, 11, 0, 0, 0, 0);
        [first.as_bytes(), self.header().as_bytes(), data, b"\n    -1\n"].concat()
    }
}

/// A number as C and pyuff print it: `e+00`, at least two digits of exponent.
pub fn fortran(value: f64, width: usize, digits: usize) -> String {
    let text = format!("{value:.digits$e}");
    let (mantissa, exponent) = text.split_once('e').unwrap();
    let exponent: i32 = exponent.parse().unwrap();
    format!("{:>width$}", format!("{mantissa}e{}{:02}", if exponent < 0 { '-' } else { '+' }, exponent.abs()))
}

/// A folder or file of the measured data beside the repository; prints why and returns `None` where it is absent.
pub fn measured(name: &str) -> Option<PathBuf> {
    let beside = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let path = std::env::var_os("ORTHOPANEL_DATA").map_or(beside, PathBuf::from).join(name);
    if !path.exists() {
        println!("skipped: {} is absent (set ORTHOPANEL_DATA)", path.display());
        return None;
    }
    Some(path)
}

/// Runs a script of this folder with the Python named by `ORTHOPANEL_PYTHON`; `None` where there is none, or where
/// the package `needs` is not installed in it.
pub fn python(script: &str, needs: &str, arguments: &[&std::path::Path]) -> Option<String> {
    let Some(python) = std::env::var_os("ORTHOPANEL_PYTHON") else {
        println!("skipped: ORTHOPANEL_PYTHON names no Python with {needs}");
        return None;
    };
    let has = Command::new(&python).args(["-c", &format!("import {needs}")]).output().unwrap();
    if !has.status.success() {
        println!("skipped: {} has no {needs}", python.display());
        return None;
    }
    let script = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests").join(script);
    let output = Command::new(&python).arg(script).args(arguments).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(String::from_utf8(output.stdout).unwrap())
}
