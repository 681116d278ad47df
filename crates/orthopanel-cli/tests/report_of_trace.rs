//! The page of records that no beam of the test file could give.

use crate::support::Bench;

/// A free beam's hits in a file that says clamped: refused, and that is where a page is needed most.
#[test]
fn records_that_contradict_the_beam_have_their_page() {
    let bench = Bench::new();
    let clamped = bench.made_hits("[boundary]\nleft = \"clamped\"\nright = \"free\"\n");
    let output = bench.run(&format!("run {clamped} -o out --json"));
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(message.contains("half of all lines miss the model"), "{message}");
    let answer: serde_json::Value = serde_json::from_slice(&output.stdout).expect("one JSON object");
    assert_eq!(answer["trace"]["verdict"], "unexplained");
    assert_eq!(answer["trace"]["effects"], serde_json::json!([]));
    assert!(answer["files"].to_string().contains("report.html"), "{answer}");
    assert!(!bench.path("out/model.json").exists());
    let text = std::fs::read_to_string(bench.path("out/report.html")).expect("a page");
    for said in [
        "No base model was identified: half of all lines miss the model",
        "What the model lacks",
        "Error before and after",
        "Ranking",
        "<h3>Records</h3>",
        "3 hits",
        "coherence of 1 records",
        "Accelerances: the base model, before effects",
        "What the model leaves: the base model, before effects",
        "A misfit that grows with the force",
    ] {
        assert!(text.contains(said), "the page does not say {said:?}");
    }
    // No table of constants that were not identified.
    assert!(!text.contains("<th>constant</th>"), "{text}");
}
