//! The README tells the truth: each of its commands runs, in its order, and one number of each is held against another
//! source; what it shows as printed is printed; its picture is the program's.

use crate::support::{Bench, ROOT, number};

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
    // The README leaves out the ranking of effects that follows.
    let (printed, _) = printed.split_once("\n\nnatural frequencies, % rms").expect("what the trace found");
    let shown: String = printed.lines().map(|line| format!("    {line}").trim_end().to_owned() + "\n").collect();
    assert!(text.contains(&shown), "the README does not show what is printed:\n{printed}");
    let drawn = std::fs::read(bench.path("out/frequencies.svg")).expect("a picture");
    let kept = std::fs::read(format!("{ROOT}/docs/piece-1-frequencies.svg")).expect("the README's picture");
    assert!(drawn == kept, "docs/piece-1-frequencies.svg is not what `run` draws: copy out/frequencies.svg there");

    let answer: serde_json::Value =
        serde_json::from_str(&run(&bench, &mut commands, "identify examples/pieces-1-2/")).expect("one JSON object");
    // The two pieces share E_x, so it lies between their own (the paper's table 4).
    let e_x = number(&answer, "/constants/e_x/value");
    assert!((1.070e10..1.095e10).contains(&e_x), "{e_x}");

    let table = run(&bench, &mut commands, "identify examples/pieces-1-2-plate/");
    // The figures that the README gives; an independent prototype of the plate found 0.362 and 0.483.
    assert!(table.contains("0.362 % rms") && table.contains("0.484 % rms"), "{table}");
    assert!(table.contains("g_xy is not identified"), "{table}");

    let table = run(&bench, &mut commands, "modes out/model.json ");
    let row = table.lines().nth(3).expect("mode 3");
    let frequency: f64 = row.split_whitespace().nth(1).and_then(|cell| cell.parse().ok()).expect("a number");
    // The paper's table 5 prints 1522.5 Hz; its own rounded constants give it within 0.06 Hz.
    assert!((frequency - 1522.5).abs() <= 0.06, "mode 3: {frequency}");

    run(&bench, &mut commands, "accelerance out/model.json ");
    // At 0 Hz the beam is rigid: 1/m + x1 x2/J with J = m (a^2 + t^2)/12.
    let rigid = (1.0 - 0.3 * 0.3 / ((0.8_f64.powi(2) + 0.03_f64.powi(2)) / 12.0)) / (6.88 * 0.8 * 0.1);
    let first = &bench.rows("out/accelerance.csv")[0];
    assert!((first[1] - rigid).abs() < 1e-9 * rigid.abs(), "{}, rigid {rigid}", first[1]);

    run(&bench, &mut commands, "export out/model.json ");
    // Two response places: time, one force, and three quantities at each place.
    bench.done("simulate out/two-places.fmu --force-file examples/half-sine.csv -o out/two.csv");
    assert_eq!(bench.rows("out/two.csv")[0].len(), 2 + 3 * 2);

    run(&bench, &mut commands, "simulate out/panel.fmu ");
    bench.done("simulate out/model.json --force-file examples/half-sine.csv -o out/by-model.csv");
    let (fmu, model) = (bench.rows("out/hit.csv"), bench.rows("out/by-model.csv"));
    let peak = model.iter().map(|row| row[2].abs()).fold(0.0, f64::max);
    assert!(peak > 100.0 && fmu.len() == 2001);
    assert!(fmu.iter().zip(&model).all(|(fmu, model)| (fmu[2] - model[2]).abs() <= 1e-9 * peak));

    run(&bench, &mut commands, "batch examples/piece-1 ");
    bench.done("lot lot.parquet -o lot.html");

    records_hold(&bench, &mut commands, &text);
    plate_holds(&bench, &mut commands);

    assert!(commands.is_empty(), "commands of the README that no test runs: {commands:?}");
}

/// The commands on the made hits, against what their generator put in.
fn records_hold(bench: &Bench, commands: &mut Vec<String>, text: &str) {
    run(bench, commands, "init examples/made-hits");
    let drafted = std::fs::read_to_string(bench.path("my-test.toml")).expect("a test file");
    assert!(drafted.contains("file = \"examples/made-hits/point-0.uff\""), "{drafted}");
    let listed = run(bench, commands, "records examples/made-hits");
    assert!(listed.contains("1.6000 s at 10240 Hz"), "{listed}");
    let truth = bench.read_json("examples/made-hits/truth.json");
    let printed = run(bench, commands, "run examples/made-hits");
    for (name, percent) in [("e_x", 0.1), ("g_zx", 0.3)] {
        let line = printed.lines().find(|line| line.starts_with(name)).expect("a constant");
        let shown = line.split_whitespace().nth(1).expect("a value");
        assert!(text.contains(&format!("{name} = {shown} Pa")), "the README does not show {line:?}");
        let found: f64 = shown.parse().expect("a number");
        let error = 100.0 * (found / number(&truth, &format!("/constants/{name}")) - 1.0);
        assert!(error.abs() <= percent, "{name}: {error:+.3} % from the truth");
    }
    let identified = bench.read_json("out-hits/identified.json");
    for mode in 0..6 {
        let [found, put_in] = [&identified, &truth].map(|of| number(of, &format!("/modes/{mode}/zeta")));
        assert!((found / put_in - 1.0).abs() < 0.01, "mode {}: zeta {found}, put in {put_in}", mode + 1);
    }
    let drawn = std::fs::read_to_string(bench.path("out-hits/accelerance.svg")).expect("a picture");
    let kept = std::fs::read_to_string(format!("{ROOT}/docs/made-hits-accelerance.svg")).expect("the README's picture");
    assert!(
        alike(&drawn, &kept),
        "docs/made-hits-accelerance.svg is not what `run` draws: copy out-hits/accelerance.svg"
    );

    run(bench, commands, "accelerance examples/made-hits");
    // Far below the first resonance the beam is rigid: 1/m + x1 x2/J, by scatter of the lines within a few per cent.
    let rigid = (1.0 - 0.3 * 0.3 / ((0.8_f64.powi(2) + 0.03_f64.powi(2)) / 12.0)) / (6.88 * 0.8 * 0.1);
    let rows = bench.rows("out-hits/measured.csv");
    let low: Vec<f64> = rows.iter().filter(|row| row[0] < 30.0).map(|row| row[1]).collect();
    let mean = low.iter().sum::<f64>() / low.len() as f64;
    assert!((mean / rigid - 1.0).abs() < 0.05, "{mean}, rigid {rigid}");

    let table = run(bench, commands, "simulate out-hits/model.json");
    let explained: Vec<f64> =
        table.lines().skip(1).filter_map(|line| line.split_whitespace().nth(6)?.parse().ok()).collect();
    // Noise is 0.3 % of either channel's rms, 1e-5 of the variance.
    assert!(explained.len() == 3 && explained.iter().all(|part| *part > 0.9999), "{explained:?}");

    let traced: serde_json::Value =
        serde_json::from_str(&run(bench, commands, "trace examples/misplaced-hit")).expect("one JSON object");
    assert_eq!((&traced["verdict"], &traced["effects"][0]["id"]), (&"explained".into(), &"hammer-offset".into()));
    let offset = format!("{:.1} mm", 1e3 * number(&traced, "/effects/0/parameters/offset/value"));
    assert!(text.contains(&offset), "the README does not show {offset}");

    run(bench, commands, "report examples/made-hits");
    let page = std::fs::read_to_string(bench.path("out-hits/report.html")).expect("a page");
    let [e_x] = ["e_x"].map(|name| number(&identified, &format!("/constants/{name}/value")));
    assert!(page.contains(&format!("<td>e_x</td><td>{e_x:.4e}</td>")), "the page does not hold e_x = {e_x}");
}

/// The plate model that the README shows.
fn plate_holds(bench: &Bench, commands: &mut Vec<String>) {
    let table = run(bench, commands, "modes examples/plate.json");
    // A free-free piece twice as long as wide twists lowest: mode 1 or 2 is the torsion with one node each way.
    let torsion = table.lines().find(|line| line.contains("torsion")).expect("a torsion mode");
    assert!(torsion.split_whitespace().skip(2).take(2).eq(["1", "1"]), "{torsion}");
    let drawn = std::fs::read_to_string(bench.path("out/plate-modes.svg")).expect("a picture");
    let kept = std::fs::read_to_string(format!("{ROOT}/docs/plate-modes.svg")).expect("the README's picture");
    assert!(alike(&drawn, &kept), "docs/plate-modes.svg is not what `modes` draws: copy out/plate-modes.svg");
    run(bench, commands, "export examples/plate.json");
    let answer = bench.json("simulate out/plate.fmu --force-file examples/half-sine.csv");
    assert!(answer.is_object());
}

/// The same picture but for two pixels: the last digits of a fit differ from processor to processor.
fn alike(one: &str, other: &str) -> bool {
    let numbers = |text: &str| -> Vec<i64> {
        text.split(|character: char| !character.is_ascii_digit()).filter_map(|digits| digits.parse().ok()).collect()
    };
    let (one, other) = (numbers(one), numbers(other));
    one.len() == other.len() && one.iter().zip(&other).all(|(one, other)| one.abs_diff(*other) <= 2)
}
