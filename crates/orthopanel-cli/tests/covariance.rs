//! What a model file tells of its errors.

use orthopanel_model::{Estimate, ModeRange, PanelModel};
use serde_json::Value;

use crate::support::{Bench, number};

const MODES: usize = 6;
const DRAWS: usize = 2000;

fn logarithms(panel: &PanelModel) -> Vec<f64> {
    let modes = panel.modes(ModeRange::Count(MODES)).expect("modes");
    modes.iter().map(|mode| mode.frequency()).filter(|frequency| *frequency > 0.0).map(f64::ln).collect()
}

/// Standard deviation of the logarithm of each frequency over many draws.
fn drawn(panel: &PanelModel) -> Vec<f64> {
    let all: Vec<Vec<f64>> = panel.draws(DRAWS, 3).expect("draws").iter().map(logarithms).collect();
    let of_mode = |mode: usize| {
        let mean = all.iter().map(|of| of[mode]).sum::<f64>() / DRAWS as f64;
        (all.iter().map(|of| (of[mode] - mean).powi(2)).sum::<f64>() / (DRAWS - 1) as f64).sqrt()
    };
    (0..MODES).map(of_mode).collect()
}

/// The same by $\sqrt{s^T\Sigma s}$ with the covariance $\Sigma$ that an identification tells, and $s = \partial\ln f/\partial c$ by differences.
fn propagated(panel: &PanelModel, identified: &Value) -> Vec<f64> {
    let names = ["e_x", "g_zx"];
    let std = names.map(|name| number(identified, &format!("/constants/{name}/std")));
    let share = |at: usize| {
        let moved = |sign: f64| {
            let mut moved = panel.clone();
            let value = panel.constants[names[at]].value + sign * 0.1 * std[at];
            moved.constants.insert(names[at].into(), Estimate { value, std: None });
            logarithms(&moved)
        };
        moved(1.0).into_iter().zip(moved(-1.0)).map(|(up, down)| (up - down) / 0.2).collect::<Vec<f64>>()
    };
    let (e, g) = (share(0), share(1));
    let pair = &identified["correlations"][0];
    assert_eq!([&pair["first"], &pair["second"]], ["e_x", "g_zx"]);
    let together = number(pair, "/value");
    e.iter().zip(&g).map(|(e, g)| (e * e + g * g + 2.0 * together * e * g).sqrt()).collect()
}

#[test]
fn val_draws_from_a_model_file_spread_as_the_covariance_says() {
    let bench = Bench::new();
    let identified = bench.json("identify examples/piece-1 -o model.json");
    let panel =
        PanelModel::from_json(&std::fs::read_to_string(bench.path("model.json")).expect("a model")).expect("read");
    let due = propagated(&panel, &identified);
    // A standard deviation of N draws has an error of 1/sqrt(2 N); four times that.
    let error = 4.0 / (2.0 * DRAWS as f64).sqrt();
    for (mode, (found, due)) in drawn(&panel).iter().zip(&due).enumerate() {
        assert!((found / due - 1.0).abs() < error, "mode {}: {found:e}, not {due:e}", mode + 1);
    }
    let independent = drawn(&PanelModel { correlation: None, ..panel });
    let most = independent.iter().zip(&due).map(|(found, due)| found / due).fold(0.0, f64::max);
    assert!(most > 1.3, "independent draws spread {most} times as far at most");
}

#[test]
fn traced_models_keep_their_correlation_and_deviations_of_damping() {
    let bench = Bench::new();
    bench.done("trace examples/misplaced-hit -o traced.json");
    let model = bench.read_json("traced.json");
    assert_eq!(model["correlation"]["names"], serde_json::json!(["e_x", "g_zx"]));
    let coefficient = number(&model, "/correlation/matrix/0/1");
    assert!(coefficient.abs() < 1.0 && coefficient != 0.0, "{coefficient}");
    assert!(number(&model, "/damping/std/0") > 0.0);
    let panel = PanelModel::from_json(&model.to_string()).expect("a model");
    assert_eq!(panel.damping.std.len(), panel.damping.ratios.len());
    // Into the sets of parameters that go with an FMU.
    bench.done("export traced.json -o panel.fmu --ssp --samples 2");
}
