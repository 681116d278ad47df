//! What an answer is of.

use serde_json::Value;

use crate::support::{Bench, DATE};

#[test]
fn answers_tell_what_they_are_of() {
    let bench = Bench::new();
    bench.done("run examples/made-hits -o out");
    let manifest = bench.read_json("out/manifest.json");
    for name in ["out/identified.json", "out/trace.json"] {
        let provenance = bench.read_json(name)["provenance"].take();
        assert_eq!(provenance["program"], concat!("orthopanel ", env!("CARGO_PKG_VERSION")));
        assert_eq!(provenance["test"], "examples/made-hits/test.toml");
        assert_eq!(provenance["pieces"], serde_json::json!(["1"]));
        assert_eq!(provenance["date"], DATE.1);
        assert_eq!(provenance["inputs"], manifest["inputs"], "{name}");
        assert_eq!(provenance["inputs"].as_array().map(Vec::len), Some(2));
    }
    // Without the variable it is that of the clock.
    let now = bench
        .command("identify examples/piece-1 --json")
        .env_remove("SOURCE_DATE_EPOCH")
        .stdout(std::process::Stdio::piped())
        .output();
    let now: Value = serde_json::from_slice(&now.expect("the program starts").stdout).expect("one JSON object");
    assert!(now["provenance"]["date"].as_str().is_some_and(|date| date > DATE.1), "{now}");
}
