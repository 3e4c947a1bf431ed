//! What logs would have shown: an answer that nothing is missing says no more than that.

use super::hypothesis::Hypothesis;
use super::search::Search;
use super::state::Setting;
use crate::policy::excitation::{LARGE, LEAST_RANGE, NEVER};
use denavit_evidence::policy;
use denavit_measure::JointIndex;

/// An effect of one parameter, and how large it must be to be seen in a joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Visible {
    /// The candidate.
    pub candidate: usize,
    /// Its joint.
    pub joint: JointIndex,
    /// The least value of its parameter that would have been named: it has the odds for that and is
    /// worth a name. Infinite where the motion has nothing of it.
    pub least: f64,
    /// What such an effect would be of the joint's torque (root mean squares).
    pub share: f64,
}

/// Why the logs say too little of a joint.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Unseen {
    /// Of so many effects so many would not be seen though they were half of its torque.
    Effects {
        /// The joint.
        joint: JointIndex,
        /// Those that would not be seen.
        unseen: usize,
        /// Those that were looked at.
        of: usize,
    },
    /// It does not move.
    Rest {
        /// The joint.
        joint: JointIndex,
    },
    /// It covers a small share of what its limits let it.
    Range {
        /// The joint.
        joint: JointIndex,
        /// The share of its positions, or of its speed.
        share: f64,
        /// Whether it is that of its speed.
        is_speed: bool,
    },
}

/// How small effects of one parameter would have been seen.
pub(super) fn visible(
    setting: &Setting<'_>,
    search: &Search<'_>,
    after: &Hypothesis,
) -> Vec<Visible> {
    // What lowers the squares by that has the odds that a name asks for.
    let errors = search.least_errors();
    let of = |(candidate, error, share): (usize, f64, f64)| {
        let joint = setting.candidates[candidate].joint?;
        // What the model's own numbers explain whole is left as rounding.
        let seen = if share < NEVER { errors } else { f64::INFINITY };
        let worth = (policy::WORTH / share).max(seen);
        Some(Visible { candidate, joint, least: worth * error, share: worth * share })
    };
    search.precisions(after).into_iter().filter_map(of).collect()
}

/// Joints of which the logs say too little for the answer that nothing is missing.
pub(super) fn unseen(setting: &Setting<'_>, visible: &[Visible]) -> Vec<Unseen> {
    let joints = &setting.data.train.nominal.model.joints;
    let mut found = Vec::new();
    for (joint, described) in joints.iter().enumerate() {
        let own = || visible.iter().filter(|one| one.joint.0 == joint);
        let (unseen, of) = (own().filter(|one| one.share > LARGE).count(), own().count());
        if 2 * unseen > of {
            found.push(Unseen::Effects { joint: JointIndex(joint), unseen, of });
        }
        let signals = || setting.data.train.signals.iter();
        let range = |values: &mut dyn Iterator<Item = f64>| {
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], v| [l.min(v), h.max(v)])
        };
        let [low, high] = range(&mut signals().flat_map(|log| log.q[joint].iter().copied()));
        // What an encoder's noise does is no motion.
        let [least, most] =
            range(&mut signals().flat_map(|log| log.position_noise[joint].iter().copied()));
        if high - low <= most - least {
            found.push(Unseen::Rest { joint: JointIndex(joint) });
        }
        let fastest =
            signals().flat_map(|log| &log.qd[joint]).fold(0.0, |a: f64, v| a.max(v.abs()));
        let of_range = described.position_limits.map(|[l, h]| ((high - low) / (h - l), false));
        let of_speed = described.velocity_limit.map(|limit| (fastest / limit, true));
        let shares = [of_range, of_speed].into_iter().flatten();
        let small = shares.filter(|(share, _)| *share < LEAST_RANGE);
        found.extend(small.map(|(share, is_speed)| Unseen::Range {
            joint: JointIndex(joint),
            share,
            is_speed,
        }));
    }
    found
}

impl Unseen {
    /// The reason in words, with the names of joints.
    pub(super) fn sentence(&self, names: &[&str]) -> String {
        let percent = |share: f64| format!("{:.1} %", 100.0 * share);
        match self {
            Self::Effects { joint, unseen, of } => format!(
                "too little excitation: of {of} effects {unseen} would not be seen at {} though \
                 they were half of its torque",
                names[joint.0]
            ),
            Self::Rest { joint } => {
                format!("too little excitation: {} does not move", names[joint.0])
            }
            Self::Range { joint, share, is_speed } => format!(
                "too little excitation: {} covers {} of {}",
                names[joint.0],
                percent(*share),
                if *is_speed { "its speed" } else { "its range" }
            ),
        }
    }
}
