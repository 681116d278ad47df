//! What a record leaves open is asked about, with the line of the test file that answers it.

use orthopanel_data::{
    Accelerance, ChannelName, Hit, ImpactTest, Motion, RecordFile, RecordedResponse, TimeHistory, Trigger, Unit,
};

use crate::support::{
    Dataset,
    hammer::{Noise, RATE},
    recorded::{DAMPED, good, history, measurement, pair, records},
};

fn response(numerator: (i64, &str), denominator: (i64, &str)) -> Dataset {
    Dataset {
        function: 4,
        complex: true,
        numerator: (numerator.0, numerator.1.into()),
        denominator: (denominator.0, denominator.1.into()),
        points: (0..5).map(|line| vec![1.0, f64::from(line)]).collect(),
        ..Dataset::time(&[], (12, ""))
    }
}

fn accelerance(file: RecordFile, declared: &RecordedResponse) -> Result<Accelerance, String> {
    Accelerance::from_records(file, declared).map_err(|error| error.to_string())
}

#[test]
fn val_units_that_contradict_each_other_are_asked_about() {
    let unit = |text: &str| RecordedResponse { response_unit: Unit::parse(text), ..measurement() };
    let velocity = RecordedResponse { quantity: Some(Motion::Velocity), ..measurement() };
    let cases = [
        (
            response((12, "mm/s"), (13, "N")),
            measurement(),
            "is a unit of velocity, and the record is taken as acceleration: declare quantity",
        ),
        (
            response((12, "m/s2"), (13, "N")),
            unit("mm/s"),
            "response_unit = \"mm/s\" is a unit of velocity: correct it, or where",
        ),
        (
            response((12, "m/s2"), (13, "N")),
            unit("g"),
            "in \"m/s2\", the test file declares another unit, g: correct or drop `response_unit`",
        ),
        (
            response((12, "m/s2"), (13, "furlong")),
            measurement(),
            "unit \"furlong\" of the force is unknown: where it is N, or another",
        ),
        (response((12, "m/s2/N"), (13, "N")), unit("g"), "is in \"m/s2/N\", the test file declares another unit"),
        (
            response((12, "V"), (13, "N")),
            measurement(),
            "the acceleration is in volts (\"V\"): give response_sensitivity = V a m/s2",
        ),
        (
            response((12, "m/s2"), (13, "mV")),
            measurement(),
            "the force is in volts (\"mV\"): give force_sensitivity = V a N",
        ),
        (response((12, "m/s2"), (13, "N")), velocity, "is a unit of acceleration, and the record is taken as velocity"),
    ];
    for (dataset, declared, said) in cases {
        let message = accelerance(records(&[dataset]), &declared).unwrap_err();
        assert!(message.starts_with("hits.uff, byte 7: record 1: ") && message.contains(said), "{said}\n{message}");
    }
    let calibrated = RecordedResponse { response_sensitivity: Some(0.01), ..measurement() };
    let message = accelerance(records(&[response((12, "g"), (13, "N"))]), &calibrated).unwrap_err();
    assert!(message.contains("the acceleration is in \"g\", not in volts: drop response_sensitivity"), "{message}");
}

/// Inches by dataset 164, metres by the label: only the person who measured knows.
#[test]
fn val_a_label_against_dataset_164_is_asked_about() {
    let units = "    -1\n   164\n         7IN: Inch (pound f)           2\n   3.9370078740157480D+01   2.2480894309971047D-01   1.0D+00\n   2.7315D+02\n    -1\n";
    let file = |numerator, denominator| {
        let bytes = [units.as_bytes(), &response(numerator, denominator).text()].concat();
        RecordFile::from_bytes(&bytes, "hits.uff").unwrap()
    };
    let message = accelerance(file((12, "m/s2"), (13, "N")), &measurement()).unwrap_err();
    assert!(
        message.contains("in \"m/s2\" by its label, and in \"IN: Inch (pound f)\", a unit of length of 0.0254 m/s2"),
        "{message}"
    );
    assert!(message.contains("declare which by response_unit = \"m/s2\""), "{message}");
    let [response_unit, force_unit] = ["m/s2", "N"].map(Unit::parse);
    let declared = RecordedResponse { response_unit, force_unit, ..measurement() };
    assert_eq!(accelerance(file((12, "m/s2"), (13, "N")), &declared).unwrap().value[0].re, 1.0);
    let broken =
        [b"    -1\n   164\n        99?\n   no factors\n    -1\n", &response((12, "g"), (13, "N")).text()[..]].concat();
    let message = RecordFile::from_bytes(&broken, "hits.uff").unwrap_err().to_string();
    assert!(message.contains("dataset 164: the factors of length and force expected"), "{message}");
    let cut = RecordFile::from_bytes(b"    -1\n   164\n", "hits.uff").unwrap_err().to_string();
    assert!(cut.contains("the dataset ends"), "{cut}");
}

/// A coherence that may belong to either response belongs to none, and that is said.
#[test]
fn val_a_coherence_that_cannot_be_paired_is_left_out_and_said() {
    let response = response((12, "m/s2"), (13, "N"));
    let coherence = Dataset { function: 6, ..Dataset::time(&[0.5; 5], (0, "NONE")) };
    let elsewhere = Dataset { response_node: 99, ..coherence.clone() };
    let of = |datasets: &[&Dataset], record| {
        let datasets: Vec<Dataset> = datasets.iter().map(|dataset| (*dataset).clone()).collect();
        accelerance(records(&datasets), &RecordedResponse { record, ..measurement() }).unwrap()
    };
    let between = of(&[&response, &coherence, &response], Some(1));
    assert!(between.coherence.is_none());
    let said = "left without coherence: 1 of the file may belong to 2 frequency responses";
    assert!(between.notes.iter().any(|note| note.contains(said)), "{:?}", between.notes);
    let other = of(&[&response, &elsewhere], None);
    assert!(
        other.coherence.is_none() && !other.notes.iter().any(|note| note.contains("coherence")),
        "{:?}",
        other.notes
    );
    assert!(of(&[&response, &coherence, &response, &response, &coherence], Some(4)).coherence.is_some());
    assert!(of(&[&response, &coherence, &response, &response, &coherence], Some(3)).coherence.is_none());
}

fn csv(time: impl Fn(usize) -> String, keep: impl Fn(&usize) -> bool) -> Result<TimeHistory, String> {
    with_rate(time, keep, None)
}

fn with_rate(
    time: impl Fn(usize) -> String,
    keep: impl Fn(&usize) -> bool,
    sampling_rate: Option<f64>,
) -> Result<TimeHistory, String> {
    let hit = good();
    let row = |n: usize| format!("{},{},{}\n", time(n), hit.force[n], hit.acceleration[n]);
    let rows: String = (0..hit.force.len()).filter(keep).map(row).collect();
    let file = RecordFile::from_bytes(format!("time_s,force_n,acceleration_m_s2\n{rows}").as_bytes(), "a.csv").unwrap();
    TimeHistory::from_records(file, &RecordedResponse { sampling_rate, ..measurement() })
        .map_err(|error| error.to_string())
}

#[test]
fn val_a_sampling_rate_that_no_hammer_test_has_is_asked_about() {
    let said = csv(|n| format!("{n}"), |_| true).unwrap_err();
    assert!(said.contains("sampled at 1.000 Hz, where hammer tests are at 100 to"), "{said}");
    assert!(said.contains("are its times in ms? declare sampling_rate = 1000 in its [[measurement]]"), "{said}");
    assert_eq!(with_rate(|n| format!("{n}"), |_| true, Some(RATE)).unwrap().rate, RATE);
    let said = csv(|n| format!("{}", 20 * n), |_| true).unwrap_err();
    assert!(said.contains("are its times in µs? declare sampling_rate = 50000"), "{said}");
}

/// Rounded times are even, whatever repeats among them; their notes tell it where a step is lost.
#[test]
fn val_rounded_times_are_read_on_the_grid_that_they_round() {
    for (digits, rate) in [(5, 12800.0), (5, 20480.0), (5, 25600.0), (6, 44100.0)] {
        let found = csv(|n| format!("{:.digits$}", n as f64 / rate), |_| true).unwrap();
        assert!((found.rate / rate - 1.0).abs() < 1e-12, "{digits} {rate}: {}", found.rate);
        let told = found.notes.iter().any(|note| note.contains("the times are rounded to"));
        assert_eq!(told, digits == 5, "{digits}: {:?}", found.notes);
    }
    // A thousand samples of 0.05 s in all: 20500 Hz would do as well.
    let said = csv(|n| format!("{:.3}", n as f64 / 20480.0), |_| true).unwrap_err();
    assert!(said.contains("the times are rounded to 0.001 s, and so few tell the sampling rate to 0."), "{said}");
    assert!(said.contains("or declare it, such as sampling_rate = 20500, in its [[measurement]]"), "{said}");
}

#[test]
fn val_uneven_times_are_refused_with_what_mends_them() {
    let even = |n: usize| n as f64 / RATE;
    let refused = |said: &str, found: Result<TimeHistory, String>| {
        let message = found.unwrap_err();
        assert!(message.starts_with("a.csv:") && message.contains(said), "{said}\n{message}");
        assert!(!message.contains("sort the rows"), "{message}");
    };
    refused(
        "or resample both onto even times; where the column of times alone is wrong",
        csv(|n| format!("{}", even(n) * (1.0 + even(n))), |_| true),
    );
    refused("samples are missing or stand twice", csv(|n| format!("{}", even(n)), |n| !(500..520).contains(n)));
    refused("the times begin anew, or rows are out of order", csv(|n| format!("{}", even(n % 500)), |_| true));
    refused("a time step of 0 s makes no sampling rate", csv(|_| "0.5".into(), |_| true));
    assert_eq!(with_rate(|n| format!("{}", even(n % 500)), |_| true, Some(RATE)).unwrap().rate, RATE);
}

/// A window is told by its time constant; what no window leaves, or another file's column contradicts, is refused.
#[test]
fn val_a_declared_window_is_taken_out_or_refused() {
    let declared = |tau| RecordedResponse { window_decay: Some(tau), ..measurement() };
    let line = accelerance(records(&[response((12, "m/s2"), (13, "N"))]), &declared(0.25)).unwrap();
    assert_eq!(line.decay_rate, 4.0);
    let column = |tau| {
        let file =
            RecordFile::from_bytes(b"frequency_hz,real,imag,decay_rate_1_s\n1,2,3,4\n2,3,4,4\n", "a.csv").unwrap();
        accelerance(file, &declared(tau))
    };
    assert_eq!(column(0.25).unwrap().decay_rate, 4.0);
    assert!(column(0.5).unwrap_err().contains("decay rate 4 1/s, and window_decay = 0.5 s declares 2 1/s"));
    let [force, motion] = pair();
    let message = history(&[force, motion], &declared(0.01)).unwrap_err();
    assert!(message.contains("window_decay = 0.01 s leaves e^-100.0 of the record's end, after 1.0000 s"), "{message}");
}

#[test]
fn val_the_keys_of_channels_are_checked_with_their_line() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.uff"), "").unwrap();
    let read = |kind: &str, keys: &str| {
        let text = format!(
            "[piece]\nlength = 1\nwidth = 0.1\nthickness = 0.02\nmass_per_area = 5\n[[measurement]]\nkind = \"{kind}\"\nfile = \"a.uff\"\n\
             force_at = [0, 0]\nresponse_at = [0.1, 0]\n{keys}\n"
        );
        ImpactTest::from_toml(&text, folder.path().join("test.toml")).map_err(|error| error.to_string())
    };
    read("time-history", "response_unit = \"in/s\"\nforce_unit = \"lbf\"\nquantity = \"velocity\"\nsampling_rate = 25600\nwindow_decay = 0.3").unwrap();
    read("accelerance", "response_sensitivity = 0.01\nforce_sensitivity = 2e-3\nwindow_decay = 0.3").unwrap();
    for (kind, keys, said) in [
        (
            "accelerance",
            "response_unit = \"parsec\"",
            "test.toml:11: measurement[1].response_unit = \"parsec\": must be a unit of motion",
        ),
        ("accelerance", "force_unit = \"g\"", "measurement[1].force_unit = \"g\": must be a unit of force"),
        ("accelerance", "unit = \"g\"\nresponse_unit = \"g\"", "measurement[1].unit: is another name of response_unit"),
        ("accelerance", "quantity = \"speed\"", "measurement[1].quantity = \"speed\": must be \"acceleration\""),
        (
            "accelerance",
            "quantity = \"velocity\"\nresponse_unit = \"g\"",
            "a velocity is not in g, which is a unit of acceleration",
        ),
        (
            "accelerance",
            "sampling_rate = 1000",
            "measurement[1].sampling_rate: does not belong to kind = \"accelerance\"",
        ),
        (
            "time-history",
            "force_channel = 0",
            "measurement[1].force_channel: 0 given, wanted is a record's number from 1",
        ),
        (
            "accelerance",
            "response_channel = [1]",
            "measurement[1].response_channel: [1] given, wanted is a record's number",
        ),
        ("time-history", "sampling_rate = 3", "measurement[1].sampling_rate = 3: must lie between 100 and"),
        ("time-history", "window_decay = 0", "measurement[1].window_decay = 0: must be a finite number of s"),
        (
            "time-history",
            "response_sensitivity = -1",
            "must be a finite number of V a unit of motion, greater than zero",
        ),
        (
            "time-history",
            "force_sensitivity = \"2 mV/N\"",
            "text \"2 mV/N\" given, wanted is a number in V a force_unit",
        ),
    ] {
        let message = read(kind, keys).unwrap_err();
        assert!(message.contains(said), "{said}\n{message}");
    }
}

/// Frequencies in kHz under no label: no hammer test ends so low.
#[test]
fn val_frequencies_that_no_hammer_test_has_are_asked_about() {
    let lines = |step: f64| {
        let mut file = Dataset { even: None, ..response((12, "m/s2"), (13, "N")) };
        file.points = (1..=800).map(|line| vec![step * f64::from(line), 1.0, 0.0]).collect();
        file
    };
    let read = |step: f64, unit: Option<&str>| {
        let declared = RecordedResponse { frequency_unit: unit.and_then(Unit::parse), ..measurement() };
        accelerance(records(&[lines(step)]), &declared)
    };
    let said = read(0.00625, None).unwrap_err();
    assert!(
        said.contains("its lines end at 5 Hz")
            && said.contains("write frequency_unit = \"kHz\" in its [[measurement]]"),
        "{said}"
    );
    assert!((read(0.00625, Some("kHz")).unwrap().frequency[799] - 5000.0).abs() < 1e-6);
    assert!((read(0.00625, Some("Hz")).unwrap().frequency[799] - 5.0).abs() < 1e-9);
    assert!(read(6.25, None).is_ok());
    let said = read(62.5, Some("MHz")).unwrap_err();
    assert!(said.contains("frequency_unit = \"MHz\" would put the last line at 5e10 Hz"), "{said}");
}

/// Of several channels none is guessed: the message lists them, or the key that chooses.
#[test]
fn val_a_channel_that_is_not_there_is_told_with_those_that_are() {
    let [force, motion] = pair();
    let at = |node, direction| Dataset { response_node: node, response_direction: direction, ..motion.clone() };
    let hammer = Dataset { response_node: 1, ..force.clone() };
    let file = [hammer.clone(), at(4, 3), at(5, -3)];
    let of = |channel| RecordedResponse { response_channel: Some(channel), ..measurement() };
    let said = history(&file, &of(ChannelName::Port { node: 6, direction: 3 })).unwrap_err();
    assert!(
        said.contains("response_channel = \"6:+z\" is none of its channels: \"1:+z\", \"4:+z\", \"5:-z\""),
        "{said}"
    );
    let said = history(&file, &of(ChannelName::Number(9))).unwrap_err();
    assert!(said.contains("response_channel = 9 is none of its channels"), "{said}");
    let said = history(&file, &measurement()).unwrap_err();
    assert!(said.contains("1 force and 2 acceleration records against time"), "{said}");
    let lines =
        "each has a [[measurement]] of its own, with response_channel = \"4:+z\", or response_channel = \"5:-z\"";
    assert!(said.contains(lines), "{said}");
    assert_eq!(history(&file, &of(ChannelName::Port { node: 5, direction: 0 })).unwrap().hits.len(), 1);
}

/// Hits in files of their own are one measurement: a list, or a pattern.
#[test]
fn val_a_measurement_names_several_files() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["hit-2.uff", "hit-10.uff", "hit-1.uff", "other.uff"] {
        std::fs::write(folder.path().join(name), "").unwrap();
    }
    let read = |file: &str| {
        let text = format!(
            "[piece]\nlength = 1\nwidth = 0.1\nthickness = 0.02\nmass_per_area = 5\n[[measurement]]\nkind = \"time-history\"\nfile = {file}\n\
             force_at = [0, 0]\nresponse_at = [0.1, 0]\nresponse_unit = \"g\"\n"
        );
        let test = ImpactTest::from_toml(&text, folder.path().join("test.toml")).map_err(|error| error.to_string())?;
        let name = |path: &std::path::Path| path.file_name().unwrap().to_str().unwrap().to_owned();
        Ok::<_, String>(test.files().map(name).collect::<Vec<_>>())
    };
    assert_eq!(read("[\"other.uff\", \"hit-2.uff\"]").unwrap(), ["other.uff", "hit-2.uff"]);
    assert_eq!(read("\"hit-*.uff\"").unwrap(), ["hit-1.uff", "hit-10.uff", "hit-2.uff"]);
    assert_eq!(read("[\"hit-?.uff\", \"other.uff\"]").unwrap(), ["hit-1.uff", "hit-2.uff", "other.uff"]);
    for (file, said) in [
        ("\"blow-*.uff\"", "measurement[1].file: cannot be read"),
        ("\"blow-*.uff\"", "no file matches: * stands for any characters"),
        ("[\"other.uff\", \"gone.uff\"]", "gone.uff"),
        ("[]", "[] given, wanted is a file's name in quotes, a list of names, or {force = .., response = ..}"),
        ("[3]", "3 given, wanted is a file's name"),
        ("true", "true given, wanted is a file's name"),
    ] {
        let message = read(file).unwrap_err();
        assert!(message.contains(said) && message.contains("test.toml:8"), "{said}\n{message}");
    }
}

/// Two resonances by hand, as motion over force without type or unit.
#[test]
fn val_a_response_that_tells_nothing_is_asked_about_by_its_slope() {
    let response = |power: i32| {
        let at = |line: usize| {
            let s = num_complex::Complex64::new(0.0, std::f64::consts::TAU * line as f64);
            let mode = |hertz: f64| {
                let omega = std::f64::consts::TAU * hertz;
                1.0 / (s * s + 0.02 * omega * s + omega * omega)
            };
            let value = s.powi(power) * (mode(30.0) + 0.7 * mode(190.0) - 0.4 * mode(420.0));
            vec![value.re, value.im]
        };
        Dataset {
            points: (0..800).map(at).collect(),
            even: Some(("0.00000e+00".into(), "1.00000e+00".into())),
            ..response((0, "NONE"), (0, "NONE"))
        }
    };
    let of = |power, declared: &RecordedResponse| accelerance(records(&[response(power)]), declared);
    assert!(of(2, &measurement()).is_ok());
    assert!(
        of(1, &measurement()).unwrap_err().contains("as a mobility does: is it one? declare quantity = \"velocity\"")
    );
    assert!(of(0, &measurement()).unwrap_err().contains("as a receptance does: is it one?"));
    let declared = |quantity| RecordedResponse { quantity: Some(quantity), ..measurement() };
    assert!(of(0, &declared(Motion::Acceleration)).is_ok());
    let [due, found] =
        [of(2, &measurement()), of(0, &declared(Motion::Displacement))].map(|found| found.unwrap().value);
    assert!(due.iter().zip(&found).all(|(due, found)| (due - found).norm() < 1e-6 * due.norm()));
}

/// A title with its unit names a channel without it, too.
#[test]
fn val_a_channel_is_named_without_its_unit() {
    let [force, motion] = pair();
    let titled = |title: &str, dataset: &Dataset| Dataset { title: title.into(), ..dataset.clone() };
    let named =
        |name: &str| RecordedResponse { response_channel: Some(ChannelName::Name(name.into())), ..measurement() };
    let datasets = [titled("Hammer (N)", &force), titled("Acc 1 (m/s2)", &motion), titled("Acc 2 (m/s2)", &motion)];
    for name in ["Acc 2", "Acc 2 (m/s2)"] {
        assert_eq!(history(&datasets, &named(name)).unwrap().hits.len(), 1, "{name}");
    }
    let refused = history(&datasets, &named("Acc")).unwrap_err();
    assert!(refused.contains("response_channel = \"Acc\" is none of its channels"), "{refused}");
}

/// Swapped channels are told with the lines that swap them, and these lines do.
#[test]
fn val_swapped_channels_are_mended_by_the_lines_that_are_said() {
    let untold = |of: Dataset| Dataset { numerator: (0, "NONE".into()), response_node: 0, ..of };
    let [force, motion] = pair();
    let swapped = [untold(motion.clone()), untold(force.clone())];
    let refused = history(&swapped, &measurement()).unwrap_err();
    assert!(
        refused.contains("declare force_channel = 2 and response_channel = 1 in its [[measurement]])"),
        "{refused}"
    );
    let declared = RecordedResponse {
        force_channel: Some(ChannelName::Number(2)),
        response_channel: Some(ChannelName::Number(1)),
        ..measurement()
    };
    assert_eq!(history(&swapped, &declared).unwrap().hits, history(&[force, motion], &measurement()).unwrap().hits);
}

/// Two runs of one pair of nodes, chosen by their nodes: only their numbers part them.
#[test]
fn val_runs_of_one_pair_of_channels_are_told_by_their_numbers() {
    let run = response((12, "m/s2"), (13, "N"));
    let port = |node| Some(ChannelName::Port { node, direction: 3 });
    let channels = |force, response| RecordedResponse {
        force_channel: port(force),
        response_channel: port(response),
        ..measurement()
    };
    let refused = accelerance(records(&[run.clone(), run.clone()]), &channels(8, 7)).unwrap_err();
    assert!(refused.contains("of this pair of channels as runs of one test are: say which by record = N in its [[measurement]], one of 1, 2"), "{refused}");
    assert!(!refused.contains("or by response_channel"), "{refused}");
    let other = Dataset { response_node: 5, reference_node: 6, ..run.clone() };
    let refused = accelerance(records(&[run, other]), &channels(8, 5)).unwrap_err();
    assert!(
        refused.contains("no frequency response is of both the force_channel and the response_channel"),
        "{refused}"
    );
}

/// Dataset 164 tells its units by factors; people know them by name.
#[test]
fn val_units_of_dataset_164_are_listed_by_their_names() {
    let units = "    -1\n   164\n         7IN: Inch (pound f)           2\n   3.9370078740157480D+01   2.2480894309971047D-01   1.0D+00\n   2.7315D+02\n    -1\n";
    let listed = |numerator, denominator| {
        let bytes = [units.as_bytes(), &response(numerator, denominator).text()].concat();
        RecordFile::from_bytes(&bytes, "hits.uff").unwrap().listed()[0].unit.clone()
    };
    assert_eq!(listed((12, "NONE"), (13, "NONE")), "in/s2 (164) / lbf (164)");
    assert_eq!(listed((8, "NONE"), (13, "N")), "in (164) / N");
}

/// Five blows with pauses, as one record with a little noise; what a trigger declares.
fn blows(trigger: Option<Trigger>) -> Result<TimeHistory, String> {
    let quiet = [0.0; 1500];
    let noise = Noise(9).over(&Hit { force: vec![100.0; 12_500], acceleration: vec![1.0; 12_500] }, 1e-3, 1e-3);
    let join = |channel: &dyn Fn(&Hit) -> Vec<f64>, noise: &[f64], mean: f64| {
        let blow = [channel(&DAMPED.soft_hit(1000, 100.0)), quiet.to_vec()].concat();
        let all: Vec<f64> = (0..5).flat_map(|_| blow.clone()).collect();
        all.iter().zip(noise).map(|(value, noise)| value + (noise - mean)).collect::<Vec<f64>>()
    };
    let force = join(&|hit| hit.force.clone(), &noise.force, 100.0);
    let motion = join(&|hit| hit.acceleration.clone(), &noise.acceleration, 1.0);
    let datasets = [Dataset::time(&force, (13, "N")), Dataset::time(&motion, (12, "m/s^2"))];
    history(&datasets, &RecordedResponse { trigger, ..measurement() })
}

/// A trigger that is wrong is refused with one that does, which then does.
#[test]
fn val_a_wrong_trigger_is_refused_with_one_that_does() {
    let none = Trigger::default();
    assert_eq!(blows(Some(none)).unwrap().hits.len(), 5);
    for (wrong, said) in [
        (Trigger { level: Some(0.002), ..none }, "trigger.level = 0.002 N lies in the noise of the force"),
        (Trigger { level: Some(1e4), ..none }, "no blow passes trigger.level = 10000 N: the highest has"),
        (Trigger { before: Some(3.0), ..none }, "trigger.before = 3 s reaches over a hit"),
        (Trigger { before: Some(1.9), length: Some(2.3), ..none }, "back into the blow before"),
        (Trigger { length: Some(0.1), ..none }, "hits of 0.1 s, 100 samples, are too short"),
        (Trigger { length: Some(60.0), ..none }, "no blow has trigger.length = 60 s of the record to itself"),
    ] {
        let refused = blows(Some(wrong)).err().unwrap_or_else(|| panic!("{wrong:?} is taken"));
        assert!(refused.contains(said), "{refused}");
        if let Some(instead) = refused.split("trigger = {level = ").nth(1) {
            let numbers: Vec<f64> = instead
                .split('}')
                .next()
                .unwrap()
                .split(", ")
                .map(|part| part.rsplit(' ').next().unwrap().parse().unwrap())
                .collect();
            let [level, before, length] = numbers[..] else { panic!("{refused}") };
            let mended = Trigger { level: Some(level), before: Some(before), length: Some(length) };
            assert_eq!(blows(Some(mended)).unwrap().hits.len(), 5, "{refused}");
        } else {
            let number = refused.split("it to ").nth(1).unwrap().split(' ').next().unwrap();
            let level: f64 = number.parse().unwrap();
            assert_eq!(blows(Some(Trigger { level: Some(level), ..none })).unwrap().hits.len(), 5, "{refused}");
        }
    }
    // A small level is said as it is.
    let said = blows(Some(Trigger { level: Some(1.2345), ..none })).unwrap().notes.join("; ");
    assert!(said.contains("trigger = {level = 1.234, ") || said.contains("trigger = {level = 1.235, "), "{said}");
}
