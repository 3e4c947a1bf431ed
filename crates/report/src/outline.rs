//! Outlines and round numbers of pictures.

use super::camera::Vec2;

/// The corners of a rectangle.
pub(super) fn rectangle(middle: Vec2, half: Vec2) -> [Vec2; 4] {
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
        .map(|signs: Vec2| [0, 1].map(|side| middle[side] + signs[side] * half[side]))
}

/// Sine and cosine of 24 directions, every 15 degrees.
pub(super) const CIRCLE: [(f64, f64); 24] = {
    const A: f64 = 0.258_819_045_102_520_76;
    const B: f64 = 0.5;
    const C: f64 = std::f64::consts::FRAC_1_SQRT_2;
    const D: f64 = 0.866_025_403_784_438_6;
    const E: f64 = 0.965_925_826_289_068_3;
    [
        (0.0, 1.0),
        (A, E),
        (B, D),
        (C, C),
        (D, B),
        (E, A),
        (1.0, 0.0),
        (E, -A),
        (D, -B),
        (C, -C),
        (B, -D),
        (A, -E),
        (0.0, -1.0),
        (-A, -E),
        (-B, -D),
        (-C, -C),
        (-D, -B),
        (-E, -A),
        (-1.0, 0.0),
        (-E, A),
        (-D, B),
        (-C, C),
        (-B, D),
        (-A, E),
    ]
};

/// 1, 2 or 5 times a power of ten, at most `length`.
pub(super) fn round_step(length: f64) -> f64 {
    let power = 10f64.powi(length.log10().floor() as i32);
    let digit = length / power;
    let first = if digit >= 5.0 {
        5.0
    } else if digit >= 2.0 {
        2.0
    } else {
        1.0
    };
    first * power
}

/// The convex outline of points, by Andrew's monotone chain.
pub(super) fn hull(mut points: Vec<Vec2>) -> Vec<Vec2> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let turn =
        |o: Vec2, a: Vec2, b: Vec2| (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
    let mut outline: Vec<Vec2> = Vec::new();
    for pass in 0..2 {
        let start = outline.len();
        for &point in &points {
            while outline.len() >= start + 2 {
                let [.., before, last] = outline[..] else { break };
                if turn(before, last, point) > 0.0 {
                    break;
                }
                outline.pop();
            }
            outline.push(point);
        }
        outline.pop();
        if pass == 0 {
            points.reverse();
        }
    }
    outline
}

#[cfg(test)]
mod tests {
    use super::*;
    use denavit_numerics::short;

    #[test]
    fn steps_are_round() {
        let steps = [0.099, 0.1, 0.24, 0.7, 3.0].map(round_step);
        assert_eq!(steps.map(short), ["0.05", "0.1", "0.2", "0.5", "2"]);
    }

    #[test]
    fn a_hull_is_the_outline_alone() {
        let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
        let mut points = square.to_vec();
        points.extend([[1.0, 1.0], [1.0, 0.0], [0.5, 1.5]]);
        let mut outline = hull(points);
        outline.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        let mut corners = square.to_vec();
        corners.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        assert_eq!(outline, corners);
    }
}
