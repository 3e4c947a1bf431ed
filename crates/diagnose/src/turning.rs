//! What nobody can know of friction while a joint turns around, and what every model has.
//!
//! A drive that sticks for milliseconds has any friction up to that of sliding, and a filter moves
//! the moment of its reversal: all that takes the sign of a rate is unsure there. While it is seen
//! to rest, friction goes from one side to the other, but how is not known.

use super::known::late_reversals;
use super::nominal::{Nominal, Phi};
use super::rows::{PerJoint, torques as torques_of};
use super::signals::Signals;
use denavit_evidence::policy;
use denavit_measure::JointIndex;
use std::ops::Range;

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
            if friction > 0.0 { [needed / friction, friction] } else { [0.0; 2] }
        };
        let sides: Vec<[f64; 2]> = resting.iter().zip(back.iter().zip(&forth)).map(side).collect();
        let mut first = 0;
        for (rest, range) in signals.rests[joint.0].iter_mut().zip(ranges) {
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
