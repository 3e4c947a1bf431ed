//! Whether a log says what it seems to say: units, swapped joints, signals that do not move.

use super::fault::{LogFault, LogRemark, Suspicion};
use super::{JointSignals, MeasuredLog};
use denavit_plants::regression::RegressionJoint;

/// A step of the time from which on it hardly counts seconds.
const SLOWEST_STEP_S: f64 = 0.1;

/// A step of the time below which it hardly counts seconds: a millisecond in days is 1e-8, and no
/// loop of a drive has a rate of a megahertz.
const FASTEST_STEP_S: f64 = 1e-6;

/// Seconds in an hour.
const HOUR_S: f64 = 3600.0;

/// Changes of a torque below this are rounding [N m, N].
const ROUNDING: f64 = 1e-12;

/// Times its limit that a torque goes to if the limits of a trajectory are the model's.
const FAR_BEYOND: f64 = 3.0;

/// Two signals that are one.
const SAME: f64 = 0.98;

/// Two signals that are not one.
const OTHER: f64 = 0.7;

/// What looks wrong, and what is worth a remark.
#[derive(Default)]
pub(super) struct Findings {
    pub(super) faults: Vec<LogFault>,
    pub(super) suspicions: Vec<Suspicion>,
    pub(super) remarks: Vec<LogRemark>,
}

/// Looks at every signal.
pub(super) fn check(log: &MeasuredLog, joints: &[RegressionJoint]) -> Findings {
    let mut found = Findings::default();
    time_unit(log, &mut found);
    let moving: Vec<bool> = log.joints.iter().map(moves).collect();
    let has_drives = joints.iter().any(|joint| joint.is_driven);
    for ((signals, joint), &moves) in log.joints.iter().zip(joints).zip(&moving) {
        position(signals, joint, &mut found);
        if moves {
            logged_rate((signals, log.step_s), joint, &mut found);
        } else if !joint.is_base {
            found.remarks.push(LogRemark::Resting { joint: joint.name.clone() });
        }
        torque(signals, (joint, has_drives), moves, &mut found);
    }
    if !moving.contains(&true) {
        found.faults.push(LogFault::NothingMoves);
    }
    swapped(log, joints, &moving, &mut found);
    found
}

fn time_unit(log: &MeasuredLog, found: &mut Findings) {
    if log.step_s > SLOWEST_STEP_S {
        // of microseconds these would be slower than any log
        let factor = match log.step_s {
            step if step > SLOWEST_STEP_S * 1e6 => 1e-9,
            step if step >= 50.0 => 1e-6,
            _ => 1e-3,
        };
        found.suspicions.push(Suspicion::TimeUnit { step: log.step_s, factor });
    } else if log.step_s < FASTEST_STEP_S {
        found.suspicions.push(Suspicion::TimeUnit { step: log.step_s, factor: HOUR_S });
    }
}

fn range(column: &[f64]) -> [f64; 2] {
    column.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &value| {
        [low.min(value), high.max(value)]
    })
}

/// A joint moves if it goes further than rounding and the steps of its encoder.
fn moves(joint: &JointSignals) -> bool {
    let [low, high] = range(&joint.q);
    high - low > (4.0 * joint.step.unwrap_or(0.0)).max(1e-7 * high.abs().max(low.abs()).max(1e-3))
}

fn position(signals: &JointSignals, joint: &RegressionJoint, found: &mut Findings) {
    let [low, high] = range(&signals.q);
    let column = format!("q_{}", joint.name);
    let largest = low.abs().max(high.abs());
    // A joint without limits may turn on and on: its velocities tell its unit, not its size.
    if let Some(limits) = joint.position_limits {
        let slack = 0.02 * (limits[1] - limits[0]);
        let beyond = [low < limits[0] - slack, high > limits[1] + slack];
        let reach = limits[0].abs().max(limits[1].abs());
        if !joint.slides && largest > 1.5 * reach && largest > 6.0 {
            found.suspicions.push(Suspicion::Degrees { column, largest });
        } else if beyond[0] || beyond[1] {
            let value = if beyond[0] { low } else { high };
            found.suspicions.push(Suspicion::BeyondLimits { column, value, limits });
        }
    }
    if let Some(step) = signals.step {
        let own = (format!("q_{}", joint.name), step);
        // one remark for all joints
        let steps = found.remarks.iter_mut().find_map(|remark| match remark {
            LogRemark::Steps { columns } => Some(columns),
            _ => None,
        });
        match steps {
            Some(columns) => columns.push(own),
            None => found.remarks.push(LogRemark::Steps { columns: vec![own] }),
        }
    }
}

/// The integral of a rate against its position: neither noise nor steps of an encoder matter there,
/// as they would in a derivative.
fn logged_rate(
    (signals, step_s): (&JointSignals, f64),
    joint: &RegressionJoint,
    found: &mut Findings,
) {
    let Some(logged) = &signals.qd else { return };
    let column = format!("qd_{}", joint.name);
    let (position, travelled) = (level(&signals.q), level(&integral(logged, step_s)));
    let correlation = correlation(&travelled, &position);
    // The swapped ones are found below.
    if correlation.abs() < OTHER {
        found.suspicions.push(Suspicion::NotTheRate { column, correlation });
        return;
    }
    let ratio = slope(&position, &travelled);
    if !(0.8..1.25).contains(&ratio) {
        found.suspicions.push(Suspicion::RateScale { column, ratio });
    }
}

fn torque(
    signals: &JointSignals,
    (joint, has_drives): (&RegressionJoint, bool),
    moves: bool,
    found: &mut Findings,
) {
    let Some(torque) = &signals.tau else { return };
    let [low, high] = range(torque);
    let column = format!("tau_{}", joint.name);
    if joint.is_base {
        return;
    }
    if high - low < ROUNDING {
        // what has no drive in a model with drives has no torque either
        let is_passive = low.abs() < ROUNDING && !joint.is_driven && has_drives;
        if moves && !is_passive {
            found.suspicions.push(Suspicion::ConstantTorque { column });
        }
        return;
    }
    if let Some([least, most]) = joint.torque_limits {
        let limit = least.abs().max(most.abs());
        let is_beyond = |value: f64| value.abs() > FAR_BEYOND * limit;
        if limit > 0.0 && (is_beyond(low) || is_beyond(high)) {
            let samples = torque.iter().filter(|value| is_beyond(**value)).count();
            let (column, value) = (column.clone(), if is_beyond(low) { low } else { high });
            found.suspicions.push(Suspicion::BeyondTorque { column, value, limit, samples });
        }
    }
    for value in [low, high] {
        // Samples that stand at the very extreme, five or more at once.
        let mut run = 0;
        let mut at_once = 0;
        let mut count = 0;
        for &one in torque {
            run = if one == value { run + 1 } else { 0 };
            at_once = at_once.max(run);
            count += usize::from(one == value);
        }
        let share = count as f64 / torque.len() as f64;
        if at_once >= 5 && share > 0.002 {
            let column = column.clone();
            found.remarks.push(LogRemark::Saturated { column, share, value });
        }
    }
}

/// q of one joint fits the rate, or the reference, of another, and not its own.
fn swapped(log: &MeasuredLog, joints: &[RegressionJoint], moving: &[bool], found: &mut Findings) {
    let fits = |a: usize, b: usize| {
        let own = &log.joints[a].q;
        let by_rate = log.joints[b].qd.as_ref().filter(|_| moving[a]);
        let by_rate =
            by_rate.map(|rate| correlation(&level(own), &level(&integral(rate, log.step_s))));
        let by_reference = log.joints[b].reference.as_ref();
        by_rate.or(by_reference.map(|reference| correlation(own, reference)))
    };
    for a in 0..joints.len() {
        let Some(own) = fits(a, a).filter(|own| *own < OTHER) else { continue };
        let others = (0..joints.len()).filter(|&b| b != a);
        let best = others.filter_map(|b| Some((b, fits(a, b)?))).max_by(|x, y| x.1.total_cmp(&y.1));
        if let Some((b, fit)) = best
            && fit > SAME.max(own)
        {
            let (joint, other) = (joints[a].name.clone(), joints[b].name.clone());
            found.suspicions.push(Suspicion::Swapped { joint, other });
        }
    }
}

/// The integral by trapezoids, from 0.
fn integral(rate: &[f64], step_s: f64) -> Vec<f64> {
    let mut sum = 0.0;
    let mut before = rate.first().copied().unwrap_or(0.0);
    let mut next = |&rate: &f64| {
        sum += 0.5 * step_s * (rate + before);
        before = rate;
        sum
    };
    rate.iter().map(&mut next).collect()
}

/// A signal without the line that fits it best: what an offset of a rate adds to its integral.
fn level(signal: &[f64]) -> Vec<f64> {
    let middle = 0.5 * (signal.len() as f64 - 1.0);
    let at = |index: usize| index as f64 - middle;
    let squares: f64 = (0..signal.len()).map(|index| at(index).powi(2)).sum();
    let products: f64 = signal.iter().enumerate().map(|(index, value)| at(index) * value).sum();
    let (mean, slope) = (mean(signal), products / squares.max(f64::MIN_POSITIVE));
    signal.iter().enumerate().map(|(index, value)| value - mean - slope * at(index)).collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The correlation of two signals; 0 where one of them is constant.
pub(super) fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let (at, bt) = (mean(a), mean(b));
    let (mut ab, mut aa, mut bb) = (0.0, 0.0, 0.0);
    for (x, y) in a.iter().zip(b) {
        let (x, y) = (x - at, y - bt);
        ab += x * y;
        aa += x * x;
        bb += y * y;
    }
    if aa > 0.0 && bb > 0.0 { ab / (aa * bb).sqrt() } else { 0.0 }
}

/// The slope of `b` over `a`.
fn slope(a: &[f64], b: &[f64]) -> f64 {
    let (at, bt) = (mean(a), mean(b));
    let (mut ab, mut aa) = (0.0, 0.0);
    for (x, y) in a.iter().zip(b) {
        ab += (x - at) * (y - bt);
        aa += (x - at) * (x - at);
    }
    ab / aa
}
