//! The search for logs that contradict the others: one after another is left out, until the others
//! agree.

use super::super::policy;
use super::logs::{Compared, Line, Shared};
use super::{ContradictingJoint, ContradictingLog, Likeness, Standing};
use denavit_evidence::policy::NAMED;
use denavit_measure::condition::Conditioned;
use denavit_plants::regression::RegressionModel;
use nalgebra::DVector;

/// How logs agree.
pub(crate) struct Agreement {
    /// Logs for the estimate that contradict the others, in their order, and those for validation
    /// that contradict those for the estimate.
    pub(crate) contradicting: Vec<ContradictingLog>,
    /// Of several logs for the estimate the one that agrees least with the others.
    pub(crate) oddest: Option<OddLog>,
}

/// A log, and what the others say without it.
pub(crate) struct OddLog {
    pub(crate) log: usize,
    /// The parameters of the others, and their standard errors.
    pub(crate) phi: DVector<f64>,
    pub(crate) errors: DVector<f64>,
}

/// A log that is held against others.
struct Apart {
    log: usize,
    /// The log odds that it has something of its own.
    log_odds: f64,
    others: Shared,
    joints: Vec<ContradictingJoint>,
}

impl Apart {
    fn contradicts(&self) -> bool {
        self.log_odds > NAMED && !self.joints.is_empty()
    }
}

/// How logs for an estimate, which found `phi`, and those for validation agree; of those that are
/// not `shown` noise of the positions makes most.
pub(crate) fn agreement(
    model: &RegressionModel,
    (train, held_out): (&[Conditioned], &[Conditioned]),
    (shown, phi): (&[usize], &DVector<f64>),
) -> Agreement {
    let logs: Vec<&Conditioned> = train.iter().chain(held_out).collect();
    if logs.len() < 2 {
        return Agreement { contradicting: Vec::new(), oddest: None };
    }
    let first = Compared::new(model, &logs);
    let mut search = Search {
        agreeing: (0..train.len()).collect(),
        held_out: (train.len()..logs.len()).collect(),
        told: Vec::new(),
    };
    search.ask(&first);
    let oddest = search.oddest(&first, shown);
    let mut is_noisy = search.is_noisy(&first);
    let mut lower: Vec<Conditioned> = logs.iter().map(|&log| log.clone()).collect();
    for _ in 0..policy::HALVINGS {
        if !is_noisy {
            break;
        }
        lower = lower.iter().map(behind_half_the_cutoff).collect();
        let compared = Compared::new(model, &lower.iter().collect::<Vec<_>>());
        search.ask(&compared);
        is_noisy = search.is_noisy(&compared);
    }
    Agreement { contradicting: search.named((&first, train.len()), phi), oddest }
}

/// A log, or a piece of a long one, behind half the cutoff of its filter; as it is if it is too
/// short for that.
fn behind_half_the_cutoff(log: &Conditioned) -> Conditioned {
    let piece = log.pieces(policy::HALVED_SAMPLES)[0];
    log.halved(piece).map_or_else(|| log.clone(), |[_, lower]| lower)
}

/// Where the search has come to.
struct Search {
    /// Logs for the estimate that agree so far.
    agreeing: Vec<usize>,
    /// Logs for validation that contradict nothing so far.
    held_out: Vec<usize>,
    told: Vec<Apart>,
}

impl Search {
    /// Takes logs out of those that agree until the others do. Of two that contradict each other
    /// neither is believed.
    fn ask(&mut self, compared: &Compared<'_>) {
        let base = self.agreeing.clone();
        while self.agreeing.len() > 1 {
            let all = self.agreeing.iter().map(|&log| compared.apart(log, &self.agreeing));
            let mut odd: Vec<Apart> = all.filter(Apart::contradicts).collect();
            odd.sort_by(|a, b| b.log_odds.total_cmp(&a.log_odds));
            odd.truncate(if self.agreeing.len() > 2 { 1 } else { 2 });
            if odd.is_empty() {
                break;
            }
            self.agreeing.retain(|log| odd.iter().all(|one| one.log != *log));
            self.told.extend(odd);
        }
        let base = if self.agreeing.is_empty() { &base } else { &self.agreeing };
        let against = self.held_out.iter().map(|&log| compared.apart(log, base));
        self.told.extend(against.filter(Apart::contradicts));
        self.held_out.retain(|log| self.told.iter().all(|one| one.log != *log));
    }

    /// Whether noise of the positions may hide a contradiction of a log that is not told.
    fn is_noisy(&self, compared: &Compared<'_>) -> bool {
        self.agreeing.iter().chain(&self.held_out).any(|&log| compared.is_noisy(log))
    }

    /// Of the logs that are shown, or of those of them that contradict the others, the one that
    /// agrees least with those that agree.
    fn oddest(&self, compared: &Compared<'_>, shown: &[usize]) -> Option<OddLog> {
        let is_told = |log: &&usize| self.told.iter().any(|one| one.log == **log);
        let told: Vec<usize> = shown.iter().filter(is_told).copied().collect();
        let asked = if told.is_empty() { shown } else { &told };
        let of = |&log: &usize| {
            let is_other = |other: &&usize| **other != log && shown.contains(other);
            let agreeing: Vec<usize> = self.agreeing.iter().filter(is_other).copied().collect();
            let all: Vec<usize> = shown.iter().copied().filter(|other| *other != log).collect();
            let others = if agreeing.is_empty() { all } else { agreeing };
            (!others.is_empty()).then(|| compared.apart(log, &others))
        };
        let all = asked.iter().filter_map(of);
        let most = all.max_by(|a, b| a.log_odds.total_cmp(&b.log_odds))?;
        Some(OddLog { log: most.log, phi: most.others.phi, errors: most.others.errors })
    }

    /// What is said of logs that contradict the others, of so many for the estimate.
    fn named(
        mut self,
        (compared, count): (&Compared<'_>, usize),
        phi: &DVector<f64>,
    ) -> Vec<ContradictingLog> {
        self.told.sort_by_key(|one| one.log);
        let time_s = |log: usize| compared.logs[log].range.len() as f64 * compared.logs[log].step_s;
        let odd = || self.told.iter().map(|one| one.log).filter(|log| *log < count);
        let [all, few] = [(0..count).map(time_s).sum::<f64>(), odd().map(time_s).sum::<f64>()];
        let is_few = 2 * odd().count() < count && 2.0 * few < all;
        let standing = match is_few {
            false => Standing::Undecided,
            true if odd().count() == 0 || compared.is_of(&self.agreeing, phi) => Standing::OfFew,
            true => Standing::OfFewFollowed,
        };
        let of = |one: Apart| ContradictingLog {
            file: compared.logs[one.log].file.clone(),
            joints: one.joints,
            standing: if one.log < count { standing } else { Standing::HeldOut },
        };
        self.told.into_iter().map(of).collect()
    }
}

impl Compared<'_> {
    /// Holds a log against others.
    fn apart(&self, log: usize, others: &[usize]) -> Apart {
        let others: Vec<usize> = others.iter().copied().filter(|other| *other != log).collect();
        let both = [&others[..], &[log]].concat();
        let (together, without) = (self.shared(&both, &[]), self.shared(&others, &[]));
        let own = self.shared(&[log], &[]);
        let phi = self.shared_beside(&others, log).phi;
        let by_own = without.log_evidence + own.log_evidence - together.log_evidence + policy::OWN;
        let beside = self.beside(log, &both, (&phi, &together));
        let by_lines =
            beside.1.log_evidence - together.log_evidence + policy::MISREAD * beside.0.len() as f64;
        let is_own = by_own > by_lines || beside.0.is_empty();
        let joint = |joint: usize| {
            let left = self.left((log, joint), &phi, (&[], &[]))?;
            let of_own = match is_own {
                true => self.left((log, joint), &own.phi, (&[], &[]))?,
                false => self.left((log, joint), &beside.1.phi, (&beside.0, &beside.1.sizes))?,
            };
            let is_told = self.likelier((log, joint), [of_own, left]) > NAMED
                && left - of_own > policy::AGREE.powi(2);
            let line = beside.0.iter().zip(&beside.1.sizes).find(|(line, _)| line.joint == joint);
            is_told.then(|| ContradictingJoint {
                joint: self.model.joints[joint].name.clone(),
                left: left.sqrt(),
                own: of_own.sqrt(),
                like: line.filter(|_| !is_own).map(|(line, &size)| match line.is_gain {
                    true => Likeness::Factor(1.0 + size),
                    false if self.model.joints[joint].slides => Likeness::Constant(size, "N"),
                    false => Likeness::Constant(size, "N m"),
                }),
            })
        };
        let joints = (0..self.model.joints.len()).filter_map(joint).collect();
        Apart { log, log_odds: by_own.max(by_lines), others: without, joints }
    }

    /// The lines of a log beside the parameters that it shares, one after the other as long as
    /// evidence grows.
    fn beside(
        &self,
        log: usize,
        both: &[usize],
        (phi, together): (&DVector<f64>, &Shared),
    ) -> (Vec<Line>, Shared) {
        let (mut lines, mut best) = (Vec::new(), together.clone());
        let mut tried = self.lines(log, phi);
        tried.retain(|line| self.by_line(line, phi) > NAMED - policy::MISREAD);
        while !tried.is_empty() {
            let with = |line: &Line| self.shared(both, &[&lines[..], &[line.clone()]].concat());
            let all = tried.iter().map(with).enumerate();
            let most = all.max_by(|a, b| a.1.log_evidence.total_cmp(&b.1.log_evidence));
            let Some((at, next)) = most else { break };
            if next.log_evidence + policy::MISREAD <= best.log_evidence {
                break;
            }
            lines.push(tried.remove(at));
            best = next;
        }
        (lines, best)
    }

    /// Whether parameters are what some logs say.
    fn is_of(&self, logs: &[usize], phi: &DVector<f64>) -> bool {
        let shared = self.shared(logs, &[]);
        let apart = phi - &shared.phi;
        let mut both = apart.iter().zip(&shared.errors);
        both.all(|(by, error)| by.abs() <= policy::ERRORS_HOLD * error)
    }
}
