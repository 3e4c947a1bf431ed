//! What nobody can know of friction while a joint turns around.
//!
//! A drive that sticks for milliseconds has any friction up to that of sliding, and a filter moves
//! the moment of its reversal: all that takes the sign of a rate is unsure there.

use super::data::{Data, ModelTorques};
use super::floor::rms;
use super::law::Motion;
use super::nominal::{Nominal, Phi};
use super::problem::Fitted;
use super::rows::{PerJoint, torques as torques_of};
use super::signals::Signals;

/// The time by which the filter of positions moves a corner of a rate, times the cutoff of torques.
const CORNER: f64 = 0.05;

/// The deviation of what is anywhere between two values, over their distance.
const BETWEEN: f64 = 0.288_675_134_594_812_9;

/// The share of an event that the filter rings with beside it.
const RINGING: f64 = 0.3;

/// For each row the deviation of torques whose rates are not known better than corners of the
/// filter leave them, by the model and by laws [N m, N].
pub(super) fn turning(data: &Data<'_>, torques: &[ModelTorques], laws: &[Fitted<'_>]) -> Vec<f64> {
    let mut unsure = vec![0.0; data.rows()];
    for (log, (signals, torques)) in data.signals.iter().zip(torques).enumerate() {
        let bends = bends(signals, |moved| {
            let total = torques_of(data.nominal, moved, &torques.phi);
            let motion = Motion { total: &total, ..torques.motion(data.nominal, moved) };
            let mut sum = total.clone();
            for fitted in laws {
                let response = fitted.law.response(motion, &fitted.values);
                for (&equation, torque) in response.equations.iter().zip(&response.torque) {
                    sum[equation].iter_mut().zip(torque).for_each(|(sum, torque)| *sum += torque);
                }
            }
            sum
        });
        for stretch in data.stretches.iter().filter(|stretch| stretch.log == log) {
            let sizes: Vec<f64> =
                bends[stretch.equation].iter().map(|b| BETWEEN * b.abs()).collect();
            let apart = signals.rows_of(&sizes);
            let rows = &mut unsure[stretch.first..stretch.first + stretch.rows];
            for (k, row) in rows.iter_mut().enumerate() {
                // The filter rings, and what is unsure of its input shifts where it has no output.
                let beside = [k.saturating_sub(1), (k + 1).min(apart.len() - 1)];
                let beside = beside.iter().fold(0.0_f64, |most, &k| most.max(apart[k].abs()));
                *row = apart[k].abs().max(RINGING * beside);
            }
        }
    }
    unsure
}

/// What torques would be less if friction kept its sign until a reversal has left the corner
/// behind it: for each joint at the samples of the motion [N m, N].
pub(super) fn late_friction(nominal: &Nominal<'_>, signals: &Signals, phi: &Phi) -> PerJoint {
    let mut bends = bends(signals, |moved| torques_of(nominal, moved, phi));
    bends.truncate(signals.joints());
    for (joint, bends) in bends.iter_mut().enumerate() {
        let [_, accelerations] = signals.of_drive(joint);
        for (bend, acceleration) in bends.iter_mut().zip(accelerations) {
            *bend = -bend.abs() * acceleration.signum();
        }
    }
    bends
}

/// The second difference of torques by rates over what a corner of the filter hides of them: of a
/// step its height, and nothing of a slope.
fn bends(signals: &Signals, torques: impl Fn(&Signals) -> PerJoint) -> PerJoint {
    let corner_s = CORNER / signals.torque_hz;
    let moved = |sign: f64| {
        let mut moved = signals.clone();
        for joint in 0..signals.joints() {
            let by = sign * corner_s * rms(signals.of_drive(joint)[1]);
            let motor = moved.motor[joint].iter_mut().map(|[_, rates, _]| rates);
            for rates in motor.chain([&mut moved.qd[joint]]) {
                rates.iter_mut().for_each(|rate| *rate += by);
            }
        }
        torques(&moved)
    };
    let [slower, as_is, faster] = [-1.0, 0.0, 1.0].map(moved);
    let of = |equation: usize| {
        let [a, b, c] = [&slower, &as_is, &faster].map(|all| &all[equation]);
        (0..b.len()).map(|k| a[k] - 2.0 * b[k] + c[k]).collect()
    };
    (0..as_is.len()).map(of).collect()
}
