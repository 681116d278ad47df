//! Columns of numbers as CSV.

/// Columns of numbers under their names, each number with as many digits as bring it back exactly.
pub fn csv(names: &[String], columns: &[&[f64]]) -> String {
    let mut text = names.join(",") + "\n";
    let rows = columns.iter().map(|column| column.len()).min().unwrap_or(0);
    for row in 0..rows {
        let numbers = columns.iter().filter_map(|column| column.get(row));
        let numbers: Vec<String> = numbers.map(|number| number_text(*number)).collect();
        text += &numbers.join(",");
        text.push('\n');
    }
    text
}

/// The shortest text that reads back as `number`: plain near one, with an exponent far from it.
fn number_text(number: f64) -> String {
    if number == 0.0 || (1e-4..1e15).contains(&number.abs()) { format!("{number}") } else { format!("{number:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn csv_numbers_read_back_exactly() {
        let numbers = [0.0, -0.3, 1.0 / 3.0, 1e-300, -2.5e20, f64::MIN_POSITIVE];
        let text = csv(&["a".into()], &[&numbers]);
        let back: Vec<f64> = text.lines().skip(1).map(|line| line.parse().expect("a number")).collect();
        assert_eq!(back, numbers);
    }
}
