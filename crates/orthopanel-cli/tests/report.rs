//! The HTML page: whole, by itself, and safe against what a test file says.

use crate::support::{Bench, TEST, changed, refused};

fn page(bench: &Bench, line: &str) -> String {
    bench.done(&format!("{line} -o page.html"));
    std::fs::read_to_string(bench.path("page.html")).expect("a page")
}

/// Every tag that is opened is closed, in order; `br` and their like are not used, and pictures close their own.
fn assert_nested(text: &str) {
    let mut open: Vec<&str> = Vec::new();
    for part in text.split('<').skip(1) {
        let (tag, _) = part.split_once('>').expect("a tag ends");
        let name = tag.split([' ', '/', '\n']).find(|word| !word.is_empty()).unwrap_or_default();
        let is_void = tag.starts_with('!') || tag.ends_with('/') || name == "meta";
        if tag.starts_with('/') {
            assert_eq!(open.pop(), Some(name), "<{tag}> closes another");
        } else if !is_void {
            open.push(name);
        }
    }
    assert!(open.is_empty(), "left open: {open:?}");
}

#[test]
fn a_page_of_records_holds_all_of_it_and_needs_nothing_else() {
    let bench = Bench::new();
    let text = page(&bench, "report examples/made-hits/test.toml");
    assert_nested(&text);
    for reference in ["src=", "href=", "url(", "@import", "<script", "<link", "<iframe"] {
        assert!(!text.contains(reference), "{reference} leads out of the page");
    }
    // The only addresses are the names of the SVG vocabulary.
    assert_eq!(text.matches("http").count(), text.matches("xmlns=\"http://www.w3.org/2000/svg\"").count());
    for said in
        ["What was found", "Records", "3 hits", "coherence", "Accelerances", "Time histories", "What the model leaves"]
    {
        assert!(text.contains(said), "the page does not say {said:?}");
    }
    // Its numbers are those of `identify`, to the digits shown.
    let answer = bench.json("identify examples/made-hits/test.toml");
    for name in ["e_x", "g_zx"] {
        let value = crate::support::number(&answer, &format!("/constants/{name}/value"));
        assert!(text.contains(&format!("<td>{name}</td><td>{value:.4e}</td>")), "{name} = {value}");
    }
}

/// Of records of two places the page has each measured mode beside the model's, and how alike their shapes are.
#[test]
fn a_page_has_measured_modes_beside_the_models_with_their_assurance() {
    let bench = Bench::new();
    let model = r#"{"schema": "orthopanel.model/1", "piece": {"length": 0.8, "width": 0.1, "thickness": 0.03, "mass_per_area": 6.88},
 "structure": "timoshenko-beam", "constants": {"e_x": 1.07e10, "g_zx": 5.363e8}, "damping": {"beyond": 0.004},
 "ports": {"forces": [[0, 0]], "responses": [[0, 0]]}}"#;
    std::fs::write(bench.path("model.json"), model).expect("a file is written");
    let mut test = "[piece]\nlength = 0.8\nwidth = 0.1\nthickness = 0.03\nmass_per_area = 6.88\n".to_owned();
    for force in ["-0.3", "0.05"] {
        bench.done(&format!(
            "accelerance model.json --force {force} --response 0.3 --from 100 --to 2600 --lines 1251 -o at{force}.csv"
        ));
        test += &format!(
            "[[measurement]]\nkind = \"accelerance\"\nfile = \"at{force}.csv\"\nforce_at = [{force}, 0]\nresponse_at = [0.3, 0]\n"
        );
    }
    std::fs::write(bench.path("two.toml"), test).expect("a file is written");
    let text = page(&bench, "report two.toml");
    assert_nested(&text);
    assert!(text.contains("Measured modes beside those of the model") && text.contains("<th>MAC</th>"), "{text}");
    assert!(text.contains("modal assurance criterion, measured modes against the model"), "{text}");
    let answer = bench.json("identify two.toml");
    let modes = answer["measured_modes"][0]["modes"].as_array().expect("modes");
    assert!(modes.len() > 3, "{modes:?}");
    for mode in modes {
        let assurance = crate::support::number(mode, "/mac");
        assert!(assurance > 0.99 && text.contains(&format!("<td>{assurance:.4}</td>")), "{mode}");
    }
}

#[test]
fn run_leaves_the_same_page() {
    let bench = Bench::new();
    let text = page(&bench, "report examples/pieces-1-2/test.toml");
    assert_nested(&text);
    bench.done("run examples/pieces-1-2/test.toml -o out");
    assert_eq!(std::fs::read_to_string(bench.path("out/report.html")).expect("a page"), text);
}

#[test]
fn names_in_a_test_file_stay_text() {
    let bench = Bench::new();
    let name = r#"name = "<script>alert(1)</script> & 'co'"
length"#;
    std::fs::write(bench.path("test.toml"), changed(TEST, "length", name)).expect("a file is written");
    let text = page(&bench, "report test.toml");
    assert!(!text.contains("<script") && !text.contains("& '"), "a name was taken for markup");
    assert_nested(&text);
}

#[test]
fn a_page_that_cannot_be_written() {
    let bench = Bench::new();
    bench.done("identify test.toml");
    let output = bench.run("report test.toml -o test.toml/page.html");
    assert_eq!(output.status.code(), Some(2));
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(message.contains("test.toml: cannot be written"), "{message}");
    refused(&bench, "report nowhere.toml -o page.html", 2, &["nowhere.toml", "cannot be read"]);
}

#[test]
fn a_page_goes_into_a_folder_of_its_own_and_json_says_where() {
    let bench = Bench::new();
    let answer = bench.json("report test.toml -o new/folder/page.html");
    assert_eq!(answer["schema"], "orthopanel.report/1");
    assert_eq!(answer["page"], "new/folder/page.html");
    assert_eq!(answer["verdict"], "nothing-missing");
    assert!(bench.path("new/folder/page.html").is_file());
}
