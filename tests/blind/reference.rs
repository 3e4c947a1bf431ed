//! Reference motions: sums of sines that repeat every lap and turn every joint around many times.

use super::random::Random;
use super::robots::Robot;

const HARMONICS: usize = 5;

/// A periodic motion of all joints.
#[derive(Clone, Debug)]
pub(crate) struct Reference {
    /// Of one lap \[s\].
    pub(crate) lap_s: f64,
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

impl Reference {
    /// Draws a motion that keeps to the ranges of the robot, times `reach` and `rate`.
    pub(crate) fn draw(
        robot: &Robot,
        lap_s: f64,
        [reach, rate]: [f64; 2],
        random: &mut Random,
    ) -> Self {
        let frequency = std::f64::consts::TAU / lap_s;
        // the springs of an elastic robot resonate above 1.5 Hz
        let harmonics = if robot.elastic().is_some() { 3 } else { HARMONICS };
        let series = |joint: &super::robots::Joint| {
            let mut series = Series { middle: 0.0, waves: [[0.0; 2]; HARMONICS] };
            for (harmonic, wave) in series.waves[..harmonics].iter_mut().enumerate() {
                let amplitude = random.between(0.3, 1.0) / (harmonic as f64 + 1.0).sqrt();
                *wave = [amplitude, random.between(0.0, std::f64::consts::TAU)];
            }
            let samples = (0..400)
                .map(|k| series.at(f64::from(k) * std::f64::consts::TAU / 400.0, frequency));
            let farthest = samples.fold([0.0_f64; 2], |[position, speed], [p, v]| {
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

    /// Position and rate of a joint at time t \[s\].
    pub(crate) fn at(&self, joint: usize, t: f64) -> [f64; 2] {
        let frequency = std::f64::consts::TAU / self.lap_s;
        self.joints[joint].at(frequency * t, frequency)
    }
}
