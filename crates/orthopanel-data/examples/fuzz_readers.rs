//! Mutates good files and feeds them to every reader: none may panic, whatever the bytes.
//!
//! `cargo run -p orthopanel-data --example fuzz_readers -- [SECONDS] [SEED]`; 10 s and seed 1 unless said.
//! Without `--release` overflow checks are on; `.ci/run` trades them for many more rounds in its minute.
//! A panic prints its seed and round with the bytes, so that the run repeats it and a test can be made of them.
//! Coverage-guided fuzzing (cargo-fuzz) would go deeper, and needs a nightly compiler.

use std::{
    panic::{AssertUnwindSafe, catch_unwind},
    process::ExitCode,
    time::{Duration, Instant},
};

use orthopanel_data::{Accelerance, Estimation, ImpactTest, RecordFile, RecordedResponse, TimeHistory, Window};
use orthopanel_model::Place;

/// Good files that together reach every reader; mutation does the rest.
fn corpus() -> Vec<Vec<u8>> {
    let header = |function: i64, data_type: i64, points: usize, even: i64, axes: [(i64, &str); 2]| {
        let axis = |(kind, unit): (i64, &str)| format!("{kind:10}{:5}{:5}{:5} {:<20} {unit:<20}\n", 0, 0, 0, "NONE");
        format!("{:<80}\n", "NONE").repeat(5)
            + &format!(
                "{function:5}{:10}{:5}{:10} {:>10}{:10}{:4} {:>10}{:10}{:4}\n",
                0, 0, 0, "NONE", 1, 3, "NONE", 1, 3
            )
            + &format!(
                "{data_type:10}{points:10}{even:10}{:>13}{:>13}{:>13}\n",
                "0.00000e+00", "1.95312e-02", "0.0e+00"
            )
            + &[(17, "s"), axes[0], axes[1], (0, "NONE")].map(axis).concat()
    };
    let (force, motion, none) = ((13, "N"), (12, "m/s^2"), (0, "NONE"));
    let text = |header: String, values: &[f64]| {
        let data: String = values.iter().map(|value| format!("{value:20.11e}\n")).collect();
        format!("    -1\n    58\n{header}{data}    -1\n").into_bytes()
    };
    let binary = |order: u8, header: String, values: &[f64]| {
        let first = format!(
            "    -1\n    58b{order:6}     2          11{:12}     0     0           0           0\n",
            8 * values.len()
        );
        let bytes: Vec<u8> =
            values.iter().flat_map(|v| if order == 1 { v.to_le_bytes() } else { v.to_be_bytes() }).collect();
        [first.into_bytes(), header.into_bytes(), bytes, b"\n    -1\n".to_vec()].concat()
    };
    let pulse: Vec<f64> = (0..64).map(|n| if n == 9 { 1.0 } else { 0.0 }).collect();
    let ringing: Vec<f64> =
        (0..64).map(|n| if n < 9 { 0.0 } else { 0.8f64.powi(n - 9) * f64::from(n).sin() }).collect();
    let mut files = Vec::new();
    files.push(
        [text(header(1, 4, 64, 1, [force, none]), &pulse), text(header(1, 4, 64, 1, [motion, none]), &ringing)]
            .concat(),
    );
    for order in [1, 2] {
        let pair = [(force, &pulse), (motion, &ringing)];
        files.push(pair.map(|(axis, values)| binary(order, header(1, 4, 64, 1, [axis, none]), values)).concat());
        files.push(binary(order, header(4, 6, 32, 1, [motion, force]), &ringing));
    }
    files.push(text(header(4, 6, 16, 0, [motion, force]), &(0..48).map(f64::from).collect::<Vec<_>>()));
    let rows = |columns: &str, row: fn(usize) -> String| columns.to_owned() + &(0..32).map(row).collect::<String>();
    files.push(rows("time_s,force_n,acceleration_m_s2\n", |n| format!("{n},{},{n}e-3\n", n % 7)).into_bytes());
    files.push(rows("frequency_hz,real,imag,coherence\n", |n| format!("{n},1.5,-{n},0.9\n")).into_bytes());
    files.push(
        b"[[piece]]\nname = \"1\"\nlength = 0.8\nwidth = 0.1\nthickness = 0.03\nweighings = [[0.1, 0.1, 6.862e-2]]\n\
          [boundary]\nleft = \"free\"\n[suspension]\nat = [-0.22, 0.22]\n[constants]\ne_x = 7.0e10\n[[effect]]\n\
          id = \"sensor-mass\"\nmass = 0.005\n[[measurement]]\nkind = \"natural-frequencies\"\npiece = \"1\"\n\
          values = [321.3, 837.5]\nresolution = 1.25\nshape = [[2, 0], [1, 1]]\nresponse_at = [0.3, 0.0]\n"
            .to_vec(),
    );
    files
}

/// Feeds bytes to every reader, and what they accept to what comes after.
fn feed(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let _ = ImpactTest::from_toml(&text, "test.toml");
    let Ok(file) = RecordFile::from_bytes(bytes, "fuzz") else { return };
    let place = Place { x: 0.0, y: 0.0 };
    let measurement = RecordedResponse {
        file: "fuzz".into(),
        force_at: place,
        response_at: place,
        unit: None,
        direction: None,
        record: None,
    };
    let _ = Accelerance::from_records(file.clone(), &measurement);
    if let Ok(history) = TimeHistory::from_records(file, &measurement) {
        for window in [Window::None, Window::Hann, Window::ForceExponential { half_width: 0.01, tau: 0.1 }] {
            let _ = history.accelerance(Estimation { window, ..Estimation::default() });
        }
    }
}

/// True where a reader accepts the bytes as they are.
fn is_good(bytes: &[u8]) -> bool {
    let text = String::from_utf8_lossy(bytes);
    ImpactTest::from_toml(&text, "test.toml").is_ok() || RecordFile::from_bytes(bytes, "fuzz").is_ok()
}

/// Marsaglia's xorshift64.
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        // Limits are lengths of small files.
        usize::try_from(self.0 % limit.max(1) as u64).unwrap_or(0)
    }
}

/// What readers trip over: marks, numbers at their limits, broken text.
const PIECES: [&[u8]; 14] = [
    b"    -1\n",
    b"-1",
    b"\n",
    b"58b",
    b"nan",
    b"1e999",
    b"-",
    b"0",
    b"9999999999",
    b"\xff\xfe",
    b"[[",
    b",",
    b"\"",
    b"e",
];

fn mutate(bytes: &mut Vec<u8>, random: &mut Random) {
    for _ in 0..=random.below(4) {
        let (at, length) = (random.below(bytes.len()), random.below(12));
        let end = (at + length).min(bytes.len());
        match random.below(6) {
            0 => bytes.truncate(at),
            1 => drop(bytes.drain(at..end)),
            2 => {
                let copy: Vec<u8> = bytes.get(at..end).unwrap_or_default().to_vec();
                bytes.splice(at..at, copy);
            }
            3 => drop(bytes.splice(at..end, PIECES[random.below(PIECES.len())].iter().copied())),
            4 => drop(bytes.splice(at..at, PIECES[random.below(PIECES.len())].iter().copied())),
            _ => {
                if let Some(byte) = bytes.get_mut(at) {
                    *byte ^= 1 << random.below(8);
                }
            }
        }
    }
}

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1).map(|argument| argument.parse::<u64>());
    let (Ok(seconds), Ok(seed)) = (arguments.next().unwrap_or(Ok(10)), arguments.next().unwrap_or(Ok(1))) else {
        eprintln!("usage: fuzz_readers [SECONDS] [SEED], whole numbers");
        return ExitCode::from(2);
    };
    println!("fuzzing the readers for {seconds} s, seed {seed}");
    // Zero is the one state that xorshift never leaves.
    let (corpus, mut random) = (corpus(), Random(seed.max(1)));
    if let Some(refused) = corpus.iter().position(|bytes| !is_good(bytes)) {
        eprintln!("file {refused} of the corpus is refused: mutations of it would reach nothing");
        return ExitCode::FAILURE;
    }
    let end = Instant::now() + Duration::from_secs(seconds);
    let mut rounds = 0u64;
    while Instant::now() < end {
        let mut bytes = corpus[random.below(corpus.len())].clone();
        mutate(&mut bytes, &mut random);
        if catch_unwind(AssertUnwindSafe(|| feed(&bytes))).is_err() {
            eprintln!("panic in round {rounds} of seed {seed}; the bytes:\n{}", bytes.escape_ascii());
            return ExitCode::FAILURE;
        }
        rounds += 1;
    }
    println!("{rounds} files read or refused, no panic");
    ExitCode::SUCCESS
}
