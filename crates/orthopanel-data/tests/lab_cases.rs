//! Folders of records that labs' tools made, one of a kind each: what they hold must be one panel's accelerances.

use orthopanel_data::{Accelerance, Estimation, ImpactTest};

use crate::support::measured;

/// The accelerances of a folder beside the measured data; `None` where it is absent.
fn accelerances(name: &str, keys: &str) -> Option<Vec<Accelerance>> {
    let folder = measured(&format!("../cases/records/{name}"))?;
    let text = std::fs::read_to_string(folder.join("test.toml")).unwrap();
    let text = text.replace("kind = \"accelerance\"\n", &format!("kind = \"accelerance\"\n{keys}\n"));
    let test = ImpactTest::from_toml(&text, folder.join("test.toml")).unwrap();
    let found = test.accelerances(Estimation::default()).unwrap_or_else(|error| panic!("{name}: {error}"));
    Some(found.into_iter().map(|(_, accelerance)| accelerance).collect())
}

/// The median over all lines of the error over the line's size.
fn error(found: &Accelerance, due: &Accelerance) -> f64 {
    assert_eq!(found.frequency.len(), due.frequency.len());
    let lines = found.value.iter().zip(&due.value).map(|(found, due)| (found - due).norm() / due.norm());
    let mut lines: Vec<f64> = lines.collect();
    lines.sort_by(f64::total_cmp);
    lines[lines.len() / 2]
}

#[test]
fn val_every_folder_holds_the_accelerances_of_one_panel() {
    let Some(due) = accelerances("f08_kHz", "") else { return };
    for (name, keys) in [
        ("f02e_nonode", ""),
        ("f16_runs", ""),
        ("f06c_164", ""),
        ("f04_mobility", ""),
        ("f05b_rec_0", "quantity = \"displacement\""),
    ] {
        let Some(found) = accelerances(name, keys) else { return };
        for (found, due) in found.iter().zip(&due) {
            // The second run of a pair was 5 % off.
            assert!(error(found, due) < 0.06, "{name}: {}", error(found, due));
        }
    }
}

/// One blow and three responses a blow, at the places of dataset 15: each measurement finds its own.
#[test]
fn val_a_file_of_several_responses_holds_the_same_accelerances() {
    let (Some(due), Some(found)) = (accelerances("f08_kHz", ""), accelerances("t01_multi", "")) else { return };
    assert_eq!(found.len(), 3);
    for (found, due) in found.iter().zip(&due) {
        let mut errors = Vec::new();
        for (frequency, value) in found.frequency.iter().zip(&found.value) {
            if let Some(line) = due.frequency.iter().position(|line| (line - frequency).abs() < 1e-6 * frequency) {
                errors.push((value - due.value[line]).norm() / due.value[line].norm());
            }
        }
        errors.sort_by(f64::total_cmp);
        assert!(
            errors.len() > 1000 && errors[errors.len() / 2] < 0.03,
            "{}: {}",
            errors.len(),
            errors[errors.len() / 2]
        );
    }
}

/// Five blows in one record are five hits.
#[test]
fn val_a_continuous_record_holds_its_hits() {
    let Some(found) = accelerances("t03_cont", "") else { return };
    let [found] = &found[..] else { panic!("{} accelerances", found.len()) };
    assert_eq!(found.hits, 5, "{:?}", found.notes);
    assert!(found.notes.iter().any(|note| note.contains("5 blows in one record of 9.90 s")), "{:?}", found.notes);
}

/// Receptances without type and unit are asked about, and mobilities; an accelerance is taken.
#[test]
fn val_what_tells_nothing_is_asked_about_by_its_slope() {
    let Some(folder) = measured("../cases/records/f05b_rec_0") else { return };
    let test = ImpactTest::read(&folder).unwrap();
    let said = test.accelerances(Estimation::default()).unwrap_err().to_string();
    assert!(said.contains("falls over frequency as a receptance does: is it one? declare quantity = \"displacement\" in its [[measurement]]"), "{said}");
}

/// Run 1 has a poor coherence, and so have other files' firsts: each response has its own.
#[test]
fn val_each_response_has_its_own_coherence() {
    for name in ["f16_runs", "f02e_nonode"] {
        let Some(found) = accelerances(name, "") else { return };
        let firsts: Vec<f64> = found.iter().map(|of| of.coherence.as_ref().unwrap()[100]).collect();
        assert!(firsts[0] != firsts[1] && firsts[1] != firsts[2], "{firsts:?}");
        let mean = |of: &Accelerance| of.coherence.as_ref().unwrap().iter().sum::<f64>() / of.frequency.len() as f64;
        assert!(found.iter().all(|of| mean(of) > 0.9), "{name}: {:?}", found.iter().map(mean).collect::<Vec<_>>());
    }
}
