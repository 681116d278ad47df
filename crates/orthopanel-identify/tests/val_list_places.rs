//! Lists of natural frequencies of another solver (the beam of the blind benchmark, in Python): where on the panel an effect sits must not
//! decide whether it is found.

use orthopanel_data::ImpactTest;
use orthopanel_identify::{Verdict, trace};

/// Ten frequencies \[Hz\] of a panel with $E_x$ = 10.67 GPa, $k'G_{zx}$ = 530.4 MPa, each with 0.1 % of noise.
struct Made {
    effect: &'static str,
    /// Its first parameter, in which 4 standard deviations are allowed.
    value: f64,
    x: f64,
    frequencies: [f64; 10],
}

const MADE: [Made; 5] = [
    Made {
        effect: "local-mass",
        value: 0.02,
        x: 0.0,
        frequencies: [312.79, 836.158, 1466.4, 2297.309, 3027.012, 3981.758, 4689.067, 5714.936, 6349.081, 7406.988],
    },
    Made {
        effect: "local-mass",
        value: 0.02,
        x: 0.15,
        frequencies: [318.997, 810.205, 1507.803, 2284.196, 3026.075, 3929.348, 4839.763, 5541.318, 6441.626, 7406.464],
    },
    Made {
        effect: "local-mass",
        value: 0.02,
        x: 0.33,
        frequencies: [313.911, 830.795, 1516.341, 2297.061, 3111.119, 3920.012, 4732.043, 5543.726, 6395.732, 7251.428],
    },
    Made {
        effect: "stiffness-loss",
        value: 0.4,
        x: 0.0,
        frequencies: [321.208, 824.987, 1515.492, 2244.056, 3103.784, 3871.641, 4766.974, 5563.828, 6391.944, 7248.102],
    },
    Made {
        effect: "stiffness-loss",
        value: 0.4,
        x: 0.16,
        frequencies: [320.047, 834.979, 1498.634, 2245.518, 3096.605, 3917.913, 4726.938, 5579.544, 6390.875, 7236.533],
    },
];

#[test]
#[ignore = "a minute; all such run by `cargo test --release -- --ignored`"]
fn val_an_effect_is_found_wherever_it_sits() {
    for Made { effect, value, x, frequencies } in MADE {
        let scatter = frequencies.map(|frequency| 1e-3 * frequency);
        let text = format!(
            "[piece]\nlength = 0.8\nwidth = 0.1\nthickness = 0.03\nmass_per_area = 6.88\n\
             [[measurement]]\nkind = \"natural-frequencies\"\nvalues = {frequencies:?}\nscatter = {scatter:?}\n"
        );
        let found = trace(&ImpactTest::from_toml(&text, "list.toml").unwrap()).unwrap();
        let at = format!("{effect} at {x} m");
        assert_eq!(found.verdict, Verdict::Explained, "{at}: {:?}", found.alternatives);
        assert_eq!(found.effects[0].id, effect, "{at}");
        let parameters = &found.effects[0].parameters;
        let first = parameters[0].values[0];
        assert!((first.value - value).abs() < 4.0 * first.std.expect("a scatter"), "{at}: {first:?}");
        // Frequencies of a free piece do not tell its sides apart.
        let place = parameters.iter().find(|parameter| parameter.name == "x").expect("a place").values[0];
        assert!((place.value.abs() - x).abs() < 0.01, "{at}: {place:?}");
    }
}

/// A panel with a resonator: truth, and ten frequencies \[Hz\] with 0.1 % of noise.
struct Resonant {
    piece: [f64; 4],
    mass: f64,
    frequency: f64,
    x: f64,
    frequencies: [f64; 10],
}

/// Of each, another mass at another place meets the frequencies as well; of the second, at a mass on its bound.
const RESONANT: [Resonant; 2] = [
    Resonant {
        piece: [0.8, 0.2, 0.06, 6.88],
        mass: 0.01878,
        frequency: 740.24,
        x: 0.223,
        frequencies: [586.431, 748.294, 1416.19, 2364.51, 3334.65, 4306.88, 5263.49, 6211.35, 7134.91, 8036.69],
    },
    Resonant {
        piece: [0.925, 0.108, 0.06, 7.123],
        mass: 0.01546,
        frequency: 172.854,
        x: 0.035,
        frequencies: [174.147, 437.154, 1072.5, 1839.97, 2644.24, 3455.45, 4262.77, 5051.01, 5841.09, 6616.64],
    },
];

#[test]
#[ignore = "a minute; all such run by `cargo test --release -- --ignored`"]
fn val_a_resonators_intervals_hold_every_place_that_does_as_well() {
    for Resonant { piece: [length, width, thickness, mass_per_area], mass, frequency, x, frequencies } in RESONANT {
        let scatter = frequencies.map(|frequency| 1e-3 * frequency);
        let text = format!(
            "[piece]\nlength = {length}\nwidth = {width}\nthickness = {thickness}\nmass_per_area = {mass_per_area}\n\
             [[measurement]]\nkind = \"natural-frequencies\"\nvalues = {frequencies:?}\nscatter = {scatter:?}\n"
        );
        let found = trace(&ImpactTest::from_toml(&text, "list.toml").unwrap()).unwrap();
        let at = format!("{mass} kg at {x} m");
        assert_eq!(found.verdict, Verdict::Explained, "{at}: {:?}", found.alternatives);
        assert_eq!(found.effects[0].id, "resonator", "{at}");
        for (name, truth) in [("mass", mass), ("frequency", frequency), ("x", x)] {
            let told = found.effects[0].parameters.iter().find(|parameter| parameter.name == name).unwrap().values[0];
            let reach = 1.96 * told.std.expect("a scatter");
            assert!((told.value - truth).abs() < reach, "{at}: {name} = {} +- {reach}, put in {truth}", told.value);
        }
        assert!(found.notes.iter().any(|note| note.contains("as well")), "{at}: {:?}", found.notes);
    }
}
