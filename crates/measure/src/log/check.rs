//! Whether a log says what it seems to say: units, swapped joints, signals that do not move.

use super::fault::{LogFault, LogRemark, Suspicion};
use super::{JointSignals, MeasuredLog};
use crate::policy::check::{
    ABOVE_ROUNDING, DIGIT, FAR_BEYOND, FASTEST_STEP_S, HOUR_S, IN_STEPS, LARGEST_ANGLE_RAD,
    MOST_STEPS, OTHER, ROUNDED, ROUNDING, SAME, SATURATED, SINGLE, SLOWEST_STEP_S, WHOLE,
};
use denavit_numerics::{least_and_most, mean, products};
use denavit_plants::regression::RegressionJoint;

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
            logged_rate(signals, log.step_s, joint, &mut found);
        } else if !joint.is_base {
            found.remarks.push(LogRemark::Resting { joint: joint.name.clone() });
        }
        torque(signals, joint, has_drives, moves, &mut found);
    }
    if !moving.contains(&true) {
        found.faults.push(LogFault::NothingMoves);
    }
    swapped(log, joints, &moving, &mut found);
    found
}

fn time_unit(log: &MeasuredLog, found: &mut Findings) {
    let factor = match log.step_s {
        // of microseconds these would be slower than any log
        step if step > SLOWEST_STEP_S * 1e6 => 1e-9,
        step if step >= 50.0 => 1e-6,
        step if step > SLOWEST_STEP_S => 1e-3,
        step if step < FASTEST_STEP_S => HOUR_S,
        _ => return,
    };
    let (step, mapped) = (log.step_s, String::new());
    found.suspicions.push(Suspicion::TimeUnit { step, factor, mapped });
}

/// A joint moves if it goes further than rounding and the steps of its encoder.
fn moves(joint: &JointSignals) -> bool {
    let [low, high] = least_and_most(&joint.q);
    high - low > (4.0 * joint.step.unwrap_or(0.0)).max(1e-7 * high.abs().max(low.abs()).max(1e-3))
}

fn position(signals: &JointSignals, joint: &RegressionJoint, found: &mut Findings) {
    let [low, high] = least_and_most(&signals.q);
    let column = format!("q_{}", joint.name);
    let largest = low.abs().max(high.abs());
    let limits = joint.position_limits;
    let reach = limits.map(|[least, most]| 1.5 * least.abs().max(most.abs()));
    if !joint.slides && largest > reach.map_or(LARGEST_ANGLE_RAD, |reach| reach.max(6.0)) {
        let (column, factor) = (column.clone(), 1.0_f64.to_radians());
        found.suspicions.push(Suspicion::Degrees {
            column,
            largest,
            factor,
            mapped: String::new(),
        });
    } else if let Some(limits) = limits {
        let slack = 0.02 * (limits[1] - limits[0]);
        let is_below = low < limits[0] - slack;
        if is_below || high > limits[1] + slack {
            let (column, value) = (column.clone(), if is_below { low } else { high });
            found.suspicions.push(Suspicion::BeyondLimits { column, value, limits });
        }
    }
    if let Some(step) = signals.step {
        let own = (column, step);
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
fn logged_rate(signals: &JointSignals, step_s: f64, joint: &RegressionJoint, found: &mut Findings) {
    let Some(logged) = &signals.qd else { return };
    let column = format!("qd_{}", joint.name);
    let (position, travelled) = (level(&signals.q), level(&integral(logged, step_s)));
    let correlation = correlation(&travelled, &position);
    // The swapped ones are found below.
    if correlation.abs() < OTHER {
        found.suspicions.push(Suspicion::NotTheRate { column, correlation });
        return;
    }
    let [along, of_position, _] = products(&position, &travelled);
    let ratio = along / of_position;
    if !(0.8..1.25).contains(&ratio) {
        found.suspicions.push(Suspicion::RateScale { column, ratio });
    }
}

fn torque(
    signals: &JointSignals,
    joint: &RegressionJoint,
    has_drives: bool,
    moves: bool,
    found: &mut Findings,
) {
    let Some(torque) = &signals.tau else { return };
    let [low, high] = least_and_most(torque);
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
        if at_once >= 5 && share > SATURATED {
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
    let along: f64 = signal.iter().enumerate().map(|(index, value)| at(index) * value).sum();
    let mean = mean(signal);
    let slope = along / squares.max(f64::MIN_POSITIVE);
    signal.iter().enumerate().map(|(index, value)| value - mean - slope * at(index)).collect()
}

/// The correlation of two signals; 0 where one of them is constant.
fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let [ab, aa, bb] = products(a, b);
    if aa > 0.0 && bb > 0.0 { ab / (aa * bb).sqrt() } else { 0.0 }
}

/// Changes of a position that tell the step of its encoder, at least: of one that moves from sample
/// to sample, and of one that mostly does not.
const FEWEST_MOVES: usize = 20;
const FEWEST_STEPS: usize = 5;

/// Steps that the smallest difference of a position that is always fast may be.
const MOST_OF_LEAST: u32 = 5;

/// How often a step is found anew, from differences that are twice as large.
const REFINED: i32 = 10;

/// Digits after the point that a log may be printed with.
const MOST_DIGITS: i32 = 9;

/// The step of an encoder: what all differences of neighbouring samples are multiples of. Samples
/// without a number are passed over.
pub(super) fn encoder_step(q: &[f64]) -> Option<f64> {
    let q: Vec<f64> = q.iter().copied().filter(|q| !q.is_nan()).collect();
    let differences = q.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let size = least_and_most(&q).into_iter().fold(0.0, |size: f64, value| size.max(value.abs()));
    let tiny = 1e-12 * size.max(1e-6);
    let moved: Vec<f64> = differences.filter(|&d| d > tiny).take(20_000).collect();
    // where a position rests but for some steps, few tell their size
    let is_staircase = moved.len() >= FEWEST_STEPS && moved.len() * 10 < q.len();
    if moved.len() < FEWEST_MOVES && !is_staircase {
        return None;
    }
    let least = moved.iter().copied().fold(f64::INFINITY, f64::min);
    let digit = printed_digit(&q);
    let is_single = digit.is_none() && q.iter().all(|&q| f64::from(q as f32) == q);
    let rounding = size * if is_single { SINGLE } else { ROUNDED };
    let guess = |times: u32| least / f64::from(times);
    let of = |off| (1..=MOST_OF_LEAST).find_map(|times| of_multiples(&moved, guess(times), off));
    let in_digits = |digit: f64| of(digit).filter(|step| digit <= DIGIT * step);
    // Digits are multiples of themselves: steps above them are looked for first.
    let of_digits = digit.filter(|_| moved.len() >= FEWEST_MOVES).and_then(in_digits);
    of_digits.or_else(|| of(2.0 * rounding).filter(|step| *step >= ABOVE_ROUNDING * rounding))
}

/// The last decimal digit with which all positions are printed; none where they have more.
fn printed_digit(q: &[f64]) -> Option<f64> {
    let is_whole = |value: f64| (value - value.round()).abs() <= ROUNDED * value.abs().max(1.0);
    let has = |scale: &f64| q.iter().all(|q| is_whole(q * scale));
    (0..MOST_DIGITS).map(|digits| 10.0_f64.powi(digits)).find(has).map(f64::recip)
}

/// The step near a first guess that differences are multiples of, each off by no more than that;
/// none if they are not.
fn of_multiples(moved: &[f64], guess: f64, off: f64) -> Option<f64> {
    // Larger multiples know the step better than smaller ones, which say how many they are.
    let step = (0..=REFINED).fold(guess, |step, finer| {
        let small = moved.iter().filter(|&&d| d < 1.5 * 2.0_f64.powi(finer) * step);
        let (sum, count) = small.fold((0.0, 0.0), |(sum, count), d| {
            let times = (d / step).round();
            (sum + d * times, count + times * times)
        });
        if count > 0.0 { sum / count } else { step }
    });
    let is_multiple = |d: &&f64| {
        let times = **d / step;
        (times - times.round()).abs() < WHOLE + off / step && times < MOST_STEPS
    };
    // Of a smooth signal hardly any difference is a multiple of its smallest one.
    let multiples = moved.iter().filter(is_multiple).count();
    (multiples as f64 > IN_STEPS * moved.len() as f64).then_some(step)
}
