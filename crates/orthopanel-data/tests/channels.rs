//! Channels: paired, put right by declared unit and direction, or refused.

use crate::support::{
    Dataset,
    hammer::{Noise, RATE},
    recorded::{DAMPED, good, history, measurement, pair},
};
use orthopanel_data::{Accelerance, Direction, Estimation, Hit, RecordFile, RecordedResponse, TimeHistory, Unit};

#[test]
fn val_pairs_are_found_whatever_their_order() {
    let [force, acceleration] = pair();
    for datasets in [[&force, &acceleration, &force, &acceleration], [&acceleration, &acceleration, &force, &force]] {
        let history = history(&datasets.map(Clone::clone), &measurement()).unwrap();
        assert_eq!((history.hits.len(), history.rate), (2, 1000.0));
        assert_eq!(history.hits[1], good());
        assert_eq!(history.notes, [""; 0]);
    }
    let untold = pair().map(|dataset| Dataset { numerator: (0, "NONE".into()), ..dataset });
    let history = history(&untold, &measurement()).unwrap();
    assert_eq!(history.hits[0], good());
    assert!(history.notes[0].contains("do not tell what they measure"), "{:?}", history.notes);
    assert!(history.notes[1].contains("unit of the acceleration not told"), "{:?}", history.notes);
}

#[test]
fn val_channels_that_do_not_fit_are_refused() {
    let [force, acceleration] = pair();
    let shorter = Dataset { points: acceleration.points[..900].to_vec(), ..acceleration.clone() };
    let faster = Dataset { even: Some(("0.00000e+00".into(), "5.00000e-04".into())), ..acceleration.clone() };
    let swapped = [(13, "N"), (12, "g")].map(|(kind, unit)| (kind, unit.to_owned()));
    let [as_force, as_acceleration] = swapped;
    let swapped_force = Dataset { numerator: as_force, ..acceleration.clone() };
    let swapped_acceleration = Dataset { numerator: as_acceleration, ..force.clone() };
    let stones = Dataset { numerator: (13, "stone".into()), ..force.clone() };
    let cases = [
        (vec![force.clone()], "1 force and 0 acceleration records against time"),
        (vec![force.clone(), shorter], "900 samples of acceleration, 1000 of force"),
        (vec![force.clone(), faster], "acceleration, sample 2: t = 0.0005 s, 0.001 s expected"),
        (vec![swapped_force, swapped_acceleration], "the channels are swapped"),
        (vec![stones, acceleration], "unit \"stone\" of the force is unknown"),
    ];
    for (datasets, said) in cases {
        let message = history(&datasets, &measurement()).unwrap_err();
        assert!(message.starts_with("hits.uff, byte "), "{message}");
        assert!(message.contains(said), "\n  said   {message}\n  wanted {said}");
    }
}

#[test]
fn val_a_record_without_its_partner_is_named() {
    let [f, a] = pair();
    let cases = [
        (vec![&f, &a, &f, &f, &a], "record 3", "this force has no acceleration"),
        (vec![&f, &a, &f, &a, &f], "record 5", "this force has no acceleration"),
        (vec![&a, &f, &a, &a, &f, &a, &f], "record 3", "this acceleration has no force"),
        (vec![&f, &f, &f, &a, &a], "record 3", "this force has no acceleration"),
        (vec![&f, &f, &a, &a, &a], "record 5", "this acceleration has no force"),
        (vec![&a], "record 1", "this acceleration has no force"),
    ];
    for (datasets, record, said) in cases {
        let datasets: Vec<Dataset> = datasets.into_iter().cloned().collect();
        let message = history(&datasets, &measurement()).unwrap_err();
        assert!(message.contains(record) && message.contains(said), "{record}, {said}: {message}");
    }
}

#[test]
fn val_a_sensor_that_is_not_along_the_force_is_refused_unless_declared() {
    let [force, acceleration] = pair();
    let along = Some(Direction::AlongForce);
    for (direction, said) in
        [(1, "direction 1 of the motion is along x"), (-2, "direction -2 of the motion is along y")]
    {
        let turned = Dataset { response_direction: direction, ..acceleration.clone() };
        let refused = history(&[force.clone(), turned.clone()], &measurement()).unwrap_err();
        assert!(refused.contains(said) && refused.contains("record 2"), "{refused}");
        assert!(refused.contains("declare direction = 1 (or -1, turned round)"), "{refused}");
        let declared = RecordedResponse { direction: along, ..measurement() };
        let taken = history(&[force.clone(), turned], &declared).unwrap();
        assert_eq!(taken.hits[0], good());
        assert!(taken.notes.iter().any(|note| note.contains("taken as the test file declares")), "{:?}", taken.notes);
    }
    let rotation = Dataset { response_direction: 5, ..acceleration };
    let declared = RecordedResponse { direction: along, ..measurement() };
    assert!(history(&[force, rotation], &declared).unwrap_err().contains("direction 5 of the motion is a rotation"));
}

#[test]
fn val_unit_and_direction_are_put_right_and_said() {
    let [force, acceleration] = pair();
    let in_g = Dataset { numerator: (12, "g".into()), ..acceleration.clone() };
    let untold = Dataset { numerator: (12, "NONE".into()), ..acceleration.clone() };
    let opposite = Dataset { response_direction: -3, ..acceleration.clone() };
    let g = Unit::parse("g");
    let (along, against) = (Some(Direction::AlongForce), Some(Direction::AgainstForce));
    let cases = [
        (&in_g, None, None, 9.80665, "brought from g"),
        (&in_g, g.clone(), None, 9.80665, "brought from g"),
        (&untold, g.clone(), None, 9.80665, "brought from g"),
        (&acceleration, None, against, -1.0, "turned round, as the test file declares"),
        (&opposite, None, None, -1.0, "opposite directions (-3 and 3): turned round"),
        (&opposite, None, against, -1.0, "turned round, as the test file declares"),
        (&opposite, None, along, 1.0, "declares 1: not turned round"),
    ];
    for (record, unit, direction, factor, said) in cases {
        let declared = RecordedResponse { response_unit: unit, direction, ..measurement() };
        let history = history(&[force.clone(), record.clone()], &declared).unwrap();
        assert_eq!(history.hits[0].acceleration[210], factor * good().acceleration[210], "{said}");
        assert!(history.notes.iter().any(|note| note.contains(said)), "{said}: {:?}", history.notes);
    }
    let contradicted = history(&[force.clone(), acceleration], &RecordedResponse { response_unit: g, ..measurement() });
    assert!(contradicted.unwrap_err().contains("is in \"m/s^2\", the test file declares another unit"));
    let volts = Dataset { numerator: (12, "mV".into()), ..in_g };
    assert!(
        history(&[force, volts], &measurement())
            .unwrap_err()
            .contains("the acceleration is in volts (\"mV\"): give response_sens")
    );
}

#[test]
fn val_csv_in_g_is_told_by_its_column_or_by_the_test_file() {
    let csv = |column: &str| {
        let hit = good();
        let rows = hit.force.iter().zip(&hit.acceleration).enumerate();
        let rows: String = rows.map(|(n, (f, a))| format!("{},{f},{a}\n", n as f64 / RATE)).collect();
        RecordFile::from_bytes(format!("time_s,force_n,{column}\n{rows}").as_bytes(), "a.csv").unwrap()
    };
    let in_g = TimeHistory::from_records(csv("acceleration_g"), &measurement()).unwrap();
    assert_eq!(in_g.hits[0].acceleration[210], 9.80665 * good().acceleration[210]);
    assert!(in_g.notes.iter().any(|note| note.contains("brought from g")), "{:?}", in_g.notes);
    let declared = RecordedResponse { response_unit: Unit::parse("g"), ..measurement() };
    assert!(TimeHistory::from_records(csv("acceleration_m_s2"), &declared).is_err());
    let file = RecordFile::from_bytes(b"frequency_hz,real,imag\n1,2,0\n", "a.csv").unwrap();
    assert_eq!(Accelerance::from_records(file, &declared).unwrap().value[0].re, 2.0 * 9.80665);
}

/// Messages on a CSV name its line, comments and blank lines counted.
#[test]
fn val_what_does_not_fit_in_a_csv_is_told_with_its_line() {
    let measured = |text: &str| RecordFile::from_bytes(text.as_bytes(), "a.csv").unwrap();
    let accelerance = |text: &str| Accelerance::from_records(measured(text), &measurement()).unwrap_err().to_string();
    let said = accelerance("# comment\n\nfrequency_hz,real,imag,coherence\n1,2,3,1\n2,3,4,1.5\n");
    assert!(said.starts_with("a.csv:5: coherence: coherence 1.5 at point 2"), "{said}");
    let gap = |gap: usize| {
        let hit = good();
        let row = |n: usize| format!("{},{},{}\n", n as f64 / RATE, hit.force[n], hit.acceleration[n]);
        let rows: String = (0..1000).filter(|&n| n != gap).map(row).collect();
        let file = measured(&format!("# comment\ntime_s,force_n,acceleration_m_s2\n{rows}"));
        TimeHistory::from_records(file, &measurement()).unwrap_err().to_string()
    };
    // Sample 501 is gone: the row after it stands in its line. The mean step is a thousandth longer for the gap.
    assert!(gap(500).starts_with("a.csv:") && gap(500).contains("force and acceleration need the same even times"));
    let swapped = hit_csv_swapped();
    let said = TimeHistory::from_records(measured(&swapped), &measurement()).unwrap_err().to_string();
    assert!(said.starts_with("a.csv:1: force_n: the force lasts longer"), "{said}");
}

fn hit_csv_swapped() -> String {
    let hit = good();
    let rows = hit.force.iter().zip(&hit.acceleration).enumerate();
    let rows: String = rows.map(|(n, (f, a))| format!("{},{a},{f}\n", n as f64 / RATE)).collect();
    format!("time_s,force_n,acceleration_m_s2\n{rows}")
}

/// Samples that stand further apart than a blow lasts may miss it: then the force's channel holds less than the response does, and
/// the sampling rate is named beside the swapped channels.
#[test]
fn val_a_blow_between_two_samples_is_told_with_the_rate() {
    let swings =
        |n: usize, sign: f64, count: usize| if (20..20 + count).contains(&n) { sign.powi(n as i32) } else { 0.0 };
    for (rate, said) in [(410.0, true), (16384.0, false)] {
        let row =
            |n: usize| format!("{},{},{}\n", n as f64 / rate, 0.1 * swings(n, -1.0, 14), 300.0 * swings(n, 1.0, 6));
        let rows: String = (0..400).map(row).collect();
        let file =
            RecordFile::from_bytes(format!("time_s,force_n,acceleration_m_s2\n{rows}").as_bytes(), "a.csv").unwrap();
        let refused = TimeHistory::from_records(file, &measurement()).unwrap_err().to_string();
        assert!(refused.contains("the channels are swapped"), "{refused}");
        let told = refused.contains("at 410.0 Hz the blow fell between two samples, which stand 2.4 ms apart");
        assert_eq!(told, said, "{refused}");
    }
}

/// Writes a hit as CSV, and returns the `[[measurement]]` that names it.
fn csv_measurement(folder: &std::path::Path, name: &str, samples: usize) -> String {
    let hit = good();
    let rows = hit.force.iter().zip(&hit.acceleration).take(samples).enumerate();
    // No two hits are equally hard.
    let by = f64::from(name.as_bytes()[0]);
    let rows: String =
        rows.map(|(n, (force, motion))| format!("{},{},{}\n", n as f64 / RATE, by * force, by * motion)).collect();
    std::fs::write(folder.join(name), format!("time_s,force_n,acceleration_m_s2\n{rows}")).unwrap();
    format!("[[measurement]]\nkind = \"time-history\"\nfile = \"{name}\"\nforce_at = [0, 0]\nresponse_at = [0.1, 0]\n")
}

#[test]
fn val_hits_of_the_same_places_are_put_together() {
    let folder = tempfile::tempdir().unwrap();
    let piece = "[piece]\nlength = 1\nwidth = 1\nthickness = 0.01\nmass_per_area = 1\n";
    let [one, two, short, other] = [("a.csv", 1000), ("b.csv", 1000), ("c.csv", 900), ("d.csv", 1000)]
        .map(|(name, samples)| csv_measurement(folder.path(), name, samples));
    let elsewhere = other.replace("[0.1, 0]", "[0.2, 0]");
    let read = |measurements: &[&str]| {
        let text = format!("{piece}{}", measurements.concat());
        let test = orthopanel_data::ImpactTest::from_toml(&text, folder.path().join("test.toml")).unwrap();
        test.accelerances(orthopanel_data::Estimation::default())
    };
    let found = read(&[&one, &elsewhere, &two]).unwrap();
    assert_eq!(found.iter().map(|(_, accelerance)| accelerance.hits).collect::<Vec<_>>(), [2, 1]);
    assert_eq!((found[0].0, found[1].1.response_at.x), (0, 0.2));
    let message = read(&[&one, &short]).unwrap_err().to_string();
    assert!(message.contains("c.csv: 900 samples at 1000"), "{message}");
}

/// As many forces as accelerations, but one hit has lost its response and another one was written with two: behind it every
/// pair would be of two hits.
#[test]
fn val_channels_that_balance_but_do_not_pair_are_refused() {
    let [force, acceleration] = pair();
    let louder = |by: f64, of: &Dataset| Dataset {
        points: of.points.iter().map(|point| point.iter().map(|value| by * value).collect()).collect(),
        ..of.clone()
    };
    let (force_2, acceleration_3) = (louder(1.1, &force), louder(1.3, &acceleration));
    let order = [&force, &acceleration, &force_2, &force, &acceleration_3, &acceleration].map(Dataset::clone);
    let refused = history(&order, &measurement()).unwrap_err();
    let said = "record 4: a second force where the acceleration of hit 2 is due, though there are as many of either";
    assert!(refused.contains(said), "{refused}");
    for kept in [[&force, &acceleration, &acceleration, &force], [&force, &force_2, &acceleration, &acceleration_3]] {
        assert_eq!(history(&kept.map(Dataset::clone), &measurement()).unwrap().hits.len(), 2);
    }
}

/// One channel stands for both: as numbers, whatever unit is said.
#[test]
fn val_one_channel_in_place_of_both_is_refused() {
    let [force, acceleration] = pair();
    for (as_force, as_motion) in [(&force, &force), (&acceleration, &acceleration)] {
        let points = |of: &Dataset| of.points.iter().map(|point| point[0]).collect::<Vec<f64>>();
        let twice = [Dataset::time(&points(as_force), (13, "N")), Dataset::time(&points(as_motion), (12, "g"))];
        let refused = history(&twice, &measurement()).unwrap_err();
        assert!(refused.contains("record 2") && refused.contains("sample for sample"), "{refused}");
        assert!(refused.contains("the force times 1.000000"), "{refused}");
    }
}

/// A channel without type and unit beside one that is told is the other; one of another type is named.
#[test]
fn val_an_untold_channel_beside_a_told_one_is_the_other() {
    let [force, motion] = pair();
    let untold = |dataset: &Dataset| Dataset { numerator: (0, "NONE".into()), ..dataset.clone() };
    let truth = history(&[force.clone(), motion.clone()], &measurement()).unwrap();
    for (pair, name) in
        [([force.clone(), untold(&motion)], "acceleration"), ([untold(&force), motion.clone()], "force")]
    {
        let found = history(&pair, &measurement()).unwrap();
        assert_eq!(found.hits, truth.hits);
        let note = format!("tells neither type nor unit, taken as {name}");
        assert!(found.notes.iter().any(|said| said.contains(&note)), "{:?}", found.notes);
    }
    let strain = Dataset { numerator: (3, "1".into()), ..motion };
    let refused = history(&[force, strain], &measurement()).unwrap_err();
    assert!(refused.contains("(record 2: data type 3 (strain) is neither force nor motion"), "{refused}");
}

/// A hit that stands twice counts once.
#[test]
fn val_a_copy_of_a_hit_is_left_out() {
    let other = Noise(4).over(&DAMPED.soft_hit(1000, 80.0), 0.01, 0.01);
    let of = |hit: &Hit| [Dataset::time(&hit.force, (13, "N")), Dataset::time(&hit.acceleration, (12, "m/s^2"))];
    let [first, second] = [good(), other].map(|hit| of(&hit));
    let twice = history(&[first.clone(), second.clone(), first.clone()].concat(), &measurement()).unwrap();
    let once = history(&[first, second].concat(), &measurement()).unwrap();
    let [twice, once] = [twice, once].map(|history| history.accelerance(Estimation::default()).unwrap());
    assert_eq!((twice.hits, &twice.value, &twice.variance), (2, &once.value, &once.variance));
    assert!(
        twice.notes.iter().any(|note| note.contains("hit 3 left out: sample by sample hit 1 again")),
        "{:?}",
        twice.notes
    );
}
