//! What logs would have shown: an answer that nothing is missing says no more than that.

use super::hypothesis::{Hypothesis, Part};
use super::search::Search;
use super::state::Setting;
use super::weighing::range;
use crate::policy::excitation::{LARGE, LEAST_RANGE, NEVER};
use denavit_evidence::policy;
use denavit_measure::JointIndex;
use denavit_numerics::least_and_most;

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

/// How small effects of one parameter would have been seen beside what was found.
pub(super) fn visible(search: &Search<'_>, after: &Hypothesis) -> Vec<Visible> {
    // Errors from which on an effect has the odds that a name asks for.
    let errors = (2.0 * (policy::NAMED + search.log_choices)).sqrt();
    let (glance, there) = (search.glance(after, &after.parts), after.candidates());
    let of = |(candidate, own): (usize, &Vec<Part>)| {
        let (part, joint) = (own.first()?, search.weighing.candidates[candidate].joint?);
        if part.terms.len() != 1 || there.contains(&candidate) {
            return None;
        }
        let error = glance.see(&part.terms).precision[0].sqrt().recip();
        let share = error * search.weighing.spectra.share(&part.terms.columns[0], joint.0);
        // What the model's own numbers explain whole is left as rounding.
        let seen = if share < NEVER { errors } else { f64::INFINITY };
        let worth = (policy::WORTH / share).max(seen);
        let least = worth * (error * part.placed.deviations[0]);
        Some(Visible { candidate, joint, least, share: worth * share })
    };
    search.screen.iter().enumerate().filter_map(of).collect()
}

/// Why the logs say too little of joints for the answer that nothing is missing, in words.
pub(super) fn unseen(setting: &Setting<'_>, visible: &[Visible]) -> Vec<String> {
    let mut found = Vec::new();
    for (joint, described) in setting.data.train.nominal.model.joints.iter().enumerate() {
        let name = &described.name;
        let mut says = |why: String| found.push(format!("too little excitation: {why}"));
        let own = || visible.iter().filter(|one| one.joint.0 == joint);
        let (unseen, of) = (own().filter(|one| one.share > LARGE).count(), own().count());
        if 2 * unseen > of {
            says(format!(
                "of {of} effects {unseen} would not be seen at {name} though they were half of its \
                 torque"
            ));
        }
        let signals = || setting.data.train.signals.iter();
        let [low, high] = range(&[setting.data.train], JointIndex(joint));
        // What an encoder's noise does is no motion.
        let noise = signals().flat_map(|log| log.position_noise[joint].iter());
        let [least, most] = least_and_most(noise);
        if high - low <= most - least {
            says(format!("{name} does not move"));
        }
        let fastest =
            signals().flat_map(|log| log.qd[joint].iter()).fold(0.0, |a: f64, v| a.max(v.abs()));
        let of_range = described.position_limits.map(|[l, h]| ((high - low) / (h - l), "range"));
        let of_speed = described.velocity_limit.map(|limit| (fastest / limit, "speed"));
        let shares = [of_range, of_speed].into_iter().flatten();
        for (share, what) in shares.filter(|(share, _)| *share < LEAST_RANGE) {
            says(format!("{name} covers {:.1} % of its {what}", 100.0 * share));
        }
    }
    found
}
