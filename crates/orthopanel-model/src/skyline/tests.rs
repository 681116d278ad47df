//! Factors and products by rows against dense ones.

use faer::Mat;

use super::{SkylineCholesky, SymmetricMatrix};

/// Rows that begin here and there, made positive by their diagonal where `diagonal` is large.
fn made(diagonal: f64) -> (Mat<f64>, SymmetricMatrix) {
    let first = |row: usize| row.saturating_sub(1 + (7 * row) % 5);
    let entry = |row: usize, column: usize| match (row.max(column), row.min(column)) {
        (row, column) if row == column => diagonal + (row as f64).cos(),
        (row, column) if column >= first(row) => (1.3 * row as f64 + 0.7 * (column * column) as f64).sin(),
        _ => 0.0,
    };
    let whole = Mat::from_fn(23, 23, entry);
    (whole.clone(), whole.into())
}

fn apart(left: &Mat<f64>, right: &Mat<f64>) -> f64 {
    (left - right).col_iter().flat_map(|column| column.iter()).fold(0.0, |most: f64, value| most.max(value.abs()))
}

#[test]
fn val_a_skyline_is_the_matrix() {
    let (whole, skyline) = made(0.3);
    assert_eq!(skyline.to_dense(), whole);
    assert!(skyline.values.len() < 23 * 6);
    let columns = Mat::from_fn(23, 3, |i, j| (0.4 * i as f64 + j as f64).sin());
    assert!(apart(&skyline.times(&columns), &(&whole * &columns)) < 1e-14);
    let form = columns.col(1).transpose() * (&whole * columns.col(1));
    assert!((skyline.quadratic_form(columns.col_as_slice(1)) - form).abs() < 1e-13);
    let kept = [0, 2, 3, 7, 8, 15, 22];
    let part = Mat::from_fn(kept.len(), kept.len(), |i, j| whole[(kept[i], kept[j])]);
    assert_eq!(skyline.part(&kept).to_dense(), part);
    let unit = SymmetricMatrix::from(Mat::<f64>::identity(23, 23));
    let sum = SymmetricMatrix::sum([(2.0, &unit), (3.0, &skyline)].into_iter(), 23);
    assert!(apart(&sum.to_dense(), &(2.0 * Mat::<f64>::identity(23, 23) + 3.0 * &whole)) < 1e-14);
}

#[test]
fn val_the_factor_solves() {
    let (whole, skyline) = made(9.0);
    let factor = SkylineCholesky::new(&skyline).unwrap();
    let expected: Vec<f64> = (0..23).map(|i| (0.7 * i as f64).cos()).collect();
    let mut found = skyline.image(&expected);
    factor.solve_lower(&mut found);
    let mut again = expected.clone();
    factor.upper_times(&mut again);
    // L^-1 A v = L^T v.
    assert!(found.iter().zip(&again).all(|(a, b)| (a - b).abs() < 1e-12));
    factor.solve_upper(&mut found);
    assert!(found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-13));
    assert!(SkylineCholesky::new(&made(0.0).1).is_none());
    let values = whole.self_adjoint_eigenvalues(faer::Side::Lower).unwrap();
    assert!(values.iter().all(|value| *value > 0.0));
}

#[test]
fn val_negative_pivots_are_negative_eigenvalues() {
    for diagonal in [-3.0, -1.2, 0.1, 0.9] {
        let (whole, skyline) = made(diagonal);
        let values = whole.self_adjoint_eigenvalues(faer::Side::Lower).unwrap();
        let expected = values.iter().filter(|value| **value < 0.0).count();
        assert!(expected > 0);
        assert_eq!(skyline.negative_pivots(), Some(expected), "{diagonal}");
    }
}
