//! Where torques disagree: in which joint, and in which of its states of motion.

use super::data::{Data, ModelTorques, Stretch};
use super::floor::NoiseFloor;
use crate::policy::regime::{AT_EXTREME, AT_REST, MUCH, SLOW, TOLD};

/// A regime's part of what a joint leaves unexplained.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// The state of motion, in words.
    pub regime: String,
    /// Its share of the squares that are left of the joint.
    pub share: f64,
    /// Its share of the time.
    pub time: f64,
}

impl Part {
    /// The share beyond that of its time.
    pub fn excess(&self) -> f64 {
        self.share - self.time
    }
}

/// What one joint leaves unexplained.
#[derive(Clone, Debug, PartialEq)]
pub struct Where {
    /// The joint's name, or that of its spring.
    pub joint: String,
    /// Its share of what all joints leave beyond the noise, in squares of relative torques.
    pub share: f64,
    /// Root of mean square of what is left, over that of the noise.
    pub over_noise: f64,
    /// Every regime that the joint was in, by what it has beyond its share of time.
    pub parts: Vec<Part>,
    /// The second of the log in which most is left: from, to, and the share of squares in it.
    pub window_s: ([f64; 2], f64),
}

impl Where {
    /// One sentence: joint, regime, share.
    pub fn sentence(&self) -> String {
        let share = 100.0 * self.share;
        match self.parts.first().filter(|part| part.excess() > TOLD) {
            Some(Part { regime, share: own, time }) => format!(
                "{}: {share:.0} % of the unexplained torque; {regime}, in {:.0} % of the time, \
                 {:.0} % of that",
                self.joint,
                100.0 * time,
                100.0 * own
            ),
            None => format!(
                "{}: {share:.0} % of the unexplained torque, in all states of its motion",
                self.joint
            ),
        }
    }
}

/// What each joint leaves, the one that leaves most first. `filter_s` is the time that the filter
/// of torques spreads an event over.
pub(super) fn where_left(
    data: &Data<'_>,
    residual: &[f64],
    torques: &[ModelTorques],
    floors: &[NoiseFloor],
    filter_s: f64,
) -> Vec<Where> {
    let mut found = Vec::new();
    for equation in 0..data.nominal.equations() {
        let is_own = |stretch: &&Stretch| stretch.equation == equation;
        let own: Vec<Stretch> = data.stretches.iter().filter(is_own).copied().collect();
        if own.is_empty() {
            continue;
        }
        let squares = |values: &[f64]| -> f64 {
            own.iter().flat_map(|s| &values[s.range()]).map(|value| value * value).sum()
        };
        let (left, torque) = (squares(residual), squares(&data.torque));
        let noise: f64 =
            own.iter().map(|s| s.rows as f64 * floors[s.log.0][equation].powi(2)).sum();
        let flags = own.iter().map(|s| regimes(data, &torques[s.log.0], s, filter_s));
        let flags: Vec<Vec<(String, Vec<bool>)>> = flags.collect();
        let rows: Vec<f64> = own.iter().flat_map(|s| &residual[s.range()]).copied().collect();
        let part = |(place, (regime, _)): (usize, &(String, Vec<bool>))| {
            let is_in = flags.iter().flat_map(|all| &all[place].1);
            let within: Vec<f64> =
                is_in.zip(&rows).filter(|(is_in, _)| **is_in).map(|(_, row)| row * row).collect();
            let share = within.iter().sum::<f64>() / left.max(f64::MIN_POSITIVE);
            let time = within.len() as f64 / rows.len() as f64;
            (time > 0.0).then(|| Part { regime: regime.clone(), share, time })
        };
        let mut parts: Vec<Part> = flags[0].iter().enumerate().filter_map(part).collect();
        parts.sort_by(|a, b| b.excess().total_cmp(&a.excess()));
        found.push(Where {
            joint: data.nominal.equation_name(equation),
            share: (left - noise).max(0.0) / torque.max(f64::MIN_POSITIVE),
            over_noise: (left / noise.max(f64::MIN_POSITIVE)).sqrt(),
            parts,
            window_s: window(data, residual, &own),
        });
    }
    let whole: f64 = found.iter().map(|one| one.share).sum();
    for one in &mut found {
        one.share = if whole > 0.0 { one.share / whole } else { 0.0 };
    }
    found.sort_by(|a, b| b.share.total_cmp(&a.share));
    found
}

/// For each state of motion whether the rows of a stretch are in it.
fn regimes(
    data: &Data<'_>,
    torques: &ModelTorques,
    stretch: &Stretch,
    filter_s: f64,
) -> Vec<(String, Vec<bool>)> {
    let (signals, joint) = (&data.signals[stretch.log.0], stretch.joint);
    let [q, qd, qdd] =
        [&signals.q, &signals.qd, &signals.qdd].map(|all| signals.at_rows(&all[joint.0]));
    let load = signals.at_rows(&torques.load[joint.0]);
    let torque = &data.torque[stretch.range()];
    let most = |values: &[f64]| values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    let (low, high) = q.iter().fold((f64::MAX, f64::MIN), |(a, b), &x| (a.min(x), b.max(x)));
    let sixth = (high - low) / 6.0;
    let [fastest, hardest, heaviest] = [&qd, &qdd, &load].map(|values| most(values));
    let within_s = filter_s.max(0.02);
    let reach = (within_s / signals.row_step_s()).ceil() as usize;
    let reversals: Vec<usize> =
        (1..qd.len()).filter(|&k| (qd[k - 1] < 0.0) != (qd[k] < 0.0)).collect();
    let near = |k: usize| {
        let after = reversals.partition_point(|&at| at + reach < k);
        reversals.get(after).is_some_and(|&at| at <= k + reach)
    };
    let count = qd.len();
    let extreme = most(torque);
    let rests = |k: usize| {
        let beside = [k.saturating_sub(1), (k + 1).min(count - 1)];
        torque[k].abs() > AT_EXTREME * extreme
            && beside.iter().all(|&at| (torque[at] - torque[k]).abs() < AT_REST * extreme)
    };
    let near_words = format!("within {:.0} ms of reversals", 1e3 * within_s);
    let all: [(&str, &dyn Fn(usize) -> bool); 12] = [
        ("moving forward", &|k| qd[k] > 0.0),
        ("moving backward", &|k| qd[k] < 0.0),
        (&near_words, &near),
        ("below a tenth of its highest speed", &|k| qd[k].abs() < SLOW * fastest),
        ("above three fifths of its highest speed", &|k| qd[k].abs() > MUCH * fastest),
        ("above three fifths of its largest acceleration", &|k| qdd[k].abs() > MUCH * hardest),
        ("above three fifths of its largest load", &|k| load[k].abs() > MUCH * heaviest),
        ("in the highest sixth of its positions", &|k| q[k] > high - sixth),
        ("in the lowest sixth of its positions", &|k| q[k] < low + sixth),
        ("in the first third of the log", &|k| 3 * k < count),
        ("in the last third of the log", &|k| 3 * k >= 2 * count),
        ("while its torque rests at an extreme", &rests),
    ];
    all.map(|(words, is_in)| (words.to_owned(), (0..count).map(is_in).collect())).into()
}

/// The second in which most is left.
fn window(data: &Data<'_>, residual: &[f64], own: &[Stretch]) -> ([f64; 2], f64) {
    let whole: f64 = own.iter().flat_map(|s| &residual[s.range()]).map(|value| value * value).sum();
    let mut best = ([0.0; 2], 0.0);
    for stretch in own {
        let signals = &data.signals[stretch.log.0];
        let times = signals.at_rows(&signals.t);
        let length = ((1.0 / signals.row_step_s()) as usize).clamp(1, stretch.rows);
        let part = &residual[stretch.range()];
        let mut sum: f64 = part[..length].iter().map(|value| value * value).sum();
        for end in length..=part.len() {
            let share = sum / whole.max(f64::MIN_POSITIVE);
            if share > best.1 {
                best = ([times[end - length], times[end - 1]], share);
            }
            if end < part.len() {
                sum += part[end].powi(2) - part[end - length].powi(2);
            }
        }
    }
    best
}
