//! Tracing in files of accelerances, which hold no hits.

use std::fmt::Write as _;
use std::path::Path;

use crate::support::{made, shared_data};
use orthopanel_data::{Estimation, ImpactTest, MeasurementData, RecordedResponse};
use orthopanel_identify::{Settings, TracedEffect, Tracing, Verdict, identify, trace};
use orthopanel_model::Place;

fn parameter(effect: &TracedEffect, name: &str) -> Vec<(f64, f64)> {
    let found = effect.parameters.iter().find(|parameter| parameter.name == name).unwrap();
    found.values.iter().map(|value| (value.value, value.std.unwrap_or(0.0))).collect()
}

fn effect<'a>(found: &'a Tracing, id: &str) -> &'a TracedEffect {
    let ids: Vec<&str> = found.effects.iter().map(|effect| effect.id).collect();
    found.effects.iter().find(|effect| effect.id == id).unwrap_or_else(|| panic!("{id} is not among {ids:?}"))
}

/// The numbers of the note that holds these words.
fn numbers_of(found: &Tracing, words: &str) -> Vec<f64> {
    let note = found.notes.iter().find(|note| note.contains(words));
    let note = note.unwrap_or_else(|| panic!("{words}: {:?}", found.notes));
    note.split_whitespace().filter_map(|word| word.parse().ok()).collect()
}

/// Rms error of the natural frequencies \[%\], before and after, as a note tells it.
fn frequency_errors(found: &Tracing) -> (f64, f64) {
    let numbers = numbers_of(found, "natural frequencies");
    (numbers[1], numbers[2])
}

/// A real free beam: the gain of record 4 and hammer offsets between the resonances, a sensor's mass in the resonances,
/// which a sensor that never moves cannot prove.
#[test]
fn val_the_free_beam_shows_an_oblique_hit_and_hides_its_sensor() {
    let Some(folder) = shared_data("free_beam") else { return };
    let found = trace(&ImpactTest::read(folder.join("test.toml")).unwrap()).unwrap();
    assert_eq!(found.verdict, Verdict::Ambiguous);
    let ids: Vec<&str> = found.effects.iter().map(|effect| effect.id).collect();
    assert_eq!(ids[..2], ["record-gain", "hammer-offset"]);
    let gain = effect(&found, "record-gain");
    assert_eq!(parameter(gain, "record")[0].0, 4.0);
    let (value, std) = parameter(gain, "gain")[0];
    assert!((value - 0.83).abs() < 0.02 && std < 0.02, "gain {value} +- {std}");
    // "Off by up to 9 mm", as the data's own page says.
    assert!(parameter(effect(&found, "hammer-offset"), "offset").iter().all(|(offset, _)| offset.abs() < 9e-3));
    let (mass, std) = parameter(effect(&found, "sensor-mass"), "mass")[0];
    assert!((mass - 2.5e-3).abs() < 0.5e-3 && std < 0.5e-3, "sensor {mass} +- {std} kg");
    assert!(
        found.alternatives.iter().all(|id| id.starts_with("record-gain + hammer-offset")),
        "{:?}",
        found.alternatives
    );
    assert!(found.next_experiment.contains("sensor"), "{}", found.next_experiment);
    // The number of a record is no size that could end on a bound.
    assert!(!found.notes.iter().any(|note| note.contains("lies on its bound")), "{:?}", found.notes);
    let (before, after) = frequency_errors(&found);
    println!("natural frequencies: {before} % rms before, {after} % after");
    assert!((before - 0.012).abs() < 0.001 && after < 0.003, "{before} {after}");
    let error = &found.error;
    println!("between the peaks, neighbours averaged: {error:?}");
    assert!(error.after.fitted < 7.0 && error.after.held_out < 7.0 && error.before.fitted > 9.0, "{error:?}");
    let band = numbers_of(&found, "between the resonances");
    // From 20 Hz is asked; what a high-pass or a suspension does lies below, and is read with it.
    assert!(band[0] > 4.0 && band[0] < 20.0 && (band[1] - 1000.0).abs() < 5.0, "{band:?}");
    // 14.5 to 7 % or less is asked, without saying how lines are weighed. Each by the motion at its frequency, as above, that is met; as one
    // number for all lines it is missed by half a per cent.
    let one_number = numbers_of(&found, "as one number");
    println!("between the peaks, as one number: {one_number:?}");
    assert!((one_number[0] - 14.5).abs() < 1.0 && one_number[1] < 7.8, "{one_number:?}");
    // The floor is that of the lines between the resonances; what the model misses there is no noise.
    assert!(error.noise_floor < 2.0, "{error:?}");
    let scale = found.not_tested.iter().find(|not| not.id == "gain").unwrap();
    assert!(scale.reason.contains("calibrated"));
}

/// The accelerances of a made roving test, without its hits, in files of their own.
fn without_hits(test: &ImpactTest, folder: &Path) -> ImpactTest {
    let piece = test.pieces[0].piece;
    let mut toml = format!(
        "[piece]\nlength = {}\nwidth = {}\nthickness = {}\nmass_per_area = {}\n",
        piece.length, piece.width, piece.thickness, piece.mass_per_area
    );
    let at: Vec<f64> = test.suspension.iter().map(|place| place.x).collect();
    if !at.is_empty() {
        writeln!(toml, "[suspension]\nat = {at:?}").unwrap();
    }
    for (index, (_, record)) in test.accelerances(Estimation::default()).unwrap().iter().enumerate() {
        let lines = record.frequency.iter().zip(&record.value).map(|(f, h)| format!("{f},{},{}\n", h.re, h.im));
        let text = format!("frequency_hz,real,imag\n{}", lines.collect::<String>());
        std::fs::write(folder.join(format!("{index}.csv")), text).unwrap();
        let (force, response) = (record.force_at, record.response_at);
        write!(
            toml,
            "[[measurement]]\nkind = \"accelerance\"\nfile = \"{index}.csv\"\nforce_at = [{:?}, {:?}]\nresponse_at = [{:?}, {:?}]\n",
            force.x, force.y, response.x, response.y
        )
        .unwrap();
    }
    ImpactTest::from_toml(&toml, folder.join("test.toml")).unwrap()
}

#[test]
fn val_effects_put_in_are_found_without_the_hits() {
    for (kind, name) in [("record-gain", "gain"), ("sensor-mass", "mass")] {
        let folder = tempfile::tempdir().unwrap();
        let Some((test, case)) = made(&folder.path().join("set"), "clean", kind) else { return };
        let found = trace(&without_hits(&test, folder.path())).unwrap();
        let truth = case["effects"][0]["parameters"][name].as_f64().unwrap();
        let named = found.effects.iter().any(|effect| effect.id == kind)
            || found.alternatives.iter().any(|ids| ids.contains(kind));
        assert!(named, "{kind} = {truth}: {:?}, {:?}", found.effects, found.alternatives);
        let candidate = found.candidates.iter().find(|candidate| candidate.id.contains(kind)).unwrap();
        let own = candidate.effects.iter().find(|effect| effect.id == kind).unwrap();
        let (value, std) = parameter(own, name)[0];
        assert!((value - truth).abs() < 4.0 * std + 0.02 * truth, "{kind}: {value} +- {std}, truth {truth}");
        assert!(found.error.after.held_out < found.error.before.held_out, "{kind}: {:?}", found.error);
    }
}

/// What a curve's smooth misfit asks for is not there: the best name for it is a resonator of 25 Hz so damped that its ratio ends on
/// its bound, which was called `explained`.
#[test]
fn val_a_number_on_its_bound_explains_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let Some((test, _)) = made(&folder.path().join("set"), "none", "none") else { return };
    let found = trace(&without_hits(&test, folder.path())).unwrap();
    assert_ne!(found.verdict, Verdict::Explained, "{:?}", found.effects);
    let says = |text: &str| found.notes.iter().any(|note| note.contains(text));
    assert!(found.effects.is_empty() || says("lies on its bound"), "{:?}", found.notes);
}

fn records_of(test: &mut ImpactTest) -> impl Iterator<Item = &mut RecordedResponse> {
    test.measurements.iter_mut().filter_map(|measurement| match &mut measurement.data {
        MeasurementData::Accelerance(record) => Some(record),
        _ => None,
    })
}

/// The hits of each record stand at the place of the next one: no gain, offset or effect of the panel mends that, and the resonances,
/// which are right, tell nothing of it. As much as moves between them is missed, where a careful test misses 9 %.
#[test]
fn val_files_at_each_others_places_are_not_explained() {
    let folder = tempfile::tempdir().unwrap();
    let Some((test, _)) = made(&folder.path().join("set"), "none", "none") else { return };
    let test = without_hits(&test, folder.path());
    let mut moved = test.clone();
    let mut places: Vec<Place> = records_of(&mut moved).map(|record| record.force_at).collect();
    places.rotate_left(1);
    records_of(&mut moved).zip(places).for_each(|(record, place)| record.force_at = place);
    let found = trace(&moved).unwrap();
    assert_eq!((found.verdict, found.effects.len()), (Verdict::Unexplained, 0), "{:?}", found.effects);
    // What `identify` refuses is said first.
    let refused = identify(&moved, Settings::default()).unwrap_err();
    assert_eq!(found.notes[0], format!("identify refuses these records: {refused}"));
    assert!(found.error.before.fitted > 30.0, "{:?}", found.error);
    assert!(found.next_experiment.contains("check the places of hammer and sensor"), "{}", found.next_experiment);
    // Else all would be well: the resonances meet the model within their scatter.
    let resonances = numbers_of(&found, "natural frequencies");
    assert!(resonances[1] < 3.0 * resonances[3], "{:?}", found.notes);
}

#[test]
fn measurements_of_two_kinds_are_refused_with_the_way_out() {
    let text = "[piece]\nlength = 1.0\nwidth = 0.1\nthickness = 0.01\nmass_per_area = 5.0\n[[measurement]]\n\
                kind = \"natural-frequencies\"\nvalues = [30.0, 80.0, 150.0]\n[[measurement]]\nkind = \"accelerance\"\n\
                file = \"0.csv\"\nforce_at = [0.0, 0.0]\nresponse_at = [0.4, 0.0]\n";
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("0.csv"), "frequency_hz,real,imag\n1.0,1.0,0.0\n2.0,1.0,0.0\n").unwrap();
    let refused = trace(&ImpactTest::from_toml(text, folder.path().join("test.toml")).unwrap()).unwrap_err();
    assert!(refused.to_string().contains("one kind"), "{refused}");
}

#[test]
fn a_gain_of_a_record_that_the_test_has_not_is_refused_with_the_count() {
    let folder = tempfile::tempdir().unwrap();
    let of_record = |record: &str| {
        let mut text = "[piece]\nlength = 1.0\nwidth = 0.1\nthickness = 0.01\nmass_per_area = 5.0\n".to_owned();
        for place in [-0.4, 0.2] {
            write!(text, "[[measurement]]\nkind = \"accelerance\"\nfile = \"0.csv\"\nforce_at = [{place:?}, 0.0]\n")
                .unwrap();
            text += "response_at = [0.4, 0.0]\n";
        }
        text += &format!("[[effect]]\nid = \"record-gain\"\ngain = 1.1\nrecord = {record}\n");
        ImpactTest::from_toml(&text, folder.path().join("test.toml")).unwrap()
    };
    std::fs::write(folder.path().join("0.csv"), "frequency_hz,real,imag\n1.0,1.0,0.0\n2.0,1.0,0.0\n").unwrap();
    let test = of_record("3");
    for refused in [trace(&test).unwrap_err(), identify(&test, Settings::default()).unwrap_err()] {
        let said = refused.to_string();
        assert!(said.contains("record = 3") && said.contains("from 1 to 2"), "{said}");
    }
    // Two lines show no resonance; of the record nothing is said.
    let said = trace(&of_record("2")).unwrap_err().to_string();
    assert!(!said.contains("record = "), "{said}");
}
