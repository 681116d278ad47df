//! A plate whose frequencies another solver made.

use orthopanel_data::ImpactTest;

/// Constants of the plate \[Pa, nu_xy 1\].
pub const TRUTH: [(&str, f64); 6] =
    [("e_x", 1.07e10), ("e_y", 9.6e9), ("nu_xy", 0.31), ("g_xy", 3.7e9), ("g_yz", 2.9e8), ("g_zx", 5.363e8)];

/// A free plate of 0.8 x 0.2 x 0.03 m with the constants of [`TRUTH`]: frequencies by scikit-fem, nodal lines by its changes of
/// sign (`fmpy-checks/plate_by_scikit_fem.py`).
pub const FREE: [(f64, [usize; 2]); 10] = [
    (321.8, [2, 0]),
    (631.0, [1, 1]),
    (840.3, [3, 0]),
    (1254.6, [2, 1]),
    (1529.4, [4, 0]),
    (1876.5, [3, 1]),
    (2316.8, [5, 0]),
    (2515.8, [4, 1]),
    (3144.8, [6, 0]),
    (3191.4, [5, 1]),
];

/// A list of frequencies of the plate's piece; `head` stands before it, `own` in it.
pub fn listed(lines: &[(f64, [usize; 2])], head: &str, own: &str) -> ImpactTest {
    let (values, shapes): (Vec<f64>, Vec<[usize; 2]>) = lines.iter().copied().unzip();
    let text = format!(
        "structure = \"mindlin-plate\"\n[piece]\nlength = 0.8\nwidth = 0.2\nthickness = 0.03\nmass_per_area = 6.88\n{head}\n\
         [[measurement]]\nkind = \"natural-frequencies\"\nvalues = {values:?}\nshape = {shapes:?}\n{own}\n"
    );
    ImpactTest::from_toml(&text, "test.toml").unwrap()
}
