//! Whether what is left of torques repeats from lap to lap: what does not has no law of motion.

use super::between::cubic;
use super::data::{Data, Stretch};
use super::floor::{NoiseFloor, UNREPEATABLE};

/// How much what is left of a stretch differs from lap to lap.
struct Scatter {
    log: usize,
    equation: usize,
    /// Its deviation [N m, N].
    deviation: f64,
    /// Root mean square of all that is left [N m, N].
    left: f64,
}

/// The scatter of all stretches whose motion repeats. `trust` is how far rows count.
fn scatters<'d>(
    data: &'d Data<'_>,
    floors: &'d [NoiseFloor],
    left: &'d [f64],
    trust: &'d [f64],
) -> impl Iterator<Item = Scatter> + 'd {
    let of_stretch = |stretch: &Stretch| {
        let signals = &data.signals[stretch.log];
        let lap = floors[stretch.log].period_s? / signals.row_step_s();
        let rows = stretch.first..stretch.first + stretch.rows;
        let (left, trust) = (&left[rows.clone()], &trust[rows]);
        let (mut sum, mut differing, mut all) = (0.0, 0.0, 0.0);
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
            differing += weight * difference * difference;
            all += weight * left[k] * left[k];
        }
        let mean = |squares: f64| squares / sum.max(f64::MIN_POSITIVE);
        let Stretch { log, equation, .. } = *stretch;
        let (deviation, left) = (mean(0.5 * differing).sqrt(), mean(all).sqrt());
        (sum > 0.0).then_some(Scatter { log, equation, deviation, left })
    };
    data.stretches.iter().filter_map(of_stretch)
}

/// How much more what is left differs from lap to lap than noise does, at the joint or spring where
/// that is most: its equation and the ratio; none where no motion repeats.
pub(super) fn unrepeatable(
    data: &Data<'_>,
    floors: &[NoiseFloor],
    left: &[f64],
    trust: &[f64],
) -> Option<(usize, f64)> {
    let over =
        |one: Scatter| (one.equation, one.deviation / floors[one.log].deviation[one.equation]);
    scatters(data, floors, left, trust).map(over).max_by(|a, b| a.1.total_cmp(&b.1))
}

/// The share of what is left up to which its scatter from lap to lap is noise, though more than
/// that of sensors: beyond, it is something that was not recorded.
const OF_LEFT: f64 = 1.0 / 3.0;

/// Raises floors to what differs from lap to lap of each joint in the log where that is least, of
/// those where it is little of what the model leaves. `all` are sets of logs, each with what is
/// left and how far rows count.
pub(super) fn raise_floors<const N: usize>(
    all: [(&Data<'_>, &[f64], &[f64]); N],
    floors: &mut [Vec<NoiseFloor>; N],
) {
    let mut least: Vec<Option<f64>> = vec![None; all[0].0.nominal.equations()];
    for ((data, left, trust), floors) in all.iter().zip(&*floors) {
        let own = scatters(data, floors, left, trust);
        for one in own.filter(|one| one.deviation < OF_LEFT * one.left) {
            let known = least[one.equation].unwrap_or(f64::INFINITY);
            least[one.equation] = Some(one.deviation.min(known));
        }
    }
    for floor in floors.iter_mut().flatten() {
        for (deviation, scatter) in floor.deviation.iter_mut().zip(&least) {
            let scatter = scatter.unwrap_or(0.0);
            if scatter > UNREPEATABLE * *deviation {
                *deviation = scatter;
            }
        }
    }
}
