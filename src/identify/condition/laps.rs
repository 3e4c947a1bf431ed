//! Motion that repeats: its period, the mean of its laps, and the noise that laps show.

use super::ConditionError;

/// Samples that a search for the period looks at, at most.
const SEARCHED: usize = 4000;

/// The share of a signal's variance by which laps may differ.
const REPEATS: f64 = 0.02;

/// Laps of a log.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Laps {
    /// The first sample of the first lap.
    pub start: usize,
    /// Samples of a lap.
    pub samples: usize,
    /// Number of laps.
    pub count: usize,
}

/// Joints whose variance is a smaller share of the largest one do not say whether laps repeat.
const MOVES: f64 = 1e-4;

/// The largest share of a joint's variance, of those that move, by which its position differs
/// from itself so many samples later.
fn misfit(moving: &[(&[f64], f64)], lag: usize, stride: usize) -> f64 {
    let of_joint = |(q, variance): &(&[f64], f64)| {
        let (mut sum, mut count) = (0.0, 0);
        for k in (0..q.len() - lag).step_by(stride) {
            sum += (q[k + lag] - q[k]).powi(2);
            count += 1;
        }
        sum / (2.0 * f64::from(count.max(1)) * variance)
    };
    moving.iter().map(of_joint).fold(0.0, f64::max)
}

/// Positions between two samples, of joints that move, with their variances.
fn moving(positions: &[Vec<f64>], (start, end): (usize, usize)) -> Vec<(&[f64], f64)> {
    let all = positions.iter().map(|q| (&q[start..end], variance(&q[start..end])));
    let all: Vec<(&[f64], f64)> = all.collect();
    let most = all.iter().map(|(_, variance)| *variance).fold(0.0, f64::max);
    all.into_iter().filter(|(_, variance)| *variance > MOVES * most).collect()
}

impl Laps {
    /// Laps of a given period, with which the positions must repeat.
    pub fn given(
        positions: &[Vec<f64>],
        (period_s, step_s): (f64, f64),
        (start, end): (usize, usize),
    ) -> Result<Self, ConditionError> {
        let laps = Self::of_period(period_s, step_s, (start, end))?;
        let stride = (end - start).div_ceil(SEARCHED).max(1);
        let misfit = misfit(&moving(positions, (start, end)), laps.samples, stride);
        match misfit < REPEATS {
            true => Ok(laps),
            false => Err(ConditionError::NotRepeated { period_s, misfit }),
        }
    }

    /// Laps of a given period from sample `start` on.
    pub fn of_period(
        period_s: f64,
        step_s: f64,
        (start, end): (usize, usize),
    ) -> Result<Self, ConditionError> {
        let samples = (period_s / step_s).round();
        let is_whole = (period_s / step_s - samples).abs() < 0.02;
        if !(samples >= 8.0 && is_whole) {
            return Err(ConditionError::PeriodNotWhole { period_s, step_s });
        }
        let samples = samples as usize;
        match (end - start) / samples {
            count @ 2.. => Ok(Self { start, samples, count }),
            _ => Err(ConditionError::OneLap { period_s }),
        }
    }

    /// The shortest period with which all joints repeat, found by comparing the positions with
    /// themselves.
    pub fn find(
        positions: &[Vec<f64>],
        step_s: f64,
        (start, end): (usize, usize),
    ) -> Result<Self, ConditionError> {
        let samples = end - start;
        let stride = samples.div_ceil(SEARCHED).max(1);
        let moving = moving(positions, (start, end));
        let misfit = |lag: usize| misfit(&moving, lag, stride);
        if moving.is_empty() {
            return Err(ConditionError::NoPeriod);
        }
        // From the first lag at which the motion has become another one.
        let lags = (1..samples / 2 / stride).map(|lag| lag * stride);
        let mut left = false;
        let mut best: Option<(usize, f64)> = None;
        for lag in lags {
            let here = misfit(lag);
            left |= here > 0.2;
            if left && here < REPEATS && best.is_none_or(|(_, least)| here < least) {
                best = Some((lag, here));
            } else if best.is_some_and(|(found, _)| lag > found + found / 10) {
                break;
            }
        }
        let (near, _) = best.ok_or(ConditionError::NoPeriod)?;
        let nearby = near.saturating_sub(2 * stride).max(1)..=near + 2 * stride;
        let lag = nearby
            .filter(|&lag| 2 * lag <= samples)
            .min_by(|&a, &b| misfit(a).total_cmp(&misfit(b)))
            .unwrap_or(near);
        Self::of_period(lag as f64 * step_s, step_s, (start, end))
    }

    /// The mean lap of a signal, and the standard deviation of one sample about it.
    pub fn mean(&self, signal: &[f64]) -> (Vec<f64>, f64) {
        let Self { start, samples, count } = *self;
        let mean: Vec<f64> = (0..samples)
            .map(|k| (0..count).map(|lap| signal[start + lap * samples + k]).sum::<f64>())
            .map(|sum| sum / count as f64)
            .collect();
        let squares: f64 = (0..count)
            .flat_map(|lap| (0..samples).map(move |k| (lap, k)))
            .map(|(lap, k)| (signal[start + lap * samples + k] - mean[k]).powi(2))
            .sum();
        (mean, (squares / ((count - 1) * samples) as f64).sqrt())
    }
}

fn variance(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn two_harmonics(period: f64, samples: usize) -> Vec<f64> {
        let at = |k: usize| {
            let angle = TAU * k as f64 / period;
            angle.sin() + 0.4 * (3.0 * angle).cos()
        };
        (0..samples).map(at).collect()
    }

    #[test]
    fn the_period_of_two_harmonics_is_found() {
        let signal = two_harmonics(640.0, 2700);
        let laps = Laps::find(&[signal], 1e-3, (20, 2680)).expect("it repeats");
        assert_eq!((laps.samples, laps.count), (640, 4));
    }

    /// Laps of 640 samples are none of 600; a joint that rests but for noise has no say.
    #[test]
    fn a_period_with_which_nothing_repeats_is_refused() {
        let mut random = crate::simulate::Random::new(3);
        let noise: Vec<f64> = (0..2700).map(|_| 1e-4 * random.normal()).collect();
        let positions = [two_harmonics(640.0, 2700), noise];
        let given = |period_s: f64| Laps::given(&positions, (period_s, 1e-3), (20, 2680));
        assert_eq!(given(0.64).map(|laps| laps.count), Ok(4));
        for wrong in [0.6, 0.32, 0.7] {
            let refused = matches!(given(wrong), Err(ConditionError::NotRepeated { .. }));
            assert!(refused, "{wrong}: {:?}", given(wrong));
        }
    }

    #[test]
    fn what_never_repeats_has_no_period() {
        let slope: Vec<f64> = (0..1000).map(f64::from).collect();
        assert_eq!(Laps::find(&[slope], 1e-3, (0, 1000)), Err(ConditionError::NoPeriod));
    }

    #[test]
    fn laps_show_the_noise_of_a_sample() {
        let mut random = crate::simulate::Random::new(3);
        let noisy: Vec<f64> =
            two_harmonics(500.0, 5000).into_iter().map(|x| x + 0.1 * random.normal()).collect();
        let laps = Laps { start: 0, samples: 500, count: 10 };
        let (mean, noise) = laps.mean(&noisy);
        assert!((noise - 0.1).abs() < 0.005, "{noise}");
        let clean = two_harmonics(500.0, 500);
        assert!(mean.iter().zip(&clean).all(|(a, b)| (a - b).abs() < 0.2));
    }
}
