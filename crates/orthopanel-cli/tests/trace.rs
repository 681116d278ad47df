//! `trace`, and tracing inside `run` and `report`.

use crate::support::{Bench, number, refused};

/// The hammer hit 10 mm beside the place that the test file gives.
const MISPLACED: &str = "examples/misplaced-hit/test.toml";

#[test]
fn val_a_misplaced_hammer_is_named_and_its_way_found() {
    let bench = Bench::new();
    let answer = bench.json(&format!("trace {MISPLACED} -o model.json"));
    assert_eq!(answer["schema"], "orthopanel.trace/2");
    assert_eq!(answer["verdict"], "explained");
    assert_eq!(answer["effects"][0]["id"], "hammer-offset");
    assert_eq!(answer["effects"][0]["owner"], "channel");
    // No blow is trusted to fall nearer to its mark than 0.8 mm.
    let offset = number(&answer, "/effects/0/parameters/offset/value");
    let std = number(&answer, "/effects/0/parameters/offset/std");
    assert!((offset + 0.01).abs() < 2.0 * std && std < 1e-3, "offset {offset} +- {std} m, put in -0.01 m");
    let error = |path: &str| number(&answer, &format!("/error/{path}"));
    assert!(error("after/held_out") < 0.5 * error("before/held_out"), "{}", answer["error"]);
    assert!(error("after/held_out") < 1.2 * error("noise_floor"), "{}", answer["error"]);
    // The beam that the hits were made with is the model's own.
    assert!(number(&answer, "/model_error/frequency") < 3e-4, "{}", answer["model_error"]);
    let evidence = |id: &str| {
        let of = answer["candidates"].as_array().and_then(|all| all.iter().find(|candidate| candidate["id"] == id));
        of.and_then(|candidate| candidate["log_evidence"].as_f64()).expect("an evidence")
    };
    assert!(evidence("hammer-offset") > evidence("base") + 10.0);
    assert!(answer["candidates"].as_array().is_some_and(|candidates| candidates.len() > 5));
    assert!(answer["next_experiment"].is_string());
    // People read ten of them, and are told of the others.
    let further = answer["candidates"].as_array().map_or(0, Vec::len) - 10;
    let text = bench.done(&format!("trace {MISPLACED}"));
    assert!(text.contains(&format!("and {further} further behind")), "{text}");
    assert!(text.contains("Beside noise the model misses frequencies by"), "{text}");
    // It belongs to the measuring chain, so the panel's model does not have it, and its constants are right again.
    let model = bench.read_json("model.json");
    assert!(model.get("effects").is_none(), "{model}");
    assert_eq!(answer["removed"][0]["id"], "hammer-offset");
    assert_eq!(model["provenance"]["removed"], serde_json::json!(["hammer-offset"]));
    assert_eq!(model["provenance"]["trace"], "explained");
    let truth = bench.read_json("examples/made-hits/truth.json");
    for name in ["e_x", "g_zx"] {
        let found = number(&model, &format!("/constants/{name}/value"));
        let error = found / number(&truth, &format!("/constants/{name}")) - 1.0;
        assert!(error.abs() < 1e-3, "{name}: {found:e}, {error:e} from the truth");
    }
}

#[test]
fn run_writes_the_panel_without_rig_and_channel_and_says_so() {
    let bench = Bench::new();
    let answer = bench.json(&format!("run {MISPLACED} -o out"));
    assert_eq!(answer["trace"]["verdict"], "explained");
    assert_eq!(bench.read_json("out/trace.json"), answer["trace"]);
    let model = bench.read_json("out/model.json");
    assert_eq!(model["provenance"]["removed"], serde_json::json!(["hammer-offset"]));
    assert_eq!(model["provenance"]["trace"], "explained");
    // Modes as the test shows them; errors of the model without the effect are no longer this model's.
    let modes = model["provenance"]["modes"].as_array().expect("the measured modes");
    assert!(modes.len() > 5 && modes.iter().all(|mode| mode["measured_hz"].is_number()), "{modes:?}");
    assert!(modes.iter().all(|mode| mode.get("model_hz").is_none() && mode.get("zeta").is_none()), "{modes:?}");
    // The records' noise is below a hundredth of the resonances: the model without the offset misses them by a tenth.
    let left = number(&model, "/provenance/accelerance_rms_percent");
    assert!(left > 0.0 && left < 1.0, "{left} %");
    assert!(model["provenance"].get("frequency_rms_percent").is_none(), "{model}");
    let damping = model["provenance"]["damping"].as_str().expect("where the damping is from");
    assert!(damping.contains("with the effects") && !damping.contains("but for mode"), "{damping}");
    let page = std::fs::read_to_string(bench.path("out/report.html")).expect("a page");
    for said in [
        "What the model lacks",
        "Hits before and with the effects",
        "These are the constants of the base model, before effects",
        "Fit of the natural frequencies: the base model, before effects",
        "Time histories: the base model, before effects",
        "What the model leaves: the base model, before effects",
        "constant with it",
        "hammer-offset",
        "taken out of the model",
        "Error before and after",
        "Accelerances with the effects",
        "What the model with the effects leaves",
        "The same by level",
        "Ranking",
    ] {
        assert!(page.contains(said), "the page does not say {said:?}");
    }
}

/// Two pieces of one plate with nu_xy = 0.4, by `orthopanel modes`.
const TWO_WIDTHS: &str = r#"
[[piece]]
name = "narrow"
length = 0.8
width = 0.1
thickness = 0.03
mass_per_area = 6.88
[[piece]]
name = "wide"
length = 0.8
width = 0.3
thickness = 0.03
mass_per_area = 6.88
[[measurement]]
piece = "narrow"
kind = "natural-frequencies"
values = [320.46, 834.99, 1517.31, 2297.41, 3128.66, 3982.34, 4842.70]
resolution = 1.25
[[measurement]]
piece = "wide"
kind = "natural-frequencies"
values = [321.94, 843.80, 1529.69, 2409.89, 3202.36, 4053.22, 4928.93]
resolution = 1.25
"#;

#[test]
fn run_and_report_take_a_reference_as_trace_does() {
    let bench = Bench::new();
    let (suspect, good) = ("examples/piece-3/test.toml", "examples/piece-4/test.toml");
    let traced = bench.json(&format!("trace {suspect} --reference {good}"));
    let modes = number(&traced, "/shared_model_error/modes");
    assert_eq!(bench.json(&format!("run {suspect} --reference {good} -o out"))["trace"], traced);
    let page = std::fs::read_to_string(bench.path("out/report.html")).expect("a page");
    assert!(page.contains(&format!("Against the reference: the model misses {modes} frequencies")), "{page}");
    bench.done(&format!("report {suspect} --reference {good} -o page.html"));
    assert_eq!(std::fs::read_to_string(bench.path("page.html")).expect("a page"), page);
    let manifest = std::fs::read_to_string(bench.path("out/manifest.json")).expect("a manifest");
    assert!(manifest.contains(good), "{manifest}");
}

/// Two widths that one beam cannot follow: the model that is written is the plate.
#[test]
fn a_width_that_the_beam_lacks_makes_the_model_a_plate() {
    let bench = Bench::new();
    bench.write("two.toml", TWO_WIDTHS);
    let answer = bench.json("run two.toml -o out");
    assert_eq!(answer["trace"]["verdict"], "explained");
    assert_eq!(answer["trace"]["effects"][0]["id"], "width-coupling");
    let model = bench.read_json("out/model-narrow.json");
    assert_eq!(model["structure"], "mindlin-plate");
    assert!(model["constants"]["nu_xy"]["std"].is_number());
    // Its error is the plate's, and its damping the assumed one, not none.
    let error = number(&model, "/provenance/frequency_rms_percent");
    let traced = number(&answer, "/trace/error/after/fitted");
    assert!((error / traced - 1.0).abs() < 0.05 && traced < 0.5, "{error} %, {traced} %");
    assert_eq!(model["damping"]["beyond"], 0.003);
    bench.done("trace two.toml -o traced.json");
    assert_eq!(bench.read_json("traced-narrow.json")["damping"]["beyond"], 0.003);
    // The page has each frequency before and with the plate, which modes of the written model are.
    let page = std::fs::read_to_string(bench.path("out/report.html")).expect("a page");
    for said in ["base model [Hz]", "with effects [Hz]", "with the effects</text>", "95 % interval"] {
        assert!(page.contains(said) || page.contains(&said.replace("</", "\n</")), "the page does not say {said:?}");
    }
    let modes = bench.json("modes out/model-narrow.json --count 30");
    let bending = modes["modes"].as_array().expect("modes").iter().filter(|mode| mode["nodes"][1] == 0).take(6);
    for mode in bending {
        let shown = format!("<td>{:.2}</td>", number(mode, "/frequency_hz"));
        assert!(page.contains(&shown), "{shown} is not on the page");
    }
    refused(&bench, "trace nowhere.toml", 2, &["nowhere.toml", "cannot be read"]);
}

/// Two lengths with the same mass at each end: what both pieces have is said once, and the page has the frequencies with it.
#[test]
fn what_stays_in_several_pieces_is_said_once() {
    let bench = Bench::new();
    let mut test = String::new();
    for (name, length) in [("long", 0.8), ("short", 0.6)] {
        let model = format!(
            r#"{{"schema": "orthopanel.model/1", "piece": {{"length": {length}, "width": 0.1, "thickness": 0.03, "mass_per_area": 6.88}},
 "structure": "timoshenko-beam", "constants": {{"e_x": 1.07e10, "g_zx": 5.363e8}}, "damping": {{"beyond": 0.003}},
 "effects": [{{"id": "edge-mass", "owner": "panel", "mass": 0.02}}], "ports": {{"forces": [[0, 0]], "responses": [[0, 0]]}}}}"#
        );
        std::fs::write(bench.path("edge.json"), model).expect("a file is written");
        let modes = bench.json("modes edge.json --count 8");
        let modes = modes["modes"].as_array().expect("modes");
        let values: Vec<String> = modes.iter().map(|mode| format!("{:.2}", number(mode, "/frequency_hz"))).collect();
        test += &format!(
            "[[piece]]\nname = \"{name}\"\nlength = {length}\nwidth = 0.1\nthickness = 0.03\nmass_per_area = 6.88\n\
             [[measurement]]\npiece = \"{name}\"\nkind = \"natural-frequencies\"\nvalues = [{}]\n",
            values.join(", ")
        );
    }
    std::fs::write(bench.path("edges.toml"), test).expect("a file is written");
    let text = bench.done("trace edges.toml");
    assert!(text.contains("The model lacked"), "{text}");
    assert_eq!(text.matches("edge-mass stays in the model").count(), 1, "{text}");
    bench.done("report edges.toml -o page.html");
    let page = std::fs::read_to_string(bench.path("page.html")).expect("a page");
    assert_eq!(page.matches("with effects [Hz]").count(), 2);
}

/// Twelve bending modes are too few to judge a plate by: the model is the plate, and how many more would do is said.
#[test]
fn a_declared_plate_is_written_as_the_plate_that_was_identified() {
    let bench = Bench::new();
    let answer = bench.json("run examples/pieces-1-2-plate/test.toml -o out");
    assert_eq!(answer["trace"]["verdict"], "ambiguous");
    assert!(answer["trace"]["next_experiment"].as_str().expect("words").contains("read at least 14"), "{answer}");
    for piece in ["1", "2"] {
        let model = bench.read_json(&format!("out/model-{piece}.json"));
        assert_eq!(model["structure"], "mindlin-plate");
        let identified = number(&answer, "/identified/constants/e_x/value");
        assert!((number(&model, "/constants/e_x/value") / identified - 1.0).abs() < 0.01, "{model}");
        assert_eq!(model["effects"].as_array().map_or(0, Vec::len), 0);
    }
    let page = std::fs::read_to_string(bench.path("out/report.html")).expect("a page");
    assert!(!page.contains("Not traced: ") && !page.contains("The model lacked"), "{page}");
}

/// Where the file is likelier wrong than the model, no effect is blamed; where a list is too short, the words say what would do.
#[test]
fn lists_that_cannot_name_an_effect_say_what_to_do() {
    let bench = Bench::new();
    let list = |values: &str, length: f64| {
        format!(
            "[piece]\nlength = {length}\nwidth = 0.1\nthickness = 0.03\nmass_per_area = 6.88\n[[measurement]]\n\
             kind = \"natural-frequencies\"\nvalues = [{values}]\n"
        )
    };
    bench.write("short.toml", &list("321.3, 837.5, 1520.0", 0.8));
    let said = bench.done("trace short.toml");
    let verdict = said.lines().next().expect("a verdict");
    assert!(
        verdict.contains("cannot tell") && verdict.contains("Next: read at least 6 natural frequencies"),
        "{verdict}"
    );
    // The second and the third read the wrong way round.
    bench.write("swapped.toml", &list("321.3, 1520.0, 1620.0, 2312.5, 3950.0, 3987.5, 4900.0", 0.8));
    let said = bench.done("trace swapped.toml");
    let verdict = said.lines().next().expect("a verdict");
    assert!(verdict.contains("wrong sizes") && verdict.contains("before an effect is blamed"), "{verdict}");
    assert!(!verdict.contains("the nearest is"), "{verdict}");
}
