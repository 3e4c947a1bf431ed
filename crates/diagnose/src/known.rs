//! What the rows of a joint tell of its torque, where its drive turns around or rests.
//!
//! A drive passes each reversal late by a time of its own: it sticks for milliseconds, and its
//! readings are of another time than its torque. While it rests, its friction is anything up to
//! that of sliding. Noise is taken to be even in time, so that rows count by what is not known of
//! them. That is of the motion and repeats with it: many laps tell no more of it than one.

use super::nominal::{Nominal, Phi};
use super::rows::{PerJoint, torques as torques_of};
use super::signals::{Shared, Signals};
use crate::policy::known::{CREEP, RINGING};
use denavit_evidence::policy;
use denavit_measure::JointIndex;
use denavit_numerics::derivative;

/// For each joint what each row of a log counts, from 0 to 1.
pub(super) fn weights(nominal: &Nominal<'_>, signals: &Signals, phi: &Phi) -> PerJoint {
    let heights = heights(nominal, signals, phi);
    let samples = signals.samples() as f64 * signals.step_s / signals.log_step_s;
    let laps = signals.laps.map_or(1.0, |laps| samples / laps.period);
    let of_joint = |(joint, heights): (usize, &Vec<f64>)| {
        let level = policy::NOISE_LEVEL * nominal.usual[joint][0];
        let weight = |unknown: &f64| {
            if *unknown == 0.0 { 1.0 } else { level / level.hypot(*unknown) }
        };
        let late: Vec<f64> =
            late(signals, JointIndex(joint), heights).iter().map(|by| by.abs()).collect();
        let [late, resting] =
            [signals.rows_of(&late), resting(signals, JointIndex(joint), heights)];
        let of_lap = late.iter().zip(resting).map(|(a, b)| a.hypot(b));
        let unknown: Vec<f64> = of_lap.map(|unknown| laps.sqrt() * unknown).collect();
        even(with_ringing(&unknown).iter().map(weight).collect())
    };
    heights.iter().enumerate().map(of_joint).collect()
}

/// Weights of which the largest is 1: where all rows are as little known, noise is even again.
fn even(weights: Vec<f64>) -> Vec<f64> {
    let most = weights.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    weights.into_iter().map(|weight| weight / most).collect()
}

/// What friction of some height lacks at the samples of the motion where it turns around later.
/// What a drive holds with at rest is unknown itself, and has no side.
fn late(signals: &Signals, joint: JointIndex, heights: &[f64]) -> Vec<f64> {
    let side = |rate: f64| if rate == 0.0 { 0.0 } else { rate.signum() };
    let sides = heights.iter().zip(signals.creeping(joint));
    let step: Vec<f64> = sides.map(|(height, rate)| height * side(rate)).collect();
    derivative(&step, signals.step_s).iter().map(|by| -policy::LATE_S * by).collect()
}

/// For each joint what its friction lacks where all its reversals are late by the same time.
pub(super) fn late_reversals(nominal: &Nominal<'_>, signals: &Signals, phi: &Phi) -> PerJoint {
    let heights = heights(nominal, signals, phi);
    heights
        .iter()
        .enumerate()
        .map(|(joint, heights)| late(signals, JointIndex(joint), heights))
        .collect()
}

/// What friction of some height may differ by in the rows, since the drive rests: up to where it
/// needs all that it slides with, for what it needs beyond that is to be told.
fn resting(signals: &Signals, joint: JointIndex, heights: &[f64]) -> Vec<f64> {
    let mut resting = vec![0.0; heights.len()];
    for rest in &signals.rests[joint.0] {
        let samples = rest.held(&signals.t);
        resting[samples.clone()].copy_from_slice(&heights[samples]);
    }
    signals.rows_of(&resting)
}

/// What is unknown in rows, or beside them, where the filter rings.
fn with_ringing(rows: &[f64]) -> Vec<f64> {
    let of = |k: usize| {
        let near = &rows[k.saturating_sub(1)..(k + 2).min(rows.len())];
        near.iter().fold(rows[k].abs(), |most, row| most.max(RINGING * row.abs()))
    };
    (0..rows.len()).map(of).collect()
}

/// How high the step of each joint's friction is at a reversal, with what a model may lack of it.
fn heights(nominal: &Nominal<'_>, signals: &Signals, phi: &Phi) -> PerJoint {
    let creeping = |direction: f64| {
        let mut moved = signals.clone();
        for joint in 0..signals.joints() {
            moved.drive_mut(JointIndex(joint))[0].fill(direction * CREEP);
            Shared::make_mut(&mut moved.qd[joint]).fill(direction * CREEP);
        }
        torques_of(nominal, &moved, phi)
    };
    let [forth, back] = [1.0, -1.0].map(creeping);
    let of_joint = |joint: usize| {
        let lacking = policy::STEP * nominal.usual[joint][0];
        let both = forth[joint].iter().zip(&back[joint]);
        both.map(|(forth, back)| 0.5 * (forth - back).abs() + lacking).collect()
    };
    (0..signals.joints()).map(of_joint).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Filters;
    use denavit_codegen::regressor::functions::modelled;
    use denavit_measure::log::{JointSignals, MeasuredLog};
    use denavit_plants::regression::RegressionModel;
    use std::f64::consts::TAU;

    const SLED: &str = r#"{
      "format": "denavit-model/1", "name": "sled", "convention": "standard",
      "gravity": [0, -9.81, 0],
      "links": [{
        "name": "sled", "joint": {"type": "prismatic", "theta": 0, "d": 0, "a": 0, "alpha": 0},
        "body": {"mass": 2, "com": [0, 0, 0], "about": "com",
                 "inertia": {"xx": 1, "yy": 1, "zz": 1, "xy": 0, "xz": 0, "yz": 0}}
      }],
      "drives": {"sled": {"viscous": 0, "coulomb": 1}}
    }"#;

    const COULOMB: f64 = 1.0;
    const HZ: f64 = 0.5;

    /// A sled that an exact torque moves in waves of a period of 2 s, for so many samples.
    fn waves(samples: i32) -> MeasuredLog {
        let at = |k: i32| TAU * HZ * 0.002 * f64::from(k);
        let q: Vec<f64> = (0..samples).map(|k| 0.2 * at(k).sin()).collect();
        let torque = |k: i32| {
            let acceleration = -0.2 * (TAU * HZ).powi(2) * at(k).sin();
            2.0 * acceleration + COULOMB * at(k).cos().signum()
        };
        let tau = Some((0..samples).map(torque).collect());
        let joints = vec![JointSignals { q, tau, ..JointSignals::default() }];
        MeasuredLog { file: "waves".into(), step_s: 0.002, joints, ..MeasuredLog::default() }
    }

    /// What a test finds with the model of the sled, and waves of so many samples.
    fn in_waves<T>(samples: i32, find: impl Fn(&Nominal<'_>, &Signals, &Phi) -> T) -> T {
        let robot = denavit_codegen::model::read("sled", SLED.as_bytes()).expect("a model");
        let model = RegressionModel::new(&robot, modelled(&robot), &[]).expect("parameters");
        let signals = Signals::new(waves(samples), Filters::of_torques(10.0)).expect("long enough");
        let logs = [signals];
        let nominal = Nominal::new(&model).moving_as(&logs);
        let ([signals], phi) = (&logs, nominal.phi(&vec![0.0; nominal.len()]));
        find(&nominal, signals, &phi)
    }

    #[test]
    fn rows_at_reversals_count_less_and_late_ones_lack_an_impulse() {
        in_waves(8000, rows_and_impulses);
    }

    fn rows_and_impulses(nominal: &Nominal<'_>, signals: &Signals, phi: &Phi) {
        let [weights] = &weights(nominal, signals, phi)[..] else { panic!("one joint") };
        for (t, weight) in signals.at_rows(&signals.t).iter().zip(weights) {
            // The rate is that of a cosine, and 0 a quarter of a period after its extremes.
            let from_reversal_s =
                ((t * 2.0 * HZ - 0.5).round() - (t * 2.0 * HZ - 0.5)).abs() / (2.0 * HZ);
            match from_reversal_s {
                near if near < 0.02 => assert!(*weight < 0.1, "{t}: {weight}"),
                far if far > 0.3 => assert!(*weight > 0.99, "{t}: {weight}"),
                _ => {}
            }
        }

        // Of a step of friction that is late by a time, that time its height is missing.
        let [late] = &late_reversals(nominal, signals, phi)[..] else { panic!("one joint") };
        let height = COULOMB + policy::STEP * nominal.usual[0][0];
        let half = (1.0 / HZ / signals.step_s / 2.0) as usize;
        for (k, samples) in late.chunks_exact(half).enumerate() {
            let (first, last) = (k * half, (k + 1) * half - 1);
            let [from, to] = [first, last].map(|k| signals.qd[0][k].signum());
            let impulse = signals.step_s * samples.iter().sum::<f64>();
            let wanted = -policy::LATE_S * height * (to - from);
            assert!((impulse - wanted).abs() < 1e-3 * policy::LATE_S, "{k}: {impulse} {wanted}");
        }
    }

    #[test]
    fn laps_tell_no_more_of_reversals_than_one_lap() {
        let near_reversals = |nominal: &Nominal<'_>, signals: &Signals, phi: &Phi| -> f64 {
            let rates = signals.at_rows(&signals.qd[0]);
            let weights = &weights(nominal, signals, phi)[0];
            let near = rates.iter().zip(weights).filter(|(rate, _)| rate.abs() < 0.03);
            near.map(|(_, weight)| weight * weight).sum()
        };
        let [few, many] = [5000, 20_000].map(|samples| in_waves(samples, near_reversals));
        assert!((many / few - 1.0).abs() < 0.25, "{few} {many}");
    }
}
