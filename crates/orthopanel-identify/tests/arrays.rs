//! Constants of records in memory, held against those of files with the same samples.

use std::path::Path;

use orthopanel_data::{Hit, ImpactTest, Measurement, MeasurementData, NamedPiece, RecordedResponse};
use orthopanel_identify::{IdentifyError, Settings, identify, trace};
use orthopanel_model::Place;

fn example() -> ImpactTest {
    ImpactTest::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/made-hits")).unwrap()
}

/// The example's piece with these hits as arrays.
fn of_arrays(hits: Vec<Hit>, rate: f64) -> ImpactTest {
    let (force, response) = hits.into_iter().map(|hit| (hit.force, hit.acceleration)).unzip();
    let places = [Place { x: -0.3, y: 0.0 }, Place { x: 0.3, y: 0.0 }];
    let hits = RecordedResponse::of_hits([force, response], rate, places).unwrap();
    let mut test = bare();
    test.add(Measurement { piece: 0, data: MeasurementData::TimeHistory(hits) }).unwrap();
    test
}

fn bare() -> ImpactTest {
    let pieces = vec![NamedPiece::new("1", example().pieces[0].piece)];
    ImpactTest { pieces, ..ImpactTest::default() }.checked().unwrap()
}

#[test]
fn val_arrays_give_the_constants_of_files_bit_for_bit() {
    let file = example();
    let (_, history) = file.time_histories().unwrap().remove(0);
    let arrays = of_arrays(history.hits, history.rate);
    let [of_file, of_arrays] = [&file, &arrays].map(|test| identify(test, Settings::default()).unwrap());
    assert_eq!(of_arrays.constants, of_file.constants);
    assert_eq!(of_arrays.correlations, of_file.correlations);
    assert_eq!(of_arrays.pieces, of_file.pieces);
    let [of_file, of_arrays] = [&file, &arrays].map(|test| trace(test).unwrap());
    let text = |of: &orthopanel_identify::Tracing| serde_json::to_string(of).unwrap();
    assert_eq!(text(&of_arrays), text(&of_file));
}

#[test]
fn hits_that_cannot_be_used_are_told_by_their_array() {
    let (_, history) = example().time_histories().unwrap().remove(0);
    let mut hits = history.hits;
    for hit in &mut hits {
        let most = 0.1 * hit.force.iter().copied().fold(0.0, f64::max);
        hit.force.iter_mut().for_each(|force| *force = force.min(most));
    }
    let found = identify(&of_arrays(hits, history.rate), Settings::default());
    let said = found.map(|found| found.constants).unwrap_err().to_string();
    let at = "records added at force_at = [-0.3, 0], response_at = [0.3, 0]: no hit can be used: hit 1 left out: ";
    assert!(said.contains(at), "{said}");
}

#[test]
fn a_test_without_measurements_is_refused() {
    let refused = identify(&bare(), Settings::default());
    assert!(matches!(refused, Err(IdentifyError::TooFewFrequencies { found: 0, .. })), "{refused:?}");
    let refused = trace(&bare()).unwrap_err();
    assert!(
        matches!(refused, IdentifyError::TooFewFrequencies { .. } | IdentifyError::TooFewResonances { .. }),
        "{refused:?}"
    );
}
