//! What nobody can know of friction while a joint turns around.
//!
//! A drive that sticks for milliseconds has any friction up to that of sliding, and a filter moves
//! the moment of its reversal: all that takes the sign of a rate is unsure there. While it is seen
//! to rest, friction goes from one side to the other, but how is not known.

use super::data::{Data, ModelTorques};
use super::floor::rms;
use super::law::Motion;
use super::nominal::{Nominal, Phi};
use super::problem::Fitted;
use super::rows::{PerJoint, torques as torques_of};
use super::signals::Signals;
use nalgebra::DMatrix;

/// The time by which the filter of positions moves a corner of a rate, times the cutoff of torques.
const CORNER: f64 = 0.05;

/// The deviation of what is anywhere between two values, over their distance.
const BETWEEN: f64 = 0.288_675_134_594_812_9;

/// The share of an event that the filter rings with beside it.
const RINGING: f64 = 0.3;

/// How far a torque is not known [N m, N].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Unsure {
    /// Since its rate is not known better than corners of the filter leave it.
    pub(super) corner: f64,
    /// Since the drive rests.
    pub(super) rest: f64,
}

impl Unsure {
    /// The deviation of a row, with a share of that of corners.
    pub(super) fn deviation(self, share: f64) -> f64 {
        (share * self.corner).hypot(self.rest)
    }
}

/// For each row how far its torque is not known by the model and by laws.
pub(super) fn turning(
    data: &Data<'_>,
    torques: &[ModelTorques],
    laws: &[Fitted<'_>],
) -> Vec<Unsure> {
    let mut unsure = vec![Unsure::default(); data.rows()];
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
        for stretch in data.stretches.iter().filter(|stretch| stretch.log == log) {
            let sizes: Vec<f64> =
                bends[stretch.equation].iter().map(|b| BETWEEN * b.abs()).collect();
            let apart = signals.rows_of(&sizes);
            let rows = &mut unsure[stretch.first..stretch.first + stretch.rows];
            if let [Some(a), Some(b)] = rests.each_ref().map(|torques| torques.as_ref()) {
                let [a, b] = [a, b].map(|torques| signals.rows_of(&torques[stretch.equation]));
                let both = a.iter().zip(&b).map(|(a, b)| (a - b).abs());
                rows.iter_mut().zip(both).for_each(|(row, rest)| row.rest = rest);
            }
            for (k, row) in rows.iter_mut().enumerate() {
                // The filter rings, and what is unsure of its input shifts where it has no output.
                let beside = [k.saturating_sub(1), (k + 1).min(apart.len() - 1)];
                let beside = beside.iter().fold(0.0_f64, |most, &k| most.max(apart[k].abs()));
                row.corner = apart[k].abs().max(RINGING * beside);
            }
        }
    }
    unsure
}

/// Tells drives at rest what their inertia and friction come to by the model: when a drive stops,
/// all others are free to go on with the torques that they have, and so is what is behind a spring.
pub(super) fn settle(nominal: &Nominal<'_>, signals: &mut Signals, phi: &Phi) {
    let joints = signals.joints();
    for joint in 0..joints {
        let t = signals.t.clone();
        let rests = signals.rests_mut(joint);
        let Some(creep) = rests.first().map(|rest| rest.creep) else { continue };
        let stops: Vec<usize> = rests.iter().map(|rest| rest.first(&t)).collect();
        let stopped = signals.at(&stops);
        let torques = |change: &dyn Fn(&mut Signals)| {
            let mut moved = stopped.clone();
            change(&mut moved);
            torques_of(nominal, &moved, phi)
        };
        let creeps = |rate: f64| torques(&|moved| moved.drive_mut(joint)[0].fill(rate));
        let [back, forth] = [-creep, creep].map(creeps);
        let faster = |all: &mut Vec<f64>| all.iter_mut().for_each(|one| *one += 1.0);
        let columns: Vec<PerJoint> = match stopped.motor[joint] {
            Some(_) => vec![torques(&|moved| faster(moved.drive_mut(joint)[1]))],
            None => (0..joints).map(|of| torques(&|moved| faster(&mut moved.qdd[of]))).collect(),
        };
        let still = torques(&|_| ());
        for (k, rest) in signals.rests_mut(joint).iter_mut().enumerate() {
            let entry = |row: usize, column: usize| columns[column][row][k] - still[row][k];
            let inertia = match columns.len() {
                1 => Some(entry(joint, 0)),
                _ => DMatrix::from_fn(joints, joints, entry)
                    .cholesky()
                    .map(|matrix| 1.0 / matrix.inverse()[(joint, joint)]),
            };
            let friction = 0.5 * (forth[joint][k] - back[joint][k]);
            rest.settle(inertia.unwrap_or(0.0), friction);
        }
        signals.rest(joint);
    }
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
            moved.rest(joint);
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
