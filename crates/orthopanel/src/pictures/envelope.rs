//! Curves with more points than a picture has columns.

/// Columns over which a curve is thinned: about the pixels across a chart.
const COLUMNS: usize = 900;

/// The least and the greatest point of each column, in their order, so that no peak is lost; `points` must rise in x.
pub fn envelope(points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    let (Some(&(first, _)), Some(&(last, _))) = (points.first(), points.last()) else { return points };
    if points.len() <= 2 * COLUMNS || first >= last {
        return points;
    }
    let column = |x: f64| ((x - first) / (last - first) * COLUMNS as f64) as usize;
    let mut thinned = Vec::with_capacity(2 * COLUMNS + 2);
    for together in points.chunk_by(|a, b| column(a.0) == column(b.0)) {
        let by_height = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
        let (Some(&low), Some(&high)) = (together.iter().min_by(by_height), together.iter().max_by(by_height)) else {
            continue;
        };
        thinned.extend(if low.0 <= high.0 { [low, high] } else { [high, low] });
    }
    thinned
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn peaks_survive_and_points_are_few() {
        let spike = |index: usize| if index == 54_321 { 100.0 } else { (index as f64).sin() };
        let points: Vec<(f64, f64)> = (0..100_000).map(|index| (index as f64, spike(index))).collect();
        let thinned = envelope(points);
        assert!(thinned.len() <= 2 * COLUMNS + 2, "{}", thinned.len());
        assert!(thinned.contains(&(54_321.0, 100.0)));
        assert!(thinned.is_sorted_by(|a, b| a.0 <= b.0));
    }

    #[test]
    fn short_curves_stay_as_they_are() {
        let points = vec![(0.0, 1.0), (1.0, 2.0)];
        assert_eq!(envelope(points.clone()), points);
    }
}
