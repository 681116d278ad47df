//! The README tells the truth: each of its commands runs, in its order, and one number of each is held against another
//! source; what it shows as printed is printed; its picture is the program's.

mod support;

use support::{Bench, ROOT, number};

const COMMAND: &str = "    cargo run --release -- ";

fn readme() -> String {
    std::fs::read_to_string(format!("{ROOT}/README.md")).expect("README.md")
}

/// Runs a command of the README that begins with `start`, and takes it off the list.
fn run(bench: &Bench, commands: &mut Vec<String>, start: &str) -> String {
    let position = commands.iter().position(|command| command.starts_with(start));
    let command = commands.remove(position.unwrap_or_else(|| panic!("the README has no command {start}")));
    bench.done(&command)
}

#[test]
fn every_command_runs_and_its_number_holds() {
    let text = readme();
    let mut commands: Vec<String> =
        text.lines().filter_map(|line| line.strip_prefix(COMMAND)).map(str::to_owned).collect();
    let bench = Bench::new();

    let printed = run(&bench, &mut commands, "run ");
    let shown: String = printed.lines().map(|line| format!("    {line}").trim_end().to_owned() + "\n").collect();
    assert!(text.contains(&shown), "the README does not show what is printed:\n{printed}");
    let drawn = std::fs::read(bench.path("out/frequencies.svg")).expect("a picture");
    let kept = std::fs::read(format!("{ROOT}/docs/piece-1-frequencies.svg")).expect("the README's picture");
    assert!(drawn == kept, "docs/piece-1-frequencies.svg is not what `run` draws: copy out/frequencies.svg there");

    let answer: serde_json::Value =
        serde_json::from_str(&run(&bench, &mut commands, "identify ")).expect("one JSON object");
    // The two pieces share E_x, so it lies between their own (the paper's table 4).
    let e_x = number(&answer, "/constants/e_x/value");
    assert!((1.070e10..1.095e10).contains(&e_x), "{e_x}");

    let table = run(&bench, &mut commands, "modes ");
    let row = table.lines().nth(3).expect("mode 3");
    let frequency: f64 = row.split_whitespace().nth(1).and_then(|cell| cell.parse().ok()).expect("a number");
    // The paper's table 5 prints 1522.5 Hz; its own rounded constants give it within 0.06 Hz.
    assert!((frequency - 1522.5).abs() <= 0.06, "mode 3: {frequency}");

    run(&bench, &mut commands, "accelerance ");
    // At 0 Hz the beam is rigid: 1/m + x1 x2/J with J = m (a^2 + t^2)/12.
    let rigid = (1.0 - 0.3 * 0.3 / ((0.8_f64.powi(2) + 0.03_f64.powi(2)) / 12.0)) / (6.88 * 0.8 * 0.1);
    let first = &bench.rows("out/accelerance.csv")[0];
    assert!((first[1] - rigid).abs() < 1e-9 * rigid.abs(), "{}, rigid {rigid}", first[1]);

    run(&bench, &mut commands, "export ");
    // Two response places: time, one force, and three quantities at each place.
    bench.done("simulate out/two-places.fmu --force-file examples/half-sine.csv -o out/two.csv");
    assert_eq!(bench.rows("out/two.csv")[0].len(), 2 + 3 * 2);

    run(&bench, &mut commands, "simulate ");
    bench.done("simulate out/model.json --force-file examples/half-sine.csv -o out/by-model.csv");
    let (fmu, model) = (bench.rows("out/hit.csv"), bench.rows("out/by-model.csv"));
    let peak = model.iter().map(|row| row[2].abs()).fold(0.0, f64::max);
    assert!(peak > 100.0 && fmu.len() == 2001);
    assert!(fmu.iter().zip(&model).all(|(fmu, model)| (fmu[2] - model[2]).abs() <= 1e-9 * peak));

    assert!(commands.is_empty(), "commands of the README that no test runs: {commands:?}");
}
