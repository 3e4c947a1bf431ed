//! What is to be said before anybody believes identified parameters.

use denavit_identify::estimate::{
    ContradictingJoint, ContradictingLog, IdentifiedParameter, Likeness, Standing, Unexplained,
};
use denavit_identify::{Identification, LeftOutRows};

/// Parameters that are named, at most.
const LISTED: usize = 6;

/// All that is to be said before anybody believes the parameters.
pub(crate) fn warnings(found: &Identification) -> Vec<String> {
    let misread = found.misread.iter().map(|one| {
        let accepted = if one.is_sure { "Accepted: " } else { "Perhaps " };
        let hint = one.hint();
        format!("{accepted}{} ({hint}).", one.summary())
    });
    let reversals = found.reversals.iter().map(|(joint, share)| {
        format!(
            "Coulomb friction of {joint} is uncertain, by more than its error says: {:.0} % of \
             samples are within the filter's time of a reversal, or as slow, and count. \
             `options.slow` leaves them out, as far as other samples are there; \
             `options.friction=tanh` has another law there.",
            100.0 * share
        )
    });
    // where noise makes most, that is why
    let is_shown = !found.is_noise();
    let unexplained = found.unexplained.iter().filter(|_| is_shown).map(unexplained);
    let noisy = found.noisy_logs.iter().filter(|_| is_shown).map(noisy_log);
    let contradicting = found.contradicting_logs.iter().filter(|_| is_shown).map(contradicting);
    misread
        .chain(contradicting)
        .chain(unexplained)
        .chain(bias(found))
        .chain(noisy)
        .chain(changed(found))
        .chain(smeared(found))
        .chain(reversals)
        .chain(other_robot(found))
        .chain(no_bodies(found))
        .collect()
}

/// What is to be said of rows that do not count, and of what is left of the others.
pub(crate) fn notes(found: &Identification) -> Vec<String> {
    let lacking = lacking(&found.lacking).filter(|_| !found.is_noise());
    rows_left_out(&found.left_out).into_iter().chain(lacking).collect()
}

/// What is to be said if noise of the positions biases the parameters.
fn bias(found: &Identification) -> Option<String> {
    if found.is_noise() {
        let short = if found.is_short() { "The logs are too short for it: " } else { "" };
        return Some(format!(
            "{short}Noise of the positions makes up to {:.0} % of what the motion shows of the \
             parameters. How far they are off is not known, nor whether columns are mislabelled. A \
             filter with a lower cutoff (`conditions.filter`) has less of it; so has a longer or \
             faster motion, or one of all joints at once.",
            100.0 * found.estimate.noise_share
        ));
    }
    let own = |one: &IdentifiedParameter| Some((one.name.clone(), one.noise_bias?));
    let all = found.parameters.iter().filter(|one| one.is_biased());
    let biased =
        listed(all.filter_map(own).collect(), |(name, bias)| format!("{name} by {bias:.1}"))?;
    Some(format!(
        "Noise of the positions biases parameters, in standard errors: {biased}. Their intervals \
         hold less often than they say. A filter with a lower cutoff (`conditions.filter`) has \
         less of it, or `options.method=iv` none."
    ))
}

/// What is to be said if parameters change with half the cutoff by more than chance.
fn changed(found: &Identification) -> Option<String> {
    if found.is_noise() {
        return None; // it has been said, and errors count too little of it
    }
    let times = |one: &IdentifiedParameter| {
        let by = one.std? / one.half_cutoff?.own_std;
        Some((one.name.clone(), by))
    };
    let all = found.parameters.iter().filter(|one| one.is_changed());
    let wider = listed(all.filter_map(times).collect(), |(name, by)| format!("{name} {by:.1}"))?;
    Some(format!(
        "Parameters change with half the cutoff of the filter by more than chance. That is in \
         their errors, which are wider than chance alone makes them, so many times: {wider}. A \
         loop closed over the encoder of the log makes such a change, since its motion answers the \
         noise (`options.method=iv` is for that), and so may what the model lacks. \
         `conditions.filter` with a lower cutoff has less of it."
    ))
}

/// What is to be said if the filter itself makes a part of the torques.
fn smeared(found: &Identification) -> Option<String> {
    let (joint, share) = found.filter_error.as_ref()?;
    Some(format!(
        "The filter by itself makes an error of {:.1} % of the torque of {joint}: the motion is \
         too fast for it, or has too few samples a second. Parameters are biased, and their \
         intervals too narrow. `conditions.filter` with a higher cutoff makes less of it.",
        100.0 * share
    ))
}

fn rows_left_out(rows: &[LeftOutRows]) -> Option<String> {
    let of = |one: &LeftOutRows| {
        let left = 100.0 * one.left;
        let LeftOutRows { joint, samples, of, .. } = one;
        format!("{samples} of {of} samples of {joint}, whose others have a residual of {left:.2} %")
    };
    let listed: Vec<String> = rows.iter().map(of).collect();
    (!listed.is_empty()).then(|| {
        format!(
            "Left out of the estimate, since the joint reverses or is slow there, where friction \
             is not the sign of its velocity: {}. Residuals of the tables are those of all \
             samples. `options.slow=off` keeps them all.",
            listed.join("; ")
        )
    })
}

/// That what is left of torques is no noise.
fn lacking(lacking: &[(String, f64)]) -> Option<String> {
    let of = |(joint, share): &(String, f64)| format!("{joint} ({:.2} %)", 100.0 * share);
    let listed: Vec<String> = lacking.iter().map(of).collect();
    (!listed.is_empty()).then(|| {
        format!(
            "The residual of {} is no noise: it is correlated for longer than the filter makes it. \
             The model lacks something (denavit diagnose looks for it), has other lengths or \
             angles than the robot, or a column is scaled or late. Parameters take up what of it \
             is like them, and stated errors do not count that.",
            listed.join(", ")
        )
    })
}

/// That the nominal parameters leave far more than there is.
fn other_robot(found: &Identification) -> Option<String> {
    let before = found.before.filter(|_| found.is_of_other_robot())?;
    Some(format!(
        "With the nominal parameters the residual is {before:.0} times the torques: the log is of \
         another robot, or the nominal parameters are far off."
    ))
}

/// That the nearest bodies are far from the estimate.
fn no_bodies(found: &Identification) -> Option<String> {
    found.is_of_no_bodies().then(|| {
        format!(
            "The parameters are not physically consistent: the nearest that are lie {:.0} standard \
             errors away, over all parameters. Perhaps a column or the time is in another unit, \
             the log is of another robot, or it shows an effect that the model lacks. Do not trust \
             these parameters.",
            found.consistent.distance
        )
    })
}

/// A log that contradicts the others.
fn contradicting(one: &ContradictingLog) -> String {
    let of = |one: &ContradictingJoint| {
        let ContradictingJoint { joint, left, own, like } = one;
        let like = match like {
            None => String::new(),
            Some(Likeness::Constant(by, unit)) => format!(", as if {by:+.3} {unit} were added"),
            Some(Likeness::Factor(by)) => format!(", as if it were {by:.3} times as large"),
        };
        let [left, own] = [left, own].map(|share| 100.0 * share);
        format!("the residual of {joint} is {left:.1} % of its torque, {own:.1} % by its own{like}")
    };
    let joints: Vec<String> = one.joints.iter().map(of).collect();
    let (contradicts, advice) = match one.standing {
        Standing::OfFew => (OF_FEW, "Parameters are those of the others; leave it out."),
        Standing::OfFewFollowed => {
            (OF_FEW, "Parameters are not those of the others alone: leave it out.")
        }
        Standing::HeldOut => (
            "and the logs for the estimate contradict each other",
            "Which of them are right is not known.",
        ),
        Standing::Undecided => (
            "and the other logs contradict each other",
            "The logs that agree are not both more and longer together than those that do not: \
             which of them are right is not known. Do not trust these parameters: look at each log \
             by itself.",
        ),
    };
    format!(
        "{} {contradicts}: {}. It may be of another payload, gain, offset or robot, or show a law \
         that the model lacks. {advice}",
        one.file,
        joints.join("; ")
    )
}

const OF_FEW: &str = "contradicts the other logs, which no parameters explain together with it";

/// A joint of whose torque too much is left.
fn unexplained(one: &Unexplained) -> String {
    let (joint, percent) = (&one.joint, 100.0 * one.share);
    let file = one.file.as_ref().map_or(String::new(), |file| format!(" in {file}"));
    let what = match (one.beside, one.rest_s) {
        (Some(share), _) => format!(
            ", without what is near reversals, and {:.1} % in the logs for the estimate: far more \
             than noise, the filter and errors of the parameters make. Perhaps a column or the \
             time is in another unit, the log is of another robot, or it shows a law that the \
             model lacks. It does not confirm the parameters.",
            100.0 * share
        ),
        (None, None) => ", although the joint moves. Its column may be another quantity, in \
                         another unit, or noise, or the zero of a position may be off, or the \
                         model's geometry; do not trust these parameters."
            .to_owned(),
        (None, Some([from, to])) => format!(
            ", although the joint rests, from {from:.2} to {to:.2} s, and its friction holds less. \
             The column of its position may be stuck while it moves, or stiction or a brake holds \
             it, which no equation knows; do not trust these parameters."
        ),
    };
    format!(
        "The torque of {joint} is not explained: the residual is {percent:.0} % of \
             it{file}{what}"
    )
}

/// A log of which noise makes most, beside others.
fn noisy_log((file, share): &(String, f64)) -> String {
    format!(
        "Noise of the positions makes up to {:.0} % of what {file} shows of the parameters by \
         itself. Its rows count as little as that noise says.",
        100.0 * share
    )
}

/// The largest of some numbers with names, and how many others there are; none without any.
fn listed(mut all: Vec<(String, f64)>, text: impl Fn(&(String, f64)) -> String) -> Option<String> {
    all.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
    let named: Vec<String> = all.iter().take(LISTED).map(text).collect();
    let more = all.len().saturating_sub(LISTED);
    let more = if more > 0 { format!(" and {more} others") } else { String::new() };
    (!all.is_empty()).then(|| format!("{}{more}", named.join(", ")))
}
