//! Tests of what is private in `errors.rs`.

use super::*;
use denavit_measure::LogIndex;

/// Of 24 parts six decide a parameter alike, and all another one: their variances have as many
/// degrees of freedom as sums with neighbours counted half, of so many.
#[test]
fn what_few_parts_decide_has_few_degrees_of_freedom() {
    let part = |at: usize| {
        let shows = if at < 6 { 1.0 } else { 0.0 };
        let mut triangle = Triangle::new(2);
        triangle.push(&[&[shows, 0.0], &[0.0, 1.0], &[0.1, -0.1]]);
        vec![triangle]
    };
    let condensed = Condensed {
        parts: (0..24).map(part).collect(),
        log_of_part: vec![LogIndex(0); 24],
        ..Condensed::without_parts((vec![vec![0, 1]], 2), vec![1.0], vec![1.0])
    };
    let weights = [vec![1.0]];
    let system = condensed.system(&condensed.whole(), &weights, &[]);
    let solution = solve(&system, &[0.0, 0.0]);
    let problem =
        Problem { condensed: &condensed, weights: &weights, prior: &[], solution: &solution };
    // each by itself, and a sum that the first decides
    let sums = DMatrix::from_row_slice(3, 2, &[1.0, 0.0, 0.0, 1.0, 1.0, 1e-6]);
    let degrees = problem.degrees_of_freedom(Errors::Correlated, &sums);
    for (degrees, expected) in degrees.iter().zip([4.0, 16.0, 4.0]) {
        assert!((degrees - expected).abs() < 1e-6, "{degrees} {expected}");
    }
    let degrees = problem.degrees_of_freedom(Errors::Classical, &sums);
    assert_eq!(degrees[0], 46.0);
}
