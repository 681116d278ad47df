//! What `trace -o` writes where no effect explains the data.

use crate::support::{Bench, changed};

/// Constants held a tenth beside the truth, more than any real panel's model error: the nearest effects do not explain what is missed, and are not in the file.
#[test]
fn what_does_not_explain_the_data_is_in_no_model() {
    let bench = Bench::new();
    let test = bench.made_hits("[constants]\ne_x = 1.2e10\ng_zx = 5.3e8\n");
    let said = bench.done(&format!("trace {test} -o traced.json"));
    assert!(
        said.starts_with("Something is missing that no effect of the catalogue explains; the nearest is"),
        "{said}"
    );
    assert!(said.contains("goes into no model"), "{said}");
    assert!(!said.contains("stays in the model") && !said.contains("taken out of the model"), "{said}");
    let mut model = bench.read_json("traced.json");
    assert_eq!(model["provenance"]["trace"], "unexplained");
    assert!(model.get("effects").is_none() && model["provenance"].get("removed").is_none(), "{model}");
    // But for the verdict it is what `identify` makes of the test, as with `run`.
    bench.done(&format!("identify {test} -o base.json"));
    let told = model["provenance"].as_object_mut().expect("a provenance");
    told.remove("trace");
    assert_eq!(model, bench.read_json("base.json"));
}

/// A boundary that the records contradict: nothing found explains them, and the base model is refused.
#[test]
fn where_the_base_model_is_refused_too_no_model_is_written() {
    let bench = Bench::new();
    let test = bench.made_hits("[boundary]\nleft = \"clamped\"\nright = \"free\"\n");
    let output = bench.run(&format!("trace {test} -o traced.json --json"));
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{message}");
    for part in ["traced.json: no model is written", "no effect explains", "half of all lines miss the model"] {
        assert!(message.contains(part), "{message:?} does not say {part:?}");
    }
    assert!(!bench.path("traced.json").exists());
    // What was found is told all the same.
    let told: serde_json::Value = serde_json::from_slice(&output.stdout).expect("one JSON object");
    assert_eq!(told["verdict"], "unexplained");
}

/// With all constants held the plate has nothing free: it is judged by its own error, and every candidate has a number.
#[test]
fn every_candidate_has_an_error_held_out() {
    let bench = Bench::new();
    let held = "[constants]\ne_x = 1.07e10\ng_zx = 5.363e8\n[[measurement]]";
    bench.write("held.toml", &changed(crate::support::TEST, "[[measurement]]", held));
    let answer = bench.json("trace held.toml");
    let candidates = answer["candidates"].as_array().expect("candidates");
    assert!(candidates.iter().any(|of| of["id"] == "width-coupling"), "{answer}");
    assert!(candidates.iter().all(|of| of["held_out"].is_number()), "{answer}");
}
