//! Effects that a test file declares, through records: they belong to the base model, and what is missing beside them is
//! still found.
//!
//! The records come from `tests/blind_tracing`, which shares no code with the crates.

use std::path::Path;

use crate::support::made;
use orthopanel_data::ImpactTest;
use orthopanel_identify::{Tracing, Verdict, trace};
use serde_json::Value;

/// The made test of a set and kind with its effect `id` declared as it was put in, and the truth.
fn declared(folder: &Path, (set, kind): (&str, &str), id: &str) -> Option<(Tracing, Value)> {
    let (_, case) = made(folder, set, kind)?;
    let effects = case["effects"].as_array().unwrap();
    let parameters = &effects.iter().find(|effect| effect["id"] == id).unwrap()["parameters"];
    let told: String =
        parameters.as_object().unwrap().iter().map(|(name, value)| format!("{name} = {value}\n")).collect();
    let file = folder.join(case["case"].as_str().unwrap()).join("test.toml");
    let text = std::fs::read_to_string(&file).unwrap() + &format!("\n[[effect]]\nid = \"{id}\"\n{told}");
    std::fs::write(&file, text).unwrap();
    Some((trace(&ImpactTest::read(&file).unwrap()).unwrap(), case))
}

#[test]
fn val_with_its_sensor_declared_nothing_is_missing() {
    let folder = tempfile::tempdir().unwrap();
    let Some((found, _)) = declared(&folder.path().join("set"), ("clean", "sensor-mass"), "sensor-mass") else {
        return;
    };
    assert_eq!((found.verdict, found.effects.len()), (Verdict::NothingMissing, 0), "{:?}", found.effects);
    assert!(found.candidates.iter().all(|candidate| !candidate.id.contains("sensor-mass")));
    // Declared, and still the rig's: the panel's model does not carry it.
    assert_eq!((found.removed.len(), found.removed[0].id), (1, "sensor-mass"));
    assert!(found.removed[0].why.contains("declared") && found.panels[0].effects.is_empty());
}

#[test]
fn val_what_is_missing_beside_a_declared_sensor_is_named_and_measured() {
    let folder = tempfile::tempdir().unwrap();
    let pair = ("pairs", "local-mass + sensor-mass");
    let Some((found, case)) = declared(&folder.path().join("set"), pair, "sensor-mass") else { return };
    assert!(matches!(found.verdict, Verdict::Explained | Verdict::Ambiguous), "{}", found.verdict.name());
    let ids: Vec<&str> = found.effects.iter().map(|effect| effect.id).collect();
    assert_eq!(ids, ["local-mass"]);
    let effects = case["effects"].as_array().unwrap();
    let truth = &effects.iter().find(|effect| effect["id"] == "local-mass").unwrap()["parameters"];
    for parameter in &found.effects[0].parameters {
        let (truth, value) = (truth[parameter.name].as_f64().unwrap(), parameter.values[0]);
        // Five standard deviations: the generator's own solution may differ by a small part of the noise.
        assert!(
            (value.value - truth).abs() < 5.0 * value.std.unwrap() + 1e-4,
            "{}: {value:?}, {truth}",
            parameter.name
        );
    }
    // Mass of the panel stays in its model, the sensor does not.
    assert_eq!((found.panels[0].effects.len(), found.removed.len()), (1, 1));
}

/// The hits of `examples/made-hits`, in which nothing is missing, with something declared.
fn made_hits(declared: &str) -> Result<Tracing, String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/made-hits");
    let text = std::fs::read_to_string(folder.join("test.toml")).unwrap() + declared;
    let test = ImpactTest::from_toml(&text, folder.join("test.toml")).unwrap();
    trace(&test).map_err(|error| error.to_string())
}

/// A core whose three numbers are open was left at its first start, and an edge mass of half a milligram stood beside it.
#[test]
fn val_open_numbers_of_a_declared_effect_are_searched_as_closely_as_a_rival() {
    let found = made_hits("[[effect]]\nid = \"viscoelastic-core\"\n").unwrap();
    assert_eq!((found.verdict, found.effects.len()), (Verdict::NothingMissing, 0), "{:?}", found.effects);
    assert!(found.error.before.fitted < 1.1, "{:?}", found.error);
}

#[test]
fn val_a_declared_number_that_is_wrong_is_doubted_with_the_right_one() {
    let found = made_hits("[[effect]]\nid = \"gain\"\ngain = 1.05\n").unwrap();
    assert_eq!(found.verdict, Verdict::Unexplained, "{:?}", found.effects);
    let doubt = found.notes.iter().find(|note| note.contains("the declared gain may have a wrong number"));
    let doubt = doubt.unwrap_or_else(|| panic!("{:?}", found.notes));
    let (_, told) = doubt.split_once("gain = ").unwrap_or_else(|| panic!("{doubt}"));
    let told: f64 = told.split(' ').next().and_then(|number| number.parse().ok()).unwrap_or_else(|| panic!("{doubt}"));
    assert!((told - 1.0).abs() < 1e-3 && doubt.contains("in place of 1.0500e0"), "{doubt}");
    assert!(found.next_experiment.contains("the numbers of what is declared (gain)"), "{}", found.next_experiment);
}

/// The sensor of the hits has no mass. 5 g that the file puts there came back as -5 g of the panel, `explained`, and in its model: one record
/// does not tell them clearly from the error of a sound model, and that they are likelier is said.
#[test]
fn val_a_declared_mass_that_is_wrong_is_not_undone_by_the_panel() {
    let found = made_hits("[[effect]]\nid = \"sensor-mass\"\nmass = 0.005\n").unwrap();
    assert_eq!((found.verdict, found.effects.len()), (Verdict::Ambiguous, 0), "{:?}", found.effects);
    assert!(found.alternatives.contains(&"local-mass".to_owned()), "{:?}", found.alternatives);
    assert!(found.panels[0].effects.is_empty(), "{:?}", found.panels[0].effects);
    let rival = found.candidates.iter().find(|candidate| candidate.id == "local-mass").unwrap();
    let mass = rival.effects[0].parameters[0].values[0].value;
    assert!((mass + 0.005).abs() < 5e-4, "{mass}");
}

#[test]
fn a_gain_is_told_to_be_what_a_wrong_mass_makes_too() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/made-hits");
    let text = std::fs::read_to_string(folder.join("test.toml")).unwrap();
    let heavy = text.replace("mass_per_area = 6.88", "mass_per_area = 7.5");
    assert_ne!(heavy, text);
    let found = trace(&ImpactTest::from_toml(&heavy, folder.join("test.toml")).unwrap()).unwrap();
    let gain = found.effects[0].parameters[0].values[0].value;
    assert!(found.effects[0].id == "gain" && (gain - 7.5 / 6.88).abs() < 2e-3, "{:?}", found.effects);
    assert!(found.notes.iter().any(|note| note.contains("mass_per_area = 6.88")), "{:?}", found.notes);
}

/// This was told as records that show no resonance.
#[test]
fn an_effect_that_cannot_act_is_refused_with_what_it_needs() {
    let refused = made_hits("[[effect]]\nid = \"support-compliance\"\n").unwrap_err();
    assert!(refused.contains("needs an edge that is clamped"), "{refused}");
}
