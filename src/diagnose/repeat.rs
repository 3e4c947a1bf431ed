//! Whether what is left of torques repeats from lap to lap: what does not has no law of motion.

use super::data::{Data, Stretch};
use super::floor::NoiseFloor;
use super::signals::cubic;

/// How much more what is left differs from lap to lap than noise does, at the joint where that is
/// most: its number and the ratio; none where no motion repeats. `trust` is how far rows count.
pub(super) fn unrepeatable(
    data: &Data<'_>,
    floors: &[NoiseFloor],
    left: &[f64],
    trust: &[f64],
) -> Option<(usize, f64)> {
    let of_stretch = |stretch: &Stretch| {
        let signals = &data.signals[stretch.log];
        let floor = &floors[stretch.log];
        let lap = floor.period_s? / signals.row_step_s();
        let rows = stretch.first..stretch.first + stretch.rows;
        let (left, trust) = (&left[rows.clone()], &trust[rows]);
        let (mut sum, mut squares) = (0.0, 0.0);
        for k in 0..stretch.rows {
            let (whole, part) = (lap as usize, lap.fract());
            let after = k + whole;
            if k == 0 || after + 2 >= stretch.rows {
                continue;
            }
            let weight = trust[k] * trust[after].min(trust[after + 1]);
            let difference =
                cubic([-1, 0, 1, 2].map(|by: isize| left[after.wrapping_add_signed(by)]), part)
                    - left[k];
            sum += weight;
            squares += weight * difference * difference;
        }
        let deviation = (squares / (2.0 * sum).max(f64::MIN_POSITIVE)).sqrt();
        (sum > 0.0).then(|| (stretch.joint, deviation / floor.deviation[stretch.joint]))
    };
    data.stretches.iter().filter_map(of_stretch).max_by(|a, b| a.1.total_cmp(&b.1))
}
