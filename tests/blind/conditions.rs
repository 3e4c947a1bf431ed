//! Conditions that real logs have and the first rows of the battery lack: how numbers are printed,
//! coarse encoders, stamps that are not equally spaced, lost rows, torques that no channel records,
//! and a model whose own friction is far off. docs/evidence/battery-conditions.md has a source for
//! each size.

use super::case::Case;
use super::experiment::STEP_S;
use super::nominal::Nominal;
use super::random::Random;
use super::robots::Robot;
use std::f64::consts::TAU;

/// A condition of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Condition {
    /// All numbers printed to six decimals.
    Printed,
    /// All numbers stored as IEEE single precision.
    SinglePrecision,
    /// Encoders of 16 to 18 bits with noise, whose steps six decimals do not show exactly.
    CoarseEncoder,
    /// Rows at times that scatter, stamped as they were.
    Jitter,
    /// Rows that are missing.
    Dropped,
    /// Torque of the drives that is in no column and differs between runs.
    Disturbance,
    /// Friction of the nominal model 20 to 50 % off, 50 % stated.
    OwnFriction,
    /// All of them but single precision.
    Together,
}

/// All conditions, in the order of the rows.
pub const CONDITIONS: [Condition; 8] = [
    Condition::Printed,
    Condition::SinglePrecision,
    Condition::CoarseEncoder,
    Condition::Jitter,
    Condition::Dropped,
    Condition::Disturbance,
    Condition::OwnFriction,
    Condition::Together,
];

/// Resolution of coarse encoders, in bits of a turn of the joint.
const COARSE_BITS: [f64; 3] = [16.0, 17.0, 18.0];
/// Their noise, in steps.
const COARSE_NOISE: f64 = 0.3;
/// Standard deviation of a stamp against the distance of rows.
const JITTER: [f64; 2] = [0.01, 0.05];
/// A stamp is off by this many standard deviations at most.
const FARTHEST: f64 = 3.0;
/// Share of rows that are missing, and most in a row.
const DROPPED: [f64; 2] = [0.002, 0.01];
const MOST_DROPPED: usize = 3;
/// Standard deviation of a disturbance against the largest torque of its joint.
const DISTURBANCE: [f64; 2] = [0.0015, 0.003];
/// Corner of a disturbance \[Hz\].
const DISTURBANCE_HZ: f64 = 8.0;
/// How far off friction is, relative to what it is.
const FRICTION_ERROR: [f64; 2] = [0.2, 0.5];
/// What the model says of its friction then, relative.
const FRICTION_STD: f64 = 0.5;

/// How the numbers of a log are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Digits {
    /// Eight decimals.
    #[default]
    Eight,
    /// Six decimals.
    Six,
    /// The shortest decimal that single precision reads as the same number.
    Single,
}

impl Digits {
    /// A cell of a table.
    pub fn cell(self, value: f64) -> String {
        match self {
            Self::Eight => format!("{value:.8}"),
            Self::Six => format!("{value:.6}"),
            Self::Single => format!("{}", value as f32),
        }
    }
}

/// How a log is recorded, beside its sensors.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Recording {
    pub digits: Digits,
    /// Standard deviation of a stamp against the distance of rows.
    pub jitter: f64,
    /// Share of rows that are missing.
    pub dropped: f64,
}

impl Recording {
    /// How much later than on their grid rows are measured, in distances of rows.
    pub fn late(&self, rows: usize, random: &mut Random) -> Vec<f64> {
        if self.jitter == 0.0 {
            return vec![0.0; rows];
        }
        let most = FARTHEST * self.jitter;
        (0..rows).map(|_| (self.jitter * random.normal()).clamp(-most, most)).collect()
    }

    /// Which rows are kept: not the ends, which say how long the log is.
    pub fn kept(&self, rows: usize, random: &mut Random) -> Vec<bool> {
        let mut kept = vec![true; rows];
        if self.dropped == 0.0 {
            return kept;
        }
        // a gap has (1 + .. + MOST_DROPPED) / MOST_DROPPED rows in the mean
        let begins = self.dropped * 2.0 / (MOST_DROPPED + 1) as f64;
        let mut row = 2;
        while row + MOST_DROPPED + 2 < rows {
            if random.chance(begins) {
                let gap = 1 + random.below(MOST_DROPPED);
                kept[row..row + gap].fill(false);
                // four neighbours of a gap are there
                row += gap + 2;
            }
            row += 1;
        }
        kept
    }
}

/// Torques that drives give beside their commands: white noise through a lag of first order.
#[derive(Clone, Debug)]
pub struct Disturbance {
    sizes: Vec<f64>,
    random: Random,
}

impl Disturbance {
    /// Of joints with standard deviations [N m]; none if there are no sizes.
    pub fn new(sizes: &[f64], random: Random) -> Self {
        Self { sizes: sizes.to_vec(), random }
    }

    /// Goes on by a step of the plant; the first call begins where it may be at any time.
    pub fn step(&mut self, torques: &mut [f64], is_first: bool) {
        let kept = (-TAU * DISTURBANCE_HZ * STEP_S).exp();
        let (kept, fresh) = if is_first { (0.0, 1.0) } else { (kept, (1.0 - kept * kept).sqrt()) };
        for (torque, size) in torques.iter_mut().zip(&self.sizes) {
            *torque = kept * *torque + fresh * size * self.random.normal();
        }
    }
}

impl Case {
    /// Changes the case to be as its condition says.
    pub(super) fn meet(&mut self, condition: Condition) {
        let random = &mut Random::new(self.number, "condition");
        let is = |one: Condition| condition == one || condition == Condition::Together;
        // all are drawn, so that a condition does not depend on those before it
        let bits = COARSE_BITS[random.below(COARSE_BITS.len())];
        let [jitter, dropped, disturbance] =
            [JITTER, DROPPED, DISTURBANCE].map(|[low, high]| random.log_between(low, high));
        if is(Condition::CoarseEncoder) {
            self.sensors.resolution = TAU / bits.exp2();
            self.sensors.encoder_noise = COARSE_NOISE * self.sensors.resolution;
        }
        let printed = is(Condition::Printed) || is(Condition::CoarseEncoder);
        self.recording = Recording {
            digits: match condition {
                Condition::SinglePrecision => Digits::Single,
                _ if printed => Digits::Six,
                _ => Digits::Eight,
            },
            jitter: if is(Condition::Jitter) { jitter } else { 0.0 },
            dropped: if is(Condition::Dropped) { dropped } else { 0.0 },
        };
        self.relative_disturbance = if is(Condition::Disturbance) { disturbance } else { 0.0 };
        if is(Condition::OwnFriction) {
            self.nominal.mistake_friction(&self.truth, random);
        }
    }
}

impl Nominal {
    /// Friction far from what it is, and known to be so.
    fn mistake_friction(&mut self, truth: &Robot, random: &mut Random) {
        self.friction_std = FRICTION_STD;
        for (joint, real) in self.robot.joints.iter_mut().zip(&truth.joints) {
            let [low, high] = FRICTION_ERROR;
            let mut wrong = |value: f64| value * (1.0 + random.sign() * random.between(low, high));
            joint.drive.viscous = wrong(real.drive.viscous);
            joint.drive.coulomb = wrong(real.drive.coulomb);
        }
    }
}
