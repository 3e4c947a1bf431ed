//! Whether a trajectory keeps the limits: its references at many more times than the solver saw,
//! with Coulomb friction as it is.

use super::fault::LimitKind;
use super::model::{Evaluators, ExcitedModel, JointLimits};
use super::objective::{Excitation, Stacked};
use super::stack::{Signs, Stack};
use crate::policy::check::DEAD;
use denavit_plants::trajectory::Reference;

/// The extremes of a quantity of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremes {
    /// Lowest and highest value.
    pub range: [f64; 2],
    /// Lowest and highest value that is allowed.
    pub limits: [f64; 2],
    /// The distance from the middle of the limits, at most 1 where they hold.
    pub usage: f64,
}

impl Extremes {
    fn of(values: &[f64], limits: [f64; 2]) -> Self {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let (middle, half) = (0.5 * (limits[0] + limits[1]), 0.5 * (limits[1] - limits[0]));
        let usage = (high - middle).max(middle - low) / half;
        // what is not a number keeps no limit
        let usage = if usage.is_finite() { usage } else { f64::INFINITY };
        Self { range: [low, high], limits, usage }
    }
}

/// The use that a joint makes of its limits.
#[derive(Clone, Debug, PartialEq)]
pub struct JointUse {
    /// The joint's name.
    pub name: String,
    /// Whether it slides (m, N) or turns (rad, N m).
    pub slides: bool,
    /// Of a joint that moves.
    pub position: Option<Extremes>,
    /// Of a joint that moves.
    pub velocity: Option<Extremes>,
    /// Of a joint that moves.
    pub acceleration: Option<Extremes>,
    /// Of a joint with a torque limit.
    pub torque: Option<Extremes>,
}

/// A trajectory against the limits, and what it excites.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// How well the parameters are excited.
    pub excitation: Excitation,
    /// The use that it makes of the limits.
    pub limits: LimitUse,
}

/// The use that a trajectory makes of the limits.
#[derive(Clone, Debug, PartialEq)]
pub struct LimitUse {
    /// The joints, in the order of q.
    pub joints: Vec<JointUse>,
    /// The point that comes closest to the ground, and its height \[m\].
    pub lowest: Option<(String, f64)>,
    /// The height that points must keep \[m\].
    pub clearance_m: f64,
    /// Limits that the model does not give, by joint [rad/s, m/s; per s^2].
    pub assumed: Vec<(String, LimitKind, f64)>,
}

impl LimitUse {
    /// The largest use; a point that is too low counts as more than 1.
    pub fn worst(&self) -> f64 {
        let uses = self
            .joints
            .iter()
            .flat_map(|joint| [joint.position, joint.velocity, joint.acceleration, joint.torque]);
        let uses = uses.flatten().map(|extremes| extremes.usage).fold(0.0, f64::max);
        let missing = self.lowest.as_ref().map_or(0.0, |(_, gap)| self.clearance_m - gap);
        let is_low = missing > 0.0 || missing.is_nan();
        uses.max(if is_low { 1.0 + missing.abs().max(1e-6) } else { 0.0 })
    }
}

impl Check {
    /// Whether all limits hold.
    pub fn is_feasible(&self) -> bool {
        self.limits.worst() <= 1.0 + 1e-9
    }

    /// Whether an estimate from it would find all parameters that are meant, and not take the
    /// least visible one for one that nothing is said of.
    pub fn excites(&self) -> bool {
        self.excitation.condition.is_finite() && self.excitation.condition_scaled * DEAD < 1.0
    }
}

/// Checks references, one for each joint, at `steps` + 1 even times of a lap.
pub(super) fn check(
    model: &ExcitedModel,
    stack: &Stack,
    evaluators: &mut Evaluators,
    references: &[Reference],
    lap: Lap,
) -> Check {
    let motion = lap.motion(references);
    let columns: Vec<&[f64]> = motion.iter().map(Vec::as_slice).collect();
    let limits = of_motion(model, evaluators, &columns, lap);
    let w = stack.w(model, evaluators, &columns, Signs::Exact);
    Check { excitation: Stacked::new(w).excitation(), limits }
}

/// The use that such references make of the limits alone, which takes less time.
pub(super) fn limit_use(
    model: &ExcitedModel,
    evaluators: &mut Evaluators,
    references: &[Reference],
    lap: Lap,
) -> LimitUse {
    let motion = lap.motion(references);
    let columns: Vec<&[f64]> = motion.iter().map(Vec::as_slice).collect();
    of_motion(model, evaluators, &columns, lap)
}

/// The same of positions of all joints, their velocities, and their accelerations.
fn of_motion(
    model: &ExcitedModel,
    evaluators: &mut Evaluators,
    motion: &[&[f64]],
    lap: Lap,
) -> LimitUse {
    let n = model.joints.len();
    let torques = model.torque_columns(evaluators, motion);
    let limited = model.limited();
    let joint = |(index, limits): (usize, &JointLimits)| {
        let moves = limits.held.is_none();
        let of = |order: usize, range: [f64; 2]| {
            moves.then(|| Extremes::of(motion[order * n + index], range))
        };
        let (velocity, acceleration) = (limits.velocity, limits.acceleration);
        JointUse {
            name: limits.name.clone(),
            slides: limits.slides,
            position: of(0, limits.position),
            velocity: of(1, [-velocity, velocity]),
            acceleration: of(2, [-acceleration, acceleration]),
            torque: limits.torque.filter(|_| limited.contains(&index)).map(|range| {
                let coulomb = model.coulomb(index);
                let signed = torques[index].iter().zip(motion[n + index]).map(|(torque, rate)| {
                    // friction reaches its full value with the smallest rate, and may oppose
                    // either way at rest
                    let sign = if *rate != 0.0 { rate.signum() } else { torque.signum() };
                    torque + coulomb * sign
                });
                Extremes::of(&signed.collect::<Vec<f64>>(), range)
            }),
        }
    };
    let joints = model.joints.iter().enumerate().map(joint).collect();
    let gaps = model.gap_columns(evaluators, &motion[..n]);
    let lowest = |(point, gaps): (usize, &Vec<f64>)| {
        let least = gaps.iter().copied().fold(f64::INFINITY, |a, b| if b >= a { a } else { b });
        (model.points[point].name.clone(), least)
    };
    let lowest = gaps.iter().enumerate().map(lowest).min_by(|a, b| a.1.total_cmp(&b.1));
    let assumed = model.joints.iter().flat_map(assumed).collect();
    LimitUse { joints, lowest, clearance_m: lap.clearance_m, assumed }
}

/// The limits of a joint that the model does not give.
fn assumed(limits: &JointLimits) -> Vec<(String, LimitKind, f64)> {
    let of = |kind: &LimitKind| match kind {
        LimitKind::Velocity => limits.velocity,
        _ => limits.acceleration,
    };
    limits.assumed.iter().map(|kind| (limits.name.clone(), *kind, of(kind))).collect()
}

/// What a trajectory is checked over.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lap {
    pub(super) duration_s: f64,
    pub(super) steps: usize,
    pub(super) clearance_m: f64,
}

impl Lap {
    /// Positions of all joints at its times, their velocities, and their accelerations.
    fn motion(&self, references: &[Reference]) -> Vec<Vec<f64>> {
        let n = references.len();
        let mut motion = vec![Vec::with_capacity(self.steps + 1); 3 * n];
        for k in 0..=self.steps {
            // the very end belongs to the lap, not to the rest after it
            let t_s = (self.duration_s * k as f64 / self.steps as f64).min(self.duration_s);
            for (joint, reference) in references.iter().enumerate() {
                let setpoint = reference.at(t_s);
                motion[joint].push(setpoint.position);
                motion[n + joint].push(setpoint.rate);
                motion[2 * n + joint].push(setpoint.acceleration);
            }
        }
        motion
    }
}
