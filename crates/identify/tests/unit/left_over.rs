//! Tests of what is private in `left_over.rs`.

use super::*;

/// Rows are compared with those half a period before, none that does not count between.
#[test]
fn rows_are_compared_over_half_a_period() {
    let mut left = Left { apart: 2.0, ..Left::default() };
    let mut recent = VecDeque::new();
    for one in [Some(1.0), None, Some(3.0), Some(5.0), None, Some(7.0)] {
        left.add(one, &mut recent);
    }
    assert_eq!((left.rows, left.squares), (4.0, 84.0));
    assert_eq!((left.alike, left.both), (3.0 + 35.0, 5.0 + 37.0));
}
