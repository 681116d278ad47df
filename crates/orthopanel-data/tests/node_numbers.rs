//! Node numbers of universal files against the places of the test file.

use std::{fs, path::Path};

use crate::support::Dataset;
use orthopanel_data::{DataError, Estimation, ImpactTest};

/// One file: hammer's and sensor's node, and the places that the test file gives.
type Numbered = ([i64; 2], [f64; 2]);

fn accelerance([hammer, sensor]: [i64; 2], size: f64) -> Vec<u8> {
    let mut response = Dataset::time(&[], (12, "m/s^2"));
    (response.function, response.complex, response.denominator) = (4, true, (13, "N".into()));
    (response.response_node, response.reference_node) = (sensor, hammer);
    response.points = (0..8).map(|line| vec![size, 0.1 * f64::from(line)]).collect();
    response.text()
}

/// One record against time, at a node.
fn channel(node: i64, kind: i64, unit: &str, samples: &[f64]) -> Vec<u8> {
    let mut record = Dataset::time(samples, (kind, unit));
    record.response_node = node;
    record.text()
}

fn hit([hammer, sensor]: [i64; 2]) -> Vec<u8> {
    let mut force = [0.0; 32];
    (force[3], force[4]) = (50.0, 20.0);
    let ringing: Vec<f64> = (0..32).map(|n| f64::from(n).cos() * 0.9f64.powi(n)).collect();
    [channel(hammer, 13, "N", &force), channel(sensor, 12, "m/s^2", &ringing)].concat()
}

/// A test of files in a folder of its own.
fn test_of(name: &str, kind: &str, files: &[(Vec<u8>, [f64; 2])]) -> ImpactTest {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(&folder).unwrap();
    let mut text = "[piece]\nlength = 0.8\nwidth = 0.1\nthickness = 0.03\nmass_per_area = 6.88\n".to_owned();
    for (index, (bytes, [force, response])) in files.iter().enumerate() {
        fs::write(folder.join(format!("point-{index}.uff")), bytes).unwrap();
        text += &format!(
            "[[measurement]]\nkind = \"{kind}\"\nfile = \"point-{index}.uff\"\nforce_at = [{force}, 0.0]\n\
             response_at = [{response}, 0.0]\n"
        );
    }
    ImpactTest::from_toml(&text, folder.join("test.toml")).unwrap()
}

fn read(name: &str, of: &[Numbered]) -> Result<usize, DataError> {
    let files: Vec<_> =
        of.iter().zip(1..).map(|(&(nodes, places), n)| (accelerance(nodes, f64::from(n)), places)).collect();
    let test = test_of(name, "accelerance", &files);
    test.accelerances(Estimation::default()).map(|found| found.len())
}

#[test]
fn val_numbers_that_fit_the_places_are_taken() {
    let roving = [([1, 9], [-0.3, 0.3]), ([2, 9], [0.0, 0.3]), ([3, 9], [0.2, 0.3])];
    assert_eq!(read("roving", &roving).unwrap(), 3);
    // Numbers as they stood when the recorder was switched on; numbers that no one gave; a hammer that strays.
    assert_eq!(read("untouched", &[([1, 1], [-0.3, 0.3]), ([1, 1], [0.0, 0.3])]).unwrap(), 2);
    assert_eq!(read("untold", &[([0, 0], [-0.3, 0.3]), ([0, 2], [0.0, 0.3])]).unwrap(), 2);
    assert_eq!(read("stray", &[([1, 9], [-0.3, 0.3]), ([1, 9], [-0.302, 0.3]), ([2, 9], [0.0, 0.3])]).unwrap(), 3);
}

#[test]
fn val_one_node_at_two_places_is_refused_with_both() {
    let error = read("two-places", &[([1, 9], [-0.3, 0.3]), ([2, 9], [0.0, 0.3]), ([1, 9], [0.2, 0.3])]).unwrap_err();
    let DataError::Contradiction { at, problem } = &error else { panic!("{error}") };
    assert!(at.file.ends_with("point-2.uff"), "{error}");
    for part in ["hammer is at node 1", "(0.2, 0)", "(-0.3, 0)", "point-0.uff", "force_at"] {
        assert!(problem.contains(part), "{part}: {error}");
    }
    let error = read("sensor", &[([1, 8], [-0.3, 0.3]), ([1, 9], [-0.3, 0.2]), ([1, 9], [-0.3, 0.0])]).unwrap_err();
    assert!(error.to_string().contains("sensor is at node 9"), "{error}");
}

#[test]
fn val_a_record_that_is_listed_twice_is_refused_and_a_copy_is_told() {
    let same = accelerance([1, 9], 1.0);
    let copies = [(same.clone(), [-0.3, 0.3]), (same, [0.0, 0.3])];
    let test = test_of("copies", "accelerance", &copies);
    let found = test.accelerances(Estimation::default()).unwrap();
    assert!(found[1].1.notes.iter().any(|note| note.contains("is it a copy?")), "{:?}", found[1].1.notes);
    let mut twice = test_of("twice", "accelerance", &copies[..1]);
    twice.measurements.push(twice.measurements[0].clone());
    let error = twice.accelerances(Estimation::default()).unwrap_err().to_string();
    assert!(error.contains("point-0.uff") && error.contains("lists this record twice"), "{error}");
}

#[test]
fn val_hits_of_several_nodes_in_one_file_are_refused() {
    let one = |nodes: &[[i64; 2]]| nodes.iter().flat_map(|&nodes| hit(nodes)).collect::<Vec<u8>>();
    let test = test_of("one-place", "time-history", &[(one(&[[4, 9], [4, 9]]), [-0.3, 0.3])]);
    assert_eq!(test.time_histories().unwrap()[0].1.hits.len(), 2);
    let test = test_of("many-places", "time-history", &[(one(&[[4, 9], [5, 9]]), [-0.3, 0.3])]);
    let error = test.time_histories().unwrap_err().to_string();
    for part in ["record 3", "node 5", "record 1", "node 4", "a file of its own"] {
        assert!(error.contains(part), "{part}: {error}");
    }
}
