//! What nobody can know of friction while a joint turns around, and what every model has.
//!
//! A drive that sticks for milliseconds has any friction up to that of sliding, and a filter moves
//! the moment of its reversal: all that takes the sign of a rate is unsure there. While it is seen
//! to rest, friction goes from one side to the other, but how is not known.

use super::data::{Data, ModelTorques};
use super::floor::rms;
use super::known::{late_reversals, with_ringing};
use super::law::Motion;
use super::nominal::{Nominal, Phi};
use super::problem::Fitted;
use super::rows::{PerJoint, torques as torques_of};
use super::signals::Signals;
use crate::policy::turning::{BETWEEN, CORNER};
use denavit_evidence::policy;
use denavit_measure::JointIndex;
use std::ops::Range;

/// For each row how far its torque is not known by the model and by laws [N m, N]: since corners of
/// the filter leave rates uncertain, and since drives rest.
pub(super) fn turning(data: &Data<'_>, torques: &[ModelTorques], laws: &[Fitted<'_>]) -> Vec<f64> {
    let mut unsure = vec![0.0; data.rows()];
    for (log, (signals, torques)) in data.signals.iter().zip(torques).enumerate() {
        let all = |moved: &Signals| {
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
        };
        let bends = bends(signals, all);
        let rests = [-0.5, 0.5].map(|by| Some(all(&signals.with_rests_bent(by)?)));
        for stretch in data.stretches.iter().filter(|stretch| stretch.log.0 == log) {
            let sizes: Vec<f64> =
                bends[stretch.equation].iter().map(|b| BETWEEN * b.abs()).collect();
            let apart = signals.rows_of(&sizes);
            // What is unsure of the filter's input shifts where it has no output.
            let mut corners = with_ringing(&apart);
            if let [Some(a), Some(b)] = rests.each_ref().map(|torques| torques.as_ref()) {
                let [a, b] = [a, b].map(|torques| signals.rows_of(&torques[stretch.equation]));
                let both = a.iter().zip(&b).map(|(a, b)| a - b);
                corners
                    .iter_mut()
                    .zip(both)
                    .for_each(|(corner, rest)| *corner = corner.hypot(rest));
            }
            unsure[stretch.range()].copy_from_slice(&corners);
        }
    }
    unsure
}

/// Tells drives at rest which friction balances their torques by the model, as long as what they
/// slide with is enough for that.
pub(super) fn settle(nominal: &Nominal<'_>, signals: &mut Signals, phi: &Phi) {
    for joint in (0..signals.joints()).map(JointIndex) {
        let Some(measured) = signals.measured_within(joint) else { continue };
        let (t, rests) = (&signals.t, &signals.rests[joint.0]);
        let Some(creep) = rests.first().map(|rest| rest.creep) else { continue };
        let ranges: Vec<Range<usize>> = rests.iter().map(|rest| rest.samples(t)).collect();
        let resting: Vec<usize> = ranges.iter().cloned().flatten().collect();
        let at_rest = signals.at(&resting);
        let [back, forth] = [-creep, creep].map(|rate| {
            let mut moved = at_rest.clone();
            moved.drive_mut(joint)[0].fill(rate);
            torques_of(nominal, &moved, phi).swap_remove(joint.0)
        });
        let side = |(k, (back, forth)): (&usize, (&f64, &f64))| {
            let friction = 0.5 * (forth - back);
            let needed = measured[*k] - 0.5 * (forth + back);
            if friction > 0.0 { needed / friction } else { 0.0 }
        };
        let sides: Vec<f64> = resting.iter().zip(back.iter().zip(&forth)).map(side).collect();
        let mut first = 0;
        for (rest, range) in signals.rests_mut(joint).iter_mut().zip(ranges) {
            let last = first + range.len();
            if first < last {
                rest.settle(&sides[first..last]);
            }
            first = last;
        }
        signals.rest(joint);
    }
}

/// What every joint may have that is too small for a name, one deviation of each.
pub(super) const PER_JOINT: usize = 4;

/// For each joint what its equation may have that is too small for a name, at the samples of the
/// motion [N m, N]: an offset, viscous and Coulomb friction, and reversals that are all late.
pub(super) fn unnamed(nominal: &Nominal<'_>, signals: &Signals, phi: &Phi) -> Vec<PerJoint> {
    let late = late_reversals(nominal, signals, phi);
    let of_joint = |joint: usize| {
        let rates = &signals.of_drive(JointIndex(joint))[0];
        let [torque, rate] = nominal.usual[joint];
        let size = policy::UNNAMED * torque;
        let slope = if rate > 0.0 { size / rate } else { 0.0 };
        let of_rates = |of: &dyn Fn(f64) -> f64| rates.iter().map(|rate| of(*rate)).collect();
        vec![
            of_rates(&|_| size),
            of_rates(&|rate| slope * rate),
            of_rates(&|rate| size * rate.signum()),
            late[joint].clone(),
        ]
    };
    (0..signals.joints()).map(of_joint).collect()
}

/// The second difference of torques by rates over what a corner of the filter hides of them: of a
/// step its height, and nothing of a slope.
fn bends(signals: &Signals, torques: impl Fn(&Signals) -> PerJoint) -> PerJoint {
    let corner_s = CORNER / signals.torque_hz;
    let moved = |sign: f64| {
        let mut moved = signals.clone();
        for joint in 0..signals.joints() {
            let by = sign * corner_s * rms(signals.of_drive(JointIndex(joint))[1]);
            let motor = moved.motor[joint].iter_mut().map(|[_, rates, _]| rates);
            for rates in motor.chain([&mut moved.qd[joint]]) {
                rates.iter_mut().for_each(|rate| *rate += by);
            }
            moved.rest(JointIndex(joint));
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
