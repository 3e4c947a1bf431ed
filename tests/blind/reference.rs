//! Reference motions: sums of sines that repeat every lap and turn every joint around many times.

use super::random::Random;
use super::robots::Robot;

const HARMONICS: usize = 5;
/// Motions drawn for a joint; the one that lingers least where it turns around is taken, as one
/// would who knows that a drive sticks there.
const CANDIDATES: usize = 6;
/// Points of a lap that are looked at.
const SAMPLES: usize = 400;

/// A periodic motion of all joints.
#[derive(Clone, Debug)]
pub struct Reference {
    /// Of one lap \[s\].
    pub lap_s: f64,
    joints: Vec<Series>,
}

#[derive(Clone, Copy, Debug)]
struct Series {
    middle: f64,
    /// Amplitude \[rad\] and phase \[rad\] of each harmonic.
    waves: [[f64; 2]; HARMONICS],
}

impl Series {
    fn at(&self, phase: f64, scale: f64) -> [f64; 2] {
        let (mut position, mut rate) = (self.middle, 0.0);
        for (harmonic, [amplitude, shift]) in self.waves.iter().enumerate() {
            let order = (harmonic + 1) as f64;
            let (sin, cos) = (order * phase + shift).sin_cos();
            position += amplitude * sin;
            rate += amplitude * order * scale * cos;
        }
        [position, rate]
    }
}

impl Series {
    fn draw(harmonics: usize, random: &mut Random) -> Self {
        let mut series = Self { middle: 0.0, waves: [[0.0; 2]; HARMONICS] };
        for (harmonic, wave) in series.waves[..harmonics].iter_mut().enumerate() {
            let amplitude = random.between(0.3, 1.0) / (harmonic as f64 + 1.0).sqrt();
            *wave = [amplitude, random.between(0.0, std::f64::consts::TAU)];
        }
        series
    }

    /// Positions and rates over a lap.
    fn samples(&self, frequency: f64) -> impl Iterator<Item = [f64; 2]> {
        let phases = (0..=SAMPLES).map(|k| k as f64 / SAMPLES as f64 * std::f64::consts::TAU);
        phases.map(move |phase| self.at(phase, frequency))
    }

    /// How fast the slowest reversal is, against the fastest change of rate.
    fn sharpness(&self) -> f64 {
        let rates: Vec<f64> = self.samples(1.0).map(|[_, rate]| rate).collect();
        let changes = rates.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        let turns = rates.windows(2).filter(|pair| pair[0] * pair[1] <= 0.0);
        let slowest = turns.map(|pair| (pair[1] - pair[0]).abs()).fold(f64::INFINITY, f64::min);
        slowest / changes.fold(0.0, f64::max)
    }
}

impl Reference {
    /// Draws a motion that keeps to the ranges of the robot, times `reach` and `rate`.
    pub fn draw(robot: &Robot, lap_s: f64, [reach, rate]: [f64; 2], random: &mut Random) -> Self {
        let frequency = std::f64::consts::TAU / lap_s;
        // the springs of an elastic robot resonate above 1.5 Hz
        let harmonics = if robot.elastic().is_some() { 3 } else { HARMONICS };
        let series = |joint: &super::robots::Joint| {
            let drawn = (0..CANDIDATES).map(|_| Series::draw(harmonics, random));
            let best = drawn.max_by(|one, two| one.sharpness().total_cmp(&two.sharpness()));
            let mut series = best.expect("candidates");
            let farthest =
                series.samples(frequency).fold([0.0_f64; 2], |[position, speed], [p, v]| {
                    [position.max(p.abs()), speed.max(v.abs())]
                });
            let range = joint.range;
            let scale = (range.reach * reach / farthest[0]).min(range.rate * rate / farthest[1]);
            series.waves.iter_mut().for_each(|wave| wave[0] *= scale);
            series.middle = range.middle;
            series
        };
        Self { lap_s, joints: robot.joints.iter().map(series).collect() }
    }

    /// A motion of so many waves as a lap may have: for each joint its middle, and amplitude and
    /// phase of each harmonic.
    pub fn of_waves(lap_s: f64, joints: impl Iterator<Item = (f64, Vec<[f64; 2]>)>) -> Self {
        let series = |(middle, given): (f64, Vec<[f64; 2]>)| {
            assert!(given.len() <= HARMONICS, "more harmonics than a reference has");
            let mut waves = [[0.0; 2]; HARMONICS];
            waves[..given.len()].copy_from_slice(&given);
            Series { middle, waves }
        };
        Self { lap_s, joints: joints.map(series).collect() }
    }

    /// Position and rate of a joint at time t \[s\].
    pub fn at(&self, joint: usize, t: f64) -> [f64; 2] {
        let frequency = std::f64::consts::TAU / self.lap_s;
        self.joints[joint].at(frequency * t, frequency)
    }
}
