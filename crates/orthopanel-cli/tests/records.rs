//! Records whose truth is known, made by tests/record_generator apart from the crates, through the commands.
//!
//! Bounds are those of the project's goal: E_x within 0.1 %, G_zx within 0.3 %, damping within 3 % from one place and
//! 1 % from five.

use crate::support::{Bench, made_records, number, refused};
use serde_json::Value;

/// Constants within 0.1 and 0.3 %, damping of the modes shown within `zeta_percent` of the truth.
fn assert_truth(answer: &Value, truth: &Value, least_modes: usize, zeta_percent: f64) {
    for (name, percent) in [("e_x", 0.1), ("g_zx", 0.3)] {
        let (found, true_value) =
            (number(answer, &format!("/constants/{name}/value")), number(truth, &format!("/constants/{name}")));
        let error = 100.0 * (found / true_value - 1.0);
        assert!(error.abs() <= percent, "{name}: {found:e} is {error:+.3} % from the truth");
    }
    let modes = answer["modes"].as_array().expect("modes");
    assert!(modes.len() >= least_modes, "only {} modes", modes.len());
    for mode in modes {
        let index = number(mode, "/mode") as usize - 1;
        let true_zeta = number(truth, &format!("/modes/{index}/zeta"));
        let error = 100.0 * (number(mode, "/zeta") / true_zeta - 1.0);
        assert!(error.abs() <= zeta_percent, "mode {}: zeta {error:+.2} % from the truth", index + 1);
        assert!(number(mode, "/zeta_std") > 0.0);
        let true_hz = number(truth, &format!("/modes/{index}/frequency_hz"));
        assert!((number(mode, "/model_hz") / true_hz - 1.0).abs() < 2e-4, "mode {}", index + 1);
    }
    // The generator's noise is all that there is: the misfit per datum is near 1.
    let chi_square = number(answer, "/error/chi_square");
    assert!((0.5..2.0).contains(&chi_square), "chi-square {chi_square}");
}

#[test]
fn val_identify_one_place_from_csv() {
    let bench = Bench::new();
    let Some(truth) = made_records(&bench, "one", "--noise 0.01 --seed 5") else { return };
    let answer = bench.json("identify one/test.toml -o model.json");
    assert_truth(&answer, &truth, 6, 3.0);
    let rms = number(&answer, "/error/accelerance_rms_percent");
    assert!((0.1..10.0).contains(&rms), "accelerance {rms} % rms");

    let model = bench.read_json("model.json");
    assert_eq!(model["ports"], serde_json::json!({"forces": [[-0.3, 0.0]], "responses": [[0.3, 0.0]]}));
    // Beyond the band stands the median of the ratios found.
    let zetas =
        |modes: &Value| -> Vec<f64> { modes.as_array().expect("modes").iter().map(|m| number(m, "/zeta")).collect() };
    let mut zetas = zetas(&answer["modes"]);
    zetas.sort_by(f64::total_cmp);
    assert_eq!(number(&model, "/damping/beyond"), zetas[zetas.len() / 2]);
    assert!(model["provenance"]["damping"].as_str().expect("a text").contains("median"));
}

/// A sensor in g, turned round, in binary universal files; five places; then the model under every measured force.
#[test]
fn val_run_five_places_from_uff() {
    let bench = Bench::new();
    let options = "--five-places --format uff-binary --noise 0.01 --seed 4 --hits 3 --unit g --sensor-sign -1";
    let Some(truth) = made_records(&bench, "five", options) else { return };
    let answer = bench.json("run five/test.toml -o out");
    assert_truth(&answer["identified"], &truth, 6, 1.0);
    // The same modes by a joint fit, before any model.
    let measured = answer["identified"]["measured_modes"][0]["modes"].as_array().expect("measured modes");
    assert!(measured.len() >= 6, "{measured:?}");
    for mode in measured {
        let index = number(mode, "/mode") as usize - 1;
        let [frequency, zeta] = ["frequency_hz", "zeta"].map(|name| number(&truth, &format!("/modes/{index}/{name}")));
        assert!((number(mode, "/frequency_hz") / frequency - 1.0).abs() < 2e-4, "{mode}, {frequency} Hz");
        assert!((number(mode, "/zeta") / zeta - 1.0).abs() < 0.02, "{mode}, {zeta}");
        assert!(number(mode, "/mac") > 0.999, "{mode}");
    }

    let hits = answer["hits"].as_array().expect("hits");
    assert_eq!(hits.len(), 5 * 3);
    for hit in hits {
        // Noise is 1 % of the rms on either channel, 1e-4 of the variance; what the force's noise moves adds as much.
        let explained = number(hit, "/whole/variance_explained");
        assert!(explained > 0.999 && explained < 1.0, "{hit}");
        assert!(number(hit, "/whole/rms_percent_of_peak") < 0.2, "{hit}");
        assert!(number(hit, "/in_band/variance_explained") > 0.999, "{hit}");
    }
    assert_eq!(bench.read_json("out/time-histories.json")["hits"], answer["hits"]);
    for place in 1..=5 {
        for name in [format!("out/accelerance-{place}.svg"), format!("out/time-history-{place}.svg")] {
            let size = std::fs::metadata(bench.path(&name)).expect("a picture").len();
            assert!((5_000..150_000).contains(&size), "{name}: {size} bytes");
        }
    }
    // The same comparison by itself, with the model that `run` wrote.
    let again = bench.json("simulate out/model.json --force-file five/test.toml");
    assert_eq!(again["hits"][0]["whole"], answer["hits"][0]["whole"]);
}

#[test]
fn val_bad_hits_are_left_out_and_said() {
    let bench = Bench::new();
    // A soft hammer tip: the response turns slowly enough for a clipped peak to be flat over several samples.
    let options = "--double-hit 2 --overload 4 --overload-at 0.5 --pulse-duration 6e-4 --format uff-binary --seed 6";
    let Some(truth) = made_records(&bench, "bad", options) else { return };
    let answer = bench.json("accelerance bad/test.toml -o h.csv");
    let of = &answer["accelerances"][0];
    assert_eq!(number(of, "/hits_kept"), 3.0);
    let kept: Vec<bool> = (0..5).map(|hit| of["hits"][hit]["kept"].as_bool().expect("a verdict")).collect();
    assert_eq!(kept, [true, false, true, false, true]);
    assert!(of["hits"][1]["faults"][0].as_str().expect("a fault").contains("double hit"));
    assert!(of["hits"][3]["faults"].to_string().contains("overload"));

    let text = std::fs::read_to_string(bench.path("h.csv")).expect("a CSV file");
    assert!(text.starts_with("frequency_hz,real,imag,coherence,variance\n"));
    let rows = bench.rows("h.csv");
    assert_eq!(rows.len() as f64, number(of, "/lines"));
    assert!(rows.iter().all(|row| (0.0..=1.0).contains(&row[3]) && row[4] >= 0.0));
    assert_truth(&bench.json("identify bad/test.toml -o bad.json"), &truth, 3, 3.0);

    let compared = bench.run("simulate bad.json --force-file bad/test.toml");
    let table = String::from_utf8_lossy(&compared.stdout);
    assert!(table.contains("hit 2 left out: double hit") && table.contains("hit 4 left out"), "{table}");
    refused(&bench, "modes bad/test.toml", 2, &["bad/test.toml: a test file, where a model file (JSON) is wanted"]);
}

/// Several pairs of places from one test: numbered files beside a name that ends in .csv, else a folder.
#[test]
fn accelerances_of_several_pairs_are_numbered() {
    let bench = Bench::new();
    let text = std::fs::read_to_string(bench.path("examples/made-hits/test.toml")).expect("a test");
    let (before, measurement) = text.split_once("[[measurement]]").expect("a measurement");
    let other = measurement.replace("force_at = [-0.3", "force_at = [-0.2");
    assert_ne!(other, measurement);
    let both = format!("{before}[[measurement]]{measurement}\n[[measurement]]{other}");
    std::fs::write(bench.path("examples/made-hits/two.toml"), both).expect("a file is written");
    let answer = bench.json("accelerance examples/made-hits/two.toml -o h.csv");
    for (index, name) in ["h-1.csv", "h-2.csv"].into_iter().enumerate() {
        assert_eq!(answer["accelerances"][index]["file"], name);
        assert!(bench.rows(name).len() > 100);
    }
    assert!(!bench.path("h.csv").exists());
    let answer = bench.json("accelerance examples/made-hits/two.toml -o folder");
    assert_eq!(answer["accelerances"][1]["file"], "folder/accelerance-2.csv");
    assert!(bench.path("folder/accelerance-1.csv").exists());
}

/// An exponential window's damping is carried by the file, and taken out of what is read off it: the fit gives the truth, and a
/// trace misses nothing where it named a window before.
#[test]
fn val_a_csv_under_an_exponential_window_carries_its_decay_rate() {
    let bench = Bench::new();
    let Some(truth) = made_records(&bench, "one", "--noise 0.003 --seed 7 --hits 3 --format uff-binary") else {
        return;
    };
    bench.done("accelerance one/test.toml --window force-exponential --tau 0.1 -o one/h.csv");
    let text = std::fs::read_to_string(bench.path("one/h.csv")).expect("a CSV file");
    assert!(text.starts_with("frequency_hz,real,imag,coherence,variance,decay_rate_1_s\n"));
    let test = std::fs::read_to_string(bench.path("one/test.toml")).expect("a test");
    let before = test.split("[[measurement]]").next().expect("a piece");
    let measurement =
        "[[measurement]]\nkind = \"accelerance\"\nfile = \"h.csv\"\nforce_at = [-0.3, 0.0]\nresponse_at = [0.3, 0.0]\n";
    bench.write("one/lines.toml", &format!("{before}{measurement}"));
    let found = bench.json("identify one/lines.toml");
    assert_truth(&found, &truth, 6, 3.0);
    let traced = bench.json("trace one/lines.toml");
    assert_eq!(traced["verdict"], "nothing-missing", "{traced}");
}
