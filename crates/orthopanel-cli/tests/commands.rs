//! The commands on good input: numbers, JSON and files.

use crate::support::{Bench, number, refused};

/// The paper's table 5, "Calculation".
const TABLE_5: [f64; 6] = [321.4, 837.6, 1522.5, 2306.1, 3141.7, 4000.4];

#[test]
fn val_modes_are_those_of_table_5() {
    let answer = Bench::new().json("modes model.json --count 6");
    assert_eq!(answer["schema"], "orthopanel.modes/1");
    assert_eq!(answer["modes"].as_array().map(Vec::len), Some(6));
    for (index, printed) in TABLE_5.into_iter().enumerate() {
        // The constants of table 4 carry four digits: 0.06 Hz on the highest of these modes.
        let found = number(&answer, &format!("/modes/{index}/frequency_hz"));
        assert!((found - printed).abs() <= 0.06 + 1e-9, "mode {}: {found}, printed {printed}", index + 1);
        // A free-free beam's flexible mode m has m + 1 nodes.
        assert_eq!(answer["modes"][index]["nodes"], serde_json::json!([index + 2, 0]));
        assert_eq!(number(&answer, &format!("/modes/{index}/zeta")), 0.003);
    }
}

#[test]
fn val_a_picture_shows_the_nodes_of_every_mode() {
    let bench = Bench::new();
    bench.done("modes model.json --count 5 --picture modes.svg");
    let text = std::fs::read_to_string(bench.path("modes.svg")).expect("a picture");
    // A free-free beam's flexible mode m has m + 1 nodes: 2 + 3 + 4 + 5 + 6 dots.
    assert_eq!(text.matches("<circle").count(), 20);
    assert!(text.contains("mode 1: 321.4 Hz, 2 nodes"), "{text}");
    bench.done("modes model.json --count 0 --picture modes.svg");
    refused(&bench, "modes model.json --picture nowhere/modes.svg", 2, &["nowhere/modes.svg", "cannot be written"]);
}

#[test]
fn val_accelerance_of_the_rigid_beam_at_zero_frequency() {
    let bench = Bench::new();
    let line = "accelerance model.json --force -0.3,0.0 --response=-0.2 --from 0 --to 4500 --lines 1801 -o h.csv";
    let answer = bench.json(line);
    // Translation 1/m and rotation x1 x2/J, with J = m (a^2 + t^2)/12 (rotary inertia is part of eq. 5).
    let mass = 6.88 * 0.8 * 0.1;
    let rigid = (1.0 + 0.3 * 0.2 / ((0.8_f64.powi(2) + 0.03_f64.powi(2)) / 12.0)) / mass;
    assert!((number(&answer, "/real/0") - rigid).abs() < 1e-9 * rigid);
    assert!(number(&answer, "/imag/0").abs() < 1e-12);
    let rows = bench.rows("h.csv");
    assert_eq!((rows.len(), rows[1][0], rows[1800][0]), (1801, 2.5, 4500.0));
    for row in [0, 700, 1800] {
        assert_eq!(rows[row][1], number(&answer, &format!("/real/{row}")));
        assert_eq!(rows[row][2], number(&answer, &format!("/imag/{row}")));
    }
}

#[test]
fn val_modes_beyond_the_sum_are_there_at_rest() {
    // At the force's own place a bare sum converges with one over its length: 300 and 1000 modes would differ by a per
    // cent in the valleys. With the static flexibility of the rest the length no longer shows.
    let bench = Bench::new();
    let line = "accelerance model.json --force -0.3 --response -0.3 --from 2.5 --to 4500 --lines 1800 -o h.csv";
    bench.done(line);
    let usual = bench.rows("h.csv");
    bench.done(&format!("{line} --modes 1000"));
    for (usual, longer) in usual.iter().zip(bench.rows("h.csv")) {
        let difference = (usual[1] - longer[1]).hypot(usual[2] - longer[2]) / longer[1].hypot(longer[2]);
        assert!(difference < 1e-4, "{} Hz: {difference}", usual[0]);
    }
}

#[test]
fn val_a_band_limited_force_needs_few_samples() {
    // The spectrum of exp(-(t/s)^2/2) is exp(-(2 pi f s)^2/2): 4e-6 at 4 kHz for s = 0.2 ms. Sampled at 8 kHz and
    // band-limited it moves the panel as the same pulse in straight lines at 256 kHz; straight lines at 8 kHz do not.
    let bench = Bench::new();
    let pulse = |name: &str, rate: f64| {
        let row = |sample: i32| {
            let time = f64::from(sample) / rate;
            format!("{time},{}\n", 100.0 * (-0.5 * ((time - 0.004) / 2e-4).powi(2)).exp())
        };
        let rows: String = (0..=(0.016 * rate) as i32).map(row).collect();
        std::fs::write(bench.path(name), format!("time_s,force_n\n{rows}")).expect("a file is written");
    };
    pulse("fine.csv", 256e3);
    pulse("coarse.csv", 8e3);
    bench.done("simulate model.json --force-file fine.csv -o fine-y.csv");
    bench.done("export model.json -o panel.fmu");
    let truth: Vec<f64> = bench.rows("fine-y.csv").iter().step_by(32).map(|row| row[2]).collect();
    let peak = truth.iter().fold(0.0_f64, |peak, value| peak.max(value.abs()));
    let worst = |line: &str| {
        bench.done(&format!("simulate {line} --force-file coarse.csv -o y.csv"));
        let found = bench.rows("y.csv");
        assert_eq!(found.len(), truth.len());
        found.iter().zip(&truth).map(|(row, truth)| (row[2] - truth).abs() / peak).fold(0.0, f64::max)
    };
    for line in ["model.json --hold band-limited", "panel.fmu --hold band-limited"] {
        // Straight lines at 256 kHz lose 1e-4 at 2 kHz, where the pulse still has a twentieth of its spectrum.
        assert!(worst(line) < 2e-4, "{line}: {}", worst(line));
    }
    assert!(worst("model.json") > 0.02, "straight lines: {}", worst("model.json"));
}

#[test]
fn an_fmu_moves_as_its_model() {
    let bench = Bench::new();
    let options = "--modes 8 --force -0.3 --force 0.1 --response 0.3 --response 0.0,0.02";
    let force =
        "force_1_n,time_s,force_2_n\n0,0,1\n58.8,1e-4,3\n100,2.5e-4,-2\n58.8,4e-4,0\n0,5e-4,0\n0,2e-3,0\n0,5e-3,7\n";
    std::fs::write(bench.path("two.csv"), force).expect("a file is written");
    for hold in ["linear", "held"] {
        bench.done(&format!("simulate model.json {options} --hold {hold} --force-file two.csv -o model.csv"));
        let expected = bench.rows("model.csv");
        for fmi in ["2", "3"] {
            bench.done(&format!("export model.json {options} --fmi {fmi} -o panel.fmu"));
            bench.done(&format!("simulate panel.fmu --hold {hold} --force-file two.csv -o fmu.csv"));
            let found = bench.rows("fmu.csv");
            assert_eq!((found.len(), found[0].len()), (7, 9));
            for column in 0..9 {
                let peak = expected.iter().map(|row| row[column].abs()).fold(0.0, f64::max);
                assert!(peak > 0.0, "column {column} says nothing");
                // Both add to displacements the static part of the modes left out: under the blow's 100 N it is up to 3e-4
                // of the peak. How much it must be is held in fmpy-checks/test_motion.py.
                for (found, expected) in found.iter().zip(&expected) {
                    let difference = (found[column] - expected[column]).abs();
                    assert!(difference <= 1e-9 * peak, "FMI {fmi}, {hold}, column {column}: {difference} of {peak}");
                }
            }
        }
    }
}

#[test]
fn val_a_held_force_pushes_the_mass() {
    // The centre of mass of a free panel obeys m x'' = f, whatever the flexible modes: with no flexible mode and the
    // force at the centre, 2 N for 3 ms move it by f t^2/(2 m).
    let bench = Bench::new();
    std::fs::write(bench.path("step.csv"), "time_s,force_n\n0,2\n3e-3,2\n").expect("a file is written");
    // The mean over the panel, by Gauss' rule of three points on each half, where shapes are polynomials: what the residual modes
    // do leaves it alone.
    let far = 0.2 * 0.6_f64.sqrt();
    let places = [-0.2 - far, -0.2, -0.2 + far, 0.2 - far, 0.2, 0.2 + far];
    let responses: String = places.iter().map(|x| format!(" --response={x}")).collect();
    bench.done(&format!("simulate model.json --modes 0 --force 0{responses} --force-file step.csv -o y.csv"));
    let rows = bench.rows("y.csv");
    let last = rows.last().expect("a row");
    let mass = 6.88 * 0.8 * 0.1;
    let weights = [5.0, 8.0, 5.0, 5.0, 8.0, 5.0].map(|weight| weight / 36.0);
    let mean =
        |kind: usize| -> f64 { weights.iter().zip(&last[2 + 6 * kind..]).map(|(weight, value)| weight * value).sum() };
    for (kind, expected) in [2.0 / mass, 2.0 * 3e-3 / mass, 9e-6 / mass].into_iter().enumerate() {
        assert!((mean(kind) - expected).abs() < 1e-12 * expected, "{}, expected {expected}", mean(kind));
    }
}

#[test]
fn val_every_example_gives_the_constants_of_table_4() {
    let bench = Bench::new();
    for (piece, e_x, g_zx) in
        [("1", 1.070e10, 5.363e8), ("2", 1.095e10, 5.470e8), ("3", 4.876e9, 2.980e8), ("4", 4.849e9, 3.029e8)]
    {
        for search in ["least-squares", "simplex"] {
            let answer = bench.json(&format!("identify examples/piece-{piece}/test.toml --search {search}"));
            assert_eq!(answer["schema"], "orthopanel.identified/1");
            assert_eq!(answer["modes"][0]["piece"], piece);
            for (name, printed) in [("e_x", e_x), ("g_zx", g_zx)] {
                let found = number(&answer, &format!("/constants/{name}/value"));
                assert!(number(&answer, &format!("/constants/{name}/std")) > 0.0);
                // Rounded as the paper prints it, four digits, it may differ by one in the last: the paper's simplex
                // stopped near the minimum, not at it. Piece 4's printed mode 1 does not fit its own constants
                // (582.4 Hz printed, 582.0 Hz from them), hence 0.1 % there.
                let digit = 10.0_f64.powf(f64::log10(printed).floor() - 3.0);
                let off = ((found / digit).round() - (printed / digit).round()).abs();
                let close = if piece == "4" { (found / printed - 1.0).abs() < 1e-3 } else { off <= 1.0 };
                assert!(close, "piece {piece}, {search}: {name} = {found:e}, printed {printed:e}");
            }
        }
    }
}

#[test]
fn pieces_of_one_material_share_constants_and_get_a_model_each() {
    let bench = Bench::new();
    for (pair, first, second) in [("1-2", "1", "2"), ("3-4", "3", "4")] {
        let shared = bench.json(&format!("identify examples/pieces-{pair}/test.toml -o {pair}.json"));
        let own = |piece: &str| {
            number(&bench.json(&format!("identify examples/piece-{piece}/test.toml")), "/constants/e_x/value")
        };
        let (low, high) = (own(first).min(own(second)), own(first).max(own(second)));
        let e_x = number(&shared, "/constants/e_x/value");
        assert!(low < e_x && e_x < high, "{e_x} does not lie between {low} and {high}");
        for (piece, width) in [(first, 0.1), (second, 0.2)] {
            let text = std::fs::read_to_string(bench.path(&format!("{pair}-{piece}.json"))).expect("a model file");
            let model: serde_json::Value = serde_json::from_str(&text).expect("JSON");
            assert_eq!(number(&model, "/piece/width"), width);
            assert_eq!(number(&model, "/constants/e_x/value"), e_x);
            assert_eq!(number(&model, "/damping/beyond"), 0.003);
            assert_eq!(model["provenance"]["damping"], "assumed, not measured");
        }
    }
}

#[test]
fn run_leaves_models_fmus_response_and_pictures() {
    let bench = Bench::new();
    let answer = bench.json("run examples/pieces-3-4/test.toml -o out/deep");
    assert_eq!(answer["schema"], "orthopanel.run/1");
    let files = answer["files"].as_array().expect("a list of files");
    assert_eq!(files.len(), 18);
    for file in files {
        let path = bench.path(file.as_str().expect("a path"));
        assert!(std::fs::metadata(&path).is_ok_and(|found| found.len() > 100), "{}", path.display());
    }
    let frequency = number(&bench.json("modes out/deep/model-4.json --count 1"), "/modes/0/frequency_hz");
    let identified = number(&answer, "/identified/modes/4/model_hz");
    assert!((frequency - identified).abs() < 1e-9 * identified, "{frequency}, identified {identified}");
}

#[test]
fn an_fmu_without_a_flexible_mode_is_told_of() {
    let bench = Bench::new();
    for (words, told) in [("--modes 0", true), ("--up-to 10", true), ("--modes 1", false)] {
        let run = bench.run(&format!("export model.json -o panel.fmu {words}"));
        let said = String::from_utf8_lossy(&run.stderr);
        assert!(run.status.success() && said.contains("no flexible mode is kept") == told, "{words}: {said}");
    }
}

#[test]
fn help_shows_an_example_of_every_command() {
    let bench = Bench::new();
    for command in ["run", "identify", "modes", "accelerance", "export", "simulate", "report", "trace"] {
        let text = bench.done(&format!("{command} --help"));
        let example = ["Example: ", "Examples: "].map(|word| format!("{word}orthopanel {command} "));
        assert!(example.iter().any(|example| text.contains(example)), "{text}");
    }
}
