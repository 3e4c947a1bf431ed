//! The answer in one word, and why.

use super::cancelling::terms_over_torque;
use super::data::Data;
use super::diagnosis::{Diagnosis, Gaps};
use super::effects_found::FoundEffect;
use super::excitation::unseen;
use super::leftover::{Leftover, is_broad};
use super::rounds::Found;
use super::signals::Signals;
use super::state::{Setting, State};
use crate::policy::verdict::{CANCELLED, UNTOLD};
use denavit_evidence::policy;
use denavit_identify::doubt::MisreadColumns;

/// The answer in one word.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Verdict {
    /// What is left is noise.
    NothingMissing,
    /// Effects were found that leave noise.
    Explained,
    /// Effects were found, and more than noise is left.
    PartlyExplained,
    /// More than noise is left, and no effect of the catalogue explains it.
    Unexplained,
    /// The logs do not say.
    #[default]
    CannotTell,
}

impl Verdict {
    /// The word in files.
    pub const fn word(self) -> &'static str {
        match self {
            Self::NothingMissing => "nothing_missing",
            Self::Explained => "explained",
            Self::PartlyExplained => "partly_explained",
            Self::Unexplained => "unexplained",
            Self::CannotTell => "cannot_tell",
        }
    }
}

/// Judges what was found, with what is open of each joint and spring in all logs, and in held-out
/// ones by the others; of logs some of whose columns may be surely misread.
pub(super) fn judge(
    diagnosis: &mut Diagnosis,
    setting: &Setting<'_>,
    (found, after): (&Found, &State),
    open: &[Vec<f64>; 2],
    misread: &[MisreadColumns],
) {
    // Of a model that is nothing like the logs, nothing has a name.
    let is_alike = left_open(diagnosis) <= policy::NOTHING_LIKE;
    let is_named = |one| is_alike && is_law(diagnosis, setting, open, one);
    let named: Vec<bool> = diagnosis.effects.iter().map(is_named).collect();
    for (one, is_named) in diagnosis.effects.iter_mut().zip(named) {
        one.is_named = is_named;
    }
    let cancelled = cancelled(diagnosis, setting);
    // of what has no name for another reason nothing more is said
    let open = open.iter().filter(|_| is_alike && cancelled.is_none());
    let doubts = doubts(diagnosis, setting, found, &open.collect::<Vec<_>>());
    let (verdict, mut reasons) = match cancelled {
        Some(why) => {
            diagnosis.effects.iter_mut().for_each(|one| one.is_named = false);
            (Verdict::CannotTell, vec![why])
        }
        None => said(diagnosis, setting),
    };
    reasons.extend(doubts);
    let untold = untold(setting.data.held_out, &after.residual.held_out);
    diagnosis.is_left_at_reversals = !untold.is_empty();
    reasons.extend(untold);
    (diagnosis.verdict, diagnosis.reasons) = (verdict, reasons);
    if found.is_stopped {
        diagnosis.verdict = Verdict::CannotTell;
    }
    if !misread.is_empty() {
        diagnosis.verdict = Verdict::CannotTell;
        diagnosis.reasons = misread.iter().map(ToString::to_string).collect();
    }
}

/// Whether an effect is a law, and not near to something else: it stands for nothing without a
/// name, and what is open beside it is little, in all logs and in held-out ones by the others, or
/// no more than its sensors make while held-out logs ask for it. Noise of few steps of an encoder
/// is as strong in slow bands as the motion is slow, not as in fast ones.
fn is_law(
    diagnosis: &Diagnosis,
    setting: &Setting<'_>,
    open: &[Vec<f64>; 2],
    one: &FoundEffect,
) -> bool {
    let is_noise = |left: Leftover, gaps: &Gaps| {
        let floor = gaps.floor.per_joint[left.equation].unwrap_or(0.0);
        left.share < floor && one.log_predicted > policy::NAMED
    };
    let stands = |open: &[f64], size: f64, gaps: &Gaps| {
        let left = open_beside(setting, open, one);
        left.is_none_or(|left| !is_unexplained(left, size) || is_noise(left, gaps))
    };
    let Diagnosis { train, held_out, leftovers, .. } = diagnosis;
    let slow: Vec<f64> = leftovers.iter().map(|left| left.share).collect();
    let is_judged = || one.judged <= policy::WORTH || stands(&open[1], one.judged, held_out);
    let stands = match setting.candidates[one.candidate].is_standard() {
        true => stands(&slow, one.size, train), // every drive has it, whatever else there is
        false => stands(&open[0], one.size, train) && is_judged(),
    };
    stands && one.stands_for.is_none()
}

fn is_unexplained(left: Leftover, explained: f64) -> bool {
    left.share > policy::LEFT && left.share > policy::LEFT_OF_EXPLAINED * explained
}

/// Whether an effect acts where something is left.
fn acts_at(setting: &Setting<'_>, one: &FoundEffect, left: &Leftover) -> bool {
    let candidate = &setting.candidates[one.candidate];
    let joint = setting.data.train.nominal.joint_of(left.equation);
    candidate.is_body || candidate.joint.is_none_or(|own| own == joint)
}

/// What is open most of where an effect acts.
fn open_beside(setting: &Setting<'_>, open: &[f64], one: &FoundEffect) -> Option<Leftover> {
    let all = open.iter().enumerate().map(|(equation, &share)| Leftover { equation, share });
    let own = all.filter(|left| acts_at(setting, one, left));
    own.max_by(|a, b| a.share.total_cmp(&b.share))
}

/// What is left where the effects that act there explain no more: most of it.
fn unexplained<'d>(diagnosis: &'d Diagnosis, setting: &Setting<'_>) -> Option<&'d Leftover> {
    // what explains one joint excuses nothing at another
    let unexplained = diagnosis.leftovers.iter().filter(|left| {
        let there = diagnosis.effects.iter().filter(|one| acts_at(setting, one, left));
        is_unexplained(**left, there.map(|one| one.size).fold(0.0, f64::max))
    });
    unexplained.max_by(|a, b| a.share.total_cmp(&b.share))
}

/// Why what is left of a joint, or is like no law, says nothing of the model: its torque is a small
/// difference.
fn cancelled(diagnosis: &Diagnosis, setting: &Setting<'_>) -> Option<String> {
    let is_open = |left: &&Leftover| {
        let mut there = diagnosis.effects.iter().filter(|one| acts_at(setting, one, left));
        left.share > policy::LEFT && there.any(|one| !one.is_named)
    };
    let near = || diagnosis.leftovers.iter().find(is_open);
    let joint = unexplained(diagnosis, setting).or_else(near)?.equation;
    (joint < setting.data.train.nominal.model.joints.len()).then_some(())?;
    let both = setting.data.each_ref().map(|data| terms_over_torque(data, joint));
    let times = both.train.max(both.held_out);
    (times > CANCELLED && times.is_finite()).then(|| {
        format!(
            "the torque of {} is a small difference: its weight and inertia take {times:.1} times \
             as much, so that small errors of positions and accelerations are as large as it",
            diagnosis.places[joint]
        )
    })
}

/// The share of the torque that is left of held-out logs, without noise: that says nothing of the
/// model.
fn left_open(diagnosis: &Diagnosis) -> f64 {
    let Gaps { after, floor, .. } = &diagnosis.held_out;
    let square = after.all * after.all - floor.all * floor.all;
    // what is no number stays none
    if square < 0.0 { 0.0 } else { square.sqrt() }
}

/// The verdict with its first reasons.
fn said(diagnosis: &Diagnosis, setting: &Setting<'_>) -> (Verdict, Vec<String>) {
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    let left = left_open(diagnosis);
    if left.is_nan() || left > policy::NOTHING_LIKE {
        let why = format!(
            "the model is nothing like the logs: the torque mismatch is {}; a column of another \
             joint, sign or unit, or another robot",
            percent(left)
        );
        return (Verdict::CannotTell, vec![why]);
    }
    let slow = unexplained(diagnosis, setting).map(|left| {
        let (share, place) = (percent(left.share), &diagnosis.places[left.equation]);
        format!(
            "a residual of {share} of the torque of {place} is in the bands in which the robot \
             moves"
        )
    });
    let broad = || {
        let (place, share) = broad(diagnosis)?;
        let share = percent(share);
        Some(format!(
            "a residual of {share} of the torque of {place} is spread evenly over all frequencies: \
             more than sensors have"
        ))
    };
    let what = slow.or_else(broad);
    if diagnosis.effects.is_empty() && what.is_none() {
        return nothing_found(diagnosis, setting);
    }
    let has = |named: bool| diagnosis.effects.iter().any(|one| one.is_named == named);
    if what.is_some() || has(false) {
        let verdict = if has(true) { Verdict::PartlyExplained } else { Verdict::Unexplained };
        return (verdict, what.into_iter().collect());
    }
    let names = |is_asked: &dyn Fn(&FoundEffect) -> bool| -> Vec<String> {
        let asked = diagnosis.effects.iter().filter(|one| is_asked(one));
        asked.map(|one| setting.candidates[one.candidate].name()).collect()
    };
    let ambiguous = names(&|one| probability(one) < 0.5);
    if !ambiguous.is_empty() {
        let why = format!("alias: others would do as well as {}", ambiguous.join(", "));
        return (Verdict::CannotTell, vec![why]);
    }
    let untrained = names(&|one| one.is_untrained);
    if !untrained.is_empty() {
        let untrained = untrained.join(", ");
        let why = format!("held-out logs alone have {untrained} act, and gave its values");
        return (Verdict::PartlyExplained, vec![why]);
    }
    let unjudged = names(&|one| one.judged < policy::WORTH && one.log_predicted < policy::NAMED);
    if !unjudged.is_empty() {
        let why = format!("no motion of held-out logs has {} act", unjudged.join(", "));
        return (Verdict::PartlyExplained, vec![why]);
    }
    let Gaps { before, after, .. } = &diagnosis.held_out;
    if after.all > before.all {
        let [before, after] = [before, after].map(|gap| percent(gap.all));
        let why = format!("the torque mismatch of held-out logs grows, from {before} to {after}");
        return (Verdict::PartlyExplained, vec![why]);
    }
    match diagnosis.held_out.closed {
        Some(closed) if closed < policy::SAME => {
            let closed = percent(closed.max(0.0));
            let why = format!("{closed} of what noise does not explain of held-out logs is closed");
            (Verdict::PartlyExplained, vec![why])
        }
        _ => (Verdict::Explained, Vec::new()),
    }
}

/// The joint or spring of which most is left that sensors do not have, with its share.
fn broad(diagnosis: &Diagnosis) -> Option<(&str, f64)> {
    let gaps = &diagnosis.train;
    let both = gaps.after.per_joint.iter().zip(&gaps.floor.per_joint).zip(&diagnosis.places);
    let left = both.filter_map(|((after, floor), place)| Some(((*after)?, (*floor)?, place)));
    let broad = left.filter(|(after, floor, _)| is_broad(*after, *floor));
    let most = broad.max_by(|a, b| a.0.total_cmp(&b.0));
    most.map(|(after, _, place)| (place.as_str(), after))
}

/// The probability of an effect among all that would do in its place.
fn probability(one: &FoundEffect) -> f64 {
    let others: f64 = one.alternatives.iter().map(|other| (-other.log_odds).exp()).sum();
    1.0 / (1.0 + others)
}

/// What it means that no effect was found, and why.
fn nothing_found(diagnosis: &Diagnosis, setting: &Setting<'_>) -> (Verdict, Vec<String>) {
    let unseen = unseen(setting, &diagnosis.visible);
    // Numbers that are driven beyond what the model says stand for something else.
    let is_model_right = unseen.is_empty() && diagnosis.driven[1].is_empty();
    let verdict = if is_model_right { Verdict::NothingMissing } else { Verdict::CannotTell };
    (verdict, unseen)
}

/// What else must be known to trust the answer. What is `open` says why effects have no name.
fn doubts(
    diagnosis: &Diagnosis,
    setting: &Setting<'_>,
    found: &Found,
    open: &[&Vec<f64>],
) -> Vec<String> {
    let mut reasons = Vec::new();
    let is_searched =
        |log: &Signals| setting.data.train.signals.iter().any(|other| other.q == log.q);
    if setting.data.held_out.signals.iter().any(is_searched) {
        reasons.push("judged with a log that was searched: nothing is held out".to_owned());
    }
    for one in &diagnosis.effects {
        let name = setting.candidates[one.candidate].name();
        if !one.exact.is_empty() {
            reasons.push(format!(
                "exact alias: {name} does what parameters of the model do in every motion ({}); \
                 the logs say that they are off by more than the model states",
                one.exact.join(", ")
            ));
        }
        let most = open.iter().filter_map(|open| open_beside(setting, open, one));
        let most = most.max_by(|a, b| a.share.total_cmp(&b.share)).filter(|_| !one.is_named);
        let why = match (&one.stands_for, most) {
            (Some(place), _) => format!(
                "stands for something at {place} that has no name: beside that nothing asks for it"
            ),
            (None, Some(left)) => format!(
                "is only near to what is missing: a residual of {:.1} % of the torque of {} is \
                 left beside it",
                100.0 * left.share,
                diagnosis.places[left.equation]
            ),
            _ => continue,
        };
        reasons.push(format!("{name} {why}"));
    }
    for &candidate in &found.dropped {
        reasons.push(format!(
            "not reported: {}, which does not help logs that its values were not fitted to",
            setting.candidates[candidate].name()
        ));
    }
    let ends = [
        (found.is_full, "as many effects were found as are allowed"),
        (found.is_stopped, "the search was stopped: not all was compared"),
    ];
    reasons.extend(ends.iter().filter(|(is, _)| *is).map(|(_, why)| (*why).to_owned()));
    if !diagnosis.driven[1].is_empty() {
        reasons.push(format!(
            "the logs would move parameters beyond their uncertainty: {}",
            diagnosis.driven[1].join(", ")
        ));
    }
    reasons
}

/// What held-out logs leave where rows hardly count: it is neither explained nor against the model.
fn untold(data: &Data<'_>, residual: &[f64]) -> Vec<String> {
    let of = |equation: usize| {
        let own = data.stretches.iter().filter(|stretch| stretch.equation == equation);
        let [mut left, mut told, mut torque] = [0.0; 3];
        for row in own.flat_map(|stretch| stretch.range()) {
            left += residual[row].powi(2);
            told += (data.weights[row] * residual[row]).powi(2);
            torque += data.torque[row].powi(2);
        }
        let share = (left / torque).sqrt();
        (share > policy::LEFT && told < UNTOLD * left).then(|| {
            format!(
                "held-out logs have a residual of {:.1} % of the torque of {}, most of it at \
                 velocity reversals and rests of the drive: friction is not known there",
                100.0 * share,
                data.nominal.equation_name(equation)
            )
        })
    };
    (0..data.nominal.equations()).filter_map(of).collect()
}
