//! A diagnosis in sentences: the verdict, what is left, and what that looks like.

use crate::html::{Grade, VerdictLine};
use crate::percent;
use denavit_diagnose::{Candidate, Diagnosis, FoundEffect, Gaps, Structure, Verdict};

/// What is left is called noise up to this many times what noise alone leaves. Words alone: no
/// verdict depends on it.
const LIKE_NOISE: f64 = 1.5;

/// The share of the gap from which an effect is said to close it: less would be printed as 0.1 %
/// or nothing.
const LEAST_SHARE: f64 = 0.001;

/// The answer in a sentence or two: the verdict, and what was found.
pub(super) fn verdict(found: &Diagnosis, candidates: &[Candidate]) -> VerdictLine {
    let grade = match found.verdict {
        Verdict::NothingMissing | Verdict::Explained => Grade::Good,
        Verdict::PartlyExplained => Grade::Fair,
        Verdict::Unexplained | Verdict::CannotTell => Grade::Bad,
    };
    VerdictLine { grade, text: verdict_sentence(found, candidates) }
}

fn verdict_sentence(found: &Diagnosis, candidates: &[Candidate]) -> String {
    let mut text = match found.verdict {
        Verdict::NothingMissing => nothing_missing(&found.held_out, Rest::of(found)),
        Verdict::Explained => {
            "What the model lacks is named, and explains the torque mismatch.".to_owned()
        }
        Verdict::PartlyExplained => "A part of what the model lacks is named.".to_owned(),
        Verdict::Unexplained => {
            "The model lacks something that is not in the catalogue.".to_owned()
        }
        Verdict::CannotTell => "The logs do not tell what the model lacks.".to_owned(),
    };
    for (is_named, word) in [(true, "Found"), (false, "Nearest to what has no name")] {
        let all = found.effects.iter().filter(|one| one.is_named == is_named);
        let names = all.map(|one| &candidates[one.candidate]);
        let names: Vec<String> = names.map(in_words).collect();
        if !names.is_empty() {
            text += &format!(" {word}: {}.", names.join("; "));
        }
    }
    text
}

/// What the torque that is left beyond noise looks like.
#[derive(Clone, Copy, Debug)]
enum Rest<'a> {
    /// A function of the motion, which explains most of it at a joint.
    Physics(&'a Structure),
    /// A disturbance; a function of the motion explains some of it.
    Disturbance(Option<&'a Structure>),
    /// What is not looked at: most is left at velocity reversals and rests.
    Reversals,
}

impl<'a> Rest<'a> {
    fn of(found: &'a Diagnosis) -> Self {
        match found.structures.iter().max_by(|a, b| a.share.total_cmp(&b.share)) {
            Some(one) if one.share > 0.5 => Self::Physics(one),
            None if found.is_left_at_reversals => Self::Reversals,
            best => Self::Disturbance(best),
        }
    }
}

/// What it means that nothing is missing where so much is left.
fn nothing_missing(held_out: &Gaps, rest: Rest<'_>) -> String {
    let Gaps { after, floor, .. } = held_out;
    if beyond_noise(held_out).is_none() {
        return "Nothing is missing: the residual is noise.".to_owned();
    }
    let what = match rest {
        Rest::Physics(_) => "and it looks like physics without a name",
        Rest::Disturbance(_) => "and it looks like a disturbance",
        Rest::Reversals => "most of it at velocity reversals and rests",
    };
    let [left, noise] = [after.all, floor.all].map(percent);
    format!(
        "Nothing of the catalogue is missing: the torque mismatch is {left} where noise alone \
         makes {noise}, {what}."
    )
}

/// The share of the torque that is left beyond noise; none where what is left is about noise.
fn beyond_noise(held_out: &Gaps) -> Option<f64> {
    let Gaps { after, floor, .. } = held_out;
    (after.all > LIKE_NOISE * floor.all)
        .then(|| (after.all * after.all - floor.all * floor.all).sqrt())
}

/// The answer in a paragraph: verdict, what was found, the gap before and after, reasons.
pub fn verdict_paragraph(found: &Diagnosis, candidates: &[Candidate]) -> String {
    format!("{} {}", verdict_sentence(found, candidates), reasons(found))
}

/// The gap before and after, and what speaks for the verdict.
pub(super) fn reasons(found: &Diagnosis) -> String {
    let Gaps { before, after, floor, .. } = &found.held_out;
    let mut text = format!(
        "On held-out logs the torque mismatch was {}, with what was found it is {}, and noise \
         alone makes {}",
        percent(before.all),
        percent(after.all),
        percent(floor.all)
    );
    if let Some(share) = found.held_out.closed.filter(|_| !found.effects.is_empty()) {
        let share = if share > 0.0 { percent(share) } else { "nothing".to_owned() };
        text += &format!(
            ": {share} of what can be explained is closed, velocity reversals and rests left out"
        );
    }
    text.push('.');
    text += &looks_like(found).map_or_else(String::new, |sentence| format!(" {sentence}"));
    for reason in &found.reasons {
        let mut letters = reason.chars();
        let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
        text += &format!(" {first}{}.", letters.as_str());
    }
    text
}

/// Whether what is left beyond noise looks like physics or like a disturbance.
fn looks_like(found: &Diagnosis) -> Option<String> {
    let share = percent(beyond_noise(&found.held_out)?);
    if found.verdict == Verdict::CannotTell {
        return None;
    }
    let explains = |one: &Structure| {
        format!("explains {} of the squared residual of {}", percent(one.share), one.at)
    };
    let what = match Rest::of(found) {
        Rest::Physics(one) => format!("physics: a formula of the motion {}", explains(one)),
        Rest::Disturbance(Some(one)) => format!(
            "a disturbance, more than like physics: the best formula of the motion {}",
            explains(one)
        ),
        Rest::Disturbance(None) => {
            "a disturbance: no formula of the motion is found in it".to_owned()
        }
        Rest::Reversals => return None,
    };
    Some(format!("The {share} of the torque beyond noise looks like {what}."))
}

/// An effect of the catalogue, and where it is.
pub(super) fn in_words(own: &Candidate) -> String {
    format!("{} at {}", own.title, own.at_in_words())
}

/// How much of the gap an effect closes, in words; none where the other terms close as much
/// without it.
pub(crate) fn closes(one: &FoundEffect) -> Option<String> {
    (one.share > LEAST_SHARE).then(|| percent(one.share.min(1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use denavit_diagnose::Gap;

    fn gaps(after: f64, floor: f64) -> Gaps {
        let [before, after, floor] =
            [after, after, floor].map(|all| Gap { all, per_joint: vec![Some(all)] });
        Gaps { before, after, floor, closed: None }
    }

    #[test]
    fn nothing_missing_says_so_of_noise_alone() {
        let said = |after, floor, rest| nothing_missing(&gaps(after, floor), rest);
        let disturbance = Rest::Disturbance(None);
        assert_eq!(said(0.0021, 0.0017, disturbance), "Nothing is missing: the residual is noise.");
        let disturbed = "Nothing of the catalogue is missing: the torque mismatch is 2.11 % where \
                         noise alone makes 0.17 %, and it looks like a disturbance.";
        assert_eq!(said(0.0211, 0.0017, disturbance), disturbed);
        assert!(
            said(0.0211, 0.0017, Rest::Reversals)
                .ends_with("most of it at velocity reversals and rests.")
        );
        assert!(said(0.004, 0.0, disturbance).contains("mismatch is 0.40 %"));
    }
}
