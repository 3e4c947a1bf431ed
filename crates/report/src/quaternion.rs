//! Turns as quaternions, as scripts of pages read them.

use super::space::Transform;

/// Place and turn (x, y, z, w) of a frame.
pub(super) fn pose_of(frame: &Transform) -> [f64; 7] {
    let [x, y, z] = frame.axes;
    // the largest of the four squares is far from 0 (Shepperd 1978)
    let squares = [
        1.0 + x[0] - y[1] - z[2],
        1.0 - x[0] + y[1] - z[2],
        1.0 - x[0] - y[1] + z[2],
        1.0 + x[0] + y[1] + z[2],
    ];
    let most = (0..4).max_by(|a, b| squares[*a].total_cmp(&squares[*b])).unwrap_or(3);
    let (sums, turned) =
        ([x[1] + y[0], x[2] + z[0], y[2] + z[1]], [y[2] - z[1], z[0] - x[2], x[1] - y[0]]);
    let parts = match most {
        0 => [squares[0], sums[0], sums[1], turned[0]],
        1 => [sums[0], squares[1], sums[2], turned[1]],
        2 => [sums[1], sums[2], squares[2], turned[2]],
        _ => [turned[0], turned[1], turned[2], squares[3]],
    };
    let length = parts.iter().map(|part| part * part).sum::<f64>().sqrt().max(1e-12);
    let [a, b, c, d] = parts.map(|part| part / length);
    let [px, py, pz] = frame.origin;
    [px, py, pz, a, b, c, d]
}
