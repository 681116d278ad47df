//! What is known before a test: standard deviations of sizes and mass, priors and starts of constants.

use orthopanel_data::ImpactTest;
use orthopanel_identify::{Identification, Settings, identify};

/// The paper's piece 1 (table 5), with more said of the piece and of the constants.
fn found(piece: &str, constants: &str) -> Identification {
    let text = format!(
        "[piece]\nlength = 0.8\nwidth = 0.1\nthickness = 0.03\nmass_per_area = 6.88\n{piece}\n[constants]\n{constants}\n[[measurement]]\n\
         kind = \"natural-frequencies\"\nvalues = [321.3, 837.5, 1520.0, 2312.5, 3150.0, 3987.5]\n"
    );
    identify(&ImpactTest::from_toml(&text, "test.toml").unwrap(), Settings::default()).unwrap()
}

/// Relative standard deviations of $E_x$ and $G_{zx}$.
fn relative(of: &Identification) -> [f64; 2] {
    [0, 1].map(|index| of.constants[index].std.unwrap() / of.constants[index].value)
}

/// $E_x \propto \mu a^4/t^3$ and $G_{zx} \propto \mu a^2/t$: the exponents are those of a second identification at other sizes.
#[test]
fn val_doubts_of_sizes_come_to_the_constants() {
    let own = relative(&found("", ""));
    for (key, std, size, exponents) in [
        ("length_std", 0.004, 0.8, [4.0, 2.0]),
        ("thickness_std", 0.0006, 0.03, [3.0, 1.0]),
        ("mass_per_area_std", 0.07, 6.88, [1.0, 1.0]),
        ("width_std", 0.002, 0.1, [0.0, 0.0]),
    ] {
        let with = relative(&found(&format!("{key} = {std}"), ""));
        for (index, exponent) in exponents.iter().enumerate() {
            let due = own[index].hypot(exponent * std / size);
            assert!((with[index] / due - 1.0).abs() < 1e-6, "{key}: {} where {due} is due", with[index]);
        }
    }
    let moved = |sizes: &str| {
        let text = format!(
            "[piece]\n{sizes}\nwidth = 0.1\n[[measurement]]\nkind = \"natural-frequencies\"\nvalues = [321.3, 837.5, 1520.0, 2312.5, 3150.0, 3987.5]\n"
        );
        let found = identify(&ImpactTest::from_toml(&text, "test.toml").unwrap(), Settings::default()).unwrap();
        [found.constants[0].value.ln(), found.constants[1].value.ln()]
    };
    let at = moved("length = 0.8\nthickness = 0.03\nmass_per_area = 6.88");
    let long = moved("length = 0.808\nthickness = 0.03\nmass_per_area = 6.88");
    let thick = moved("length = 0.8\nthickness = 0.0303\nmass_per_area = 6.88");
    let [a, t] = [1.01_f64.ln(), 1.01_f64.ln()];
    for (index, (by_length, by_thickness)) in [(4.0, -3.0), (2.0, -1.0)].into_iter().enumerate() {
        // But for rotary inertia.
        assert!(((long[index] - at[index]) / a - by_length).abs() < 0.05, "{}", (long[index] - at[index]) / a);
        assert!(((thick[index] - at[index]) / t - by_thickness).abs() < 0.05, "{}", (thick[index] - at[index]) / t);
    }
}

/// A prior as wide as what the data say meets them half way; a wide one changes nothing, a narrow one stays.
#[test]
fn val_a_prior_is_a_further_datum() {
    let alone = found("", "");
    let (value, std) = (alone.constants[0].value, alone.constants[0].std.unwrap());
    let centre = value + 2.0 * std;
    let with = |of: f64| found("", &format!("e_x = {{value = {centre}, std = {of}}}"));
    let equal = with(std);
    assert!(((equal.constants[0].value - value) / std - 1.0).abs() < 0.02, "{:?}", equal.constants);
    assert!((equal.constants[0].std.unwrap() / std - 0.5_f64.sqrt()).abs() < 0.01, "{:?}", equal.constants);
    // The shear modulus goes with it, against it in sign.
    assert!(equal.constants[1].value < alone.constants[1].value, "{:?}", equal.constants);
    let wide = with(1e4 * std);
    assert!((wide.constants[0].value / value - 1.0).abs() < 1e-6, "{:?}", wide.constants);
    let narrow = with(1e-4 * std);
    assert!((narrow.constants[0].value / centre - 1.0).abs() < 1e-6, "{:?}", narrow.constants);
    assert!(narrow.frequency_rms_percent > alone.frequency_rms_percent);
}

/// A start is where a search begins, and no datum.
#[test]
fn val_a_start_leads_to_the_same_minimum() {
    let alone = found("", "");
    for start in ["e_x = {start = 2e10}", "e_x = {start = 2e10}\ng_zx = {start = 1e8}"] {
        let begun = found("", start);
        for (own, other) in alone.constants.iter().zip(&begun.constants) {
            assert!((own.value / other.value - 1.0).abs() < 1e-6, "{start}: {} {}", own.value, other.value);
        }
    }
}

/// A constant of a plate that the data do not show is what its prior says.
#[test]
fn val_an_unseen_constant_is_its_prior() {
    let text = "structure = \"mindlin-plate\"\n[piece]\nlength = 0.8\nwidth = 0.1\nthickness = 0.03\nmass_per_area = 6.88\n[constants]\n\
                nu_xy = {value = 0.25, std = 0.05}\n[[measurement]]\nkind = \"natural-frequencies\"\n\
                values = [321.3, 837.5, 1520.0, 2312.5, 3150.0, 3987.5]\n\
                shape = [[2, 0], [3, 0], [4, 0], [5, 0], [6, 0], [7, 0]]\n";
    let found = identify(&ImpactTest::from_toml(text, "test.toml").unwrap(), Settings::default()).unwrap();
    let nu = found.constants.iter().find(|constant| constant.name == "nu_xy").unwrap();
    assert_eq!((nu.value, nu.std, nu.held), (0.25, Some(0.05), false));
    assert!(found.not_identified.iter().all(|unseen| unseen.name != "nu_xy"));
}

/// A prior far from what the data say is told with its line, and the errors are those with it: the same as of constants that are held
/// where it leads.
#[test]
fn val_a_prior_that_contradicts_the_data_is_told_with_its_error() {
    let alone = found("", "");
    assert!(alone.notes.iter().all(|note| !note.contains("standard deviations from what the data say")));
    let told = |of: &Identification| {
        let said = of.notes.iter().find(|note| note.contains("standard deviations from what the data say"));
        said.map(|note| note.split(" lies ").nth(1).unwrap().split(' ').next().unwrap().parse::<f64>().unwrap())
    };
    let (value, std) = (alone.constants[0].value, alone.constants[0].std.unwrap());
    let with = |centre: f64, of: f64| found("", &format!("e_x = {{value = {centre}, std = {of}}}"));
    assert_eq!(told(&with(value + 2.0 * std, std)), None);
    let far = with(1.2 * value, 0.001 * value);
    let due = 1.2_f64.ln() / (std / value).hypot(0.001 / 1.2);
    assert!((told(&far).unwrap() / due - 1.0).abs() < 0.01, "{:?}", far.notes);
    assert!(far.notes.iter().any(|note| note.starts_with("e_x = {value = ") && note.contains("under [constants]")));
    let [e_x, g_zx] = [0, 1].map(|index| far.constants[index].value);
    let held = found("", &format!("e_x = {e_x}\ng_zx = {g_zx}"));
    assert!((far.frequency_rms_percent / held.frequency_rms_percent - 1.0).abs() < 1e-9);
    assert_eq!(far.pieces[0].modes.len(), 6);
    assert!(far.frequency_rms_percent > 2.0 * alone.frequency_rms_percent, "{}", far.frequency_rms_percent);
}

/// With records the error of the lines is that with the prior, too; where no line is met with it, the prior is refused.
#[test]
fn val_a_prior_counts_in_the_error_of_records() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/made-hits/test.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    let with = |constants: &str| {
        let text = text.replace("[[measurement]]", &format!("[constants]\n{constants}\n[[measurement]]"));
        identify(&ImpactTest::from_toml(&text, &path).unwrap(), Settings::default())
    };
    let alone = with("").unwrap();
    let near = with("e_x = {value = 1.072e10, std = 1e5}").unwrap();
    let error = |of: &Identification| of.accelerance_rms_percent.unwrap();
    assert!(error(&near) > 1.05 * error(&alone) && near.chi_square > alone.chi_square, "{}", error(&near));
    let [e_x, g_zx] = [0, 1].map(|index| near.constants[index].value);
    let held = with(&format!("e_x = {e_x}\ng_zx = {g_zx}")).unwrap();
    assert!((error(&near) / error(&held) - 1.0).abs() < 1e-9, "{} {}", error(&near), error(&held));
    assert!(
        near.notes.iter().any(|note| note.contains("standard deviations from what the data say")),
        "{:?}",
        near.notes
    );
    let refused = with("e_x = {value = 4e10, std = 1e5}").unwrap_err().to_string();
    assert!(refused.starts_with("e_x = {value = 4e10, std = 1e5} under [constants] lies "), "{refused}");
}
