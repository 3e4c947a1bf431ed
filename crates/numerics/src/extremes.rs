//! Which rows of long columns a picture needs (M4, Jugel et al. 2014).
//!
//! Of each span of rows the first, the last and, of every column, the least and the greatest: a
//! line through these covers the same pixels as one through all, where spans are no wider than a
//! pixel. Nothing that stands out is lost, which a row in so many would lose.

/// The rows of `0..rows` that are kept, in order, if there are about `spans` spans; all, where
/// there are no more than the spans would keep. `at` is the value of a column in a row; what is no
/// number is neither least nor greatest.
pub fn extremes(
    rows: usize,
    columns: usize,
    spans: usize,
    at: impl Fn(usize, usize) -> f64,
) -> Vec<usize> {
    if rows <= spans.max(1) * (2 + 2 * columns) {
        return (0..rows).collect();
    }
    let length = rows.div_ceil(spans.max(1));
    let mut kept = Vec::new();
    for start in (0..rows).step_by(length) {
        let end = (start + length).min(rows);
        let from = kept.len();
        kept.extend([start, end - 1]);
        for column in 0..columns {
            let (mut least, mut greatest) = (None::<(f64, usize)>, None::<(f64, usize)>);
            for row in start..end {
                let value = at(column, row);
                if value.is_nan() {
                    continue;
                }
                if least.is_none_or(|(known, _)| value < known) {
                    least = Some((value, row));
                }
                if greatest.is_none_or(|(known, _)| value > known) {
                    greatest = Some((value, row));
                }
            }
            kept.extend([least, greatest].into_iter().flatten().map(|(_, row)| row));
        }
        kept[from..].sort_unstable();
    }
    kept.dedup();
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn peaks_of_one_row_stay() {
        let mut column = vec![0.0; 10_000];
        (column[1234], column[7777], column[5000]) = (5.0, -3.0, f64::NAN);
        let kept = extremes(column.len(), 1, 100, |_, row| column[row]);
        assert!(kept.len() <= 400, "{}", kept.len());
        assert!([0, 1234, 7777, 9999].iter().all(|row| kept.contains(row)));
        assert!(kept.windows(2).all(|pair| pair[0] < pair[1]), "in order, none twice");
    }

    #[test]
    fn short_columns_stay_whole() {
        assert_eq!(extremes(40, 1, 10, |_, _| 0.0), (0..40).collect::<Vec<_>>());
        assert!(extremes(0, 2, 10, |_, _| 0.0).is_empty());
    }
}
