//! Frequency responses that were averaged under an exponential window which the test file does not declare.

use std::fmt::Write as _;
use std::path::Path;

use orthopanel_data::{Estimation, ImpactTest, MeasurementData, TimeHistory, Window};
use orthopanel_identify::{Identification, Settings, Verdict, identify, trace};

/// The example's hits under $e^{-t/\tau}$ over both channels, averaged, as a file of lines in a test of its own.
fn averaged_under(tau: Option<f64>, declared: Option<f64>, folder: &Path) -> Identification {
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/made-hits/test.toml");
    let test = ImpactTest::read(&example).unwrap();
    let MeasurementData::TimeHistory(recorded) = &test.measurements[0].data else { panic!("hits") };
    let mut history = TimeHistory::read(recorded).unwrap();
    let rate = history.rate;
    if let Some(tau) = tau {
        for hit in &mut history.hits {
            for channel in [&mut hit.force, &mut hit.acceleration] {
                channel.iter_mut().enumerate().for_each(|(n, value)| *value *= (-(n as f64) / (rate * tau)).exp());
            }
        }
    }
    let lines = history.accelerance(Estimation { window: Window::None, ..Estimation::default() }).unwrap();
    let mut text = String::from("frequency_hz,real,imag\n");
    let told = lines.frequency.iter().zip(&lines.value).filter(|(frequency, _)| (20.0..4500.0).contains(*frequency));
    told.for_each(|(frequency, value)| writeln!(text, "{frequency},{},{}", value.re, value.im).unwrap());
    std::fs::write(folder.join("lines.csv"), text).unwrap();
    let piece = std::fs::read_to_string(&example).unwrap();
    let piece = piece.split("[[measurement]]").next().unwrap();
    let window = declared.map_or(String::new(), |tau| format!("window_decay = {tau}\n"));
    let text = format!(
        "{piece}[[measurement]]\nkind = \"accelerance\"\nfile = \"lines.csv\"\nforce_at = [-0.3, 0]\nresponse_at = [0.3, 0]\n{window}"
    );
    identify(&ImpactTest::from_toml(&text, folder.join("test.toml")).unwrap(), Settings::default()).unwrap()
}

fn question(found: &Identification) -> Option<&str> {
    found.notes.iter().find(|note| note.contains("exponential window")).map(String::as_str)
}

/// It is asked about, with its time constant; declared, it is taken out; where there was none, nothing is asked.
#[test]
fn val_a_window_is_asked_about_and_taken_out() {
    let folder = tempfile::tempdir().unwrap();
    let zeta = |found: &Identification| found.pieces[0].modes[0].damping.unwrap().value;
    let plain = averaged_under(None, None, folder.path());
    assert_eq!(question(&plain), None, "{:?}", plain.notes);
    let tau = 0.25;
    let windowed = averaged_under(Some(tau), None, folder.path());
    let asked = question(&windowed).unwrap_or_else(|| panic!("{:?} {:?}", windowed.chi_square, windowed.notes));
    assert!(zeta(&windowed) > 1.5 * zeta(&plain), "the window damps: {} and {}", zeta(&windowed), zeta(&plain));
    let told = asked.split("window_decay = ").nth(1).and_then(|rest| rest.split(',').next()).unwrap();
    let told: f64 = told.parse().unwrap();
    assert!((told / tau - 1.0).abs() < 0.1, "{asked}");
    let declared = averaged_under(Some(tau), Some(tau), folder.path());
    assert_eq!(question(&declared), None, "{:?}", declared.notes);
    assert!((zeta(&declared) / zeta(&plain) - 1.0).abs() < 0.02, "{} and {}", zeta(&declared), zeta(&plain));
}

/// Lines that a lab's tool averaged under 0.25 s.
#[test]
fn val_a_measured_folder_is_asked_about() {
    let Some(folder) = crate::support::shared_data("../cases/records/f13_expwin") else { return };
    let found = identify(&ImpactTest::read(folder).unwrap(), Settings::default()).unwrap();
    let asked = question(&found).unwrap_or_else(|| panic!("{:?}", found.notes));
    assert!(asked.contains("write window_decay = 0.25,") && asked.contains("zeta is about 2.3"), "{asked}");
    for (constant, truth) in found.constants.iter().zip([1.067e10, 5.304e8]) {
        assert!((constant.value / truth - 1.0).abs() < 5e-3, "{}: {:e}", constant.name, constant.value);
    }
}

/// `trace` asks the same, and calls nothing explained before the answer; declared, it is no more asked.
#[test]
fn val_a_trace_asks_too() {
    let folder = tempfile::tempdir().unwrap();
    averaged_under(Some(0.25), None, folder.path());
    let piece = "[piece]\nlength = 0.8\nwidth = 0.1\nthickness = 0.03\nmass_per_area = 6.88\n";
    let lines =
        "[[measurement]]\nkind = \"accelerance\"\nfile = \"lines.csv\"\nforce_at = [-0.3, 0]\nresponse_at = [0.3, 0]\n";
    let sensor = "[[effect]]\nid = \"sensor-mass\"\nmass = 1e-5\n";
    let path = folder.path().join("test.toml");
    let read = |text: String| ImpactTest::from_toml(&text, &path).unwrap();
    // With an effect declared too, by both.
    let test = read(format!("{piece}{sensor}{lines}"));
    let found = identify(&test, Settings::default()).unwrap();
    assert_eq!(found.question.as_deref(), question(&found));
    let asked = found.question.unwrap();
    let traced = trace(&read(format!("{piece}{lines}"))).unwrap();
    assert_eq!((traced.verdict, traced.alternatives[0].as_str()), (Verdict::Ambiguous, "exponential-window"));
    assert_eq!((&traced.next_experiment, &traced.notes[0]), (&asked, &asked));
    let traced = trace(&read(format!("{piece}{lines}window_decay = 0.25\n"))).unwrap();
    // These lines have no noise, and what one record leaves of them is many times that: the verdict is no matter of the window.
    assert!(!traced.alternatives.iter().any(|id| id == "exponential-window"), "{:?}", traced.alternatives);
    assert!(!traced.next_experiment.contains("window_decay"), "{}", traced.next_experiment);
}
