//! Mutates good files and feeds each to its reader: none may panic, hang or take much memory, whatever the bytes.
//!
//! `cargo run -p orthopanel --example fuzz_readers -- [SECONDS] [SEED]`; 10 s and seed 1 unless said.
//! Without `--release` overflow checks are on; `.ci/run` trades them for many more rounds in its half minute.
//! A fault prints the bytes with reader, seed and round, so that the run repeats it and a test can be made of them.
//! `-- write FOLDER` writes the good files, for the coverage-guided targets in `fuzz/`, which go deeper.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod mutation;
#[path = "../../../../fuzz/src/lib.rs"]
mod readers;
mod seeds;

use std::{
    panic::{AssertUnwindSafe, catch_unwind},
    path::Path,
    process::{ExitCode, exit},
    sync::Mutex,
    thread,
    time::{Duration, Instant},
};

use mutation::Random;
use peak_alloc::PeakAlloc;
use readers::fmu_refusal;
use seeds::Reader;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Most bytes that a file may take at a time.
const MOST_MEMORY: usize = 256 << 20;
/// Longest time that a file may take: a hundred times what the slowest takes, for machines are busy.
const LONGEST: Duration = Duration::from_secs(20);
/// One file in so many is made long.
const LONG_ONES: usize = 256;
/// Bytes of a long file.
const LONG: usize = 1 << 20;
/// Bytes of a file that are shown where it is a finding; the seed makes it anew.
const SHOWN: usize = 1 << 16;

/// One file that is being read, for the watch.
struct Round {
    begun: Instant,
    name: String,
    bytes: Vec<u8>,
}

impl Round {
    fn report(&self, fault: &str) {
        let shown = &self.bytes[..self.bytes.len().min(SHOWN)];
        eprintln!("{fault} in {}; of its {} bytes:\n{}", self.name, self.bytes.len(), shown.escape_ascii());
    }
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let readers = seeds::readers();
    if let [first, folder] = &arguments[..]
        && first == "write"
    {
        return write(&readers, Path::new(folder));
    }
    let number = |index: usize, usual: u64| arguments.get(index).map_or(Ok(usual), |text| text.parse());
    let (Ok(seconds), Ok(seed)) = (number(0, 10), number(1, 1)) else {
        eprintln!("usage: fuzz_readers [SECONDS] [SEED], whole numbers, or fuzz_readers write FOLDER");
        return ExitCode::from(2);
    };
    for Reader { name, feed, files } in &readers {
        if let Some(refused) = files.iter().position(|bytes| !feed(bytes)) {
            eprintln!("good file {refused} of {name} is refused: mutations of it would reach nothing");
            return ExitCode::FAILURE;
        }
    }
    println!("fuzzing the readers for {seconds} s, seed {seed}");
    fuzz(&readers, Duration::from_secs(seconds), seed)
}

fn fuzz(readers: &[Reader], duration: Duration, seed: u64) -> ExitCode {
    static ROUND: Mutex<Option<Round>> = Mutex::new(None);
    thread::spawn(|| {
        loop {
            thread::sleep(Duration::from_millis(500));
            if let Ok(round) = ROUND.lock()
                && let Some(round) = round.as_ref().filter(|round| round.begun.elapsed() > LONGEST)
            {
                round.report("no end");
                exit(1);
            }
        }
    });
    let mut random = Random::new(seed);
    let end = Instant::now() + duration;
    let (mut rounds, mut accepted) = (0u64, 0u64);
    let (mut longest, mut most) = (Duration::ZERO, 0);
    while Instant::now() < end {
        let Reader { name, feed, files } = &readers[random.below(readers.len())];
        let mut bytes = files[random.below(files.len())].clone();
        if random.below(LONG_ONES) == 0 {
            random.lengthen(&mut bytes, LONG);
        }
        random.mutate(&mut bytes);
        let round =
            |bytes| Round { begun: Instant::now(), name: format!("{name}, round {rounds} of seed {seed}"), bytes };
        *ROUND.lock().expect("no reader holds it") = Some(round(bytes.clone()));
        MEMORY.reset_peak_usage();
        let begun = Instant::now();
        let read = catch_unwind(AssertUnwindSafe(|| feed(&bytes)));
        (longest, most) = (longest.max(begun.elapsed()), most.max(MEMORY.peak_usage()));
        accepted += u64::from(matches!(read, Ok(true)));
        if read.is_err() || most > MOST_MEMORY {
            round(bytes).report(&if read.is_err() { "panic".into() } else { format!("{most} bytes of memory") });
            return ExitCode::FAILURE;
        }
        rounds += 1;
    }
    println!(
        "{rounds} inputs, {accepted} of them accepted: 0 findings (no panic, the longest {:.2} s, the most memory {} MiB)",
        longest.as_secs_f64(),
        most >> 20
    );
    ExitCode::SUCCESS
}

/// One folder a reader, one file a good file.
fn write(readers: &[Reader], folder: &Path) -> ExitCode {
    for Reader { name, files, .. } in readers {
        let folder = folder.join(name);
        let written = std::fs::create_dir_all(&folder).and_then(|()| {
            files
                .iter()
                .enumerate()
                .try_for_each(|(index, bytes)| std::fs::write(folder.join(index.to_string()), bytes))
        });
        if let Err(error) = written {
            eprintln!("{}: {error}", folder.display());
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}
