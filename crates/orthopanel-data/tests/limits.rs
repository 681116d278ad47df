//! What files may hold at most, and that reading them takes no longer than their length.

use std::path::Path;
use std::time::{Duration, Instant};

use crate::support::Dataset;
use orthopanel_data::{DataError, ImpactTest, RecordFile, limits};

const PIECE: &str = "length = 0.8\nwidth = 0.1\nthickness = 0.03\nmass_per_area = 6.88\n";

fn said(text: &str) -> String {
    ImpactTest::from_toml(text, "test.toml").expect_err("refused").to_string()
}

/// Where time grows with the square of the length, a file of this size takes minutes.
const LONG: usize = 1 << 21;
/// A hang, on however busy a machine.
const HANG: Duration = Duration::from_secs(30);

fn soon(what: &str, bytes: &[u8]) -> Result<RecordFile, DataError> {
    let begun = Instant::now();
    let read = RecordFile::from_bytes(bytes, "long.uff");
    assert!(begun.elapsed() < HANG, "{what}: {:?} for {} bytes", begun.elapsed(), bytes.len());
    read
}

#[test]
fn regress_long_universal_files_are_read_in_one_pass() {
    let values: Vec<f64> = (0..20).map(f64::from).collect();
    let set = Dataset::time(&values, (13, "N"));
    // Marks without line ends, where the data of a 58b should end.
    let marks = "    -1".repeat(LONG / 6).into_bytes();
    let binary =
        [set.binary_with(false, 7, &[&set.binary_data(false)[..], b"x", &marks].concat()), set.binary(false)].concat();
    let refused = soon("marks in binary data", &binary).expect_err("corrupt");
    assert!(matches!(refused, DataError::Surplus { .. } | DataError::Truncated { .. }), "{refused}");
    // Marks before blank lines, one set after the other, and sets that are not read.
    for (what, part) in [
        ("marks on lines of their own", "    -1\n"),
        ("marks and blank lines", "    -1\n\n\n"),
        ("sets of another kind", "    -1\n    15\n    -1\n"),
        ("blanks after marks", "    -1                    \r\n"),
    ] {
        let text = part.repeat(LONG / part.len());
        let read = soon(what, &[text.as_bytes(), &set.text()].concat()).expect(what);
        assert_eq!(read.records.len(), 1, "{what}");
        assert!(read.notes.len() < 10, "{what}: {} notes", read.notes.len());
    }
    // Values that look like marks among others, each before blank lines.
    let values = "    -1\n\n".repeat(LONG / 8);
    let among = format!("    -1\n    58\n{}{values}1.0 2.0\n    -1\n", set.header());
    assert!(soon("marks among values", among.as_bytes()).is_err());
}

#[test]
fn a_list_may_be_long_but_not_endless() {
    let list = |count: usize| {
        let values: Vec<String> = (0..count).map(|mode| format!("{}", 300.0 + mode as f64)).collect();
        format!("[piece]\n{PIECE}[[measurement]]\nkind = \"natural-frequencies\"\nvalues = [{}]\n", values.join(", "))
    };
    assert!(ImpactTest::from_toml(&list(limits::FREQUENCIES), "test.toml").is_ok());
    let said = said(&list(100_000));
    for part in ["test.toml:8: measurement[1].values", "100000 natural frequencies", "at most 200"] {
        assert!(said.contains(part), "{said:?} does not say {part:?}");
    }
}

#[test]
fn every_list_of_a_test_file_has_an_end() {
    let measured = "[[measurement]]\nkind = \"natural-frequencies\"\nvalues = [321.3, 837.5]\n";
    let piece = |number: usize| format!("[[piece]]\nname = \"{number}\"\n{PIECE}");
    let pieces: String = (0..=limits::PIECES).map(piece).collect();
    let many = |head: &str, entry: &str, count: usize| format!("[piece]\n{PIECE}{head}{}", entry.repeat(count));
    let names = ["\"g_zx\""; limits::OWN_CONSTANTS + 1].join(", ");
    let points = ["0.1"; limits::SUSPENSION_POINTS + 1].join(", ");
    let coupons = ["[0.1, 0.1, 0.0686]"; limits::WEIGHINGS + 1].join(", ");
    let full = format!(
        "[[measurement]]\nkind = \"natural-frequencies\"\nvalues = [{}]\n",
        (0..limits::FREQUENCIES).map(|mode| format!("{}", 300 + mode)).collect::<Vec<_>>().join(", ")
    );
    for (text, what, most) in [
        (pieces + measured, "pieces", limits::PIECES),
        (many("", measured, limits::MEASUREMENTS + 1), "measurements", limits::MEASUREMENTS),
        (
            many(measured, "[[effect]]\nid = \"sensor-mass\"\nmass = 0.005\n", limits::EFFECTS + 1),
            "effects",
            limits::EFFECTS,
        ),
        (format!("[piece]\n{PIECE}own_constants = [{names}]\n{measured}"), "names", limits::OWN_CONSTANTS),
        (format!("[piece]\n{PIECE}[suspension]\nat = [{points}]\n{measured}"), "points", limits::SUSPENSION_POINTS),
        (
            format!("[piece]\n{}weighings = [{coupons}]\n{measured}", PIECE.replace("mass_per_area = 6.88\n", "")),
            "coupons",
            limits::WEIGHINGS,
        ),
        (
            many("", &full, limits::FREQUENCIES_OF_TEST / limits::FREQUENCIES + 1),
            "natural frequencies in all",
            limits::FREQUENCIES_OF_TEST,
        ),
        (
            format!("[piece]\nname = \"{}\"\n{PIECE}{measured}", "a".repeat(limits::NAME + 1)),
            "characters",
            limits::NAME,
        ),
    ] {
        let said = said(&text);
        assert!(said.contains(what) && said.contains(&format!("at most {most} ")), "{what}: {said}");
    }
}

#[test]
fn a_file_has_no_more_records_than_the_limit() {
    // Without the blanks that fill up lines: a hundred thousand of them are 40 MB.
    let set = String::from_utf8(Dataset::time(&[1.0], (13, "N")).text()).expect("text");
    let set: String = set.lines().map(|line| format!("{}\n", line.trim_end())).collect();
    let read = |count: usize| RecordFile::from_bytes(set.repeat(count).as_bytes(), "many.uff");
    assert_eq!(read(limits::RECORDS).expect("as many as may be").records.len(), limits::RECORDS);
    let said = read(limits::RECORDS + 1).expect_err("one too many").to_string();
    for part in ["many.uff", "100001 records", "at most 100000", "split the file"] {
        assert!(said.contains(part), "{said:?} does not say {part:?}");
    }
}

/// A test of so many files `0.uff`, `1.uff`, ... in a folder, all of one pair of places.
fn hits_of(folder: &Path, files: usize) -> Result<ImpactTest, DataError> {
    let entry = |index| {
        format!(
            "[[measurement]]\nkind = \"time-history\"\nfile = \"{index}.uff\"\nforce_at = [-0.3, 0]\nresponse_at = [0.3, 0]\n"
        )
    };
    let entries: String = (0..files).map(entry).collect();
    ImpactTest::from_toml(&format!("[piece]\n{PIECE}{entries}"), folder.join("test.toml"))
}

#[test]
fn a_pair_of_places_has_no_more_hits_than_the_limit() {
    let hits = |count: usize, size: f64| {
        let pulse = Dataset::time(&std::array::from_fn::<_, 16, _>(|n| if n == 1 { size } else { 0.0 }), (13, "N"));
        let motion = Dataset::time(&std::array::from_fn::<_, 16, _>(|n| size * n as f64), (12, "m/s^2"));
        [pulse.text(), motion.text()].concat().repeat(count)
    };
    let most = limits::HITS;
    // In one file, and in several that are hits of one pair together.
    for (files, is_refused) in [
        (vec![hits(most, 1.0)], false),
        (vec![hits(most + 1, 1.0)], true),
        (vec![hits(most / 2, 1.0), hits(most / 2, 2.0)], false),
        (vec![hits(most / 2, 1.0), hits(most / 2 + 1, 2.0)], true),
    ] {
        let home = tempfile::tempdir().expect("a folder");
        for (index, bytes) in files.iter().enumerate() {
            std::fs::write(home.path().join(format!("{index}.uff")), bytes).expect("written");
        }
        let test = hits_of(home.path(), files.len()).expect("a test");
        let found = test.time_histories().map(|found| found[0].1.hits.len());
        match found {
            Ok(found) => assert!(!is_refused && found == most, "{found}"),
            Err(refused) => {
                let said = refused.to_string();
                assert!(is_refused, "{said}");
                for part in [".uff", "2001 hits of one pair of places", "at most 2000", "leave some out"] {
                    assert!(said.contains(part), "{said:?} does not say {part:?}");
                }
            }
        }
    }
}

/// Holes, which take no room on the disk.
#[cfg(unix)]
#[test]
fn files_of_records_have_no_more_bytes_together_than_the_limit() {
    let home = tempfile::tempdir().expect("a folder");
    let sized = |sizes: &[u64]| {
        for (index, size) in sizes.iter().enumerate() {
            let file = std::fs::File::create(home.path().join(format!("{index}.uff"))).expect("made");
            file.set_len(*size).expect("sized");
        }
        hits_of(home.path(), sizes.len()).map(drop).map_err(|refused| refused.to_string())
    };
    let half = limits::RECORD_FILES / 2;
    sized(&[half, half]).expect("as many as may be");
    let said = sized(&[half, half, 1]).expect_err("one byte too many");
    for part in ["3 files", "4294967297 bytes", "4294967296"] {
        assert!(said.contains(part), "{said:?} does not say {part:?}");
    }
    let said = sized(&[half + 1]).expect_err("one file too large");
    for part in ["0.uff", "2147483649 bytes", "a file of records may have 2147483648"] {
        assert!(said.contains(part), "{said:?} does not say {part:?}");
    }
}

#[test]
fn a_type_error_behind_many_tables_is_told_soon() {
    let begun = Instant::now();
    let text = format!("{}[piece]\nlength = true\n", "[[measurement]]\n".repeat(LONG / 16));
    let said = said(&text);
    assert!(begun.elapsed() < HANG, "{:?}", begun.elapsed());
    assert!(said.contains("piece.length: true given"), "{said}");
}

#[test]
fn nesting_has_an_end() {
    for (open, close) in [("[", "]"), ("{a = ", "}")] {
        let deep =
            format!("[piece]\n{PIECE}[[measurement]]\nkind = {}1{}\n", open.repeat(100_000), close.repeat(100_000));
        let said = said(&deep);
        assert!(said.starts_with("test.toml:7") && said.len() < 1000, "{}", &said[..said.len().min(300)]);
    }
    // Dotted keys and headers nest too.
    for text in [format!("{}b = 1\n", "a.".repeat(100_000)), format!("[{}b]\n", "a.".repeat(100_000))] {
        assert!(ImpactTest::from_toml(&text, "test.toml").is_err());
    }
}

#[test]
fn frequencies_that_no_panel_has_are_refused() {
    let list = |values: &str| {
        format!("[piece]\n{PIECE}[[measurement]]\nkind = \"natural-frequencies\"\nvalues = [{values}]\n")
    };
    for (values, place) in [
        ("1e-300, 837.5", "values[1] = "),
        ("1e-4, 837.5", "values[1] = "),
        ("321.3, 1e9", "values[2] = "),
        ("321.3, 837.5, 1e300", "values[3] = "),
    ] {
        let said = said(&list(values));
        for part in [place, "no mode of a piece of these sizes", "1e3 Pa", "1e13 Pa", "Hz"] {
            assert!(said.contains(part), "{said:?} does not say {part:?}");
        }
        assert!(said.len() < 500, "{said}");
    }
    // From a mat of foam to a slab of diamond everything passes.
    for values in ["0.1, 0.3", "321.3, 837.5", "60000.0, 150000.0"] {
        assert!(ImpactTest::from_toml(list(values).as_str(), "test.toml").is_ok(), "{values}");
    }
}

#[test]
fn a_size_is_blamed_on_itself() {
    for (size, value) in [("length", "0.8"), ("width", "0.1"), ("thickness", "0.03"), ("mass_per_area", "6.88")] {
        for absurd in ["1e308", "1e-308"] {
            let piece = PIECE.replace(&format!("{size} = {value}"), &format!("{size} = {absurd}"));
            let said = said(&format!(
                "[piece]\n{piece}[[measurement]]\nkind = \"natural-frequencies\"\nvalues = [321.3, 837.5]\n"
            ));
            let others = ["length", "width", "thickness"].into_iter().filter(|other| *other != size);
            assert!(said.contains(&format!("{size} = {absurd}")), "{said}");
            for other in others {
                assert!(!said.contains(&format!("{other} =")), "{said}");
            }
        }
    }
}
