//! Plates from the records of a hammer, from sizes and mass alone.

use orthopanel_data::ImpactTest;
use orthopanel_identify::{Settings, identify};

use crate::support::shared_data;

/// Two spruce plates, hit at one place each. The constants are those that lists of their named modes give; the tolerances are those of two
/// readings of one piece of wood, whose frequencies no plate meets better than 0.7 %. The folder is not part of the repository.
#[test]
fn val_real_plates_have_the_constants_of_their_own_lists() {
    for (name, wanted) in [("2L", [1.044e10, 9.647e8, 6.577e8]), ("5R", [1.104e10, 9.625e8, 7.965e8])] {
        let Some(path) = shared_data(&format!("spruce_plates/{name}/test.toml")) else { return };
        let test = ImpactTest::read(&path).expect("a test");
        let found = identify(&test, Settings::default()).expect("constants");
        for ((constant, wanted), within) in ["e_x", "e_y", "g_xy"].into_iter().zip(wanted).zip([0.03, 0.06, 0.08]) {
            let own = found.constants.iter().find(|own| own.name == constant).expect("identified");
            assert!((own.value / wanted - 1.0).abs() < within, "{name} {constant}: {} {wanted}", own.value);
            assert!(own.std.is_some_and(|std| std < within * wanted), "{name} {constant}: {:?}", own.std);
        }
        assert!(found.notes[0].contains("which the nearest plate misses by 0.7"), "{:?}", found.notes);
        assert!(found.pieces[0].modes.len() > 25, "{name}: {} modes", found.pieces[0].modes.len());
    }
}

/// The same records with constants held: those across and in shear that the lists give, which leave E_x as these have it, and five of six, with
/// what is usual for spruce for the rest; of the other plate's the one is told that these records contradict.
#[test]
fn val_real_plates_with_constants_held_have_the_others() {
    for (name, e_x, held) in [("2L", 1.044e10, [9.647e8, 6.577e8]), ("5R", 1.104e10, [9.625e8, 7.965e8])] {
        let Some(path) = shared_data(&format!("spruce_plates/{name}/test.toml")) else { return };
        let mut test = ImpactTest::read(&path).expect("a test");
        test.constants.extend(["e_y", "g_xy"].map(str::to_owned).into_iter().zip(held));
        let two = identify(&test, Settings::default()).expect("constants");
        assert!((two.constants[0].value / e_x - 1.0).abs() < 0.03, "{name}: {:?}", two.constants[0]);
        assert_eq!((two.constants[1].value, two.constants[1].held), (held[0], true));
        test.constants.extend([("nu_xy", 0.37), ("g_yz", 7e7), ("g_zx", 8e8)].map(|(of, at)| (of.to_owned(), at)));
        let five = identify(&test, Settings::default()).expect("constants");
        assert!((five.constants[0].value / e_x - 1.0).abs() < 0.05, "{name}: {:?}", five.constants[0]);
        let said = |what: &str| five.notes.iter().any(|note| note.contains(what));
        assert!(said("e_y, nu_xy, g_xy, g_yz, g_zx as the test file holds them"), "{:?}", five.notes);
        if name == "5R" {
            test.constants.insert("g_xy".to_owned(), 6.577e8);
            let other = identify(&test, Settings::default()).expect("constants");
            let told = other.notes.iter().any(|note| note.contains("contradict g_xy = 6.577e8, free 7.9"));
            assert!(told, "{:?}", other.notes);
        }
    }
}

/// The same plates' lists of ten and eleven frequencies, and one of a plate with a clamped edge whose authors exchanged two shapes, without any shape: the
/// constants are those that the lists with shapes give. The folder is not part of the repository.
#[test]
fn val_real_lists_without_shapes_have_the_constants_of_those_with() {
    for (name, wanted) in [
        ("spruce-2L-list", [1.044e10, 9.647e8, 6.577e8]),
        ("spruce-5R-list", [1.104e10, 9.625e8, 7.965e8]),
        ("nemus-S3-rep1", [1.165e10, 9.449e8, 5.314e8]),
    ] {
        let Some(path) = shared_data(&format!("../cases/lists/{name}/test.toml")) else { return };
        let text = std::fs::read_to_string(path).expect("a test");
        let shapeless: Vec<&str> = text.lines().filter(|line| !line.starts_with("shape")).collect();
        let test = ImpactTest::from_toml(&shapeless.join("\n"), "test.toml").expect("a test");
        let found = identify(&test, Settings::default()).expect("constants");
        assert!(found.notes[0].contains("read by frequency alone"), "{:?}", found.notes);
        for (constant, wanted) in ["e_x", "e_y", "g_xy"].into_iter().zip(wanted) {
            let own = found.constants.iter().find(|own| own.name == constant).expect("identified");
            // Where the shape of a mode is in doubt, which is asked about, another reading stands within what is told.
            let std = own.std.expect("free");
            let apart = (own.value - wanted).abs();
            assert!(apart < 2.5 * std && apart < 0.04 * wanted, "{name} {constant}: {} +- {std}, {wanted}", own.value);
        }
        if name == "nemus-S3-rep1" {
            // As its authors have them it is missed by 1.25 %, the other way round by 1.05 %.
            assert!(found.notes[0].contains("635.1 Hz [1, 1], 657.3 Hz [0, 2]"), "{:?}", found.notes);
        }
    }
}
