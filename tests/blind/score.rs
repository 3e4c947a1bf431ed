//! Scores of answers: names and joints, false discoveries, refusals, gaps, intervals, confusion.

use super::case::Case;
use super::conditions::{CONDITIONS, Condition};
use super::design::Kind;
use super::generate::Generated;
use super::hidden::{Hidden, Site};
use super::robots::Robot;
use std::collections::BTreeMap;

/// One effect that a diagnosis names.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Named {
    /// Name in the catalogue; empty for a structure that was left unnamed.
    pub name: String,
    /// Joint, or none for an effect of the whole model.
    pub joint: Option<String>,
    /// Names with their joints that the data cannot tell from this one; empty for an unambiguous
    /// answer.
    pub others: Vec<(String, Option<String>)>,
    /// Parameters with their standard deviations.
    pub parameters: BTreeMap<String, [f64; 2]>,
}

/// What a diagnosis says.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Answer {
    /// As in the command's JSON: `nothing_missing`, `explained`, ...
    pub verdict: String,
    pub effects: Vec<Named>,
    /// Share of the explainable held-out gap that was closed.
    pub closed: Option<f64>,
}

/// How a case went.
#[derive(Clone, Debug, PartialEq)]
pub struct Score {
    pub number: u64,
    pub kind: Kind,
    /// Of the rows with conditions of real logs.
    pub condition: Option<Condition>,
    /// Whether the answer is that nothing is missing.
    pub is_clean: bool,
    /// `strong`, `medium`, `weak`, or `hidden` below what can be seen.
    pub level: &'static str,
    /// What was hidden, by catalogue name (or law, outside the catalogue).
    pub truth: Vec<String>,
    pub said: Vec<String>,
    /// Effects whose name and joint were found, counting stated families of at most three.
    pub found: usize,
    /// The same, by unambiguous answers alone.
    pub unambiguous: usize,
    /// Effects that were named and were not there.
    pub false_names: usize,
    /// Whether the answer is what was expected.
    pub right: bool,
    /// Share of the explainable held-out gap that was closed.
    pub closed: Option<f64>,
    /// Parameters within two standard deviations, of those that can be compared.
    pub within: [usize; 2],
}

const LARGEST_FAMILY: usize = 3;
/// Of an effect's strength, by what was reached and not by what was aimed at.
const LEVELS: [(&str, f64); 3] = [("strong", 12.0), ("medium", 3.5), ("weak", 1.4)];

fn level(strength: f64) -> &'static str {
    LEVELS.iter().find(|(_, least)| strength >= *least).map_or("hidden", |(name, _)| name)
}

impl Named {
    /// The value that corresponds to a hidden size, with its deviation.
    fn stated(&self, parameter: &str) -> Option<[f64; 2]> {
        if let Some((a, b)) = parameter.split_once(',') {
            let [[a, of_a], [b, of_b]] = [self.parameters.get(a)?, self.parameters.get(b)?];
            let amplitude = a.hypot(*b);
            return Some([amplitude, (a * of_a).hypot(b * of_b) / amplitude]);
        }
        let opposite = parameter.strip_prefix('-');
        let only = self.parameters.values().next().filter(|_| self.parameters.len() == 1);
        let [value, std] = *self.parameters.get(opposite.unwrap_or(parameter)).or(only)?;
        Some([if opposite.is_some() { -value } else { value }, std])
    }

    /// Whether this names the physics of a hidden effect, at its joint: alone, or, with `family`,
    /// as one of few.
    fn is(&self, hidden: &Hidden, robot: &Robot, family: bool) -> bool {
        let most = if family { LARGEST_FAMILY } else { 1 };
        let is_it = |name: &str, joint: &Option<String>| {
            hidden.is_called(name, robot) && is_there(hidden, robot, joint.as_deref())
        };
        self.others.len() < most
            && (is_it(&self.name, &self.joint)
                || self.others.iter().any(|(name, joint)| is_it(name, joint)))
    }
}

/// Whether a joint, or none for the whole model, is where a hidden effect is.
fn is_there(hidden: &Hidden, robot: &Robot, joint: Option<&str>) -> bool {
    let site = hidden.law.entry().site;
    let Some(joint) = joint else { return site == Site::Model };
    let at = |index: usize| robot.joints[index].name == joint;
    match site {
        Site::Joint => at(hidden.joint),
        Site::Pair => at(hidden.joint) || at(hidden.other),
        Site::Link => at(hidden.joint) || at(hidden.joint.saturating_sub(1)),
        Site::Model => true,
    }
}

/// Compares an answer with what was hidden.
pub fn score(generated: &Generated, answer: &Answer) -> Score {
    let case: &Case = &generated.case;
    let robot = &case.truth;
    let named: Vec<&Named> = answer.effects.iter().filter(|one| !one.name.is_empty()).collect();
    let count = |family: bool| {
        let is_found = |one: &&Hidden| named.iter().any(|named| named.is(one, robot, family));
        case.hidden.iter().filter(is_found).count()
    };
    let found = count(true);
    let known = |one: &&&Named| case.hidden.iter().any(|hidden| one.is(hidden, robot, true));
    let false_names = named.len() - named.iter().filter(known).count();
    let refused = matches!(answer.verdict.as_str(), "cannot_tell" | "unexplained");
    let right = match case.plan.kind {
        _ if answer.verdict == "failed" => false,
        Kind::Nothing => named.is_empty() && answer.verdict != "explained",
        Kind::Outside => refused || named.is_empty(),
        Kind::CannotTell => refused || (case.plan.still && named.is_empty()),
        Kind::Single | Kind::Pair | Kind::Thesis => found == case.hidden.len() && false_names == 0,
    };
    let weakest = generated.strengths.iter().copied().fold(f64::INFINITY, f64::min);
    let strength = if case.hidden.is_empty() { 0.0 } else { weakest };
    let label = |hidden: &Hidden| match hidden.law.entry().name {
        "" => format!("{:?}", hidden.law),
        name => name.to_owned(),
    };
    let said = |one: &&Named| one.name.clone();
    Score {
        number: case.number,
        kind: case.plan.kind,
        condition: case.plan.condition,
        is_clean: answer.verdict == "nothing_missing",
        level: level(strength),
        truth: case.hidden.iter().map(label).collect(),
        said: named.iter().map(said).collect(),
        found,
        unambiguous: count(false),
        false_names,
        right,
        closed: answer.closed,
        within: intervals(case, &named),
    }
}

/// Parameters within two standard deviations of the truth, and all that can be compared.
fn intervals(case: &Case, named: &[&Named]) -> [usize; 2] {
    let mut within = [0, 0];
    for hidden in case.hidden.iter().filter(|hidden| hidden.variant == 0) {
        let entry = hidden.law.entry();
        let answer =
            named.iter().find(|one| one.name == entry.name && one.is(hidden, &case.truth, true));
        let asked = !entry.parameter.is_empty();
        let stated = answer.filter(|_| asked).and_then(|one| one.stated(entry.parameter));
        let Some([value, std]) = stated else { continue };
        within[1] += 1;
        within[0] += usize::from((value - hidden.size).abs() <= 1.96 * std);
    }
    within
}

/// The probability of at most `hits` of `count` that are probable by `p` each.
fn at_most(hits: usize, count: usize, p: f64) -> f64 {
    let mut term = (count as f64 * (-p).ln_1p()).exp();
    let mut sum = term;
    for i in 0..hits {
        term *= (count - i) as f64 / (i + 1) as f64 * p / (1.0 - p);
        sum += term;
    }
    sum
}

/// Probability of each tail beyond an interval.
const TAIL: f64 = 0.025;

/// Exact interval of 95 % of a probability, after `hits` of `count` (Clopper, Pearson 1934): at its
/// ends the tails of the binomial distribution have 2.5 % each.
pub fn binomial_interval(hits: usize, count: usize) -> [f64; 2] {
    let bisect = |is_low: &dyn Fn(f64) -> bool| {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if is_low(middle) { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    };
    let lower = if hits == 0 { 0.0 } else { bisect(&|p| 1.0 - at_most(hits - 1, count, p) < TAIL) };
    let upper = if hits == count { 1.0 } else { bisect(&|p| at_most(hits, count, p) > TAIL) };
    [lower, upper]
}

/// The median and its interval of 95 %, between two of the values, whatever their distribution.
fn median(mut values: Vec<f64>) -> Option<[f64; 3]> {
    values.sort_by(f64::total_cmp);
    let count = values.len();
    let outside = (0..count / 2).take_while(|&k| at_most(k, count, 0.5) <= TAIL).count();
    let median = *values.get(count / 2)?;
    Some([median, values[outside.saturating_sub(1)], values[count - outside.max(1)]])
}

/// Figures of many cases, as lines of a table.
pub fn table(scores: &[Score]) -> String {
    let mut text =
        String::from("| | right | of | share | 95 % interval |\n|---|---:|---:|---:|---|\n");
    let mut line = |name: &str, hits: usize, count: usize| {
        if count > 0 {
            let [low, high] = binomial_interval(hits, count).map(|p| 100.0 * p);
            let share = 100.0 * hits as f64 / count as f64;
            text += &format!(
                "| {name} | {hits} | {count} | {share:.1} % | {low:.1} .. {high:.1} % |\n"
            );
        }
    };
    let of = |kind: Kind| scores.iter().filter(move |score| score.kind == kind);
    let levels = LEVELS.map(|(level, _)| level);
    let groups = [&levels[..2], &levels[2..], &levels[..1], &levels[1..2], &levels[..]];
    for group in groups {
        let name = group.join(" and ");
        let these: Vec<&Score> =
            of(Kind::Single).filter(|score| group.contains(&score.level)).collect();
        let counted =
            |is_it: &dyn Fn(&Score) -> bool| these.iter().filter(|score| is_it(score)).count();
        let all = these.len();
        line(&format!("{name}: name and joint"), counted(&|score| score.found > 0), all);
        line(&format!("{name}: unambiguously"), counted(&|score| score.unambiguous > 0), all);
        line(&format!("{name}: and nothing else"), counted(&|score| score.right), all);
    }
    let rights = |kind: Kind| of(kind).filter(|score| score.right).count();
    let seen = || of(Kind::Pair).filter(|score| score.level != "hidden");
    let both = seen().filter(|score| score.found == 2).count();
    line("pairs: both named", both, seen().count());
    let false_discoveries = of(Kind::Nothing).filter(|score| !score.right).count();
    line("nothing hidden: false discoveries", false_discoveries, of(Kind::Nothing).count());
    let clean = of(Kind::Nothing).filter(|score| score.is_clean).count();
    line("nothing hidden: nothing missing, it says", clean, of(Kind::Nothing).count());
    line(
        "outside the catalogue: refused or unnamed",
        rights(Kind::Outside),
        of(Kind::Outside).count(),
    );
    line("cannot be told: refused", rights(Kind::CannotTell), of(Kind::CannotTell).count());
    line("the thesis's own", rights(Kind::Thesis), of(Kind::Thesis).count());
    let sums =
        scores.iter().fold([0, 0], |[a, b], score| [a + score.within[0], b + score.within[1]]);
    line("parameters within their intervals", sums[0], sums[1]);
    let named = |score: &&Score| !score.truth.is_empty() && score.found > 0;
    let closed = scores.iter().filter(named).filter_map(|score| score.closed).collect();
    if let Some(shares) = median(closed) {
        let [median, low, high] = shares.map(|share| 100.0 * share);
        text += &format!(
            "\nMedian share of the explainable gap closed: {median:.1} % \
             (95 % interval {low:.1} .. {high:.1} %)\n"
        );
    }
    text
}

/// How it went under each condition of real logs: effects named, and of nothing hidden false
/// discoveries and answers that nothing is missing.
pub fn by_condition(scores: &[Score]) -> String {
    let mut text = String::from(
        "| condition | name and joint | and nothing else | false discoveries | nothing missing |\n\
         |---|---:|---:|---:|---:|\n",
    );
    for condition in CONDITIONS {
        let these = scores.iter().filter(|score| score.condition == Some(condition));
        let (nothing, hidden): (Vec<&Score>, Vec<&Score>) =
            these.partition(|score| score.kind == Kind::Nothing);
        let share = |of: &[&Score], is_it: &dyn Fn(&Score) -> bool| {
            format!("{} of {}", of.iter().filter(|score| is_it(score)).count(), of.len())
        };
        text += &format!(
            "| {condition:?} | {} | {} | {} | {} |\n",
            share(&hidden, &|score| score.found > 0),
            share(&hidden, &|score| score.right),
            share(&nothing, &|score| !score.right),
            share(&nothing, &|score| score.is_clean)
        );
    }
    text
}

/// What was said for what was hidden, in single cases: `hidden`, `said`, how often.
pub fn confusion(scores: &[Score]) -> String {
    let mut counts: BTreeMap<(String, String), usize> = BTreeMap::new();
    for score in scores.iter().filter(|score| {
        score.truth.len() <= 1 && score.level != "hidden" || score.kind == Kind::Nothing
    }) {
        let truth = score.truth.first().map_or("nothing", String::as_str);
        let mut said = score.said.clone();
        said.sort();
        said.dedup();
        let said = if said.is_empty() { "-".to_owned() } else { said.join(" + ") };
        *counts.entry((truth.to_owned(), said)).or_default() += 1;
    }
    let mut text = String::from("| hidden | said | times |\n|---|---|---:|\n");
    for ((truth, said), count) in counts {
        text += &format!("| {truth} | {said} | {count} |\n");
    }
    text
}
