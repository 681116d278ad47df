//! The paper's section 3.5 by the command, on records whose truth is known.

use crate::support::{Bench, changed, made_records, number, refused};
use serde_json::Value;

fn hits(answer: &Value) -> &Vec<Value> {
    answer["hits"].as_array().expect("hits")
}

/// At table 9's constants: both methods against the record at every place, and against each other.
#[test]
fn val_runge_kutta_on_finite_elements_stands_beside_the_exact_stepper() {
    let bench = Bench::new();
    let options = "--pair -0.3 0.3 --pair -0.05 0.3 --hits 2 --samples 8192 --noise 0.003 --seed 8 --format uff-binary";
    let Some(truth) = made_records(&bench, "made", options) else { return };
    let ratios: Vec<f64> = truth["modes"].as_array().expect("modes").iter().map(|mode| number(mode, "/zeta")).collect();
    let mut model = bench.read_json("model.json");
    model["constants"] = serde_json::json!({"e_x": truth["constants"]["e_x"], "g_zx": truth["constants"]["g_zx"]});
    model["damping"] = serde_json::json!({"ratios": ratios, "beyond": ratios.last()});
    bench.write("true.json", &model.to_string());
    let line = "simulate true.json --force-file made/test.toml";
    let (exact, linear) = (bench.json(line), bench.json(&format!("{line} --hold linear")));
    let by_lines = format!("{line} --method runge-kutta --hold linear");
    let answer = bench.json(&format!("{by_lines} -o rk.csv"));
    assert_eq!((exact["method"].as_str(), answer["method"].as_str()), (Some("exact"), Some("runge-kutta")));
    assert_eq!(hits(&answer).len(), 4);
    for (hit, linear) in hits(&answer).iter().zip(hits(&linear)) {
        // Beside it stands the exact stepper under the same straight lines.
        let named = ["peak_m_s2", "rms_percent_of_peak", "variance_explained"];
        assert!(named.iter().all(|name| hit["exact"][name] == linear["whole"][name]), "{hit}");
        // Elements and steps together: a thousandth of the peak.
        let apart = number(hit, "/exact/apart_percent_of_peak");
        assert!(apart > 0.0 && apart < 0.1, "{apart} % of the peak");
        let (own, exact) = (number(hit, "/whole/variance_explained"), number(hit, "/exact/variance_explained"));
        assert!((own - exact).abs() < 1e-4, "{own} {exact}");
    }
    // What straight lines lose, the band-limited force keeps: noise is all that is left.
    let smooth = bench.json(&format!("{line} --method runge-kutta"));
    for (hit, linear) in hits(&smooth).iter().zip(hits(&answer)) {
        let own = |hit| number(hit, "/whole/variance_explained");
        assert!(own(hit) > 0.9999 && own(linear) < 0.99, "{} {}", own(hit), own(linear));
    }
    // A quarter of the steps errs 256 times as much; at the default they hardly err beside the elements.
    let steps = number(&answer, "/integrations/0/steps");
    let coarse = bench.json(&format!("{by_lines} --steps {}", (steps / 4.0).ceil()));
    for (hit, coarse) in hits(&answer).iter().zip(hits(&coarse)) {
        let apart = |hit| number(hit, "/exact/apart_percent_of_peak");
        assert!(apart(coarse) > 4.0 * apart(hit), "{} {}", apart(coarse), apart(hit));
    }
    // The steps that are said to bring 1e-8 do, and those before do not.
    let of_steps = |answer: &Value| -> Vec<(f64, f64)> {
        let each = answer["integrations"].as_array().expect("integrations").iter();
        each.map(|of| (number(of, "/step_error_of_peak"), number(of, "/steps_to_1e_8"))).collect()
    };
    let said = of_steps(&answer);
    assert!(said.len() == 2 && said.iter().all(|(error, _)| (1e-7..1e-3).contains(error)), "{said:?}");
    let enough = said.iter().map(|(_, steps)| *steps).fold(0.0, f64::max);
    let fine = of_steps(&bench.json(&format!("{by_lines} --steps {enough}")));
    assert!(fine.iter().all(|(error, _)| (1e-10..=1e-8).contains(error)), "{fine:?}");
    let words = String::from_utf8_lossy(&bench.run(&by_lines).stderr).into_owned();
    assert!(words.contains("-0.05 to 0.3: ") && words.contains("brings 1e-8"), "{words}");
    // What straight lines lose is said, and nothing where they are not taken.
    assert!(words.contains("with --hold band-limited"), "{words}");
    let words = String::from_utf8_lossy(&bench.run(line).stderr).into_owned();
    assert!(!words.contains("straight lines"), "{words}");
    assert_eq!(bench.rows("rk.csv").len(), 4 * 8192);
    let table = bench.done(&format!("{line} --method runge-kutta"));
    assert!(table.lines().next().expect("a heading").ends_with("variance explained  apart [% of peak]"), "{table}");
}

/// A sensor turned round on a file of hits, which no test file declares: said with the correlation.
#[test]
fn val_a_sensor_turned_round_is_said() {
    let bench = Bench::new();
    bench.done("simulate model.json --force-file examples/half-sine.csv --force -0.3 --response 0.3 -o moved.csv");
    let words = |sign: f64| {
        let rows = bench.rows("moved.csv").into_iter();
        let rows: String = rows.map(|row| format!("{},{},{}\n", row[0], row[1], sign * row[2])).collect();
        bench.write("hit.csv", &format!("time_s,force_n,acceleration_m_s2\n{rows}"));
        let line = "simulate model.json --force-file hit.csv --force -0.3 --response 0.3";
        String::from_utf8_lossy(&bench.run(line).stderr).into_owned()
    };
    assert!(words(-1.0).contains("run against each other (correlation -"), "{}", words(-1.0));
    assert!(!words(1.0).contains("run against each other"), "{}", words(1.0));
}

#[test]
fn what_does_not_fit_section_3_5_is_refused() {
    let bench = Bench::new();
    let hits = "--force-file examples/made-hits/test.toml";
    refused(&bench, &format!("simulate model.json {hits} --steps 8"), 2, &["--steps", "runge-kutta"]);
    refused(
        &bench,
        "simulate model.json --force-file force.csv --method runge-kutta",
        2,
        &["--method", "measured hits"],
    );
    refused(
        &bench,
        &format!("simulate model.json {hits} --method runge-kutta --hold linear --steps 1"),
        2,
        &["steps", "mode"],
    );
    let model = std::fs::read_to_string(bench.path("model.json")).expect("a model");
    let effect = r#""effects": [{"id": "edge-mass", "owner": "panel", "mass": 0.01}], "ports""#;
    bench.write("modified.json", &changed(&model, r#""ports""#, effect));
    refused(
        &bench,
        &format!("simulate modified.json {hits} --method runge-kutta"),
        2,
        &["modified.json", "beam without effects"],
    );
    refused(&bench, &format!("simulate plate.json {hits} --method runge-kutta"), 2, &["plate.json", "beam without"]);
}
