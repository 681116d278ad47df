//! Standard output and standard error that are closed, full or read by nobody; and what may not reach a terminal.

use crate::support::{Bench, changed};

/// Lines that print each kind of answer: tables, JSON, CSV, and what clap says.
#[cfg(unix)]
const ANSWERS: [&str; 7] = [
    "identify test.toml",
    "identify test.toml --json",
    "modes model.json",
    "accelerance model.json --force 0 --response 0.1 --from 1 --to 9 --lines 3",
    "simulate model.json --force-file force.csv",
    "--version",
    "run --help",
];

#[cfg(target_os = "linux")]
#[test]
fn regress_a_full_standard_output_is_no_success() {
    use std::process::Stdio;

    let bench = Bench::new();
    let full = || Stdio::from(std::fs::File::options().write(true).open("/dev/full").expect("a full device"));
    for line in ANSWERS {
        let output = bench.command(line).stdout(full()).stderr(Stdio::piped()).output().expect("the program starts");
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{line}: {message}");
        assert!(message.contains("standard output: the answer could not be written whole"), "{line}: {message}");
        // Where nothing can be said either, the exit status still tells.
        let ended = bench.command(line).stdout(full()).stderr(full()).status().expect("the program starts");
        assert_eq!(ended.code(), Some(2), "{line}");
        let ended = bench.command(line).stderr(full()).status().expect("the program starts");
        assert_eq!(ended.code(), Some(0), "{line}");
    }
    // Bad usage and bad input, with nobody to tell.
    for line in ["", "modes", "modes nowhere.json"] {
        assert_eq!(bench.command(line).stderr(full()).status().expect("the program starts").code(), Some(2), "{line}");
    }
}

#[cfg(unix)]
#[test]
fn regress_a_closed_stream_is_no_error() {
    let bench = Bench::new();
    for line in ANSWERS {
        for closed in [">&-", "2>&-", ">&- 2>&-"] {
            let status = shell(&bench, &format!("\"$0\" {line} {closed}"));
            assert_eq!(status, Some(0), "{line} {closed}");
        }
    }
    assert_eq!(shell(&bench, "\"$0\" modes nowhere.json 2>&-"), Some(2));
}

#[cfg(unix)]
#[test]
fn regress_a_reader_that_goes_away_is_no_error() {
    let bench = Bench::new();
    // Far more than a pipe holds.
    let long = "accelerance model.json --force 0 --response 0.1 --from 1 --to 4000 --lines 40000";
    for line in [long, &format!("{long} --json"), "run --help", "--version"] {
        for pipe in ["\"$0\" LINE; echo $? >&3", "\"$0\" LINE 2>&1 >/dev/null; echo $? >&3"] {
            let script = format!("{{ {}; }} 3>status | true", pipe.replace("LINE", line));
            assert_eq!(shell(&bench, &script), Some(0));
            assert_eq!(std::fs::read_to_string(bench.path("status")).expect("a status"), "0\n", "{line}");
        }
    }
    let script = "{ \"$0\" modes nowhere.json 2>&1 >/dev/null; echo $? >&3; } 3>status | true";
    assert_eq!(shell(&bench, script), Some(0));
    assert_eq!(std::fs::read_to_string(bench.path("status")).expect("a status"), "2\n");
}

/// Runs a script of the shell, in which `$0` is the program.
#[cfg(unix)]
fn shell(bench: &Bench, script: &str) -> Option<i32> {
    let mut shell = std::process::Command::new("sh");
    let shell = shell.args(["-c", script, env!("CARGO_BIN_EXE_orthopanel")]).current_dir(bench.folder.path());
    shell.stdout(std::process::Stdio::null()).stderr(std::process::Stdio::null()).status().expect("a shell").code()
}

/// An output that is a stream of the process: nothing is computed, and what the shell appends to keeps its lines.
#[cfg(unix)]
#[test]
fn regress_an_output_that_is_an_open_stream_is_refused() {
    let bench = Bench::new();
    std::os::unix::fs::symlink("/dev/stdout", bench.path("link")).expect("linked");
    let line = "\"$0\" identify examples/piece-1 -o";
    for (output, streams) in [
        ("/dev/stdout", ">> log 2> said"),
        ("/dev/fd/1", ">> log 2> said"),
        ("/proc/self/fd/1", ">> log 2> said"),
        ("/dev/fd/../fd/1", ">> log 2> said"),
        ("link", ">> log 2> said"),
        ("log", ">> log 2> said"),
        ("./examples/../log", ">> log 2> said"),
        ("/dev/stderr", "2>> log"),
        ("/dev/fd/2", "2>> log"),
        ("log", "2>> log"),
        ("/dev/stdout", "2> said | cat >> log"),
    ] {
        if output.starts_with("/proc") && !cfg!(target_os = "linux") {
            continue;
        }
        bench.write("log", "old\n");
        bench.write("said", "");
        let status = shell(&bench, &format!("{line} {output} {streams}"));
        assert!(status == Some(2) || streams.contains('|'), "{output} {streams}: {status:?}");
        let [log, said] = ["log", "said"].map(|name| std::fs::read_to_string(bench.path(name)).expect("a file"));
        let said = if streams.starts_with("2>>") { log.strip_prefix("old\n").unwrap_or_default() } else { &said };
        assert!(log.starts_with("old\n"), "{output} {streams}: {log:?}");
        assert!(said.contains("cannot be written: it is") && said.lines().count() == 1, "{output} {streams}: {said}");
        assert!(streams.starts_with("2>>") || log == "old\n", "{output} {streams}: {log:?}");
    }
}

#[cfg(unix)]
#[test]
fn regress_an_answer_is_not_appended_to_an_input() {
    let bench = Bench::new();
    std::os::unix::fs::symlink("force.csv", bench.path("link.csv")).expect("linked");
    for (line, input) in [
        ("simulate model.json --force-file force.csv", "force.csv"),
        ("simulate model.json --force-file link.csv", "force.csv"),
        ("simulate model.json --force-file force.csv", "model.json"),
        ("simulate model.json --force-file examples/made-hits/test.toml", "examples/made-hits/point-0.uff"),
        ("modes model.json --json", "model.json"),
        ("identify test.toml", "test.toml"),
        ("trace examples/made-hits", "examples/made-hits/point-0.uff"),
        ("accelerance model.json --force 0 --response 0.1 --from 1 --to 9 --lines 3", "model.json"),
    ] {
        let before = std::fs::read(bench.path(input)).expect("an input");
        let status = shell(&bench, &format!("\"$0\" {line} >> {input} 2> said"));
        let said = std::fs::read_to_string(bench.path("said")).expect("a message");
        assert_eq!(status, Some(2), "{line}: {said}");
        assert!(said.contains("which this command reads") && said.lines().count() == 1, "{line}: {said}");
        assert!(std::fs::read(bench.path(input)).expect("an input") == before, "{line}");
    }
}

/// Searches of seconds, in lists and in records.
#[cfg(unix)]
const SEARCHES: [&str; 2] = ["trace examples/pieces-1-2/test.toml", "trace examples/made-hits/test.toml"];

/// What a command writes to standard error where that is a terminal, each piece with the time it came.
#[cfg(unix)]
fn on_terminal(bench: &Bench, line: &str) -> Vec<(std::time::Instant, String)> {
    use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
    use std::io::Read as _;

    let terminal = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).expect("a terminal");
    grantpt(&terminal).and_then(|()| unlockpt(&terminal)).expect("its other end");
    let name = ptsname(&terminal, Vec::new()).expect("a name").into_string().expect("UTF-8");
    let end = std::fs::File::options().read(true).write(true).open(name).expect("opened");
    let mut process = bench.command(line).env("TERM", "xterm").stderr(end).spawn().expect("the program starts");
    let (mut terminal, mut part, mut shown) = (std::fs::File::from(terminal), [0; 4096], Vec::new());
    // Ends with an error when the program has closed its end.
    while let Ok(length @ 1..) = terminal.read(&mut part) {
        shown.push((std::time::Instant::now(), String::from_utf8_lossy(&part[..length]).into_owned()));
    }
    assert_eq!(process.wait().expect("ended").code(), Some(0), "{line}");
    shown
}

#[cfg(unix)]
#[test]
fn a_long_search_shows_what_it_does_on_a_terminal_and_nowhere_else() {
    use std::time::{Duration, Instant};

    let bench = Bench::new();
    for line in SEARCHES {
        let begun = Instant::now();
        let shown = on_terminal(&bench, line);
        // From the first moments on, and never silent for long.
        let times: Vec<Instant> = std::iter::once(begun).chain(shown.iter().map(|(at, _)| *at)).collect();
        let silent = times.windows(2).map(|pair| pair[1] - pair[0]).max().unwrap_or_default();
        assert!(silent < Duration::from_secs(2), "{line}: {silent:?} without a sign of life");
        let text: String = shown.into_iter().map(|(_, text)| text).collect();
        assert!(text.contains("tracing what the model lacks ["), "{line}: {text:?}");
        // Which steps are drawn hangs on how fast they follow each other.
        let steps =
            ["local-mass", "edge-mass", "sensor-mass", "stiffness-loss", "rotary-inertia", "suspension", "gain"];
        assert!(steps.iter().any(|step| text.contains(step)), "{line} names no step: {text:?}");
        let piped = bench.command(line).stderr(std::process::Stdio::piped()).output().expect("the program starts");
        let said = String::from_utf8(piped.stderr).expect("UTF-8");
        assert!(!said.contains("tracing what") && !said.contains('\u{1b}') && !said.contains('\r'), "{line}: {said:?}");
        assert!(said.lines().all(|line| line.starts_with("note: ")), "{line}: {said:?}");
    }
}

#[test]
fn regress_names_do_not_steer_the_terminal() {
    let bench = Bench::new();
    let test = std::fs::read_to_string(bench.path("examples/pieces-3-4/test.toml")).expect("a test");
    // Escape, a C1 control, a new line, and writing turned round.
    let name = r#""3\u001b[2J\u009b1m\u202e\nx""#;
    let named = changed(&test, "name = \"3\"", &format!("name = {name}"));
    bench.write("named.toml", &named.replace("piece = \"3\"", &format!("piece = {name}")));
    let harmful =
        |text: &str| text.chars().any(|c| (c.is_control() && c != '\n') || ('\u{202a}'..='\u{202e}').contains(&c));
    for line in ["identify named.toml", "trace named.toml", "identify named.toml --json", "run named.toml -o out"] {
        let output = bench.run(line);
        assert_eq!(output.status.code(), Some(0), "{line}: {}", String::from_utf8_lossy(&output.stderr));
        for stream in [output.stdout, output.stderr] {
            let text = String::from_utf8(stream).expect("UTF-8");
            assert!(!harmful(&text), "{line}: {text:?}");
        }
    }
    let answer = bench.json("identify named.toml");
    assert!(answer.to_string().contains("3\\u001b[2J\u{9b}1m\u{202e}\\nx"), "{answer}");
    // Of files and arguments, too; clap takes whole escape sequences out by itself.
    for (line, shown) in [
        ("modes \u{1b}[2J\u{9b}.json", "\\u{1b}[2J\\u{9b}.json"),
        ("modes model.json \u{202e}x\u{7}", "\\u{202e}x"),
        ("modes model.json --\u{1b}[31mx", "--x"),
    ] {
        let output = bench.run(line);
        let text = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{line:?}: {text:?}");
        assert!(!harmful(&text) && text.contains(shown), "{line:?}: {text:?}");
    }
}
