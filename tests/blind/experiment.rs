//! The closed loop: sampled PD control along a reference, and what sensors make of the run.

use super::conditions::{Disturbance, Recording};
use super::hidden::{Hidden, Law};
use super::nominal::Nominal;
use super::plant::Plant;
use super::random::Random;
use super::reference::Reference;
use super::rigid::{MOST, Posture};
use nalgebra::DMatrix;

/// Step of the plant \[s\].
pub const STEP_S: f64 = 2.5e-4;
/// Run before the log begins, so that it begins in the middle of a motion \[s\].
const BEFORE_S: f64 = 1.5;
/// Run after the log's end \[s\].
const AFTER_S: f64 = 0.1;

/// A sampled controller, built on the nominal model by somebody who does not know better.
#[derive(Clone, Debug)]
pub struct Control {
    /// Plant steps per sample of the controller.
    pub steps: usize,
    /// Frequency of the loop [rad/s] and its damping.
    pub loop_rate: f64,
    pub damping: f64,
    /// Feed-forward of gravity and of Coulomb friction along the reference.
    pub gravity: bool,
    pub friction: bool,
}

impl Control {
    /// Draws a controller.
    pub fn draw(random: &mut Random) -> Self {
        Self {
            steps: [2, 4, 4][random.below(3)],
            loop_rate: random.between(32.0, 50.0),
            damping: random.between(0.7, 1.1),
            gravity: random.chance(0.6),
            friction: random.chance(0.85),
        }
    }

    /// Commands on the joints' side [N m] for angles and rates of the drives.
    fn command(
        &self,
        nominal: &Nominal,
        gains: &[f64],
        reference: &[[f64; 2]],
        drive: [&[f64]; 2],
        command: &mut [f64],
    ) {
        command.fill(0.0);
        if self.gravity {
            let q: Vec<f64> = reference.iter().map(|[q, _]| *q).collect();
            let posture = Posture::new(&nominal.robot.rows(), &q);
            posture.torques(&[0.0; MOST], &[0.0; MOST], &nominal.robot.fall, command);
        }
        for (joint, [q, qd]) in reference.iter().enumerate() {
            let kp = gains[joint] * self.loop_rate * self.loop_rate;
            let kd = 2.0 * self.damping * self.loop_rate * gains[joint];
            command[joint] += kp * (q - drive[0][joint]) + kd * (qd - drive[1][joint]);
            if self.friction {
                command[joint] += nominal.robot.joint_side(joint)[2] * qd.signum();
            }
        }
    }
}

/// A run, at every step of the plant.
#[derive(Clone, Debug)]
pub struct Run {
    /// Steps before t = 0.
    before: usize,
    pub q: Vec<Vec<f64>>,
    pub qd: Vec<Vec<f64>>,
    pub motor: Vec<Vec<f64>>,
    pub command: Vec<Vec<f64>>,
}

/// Runs the closed loop for a duration \[s\]; none if it comes apart.
pub fn run(
    plant: &Plant,
    nominal: &Nominal,
    control: &Control,
    reference: &Reference,
    duration_s: f64,
    disturbance: &mut Disturbance,
) -> Option<Run> {
    let joints = plant.rows.len();
    let before = (BEFORE_S / STEP_S).round() as usize;
    let steps = before + ((duration_s + AFTER_S) / STEP_S).round() as usize;
    let at = |t: f64| (0..joints).map(|joint| reference.at(joint, t)).collect::<Vec<_>>();
    let start = at(-BEFORE_S);
    let [q, qd]: [Vec<f64>; 2] = [0, 1].map(|k| start.iter().map(|pair| pair[k]).collect());
    let mut state = plant.start(-BEFORE_S, &q, &qd);
    let freedoms = joints + plant.transmissions.len();
    let gains = inertias(nominal, control);
    let mut command = vec![0.0; joints];
    let empty = || vec![Vec::with_capacity(steps); joints];
    let mut run = Run { before, q: empty(), qd: empty(), motor: empty(), command: empty() };
    for step in 0..steps {
        // the grid of times, not the sum of steps
        state.t = (step as f64 - before as f64) * STEP_S;
        let motor = plant.motors(&state.y);
        if step % control.steps == 0 {
            let rates = plant.motors(&state.y[freedoms..]);
            let drive = [&motor[..joints], &rates[..joints]];
            control.command(nominal, &gains, &at(state.t), drive, &mut command);
        }
        for joint in 0..joints {
            run.q[joint].push(state.y[joint]);
            run.qd[joint].push(state.y[freedoms + joint]);
            run.motor[joint].push(motor[joint]);
            run.command[joint].push(command[joint]);
        }
        disturbance.step(&mut state.push, step == 0);
        plant.step(&mut state, &command, STEP_S);
        let far = |q: &f64| q.is_nan() || q.abs() > 20.0;
        if state.y[..joints].iter().any(far) {
            return None;
        }
    }
    Some(run)
}

/// Inertias that gains are laid out for [kg m^2]: of each drive while the others are free, in the
/// middle of the motion; more where friction would hold a drive more than 5 mrad off.
fn inertias(nominal: &Nominal, control: &Control) -> Vec<f64> {
    let middle: Vec<f64> = nominal.robot.joints.iter().map(|joint| joint.range.middle).collect();
    let mut matrix = [[0.0; MOST]; MOST];
    Posture::new(&nominal.robot.rows(), &middle).mass_matrix(&mut matrix);
    let count = middle.len();
    let rotor = |joint: usize| nominal.robot.joint_side(joint)[0].max(0.01);
    let entry = |row: usize, column: usize| {
        matrix[row][column] + if row == column { rotor(row) } else { 0.0 }
    };
    let inverse = DMatrix::from_fn(count, count, entry).try_inverse();
    let inverse = inverse.expect("a mass matrix is definite");
    let held = |joint: usize| {
        let friction = nominal.robot.joint_side(joint)[2];
        friction / (0.005 * control.loop_rate * control.loop_rate)
    };
    (0..count).map(|joint| (1.0 / inverse[(joint, joint)]).max(held(joint))).collect()
}

/// Sensors.
#[derive(Clone, Debug)]
pub struct Sensors {
    /// Plant steps per row of the log.
    pub steps: usize,
    /// Resolution of all encoders \[rad\].
    pub resolution: f64,
    /// Standard deviation of their noise \[rad\].
    pub encoder_noise: f64,
    /// Standard deviation of each measured torque [N m].
    pub torque_noise: Vec<f64>,
    /// Standard deviation of each measured rate [rad/s], if there are any.
    pub rate_noise: Option<f64>,
}

/// What was measured: a column per joint, a row per sample.
#[derive(Clone, Debug)]
pub struct Log {
    /// Distance of rows on their grid.
    pub step_s: f64,
    pub t: Vec<f64>,
    pub q: Vec<Vec<f64>>,
    pub qd: Option<Vec<Vec<f64>>>,
    pub motor: Vec<Vec<f64>>,
    pub tau: Vec<Vec<f64>>,
}

/// Measures a run, with the effects that are in sensors, at its grid of rows or as a recording has
/// its times.
pub fn measure(
    run: &Run,
    sensors: &Sensors,
    hidden: &[Hidden],
    random: &mut Random,
    recording: &Recording,
    random_times: &mut Random,
) -> Log {
    let total = run.q[0].len();
    let after = (AFTER_S / STEP_S).round() as usize;
    let grid: Vec<usize> = (run.before..total - after).step_by(sensors.steps).collect();
    let late = recording.late(grid.len(), random_times);
    let kept = recording.kept(grid.len(), random_times);
    let step_s = sensors.steps as f64 * STEP_S;
    let all = grid.iter().zip(&late).zip(&kept).enumerate().filter(|(_, (_, kept))| **kept);
    let (mut rows, mut t) = (Vec::new(), Vec::new());
    for (index, ((row, late), _)) in all {
        rows.push((*row, late * sensors.steps as f64));
        t.push((index as f64 + late) * step_s);
    }
    let rounded = |value: f64, random: &mut Random| {
        let noise = sensors.encoder_noise;
        let value = if noise > 0.0 { value + noise * random.normal() } else { value };
        (value / sensors.resolution).round() * sensors.resolution
    };
    let mut log = Log {
        step_s,
        t,
        q: Vec::new(),
        qd: sensors.rate_noise.map(|_| Vec::new()),
        motor: Vec::new(),
        tau: Vec::new(),
    };
    for joint in 0..run.q.len() {
        let here: Vec<&Hidden> = hidden.iter().filter(|one| one.joint == joint).collect();
        let q: Vec<f64> =
            rows.iter().map(|&(step, part)| between(&run.q[joint], step, part)).collect();
        let error = |q: f64| here.iter().map(|one| one.angle_error(q)).sum::<f64>();
        log.q.push(q.iter().map(|q| rounded(q + error(*q), random)).collect());
        let motor =
            |&(step, part): &(usize, f64)| rounded(between(&run.motor[joint], step, part), random);
        let motor = rows.iter().map(motor);
        log.motor.push(motor.collect());
        let noise = sensors.torque_noise[joint];
        let torque = |((row, part), q): (&(usize, f64), &f64)| {
            let gain: f64 = here.iter().map(|one| one.torque_gain(*q)).product();
            let middle = *row as f64 + part;
            let mean = mean_torque(&run.command[joint], middle, sensors.steps, &here);
            mean * gain + noise * random.normal()
        };
        log.tau.push(rows.iter().zip(&q).map(torque).collect());
        if let (Some(columns), Some(noise)) = (&mut log.qd, sensors.rate_noise) {
            let rates = &run.qd[joint];
            let rates = rows
                .iter()
                .map(|&(step, part)| between(rates, step, part) + noise * random.normal());
            columns.push(rates.collect());
        }
    }
    log
}

/// A signal at a step and a part of one further on: on the cubic through four neighbours.
fn between(signal: &[f64], step: usize, part: f64) -> f64 {
    if part == 0.0 {
        return signal[step];
    }
    let first = (step as f64 + part).floor() as usize - 1;
    let x = step as f64 + part - first as f64;
    let others = |k: usize| (0..4).filter(move |other| *other != k).map(|other| other as f64);
    let weight =
        |k: usize| -> f64 { others(k).map(|other| (x - other) / (k as f64 - other)).product() };
    (0..4).map(|k| weight(k) * signal[first + k]).sum()
}

/// The torque over the window of one sample around a step: what a sensor with that bandwidth says.
fn mean_torque(command: &[f64], middle: f64, steps: usize, here: &[&Hidden]) -> f64 {
    let late = here.iter().find(|hidden| hidden.law == Law::TorqueDelay);
    let window = |shift: f64| {
        // from cumulated sums one would lose digits; windows are short
        let begin = middle - shift - 0.5 * steps as f64;
        let (whole, part) = (begin.floor(), begin - begin.floor());
        let first = (whole.max(0.0) as usize).min(command.len() - 1 - steps.min(command.len() - 1));
        let inner: f64 = command[first + 1..first + steps].iter().sum();
        ((1.0 - part) * command[first] + inner + part * command[first + steps]) / steps as f64
    };
    match late {
        None => window(0.0),
        Some(hidden) if hidden.variant == 0 => window(hidden.size / STEP_S),
        Some(hidden) => {
            // a filter in the sensor: two equal lags, whose weights are s exp(-s)
            let time = 0.5 * hidden.size / STEP_S;
            let weights = (0..40).map(|k| (f64::from(k) + 0.5) * 0.25);
            let parts = weights.map(|s| (s * (-s).exp(), window(s * time)));
            let (weight, sum) = parts.fold((0.0, 0.0), |(w, s), (dw, x)| (w + dw, s + dw * x));
            sum / weight
        }
    }
}

impl Hidden {
    /// What a sensor adds to an angle \[rad\].
    fn angle_error(&self, q: f64) -> f64 {
        match (self.law, self.variant) {
            (Law::JointZero, _) => self.size,
            (Law::TransmissionError, 1) => self.size * self.ripple(q),
            _ => 0.0,
        }
    }

    /// What a sensor multiplies a torque with.
    fn torque_gain(&self, q: f64) -> f64 {
        match (self.law, self.variant) {
            (Law::TorqueGain, _) => 1.0 + self.size,
            (Law::TransmissionError, 0) => 1.0 + self.size * self.ripple(q),
            _ => 1.0,
        }
    }

    fn ripple(&self, q: f64) -> f64 {
        let lowest = if self.variant == 0 { 1.0 } else { 5.0 };
        let waves = lowest + (3.0 * self.shape.first).floor();
        (waves * q + self.shape.phase).sin()
    }
}
