//! A lot of panels: `batch`, and `lot` of its table.

use crate::support::{Bench, TEST, changed, number};

/// Six sound panels, one a fifth stiffer, and one that is refused.
fn lot() -> Bench {
    let bench = Bench::new();
    for panel in 1..=8 {
        let factor = 1.0 + 0.002 * f64::from(panel % 3) + if panel == 5 { 0.1 } else { 0.0 };
        let values = [321.3, 837.5, 1520.0, 2312.5, 3150.0, 3987.5].map(|value| factor * value);
        let values = if panel == 8 { "[]".to_owned() } else { format!("{values:?}") };
        let text = changed(TEST, "[321.3, 837.5, 1520.0, 2312.5, 3150.0, 3987.5]", &values);
        std::fs::create_dir_all(bench.path(&format!("lot/{panel}"))).expect("a folder is made");
        bench.write(&format!("lot/{panel}/test.toml"), &text);
    }
    bench
}

#[test]
fn a_row_has_what_identify_says_of_its_panel() {
    let bench = lot();
    let answer = bench.json("batch lot -o lot.csv");
    assert_eq!((number(&answer, "/panels"), number(&answer, "/failed")), (8.0, 1.0));
    let mut reader = csv::Reader::from_path(bench.path("lot.csv")).expect("a table");
    let names = reader.headers().expect("a heading").clone();
    let rows: Vec<csv::StringRecord> = reader.records().map(|row| row.expect("a row")).collect();
    let cell = |row: usize, name: &str| {
        let column = names.iter().position(|known| known == name).unwrap_or_else(|| panic!("no {name}: {names:?}"));
        rows[row][column].to_owned()
    };
    assert_eq!((0..8).map(|row| cell(row, "panel")).collect::<String>(), "12345678");
    let alone = bench.json("identify lot/3");
    for (column, place) in [
        ("e_x", "/constants/e_x/value"),
        ("e_x_std", "/constants/e_x/std"),
        ("g_zx", "/constants/g_zx/value"),
        ("corr:e_x:g_zx", "/correlations/0/value"),
        ("left_out_error_percent", "/error/left_one_out_percent"),
    ] {
        let (found, wanted) = (cell(2, column).parse::<f64>().expect("a number"), number(&alone, place));
        assert!((found / wanted - 1.0).abs() < 1e-8, "{column}: {found} {wanted}");
    }
    assert_eq!(cell(2, "verdict"), "nothing-missing");
    assert!(cell(7, "failed").contains("lot/8/test.toml") && cell(7, "e_x").is_empty());

    // What is known is kept, and what was changed is not.
    let before = std::fs::read(bench.path("lot.csv")).expect("a table");
    bench.done("batch lot -o lot.csv");
    assert_eq!(std::fs::read(bench.path("lot.csv")).expect("a table"), before);
    std::fs::copy(bench.path("lot/1/test.toml"), bench.path("lot/8/test.toml")).expect("a file is copied");
    assert_eq!(number(&bench.json("batch lot -o lot.csv"), "/failed"), 0.0);
}

#[test]
fn a_page_of_either_format_names_the_panel_that_stands_out() {
    let bench = lot();
    for ending in ["csv", "parquet"] {
        bench.done(&format!("batch lot -o lot.{ending}"));
        bench.done(&format!("lot lot.{ending} -o {ending}.html"));
    }
    let page = std::fs::read_to_string(bench.path("csv.html")).expect("a page");
    assert_eq!(page, std::fs::read_to_string(bench.path("parquet.html")).expect("a page"));
    assert!(page.contains("8 panels: 7 with constants, 0 with a named effect, 1 failed."), "{page}");
    let outliers = page.split("Panels that stand out").nth(1).and_then(|rest| rest.split("</section>").next());
    assert!(
        outliers.is_some_and(|rows| rows.contains("<td>5</td>") && rows.contains("of both spreads")),
        "{outliers:?}"
    );
}

#[test]
fn what_is_no_lot_is_refused_and_left_as_it_is() {
    let bench = lot();
    for (line, said) in [
        ("batch lot -o lot.xlsx", "give its name one of these endings"),
        ("batch nowhere -o lot.csv", "nowhere"),
        ("batch lot -o force.csv", "no lot's table"),
        ("lot test.toml -o page.html", "give its name one of these endings"),
        ("lot nowhere.csv -o page.html", "nowhere.csv: cannot be read"),
    ] {
        let output = bench.run(line);
        let told = String::from_utf8_lossy(&output.stderr);
        let refused_row = line.contains("nowhere -o");
        assert_eq!(output.status.code(), Some(if refused_row { 0 } else { 2 }), "{line}: {told}");
        assert!(told.contains(said), "{line}: {told}");
    }
    assert_eq!(std::fs::read_to_string(bench.path("force.csv")).expect("a file"), crate::support::FORCE);
}
